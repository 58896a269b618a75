"""Contact laws of grass and of courts, as data: each calls a function of numbers, which the kernel calls, too."""

from __future__ import annotations

from dataclasses import dataclass

from sandbox.engine.model.surface import Bounce
from sandbox.physics.court import cross_restitution
from sandbox.physics.turf import penner_bounce


@dataclass(frozen=True)
class PennerTurf:
    """The response of turf to an impact: Penner's restitution times ``bounce``, and a tilt times ``give``."""

    bounce: float
    friction: float
    give: float

    def __call__(self, normal_speed: float, tangential_speed: float) -> Bounce:
        return Bounce(*bounce_of_turf(normal_speed, tangential_speed, self.bounce, self.friction, self.give))


def bounce_of_turf(
    normal_speed: float, tangential_speed: float, bounce: float, friction: float, give: float
) -> tuple[float, float, float, float]:
    """The fields of its Bounce."""
    restitution, tilt = penner_bounce(normal_speed, tangential_speed, give)
    return min(1.0, bounce * restitution), friction, tilt, 0.0


@dataclass(frozen=True)
class CourtBounce:
    """The response of a hard court to an impact: Cross's restitution, which falls by ``slope`` for each degree that the
    ball arrives steeper; ``tangential`` is the share of the slip that is reversed if the ball grips."""

    restitution: float
    friction: float
    slope: float
    tangential: float

    def __call__(self, normal_speed: float, tangential_speed: float) -> Bounce:
        numbers = self.restitution, self.friction, self.slope, self.tangential
        return Bounce(*bounce_of_court(normal_speed, tangential_speed, *numbers))


def bounce_of_court(
    normal_speed: float, tangential_speed: float, restitution: float, friction: float, slope: float, tangential: float
) -> tuple[float, float, float, float]:
    """The fields of its Bounce."""
    return cross_restitution(normal_speed, tangential_speed, restitution, slope), friction, 0.0, tangential
