"""The program from outside: what it prints, what it writes, what it refuses, and with which exit code."""

from __future__ import annotations

import csv
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
import weakref
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pymunk
import pytest
from PIL import Image

import sandbox
from sandbox.cli import card
from sandbox.cli.interrupts import Interrupts
from sandbox.engine.model.accuracy import LEVELS
from sandbox.files import folder_of_parts
from sandbox.parameters import every_key
from tests.own_scene import BUILD, COMMAND, DROP, HANG, Outcome, assert_refused, change


def read_rows(file: Path) -> list[dict[str, str]]:
    with file.open(newline="") as lines:
        return list(csv.DictReader(lines))


# What it shows ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", [[], ["list"], ["run"], ["schema"]])
def test_help(call, command: list[str]):
    code, out, err = call(*command, "--help")
    assert (code, err) == (0, "")
    assert out.startswith("Usage: sandbox")
    assert max(len(line) for line in out.splitlines()) <= 110
    assert command or call() == (0, out, "")
    assert not re.search(r"[\w,]\.\.\.\n", out)  # a command's line that is cut off


def test_list_shows_the_scene_files_of_the_folder(call, tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "shot.toml").write_text('# A flop over the bunker.\nscene = "golf"\n')
    (tmp_path / "pyproject.toml").write_text('[project]\nname = "golf"\n')
    (tmp_path / "broken.toml").write_text("scene = [")
    lines = call("list").out.splitlines()
    assert any(re.fullmatch(r"shot\.toml +A flop over the bunker\.", line) for line in lines)
    assert not any("pyproject" in line or "broken" in line for line in lines)
    assert call("run", "shot.toml").code == 0


def test_list_reads_whatever_stands_in_the_folder(call, tmp_path: Path, monkeypatch):
    """No scene: nested too deep for Python, a pipe, a device, a folder, not a text, too large; and none is run."""
    monkeypatch.chdir(tmp_path)
    sources = {
        "brackets": "(" * 100_000,
        "minus": "x = " + "-" * 100_000 + "1",
        "binary": "\0" * 100,
        "unclosed": '"""',
        "code": "raise SystemExit(3)",
        "number": "3",
    }
    for name, source in sources.items():
        (tmp_path / name).mkdir()
        (tmp_path / name / "scene.py").write_text(source)
        (tmp_path / f"{name}.toml").write_text("x = " + "[" * 10_000)
    (tmp_path / "pipe").mkdir()
    os.mkfifo(tmp_path / "pipe" / "scene.py")
    os.mkfifo(tmp_path / "pipe.toml")
    (tmp_path / "folder" / "scene.py").mkdir(parents=True)
    (tmp_path / "folder.toml").mkdir()
    code, out, err = call("list")
    assert (code, err) == (0, "")
    assert {line for line in out.splitlines() if line.startswith("./")} >= {f"./{name}" for name in sources}


def test_list_has_tasks_and_games_under_a_scene(call):
    lines = call("list", "billiards").out.splitlines()
    rows = "\n".join(lines[next(i for i, line in enumerate(lines) if line.startswith("  tasks ")) :]).split()
    names = ["straight-pot,", "cut-shot,", "round-the-blocker,", "three-cushions,", "eight-ball"]
    assert rows == ["tasks", *names, "games", "eight-ball,", "nine-ball,", "three-cushion"]
    assert not any(line.startswith("  tasks") for line in call("list", "collisions/overlapping").out.splitlines()[:3])


