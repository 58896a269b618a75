"""Rows and columns of measured tables that are not used: left out, share_that_holds, named with their reasons."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import t as student_t

import sandbox
from sandbox.errors import RequestError
from sandbox.lab.against import Shots, read_against
from sandbox.lab.axes import Span
from sandbox.lab.fit.data import Reading, read_data
from sandbox.lab.fit.problem import Problem
from sandbox.lab.mapped import EVERYTHING, Choices, choices_of, read_shots
from sandbox.lab.misfit import misfit
from sandbox.lab.misfit import report_of as misfit_report
from sandbox.lab.report import as_text
from sandbox.lab.selection import LeftOut
from sandbox.lab.table_file import read_table
from sandbox.lab.where import conditions
from sandbox.parameters import value_at, walk
from sandbox.scene import listings
from tests.own_scene import Outcome, assert_refused

Call = Callable[..., Outcome]

SPEEDS = [60.0, 62.0, 65.0, 68.0, 70.0]
HEAD = "Club,Ball Speed (m/s),Launch Angle (deg),Spin Rate (rpm),Carry Flat - Length (m),Side (m)\n"


@pytest.fixture(scope="module")
def carries() -> list[float]:
    """Carry in m of five drives in thin air."""
    points = {"launch.speed": SPEEDS, "launch.angle": [12.0] * 5, "launch.spin": [2600.0] * 5}
    found = sandbox.simulate_many(sandbox.load("golf", {"air.density": 1.1}), points, facts=("carry",))
    return found["carry"].tolist()


def shots(carries: Sequence[float]) -> list[str]:
    return [f"D,{v},12,2600,{c},3\n" for v, c in zip(SPEEDS, carries, strict=True)]


def written(folder: Path, text: str, name: str = "track.csv") -> Path:
    (folder / name).write_text(text, "utf-8")
    return folder / name


def text_of(lines: Sequence[str]) -> str:
    return " ".join(" ".join(lines).split())


# Rows of launches ---------------------------------------------------------------------------------------------------

BAD = {
    "D,60,12,-21474836480,150,3\n": "Spin Rate = -21474836480 rpm is out of range",
    "D,60,12,2600,-21474836480,3\n": "Carry Flat - Length = -21474836480 m is out of range",
    "D,x,12,2600,150,3\n": "Ball Speed = 'x' is not a number",
    "D,60,12,2600\n": "has 4 values, but there are 6 columns",
    "D,60,12,nan,150,3\n": "Spin Rate = nan is not finite",
}


@pytest.mark.parametrize("row", BAD, ids=range(len(BAD)))
def test_a_bad_row_is_left_out_and_named(call: Call, tmp_path: Path, carries: list[float], row: str):
    good = shots(carries)
    file = written(tmp_path, HEAD + "".join([*good[:2], row, *good[2:]]))
    args = ("fit", "golf", file, "--vary", "air.density=1:1.3")
    done = call(*args, "--json")
    found = json.loads(done.out)
    assert found["values"]["air.density"]["value"] == pytest.approx(1.1, abs=1e-6)
    assert found["points"] == 5
    (left,) = found["left_out"]
    assert left["row"] == 3
    assert BAD[row] in left["why"]
    assert f"used 5 of 6 shots: row 3, {BAD[row]}" in text_of(found["said"])
    assert_refused(call(*args, "--strict"), f"track {file}: row 3, {BAD[row]}")


def test_empty_cells_and_sums_are_left_out_also_if_strict(tmp_path: Path, carries: list[float]):
    rows = ["D,60,12,,150,3\n", *shots(carries), "Avg,64,12,2600,150,3\n"]
    file = written(tmp_path, HEAD + "".join(rows))
    for strict in (False, True):
        found = sandbox.fit("golf", file, {"air.density": (1.0, 1.3)}, strict=strict).measured
        assert found.left_out == (LeftOut(1, "Spin Rate is missing"), LeftOut(7, "averages of other rows"))


@pytest.mark.parametrize(
    ("where", "rows"),
    [
        (["ball speed (m/s) = 62:68"], [2, 3, 4]),
        (["Ball Speed >= 140 mph"], [3, 4, 5]),  # 62.59 m/s
        (["launch.speed<65"], [1, 2]),
        (["launch.speed <= 65", "launch.speed != 62"], [1, 3]),
        (["Club!=w", "Ball Speed>62"], [3, 4]),
        (["Club=D", "Spin Rate=2600.0", "carry=1:1000 yd"], [1, 2, 3, 4]),
    ],
)
def test_conditions_choose_rows(tmp_path: Path, carries: list[float], where: list[str], rows: list[int]):
    every = [*shots(carries)[:4], shots(carries)[4].replace("D", "W", 1)]
    table = read_table("track", written(tmp_path, HEAD + "".join([*every, "D,60,12,2600,none,3\n"])))
    scene = sandbox.load("golf")
    found = read_shots(scene, table, Choices(where=conditions(where)))
    assert found.rows == tuple(rows)
    assert set(found.left_out) <= {LeftOut(6, "Carry Flat - Length is missing")}


def test_a_row_without_the_number_is_left_out_and_named(tmp_path: Path, carries: list[float]):
    rows = [
        row.replace(",3\n", f",{side}\n") for row, side in zip(shots(carries), ["3", "", "x", "9", "4"], strict=True)
    ]
    file = written(tmp_path, HEAD + "".join(rows))
    read = read_against(file, "golf", Choices(where=conditions("Side < 5")))
    assert isinstance(read, Shots)
    assert read.found.rows == (1, 5)
    assert read.found.left_out == (LeftOut(2, "Side is empty"), LeftOut(3, "Side = 'x' is not a number"))
    assert read.notes[0] == "only rows with Side < 5: 2 of 5"
    with pytest.raises(RequestError, match="row 3, Side = 'x' is not a number"):
        read_against(file, "golf", Choices(where=conditions("Side < 5"), strict=True))


@pytest.mark.parametrize(
    ("where", "why"),
    [
        ("Club", "--where Club: write it as COLUMN=TEXT"),
        ("Clbu=D", "has no column 'Clbu', which --where names; did you mean Club?"),
        ("zzz=D", "which --where names; it has Club, Ball Speed, Launch Angle, Spin Rate, Carry Flat - Length, Side"),
        ("Club=Iron", "no row has Club = Iron; Club has D"),
        ("Ball Speed>80", "no row has Ball Speed > 80; Ball Speed is from 60 to 70 m/s"),
        ("launch.speed=80:90", "no row has launch.speed = 80:90; launch.speed is from 60 to 70 m/s"),
        ("Ball Speed<fast", "--where Ball Speed < fast: is not a number with a unit; use m/s"),
        ("launch.speed<3 kg", "--where launch.speed < 3 kg: kg is a unit of mass; use m/s"),
    ],
)
def test_a_condition_that_cannot_hold_is_refused(tmp_path: Path, carries: list[float], where: str, why: str):
    file = written(tmp_path, HEAD + "".join(shots(carries)))
    with pytest.raises(RequestError, match=re.escape(why)):
        read_against(file, "golf", Choices(where=conditions(where)))


def test_a_row_that_repeats_another_is_left_out(tmp_path: Path, carries: list[float]):
    good = shots(carries)
    file = written(tmp_path, HEAD + "".join([*good, good[1], good[2].replace(",3\n", ",4\n"), good[1]]))
    read = read_against(file, "golf", Choices(strict=True))
    assert isinstance(read, Shots)
    assert read.found.left_out == (LeftOut(6, "repeats row 2"), LeftOut(8, "repeats row 2"))
    few = {"launch.speed": "Ball Speed", "carry": "Carry Flat - Length"}  # alike by chance
    read = read_against(file, "golf", choices_of(few, (), (), strict=False))
    assert isinstance(read, Shots)
    assert read.found.left_out == ()


def test_a_known_column_is_left_unused(call: Call, tmp_path: Path, carries: list[float]):
    rows = [row.replace(",3\n", ",1.25\n") for row in shots(carries)]
    head = HEAD.replace("Side (m)", "Air Density").replace("Carry Flat - Length", "Carry Distance")
    file = written(tmp_path, head + "".join(rows))
    assert_refused(
        call("fit", "golf", file, "--vary", "air.density=1:1.3"),
        "--vary air.density: is a column of the table; to fit it, leave that out: --without air.density",
    )
    found = sandbox.fit("golf", file, {"air.density": (1.0, 1.3)}, without="air.density")
    assert found.values["air.density"].value == pytest.approx(1.1, abs=1e-6)
    assert "Air Density" in found.measured.unused
    with pytest.raises(RequestError, match=re.escape("--without launch: --against")):
        read_against(file, "golf", Choices(without=("launch",)))
    read = read_against(file, "golf", Choices(without=("Air density",)))
    assert isinstance(read, Shots)
    assert list(read.found.given) == ["launch.speed", "launch.angle", "launch.spin"]


def test_no_row_that_can_be_used_is_an_error(call: Call, tmp_path: Path):
    file = written(tmp_path, HEAD + next(iter(BAD)) * 2)
    refused = call("fit", "golf", file, "--vary", "air.density=1:1.3")
    assert_refused(refused, "no row can be used: rows 1 and 2, Spin Rate = -21474836480 rpm is out of range")


def test_a_launch_without_the_result_is_left_out(call: Call, tmp_path: Path):
    """A pitch in the dirt has no height over the plate."""
    points = {"launch.speed": [38.0, 40.0, 42.0], "launch.angle": [-1.0, -1.5, -2.0]}
    heights = sandbox.simulate_many("baseball-pitch", points, facts=("plate_height",))["plate_height"].tolist()
    rows = [*zip(*points.values(), heights, strict=True), (40.0, -20.0, 0.1)]
    file = written(tmp_path, "v,up,height\n" + "".join(f"{v},{up},{h}\n" for v, up, h in rows))
    maps = [part for one in ("launch.speed=v [m/s]", "launch.angle=up [deg]", "plate_height=height [m]")
            for part in ("--map", one)]  # fmt: skip
    done = call("fit", "baseball-pitch", file, *maps, "--vary", "air.density=1:1.4", "--json")
    assert json.loads(done.out)["left_out"] == [{"row": 4, "why": "baseball-pitch has no plate_height for this launch"}]
    strict = call("fit", "baseball-pitch", file, *maps, "--vary", "air.density=1:1.4", "--strict")
    assert_refused(strict, "row 4, baseball-pitch has no plate_height for this launch")


def test_ground_balls_are_left_out_by_rule(tmp_path: Path):
    """Their distance is where they were fielded: with them the spin would stop at the end of its range."""
    speeds, angles = [42.0, 45.0, 47.0, 44.0], [24.0, 28.0, 31.0, 19.0]
    points = {"launch.speed": speeds, "launch.angle": angles}
    spun = sandbox.load("baseball", {"launch.spin": 2100.0, "launch.sidespin": 2190.0})
    far = sandbox.simulate_many(spun, points, facts=("distance",))
    rows = [f"{v / 0.44704},{a},{d / 0.3048 + 1},fly_ball\n"
            for v, a, d in zip(speeds, angles, far["distance"].tolist(), strict=True)]  # fmt: skip
    rows += ["104.2,-12,9,ground_ball\n", "101.0,4,140,line_drive\n", "98,15,120,ground_ball\n"]
    file = written(tmp_path, "launch_speed,launch_angle,hit_distance_sc,bb_type\n" + "".join(rows))
    found = sandbox.fit("baseball", file, {"launch.spin": (1000, 3500)})
    spin = found.values["launch.spin"]
    assert spin.low is not None
    assert spin.value == pytest.approx(2100.0, abs=150.0)
    assert [each.row for each in found.measured.left_out] == [5, 6, 7]
    assert (
        "used 4 of 7 shots: rows 5 and 7, is a ground ball: its distance is where it was fielded; row 6, "
        in text_of(as_text(found.report()))
    )


def test_a_value_at_the_end_of_its_range_is_no_result(call: Call, tmp_path: Path, carries: list[float]):
    file = written(tmp_path, HEAD + "".join(shots(carries)))
    done = call("fit", "golf", file, "--vary", "air.density=1.15:1.3", "--json")
    value = json.loads(done.out)["values"]["air.density"]
    assert (value["value"], value["low"], value["high"], value["at_bound"]) == (1.15, None, None, True)
    assert value["interval_kind"] is json.loads(done.out)["interval_kind"] is None
    said = call("fit", "golf", file, "--vary", "air.density=1.15:1.3", "--save", tmp_path / "x.toml").out
    assert "1.15 kg/m^3 no result: at the end of its range" in text_of(said.splitlines())
    assert "±" not in said
    assert "no result" in (tmp_path / "x.toml").read_text("utf-8")


def test_launches_are_compared_without_tolerances(call: Call, tmp_path: Path, carries: list[float]):
    off = [1.0, -2.0, 3.0, 0.5, 2.5]  # m, computed minus measured
    rows = shots([carry - each for carry, each in zip(carries, off, strict=True)])
    file = written(tmp_path, HEAD + "".join([next(iter(BAD)), *rows]))
    args = ("validate", "golf", "--against", file, "--set", "air.density=1.1")
    found = json.loads(call(*args, "--by", "launch.speed", "--json").out)
    carry = found["results"]["carry"]
    interval = student_t.interval(0.95, 4, np.mean(off), np.std(off, ddof=1) / 5**0.5)
    assert (carry["low"], carry["high"]) == pytest.approx(interval, rel=4e-3)
    assert (carry["n"], carry["unit"], carry["worst"]["row"]) == (5, "m", 4)
    expected = np.mean(off), np.std(off, ddof=1), np.sqrt(np.mean(np.square(off))), 3.0
    assert (carry["bias"], carry["sd"], carry["rms"], carry["worst"]["off"]) == pytest.approx(expected, abs=1e-6)
    assert [each["why"][:9] for each in found["left_out"]] == ["Spin Rate"]
    assert (found["rows"], found["used"]) == (6, 5)
    groups = {name: results["carry"] for name, results in found["by"].items()}
    assert [(name, each["n"], each["low"]) for name, each in groups.items()] == [
        (f"{speed:g} m/s", 1, None) for speed in SPEEDS
    ]
    said = call(*args, "--all").out
    assert text_of(said.splitlines()).startswith("golf: 5 shots, computed minus measured result n bias")
    assert "used 5 of 6 shots: row 1, Spin Rate" in text_of(said.splitlines())
    assert said.count("  carry  ") == 1 + 5
    assert_refused(call(*args, "--by", "Clbu"), f"{file}: has no column 'Clbu', which --by names; did you mean Club?")
    assert_refused(call(*args, "--by", "Club", "--within", "carry=2%"), "--by and --all are for a table of launches")
    assert_refused(call(*args, "--strict"), "row 1, Spin Rate = -21474836480 rpm is out of range")


def test_groups_of_many_numbers_are_bins(tmp_path: Path):
    file = written(tmp_path, HEAD + "".join(f"D,{60 + each},12,2600,150,3\n" for each in range(20)))
    shots_of = read_against(file, "golf", EVERYTHING)
    assert isinstance(shots_of, Shots)
    found = misfit(shots_of, by="Ball Speed")
    assert {name: kept.sum() for name, kept in found.groups.items()} == {
        "60 to 62 m/s": 2, "62 to 64 m/s": 2, "64 to 66 m/s": 2, "66 to 68 m/s": 2, "68 to 70 m/s": 2,
        "70 to 72 m/s": 2, "72 to 74 m/s": 2, "74 to 76 m/s": 2, "76 to 78 m/s": 2, "78 to 80 m/s": 2,
    }  # fmt: skip
    assert [chart.panels[0].x for chart in misfit_report(found).charts()] == ["measured (m)"]


def test_rows_are_left_out_of_a_validation(call: Call, tmp_path: Path, carries: list[float]):
    file = written(tmp_path, HEAD + "".join([next(iter(BAD)), *shots(carries)]))
    args = ("validate", "golf", "--against", file, "--within", "carry=2%", "--set", "air.density=1.1")
    said = text_of(call(*args).out.splitlines())
    assert "5 of 5 measured numbers hold" in said
    assert "used 5 of 6 rows: row 1, Spin Rate = -21474836480 rpm is out of range" in said
    as_json = call(*args, "--json")
    assert len(json.loads(as_json.out)) == 5
    assert as_json.err.startswith("used 5 of 6 rows: row 1, Spin Rate")
    assert_refused(call(*args, "--strict"), "row 1, Spin Rate = -21474836480 rpm is out of range")
    own = written(tmp_path, "result,value,tolerance\ncarry,200,5\ncarry,200,1,5\ncarry,200,5\n", "own.csv")
    assert_refused(call("validate", "golf", "--against", own), "row 2 has 4 values, but there are 3 columns")
    assert_refused(call("validate", "golf", "--strict"), "--strict require --against")


def test_a_table_of_shots_gives_the_points_of_a_sweep(call: Call, tmp_path: Path, carries: list[float]):
    rows = [*shots(carries), next(iter(BAD)), "W,60,12,2600,none,3\n"]
    file, out = written(tmp_path, HEAD + "".join(rows)), tmp_path / "out.csv"
    done = call("sweep", "golf", "--points", file, "--where", "Club=D", "--set", "air.density=1.1", "--out", out)
    assert "used 5 of 6 shots: row 6, Spin Rate = -21474836480 rpm" in text_of(done.out.splitlines())
    swept = [line.split(",") for line in out.read_text().splitlines()]
    column = swept[0].index("carry")
    assert [float(row[column]) for row in swept[1:]] == pytest.approx(carries)
    thin = sandbox.load("golf", {"air.density": 1.1})
    found = sandbox.simulate_many(thin, file, facts=("carry",), columns={"launch.speed": "Ball Speed"}, without=())
    assert found.rows == (1, 2, 3, 4, 5, 6, 7)
    found = sandbox.simulate_many(thin, file, facts=("carry",))
    assert found["carry"][:5] == pytest.approx(carries)
    assert [each.row for each in found.left_out] == [6]
    assert_refused(
        call("sweep", "golf", "--where", "a=b", "--out", out), "--map, --where, --without and --strict require"
    )


def test_results_that_disagree_make_the_interval_robust(call: Call, tmp_path: Path):
    """The model's drag is 4 % less than that of these shots: carry and apex call for different densities of the air."""
    fixed = {"ball.drag.model": "constant", "ball.drag.coefficient": 0.25}
    given = {"launch.speed": np.linspace(55.0, 70.0, 12), "launch.angle": np.linspace(18.0, 11.0, 12),
             "launch.spin": np.linspace(5000.0, 2600.0, 12)}  # fmt: skip
    names, noise = ("carry", "apex", "flight_time"), np.random.default_rng(1).normal(size=(3, 12))
    spread = (0.5, 0.1, 0.02)
    for drag, kind in ((0.26, "robust"), (0.25, "normal")):
        flown = sandbox.simulate_many(
            sandbox.load("golf", {**fixed, "ball.drag.coefficient": drag}), given, facts=names
        )
        table = given | {name: flown[name] + sd * own for name, sd, own in zip(names, spread, noise, strict=True)}
        columns = {key: key for key in table}
        found = sandbox.fit(sandbox.load("golf", fixed), table, {"air.density": (1.0, 1.4)}, columns=columns)
        value = found.values["air.density"]
        assert value.interval_kind == kind
        assert found.robust_by == (("result",) if kind == "robust" else ())
        wider = found.half_widths["air.density"] / found.normal_half_widths["air.density"]
        assert value.half == pytest.approx(found.half_widths["air.density"])
        assert wider > 3.0 if kind == "robust" else wider == 1.0
        assert ("errors are alike in each result, by more than chance" in text_of(as_text(found.report()))) == (
            kind == "robust"
        )


