"""The program called in this process, and scenes of a user's own to call it with."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

#: The smallest scene, and the program in a process of its own.
DROP = Path(__file__).parent / "scenes" / "drop"
COMMAND = [sys.executable, "-c", "import sys; from sandbox.cli import main; sys.exit(main())"]

#: Where in the scene.py of drop a test puts code of its own.
BUILD = "def build(parameters: Parameters) -> Setup:\n"


#: A test that waits for longer than this, in s, is taken to hang. Nothing is measured by it: a machine may be busy.
HANG = 600.0


class Outcome(NamedTuple):
    """Of a call of the program: exit code, stdout and stderr."""

    code: int
    out: str
    err: str


def wait_for_work(process: subprocess.Popen[str], seconds: float) -> None:
    """Wait until a process has computed for so many s of processor time from now, on a system that says so."""

    def worked() -> float:
        fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    until, end = worked() + seconds, time.monotonic() + HANG
    while process.poll() is None and worked() < until:
        assert time.monotonic() < end
        time.sleep(0.01)


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
