"""The view from above: a picture of a place that is seen from over its middle."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import ClassVar

import numpy as np
import pygame

from sandbox.picture.ball import Flat
from sandbox.picture.camera import Area, Camera
from sandbox.picture.moving import NOT_WORTH_NOTING
from sandbox.picture.painter import Painter, Point
from sandbox.picture.palette import Colour, palette
from sandbox.picture.places.plan import BREADTH, Person, Plan, draw_moving, drawn, dusk, enlarged
from sandbox.picture.sheet import Sheet
from sandbox.picture.view import P, View
from sandbox.sport.amounts import times

_CARD = palette("card")

#: Balls are lit from the left above, so their shadows lie to the right below; in radii.
_SHADOW = (0.4, 0.5)
#: The picture shows at least so many radii of the ball.
_LEAST = 10


class AboveView(View[P]):
    """One run seen from above; a scene declares its ``plan``."""

    SPIN_NAMES = ("right", "left")
    FROM_ABOVE = True
    #: True for a place that is longer along x: in a browser that is held upright, x points up.
    STANDS_UPRIGHT: ClassVar[bool] = False
    #: The colour of the darkness at the picture's edges.
    DUSK: ClassVar[Colour | None] = None
    #: True leaves that out, for a part that is put into another picture.
    lit = False

    @cached_property
    def plan(self) -> Plan:
        """The place: everything that stands still."""
        return ()

    @cached_property
    def must_show(self) -> np.ndarray:
        """Places in m that the poster must show, shape (n, 2): the paths, and the surfaces around them."""
        return self.surroundings

    @property
    def area(self) -> Area:
        """The part of the picture for all that must be seen, in px: over the scale bar."""
        aside, foot = 0.085 * self.size[0], self.sheet.lettering.height("small") + 3.4 * self.sheet.gap
        return Area(aside, self.sheet.top_row + 16 * self.unit, self.size[0] - aside, self.card_row - foot)

    @cached_property
    def camera(self) -> Camera:
        return self.fitted(self.area)

    def fitted(self, area: Area) -> Camera:
        """Shows all that must be seen in the middle of its area."""
        low, high = self.must_show.min(axis=0), self.must_show.max(axis=0)
        wide, tall = np.maximum(high - low, _LEAST * self.radius)
        scale = min((area.right - area.left) / wide, (area.bottom - area.top) / tall)
        x, y = (low + high) / 2
        return Camera((float(x), float(y)), area.middle, float(scale))

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """The place, darker to the edges."""
        if camera == self.camera:
            painter.surface.blit(drawn(self.plan, camera, self.size), (0, 0))
        else:
            draw_moving(painter.surface, self.plan, camera)
        if self.DUSK is not None and not self.lit:
            painter.surface.blit(dusk(self.size, self.DUSK), (0, 0))

    def shadow(self, painter: Painter, camera: Camera, name: str, t: float, at: Point, radius: float) -> None:
        """On the ground, to the right below a ball; a flat body lies on it."""
        if not isinstance(self.looks[name], Flat):
            below = at[0] + _SHADOW[0] * radius, at[1] + _SHADOW[1] * radius
            painter.shadow(below, 1.05 * radius, 0.95 * radius, _CARD["shadow"], 0.55)

    @property
    def people(self) -> list[Person]:
        """Those who stand still."""
        return [part for part in self.plan if isinstance(part, Person)]

    def remarks(self, camera: Camera) -> list[str]:
        factor = enlarged(camera, self.unit)
        return [f"players drawn {times(factor)} their size"] if self.people and factor > NOT_WORTH_NOTING else []

    def dimensions(self, sheet: Sheet, camera: Camera) -> None:
        """None; but no label goes to the headline or on the card, nor on a ball or a person."""
        reach = 0.8 * BREADTH * enlarged(camera, self.unit) * camera.scale
        places = [(person.place(camera, self.unit), reach) for person in self.people]
        self.keep_off(sheet, camera, sheet.top_row, places)

    def keep_off(self, sheet: Sheet, camera: Camera, top: int, spots: Sequence[tuple[Point, float]] = ()) -> None:
        """No label goes over the row ``top`` or on the card, nor on a ball or within so many px of these spots."""
        sheet.labels.take(pygame.Rect(0, 0, self.size[0], top))
        sheet.labels.take(pygame.Rect(0, round(self.card_row), *self.size))
        for (x, y), half in [*self._ball_places(camera, self.story_end).values(), *spots]:
            sheet.labels.take(pygame.Rect(round(x - half), round(y - half), round(2 * half), round(2 * half)))

    def scale(self, sheet: Sheet, camera: Camera) -> None:
        """A scale bar at the lower left."""
        sheet.scale_bar(camera, sheet.frame.left, self.card_row - 2 * sheet.gap, 0.3 * sheet.frame.width)
