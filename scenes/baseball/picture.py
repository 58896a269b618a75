"""Baseball from the side: the ball park on a summer's day, and the fence."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

from sandbox.kit import (
    Box,
    Camera,
    Landscape,
    Length,
    Look,
    Person,
    Place,
    Post,
    Shape,
    Sheet,
    SideView,
    Story,
    in_two_units,
    passing,
    scene_colours,
    seams,
    turf,
)
from sandbox.sport.sideways import GroundPlace

from .scene import Parameters, track

COLOURS = scene_colours(__file__)
FIELD = COLOURS["field"]
INFIELD, TRACK, DEEP, POLE = 44.0, 4.6, 60.0, 9.0  # m: dirt, warning track, length of fence, pole above it


class Picture(SideView[Parameters]):
    LOOK = Look(COLOURS["ball"]["colour"], seams(COLOURS["ball"]["seam"]))
    TRACE, OTHER_TRACES, ON_DARK = COLOURS["trace"], COLOURS["earlier"], False
    LENGTH_ROWS, SECOND_UNIT, MEASURED_FROM, EYE_HEIGHT, EYE_COLUMN = 1, "ft", "from the plate", 90, 0.4

    @cached_property
    def story_end(self) -> float:
        """A ball that hits the fence is told until then."""
        passed, gap = passing(self.run, self.parameters.fence.distance), self.run.result["over_fence"]
        return passed.t if passed is not None and gap <= 0.0 else self.run.duration

    @property
    def aims(self) -> list[Box]:
        fence = self.parameters.fence
        return [Box(fence.distance - 0.5, 0.0, fence.distance + 0.5, fence.height)]

    @property
    def story(self) -> Story:
        """The fence with its pole where the ball passes it, or where it comes down."""
        fence = self.parameters.fence
        passed = passing(self.run, fence.distance)
        wall = Box(fence.distance - 0.5, 0.0, fence.distance + 0.5, fence.height + POLE)
        return self.meeting(wall, share=0.5, spot=4.0, at=None if passed is None else passed.t)

    @property
    def preferred_view(self) -> Box:
        fence = self.parameters.fence
        return Box(-4.0, 0.0, fence.distance + 2.0, fence.height)

    @cached_property
    def place(self) -> Place:
        foot, high = self.parameters.fence.distance, self.parameters.fence.height
        dirt = [(-6.0, 0.0), (INFIELD, 0.0), (0.7 * INFIELD, INFIELD), (-6.0, INFIELD)]
        track = [(foot - TRACK, 0.0), (foot, 0.0), (foot, DEEP), (foot - TRACK, DEEP)]
        ground = turf(FIELD, 8.0, 6, areas=[(dirt, FIELD["infield"]), (track, FIELD["track"])])
        corners = [(foot, 0.0, 0.0), (foot, high, 0.0), (foot, high, DEEP), (foot, 0.0, DEEP)]
        wall, batter = Shape(corners, COLOURS["fence"]["wall"]), Person(0.0, 1.85, COLOURS["batter"], "batting")
        pole = Post([(foot, 0.0, 0.0), (foot, high + POLE, 0.0)], 0.1, COLOURS["fence"]["pole"])
        return Place(Landscape(**COLOURS["landscape"]), ground, [wall, pole, batter])

    @property
    def track(self) -> Sequence[GroundPlace]:
        return track(self.run, self.parameters)

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        fence, over = self.parameters.fence, self.run.result["over_fence"]
        if over is not None and over > 0.0:
            self.gap(sheet, camera, fence.distance, fence.height, fence.height + over, "over the fence")

    def lengths(self) -> list[Length]:
        far = self.parameters.fence.distance
        return [Length(f"fence {in_two_units(far, 'ft')}", 0.0, far)]
