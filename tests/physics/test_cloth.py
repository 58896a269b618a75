"""A ball on cloth against the equations of sliding, rolling and spinning."""

from __future__ import annotations

from itertools import pairwise
from math import atan2, cos, hypot, inf, sin

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.physics.cloth import Cloth
from sandbox.physics.plane import PlaneMode, PlanePhase, PlaneState

R = 0.028575  # m
G = 9.81  # m/s^2
CLOTH = Cloth(sliding=0.2, rolling=0.01, spinning=0.0127, gravity=G)

speeds = st.floats(-10.0, 10.0)
spins = st.floats(-400.0, 400.0)
states = st.builds(lambda vx, vy, wz, wx, wy: (0.1, -0.2, vx, vy, wz, wx, wy), speeds, speeds, spins, spins, spins)


def advance(state: PlaneState, t: float, cloth: Cloth = CLOTH) -> PlaneState:
    """The state t s later, through as many phases as it takes."""
    for _ in range(10):
        phase = cloth.phase(state, R)
        if t <= phase.duration:
            return phase.after(t)
        state = phase.after(phase.duration)
        t -= phase.duration
    raise AssertionError("phases without end")


def way(state: PlaneState, cloth: Cloth = CLOTH) -> list[tuple[PlaneState, PlanePhase]]:
    """All phases to rest, each with the state at its beginning."""
    found = []
    while True:
        phase = cloth.phase(state, R)
        found.append((state, phase))
        if phase.duration == inf:
            return found
        state = phase.after(phase.duration)
        assert len(found) < 10


def slip(state: PlaneState) -> tuple[float, float]:
    _, _, vx, vy, _, wx, wy = state
    return vx - R * wy, vy + R * wx


def energy(state: PlaneState) -> float:
    """Per mass, in J/kg: v^2 / 2 + (2/5) r^2 w^2 / 2."""
    _, _, vx, vy, wz, wx, wy = state
    return 0.5 * (vx * vx + vy * vy) + 0.2 * R * R * (wx * wx + wy * wy + wz * wz)


# Sliding into rolling -------------------------------------------------------------------------------------------------


def test_a_ball_without_spin_comes_to_roll_at_5_7_of_its_speed():
    """t = 2 v / (7 mu g), x = 12 v^2 / (49 mu g): .291248 s and .499282 m for v = 2, mu = .2."""
    start = (0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0)
    phase = CLOTH.phase(start, R)
    assert phase.mode is PlaneMode.SLIDING
    assert phase.duration == pytest.approx(0.291248, abs=5e-7)
    assert phase.duration == pytest.approx(4.0 / (7.0 * 0.2 * G), rel=1e-15)
    rolls = phase.after(phase.duration)
    assert rolls[0] == pytest.approx(0.499282, abs=5e-7)
    assert rolls[0] == pytest.approx(12.0 * 4.0 / (49.0 * 0.2 * G), rel=1e-15)
    assert rolls[2] == pytest.approx(10.0 / 7.0, rel=1e-15)
    assert slip(rolls) == (0.0, 0.0)
    assert CLOTH.phase(rolls, R).mode is PlaneMode.ROLLING


def test_full_draw_from_rest_comes_back_at_2_7():
    """Stopped dead while it spins backward as a ball rolling at -v would: r w = -v, and it ends rolling at -2/7 v."""
    v = 2.0
    (_, _), (rolls, phase), _ = way((0.0, 0.0, 0.0, 0.0, 0.0, 0.0, -v / R))
    assert phase.mode is PlaneMode.ROLLING
    assert rolls[2] == pytest.approx(-2.0 / 7.0 * v, rel=1e-14)


@given(states)
def test_sliding_ends_at_5_7_of_v_and_2_7_of_the_spin(state: PlaneState):
    """Angular momentum about a line on the cloth is kept: v_end = (5/7) v + (2/7) r (wy, -wx)."""
    _, _, vx, vy, _, wx, wy = state
    end = next(start for start, phase in way(state) if phase.mode is not PlaneMode.SLIDING)
    assert end[2] == pytest.approx(5.0 / 7.0 * vx + 2.0 / 7.0 * R * wy, abs=1e-12)
    assert end[3] == pytest.approx(5.0 / 7.0 * vy - 2.0 / 7.0 * R * wx, abs=1e-12)
    assert hypot(*slip(end)) < 2e-12


