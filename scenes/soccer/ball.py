"""The soccer ball, for all scenes of the sport."""

from __future__ import annotations

from typing import Literal

from sandbox.parameters import choice, either
from sandbox.physics.coefficients import SOCCER_DRAG, SOCCER_LIFT, Coefficient
from sandbox.sport.air import ConstantDrag, ConstantLift, Lift, Model, NoDrag, NoLift, SpinRatioLift
from sandbox.sport.flight import Sphere


class SoccerDrag(Model):
    """Drag of a soccer ball by its source."""

    model: Literal["goff-carre", "textbook"] = choice("goff-carre", "drag coefficient by its source")

    def coefficient_law(self) -> Coefficient:
        return SOCCER_DRAG[self.model]


class SoccerLift(Lift):
    """Magnus force on a soccer ball by its source."""

    model: Literal["asai", "power-law"] = choice("asai", "lift coefficient by its source")

    def coefficient_law(self) -> Coefficient:
        return SOCCER_LIFT[self.model]


class SoccerBall(Sphere):
    """The soccer ball, a hollow sphere."""

    drag: SoccerDrag | ConstantDrag | NoDrag = either(..., "drag of the air")
    lift: SoccerLift | ConstantLift | SpinRatioLift | NoLift = either(..., "Magnus force")
