"""Data for a fit: tracks as other programs write them, photographs, tables of launches; and what is refused."""

from __future__ import annotations

import json
import re
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import sandbox
from sandbox.cli.program import app, call
from sandbox.errors import RequestError
from sandbox.lab.fit.data import Reading, data_of, read_data, table_of
from sandbox.lab.fit.launches import Launches
from sandbox.lab.fit.outline import distances
from sandbox.lab.fit.parsing import Film, measurements, parse_scale
from sandbox.lab.formats import forms, recognized
from sandbox.lab.mapped import choices_of
from sandbox.lab.report import as_text
from sandbox.lab.selection import LeftOut
from sandbox.lab.table_file import read_table

PLAIN = Film()

#: Three points at 0, 0.1 and 0.2 s, at (1, 2), (1.5, 2.25) and (2, 2) m.
WRITTEN = {
    "CSV": "t,x,y\n0,1,2\n0.1,1.5,2.25\n0.2,2,2\n",
    "units in the names": "Time [ms],x (cm),y/cm\n0,100,200\n100,150,225\n200,200,200\n",
    "decimal commas": "t;x;y\n0,0;1,0;2,0\n0,1;1,5;2,25\n0,2;2,0;2,0\n",
    "Tracker's text": "mass A\t\t\nt\tx\ty\t\n0.0E0\t1.0E0\t2.0\t\n5.0E-2\t\t\t\n0.1\t1.5\t2.25\t\n0.2\t2.0\t2.0\t\n",
    "Tracker's CSV": "#multi:\n,mass A,,,\nt,frame,x,y,\n0.0,0,1.0,2.0,\n0.1,3,1.5,2.25,\n0.2,6,2.0,2.0,\n",
    "spaces, a comment": "# by hand\n t   x    y\n 0.0 1.0  2.0\n 0.1 1.5  2.25\n\n 0.2 2.0 2.0\n",
    "names behind #": "# t,x,y\n0,1,2\n0.1,1.5,2.25\n0.2,2,2\n",
    "Vernier": "Latest: Time (s),Latest: X (m),Latest: Y (m)\n0,1,2\n0.1,1.5,2.25\n0.2,2,2\n",
    "JSON by columns": '{"t": [0, 0.1, 0.2], "x": [1, 1.5, 2], "y": [2, 2.25, 2]}',
    "JSON by rows": '[{"t": 0, "x": 1, "y": 2}, {"t": 0.1, "x": 1.5, "y": 2.25}, {"t": 0.2, "x": 2, "y": 2}]',
    "Kinovea": "#Kinovea Trajectory data export\n#T X Y\n0:00:00:00 1.00 2.00\n0:00:00:10 1.50 2.25\n0:00:00:20 2 2\n",
    "Kinovea's next": "#Kinovea Trajectory data export\n#T X Y\n\n# ball\n0.00 1 2\n0.10 1.5 2.25\n0.20 2 2\n",
    "Logger Pro": "Vernier Format 2\nthrow.cmbl\n.\nVideo Analysis\nTime\tX\tY\nt\tx\ty\ns\tcm\tcm\n"
    "0\t100\t200\n0.1\t150\t225\n0.2\t200\t200\n",
    "names of its own": "Zeit (s);Ort x (m);Ort y (m);v x (m/s)\n0;1;2;5\n0,1;1,5;2,25;5\n0,2;2;2;5\n",
    "phyphox": '"Time (s)","Position x (m)","Position y (m)"\n0,1,2\n1e-1,1.5,2.25\n2E-1,2,2\n',
    "all cells": "mass_A\t\t\t\t\nt\tx\ty\tv_{x}\ta\t\n0\t1\t2\t\t\t\n0.1\t1.5\t2.25\t5\t\t\n0.2\t2\t2\t\t\t\n",
    "our own": "t,ball,x,y,vx,vy,spin\n0,,1,2,5,1,0\n0.1,,1.5,2.25,5,0,0\n0.2,,2,2,5,-1,0\n",
}


def read(folder: Path, text: str, film: Film = PLAIN):
    (folder / "track.csv").write_text(text, "utf-8")
    return measurements([("track", read_table("track", folder / "track.csv"))], film)


