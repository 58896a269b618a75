"""Courts: how a ball bounces off hard, level ground."""

from __future__ import annotations

from math import atan2, degrees

#: Angle in deg at which courts are tested, and that beyond which the restitution stays as it is.
TEST_ANGLE, STEEP = 16.0, 41.0


def cross_restitution(normal_speed: float, tangential_speed: float, restitution: float, slope: float) -> float:
    """Restitution of a tennis ball: ``e = restitution - slope (angle - 16 deg)``, less for a steeper ball.

    On a hard court e = 0.95 - 0.005 per deg, which is 0.87 at the 16 deg of the ITF's court test. Beyond 41 deg, where
    that is the 0.745 of the ball's drop test, e stays as it is; that is ours. Speeds in m/s, both positive.
    Source: Cross 2020, Sports Eng. 23:9; second-hand.
    """
    steeper = min(degrees(atan2(normal_speed, tangential_speed)), STEEP) - TEST_ANGLE
    return min(1.0, max(0.0, restitution - slope * steeper))
