"""Which package may import which, by the tables of CONTRIBUTING.md; and what else holds for all modules."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from collections.abc import Iterator
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parent.parent
SCENES = sorted(path.parent.name for path in (ROOT / "scenes").glob("*/scene.py"))


def layers(text: str) -> tuple[dict[str, int], dict[str, set[str]]]:
    """The rows of the tables of core and extensions: the place of each package or module, from the lowest, and those
    that may import each library."""
    places: dict[str, int] = {}
    owners: dict[str, set[str]] = {}
    rows = text[text.index("| core |") : text.index("| beside ")].splitlines()
    for place, row in enumerate(row for row in rows if row.startswith("| `")):
        names, _, libraries = (re.findall(r"`([^`]+)`", cell) for cell in row.split("|")[1:4])
        assert not places.keys() & names, f"{names}: has two places"
        places |= dict.fromkeys(names, place)
        for library in libraries:
            owners.setdefault(library, set()).update(names)
    return places, owners


PLACES, OWNERS = layers((ROOT / "CONTRIBUTING.md").read_text("utf-8"))


@cache
def read(source: str) -> list[ast.AST]:
    """The imports, constants, functions and conditions of a module."""
    kinds = ast.Import | ast.ImportFrom | ast.Constant | ast.FunctionDef | ast.AsyncFunctionDef | ast.If
    return [node for node in ast.walk(ast.parse(source)) if isinstance(node, kinds)]


def imported(source: str, package: str) -> Iterator[str]:
    """Dotted names of all modules that a module imports or names anywhere in it; ``package`` resolves relative
    imports."""
    for node in read(source):
        if isinstance(node, ast.Import | ast.ImportFrom):
            yield from imports_of(node, package)
        elif isinstance(node, ast.Constant) and is_module(node.value):
            yield node.value  # for import_module


def is_module(value: object) -> bool:
    """True for the name of a module of the package, and not for another name, such as ``sandbox.stdout``."""
    known = isinstance(value, str) and value.startswith("sandbox.") and re.fullmatch(r"sandbox(\.\w+)+", value)
    return bool(known) and layer_of(str(value)) != "__init__"


def imports_of(node: ast.Import | ast.ImportFrom, package: str) -> Iterator[str]:
    """Dotted names of what a statement imports."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
        return
    base = package.split(".")[: len(package.split(".")) + 1 - node.level] if node.level else []
    module = ".".join([*base, *([node.module] if node.module else [])])
    yield from (f"{module}.{alias.name}" for alias in node.names)


def layer_of(module: str) -> str:
    """``"lab/fit"`` for ``sandbox.lab.fit.squares``, ``"lab"`` for ``sandbox.lab.axes``; ``"__init__"`` for a name of
    ``sandbox`` itself, such as ``sandbox.load``."""
    parts = module.split(".")[1:]
    return next((name for name in ("/".join(parts[:2]), "/".join(parts[:1])) if name in PLACES), "__init__")


def broken_rules(source: str, where: str, own: str) -> list[str]:
    """What a module of the layer ``own`` imports or says that it must not."""
    broken = []
    for module in imported(source, f"sandbox.{own}".replace("/", ".")):
        top = module.partition(".")[0]
        if own not in OWNERS.get(top, {own}):
            broken.append(f"{where}: {own} imports {top}")
        if top in ("scenes", "sandbox_scenes", "tests"):
            broken.append(f"{where}: imports {module}")
        if top == "sandbox" and module != "sandbox.__version__" and PLACES[layer_of(module)] > PLACES[own]:
            broken.append(f"{where}: {own} imports {module}")
    broken += [
        f"{where}, line {node.lineno}: names the scene {node.value}"
        for node in read(source)
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and node.value.partition("/")[0] in SCENES
    ]
    return broken


@cache
def modules() -> dict[str, Path]:
    """All modules of the package by their dotted names."""
    paths = {".".join(path.relative_to(ROOT).with_suffix("").parts): path for path in (ROOT / "sandbox").rglob("*.py")}
    return {
        name.removesuffix(".__init__") if name != "sandbox.__init__" else name: path for name, path in paths.items()
    }


