"""Golf from the side: a wide sky, the ground cut open along the line of play, and the ball's path over it."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from math import pi, sin
from typing import Any

import numpy as np
import pygame

from sandbox.kit import (
    Box,
    Camera,
    Colour,
    Eye,
    Ground,
    Landscape,
    Length,
    Line,
    Look,
    Mark,
    Painter,
    Segment,
    Sheet,
    SideRows,
    SideView,
    Story,
    Stripes,
    Thing,
    dimples,
    in_two_units,
    metres,
    mix,
    palette,
    round_number_above,
    scene_colours,
)
from sandbox.sport.sideways import GroundPlace

from .scene import Parameters, track

CARD, COLOURS = palette("card"), scene_colours(__file__)
HOLE, BALL = COLOURS["hole"], COLOURS["ball"]

#: Carry is measured at launch height; a ball that is then at least this far above the ground (px on 720 rows) shows so.
LEAST_DROP = 14
#: Without air, and with gravity below this in m/s^2, it is the Moon.
LEAST_GRAVITY = 5.0
#: Mown stripes are about so wide, and the dashed line under the apex is at least so long, in px on 720 rows.
STRIPE, LEAST_APEX = 70, 44
#: Height of the flagstick in m, and scale of things at the far side of the fairway, compared with the line of play.
FLAGSTICK, FAR = 2.13, 0.42
#: Depth of the turf that is cut open, and most of a hollow, in px on 720 rows; a cup of this width is drawn.
TURF, HOLLOW, LEAST_CUP = 7, 16, 10
#: A ball that ends so near to the cup, in m, is decided there.
CLOSE = 0.5

#: A flag over a ball that is holed flutters so much wider, in px on 720 rows, and as before after so many s.
LIVELY, CALMS = 3.0, 2.0
#: A pin as near as this, in m, is in the picture of a putt however short it is.
NEAR_PIN = 15.0


def _stripe(at: np.ndarray) -> np.ndarray:
    """The line that players draw around half of it."""
    return ((abs(at[..., 1]) < 0.13) & (at[..., 2] > 0.0) & (abs(at[..., 0]) < 0.7)).astype(float)


class Picture(SideView[Parameters]):
    """One shot of golf."""

    LOOK = Look(BALL["colour"], Mark(BALL["mark"], _stripe, least=6), dimples(BALL["dimple"]))
    HEADROOM = 40
    MAX_STRETCH = 2.0
    MIN_PATH_SHARE = 0.2
    MIN_IMPACT, MIN_IMPACT_SHARE = 1.0, 0.25
    TRAIL, MIN_STROBE_SHARE = 1.4, 0.4
    EYE_HEIGHT, EYE_COLUMN = 58, 0.5

    @cached_property
    def on_dark(self) -> bool:
        """On the Moon, whose sky is black."""
        return self.parameters.air.density == 0.0 and self.parameters.gravity < LEAST_GRAVITY

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (self.pin, 0.0), "the pin"

    @property
    def preferred_view(self) -> Box:
        return Box(self.pin, 0.0, self.pin, 0.0)

    @property
    def must_be_visible(self) -> Box | None:
        return self.preferred_view if self.pin <= NEAR_PIN else None

    @property
    def story(self) -> Story:
        """The cup if the ball ends near it, or else where it ends up."""
        cup, end = self.cup, float(self.path.points[-1, 0])
        near = bool(cup.left < cup.right and cup.left - CLOSE < end < cup.right + CLOSE)
        return self.meeting(*[cup] * near, share=0.22 if near else 0.35, spot=5.0, at=self.story_end)

    @property
    def floor(self) -> float:
        """The bottom of the cup, which is cut open, if that is lower."""
        return min(self.cup.bottom, super().floor)

    # The place

    @property
    def pin(self) -> float:
        """The pin's place, in m."""
        return self.parameters.pin.distance

    @property
    def colours(self) -> dict[str, Any]:
        """Those of the course."""
        found: dict[str, Any] = COLOURS["moon" if self.on_dark else "earth"]
        return found

    @cached_property
    def pieces(self) -> list[tuple[str, Segment]]:
        """The ground, from left to right, each piece with its kind."""
        found = ((s.name, s.shape) for s in self.run.setup.surfaces if isinstance(s.shape, Segment) and s.name != "cup")
        return sorted(found, key=lambda piece: piece[1].a)

    @cached_property
    def cup(self) -> Box:
        """The cup; without height where there is none."""
        corners = [s.shape.a for s in self.run.setup.surfaces if isinstance(s.shape, Segment) and s.name == "cup"]
        corners = corners or [(self.pin, self._under(self.pin))]
        return Box(*np.min(corners, axis=0), *np.max(corners, axis=0))

    @cached_property
    def line(self) -> np.ndarray:
        """The ground's line in m, from left to right, shape (n, 2)."""
        return np.array(self.parameters.ground.line)

    def ground(self, x: np.ndarray) -> np.ndarray:
        """Across the cup too."""
        return np.interp(x, *self.line.T)

    def profile(self, left: float, right: float) -> np.ndarray:
        inner = self.line[(self.line[:, 0] > left) & (self.line[:, 0] < right)]
        return np.array([(left, self._under(left)), *inner, (right, self._under(right))])

    def base(self, rows: SideRows, scale: float) -> int:
        """Higher where the cup can be seen, for lengths and ruler are below it."""
        cup, seen = self.cup, self.subject.left <= self.pin <= self.subject.right
        deep = (cup.top - cup.bottom) * scale - 4 * self.unit if seen else 0.0
        return rows.base - round(min(max(0.0, deep), 0.15 * self.size[1]))

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """Landscape, field and ground."""
        eye, (width, height), turf = self.seen_from(camera), self.size, self.colours["turf"]
        low, high = camera.world(0, 0)[0], camera.world(width, 0)[0]
        outline = camera.pixels(self.profile(low, high))
        deepest = min(height, max(round(eye.base), round(outline[:, 1].max())))
        field, thick = (
            self._field(eye, round_number_above(STRIPE * self.unit / self.camera.scale)),
            max(3, round(TURF * self.unit)),
        )
        Landscape(**self.colours["landscape"]).draw(painter.surface, min(field.foot(eye), height), self.moved(camera))
        field.draw(painter, eye, deepest)
        if outline[:, 1].min() < deepest - 1:
            under = np.add(outline, (0, thick / 2))  # so that its rough edge is hidden
            pygame.draw.polygon(painter.surface, turf["soil"][0], [*under, (width, deepest), (0, deepest)])
        for name, shape in self.pieces:
            left, right = max(shape.a[0], low), min(shape.b[0], high)
            if left < right:
                top = camera.pixels(self.profile(left, right)).round()
                painter.polygon([*top, *np.add(top[::-1], (0, thick))], mix(turf[name], (255, 255, 255), 0.13))
            if left < right and name in ("bunker", "water"):
                self._hollow(painter, eye, camera.pixels(np.array([shape.a, shape.b])), turf[name])
        self._hole(painter, eye)

    def _field(self, eye: Eye, stripe: float) -> Ground:
        """The ground behind the line of play: rough along the horizon, in front of it fairway, green and bunkers."""
        far, close, turf = eye.depth(FAR), eye.depth(2.0), self.colours["turf"]
        areas: list[tuple[Line, Colour]] = []
        for name, shape in self.pieces:
            a, b = shape.a[0], shape.b[0]
            if name in ("rough", "tee"):
                left, right = max(a, eye.along(0, far)), min(b, eye.along(2 * eye.centre, far))
                areas.append(([(left, close), (right, close), (right, far), (left, far)], turf[name]))
            elif name != "fairway":
                deep = min(0.5, max(0.16 * (b - a) * eye.camera.scale, 8.0 * self.unit) / (eye.base - eye.level))
                turn = np.linspace(0.0, pi, 41)
                x, z = (a + b) / 2 + np.cos(turn) * (b - a) / 2, np.sin(turn) * eye.depth(1 - deep)
                areas.append(([(b, close), *zip(x, z, strict=True), (a, close)], turf[name]))
        stripes = Stripes((turf["fairway"], turf["fairway_stripe"]), stripe)
        beyond = turf["rough_far"], turf["rough"]
        return Ground(stripes, turf["soil"], areas=areas, far=FAR, beyond=beyond)

    def _hollow(self, painter: Painter, eye: Eye, ends: np.ndarray, colour: Colour) -> None:
        """Sand or water in a shallow hollow between two points in px."""
        (left, top), (right, end) = ends
        turn = np.linspace(0, pi, 25)
        x = (left + right) / 2 + np.cos(turn) * (right - left) / 2
        deep = np.sin(turn) ** 0.7 * min(HOLLOW * self.unit, 0.2 * (right - left))
        painter.polygon([*ends, *zip(x, np.interp(x, [left, right], [top, end]) + deep, strict=True)], colour)

    def _hole(self, painter: Painter, eye: Eye) -> None:
        """The cup, or a shadow where it would be too small to see."""
        (left, low), (right, top) = eye.camera.pixel(*self.cup[:2]), eye.camera.pixel(*self.cup[2:])
        unit, dark = self.unit, HOLE["cup"]
        if self.cup.left < self.cup.right and right - left <= LEAST_CUP * unit:
            painter.shadow(((left + right) / 2, top + 3 * unit), 7 * unit, 2.5 * unit, dark, 0.9)
        elif left < right:
            thin = max(1, round(1.6 * unit))
            liner = pygame.Rect(round(left), round(top), round(right - left), round(low - top))
            painter.surface.fill(HOLE["liner"], liner)
            painter.surface.fill(dark, (liner.left + thin, liner.top, liner.width - 2 * thin, liner.height - thin))

    def kept_clear(self, camera: Camera, t: float) -> list[pygame.Rect]:
        return [*super().kept_clear(camera, t), self.flag_box(camera)]

    def flag_box(self, camera: Camera) -> pygame.Rect:
        """The place that the flag takes; it is drawn larger where it would be too small to see."""
        (x, ground), unit = camera.pixel(self.pin, self.cup.top), self.unit
        tall, cloth = min(max(FLAGSTICK * camera.scale, 66 * unit), 120 * unit), 30 * unit
        return pygame.Rect(round(x - cloth), round(ground - tall), round(2 * cloth), round(tall))

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """The flag, which flutters in the wind."""
        (x, ground), unit = camera.pixel(self.pin, self.cup.top), self.unit
        top, deep = self.flag_box(camera).top, (self.cup.top - self.cup.bottom) * camera.scale
        foot = ground + (deep if deep > LEAST_CUP * unit else 3 * unit if deep else 0.0)
        painter.shadow((x + 12 * unit, ground - unit), 16 * unit, 2.5 * unit, CARD["shadow"], 0.3)
        painter.trace([(x, foot), (x, top)], max(2.0, 2.6 * unit), HOLE["pole"], CARD["shadow"], 0.7 * unit)
        share, wide = np.linspace(0, 1, 9), (1.6 + self._lively()) * unit
        along = x + (-1 if self.wind[0] < 0 else 1) * 30 * unit * share
        t = t if self.answering is None else self.answering
        wave = top + np.array([wide * s * sin(5 * s - 9 * t) for s in share])
        edges = np.concatenate([wave + 9 * unit * share, (wave + (19 - 9 * share) * unit)[::-1]])
        painter.polygon(np.column_stack([[*along, *along[::-1]], edges]), HOLE["flag"])

    def _lively(self) -> float:
        """The amplitude in px on 720 rows that the flag's flutter gains once the ball is in the cup."""
        if self.answering is None or not self.run.result["holed"]:
            return 0.0
        since = self.answering - self.decided
        return LIVELY * max(0.0, 1.0 - since / CALMS) if since > 0.0 else 0.0

    @property
    def standing(self) -> Sequence[Thing]:
        """Nothing: the ball is in front of all of the course."""
        return ()

    def landmarks(self, sheet: Sheet, camera: Camera) -> None:
        """Write how far the pin is."""
        flag = self.flag_box(camera)
        if flag.colliderect(sheet.surface.get_rect()):
            sheet.labels.take(flag.inflate(0, 2 * sheet.gap))
            spots = [(flag.centerx, flag.top - lift * self.unit, "midbottom") for lift in (8, 14)]
            text = f"pin {metres(self.pin, 0 if self.pin == int(self.pin) else None)}"
            sheet.label(text, "small", spots, sheet.ink, bold=True)

    # The poster

    @property
    def track(self) -> Sequence[GroundPlace]:
        return track(self.run, self.parameters)

    @property
    def sky(self) -> float:
        return min(super().sky, self.flag_box(self.camera).top - 36 * self.unit)

    def closeup_boxes(self) -> list[Box]:
        """The cup, as a putt comes to it."""
        cup = self.cup
        wide = cup.right - cup.left
        if wide * self.camera.scale < LEAST_CUP * self.unit:
            return []
        return [Box(cup.left - 4 * wide, cup.bottom - 0.2 * wide, cup.right + 2 * wide, cup.top + 0.8 * wide)]

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The apex, with a dashed line down to the ground, and where carry ends in the air."""
        unit, (_, x, y) = self.unit, self.path.samples[self.path.points[:, 1].argmax()]
        (px, py), (_, ground) = camera.pixel(x, y), camera.pixel(x, self._under(x))
        if ground - py >= LEAST_APEX * unit:
            above = [(px, py - lift * unit, "midbottom") for lift in (12, 18, 24)]
            aside = [(px + side * 10 * unit, (py + ground) / 2, side, 0.0) for side in (1.0, -1.0)]
            text = f"apex {metres(self.run.result['apex'])}"
            if not sheet.label(text, "small", above, sheet.ink, bold=True):
                sheet.chip(text, aside)
            sheet.painter.dashes([(px, py + 8 * unit), (px, ground)], 1.2 * unit, sheet.quiet_ink, 5 * unit, 4 * unit)
            sheet.labels.take_path([(px, row) for row in np.linspace(py, ground, 20)], 2 * unit)
        if self.rows_at.lengths and self._ends_high:
            end = camera.pixel(self.run.result["carry"], self.path.points[0, 1])
            down = end[0], self.rows_at.lengths[-1] - 0.6 * sheet.gap
            sheet.painter.dashes([end, down], 1.3 * unit, CARD["accent"], 4 * unit, 4 * unit)
            sheet.painter.disc(end, 3.0 * unit, CARD["accent"])
            sheet.labels.take_path(np.linspace(end, down, 20), 4 * unit)

    def lengths(self) -> list[Length]:
        """Total, and carry."""
        why = "   at launch height" if self._ends_high else ""
        total, carry = self.run.result["total"], self.run.result["carry"] or 0.0
        lengths = [Length(f"total {in_two_units(total, 'yd')}", 0.0, total)]
        lengths += [Length(f"carry {in_two_units(carry, 'yd')}{why}", 0.0, carry, CARD["accent"])]
        return [length for length in lengths if length.end]

    @property
    def _ends_high(self) -> bool:
        """True if the ball is seen to be above lower ground where its carry ends."""
        carry, camera = self.run.result["carry"], self.camera
        if carry is None:
            return False
        drop = self.path.points[0, 1] - self.radius - self._under(carry)
        return bool(drop * camera.scale * camera.stretch >= LEAST_DROP * self.unit)
