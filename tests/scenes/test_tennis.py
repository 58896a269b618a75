"""Tennis: in, long, net and short; what the court and the racket make of the ball."""

from __future__ import annotations

import pytest

from tests.scenes.play import results_of

shot = results_of("tennis")


def test_a_ball_that_grips_springs_back_along_the_court():
    """v' = v (1 - (1 + t) a / (1 + a)), with a = 0.55 and t = 0.1."""
    steep = {"launch__angle": -60.0, "launch__spin": 0.0, "launch__speed": 20.0, "release__place": 5.0}
    kept = shot(**steep, air__density=0.0, gravity=1e-3)["speed_kept"]
    assert kept == pytest.approx(1.0 - 1.1 * 0.55 / 1.55, abs=1e-4)
