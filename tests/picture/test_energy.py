"""Where the energy goes: nothing is lost on the way, and the chart can be drawn for any run."""

from functools import cache

import numpy as np
import pytest

import sandbox
from sandbox.engine.ledger import ledger
from sandbox.picture.energy import course, energy_chart, joules

RUNS = ["golf", "golf/putt", "basketball", "billiards/bank", "billiards/nine-ball-break", "soccer"]


@cache
def run_of(name: str):
    return sandbox.simulate(sandbox.load(name))


@pytest.mark.parametrize("name", RUNS)
def test_what_there_is_and_what_is_lost_add_up_at_all_times(name):
    energy = course(run_of(name))
    total = sum(energy.has.values()) + sum(energy.lost.values())
    assert total == pytest.approx(np.full(len(energy.times), energy.start), rel=1e-6)


@pytest.mark.parametrize("name", RUNS)
def test_each_cause_takes_in_the_end_what_the_ledger_says(name):
    run = run_of(name)
    energy, book = course(run), ledger(run)
    booked = sum(sum(kind.values()) for kind in (book.work, book.impacts, book.contacts)) - book.work.get(
        "gravity", 0.0
    )
    pockets = energy.lost.get("pockets", np.zeros(1))[-1]
    assert sum(lost[-1] for lost in energy.lost.values()) - pockets == pytest.approx(-booked, rel=1e-9)


def test_drag_takes_more_and_more():
    lost = course(run_of("golf")).lost["drag"]
    assert np.all(np.diff(lost) >= -1e-12)
    assert lost[-1] > 100  # J, of a drive's 134


def test_an_impact_takes_its_energy_at_once():
    energy = course(run_of("basketball"))
    event = next(event for event in run_of("basketball").events if event.kind == "impact")
    before, at = (int(np.argmin(abs(energy.times - t))) for t in (event.t - 1e-9, event.t))
    jump = energy.lost["floor"][at] - energy.lost["floor"][before]
    assert jump == pytest.approx(energy.lost["floor"][at], rel=1e-6)
    assert jump > 1.0  # J


def test_surfaces_that_are_alike_and_pairs_of_balls_stand_together():
    assert set(course(run_of("billiards/nine-ball-break")).lost) >= {"cloth", "cushions", "balls"}


def test_a_caught_ball_takes_its_energy_into_the_pocket():
    energy = course(run_of("billiards/bank"))
    assert energy.lost["pockets"][-1] > 0
    assert energy.has["speed"][-1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("size", [(640, 360), (1280, 720), (1920, 1080)], ids=str)
@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("golf", {}),
        ("golf", {"air.wind": [20.0, 0.0]}),
        ("golf", {"launch.speed": 0.0, "launch.spin": 0.0}),
        ("basketball", {}),
        ("billiards/nine-ball-break", {}),
        ("soccer-curl", {}),
    ],
    ids=str,
)
def test_the_chart_is_legible(name, overrides, size, monkeypatch):
    from sandbox.picture import energy

    sheets = []

    class Kept(energy.Sheet):
        def __init__(self, *args, **kwargs):
            super().__init__(*args, **kwargs)
            sheets.append(self)

    monkeypatch.setattr(energy, "Sheet", Kept)
    run = run_of(name) if not overrides else sandbox.simulate(sandbox.load(name, overrides))
    assert energy_chart(run, size).get_size() == size
    (sheet,) = sheets
    for i, (text, rect) in enumerate(sheet.written):
        assert sheet.frame.inflate(2, 2).contains(rect), f"{text} leaves the frame"
        for other_text, other in sheet.written[:i]:
            assert not rect.colliderect(other), f"{text} overlaps {other_text}"


@pytest.mark.parametrize(
    ("energy", "text"), [(0.0, "0 J"), (0.0123, "12.3 mJ"), (1.5, "1.5 J"), (134.5, "134 J"), (12345.0, "12.3 kJ")]
)
def test_joules(energy, text):
    assert joules(energy) == text
