"""Seeded mutants of the program, each against the tests that call what it changes: which go unnoticed?

Run ``python tests/mutants.py [--room FOLDER ...] [--number N] [--seed S] [--part I/N] [--timeout SECONDS]``; not a part
of ``make test``. Each mutant changes one place: a number, an operator, a comparison, a condition, a statement that is
left out, two arguments that are swapped. The tree is copied first; only the copy is read and mutated. Survivors are
listed with their lines; whether one is equivalent is for people to judge.

Which functions each test calls is measured once, by one run of all tests, and kept in ``out/reach.json``: delete it
when tests or functions have new names. What tests start in other processes is not seen.
"""

from __future__ import annotations

import argparse
import ast
import json
import os
import random
import shutil
import signal
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import accumulate, count
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

#: Where each test's functions are recorded; measured when it is not there.
REACH = ROOT / "out" / "reach.json"

#: In s, for files that are written.
MOMENTS = count(1_000_000_000)

#: Of each test its time in s, and the names of the functions it calls, by module.
Reach = dict[str, tuple[float, dict[str, list[str]]]]

#: Not looked into: what holds names only, and shapes of types.
LEFT_OUT = {"__init__"}

#: Tests that compare all that is seen of something with what is kept of it.
KEPT = ("scenes/", "tests/test_printed.py", "tests/picture/test_other_pictures.py",
        "tests/window/test_look.py")  # fmt: skip

#: Tests of what modules declare when they are loaded, which calls no function.
DECLARED = ("tests/test_schemas.py::test_a_schema_is_in", "tests/test_printed.py::test_controls", *KEPT[:1])

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
    files = [file for folder in ("sandbox", "scenes") for file in sorted((tree / folder).rglob("*.py"))]
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


def function_at(source: str, place: int) -> str:
    """The name, as Python qualifies it, of the innermost function around a place; "" outside of all."""
    tree = ast.parse(source)
    names: dict[int, str] = {}

    def visit(node: ast.AST, prefix: str, function: str) -> None:
        names[id(node)] = function
        if isinstance(node, ast.ClassDef):
            prefix += f"{node.name}."
        elif isinstance(node, ast.FunctionDef):
            function, prefix = prefix + node.name, f"{prefix}{node.name}.<locals>."
        for child in ast.iter_child_nodes(node):
            visit(child, prefix, function)

    visit(tree, "", "")
    return names[id(list(places(tree))[place][0])]


def tests_of(reach: Reach, module: str, function: str, most: float) -> list[str]:
    """The tests that call a function of a module, the quickest first: as many as together take half of ``most`` s, and
    for as long those of KEPT. For "" those that call any of its functions, and of DECLARED those of its scene."""
    by_time = sorted(reach, key=lambda test: reach[test][0])
    called = [
        test for test in by_time if module in reach[test][1] and (not function or function in reach[test][1][module])
    ]
    declared = [
        test
        for test in by_time
        if not function
        and test.startswith(DECLARED)
        and test.endswith((f"[{Path(module).parent.name}]", f"::{Path(module).parent.name}"))
    ]
    usual = _within(0.5 * most, reach, called)
    return list(
        dict.fromkeys([*usual, *declared, *_within(0.5 * most, reach, [t for t in called if t.startswith(KEPT)])])
    )


def _within(most: float, reach: Reach, tests: Sequence[str]) -> list[str]:
    """As many of these tests, from the first on, as together take ``most`` s at most."""
    together = list(accumulate(reach[test][0] for test in tests))
    return [test for test, seconds in zip(tests, together, strict=True) if seconds <= most]


class Recorder:
    """A plugin of pytest: seconds and called functions of each test that passes."""

    def __init__(self, tree: Path) -> None:
        self.reach: Reach = {}
        self._tree = str(tree)
        self._called: set[Any] = set()

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self._called.clear()
        begun = time.process_time()
        sys.settrace(lambda frame, *_: self._called.add(frame.f_code))
        yield
        sys.settrace(None)
        called: dict[str, list[str]] = {}
        for code in self._called:
            if code.co_filename.startswith(self._tree):
                called.setdefault(os.path.relpath(code.co_filename, self._tree), []).append(code.co_qualname)
        self.reach[item.nodeid] = time.process_time() - begun, called

    def pytest_sessionfinish(self, exitstatus: int) -> None:
        if exitstatus:
            return
        REACH.parent.mkdir(exist_ok=True)
        REACH.write_text(json.dumps(self.reach), "utf-8")


def written(file: Path, source: str) -> None:
    """Write a source with a time of its own, so that nothing compiled before is taken for it."""
    file.write_text(source, "utf-8")
    moment = next(MOMENTS)
    os.utime(file, (moment, moment))


def noticed(tree: Path, module: str, source: str, tests: Sequence[str], timeout: float) -> bool:
    """Whether a test fails, or none ends within ``timeout`` s, when the module has this source."""
    original = (tree / module).read_text("utf-8")
    written(tree / module, source)
    code = exit_code(tree, tests, timeout)
    written(tree / module, original)
    return code != 0


def exit_code(tree: Path, arguments: Sequence[str], timeout: float | None = None, plugins: Sequence[Any] = ()) -> int:
    """Pytest's in a tree, or another than 0 if it does not end within ``timeout`` s."""
    process = get_context("fork").Process(target=_tested, args=(tree, arguments, plugins))
    process.start()
    process.join(timeout)
    assert process.pid
    with suppress(ProcessLookupError):  # its workers, too
        os.killpg(process.pid, signal.SIGKILL)
    process.join()
    return process.exitcode or 0


def _tested(tree: Path, arguments: Sequence[str], plugins: Sequence[Any]) -> None:
    """Run pytest in a tree, and end as it does."""
    os.setsid()
    os.chdir(tree)
    sys.path.insert(0, str(tree))
    for stream in (1, 2):
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream)
    loaded = "ignore::pytest.PytestAssertRewriteWarning"
    os._exit(pytest.main(["-x", "-q", "-n", "0", "-p", "no:cacheprovider", "-W", loaded, *arguments], [*plugins]))


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
        if not REACH.exists() and exit_code(tree, ["tests", "scenes"], plugins=[Recorder(tree)]):
            sys.exit("some tests fail without any mutant")
        reach = json.loads(REACH.read_text("utf-8"))
        chosen = []
        for module, place in drawn(tree, arguments.room, arguments.number, arguments.seed)[part - 1 :: parts]:
            source = (tree / module).read_text("utf-8")
            tests = tests_of(reach, module, function_at(source, place), arguments.timeout / 3.0)
            chosen.append((module, *mutant(source, place), tests))
        if exit_code(tree, sorted({test for *_, tests in chosen for test in tests})):
            sys.exit(f"some of their tests fail without any mutant; if they have new names, delete {REACH}")
        for module, source, what, tests in chosen:
            tried += 1
            if not tests or not noticed(tree, module, source, tests, arguments.timeout):
                survivors += 1
                by = f"{len(tests)} tests" if tests else "no test calls it"
                sys.stdout.write(f"survived ({survivors} of {tried}; {by})  {module}:{what}\n")
                sys.stdout.flush()
    sys.stdout.write(f"{survivors} of {tried} mutants survived\n")


if __name__ == "__main__":
    main()
