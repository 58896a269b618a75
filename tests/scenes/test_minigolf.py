"""Minigolf: blade and gate decide, the hole holds what is slow enough, the next putt begins where one ended."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot, nan, sqrt

import pytest

import sandbox
from sandbox import Ball, Cloth, Setup, Trap
from sandbox.errors import RequestError
from tests.scenes.play import playing, results_of

putt, result_of = playing("minigolf"), results_of("minigolf")
SMOOTH = Cloth(sliding=0.0, rolling=0.0)


def test_the_blade_decides():
    made = [result_of(mills=[{"angle": angle}]) for angle in (30, 38, 45, 60, 75, 90)]
    assert [(result["holed"], result["struck"] > 0) for result in made] == [(True, False)] * 3 + [(False, True)] * 3


def test_a_blade_strikes_a_ball_that_lies_there():
    result = result_of(ball__x=-0.2, launch__speed=0.0)
    assert result["struck"] > 0
    assert result["time"] > 1.0


def test_a_gate_that_is_in_the_way_later():
    assert result_of("minigolf/gate")["holed"]
    assert result_of("minigolf/gate", gates=[{"x": 1.5, "phase": 90.0, "width": 0.3}])["struck"] == 1


def crossing(speed: float, aside: float, *, fastest: float = 1.63) -> bool:
    """True if a hole of 5 cm holds a ball that passes its middle at a distance in m."""
    ball = Ball("ball", mass=0.046, radius=0.02, position=(-1.0, aside), velocity=(speed, 0.0))
    traps = [Trap("hole", (0.0, 0.0), 0.05, fastest=fastest)]
    return sandbox.simulate(Setup([ball], traps=traps, plane=SMOOTH, duration=20.0)).caught_at("ball") is not None


@pytest.mark.parametrize("aside", [0.0, 0.02, -0.04])
def test_the_hole_holds_what_is_slow_enough(aside: float):
    """v <= 1.63 m/s (1 - (d / R)^2)."""
    limit = 1.63 * (1.0 - (aside / 0.05) ** 2)
    assert crossing(limit - 1e-6, aside)
    assert not crossing(limit + 1e-6, aside)


def test_a_ball_over_the_hole_keeps_its_motion():
    """As if there were no hole, and caught on its way back."""
    there, no = putt("minigolf/over-and-back"), putt("minigolf/over-and-back", hole__y=-0.3)
    board = next(event for event in there.events if event.partner == "board")
    assert board.t == pytest.approx(next(event.t for event in no.events if event.partner == "board"), abs=1e-12)
    assert there.caught_at("ball") > board.t
    assert [*there.before("ball", board.t)] == pytest.approx([*no.before("ball", board.t)], abs=1e-9)


def test_the_limit_must_be_positive():
    with pytest.raises(ValueError, match="trap 'hole': fastest = 0"):
        Trap("hole", (0.0, 0.0), 0.05, fastest=0.0)


def test_slow_felt_slows_as_a_stimpmeter_says():
    """v^2 - 2 c g s, and with c = 1.83^2 / (2 g stimp) that is v^2 - 1.83^2 s / stimp."""
    run = putt(mills=[], launch__roll=1.0, launch__speed=3.0, felt__rough_start=-2.0, felt__rough_end=-1.0)
    at = {x: next(state for _, state in run.crossings("ball", (x, 0.0), (-1.0, 0.0))) for x in (-2.0, -1.0)}
    before, after = (hypot(state[2], state[3]) for state in at.values())
    assert before == pytest.approx(sqrt(9.0 - 1.83**2 * 0.7 / 3.048), abs=1e-9)
    assert after == pytest.approx(sqrt(before**2 - 1.83**2 / (2.0 * 0.3048)), abs=1e-9)


def test_the_next_putt_begins_where_the_ball_stopped():
    scene = sandbox.load("minigolf/blocked")
    run = sandbox.simulate(scene)
    changes = scene.controls.next_start(run, scene.parameters)
    assert changes["putt"] == 2
    assert (changes["ball.x"], changes["ball.y"]) == run.state("ball", run.duration)[:2]
    second = sandbox.load("minigolf/blocked", changes)
    assert sandbox.simulate(second).result["putts"] == 2


def test_the_verdict_counts():
    holed = putt("minigolf/tap-in", putt=3)
    assert holed.scene.verdict(holed) == "Holed with putt 3"


def test_a_hole_off_the_lane_is_refused():
    with pytest.raises(RequestError, match=r"hole\.y = 0\.6 m: the lane is from -0\.45 to 0\.45 m"):
        putt(hole__y=0.6)


def test_a_ramp_decides():
    """Up a rise h a ball that rolls needs v^2 = 2 g h / (1 + k), and what friction takes."""
    ramp = {"felt__ramp_start": -1.0, "felt__ramp_end": 0.0, "felt__ramp_rise": 0.2, "mills": [], "launch__roll": 1.0}
    needed = sqrt(2.0 * (9.81 * 0.2 / 1.4 + 1.83**2 / (2.0 * 3.048) * 2.7))
    over, back = putt(**ramp, launch__speed=needed + 1e-6), putt(**ramp, launch__speed=needed - 1e-6)
    assert over.result["to_hole"] < 2.5
    assert back.state("ball", back.duration).x < -1.0
    assert putt("minigolf/ramp").result["holed"]
    with pytest.raises(
        RequestError, match=r"felt\.ramp_rise = 2 m: felt: a slope that pulls by 19\.6 m/s\^2 must pull"
    ):
        putt(**ramp | {"felt__ramp_rise": 2.0})


@pytest.mark.parametrize(
    ("name", "key", "values"),
    [
        ("minigolf", "mills[0].angle", range(25, 95, 5)),
        ("hockey/glove-save", "launch.angle", [8.0 + 0.4 * i for i in range(14)]),
        ("soccer-curl/dive", "launch.angle", [-16.0 + 0.3 * i for i in range(16)]),
    ],
)
def test_many_with_what_moves_are_as_each_alone(name: str, key: str, values: Sequence[float]):
    facts = [fact for fact in sandbox.load(name).units if fact not in ("touches", "ended")]
    together = sandbox.simulate_many(name, {key: list(values)}, facts=facts)
    alone = [sandbox.simulate(sandbox.load(name, {key: value})).result for value in values]
    assert len({tuple(sorted(map(str, result.values()))) for result in alone}) > 5
    for fact in facts:
        expected = [
            nan if result[fact] is None and isinstance(together[fact][0], float) else result[fact] for result in alone
        ]
        assert [*together[fact]] == pytest.approx(expected, abs=1e-12, nan_ok=True), fact
