"""What a setup says by the names of balls and surfaces: the law of a pair, and what ends the run."""

from __future__ import annotations

from typing import Any

import pytest

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup, Touches
from sandbox.engine.model.surface import Bounce, ConstantBounce, Segment, Surface
from sandbox.physics.forces import Gravity
from sandbox.physics.ice import Glide

FLOOR = Surface("floor", Segment((-100.0, 0.0), (100.0, 0.0)), restitution=0.8, friction=0.0)


@pytest.mark.parametrize("method", ["exact", "plain"])
@pytest.mark.parametrize("order", [("a", "b"), ("b", "a")])
def test_a_pair_of_balls_answers_by_its_own_law(method: str, order: tuple[str, str]):
    """Equal balls in a line: with restitution e the struck one leaves with (1 + e) / 2 of the speed."""
    balls = [
        Ball("a", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0)),
        Ball("b", 1.0, 0.1, (0.5, 0.0)),
        Ball("c", 1.0, 0.1, (3.0, 0.0), (0.0, 1.0)),
        Ball("d", 1.0, 0.1, (3.0, 1.0)),
    ]
    setup = Setup(balls, duration=1.5, pairs=[(*order, ConstantBounce(Bounce(0.4, 0.0)))])
    run = simulate(setup, resolve(method=method, step=1e-3 if method == "plain" else None))
    assert run.state("b", 1.5)[2] == pytest.approx(0.7, abs=1e-6)
    assert run.state("d", 1.5)[3] == pytest.approx(1.0, abs=1e-6)  # all others as between_balls says: elastic


@pytest.mark.parametrize("method", ["exact", "plain"])
@pytest.mark.parametrize("times", [1, 2, 3])
def test_a_run_ends_at_the_touch_that_was_asked_for(method: str, times: int):
    """From h it is down after sqrt(2 h / g), and the bounce after the n-th touch takes 2 e^n of that."""
    g, h, e = 9.81, 1.0, FLOOR.restitution
    ball = Ball("ball", 1.0, 0.1, (0.0, h + 0.1), forces=[Gravity(g, 1.0)])
    setup = Setup([ball], [FLOOR], until=Touches("floor", times))
    run = simulate(setup, resolve(method=method, step=1e-4 if method == "plain" else None))
    fall = (2.0 * h / g) ** 0.5
    assert run.ended == "until"
    assert run.duration == pytest.approx(fall * (1.0 + 2.0 * sum(e**n for n in range(1, times))), abs=2e-3)


LAW = ConstantBounce(Bounce(0.4, 0.0))


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"pairs": [("a", "frog", LAW)]}, "setup: pairs: there is no ball 'frog'; there are 'a', 'b'"),
        ({"pairs": [("a", "a", LAW)]}, "setup: pairs: .* names one ball twice"),
        ({"pairs": [("a", "b", LAW), ("b", "a", LAW)]}, "setup: pairs: two laws for 'b' and 'a'"),
        ({"pairs": [("a", "b")]}, "setup: pairs: .* must be \\(ball, ball, law\\)"),
        ({"planes": [("frog", Glide(0.1))]}, "setup: planes: there is no ball 'frog'"),
        ({"planes": [("a", Glide(0.1)), ("a", Glide(0.2))]}, "setup: planes: two laws for 'a'"),
    ],
)
def test_laws_are_for_balls_that_there_are(given: dict[str, Any], said: str):
    balls = [Ball("a", 1.0, 0.1, (0.0, 0.0)), Ball("b", 1.0, 0.1, (1.0, 0.0))]
    with pytest.raises(ValueError, match=said):
        Setup(balls, plane=Glide(0.2), **given)