def test_list_of_one_scene(call, tmp_path: Path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copytree(DROP, tmp_path / "drop")
    everything, golf, drop = (
        [line.split()[0] for line in call("list", *names).out.splitlines() if not line.startswith(" ")]
        for names in ((), ("golf",), ("./drop",))
    )
    assert golf == [name for name in everything if name == "golf" or name.startswith("golf/")]
    assert drop == [name for name in everything if name == "./drop" or name.startswith("./drop/")]
    assert len(drop) > 1
    assert_refused(call("list", "golff"), "did you mean golf?")


@pytest.mark.parametrize(
    "command",
    ["list", "run golf", "run golf --compare golf/headwind", "run billiards --check --compare billiards/draw"],
)
def test_what_is_printed_fits_80_columns_and_is_plain(call, command: str):
    code, out, _ = call(*command.split())
    assert code == 0
    assert max(len(line) for line in out.splitlines()) <= 80
    assert "\x1b" not in out


def test_events_of_several_balls_align(call):
    lines = [line for line in call("run", "billiards").out.splitlines() if " impact " in line]
    assert len({line.index("impact") for line in lines}) == len({line.index(" at ") for line in lines}) == 1


def test_schema_is_json(call):
    code, out, err = call("schema", "golf")
    assert (code, err) == (0, "")
    assert {"const": "golf"} in json.loads(out)["properties"]["scene"]["anyOf"]
    assert call("schema", DROP / "moon").out == call("schema", DROP).out


def test_what_only_the_scene_can_refuse_names_the_file(call, tmp_path: Path):
    file = tmp_path / "table.toml"
    spots = "".join(f'[[balls]]\nname = "{name}"\nx = {x}\ny = 0\n' for name, x in (("cue", 0), ("1", 0.01)))
    file.write_text(f'scene = "billiards"\n{spots}')
    assert_refused(call("run", file), f'{file}: balls "cue" at (0, 0) m and "1" at (0.01, 0) m overlap')


def test_a_count_has_no_error_where_it_stays_the_same(call):
    card = call("run", "billiards/cut", "--check").out
    cushions = next(line for line in card.splitlines() if line.startswith("  cushions "))
    assert re.fullmatch(r"  cushions +\d+", cushions)
    chaotic = call("run", "billiards/eight-ball-break", "--check").out
    assert re.search(r"\n  cushions, all balls +\d+ ± \d+\n", chaotic)
    assert "±" in card


def test_an_impact_has_the_speed_of_the_whole_motion(call):
    """And not its part across the ground, which grows while a topped ball slows down and bounces higher."""
    out = call("run", "golf/topped").out
    landing = re.search(r"landing speed +([\d.]+) m/s", out)
    assert landing is not None
    speeds = [float(speed) for speed in re.findall(r"impact +fairway +at ([\d.]+) m/s", out)]
    assert speeds[0] == float(landing[1])
    assert speeds == sorted(speeds, reverse=True)
    assert len(speeds) > 3


def test_the_card_of_a_long_run_says_what_took_long():
    """A run of 20,000 impacts; that of a few says nothing."""
    scene = sandbox.load("pinball", {"launch.speed": 2.0})
    run = sandbox.simulate(scene)
    assert "what took long" not in "".join(card.card(scene, run))
    run.numerics.impacts = 20_000
    said = next(line for line in card.card(scene, run) if "what took long" in line)
    assert said.startswith("  what took long: 20,000 impacts in ")


def test_the_card_names_the_preset_and_check_adds_errors(call):
    assert call("run", DROP / "moon").out.startswith("drop/moon: The same drop on the moon.")
    out = call("run", DROP, "--check").out
    assert "1.21 m ± less than 0.001 mm" in out
    assert "only the numbers change" in " ".join(out.split())
    report = json.loads(call("run", DROP, "--check", "--json").out)
    assert set(report["errors"]) == {"bounces", "first_touch", "final_height"}
    assert report["changed"] == {}


def test_check_tells_when_the_verdict_hangs_on_the_accuracy(call, drop: Path):
    change(
        drop / "scene.py",
        "FACTS = (",
        "FACTS = (Fact('in', '', '', lambda run, parameters: run.accuracy.tolerance < 5e-4),",
    )
    assert "depends on the accuracy: in is false here and true in a finer run" in call("run", drop, "--check").out


# JSON and CSV -------------------------------------------------------------------------------------------------------


def test_json_is_one_object_with_everything(call):
    code, out, err = call("run", "golf", "--set", "launch.speed=171 mph", "--accuracy", "fast", "--json")
    assert (code, err) == (0, "")
    report = json.loads(out)
    assert (report["scene"], report["preset"]) == ("golf", None)
    assert report["parameters"]["launch"]["speed"] == pytest.approx(76.44384)
    assert report["parameters"]["air"]["wind"] == [0.0, 0.0]
    assert report["accuracy"]["level"] == report["parameters"]["accuracy"]["level"] == "fast"
    results = "carry total apex flight_time landing_angle landing_speed landing_spin distance_to_pin holed ended"
    assert set(results.split()) <= set(report["result"])
    assert {"t", "kind", "ball", "with", "speed"} <= set(report["events"][0])
    assert {"force_evaluations", "steps", "impacts", "wall_s"} <= set(report["numerics"])
    scene = sandbox.load("golf", {"launch.speed": "171 mph", "accuracy.level": "fast"})
    assert report["result"] == sandbox.simulate(scene).result


def test_what_is_no_number_is_null_in_json(call, drop: Path):
    for key, value in (("a", "float('nan')"), ("b", "[float('inf')]"), ("c", "{'d': float('nan')}")):
        change(drop / "scene.py", "FACTS = (", f"FACTS = (Fact('{key}', '', '', lambda run, parameters: {value}),")
    report = json.loads(call("run", drop, "--json").out, parse_constant=pytest.fail)
    result = report["result"]
    assert (result["a"], result["b"], result["c"]) == (None, [None], {"d": None})
    assert report["warnings"] == [f"{key} is not a finite number, and null in JSON" for key in "cba"]
    assert "  warning: a is not a finite number, and null in JSON" in call("run", drop).out.splitlines()


@pytest.mark.parametrize(
    "command", [("run", "--json"), ("schema",), ("spread", "--json", "--by", "launch.height=0.1", "--samples", "16")]
)
def test_what_a_scene_prints_is_no_part_of_the_json(call, drop: Path, command: tuple[str, ...]):
    change(drop / "scene.py", "from __future__ import annotations\n", "from __future__ import annotations\nprint(1)\n")
    change(drop / "scene.py", BUILD, BUILD + "    print(2)\n")
    code, out, err = call(command[0], drop, *command[1:])
    assert (code, type(json.loads(out))) == (0, dict)
    assert set("12" if "--json" in command else "1") <= set(err.split())


def test_a_verdict_with_half_a_character_is_written_and_drawn(call, drop: Path, tmp_path: Path):
    change(drop / "scene.py", 'return "Bounced"', 'return "\\ud83d\\0 bounced"')
    files = [tmp_path / name for name in ("a.png", "a.html", "a.csv")]
    options = [word for each in zip(("--poster", "--html", "--trajectory"), files, strict=True) for word in each]
    code, out, err = call("run", drop, "--json", *options)
    assert (code, err, all(file.is_file() for file in files)) == (0, "", True)
    assert json.loads(out)["verdict"] == "\ud83d\0 bounced"


def test_trajectory(call, tmp_path: Path):
    file = tmp_path / "path.csv"
    code, out, _ = call("run", DROP, "--trajectory", file)
    assert (code, out.splitlines()[-1]) == (0, f"wrote {file}")
    rows = read_rows(file)
    assert list(rows[0]) == ["t", "ball", "x", "y", "vx", "vy", "spin"]
    assert {row["ball"] for row in rows} == {"ball"}
    run = sandbox.simulate(sandbox.load(DROP))
    numbers = [[float(row[key]) for key in ("t", "x", "y", "vx", "vy", "spin")] for row in rows]
    assert numbers == run.trajectory("ball").tolist()
    assert [path.name for path in tmp_path.iterdir()] == ["path.csv"]


# Pictures -----------------------------------------------------------------------------------------------------------


def test_pictures(call, tmp_path: Path):
    names = ("drop.png", "strip.png", "energy.png", "drop.gif", "frames")
    poster, strip, energy, gif, frames = files = [tmp_path / name for name in names]
    options = ("--poster", "--strip", "--energy", "--gif", "--frames")
    args = [word for pair in zip(options, files, strict=True) for word in pair]
    code, out, err = call("run", DROP, *args, "--fps", 10, "--size", "640x360")
    assert (code, err) == (0, "")
    assert set(out.splitlines()[-5:]) == {f"wrote {file}" for file in files}
    seen = {}
    for file in (poster, strip, energy, gif):
        with Image.open(file) as image:
            seen[file] = (image.format, image.size, getattr(image, "n_frames", 1) > 1)
    assert seen[poster] == seen[energy] == ("PNG", (640, 360), False)
    assert (seen[gif][0], seen[gif][2]) == ("GIF", True)
    width, height = seen[strip][1]  # of frames of 320x180, in rows
    assert (width // 320) * (height // 180) > 5
    assert sorted(path.name for path in frames.iterdir()) == [f"frame_{number:05d}.png" for number in range(11)]


def test_two_runs_over_each_other(call, tmp_path: Path):
    poster, strip = tmp_path / "both.png", tmp_path / "strip.png"
    pictures = ("--poster", poster, "--strip", strip, "--size", "320x180")  # the smallest
    code, out, err = call("run", "golf", "--compare", "golf/headwind", *pictures)
    assert (code, err) == (0, "")
    row = next(line for line in out.splitlines() if line.startswith("  carry"))
    assert row.count("yd") == 2
    assert "golf/headwind" in out
    with Image.open(poster) as image, Image.open(strip) as film:
        assert (image.size, film.height >= 180) == ((320, 180), True)
    report = json.loads(call("run", "golf", "--compare", "golf/headwind", "--json").out)
    assert report["compared"]["preset"] == "headwind"
    assert report["compared"]["result"]["carry"] < report["result"]["carry"]


def test_three_runs_next_to_each_other(call, tmp_path: Path):
    """Two of them of the same short name, which pictures then show in full."""
    iron = tmp_path / "headwind.toml"
    iron.write_text('scene = "golf/7-iron"\n', encoding="utf-8")
    wanted = ("run", "golf", "--compare", "golf/headwind", "--compare", iron)
    names = ("poster.png", "graph.png", "energy.png", "page.html")
    kinds = ("--poster", "--graph", "--energy", "--html")
    files = [word for kind, name in zip(kinds, names, strict=True) for word in (kind, tmp_path / name)]
    code, out, err = call(*wanted, *files, "--size", "640x360")
    assert (code, err) == (0, "")
    rows = out.splitlines()
    assert next(row for row in rows if row.startswith("  landing  ")).count("°") == 3
    assert all((tmp_path / name).stat().st_size > 10_000 for name in names)
    with Image.open(tmp_path / "energy.png") as charts:
        assert charts.height == 3 * 180  # the smallest, for each run
    page = (tmp_path / "page.html").read_text("utf-8")
    assert f"--compare golf/headwind --compare {iron}" in page
    compared = json.loads(call(*wanted, "--json").out)["compared"]
    assert [other["result"]["carry"] for other in compared] == sorted(
        (other["result"]["carry"] for other in compared), reverse=True
    )
    assert [other["scene"] for other in compared] == ["golf", "golf"]


def test_pictures_leave_json_alone(tmp_path: Path):
    """pygame greets on stdout when it is imported."""
    process = subprocess.run(
        [*COMMAND, "run", str(DROP), "--json", "--poster", str(tmp_path / "drop.png")], capture_output=True, text=True
    )
    assert (process.returncode, process.stderr) == (0, "")
    assert json.loads(process.stdout)["scene"] == "drop"
    with Image.open(tmp_path / "drop.png") as image:
        assert image.size == (32, 18)  # the picture's own


# Settings -----------------------------------------------------------------------------------------------------------


def test_settings_and_accuracy_stand_over_the_file(call, tmp_path: Path):
    (tmp_path / "shot.toml").write_text('scene = "golf"\nlaunch.speed = 50\naccuracy.level = "precise"')
    args = ["--set", "launch.angle=0.3 rad", "--set", "ball.drag.model=none", "--set", "launch.angle=20", "--json"]
    report = json.loads(call("run", tmp_path / "shot.toml", *args).out)
    assert report["parameters"]["start"] == "launch"  # by speed and angle
    assert {key: report["parameters"]["launch"][key] for key in ("speed", "angle")} == {"speed": 50, "angle": 20}
    assert report["parameters"]["ball"]["drag"] == {"model": "none"}
    assert report["accuracy"]["level"] == "precise"
    for level in LEVELS:
        assert json.loads(call("run", DROP, "--accuracy", level, "--json").out)["accuracy"]["level"] == level


def test_one_of_a_list_may_be_set(call, monkeypatch):
    wind = ["--set", "air.wind=[1,2]", "--set", "air.wind[0]=11 mph"]
    spot = ["--set", "balls[0].x=0.1"]
    assert json.loads(call("run", "golf", *wind, "--json").out)["parameters"]["air"]["wind"] == [4.91744, 2.0]
    before, after = (json.loads(call("run", "billiards/bank", *args, "--json").out) for args in ((), spot))
    assert after["parameters"]["balls"] == [
        before["parameters"]["balls"][0] | {"x": 0.1},
        *before["parameters"]["balls"][1:],
    ]
    played = []
    monkeypatch.setattr("sandbox.window.app.play", lambda *args: played.append(args[:2]))
    assert call("play", "golf", *wind, "--set", "gravity=5").code == 0
    assert played == [("golf", {"air.wind": (4.91744, 2.0), "gravity": 5})]


@pytest.mark.parametrize(
    ("args", "expected"),
    [
        (["schema", "golff"], "unknown scene golff; did you mean golf?"),
        (["run", "golf", "--set", "launch.sped=3"], "--set launch.sped: unknown key; did you mean launch.speed?"),
        (["run", "golf", "--set", "launch.speed=341"], "--set launch.speed = 341: must be from 0 to 340 m/s"),
        (["run", "golf", "--set", "launch.speed=70 kg"], "kg is a unit of mass; use m/s, km/h, mph, kn or ft/s"),
        (["run", "golf", "--set", "launch.speed=nan"], "--set launch.speed = nan: must be a finite number"),
        (["run", "golf", "--set", "launch.speed"], "--set launch.speed: write it as key.path=value"),
        (["run", "golf", "--set", "air.wind=[3,300]"], "air.wind = [3, 300]: 300: must be from -100 to 100 m/s"),
        (["run", "golf", "--set", "air.wind[2]=3"], "--set air.wind[2]: there is no [2]; the list has 2"),
        (["run", "golf", "--set", "air.wind[0]=300"], "--set air.wind = [300, 0.0]: 300: must be from -100 to 100 m/s"),
        (["run", "golf", "--set", "air.wind[0]=3 kg"], 'air.wind = ["3 kg", 0.0]: "3 kg": kg is a unit of mass; use'),
        (["run", "golf", "--set", "air.wnd[0]=3"], "--set air.wnd: unknown key; did you mean air.wind?"),
        (["run", "golf", "--set", "launch.speed[0]=3"], "--set launch.speed[0]: is not a list"),
        (["run", "golf", "--set", "air.wind[x]=3"], "--set air.wind[x]: a key is written like launch.speed, or air.wi"),
        (["run", "golf", "--accuracy", "best"], "'best' is not one of 'fast', 'balanced', 'precise'."),
        (["run", "golf", "--fps", "30"], "--fps 30: requires --frames, --gif or --video"),
        (["run", "golf", "--frames", "frames", "--fps", "0"], "'--fps': 0 is not in the range 1<=x<=240."),
        (["run", "golf", "--frames", "frames", "--fps", "12.5"], "'--fps': '12.5' is not a valid integer"),
        (["sweep", "golf", "--over", "launch.angle=1,2", "--out", "x.csv", "--jobs=0"], "--jobs 0: must be from"),
        (["sweep", "golf", "--over", "launch.angle=1,2", "--out", "x.csv", "--jobs=9999"], "must be from 1 to 1000"),
        (["run", "golf", "--size", "720p"], "--size 720p: must be width and height in px, such as 1280x720"),
        (["run", "golf", "--size", "640x360"], "--size 640x360: requires a picture, such as --poster F.png"),
        (["run", "golf", "--size", "100000x100000"], "--size 100000x100000: must be between 320x180 and 7680x4320 px"),
        (["run", "golf", "--size", "16x9"], "--size 16x9: must be between 320x180 and 7680x4320 px"),
        (["run", "golf", "--compare", "soccer"], "--compare soccer: is soccer, and only golf can"),
        (["run", "golf", "--set", "launch.speed=150 MPH"], "MPH is not a known unit; did you mean mph?"),
        (
            ["run", "golf", "--set", "launch.speed=150", "mph"],
            'a value with a space goes in quotes: launch.speed="150 m',
        ),
        (["run", "golf", "--xyzzy"], "No such option '--xyzzy'.\nsandbox run --help shows its arguments"),
        (["run", "golf", "--fps"], "Option '--fps' requires an argument.\nsandbox run --help shows its arguments"),
        (["run"], "Missing argument 'SCENE'"),
        (["bogus"], "No such command 'bogus'.\nsandbox --help shows its arguments"),
    ],
)
def test_a_wrong_request_is_refused_in_a_line(call, tmp_path: Path, monkeypatch, args: list[str], expected: str):
    monkeypatch.chdir(tmp_path)
    assert_refused(call(*args), expected)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"scene = 'golf'\n[launch]\nspeed = 400\n", "shot.toml: launch.speed = 400: must be from 0 to 340 m/s"),
        (b"scene = 'golf'\n[launch\nspeed = 70\n", "shot.toml: broken TOML: "),
        (b"scene = 'golf'\n[launch]\nspeed = 120 mph\n", 'a value with a unit goes in quotes: "120 mph"'),
        (b"scene = 'golf'\nair.wind = [3 m/s, 0]\n", 'a value with a unit goes in quotes: "3 m/s"'),
        (b"scene = golf\n", 'a word goes in quotes: "golf"'),
        (b"scene = 'golf'\n[launch]\nspeed = 60,5  # m/s\n", "60,5 has a decimal comma; write 60.5"),
    ],
)
def test_a_wrong_file_is_refused_in_a_line(call, tmp_path: Path, content: bytes, expected: str):
    (tmp_path / "shot.toml").write_bytes(content)
    assert_refused(call("run", tmp_path / "shot.toml", "--json"), expected)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_an_unreadable_file_is_refused(call, tmp_path: Path):
    (tmp_path / "shot.toml").touch(mode=0o000)
    assert_refused(call("run", tmp_path / "shot.toml"), "shot.toml: cannot be read: permission denied")


