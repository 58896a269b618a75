"""Seeded mutants of the program, each against its related tests: which go unnoticed?

Run ``python tests/mutants.py [--room FOLDER ...] [--number N] [--seed S] [--part I/N] [--timeout SECONDS]``; not a part
of ``make test``. Each mutant changes one place: a number, an operator, a comparison, a condition, a statement that is
left out, two arguments that are swapped. The tree is copied first; only the copy is read and mutated. Survivors are
listed with their lines; whether one is equivalent is for people to judge.
"""

from __future__ import annotations

import argparse
import ast
import os
import random
import shutil
import sys
import tempfile
from collections.abc import Iterator, Sequence
from itertools import count
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import hypothesis  # noqa: F401  (this and the next three: loaded once, for all mutants)
import numpy  # noqa: F401
import pydantic  # noqa: F401
import pymunk  # noqa: F401
import pytest

os.environ["SDL_VIDEODRIVER"] = "dummy"

ROOT = Path(__file__).resolve().parent.parent

#: The tests of each module, the quickest to notice first; those of a room's other modules under "". A name is that of a
#: file ``test_NAME.py`` in the room's own folder of tests, or in the one that it begins with.
TESTS: dict[str, dict[str, str]] = {
    "sandbox/engine": {
        "accuracy": "methods exact plain",
        "acting": "guards run methods batch bodies",
        "arc": "run exact contact batch cloth",
        "arc_rows": "batch",
        "batch": "batch methods",
        "bernstein": "bernstein contact exact",
        "bernstein_many": "bernstein batch",
        "clusters": "clusters pressed scenes/billiards",
        "heap": "heap bodies scenes/collisions golden_runs",
        "impacts": "contact cloth clusters bodies",
        "impulses": "contact cloth batch bodies",
        "lasting": "contact exact run",
        "ledger": "run cloth guards physics/rocket",
        "on_plane": "cloth ice plain",
        "outlines": "batch",
        "path": "run batch cloth",
        "plain": "plain run guards cloth bodies",
        "pressed": "pressed clusters contact scenes/billiards",
        "real_space": "heap plain bodies",
        "rubbing": "clusters scenes/billiards",
        "run": "run names batch cloth bodies",
        "setup": "guards contact run batch bodies names cloth",
        "setup_errors": "guards",
        "simulation": "contact guards cloth exact heap bodies batch golden_runs",
        "stacking": "batch lab/runs",
        "start": "contact guards bodies",
        "step_control": "methods run guards exact batch determinism physics/rocket",
        "surfaces": "contact guards plain cloth",
        "touch": "contact exact batch cloth",
        "track": "guards contact exact run bodies cloth clusters heap",
        "": "bodies heap cloth scenes/football",
    },
    "sandbox/physics": {
        "checks": "engine/guards engine/ice",
        "elementwise": "coefficients forces air engine/batch",
        "cushion": "cushion",
        "hertz": "hertz engine/clusters",
        "ice": "engine/ice",
        "plane": "engine/ice cloth",
        "impulse": "cushion engine/cloth engine/contact engine/batch",
        "coefficients": "coefficients soccer_ball air scenes/golf",
        "ballistics": "ballistics scenes/bullet",
        "court": "scenes/tennis scenes/outcomes",
        "swing": "swing scenes/tennis",
        "throw": "scenes/billiards",
        "": "{name} scenes/golf",
    },
    "sandbox/sport": {
        "": " ".join(
            ["{name}", "schemas", *(f"scenes/{file.stem[5:]}" for file in sorted(ROOT.glob("tests/scenes/test_*.py")))]
        )
    },
    "sandbox/scene": {"running": "checking", "": "scene mistakes cli"},
    "sandbox/lab": {
        "maps": "maps",
        "stress": "stress",
        "extremes": "stress",
        "tables": "tables",
        "verdicts": "stress",
        "runs": "runs sweep",
        "": "sweep trade",
        "chart": "sweep trade",
        "trade": "trade",
        "ablation": "trade",
        "reference": "trade",
        "validate": "scenes/published docs cli",
    },
    "sandbox/lab/aim": {"": "lab/aim"},
    "sandbox/workers": {"": "lab/sweep"},
    "sandbox/cli": {"lab": "lab/sweep cli lab/aim lab/trade", "": "cli"},
    "sandbox": {
        "golden": "picture/golden",
        "record": "picture/golden",
        "files": "cli lab/sweep",
        "new": "new",
        "parameters": "parameters scene cli",
        "report": "cli",
        "schema": "schemas parameters",
        "tracebacks": "mistakes cli lab/sweep",
        "units": "parameters",
        "": "{name} cli",
    },
    **{
        f"scenes/{file.parent.name}": {
            "": f"schemas scenes/{file.parent.name.replace('-', '_')} scenes/outcomes golden_runs"
        }
        for file in sorted(ROOT.glob("scenes/*/scene.py"))
    },
}

