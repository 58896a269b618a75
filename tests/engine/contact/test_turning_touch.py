"""The time at which two outlines that move and turn touch."""

from __future__ import annotations

import random

import numpy as np
import pytest

from sandbox.engine.contact import turning_touch
from sandbox.engine.contact.turning_touch import OutlineOnArc, first_touch, pose_of
from sandbox.engine.model.nearest import nearest
from sandbox.engine.model.shapes import box, disc
from sandbox.engine.paths.arc import Arc, hermite_arc
from tests.engine.bodies import random_outline


def swinging(rng: random.Random, way: float, h: float) -> Arc:
    """A fast path towards the other that starts ``way`` of the middle."""
    x, y, angle = way * rng.uniform(2.0, 3.0), rng.uniform(-1.0, 1.0), rng.uniform(-3.0, 3.0)
    vx, vy, spin = -way * rng.uniform(0.0, 12.0), rng.uniform(-2.0, 2.0), rng.uniform(-40.0, 40.0)
    ax, ay, turning = rng.uniform(-5.0, 5.0), rng.uniform(-10.0, 10.0), rng.uniform(-30.0, 30.0)
    end = (x + h * vx + h * h * ax / 2, y + h * vy + h * h * ay / 2, vx + h * ax, vy + h * ay, spin + h * turning)
    start, end = (x, y, vx, vy, spin, angle), (*end, angle + h * spin + h * h * turning / 2)
    return hermite_arc(0.0, h, start, (ax, ay, turning), end, (ax, ay, turning))


def test_no_touch_of_spinning_outlines_is_missed():
    """Between the start and the time found, sampled finely, they are apart; then they overlap by the skin."""
    rng, hits = random.Random(8), 0
    for _ in range(60):
        one, other = (OutlineOnArc(random_outline(rng), swinging(rng, way, 0.6)) for way in (-1.0, 1.0))
        t = first_touch(one, other, 0.0, 0.6)
        gaps = [
            nearest(one.shape, pose_of(one.arc.state(at)), other.shape, pose_of(other.arc.state(at))).gap
            for at in np.linspace(0.0, 0.6 if t is None else t, 60, endpoint=t is not None)
        ]
        assert min(gaps) > -2.1e-11
        if t is not None:
            hits += 1
            assert gaps[-1] == pytest.approx(-2e-11, abs=1e-12)
    assert hits > 15


def test_the_spin_of_a_disc_costs_no_distance_queries(monkeypatch):
    """It turns no point of its outline's core."""
    asked = []
    monkeypatch.setattr(turning_touch, "nearest", lambda *where: asked.append(where) or nearest(*where))
    start = [(-0.2, 0.1, 1.5, 0.0, 0.0, 0.0), (-1e-7, 0.1, 1.5, 0.0, -20.0)]
    ends = [(state[0] + 1.5 * 0.1, *state[1:]) for state in start]
    arcs = [hermite_arc(0.0, 0.1, *pair, (0.0,) * 3) for pair in zip(start, [(0.0,) * 3] * 2, ends, strict=True)]
    assert first_touch(OutlineOnArc(box(0.2, 0.2), arcs[0]), OutlineOnArc(disc(0.1), arcs[1]), 0.0, 0.1) is None
    assert len(asked) < 10


@pytest.mark.parametrize(("x", "y"), [(0.0, 1e5), (0.0, -1e5)])
def test_rounding_far_away_is_no_touch(x: float, y: float):
    """Boxes 100 km from the origin that lie on each other, as nearly as their places can be written: closing at 1 nm/s
    is none, and from rest with an acceleration it is one once they would overlap by 1 nm, after sqrt(2 nm / a)."""

    def found(speed: float, acceleration: float) -> float | None:
        outlines, h = [], 0.1
        for side in (-0.5, 0.5):
            v, a = -side * speed, -side * acceleration
            start = (x, y + 0.2 * side, 0.0, v, 0.0, 0.0)
            end = (x, start[1] + h * v + h * h * a / 2.0, 0.0, v + h * a, 0.0, 0.0)
            outlines.append(OutlineOnArc(box(0.2, 0.2), hermite_arc(0.0, h, start, (0.0, a, 0.0), end, (0.0, a, 0.0))))
        return first_touch(*outlines, 0.0, h)

    assert found(speed=1e-9, acceleration=0.0) is None
    assert found(speed=0.0, acceleration=1.0) == pytest.approx(2e-9**0.5, rel=1e-3)
