"""The bench: balls with their velocities before and after the blow, and bars of momentum and energy that add up."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain, product
from math import cos, sin

import numpy as np
import pygame

from sandbox.kit import (
    AboveView,
    Area,
    Body,
    Camera,
    Colour,
    Look,
    Mark,
    Painter,
    Segment,
    Sheet,
    metres,
    near,
    palette,
    round_number_above,
    scene_colours,
    signed,
)
from sandbox.picture.places.plan import Plan
from sandbox.picture.places.things import unit_of

from .boxes import TOUCH, strip
from .scene import AMOUNTS, Blow, Parameters, blow, hangs, shares, stepped
from .stepping import RULES, Stepped

CARD, COLOURS = palette("card"), scene_colours(__file__)
SPOTS = near(np.array(list(product((-1.0, 1.0), repeat=3))) / 3**0.5, 0.25)  # so that one sees them turn
LOOKS = [Look(colour, Mark(COLOURS["spot"], SPOTS), gloss=0.7) for colour in COLOURS["balls"]]
#: Width of the bench's planks, px on 720 rows; where the mat lies on the picture: its corner and size, as shares of it.
PLANK, MAT = 46.0, (0.035, 0.145, 0.93, 0.695)
#: The share of the width that bars take, the rows of letters that two take with their title; px of the longest arrow.
BARS, BLOCK, LONGEST = 0.27, 3.75, 90.0
#: Under them the blow is drawn by itself if there is room for so many px.
LEAST_BESIDE = 120.0
#: Room between two rows of balls, for a line of letters, in radii of the larger; outlines along a row.
BETWEEN, OUTLINES = 2.4, 8


@dataclass(frozen=True)
class Board:
    """A mat with a grid of round lengths on a wooden bench, and a floor or a bowl."""

    shapes: tuple[Segment, ...]

    def draw(self, painter: Painter, camera: Camera) -> None:
        size, unit = painter.surface.get_size(), unit_of(painter)
        plank = PLANK * unit
        for i, top in enumerate(np.arange(0.0, size[1], plank).tolist()):
            painter.surface.fill(COLOURS["bench"][i % 2], (0, round(top), size[0], round(top + plank) - round(top)))
        mat = pygame.Rect(*(round(share * side) for share, side in zip(MAT, (*size, *size), strict=True)))
        shadow = mat.inflate(16 * unit, 16 * unit).move(0, round(4 * unit))
        painter.panel(shadow, COLOURS["dusk"], 0.35, 16 * unit)
        painter.panel(mat, COLOURS["board"], 1.0, 10 * unit)
        (left, high), (right, low) = camera.world(*mat.topleft), camera.world(*mat.bottomright)
        step = round_number_above(60 * unit / camera.scale)
        across = [((x, low), (x, high)) for x in np.arange(left // step + 1, right / step) * step]
        along = [((left, y), (right, y)) for y in np.arange(low // step + 1, high / step) * step]
        floor = [[(min(max(x, left), right), y) for x, y in (shape.a, shape.b)] for shape in self.shapes]
        for lines, width, colour in ((across + along, 1.0, COLOURS["grid"]), (floor, 4 * unit, COLOURS["floor"])):
            for ends in lines:
                painter.line([camera.pixel(*end) for end in ends], width, colour)


class Picture(AboveView[Parameters]):
    MIN_IMPACT = np.inf  # marks would hide the arrows
    STRING_COLOUR = COLOURS["string"]
    DUSK = COLOURS["dusk"]

    @property
    def ball(self) -> str:
        named = self.parameters.launch.ball
        return named if named in self.balls else self.balls[0]

    @property
    def area(self) -> Area:
        """Left of the bars, if there are any."""
        area = super().area
        return area if self.met is None else area._replace(right=area.right - BARS * self.size[0])

    @cached_property
    def met(self) -> Blow | None:
        """The blow; None where rules at a fixed step take its room."""
        return None if self.rows_of_rules else blow(self.run, self.parameters)

    @cached_property
    def rows_of_rules(self) -> list[tuple[str, Stepped, float]]:
        """The name of each rule at a fixed step, its run, and how far below the exact run it is drawn, in m."""
        low, high = self.surroundings
        apart = high[1] - low[1] + BETWEEN * max(self.radii.values())
        return [(name, each, i * apart) for i, (name, each) in enumerate(stepped(self.run, self.parameters).items(), 1)]

    def look_of(self, name: str) -> Look:
        place = self.balls.index(name)
        return LOOKS[min(place, 2 + (place - 2) % (len(LOOKS) - 2))]

    def colour_of(self, name: str) -> Colour:
        return self.look_of(name).colour

    @cached_property
    def must_show(self) -> np.ndarray:
        """With the ends of the strings, and the rows of other rules."""
        low, high = self.surroundings
        room = np.array([0.0, 0.3 * BETWEEN * max(self.radii.values())])
        rows = [corner for *_, below in self.rows_of_rules for corner in (low - np.array([0.0, below]), high + room)]
        return np.vstack([self.surroundings, *(end for _, end in self.strings), *rows])

    @cached_property
    def plan(self) -> Plan:
        return (Board(tuple(s.shape for s in self.run.setup.surfaces if isinstance(s.shape, Segment))),)

    @property
    def strings(self) -> Sequence[tuple[str, tuple[float, float]]]:
        """The strings of a cradle."""
        up = self.parameters.strings
        return [(name, (x, up)) for name, x in zip(self.balls, hangs(self.parameters), strict=True)] if up else ()

    @property
    def moment(self) -> float:
        return self.story_end

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The blow, in its place or, where what moves lies over that in the end, beside it."""
        if self.met is None:
            return
        board = self._sums(sheet, self.met)
        if not self._covered(self.met, camera):
            self._blow(sheet.painter, camera, self.met)
            return
        top, right = board.bottom + 2 * sheet.gap, sheet.frame.right
        rect = pygame.Rect(board.left, top, right + sheet.gap - board.left, round(self.card_row) - 6 * sheet.gap - top)
        if rect.height < LEAST_BESIDE * self.unit:
            return
        sheet.painter.panel(rect, CARD["background"], CARD["opacity"], 10 * self.unit)
        title = sheet.write(
            f"the blow after {self.clock(self.met.t)}",
            "small",
            (rect.right - sheet.gap, rect.top + sheet.gap),
            CARD["quiet"],
            "topright",
        )
        inner = pygame.Rect(rect.left, title.bottom, rect.width, rect.bottom - title.bottom).inflate(-2 * sheet.gap, 0)
        sheet.surface.set_clip(inner)
        self._blow(sheet.painter, self._beside(self.met, inner), self.met)
        sheet.surface.set_clip(None)

    def _beside(self, met: Blow, rect: pygame.Rect) -> Camera:
        """Shows all whose velocity the blow changes, with room for the arrows, in a part of the picture (px)."""
        pair = [(np.array(met.before[name][:2]), self.radii[name]) for name in self._changed(met)]
        low, high = np.min([at - r for at, r in pair], axis=0), np.max([at + r for at, r in pair], axis=0)
        arrows = 1.5 * LONGEST * self.unit
        scale = min((rect.width - arrows) / (high[0] - low[0]), (rect.height - arrows) / (high[1] - low[1]))
        x, y = (low + high) / 2
        return Camera((float(x), float(y)), rect.center, max(float(scale), 1e-9))

    def _covered(self, met: Blow, camera: Camera) -> bool:
        """True if in the end anything lies over where the pair met, of more than one pair."""
        ends = {name: self.run.state(name, self.story_end)[:2] for name in self.balls}
        return len(self.balls) > 2 and any(
            np.hypot(*np.subtract(ends[name], met.before[one][:2])) < self.radii[name] + self.radii[one]
            for one in met.pair
            for name in self.balls
        )

    def _blow(self, painter: Painter, camera: Camera, met: Blow) -> None:
        """The line of action, along the normal where they touch, and the velocities that the blow changes, before
        (pale) and after it."""
        unit = self.unit
        touching = met.touching(met.before)
        point, normal = np.mean(touching.points, axis=0), np.array(touching.normal)
        a, b = (point + np.dot(met.before[name][:2] - point, normal) * normal for name in met.pair)
        line = [camera.pixel(*(at + way * (b - a))) for at, way in ((a, -1.2), (b, 1.2))]
        painter.dashes(line, 1.6 * unit, CARD["accent"], 7 * unit, 5 * unit)
        changed = self._changed(met)
        fastest = max(np.hypot(*velocity) for both in changed.values() for velocity in both)
        for name, (before, after) in changed.items():
            x, y = at = camera.pixel(*met.before[name][:2])
            self._outlined(painter, camera, name, met)
            for velocity, colour, width in ((before, COLOURS["before"], 3.0), (after, CARD["text"], 4.0)):
                along, up = velocity / fastest * LONGEST * unit
                if np.hypot(along, up) > 6 * unit:
                    painter.arrow(at, (x + along, y - up), width * unit, colour)

    def _changed(self, met: Blow) -> dict[str, list[np.ndarray]]:
        """The velocities in m/s before and after the blow of all that it changes."""
        speeds = {name: [np.array(states[name][2:4]) for states in (met.before, met.after)] for name in self.balls}
        fastest = max(np.hypot(*velocity) for both in speeds.values() for velocity in both)
        return {name: both for name, both in speeds.items() if np.hypot(*(both[1] - both[0])) >= 0.01 * fastest}

    def _outlined(self, painter: Painter, camera: Camera, name: str, met: Blow) -> None:
        """Draw the outline of a ball or body at the blow."""
        (x, y, *_, angle), body = met.before[name], next(ball for ball in self.run.setup.balls if ball.name == name)
        if not isinstance(body, Body):
            painter.ring(camera.pixel(x, y), body.radius * camera.scale, 1.5 * self.unit, self.colour_of(name))
            return
        c, s = cos(angle), sin(angle)
        rim = body.outline.rim(1e-3 * body.radius)
        corners = [camera.pixel(x + c * u - s * v, y + s * u + c * v) for u, v in [*rim, rim[0]]]
        painter.line(corners, 1.5 * self.unit, self.colour_of(name))

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        """Draw, where not all is round, the strip between the two that are nearest, or where they touch, and why."""
        if (between := strip(self.run, t)) is None:
            return
        painter.surface.set_clip(
            pygame.Rect(0, self.sheet.top_row, self.size[0], round(self.card_row) - self.sheet.top_row)
        )
        (gap, (nx, ny), points, _), unit, far = between.met, self.unit, 0.35 * self.size[1] / camera.scale
        for x, y in points:
            pair = [(x + half * nx, y + half * ny) for half in (0.5 * gap, -0.5 * gap)]
            if gap > TOUCH:
                for u, v in pair:
                    line = [camera.pixel(u - way * far * ny, v + way * far * nx) for way in (-1.0, 1.0)]
                    painter.dashes(line, 1.2 * unit, CARD["quiet"], 6 * unit, 6 * unit)
                painter.line([camera.pixel(*place) for place in pair], 2 * unit, CARD["accent"])
            for place in pair:
                painter.disc(camera.pixel(*place), 3.5 * unit, CARD["accent"])
        painter.surface.set_clip(None)
        spot = self.sheet.frame.right, self.card_row - 2 * self.sheet.gap, -1.0, -1.0
        self.sheet.chip(between.why, [spot])

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """Draw the exact run and, below it, those of rules at a fixed step until t in s, if there are any: outlines at
        even times, a tick under each exchange, and over each row its rule and, in the end, what came of it."""
        if not self.rows_of_rules:
            return
        hits = [event.t for event in self.run.events if event.kind == "impact"]
        self._row(painter, camera, t, "exact", "exchange at touch", hits, self._exact, 0.0)
        for name, each, below in self.rows_of_rules:
            times = [float(each.times[look]) for look in each.exchanges]
            self._row(painter, camera, t, name, RULES[name].label, times, each.at, below)
            for ball, (x, y) in zip(self.balls, each.at(t), strict=True):
                self.draw_ball(painter, camera, ball, 0.0, camera.pixel(x, y - below), self.radii[ball] * camera.scale)

    def remarks(self, camera: Camera) -> list[str]:
        it = self.parameters.stepping
        if it.step is None:
            return super().remarks(camera)
        looks = f"all but the exact way look every {it.step:g} s"
        if it.first > it.step:
            looks += f", first after {it.first:g} s"
        return [looks, "a tick at each exchange", f"outlines every {self.story_end / (OUTLINES - 1):.2g} s"]

    def _exact(self, t: float) -> np.ndarray:
        """The places in m of the balls of the exact run, shape (2, 2)."""
        return np.array([self.run.state(name, t)[:2] for name in self.balls])

    def _row(
        self,
        painter: Painter,
        camera: Camera,
        t: float,
        name: str,
        rule: str,
        exchanges: Sequence[float],
        at: Callable[[float], np.ndarray],
        below: float,
    ) -> None:
        """Draw all but the balls of one row: of a rule with exchanges at these times in s, ``below`` m down."""
        for moment in np.linspace(0.0, self.story_end, OUTLINES):
            for ball, (x, y) in zip(self.balls, at(moment), strict=True):
                if moment <= t:
                    spot, radius = camera.pixel(x, y - below), self.radii[ball] * camera.scale
                    painter.ring(spot, radius, 1.2 * self.unit, self.colour_of(ball), 0.6)
        (left, low), (_, high) = self.surroundings
        for moment in exchanges:
            x, y = camera.pixel(float(np.mean(at(moment)[:, 0])), low - below)
            if moment <= t:
                painter.line([(x, y + 3 * self.unit), (x, y + 12 * self.unit)], 1.6 * self.unit, CARD["accent"])
        words = f"{name}: {rule}"
        if t >= self.story_end:
            count, gap = self.run.result["exchanges"][name], self.run.result["gaps"][name]
            how = f"{metres(abs(gap))} {'apart' if gap >= 0.0 else 'deep'} at the end"
            words += f"; {'once' if count == 1 else f'{count} times'}, {how}"
        x, y = camera.pixel(left, high - below)
        frame, lettering = self.sheet.frame, self.sheet.lettering
        at_left = max(frame.left, min(x, frame.right - lettering.width(words, "small")))
        lettering.write(painter.surface, words, "small", (at_left, y - 3 * self.unit), CARD["text"], "bottomleft")

    def frame(self, t: float) -> pygame.Surface:
        """With the sums, from the blow on."""
        picture, met = super().frame(t), self.met
        if met is not None and t >= met.t:
            self._sums(self.sheet, met)
        return picture

    def _sums(self, sheet: Sheet, met: Blow) -> pygame.Rect:
        """The sums that have to stay, and where they are written."""
        small, right, room = sheet.lettering.height("small"), sheet.frame.right, BARS * self.size[0]
        sums = {what: [shares(self.run, states, what) for states in (met.before, met.after)] for what in AMOUNTS}
        sums["energy"][1].append(max(0.0, sum(sums["energy"][0]) - sum(sums["energy"][1])))  # what is lost
        largest = {what: max(map(abs, chain(*parts))) for what, parts in sums.items()}
        of_unit = {
            unit: max(largest[what] for what in sums if AMOUNTS[what][0] == unit) for unit, _ in AMOUNTS.values()
        }
        visible = [what for what in sums if largest[what] > 0.02 * of_unit[AMOUNTS[what][0]]]
        top = sheet.top_row + 1.5 * small
        visible = visible[: 1 + int(max(0.0, self.card_row - top - 2 * small) / (BLOCK * small))]
        tall = len(visible) * BLOCK * small
        board = pygame.Rect(round(right - room), round(top - 1.3 * small), round(room), round(tall + 0.2 * small))
        board = board.inflate(2 * sheet.gap, 0)
        sheet.painter.panel(board, CARD["background"], CARD["opacity"], 10 * self.unit)
        for i, what in enumerate(visible):
            unit, total = AMOUNTS[what][0], sum(sums[what][0])
            words = signed(f"{total if abs(total) > 1e-4 * largest[what] else 0.0:.3g}")
            self._bars(sheet, top + i * BLOCK * small, f"{what}: {words} {unit}", sums[what])
        return board

    def _bars(self, sheet: Sheet, top: float, title: str, sums: Sequence[Sequence[float]]) -> None:
        """Two bars of shares in the balls' colours, negative ones to the left, with a tick at their sum; what is lost
        comes last."""
        unit, right, small = self.unit, sheet.frame.right, sheet.lettering.height("small")
        room, thick, colours = (BARS - 0.06) * self.size[0], 0.8 * small, [*map(self.colour_of, self.balls)]
        least = min(float(np.minimum(parts, 0.0).sum()) for parts in sums)
        most = max(float(np.maximum(parts, 0.0).sum()) for parts in sums)
        scale, left = room / (most - least), right - room
        sheet.write(title, "small", (right, top), CARD["quiet"], "bottomright")
        for parts, word in zip(sums, ("before", "after"), strict=True):
            top += 0.3 * thick
            ends = [left - least * scale] * 2
            for part, colour in zip(parts, [*colours, COLOURS["lost"]], strict=False):
                start = ends[part > 0.0]
                ends[part > 0.0] = end = start + part * scale
                sheet.painter.polygon([(start, top), (end, top), (end, top + thick), (start, top + thick)], colour)
            total = left + (sum(parts) - least) * scale
            sheet.painter.line([(total, top), (total, top + thick + 3 * unit)], 2 * unit, CARD["accent"])
            sheet.write(word, "small", (left - 8 * unit, top + thick / 2), CARD["quiet"], "midright")
            top += thick
