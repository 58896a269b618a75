"""Tennis: in, long, net and short; what the court and the racket make of the ball."""

from __future__ import annotations

import pytest

from tests.scenes.play import playing, results_of

shot = results_of("tennis")


def test_a_ball_that_grips_springs_back_along_the_court():
    """v' = v (1 - (1 + t) a / (1 + a)), with a = 0.55 and t = 0.1."""
    steep = {"launch__angle": -60.0, "launch__spin": 0.0, "launch__speed": 20.0, "release__place": 5.0}
    kept = shot(**steep, air__density=0.0, gravity=1e-3)["speed_kept"]
    assert kept == pytest.approx(1.0 - 1.1 * 0.55 / 1.55, abs=1e-4)


def rated(preset: str, **changes: float) -> float:
    """Pace rating of the court of a preset."""
    cannon = {"shot": "rally", "launch__speed": 30.8, "launch__angle": -15, "launch__spin": 0, "release__place": 13}
    return results_of(preset)(**cannon, release__height=0.5, **changes)["pace_rating"]


def test_courts_play_in_the_order_that_is_published():
    """Clay at most 29, hard 30 to 44, fast 45 and more; with the friction of clay a hard court would be slow."""
    assert rated("tennis/clay") < 29.5 < rated("tennis") < 44.5 < rated("tennis/grass")
    assert rated("tennis", court__friction=0.73) < 29.5


def test_the_pace_is_that_of_the_courts_own_numbers():
    """100 (1 - mu) + 150 (0.81 - e), e by the angle at which it lands."""
    for friction in (0.4, 0.5, 0.6):
        result = results_of("tennis/pace-test")(court__friction=friction)
        restitution = 0.83 - 0.0034 * (result["landing_angle"] - 16.0)
        wanted = 100.0 * (1.0 - friction) + 150.0 * (0.81 - restitution)
        assert result["pace_rating"] == pytest.approx(wanted, abs=1e-6)
        assert (result["landing_speed"], result["landing_angle"]) == pytest.approx((30.0, 16.0), abs=0.1)


def test_only_a_ball_as_in_the_test_rates_a_court():
    run = playing("tennis/pace-test")
    assert run().scene.verdict(run()) == "In, 11 m before the baseline; court pace 36, medium"
    for changes in ({"launch__speed": 27}, {"launch__angle": -18}, {"launch__spin": 200}):
        other = run(**changes)
        assert other.result["pace_rating"] is None
        assert "pace" not in other.scene.verdict(other)