# Rows of tracks -----------------------------------------------------------------------------------------------------

THROW = [(t, 1.0 + 5.0 * t, 2.0 + 3.0 * t - 4.905 * t * t) for t in (np.arange(12) / 20).tolist()]


@pytest.mark.parametrize("cell", ["", "nan", "oops"])
def test_an_empty_cell_of_a_track_leaves_out_its_row(call: Call, tmp_path: Path, cell: str):
    """The times of the others stay: g is as it was thrown."""
    lines = [f"{t},{x},{y if place != 2 else cell}\n" for place, (t, x, y) in enumerate(THROW)]
    file = written(tmp_path, "t,x,y\n" + "".join(lines))
    vary = ("--vary", "gravity=8:12", "--vary", "launch.speed=2:9", "--vary", "launch.angle=10:60")
    args = ("fit", "throws", file, *vary, "--free", "origin", "--set", "ball.drag.model=none")
    found = json.loads(call(*args, "--json").out)
    assert found["values"]["gravity"]["value"] == pytest.approx(9.81, abs=1e-3)
    assert (found["points"], [each["row"] for each in found["left_out"]]) == (11, [3])
    assert_refused(call(*args, "--strict"), f"track {file}: row 3, y ")


def test_a_wrong_scale_is_named_by_the_gravity_of_the_arcs(call: Call, tmp_path: Path):
    """A ball that bounces three times, measured 30 % too large; and on a clock that is 20 % too slow."""
    run = sandbox.simulate(sandbox.load("collisions/bouncing-ball", {"launch.speed": 0.8, "launch.angle": 0.0}))
    t = np.arange(0.0, 1.9, 1.0 / 30.0)
    x, y = (run.states("first", t)[:, :2] + np.random.default_rng(2).normal(0.0, 0.004, (len(t), 2))).T
    vary = ("--vary", "floor.restitution", "--vary", "launch.speed=0:2", "--free", "origin")
    for scale, clock, said in ((1.3, 1.0, "scale is 30 % off, or your clock 12 %"), (1.0, 0.8, "scale is 5")):
        rows = "".join(f"{at * clock},{scale * right},{scale * up}\n" for at, right, up in zip(t, x, y, strict=True))
        refused = call("fit", "collisions/bouncing-ball", written(tmp_path, "t,x,y\n" + rows), *vary)
        assert_refused(refused, f"m/s^2, not 9.81: your {said}")
    again = call("fit", "collisions/bouncing-ball", tmp_path / "track.csv", *vary, "--set", "gravity=15.3", "--json")
    assert json.loads(again.out)["values"]["floor.restitution"]["value"] == pytest.approx(0.75, abs=0.01)


