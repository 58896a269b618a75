"""Shot put from the side: circle, stop board and sector in a stadium."""

from __future__ import annotations

from functools import cached_property

from sandbox.kit import (
    Box,
    Length,
    Look,
    Person,
    Place,
    Post,
    Shape,
    SideView,
    Stands,
    Story,
    scene_colours,
    turf,
)

from .scene import THROWN, Parameters

COLOURS = scene_colours(__file__)
FIELD = COLOURS["field"]
CIRCLE, BOARD, SLOPE, EVERY = 2.135, 0.10, 0.35, 5.0  # m, m, half the sector's width over its length, m between lines
UP = 1.20  # of the hand, in heights of the athlete


class Picture(SideView[Parameters]):
    LOOK = Look(COLOURS["ball"], gloss=0.45)  # smooth iron
    TRACE, OTHER_TRACES = COLOURS["trace"], COLOURS["earlier"]
    LENGTH_ROWS, SECOND_UNIT, MEASURED_FROM = 1, "ft", "from the board"

    @property
    def aims(self) -> list[Box]:
        """The mark."""
        return [Box(self.parameters.record - 0.1, 0.0, self.parameters.record + 0.4, 0.9)]

    @property
    def story(self) -> Story:
        """The mark, or where the shot comes down."""
        return self.meeting(*self.aims, share=0.3, spot=1.5)

    @property
    def preferred_view(self) -> Box:
        return Box(-CIRCLE - 0.3, 0.0, self.parameters.record + 1.5, 2.5)

    @cached_property
    def place(self) -> Place:
        release, record = self.parameters.release, self.parameters.record
        tall = min(1.95, release.height / UP)
        count = int((record + EVERY) / EVERY) + 1
        arcs = [[(i * EVERY, 0.0), (i * EVERY, 2.0 * SLOPE * i * EVERY)] for i in range(1, count + 1)]
        end = count * EVERY
        circle = [(-CIRCLE, 0.0), (0.0, 0.0), (0.0, 1.2), (-CIRCLE, 1.2)]
        sides = [[(0.0, 0.0), (end, slope * end)] for slope in (0.0, 2.0 * SLOPE)]
        ground = turf(FIELD, 2.5, areas=[(circle, FIELD["circle"])], lines=[*arcs, *sides])
        board = Shape([(0.0, 0.0, 0.0), (0.11, 0.0, 0.0), (0.11, BOARD, 0.0), (0.0, BOARD, 0.0)], FIELD["board"])
        flag = Post([(record, 0.0, 0.0), (record, 0.9, 0.0)], 0.03, FIELD["mark"])
        athlete = Person(release.place - 0.165 * tall, tall, COLOURS["athlete"], "reaching")
        return Place(Stands(**COLOURS["stands"]), ground, [flag, board, athlete])

    def lengths(self) -> list[Length]:
        return [Length(f"mark {THROWN.text(self.parameters.record)}", 0.0, self.parameters.record)]
