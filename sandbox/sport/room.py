"""Room at the start: nothing may lie in anything else, and what does is refused by the keys that place it."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from math import hypot, inf
from typing import NamedTuple

from sandbox.errors import RequestError
from sandbox.parameters import Group, walk


class Solid(NamedTuple):
    """What takes up room: a rectangle in m, ``radius`` m larger all around; ``keys`` say where it is."""

    name: str
    keys: Sequence[str]
    left: float
    bottom: float
    right: float
    top: float
    radius: float = 0.0


def disc(name: str, keys: Sequence[str], x: float, y: float, radius: float) -> Solid:
    """A ball, or a tube seen along its axis."""
    return Solid(name, keys, x, y, x, y, radius)


def ground(name: str) -> Solid:
    """Everything below 0 m."""
    return Solid(name, (), -inf, -inf, inf, 0.0)


def check_room(parameters: Group, solids: Sequence[Solid]) -> None:
    """Raise RequestError where two of the solids overlap, with the values of the keys that place them."""
    for one, other in combinations(solids, 2):
        across = max(one.left - other.right, other.left - one.right, 0.0)
        up = max(one.bottom - other.top, other.bottom - one.top, 0.0)
        if hypot(across, up) < one.radius + other.radius - 1e-9:
            keys = {*one.keys, *other.keys}
            where = ", ".join(f"{it.key} = {it.value:g} {it.unit}" for it in walk(parameters) if it.key in keys)
            raise RequestError(f"{where}: {one.name} and {other.name} overlap; move one of them")