# Outputs ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("args", "expected"),
    [
        (["--trajectory", "missing/path.csv"], "--trajectory: there is no folder missing; make it first"),
        (["--trajectory", ".."], "--trajectory ..: is a folder; name a file in it"),
        (["--poster", ""], '--poster: "" and "." are not files; name one, such as out.png'),
        (["--poster", "shot.png", "--energy", "./shot.png"], "--energy shot.png: is also the file of --poster"),
        (["--poster", "x" * 300 + ".png"], "xxx...: file name too long"),
        (["--trajectory", "x" * 300 + ".csv"], "xxx...: file name too long"),
        (["--frames", "x" * 300], "xxx...: file name too long"),
        (["--trajectory", "path.txt"], "--trajectory path.txt: its name must end in .csv"),
        (["--trajectory", "file/path.csv"], "--trajectory: there is no folder file"),
        (["--trajectory", "/proc/path.csv"], "--trajectory: cannot write into /proc"),
        (["--poster", "missing/shot.png"], "--poster: there is no folder missing"),
        (["--poster", "shot.jpg"], "--poster shot.jpg: its name must end in .png"),
        (["--gif", "shot.png"], "--gif shot.png: its name must end in .gif"),
        (["--energy", "shot.gif"], "--energy shot.gif: its name must end in .png"),
        (["--frames", "file"], "--frames file: is a file; a folder is needed"),
        (["--frames", "file/frames"], "--frames: there is no folder"),
        (["--frames", "/proc/some/frames"], "--frames: cannot write into /proc"),
    ],
)
def test_an_unwritable_output_is_refused_before_the_run(
    call, drop: Path, tmp_path: Path, monkeypatch, args: list[str], expected: str
):
    change(drop / "scene.py", BUILD, f"{BUILD}    1 / 0\n")
    monkeypatch.chdir(tmp_path)
    Path("file").touch()
    assert_refused(call("run", "./drop", *args), expected)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drop", "file"]


