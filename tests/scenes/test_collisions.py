"""The bench of collisions: what has to stay stays, and each preset shows what it is for."""

from __future__ import annotations

from math import cos, dist, radians
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sandbox
from sandbox.engine.ledger import ledger
from sandbox.engine.model.ball import kinetic
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError
from sandbox.picture.palette import palette, scene_colours
from sandbox.scene import load
from scenes.collisions.stepping import RULES, Rule, step_through


def run_of(name: str = "collisions", **changes: Any) -> Run:
    return sandbox.simulate(load(name, {key.replace("__", "."): value for key, value in changes.items()}))


def bench(*balls: dict[str, Any], **changes: Any) -> Run:
    return run_of(balls=list(balls), **changes)


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(0.05, 5.0), st.floats(-0.05, 0.05))
def test_momentum_stays_and_they_part_as_restitution_says(
    restitution: float, friction: float, mass: float, aside: float
):
    balls = {"name": "a", "x": -0.5, "y": aside, "vx": 2.0, "mass": mass}, {"name": "b", "vy": 0.01, "spin": 3.0}
    result = bench(*balls, contact__restitution=restitution, contact__friction=friction).result
    assert result["separation"] == pytest.approx(restitution * result["approach"], abs=1e-9)
    assert result["momentum_before"] == pytest.approx([2.0 * mass, 0.0017])
    assert result["momentum_after"] == pytest.approx(result["momentum_before"], abs=1e-9)
    assert 0.0 <= result["lost"] <= 100.0
    assert result["energy_before"] == pytest.approx(0.5 * mass * 4.0 + 0.085e-4 + 0.2 * 0.17 * (3.0 * 0.028575) ** 2)
    left = result["energy_before"] * (1.0 - 0.01 * result["lost"])
    assert result["energy_after"] == pytest.approx(left, rel=1e-9)
    if restitution == 1.0 and friction == 0.0:
        assert result["lost"] == pytest.approx(0.0, abs=1e-6)


def test_equal_masses_exchange_their_speeds_head_on():
    run = run_of("collisions/equal-masses")
    assert run.state("first", 0.8)[2:] == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)
    assert run.state("second", 0.8)[2:] == pytest.approx((2.0, 0.0, 0.0), abs=1e-12)


def test_an_inelastic_hit_loses_the_energy_of_the_approach():
    """1/2 mu v^2 of 1/2 m v^2: half for equal masses."""
    assert run_of("collisions/equal-masses", contact__restitution=0.0).result["lost"] == pytest.approx(50.0)


@pytest.mark.parametrize(("preset", "out"), [("cradle-3", 1), ("cradle-5", 1), ("cradle-two-lifted", 2)])
def test_as_many_balls_leave_a_cradle_as_come_in(preset: str, out: int):
    run = run_of(f"collisions/{preset}")
    t = next(event.t for event in run.events if event.kind == "impact") + 0.02
    speeds = [run.state(ball.name, t)[2] for ball in run.setup.balls]
    assert min(speeds[-out:]) > 0.6 * max(speeds)
    assert max(speeds[:-out]) < 0.25 * max(speeds)


@pytest.mark.parametrize("angle", [-20.0, 20.0, 160.0])
def test_a_cradle_pulled_at_an_angle_stays_on_its_strings(angle: float):
    run = run_of("collisions/cradle-5", launch__speed=0.5, launch__angle=angle)
    for ball in run.setup.balls:
        path = run.trajectory(ball.name, every=0.01)
        assert path[:, 2] == pytest.approx(0.0, abs=1e-6)
    assert run.state("first", 0.0)[2:4] == pytest.approx((0.5 * cos(radians(angle)), 0.0))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"launch__speed": 2.0}, r"'first' hangs on a string of 0\.25 m: .* at most 1\.57 m/s"),
        ({"balls[0].y": 0.01}, r"'first' hangs on a string: y = 0\.01 m must be 0 m"),
        ({"balls[2].vy": 0.1}, r"'3' hangs on a string: vy = 0\.1 m/s must be 0"),
        ({"balls[0].x": -0.3}, r"swings over the string's end"),
    ],
)
def test_what_strings_cannot_do_is_refused(changes: dict[str, Any], words: str):
    with pytest.raises(RequestError, match=words):
        run_of("collisions/cradle-5", **changes)