@pytest.mark.parametrize("text", WRITTEN.values(), ids=WRITTEN)
def test_a_track_is_read_as_programs_write_it(tmp_path, text):
    found = read(tmp_path, text)
    assert found.t == pytest.approx([0.0, 0.1, 0.2])
    assert found.positions == pytest.approx(np.array([[1.0, 2.0], [1.5, 2.25], [2.0, 2.0]]))


def test_older_encodings_and_marks_of_order_are_read(tmp_path):
    file = tmp_path / "track.csv"
    for encoding in ("utf-16", "cp1252", "utf-8-sig"):
        file.write_bytes("Größe;t;x;y\n1;0;1,5;2\n2;1;2;3\n".encode(encoding))
        assert measurements([("", read_table("track", file))], PLAIN).positions[0] == pytest.approx([1.5, 2.0])


def test_pixels_have_y_downwards_and_frames_have_no_times(tmp_path):
    film = Film(parse_scale("200 px = 4 ft"), (10.0, 300.0), 50.0)
    found = read(tmp_path, "frame,x (px),y (px)\n0,10,200\n5,210,300\n", film)
    assert found.t == pytest.approx([0.0, 0.1])
    assert found.positions == pytest.approx(0.3048 * np.array([[0.0, 2.0], [4.0, 0.0]]))
    assert parse_scale("1 m = 120 px") == parse_scale("120 px = 1 m") == parse_scale("120 px/m") == 1.0 / 120.0


def test_names_of_columns_can_be_given():
    track = {"Zeit": [0, 100, 200], "rechts (cm)": [0, 50, 100], "hoch": [210, 260, 290]}
    columns = {"t": "Zeit [ms]", "x": "rechts (cm)", "y": "hoch+0.5-1/2 [cm]"}
    choices = choices_of(columns, (), (), strict=False)
    found = data_of(sandbox.load("throws"), [("", table_of(track))], Reading(choices=choices))
    assert found.times == pytest.approx([0.0, 0.0, 0.1, 0.1, 0.2, 0.2])
    assert found.positions == pytest.approx(np.array([[0.0, 2.1], [0.5, 2.6], [1.0, 2.9]]))
    with pytest.raises(RequestError, match=r"--map x=weit: has no column 'weit'; did you mean Zeit\? Write it as"):
        sandbox.fit("throws", track, {"launch.speed": (2, 20)}, columns={"x": "weit", "y": "hoch"})


def test_several_balls_come_side_by_side_or_in_files(tmp_path):
    text = "#multi:\n,mass A,,mass B,,\nt,x,y,x,y,\n0,1,2,3,4,\n0.1,5,6,,,\n"
    found = read(tmp_path, text, Film(balls={"mass A": "first", "mass B": "second"}))
    assert found.balls == ("first", "first", "second")
    assert found.positions.tolist() == [[1.0, 2.0], [5.0, 6.0], [3.0, 4.0]]
    assert found.rows.tolist() == [1, 2, 1]
    (tmp_path / "second.csv").write_text("t,x,y\n0,3,4\n")
    tables = [(name, read_table("track", tmp_path / f"{name}.csv")) for name in ("track", "second")]
    (tmp_path / "track.csv").write_text("t,x,y\n0,1,2\n")
    tables[0] = ("first", read_table("track", tmp_path / "track.csv"))
    assert measurements(tables, PLAIN).balls == ("first", "second")


def test_one_of_several_balls_is_chosen():
    track = {"t": [0, 0.1, 0, 0.1], "x": [0, 1, 5, 6], "y": [2, 2.1, 3, 3.1], "ball": ["A", "A", "B", "B"]}
    with pytest.raises(RequestError, match='"A=ball", and the others are left out'):
        sandbox.fit("throws", track, {"launch.speed": (2, 20)})
    found = data_of(sandbox.load("throws"), [("", table_of(track))], Reading(Film(balls={"B": "ball"})))
    assert found.positions.tolist() == [[5.0, 3.0], [6.0, 3.1]]
    assert found.notes == ("balls that are not used: A",)