def test_a_name_may_be_as_long_as_the_system_allows(call, tmp_path: Path):
    file = tmp_path / ("x" * 251 + ".csv")
    assert call("run", DROP, "--trajectory", file).code == 0
    assert [path.name for path in tmp_path.iterdir()] == [file.name]
    again = call("run", DROP, "--trajectory", file)  # there is no longer name for what it replaces
    assert_refused(again, "its content could not be kept under this name with ~: file name too long")
    assert [path.name for path in tmp_path.iterdir()] == [file.name]


def test_frames_made_by_others_are_kept(call, tmp_path: Path):
    assert call("run", DROP, "--frames", tmp_path, "--fps", 10).code == 0
    (tmp_path / "frame_99999.png").write_bytes(b"mine")
    (tmp_path / "frame_1.png").write_bytes(b"of another kind")
    before = {path.name: path.read_bytes() for path in tmp_path.iterdir()}
    outcome = call("run", DROP, "--frames", tmp_path, "--fps", 5)
    assert_refused(outcome, "frame_99999.png in it was not written by the sandbox; name another folder, or move it")
    assert {path.name: path.read_bytes() for path in tmp_path.iterdir()} == before
    (tmp_path / "frame_99999.png").unlink()
    assert call("run", DROP, "--frames", tmp_path, "--fps", 5).code == 0  # fewer than before
    assert len(list(tmp_path.glob("frame_?????.png"))) == 6