def test_strings_are_drawn_as_long_as_they_are():
    """0.2 m aside on a string of 0.25 m: drawn 0.15 m below its end, not 0.25."""
    run = run_of("collisions/cradle-3", **{"balls[0].x": -0.2})
    view = run.scene.picture(run, (640, 360))
    name, tied = view.strings[0]
    for t in np.linspace(0.0, run.duration, 40):
        at = np.array([run.state(name, t)[:2]])
        (drawn,), end = view.spots(view.camera, at, 0.0, name), view.camera.pixel(*tied)
        assert dist(drawn, end) / view.camera.scale == pytest.approx(0.25, rel=1e-6)


def test_a_dropped_ball_leaps_off_another():
    """One impact after another: the floor turns the large one round, e V; then the small one."""
    run = run_of("collisions/ball-on-ball")
    m, big, e, floor = 0.058, 0.6, 0.75, 0.8
    down = (2 * 9.81 * 0.5) ** 0.5
    small = run.before(
        "first",
        next(
            event.t
            for event in run.events
            if event.partner == "second" or (event.ball == "second" and event.partner == "first")
        ),
    )[3]
    expected = (m * small + big * floor * down + big * e * (floor * down - small)) / (m + big)
    assert run.result["first_after"] == pytest.approx(expected, rel=0.02)
    assert run.highest("first")[1][1] > 2 * 0.78


def test_the_rack_stays_symmetric():
    run = run_of("collisions/triangle")
    for above, below in (("second", "second"), ("3", "4"), ("12", "16"), ("13", "15")):
        x, y, *_ = run.state(above, 0.3)
        u, v, *_ = run.state(below, 0.3)
        assert (x, y) == pytest.approx((u, -v), abs=1e-7)


def test_balls_in_a_bowl_come_to_rest():
    run = run_of("collisions/bowl")
    assert run.ended == "rest"
    assert all(-0.3 < run.state(ball.name, run.duration)[0] < 0.3 for ball in run.setup.balls)


def test_the_headline_says_of_which_hit_it_tells():
    """4 % are lost in the first of many; and all energy until the balls lie still."""
    assert run_of("collisions/bowl").scene.verdict(run_of("collisions/bowl")).endswith("4 % lost, later all of it")
    several, one = run_of("collisions/cradle-5"), bench({"name": "first", "x": -0.2}, {"name": "second"})
    assert several.scene.verdict(several).endswith("% lost in the first hit")
    assert one.scene.verdict(one).endswith("lost")
    for restitution, lost in ((1.0, "nothing"), (0.9993, "0 %"), (0.99, "1 %")):  # 0, 0.07 and 1 %
        hit = run_of("collisions/equal-masses", contact__restitution=restitution)
        assert hit.scene.verdict(hit).endswith(f"; {lost} lost")


def test_a_blow_that_is_shown_beside_its_place_has_a_card():
    run = run_of("collisions/cradle-5")
    picture = run.scene.picture(run, (640, 360))
    poster = picture.poster()
    rect = dict(picture.sheet.written)["the blow after 0.25 s"]
    ground, card = scene_colours(str(run.scene.folder / "picture.py"))["board"], palette("card")["background"]
    corners = [poster.get_at(corner)[:3] for corner in (rect.topleft, rect.midbottom)]
    assert all(dist(corner, card) < dist(corner, ground) for corner in corners)


def test_no_two_balls_that_meet_is_said():
    run = bench({"name": "first", "y": 0.2}, {"name": "second"})
    assert run.scene.verdict(run) == "No two balls meet"
    assert run.result["velocities"] == {"first": [2.0, 0.0], "second": [0.0, 0.0]}


