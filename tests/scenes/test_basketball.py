"""Basketball in side view."""

from __future__ import annotations

from math import asin, atan, cos, degrees, exp, hypot, pi, radians, sin, tan
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import sandbox
from sandbox.lab.runs import runs
from scenes.basketball import hoop
from scenes.basketball.scene import aside_at, out
from tests.scenes.play import playing

#: Without the net's force, which bends the end of the way.
shoot = playing("basketball", net__slows=False)


def at_ring(**changes: Any) -> tuple[float, ...]:
    """State of a free throw where it comes down to the height of the ring, with ring and board out of the way."""
    away = {"hoop__height": 90, "backboard__bottom": 90, "backboard__top": 91}
    return next(shoot(**away, **changes).crossings("ball", (0.0, 3.05), (0.0, 1.0)))[1]


# Presets ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("level", ["fast", "balanced", "precise"])
def test_the_rattle_touches_the_rim_five_times_and_drops(level: str):
    result = shoot("basketball/rattle", accuracy__level=level).result
    assert result["touches"] == ["rim back", "rim front", "backboard", "rim front", "rim back", "rim front"]
    assert result["made"]


def test_free_throws_enter_as_coaches_want_them_to():
    """Coaches ask for 43 to 47 deg at the ring; 52 deg from a hand at 7 ft comes close."""
    assert shoot("basketball/free-throw").result["entry_angle"] == pytest.approx(43.0, abs=1.0)
    assert 43.0 < shoot("basketball/three-pointer").result["entry_angle"] < 50.0


def test_the_bank_shot_goes_in_over_the_speeds_its_file_says():
    for speed in (6.94, 6.98, 7.02, 7.06, 7.10):
        assert shoot("basketball/bank-shot", launch__speed=speed).result["touches"] == ["backboard"]


def test_the_brick_comes_back():
    run = shoot("basketball/brick")
    landed = next(event for event in run.events if event.partner == "floor")
    assert run.result["touches"] == ["rim front", "floor"]
    assert landed.x < 2.0


# Exact cases --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("distance", "height"), [(4.191, 2.1336), (7.24, 2.4), (2.0, 1.5)])
def test_smallest_speed_to_a_hoop_in_vacuum(distance: float, height: float):
    """At 45 deg + atan(h / d) / 2 it is v^2 = g (h + (h^2 + d^2)^(1/2)); at this speed no other angle gets there."""
    above = 3.05 - height
    best = 45.0 + 0.5 * degrees(atan(above / distance))
    speed = (9.81 * (above + hypot(above, distance))) ** 0.5
    vacuum = {"air__density": 0, "release__height": height, "launch__speed": speed}

    state = at_ring(launch__angle=best, **vacuum)
    assert state[0] == pytest.approx(distance, abs=1e-7)
    for angle in (best - 3.0, best - 1.0, best + 1.0, best + 3.0):
        assert at_ring(launch__angle=angle, **vacuum)[0] < distance - 1e-4


def test_smallest_entry_angle():
    """Without gravity and air, a ball of diameter b passes clean through a thin ring D wide only above asin(b / D)."""

    def verdicts(angle: float) -> set[str]:
        a = radians(angle)
        straight = {"gravity": 0, "ball__drag__model": "none", "launch__spin": 0, "hoop__tube_radius": 0.0005}
        return {
            shoot(
                launch__speed=8,
                launch__angle=-angle,
                hoop__distance=2.0,
                release__height=3.05 + 2.0 * tan(a) + aside,
                **straight,
            ).result["verdict"]
            for aside in (-0.001, -0.0005, 0.0, 0.0005, 0.001)
        }

    smallest = degrees(asin(0.2388 / 0.4572))
    assert "swish" not in verdicts(smallest - 0.1)
    assert "swish" in verdicts(smallest + 0.2)


def test_entry_angle_and_speed_in_vacuum_are_the_parabolas():
    speed, angle = 7.16, radians(52.0)
    result = shoot(launch__speed=speed, air__density=0).result
    vx, vy0 = speed * cos(angle), speed * sin(angle)
    falling = (vy0**2 - 2.0 * 9.81 * (3.05 - 2.1336)) ** 0.5
    assert result["verdict"] == "swish"
    assert result["entry_angle"] == pytest.approx(degrees(atan(falling / vx)), abs=1e-7)
    assert result["entry_speed"] == pytest.approx(hypot(vx, falling), abs=1e-9)
    assert result["entry_offset"] == pytest.approx(vx * (vy0 + falling) / 9.81 - 4.191, abs=1e-8)
    assert result["apex"] == pytest.approx(vy0**2 / (2.0 * 9.81), abs=1e-9)