def test_nothing_half_written_stays_behind(call, drop: Path, tmp_path: Path, monkeypatch):
    """The second row of the trajectory fails; the file of an earlier run must survive."""
    file = tmp_path / "path.csv"
    assert call("run", DROP, "--trajectory", file).code == 0
    before = file.read_bytes()

    class Rows:
        def tolist(self) -> list:
            return [[0.0] * 6, None]

    monkeypatch.setattr("sandbox.engine.paths.run.Run.trajectory", lambda run, ball: Rows())
    with pytest.raises(TypeError):
        call("run", DROP, "--trajectory", file)
    assert file.read_bytes() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drop", "path.csv"]


def test_a_link_is_written_through(call, tmp_path: Path):
    (tmp_path / "real.csv").touch()
    (tmp_path / "link.csv").symlink_to("real.csv")
    assert call("run", DROP, "--trajectory", tmp_path / "link.csv").code == 0
    assert (tmp_path / "link.csv").is_symlink()
    assert (tmp_path / "real.csv").stat().st_size > 100


# Text from files ----------------------------------------------------------------------------------------------------


EVIL = "\x1b[2J\x9b31m\u202e"  # clear the screen, red, from right to left


def test_nothing_from_a_file_reaches_the_terminal_as_an_order(call, drop: Path, tmp_path: Path):
    change(drop / "scene.py", '"""A ball', f'"""{EVIL}A ball')
    change(drop / "scene.py", '"bounces", "bounces"', f'"bounces", "boun{EVIL}ces\\nsplit"')
    change(drop / "scene.py", '"ball",', f'"b{EVIL}all\\nsplit",')
    change(drop / "scene.py", 'run.state("ball"', f'run.state("b{EVIL}all\\nsplit"')
    key = EVIL.encode("ascii", "backslashreplace").decode().replace("\\x9b", "\\u009b").replace("\x1b", "\\u001b")
    (tmp_path / "shot.toml").write_text(f'scene = "golf"\n"{key}" = 3\n')
    outcomes = [call("run", drop), call("run", drop, "--json"), call("list", drop), call("run", tmp_path / "shot.toml")]
    for code, out, err in outcomes:
        assert not set(EVIL[:1] + EVIL[4] + EVIL[-1]) & set(out + err), (code, out, err)
    assert json.loads(outcomes[1].out)["events"][0]["ball"] == f"b{EVIL}all\nsplit"
    assert any(
        line.startswith("  boun") and line.split("split")[1].strip() == "1" for line in outcomes[0].out.splitlines()
    )