# Heads --------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "head",
    [
        "Club,Ball Speed,Carry,\nShots of Monday,[mph],[yds],\n",
        "Club,Ball Speed,Carry,\n,[mph],[yds],[m]\n",
        "Club,Ball Speed,Carry\nUnits,[mph],[yds],[m]\n",
        ",Ball Speed,Carry,\n,[mph],[yds],\n",
    ],
)
def test_a_head_with_a_title_or_without_a_name_is_read(tmp_path: Path, head: str):
    table = read_table("track", written(tmp_path, head + "D,100,150,7\nI,90,140,8\n"))
    assert [(one.name, one.unit) for one in table.columns][1:3] == [("Ball Speed", "mph"), ("Carry", "yd")]
    assert len(table.columns) == 4
    assert [column.cells for column in table.columns] == [("D", "I"), ("100", "90"), ("150", "140"), ("7", "8")]


def test_a_translated_head_is_known(tmp_path: Path, carries: list[float]):
    head = (
        "Schlägerart;Ballgeschwindigkeit;Abflugwinkel;Drehrate;Drehachse;Carry-Distanz\n;[km/h];[deg];[rpm];[deg];[m]\n"
    )
    rows = "".join(f"Driver;{v * 3.6};12;2600;0;{c}\n".replace(".", ",") for v, c in zip(SPEEDS, carries, strict=True))
    found = read_data(sandbox.load("golf"), [written(tmp_path, head + rows)], Reading())
    assert found.given["launch.speed"] == pytest.approx(SPEEDS)
    assert found.measured["carry"] == pytest.approx(carries)


