"""Measuring on the picture: distances from lines, and the point of a trace that is nearest."""

from __future__ import annotations

import numpy as np
import pytest

from sandbox.window.measure import Tape, away_from

LINE = np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 20.0)])


@pytest.mark.parametrize(
    ("at", "away", "piece", "share"),
    [
        ((4.0, 3.0), 3.0, 0, 0.4),
        ((13.0, 15.0), 3.0, 1, 0.75),
        ((-3.0, -4.0), 5.0, 0, 0.0),  # before the start
        ((10.0, 26.0), 6.0, 1, 1.0),  # beyond the end
    ],
)
def test_the_nearest_point_of_a_line(at: tuple[float, float], away: float, piece: int, share: float):
    assert away_from(LINE, at) == pytest.approx((away, piece, share))


def test_a_point_is_a_line_without_length():
    assert away_from(np.array([(1.0, 1.0)]), (4.0, 5.0)) == pytest.approx((5.0, 0, 0.0))


def test_a_tape_is_as_long_as_its_ends_are_apart():
    assert Tape((1.0, 2.0), (4.0, -2.0)).length == 5.0