def test_a_name_in_a_csv_is_one_cell_that_computes_nothing(call, drop: Path, tmp_path: Path):
    for name in ("'=1+1,\\n2'", "'-b\\\"a'"):
        copy = Path(shutil.copytree(drop, tmp_path / f"copy{len(name)}"))
        change(copy / "scene.py", '"ball",', f"{name},")
        change(copy / "scene.py", 'run.state("ball"', f"run.state({name}")
        file = tmp_path / "path.csv"
        assert call("run", copy, "--trajectory", file).code == 0
        names = {row["ball"] for row in read_rows(file)}
        assert names == {"'" + " ".join(eval(name).split())}


# As a process -------------------------------------------------------------------------------------------------------


def test_a_process_that_was_asked_wrongly_ends_with_2():
    process = subprocess.run([*COMMAND, "run", "golff"], capture_output=True, text=True)
    assert (process.returncode, process.stdout) == (2, "")
    assert process.stderr == "error: unknown scene golff; did you mean golf?\n"


@pytest.mark.parametrize("command", ["list", "--help", "schema golf"])
def test_a_reader_that_leaves_is_no_trouble(command: str):
    read, write = os.pipe()
    os.close(read)
    process = subprocess.run([*COMMAND, *command.split()], stdout=write, stderr=subprocess.PIPE, text=True)
    os.close(write)
    assert process.stderr == ""
    assert process.returncode == 1


def test_a_full_disk_behind_stdout_is_told():
    with Path("/dev/full").open("w") as full:
        process = subprocess.run([*COMMAND, "schema", "golf"], stdout=full, stderr=subprocess.PIPE, text=True)
    assert process.stderr == "error: stdout cannot be written: no space left on device\n"
    assert process.returncode == 1


def test_a_terminal_that_cannot_show_a_character_is_no_trouble():
    environment = os.environ | {"PYTHONIOENCODING": "koi8-r"}
    process = subprocess.run([*COMMAND, "run", str(DROP), "--check"], capture_output=True, env=environment)
    assert (process.returncode, process.stderr) == (0, b"")
    assert b"1.21 m ? less" in process.stdout


def test_a_closed_stdout_is_told(tmp_path: Path):
    outcome = subprocess.run(["sh", "-c", '"$@" >&-', "sh", *COMMAND, "run", str(DROP)], capture_output=True, text=True)
    assert (outcome.returncode, outcome.stderr) == (1, "error: stdout cannot be written: it is closed\n")


def test_a_closed_stderr_is_no_trouble(tmp_path: Path):
    command = ["sh", "-c", '"$@" 2>&-', "sh", *COMMAND, "run", str(DROP), "--gif", str(tmp_path / "drop.gif")]
    outcome = subprocess.run(command, capture_output=True, text=True)
    assert (outcome.returncode, outcome.stderr) == (0, "")
    assert "wrote" in outcome.stdout


def test_python_runs_the_module():
    outcome = subprocess.run([sys.executable, "-m", "sandbox", "--version"], capture_output=True, text=True)
    assert (outcome.returncode, outcome.stdout) == (0, f"sandbox {sandbox.__version__}\n")


