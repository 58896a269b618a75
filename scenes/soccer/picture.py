"""Soccer from the side: the kick's path over the wall to the goal, on an evening under the lamps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import asin, pi

import numpy as np

from sandbox.engine.setup import Segment
from sandbox.picture.ball import Look, patches
from sandbox.picture.camera import Box, Camera
from sandbox.picture.depth import Eye
from sandbox.picture.figures import KICKING
from sandbox.picture.painter import Painter
from sandbox.picture.palette import mix, palette, scene_colours
from sandbox.picture.path import chip
from sandbox.picture.places import Ground, Group, Line, Person, Stands, Stripes, Thing, goal
from sandbox.picture.sheet import Sheet
from sandbox.picture.side import Length, Place, SideView
from sandbox.sport.amounts import metres, roughly, times

from .scene import Parameters

CARD, COLOURS = palette("card"), scene_colours(__file__)
BALL, PITCH = COLOURS["ball"], COLOURS["pitch"]

#: Room for the kicker behind the ball, and least height that is shown, in m.
KICKER, LEAST_TOP = 1.5, 2.7
#: Stripes as wide as the goal area is deep, lines, and what they bound (Laws of the Game, law 1), in m.
STRIPE, LINE = 5.5, 0.12
GOAL_WIDTH, GOAL_AREA, PENALTY_AREA, SPOT, CIRCLE = 7.32, (5.5, 18.32), (16.5, 40.32), 11.0, 9.15
PITCH_LENGTH, PITCH_WIDTH = 105.0, 68.0
#: How much smaller things look at the boards on the far side.
FAR = 0.38
#: Players of the wall stand so far apart, in m; they are this tall unless they jump or the wall is low.
PLAYERS, ABREAST, BEHIND, TALL, LEAST_TALL, HIGHEST = 4, 0.62, 0.5, 1.88, 1.55, 2.6
#: Goal and players are drawn larger where a goal of this height (m) would be less tall than this, px on 720 rows.
GOAL_HEIGHT, LEAST_HEIGHT = 2.44, 22


class Picture(SideView[Parameters]):
    """One kick."""

    LOOK = Look(BALL["colour"], patches(BALL["patch"]))
    TRACE, EARLIER = COLOURS["trace"], COLOURS["earlier"]
    FAINT = mix(TRACE, PITCH["grass"][0], 0.4)
    TRAIL = 0.6
    LEAST_IMPACT = 1.5
    LEVEL, ASIDE = 152, 0.2
    FROM = "from the kick"

    @cached_property
    def told(self) -> float:
        """A ball in the goal has come to the ground, any other has stopped."""
        if not self.run.result["goal"]:
            return self.run.duration
        flight = self.run.result["flight_time"]
        down = (e.t for e in self.run.events if e.kind == "impact" and e.partner == "ground" and e.t > flight)
        return next(down, self.run.duration)

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (self.parameters.goal.distance, 0.0), "the goal"

    @property
    def company(self) -> Box:
        return Box(-KICKER, 0.0, 0.0, LEAST_TOP)

    @property
    def target(self) -> Box:
        goal = self.parameters.goal
        return Box(goal.distance, 0.0, goal.distance + goal.depth, goal.height + 0.3 if goal.present else 0.0)

    @cached_property
    def place(self) -> Place:
        mouth, wall = self.parameters.goal, self.parameters.wall
        ground = Ground(
            Stripes(PITCH["grass"], STRIPE, mouth.distance),
            PITCH["soil"],
            edges=[(PITCH["edge"], 6)],
            lines=_markings(mouth.distance),
            line=(PITCH["line"], LINE),
            far=FAR,
            haze=PITCH["far"],
        )
        shapes = [surface.shape for surface in self.run.setup.surfaces if surface.name == "boards"]
        boards = [Boards(*shape.b) for shape in shapes if isinstance(shape, Segment)]
        size = mouth.distance, mouth.depth, mouth.height, GOAL_WIDTH, mouth.post_radius
        standing = [
            self._standing_at(mouth.distance, goal(*size, **COLOURS["goal"]) if mouth.present else []),
            self._standing_at(wall.distance, self._wall() if wall.present else []),
            self._standing_at(0.0, [Person(-0.62, 1.82, COLOURS["kicker"], KICKING)]),
        ]
        return Place(Stands(**COLOURS["stands"]), ground, [*boards, *standing])

    @staticmethod
    def _standing_at(x: float, things: Sequence[Thing]) -> Group:
        """Things that can be seen in the whole length of a pitch, too."""
        return Group(x, things, GOAL_HEIGHT, LEAST_HEIGHT)

    def _wall(self) -> list[Person]:
        """The wall of players, the nearest in the plane of play, the farther ones darker."""
        wall, shade = self.parameters.wall, COLOURS["stands"]["stands"][2]
        tall = min(wall.height, TALL) if LEAST_TALL <= wall.height <= HIGHEST else wall.height
        rows = max(1, round(wall.thickness / BEHIND))
        return [
            Person(
                wall.distance + (row - (rows - 1) / 2) * BEHIND,
                tall,
                {part: mix(colour, shade, 0.12 * i) for part, colour in COLOURS["wall"].items()},
                z=i * ABREAST,
                up=wall.height - tall,
                facing=-1,
            )
            for i in reversed(range(PLAYERS))
            for row in range(rows)
        ]

    def remarks(self, camera: Camera) -> list[str]:
        wall, goal, distance = self.parameters.wall.present, self.parameters.goal.present, self.parameters.goal.distance
        if not 0 < camera.pixel(distance, 0)[0] < self.size[0]:
            return [f"the goal is {roughly(distance)} away"]
        factor = self._standing_at(distance, ()).enlarged(self.eye(camera))
        who = "players and goal" if wall and goal else "goal" if goal else "players"
        return [f"{who} drawn {times(factor)} {'its' if who == 'goal' else 'their'} size"] if factor > 1 else []

    def lengths(self) -> list[Length]:
        goal, wall = self.parameters.goal, self.parameters.wall
        things = [("goal", goal.present, goal.distance), ("wall", wall.present, wall.distance)]
        return [Length(f"{name} {metres(far)}", 0.0, far) for name, present, far in things if present]

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """How far the ball passes over the heads and under or over the bar."""
        wall, goal, result = self.parameters.wall, self.parameters.goal, self.run.result
        if wall.present and result["height_at_wall"] is not None:
            low = result["height_at_wall"] - self.radius
            if low > wall.height:
                self._clearance(sheet, camera, wall.distance, wall.height, low, "over the wall")
        if goal.present and result["height_at_goal"] is not None:
            high, low = result["height_at_goal"] + self.radius, result["height_at_goal"] - self.radius
            if high < goal.height:
                self._clearance(sheet, camera, goal.distance, high, goal.height, "under the bar")
            elif low > goal.height:
                bar = goal.height + 2 * goal.post_radius
                self._clearance(sheet, camera, goal.distance, bar, low, "over the bar")

    def _clearance(self, sheet: Sheet, camera: Camera, x: float, low: float, high: float, text: str) -> None:
        """A stroke from one height to another at x, all in m, and how long it is."""
        unit = self.unit
        (px, top), (_, bottom) = camera.pixel(x, high), camera.pixel(x, low)
        if bottom - top > 3 * unit:
            sheet.painter.line([(px, top), (px, bottom)], 1.6 * unit, CARD["accent"])
            for y in (top, bottom):
                sheet.painter.line([(px - 4 * unit, y), (px + 4 * unit, y)], 1.6 * unit, CARD["accent"])
        path = self.trace[np.argmin(np.abs(self.trace[:, 0] - px))]
        spots = [
            (px + side * aside * unit, edge + way * far * unit, side * 0.7 if aside else 0.0, way)
            for far in (12, 20, 32, 46)
            for edge, way in ((min(top, path[1]), -1), (max(bottom, path[1]), 1))
            for aside, side in ((0, 0), (10, -1), (10, 1))
        ]
        chip(sheet, f"{metres(high - low)} {text}", spots, CARD["accent"])


@dataclass(frozen=True)
class Boards:
    """Advertising boards across the pitch at x, ``top`` m high, where a ball is out of play."""

    x: float
    top: float

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None:
        edges = np.linspace(0.0, eye.depth(FAR), 9)
        for i in reversed(range(0 if near else 8)):
            a, b = edges[i], edges[i + 1]
            corners = [(self.x, 0.0, a), (self.x, 0.0, b), (self.x, self.top, b), (self.x, self.top, a)]
            seen, colour = eye.points(np.array(corners)), COLOURS["stands"]["boards"][i * 3 % 4]
            if seen[:, 0].max() > 0 and seen[:, 0].min() < painter.surface.get_width():
                painter.polygon(seen, mix(colour, PITCH["far"], 0.25))


def _markings(end: float) -> list[Line]:
    """All lines of a pitch behind the plane of play, which passes by the near post of the goal at x = ``end``."""
    middle, start = GOAL_WIDTH / 2, end - PITCH_LENGTH
    far, half = middle + PITCH_WIDTH / 2, end - PITCH_LENGTH / 2
    turn = asin((PENALTY_AREA[0] - SPOT) / CIRCLE)
    turns = np.linspace(turn - pi / 2, pi / 2 - turn, 40)
    arc = [(end - SPOT - CIRCLE * np.cos(a), middle + CIRCLE * np.sin(a)) for a in turns]
    circle = [(half + CIRCLE * np.cos(a), middle + CIRCLE * np.sin(a)) for a in np.linspace(0, 2 * pi, 60)]
    lines: list[Line] = [[(end, 0.0), (end, far), (start, far), (start, 0.0)], arc, circle, [(half, 0.0), (half, far)]]
    for deep, wide in (GOAL_AREA, PENALTY_AREA):
        for line, way in ((end, -1), (start, 1)):
            side = middle + wide / 2
            lines.append([(line + way * deep, 0.0), (line + way * deep, side), (line, side)])
    return [[(x, z) for x, z in line if z >= -0.01] for line in lines]
