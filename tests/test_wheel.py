"""The wheel in an empty environment in another folder: program, scenes, assets, pytest plugin and types."""

from __future__ import annotations

import json
import os
import re
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
def installed(wheel: Path, tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Runs a command of the environment in a folder of its own, far from the checkout.

    Libraries are those of the environment that runs the tests, lent by a .pth file, so that nothing is downloaded.
    """
    folder = tmp_path_factory.mktemp("elsewhere")
    environment = folder / "environment"
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
    work = folder / "work"
    work.mkdir()
    variables = {key: value for key, value in os.environ.items() if key not in ("CI", "PYTHONPATH", "VIRTUAL_ENV")}

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


def test_a_scene_of_ones_own_and_its_golden_test_there(installed: Call):
    checked(installed("sandbox", "new", "beachvolley"))
    assert "Comes down" in checked(installed("sandbox", "run", "./beachvolley"))
    assert installed("python", "-m", "pytest", "beachvolley").returncode == 0
    checked(installed("python", "-c", "__import__('shutil').rmtree('beachvolley/golden')"))
    made = installed("python", "-m", "pytest", "beachvolley", "--golden-update")
    assert (made.returncode, "golden/beachvolley.png: new" in made.stdout) == (0, True)


def test_a_failure_there_shows_nothing_of_ours(installed: Call):
    checked(installed("sandbox", "new", "broken"))
    checked(installed("python", "-c", "open('broken/scene.py', 'a').write('1 / 0\\n')"))
    process = installed("sandbox", "run", "./broken")
    assert (process.returncode, process.stdout) == (1, "")
    assert process.stderr.startswith("error: your scene failed\n")
    assert "site-packages" not in process.stderr


def test_types_are_seen_there(installed: Call):
    source = (
        "import sandbox\nfrom sandbox.engine.model.setup import Ball\nreveal_type(sandbox.load('golf').name)\nBall(1)\n"
    )
    checked(installed("python", "-c", f"open('typed.py', 'w').write({source!r})"))
    # to read the libraries as well would take as long again
    options = "[mypy]\n[mypy-numpy.*,pydantic.*]\nfollow_imports = skip\nfollow_imports_for_stubs = True\n"
    checked(installed("python", "-c", f"open('mypy.ini', 'w').write({options!r})"))
    process = installed("python", "-m", "mypy", "--no-incremental", "typed.py")
    assert 'typed.py:3: note: Revealed type is "str"' in process.stdout.replace("builtins.", "")
    assert "typed.py:4: error: " in process.stdout
