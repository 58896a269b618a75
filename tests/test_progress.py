"""The progress bar: on a terminal, after two seconds, and gone at the end."""

from __future__ import annotations

import io
import re
import time
from pathlib import Path

import pytest

from sandbox.cli import main
from sandbox.progress import bar


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch):
    """Time that stands still until it is moved on."""
    now = [1000.0]
    monkeypatch.setattr(time, "monotonic", lambda: now[0])

    def forward(seconds: float) -> None:
        now[0] += seconds

    return forward


def assert_cleared(terminal: Terminal) -> None:
    """The line is empty, and the cursor is at its beginning."""
    assert terminal.getvalue().endswith("\r" + 79 * " " + "\r")


def work(clock, seconds: float) -> None:
    with bar("frames") as progress:
        for done in range(1, 11):
            clock(seconds / 10)
            progress(done, 10)


def fail(clock) -> None:
    with bar("frames") as progress:
        clock(3.0)
        progress(1, 2)
        raise ZeroDivisionError


def test_long_work_shows_a_bar_and_clears_it(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    work(clock, 4.0)
    assert re.search(r"frames.*━.* 6/10", terminal.getvalue())
    assert " 4/10" not in terminal.getvalue()
    assert_cleared(terminal)


def test_the_bar_stays_in_its_line(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    with bar("frames of a long name" * 9) as progress:
        clock(3.0)
        progress(1, 2)
    assert max(map(len, terminal.getvalue().split("\r"))) == 79


def test_short_work_shows_nothing(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    work(clock, 1.9)
    assert terminal.getvalue() == ""


def test_what_is_no_terminal_shows_no_bar(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", file := io.StringIO())
    work(clock, 4.0)
    assert file.getvalue() == ""


def test_a_failure_clears_the_bar(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    with pytest.raises(ZeroDivisionError):
        fail(clock)
    assert_cleared(terminal)


def test_it_tells_the_rate_and_the_time_left(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    with bar("sweep") as progress:
        progress(1000, 5000)  # done before
        clock(4.0)
        progress(3000, 5000)
    assert re.search(r"3000/5000\S* 500/s  4 s left", terminal.getvalue())


def test_each_piece_of_work_has_its_own_rate(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    with bar("seconds simulated") as progress:
        progress(1.0, 10.0)
        clock(4.0)
        progress(9.0, 10.0)
        clock(4.0)
        progress(0.5, 10.0)
        clock(4.0)
        progress(2.5, 10.0)
    assert re.search(r"2/10\S* 0\.5/s  15 s left", terminal.getvalue())


def test_long_work_says_so_before_in_a_log_too(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", log := io.StringIO())
    with bar("aim") as progress:
        for done, total in ((0, 129), (100, 129), (129, 2691), (200, 2691), (300, 2700)):
            progress(done, total)
            clock(3.0)
    assert log.getvalue() == "aim: 2,691 in all, about 2 min left\n"


def test_long_work_is_announced_above_the_bar(clock, monkeypatch):
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    with bar("sweep") as progress:
        progress(0, 100)
        clock(4.0)
        progress(10, 100)
    line, bars = terminal.getvalue().split("\n")
    assert line.strip() == "sweep: 100 in all, about 36 s left"
    assert "10/100" in bars
    assert_cleared(terminal)


@pytest.mark.parametrize("more", [[], ["--check"]])
def test_a_run_of_many_steps_tells_how_far_it_is(monkeypatch, more):
    monkeypatch.setattr("sys.stderr", terminal := Terminal())
    monkeypatch.setattr("sandbox.progress.PATIENCE", 0.0)
    steps = ["--set", "accuracy.method=plain", "--set", "accuracy.step=0.01"]
    assert main(["run", str(Path(__file__).parent / "scenes" / "drop"), *steps, *more]) == 0
    assert re.search(r"seconds simulated ─.*0/1", terminal.getvalue())
    assert_cleared(terminal)
