"""A comparison of the compiled kernel with the interpreted one, bit by bit: shots with every law that has a code."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random
from typing import Any

import numpy as np

from sandbox.engine.kernel import leg
from sandbox.engine.kernel.laws import COEFFICIENTS
from sandbox.engine.kernel.library import FlyAll, Legs, fly_together
from sandbox.engine.kernel.rows import Tables, tables
from sandbox.engine.kernel.step_control import FIRST_STEP
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.bounce_laws import CourtBounce, PennerTurf
from sandbox.engine.model.setup import EndsBy, ForceRegion, Rule, Setup
from sandbox.engine.model.surface import Circle, Segment, Surface
from sandbox.errors import RunError
from sandbox.physics.air import LogWind, UniformWind
from sandbox.physics.ballistics import SHAPES, BulletDrag
from sandbox.physics.coefficients import NathanDrag, OfWholeSpin, Scaled
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
from sandbox.physics.net import NetDrag

#: Shots that are compared; those of one setup differ in their launch.
COMPARED, _ALIKE = 1_000, 20


def check(fly_all: FlyAll, count: int = COMPARED) -> None:
    """Raise RunError if compiled paths of so many shots are not the same, bit by bit, as interpreted ones."""
    for rows, shots in _shots(count):
        counted = np.zeros((len(shots), rows.rules.shape[1]))
        one, other = (fly_together(fly, shots, rows, counted.copy()) for fly in (fly_all, interpreted))
        for name, here, there in zip(Legs._fields, one, other, strict=True):
            if here.shape != there.shape or here.tobytes() != there.tobytes():
                raise RunError(
                    f"the compiled kernel gives other {name} than the interpreted one, so it is not installed"
                )


def interpreted(first: int, *arrays: np.ndarray) -> int:
    """``fly_all`` as Python runs it, with what it writes in arrays."""
    *read, limits, arcs, events, found = arrays
    counted = read[-1].tolist()
    written = [[None] * len(rows) for rows in (arcs, events, found)]
    fly_all: FlyAll = leg.fly_all
    done = fly_all(first, *(each.tolist() for each in read[:-1]), counted, limits.tolist(), *written)
    read[-1][:] = counted
    for rows, new in zip((arcs, events, found), written, strict=True):
        for place, row in enumerate(new):
            if row is not None:
                rows[place] = row
    return done


def _shots(count: int) -> Iterator[tuple[Tables, np.ndarray]]:
    """Rows of setups with every law that has a code, and of launches in each."""
    random, accuracy = Random(1), resolve()
    for number in range(count // _ALIKE):
        setup = _setup(number, random)
        rows = tables(setup, accuracy, 1)
        assert rows is not None
        shots = [(0.0, 0.0, 2.0, *_launch(random), FIRST_STEP) for _ in range(_ALIKE)]
        yield rows, np.array(shots)


def _launch(random: Random) -> tuple[float, float, float]:
    """Velocity in m/s and spin in rad/s."""
    return random.uniform(2.0, 45.0), random.uniform(-2.0, 20.0), random.uniform(-300.0, 300.0)


def _setup(number: int, random: Random) -> Setup:
    laws: list[Any] = [*COEFFICIENTS, NathanDrag(), random.uniform(0.1, 0.5)]
    drag, lift = laws[number % len(laws)], laws[(7 * number + 3) % len(laws)]
    if number % 3 == 1 and callable(lift):
        lift = Scaled(OfWholeSpin(lift, 0.8), 0.9)
    wind = (None, UniformWind(-4.0, 0.5), LogWind((-5.0, 0.0), 10.0, 0.03))[number % 3]
    ring = (random.uniform(3.0, 12.0), 2.0)
    net = NetDrag(0.4, 6.0, ring, 0.3, 0.5)
    through_air: Any = Drag(coefficient=drag, wind=wind)
    if number % 5 == 4:
        through_air = BulletDrag(0.4, SHAPES[number % len(SHAPES)], 0.1, 1.2, random.uniform(5.0, 300.0), wind)
    forces: list[Any] = [Gravity(9.81), through_air, Magnus(coefficient=lift, wind=wind), net]
    ball = Ball("ball", mass=0.4, radius=0.1, position=(0.0, 2.0), forces=forces, torques=[SpinDecay(wind=wind)])
    response = (None, PennerTurf(1.0, 0.4, 1.0), CourtBounce(0.8, 0.6, 0.005, 0.1))[number // 3 % 3]
    (x, y), wall = ring, random.uniform(12.0, 30.0)
    surfaces = [
        Surface("ground", Segment((-50.0, 0.0), (wall, 0.0)), 0.7, 0.4, lowest_bounce=0.01, law=response),
        Surface("front", Circle((x - 0.2, y), 0.02), 0.6, 0.3),
        Surface("back", Circle((x + 0.2, y), 0.02), 0.6, 0.3, kick=0.1),
        Surface("board", Segment((wall, 0.0), (wall, 4.0), 0.02), 0.8, 0.3),
    ]
    region = ForceRegion(x - 0.3, y - 0.5, x + 0.3, y, 0.02)
    until = EndsBy((Rule(("ground",), times=4), Rule(("board",), fastest=9.0, left=-1.0, right=13.0)))
    return Setup([ball], surfaces, duration=6.0, until=until, force_regions=[region])