def test_accelerations_alone_are_nothing_to_fit(call: Call, tmp_path: Path):
    head = "Time (s),Linear Acceleration x (m/s^2),Linear Acceleration y (m/s^2),Absolute acceleration (m/s^2)\n"
    file = written(tmp_path, head + "0,-0.12,-0.39,0.44\n0.01,0.05,-0.33,0.36\n")
    refused = call("fit", "throws", file, "--vary", "launch.speed")
    assert_refused(refused, "no positions: there is nothing to fit. Its peaks tell when something was hit: write")


@pytest.fixture(scope="module")
def heard() -> tuple[list[float], list[float]]:
    """Times in s of the bounces of a ball in air, and heights in m after them, the first where it is dropped."""
    ball = {"floor.restitution": 0.8, "air.density": 1.2, "duration": 8.0}
    run = sandbox.simulate(sandbox.load("collisions/bouncing-ball", ball))
    times = [event.t for event in run.events if event.kind == "impact"][:6]
    ends = [0.0, *times]
    arcs = (run.states("first", np.linspace(*pair, 2001))[:, 1] for pair in pairwise(ends))
    return times, [float(arc.max()) - 0.033 for arc in arcs]


BOUNCING = ("collisions/bouncing-ball", "--vary", "floor.restitution", "--vary")


