"""Baseball: over the fence or not, and how far, compared with what was measured."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from statistics import mean, stdev

import pytest

import sandbox
from sandbox.lab.against import Shots, read_against
from sandbox.lab.mapped import choices_of
from sandbox.lab.misfit import misfit
from sandbox.lab.statistics import Numbers
from tests.reference.fly_balls import errors, groups, read, straight_away
from tests.scenes.play import results_of

hit = results_of("baseball")


def test_tracked_fly_balls_are_right_on_average():
    """The same launch scatters by 16 ft in reality; without their sidespin the balls fly 19 ft too far."""
    balls = read()
    off = errors(balls)
    assert len(off) == 85
    assert abs(mean(off)) < 2.0
    assert stdev(off) < 15.0
    assert abs(mean(error for error, ball in zip(off, balls, strict=True) if ball.angle < 30)) < 3.0
    assert mean(errors(balls, sidespin=0.0)) > 15.0
    unknown = errors(straight_away(balls))
    assert (mean(unknown), stdev(unknown)) == pytest.approx((17.3, 17.7), abs=0.1)  # of who does not know the spray
    assert sum(map(len, groups(balls))) == 85


def test_the_spray_gives_an_average_balls_sidespin():
    """849 rpm straight away and 94 more per degree to the opposite field."""
    assert hit(launch__spray=10.0) == hit(launch__sidespin=1789.0)
    assert hit(launch__spray=-20.0) == hit(launch__sidespin=-1031.0)


def test_a_table_without_spray_is_right_on_average():
    """The 85 balls without their spray and spin; straight away, as before, they are 17 ft too far."""
    columns = {
        "launch.speed": "exit_speed_mph [mph]",
        "launch.angle": "launch_angle_deg [deg]",
        "distance": "distance_ft [ft]",
    }
    table = Path(__file__).parent.parent / "reference" / "fly_balls.csv"

    def off(**changes: float) -> Numbers:
        dotted = {key.replace("__", "."): value for key, value in changes.items()}
        shots = read_against(table, "baseball", replace(choices_of(columns, (), (), False), decided=tuple(dotted)))
        assert isinstance(shots, Shots)
        return misfit(shots, dotted).results[0].off

    assert off().mean == pytest.approx(1.3, abs=0.3)
    assert off(launch__spray=0.0).mean == pytest.approx(17.3, abs=0.1)
    assert off(launch__spin=2500.0, launch__sidespin=849.0).mean == pytest.approx(22.2, abs=0.1)


def test_sidespin_costs_distance_on_either_side():
    plain, right, left = (hit(launch__sidespin=rpm) for rpm in (0.0, 2500.0, -2500.0))
    assert right["distance"] == left["distance"] < plain["distance"] - 6.0
    assert right["launch_spin"] == plain["launch_spin"] == 2500.0


def test_sidespin_alone_lifts_nothing():
    """Drag grows with all spin, lift has the share of the backspin; S and the turn are those of both."""
    spun = sandbox.load("baseball", {"launch.spin": -1500.0, "launch.sidespin": 2000.0}).build().balls[0]
    assert spun.spin == pytest.approx(-2500.0 * 3.141592653589793 / 30)
    magnus = next(force for force in spun.forces if type(force).__name__ == "Magnus")
    assert magnus.coefficient.share == pytest.approx(0.6)
    assert hit(launch__spin=0.0, launch__sidespin=2000.0)["apex"] < hit(launch__spin=0.0, launch__sidespin=0.0)["apex"]


def test_drag_grows_with_the_spin_and_not_with_the_air():
    """Cd = 0.3008 + 0.0292 per 1,000 rpm, at any density."""
    for density in (0.9, 1.2):
        drag = next(
            force
            for force in sandbox.load("baseball", {"air.density": density}).build().balls[0].forces
            if type(force).__name__ == "Drag"
        )
        push = drag(0.0, (0.0, 1.0), (40.0, 0.0), 2000 * 3.141592653589793 / 30)[0]
        area = 3.141592653589793 * drag.radius**2
        assert -push / (0.5 * density * area * 1600.0) == pytest.approx(0.3008 + 2 * 0.0292, rel=1e-9)
