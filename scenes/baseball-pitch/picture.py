"""A pitch from the side: mound, batter, catcher, and the strike zone over the plate."""

from __future__ import annotations

from functools import cached_property

from sandbox.kit import (
    Box,
    Landscape,
    Length,
    Person,
    Place,
    Post,
    Shape,
    SideView,
    Story,
    Thing,
    metres,
    palette,
    turf,
)

from ..baseball.picture import COLOURS, FIELD
from ..baseball.picture import Picture as FlyBall
from .scene import MITT, Parameters

DEEP, WIDE, TALL, ZONE = 0.43, 0.43, 1.88, palette("card")["accent"]  # m: home plate (Official Baseball Rules, 2.02)


class Picture(SideView[Parameters]):
    LOOK, TRACE, OTHER_TRACES = FlyBall.LOOK, FlyBall.TRACE, FlyBall.OTHER_TRACES
    ON_DARK = False
    LENGTH_ROWS, SECOND_UNIT, MEASURED_FROM, EYE_COLUMN = 1, "ft", "from the hand", 0.6

    @property
    def aims(self) -> list[Box]:
        plate = self.parameters.plate
        return [Box(plate.distance, plate.bottom, plate.distance + DEEP, plate.top)]

    @property
    def story(self) -> Story:
        """The zone, or where the ball passes the plate."""
        return self.meeting(*self.aims, share=0.3, spot=1.0)

    @property
    def preferred_view(self) -> Box:
        return Box(-1.2, 0.0, self.parameters.plate.distance + MITT + 0.8, 2.6)

    @cached_property
    def place(self) -> Place:
        plate, release = self.parameters.plate, self.parameters.release
        front, low, high = plate.distance, plate.bottom, plate.top
        dirt = [[(front - 3.2, 0.0), (front + 3.0, 0.0), (front + 3.0, 3.0), (front - 3.2, 3.0)]]
        dirt.append([(-3.0, 0.0), (2.2, 0.0), (1.6, 2.6), (-2.6, 2.6)])
        base = [(front, 0.0), (front + DEEP, 0.0), (front + DEEP, WIDE), (front, WIDE)]
        areas = [*((area, FIELD["infield"]) for area in dirt), (base, FIELD["line"])]
        ground = turf(FIELD, 2.0, 6, areas=areas)
        corners = [(front, low, 0.0), (front + DEEP, low, 0.0), (front + DEEP, high, 0.0), (front, high, 0.0)]
        zone: list[Thing] = [Shape(corners, ZONE, 0.25), Post([*corners, corners[0]], 0.012, ZONE)]
        pitcher = Person.holding((release.place, release.height), "pitching", COLOURS["batter"], shortest=1.6)
        batter = Person(front + 0.1, TALL, COLOURS["visitor"], "batting", z=0.9, facing=-1)
        catcher = Person(front + MITT + 0.35, TALL, COLOURS["batter"], "crouching", facing=-1)
        return Place(Landscape(**COLOURS["landscape"]), ground, [batter, *zone, catcher, pitcher])

    def closeup_boxes(self) -> list[Box]:
        """The zone, with batter and catcher."""
        front = self.parameters.plate.distance
        return [Box(front - 2.6, -0.1, front + MITT + 1.0, TALL + 0.2)]

    def lengths(self) -> list[Length]:
        return [Length(f"plate {metres(self.parameters.plate.distance)}", 0.0, self.parameters.plate.distance)]
