"""Soccer from above."""

from __future__ import annotations

from math import asin, cos, exp, hypot, pi, radians, sin, tan
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sandbox
from sandbox.record import first_change, record
from sandbox.sport.amounts import roughly
from tests.reference.fit_soccer_lift import flight
from tests.scenes.play import playing

ALONE = {"wall.present": False, "keeper.present": False}
PRESETS = ["soccer-curl", "soccer-curl/beckham-2001", "soccer-curl/roberto-carlos-1997"]

kick = playing("soccer-curl")


# Presets ------------------------------------------------------------------------------------------------------------


def test_roberto_carlos_clears_the_wall_from_outside_the_goal():
    """Physics World 1998: clear of the wall by at least a metre, at a ball-boy metres outside, in by the right post."""
    run = kick("soccer-curl/roberto-carlos-1997")
    _, (_, y, *_) = next(run.crossings("ball", (9.15, 0.0), (-1.0, 0.0)))
    right_end_of_wall = -1.0
    assert right_end_of_wall - (y + 0.11) >= 0.95
    right_post = 2.0 - 3.66
    straight = -35.0 * 0.3057  # where the line of the launch meets the goal line, tan 17 deg
    assert straight < right_post - 5.0
    assert -3.66 < run.result["offset_at_goal"] < -2.66


def test_beckham_ends_in_the_left_corner():
    assert 2.66 < kick("soccer-curl/beckham-2001").result["offset_at_goal"] < 3.55


@pytest.mark.parametrize("name", PRESETS)
def test_without_spin_they_would_not_have_bent(name: str):
    result = kick(name, launch__spin=0, **ALONE).result
    assert result["deviation"] == pytest.approx(0.0, abs=1e-9)


# Exact cases --------------------------------------------------------------------------------------------------------


def test_constant_lift_without_drag_draws_a_circle():
    """Radius r = 2 m / (rho A Cl); x along the tangent it is r - (r^2 - x^2)^(1/2) aside, after r asin(x / r)."""
    run = kick(ball__drag__model="none", ball__lift={"model": "constant", "coefficient": 0.3}, launch__angle=0, **ALONE)
    radius = 2.0 * 0.43 / (1.204 * pi * 0.11**2 * 0.3)
    assert run.result["deviation"] == pytest.approx(radius - (radius**2 - 22.0**2) ** 0.5, abs=1e-6)
    assert run.result["flight_time"] == pytest.approx(radius * asin(22.0 / radius) / 27.0, abs=1e-7)
    assert run.result["speed_at_goal"] == pytest.approx(27.0, abs=1e-7)


def test_the_lean_of_the_axis_takes_its_cosine():
    """With constant coefficients a leaning axis is a smaller lift coefficient."""
    lift = {"model": "constant", "coefficient": 0.3}
    leaning = kick(ball__lift=lift, launch__tilt=60, **ALONE)
    upright = kick(
        ball__lift=lift | {"coefficient": 0.3 * cos(radians(60.0))}, wall__present=False, keeper__present=False
    )
    assert leaning.result["deviation"] == pytest.approx(upright.result["deviation"], rel=1e-12)


def test_what_the_view_from_above_leaves_out():
    """The same laws in three dimensions, integrated by scipy: alike without height, and as far off with it as the scene
    says in its first lines."""
    numbers, spin, (x, y) = np.array([0.301, 0.108]), 500.0 * pi / 30.0, (cos(radians(12.0)), -sin(radians(12.0)))
    ours = kick(**ALONE).result["offset_at_goal"]
    off = []
    for rise in (0.0, 10.0, 15.0, 20.0, 25.0):
        way = flight(27.0 * np.array([x, y, tan(radians(rise))]), numbers, rise > 0.0, spin)
        off.append(float(np.interp(22.0, *way.T)) - ours)
    assert off == pytest.approx([0.0, 0.01, 0.04, 0.08, 0.15], abs=0.005)
    assert off[0] == pytest.approx(0.0, abs=2e-4)


def test_a_ball_loses_spin_along_its_way():
    """w = w0 exp(-k s / r), whatever its speed; after 18 m 7.2 rev/s of 8, as filmed (Tsukada & Sakurai 2008)."""
    straight = {"launch__speed": 25, "launch__spin": 480, "launch__angle": 0, "ball__lift__model": "none"}
    run = kick(**straight, goal__distance=18, **ALONE)
    spin = next(run.crossings("ball", (18.0, 0.0), (-1.0, 0.0)))[1][4] / (2.0 * pi)
    assert spin == pytest.approx(8.0 * exp(-6.6e-4 * 18.0 / 0.11), rel=1e-6)
    assert 6.8 < spin < 7.6


# Properties ---------------------------------------------------------------------------------------------------------


@settings(max_examples=15, deadline=None)
@given(
    speed=st.floats(10, 45),
    angle=st.floats(-25, 25),
    spin=st.floats(-900, 900),
    wind=st.floats(-10, 10),
    aside=st.floats(-2, 2),
)
def test_mirror_image_in_mirror_image_out(speed: float, angle: float, spin: float, wind: float, aside: float):
    def played(side: float) -> dict[str, Any]:
        changes = {
            "launch.speed": speed,
            "launch.angle": side * angle,
            "launch.spin": side * spin,
            "air.wind": [0.0, side * wind],
            "wall.offset": side * aside,
            "keeper.offset": -side * aside,
            "keeper.speed": side * 1.0,
        }
        return kick(**changes).result

    one, other = played(1.0), played(-1.0)
    assert one["verdict"] == other["verdict"]
    for name in ("deviation", "offset_at_goal"):
        assert (one[name] is None) is (other[name] is None)
        if one[name] is not None:
            assert one[name] == pytest.approx(-other[name], abs=1e-9)
    assert one["flight_time"] == pytest.approx(other["flight_time"], abs=1e-9)


