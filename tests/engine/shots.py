"""The shots on which the engine is compared with the reference: a basketball among ring, board and floor."""

from __future__ import annotations

from math import cos, pi, radians, sin

import numpy as np

from sandbox.engine.model.ball import HOLLOW_SPHERE, Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Circle, Segment, Surface
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity, Magnus
from tests.engine.reference import Bar, Disc

MASS, RADIUS, GRAVITY, DENSITY = 0.624, 0.1194, 9.81, 1.2
RING, TUBE = 4.191, 0.009  # m, from the release to the ring's centre; radius of the tube
INNER = 0.4572  # m
DRAG, LIFT = 0.5, 0.1

SURFACES = [
    Surface("rim front", Circle((RING - INNER / 2 - TUBE, 3.05), TUBE), 0.7, 0.5),
    Surface("rim back", Circle((RING + INNER / 2 + TUBE, 3.05), TUBE), 0.7, 0.5),
    Surface("backboard", Segment((RING + INNER / 2 + 0.15, 2.90), (RING + INNER / 2 + 0.15, 3.95), 0.01), 0.75, 0.4),
    Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.78, 0.5),
]

REFERENCE = [
    Disc("rim front", RING - INNER / 2 - TUBE, 3.05, TUBE, 0.7, 0.5),
    Disc("rim back", RING + INNER / 2 + TUBE, 3.05, TUBE, 0.7, 0.5),
    Bar("backboard", RING + INNER / 2 + 0.15, 2.90, RING + INNER / 2 + 0.15, 3.95, 0.01, 0.75, 0.4),
    Bar("floor", -50.0, 0.0, 50.0, 0.0, 0.0, 0.78, 0.5),
]


def setup(speed: float, angle: float, spin: float, duration: float) -> Setup:
    """A shot from 2.1 m height; speed in m/s, angle in deg, spin in rad/s."""
    ball = Ball(
        "ball",
        MASS,
        RADIUS,
        position=(0.0, 2.1),
        velocity=(speed * cos(radians(angle)), speed * sin(radians(angle))),
        spin=spin,
        inertia_factor=HOLLOW_SPHERE,
        forces=[Gravity(GRAVITY, MASS), Drag(RADIUS, DENSITY, Constant(DRAG)), Magnus(RADIUS, DENSITY, Constant(LIFT))],
    )
    return Setup([ball], SURFACES, duration=duration)


def start(speed: float, angle: float, spin: float) -> tuple[float, ...]:
    return (0.0, 2.1, speed * cos(radians(angle)), speed * sin(radians(angle)), spin)


def acceleration(t: float, s: np.ndarray) -> tuple[float, float, float]:
    """The same forces, written out again."""
    speed = np.hypot(s[2], s[3])
    k = 0.5 * DENSITY * pi * RADIUS**2 / MASS * speed
    lift = LIFT * np.sign(s[4])
    return -k * (DRAG * s[2] + lift * s[3]), -k * (DRAG * s[3] - lift * s[2]) - GRAVITY, 0.0


def seeded(count: int) -> list[tuple[float, float, float]]:
    """Shots towards the hoop, most of which meet rim or board: speed, angle, spin."""
    random = np.random.default_rng(20)
    shots = []
    for _ in range(count):
        angle = random.uniform(42.0, 60.0)
        d, h = RING + random.uniform(-0.3, 0.45), 0.95
        a = radians(angle)
        vacuum = (GRAVITY * d * d / (2 * cos(a) ** 2 * (d * np.tan(a) - h))) ** 0.5
        shots.append((float(vacuum * 1.025), float(angle), float(random.uniform(-5.0, 25.0))))
    return shots
