"""Soccer from above: how far the kick bends from its straight line, round the wall and past the keeper."""

from __future__ import annotations

from functools import cached_property
from math import atan2, cos, degrees, hypot, radians, sin, tan

import numpy as np
import pygame

from sandbox.picture.above import AboveView
from sandbox.picture.camera import Camera
from sandbox.picture.painter import Painter
from sandbox.picture.palette import mix, palette
from sandbox.picture.path import chip
from sandbox.picture.places.plan import BREADTH, Person, Plan, enlarged
from sandbox.picture.sheet import Entry, Sheet
from sandbox.sport.amounts import metres, times

from .pitch import BALL, COLOURS, KEEPER, pitch
from .scene import Parameters

CARD = palette("card")

#: Room for the kicker behind the ball, and beside each post, in m.
KICKER, ASIDE = 1.3, 0.4
#: The poster follows a ball that was stopped for so long, in s.
AFTERMATH = 0.6
#: The time between balls is chosen for the flight, or for this share of the whole path.
LEAST_SPAN = 0.6


class Picture(AboveView[Parameters]):
    """One kick, seen by a camera that stays near the ball."""

    LOOK, TRACE, EARLIER = BALL, COLOURS["trace"], COLOURS["earlier"]
    FAINT = mix(COLOURS["trace"], COLOURS["grass"][0], 0.3)
    TRAIL, NEAREST, DUSK = 0.4, 34.0, COLOURS["dusk"]

    @property
    def balls(self) -> list[str]:
        return ["ball"]

    @cached_property
    def told(self) -> float:
        if self.run.result["goal"]:
            return self.run.duration
        touched = next((e.t for e in self.run.events if "ball" in (e.ball, e.partner)), self.run.duration)
        return min(self.run.duration, touched + AFTERMATH)

    @cached_property
    def span(self) -> float:
        return max(self.run.result["flight_time"] or 0.0, LEAST_SPAN * self.told)

    @property
    def moment(self) -> float:
        """When the ball is at the goal line or touched."""
        t = self.run.result["flight_time"]
        return self.run.duration if t is None else t

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (self.parameters.goal.distance, self.parameters.goal.offset), "the goal"

    # The place

    @cached_property
    def plan(self) -> Plan:
        return pitch(self.parameters)

    @cached_property
    def seen(self) -> np.ndarray:
        """The paths, the kicker, the goal, and where the straight line meets the goal line."""
        goal = self.parameters.goal
        half, back = goal.width / 2 + ASIDE, goal.distance + goal.depth
        corners = [(-KICKER, 0.0), (back, goal.offset - half), (back, goal.offset + half)]
        return np.concatenate([self.points, corners, [self.straight] if self.straight else np.empty((0, 2))])

    def remarks(self, camera: Camera) -> list[str]:
        factor = enlarged(camera, self.unit)
        return [f"players drawn {times(factor)} their size"] if factor > 1 else []

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """Where the ball would have gone without spin, and the keeper."""
        self._straight_line(painter, camera, t)
        keeper = self.parameters.keeper
        if not keeper.present:
            return
        start, at = (self.run.state("keeper", moment)[:2] for moment in (0.0, t))
        colour, reach, thin = KEEPER.shirt, keeper.radius * camera.scale, max(1.0, 1.2 * self.unit)
        if hypot(at[0] - start[0], at[1] - start[1]) * camera.scale > 4 * self.unit:
            way = [camera.pixel(*start), camera.pixel(*at)]
            painter.dashes(way, thin, colour, 4 * self.unit, 5 * self.unit, 0.6)
            painter.ring(way[0], reach, thin, colour, 0.5)
        painter.disc(camera.pixel(*at), reach, colour, 0.25)
        painter.ring(camera.pixel(*at), reach, thin, colour, 0.7)
        Person(at, 180.0, KEEPER, min(BREADTH, 1.25 * keeper.radius), arms=keeper.radius).draw(painter, camera)

    # How far it bends

    @cached_property
    def straight(self) -> tuple[float, float] | None:
        """Where the straight line of the launch meets the goal line, in m; None where the ball does not get there."""
        angle, line = self.parameters.launch.angle, self.parameters.goal.distance
        if abs(angle) >= 89.0 or self.run.result["deviation"] is None:
            return None
        return line, line * tan(radians(angle))

    def _straight_line(self, painter: Painter, camera: Camera, t: float) -> None:
        """To the goal line once the ball is there, and until then as far as the ball is."""
        points = camera.pixels(np.array([(0.0, 0.0), self._without_spin(t)]))
        if np.hypot(*(points[1] - points[0])) > 20 * self.unit:
            colour = mix(COLOURS["straight"], COLOURS["grass"][0], 0.4)
            painter.dashed_thread(points, 1.4 * self.unit, colour, 7 * self.unit, 6 * self.unit)

    def _without_spin(self, t: float) -> tuple[float, float]:
        if self.straight is not None and t >= self.moment:
            return self.straight
        far, angle = hypot(*self.run.state("ball", t)[:2]), radians(self.parameters.launch.angle)
        return far * cos(angle), far * sin(angle)

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """How far from its straight line the ball comes to the goal line."""
        if self.parameters.keeper.present:
            (x, y), reach = camera.pixel(*self.run.state("keeper", self.moment)[:2]), self.parameters.keeper.radius
            half = round(reach * camera.scale)
            sheet.labels.take(pygame.Rect(round(x) - half, round(y) - half, 2 * half, 2 * half))
        line = np.linspace(camera.pixel(0.0, 0.0), camera.pixel(*self._without_spin(self.moment)), 80)
        sheet.labels.take_path(line, 2 * self.unit)
        deviation = self.run.result["deviation"]
        if self.straight is None or deviation is None:
            return
        unit, accent = self.unit, CARD["accent"]
        start = camera.pixel(*self.straight)
        end = camera.pixel(self.straight[0], self.straight[1] + deviation)
        if abs(end[1] - start[1]) > 12 * unit:
            sheet.painter.arrow(start, end, 2.6 * unit, accent)
        sheet.painter.line([(start[0] - 6 * unit, start[1]), (start[0] + 6 * unit, start[1])], 2.0 * unit, accent)
        sheet.labels.take_path(np.linspace(start, end, 30), 3 * unit)
        way = 1.0 if end[1] < start[1] else -1.0
        spots = [(start[0], start[1] + way * far * unit, 0.0, way) for far in (12, 20)]
        spots += [
            (start[0] + side * far * unit, start[1] + (end[1] - start[1]) * share, side, 0.0)
            for far in (14, 24, 40)
            for share in (0.0, 0.25, 0.5, 0.75)
            for side in (1.0, -1.0)
        ]
        chip(sheet, f"{metres(abs(deviation))} to the {_side(deviation)}", spots, accent)
        beside = [
            (line[round(79 * share), 0], line[round(79 * share), 1] + way * far * unit)
            for share in (0.62, 0.5, 0.75, 0.38)
            for far in (10, 16, 24)
        ]
        anchor = "midtop" if way > 0 else "midbottom"
        sheet.label("without spin", "small", [(*spot, anchor) for spot in beside], sheet.ink)

    # Frames

    def progress(self, t: float) -> tuple[str, str]:
        away = self.parameters.goal.distance - self.run.state("ball", t)[0]
        return metres(abs(away)), "to the goal line" if away >= 0 else "behind the goal line"

    def live(self, t: float) -> list[Entry]:
        """What a frame's card says at time t in s."""
        x, y, vx, vy, spin = self.run.state("ball", t)
        angle, speed = radians(self.parameters.launch.angle), hypot(vx, vy)
        aside = y * cos(angle) - x * sin(angle)
        return [
            ("time", f"{t:.2f} s"),
            ("off the straight", f"{metres(abs(aside))} {_side(aside)}" if abs(aside) >= 0.005 else "–"),
            ("speed", f"{speed:.1f} m/s"),
            ("direction", f"{abs(degrees(atan2(vy, vx))):.0f}° {_side(vy)}" if speed > 0.01 else "–"),
            ("spin", self.spin_text(spin)),
            *self.vectors.entries(t),
        ]


def _side(amount: float) -> str:
    return "right" if amount < 0.0 else "left"
