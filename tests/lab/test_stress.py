"""The extremes: what is promised of the exact method is kept, and what is broken is seen."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from math import nan

import pytest

from sandbox.cli import main
from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS, resolve
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.motion import Motion, Sliding, Turning
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import box
from sandbox.engine.model.surface import Circle, Moving, Segment, Surface
from sandbox.engine.paths.run import Run
from sandbox.lab import stress as lab
from sandbox.lab.extremes import Extreme, of_scene, setups_without_scene
from sandbox.lab.report import as_text
from sandbox.lab.stress import FAILED, HELD, REFUSED, SENSELESS, Outcome, tried
from sandbox.physics.forces import Gravity
from sandbox.scene import load

#: Rows that take seconds, left to the command itself.
SLOW = {"1,000 balls in a pile", "mass ratio 1e+06", "an hour in a box, no loss"}

LEVEL_METHOD = "dormand-prince"  # of the three levels


def one(extreme: Extreme, method: str) -> Outcome:
    return next(outcome for outcome in tried("", extreme, methods=[method]))


BARE = {extreme.name: extreme for extreme in setups_without_scene()}


# What is promised ----------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", [name for name in BARE if name not in SLOW])
def test_the_levels_method_keeps_what_is_promised(name: str):
    outcome = one(BARE[name], LEVEL_METHOD)
    assert outcome.outcome in ((HELD, REFUSED) if BARE[name].makes_sense else (SENSELESS,)), outcome


@pytest.mark.parametrize("scene", ["golf", "soccer", "soccer-curl", "basketball", "minigolf"])
def test_scenes_hold_at_their_extremes(scene: str):
    outcomes = [
        outcome
        for extreme in of_scene(load(scene))
        if extreme.step is None and extreme.name != "an hour"
        for outcome in tried(scene, extreme, methods=[LEVEL_METHOD])
    ]
    assert len(outcomes) > 20
    assert [outcome for outcome in outcomes if outcome.outcome == FAILED] == []
    assert sum(outcome.outcome == HELD for outcome in outcomes) > 0.7 * len(outcomes)


def test_every_method_keeps_a_thin_wall():
    outcomes = list(tried("", BARE["wall of 0.1 mm at 340 m/s"]))
    assert {outcome.outcome for outcome in outcomes} == {HELD}
    assert max(outcome.penetration_m for outcome in outcomes) < 1e-8


def test_a_failure_of_the_plain_method_is_no_refusal():
    crate = Body("crate", mass=1.0, shape=box(0.02, 0.02), position=(0.0, 0.0), velocity=(900.0, 0.0))
    walled = Setup([crate], [Surface("wall", Segment((2.0, -9.0), (2.0, 1.0)), 0.5, 0.0)], duration=0.1)
    outcome = next(tried("", Extreme("fast box", lambda: walled, step=0.1), methods=["plain"]))
    assert (outcome.outcome, outcome.message.partition(":")[0]) == (FAILED, "tunnelled")


def test_overlaps_at_the_start_are_refused_with_both_names():
    outcome = one(BARE["start half inside a wall"], LEVEL_METHOD)
    assert outcome.outcome == SENSELESS
    assert "'ball'" in outcome.message
    assert "'floor'" in outcome.message


def test_a_nan_force_is_an_error_with_time_and_ball():
    for outcome in tried("", BARE["a force that is not a number"]):
        assert outcome.outcome == SENSELESS
        assert "t = " in outcome.message
        assert "'ball'" in outcome.message


# What is broken is seen ----------------------------------------------------------------------------------------------


def dropped(**changes: object) -> Setup:
    ball = Ball("ball", 1.0, 0.1, (0.0, 1.0), forces=[Gravity(9.81, 1.0)])
    floor = Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 0.8, 0.5)
    return replace(Setup([ball], [floor], duration=1.0), **changes)


def test_a_bounce_that_gains_energy_ends_the_run():
    lively = Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 1.0, 0.5)
    object.__setattr__(lively, "restitution", 1.2)
    outcome = one(Extreme("lively", lambda: dropped(surfaces=[lively])), LEVEL_METHOD)
    assert outcome.outcome == REFUSED
    assert "J appeared from nothing in the impact of 'ball', 'floor'" in outcome.message


def test_an_exception_of_another_kind_is_a_failure():
    def force(t: float, position: object, velocity: object, spin: object) -> tuple[float, float]:
        raise ZeroDivisionError("somebody's bug")

    ball = Ball("ball", 1.0, 0.1, (0.0, 1.0), forces=[force])
    outcome = one(Extreme("bug", lambda: Setup([ball])), LEVEL_METHOD)
    assert outcome.outcome == FAILED
    assert outcome.message == "ZeroDivisionError: somebody's bug"


def examined(monkeypatch: pytest.MonkeyPatch, run: Run) -> Outcome:
    """What is said of a run that the engine would not give."""
    monkeypatch.setattr(lab, "simulate", lambda setup, accuracy: run)
    return one(Extreme("forged", lambda: run.setup), LEVEL_METHOD)


@pytest.mark.parametrize(
    ("start", "velocity", "shape", "overlap", "through"),
    [
        ((-1.0, 0.0), (2.0, 0.5), Segment((0.0, -1.0), (0.0, 1.0)), 0.1, True),
        ((-1.0, 0.0), (0.8, 0.5), Segment((0.0, -1.0), (0.0, 1.0)), 0.0, False),
        ((-1.0, 3.0), (2.0, 0.0), Segment((0.0, -1.0), (0.0, 1.0)), 0.0, False),
        ((0.12, 0.0), (0.0, 0.1), Segment((0.0, -1.0), (0.0, 1.0), 0.05), 0.03, False),
        ((0.0, 1.13), (0.0, 0.1), Segment((0.0, -1.0), (0.0, 1.0), 0.05), 0.02, False),
        ((0.15, 0.0), (0.1, 0.0), Circle((0.0, 0.0), 0.1), 0.05, False),
    ],
)
def test_a_path_through_a_wall_and_an_overlap_are_seen(monkeypatch, start, velocity, shape, overlap, through):
    """The path of a ball of 0.1 m for a second, as it is without the surface."""
    run = simulate(Setup([Ball("ball", 1.0, 0.1, start, velocity)], duration=1.0), resolve())
    run.setup = replace(run.setup, surfaces=[Surface("wall", shape, 1.0, 0.0)])
    outcome = examined(monkeypatch, run)
    assert outcome.penetration_m == pytest.approx(overlap, abs=5e-3)
    assert outcome.left is through
    assert ("passed through wall" in outcome.message) is through
    assert outcome.outcome == (FAILED if overlap else HELD)


@pytest.mark.parametrize(
    ("motion", "overlap", "through"),
    [
        (Turning((0.0, 0.0), 2.0), 0.1, True),  # it passes over the ball that waits
        (Turning((0.0, 0.0), 0.2), 0.0, False),
        (Sliding((0.0, 0.55)), 0.05, False),
        (Sliding((0.0, 2.0)), 0.1, True),
    ],
)
def test_what_moves_is_looked_at_where_it_is(monkeypatch, motion: Motion, overlap: float, through: bool):
    """A ball of 0.1 m that waits at (0.5, 0.6) m for a second, as it does without the surface."""
    run = simulate(Setup([Ball("ball", 1.0, 0.1, (0.5, 0.6))], duration=1.0), resolve())
    run.setup = replace(
        run.setup, surfaces=[Moving(Surface("blade", Segment((0.0, 0.0), (1.0, 0.0)), 1.0, 0.0), motion)]
    )
    outcome = examined(monkeypatch, run)
    assert outcome.penetration_m == pytest.approx(overlap, abs=5e-3)
    assert outcome.left is through
    assert outcome.outcome == (FAILED if overlap else HELD)


def test_what_moves_may_drive_a_ball():
    bat = Moving(Surface("bat", Segment((-1.0, -1.0), (-1.0, 1.0)), 1.0, 0.0), Sliding((20.0, 0.0)))
    setup = Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0), (-1.0, 0.0))], [bat], duration=0.2)
    outcome = one(Extreme("bat", lambda: setup), LEVEL_METHOD)
    assert outcome.outcome == HELD
    assert outcome.energy_gained == pytest.approx(0.0, abs=1e-9)


def test_a_state_that_is_no_number_is_seen(monkeypatch: pytest.MonkeyPatch):
    run = simulate(dropped(), resolve())
    run.arcs["ball"][-1].end = (nan, 0.0, 0.0, 0.0, 0.0)
    assert "NaN" in examined(monkeypatch, run).message


@pytest.mark.parametrize(("deep", "outcome"), [(0.0, HELD), (0.01, FAILED)])
def test_of_a_body_its_outline_counts(monkeypatch: pytest.MonkeyPatch, deep: float, outcome: str):
    bodies = [Body(str(y), position=(0.0, y), shape=box(0.8, 0.2), mass=1.0) for y in (0.1, 0.3)]
    run = simulate(Setup(bodies, duration=0.01), resolve())
    run.setup = replace(run.setup, surfaces=[Surface("floor", Segment((-1.0, deep), (1.0, deep)), 0.5, 0.5)])
    found = examined(monkeypatch, run)
    assert found.outcome == outcome
    assert found.penetration_m == pytest.approx(deep, abs=1e-9)


def test_two_balls_in_each_other_are_seen(monkeypatch: pytest.MonkeyPatch):
    balls = [Ball("one", 1.0, 0.1, (0.0, 0.0)), Ball("other", 1.0, 0.1, (0.15, 0.0))]
    run = simulate(Setup(balls, duration=0.01), resolve(method="plain", step=1e-3))
    assert examined(monkeypatch, run).penetration_m > 0.01


def test_a_run_that_ends_with_all_balls_potted_is_looked_at_too():
    lone = {"balls": [{"name": "cue", "x": 0.9, "y": -0.3}, {"name": "1", "x": 1.0, "y": -0.4}], "cue.angle": -45.0}
    potted = load("billiards", {**lone, "cue.follow": 0.4})
    outcome = one(Extreme("cleared", potted.build), LEVEL_METHOD)
    assert outcome.outcome == HELD
    assert simulate(potted.build(), LEVELS["balanced"]).caught_at("cue") is not None


def test_a_heap_may_overlap_and_is_tried_with_few_integrators(monkeypatch):
    falling = load("collisions/dominoes", {"duration": 0.2})
    monkeypatch.setattr(lab, "of_scene", lambda scene: [Extreme("own", scene.build)])
    outcomes = {outcome.method: outcome for outcome in lab.stress([falling], with_bare=False)}
    assert outcomes.keys() == {"rk4", "dormand-prince", "plain"}
    assert outcomes[LEVEL_METHOD].outcome == HELD
    assert outcomes[LEVEL_METHOD].penetration_m > lab.OVERLAP


# The command ---------------------------------------------------------------------------------------------------------


def test_the_command_prints_json(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch):
    """Every 40th row: all of them take 20 s."""
    monkeypatch.setattr(lab, "of_scene", lambda scene: list(of_scene(scene))[::40])
    assert main(["stress", "soccer-curl", "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert {"scene", "extreme", "method", "outcome", "energy_gained", "penetration_m", "left", "message"} <= set(
        rows[0]
    )
    assert {row["method"] for row in rows} == set(lab.every_method())
    assert {row["scene"] for row in rows} == {"soccer-curl"}


def test_the_command_prints_failures_and_all_with_reasons():
    outcomes = [
        Outcome("golf", "wind", "rk4", HELD, "", 0.1, 1e-5, 2e-11),
        Outcome("golf", "wind", "plain", FAILED, "tunnelled: went through fairway", 0.1, 0.0, 0.1, True),
        Outcome("golf", "step 0.1 s", "plain", HELD, "", 0.1, 0.0, 0.1),
        Outcome("golf", "ball of 1 m", "rk4", SENSELESS, "ball.radius = 1: must be from 0.0005 to 0.5 m"),
        Outcome("golf", "ball of 1 m", "plain", HELD, "", 0.1, 0.0, 0.1),
    ]
    brief, text = ("\n".join(as_text(lab.report_of(outcomes), everything)) for everything in (False, True))
    assert re.search(r"wind +1 +1 +0.001 %", text)  # held by one method, failed by one
    assert "ball.radius" not in brief  # what is refused, and why
    assert re.search(r"plain +1 +0 +1", brief)  # not where it makes no sense
    assert brief.startswith("2 extremes of golf")
    assert "not counted, as they make no sense and are refused: 1" in brief
    for each in (brief, text):
        assert "failed, wind (plain): tunnelled: went through fairway" in each
    assert "senseless, ball of 1 m (rk4): ball.radius = 1" in text


def test_an_unknown_scene_is_refused(capsys: pytest.CaptureFixture[str]):
    assert main(["stress", "gulf"]) == 2
    assert "did you mean golf" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("integrator", "gained", "outcome"),
    [
        ("dormand-prince", 0.9e-3, HELD),
        ("dormand-prince", 1.1e-3, FAILED),
        ("rk4", 2.9e-2, HELD),
        ("rk4", 3.1e-2, FAILED),
    ],
)
def test_energy_may_grow_by_its_bound_and_no_more(
    monkeypatch: pytest.MonkeyPatch, integrator: str, gained: float, outcome: str
):
    """1e-3 with error control, 3e-2 with steps of a fixed length, of the largest energy."""
    monkeypatch.setattr(lab, "_energy_gained", lambda run: gained)
    assert (
        one(BARE["step 1/60 s"] if "step 1/60 s" in BARE else next(iter(BARE.values())), integrator).outcome == outcome
    )
