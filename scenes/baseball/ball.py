"""The baseball and its models, from the side: hit or pitched."""

from __future__ import annotations

from typing import Literal

from sandbox.engine.setup import SOLID_SPHERE
from sandbox.parameters import choice, group, quantity
from sandbox.physics.coefficients import BASEBALL_LIFT, Coefficient, NathanDrag
from sandbox.sport.air import Air, Model, Weather
from sandbox.sport.flight import RPM, Flight, Release, Sphere


class BaseballDrag(Model):
    """Drag that grows with the spin."""

    model: Literal["nathan"] = choice(..., "coefficient by its source")

    def coefficient_in(self, air: Air, radius: float) -> Coefficient:
        return NathanDrag(air.viscosity / (2.0 * radius**2 * air.density * RPM))


class Baseball(Sphere, drag=BaseballDrag, lift=BASEBALL_LIFT):
    """The ball."""

    INERTIA = SOLID_SPHERE
    spin_decay: float = quantity(..., "", 0, 0.01, "k of dw/dt = -k |u| w / r")

    def decay_in(self, air: Air) -> float:
        return self.spin_decay


class BaseballFlight(Flight):
    """Parameters of a baseball in the air; x = 0 is the plate of a hit, and the hand of a pitch."""

    release: Release = group(..., "where the ball leaves bat or hand")
    air: Weather = group(..., "the air")
    ball: Baseball = group(..., "the ball")
