"""Published cases: every row of scenes/*/published beside ours. The tables are those of ``sandbox validate``."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

from sandbox.errors import RequestError
from sandbox.lab.published import KINDS, cases
from sandbox.lab.report import as_text
from sandbox.lab.teeth import report_of as report_of_teeth
from sandbox.lab.teeth import teeth
from sandbox.lab.validate import Compared, report_of, share_that_holds, validate
from sandbox.scene import listings
from tests.own_scene import DROP, assert_refused, copy_of

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def rows() -> list[Compared]:
    return validate()


def test_every_case_holds_or_says_why_not_and_most_hold(rows):
    silent = [f"{row.scene} {row.name} {row.result}" for row in rows if not row.holds and not row.reason]
    assert silent == []
    assert [row.name for row in rows if row.holds and row.reason] == []
    assert sum(row.holds for row in rows) >= 0.85 * len(rows)
    exact = [row for row in rows if row.kind == "exact"]
    assert len(exact) >= 20
    assert all(row.holds for row in exact)
    assert max(map(len, as_text(report_of(rows)))) <= 80


def test_every_case_has_a_source_a_kind_and_a_reasoned_tolerance(rows):
    assert {row.kind for row in rows} == set(KINDS)
    assert [row.name for row in rows if not row.source or (row.tolerance is not None and not row.tolerance_from)] == []
    scenes = {listing.name for listing in listings() if "/" not in listing.name}
    assert {case.scene.partition("/")[0] for case in cases()} >= scenes


def test_rows_fall_without_the_effect_they_test(rows, monkeypatch):
    """One of each source and result; ``sandbox validate --teeth`` tries all. Few need more than that it is left out."""
    with monkeypatch.context() as quick:
        quick.setattr("sandbox.lab.teeth._FACTORS", {0.0: "off"})
        first = teeth(list({(row.source, row.result): row for row in rows if row.holds}.values()))
    assert first
    tried = teeth([one.row for one in first if not one.has_teeth])
    assert [f"{one.row.scene} {one.row.name} {one.row.result}" for one in tried if not one.has_teeth] == []


def test_an_effect_that_is_left_out_is_named(rows):
    """The friction of two balls, for example, which falls with their speed unless it is given."""
    row = next(row for row in rows if row.scene == "billiards" and row.holds and "ball.friction" not in row.set)
    with pytest.raises(RequestError, match=r"ball\.friction is left out here: .* ball\.friction=0\.1"):
        teeth([replace(row, tests="ball.friction")])


def test_a_row_without_teeth_is_listed():
    """Within 100 yd a carry says nothing about lift; that drag is left out altogether it would still notice."""
    carry = [row for row in validate("golf") if (row.name, row.result) == ("PGA 7i", "carry")]
    blunt = [replace(row, tolerance=100.0) for row in carry]
    (one,) = tried = teeth(blunt)
    assert (one.has_teeth, one.unnoticed()) == (False, ["lift"])
    report = report_of_teeth(blunt, tried)
    assert "PGA 7i" in "".join(as_text(report))
    assert report.document()[0]["has_teeth"] is False


def test_the_readme_counts_measured_rows_as_validate_does(rows):
    """``python docs/measure_accuracy.py validate`` writes it."""
    counts = [row for row in rows if row.kind in ("measured", "held-out")]
    said = f"{sum(row.holds for row in counts)} of {len(counts)} measured numbers"
    assert said == share_that_holds(rows)
    assert f"`sandbox validate`: {said}" in " ".join((ROOT / "README.md").read_text("utf-8").split())


def test_a_wrong_number_would_be_seen():
    """Half as much drag again, and the tour table no longer holds."""
    rows = validate("golf", {"ball.drag.model": "constant", "ball.drag.coefficient": 0.4})
    flown = [row for row in rows if "drag" in row.tests]
    assert sum(row.holds for row in flown) < 0.5 * len(flown)


def test_a_result_that_a_changed_scene_lacks_does_not_hold():
    """On a dry lane no third pin is struck: the case says so, in place of an IndexError."""
    rows = validate("bowling", {"dry": 0.15})
    lacking = [row for row in rows if row.computed is None]
    assert [row.result for row in lacking] == ["met.3"]
    assert not lacking[0].holds
    assert "none" in "\n".join(as_text(report_of(lacking)))


def test_another_model_takes_the_place_of_the_one_in_a_case():
    """A case with a constant coefficient, too, is computed with the model that is asked for."""
    rows = validate("golf", {"ball.drag.model": "usga", "ball.lift.model": "usga"})
    assert not any(row.holds for row in rows if row.name == "p = 1, 45 deg")


def test_a_scene_of_ones_own_has_published_numbers_in_its_folder(tmp_path, call, monkeypatch):
    monkeypatch.chdir(tmp_path)
    table = copy_of(DROP, tmp_path / "drop") / "published" / "numbers.csv"
    table.parent.mkdir()
    table.write_text("preset,set,result,value,tolerance,unit\n,launch.height=5,final_height,2.5,2.5,m\n")
    (row,) = json.loads(call("validate", "./drop", "--json").out)
    assert (row["scene"], row["holds"], row["kind"]) == ("./drop", True, "measured")
    table.write_text(table.read_text().replace("final_height", "height"))
    assert_refused(call("validate", "./drop"), "drop/published/numbers.csv: row 1, result = height: no such result")
