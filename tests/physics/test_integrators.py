"""Every integrator converges at its stated order, on floats and on arrays alike."""

from math import exp, log, sin

import numpy as np
import pytest

from tests.physics.methods import METHODS


def advance(name, law, state, duration, steps):
    dt = duration / steps
    t = 0.0
    for _ in range(steps):
        state = METHODS[name].step_of(law, len(state) == 6)(t, state, law(t, state), dt)[0]
        t += dt
    return state


def drag_alone(t, state):
    """a = -k |v| v with k = 0.5 /m, along x; the spin decays as dw/dt = -w."""
    return -0.5 * abs(state[2]) * state[2], 0.0 * state[3], -state[4]


def turning(t, state):
    """a = w zhat x v with w = 2 rad/s, and a push that grows in time: velocity, time and position all matter."""
    return -2.0 * state[3] + 0.3 * t, 2.0 * state[2] - 0.1 * state[0], 0.0 * state[4]


@pytest.mark.parametrize("name", METHODS)
def test_converges_at_its_stated_order(name):
    """Drag alone has x(t) = ln(1 + k v0 t) / k and v(t) = v0 / (1 + k v0 t); the spin is exp(-t)."""
    v0, duration, k = 1.0, 1.0, 0.5
    counts = 2 ** np.arange(3, 7) if METHODS[name].order >= 4 else 2 ** np.arange(7, 12)
    errors = []
    for steps in counts:
        x, _, v, _, spin = advance(name, drag_alone, (0.0, 0.0, v0, 0.0, 1.0), duration, int(steps))
        off = x - log(1 + k * v0 * duration) / k, v - v0 / (1 + k * v0 * duration), spin - exp(-duration)
        errors.append(sum(map(abs, off)))
    slope = np.polyfit(np.log(duration / counts), np.log(errors), 1)[0]
    assert slope == pytest.approx(METHODS[name].order, abs=0.15)


def swinging(t, state):
    """A body whose angle drives its turning and its way."""
    return 2.0 * sin(state[5]), -0.5 * state[3], -9.0 * sin(state[5]) - 0.3 * state[4] + 0.5 * state[0]


@pytest.mark.parametrize(
    ("law", "start"), [(turning, (1.0, -0.5, 0.7, 0.3, 0.0)), (swinging, (0.2, 0.0, 0.5, 0.3, -1.0, 0.8))]
)
@pytest.mark.parametrize("name", METHODS)
def test_converges_where_all_of_the_state_matters(name, law, start):
    """Against the same method at a sixteenth of the finest step."""
    counts = 2 ** np.arange(4, 7) if METHODS[name].order >= 4 else 2 ** np.arange(6, 10)
    fine = np.array(advance("dormand-prince", law, start, 1.0, 512))
    errors = [np.abs(np.array(advance(name, law, start, 1.0, int(n))) - fine).max() for n in counts]
    slope = np.polyfit(np.log(1.0 / counts), np.log(errors), 1)[0]
    assert slope == pytest.approx(METHODS[name].order, abs=0.15)


@pytest.mark.parametrize("name", METHODS)
def test_counts_its_evaluations(name):
    calls = 0

    def law(t, state):
        nonlocal calls
        calls += 1
        return drag_alone(t, state)

    state = (0.0, 0.0, 4.0, 0.0, 1.0)
    METHODS[name].step_of(law)(0.0, state, drag_alone(0.0, state), 0.01)
    assert calls == METHODS[name].evaluations


@pytest.mark.parametrize("name", METHODS)
def test_many_shots_at_once_are_the_same_as_one_by_one(name):
    speeds = [1.0, 2.5, 4.0]
    state, dt = np.array([[1.0] * 3, [-0.5] * 3, speeds, [0.3] * 3, [-2.0] * 3]), np.array([0.01, 0.02, 0.03])
    end, last, error = METHODS[name].step_of_many(turning)(0.1, state, np.array(turning(0.1, state)), dt)
    for k in range(3):
        start = tuple(state[:, k].tolist())
        alone = METHODS[name].step_of(turning)(0.1, start, turning(0.1, start), float(dt[k]))
        assert (end[:, k].tolist(), last[:, k].tolist()) == (
            pytest.approx(alone[0], rel=1e-15, abs=0.0),
            pytest.approx(alone[1], rel=1e-14, abs=0.0),
        )
        assert error is alone[2] is None or error[:, k].tolist() == pytest.approx(alone[2], rel=1e-9, abs=1e-17)


@pytest.mark.parametrize("name", METHODS)
def test_the_angle_is_integrated_from_the_spin(name):
    """What acts along x acts about the axis, too: both go the same way, and so do their errors."""
    law = lambda t, s: (*(2 * (t - 3.0 * s[0] - 0.5 * s[2],)), t - 3.0 * s[5] - 0.5 * s[4])  # noqa: E731
    state = (0.2, 0.2, 1.0, 1.0, 1.0, 0.2)
    (x, y, vx, vy, spin, angle), _, error = METHODS[name].step_of(law, rotates=True)(0.5, state, law(0.5, state), 0.1)
    assert (x, vx) == (y, vy) == (angle, spin) != state[:2]
    assert error is None or (error[0], error[2]) == (error[1], error[3]) == (error[5], error[4]) != (0.0, 0.0)


@pytest.mark.parametrize("name", [name for name in METHODS if METHODS[name].by_hand])
@pytest.mark.parametrize(("law", "more"), [(turning, ()), (swinging, (0.8,))])
def test_a_step_by_hand_is_the_loop_over_the_table(name, law, more):
    state, t, dt = (1.0, -0.5, 0.7, 0.3, -2.0, *more), 0.3, 0.2
    by_hand, by_table = (
        method.step_of(law, rotates=len(more) > 0)(t, state, law(t, state), dt)
        for method in (METHODS[name], METHODS[name]._replace(by_hand=None))
    )
    for one, other in zip(by_hand, by_table, strict=True):
        assert one == pytest.approx(other, rel=1e-14, abs=1e-15)


@pytest.mark.parametrize("name", [name for name in METHODS if METHODS[name].controls_error])
def test_the_error_estimate_shrinks_with_its_order(name):
    """The pair's difference is the local error of the lower order p - 1: O(dt^p)."""
    state = (1.0, -0.5, 0.7, 0.3, 0.0)
    sizes = []
    for dt in (0.2, 0.1, 0.05):
        error = METHODS[name].step_of(turning)(0.0, state, turning(0.0, state), dt)[2]
        sizes.append(max(abs(component) for component in error))
    assert log(sizes[0] / sizes[1], 2) == pytest.approx(METHODS[name].order, abs=0.4)
    assert log(sizes[1] / sizes[2], 2) == pytest.approx(METHODS[name].order, abs=0.4)
