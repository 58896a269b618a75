"""Where the energy goes: nothing is lost on the way, and the chart can be drawn for any run."""

import numpy as np
import pytest

from sandbox.engine.ledger import ledger
from sandbox.picture import energy_chart as chart
from sandbox.picture.energy import course
from sandbox.picture.energy_chart import LEAST_SHARE, bands_of, energy_chart, joules
from tests.picture.legible import assert_legible
from tests.scenes.play import run_of

RUNS = ["golf", "golf/putt", "basketball", "billiards/bank", "billiards/nine-ball-break", "soccer"]
WINDY = "soccer/goal-kick-in-a-gale"


@pytest.fixture
def sheets(monkeypatch):
    """The sheets of the charts that are drawn."""
    drawn = []

    class Kept(chart.Sheet):
        def __init__(self, *args, **kwargs):
            super().__init__(*args, **kwargs)
            drawn.append(self)

    monkeypatch.setattr(chart, "Sheet", Kept)
    return drawn


@pytest.mark.parametrize("name", RUNS)
def test_what_there_is_and_what_is_lost_add_up_at_all_times(name):
    spent = course(run_of(name))
    total = sum(spent.has.values()) - sum(spent.work.values())
    assert total == pytest.approx(np.full(len(spent.times), spent.start), rel=2e-6)  # the net takes much in little time
    bands, _ = bands_of(spent)
    assert bands[-1].values[-1] == pytest.approx(spent.start, rel=LEAST_SHARE)  # "other" is drawn if it is more


@pytest.mark.parametrize("name", ["billiards/bank", "billiards/nine-ball-break", "basketball/rattle"])
def test_what_an_impact_takes_is_taken_at_once(name):
    """Between two samples that are nearer to each other than can be drawn."""
    run, spent = run_of(name), course(run_of(name))
    for t in {event.t for event in run.events if event.kind == "impact"}:
        at = int(np.searchsorted(spent.times, t))
        assert spent.times[at] == t
        assert spent.times[at] - spent.times[at - 1] < 1e-6


def test_with_what_the_wind_put_in_the_balance_holds():
    """In still air lift does no work; through its curving path it hands a kick what the wind has."""
    spent = course(run_of(WINDY))
    there = sum(spent.has.values()) + sum(spent.taken_by_cause.values())
    assert there == pytest.approx(spent.start + sum(spent.put_in.values()), rel=1e-6)
    assert spent.put_in["lift"].max() > 0.15 * spent.start
    assert max(values.max() for values in course(run_of("soccer")).put_in.values()) < 1e-6 * spent.start


@pytest.mark.parametrize("name", RUNS)
def test_each_cause_takes_in_the_end_what_the_ledger_says(name):
    run = run_of(name)
    spent, book = course(run), ledger(run)
    booked = sum(sum(kind.values()) for kind in (book.work, book.impacts, book.contacts)) - book.work.get(
        "gravity", 0.0
    )
    pockets = spent.work.get("pockets", np.zeros(1))[-1]
    assert sum(work[-1] for work in spent.work.values()) - pockets == pytest.approx(booked, rel=1e-9)


def test_drag_takes_more_and_more():
    lost = course(run_of("golf")).taken_by_cause["drag"]
    assert np.all(np.diff(lost) >= -1e-12)
    assert lost[-1] > 100  # J, of a drive's 134


def test_an_impact_takes_its_energy_at_once():
    spent = course(run_of("basketball"))
    event = next(event for event in run_of("basketball").events if event.kind == "impact")
    before, at = (int(np.argmin(abs(spent.times - t))) for t in (event.t - 1e-9, event.t))
    jump = spent.taken_by_cause["floor"][at] - spent.taken_by_cause["floor"][before]
    assert jump == pytest.approx(spent.taken_by_cause["floor"][at], rel=1e-6)
    assert jump > 1.0  # J