@pytest.mark.parametrize("program", ["../sandbox", "-m sandbox"])
def test_modules_in_the_current_folder_shadow_none_of_pythons(tmp_path: Path, program: str):
    """Neither in the program nor in the processes of a sweep."""
    (tmp_path / "sandbox").write_text(f"if __name__ == '__main__':\n    {COMMAND[-1]}")
    (here := tmp_path / "here").mkdir()
    for name in ("random", "struct", "pickle", "multiprocessing", "click", "numpy", "scene"):
        (here / f"{name}.py").write_text("open('ran', 'w')\nraise ImportError")
    command = f"{program} sweep golf --over launch.angle=5:9:3 --jobs 2 --out rows.csv".split()
    outcome = subprocess.run([sys.executable, *command], capture_output=True, text=True, cwd=here)
    assert (outcome.returncode, outcome.stderr) == (0, "")
    assert not (here / "ran").exists()


def stopped(by: int, sign: Path, *args: object) -> Outcome:
    """Run the program in a process, and send it a signal once ``sign`` is there; without what a slow machine says of
    the progress."""
    process = subprocess.Popen(
        [*COMMAND, *map(str, args)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, start_new_session=True
    )
    while not sign.exists() and process.poll() is None:
        time.sleep(0.01)
    os.killpg(process.pid, by)  # as a terminal does
    out, err = process.communicate(timeout=HANG)
    lines = [line for line in err.splitlines(keepends=True) if not line.startswith(f"{args[0]}: ")]
    return Outcome(process.returncode, out, "".join(lines))


ENDLESS = """
    def endless(t, position, velocity, spin):
        open({sign!r}, "w").close()
        while velocity[0] > -1.0:
            pass
        return 0.0, 0.0

    return Setup((Ball("ball", 0.05, 0.03, (0.0, 1.0), forces=(endless,)),), duration=1.0)
"""
OVER = ("--over", "launch.height=1:2:3", "--out", "x.csv", "--jobs")


@pytest.mark.parametrize(
    "command",
    [
        ["run"],
        ["run", "--set", "accuracy.method=plain"],  # in a callback of pymunk, where exceptions are lost
        ["aim", "--vary", "launch.height=1:2", "--target", "bounces=2"],
        ["sweep", *OVER, "1"],
        ["sweep", *OVER, "2"],
    ],
    ids=["run", "plain", "aim", "sweep", "sweep-processes"],
)
def test_ctrl_c_ends_a_force_that_never_does(drop: Path, tmp_path: Path, monkeypatch, command):
    monkeypatch.chdir(tmp_path)
    sign = tmp_path / "running"
    change(drop / "scene.py", BUILD, BUILD + ENDLESS.format(sign=str(sign)))
    name, *more = command
    outcome = stopped(signal.SIGINT, sign, name, drop, *more)
    assert (outcome.code, outcome.out) == (130, "")
    assert outcome.err.startswith("stopped")
    assert len(outcome.err.splitlines()) == 1


@pytest.mark.parametrize("by", [signal.SIGTERM, signal.SIGHUP])
def test_other_signals_stop_as_ctrl_c_does_and_leave_no_frames(drop: Path, tmp_path: Path, by: int):
    sign = tmp_path / "running"
    begun = "    def frame(self, t: float) -> pygame.Surface:\n"
    waits = (
        "        if t > 0.2:\n            import pathlib, time\n"
        f"            pathlib.Path({str(sign)!r}).touch()\n            time.sleep({HANG})\n"
    )
    change(drop / "picture.py", begun, begun + waits)
    outcome = stopped(by, sign, "run", drop, "--frames", tmp_path / "new" / "frames")
    assert outcome == (130, "", "stopped\n")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drop", "running"]


@pytest.mark.parametrize("by", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    "source",
    [
        "{}",
        "import contextlib; exec({!r})",
        "class Named:\n    def __set_name__(self, *_):\n        {}\nclass Owner:\n    name = Named()",  # 3.11 wraps it
    ],
)
def test_an_interrupt_during_the_first_import_is_a_line(tmp_path: Path, source: str, by: int):
    """Before any code of ours Python itself says what it likes; from the first line of ours on, so do we."""
    (tmp_path / "click.py").write_text(source.format(f"import signal; signal.raise_signal({by:d})"))
    environment = os.environ | {"PYTHONPATH": str(tmp_path)}
    outcome = subprocess.run([sys.executable, "-m", "sandbox", "list"], capture_output=True, text=True, env=environment)
    assert (outcome.returncode, outcome.stdout, outcome.stderr) == (130, "", "stopped\n")


class _Deleted:
    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)


class _Referred:
    pass


def _in_a_callback_of_c() -> None:
    space, body = pymunk.Space(), pymunk.Body(1.0, 1.0)
    body.velocity_func = lambda *_: signal.raise_signal(signal.SIGINT)
    space.add(body, pymunk.Circle(body, 1.0))
    space.step(0.01)


def _for_a_weak_reference() -> None:
    referred = _Referred()
    _reference = weakref.ref(referred, lambda _: signal.raise_signal(signal.SIGINT))
    del referred


