"""Outlines, bodies and runs that tests of bodies share."""

from __future__ import annotations

import math
import random
from collections.abc import Sequence
from typing import Any

import numpy as np

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.nearest import Pose
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Ellipse, Polygon, Shape, box, capsule, disc, regular
from sandbox.engine.model.surface import Segment, Surface
from sandbox.engine.paths.run import Run
from sandbox.physics.forces import Gravity

G = 9.81  # m/s^2
OUTLINES = {
    "box": box(0.4, 0.3),
    "rounded box": box(0.4, 0.3, 0.05),
    "triangle": Polygon(((0.1, 0.25), (0.3, 0.0), (0.0, 0.0))),
    "rounded triangle": Polygon(((0.0, 0.0), (0.3, 0.0), (0.1, 0.25)), 0.06),
    "capsule": capsule(0.5, 0.08),
    "disc": disc(0.2),
    "ellipse": Ellipse(0.3, 0.12),
    "heptagon": regular(7, 0.25, 0.02),
}


def random_outline(rng: random.Random) -> Shape:
    size = rng.uniform(0.2, 1.0)
    kind = rng.randrange(4)
    if kind == 0:
        return Ellipse(size, rng.uniform(0.1, 1.0) * size)
    if kind == 1:
        return box(2.0 * size, rng.uniform(0.2, 2.0) * size, rng.choice((0.0, 0.05 * size)))
    if kind == 2:
        return capsule(2.0 * size, rng.uniform(0.1, 0.9) * size)
    turns = [2.0 * math.pi * (k + rng.uniform(0.0, 0.8)) / 6 for k in range(6)]
    return Polygon([(size * math.cos(turn), size * math.sin(turn)) for turn in turns], rng.choice((0.0, 0.1)))


def floor(restitution: float, friction: float) -> list[Surface]:
    return [Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), restitution, friction)]


def thrown(shape: Shape, *, mass: float = 2.0, **start: Any) -> Body:
    return Body("body", shape=shape, mass=mass, forces=(Gravity(G, mass),), **start)


def run_of(balls: Sequence[Ball], duration: float, surfaces: Sequence[Surface] = (), **more: Any) -> Run:
    return simulate(Setup(balls, surfaces, duration, **more), LEVELS["balanced"])


def widest(points: np.ndarray, turns: np.ndarray) -> np.ndarray:
    """How far points reach in each direction."""
    reach: np.ndarray = np.max(np.outer(np.cos(turns), points[:, 0]) + np.outer(np.sin(turns), points[:, 1]), axis=1)
    return reach


def height(shape: Shape, at: Pose, turns: np.ndarray) -> np.ndarray:
    """How far an outline reaches in each direction."""
    there = at.x * np.cos(turns) + at.y * np.sin(turns)
    if isinstance(shape, Ellipse):
        return there + np.hypot(shape.a * np.cos(turns - at.angle), shape.b * np.sin(turns - at.angle))
    return there + widest(np.array(shape.corners), turns - at.angle) + shape.radius


LEVEL = Segment((-50.0, 0.0), (50.0, 0.0))
