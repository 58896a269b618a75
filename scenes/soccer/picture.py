"""Soccer from the side: the kick's path over the wall to the goal, on an evening under the lamps."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import pairwise

import numpy as np

from sandbox.kit import (
    Box,
    Camera,
    Length,
    Look,
    Person,
    Place,
    Segment,
    Shape,
    Sheet,
    SideView,
    Stands,
    Story,
    courts,
    goal,
    metres,
    mix,
    patches,
    scene_colours,
    turf,
)
from sandbox.sport.sideways import GroundPlace

from .scene import Parameters, scored, track

COLOURS = scene_colours(__file__)
BALL, PITCH, BOARDS = COLOURS["ball"], COLOURS["pitch"], COLOURS["stands"]["boards"]

#: Widths in m: of a stripe, as wide as the goal area is deep, and of a line, the most that the Laws of the Game allow.
STRIPE, LINE = 5.5, 0.12
#: Room for the kicker behind the ball, and least height that is shown, in m.
KICKER, LEAST_TOP = 1.5, 2.7
#: The goal, whose near post is in the plane of play, is so wide (Laws of the Game, law 1), and boards so long, in m.
GOAL_WIDTH, BOARD = 7.32, 8.0
#: Boards are drawn if the ball comes so near to them, in m.
NEARBY = 20.0
#: Scale of things at the boards on the far side.
FAR = 0.38
#: Players of the wall stand so far apart, in m; they are this tall unless they jump or the wall is low.
PLAYERS, ABREAST, BEHIND, TALL, LEAST_TALL, HIGHEST = 4, 0.62, 0.5, 1.88, 1.55, 2.6


class Picture(SideView[Parameters]):
    """One kick."""

    LOOK = Look(BALL["colour"], patches(BALL["patch"]))
    TRACE, OTHER_TRACES = COLOURS["trace"], COLOURS["earlier"]
    FAINT_TRACE = mix(TRACE, PITCH["grass"][0], 0.4)
    TRAIL = 0.6
    MIN_IMPACT = 1.5
    EYE_HEIGHT, EYE_COLUMN = 152, 0.2
    MEASURED_FROM = "from the kick"

    @cached_property
    def story_end(self) -> float:
        """A ball in the goal has come to the ground, any other has stopped."""
        run, goal = self.run, scored(self.run, self.parameters)
        down = (event.t for event in run.events if event.kind == "impact" and event.partner == "ground")
        return run.duration if goal is None else next((t for t in down if t > goal), run.duration)

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (self.parameters.goal.distance, 0.0), "the goal"

    @property
    def must_be_visible(self) -> Box:
        return Box(-KICKER, 0.0, 0.0, LEAST_TOP)

    @property
    def aims(self) -> list[Box]:
        goal = self.parameters.goal
        return [Box(goal.distance, 0.0, goal.distance + goal.depth, goal.height)] if goal.present else []

    @property
    def story(self) -> Story:
        """The goal, the wall, or where the ball ends up."""
        wall = self.parameters.wall
        thick, there = 0.5 * wall.thickness, wall.present
        walls = [Box(wall.distance - thick, 0.0, wall.distance + thick, wall.height)] if there else []
        return self.meeting(*self.aims, *walls, share=0.5, spot=4.0)

    @property
    def preferred_view(self) -> Box:
        goal = self.parameters.goal
        return Box(goal.distance, 0.0, goal.distance + goal.depth, goal.height + 0.3 if goal.present else 0.0)

    @cached_property
    def place(self) -> Place:
        mouth, wall = self.parameters.goal, self.parameters.wall
        lines = courts.pitch_lines(mouth.distance, GOAL_WIDTH / 2)
        ground = turf(PITCH, STRIPE, 6, LINE, start=mouth.distance, lines=lines, far=FAR, haze=PITCH["far"])
        size = mouth.distance, mouth.depth, mouth.height, GOAL_WIDTH, mouth.post_radius
        standing = [
            *(goal(*size, **COLOURS["goal"]) if mouth.present else ()),
            *(self._wall() if wall.present else ()),
            Person(-0.62, 1.82, COLOURS["kicker"], "kicking", near=self._comes_back),
        ]
        return Place(Stands(**COLOURS["stands"]), ground, [*self._boards(), *standing])

    @property
    def _comes_back(self) -> bool:
        """True if the ball goes behind the kicker, who then stands before its path."""
        return bool(self.path.points[:, 0].min() < -1.0)

    def _boards(self) -> list[Shape]:
        """Advertising boards across the pitch, where a ball is out of play, if it comes near them."""
        far = self.points[:, 0].max()
        boards = (surface.shape for surface in self.run.setup.surfaces if surface.name == "boards")
        shapes = [shape for shape in boards if isinstance(shape, Segment) and shape.a[0] < far + NEARBY]
        drawn = (1.0 / FAR - 1.0) * self.size[0] / self.camera.scale  # to the boards on the far side
        across = max((GOAL_WIDTH + courts.PITCH_WIDTH) / 2, drawn)
        edges = np.arange(across, -BOARD, -BOARD).clip(0.0).tolist()
        return [
            Shape([(*low, near), (*low, far), (*top, far), (*top, near)], mix(BOARDS[i * 3 % 4], PITCH["far"], 0.25))
            for low, top in ((shape.a, shape.b) for shape in shapes)
            for i, (far, near) in enumerate(pairwise(edges))
        ]

    def _wall(self) -> list[Person]:
        """The wall of players, the nearest in the plane of play, the farther ones darker."""
        wall, shade = self.parameters.wall, COLOURS["stands"]["stands"][2]
        tall = min(wall.height, TALL) if LEAST_TALL <= wall.height <= HIGHEST else wall.height
        rows, up = max(1, round(wall.thickness / BEHIND)), wall.height - tall
        behind = [wall.distance + (row - (rows - 1) / 2) * BEHIND for row in range(rows)]
        darker = [{part: mix(ink, shade, 0.12 * i) for part, ink in COLOURS["wall"].items()} for i in range(PLAYERS)]
        spots = [(i, x) for i in reversed(range(PLAYERS)) for x in behind]
        return [Person(x, tall, darker[i], z=i * ABREAST, up=up, facing=-1) for i, x in spots]

    def lengths(self) -> list[Length]:
        goal, wall = self.parameters.goal, self.parameters.wall
        things = [("goal", goal.present, goal.distance), ("wall", wall.present, wall.distance)]
        return [Length(f"{name} {metres(far)}", 0.0, far) for name, present, far in things if present]

    @property
    def track(self) -> Sequence[GroundPlace]:
        return track(self.run, self.parameters)

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """Mark how far the ball passes over the heads and under or over the bar."""
        wall, goal, result = self.parameters.wall, self.parameters.goal, self.run.result
        over, under = result["over_wall"], result["under_bar"]
        if over is not None and over > 0.0:
            self.gap(sheet, camera, wall.distance, wall.height, wall.height + over, "over the wall")
        if under is not None and under > 0.0:
            self.gap(sheet, camera, goal.distance, goal.height - under, goal.height, "under the bar")
        elif under is not None and -under > 2 * self.radius:
            bar, low = goal.height + 2 * goal.post_radius, goal.height - under - 2 * self.radius
            self.gap(sheet, camera, goal.distance, bar, low, "over the bar")
