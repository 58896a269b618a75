"""Files that a command reads are never replaced; what is replaced by name is kept; only plain files are opened."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest

from sandbox.files import atomic_write, backup_of, inputs_are_kept, read_given, write_together
from tests.own_scene import COMMAND, DROP, Outcome, assert_refused

Call = Callable[..., Outcome]

FIT = ("--vary", "launch.speed=5:20", "--vary", "launch.angle=20:60")
LOST = "this command reads that file, which would be lost; name another"


@pytest.fixture
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder to work in, with a measured track: x = 10 t, y = 2 + 5 t - g/2 t^2."""
    monkeypatch.chdir(tmp_path)
    rows = [f"{t},{10 * t},{2 + 5 * t - 4.905 * t * t}" for t in (0.0, 0.2, 0.4, 0.6, 0.8)]
    Path("track.csv").write_text("\n".join(["t,x,y", *rows]) + "\n", "utf-8")
    return tmp_path


def contents(folder: Path) -> dict[str, bytes]:
    return {file.name: file.read_bytes() for file in folder.iterdir() if file.is_file()}


# What a command reads -----------------------------------------------------------------------------------------------


def test_no_output_replaces_points_that_are_read(call: Call, here: Path):
    assert call("fit", "throws", "track.csv", *FIT, "--free", "origin", "--save", "good.toml").code == 0
    before = contents(here)
    for option in ("--trajectory", "--momentum"):
        assert_refused(call("run", "good.toml", option, "good.csv"), f"{option} good.csv: {LOST}")
    assert_refused(call("sweep", "good.toml", "--over", "launch.speed=8:9:2", "--out", "good.csv"), LOST)
    assert_refused(
        call("fit", "throws", "track.csv", *FIT, "--save", "track.toml"), "its points would be written over track.csv"
    )
    assert contents(here) == before
    assert call("run", "good.toml").code == 0


@pytest.mark.parametrize("link", ["symlink_to", "hardlink_to"])
def test_no_output_replaces_a_scene_by_a_link(call: Call, here: Path, link: str):
    Path("my.toml").write_text('scene = "throws"\n', "utf-8")
    getattr(Path("lnk.csv"), link)("my.toml")
    before = contents(here)
    assert_refused(call("run", "my.toml", "--trajectory", "lnk.csv"), f"--trajectory lnk.csv: {LOST}")
    assert_refused(call("run", "throws", "--compare", "my.toml", "--trajectory", "lnk.csv"), LOST)
    Path("code.csv").symlink_to(DROP / "scene.py")
    assert_refused(call("run", DROP, "--trajectory", "code.csv"), LOST)
    Path("points.csv").write_text("launch.speed\n8\n", "utf-8")
    assert_refused(call("sweep", "throws", "--points", "points.csv", "--out", "points.csv"), LOST)
    assert contents(here).items() >= before.items()


def test_a_backup_replaces_nothing_that_is_read(call: Call, here: Path):
    Path("rows.csv~").write_text("launch.speed\n8\n", "utf-8")
    Path("rows.csv").write_text("a\n", "utf-8")
    refused = call("sweep", "throws", "--points", "rows.csv~", "--out", "rows.csv")
    assert_refused(refused, "its content would be kept as")
    assert Path("rows.csv~").read_text("utf-8") == "launch.speed\n8\n"


def test_inputs_are_those_of_one_command(tmp_path: Path):
    """A later command may write what an earlier one read, and a library's user may, too."""
    file = tmp_path / "a.html"
    file.write_text("old", "utf-8")
    with inputs_are_kept():
        read_given(file, 100)
    with atomic_write(file) as out:
        out.write("new")
    assert contents(tmp_path) == {"a.html": b"new", "a.html~": b"old"}


# What is replaced ---------------------------------------------------------------------------------------------------


def test_points_replace_no_file_that_nobody_named(call: Call, here: Path):
    Path("existing.csv").write_text("mine\n", "utf-8")
    refused = call("fit", "throws", "track.csv", *FIT, "--save", "existing.toml")
    assert_refused(refused, "--save existing.toml: its points would be written over existing.csv; choose another name")
    Path("existing.toml").write_text('scene = "throws"\n', "utf-8")
    assert call("fit", "throws", "track.csv", *FIT, "--save", "existing.toml").code == 2
    assert Path("existing.csv").read_text("utf-8") == "mine\n"


def test_a_fit_saved_again_keeps_the_one_before(call: Call, here: Path):
    save = ("fit", "throws", "track.csv", "--free", "origin", "--save", "good.toml")
    assert call(*save, *FIT).code == 0
    first = contents(here)
    assert call(*save, *FIT).code == 0
    assert contents(here) == first  # the same again: nothing to keep
    assert call(*save, *FIT[:2]).code == 0
    assert contents(here)["good.toml~"] == first["good.toml"]
    assert contents(here)["good.csv~"] == first["good.csv"]
    assert call(*save, *FIT).code == 0  # what this program wrote may be replaced
    assert contents(here)["good.toml"] == first["good.toml"]