def test_a_dropped_ball_keeps_its_restitution():
    run = shoot(launch__speed=0, launch__spin=0, ball__drag__model="none", release__height=1.8)
    impacts = [event.speed for event in run.events if event.kind == "impact"]
    assert impacts[0] == pytest.approx((2.0 * 9.81 * (1.8 - 0.1194)) ** 0.5, abs=1e-9)
    assert impacts[1] / impacts[0] == pytest.approx(0.76, abs=1e-9)


# What made means ----------------------------------------------------------------------------------------------------


def test_up_through_the_ring_and_down_again_does_not_count():
    """A ball scores from above (FIBA rules, art. 16): also where it was thrown straight up through the ring."""
    run = shoot(hoop__distance=0, release__height=1, launch__angle=90, launch__speed=7, launch__spin=0)
    assert (run.result["made"], run.result["verdict"], run.result["touches"]) == (False, "miss", [])
    assert run.scene.verdict(run) == "Up through the ring: it does not count"
    too_weak = shoot(hoop__distance=0, release__height=1, launch__angle=90, launch__speed=6, launch__spin=0).result
    assert too_weak["made"] is False


def test_no_free_throw_scores_from_below_wherever_the_ring_is():
    """Rings and boards moved and turned into each other's way, throws of all speeds and angles: the centre of a ball
    that is in is first between the edges on its way down. Without that rule some of these would count."""
    random, points = np.random.default_rng(1), []
    for _ in range(600):
        ring, below = random.uniform(2.2, 3.6), random.uniform(-0.3, 1.0)
        hoop = random.uniform(1.5, 3.0), ring, random.uniform(0.05, 0.8), ring - below, ring - below + 1.5
        points.append([random.uniform(3, 12), random.uniform(5, 88), random.uniform(1.5, 2.3), *hoop])
    keys = ["launch.speed", "launch.angle", "release.height", "hoop.distance", "hoop.height"]
    keys += ["backboard.gap", "backboard.bottom", "backboard.top"]
    made = [
        it for it in runs(sandbox.load("basketball/free-throw"), keys, points, asked=("made",)) if it.result["made"]
    ]
    assert len(made) > 10
    for run in made:
        hoop, half = run.scene.parameters.hoop, 0.5 * run.scene.parameters.width
        ways = {way: run.crossings("ball", hoop.middle, (0.0, way)) for way in (1.0, -1.0)}
        between = sorted((t, way) for way, all_ in ways.items() for t, at in all_ if abs(at[0] - hoop.distance) < half)
        assert between[0][1] == 1.0


def test_a_shot_is_decided_before_it_reaches_the_floor():
    """Through the ring, slowed by the net, or back down from inside it; or because it stays between ring and board, to
    come to rest there: then a run asked for its facts ends."""
    upwards = [
        ({"hoop.distance": 0.0, "release.height": 1.0, "launch.angle": 90.0, "launch.spin": 0.0}, speed)
        for speed in (7.0, 7.4, 7.6)
    ]
    stuck = [({}, speed) for speed in (7.970249, 7.9698058, 7.507273)]
    for changes, speed in [*upwards, ({}, 7.482), ({}, 7.5045), *stuck]:
        scene = sandbox.load("basketball", {**changes, "ball.lift.model": "spin-ratio"})
        asked = scene.facts_except_ended
        run = next(runs(scene, ["launch.speed"], [(speed,)], asked=asked))
        full = sandbox.simulate(scene.changed({"launch.speed": speed}))
        assert run.result == {key: full.result[key] for key in asked}
        assert run.state("ball", run.duration).y > 2.8
        assert run.ended == "until"
        assert full.ended == ("rest" if (changes, speed) in stuck else "until")


@pytest.mark.parametrize("speed", [7.3, 7.44, 7.45, 7.46, 7.5, 7.6])
def test_a_hoop_narrower_than_the_ball_runs_and_never_scores(speed: float):
    run = shoot(hoop__inner_diameter=0.2, launch__speed=speed)
    assert run.result["made"] is False
    assert run.ended in ("rest", "until")


def test_a_ball_may_come_to_rest_on_a_narrow_ring():
    run = shoot(hoop__inner_diameter=0.2, hoop__distance=0, release__height=3.25, launch__speed=0, launch__spin=0)
    assert run.ended == "rest"
    assert run.result["made"] is False
    assert set(run.result["touches"]) == {"rim front", "rim back"}


