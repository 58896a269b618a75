"""The baseball and its models, from the side: hit or pitched."""

from __future__ import annotations

from typing import Literal

from sandbox.parameters import choice, either, quantity
from sandbox.physics.coefficients import BASEBALL_LIFT, Coefficient, NathanDrag
from sandbox.sport.air import Air, ConstantDrag, ConstantLift, Lift, Model, NoDrag, NoLift, SpinRatioLift
from sandbox.sport.flight import RPM, Sphere


class BaseballDrag(Model):
    """Drag that grows with the spin."""

    model: Literal["nathan"] = choice(..., "drag coefficient by its source")

    def coefficient_in(self, air: Air, radius: float) -> Coefficient:
        return NathanDrag(air.viscosity / (2.0 * radius**2 * air.density * RPM))


class BaseballLift(Lift):
    """Lift of a baseball."""

    LAWS = BASEBALL_LIFT
    model: Literal["nathan", "sawicki"] = choice(..., "lift coefficient by its source")


class Baseball(Sphere):
    """The ball."""

    spin_decay: float = quantity(..., "", 0, 0.01, "k of dw/dt = -k |u| w / r")
    drag: BaseballDrag | ConstantDrag | NoDrag = either(..., "drag of the air")
    lift: BaseballLift | SpinRatioLift | ConstantLift | NoLift = either(..., "Magnus lift")