def test_modules_look_only_downwards():
    broken = []
    for name, path in modules().items():
        own = layer_of(name)
        assert own != "__init__" or name == "sandbox.__init__", f"{path}: CONTRIBUTING.md has no place for it"
        broken += broken_rules(path.read_text("utf-8"), str(path.relative_to(ROOT)), own)
    assert broken == []
    assert {layer_of(name) for name in modules()} == PLACES.keys()


def test_the_list_of_layers_is_read():
    text = "| core | what | libraries |\n|---|---|---|\n| `b`, `a/c` | of `d` | `pymunk` |\n\n| `e` | | |\n| beside |"
    assert layers(text) == ({"b": 0, "a/c": 0, "e": 1}, {"pymunk": {"b", "a/c"}})
    with pytest.raises(AssertionError, match="two places"):
        layers(text.replace("`e`", "`b`"))
    assert PLACES["physics"] < PLACES["engine"] < PLACES["sport"] < PLACES["scene"] < PLACES["cli"] < PLACES["tasks"]


@cache
def imports(path: Path) -> tuple[list[str], list[tuple[int, str]]]:
    """What a module imports as it is imported itself, and late, in functions, with the line; without types."""
    nodes = read(path.read_text("utf-8"))
    functions = [node for node in nodes if isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef)]
    typing = [node for node in nodes if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"]
    late = {line for node in functions for line in range(node.lineno, node.end_lineno + 1)}
    unread = {line for node in typing for line in range(node.lineno, node.body[-1].end_lineno + 1)}
    found = [node for node in nodes if isinstance(node, ast.Import | ast.ImportFrom) and node.lineno not in unread]
    named = [(node.lineno, name) for node in found for name in imports_of(node, "sandbox")]
    return [name for line, name in named if line not in late], [(line, name) for line, name in named if line in late]


@cache
def libraries(name: str) -> frozenset[str]:
    """The libraries that come with a module, or a name in it, by its own early imports and theirs."""
    seen, waiting, found = set(), [name], set()
    while waiting:
        parts = waiting.pop().split(".")
        if parts[0] != "sandbox":
            found |= {parts[0]} - sys.stdlib_module_names
        for inner in (".".join(parts[:end]) for end in range(2, len(parts) + 1)):
            if inner in modules() and inner not in seen:
                seen.add(inner)
                waiting += imports(modules()[inner])[0]
    return frozenset(found)


def is_for_the_start(name: str, path: Path, late: str) -> bool:
    """True if a late import saves time at the start of a program: where commands are found, where a package opens, in
    the plugin that each session of pytest loads; elsewhere if it spares a library."""
    start = {PLACES["cli"], PLACES["golden"]}
    starts = PLACES[layer_of(name)] in start or path.name in ("__init__.py", "command.py")
    return starts or not late.startswith("sandbox.") or bool(libraries(late) - libraries(name))


def test_late_imports_are_for_the_time_to_start():
    late = [(name, path, *found) for name, path in modules().items() for found in imports(path)[1]]
    assert len(late) > 100
    assert [
        f"{path.relative_to(ROOT)}, line {line}: imports {module} late"
        for name, path, line, module in late
        if not is_for_the_start(name, path, module)
    ] == []


@cache
def offered() -> dict[str, str]:
    """What ``sandbox.kit`` offers by name, and where it comes from: ``sandbox.kit.Ball``, ``sandbox.engine...Ball``."""
    files = (ROOT / "sandbox" / "kit.py", ROOT / "sandbox" / "picture" / "views.py")
    sources = [file.read_text("utf-8") for file in files]
    homes = [module for source in sources for module in imported(source, "sandbox") if module.startswith("sandbox.")]
    return {f"sandbox.kit.{home.rpartition('.')[2]}": home for home in homes}


def through_kit(source: str) -> str:
    """The source of a scene with the imports from ``sandbox.kit`` as those from where the names come from."""
    homes = offered()
    named = [module for module in imported(source, "itself") if module.startswith("sandbox.kit.")]
    unknown = [module for module in named if module not in homes]
    assert unknown == []
    kept = [node for node in read(source) if isinstance(node, ast.ImportFrom) and node.module == "sandbox.kit"]
    lines = source.splitlines()
    for node in kept:
        lines[node.lineno - 1 : node.end_lineno] = [""] * (node.end_lineno - node.lineno + 1)
    return "\n".join([*lines, *(f"import {homes[module]}" for module in named)])


def used_by_scene(folder: Path) -> set[str]:
    """Names of the modules of a scene that its scene.py imports, which must do without pygame as it does."""
    names, waiting = set(), ["__init__", "scene"]
    while waiting:
        name = waiting.pop()
        file = folder / f"{name}.py"
        if name not in names and file.is_file():
            names.add(name)
            modules = imported(file.read_text("utf-8"), "itself")
            waiting += [module.split(".")[1] for module in modules if module.startswith("itself.")]
    return names


def test_scenes_use_what_a_scene_may():
    broken = []
    for path in (path for path in sorted((ROOT / "scenes").rglob("*.py")) if not path.name.startswith("test_")):
        game, source = path.parent.name == "games", through_kit(path.read_text("utf-8"))
        scene = path.parent == ROOT / "scenes" or path.stem in used_by_scene(path.parent)
        source = source.replace("from ..", "from .") if game else source  # of its scene
        found = broken_rules(source, str(path.relative_to(ROOT)), "scene" if scene or game else "picture")
        broken += [line for line in found if scene or "imports sandbox.tasks.match." not in line]  # rules of a game
    others = tuple(f"imports sandbox.{name.replace('-', '_')}." for name in SCENES)  # from ..soccer.ball: one sport
    assert [line for line in broken if "names the scene" not in line and not any(o in line for o in others)] == []


def test_a_scene_takes_from_the_kit_what_it_may():
    assert broken_rules(through_kit("from sandbox.kit import Ball, Run, fact_from"), "here", "scene") == []
    source = "from sandbox.kit import (\n    Ball,\n    SideView,\n)"
    assert broken_rules(through_kit(source), "here", "scene") == ["here: scene imports sandbox.picture.side.SideView"]
    assert broken_rules(through_kit(source), "here", "picture") == []


def past_kit(source: str) -> list[str]:
    """The names that a scene takes from where they are defined, though the kit has them."""
    homes = set(offered().values())
    return [module for module in imported(source, "itself") if module in homes]


def test_scenes_take_from_the_kit_what_it_has():
    paths = [path for path in (ROOT / "scenes").glob("*/*.py") if path.stem != "__init__"]
    assert {str(path): found for path in paths if (found := past_kit(path.read_text("utf-8")))} == {}
    assert past_kit("from sandbox.engine.model.ball import Ball, kinetic") == ["sandbox.engine.model.ball.Ball"]
    assert len(paths) > 40


def test_the_kit_does_without_pygame_until_a_picture_needs_it():
    code = "import sys, sandbox.kit; assert 'pygame' not in sys.modules; sandbox.kit.SideView; sys.modules['pygame']"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


@pytest.mark.parametrize(
    ("own", "source"),
    [
        ("physics", "from sandbox.engine import run"),
        ("scene", "from sandbox.kit import Ball"),  # the package itself
        ("physics", "from ..engine import run"),
        ("physics", "import sandbox.parameters"),
        ("engine", "def late():\n    from sandbox.scene import load"),
        ("engine", "import sandbox"),
        ("engine", "import_module('sandbox.lab.trade')"),
        ("engine", "import_module('sandbox.page.notebook')"),
        ("scene", "import_module('sandbox.page.notebook')"),
        ("lab", "import_module('sandbox.page.notebook')"),
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
        ("cli", "from sandbox.window.app import play"),
        ("lab", "from sandbox.lab.fit import fit"),
        ("cli", "import sandbox"),
    ],
)
def test_the_rules_can_be_broken(own: str, source: str):
    assert len(broken_rules(source, "here", own)) >= 1


@pytest.mark.parametrize(
    ("own", "source"),
    [
        ("engine", "from sandbox.physics.integrators import rk4\nfrom sandbox.errors import RunError\nimport pymunk"),
        ("picture", "from sandbox.scene import load\nimport pygame"),
        ("scene", "from sandbox import parameters, resources"),
        ("cli", "from sandbox import __version__, entries"),
    ],
)
def test_the_rules_allow_what_they_should(own: str, source: str):
    assert broken_rules(source, "here", own) == []


#: The packages of the engine: a module may import from its own and from those before. Modules beside them, such as
#: ``simulation``, stand between ``heap`` and ``many``; ``__init__`` is above all.
ENGINE = ["model", "paths", "contact", "kernel", "motion", "impact", "heap", "", "many", "__init__"]


def engine_modules() -> dict[str, set[str]]:
    """Each module of the engine, as ``motion/on_plane``, and those of the engine that it imports, late or for types."""
    engine = ROOT / "sandbox" / "engine"
    names = {str(path.relative_to(engine).with_suffix("")): path for path in engine.rglob("*.py")}
    return {
        name: {
            "/".join(parts[: length + 1])
            for module in imported(path.read_text("utf-8"), "sandbox.engine")
            if module.startswith("sandbox.engine.")
            for parts in [module.split(".")[2:]]
            for length in range(len(parts))
            if "/".join(parts[: length + 1]) in names
        }
        for name, path in names.items()
    }


def test_packages_of_the_engine_look_only_downwards():
    def floor(name: str) -> int:
        return ENGINE.index(name if name == "__init__" else name.rpartition("/")[0])

    modules = engine_modules()
    assert {name.partition("/")[0] for name in modules if "/" in name} == {name for name in ENGINE[:-1] if name}
    upward = [
        f"{name} imports {other}" for name, others in modules.items() for other in others if floor(other) > floor(name)
    ]
    assert upward == []


def test_no_two_modules_of_the_engine_need_each_other():
    """Not even for types: what happened (run) knows what was set up, and not the other way round."""
    order = list(TopologicalSorter(engine_modules()).static_order())  # raises CycleError, which names the circle
    assert (
        order.index("model/event") < order.index("model/setup") < order.index("paths/run") < order.index("simulation")
    )


def is_hard_to_follow(node: ast.AST) -> bool:
    """True for Python from strings, and for coroutines."""
    named = isinstance(node, ast.Name) and node.id in ("exec", "eval", "compile")
    sent = isinstance(node, ast.Attribute) and node.attr == "send"
    return named or sent or isinstance(node, ast.YieldFrom)


def test_engine_and_physics_have_no_written_code_or_coroutines():
    found = [
        f"{path.relative_to(ROOT)}, line {getattr(node, 'lineno', 0)}"
        for package in ("engine", "physics")
        for path in sorted((ROOT / "sandbox" / package).rglob("*.py"))
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if is_hard_to_follow(node)
    ]
    assert found == []
    for source in ("exec('x = 1')", "def many():\n    yield from range(3)", "task.send(None)"):
        assert any(map(is_hard_to_follow, ast.walk(ast.parse(source))))


def test_no_module_of_the_engine_has_more_than_400_lines():
    lines = {path: len(path.read_text("utf-8").splitlines()) for path in (ROOT / "sandbox" / "engine").rglob("*.py")}
    assert [str(path.relative_to(ROOT)) for path, count in lines.items() if count > 400] == []
    assert len(lines) > 40


def test_names_of_tests_have_at_most_60_characters():
    """A name that says one behaviour is short; ``pytest -k`` finds it."""
    longer = [
        f"{path.relative_to(ROOT)}: {name}"
        for folder in ("tests", "template", "template_above")
        for path in sorted((ROOT / folder).rglob("*.py"))
        for name in re.findall(r"^ *def (test_\w+)", path.read_text("utf-8"), re.MULTILINE)
        if len(name) > 60
    ]
    assert longer == []
