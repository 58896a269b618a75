"""Paths that graze a shape, and the touches that the engine finds: ``python tests/reference/grazing.py [count]``.

Of 40,000 paths past circles, segments and their ends, a third aimed at a tangent to within 1e-9 of the distance, each
touch is compared with the distances at 400 points of the path and at the minima between them. None is missed, late or
made up by more than 1e-12 m. Half a minute.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from math import hypot
from random import Random
from typing import NamedTuple

import numpy as np

from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.model.surface import Circle, Segment, Surface
from sandbox.engine.paths.arc import Arc, hermite_arc
from sandbox.engine.paths.bernstein import evaluate

ROUNDING = 1e-12  # m
POINTS = 401
_GOLDEN = 0.5 * (3.0 - 5.0**0.5)


class Case(NamedTuple):
    """A path, and what it may touch."""

    obstacle: Obstacle
    arc: Arc


def cases(count: int, seed: int = 1) -> Iterator[Case]:
    """So many paths that start outside of their shape."""
    rng = Random(seed)
    while count > 0:
        case = _case(rng)
        if gap(case, 0.0) > ROUNDING:
            count -= 1
            yield case


def _case(rng: Random) -> Case:
    radius, h = rng.choice((0.02, 0.12)), rng.choice((1e-4, 0.01, 0.1, 0.4))
    x, y = rng.uniform(-1.0, 1.0), rng.uniform(-1.0, 1.0)
    far = x + rng.uniform(-1.0, 1.0), y + rng.uniform(-1.0, 1.0)
    thick, thin = rng.choice((0.001, 0.009, 0.1)), rng.choice((0.0, 0.0045))
    shape = Circle((x, y), thick) if rng.random() < 0.4 else Segment((x, y), far, thin)
    obstacle = Obstacle(Surface("shape", shape, 0.7, 0.5), radius)
    start, end = ([rng.uniform(-1.2, 1.2) for _ in range(2)] for _ in range(2))
    pushes = [(rng.uniform(-5.0, 5.0), rng.uniform(-15.0, 5.0), 0.0) for _ in range(2)]
    if rng.random() < 0.35:  # past the first end, along a tangent
        off = obstacle.outline.reach * (1.0 + rng.choice((0.0, 1e-6, -1e-6, 1e-9, -1e-9, 1e-11, -1e-11)))
        start, end = [x - 0.7, y + off], [x + 0.7, y + off]
    if rng.random() < 0.5:
        pushes = [(0.0, 0.0, 0.0)] * 2
    velocity = (end[0] - start[0]) / h, (end[1] - start[1]) / h
    return Case(obstacle, hermite_arc(0.0, h, (*start, *velocity, 1.0), pushes[0], (*end, *velocity, 1.0), pushes[1]))


def gap(case: Case, u: float) -> float:
    """Distance in m to a touch at u, by the nearest feature."""
    obstacle, arc = case
    return float(obstacle.near(evaluate(arc.x, u), evaluate(arc.y, u)).gap) + obstacle.skin


def deepest(case: Case, until: float) -> float:
    """The least gap in m up to u = ``until``: at points, and at the minima between them."""
    us = np.linspace(0.0, until, POINTS).tolist()
    gaps = [gap(case, u) for u in us]
    least = min(gaps)
    for i in range(1, POINTS - 1):
        if gaps[i] <= min(gaps[i - 1], gaps[i + 1]) and gaps[i] < least + 1e-3:
            least = min(least, _minimum(case, us[i - 1], us[i + 1]))
    return least


def _minimum(case: Case, low: float, high: float) -> float:
    """The least gap between, by golden sections."""
    a, b = (low + share * (high - low) for share in (_GOLDEN, 1.0 - _GOLDEN))
    at_a, at_b = gap(case, a), gap(case, b)
    for _ in range(40):
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = low + _GOLDEN * (high - low)
            at_a = gap(case, a)
        else:
            low, a, at_a = a, b, at_b
            b = high - _GOLDEN * (high - low)
            at_b = gap(case, b)
    return min(at_a, at_b)


def mistake(case: Case) -> str:
    """What is wrong with the touch that is found; "" if nothing is."""
    u = case.obstacle.first_touch(case.arc)
    if u is None:
        return "missed" if deepest(case, 1.0) < -ROUNDING else ""
    speed = hypot(*(max(map(abs, curve)) for curve in case.arc.curves[2:4])) * case.arc.t1
    if abs(gap(case, u)) > ROUNDING * (1.0 + speed):
        return "made up"
    return "late" if deepest(case, u) < -ROUNDING * (1.0 + speed) else ""


def main(count: int) -> None:
    found = [mistake(case) for case in cases(count)]
    print(f"{count:,} paths:", ", ".join(f"{found.count(kind)} {kind}" for kind in ("missed", "late", "made up")))


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 40_000)