@pytest.mark.parametrize("since", ["release", "first bounce"])
def test_restitution_and_drag_come_from_times_of_bounces(call: Call, tmp_path: Path, heard, since: str):
    """A bounce was not heard; a clock that starts with a bounce leaves open when the ball was released."""
    noise, start = np.random.default_rng(0).normal(0.0, 2e-5, 6), heard[0][0] if since == "first bounce" else 0.0
    rows = [f"{number};{1e3 * (t - start + error if number > 1 else t - start)}\n"
            for number, (t, error) in enumerate(zip(heard[0], noise, strict=True), start=1) if number != 4]  # fmt: skip
    file = written(tmp_path, "bounce;t (ms)\n" + "".join(rows).replace(".", ","))
    found = json.loads(call("fit", BOUNCING[0], file, *BOUNCING[1:], "air.density=0:6", "--json").out)
    values = found["values"]
    assert values["floor.restitution"]["value"] == pytest.approx(0.8, abs=0.003)
    assert values["air.density"]["value"] == pytest.approx(1.2, abs=0.4)  # the drag is in proportion to it
    assert ("track.time" in values) == (since == "first bounce")
    assert (found["points"], list(found["residual_sd"])) == (5, ["t"])


def test_restitution_and_place_come_from_heights(call: Call, tmp_path: Path, heard):
    rows = "".join(f"{number},{100 * height}\n" for number, height in enumerate(heard[1]))
    file = written(tmp_path, "Bounce,height (cm)\n" + rows)
    done = call("fit", BOUNCING[0], file, *BOUNCING[1:], "balls[0].y=1:2", "--set", "air.density=1.2", "--json")
    values = json.loads(done.out)["values"]
    assert values["floor.restitution"]["value"] == pytest.approx(0.8, abs=1e-5)
    assert values["balls[0].y"]["value"] == pytest.approx(1.533, abs=1e-5)
    written(tmp_path, "bounce,t\n1.5,2\n")
    assert_refused(call("fit", BOUNCING[0], file, *BOUNCING[1:], "gravity"), "row 1, bounce = 1.5 is no number of a")