def test_like_surfaces_and_pairs_of_balls_are_grouped():
    assert set(course(run_of("billiards/nine-ball-break")).taken_by_cause) >= {"cloth", "cushions", "balls"}


def test_what_catches_a_ball_goes_by_its_own_name():
    taken = course(run_of("bowling")).taken_by_cause
    assert taken["pit"][-1] > 50.0  # J
    assert "pockets" not in taken


def test_conservative_storage_is_neither_input_nor_loss():
    """Strings of a cradle: all the energy there is at the start, and most of it again at each turn."""
    spent = course(run_of("collisions/cradle-5"))
    stored = spent.has["stored by string"]
    assert stored[0] == pytest.approx(spent.start)
    assert max((values.max() for values in spent.put_in.values()), default=0.0) == pytest.approx(0.0, abs=1e-12)
    total = sum(spent.has.values()) - sum(spent.work.values())
    assert total == pytest.approx(np.full(len(spent.times), spent.start), rel=1e-4)
    assert not any("stored" in name for name in course(run_of("basketball")).has)  # a net acts on a part of its way


def test_what_the_last_impact_changes_has_a_width():
    bands, _ = bands_of(chart.held_at_the_end(run_of("volleyball/spike")))
    floor = next(band for band in bands if band.name == "floor")
    wide = floor.times[floor.values - floor.foot > 1.0]
    assert np.ptp(wide) > 0.03 * run_of("volleyball/spike").duration


def test_a_caught_ball_takes_its_energy_into_the_pocket():
    spent = course(run_of("billiards/bank"))
    assert spent.taken_by_cause["pockets"][-1] > 0
    assert spent.has["speed"][-1] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("size", [(320, 180), (720, 1280)], ids=str)
@pytest.mark.parametrize(
    ("name", "overrides"),
    [
        ("golf", {}),
        ("golf", {"air.wind": [20.0, 0.0]}),
        ("golf", {"launch.speed": 0.0, "launch.spin": 0.0}),
        ("basketball", {}),
        ("billiards/nine-ball-break", {}),
        ("soccer-curl", {}),
        (WINDY, {}),
    ],
    ids=str,
)
def test_the_chart_is_legible(name, overrides, size, sheets):
    assert energy_chart(run_of(name, overrides), size).get_size() == size
    (sheet,) = sheets
    assert_legible(sheet)


def test_a_chart_gives_the_input_and_fractions_of_one_whole(sheets):
    energy_chart(run_of(WINDY))
    texts = [text for text, _ in sheets[0].written]
    assert any(text.startswith("shares of 214 J: 195 J at the start + 18.8 J put in by lift") for text in texts)
    shares = [float(text.removesuffix(" %")) for text in texts if text.endswith(" %")]
    assert sum(shares) == pytest.approx(100.0, abs=0.05 * len(shares))


def test_a_name_within_a_band_stays_in_it(sheets):
    picture = energy_chart(run_of("collisions/tumbling-box"))
    rects = dict(sheets[0].written)
    for name in ("height", "speed", "spin"):
        rect = rects[name]
        for corner in (rect.topleft, rect.bottomleft, (rect.right, rect.top), (rect.right, rect.bottom)):
            assert picture.get_at(corner)[:3] == pytest.approx(chart.CHART[name], abs=6), name


def test_a_cause_has_its_words_and_its_own_colour_in_every_chart():
    pond, splash = (bands_of(course(run_of(name)))[0] for name in ("golf/pond", "golf/splash"))
    pond, splash = ({band.name: band.colour for band in bands} for bands in (pond, splash))
    assert pond["spin decay"] == splash["spin decay"] != pond["green"]


@pytest.mark.parametrize(
    ("amount", "text"), [(0.0, "0 J"), (0.0123, "12.3 mJ"), (1.5, "1.5 J"), (134.5, "134 J"), (12345.0, "12.3 kJ")]
)
def test_joules(amount, text):
    assert joules(amount) == text