@settings(max_examples=20, deadline=None)
@given(speed=st.floats(7.0, 8.2), angle=st.floats(40, 65), spin=st.floats(-300, 300))
def test_made_is_what_the_path_says(speed: float, angle: float, spin: float):
    """Looked at from outside, on samples: the last time it is within the ring's edges near the plane, it goes down."""
    run = shoot(launch__speed=speed, launch__angle=angle, launch__spin=spin)
    result = run.result
    known = {"rim front", "rim back", "backboard", "bracket", "floor"}
    assert {event.partner for event in run.events} <= known
    path = run.trajectory("ball", every=1 / 2000)
    x, y = path[:, 1] - 4.191, path[:, 2] - 3.05
    crossed = (y[:-1] > 0.0) & (y[1:] <= 0.0) & (abs(x[:-1]) < 0.2286) & (abs(x[1:]) < 0.2286)
    assert result["made"] is bool(crossed.any() and y[-1] < -0.1194)
    assert (result["verdict"] == "miss") is (not result["made"])
    assert (result["verdict"] == "swish") is (result["made"] and not result["touches"])
    assert ("floor" in result["touches"]) is (not result["made"] and run.ended != "rest")


# Properties ---------------------------------------------------------------------------------------------------------


def test_a_faster_shot_goes_further():
    assert (np.diff([at_ring(launch__speed=v)[0] for v in (7.0, 7.2, 7.4, 7.6, 7.8)]) > 0.0).all()


def test_backspin_carries_and_comes_off_the_board_lower():
    """As the board drags its front down. Without lift spin plays no part in flight."""
    lifted = {"ball__lift__model": "spin-ratio"}
    assert (np.diff([at_ring(launch__spin=spin, **lifted)[0] for spin in (-180, 0, 180)]) > 0.05).all()
    assert at_ring(launch__spin=180)[:4] == pytest.approx(at_ring(launch__spin=-180)[:4], abs=1e-9)
    after = {}
    for spin in (150, 0, -150):
        run = shoot("basketball/bank-shot", launch__spin=spin)
        hit = next(event for event in run.events if event.partner == "backboard")
        after[spin] = run.state("ball", hit.t)[3]
    assert after[150] < after[0] < after[-150]


def test_what_air_is_worth_is_what_the_docstring_says():
    free_throw, doc = at_ring(), " ".join((sandbox.load("basketball").module.__doc__ or "").split())
    lifted = at_ring(ball__lift__model="spin-ratio")
    further = lifted[0] - free_throw[0]
    steeper = degrees(atan(-lifted[3] / lifted[2])) - degrees(atan(-free_throw[3] / free_throw[2]))
    assert f"carry the ball {100 * further:.1f} cm further and make it {steeper:.1f} deg steeper" in doc
    assert at_ring(launch__speed=7.44 + 0.0735)[0] == pytest.approx(lifted[0], abs=0.001)
    assert f"headwind, {-100 * (at_ring(air__wind=[-1, 0])[0] - free_throw[0]):.0f} cm shorter" in doc
    assert f"drag takes {100 * (at_ring(ball__drag__model='none')[0] - free_throw[0]):.0f} cm" in doc
    for coefficient, sign in ((0.45, 1), (0.55, -1)):
        assert at_ring(ball__drag__coefficient=coefficient)[0] - free_throw[0] == pytest.approx(sign * 0.04, abs=0.002)


def test_the_swish_is_as_wide_as_the_docstring_says():
    doc = " ".join((sandbox.load("basketball").module.__doc__ or "").split())
    ends = [shoot(launch__speed=speed).result for speed in (7.408, 7.481)]
    assert [result["verdict"] for result in ends] == ["swish", "swish"]
    short, beyond = (100 * result["entry_offset"] for result in ends)
    assert f"from {-short:.1f} cm short of the middle of the ring to {beyond:.1f} cm beyond it" in doc
    for speed in (7.405, 7.484):
        assert shoot(launch__speed=speed).result["touches"]


# The net ------------------------------------------------------------------------------------------------------------


def test_the_net_slows_a_ball_and_changes_nothing_before():
    assert sandbox.load("basketball").parameters.net.slows
    free, slowed = shoot(), shoot(net__slows=True)
    assert slowed.result["verdict"] == free.result["verdict"] == "swish"
    below = (0.0, 3.05 - 0.45)
    speeds = [hypot(*next(run.crossings("ball", below, (0.0, 1.0)))[1][2:4]) for run in (free, slowed)]
    assert 2.0 < speeds[1] < 0.5 * speeds[0]
    assert all(abs(state[0] - 4.191) < 0.2286 for _, state in slowed.crossings("ball", below, (0.0, 1.0)))
    assert at_ring(net__slows=True)[0] == pytest.approx(at_ring()[0], abs=1e-6)


