"""The wheel in an empty environment in another folder: program, scenes, assets, pytest plugin and types."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import venv
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
PIP = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]

Call = Callable[..., "subprocess.CompletedProcess[str]"]


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Built as ``make wheel`` builds it, without a network."""
    folder = tmp_path_factory.mktemp("dist")
    command = [*PIP, "wheel", "--no-deps", "--no-build-isolation", "--no-index", "--wheel-dir", str(folder), str(ROOT)]
    subprocess.run(command, check=True, capture_output=True, text=True)
    (built,) = folder.glob("*.whl")
    return built


@pytest.fixture(scope="module")
def work(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder far from the checkout."""
    return tmp_path_factory.mktemp("elsewhere")


@pytest.fixture(scope="module")
def installed(wheel: Path, work: Path, tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Runs a command of the environment in ``work``.

    Libraries are those of the environment that runs the tests, lent by a .pth file, so that nothing is downloaded.
    """
    environment = tmp_path_factory.mktemp("elsewhere") / "environment"
    venv.create(environment, with_pip=False)
    python = environment / "bin" / "python"
    subprocess.run(
        [*PIP, "--python", str(python), "install", "--no-deps", "--no-index", "--no-compile", str(wheel)],
        check=True,
        capture_output=True,
        text=True,
    )
    (site,) = environment.glob("lib/python*/site-packages")
    (site / "lent.pth").write_text(sysconfig.get_path("purelib") + "\n")
    others = ("CI", "PYTHONPATH", "PYTHONDONTWRITEBYTECODE", "VIRTUAL_ENV")  # compiled once, as for a user
    variables = {key: value for key, value in os.environ.items() if key not in others}

    def call(program: str, *args: str) -> subprocess.CompletedProcess[str]:
        command = [str(environment / "bin" / program), *args]
        return subprocess.run(command, cwd=work, env=variables, capture_output=True, text=True)

    return call


def checked(process: subprocess.CompletedProcess[str]) -> str:
    assert (process.returncode, process.stderr) == (0, "")
    return process.stdout


def test_the_wheel_holds_what_it_should(wheel: Path):
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        metadata = next(archive.read(name).decode() for name in names if name.endswith("METADATA"))
    tops = {name.partition("/")[0] for name in names}
    assert {top.partition("-")[0] for top in tops} == {"sandbox", "sports_sandbox"}
    for name in (
        "py.typed",
        "golden.py",
        "scenes/golf/golf.toml",
        "scenes/golf/presets/driver.toml",
        "template/scene.py",
        "template_above/scene.py",
    ):
        assert f"sandbox/{name}" in names
    assert "sandbox/scenes/golf/golf.schema.json" in names
    assert any(name.endswith(".ttf") for name in names)
    assert not [name for name in names if "__pycache__" in name or name.startswith("tests")]
    assert wheel.stat().st_size < 3_000_000
    for extra in ("lab", "cluster"):
        assert f"Provides-Extra: {extra}\n" in metadata
    assert "Requires-Python: >=3.11\n" in metadata
    needs = [line.partition(";")[0] for line in metadata.splitlines() if line.startswith("Requires-Dist")]
    assert [
        need for need in needs if "<" not in need and "sports-sandbox[" not in need
    ] == []  # bounded to what is tested


def test_every_shipped_file_is_in_the_wheel(wheel: Path):
    listed = subprocess.run(
        ["git", "ls-files", "scenes", "assets", "template", "template_above"], cwd=ROOT, capture_output=True, text=True
    )
    if listed.returncode != 0:
        pytest.skip("not a git checkout")
    with zipfile.ZipFile(wheel) as archive:
        names = set(archive.namelist())
    of_tests = re.compile(r"scenes/[\w-]+/(golden/|shots\.toml)")
    shipped = {file for file in listed.stdout.splitlines() if not of_tests.match(file)}
    assert shipped - {name.removeprefix("sandbox/") for name in names} == set()
    assert not any("/golden/" in name for name in names)


def test_golf_runs_there(installed: Call):
    where = checked(installed("python", "-c", "import sandbox; print(sandbox.__file__)"))
    assert "elsewhere" in where
    report = json.loads(checked(installed("sandbox", "run", "golf", "--json", "--poster", "golf.png")))
    assert report["result"]["carry"] > 200
    size = checked(installed("python", "-c", "from PIL import Image; print(*Image.open('golf.png').size)"))
    assert size == "1280 720\n"


def test_all_scenes_are_there(installed: Call):
    listed = {line.split()[0] for line in checked(installed("sandbox", "list")).splitlines()}
    here = {path.parent.name for path in ROOT.glob("scenes/*/scene.py")}
    presets = {f"{path.parent.parent.name}/{path.stem}" for path in ROOT.glob("scenes/*/presets/*.toml")}
    assert here | presets <= listed


def test_a_scene_of_ones_own_and_its_golden_test_there(installed: Call, work: Path):
    checked(installed("sandbox", "new", "boules"))
    assert "Comes down" in checked(installed("sandbox", "run", "./boules"))
    assert installed("python", "-m", "pytest", "boules").returncode == 0
    shutil.rmtree(work / "boules" / "golden")
    made = installed("python", "-m", "pytest", "boules", "--golden-update")
    assert (made.returncode, "golden/boules.png: new" in made.stdout) == (0, True)


def test_a_failure_there_shows_nothing_of_ours(installed: Call, work: Path):
    checked(installed("sandbox", "new", "broken"))
    with (work / "broken" / "scene.py").open("a") as file:
        file.write("1 / 0\n")
    process = installed("sandbox", "run", "./broken")
    assert (process.returncode, process.stdout) == (1, "")
    assert process.stderr.startswith("error: your scene failed\n")
    assert "site-packages" not in process.stderr


def test_types_are_seen_there_and_pass_strictly(installed: Call, work: Path):
    """In the scenes of the guide and of the templates, in the code of docs/python.md, and in code that is wrong."""
    guide, page = ((ROOT / "docs" / f"{name}.md").read_text("utf-8") for name in ("your-own-scene", "python"))
    blocks = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    wrong = (
        "import sandbox\n"
        "from sandbox import Bal\n"
        "sandbox.simulate(3)\n"
        "carry: int = sandbox.simulate(sandbox.load('golf')).state('ball', 0.0).x\n"
        "reveal_type(sandbox.load('golf').name)\n"
    )
    written = {"page.py": "\n".join(blocks), "wrong.py": wrong}
    for name, text in re.findall(r"^```python\n# (\S+)\n(.*?)^```$", guide, re.MULTILINE | re.DOTALL):
        written[name] = written.get(name, "") + text
    assert {"beachvolley/scene.py", "beachvolley/picture.py"} <= written.keys()
    (work / "beachvolley").mkdir()
    for name, text in written.items():
        (work / name).write_text(text, "utf-8")
    checked(installed("sandbox", "new", "side"))
    checked(installed("sandbox", "new", "above", "--from-above"))
    given = [word for name in ("beachvolley", "side", "above", "page", "wrong") for word in ("-p", name)]
    process = installed("python", "-m", "mypy", "--strict", "--no-incremental", *given)
    found = re.findall(r"^(\S+?):(\d+): (error|note: Revealed.*)", process.stdout, re.MULTILINE)
    revealed = found.pop()
    assert found == [("wrong.py", line, "error") for line in ("2", "3", "4")], process.stdout
    assert revealed[2].replace("builtins.", "") == 'note: Revealed type is "str"'
