"""Friction between two balls, which throws the object ball off the line of centres and passes spin on."""

from __future__ import annotations

from math import exp


def friction_by_speed(slip_speed: float) -> float:
    """Coefficient of friction of two clean pool balls: ``mu = 0.009951 + 0.108 exp(-1.088 s)``.

    ``slip_speed`` s in m/s is the speed of the one surface over the other where they touch: slow shots are thrown most.
    Fitted to Marlow's measurements from 0.1 to 10 m/s. Source: Alciatore, technical proof TP A.14, The effects of cut
    angle, speed, and spin on object ball throw.
    """
    return 0.009951 + 0.108 * exp(-1.088 * slip_speed)
