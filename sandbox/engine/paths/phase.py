"""The phases of a ball's motion, and the public form of its contact along an arc."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Protocol

from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Surface


class Phase(Enum):
    """The motion of a ball or body along an arc."""

    FREE = ""
    """It flies, or moves on a plane seen from above."""

    SLIDING = "sliding"
    """It slides on a surface."""

    ROLLING = "rolling"
    """It rolls on a surface, or a body turns about a point on it."""

    PINNED = "pinned"
    """It spins in place, wedged between two surfaces."""

    RESTING = "resting"
    """It rests on a surface."""

    CLUSTER = "cluster"
    """It is in a simulated contact with other balls."""

    HEAP = "heap"
    """It lies on or under others."""


class ArcContact(Protocol):
    """The contact of a ball along an arc: a SustainedContact or one on a point, Leaning, or one of those below, which
    differ from an arc without a contact in what they define."""

    @property
    def phase(self) -> Phase:
        """The phase of the motion."""
        return Phase.FREE

    @property
    def surface(self) -> Surface | None:
        """The surface that it slides, rolls or rests on."""
        return None

    @property
    def span(self) -> tuple[float, float] | None:
        """Begin and end in s of a simulated contact with others."""
        return None

    @property
    def drift(self) -> Vector:
        """The velocity in m/s by position correction in a heap, which is no part of the ball's own."""
        return 0.0, 0.0


@dataclass(frozen=True)
class SetByHand(ArcContact):
    """Value of ``Arc.contact`` at an instant in which a ball's state is changed from outside."""


@dataclass(frozen=True)
class InCluster(ArcContact):
    """Value of ``Arc.contact`` for a ball in a simulated contact with others: when that begins and ends, in s."""

    start: float
    end: float

    @property
    def phase(self) -> Phase:
        return Phase.CLUSTER

    @property
    def span(self) -> tuple[float, float]:
        return self.start, self.end


@dataclass(frozen=True)
class InHeap(ArcContact):
    """Value of ``Arc.contact`` for a ball in a heap: how fast position correction moves it along the arc, in m/s; that
    is no part of its velocity."""

    vx: float = 0.0
    vy: float = 0.0

    @property
    def phase(self) -> Phase:
        return Phase.HEAP

    @property
    def drift(self) -> Vector:
        return self.vx, self.vy