def test_columns_without_names_are_taken_as_a_track(call: Call, tmp_path: Path):
    rows = "".join(f"{t};{x};{y}\n" for t, x, y in THROW)
    file = written(tmp_path, "\ufeff" + rows)
    args = ("fit", "throws", file, "--vary", "launch.speed=2:9", "--vary", "launch.angle=10:60", "--free", "origin")
    found = json.loads(call(*args, "--json").out)
    assert found["points"] == 12
    note = next(each for each in found["said"] if each.startswith("columns without names, taken as t in s, x and y in"))
    maps = note.rpartition("to choose others: ")[2].split()
    assert maps == ["--map", "t=1", "--map", "x=2", "--map", "y=3"]
    assert json.loads(call(*args, *maps, "--json").out)["values"] == found["values"]
    written(tmp_path, "".join(f"{x};{y}\n" for _, x, y in THROW))
    assert_refused(call(*args), "begins with numbers (1.0, 2.0)")


# Columns that are not used ------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("head", "order", "unused"),
    [
        ("Timestamp,X,Y,Z", "txsy", "Y"),  # Z is the height
        ("Timestamp,X,Y,Z", "txys", "Z"),  # Y falls
        ("Timestamp,X,Y,Z", "tsxy", "X"),  # thrown along Y
    ],
)
def test_the_height_of_three_coordinates_is_found(tmp_path: Path, head: str, order: str, unused: str):
    rows = [{"t": t, "x": x, "y": y, "s": 0.3 + 0.05 * t} for t, x, y in THROW]
    lines = [",".join(repr(row[name]) for name in order) + "\n" for row in rows]
    found = read_data(sandbox.load("throws"), [written(tmp_path, f"{head}\n" + "".join(lines))], Reading())
    assert found.t == pytest.approx([row["t"] for row in rows])
    assert found.positions == pytest.approx(np.array([(row["x"], row["y"]) for row in rows]))
    (note,) = found.notes
    assert f"{unused} is not used: it spans 0.0275 m" in note


