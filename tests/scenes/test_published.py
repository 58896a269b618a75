"""Published cases: each row of tests/reference/*.csv names a scene, what is set, and the result that was published."""

from __future__ import annotations

import csv
from pathlib import Path

import pytest

import sandbox
from sandbox.parameters import parse_assignment

COLUMNS = ["scene", "set", "result", "value", "tolerance", "unit", "source"]


def cases() -> list[dict[str, str]]:
    """Rows of all tables that have these columns; other tables have tests of their own."""
    rows: list[dict[str, str]] = []
    for path in sorted((Path(__file__).parent.parent / "reference").glob("*.csv")):
        with path.open(newline="", encoding="utf-8") as file:
            table = csv.DictReader(file)
            if table.fieldnames == COLUMNS:
                rows += table
    return rows


@pytest.mark.parametrize("case", cases(), ids=lambda case: f"{case['scene']} {case['set'][:30]} {case['result']}")
def test_published_case(case: dict[str, str]):
    settings = [text for text in case["set"].split(";") if text.strip()]
    scene = sandbox.load(case["scene"], dict(parse_assignment(text) for text in settings))
    found = sandbox.simulate(scene).result[case["result"]]
    assert case["source"]
    if case["tolerance"]:
        assert found == pytest.approx(float(case["value"]), abs=float(case["tolerance"])), case["source"]
    else:
        assert str(found).lower() == case["value"], case["source"]


def test_there_are_cases_for_each_ball_game():
    assert {case["scene"].partition("/")[0] for case in cases()} >= {"soccer-curl", "basketball"}
