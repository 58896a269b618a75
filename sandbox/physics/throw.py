"""Friction between two balls, which throws the object ball off the line of centres and passes spin on."""

from __future__ import annotations

from typing import Any

from sandbox.physics.elementwise import exp


def friction_by_speed(slip_speed: Any) -> Any:
    """Coefficient of friction of two clean pool balls: ``mu = 0.009951 + 0.108 exp(-1.088 s)``.

    ``slip_speed`` s in m/s is the relative speed of the surfaces at the contact: slow shots have the most throw. Three
    parameters through Marlow's three points, at slips of 0.07, 0.7 and 7 m/s, and valid between them. Source:
    Alciatore, technical proof TP A.14, The effects of cut angle, speed, and spin on object ball throw.
    """
    return 0.009951 + 0.108 * exp(-1.088 * slip_speed)
