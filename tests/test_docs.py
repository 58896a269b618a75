"""The pages for people keep step with the code: what they show is run, and prints what they say."""

from __future__ import annotations

import doctest
import importlib.util
import inspect
import os
import re
import shlex
import subprocess
import sys
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from PIL import Image

import sandbox
from sandbox import kit
from sandbox.cli import program
from sandbox.cli.program import app
from sandbox.parameters import walk
from sandbox.record import diverges
from sandbox.scene.modules import forget

ROOT = Path(__file__).resolve().parent.parent

# Your own scene -----------------------------------------------------------------------------------------------------

WALK = (ROOT / "docs" / "your-own-scene.md").read_text("utf-8")
LIKE = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE


def blocks(page: str) -> Iterator[tuple[str, str]]:
    """Language and text of each fenced block."""
    yield from re.findall(r"^```(\w+)\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)


def steps(console: str) -> Iterator[tuple[str, str]]:
    """Each command of a console block, and what the page says that it prints."""
    for part in re.split(r"^\$ ", console, flags=re.MULTILINE)[1:]:
        command, _, output = part.partition("\n")
        yield command, output


def test_the_walk_through_works_as_it_stands(golden, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd):
    """Every file is written and every command run, in order, in an empty folder; and it prints what the page says."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr("sandbox.lab.aim.shots._DENSE", 129)  # enough for wide intervals
    here = {key: value for key, value in os.environ.items() if key not in ("CI", "PYTEST_XDIST_WORKER")}
    here["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), here["PATH"]])
    written: set[Path] = set()
    for language, text in blocks(WALK):
        if language == "console":
            for command, expected in steps(text):
                if command.startswith("sandbox ") and ">" not in command:
                    forget(tmp_path / "beachvolley")  # or it would be as the command before found it
                    code = program.call(shlex.split(command)[1:])
                else:
                    code = subprocess.run(command, shell=True, env=here).returncode
                output = "".join(capfd.readouterr())
                assert doctest.OutputChecker().check_output(expected, output, LIKE), f"$ {command}\n{output}"
                assert code == (2 if expected.startswith("error") else 0), command
            continue
        first, _, rest = text.partition("\n")
        file = tmp_path / first.removeprefix("# ")
        file.parent.mkdir(exist_ok=True)
        with file.open("a" if file in written else "w", encoding="utf-8") as opened:
            opened.write(rest)
        written.add(file)
    with Image.open(tmp_path / "beachvolley" / "golden" / "beachvolley.png") as image:
        golden.check("beachvolley", image)
    for how in (["check", "--ignore=I001"], ["format", "--check"]):  # here the sandbox is a library like others
        command = [sys.executable, "-m", "ruff", *how, "--config", str(ROOT / "pyproject.toml"), "beachvolley"]
        assert subprocess.run(command, cwd=tmp_path, capture_output=True).returncode == 0


def test_parts_of_a_picture_are_called_as_the_guide_says():
    """With every argument in order, and "=" after those that have a default."""
    calls = re.findall(
        r"`((?:plan\.)?[A-Z]\w+)\(([\w=,\s]+)\)`", WALK.partition("## The picture")[2].partition("```python")[0]
    )
    assert {name for name, _ in calls} > {"Place", "Landscape", "Person", "Net", "plan.Stripes", "Look"}
    for name, arguments in calls:
        part = kit.plan if name.startswith("plan.") else kit
        given = inspect.signature(getattr(part, name.removeprefix("plan."))).parameters.values()
        expected = [f"{one.name}{'=' * (one.default is not one.empty)}" for one in given]
        assert re.split(r",\s+", arguments) == expected, name
    made = [kit.Place(), kit.Hall(), kit.Stands(), kit.Landscape(), kit.Ground(), kit.Stripes(), kit.Person(0.0)]
    assert all(made)


# README -------------------------------------------------------------------------------------------------------------

README = (ROOT / "README.md").read_text("utf-8")
#: Commands as the page writes them, indented or in a table; what is installed or made is not run here.
COMMANDS = sorted(set(re.findall(r"(?:^    |`)sandbox ((?!COMMAND)[a-z].*?)(?:`|$)", README, re.MULTILINE)))


def test_the_readme_has_all_commands():
    commands = program.modules().keys()
    assert {command.split()[0] for command in COMMANDS} == commands


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_of_the_readme_can_be_given(command: str):
    """The command and its options exist, and so do the scene and the keys that it names."""
    name, *args = shlex.split(command)
    shown = CliRunner().invoke(app, [name, "--help"], env={"COLUMNS": "200"}).output
    assert [arg for arg in args if arg.startswith("--") and arg not in shown] == []
    scene = args[0] if args and not args[0].startswith("--") else None
    if scene is None or name == "new" or scene in ("./beachvolley", "my-shot.toml", "shots.csv"):
        return
    known = {parameter.key for parameter in walk(sandbox.load(scene).parameters)}
    settings = [args[i + 1] for i, arg in enumerate(args) if arg in ("--set", "--vary", "--over")]
    assert [text for text in settings if text.partition("=")[0] not in known] == []


def test_code_of_the_readme_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    (shot,) = re.findall(r"^    # A softer drive.\n((?:    .*\n|\n)+?)\n    sandbox run", README, re.MULTILINE)
    Path("my-shot.toml").write_text(textwrap.dedent("    # A softer drive.\n" + shot))
    assert sandbox.simulate(sandbox.load("my-shot.toml")).result["carry"] > 100
    names: dict[str, Any] = {"dataclass": dataclass, "Any": Any}
    for language, text in blocks(README):
        if language == "python":
            exec(text, names)
    assert names["run"].result["carry"] > 200
    solutions = [solution.values["launch.angle"] for solution in names["aim"].solutions]
    ((name, until),) = re.findall(r"such as\sthat of `(.+?)`, `golden.check\(.+?, until=(.+?)\)`", README)
    chaotic = sandbox.simulate(sandbox.load(name))
    assert (diverges(chaotic, float(until)), diverges(chaotic) is None) == (None, False)
    assert f"# two: launch angles of {solutions[0]:.1f} and {solutions[1]:.1f} deg\n" in README
    assert names["Fan"](6.0, 0.8, 4.0)(0.0, (6.0, 1.0), (0.0, 0.0), 0.0) == (0.0, 4.0)


def test_the_readme_shows_the_force_of_a_new_scene():
    template = (ROOT / "template" / "scene.py").read_text("utf-8")
    (shown,) = [text for language, text in blocks(README) if "class Fan" in text]
    (own,) = re.findall(r"@dataclass\(frozen=True\)\nclass Fan:.*?(?=\n\n\n)", template, re.DOTALL)
    code = [[line for line in text.splitlines() if line and '"""' not in line] for text in (shown, own)]
    assert code[0] == code[1]


def test_code_of_the_page_on_scatter_runs(capsys: pytest.CaptureFixture[str]):
    page = (ROOT / "docs" / "spread.md").read_text("utf-8")
    names: dict[str, Any] = {}
    for _, code in blocks(page):
        exec(code, names)
    assert len(capsys.readouterr().out.splitlines()) == 4
    assert names["found"].causes["carry"]["launch.speed"].first > 0.5


def test_code_of_the_page_on_fits_runs(capsys: pytest.CaptureFixture[str]):
    names: dict[str, Any] = {}
    for language, code in blocks((ROOT / "docs" / "fit.md").read_text("utf-8")):
        if language == "python":
            exec(code, names)
    assert len(capsys.readouterr().out.splitlines()) == 3
    assert names["restitution"].low < 0.71 < names["restitution"].high


def executed(page: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    """Every file of a page is written, every command and every program run, in order, in this folder; commands print
    what the page says. What the programs print."""
    said = []
    for language, text in blocks((ROOT / "docs" / page).read_text("utf-8")):
        if language == "toml":
            Path(text.partition("\n")[0].removeprefix("# ")).write_text(text, "utf-8")
        elif language == "python":
            exec(text, {})
            said.append(capsys.readouterr().out)
        else:
            for command, expected in steps(text):
                code = program.call(shlex.split(command)[1:])
                shown = capsys.readouterr()
                assert code == (2 if expected.startswith("error: ") else 0), f"$ {command}\n{shown.err}"
                output = shown.err if code else shown.out
                assert doctest.OutputChecker().check_output(expected, output, LIKE), f"$ {command}\n{output}"
    return said


def test_the_exercises_work_as_they_stand(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    bounces, _ = (list(map(float, re.findall(r"\d+\.\d+", line))) for line in executed("teaching.md", capsys))
    assert bounces == pytest.approx([9.81, 0.75], rel=0.02)
    pictures = {"ball.png", "put.png", "air.png", "throws.png"}
    assert pictures <= {path.name for path in tmp_path.iterdir()}


def test_a_task_of_your_own_works_as_the_page_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    (played,) = executed("tasks.md", capsys)
    assert len(played.splitlines()) == 4


def test_code_of_the_page_on_environments_runs(monkeypatch: pytest.MonkeyPatch, capsys):
    one, many = executed("gym.md", capsys)
    assert (one, many) == ("True True True\n", "(64,) True\n")


@pytest.mark.parametrize("page", ["from-your-video.md", "from-your-launch-monitor.md", "session.md"])
def test_measurements_are_fitted_as_the_page_says(page: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys):
    for file in (ROOT / "docs" / "tracks").glob("*.[ct][sx][vt]"):
        (tmp_path / file.name).write_bytes(file.read_bytes())
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    for text in executed(page, capsys):
        assert text.startswith("0.7281, 0.7273 to 0.7289\n")


def test_the_measurements_that_ship_are_made_by_their_script(monkeypatch: pytest.MonkeyPatch):
    found = importlib.util.spec_from_file_location("make", ROOT / "docs" / "tracks" / "make.py")
    make = importlib.util.module_from_spec(found)
    found.loader.exec_module(make)
    for name, made in make.FILES.items():
        assert (ROOT / "docs" / "tracks" / name).read_text("utf-8") == made()


def test_code_of_the_page_on_sharing_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.chdir(tmp_path)
    page = (ROOT / "docs" / "sharing.md").read_text("utf-8")
    codes = [text for language, text in blocks(page) if language == "python"]
    for code in codes:
        exec(code, {})
    assert codes
    assert Path("golf-us.png").exists()
    assert re.findall(r"`[^`\n]*\bsandbox\.\w+\.\w[^`\n]*`", page) == []  # rooms are imported, not reached by dots


@pytest.mark.parametrize("picture", sorted((ROOT / "docs" / "pictures").glob("*.[jp]*g")), ids=lambda path: path.name)
def test_pictures_of_the_readme_are_shown_and_small(picture: Path):
    assert f"docs/pictures/{picture.name}" in README
    assert picture.stat().st_size < 300_000


# Accuracy -----------------------------------------------------------------------------------------------------------


def test_the_table_of_shots_at_the_rim_can_be_measured_again(monkeypatch: pytest.MonkeyPatch):
    """With the columns that the page has."""
    found = importlib.util.spec_from_file_location("measure_accuracy", ROOT / "docs" / "measure_accuracy.py")
    measure = importlib.util.module_from_spec(found)
    found.loader.exec_module(measure)
    monkeypatch.setattr(measure, "SHOTS", 5)
    page = measure.PAGE.read_text("utf-8")
    assert f"<!-- rim -->\n{measure.rimmed()['rim'][0]}\n" in page


# Contributing -------------------------------------------------------------------------------------------------------


def test_every_module_of_the_engine_is_in_the_architecture():
    page = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    modules = {path.name for path in (ROOT / "sandbox" / "engine").rglob("*.py")} - {"__init__.py"}
    assert {name for name in modules if f"`{name}`" not in page} == set()
    packages = page[page.index("## The packages") : page.index("## Words")]
    assert set(re.findall(r"`(\w+\.py)`", packages)) <= modules


def test_what_the_architecture_names_exists():
    page = (ROOT / "docs" / "architecture.md").read_text("utf-8")
    source = "\n".join(path.read_text("utf-8") for path in (ROOT / "sandbox").rglob("*.py"))
    rows = [row.split("|") for row in page.splitlines() if row.startswith("| ") and row.count("|") == 4]
    named = {name for row in rows for name in re.findall(r"`([a-z_]+)`", row[2])}
    named |= {name for pair in re.findall(r"`([A-Z]\w+)(?:\.(\w+))?`", page) for name in pair if name}
    assert len(named) > 20
    assert {name for name in named if not re.search(rf"^ *(?:def|class) {name}\b", source, re.MULTILINE)} == set()


# Links --------------------------------------------------------------------------------------------------------------

PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), ROOT / "assets" / "README.md"])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_lead_somewhere(page: Path):
    links = re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text("utf-8"))
    missing = [link for link in links if "://" not in link and not (page.parent / link).exists()]
    assert missing == []
