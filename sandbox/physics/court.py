"""Courts: how a ball bounces off hard, level ground, and how fast they play."""

from __future__ import annotations

from math import atan2, degrees

#: Angle in deg at which courts are tested, and that beyond which the restitution stays as it is.
_TEST_ANGLE, STEEP = 16.0, 41.0


def cross_restitution(normal_speed: float, tangential_speed: float, restitution: float, slope: float) -> float:
    """Restitution of a tennis ball: ``e = restitution - slope (angle - 16 deg)``, less for a steeper ball.

    On a hard court e = 0.95 - 0.005 per deg, which is 0.87 at the 16 deg of the ITF's court test. Beyond 41 deg, where
    that is the 0.745 of the ball's drop test, e stays as it is; that is ours. Speeds in m/s, both positive.
    Source: Cross 2020, Sports Eng. 23:9; second-hand.
    """
    steeper = min(degrees(atan2(normal_speed, tangential_speed)), STEEP) - _TEST_ANGLE
    return min(1.0, max(0.0, restitution - slope * steeper))


#: The ITF's test of a court: speed in m/s, its tolerance, that of TEST_ANGLE in deg, and the most spin in rev/s.
_TEST_SPEED, _SPEED_OFF, _ANGLE_OFF, _MOST_SPIN = 30.0, 2.0, 2.0, 3.0
#: Pace perception constant, mean restitution of all surfaces, and restitution lost per degree below 23 C.
_PERCEPTION, _MEAN_RESTITUTION, _PER_DEGREE = 150.0, 0.81, 0.003


def is_pace_test(speed: float, angle: float, spin: float) -> bool:
    """True if a ball arrives at the court as in the ITF's test: m/s, deg below the horizontal, rev/s."""
    return abs(speed - _TEST_SPEED) <= _SPEED_OFF and abs(angle - _TEST_ANGLE) <= _ANGLE_OFF and abs(spin) <= _MOST_SPIN


def court_pace(before: tuple[float, float], after: tuple[float, float], temperature: float = 23.0) -> float:
    """The ITF's court pace rating, ``100 (1 - mu) + 150 (0.81 - e_T)``, of one bounce: the higher, the faster.

    ``before`` and ``after`` are the velocities in m/s, forward and upward; ``temperature`` is the ball's in C.
    ``e = -v_y' / v_y``, ``mu = (v_x - v_x') / (|v_y| (1 + e))`` as if the ball slid all the time, and
    ``e_T = e + 0.003 (23 - T)``. It is the rating of the court if the ball arrived as in the test (is_pace_test).
    Source: ITF CS 01/02, technical booklet of 2015, page 40.
    """
    (vx, vy), (ux, uy) = before, after
    restitution = -uy / vy
    friction = (vx - ux) / (-vy * (1.0 + restitution))
    adjusted = restitution + _PER_DEGREE * (23.0 - temperature)
    return 100.0 * (1.0 - friction) + _PERCEPTION * (_MEAN_RESTITUTION - adjusted)


def pace_category(rating: float) -> str:
    """The ITF's category of a rating, rounded: slow to 29, medium-slow to 34, medium to 39, medium-fast to 44, fast."""
    bounds = {29: "slow", 34: "medium-slow", 39: "medium", 44: "medium-fast"}
    return next((name for bound, name in bounds.items() if round(rating) <= bound), "fast")
