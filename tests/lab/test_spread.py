"""Scatter: known distributions and indices, what a shot's scatter gives, and requests that are rejected."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest

import sandbox
from sandbox import RequestError
from sandbox.cli.program import call
from sandbox.lab.axes import Span
from sandbox.lab.many import Runs
from sandbox.lab.report import as_json, as_text
from sandbox.lab.spread import Spread
from sandbox.lab.spread.causes import Cause, points_of, shares_of
from sandbox.lab.spread.texts import mean_and_deviation
from sandbox.lab.statistics import Ellipse, Numbers, Share, shots_for_mean, shots_for_share, wilson
from sandbox.sport.amounts import shown_in

GOLF = {"launch.speed": "1%", "launch.angle": "1deg"}


@pytest.fixture(scope="module")
def throws() -> Spread:
    return sandbox.spread("basketball", samples=256, facts=("made", "verdict", "entry_angle", "apex"))


# Statistics ---------------------------------------------------------------------------------------------------------


def test_indices_of_the_ishigami_function():
    """f = sin x1 + 7 sin^2 x2 + 0.1 x3^4 sin x1 (Ishigami & Homma 1990) has them in closed form."""
    causes = [Cause(Span(f"x{place}", -np.pi, np.pi), "") for place in (1, 2, 3)]
    points = points_of(causes, 4096, 1, "sobol", apart=True)
    x1, x2, x3 = points.values.values()
    values = np.sin(x1) + 7.0 * np.sin(x2) ** 2 + 0.1 * x3**4 * np.sin(x1)
    runs = Runs(sandbox.load("golf"), points.values, {"carry": values}, {}, ())
    found = Spread(runs.scene, tuple(causes), points, runs, 1, "sobol", {}).causes["carry"]
    assert [it.first for it in found.values()] == pytest.approx([0.3139, 0.4424, 0.0], abs=0.015)
    assert [it.total for it in found.values()] == pytest.approx([0.5576, 0.4424, 0.2437], abs=0.015)


@pytest.mark.parametrize(("hits", "shots"), [(0, 20), (20, 20), (7, 10), (631, 1000)])
def test_interval_of_a_share_is_wilsons(hits: int, shots: int):
    from scipy.stats import binomtest

    expected = binomtest(hits, shots).proportion_ci(0.95, method="wilson")
    assert Share(hits, shots).interval == pytest.approx((expected.low, expected.high), abs=1e-12)


def test_so_many_shots_and_no_fewer_tell_a_share_or_mean():
    for share, within in ((0.5, 0.05), (0.0, 0.01), (0.9, 0.2)):
        needed = shots_for_share(share, within)
        half = [wilson(0.5, count) if share == 0.5 else wilson(share, count) for count in (needed, needed - 1)]
        if share == 0.5:
            assert [(high - low) / 2 <= within for low, high in half] == [True, False]
        assert shots_for_share(share, within / 2) > needed
    assert shots_for_share(0.5, 0.05) == 381
    assert shots_for_mean(10.0, 1.96) == 100


def test_ellipse_of_points_along_a_direction():
    """Two normal directions of 3 and 1 m, turned by 30 deg: half axes sqrt(5.991) times these."""
    rng, turn = np.random.default_rng(0), np.radians(30.0)
    axes = np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    found = Ellipse(np.array([5.0, -2.0]) + (rng.standard_normal((20_000, 2)) * [3.0, 1.0]) @ axes)
    assert found.center == pytest.approx((5.0, -2.0), abs=0.1)
    assert found.axes == pytest.approx((3.0 * 2.4477, 2.4477), rel=0.02)
    assert (found.angle, found.inside) == (pytest.approx(30.0, abs=0.5), pytest.approx(0.95, abs=0.005))
    assert np.ptp(found.outline() @ axes[0]) == pytest.approx(2.0 * found.axes[0], rel=1e-3)


# Shots --------------------------------------------------------------------------------------------------------------


def test_sd_goes_through_a_shot_as_derivatives_say():
    """Small causes: the variance is the sum of squares of derivative times sd, and each share is one of them."""
    found = sandbox.spread("golf", {"launch.speed": "0.1%", "launch.angle": 0.1}, facts=("carry",), samples=256)
    own = sandbox.load("golf")
    parts = []
    for cause in found.by:
        value = cause.axis.mean
        ends = [sandbox.simulate(own.changed({cause.key: value + sign * cause.sd})).result["carry"] for sign in (-1, 1)]
        parts.append(0.5 * (ends[1] - ends[0]))
    assert found.numbers["carry"].sd == pytest.approx(np.hypot(*parts), rel=0.02)
    expected = np.square(parts) / np.square(parts).sum()
    assert [it.first for it in found.causes["carry"].values()] == pytest.approx(expected, abs=0.02)


def test_the_same_seed_gives_the_same_evenly_spread_shots(throws: Spread):
    again = sandbox.spread("basketball", samples=256, facts=("made", "apex"), causes=False)
    assert again.values("apex").tolist() == pytest.approx(throws.values("apex").tolist(), abs=1e-9)
    even, other = shares_of(256, 3, 0, "sobol"), shares_of(256, 3, 1, "sobol")
    assert not np.array_equal(even, other)
    assert (np.histogram(even[:, 1], 16, (0, 1))[0] == 16).all()
    assert not (np.histogram(shares_of(256, 3, 0, "random")[:, 1], 16, (0, 1))[0] == 16).all()


def test_json_has_all_that_the_text_has(throws: Spread):
    told = json.loads(as_json(throws.report()))
    assert told["samples"] == 256
    made, verdicts = told["share"]["made"], told["words"]["verdict"]
    assert made["low"] < made["value"] < made["high"]
    assert made["value"] == pytest.approx(sum(it["value"] for word, it in verdicts.items() if word != "miss"))
    angle = told["facts"]["entry_angle"]
    assert angle["quantiles"]["0.05"] < angle["quantiles"]["0.5"] < angle["quantiles"]["0.95"]
    assert sum(angle["histogram"]["counts"]) == angle["shots"] == 256
    assert set(told["causes"]["made"]) == set(told["by"])
    assert told["causes"]["apex"]["launch.angle"]["total"] > 0.4
    text = "\n".join(as_text(throws.report()))
    assert f"{100 * made['value']:.1f} %" in text
    assert [need["shots"] for need in told["needed"]][:2] == sorted(need["shots"] for need in told["needed"][:2])


def test_a_histogram_of_what_differs_by_rounding_has_one_bar():
    counts, edges = Numbers(np.nextafter(20.0, [19.0, 21.0])).histogram()
    assert (counts.tolist(), len(edges)) == ([2], 2)


def test_picture_and_page_are_written(throws: Spread, tmp_path: Path):
    throws.plot(tmp_path / "throws.png")
    page = throws.page()
    assert (tmp_path / "throws.png").stat().st_size > 20_000
    assert "<svg" in page
    assert "launch.angle" in page
    assert "sandbox spread basketball --by launch.speed=" in page
    assert page.count("<section>") == 5
    assert throws.page() == page  # without a date, and with names that are the same each time


@pytest.mark.parametrize(
    ("units", "mean", "sd", "expected"),
    [
        (None, -0.019, 0.14, "−0.02 m ± 0.14 m"),
        (None, 0.019, 0.0042, "1.9 cm ± 0.42 cm"),
        (None, 252.3, 4.61, "252.3 m ± 4.6 m"),
        ("us", 252.3, 4.61, "276 yd ± 5 yd"),
    ],
)
def test_mean_and_deviation_are_in_one_unit(throws, units, mean, sd, expected):
    fact = next(key for key, fact in throws.scene.facts.items() if fact.unit == "m" and fact.digits is None)
    with shown_in(units):
        assert mean_and_deviation(throws, fact, mean, sd) == expected


def test_every_column_is_in_the_chosen_units(capsys):
    """A mean in yd has no standard deviation in m beside it; an ellipse is in one unit."""
    quick = ["--samples", "16", "--no-causes", "--units", "us"]
    assert call(["spread", "golf", *quick]) == 0
    assert re.search(r"carry +\d+ yd +\d+ ft +\d+ yd", capsys.readouterr().out)
    assert call(["spread", "collisions", "--by", "balls[0].y=0.01", *quick]) == 0
    assert re.search(r"first +[\d.]+, [\d.]+ ft +[\d.]+ ft +[\d.]+ ft", capsys.readouterr().out)


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--by", "launch.sped=1"], "--by launch.sped: unknown key; did you mean launch.speed?"),
        (["--by", "launch.speed"], "--by launch.speed: write it as KEY=SD"),
        (["--by", "launch.speed=-1%"], "must be more than 0"),
        (["--by", "launch.speed=1 kg"], 'the standard deviation "1 kg"'),
        (["--by", "launch.speed=x%"], "write a share of its value as 1%"),
        (["--by", "air.wind[0]=1%"], "the scene's own value is 0; give the standard deviation as a number in m/s"),
        (["--by", "ball.drag.model=1"], "only a number scatters"),
        (["--by", "launch.speed=1", "--by", "launch.speed=2"], "--by launch.speed: given twice"),
        (["--by", "launch.speed=nan"], "must be more than 0, and finite"),
        (["--of", "cary"], "--of cary"),
        (["--within", "carry"], "--within carry: write it as NAME=WIDTH"),
        (["--within", "carry=-1"], "--within carry=-1: must be more than 0"),
        (["--samples", "3"], "16<=x<=1000000"),
        (["--plot", "x.pdf"], "--plot x.pdf"),
        (["--html", "x.png"], "--html x.png"),
    ],
)
def test_a_wrong_request_is_one_line_and_writes_nothing(
    arguments: list[str], expected: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys
):
    monkeypatch.chdir(tmp_path)
    assert call(["spread", "golf", *arguments]) == 2
    said = capsys.readouterr()
    assert expected in said.err
    assert len(said.err.splitlines()) <= 2
    assert (said.out, list(tmp_path.iterdir())) == ("", [])


def test_errors_in_python():
    with pytest.raises(RequestError, match="seed = -1"):
        sandbox.spread("golf", GOLF, seed=-1)
    with pytest.raises(RequestError, match="by"):
        sandbox.spread("golf", "launch.speed")  # type: ignore[arg-type]
    with pytest.raises(RequestError, match="of a share it must be below 1"):
        sandbox.spread("basketball", facts=("made",), within={"made": 2.0}, samples=16, causes=False)