def test_a_fall_straight_down_needs_no_x():
    """y = 2 - g t^2 / 2, in x nothing: its exact agreement says nothing of the error in y."""
    t = np.linspace(0.0, 0.6, 30)
    y = 2.0 - 4.905 * t**2 + np.random.default_rng(1).normal(0.0, 0.003, len(t))
    with pytest.raises(RequestError, match='for a fall straight down --map "x=0\\*y" --map "y=y" --map "t=t"'):
        sandbox.fit("throws", {"t": t, "y (m)": y}, {"gravity": (5, 15)})
    still = sandbox.load("throws", {"launch.speed": 0.0, "release.height": 2.0, "ball.drag.model": "none"})
    columns = {"x": "0*y", "y": "y", "t": "t"}
    found = sandbox.fit(still, {"t": t, "y (m)": y}, {"gravity": (5, 15)}, columns=columns)
    slopes = 0.5 * t**2
    error = 2.045 * found.residual_sd["y"] / np.sqrt((slopes**2).sum())
    assert found.values["gravity"].half == pytest.approx(error, rel=0.05)
    assert found.values["gravity"].holds(9.81)


@pytest.mark.parametrize(
    "text",
    [
        '"Event time (s)","Interval (s)"\n0.8,NaN\n1.5,0.7\n2.1,0.6\n',
        '"Start (s)","Stop 1 (s)","Stop 2 (s)"\n0.8,1.5,2.1\n',
        '"Bounce 0 (s)","Height 0 (m)","Bounce 1 (s)","Height 1 (m)","Energy 1","Bounce 2 (s)"\n0.8,1,1.5,0.6,1,2.1\n',
    ],
)
def test_bounces_that_phyphox_heard_are_read_as_exported(tmp_path, text):
    (tmp_path / "heard.csv").write_text(text, "utf-8")
    found = read_data(sandbox.load("collisions/bouncing-ball"), [tmp_path / "heard.csv"], Reading())
    assert (found.bounces.tolist(), found.t.tolist()) == ([1, 2, 3], [0.8, 1.5, 2.1])
    assert [one.key for one in found.free] == ["track.time"]


def test_times_of_bounces_may_have_other_names():
    clock = {"Event": [1, 2, 3, 4], "Time (s)": [0.0, 0.7312, 1.3599, 1.9010]}
    vary = {"floor.restitution": None, "balls[0].y": (0.3, 3.0)}
    with pytest.raises(RequestError, match='for times of bounces --map "t=Time" --map "bounce=Event"'):
        sandbox.fit("collisions/bouncing-ball", clock, vary)
    found = sandbox.fit("collisions/bouncing-ball", clock, vary, columns={"t": "Time", "bounce": "Event"})
    assert found.values["floor.restitution"].value == pytest.approx(0.86, abs=0.001)


# What is no track ----------------------------------------------------------------------------------------------------

WRONG = {
    "t,x\n0,1\n": "needs one column y in its first line, which has: t, x",
    "t,x (cm),y (m)\n0,1,2\n": "units are mixed: x is in cm, but y is in m",
    "t,x (cm),y\n0,1,2\n": "units are mixed: x is in cm, but y has no unit",
    "t,x (kg),y (kg)\n0,1,2\n": "x is in kg: kg is a unit of mass; use m",
    "t,x (px),y (px)\n0,1,2\n": "x and y are in px; give --scale",
    "frame,x (px),y (px)\n0,1,2\n": "and the frames per second, such as --fps 240",
    "frame,x,y\n0,1,2\n": "has frames, but no times",
    "t,x,y\n0,0,0\n0.2,1,1\n0.1,2,2\n": "row 3, t = 0.1 s is before 0.2 s in the row above",
    "t,x,y\n0,1,nan\n": "row 1, y = nan is not finite",
    "t,x,y\n0,1,\n": "row 1, y is empty",
    "t,x,y\n0,0,3 ft\n": "row 1, y = '3 ft' is not a number",
    "t,x,y\n0,1\n": "row 1 has 2 values, but there are 3 columns",
    "t,x,y\n0,1,2,3\n": "row 1 has 4 values, but there are 3 columns",
    "0,1,2\n0,2,3\n": "begins with numbers",
    "t,x,y\n": "has no points",
    "\n \n": "is empty",
    "Dear teacher,\nhere is my track\n": "is no table",
    "hello": "is no table",
    "<!DOCTYPE html>\n<html></html>\n": "is no table but XML or HTML",
    "\x89PNG\r\n\x1a\n\x00\x00": "is no table but a binary file",
    '{"a": ': "is neither a table nor JSON",
    't,x,y\n"0,1,2\n': "a quote in it is not closed",
    "[1, 2]": "no list of objects",
}


