"""The distance of two outlines against the widest strip between them."""

from __future__ import annotations

import math
import random

import numpy as np
import pytest

from sandbox.engine.model.nearest import Pose, nearest
from tests.engine.bodies import height, random_outline


def test_distances_are_the_widest_strip_between():
    rng = random.Random(3)
    for _ in range(40):
        one, other = random_outline(rng), random_outline(rng)
        here, there = (Pose(rng.uniform(-2, 2), rng.uniform(-2, 2), rng.uniform(-7, 7)) for _ in range(2))
        found = nearest(one, here, other, there)
        coarse = np.linspace(0.0, 2.0 * np.pi, 720)
        at = coarse[np.argmax(-height(one, here, coarse + np.pi) - height(other, there, coarse))]
        for width in (1e-2, 1e-4, 1e-6):
            turns = np.linspace(at - width, at + width, 201)
            strips = -height(one, here, turns + np.pi) - height(other, there, turns)
            at = turns[np.argmax(strips)]
        assert found.gap == pytest.approx(strips.max(), abs=3e-7)
        if strips.max() > 0.0:
            assert math.remainder(found.direction - at, 2.0 * math.pi) == pytest.approx(0.0, abs=1e-3)