@given(states, st.floats(0.0, 0.999))
def test_the_direction_of_slip_is_constant_while_it_slides(state: PlaneState, share: float):
    phase = CLOTH.phase(state, R)
    if phase.mode is not PlaneMode.SLIDING or hypot(*slip(state)) < 1e-6:
        return
    ux, uy = slip(state)
    later = slip(phase.after(share * phase.duration))
    turned = atan2(ux * later[1] - uy * later[0], ux * later[0] + uy * later[1])
    assert turned == pytest.approx(0.0, abs=1e-9)


def test_side_on_spin_bends_the_path_into_a_parabola():
    """Forward at v, the axis of spin along the way (wx): slip sqrt(v^2 + (r wx)^2), displacement a_y t^2 / 2 aside."""
    v, wx = 2.0, -100.0
    start = (0.0, 0.0, v, 0.0, 0.0, wx, 0.0)
    total = hypot(v, R * wx)
    phase = CLOTH.phase(start, R)
    ax, ay = -0.2 * G * v / total, 0.2 * G * R * 100.0 / total
    for share in (0.2, 0.5, 1.0):
        t = share * phase.duration
        x, y, vx, vy, *_ = phase.after(t)
        assert (x, y) == pytest.approx((v * t + 0.5 * ax * t * t, 0.5 * ay * t * t), rel=1e-14)
        assert (vx, vy) == pytest.approx((v + ax * t, ay * t), rel=1e-14)
    assert y > 0.05  # the spin that runs to the left carries it to the left
    rolls = phase.after(phase.duration)
    assert atan2(rolls[3], rolls[2]) == pytest.approx(atan2(2.0 / 7.0 * R * 100.0, 5.0 / 7.0 * v), rel=1e-14)


# Rolling, spinning, rest ----------------------------------------------------------------------------------------------


def test_a_rolling_ball_goes_straight_for_v2_over_2_mu_g():
    v, direction = 1.5, 0.7
    vx, vy = v * cos(direction), v * sin(direction)
    (_, phase), (rest, last) = way((0.0, 0.0, vx, vy, 0.0, -vy / R, vx / R))
    assert (phase.mode, last.mode) == (PlaneMode.ROLLING, PlaneMode.RESTING)
    assert phase.duration == pytest.approx(v / (0.01 * G), rel=1e-14)
    assert hypot(rest[0], rest[1]) == pytest.approx(v * v / (2.0 * 0.01 * G), rel=1e-14)
    assert atan2(rest[1], rest[0]) == pytest.approx(direction, abs=1e-14)
    assert rest[2:] == (0.0, 0.0, 0.0, 0.0, 0.0)


def test_a_rolling_ball_keeps_rolling_on_its_way():
    start = (0.0, 0.0, 1.2, -0.9, 3.0, 0.9 / R, 1.2 / R)
    for t in (0.01, 1.0, 5.0):
        assert hypot(*slip(advance(start, t))) < 1e-14


@pytest.mark.parametrize("wz", [60.0, -60.0])
def test_vertical_spin_decays_evenly_and_moves_nothing(wz: float):
    """|dwz/dt| = 5 mu_sp g / 2 r: 10.9 rad/s^2."""
    start = (0.3, 0.1, 0.0, 0.0, wz, 0.0, 0.0)
    rate = 2.5 * 0.0127 * G / R
    assert rate == pytest.approx(10.9, abs=0.01)
    (_, phase), (rest, last) = way(start)
    assert (phase.mode, last.mode) == (PlaneMode.SPINNING, PlaneMode.RESTING)
    assert phase.duration == pytest.approx(60.0 / rate, rel=1e-15)
    assert abs(phase.after(1.0)[4]) == pytest.approx(60.0 - rate, rel=1e-15)
    assert rest == (0.3, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0)


def test_spin_about_the_vertical_does_not_bend_the_path():
    plain = (0.0, 0.0, 2.0, 1.0, 0.0, 20.0, -50.0)
    spinning = (*plain[:4], 80.0, *plain[5:])
    for t in (0.1, 1.0, 5.0, 30.0):
        assert advance(spinning, t)[:4] == pytest.approx(advance(plain, t)[:4], abs=1e-12)


