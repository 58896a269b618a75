"""Other minima of a fit: data that two values explain, exactly or nearly, of which one is found first."""

from __future__ import annotations

import json
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import pytest

import sandbox
from sandbox.lab.axes import Span
from sandbox.lab.fit.descent import descend
from sandbox.lab.fit.intervals import errors_of
from sandbox.lab.fit.loss import SQUARES, TUKEYS, Loss
from sandbox.lab.fit.problem import Problem
from sandbox.lab.fit.rivals import Weighted, rivals
from sandbox.lab.fit.squares import solve
from sandbox.lab.report import as_json, as_text

FIRST, SECOND = 10.0, 13.0  # m/s


@dataclass(frozen=True)
class TwoRoots:
    """Residuals ``e + (v - 10) (v - 13) s / 2``, whose sum of squares is the same at 10 and 13, and one of
    ``tilt (v - 13)``, which is 0 at 13 only."""

    tilt: float = 0.0
    count = 41
    runs = 1
    what = "point"
    names = ("x",)
    units = ("m",)
    free = ()
    left_out = unused = ()
    alike = MappingProxyType({})
    rows = np.arange(1, 42)
    groups = np.zeros(41, dtype=int)
    times = np.full(41, np.nan)

    def check(self, scene):
        pass

    def residuals(self, scene, keys, values, until):
        errors = np.random.default_rng(3).normal(0.0, 1.0, 40)
        slopes = np.random.default_rng(4).choice([-1.0, 1.0], 40)
        speed = values[:, :1]
        left = errors + 0.5 * (speed - FIRST) * (speed - SECOND) * slopes
        return np.hstack([left, self.tilt * (speed - SECOND)])

    def points(self, scene, free):
        return None

    def remarks(self, scene, free):
        return ()


def rivals_of(speed: float, tilt: float, loss: Loss = SQUARES) -> list[tuple[float, float]]:
    """The rivals of the minimum near a speed: how much more chi^2 is, and their speeds."""
    problem, sds = Problem(sandbox.load("throws"), TwoRoots(tilt), [Span("launch.speed", 0.0, 30.0)]), np.ones(41)
    place = descend(problem, np.array([speed / 30.0]), sds, loss)
    errors = errors_of(place.residuals, place.slopes, sds, problem.measured.groups, loss)
    found = rivals(Weighted(problem, sds, loss), place, errors)
    return [(more, float(problem.values(other.share)[0])) for more, other in found]


@pytest.mark.parametrize("loss", [SQUARES, TUKEYS], ids=lambda loss: loss.name)
@pytest.mark.parametrize("tilt", [0.0, 0.8])
def test_a_second_minimum_is_found_from_the_first(tilt: float, loss: Loss):
    """At 13 chi^2 is less by what the tilted residual, 3 tilt, costs."""
    ((more, speed),) = rivals_of(FIRST, tilt, loss)
    assert speed == pytest.approx(SECOND, abs=0.1)
    assert more == pytest.approx(-2.0 * float(loss.cost(np.array(3.0 * tilt))), abs=0.6)


@pytest.mark.parametrize(("tilt", "count"), [(0.8, 1), (1.2, 0)])  # at 10 chi^2 is 5.8 and 13 more
def test_a_minimum_that_explains_far_less_is_no_rival(tilt: float, count: int):
    assert len(rivals_of(SECOND, tilt)) == count


def test_values_that_explain_the_data_as_well_are_said():
    scene = sandbox.load("throws", {"launch.speed": FIRST})
    followed: list[tuple[int, int]] = []
    spans = [Span("launch.speed", 0.0, 30.0)]
    problem = Problem(scene, TwoRoots(0.01), spans, progress=lambda done, total: followed.append((done, total)))
    found = solve(problem)
    assert followed[0][0] == 0 < followed[0][1]  # starts that were followed, of how many
    (other,) = found.others
    assert {round(found.values["launch.speed"].value), round(other.values["launch.speed"])} == {10, 13}
    said = " ".join(line.strip() for line in as_text(found.report()))
    assert f"other values explain these points as well: launch.speed = {other.values['launch.speed']:.2f}" in said
    assert json.loads(as_json(found.report()))["others"][0]["chi2_more"] == pytest.approx(other.more)


def test_the_better_of_two_minima_is_the_fit():
    scene = sandbox.load("throws", {"launch.speed": FIRST})
    found = solve(Problem(scene, TwoRoots(3.0), [Span("launch.speed", 0.0, 30.0)]))
    assert found.values["launch.speed"].value == pytest.approx(SECOND, abs=0.2)
    assert found.others == ()
