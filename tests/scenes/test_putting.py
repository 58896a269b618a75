"""Putting: a sloping green breaks a putt, and the hole holds what is slow enough for where it comes."""

from __future__ import annotations

import pytest

from tests.scenes.play import playing, results_of

putt, result_of = playing("putting"), results_of("putting")


def test_a_green_that_falls_the_other_way_breaks_the_other_way():
    green = {"green__grade": -2.0, "green__twist": 0.5, "launch__roll": 0.3, "hole__fastest": 0.01}
    one, other = (result_of(green__cross=2.0 * s, launch__angle=6.0 * s, **green | {"green__twist": 0.5 * s})
                  for s in (1.0, -1.0))  # fmt: skip
    for fact, sign in (("break", -1.0), ("aside", -1.0), ("speed_at_hole", 1.0), ("to_hole", 1.0)):
        assert one[fact] == pytest.approx(sign * other[fact], abs=1e-7), fact


@pytest.mark.parametrize("method", ["exact", "plain"])
def test_a_lip_out_is_an_event(method: str):
    """v > fastest (1 - (d / R)^2), with v below fastest itself."""
    run = putt("putting/lip-out", accuracy__method=method)
    over = next(event for event in run.events if event.kind == "over")
    limit = 1.63 * (1.0 - (run.result["aside"] / 0.054) ** 2)
    assert limit < over.speed < 1.63
    assert (run.result["verdict"], run.result["holed"], over.partner) == ("lip out", False, "hole")
    assert result_of("putting/straight", launch__speed=2.6, accuracy__method=method)["verdict"] == "over"


def test_minigolf_has_slopes_too():
    """On a lane that falls to its right the ball comes to rest at the lower board, in few impacts."""
    run = playing("minigolf")(mills=[], felt__cross=8.0, launch__speed=2.0, launch__angle=20.0)
    assert run.result["ended"] == "rest"
    assert run.result["bounces"] < 12
    assert run.state("ball", run.duration).y == pytest.approx(0.021335 - 0.45, abs=1e-9)