#: In s, for files that are written.
MOMENTS = count(1_000_000_000)

#: Not looked into: what holds names only, and shapes of types.
LEFT_OUT = {"__init__"}

ARITHMETIC = {ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult}
COMPARISONS = {ast.Lt: ast.GtE, ast.GtE: ast.Lt, ast.Gt: ast.LtE, ast.LtE: ast.Gt, ast.Eq: ast.NotEq, ast.NotEq: ast.Eq}


def places(tree: ast.AST) -> Iterator[tuple[ast.AST, str]]:
    """Nodes that can be changed, and how; texts, annotations and slices are left alone."""
    skipped = set()
    for node in ast.walk(tree):
        kinds = [part for name in ("annotation", "returns") if (part := getattr(node, name, None)) is not None]
        skipped.update(id(each) for kind in kinds for each in ast.walk(kind))
        if isinstance(node, ast.JoinedStr | ast.Raise):
            skipped.update(id(each) for each in ast.walk(node))
        if id(node) in skipped:
            continue
        if isinstance(node, ast.Constant) and type(node.value) in (int, float):
            yield node, "number"
        elif isinstance(node, ast.BinOp) and type(node.op) in ARITHMETIC:
            yield node, "operator"
        elif isinstance(node, ast.Compare) and type(node.ops[0]) in COMPARISONS:
            yield node, "comparison"
        elif isinstance(node, ast.BoolOp):
            yield node, "and/or"
        elif isinstance(node, ast.If | ast.IfExp | ast.While):
            yield node, "condition"
        elif isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            yield node, "sign"
        elif isinstance(node, ast.Call) and _can_be_swapped(node):
            yield node, "arguments"
        elif _can_be_left_out(node):
            yield node, "statement"


def _can_be_swapped(call: ast.Call) -> bool:
    """Whether its last two arguments differ and their order may matter."""
    name = call.func.id if isinstance(call.func, ast.Name) else ""
    return name not in ("max", "min") and len({ast.unparse(each) for each in call.args[-2:]}) == 2


def _can_be_left_out(node: ast.AST) -> bool:
    """Whether it is a statement that makes no name known."""
    if isinstance(node, ast.Assign):
        return isinstance(node.targets[0], ast.Attribute | ast.Subscript)
    return isinstance(node, ast.AugAssign) or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Call))


def changed(node: Any, how: str) -> None:
    """Change the node where it stands."""
    if how == "number":
        node.value = 1 if node.value == 0 else 0 if node.value == 1 and type(node.value) is int else node.value * 2
    elif how == "operator":
        node.op = ARITHMETIC[type(node.op)]()
    elif how == "comparison":
        node.ops[0] = COMPARISONS[type(node.ops[0])]()
    elif how == "and/or":
        node.op = ast.And() if isinstance(node.op, ast.Or) else ast.Or()
    elif how == "condition":
        node.test = ast.UnaryOp(ast.Not(), node.test)
    elif how == "sign":
        node.op = ast.UAdd()
    elif how == "arguments":
        node.args[-2:] = node.args[:-3:-1]
    elif how == "statement":
        node.__class__, node.value = ast.Expr, ast.Constant(None)


