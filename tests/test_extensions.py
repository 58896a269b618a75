"""The core does without each extension: it runs in copies of the package from which their folders are taken."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from sandbox.cli.program import COMMANDS

ROOT = Path(__file__).resolve().parent.parent
TABLES = (ROOT / "CONTRIBUTING.md").read_text("utf-8")
EXTENSIONS = [
    row.split("`")[1] for row in TABLES[TABLES.index("| extension |") :].split("| `__main__`")[0].splitlines()[2:]
]
ALL = ",".join(EXTENSIONS)
CORE = sorted(name for names in COMMANDS.values() for name in names)

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="processes are forked")


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory: pytest.TempPathFactory) -> dict[str, dict[str, Any]]:
    """What each copy does, by what was taken from it."""
    folder = tmp_path_factory.mktemp("copies")
    groups = [*EXTENSIONS, ALL]
    script = [sys.executable, str(ROOT / "tests" / "without_extensions.py"), str(folder), *groups]
    done = subprocess.run(script, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found = dict(zip(groups, map(json.loads, done.stdout.splitlines()), strict=True))
    assert all(outcome["at"].startswith(str(folder)) for outcome in found.values())
    return found


@pytest.mark.parametrize("taken", [*EXTENSIONS, ALL])
def test_the_core_does_without(taken: str, outcomes: dict[str, dict[str, Any]]):
    outcome = outcomes[taken]
    assert set(outcome["core"].values()) == {0}
    assert set(CORE) <= set(outcome["commands"])
    assert outcome["dead"] == []


def test_what_was_taken_has_no_commands(outcomes: dict[str, dict[str, Any]]):
    gone = {"lab/fit": ["fit"], "lab/session": ["session"], "lab/spread": ["spread"],
            "tasks": ["play", "serve", "tasks"], "page": ["serve"],
            "window": ["play", "serve"], "serve": ["serve"], "gym": []}  # fmt: skip
    everything = {*CORE, *(name for names in gone.values() for name in names)}
    left = {taken: sorted(everything - set(names)) for taken, names in gone.items()}
    assert {taken: outcome["commands"] for taken, outcome in outcomes.items()} == {**left, ALL: CORE}


def test_options_without_their_part_say_so_in_a_line(outcomes: dict[str, dict[str, Any]]):
    assert outcomes[ALL]["refused"] == {
        "--html": [2, "error: --html: this copy of sandbox is without pages of runs\n"],
        "--attempt": [2, "error: --attempt 2: this copy of sandbox is without tasks\n"],
        "--tasks": [2, "error: --tasks: this copy of sandbox is without schemas of tasks\n"],
    }
    assert outcomes[ALL]["chart"]
    assert outcomes[ALL]["parts"] == ["charts", "pictures", "images"]
