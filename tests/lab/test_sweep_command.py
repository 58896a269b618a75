"""The command ``sandbox sweep``: its rows, pictures, and the requests it rejects."""

from __future__ import annotations

import re

import pytest
from PIL import Image

import sandbox
from sandbox.cli import main
from tests.lab.sweeping import own_scene, table
from tests.own_scene import DROP


def test_the_command(tmp_path, capsys):
    out, plot = tmp_path / "rows.csv", tmp_path / "map.png"
    over = ["--over", "launch.speed=7:8:4", "--over", "launch.angle=45:60:3"]
    assert main(["sweep", "basketball", *over, "--jobs", "1", "--out", str(out), "--plot", str(plot)]) == 0
    told = capsys.readouterr()
    assert told.out.startswith("12 points; 12 in ")
    assert told.out.endswith(f"wrote {out}\nwrote {plot}\n")
    assert told.err == ""
    rows = table(out)
    assert list(rows[0])[:4] == ["launch.speed", "launch.angle", "made", "verdict"]
    assert list(rows[0])[-1] == "error"
    assert [(row["launch.speed"], row["launch.angle"]) for row in rows][:4] == [
        ("7.0", "45.0"), ("7.0", "52.5"), ("7.0", "60.0"), ("7.333333333333333", "45.0"),
    ]  # fmt: skip
    assert {row["made"] for row in rows} <= {"true", "false"}
    with Image.open(plot) as picture:
        assert picture.size[0] > 900


def test_the_points_of_a_table(tmp_path, capsys):
    points, out, plot, page = (tmp_path / name for name in ("points.csv", "rows.csv", "map.png", "map.html"))
    points.write_text("launch.speed,launch.angle\n7.4,52\n16.5 mph,50\n7,45\n")
    command = ["sweep", "basketball", "--points", str(points), "--out", str(out), "--plot", str(plot)]
    assert main([*command, "--html", str(page)]) == 0
    assert capsys.readouterr().out.startswith("3 points; 3 in ")
    found = sandbox.simulate_many("basketball", {"launch.speed": [7.4, "16.5 mph", 7.0], "launch.angle": [52, 50, 45]})
    rows = table(out)
    assert [float(row["launch.speed"]) for row in rows] == found.points["launch.speed"].tolist()
    assert [float(row["apex"]) for row in rows] == pytest.approx(found["apex"], abs=1e-9)
    assert [row["made"] for row in rows] == [str(bool(made)).lower() for made in found["made"]]
    with Image.open(plot) as picture:
        assert picture.size[0] > 900
    assert "sandbox sweep basketball --points points.csv" in page.read_text()


def test_shots_that_are_normally_distributed(tmp_path, capsys):
    out, page = tmp_path / "rows.csv", tmp_path / "map.html"
    over = ["--over", "launch.speed=7.4~0.08", "--over", "launch.angle=52~1", "--samples", "64"]
    assert main(["sweep", "basketball", *over, "--out", str(out), "--html", str(page)]) == 0
    capsys.readouterr()
    speeds = [float(row["launch.speed"]) for row in table(out)]
    assert sum(speeds) / 64 == pytest.approx(7.4, abs=0.04)
    assert max(speeds) - min(speeds) == pytest.approx(5 * 0.08, rel=0.4)
    text = page.read_text()
    assert all(word in text for word in ("launch.speed=7.4~0.08", "launch.angle=52~1", "--samples 64"))


ROWS = ("--over", "launch.speed=1:2:3", "--out", "x.csv")


@pytest.mark.parametrize(
    ("args", "told"),
    [
        (["--over", "launch.speed=1:2:3", "--out", "x.txt"], "must end in .csv"),
        (["--over", "launch.speed=1:2:3", "--out", "no/x.csv"], "there is no folder"),
        ([*ROWS, "--of", "carry"], "requires --plot"),
        ([*ROWS, "--plot", "x.jpg"], "must end in .png"),
        ([*ROWS, "--plot", "x.png", "--of", "aped"], "did you mean apex?"),
        (["--over", "launch.speed=1:2:1", "--out", "x.csv", "--plot", "x.png"], "two values or more"),
        ([*ROWS, "--samples", "0"], "'--samples': 0 is not in the range x>=1"),
        ([*ROWS, "--seed", "2"], "--seed 2: requires --samples"),
        ([*ROWS, "--plot", "x.png", "--of", "xyz"], "refined_steps\n"),
        (["--out", "x.csv"], "nothing to sweep over: give --over KEY=LO:HI:N, or --points F.csv"),
        (
            ["--over", "launch.speed=7.4~0.08", "--out", "x.csv"],
            "launch.speed=7.4~0.08: a distribution needs --samples",
        ),
        ([*ROWS, "--points", "p.csv"], "--points p.csv: cannot be combined with --over or --samples"),
        (["--points", "p.csv", "--out", "x.csv"], "--points p.csv: cannot be read: no such file"),
        (["--over", "launch.speed=1:2:3"], "--out"),
    ],
)
def test_wrong_requests_are_told_before_any_work(tmp_path, monkeypatch, capsys, args, told):
    monkeypatch.chdir(tmp_path)
    assert main(["sweep", "basketball", *args]) == 2
    assert told in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_a_sweep_in_which_all_points_fail_says_so(tmp_path, capsys):
    scene = own_scene(tmp_path, "    raise ValueError('never')\n")
    out = tmp_path / "x.csv"
    assert main(["sweep", str(scene), "--over", "launch.height=1:2:3", "--jobs", "1", "--out", str(out)]) == 1
    errors = {row["error"] for row in table(out)}
    assert len(errors) == 1
    assert capsys.readouterr().err == f"error: every point failed, the first with: {(error := errors.pop())}\n"
    assert re.fullmatch(r"ValueError: never \(drop/scene\.py, line \d+\)", error)


@pytest.mark.parametrize(
    ("over", "more"),
    [
        (["launch.height=0.5:2:9"], []),
        (["launch.height=0.5:2:9"], ["--of", "bounced"]),
        (["launch.height=0.5:2:9", "launch.speed=0:2:8"], ["--of", "final_height"]),
        (["launch.height=2,1,0.5", "floor.present=true,false"], ["--of", "bounced"]),
        (["launch.height=0.5:2", "launch.speed=0:2"], ["--samples", "30", "--of", "bounced"]),
        (["launch.height=0.5:2", "launch.speed=0:2"], ["--samples", "30"]),
    ],
)
def test_pictures(tmp_path, over, more):
    plot = tmp_path / "x.png"
    options = [text for axis in over for text in ("--over", axis)]
    out = tmp_path / "x.csv"
    assert main(["sweep", str(DROP), *options, *more, "--jobs", "1", "--out", str(out), "--plot", str(plot)]) == 0
    with Image.open(plot) as picture:
        assert len(picture.convert("RGB").getcolors(1 << 24)) > 20
