"""The parts of a cluster: balls that may touch during one contact, and the links between them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf
from typing import Any, NamedTuple

from sandbox.engine.model.surface import BounceLaw


class ClusterBall(NamedTuple):
    """A ball at the start of the contact, in m, kg, s, rad."""

    mass: float
    radius: float
    inertia: float  # kg m^2
    position: tuple[float, float]
    velocity: tuple[float, float]
    spin: tuple[float, float, float]  # rad/s, about x, y and the axis out of the picture
    acceleration: tuple[float, float] = (0.0, 0.0)  # m/s^2, from other causes than the contacts
    room: float = inf  # m, by which it may move


class Link(NamedTuple):
    """Two balls that may touch, or a ball and a wall."""

    first: int
    second: int | None  # None for a wall
    stiffness: float  # N/m^1.5
    restitution: float
    law: BounceLaw  # of its friction
    approach: float = 0.0  # m/s, with which the law is called
    #: Gap (m), normal, and curvature (1/m) of the path along the wall, and more, of a ball at (x, y).
    wall: Callable[[float, float], Sequence[Any]] | None = None