def test_the_net_works_on_many_shots_at_once():
    net = sandbox.load("basketball", {"net.slows": True}).build().balls[0].forces[-1]
    xs, ys = np.array([4.191, 4.191, 4.0, 3.0, 4.41, 4.191]), np.array([2.8, 3.03, 2.9, 2.8, 2.8, 2.4])
    vx, vy = np.full(6, 1.5), np.full(6, -4.0)
    together = net(0.0, (xs, ys), (vx, vy), np.zeros(6))
    for i in range(6):
        alone = net(0.0, (float(xs[i]), float(ys[i])), (1.5, -4.0), 0.0)
        assert (together[0][i], together[1][i]) == pytest.approx(alone, abs=1e-15)
    assert together[1][0] == pytest.approx(0.624 * 6.0 * 4.0)
    assert together[0][0] == pytest.approx(-0.624 * 6.0 * 4.0 * 1.5)
    assert together[1][3] == together[1][5] == 0.0


# Bad input ----------------------------------------------------------------------------------------------------------


def test_a_ball_on_the_bracket_lies_half_a_tube_above_it():
    """The bracket, from the back of the ring to the board, is half as thick as the tube: README's "assumed"."""
    scene = sandbox.load("basketball")
    hoop = scene.parameters.hoop
    (bracket,) = [surface.shape for surface in scene.build().surfaces if surface.name == "bracket"]
    assert bracket.radius == 0.5 * hoop.tube_radius
    assert bracket.a[1] == bracket.b[1] == hoop.height


# The net ------------------------------------------------------------------------------------------------------------


def test_the_net_swings_after_the_ball_and_comes_to_rest():
    """At 11 rad/s, falling by exp(-3 t / s): half a period later it is on the other side, and smaller by that."""
    run = sandbox.simulate(sandbox.load("basketball/bank-shot"))
    assert run.result["made"]
    net = hoop.HangingNet(run, run.scene.parameters)
    down = np.linspace(0.0, 1.0, 5)
    ends = [net._shape(down, net.left + turn * pi / 11.0)[0] for turn in (1e-9, 0.5, 1.0, 2.0)]
    assert abs(ends[0][2]) > 1e-3
    assert ends[1] == pytest.approx(0.0 * down, abs=1e-9)
    assert ends[2] == pytest.approx(-ends[0] * exp(-3.0 * pi / 11.0), rel=1e-6)
    assert ends[3] == pytest.approx(ends[0] * exp(-6.0 * pi / 11.0), rel=1e-6)
    assert net._shape(down, net.left + 2.0)[0].tolist() == [0.0] * 5


# To the side --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("beside", "made"), [(0.0, True), (0.06, True), (0.09, True), (0.1095, False), (0.2, False)])
def test_a_ball_falls_through_where_it_has_room(beside: float, made: bool):
    """Straight down at the middle of its chord: the ball's centre may be R - r = 0.1092 m beside the ring's middle."""
    aside = np.degrees(np.arcsin(beside / 4.191))
    run = sandbox.simulate(sandbox.load("basketball", {"launch.side": aside, "launch.speed": 7.45}))
    assert run.result["made"] is made
    assert run.result["entry_aside"] == pytest.approx(beside, abs=1e-9)


def test_the_section_leaves_the_room_of_the_round_ring():
    parameters = sandbox.load("basketball", {"launch.side": 1.2}).parameters
    room, beside = parameters.clearance, 4.191 * np.sin(np.radians(1.2))
    along = 0.5 * parameters.section.inner_diameter - parameters.ball.radius
    assert np.hypot(along, beside) == pytest.approx(room, abs=1e-12)
    assert sandbox.load("basketball").parameters.section == sandbox.load("basketball").parameters.hoop


def test_left_and_right_are_alike_and_the_board_sends_it_further():
    changes = {"launch.speed": 7.84, "launch.angle": 50.0}
    left, right = (
        sandbox.simulate(sandbox.load("basketball", {**changes, "launch.side": side})) for side in (1.0, -1.0)
    )
    assert (left.result["verdict"], right.result["verdict"]) == ("bank", "bank")
    assert left.result["entry_aside"] == pytest.approx(-right.result["entry_aside"], abs=1e-12)
    through, it = out(left, left.scene.parameters), left.scene.parameters
    assert 1.05 < aside_at(through, left, it) / it.beside < 1.25


def test_scatter_to_the_side_makes_the_middle_the_best():
    """In the plane alone the best free throw is a bank shot; players know better."""
    by, best = {"launch.speed": "1%", "launch.angle": 1.0, "launch.spin": "20%"}, {}
    for aside in (0.0, 0.8):
        for how, changes in (("bank", {"launch.speed": 7.9, "launch.angle": 50.0}), ("direct", {"launch.speed": 7.45})):
            scene = sandbox.load("basketball", {**changes, "launch.aside": aside})
            found = sandbox.spread(scene, by, facts=("made",), samples=512, causes=False)
            assert ("launch.side" in [cause.key for cause in found.by]) == (aside > 0.0)
            best[how, aside] = found.shares["made"].value
    assert best["bank", 0.0] > best["direct", 0.0]
    assert best["direct", 0.8] > best["bank", 0.8]