@pytest.mark.parametrize(("option", "name"), [("--trajectory", "a.csv"), ("--poster", "a.png"), ("--html", "a.html")])
def test_what_an_output_replaces_stays(call: Call, here: Path, option: str, name: str):
    Path(name).write_text("mine", "utf-8")
    assert call("run", DROP, option, name).code == 0
    first = Path(name).read_bytes()
    assert Path(f"{name}~").read_text("utf-8") == "mine"
    again = call("run", DROP, option, name, "--set", "launch.height=1")
    if name.endswith(".csv"):  # twice over measured points would lose them
        assert_refused(again, "but that is a file of yours; name another")
        assert (Path(name).read_bytes(), Path(f"{name}~").read_text("utf-8")) == (first, "mine")
    else:
        assert again.code == 0
        assert Path(f"{name}~").read_bytes() == first != Path(name).read_bytes()


def test_frames_of_an_earlier_run_stay(call: Call, here: Path):
    shot = ("run", DROP, "--frames", "film", "--fps", 5)
    assert call(*shot).code == 0
    first = contents(here / "film")
    Path("film", "notes.txt").write_text("mine", "utf-8")
    assert call(*shot).code == 0
    assert not Path("film~").exists()
    assert call(*shot, "--set", "launch.height=0.3").code == 0
    assert contents(here / "film~") == first
    assert Path("film", "notes.txt").read_text("utf-8") == "mine"
    Path("film~", "frame_00000.png").write_text("mine", "utf-8")
    assert_refused(call(*shot), "film~: frame_00000.png in it was not written by the sandbox")


def test_all_files_of_one_output_are_kept_or_none(tmp_path: Path):
    """One backup cannot be made: neither file is replaced."""
    one, other = tmp_path / "a.toml", tmp_path / "a.csv"
    for file in (one, other, backup_of(other)):
        file.write_text("mine", "utf-8")
    with pytest.raises(Exception, match=r"a\.csv~, but that is a file of yours"):
        write_together({one: b"new", other: b"new"}, kept=True)
    assert contents(tmp_path) == {"a.toml": b"mine", "a.csv": b"mine", "a.csv~": b"mine"}


# What is no plain file ----------------------------------------------------------------------------------------------

OUTPUTS = (
    ("run", DROP, "--trajectory", "x.csv"),
    ("run", DROP, "--poster", "x.png"),
    ("run", DROP, "--html", "x.html"),
    ("run", DROP, "--video", "x.mp4"),
    ("sweep", DROP, "--over", "launch.height=1:2:2", "--out", "x.csv"),
    ("sweep", DROP, "--over", "launch.height=1:2:2", "--out", "rows.csv", "--plot", "x.png"),
    ("aim", DROP, "--vary", "launch.height=1:2", "--maximize", "bounces", "--plot", "x.png"),
    ("spread", DROP, "--by", "launch.height=1%", "--html", "x.html"),
    ("trade", DROP, "--plot", "x.png"),
    ("fit", "throws", "track.csv", *FIT, "--save", "x.toml"),
)
INPUTS = (
    ("run", "x"),
    ("fit", "throws", "x", *FIT),
    ("sweep", "throws", "--points", "x", "--out", "rows.csv"),
    ("validate", "golf", "--against", "x"),
    ("play", "x"),
)


@pytest.mark.parametrize("command", OUTPUTS, ids=lambda command: f"{command[0]} {command[-2]}")
def test_no_output_goes_into_a_pipe_or_a_device(call: Call, here: Path, command: tuple[object, ...]):
    name = Path(str(command[-1]))
    os.mkfifo(name)
    assert_refused(call(*command), f"{command[-2]} {name}: is no plain file; name another")
    name.unlink()
    name.symlink_to("/dev/zero")
    assert_refused(call(*command), f"{command[-2]} {name}: is no plain file; name another")
    assert Path("/dev/zero").is_char_device()


@pytest.mark.parametrize("command", INPUTS, ids=lambda command: command[0])
@pytest.mark.parametrize("kind", ["pipe", "device"])
def test_no_input_comes_from_a_pipe_or_a_device(call: Call, here: Path, command: tuple[str, ...], kind: str):
    if kind == "pipe":
        os.mkfifo("x.toml")
    else:
        Path("x.toml").symlink_to("/dev/zero")
    args = ["x.toml" if arg == "x" else arg for arg in command]
    assert_refused(call(*args), "x.toml: is a pipe or a device; a file is needed")


def test_outputs_may_be_stdout_wherever_it_leads(here: Path):
    command = [*COMMAND, "sweep", str(DROP), "--over", "launch.height=1:2:3", "--jobs", "1", "--out", "/dev/stdout"]
    piped = subprocess.run(command, capture_output=True, check=True).stdout
    assert len(piped.splitlines()) == 4
    with Path("rows.txt").open("wb") as file:
        file.write(b"before\n")
        file.flush()
        subprocess.run(command, stdout=file, check=True)
    assert contents(here).keys() == {"rows.txt", "track.csv"}
    assert Path("rows.txt").read_bytes() == b"before\n" + piped


@pytest.mark.parametrize(
    "args",
    [
        ("run", "--poster"),
        ("run", "--gif"),
        ("run", "--trajectory"),
        ("sweep", "--over", "launch.height=1:2:2", "--out"),
    ],
    ids=lambda args: args[-1],
)
def test_a_full_disk_is_told(args: tuple[str, ...]):
    command = [*COMMAND, args[0], str(DROP), *args[1:], "/dev/stdout"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True)
    told = f"error: {args[-1]} /dev/stdout: cannot be written: no space left on device\n"
    assert (done.returncode, done.stderr) == (1, told)