def test_the_launch_is_for_its_ball_without_a_listed_velocity():
    for name, listed, speed in (("a", {}, 0.0), ("first", {"vx": 0.5}, 0.5), ("first", {"vy": 0.0}, 0.0)):
        result = bench({"name": name, "x": -0.5, **listed}, {"name": "b", "x": 30.0}).result
        assert result["velocities"][name] == [speed, 0.0]
    assert (
        bench({"name": "b", "x": 1.0}, {"name": "first"}, launch__angle=180.0).result["velocities"]["first"][0] == -2.0
    )


@pytest.mark.parametrize("preset", ["boxes-head-on", "corner-on-face", "dominoes", "pin-hit-low", "pin-hit-high"])
def test_bodies_separate_by_restitution_and_keep_momentum(preset: str):
    run = run_of(f"collisions/{preset}")
    result = run.result
    assert result["separation"] == pytest.approx(
        run.scene.parameters.contact.restitution * result["approach"], abs=2e-3
    )
    assert 0.0 <= result["lost"] < 100.0
    if not run.scene.parameters.gravity:
        assert result["momentum_after"] == pytest.approx(result["momentum_before"], abs=1e-9)


def test_a_row_of_dominoes_falls():
    run = run_of("collisions/dominoes")
    names = [box.name for box in run.scene.parameters.boxes]
    falls = [next(e.t for e in run.events if name in (e.ball, e.partner) and "floor" not in e) for name in names]
    assert falls == sorted(falls)
    assert all(run.angle(name, run.duration) < -1.0 for name in names)
    book = ledger(run)
    assert 0.0 <= book.contacts["position correction"] < 0.02 * book.work["gravity"]


def test_the_floor_does_not_pull_a_pin_that_leaves_it():
    """A step of another length once began with impulses of the one before that no iteration could undo: 4 % less."""
    momenta = [
        sandbox.simulate("collisions/pin-hit-low", accuracy=level).result["momentum_after"]
        for level in ("balanced", "precise")
    ]
    assert momenta[0] == pytest.approx(momenta[1], rel=1e-3)


def test_a_pin_hit_low_falls_to_the_ball_and_hit_high_away():
    low, high = (run_of(f"collisions/pin-hit-{where}").state("pin", 0.06)[4] for where in ("low", "high"))
    assert low > 10.0
    assert high < -10.0


def test_the_strip_between_boxes_says_why_they_touch_or_not():
    run = run_of("collisions/boxes-head-on")
    from scenes.collisions.boxes import strip

    t = run.events[0].t
    assert strip(run, 0.0).why == "first and second are 40.0 cm apart"
    assert "in touch along a side" in strip(run, t).why
    assert len(strip(run, t).met.points) == 2


@pytest.mark.parametrize("preset", ["bowl", "dominoes"])
def test_a_long_headline_is_as_large_as_any(preset: str):
    run = run_of(f"collisions/{preset}")
    picture = run.scene.picture(run, (1280, 720))
    for _ in picture.layers():
        pass
    text, _, room = picture.heading
    assert picture.sheet.lettering.width(text, "large", bold=True) <= room


def test_of_balls_and_boxes_a_file_has_only_those_that_it_gives(tmp_path: Path):
    """Otherwise the default balls lie where its boxes do."""
    file = tmp_path / "heap.toml"
    file.write_text('scene = "collisions"\nboxes = [{ name = "a", y = 0.5 }]\n', encoding="utf-8")
    assert [body.name for body in sandbox.load(file).build().balls] == ["a"]
    assert len(sandbox.load("collisions/dominoes", {"balls[0].mass": 0.05}).build().balls) > 5