def test_the_axes_of_three_coordinates_may_be_named(tmp_path: Path):
    file = written(tmp_path, "Timestamp,X,Y,Z\n" + "".join(f"{t},{x},{y},{2 * x}\n" for t, x, y in THROW))
    named = Reading(choices=choices_of({"t": "Timestamp", "x": "X", "y": "Z"}, (), (), strict=False))
    found = read_data(sandbox.load("throws"), [file], named)
    assert found.positions[:, 1] == pytest.approx([2.0 * x for _, x, _ in THROW])
    from_above = read_data(sandbox.load("soccer-curl"), [file], Reading())
    assert from_above.positions[:, 1] == pytest.approx([y for *_, y in THROW])


def test_axis_direction_and_side_are_used(tmp_path: Path):
    """As a monitor writes them: to the left with an L; a shot without an axis flies straight."""
    tilts, aims = [0.0, -5.0, 9.0, 20.0, 0.0], [2.0, 0.0, -1.0, 1.0, 0.0]
    given = {"launch.speed": SPEEDS, "launch.angle": [12.0] * 5, "launch.spin": [2600.0] * 5, "launch.axis": tilts,
             "launch.direction": aims}  # fmt: skip
    thin = sandbox.load("golf", {"air.density": 1.1})
    flown = sandbox.simulate_many(thin, given, facts=("carry", "side"))
    head = HEAD.replace("Side (m)", "Carry Flat - Side (m),Spin Axis (deg),Launch Direction (deg)")
    cells = zip(SPEEDS, flown["carry"], flown["side"], ("0", "5.0 L", "9 R", "20", ""), aims, strict=True)
    rows = "".join(f"D,{v},12,2600,{far!r},{side!r},{tilt},{aim}\n" for v, far, side, tilt, aim in
                   ((v, float(c), float(s), t, a) for v, c, s, t, a in cells))  # fmt: skip
    found = sandbox.fit("golf", written(tmp_path, head + rows), {"air.density": (1.0, 1.3)})
    assert found.values["air.density"].value == pytest.approx(1.1, abs=1e-6)
    assert found.residual_sd["side"] < 1e-6
    assert found.measured.unused == ("Club",)
    assert "Spin Axis is missing in row 5: taken as 0" in text_of(as_text(found.report()))