@pytest.mark.parametrize("text", WRONG, ids=range(len(WRONG)))
def test_what_is_no_track_is_one_line(tmp_path, capsys, text):
    file = tmp_path / "track.csv"
    file.write_bytes(text.encode("latin-1"))
    assert call(["fit", "throws", str(file), "--vary", "launch.speed=5:20"]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    assert said.err.startswith(f"error: track {file}: ")
    assert WRONG[text] in said.err
    assert said.err.count("\n") == 1


@pytest.mark.parametrize(
    ("options", "wrong"),
    [
        (["--scale", "120 px = 1 kg"], "--scale 120 px = 1 kg: kg is no unit of length"),
        (["--scale", "a"], '--scale a: write it as "120 px = 1 m"'),
        (["--origin", "3"], "--origin 3: write it as X,Y"),
        (["--free", "lens"], "--free lens: what may be free is time, origin, tilt"),
        (["--where", "a=b"], "--where is for tables of launches"),
        (["--fps", "30"], "has no column frame"),
        (["--ball", "ball=egg"], "no ball 'egg'"),
        (["--ball", "egg=ball"], "has no ball 'egg'; it has ball"),
        (["--map", "launch.speeed=x"], "no such parameter or result in throws; did you mean launch.speed?"),
        (
            ["--map", "launch.speed=z [m/s]"],
            "--map launch.speed=z [m/s]: has no column 'z'; it has t, x, y, ball",
        ),
        (["--map", "launch.speed=x [parsec]"], "parsec is not a known unit"),
        (["--map", "launch.speed=x [kg]", "--map", "apex=y [m]"], "x for launch.speed: kg is a unit of mass"),
        (["--map", "apex=x [m]"], "nothing of the launch among the columns that are used"),
        (["--map", "x=launch.speed m/s"], 'the key comes first: --map "launch.speed=x [m/s]"'),
        (["--map", "apex"], '--map apex: write it as "KEY=EXPRESSION [UNIT]", for example'),
        (["--map", "apex=2*(x+y"], "at '(x+y' (character 3): does not parse"),
        (["--map", "apex=x.__class__"], "has no column '__class__'"),
        (["--map", "apex=open(x)"], "open is no function; there are sin, cos,"),
    ],
)
def test_options_that_do_not_fit_are_one_line(tmp_path, capsys, options, wrong):
    file = tmp_path / "track.csv"
    file.write_text("t,x,y,ball\n0,1,2,ball\n0.1,2,3,ball\n0.2,3,4,ball\n")
    assert call(["fit", "throws", str(file), "--vary", "launch.angle=5:60", *options]) == 2
    said = capsys.readouterr().err
    assert wrong in said
    assert said.count("\n") == 1


def test_a_track_before_the_launch_is_a_hint_at_its_time():
    track = {"t": [-0.1, 0.1, 0.2], "x": [0, 1, 2], "y": [2, 3, 4]}
    with pytest.raises(RequestError, match=r"row 1, t = -0\.1 s is before the launch, which is at 0 s; free time"):
        sandbox.fit("throws", track, {"launch.speed": (5, 20)})


# What is found -------------------------------------------------------------------------------------------------------


def flown(noise: float, **changes: float) -> tuple[np.ndarray, np.ndarray]:
    """Times and places of a ball that falls and bounces, with noise in m."""
    run = sandbox.simulate(sandbox.load("collisions/bouncing-ball", changes))
    t = np.arange(0.0, 1.9, 1.0 / 30.0)
    return t, run.states("first", t)[:, :2] + np.random.default_rng(4).normal(0.0, noise, (len(t), 2))


def test_clock_axes_and_tilt_of_a_film_are_found_with_the_ball():
    t, places = flown(0.003, **{"launch.speed": 1.5, "floor.restitution": 0.8})
    tilt = np.radians(3.0)
    turned = (places - (0.4, -0.1)) @ np.array([[np.cos(tilt), -np.sin(tilt)], [np.sin(tilt), np.cos(tilt)]])
    track = {"t [ms]": 1e3 * (t + 7.25), "x": turned[:, 0], "y": turned[:, 1]}
    vary = {"floor.restitution": (0.5, 1.0), "launch.speed": (0.5, 3.0)}
    found = sandbox.fit("collisions/bouncing-ball", track, vary, free=["origin", "time", "tilt"]).values
    true = {"floor.restitution": 0.8, "track.time": 7.25, "track.origin.x": 0.4, "track.origin.y": -0.1,
            "track.tilt": 3.0}  # fmt: skip
    for key, value in true.items():
        half = 0.5 * (found[key].high - found[key].low)
        assert abs(found[key].value - value) < 1.6 * half
        assert half < 0.5


def test_a_late_launch_is_compared_at_all_points():
    """The search sees what is computed for the result alone: no point is later than a run lasts."""
    t, places = flown(0.002)
    track = {"t": t + 0.9, "x": places[:, 0], "y": places[:, 1]}
    found = sandbox.fit("collisions/bouncing-ball", track, {"floor.restitution": (0.5, 1.0)}, free=["time"])
    again = found.measured.residuals(found.scene, [], np.array([found.free]), np.inf)
    assert found.residuals == pytest.approx(again[0], abs=1e-5)


def test_distances_from_a_path_have_signs():
    """Points beside a path that bounces, 1 cm to its left and right, by the normal of the velocity."""
    run = sandbox.simulate(sandbox.load("collisions/bouncing-ball", {"launch.speed": 1.5}))
    states = run.states("first", np.array([0.05, 0.3, 0.5, 0.8, 1.1]))
    normal = np.column_stack([-states[:, 3], states[:, 2]]) / np.hypot(states[:, 2], states[:, 3])[:, None]
    for distance in (0.01, -0.01):
        assert distances(run, "first", states[:, :2] + distance * normal) == pytest.approx(distance, abs=1e-6)


def test_places_without_times_are_enough_for_a_throw():
    run = sandbox.simulate(sandbox.load("throws", {"launch.speed": 13.0, "launch.angle": 41.0}))
    x, y = run.states("ball", np.linspace(0.05, run.duration - 0.05, 25))[:, :2].T
    noise = np.random.default_rng(1).normal(0.0, 0.02, (2, 25))
    found = sandbox.fit(
        "throws", {"x": x + noise[0], "y": y + noise[1]}, {"launch.speed": (8, 20), "launch.angle": (20, 60)}
    )
    assert found.values["launch.speed"].value == pytest.approx(13.0, abs=0.03)
    assert found.values["launch.angle"].value == pytest.approx(41.0, abs=0.3)
    assert found.residual_sd["distance"] == pytest.approx(0.02, rel=0.4)
    assert any("nearest place of the path" in remark for remark in found.remarks)
    assert found.end == pytest.approx(run.duration, rel=0.05)  # up to where its path is drawn


SHOTS = {"launch.speed": [60.0, 65.0, 70.0, 72.0], "launch.angle": [12.0, 14.0, 11.0, 13.0],
         "launch.spin": [3000.0, 2800.0, 2600.0, 2500.0]}  # fmt: skip


@pytest.fixture(scope="module")
def carries() -> tuple[list[float], list[float]]:
    """Carry and apex in m of those shots in thin air."""
    found = sandbox.simulate_many(sandbox.load("golf", {"air.density": 1.1}), SHOTS, facts=("carry", "apex"))
    return found["carry"].tolist(), found["apex"].tolist()


def devices(carries: tuple[list[float], list[float]]) -> dict[str, str]:
    """Those shots as each device writes them."""
    rows = list(zip(*SHOTS.values(), *carries, strict=True))
    trackman = "sep=,\nClub,Ball Speed,Launch Angle,Spin Rate,Spin Axis,Carry Flat - Length,Max Height - Height\n"
    trackman += ",[mph],[deg],[rpm],[deg],[yds],[ft]\n"
    trackman += "".join(f"D,{v / 0.44704},{a},{s},0,{c / 0.9144},{h / 0.3048}\n"
                        for v, a, s, c, h in rows)  # fmt: skip
    garmin = "Club Type,Ball Speed,Launch Angle,Backspin,Spin Rate,Apex Height,Carry Distance\n"
    garmin += ",[km/h],[deg],[rpm],[rpm],[m],[Meters]\n"
    garmin += "".join(f"D,{v * 3.6},{a},{s},9999,{h},{c}\n" for v, a, s, c, h in rows)
    scope = "club,Shot,Ball (km/h),Carry (m),Spin (rpm),Height (m),Spin Axis (°),Launch V (°)\n"
    scope += "".join(f'D,1,"{v * 3.6}",{c},{s},{h},0 L,{a}\n'.replace(".", "X") for v, a, s, c, h in rows)
    scope = scope.replace("X", ".") + "D,Avg,240,200,2700,30,-,12\nD,2,240,200,-,30,1 R,12\n"
    messages = [
        {"Units": "Meters", "BallData": {"Speed": v / 0.44704, "VLA": a, "BackSpin": s, "CarryDistance": c}}
        for v, a, s, c, h in rows
    ]
    heartbeat = [{"Units": "Meters", "ShotDataOptions": {"IsHeartBeat": True}}]
    gspro = "".join(json.dumps(one) + "\n" for one in heartbeat + messages)
    return {"trackman": trackman, "garmin": garmin, "flightscope": scope, "gspro": gspro}


@pytest.mark.parametrize("device", ["trackman", "garmin", "flightscope", "gspro"])
def test_the_columns_of_a_device_are_known(tmp_path, carries, device):
    file = tmp_path / "shots.csv"
    file.write_text(devices(carries)[device], "utf-8")
    found = read_data(sandbox.load("golf"), [file], Reading())
    given = {key: values.tolist() for key, values in found.given.items()}
    assert given.pop("launch.axis", [0.0] * 4) == [0.0] * 4
    assert given == {key: pytest.approx(values) for key, values in SHOTS.items()}
    assert found.measured["carry"] == pytest.approx(carries[0])
    assert device == "gspro" or found.measured["apex"] == pytest.approx(carries[1])
    assert forms()[device].title in " ".join(found.notes)
    left = found.residuals(sandbox.load("golf"), ["air.density"], np.array([[1.1]]), 0.0)
    assert left == pytest.approx(0.0, abs=1e-6)


def test_a_device_has_units_where_the_file_has_none(tmp_path, carries):
    file, text = tmp_path / "shots.csv", devices(carries)["trackman"]
    file.write_text(text.replace(",[mph],[deg],[rpm],[deg],[yds],[ft]\n", ""), "utf-8")
    found = read_data(sandbox.load("golf"), [file], Reading())
    assert found.given["launch.speed"] == pytest.approx(SHOTS["launch.speed"])
    assert found.measured["carry"] == pytest.approx(carries[0])
    assert found.measured["apex"] == pytest.approx(carries[1])


def test_statcast_and_columns_by_hand(tmp_path):
    speeds, angles = [42.0, 45.0, 47.0], [24.0, 28.0, 31.0]
    points = {"launch.speed": speeds, "launch.angle": angles}
    spun = sandbox.load("baseball", {"launch.spin": 2100.0, "launch.sidespin": 2190.0})
    far = sandbox.simulate_many(spun, points, facts=("distance",))
    rows = list(zip(speeds, angles, far["distance"].tolist(), strict=True))
    lines = [f"F,{v / 0.44704},{a},{d / 0.3048},2300\n" for v, a, d in rows]
    head = "type,launch_speed,launch_angle,hit_distance_sc,release_spin_rate\n"
    (tmp_path / "statcast.csv").write_text(head + "".join(lines) + "F,,,,2200\n")
    baseball = sandbox.load("baseball")
    known = read_data(baseball, [tmp_path / "statcast.csv"], Reading())
    assert known.measured["distance"] == pytest.approx(far["distance"])
    assert known.left_out == (LeftOut(4, "launch_speed is missing"),)
    columns = {"launch.speed": "Exit [mph]", "launch.angle": "Up", "distance": "Far [ft]"}
    noise = [0.4, -0.3, 0.1]
    table = {
        "Exit": [v / 0.44704 for v in speeds],
        "Up": angles,
        "Far": [d / 0.3048 + e for (*_, d), e in zip(rows, noise, strict=True)],
    }
    by_hand = sandbox.fit("baseball", table, {"launch.spin": (1500, 2500)}, columns=columns)
    spin = by_hand.values["launch.spin"]
    assert spin.low < 2100.0 < spin.high < 2350.0
    assert "Up has no unit: taken as deg" in by_hand.remarks
    with pytest.raises(RequestError, match="units are mixed: Exit is in km/h, but --map says mph"):
        sandbox.fit("baseball", {"Exit (km/h)": [1], "Far": [3], "Up": [2]}, {"launch.spin": (1, 2)}, columns=columns)


def test_results_that_a_run_meets_exactly_are_no_error():
    speeds = {"launch.speed": [10.0, 12.0, 14.0]}
    apexes = sandbox.simulate_many("throws", speeds, facts=("apex",))["apex"]
    columns = {"launch.speed": "launch.speed [m/s]", "apex": "apex [m]"}
    found = sandbox.fit("throws", {**speeds, "apex": apexes}, {"gravity": (8, 12)}, columns=columns)
    assert found.values["gravity"].value == pytest.approx(9.81, abs=1e-9)
    assert as_text(found.report())


def test_known_columns_are_listed_without_a_scene():
    shown = CliRunner().invoke(app, ["fit", "--formats"])
    assert shown.exit_code == 0
    for form in forms().values():
        assert form.title in shown.output
        assert all(f'--map "{entry}"' in shown.output for group in form.columns for entry in group)


def test_a_table_that_is_not_known_says_so(tmp_path):
    (tmp_path / "x.csv").write_text("speed,far\n1,2\n")
    assert recognized(read_table("track", tmp_path / "x.csv"), sandbox.load("golf")) is None
    with pytest.raises(
        RequestError, match=re.escape('speed seem known; complete and give --map "launch.speed=speed [UNIT]"')
    ):
        sandbox.fit("golf", tmp_path / "x.csv", {"air.density": (1, 2)})


def test_a_table_for_another_scene_or_of_what_is_fitted_says_so(tmp_path, carries):
    file = tmp_path / "shots.csv"
    file.write_text(devices(carries)["trackman"], "utf-8")
    with pytest.raises(RequestError, match=r"looks like TrackMan .*, whose columns are known for golf; for basketball"):
        sandbox.fit("basketball", file, {"air.density": (1, 2)})
    with pytest.raises(RequestError, match=r"--vary launch\.spin: is a column of the table"):
        sandbox.fit("golf", file, {"launch.spin": (1000, 4000)})


# A table of one's own in place of the published ones ------------------------------------------------------------------


def test_a_table_of_ones_own_is_validated(tmp_path, capsys):
    file = tmp_path / "own.csv"
    file.write_text(
        "scene,set,result,value,tolerance,unit\nthrows,launch.speed=13,apex,17.5,1,ft\nthrows,,apex,1,1,m\n"
    )
    assert call(["validate", "--against", str(file), "--json"]) == 0
    first, second = json.loads(capsys.readouterr().out)
    assert (first["holds"], second["holds"], first["kind"], first["unit"]) == (True, False, "measured", "ft")
    assert first["computed"] == pytest.approx(17.5, abs=1.0)


def test_a_tolerance_of_ones_own_may_be_a_share_or_have_a_unit(tmp_path, capsys):
    file = tmp_path / "own.csv"
    file.write_text("result;value;tolerance;unit\napex;17,5;2,5%;ft\napex;17,5;1 m;ft\napex;17,5;0,5;ft\n")
    assert call(["validate", "throws", "--against", str(file), "--json"]) == 0
    allowed = [row["tolerance"] for row in json.loads(capsys.readouterr().out)]
    assert allowed == pytest.approx([0.4375, 1.0 / 0.3048, 0.5])


def test_launches_are_validated_by_their_columns(tmp_path, capsys, carries):
    file = tmp_path / "shots.csv"
    file.write_text(devices(carries)["garmin"], "utf-8")
    command = ["validate", "golf", "--against", str(file), "--set", "air.density=1.1", "--json"]
    assert call([*command, "--within", "carry=1%", "--within", "apex=2 ft"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["holds"] for row in rows] == [True] * 8
    first, second = rows[:2]
    assert first["tolerance"] == pytest.approx(0.01 * float(first["value"]))
    assert (second["tolerance"], second["unit"]) == (pytest.approx(0.6096), "m")
    assert call([*command, "--within", "carry=1%"]) == 2
    assert "say how far off apex may be" in capsys.readouterr().err
    assert call([*command, "--within", "carri=1%"]) == 2
    assert "--within carri: is no result of the table, which has carry, apex" in capsys.readouterr().err


def test_a_long_table_takes_fewer_starts(monkeypatch):
    angles, computed, tried = np.linspace(30.0, 50.0, 100), Launches.residuals, []
    shots = [sandbox.simulate(sandbox.load("throws", {"launch.angle": angle})) for angle in angles[::25]]
    distances = [shot.result["distance"] for shot in shots for _ in range(25)]

    def counted(self, scene, keys, values, until):
        tried.append(len(values))
        return computed(self, scene, keys, values, until)

    monkeypatch.setattr(Launches, "residuals", counted)
    table = {"a (deg)": np.repeat(angles[::25], 25), "d (m)": distances}
    columns = {"launch.angle": "a (deg)", "distance": "d (m)"}
    found = sandbox.fit("throws", table, {"launch.speed": (10, 20)}, columns=columns)
    assert found.values["launch.speed"].value == pytest.approx(14.0)
    assert tried[0] == 1 + 1000 // 100


@pytest.mark.parametrize(
    ("text", "wrong"),
    [
        ("result,value,tolerance\ncary,1,1\n", "row 1, result = cary: no such result; did you mean carry?"),
        ("result,value,tolerance,unit\ncarry,1,1,kg\n", "row 1, unit = 'kg' is no unit of carry"),
        ("result,value,tolerance,unit\ncarry,x,1,m\n", "row 1, value = 'x' is not a number"),
        ("result,value,tolerance,unit,kind\ncarry,1,1,m,guess\n", "row 1, kind = 'guess' is none of exact"),
        ("result,value,tolerance,units\ncarry,1,1,m\n", "column 'units' is none of"),
        ("a,b\n1,2\n", 'its columns are not known; for golf name them, such as --map "carry=COLUMN"; it has a, b'),
        ("value,tolerance\n1,2\n", "has no column result"),
        ("result,set,value,tolerance\ncarry,launch.sped=3,1,1\n", "row 1, set launch.sped: unknown key"),
        ("result,value,tolerance,unit\ncarry,1,-1,m\n", "row 1, tolerance = -1: must be 0 or more"),
        ("result,value,tolerance,unit\ncarry,1,-2%,m\n", "row 1, tolerance = -2%: must be 0 or more"),
        ("result,value,tolerance,unit\ncarry,1,1 kg,m\n", "row 1, tolerance = 1 kg: kg is a unit of mass; use m"),
    ],
)
def test_a_table_that_cannot_be_validated_is_one_line(tmp_path, capsys, text, wrong):
    file = tmp_path / "own.csv"
    file.write_text(text)
    assert call(["validate", "golf", "--against", str(file)]) == 2
    said = capsys.readouterr()
    assert wrong in said.err
    assert (said.err.count("\n"), said.out) == (1, "")