def test_a_heavy_body_on_a_light_one_in_a_bowl_gains_no_energy():
    """222 J became 4,399 J: 76.8 kg came down on 0.4 kg."""
    light = {"name": "a", "shape": "box", "x": -0.01, "y": 0.5, "angle": 7, "width": 0.25, "height": 0.08, "mass": 0.4}
    heavy = {"name": "b", "shape": "capsule", "x": -0.09, "y": 0.9, "angle": -162, "width": 0.14, "height": 0.15}
    bowl = {"shape": "bowl", "radius": 0.35, "restitution": 0.55, "friction": 0.84}
    bounces = {"contact__restitution": 0.33, "contact__friction": 0.57, "launch__ball": ""}
    floor = {f"floor__{key}": value for key, value in bowl.items()}
    run = run_of(balls=[], boxes=[light, {**heavy, "mass": 76.8}], gravity=9.81, duration=1.0, **bounces, **floor)
    moving = [energy_at(run, t, 0.0) for t in np.linspace(0.0, run.duration, 101)]
    whole = [energy_at(run, t, 9.81) for t in np.linspace(0.0, run.duration, 101)]
    assert max(whole) <= whole[0] + 1e-3 * max(moving)


def energy_at(run: Run, t: float, gravity: float) -> float:
    states = [(ball, run.state(ball.name, t)) for ball in run.setup.balls]
    return sum(kinetic(ball, state) + ball.mass * gravity * state[1] for ball, state in states)


def test_only_the_naive_rule_exchanges_at_each_step():
    """Found 3 cm deep at 0.2 s, 1 cm a step: the naive rule turns them back before they are out, 61 times until 0.8 s.
    Equal masses part by the approach of 1 m/s times the time since the exchange, less the depth that is not mended."""
    result = run_of("collisions/overlapping").result
    assert result["exchanges"] == {"naive": 61, "approach": 1, "push": 1, "exact": 1}
    assert result["gaps"] == pytest.approx({"naive": -0.03, "approach": 0.57, "push": 0.6, "exact": 0.63}, abs=1e-9)


def test_with_short_steps_all_rules_agree_if_elastic():
    result = run_of("collisions/overlapping", stepping__first=0.0, balls=OBLIQUE).result
    assert set(result["exchanges"].values()) == {1}
    assert result["gaps"] == pytest.approx(dict.fromkeys(result["gaps"], result["gaps"]["exact"]), abs=0.02)


def test_the_naive_rule_holds_fast_what_loses_speed():
    """Without a stall: found 1 cm deep at 0.18 s, the 15th of 66 looks, they part by 3.6 mm until the next."""
    changes = {"stepping__first": 0.0, "stepping__step": 0.012, "contact__restitution": 0.3}
    result = run_of("collisions/overlapping", **changes).result
    assert result["exchanges"] == {"naive": 52, "approach": 1, "push": 1, "exact": 1}
    assert result["gaps"]["naive"] < 0.0 < result["gaps"]["approach"] < result["gaps"]["push"]


OBLIQUE = [
    {"name": "first", "x": -0.25, "y": 0.03, "radius": 0.04, "mass": 0.3},
    {"name": "second", "radius": 0.04, "mass": 0.1},
]


@pytest.mark.parametrize("rule", RULES.values(), ids=RULES)
def test_a_rule_at_a_fixed_step_keeps_momentum_and_center(rule: Rule):
    setup = load("collisions/overlapping", {"balls": OBLIQUE}).build()
    one, other = setup.balls
    run = step_through((one, other), 0.5, rule, step=0.01, first=0.2, duration=0.8)
    masses = np.array([one.mass, other.mass])
    center = np.einsum("i,tij->tj", masses, run.places) / masses.sum()
    assert center[:, 0] == pytest.approx(center[0, 0] + 0.75 * run.times, abs=1e-12)
    assert center[:, 1] == pytest.approx(center[0, 1], abs=1e-12)
    assert run.exchanges[0] == 1


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"gravity": 9.81}, r"gravity = 9\.81: the rules of stepping\.step have none"),
        ({"contact__friction": 0.2}, r"contact\.friction = 0\.2: the rules"),
        ({"floor__shape": "flat"}, r"floor\.shape = flat: the rules"),
        ({"balls": [{"name": "first"}]}, r"stepping\.step: must be left out unless there are two balls"),
    ],
)
def test_what_the_rules_at_a_fixed_step_lack_is_refused(changes: dict[str, Any], words: str):
    with pytest.raises(RequestError, match=words):
        run_of("collisions/overlapping", **changes)
