"""Polynomials in Bernstein form: values, splits, and that no downward crossing is ever missed."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.engine.many.bernstein_many import elevated, first_downward_crossing
from sandbox.engine.many.bernstein_many import evaluate as evaluate_many
from sandbox.engine.paths.bernstein import (
    derivative,
    downward_crossings,
    elevate,
    evaluate,
    first_part,
    last_part,
    piece,
    squared_length,
    without_root_at_start,
)

coefficients = st.lists(st.floats(-10, 10, allow_subnormal=False), min_size=2, max_size=8)
inside = st.floats(0.0, 1.0)


def from_roots(*roots, scale=1.0):
    """Bernstein coefficients of scale * prod (root - u): positive before the first root."""
    b = [scale]
    for root in roots:
        n = len(b)
        b = [
            ((n - k) * root * here + k * (root - 1.0) * before) / n
            for k, (here, before) in enumerate(zip([*b, 0.0], [0.0, *b], strict=True))
        ]
    return b


def test_value_of_a_known_polynomial():
    """u^2 has the coefficients 0, 0, 1."""
    assert evaluate([0.0, 0.0, 1.0], 0.3) == pytest.approx(0.09, abs=1e-16)
    assert evaluate([0.0, 0.0, 1.0], 0.9) == pytest.approx(0.81, abs=1e-15)


@given(coefficients, inside, inside)
def test_split_piece_and_elevation_keep_the_polynomial(b, u, v):
    left, right = first_part(b, u), last_part(b, u)
    assert evaluate(left, v) == pytest.approx(evaluate(b, u * v), abs=1e-10)
    assert evaluate(right, v) == pytest.approx(evaluate(b, u + (1 - u) * v), abs=1e-10)
    low, high = sorted((u, v))
    if high > 0.0:
        assert evaluate(piece(b, low, high), 0.5) == pytest.approx(evaluate(b, 0.5 * (low + high)), abs=1e-10)
    assert evaluate(elevate(b, len(b) + 2), v) == pytest.approx(evaluate(b, v), abs=1e-10)


@given(coefficients, inside)
def test_squared_length_and_derivative(b, u):
    c = b[::-1]
    both, square = pytest.approx(evaluate(b, u) ** 2 + evaluate(c, u) ** 2, abs=1e-9), squared_length(b, c)
    assert evaluate(square, u) == both
    assert evaluate_many(elevated(np.array(square)[:, None], len(square) + 3), np.array([u]))[0] == both
    slope = (evaluate(b, 0.5 + 1e-6) - evaluate(b, 0.5 - 1e-6)) / 2e-6
    assert evaluate(derivative(b), 0.5) == pytest.approx(slope, abs=1e-3)


@given(coefficients, st.floats(0.01, 1.0))
def test_dividing_out_a_root_at_the_start(b, u):
    b = [0.0, *b]
    assert evaluate(without_root_at_start(b), u) * u == pytest.approx(evaluate(b, u), abs=1e-9)


def test_every_downward_crossing_is_found_in_order():
    roots = (0.1, 0.3, 0.300001, 0.7, 0.95)  # down, up, down, up, down
    found = list(downward_crossings(from_roots(*roots)))
    assert found == pytest.approx([0.1, 0.300001, 0.95], abs=1e-9)


def test_a_root_going_up_exactly_on_a_cut_does_not_hide_the_next():
    roots = (0.125, 0.5, 0.943359375)  # down, up, down
    assert list(downward_crossings(from_roots(*roots))) == pytest.approx([0.125, 0.943359375], abs=1e-12)
    u, unclear = first_downward_crossing(np.array(from_roots(*roots))[:, None])
    assert unclear[0] or u[0] == pytest.approx(0.125, abs=1e-12)


@given(st.lists(st.lists(st.floats(0.001, 0.999), min_size=3, max_size=3, unique=True), min_size=1, max_size=8))
def test_many_at_once_find_the_same(rows):
    polynomials = [from_roots(*roots) for roots in rows]
    u, unclear = first_downward_crossing(np.array(polynomials).T)
    for coefficients, found, doubtful in zip(polynomials, u.tolist(), unclear.tolist(), strict=True):
        if not doubtful:
            assert found == pytest.approx(next(downward_crossings(coefficients), np.inf), abs=1e-9)


def test_a_graze_is_no_touch_and_a_shallow_dip_is_one():
    """(u - 1/2)^2 + d: no root for d > 0, two for d < 0, however small."""
    square = squared_length([-0.5, 0.5], [0.0, 0.0])
    assert list(downward_crossings([b + 1e-12 for b in square])) == []
    (found,) = downward_crossings([b - 1e-12 for b in square])
    assert found == pytest.approx(0.5 - 1e-6, abs=1e-9)


@given(st.lists(st.floats(0.001, 0.999), min_size=1, max_size=6, unique=True))
def test_first_crossing_is_never_missed(roots):
    """Against numpy on a fine grid: wherever the sign falls between two samples, a crossing is found there."""
    b = from_roots(*roots)
    found = list(downward_crossings(b))
    u = np.linspace(0.0, 1.0, 2001)
    values = np.array([evaluate(b, x) for x in u])
    for k in np.flatnonzero((values[:-1] > 1e-13) & (values[1:] < -1e-13)):
        assert any(u[k] - 1e-9 <= x <= u[k + 1] + 1e-9 for x in found)
    assert found == sorted(found)
