"""Bodies other than balls on the bench, and the strip that separates the outlines of two."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations
from math import radians
from typing import Literal, NamedTuple

from sandbox.engine.contact.manifold import ContactManifold, meeting, surface_met
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.model.shapes import Shape
from sandbox.kit import (
    Body,
    Ellipse,
    Force,
    Group,
    Polygon,
    Run,
    Vector,
    box,
    capsule,
    choice,
    quantity,
    text,
)

#: Heights above the lane and diameters of a bowling pin, as shares of its height of 15 in (USBC); the neck is filled.
PIN = ((0.0, 0.150), (0.05, 0.1885), (0.15, 0.2604), (0.225, 0.3007), (0.3, 0.3177), (0.9, 0.1698), (0.98, 0.093))
#: The height of its centre of mass, and its moment of inertia over m h^2, computed from the whole profile.
PIN_CENTER, PIN_MOMENT = 0.382, 0.0564

#: Gap in m below which two outlines touch.
TOUCH = 1e-5


class Moving(Group):
    """Shared by balls and boxes on the bench."""

    name: str = text("its name")
    x: float = quantity(0.0, "m", -50, 50, "of its centre of mass, to the right")
    y: float = quantity(0.0, "m", -50, 50, "of its centre of mass, upward, or across a level bench")
    vx: float | None = quantity(None, "m/s", -50, 50, "along x; if vx and vy are left out, 0 or that of the launch")
    vy: float | None = quantity(None, "m/s", -50, 50, "along y")
    spin: float = quantity(0.0, "rad/s", -300, 300, "counter-clockwise")
    mass: float = quantity(0.17, "kg", 1e-3, 100, "mass")


class Box(Moving):
    """Something that is not round, turned by its angle."""

    shape: Literal["box", "ellipse", "capsule", "pin"] = choice("box", "its outline")
    angle: float = quantity(0.0, "deg", -360, 360, "its orientation, counter-clockwise")
    width: float = quantity(0.1, "m", 0.001, 20, "along its own x")
    height: float = quantity(0.1, "m", 0.001, 20, "along its own y")


def outline(it: Box) -> Shape:
    """Its outline; a pin stands on the origin."""
    w, h = it.width, it.height
    if it.shape == "ellipse":
        return Ellipse(w / 2, h / 2)
    if it.shape == "capsule":
        return capsule(w, h / 2) if w > h else capsule(h, w / 2)
    if it.shape == "pin":
        right = [(0.5 * share * h * w / (PIN[4][1] * h), up * h) for up, share in PIN]
        return Polygon([*right, *((-x, y) for x, y in reversed(right))])
    return box(w, h)


def body_of(it: Box, velocity: Vector, forces: Sequence[Force]) -> Body:
    """The body, with this velocity and these forces on it."""
    pin = it.shape == "pin"
    return Body(
        it.name,
        position=(it.x, it.y),
        velocity=velocity,
        spin=it.spin,
        angle=radians(it.angle),
        shape=outline(it),
        mass=it.mass,
        center=(0.0, PIN_CENTER * it.height) if pin else None,
        moment=PIN_MOMENT * it.mass * it.height**2 if pin else None,
        forces=forces,
    )


class Strip(NamedTuple):
    """The gap between two outlines."""

    met: ContactManifold
    why: str


def strip(run: Run, t: float) -> Strip | None:
    """Between the two that are nearest to each other at t: a body and another or, if it is alone, a surface."""
    there = [(ball, run.arcs[ball.name].at(t).state(t)) for ball in run.setup.balls]
    found = [
        (meeting(a, here, b, at, TOUCH), a.name, b.name)
        for (a, here), (b, at) in combinations(there, 2)
        if a.rotates or b.rotates
    ] or [
        (surface_met(body, state, (obstacle, obstacle.near(*state[:2])), TOUCH), body.name, obstacle.surface.name)
        for body, state in there
        for obstacle in (Obstacle(surface, body.radius) for surface in run.setup.surfaces)
        if body.rotates
    ]
    if not found:
        return None
    met, one, other = min(found, key=lambda pair: pair[0].gap)
    if met.gap > TOUCH:
        why = f"{_length(met.gap)} apart"
    else:
        why = f"in touch {'along a side' if len(met.points) == 2 else 'at a point'}"
    return Strip(met, f"{one} and {other} are {why}")


def _length(gap: float) -> str:
    return f"{gap:.2f} m" if gap >= 1.0 else f"{100 * gap:.1f} cm" if gap >= 1e-3 else f"{1000 * gap:.2f} mm"
