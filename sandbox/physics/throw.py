"""Friction between two balls, which throws the object ball off the line of centres and passes spin on."""

from __future__ import annotations

from typing import Any

from sandbox.physics.elementwise import maximum


def friction_by_speed(slip_speed: Any) -> Any:
    """Coefficient of friction of two pool balls: ``mu = 0.130 / (1 + (s / 1.53 m/s)^2)``.

    ``slip_speed`` s in m/s is the relative speed of the surfaces as they meet: slow shots have the most throw. Two
    numbers, fitted (*ours*) to the eight throws of a frozen ball at a cut of 45 deg that Alciatore measured (experiment
    NV D.16; Billiards Digest, July and August 2014), which it meets to 0.3 deg rms. Valid for slips of 0.3 to 1.8 m/s;
    slower ones are held at 0.130, and up to 7 m/s it is near Marlow's 0.01 there.
    """
    return 0.130 / (1.0 + (slip_speed / 1.53) ** 2)


def spring_back(share: Any) -> Any:
    """Share of the slip that two elastic spheres reverse in their contact: ``1.2 w - 1.8 w^4`` with ``w = 1 - z``, and
    no less than 0.

    ``share`` z is the impulse that would end the slip, over the most that friction can give:
    ``(2/7) s / (mu (1 + e) v)`` for solid balls that slip at s and approach at v. From z = 0.83 on they slide all the
    time. It matches the solution of Maw, Barber & Fawcett 1976, Wear 38:101, for Poisson's ratio 0.34, that of a
    phenolic resin, within 0.01 of the largest impulse (*ours*: computed by the springs of ``cluster_springs.py``).
    """
    rest = maximum(1.0 - share, 0.0 * share)
    return maximum(1.2 * rest - 1.8 * rest**4, 0.0 * share)
