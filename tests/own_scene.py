"""The program called in this process, and scenes of a user's own to call it with."""

from __future__ import annotations

import shutil
import sys
from pathlib import Path
from typing import NamedTuple

#: The smallest scene, and the program in a process of its own.
DROP = Path(__file__).parent / "scenes" / "drop"
COMMAND = [sys.executable, "-c", "import sys; from sandbox.cli import main; sys.exit(main())"]

#: Where in the scene.py of drop a test puts code of its own.
BUILD = "def build(parameters: Parameters) -> Setup:\n"


class Outcome(NamedTuple):
    """Of a call of the program: exit code, stdout and stderr."""

    code: int
    out: str
    err: str


def copy_of(scene: Path, folder: Path) -> Path:
    return Path(shutil.copytree(scene, folder, ignore=shutil.ignore_patterns("__pycache__")))


def change(file: Path, old: str, new: str) -> None:
    """Replace a text in a file; with surrogates, by bytes that are no text."""
    source = file.read_text("utf-8")
    assert old in source
    file.write_bytes(source.replace(old, new, 1).encode("utf-8", "surrogateescape"))


def assert_refused(outcome: Outcome, expected: str, code: int = 2) -> None:
    """One or two plain lines on stderr that say ``expected``, nothing on stdout, and no traceback."""
    assert expected in outcome.err
    assert (outcome.code, outcome.out) == (code, "")
    assert outcome.err.startswith("error: ")
    assert 1 <= len(outcome.err.strip().splitlines()) <= 2
    assert "Traceback" not in outcome.err
