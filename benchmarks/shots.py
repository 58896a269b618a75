"""The compared shots, and the laws of their flight as a user of pymunk or scipy would write them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import exp, pi
from typing import NamedTuple

import sandbox
from sandbox.engine.model.setup import Setup

#: (vx, vy, spin) in m/s and rad/s to (ax, ay, alpha) in m/s^2 and rad/s^2: these flights need no other arguments.
Law = Callable[[float, float, float], tuple[float, float, float]]

#: Without lift and without the net, so that the law of a shot at a basket is short.
SHORT = {"ball.lift.model": "none", "net.slows": False}
#: Off the front of the rim, then high.
RIM = {"launch.speed": 7.3, "launch.angle": 52.0, "launch.spin": 180.0, **SHORT}


class Shot(NamedTuple):
    """The setup of a shot with one ball, and its law written out."""

    setup: Setup
    law: Law


def rim_shot() -> Shot:
    """A free throw that clips the rim; position 2.5 s after the release."""
    parameters = sandbox.load("basketball", RIM)
    return Shot(replace(parameters.build(), duration=2.5, until=None), basketball_law)


def golf_flight() -> Shot:
    """The default drive with the drag and lift of tour averages, up to landing."""
    scene = sandbox.load("golf", {"ball.drag.model": "tour-fit", "ball.lift.model": "tour-fit"})
    return Shot(replace(scene.build(), until=lambda event: True), golf_law)


def basketball_law(vx: float, vy: float, spin: float) -> tuple[float, float, float]:
    """Gravity, and drag with Cd = 0.5."""
    k = -0.5 * 1.204 * 0.5 * pi * 0.1194**2 / 0.624 * (vx * vx + vy * vy) ** 0.5
    return k * vx, k * vy - 9.81, 0.0


def golf_law(vx: float, vy: float, spin: float) -> tuple[float, float, float]:
    """Gravity, the golf ball's drag and lift by speed and spin, and spin decay."""
    radius, density = 0.021335, 1.204
    speed = (vx * vx + vy * vy) ** 0.5
    reynolds, surface_speed = density * 2.0 * radius * speed / 1.789e-5, radius * abs(spin)
    lift = 0.324 * (1.0 - exp(-surface_speed / speed / 0.126))
    drag = 0.20 + 0.30 / (1.0 + (reynolds / 0.68e5) ** 8) + 1.10 * lift * lift
    k = 0.5 * density * pi * radius**2 / 0.04593 * speed
    side = k * lift if spin > 0.0 else -k * lift
    return -k * drag * vx - side * vy, -k * drag * vy + side * vx - 9.81, -2e-5 / radius * speed * spin
