"""Curling from above: the sheet from hog line to back line, and the house from near by."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from sandbox.kit import (
    Box,
    Camera,
    Colour,
    LongView,
    Look,
    Mark,
    Painter,
    Story,
    near,
    plan,
    scene_colours,
)

from .scene import BACK, DELIVERED, HOG, RELEASE, RINGS, Parameters, team_of

COLOURS = scene_colours(__file__)
#: Widths of lines and boards, what is seen beyond the lines, and the width that is swept, in m.
LINE, HOG_LINE, BOARD, SPARE, BROOM = 0.013, 0.102, 0.12, 1.6, 0.55
HANDLE = Mark(COLOURS["handle"], lambda at: ((abs(at[..., 1]) < 0.13) & (abs(at[..., 0]) < 0.5)).astype(float))
LOOKS = {
    team: Look(COLOURS["granite"], Mark(COLOURS[team], near(np.array([(0.0, 0.0, 1.0)]), 0.8)), HANDLE, gloss=0.5)
    for team in ("red", "yellow")
}


class Picture(LongView[Parameters]):
    TRACE, OTHER_TRACES, CAVEAT = COLOURS["trace"], COLOURS["earlier"], "sweeping and blows not validated"
    datum = (0.0, 0.0), "the tee"
    lines = {"hog line": HOG, "tee line": 0.0}

    @property
    def aims(self) -> list[Box]:
        """The middle of the house."""
        return [Box(-RINGS[2], -RINGS[2], RINGS[2], RINGS[2])]

    @property
    def story(self) -> Story:
        """The house, as the stone comes to rest or meets another."""
        return Story(Box(-RINGS[0], -RINGS[0], RINGS[0], RINGS[0]), self.decided, 0.0)

    @property
    def whole(self) -> Box:
        side = 0.5 * self.parameters.width + BOARD
        return Box(RELEASE - SPARE, -side, BACK + SPARE, side)

    @property
    def near(self) -> Box:
        return Box(-RINGS[0] - 1.0, -RINGS[0] - 0.25, BACK + 0.55, RINGS[0] + 0.25)

    @cached_property
    def plan(self) -> plan.Plan:
        """Boards, ice, the house, the lines, the light, and who throws."""
        _, bottom, right, top = self.whole
        ends, launch = (RELEASE - 12.0, right), self.parameters.launch
        return (
            plan.Ground(Box(ends[0], bottom, right, top), COLOURS["board"]),
            plan.Stripes(Box(ends[0], bottom + BOARD, right, top - BOARD), COLOURS["ice"], 0.8, along=True),
            *(plan.Spot((0.0, 0.0), radius, colour) for radius, colour in zip(RINGS, COLOURS["rings"], strict=True)),
            *(plan.Line(((x, bottom), (x, top)), LINE, COLOURS["line"]) for x in (BACK, 0.0)),
            plan.Line(((ends[0], 0.0), (right, 0.0)), LINE, COLOURS["line"]),
            *(plan.Line(((x, bottom), (x, top)), HOG_LINE, COLOURS["hog"]) for x in (HOG, RELEASE)),
            *(plan.Worn((x, 0.15 * top), 2.6, 0.5 * top, COLOURS["lamp"], 0.4) for x in range(-26, 3, 7)),
            plan.Person((RELEASE, launch.aside), launch.angle, plan.Kit(**COLOURS["thrower"]), behind=0.6),
        )

    def look_of(self, name: str) -> Look:
        return LOOKS[team_of(name, self.parameters)]

    def colour_of(self, name: str) -> Colour:
        return self.TRACE if name == DELIVERED else COLOURS[team_of(name, self.parameters)]

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """Draw where it is swept: in front of the stone."""
        sweep, points = self.parameters.sweep, self.path.points
        swept = points[(points[:, 0] > sweep.start) & (points[:, 0] < sweep.end)]
        if len(swept) > 1:
            painter.line(self.traced(camera, swept), BROOM * camera.scale, COLOURS["swept"], 0.6)