# Parameters that are not set ----------------------------------------------------------------------------------------


def test_a_parameter_that_is_not_set_starts_in_the_middle():
    """Of every scene; such as a density that follows from temperature and pressure."""
    seen = set()
    track = sandbox.lab.fit.data.table_of({"t": [0.0, 0.1], "x": [0.0, 1.0], "y": [0.0, 1.0]})
    for name in (listing.name for listing in listings() if "/" not in listing.name):
        scene = sandbox.load(name)
        unset = [one for one in walk(scene.parameters, entries=True)
                 if one.low is not None and value_at(scene.parameters, one.key) is None]  # fmt: skip
        measured = sandbox.lab.fit.data.data_of(scene, [("", track)], Reading())
        problem = Problem(scene, measured, [Span(one.key, one.low, one.high) for one in unset])
        assert problem.own == pytest.approx([0.5] * len(unset))
        seen |= {f"{name} {one.key}" for one in unset}
    assert {"baseball air.density", "baseball-pitch air.density", "bullet air.density"} <= seen


def test_a_density_that_is_not_set_is_fitted(tmp_path: Path):
    points = {"launch.speed": [42.0, 44.0, 45.0], "launch.angle": [30.0, 28.0, 27.0]}
    usual = {"launch.spin": [2837.0, 2597.0, 2477.0], "launch.sidespin": [2190.0] * 3}  # rpm, of average balls
    scene = sandbox.load("baseball", {"air.density": 1.12})
    far = sandbox.simulate_many(scene, points | usual, facts=("distance",))["distance"]
    table = {"v": points["launch.speed"], "up": points["launch.angle"], "far": far.tolist()}
    columns = {"launch.speed": "v [m/s]", "launch.angle": "up [deg]", "distance": "far [m]"}
    found = sandbox.fit("baseball", table, {"air.density": (1.0, 1.3)}, columns=columns)
    assert found.values["air.density"].value == pytest.approx(1.12, abs=1e-6)
    models = sandbox.fit(
        "baseball", table, {"air.density": (1.0, 1.3)}, columns=columns, models={"ball.lift.model": ["nathan", "none"]}
    )
    assert models.models["nathan"].fit is not None
    with pytest.raises(RequestError, match="unknown key"):
        sandbox.fit("baseball", table, {"air.dense": (1.0, 1.3)}, columns=columns)