def drawn(tree: Path, rooms: Sequence[str], number: int, seed: int) -> list[tuple[str, int]]:
    """Modules and the places in them to change, each once; a room is a folder, or a module in it."""
    files = [file for folder in TESTS for file in sorted((tree / folder).glob("*.py"))]
    every = [
        (name, place)
        for file in files
        if file.stem not in LEFT_OUT and (name := file.relative_to(tree).as_posix()).startswith(tuple(rooms))
        for place in range(len(list(places(ast.parse(file.read_text("utf-8"))))))
    ]
    return random.Random(seed).sample(every, min(number, len(every)))


def mutant(source: str, place: int) -> tuple[str, str]:
    """The source with the change, and what it is."""
    tree = ast.parse(source)
    node: Any
    node, how = list(places(tree))[place]
    shown = node.test if how == "condition" else node
    before = ast.unparse(shown)
    changed(node, how)
    after = "left out" if how == "statement" else ast.unparse(node.test if how == "condition" else node)
    return ast.unparse(ast.fix_missing_locations(tree)), f"{node.lineno}  {before}  ->  {after}"


def tests_of(tree: Path, module: str) -> list[str]:
    """The files of a module's tests."""
    room, _, file = module.rpartition("/")
    stem = file.removesuffix(".py")
    names = TESTS[room].get(stem, TESTS[room].get("", "")).format(name=stem).split()
    own = room.removeprefix("sandbox").strip("/")
    found = []
    for name in names:
        folder, _, last = name.rpartition("/")
        places = (f"tests/{folder or own}/test_{last}.py", f"tests/test_{last}.py")
        found += [path for path in places if (tree / path).is_file()][:1]
    return found


def written(file: Path, source: str) -> None:
    """Write a source with a time of its own, so that nothing compiled before is taken for it."""
    file.write_text(source, "utf-8")
    moment = next(MOMENTS)
    os.utime(file, (moment, moment))


def noticed(tree: Path, module: str, source: str, timeout: float) -> bool:
    """Whether a test fails, or none ends in time, when the module has this source."""
    original = (tree / module).read_text("utf-8")
    written(tree / module, source)
    passed = pass_in(tree, tests_of(tree, module), timeout)
    written(tree / module, original)
    return not passed


def pass_in(tree: Path, tests: Sequence[str], timeout: float | None = None) -> bool:
    """Whether tests pass in a tree within ``timeout`` s."""
    process = get_context("fork").Process(target=_tested, args=(tree, tests))
    process.start()
    process.join(timeout)
    process.kill()
    process.join()
    return process.exitcode == 0


def _tested(tree: Path, tests: Sequence[str]) -> None:
    """Run the tests in a tree, and end as pytest does."""
    os.chdir(tree)
    sys.path.insert(0, str(tree))
    for stream in (1, 2):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
    loaded = "ignore::pytest.PytestAssertRewriteWarning"
    os._exit(pytest.main(["-x", "-q", "-n", "0", "-p", "no:cacheprovider", "-W", loaded, *tests]))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument(
        "--room", nargs="*", default=[""], help="folders such as scenes/golf, or modules; all if not given"
    )
    parser.add_argument("--number", type=int, default=300)
    parser.add_argument("--seed", type=int, default=18)
    parser.add_argument("--part", default="1/1", help="every N-th mutant from the I-th on: I/N")
    parser.add_argument("--timeout", type=float, default=120.0, help="s for the tests of one mutant")
    arguments = parser.parse_args()
    part, parts = map(int, arguments.part.split("/"))
    survivors = tried = 0
    with tempfile.TemporaryDirectory() as folder:
        tree = Path(folder) / "tree"
        shutil.copytree(ROOT, tree, ignore=shutil.ignore_patterns(".git", ".venv", "__pycache__", "dist"))
        chosen = drawn(tree, arguments.room, arguments.number, arguments.seed)[part - 1 :: parts]
        if not pass_in(tree, sorted({test for module, _ in chosen for test in tests_of(tree, module)})):
            sys.exit("some of their tests fail without any mutant")
        for module, place in chosen:
            source, what = mutant((tree / module).read_text("utf-8"), place)
            tried += 1
            if not noticed(tree, module, source, arguments.timeout):
                survivors += 1
                sys.stdout.write(f"survived ({survivors} of {tried})  {module}:{what}\n")
                sys.stdout.flush()
    sys.stdout.write(f"{survivors} of {tried} mutants survived\n")


if __name__ == "__main__":
    main()
