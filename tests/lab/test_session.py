"""A session: groups, mishits, ellipses, the model, other air, and two sessions compared."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from scipy import stats

import sandbox
from sandbox.errors import RequestError
from sandbox.lab.report import as_text
from sandbox.lab.session.summary import _scores
from sandbox.lab.statistics import Ellipse
from tests.own_scene import Outcome, assert_refused

Call = Callable[..., Outcome]

BAG = Path(__file__).parents[2] / "docs" / "tracks" / "bag.csv"
LATER = BAG.with_name("bag-later.csv")

HEAD = "Club,Carry (yd),Side (yd)\n"
SHOTS = [("PW", 100.0, 1.0), ("PW", 104.0, -3.0), ("PW", 99.0, 2.0), ("PW", 101.0, 0.0), ("PW", 98.0, 4.0),
         ("PW", 103.0, -2.0), ("PW", 60.0, 1.0), ("9 Iron", 120.0, 2.0), ("9 Iron", 124.0, -1.0)]  # fmt: skip


def written(folder: Path, text: str, name: str = "shots.csv") -> Path:
    (folder / name).write_text(text, "utf-8")
    return folder / name


@pytest.fixture
def file(tmp_path: Path) -> Path:
    return written(tmp_path, HEAD + "".join(f"{club},{carry},{side}\n" for club, carry, side in SHOTS))


@pytest.fixture(scope="module")
def bag() -> sandbox.Session:
    return sandbox.session(BAG, LATER, changes={"air.temperature": 5.0, "air.wind": (-6.0, 0.0)})


def test_groups_have_mean_and_sd_in_the_unit_of_the_file(call: Call, file: Path):
    done = call("session", file, "--scene", "golf", "--set-aside", "none", "--json")
    found = json.loads(done.out)
    carries = [carry for club, carry, _ in SHOTS if club == "PW"]
    assert list(found["groups"]) == ["9 Iron", "PW"]  # the longest first
    wedge = found["groups"]["PW"]
    assert (wedge["n"], wedge["set_aside"], found["set_aside"], found["by"]) == (7, 0, [], "Club")
    interval = stats.t.interval(0.95, 6, np.mean(carries), stats.sem(carries))
    expected = {
        "n": 7,
        "mean": np.mean(carries),
        "sd": np.std(carries, ddof=1),
        "low": interval[0],
        "high": interval[1],
    }
    assert wedge["carry"].pop("unit") == "yd"
    assert wedge["carry"] == pytest.approx(expected, rel=5e-3)
    assert found["model"]["results"] == {}
    assert "nothing of the launch" in found["model"]["why"]


def test_a_mishit_is_set_aside_by_the_rule_that_is_said(call: Call, file: Path):
    """0.6745 (60 - 100) / (1.140 * 2): the median of the deviations from 100 yd is 2 yd, and 1.140 is for 7 shots."""
    found = json.loads(call("session", file, "--scene", "golf", "--json").out)
    assert found["set_aside"] == [{"row": 7, "group": "PW", "why": "carry 60 yd: −11.8"}]
    assert found["groups"]["PW"]["n"] == 6
    assert found["groups"]["PW"]["carry"]["mean"] == pytest.approx(100.83, abs=0.01)
    text = " ".join(call("session", file, "--scene", "golf").out.split())
    assert "set aside: row 7 (PW), carry 60 yd: −11.8" in text
    assert "--set-aside none counts all" in text


def test_a_shot_that_is_long_is_none_and_one_far_aside_is(tmp_path: Path):
    rows = "".join(f"{carry},{side}\n" for carry, side in [(c, s) for _, c, s in SHOTS[:6]] + [(160, 1), (101, 40)])
    found = sandbox.session(written(tmp_path, "Carry,Side\n" + rows), scene="golf")
    assert [(one.row, one.why) for one in found.first.set_aside] == [(8, "side 40 m: +11.6")]


def test_a_few_shots_that_lie_close_make_no_mishits():
    carries, all_of_them = np.array([230.0, 231.0, 232.0, 232.0, 232.0, 233.0, 226.0]), np.ones(7, dtype=bool)
    assert _scores(carries, all_of_them)[6] < -3.5
    assert _scores(carries, all_of_them, 0.03 * 232.0)[6] == pytest.approx(-6.0 / 6.96)


def test_groups_are_compared_however_they_are_spelled(tmp_path: Path):
    first = written(tmp_path, HEAD + "7 Iron,150,1\n7 Iron,152,0\nPW,100,0\nPW,99,0\n")
    second = written(tmp_path, HEAD + "7-iron,160,1\n7-iron,162,0\nLW,60,0\nLW,61,0\n", "later.csv")
    report = sandbox.session(first, second, scene="golf").report()
    assert report.document()["difference"]["7 Iron"]["carry"]["value"] == pytest.approx(10.0)
    assert "PW in shots.csv; LW in later.csv" in " ".join(" ".join(as_text(report)).split())


def test_one_of_twenty_normal_groups_has_a_mishit_by_chance():

    random = np.random.default_rng(5)
    for size in (6, 12, 25):
        groups = random.normal(size=(700, size))
        low = [min(_scores(group, np.ones(size, dtype=bool)).values()) < -3.5 for group in groups]
        assert np.mean(low) == pytest.approx(0.05, abs=0.025)


def test_ellipses_hold_their_shares():
    random = np.random.default_rng(3)
    points = random.multivariate_normal([3.0, 200.0], [[40.0, 15.0], [15.0, 90.0]], 4000)
    assert Ellipse(points, 0.5).inside == pytest.approx(0.5, abs=0.03)
    assert Ellipse(points).inside == pytest.approx(0.95, abs=0.015)
    long, short = (np.array(Ellipse(points, share).axes) for share in (0.95, 0.5))
    assert long / short == pytest.approx([np.sqrt(np.log(0.05) / np.log(0.5))] * 2)


def test_the_model_is_compared_as_validate_does(bag: sandbox.Session):
    found = bag.report().document()["model"]
    assert set(found["by"]) == set(bag.first.groups)
    assert found["results"]["carry"]["n"] == 80 - len(bag.first.set_aside)
    assert found["results"]["carry"]["low"] < found["results"]["carry"]["bias"] < found["results"]["carry"]["high"]
    assert found["results"]["side"]["unit"] == "yd"
    assert "total" not in found["results"]


def test_today_is_the_change_that_the_model_gives(bag: sandbox.Session):
    change = bag.report().document()["today"]["groups"]["7 Iron"]["carry"]
    rows = bag.first.shots.rows[bag.first.groups["7 Iron"]] - 1
    launch = {
        key: [float(bag.first.shots.table.column(name).cells[row]) * factor for row in rows]
        for key, name, factor in (("launch.speed", "Ball Speed", 0.44704), ("launch.angle", "Launch Angle", 1.0),
                                  ("launch.spin", "Spin Rate", 1.0), ("launch.axis", "Spin Axis", 1.0),
                                  ("launch.direction", "Launch Direction", 1.0))
    }  # fmt: skip
    here, there = (
        sandbox.simulate_many(sandbox.load("golf", air), launch, facts=("carry",))["carry"]
        for air in ({}, {"air.temperature": 5.0, "air.wind": [-6.0, 0.0]})
    )
    assert change["difference"] == pytest.approx(float((there - here).mean()) / 0.9144, abs=1e-6)
    assert change["difference"] < -10.0
    assert any(line.startswith("with air.temperature = 5, air.wind = ") for line in as_text(bag.report()))


def test_two_sessions_differ_by_welchs_interval(bag: sandbox.Session):
    assert bag.second is not None
    sets = [part.shots.measures["carry"].of(part.groups["Driver"]) for part in (bag.first, bag.second)]
    exact = stats.ttest_ind(sets[1], sets[0], equal_var=False).confidence_interval(0.95)
    found = bag.differences("Driver")["carry"]
    assert (found.value, found.low, found.high) == pytest.approx((sets[1].mean() - sets[0].mean(), *exact), rel=5e-3)
    assert set(bag.report().document()["difference"]) == {"Driver", "7 Iron", "PW"}
    assert bag.differences("5 Wood") == {}


def test_a_comparison_is_in_the_unit_of_the_first_file(tmp_path: Path):
    first = written(tmp_path, "Club,Carry (yd)\nPW,100\nPW,102\n")
    second = written(tmp_path, "Club,Carry (m)\nPW,100\nPW,102\n", "second.csv")
    found = sandbox.session(first, second, scene="golf").differences("PW")["carry"]
    assert found.value == pytest.approx(101.0 / 0.9144 - 101.0)


def test_free_throws_have_shares_and_no_mishits(tmp_path: Path):
    rows = [("Ann", 7.2, "made"), ("Ann", 7.3, "missed"), ("Bob", 7.2, "made"), ("Bob", 5.0, "made")] * 4
    file = written(tmp_path, "player,launch.speed,made\n" + "".join(f"{p},{v},{m}\n" for p, v, m in rows))
    found = sandbox.session(file, scene="basketball").report().document()
    assert list(found["groups"]) == ["Bob", "Ann"]
    assert {key: round(value, 3) for key, value in found["groups"]["Ann"]["made"].items()} == {
        "n": 8, "share": 0.5, "low": 0.215, "high": 0.785}  # fmt: skip
    assert found["set_aside"] == ()


def test_pitches_are_grouped_and_crossed_by_kind(tmp_path: Path):
    rows = [("FF", 95.0, 0.2, 2.5), ("FF", 94.0, -0.4, 3.0), ("FF", 96.0, 0.1, 2.2), ("CU", 79.0, 0.5, 1.8)]
    head = "pitch_type,release_speed,plate_x,plate_z,release_spin_rate\n"
    file = written(tmp_path, head + "".join(f"{kind},{v},{x},{z},2300\n" for kind, v, x, z in rows))
    found = sandbox.session(file).report().document()
    assert (found["scene"], list(found["groups"])) == ("baseball-pitch", ["FF", "CU"])
    assert found["groups"]["FF"]["dispersion"]["center"] == pytest.approx([-0.1 / 3, 7.7 / 3])
    assert found["groups"]["CU"]["plate_height"]["mean"] == 1.8


def test_conditions_bins_and_other_columns(call: Call, file: Path):
    found = json.loads(
        call(
            "session", file, "--scene", "golf", "--by", "carry", "--where", "carry > 95 yd", "--of", "Side", "--json"
        ).out
    )
    assert {name: group["n"] for name, group in found["groups"].items()} == {
        "120 yd": 1, "124 yd": 1, "104 yd": 1, "103 yd": 1, "101 yd": 1, "100 yd": 1, "99 yd": 1, "98 yd": 1
    }  # fmt: skip
    assert found["rows"] == 8


def test_what_is_no_session_is_refused(call: Call, tmp_path: Path, file: Path):
    assert_refused(call("session", written(tmp_path, "a,b\n1,2\n", "x.csv")), "--scene golf --map")
    assert_refused(call("session", file, "--scene", "golf", "--by", "Clb"), "did you mean Club?")
    assert_refused(call("session", file, "--scene", "golf", "--set-aside", "few"), "must be a number above 0, or none")
    assert_refused(call("session", file, "--scene", "golf", "--set", "air.wind=[1,0]"), "nothing of the launch")
    with pytest.raises(RequestError, match="no row has"):
        sandbox.session(file, scene="golf", where=["Club=Putter"])


def test_a_shot_without_a_value_counts_for_the_others(tmp_path: Path):
    rows = "PW,100,110\nPW,104,\nPW,-21474836480,108\nPW Average,102,109\n"
    file = written(tmp_path, "Club,Carry (yd),Total (yd)\n" + rows)
    found = sandbox.session(file, scene="golf").report().document()
    group = found["groups"]["PW"]
    assert (group["n"], group["carry"]["mean"], group["total"]["mean"]) == (3, 102.0, 109.0)
    assert [(one.row, one.why) for one in found["left_out"]] == [(4, "averages of other rows")]


def test_a_pitch_is_no_hit_and_null_no_kind(tmp_path: Path):
    head = "pitch_name,release_speed,release_pos_z,release_extension,plate_z,vy0,vz0,ay,az,launch_speed,launch_angle\n"
    rows = ["Slider,85,5.8,6.3,2.1,-123,-3,25,-30,null,null\n"] * 2 + ["null,90,5.8,6.3,2.2,-130,-4,27,-20,98,31\n"]
    file = written(tmp_path, head + "".join(rows))
    pitches = sandbox.session(file, by="pitch_name").first.shots
    assert set(pitches.groups) == {"(empty)", "Slider"}
    assert not {"launch_angle", "ball_speed"} & set(pitches.measures)
    hits = sandbox.session(file, scene="baseball", columns={"launch.speed": "launch_speed [mph]"}).first.shots
    assert hits.rows.tolist() == [3]
    assert {each.row for each in hits.left_out} == {1, 2}


def test_all_charts_are_on_the_page(call: Call, tmp_path: Path, file: Path):
    page = tmp_path / "s.html"
    done = call("session", file, file, "--scene", "golf", "--html", page)
    assert (done.code, done.err) == (0, "")
    text = page.read_text("utf-8")
    assert text.count("<svg") == 3  # distances, where shots come down, differences
    assert "shots.csv minus shots.csv" in text