@pytest.mark.parametrize("dropped", [_in_a_callback_of_c, _for_a_weak_reference, lambda: _Deleted() and None])
def test_ctrl_c_is_not_lost_where_python_drops_exceptions(monkeypatch, dropped: Callable[[], None]):
    """The import system does it, too: it keeps its locks by weak references."""
    monkeypatch.setattr(sys, "unraisablehook", sys.unraisablehook)  # to be restored
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        Interrupts().begin()
        dropped()
        with pytest.raises(KeyboardInterrupt):
            time.sleep(HANG)
    finally:
        signal.signal(signal.SIGINT, before)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)


def test_signals_close_together_are_one_request(monkeypatch: pytest.MonkeyPatch):
    """``timeout`` tells a process and then its group, which it is in."""
    now = [100.0]
    monkeypatch.setattr("sandbox.cli.interrupts.time.monotonic", lambda: now[0])
    before = signal.getsignal(signal.SIGTERM)
    interrupts = Interrupts()
    try:
        with pytest.raises(KeyboardInterrupt):
            interrupts(signal.SIGTERM, None)
        now[0] += 0.2
        interrupts(signal.SIGTERM, None)
        now[0] += 0.2
        with pytest.raises(KeyboardInterrupt):
            interrupts(signal.SIGTERM, None)
    finally:
        signal.signal(signal.SIGTERM, before)


def test_a_folder_of_parts_is_removed_despite_an_interrupt(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    def interrupted(folder: Path, **_: Any) -> None:
        monkeypatch.undo()
        raise KeyboardInterrupt

    monkeypatch.setattr(shutil, "rmtree", interrupted)
    with pytest.raises(KeyboardInterrupt), folder_of_parts(tmp_path, "frames") as part:
        (part / "one").touch()
    assert list(tmp_path.iterdir()) == []


def test_frames_that_were_not_finished_leave_no_folder(call, drop: Path, tmp_path: Path):
    begun = "    def frame(self, t: float) -> pygame.Surface:\n"
    change(drop / "picture.py", begun, f"{begun}        1 / 0\n")
    (tmp_path / "there").mkdir()
    for folder in ("there", "new/frames"):
        assert call("run", drop, "--frames", tmp_path / folder).code == 1
    assert sorted(path.name for path in tmp_path.iterdir()) == ["drop", "there"]


@pytest.mark.parametrize("asked", ["--help", "list"])
def test_help_and_list_import_nothing_heavy(asked):
    code = f"import sys; from sandbox.cli import main; main(['{asked}']); print(*sys.modules)"
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert not {"pydantic", "numpy", "pymunk", "pygame", "PIL"} & set(process.stdout.splitlines()[-1].split())


def test_a_run_of_one_ball_imports_no_numpy():
    code = "import sys, sandbox; sandbox.simulate('golf'); print(*sys.modules)"
    process = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "numpy" not in process.stdout.split()


def test_units_are_for_people(call, tmp_path: Path):
    """Cards and pages follow; JSON and CSV stay as they are."""
    path = tmp_path / "path.csv"
    plain = json.loads(call("run", DROP, "--json", "--trajectory", path).out)
    rows = path.read_bytes()
    chosen = json.loads(call("run", DROP, "--json", "--units", "us", "--trajectory", path).out)
    assert chosen["result"] == plain["result"]
    assert path.read_bytes() == rows
    assert " ft" in call("run", DROP, "--units", "us").out
    assert " km/h" in call("run", DROP, "--units", "km/h").out
    refused = call("run", DROP, "--units", "furlong")
    assert (refused.code, len(refused.err.splitlines())) == (2, 1)


def test_a_page_is_written_whole(call, drop: Path, tmp_path: Path):
    page = tmp_path / "shot.html"
    assert f"wrote {page}" in call("run", drop, "--html", page).out
    assert page.read_text("utf-8").rstrip().endswith("</html>")
    assert call("run", drop, "--html", tmp_path / "shot.png").code == 2


def test_a_trajectory_of_several_runs_names_each(call, drop: Path, tmp_path: Path):
    assert call("run", drop, "--compare", drop / "moon", "--trajectory", tmp_path / "x.csv").code == 0
    rows = [line.split(",") for line in (tmp_path / "x.csv").read_text("utf-8").splitlines()]
    assert rows[0] == ["t", "ball", "x", "y", "vx", "vy", "spin", "run"]
    assert [*dict.fromkeys(row[-1] for row in rows[1:])] == ["drop", str(drop / "moon")]


def test_all_keys_of_a_scene_are_listed(call, monkeypatch: pytest.MonkeyPatch):
    """Also those that only another choice of model has."""
    monkeypatch.setenv("COLUMNS", "200")
    rows = [line.split("  ")[0] for line in call("list", "golf", "--keys").out.splitlines()[1:]]
    assert {*every_key(type(sandbox.load("golf").parameters))} <= {row.strip("[]") for row in rows}
    lines = call("list", "golf", "--keys").out.splitlines()
    assert any(re.match(r"launch\.speed +76\.44\d* +m/s +0, 340 +ball speed$", line) for line in lines)
    assert any(
        re.match(r"ball\.drag\.coefficient +0\.25 +0, 10 .*\(with model = \"constant\"\)$", line) for line in lines
    )
    assert any(line.startswith("boxes[].width ") for line in call("list", "collisions", "--keys").out.splitlines())
    assert call("list", "--keys").code == 2