def test_a_ball_blown_back_from_the_line_is_no_goal():
    """A gale against the kick turns the ball on the line: over its middle, but not all of it over all of it."""
    outcomes: dict[bool, set[bool]] = {True: set(), False: set()}
    for hundredths in range(2840, 2940, 4):
        run = kick(launch__speed=hundredths / 100, launch__angle=0, launch__spin=0, air__wind=[-30, 0], **ALONE)
        furthest = run.trajectory("ball")[:, 1].max()
        if 22.0 < furthest < 24.0 - 0.12:
            outcomes[bool(furthest > 22.17)].add(run.result["goal"])
    assert outcomes == {True: {True}, False: {False}}


def test_the_headline_and_the_card_agree_on_how_wide():
    run = kick(launch__angle=-25, **ALONE)
    outside = -run.result["inside_post"]
    assert run.scene.verdict(run) == f"Wide by {roughly(outside)}"
    assert dict(run.scene.rows(run))["nearer post"].startswith(f"{outside:.2f}")


def test_a_keeper_hardly_moves_when_the_ball_meets_him():
    run = kick(keeper__offset=-1.4)
    _, _, vx, vy, _ = run.state("keeper", run.duration)
    assert 0.0 < vx < 0.3
    assert abs(vy) < 0.3


@pytest.mark.parametrize(("restitution", "friction"), [(0.3, 0.5), (0.5, 0.3), (0.3, 0.05)])
def test_the_keeper_answers_by_his_restitution_and_friction(restitution: float, friction: float):
    """Two bodies, rigid and with Coulomb's friction: n is the normal, m their common mass,
    J_n = (1 + e) m v_n and J_t = min(mu J_n, what it takes to stop the slip)."""
    run = kick(keeper__offset=-1.67, keeper__restitution=restitution, keeper__friction=friction, wall__present=False)
    hit = next(event for event in run.events if "keeper" in (event.ball, event.partner))
    (x, y, vx, vy, spin), after = run.before("ball", hit.t), run.state("ball", hit.t)
    kx, ky, ku, kv, turn = run.before("keeper", hit.t)
    ball, keeper = run.setup.balls
    reach = hypot(x - kx, y - ky)
    nx, ny = (x - kx) / reach, (y - ky) / reach
    approach = -((vx - ku) * nx + (vy - kv) * ny)
    slip = (vx - ku) * ny - (vy - kv) * nx + ball.radius * spin + keeper.radius * turn
    common = 1.0 / (1.0 / ball.mass + 1.0 / keeper.mass)
    push = (1.0 + restitution) * common * approach
    yielding = sum(1.0 / b.mass + b.radius**2 / b.inertia for b in (ball, keeper))
    rub = min(friction * push, abs(slip) / yielding)
    away = push * nx / ball.mass - rub * ny / ball.mass * (1 if slip > 0 else -1)
    assert approach == pytest.approx(hit.speed)
    assert after[2] == pytest.approx(vx + away, rel=1e-6)


def test_a_goal_narrower_than_the_ball_is_never_scored():
    assert all(not kick(goal__width=0.2, launch__angle=a).result["goal"] for a in (-10, -9, -8.5, -8.2, -8, -7.5))


def test_a_keeper_who_dives_sees_no_bend():
    """He goes along the line at u from his reaction time on, to where the ball's tangent of then passes him, at most as
    far as he reaches: he saves one ball, and another bends back behind him."""
    saved, missed = kick("soccer-curl/dive"), kick("soccer-curl/wrong-footed")
    assert (saved.result["saved"], missed.result["saved"], missed.result["goal"]) == (True, False, True)
    assert not kick("soccer-curl/dive", keeper__dive__dives=False).result["saved"]
    keeper = saved.setup.surfaces[-1]
    x, y, vx, vy, _ = saved.state("ball", 0.245)
    wanted = y + vy / vx * (20.5 - x)
    assert wanted < -1.7  # farther than he reaches
    for t in (0.245, 0.445, 5.0):
        assert keeper.at(t).shape.center == pytest.approx((20.5, 0.3 - min(3.9 * (t - 0.245), 2.0)))


def test_a_dive_in_a_mirror():
    left, right = (
        kick(keeper__dive={"dives": True}, launch__angle=side * 9.0, launch__spin=side * -300.0, wall__present=False,
             keeper__offset=side * -0.5)
        for side in (1, -1)
    )  # fmt: skip
    assert [event.t for event in left.events] == pytest.approx([event.t for event in right.events], abs=1e-9)
    assert left.result["verdict"] == right.result["verdict"]


#: A kick that clips the keeper: in no preset does the ball meet him.
OFF_THE_KEEPER = {"keeper.offset": -1.67}


@pytest.mark.parametrize("key", ["restitution", "friction", "mass", "radius"])
def test_a_thousandth_more_of_the_keeper_is_noticed(key: str):
    before = sandbox.load("soccer-curl", OFF_THE_KEEPER)
    more = 1.001 * getattr(before.parameters.keeper, key)
    after = sandbox.load("soccer-curl", {**OFF_THE_KEEPER, f"keeper.{key}": more})
    assert first_change(record(sandbox.simulate(before)), record(sandbox.simulate(after))) is not None