@given(states)
def test_a_ball_slides_then_rolls_then_spins_then_rests(state: PlaneState):
    modes = [phase.mode for _, phase in way(state)]
    order = list(PlaneMode)
    assert [order.index(mode) for mode in modes] == sorted(order.index(mode) for mode in modes)
    assert modes[-1] is PlaneMode.RESTING
    assert energy(way(state)[-1][0]) < 1e-23


# In any phase ---------------------------------------------------------------------------------------------------------


@given(states, st.lists(st.floats(0.0, 1.0), min_size=1, max_size=8), st.floats(0.0, 40.0))
def test_one_step_or_many_lead_to_the_same_state(state: PlaneState, cuts: list[float], total: float):
    times = [0.0, *sorted(cut * total for cut in cuts), total]
    at_once = advance(state, total)
    for a, b in pairwise(times):
        state = advance(state, b - a)
    assert state[:4] == pytest.approx(at_once[:4], abs=1e-12)
    assert [R * w for w in state[4:]] == pytest.approx([R * w for w in at_once[4:]], abs=1e-12)


@given(states)
def test_the_end_of_a_phase_is_where_the_motion_leads(state: PlaneState):
    for _, phase in way(state):
        if phase.duration == inf:
            break
        t = phase.duration
        before, end = phase.after(t * (1.0 - 1e-13)), phase.after(t)
        assert end[:4] == pytest.approx(before[:4], abs=1e-10)
        assert [R * w for w in end[4:]] == pytest.approx([R * w for w in before[4:]], abs=1e-10)
        assert phase.after(2.0 * t) == end
        assert phase.ends_motion or phase.ends_spin
        if phase.ends_spin:
            assert end[4] == 0.0


@given(states, st.floats(0.0, 20.0), st.floats(0.0, 20.0))
def test_energy_never_grows(state: PlaneState, first: float, second: float):
    before = advance(state, first)
    after = advance(before, second)
    assert energy(after) <= energy(before) * (1.0 + 1e-14)
    assert energy(before) <= energy(state) * (1.0 + 1e-14)


@given(states, st.floats(0.0, 20.0))
def test_the_mirror_image_moves_as_the_mirror_image(state: PlaneState, t: float):
    """Mirrored in the x axis: y, vy and, of the axial vector, wz and wx change sign; bit for bit."""

    def mirrored(s: PlaneState) -> PlaneState:
        x, y, vx, vy, wz, wx, wy = s
        return x, -y, vx, -vy, -wz, -wx, wy

    assert advance(mirrored(state), t) == mirrored(advance(state, t))


@pytest.mark.parametrize("angle", [0.3, 1.0, 2.5])
def test_no_direction_on_the_cloth_is_special(angle: float):
    c, s = cos(angle), sin(angle)

    def turned(state: PlaneState) -> tuple[float, ...]:
        x, y, vx, vy, wz, wx, wy = state
        return c * x - s * y, s * x + c * y, c * vx - s * vy, s * vx + c * vy, wz, c * wx - s * wy, s * wx + c * wy

    start = (0.0, 0.0, 1.0, 0.4, 30.0, -60.0, 20.0)
    for t in (0.05, 0.5, 4.0):
        assert advance(turned(start), t) == pytest.approx(turned(advance(start, t)), abs=1e-12)


def test_without_friction_nothing_ends():
    ice = Cloth(sliding=0.0, rolling=0.0, spinning=0.0)
    for state in (
        (0.0, 0.0, 1.0, 0.0, 5.0, 0.0, 0.0),
        (0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0 / R),
        (0.0, 0.0, 0.0, 0.0, 5.0, 0.0, 0.0),
    ):
        phase = ice.phase(state, R)
        assert phase.duration == inf
        assert phase.after(10.0) == (10.0 * state[2], 0.0, *state[2:])


def test_on_the_moon_it_slides_six_times_as_long():
    moon = Cloth(gravity=G / 6.0)
    start = (0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0)
    assert moon.phase(start, R).duration == pytest.approx(6.0 * CLOTH.phase(start, R).duration)
