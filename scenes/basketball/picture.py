"""Basketball from the side: the shot's arc in a quiet hall, to the ring and down to the floor."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property
from math import cos, radians, sin

import numpy as np
import pygame

from sandbox.kit import (
    Box,
    Camera,
    Eye,
    Hall,
    Labels,
    Length,
    Look,
    Painter,
    Person,
    Place,
    Sheet,
    SideView,
    Story,
    Thing,
    around_corners,
    boards,
    courts,
    draw_trace,
    mark_impacts,
    metres,
    mix,
    palette,
    scene_colours,
    seams,
)
from sandbox.picture.path import ImpactMark

from . import hoop
from .scene import Parameters, entry, on_floor

CARD, COLOURS = palette("card"), scene_colours(__file__)
BALL, FLOOR = COLOURS["ball"], COLOURS["floor"]

#: Reach in m of the stand behind the board, and of the thrower before the release.
STAND, THROWER = 2.5, 0.7
#: A net hangs so far below the ring, in m.
NET = 0.45
#: The lens shows so much of the world, in m, on so many px (of 720 rows); its middle lies so far from the ring's, in m.
SHOWN, SIDE, OFF_MIDDLE = 1.22, 286, (-0.02, 0.08)
#: There is no lens if the whole would have to be drawn smaller than this for it, or if it were no larger than this.
LEAST_SHRINK, LEAST_LENS = 0.85, 1.5


class Picture(SideView[Parameters]):
    """One shot."""

    LOOK = Look(BALL["colour"], seams(BALL["seam"]))
    TRACE, OTHER_TRACES = COLOURS["trace"], COLOURS["earlier"]
    FAINT_TRACE = mix(TRACE, COLOURS["hall"]["wall"][1], 0.45)
    LENGTH_ROWS, SECOND_UNIT, MEASURED_FROM = 1, "ft", "from the hand"
    EYE_HEIGHT, EYE_COLUMN, GOES_IN = 128, 0.25, 0.0

    @cached_property
    def story_end(self) -> float:
        """The time in s at which the ball is on the floor."""
        return on_floor(self.run)

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return self.ring, "the ring"

    @cached_property
    def strobe_end(self) -> float:
        """Most of the way to the floor, whether the ring is touched or not: balls are as close in all shots."""
        return 0.8 * self.story_end

    @property
    def moment(self) -> float:
        return self.net.fullest

    # The place

    @property
    def ring(self) -> tuple[float, float]:
        """The middle of the ring, in m."""
        return self.parameters.hoop.middle

    @cached_property
    def net(self) -> hoop.HangingNet:
        return hoop.HangingNet(self.run, self.parameters)

    @property
    def thrower(self) -> list[Person]:
        """The thrower, if a person can have thrown from there."""
        height = self.parameters.release.height
        if not 1.6 <= height <= 3.1 or abs(self.parameters.launch.angle - 45) > 50:
            return []
        pose = "shooting" if height <= 2.2 else "reaching"
        return [Person.holding((0.0, height), pose, COLOURS["thrower"], 2.05)]

    @cached_property
    def place(self) -> Place:
        face = self.parameters.board[0]
        lines = courts.basketball_lines(face, self.ring[0])
        ground = boards(FLOOR, areas=[(courts.basketball_key(face), FLOOR["key"])], lines=lines)
        things = [*hoop.stand(self.parameters), *self.hoop, *self.thrower]
        return Place(Hall(**COLOURS["hall"]), ground, things)

    @cached_property
    def hoop(self) -> Sequence[Thing]:
        """Board and ring, which shake when the ball hits them."""
        return hoop.hoop(self.parameters)

    def draw_things(self, painter: Painter, eye: Eye, near: bool) -> None:
        """All but board and ring, which are drawn as they shake."""
        for thing in self.standing:
            if thing.near == near and thing not in self.hoop:
                thing.draw(painter, eye)

    def draw_hoop(self, painter: Painter, camera: Camera, t: float, near: bool) -> None:
        """Board, ring and net, those parts that are before the ball or those that are not."""
        eye = self.seen_from(camera)
        if self.answering is not None:
            down = hoop.shaken(self.run, self.answering) * eye.camera.scale
            x, y = eye.camera.anchor
            eye = replace(eye, camera=replace(eye.camera, anchor=(x, y + down)))
        if near:
            self.net.draw(painter, eye, near, t)
        for thing in self.hoop:
            if thing.near == near:
                thing.draw(painter, eye)
        if not near:
            self.net.draw(painter, eye, near, t)

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        self.draw_hoop(painter, camera, t, near=False)

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        self.draw_hoop(painter, camera, t, near=True)
        super().before(painter, camera, t)

    @property
    def must_be_visible(self) -> Box:
        return Box(-THROWER if self.thrower else 0.0, 0.0, 0.0, 0.0)

    @property
    def aims(self) -> list[Box]:
        """Ring, net and board."""
        (x, y), (_, bottom, back, top) = self.ring, self.parameters.board
        half = 0.5 * self.parameters.hoop.inner_diameter + 2.0 * self.parameters.hoop.tube_radius
        return [Box(x - half, y - NET, back, y + 0.05), Box(x, bottom, back, top)]

    @property
    def story(self) -> Story:
        """Ring and net, past which a ball falls that misses all, or where the ball goes instead."""
        past = [t for t, _ in self.run.crossings("ball", (0.0, self.ring[1]), (0.0, 1.0)) if t <= self.decided]
        if past and not {*self.run.result["touches"]} - {"floor"} and not self.run.result["made"]:
            return Story(self.aims[0], past[-1])
        return self.meeting(self.aims[0], share=0.35, spot=1.5)

    @property
    def preferred_view(self) -> Box:
        face, _, back, top = self.parameters.board
        return Box(face, 0.0, back + STAND, top)

    def lengths(self) -> list[Length]:
        """From the release to the ring."""
        distance, height = self.ring
        return [Length(f"{metres(distance)} to the ring, {metres(height)} up", 0.0, distance)]

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """Nothing, but no label goes where the lens is."""
        if self.beside:
            sheet.labels.take(self.lens)

    # The lens: the ring from near by

    @cached_property
    def lens(self) -> pygame.Rect:
        """Its rectangle, in px."""
        side, frame = round(SIDE * self.unit), self.sheet.frame
        return pygame.Rect(frame.right - side, frame.top, side, side)

    @cached_property
    def near(self) -> Camera:
        """Its camera."""
        at = np.add(self.ring, OFF_MIDDLE).tolist()
        return Camera((at[0], at[1]), self.lens.center, self.lens.width / SHOWN)

    def _away(self, points: np.ndarray) -> np.ndarray:
        """The distances of points from the ring, as shares of half of what the lens shows."""
        return np.abs(points - self.ring).max(axis=1) / (SHOWN / 2)

    @cached_property
    def beside(self) -> Camera | None:
        """The poster's camera that leaves room for the lens; None where there is none: the ball does not come to the
        ring, the whole would be too small, or the lens shows it hardly larger."""
        area = self.area._replace(left=0.06 * self.size[0], right=self.lens.left - 24 * self.unit)
        camera, comes = self.fitted(area), self._away(self.path.points).min() < 0.9
        large = camera.scale >= LEAST_SHRINK * self.fitted(self.area).scale
        return camera if comes and large and self.near.scale > LEAST_LENS * camera.scale else None

    @cached_property
    def camera(self) -> Camera:
        return self.beside or self.fitted(self.area)

    def seen_from(self, camera: Camera) -> Eye:
        if camera != self.near:
            return super().seen_from(camera)
        eye = self.eye(self.camera)  # the same eye sees what is in the lens
        centre, level = camera.pixel(*self.camera.world(eye.centre, eye.level))
        return replace(eye, camera=camera, centre=centre, level=level)

    def impacts(self, camera: Camera) -> list[ImpactMark]:
        """Those that this camera shows; the rest are in the lens."""
        marks, here = super().impacts(camera), camera == self.near
        return [mark for mark in marks if not self.beside or here == (self._away(np.array([mark.at]))[0] < 1.0)]

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect | None:
        """On the poster the lens: how the ball comes, and what it touches."""
        if not self.beside or t is not None:
            return None
        near, painter, moment = self.near, sheet.painter, self.moment
        corners = around_corners(sheet.surface, self.lens, 10 * self.unit)
        sheet.surface.fill(COLOURS["lens"], self.lens)
        sheet.surface.set_clip(self.lens)
        self.draw_things(painter, self.seen_from(near), near=False)
        self.behind(painter, near, moment)
        outside, sheet.labels = sheet.labels, Labels(self.lens.inflate(-2 * sheet.gap, -2 * sheet.gap), sheet.gap)
        points = near.pixels(self.path.points)
        seen = np.flatnonzero(np.abs(points - self.lens.center).max(axis=1) < self.lens.width)
        draw_trace(sheet, points[seen[0] : seen[-1] + 1], self.TRACE)
        self._entry(sheet)
        self.before(painter, near, moment)
        mark_impacts(sheet, near, self.impacts(near))
        corner = self.lens.left + 2 * sheet.gap, self.lens.bottom - 1.6 * sheet.gap
        larger = f"{near.scale / self.camera.scale:.1f}×"
        sheet.label(larger, "small", [(*corner, "bottomleft")], CARD["quiet"])
        sheet.labels = outside
        sheet.surface.set_clip(None)
        sheet.surface.blit(corners, self.lens)
        return self.lens

    def _entry(self, sheet: Sheet) -> None:
        """The ball as it comes to the ring, and the angle at which it does."""
        ball = entry(self.run, self.parameters)
        if ball is None:
            return
        (px, py), unit, accent = self.near.pixel(ball.x, ball.y), self.unit, CARD["accent"]
        side, radius = -1 if ball.vx > 0 else 1, self.radius * self.near.scale
        far, turn = radius + 26 * unit, np.linspace(0, radians(ball.descent), 25)
        across, down = side * cos(turn[-1] / 2), -sin(turn[-1] / 2)
        anchor = "midright" if side < 0 else "midleft"
        spots = [(px + across * (far + out * unit), py + down * (far + out * unit), anchor) for out in (6, 12, 20, 30)]
        shown = self.lens.collidepoint(px + side * far, py) and ball.descent > 5
        if shown and sheet.label(f"{ball.descent:.1f}°", "small", spots, accent, bold=True):
            level = [(px, py), (px + side * (far + 8 * unit), py)]
            sheet.painter.dashes(level, 1.3 * unit, accent, 4 * unit, 4 * unit)
            arc = np.column_stack([px + side * far * np.cos(turn), py - far * np.sin(turn)])
            sheet.painter.line(arc, 1.8 * unit, accent)
            sheet.labels.take_path(arc, 2 * unit)
        self.LOOK.draw(sheet.painter, (px, py), radius, self.turn("ball", ball.t), unit)
        sheet.labels.take_path([(px, py)], radius)
