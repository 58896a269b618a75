"""Which room may import which: ``physics <- engine <- scene <- picture, lab, workers <- window <- cli``."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent

#: A module may import from its own room and from rooms of a lower floor. ``errors`` is open to all.
FLOORS = {
    "errors": 0,
    "physics": 1,
    "workers": 1,
    "engine": 2,
    "text": 3,
    "tracebacks": 3,
    "units": 3,
    "files": 3,
    "resources": 3,
    "parameters": 3,
    "schema": 3,
    "toml": 3,
    "sport": 3,
    "scene": 3,
    "picture": 4,
    "lab": 4,
    "record": 4,
    "page": 5,
    "golden": 6,
    "window": 5,
    "progress": 6,
    "report": 6,
    "cli": 6,
    "__main__": 6,
    "new": 6,
    "": 6,  # sandbox/__init__.py
}
SHARED_FLOORS = (3, 6)  # single modules, which may import each other

#: Libraries that only some rooms may import; scenes/*/picture.py counts as picture.
OWNERS = {"pymunk": {"engine"}, "pygame": {"picture", "window", "golden"}, "PIL": {"picture", "page", "golden"}}

#: What runs, scenes and results show themselves with is above them: asked for by name, on first use. Nothing else is.
SHOWN_WITH = {"sandbox.page.notebook", "sandbox.picture.plain", "sandbox.picture.views"}

SCENES = sorted(path.parent.name for path in (ROOT / "scenes").glob("*/scene.py"))


def imported(tree: ast.AST, package: str) -> Iterator[str]:
    """Dotted names of all modules that a module imports or names anywhere in it; ``package`` resolves relative
    imports."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
            module = ".".join([*base, *([node.module] if node.module else [])])
            yield from (f"{module}.{alias.name}" for alias in node.names)
        elif isinstance(node, ast.Constant) and str(node.value).startswith("sandbox.") and room(str(node.value)):
            yield from {str(node.value)} - SHOWN_WITH  # for import_module


def room(module: str) -> str:
    """``"engine"`` for ``sandbox.engine.run``; ``""`` for ``sandbox`` itself."""
    name = [*module.split("."), ""][1]
    return name if name in FLOORS else ""  # sandbox.load is sandbox/__init__.py


def broken_rules(source: str, where: str, own: str) -> list[str]:
    """What a module of the room ``own`` imports or says that it must not."""
    tree = ast.parse(source)
    broken = []
    for module in imported(tree, f"sandbox.{own}"):
        top = module.partition(".")[0]
        if own not in OWNERS.get(top, {own}):
            broken.append(f"{where}: {own} imports {top}")
        if top in ("scenes", "sandbox_scenes", "tests"):
            broken.append(f"{where}: imports {module}")
        if top == "sandbox":
            other = room(module)
            neighbours = FLOORS[own] == FLOORS[other] and (own == other or FLOORS[own] in SHARED_FLOORS)
            if not neighbours and FLOORS[other] >= FLOORS[own]:
                broken.append(f"{where}: {own} imports {module}")
    broken += [
        f"{where}, line {node.lineno}: names the scene {node.value}"
        for node in ast.walk(tree)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.partition("/")[0] in SCENES
    ]
    return broken


def test_modules_look_only_downstairs():
    broken = []
    for path in sorted((ROOT / "sandbox").rglob("*.py")):
        own = path.relative_to(ROOT / "sandbox").with_suffix("").parts[0].replace("__init__", "")
        assert own in FLOORS, f"{path}: a new room needs its floor in FLOORS"
        broken += broken_rules(path.read_text("utf-8"), str(path.relative_to(ROOT)), own)
    assert broken == []


def used_by_scene(folder: Path) -> set[str]:
    """Names of the modules of a scene that its scene.py imports, which must do without pygame as it does."""
    names, waiting = set(), ["__init__", "scene"]
    while waiting:
        name = waiting.pop()
        file = folder / f"{name}.py"
        if name not in names and file.is_file():
            names.add(name)
            modules = imported(ast.parse(file.read_text("utf-8")), "itself")
            waiting += [module.split(".")[1] for module in modules if module.startswith("itself.")]
    return names


def test_scenes_use_what_a_scene_may():
    broken = []
    for path in sorted((ROOT / "scenes").rglob("*.py")):
        own = "scene" if path.parent == ROOT / "scenes" or path.stem in used_by_scene(path.parent) else "picture"
        broken += broken_rules(path.read_text("utf-8"), str(path.relative_to(ROOT)), own)
    others = tuple(f"imports sandbox.{name.replace('-', '_')}." for name in SCENES)  # from ..soccer.ball: one sport
    assert [line for line in broken if "names the scene" not in line and not any(o in line for o in others)] == []


@pytest.mark.parametrize(
    ("own", "source"),
    [
        ("physics", "from sandbox.engine import run"),
        ("physics", "from ..engine import run"),
        ("physics", "import sandbox.parameters"),
        ("engine", "def late():\n    from sandbox.scene import load"),
        ("engine", "import sandbox"),
        ("engine", "import_module('sandbox.lab.trade')"),
        ("scene", "from sandbox.picture.camera import Camera"),
        ("scene", "import pymunk"),
        ("scene", "from PIL import Image"),
        ("picture", "from pymunk import Space"),
        ("picture", "import sandbox.lab"),
        ("lab", "import pygame"),
        ("workers", "from sandbox.lab.plan import Plan"),
        ("errors", "import sandbox.units"),
        ("cli", "import scenes.golf.scene"),
        ("cli", "load('golf')"),
        ("cli", "load('golf/driver')"),
    ],
)
def test_the_rules_can_be_broken(own: str, source: str):
    assert len(broken_rules(source, "here", own)) >= 1


@pytest.mark.parametrize(
    ("own", "source"),
    [
        ("engine", "from sandbox.physics.integrators import rk4\nfrom sandbox.errors import RunError\nimport pymunk"),
        ("picture", "from sandbox.scene import load\nimport pygame"),
        ("engine", "import_module('sandbox.page.notebook')"),
        ("scene", "from sandbox import parameters, resources"),
        ("cli", "import sandbox\nfrom sandbox import report"),
    ],
)
def test_the_rules_allow_what_they_should(own: str, source: str):
    assert broken_rules(source, "here", own) == []


def test_no_two_modules_of_the_engine_need_each_other():
    """Not even for types: what happened (run) knows what was set up, and not the other way round."""
    engine = ROOT / "sandbox" / "engine"
    needs = {
        path.stem: {
            name.split(".")[2]
            for name in imported(ast.parse(path.read_text("utf-8")), "sandbox.engine")
            if name.startswith("sandbox.engine.") and (engine / f"{name.split('.')[2]}.py").is_file()
        }
        for path in engine.glob("*.py")
        if path.stem != "__init__"
    }
    order = list(TopologicalSorter(needs).static_order())  # raises CycleError, which names the circle
    assert order.index("event") < order.index("setup") < order.index("run") < order.index("simulation")
