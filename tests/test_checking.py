"""A check says how far a result can be trusted: numbers that another start by a nanometre would change as well."""

from __future__ import annotations

import json
import re
from math import hypot, inf

import pytest

import sandbox
from sandbox import units
from sandbox.cli import main
from sandbox.engine.model.accuracy import LEVELS
from sandbox.scene.running import NUDGE, NUDGES, compare, nudged, simulate_at

#: Breaks, by the cue ball's place across the table (m), its speed (m/s) and its direction (deg).
BREAKS = [(0.2, 8.0, -8.938), (-0.23, 6.5, 10.6), (0.05, 9.5, -2.6)]


def broken(y: float, speed: float, angle: float, rolling: float = 0.005) -> sandbox.scene.Scene:
    return sandbox.load(
        "billiards",
        {
            "rack": "nine-ball",
            "balls": [{"name": "cue", "x": -0.635, "y": y}],
            "cue.speed": speed,
            "cue.angle": angle,
            "cloth.rolling_friction": rolling,
        },
    )


def apart(a: dict[str, list[float]], b: dict[str, list[float]]) -> float:
    """Largest distance in m of a ball from where it lies in the other result."""
    return max(hypot(a[name][0] - b[name][0], a[name][1] - b[name][1]) for name in a)


@pytest.mark.parametrize("shot", BREAKS)
def test_what_a_nanometre_changes_the_check_has_said(shot):
    y, speed, angle = shot
    scene = broken(y, speed, angle)
    run = sandbox.simulate(scene)
    check = sandbox.check(scene, run)
    for dy in (1e-9, -1e-9):
        other = sandbox.simulate(broken(y + dy, speed, angle)).result
        if set(other["positions"]) != set(run.result["positions"]):
            assert "positions" in {**check.changed_by_nudge, **check.chaotic}
        else:
            off = apart(run.result["positions"], other["positions"])
            assert off < check.errors.get("positions", inf)  # there is none where the finer run pots another ball
            assert off < 0.01 or "positions" in {**check.changed_by_nudge, **check.chaotic}


def test_a_finer_run_on_cloth_is_another_run():
    """Motion on cloth has no step; contact skin and hops are what the method leaves open."""
    check = sandbox.check("billiards/cut")
    assert 0.0 < check.errors["positions"] < 1e-4  # m
    assert (check.changed, check.changed_by_nudge, check.chaotic) == ({}, {}, {})


@pytest.mark.parametrize("level", LEVELS)
def test_finer_is_finer_in_everything(level):
    accuracy, finer = LEVELS[level], LEVELS[level].finer()
    for what in ("tolerance", "step", "settle", "hop", "skin"):
        assert getattr(finer, what) < getattr(accuracy, what)


def test_claimed_errors_hold():
    """Compared with far finer runs; small numbers, contacts and heaps among them."""
    exceeded, claimed = [], 0
    for name in ("golf/3-wood", "bullet", "bullet-water", "billiards/newtons-cradle", "collisions/cradle-3", "curling"):
        scene = sandbox.load(name)
        run = sandbox.simulate(scene)
        check, true = sandbox.check(scene, run), compare(run, simulate_at(scene, LEVELS["precise"].finer().finer()))
        for fact, twice in true.errors.items():
            if (
                fact not in check.chaotic
                and fact not in check.changed_by_nudge
                and run.scene.facts[fact].final_when != "start"
            ):
                claimed += 1
                exceeded += [(name, fact)] if 0.5 * twice > check.errors[fact] else []
    assert claimed > 30
    assert exceeded == []


def test_nudges_move_every_ball_its_own_way_by_a_nanometre():
    setup = sandbox.load("billiards").build()
    ways = set()
    for turn in range(NUDGES):
        for ball, moved in zip(setup.balls, nudged(setup, NUDGE, turn).balls, strict=True):
            dx, dy = moved.position[0] - ball.position[0], moved.position[1] - ball.position[1]
            assert hypot(dx, dy) == pytest.approx(NUDGE, rel=1e-3)
            ways.add((round(dx / NUDGE, 3), round(dy / NUDGE, 3)))
    assert len(ways) == NUDGES * len(setup.balls)


def test_card_and_json_say_what_is_chaotic(capsys, monkeypatch):
    """Of a break square on the rack, kept symmetric by rounding alone."""
    square = ("rack=nine-ball", 'balls=[{name = "cue", x = -0.635}]', "cue.angle=0")
    check = sandbox.check(broken(0.0, 8.0, 0.0))
    assert check.chaotic["positions"] > 1e-3  # m, a million times the nudge
    assert check.errors["positions"] >= check.spread["positions"]
    monkeypatch.setattr("sandbox.scene.check", lambda *arguments: check)
    run = ["run", "billiards", "--check", *(word for change in square for word in ("--set", change))]
    assert main(run) == 0
    out = " ".join(capsys.readouterr().out.split())
    amount = r"± ([\d.]+ m+)"
    said = rf"chaotic: positions {amount}; {NUDGES} runs from starts 1e-09 m away alone give {amount}"
    ((whole, nudged),) = re.findall(said, out)
    assert units.parse(nudged, "m") <= units.parse(whole, "m")
    assert out.count("positions") == 2  # in the warning that comes first, too: beyond what the accuracy aims at
    assert out.startswith("warning: ")
    assert main([*run, "--json"]) == 0
    report = json.loads(capsys.readouterr().out)
    assert report["nudges"]["size_m"] == NUDGE
    assert "positions" in report["nudges"]["chaotic"]
    assert report["nudges"]["spread"]["positions"] > 1e-3
    assert all(len(others) <= NUDGES for others in report["nudges"]["changed"].values())
