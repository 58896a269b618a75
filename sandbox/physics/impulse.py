"""A ball's contact with something at one point: the speeds of its surface there, and what an impulse there changes.

The unit normal n points to the ball from what it touches, and a = (ny, -nx) is the direction along it. The point is at
the height of the ball's centre or, where the nose of a cushion touches it, above it by the angle theta: it is at

    r d,    d = -cos(theta) n + sin(theta) up,

from the centre, and its speed ``v + w x r d`` has components along d (the approach), along a, and upward at right
angles to both. An impulse P of these components changes ``v`` by ``P / m`` and ``w`` by ``r d x P / I``.

Valid for a sphere or, in the plane of the picture, a disc. Left out: the vertical part of an impulse; the ball stays on
its cloth.
"""

from __future__ import annotations

from math import sqrt
from typing import Any

from sandbox.physics.elementwise import clip, maximum

#: Velocity (m/s) and spin (rad/s) of a ball: (vx, vy, wz), on cloth (vx, vy, wz, wx, wy). Floats, or arrays.
Motion = tuple[Any, ...]


def surface_speeds(motion: Motion, nx: Any, ny: Any, radius: Any, sine: float = 0.0) -> tuple[Any, Any, Any]:
    """Speed of approach of a ball, and speeds of its surface along what it touches and upward, in m/s.

    ``sine`` is that of theta.
    """
    vx, vy, wz, *rolling = motion
    wx, wy = rolling or (0.0, 0.0)
    cosine = sqrt(1.0 - sine * sine)
    into = -(vx * nx + vy * ny)
    along = vx * ny - vy * nx + radius * (cosine * wz + sine * (wx * nx + wy * ny))
    return cosine * into, along, radius * (wy * nx - wx * ny) - sine * into


def after_impulse(
    motion: Motion, nx: Any, ny: Any, radius: Any, factor: Any, impulse: tuple[Any, Any, Any], sine: float = 0.0
) -> Motion:
    """The motion after an impulse away from what the ball touches, along it and upward.

    The impulse is in m/s, divided by the ball's mass; ``factor`` is the moment of inertia over m r^2.
    """
    vx, vy, wz, *rolling = motion
    push, along, upward = impulse
    cosine, turn = sqrt(1.0 - sine * sine), 1.0 / (factor * radius)
    away = cosine * push + sine * upward
    plane = vx + away * nx + along * ny, vy + away * ny - along * nx, wz + turn * cosine * along
    if not rolling:
        return plane
    wx, wy = rolling
    return (*plane, wx + turn * (sine * along * nx - upward * ny), wy + turn * (sine * along * ny + upward * nx))


def plane_speeds(vx: Any, vy: Any, spin: Any, nx: Any, ny: Any, radius: Any) -> tuple[Any, Any]:
    """As ``surface_speeds`` of a ball that is touched at the height of its centre: approach, and along."""
    return -(vx * nx + vy * ny), vx * ny - vy * nx + radius * spin


def after_plane_impulse(
    vx: Any, vy: Any, spin: Any, nx: Any, ny: Any, radius: Any, factor: Any, push: Any, along: Any
) -> tuple[Any, Any, Any]:
    """As ``after_impulse`` of a ball that is touched at the height of its centre."""
    return vx + push * nx + along * ny, vy + push * ny - along * nx, spin + 1.0 / (factor * radius) * along


def exchange(approach: Any, slip: Any, factor: Any, restitution: Any, friction: Any) -> tuple[Any, Any]:
    """Impulses over the mass, in m/s, away from what a ball hits and along it: ``P = (1 + e) v``, of a speed of
    approach v, and ``Q = -s k / (1 + k)``, which ends a slip s, but no more than ``mu P``; k is the moment of inertia
    over m r^2.

    Newton's restitution and Coulomb's friction, as Chipmunk has them for a single contact (cpArbiter.c).
    """
    push = maximum((1.0 + restitution) * approach, 0.0)
    return push, clip(-slip * factor / (1.0 + factor), -friction * push, friction * push)
