"""Windows, macOS and small systems: every command where what only POSIX or Linux has is hidden; names of files."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

import sandbox
from sandbox.cli.program import modules
from sandbox.errors import RequestError
from sandbox.golden import Golden
from sandbox.window import export
from tests.own_scene import COMMAND, DROP, HANG, Outcome, assert_refused

Call = Callable[..., Outcome]

#: Imported by Python as it starts, in worker processes, too.
HIDE = """
import os, signal, sys
sys.modules["fcntl"] = sys.modules["resource"] = None
for name in ("fork", "forkpty", "nice", "sched_getaffinity"):
    vars(os).pop(name, None)
for name in ("SIGHUP", "pthread_sigmask"):
    vars(signal).pop(name, None)
"""

#: Each command with arguments; {} is a folder.
WAYS: dict[str, Sequence[str]] = {
    "list": [],
    "schema": ["throws"],
    "run": ["throws", "--json", "--poster", "{}/a.png", "--frames", "{}/f", "--fps", "5", "--trajectory", "{}/a.csv"],
    "aim": ["throws", "--vary", "launch.angle=20:30", "--target", "distance=19"],
    "sweep": [str(DROP), "--over", "launch.height=1:2:40", "--out", "{}/s.csv", "--jobs", "2"],
    "spread": ["throws", "--by", "launch.angle=1", "--samples", "64", "--no-causes"],
    "trade": [str(DROP), "--json"],
    "coefficients": ["golf"],
    "stress": [str(DROP)],
    "validate": ["throws"],
    "session": [str(Path(__file__).parents[1] / "docs" / "tracks" / "bag.csv")],
    "compile": ["--help"],
    "tasks": [],
    "fit": ["throws", "{}/a.csv", "--vary", "launch.speed"],
    "new": ["{}/mine"],
    "play": ["throws"],
    "serve": ["throws", "--json", "--port", "0"],
}


#: Calls commands and prints the outcome of each; settings are timed less often, and extremes tried by two methods.
CALLS = """
import io, json, sys
from contextlib import redirect_stderr, redirect_stdout
from sandbox.cli import main
from sandbox.lab import stress, trade
if __name__ == "__main__":
    trade._PATIENCE, stress.ALL, outcomes = 0.01, ("dormand-prince", "plain"), {}
    for name, *arguments in json.loads(sys.argv[1]):
        with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as err:
            code = main([name, *arguments])
        outcomes[name] = code, out.getvalue(), err.getvalue()
    print(json.dumps(outcomes))
"""


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, str]]:
    """A folder, and the environment of a program on another system."""
    folder = tmp_path_factory.mktemp("elsewhere")
    (folder / "site").mkdir()
    (folder / "site" / "sitecustomize.py").write_text(HIDE, "utf-8")
    path = os.pathsep.join(filter(None, [str(folder / "site"), os.environ.get("PYTHONPATH")]))
    return folder, {**os.environ, "PYTHONPATH": path, "SDL_VIDEODRIVER": "nothing", "PYTHONWARNDEFAULTENCODING": "1"}


def test_every_command_is_tried_elsewhere():
    assert WAYS.keys() == modules().keys()


@pytest.fixture(scope="module")
def outcomes(elsewhere: tuple[Path, dict[str, str]]) -> dict[str, Outcome]:
    """Of each command that ends by itself, called there one after another in one process."""
    folder, environment = elsewhere
    calls = [[name, *(word.format(folder) for word in WAYS[name])] for name in WAYS if name not in ("play", "serve")]
    done = subprocess.run(
        [sys.executable, "-c", CALLS, json.dumps(calls)], capture_output=True, text=True, env=environment
    )
    assert (done.returncode, done.stderr) == (0, "")
    return {name: Outcome(*outcome) for name, outcome in json.loads(done.stdout).items()}


@pytest.mark.parametrize("command", [name for name in WAYS if name not in ("play", "serve")])
def test_a_command_needs_only_what_every_system_has(outcomes: dict[str, Outcome], command: str):
    code, out, err = outcomes[command]
    assert (code, "Traceback" in err, "EncodingWarning" in err) == (0, False, False)
    assert "launch.speed" in out if command == "fit" else out


def test_the_window_says_where_it_has_no_display(elsewhere: tuple[Path, dict[str, str]]):
    done = subprocess.run([*COMMAND, "play", "throws"], capture_output=True, text=True, env=elsewhere[1])
    assert (done.returncode, done.stderr.startswith("error: no display")) == (2, True)


def test_scenes_are_served_elsewhere_too(elsewhere: tuple[Path, dict[str, str]]):
    process = subprocess.Popen(
        [*COMMAND, "serve", *WAYS["serve"]],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=elsewhere[1],
    )  # fmt: skip
    assert process.stdout is not None
    try:
        assert json.loads(process.stdout.readline())["url"].startswith("http://127.0.0.1:")
    finally:
        process.terminate()
    _, errors = process.communicate(timeout=HANG)
    assert (process.returncode, "Traceback" in errors) == (130, False)


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("a:b.png", "':' in its name"),
        ('a"b.png', "'\"' in its name"),
        ("what?.png", r"'\?' in its name"),
        ("a\\b.png", r"'\\\\' in its name"),
        ("con.png", "CON as its name"),
        ("Lpt1.tar.png", "LPT1 as its name"),
    ],
)
def test_a_name_that_windows_forbids_is_no_output(call: Call, tmp_path: Path, name: str, said: str):
    outcome = call("run", DROP, "--poster", tmp_path / name)
    assert_refused(outcome, "--poster")
    assert re.search(f"{said}: Windows has no such names; choose another", outcome.err)
    assert not [*tmp_path.iterdir()]


def test_no_other_output_has_such_a_name(call: Call, tmp_path: Path):
    for command in (
        ("run", DROP, "--frames", tmp_path / "a|b"),
        ("run", DROP, "--frames", tmp_path / "frames."),
        ("sweep", DROP, "--over", "launch.height=1:2:3", "--out", tmp_path / "aux.csv"),
        ("new", tmp_path / "nul"),
    ):
        assert_refused(call(*command), "Windows has no such names")
    with pytest.raises(RequestError, match=r"path .*a:b.png: ':' in its name"):
        sandbox.simulate("throws").poster(tmp_path / "a:b.png")
    assert not [*tmp_path.iterdir()]


def test_a_file_of_the_window_has_a_name_for_every_system(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(export, "FOLDER", tmp_path)
    assert export.new_file('a "b" / c: d?', ".png", lambda path: path.touch()).name == "a -b- - c- d--1.png"


def test_a_golden_name_is_one_for_every_system(golden: Golden):
    with pytest.raises(pytest.fail.Exception, match="the name of a golden picture is that of a file"):
        golden.check("a:b", sandbox.simulate("throws"))
