"""Putting from above: the green with its contour lines and arrows downhill, the line of the stroke, and the hole."""

from __future__ import annotations

from functools import cached_property
from math import cos, hypot, sin

import numpy as np

from sandbox.kit import DEGREE, AboveView, Area, Box, Camera, Look, Relief, Story, amount, plan, scene_colours, seams
from sandbox.sport.putting import PERCENT

from .scene import Parameters

COLOURS = scene_colours(__file__)
#: So much of the green is seen around ball and hole, at most beyond the hole, and drawn, in m.
AROUND, BEYOND, GREEN = 0.45, 2.5, 6.0


class Picture(AboveView[Parameters]):
    LOOK, TRACE, OTHER_TRACES = Look(COLOURS["ball"], seams(COLOURS["seam"])), COLOURS["trace"], COLOURS["earlier"]
    CAVEAT, ON_DARK, DUSK = "lip-outs keep their motion", True, COLOURS["dusk"]
    STANDS_UPRIGHT = True

    @property
    def area(self) -> Area:
        """As wide as the picture: a putt is long."""
        side = 0.03 * self.size[0]
        return super().area._replace(left=side, right=self.size[0] - side)

    @property
    def datum(self) -> tuple[tuple[float, float], str]:
        return (0.0, 0.0), "the hole"

    @property
    def aims(self) -> list[Box]:
        """The hole."""
        radius = self.parameters.hole.radius
        return [Box(-radius, -radius, radius, radius)]

    @property
    def story(self) -> Story:
        """The hole, or where the ball ends up."""
        return self.meeting(*self.aims, share=0.22, spot=0.4)

    @cached_property
    def must_show(self) -> np.ndarray:
        """Ball and hole, and the path as far as it is near them."""
        it = self.parameters
        far = hypot(it.ball.x, it.ball.y) + BEYOND
        near = self.points[np.hypot(*self.points.T) < far]
        places = np.concatenate([near, [(it.ball.x, it.ball.y), (0.0, 0.0)]])
        return np.array([places.min(axis=0) - AROUND, places.max(axis=0) + AROUND])

    def position_of(self, name: str, t: float) -> tuple[float, float]:
        """A ball that the hole has caught lies in its middle."""
        return (0.0, 0.0) if t >= self.caught[name] else super().position_of(name, t)

    @cached_property
    def relief(self) -> Relief:
        """The slope of the green around ball and hole."""
        green, (low, high) = self.parameters.green, self.must_show
        seen, box = Box(*low.tolist(), *high.tolist()), Box(*(low - GREEN).tolist(), *(high + GREEN).tolist())
        along, across, twist = (PERCENT * rise for rise in (green.grade, green.cross, green.twist))
        colours = COLOURS["low"], COLOURS["high"]
        return Relief(box, seen, along, across, twist, colours, COLOURS["contour"], COLOURS["arrow"])

    @cached_property
    def plan(self) -> plan.Plan:
        """The parts of the place, the lowest first."""
        it, radius = self.parameters, self.parameters.hole.radius
        ball, turn = (it.ball.x, it.ball.y), it.launch.angle * DEGREE
        far = hypot(*ball)
        line = ball, (ball[0] + far * cos(turn), ball[1] + far * sin(turn))
        return (
            self.relief,
            plan.Line(line, 0.008, COLOURS["aim"]),
            plan.Spot(ball, 1.6 * it.ball.radius, COLOURS["aim"], 0.006),
            plan.Spot((0.0, 0.0), radius + 0.004, COLOURS["rim"], 0.01),
            plan.Spot((0.0, 0.0), radius - 0.004, COLOURS["hole"]),
        )

    def remarks(self, camera: Camera) -> list[str]:
        slopes = [f"contours every {amount(self.relief.step, 'm')} of height"] if self.relief.slopes else []
        return [*super().remarks(camera), *slopes]
