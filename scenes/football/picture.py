"""Football from the side: the field with a line every five yards, bar and uprights, and the stands."""

from __future__ import annotations

from functools import cached_property

from sandbox.kit import (
    Box,
    Length,
    Look,
    Person,
    Place,
    Post,
    SideView,
    Stands,
    Story,
    metres,
    scene_colours,
    turf,
)

from .scene import Parameters

COLOURS = scene_colours(__file__)
FIELD, YARD = COLOURS["field"], 0.9144
UPRIGHT, APART, TALL, DEEP = 10.67, 5.64, 1.85, 48.8  # m: above the bar and between the uprights (NFL), kicker, field


class Picture(SideView[Parameters]):
    LOOK = Look(COLOURS["ball"])
    TRACE, OTHER_TRACES = COLOURS["trace"], COLOURS["earlier"]
    LENGTH_ROWS, MEASURED_FROM, THING, CAVEAT = 1, "from the kick", "ball", "not validated"

    @property
    def story(self) -> Story:
        """Bar and uprights, or where the ball comes down."""
        return self.meeting(*self.aims, share=0.6, spot=4.0)

    @property
    def must_be_visible(self) -> Box:
        return Box(-2.0, 0.0, 0.0, 2.2)

    @property
    def aims(self) -> list[Box]:
        goal = self.parameters.goal
        return [Box(goal.distance - 1.5, 0.0, goal.distance + 2.0, goal.height + UPRIGHT)] if goal.present else []

    @property
    def preferred_view(self) -> Box | None:
        goal = self.parameters.goal
        return Box(goal.distance, 0.0, goal.distance + 3.0, goal.height + 3.0) if goal.present else None

    @cached_property
    def place(self) -> Place:
        goal, end = self.parameters.goal, float(self.points[:, 0].max()) + 20.0
        count = int(end / (5.0 * YARD)) + 2
        lines = [[(5.0 * YARD * i, 0.0), (5.0 * YARD * i, DEEP)] for i in range(-3, count)]
        ground = turf(FIELD, 10.0 * YARD, line=0.1, lines=lines)
        kicker, things = Person(-0.7, TALL, COLOURS["kicker"], "kicking"), []
        if goal.present:
            x, bar = goal.distance, goal.height
            ends = [(x, bar, -0.5 * APART), (x, bar, 0.5 * APART)]
            foot = [(x + 2.0, 0.0, 0.0), (x + 2.0, 0.5 * bar, 0.0), (x, bar, 0.0)]
            uprights = [[end, (x, bar + UPRIGHT, end[2])] for end in ends]
            things = [Post(points, 0.06, FIELD["post"]) for points in (foot, ends, *uprights)]
        return Place(Stands(**COLOURS["stands"]), ground, [*things, kicker])

    def lengths(self) -> list[Length]:
        goal = self.parameters.goal
        return [Length(f"bar {metres(goal.distance)}", 0.0, goal.distance)] if goal.present else []
