"""The picture of a scene that has none of its own: surfaces, traps, balls and paths, as the setup has them."""

from __future__ import annotations

import numpy as np
import pygame

from sandbox.engine.model.surface import Circle, Segment
from sandbox.parameters import Group
from sandbox.picture.above import AboveView
from sandbox.picture.ball import Look, seams
from sandbox.picture.camera import Camera
from sandbox.picture.moving import THINNEST, draw_shape
from sandbox.picture.painter import Painter, Point, gradient
from sandbox.picture.palette import palette
from sandbox.picture.sheet import Sheet
from sandbox.picture.view import View

_COLOURS, _TRACES = palette("plain"), palette("trace")["colours"]
#: The looks of several balls, each in the colour of its path.
_SEVERAL = [Look(colour, seams(_COLOURS["marks"])) for colour in _TRACES]


#: Surfaces and traps that are named.
_MOST_NAMED = 8
#: The name of a segment stands at the first of these fractions of the part in sight where there is room.
_ALONG = (0.9, 0.1, 0.75, 0.25, 0.5)

#: Beside what is level and what is steep: the direction in px, and the part of the text that is there.
_LEVEL = ((0.0, 1.0, "midtop"), (0.0, -1.0, "midbottom"))
_STEEP = ((1.0, 0.0, "midleft"), (-1.0, 0.0, "midright"))


class Picture(AboveView[Group]):
    """One run, seen by a camera that stands still."""

    MIN_IMPACT = np.inf  # in a heap, marks would hide the balls
    SPIN_NAMES = View.SPIN_NAMES
    ON_DARK = False

    @property
    def solids(self) -> list[Segment | Circle]:
        """Traps are targets, and shown as well."""
        return [*super().solids, *(trap.shape for trap in self.run.setup.traps)]

    def look_of(self, name: str) -> Look:
        return self.LOOK if len(self.balls) == 1 else _SEVERAL[self.balls.index(name) % len(_SEVERAL)]

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """A light ground, and as a line or a disc every surface at rest and, paler, what takes balls."""
        painter.surface.blit(gradient(self.size, _COLOURS["ground"]), (0, 0))
        for trap in self.run.setup.traps:
            draw_shape(painter, camera, trap.shape, _COLOURS["catch"], self.unit)
        for surface in self.run.setup.surfaces:
            if surface.motion is None:
                draw_shape(painter, camera, surface.shape, _COLOURS["surface"], self.unit)

    def shadow(self, painter: Painter, camera: Camera, name: str, t: float, at: Point, radius: float) -> None:
        """On the plane that balls roll on; from the side there is none."""
        if self.run.setup.plane is not None:
            super().shadow(painter, camera, name, t, at, radius)

    def landmarks(self, sheet: Sheet, camera: Camera) -> None:
        """The names of surfaces and traps: of all where there are few, else of the first that were touched."""
        setup = self.run.setup
        named = {surface.name: surface.at(self.driven_moment).shape for surface in setup.surfaces}
        named |= {trap.name: trap.shape for trap in setup.traps}
        if len(named) > _MOST_NAMED:
            touched = dict.fromkeys(event.partner for event in self.run.events if event.partner in named)
            named = {name: named[name] for name in list(touched)[:_MOST_NAMED]}
        room = pygame.FRect(0, sheet.top_row, self.size[0], self.card_row - sheet.top_row)
        for name, shape in named.items():
            sheet.label(name, "small", self._spots(shape, camera, room), _COLOURS["surface"])

    def _spots(self, shape: Segment | Circle, camera: Camera, room: pygame.FRect) -> list[tuple[float, float, str]]:
        """Return spots for the name of a surface, beside the part of it that is in sight, in px."""
        off = max(shape.radius * camera.scale, THINNEST * self.unit) + 4 * self.unit
        a, b = (camera.pixel(*end) for end in shape.ends)
        seen = (a, b) if a == b else room.clipline(a, b)
        if not seen:
            return []
        (x0, y0), (x1, y1) = seen
        sides = _STEEP if abs(y1 - y0) > abs(x1 - x0) else _LEVEL
        places = [(x0 + part * (x1 - x0), y0 + part * (y1 - y0)) for part in _ALONG]
        beside = [(x + across * off, y + down * off, anchor) for x, y in places for across, down, anchor in sides]
        (left, left_y), (right, right_y) = sorted(seen)
        (top_x, top), (bottom_x, bottom) = sorted(seen, key=lambda end: end[1])
        level = [(left - off, left_y, "midright"), (right + off, right_y, "midleft")]
        steep = [(top_x, top - off, "midbottom"), (bottom_x, bottom + off, "midtop")]
        return [*beside, *(steep if sides is _STEEP else level)]
