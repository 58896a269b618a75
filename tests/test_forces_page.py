"""docs/forces.md: its blocks run in order, and its tables are what the code has."""

from __future__ import annotations

import re
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

import sandbox
from sandbox import units
from sandbox.engine.model.accuracy import LEVELS
from sandbox.parameters import Accuracy, words_of
from sandbox.physics.integrators import INTEGRATORS
from sandbox.physics.timing import timing_of

PAGE = (Path(__file__).resolve().parent.parent / "docs" / "forces.md").read_text("utf-8")
BLOCKS = re.findall(r"^```python\n(.*?)^```$", PAGE, re.MULTILINE | re.DOTALL)


def rows(heading: str) -> list[list[str]]:
    """The cells of the table under a heading, without its first two lines."""
    section = PAGE.partition(f"\n## {heading}\n")[2].partition("\n## ")[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in re.findall(r"^\|.*$", section, re.M)][2:]


@pytest.fixture(scope="module")
def names() -> dict[str, Any]:
    """What the blocks define."""
    found: dict[str, Any] = {"__name__": "forces_page"}
    for block in BLOCKS:
        exec(compile(block, "docs/forces.md", "exec", dont_inherit=True), found)
    return found


def test_the_blocks_do_what_the_page_says(names: dict[str, Any]):
    """The disc pitches up, the scene's own drag is replaced, what comes after a bounce has another force."""
    assert names["flight"].angle("disc", 0.5) == pytest.approx(0.12 + 0.2, abs=0.1)
    scene = names["scene"]
    assert abs(scene.result(names["own"])["carry"] - sandbox.simulate(scene).result["carry"]) > 1.0
    assert names["gusty"].state("ball", 1.0).x == pytest.approx(5.275, abs=1e-6)
    still = sandbox.simulate(replace(names["held_back"].setup, balls=[names["tossed"]]))
    assert names["held_back"].events[0].x < still.events[0].x - 1.0
    assert timing_of([names["blown"].forces[2]]).jumps == (0.4, 0.7)
    assert names["slid"].state("puck", 2.0).y > 0.1
    bounce = names["first"].events[0].t
    assert names["after"].state("ball", bounce) == names["first"].state("ball", bounce)
    assert names["after"].state("ball", 3.0) != names["first"].state("ball", 3.0)


def test_the_table_of_units_is_whole():
    expected = [[kind, ", ".join(unit or "without a unit" for unit in known)] for kind, known in units.KINDS.items()]
    assert rows("Units") == expected


def test_the_table_of_accuracy_is_that_of_the_code():
    found = {row[0].strip("`"): row[1:] for row in rows("Accuracy")}
    assert list(found) == list(Accuracy.model_fields)
    for key, (_, about, *values) in found.items():
        if key != "level":
            shown = [float(Fraction(value)) if key == "step" else value for value in values]
            assert shown == [level.step if key == "step" else f"{getattr(level, key)}" for level in LEVELS.values()]
        for word in words_of(Accuracy.model_fields[key].annotation) if key in ("method", "integrator") else ():
            assert f"`{word}`" in about
    assert {*INTEGRATORS} == {*words_of(Accuracy.model_fields["integrator"].annotation)}
