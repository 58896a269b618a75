"""Solids that a ball can strike: their response, and the room that they take up."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations, pairwise
from math import inf
from typing import Any, NamedTuple

from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Bounce, Circle, ConstantBounce, Segment, Surface
from sandbox.errors import RequestError
from sandbox.parameters import Group, quantity, walk
from sandbox.physics.elementwise import anywhere, maximum

#: The ground reaches so far to either side, in m.
_FAR = 25_000.0


def level(y: float = 0.0, reach: float = _FAR) -> Segment:
    """Level ground at a height in m, to either side farther than any ball gets."""
    return Segment((-reach, y), (reach, y))


def rectangle(left: float, bottom: float, right: float, top: float) -> list[Vector]:
    """The corners of a rectangle, once around it, in m."""
    return [(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)]


class Solid(Group):
    """A solid that a ball can strike."""

    restitution: float = quantity(..., "", 0, 1, "of the ball and this")
    friction: float = quantity(..., "", 0, 10, "of the ball and this")

    @property
    def bounce(self) -> ConstantBounce:
        """The bounce of two balls with these values."""
        return ConstantBounce(Bounce(self.restitution, self.friction))

    def surface(self, name: str, shape: Segment | Circle, **more: Any) -> Surface:
        """Its surface, of that shape."""
        return Surface(name, shape, self.restitution, self.friction, **more)

    def outline(self, name: str, corners: Sequence[Vector], **more: Any) -> list[Surface]:
        """Its surface along a line through the corners, in m."""
        return [self.surface(name, Segment(*ends), **more) for ends in pairwise(corners)]


class Extent(NamedTuple):
    """The room that something takes up: a rectangle in m, ``radius`` m larger all around; ``keys`` say where it is."""

    name: str
    keys: Sequence[str]
    left: float
    bottom: float
    right: float
    top: float
    radius: float = 0.0


def disc(name: str, keys: Sequence[str], x: float, y: float, radius: float) -> Extent:
    """The extent of a ball, or of a tube seen along its axis."""
    return Extent(name, keys, x, y, x, y, radius)


def below(name: str) -> Extent:
    """The extent of everything below 0 m."""
    return Extent(name, (), -inf, -inf, inf, 0.0)


def check_apart(parameters: Group, *extents: Extent) -> None:
    """Raise RequestError where two of them overlap, with the values of the keys that place them."""
    for one, other in combinations(extents, 2):
        across = maximum(one.left - other.right, other.left - one.right, 0.0)
        up = maximum(one.bottom - other.top, other.bottom - one.top, 0.0)
        if anywhere((across * across + up * up) ** 0.5 < one.radius + other.radius - 1e-9):
            keys = {*one.keys, *other.keys}
            where = ", ".join(f"{it.key} = {it.value:g} {it.unit}" for it in walk(parameters) if it.key in keys)
            raise RequestError(f"{where}: {one.name} and {other.name} overlap; move one of them")
