"""Seeded mutants of sandbox/engine and sandbox/physics, each against its related tests: which go unnoticed?

Run ``python tests/mutants.py [--number N] [--seed S] [--part I/N] [--timeout SECONDS]``; not a part of ``make test``.
Each mutant changes one place: a number, an operator, a comparison, a condition. A copy of the tree is mutated, never
the tree itself. Survivors are listed with their lines; whether one is equivalent is for people to judge.
"""

from __future__ import annotations

import argparse
import ast
import copy
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent

#: Tests of each module, the quickest to notice first; ``tests/physics/test_NAME.py`` where there is no entry.
RELATED = {
    "accuracy": "methods exact plain",
    "acting": "guards run methods batch",
    "arc": "run exact contact batch",
    "arc_rows": "batch",
    "batch": "batch methods",
    "bernstein": "bernstein contact exact",
    "bernstein_many": "batch",
    "setup_errors": "guards",
    "clusters": "clusters",
    "contacts": "contact cloth batch",
    "impacts": "contact cloth clusters",
    "lanes": "batch",
    "lasting": "contact exact run",
    "ledger": "run cloth guards",
    "motion": "guards contact exact run",
    "on_cloth": "cloth plain",
    "outlines": "batch",
    "plain": "plain run guards cloth",
    "pressed": "clusters",
    "run": "run batch cloth",
    "setup": "guards contact run batch",
    "simulation": "contact guards cloth exact",
    "stacking": "batch",
    "step_control": "methods run guards exact batch",
    "surfaces": "contact guards plain",
    "touch": "contact exact batch",
    "track": "contact cloth clusters",
    "elementwise": "../physics/test_coefficients ../physics/test_forces ../physics/test_air batch",
    "hertz": "clusters",
}

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


def drawn(number: int, seed: int) -> list[tuple[Path, int]]:
    """Modules and the places in them to change, each once."""
    files = sorted([*(ROOT / "sandbox/engine").glob("*.py"), *(ROOT / "sandbox/physics").glob("*.py")])
    every = [
        (file, place)
        for file in files
        if file.stem not in LEFT_OUT
        for place in range(len(list(places(ast.parse(file.read_text("utf-8"))))))
    ]
    return random.Random(seed).sample(every, min(number, len(every)))


def mutant(file: Path, place: int) -> tuple[str, str]:
    """The source with the change, and what it is."""
    tree = copy.deepcopy(ast.parse(file.read_text("utf-8")))
    node, how = list(places(tree))[place]
    before = ast.unparse(node.test if how == "condition" else node)  # type: ignore[attr-defined]
    changed(node, how)
    after = ast.unparse(node.test if how == "condition" else node)  # type: ignore[attr-defined]
    where = f"{file.relative_to(ROOT)}:{node.lineno}"  # type: ignore[attr-defined]
    return ast.unparse(ast.fix_missing_locations(tree)), f"{where}  {before}  ->  {after}"


def tests_of(file: Path) -> list[str]:
    engine = file.parent.name == "engine" or file.stem in RELATED
    names = RELATED.get(file.stem, "").split() if engine else [f"../physics/test_{file.stem}", "../scenes/test_golf"]
    paths = [f"tests/engine/test_{name}.py" if "/" not in name else f"tests/engine/{name}.py" for name in names]
    return [path for path in paths if (ROOT / path).is_file()]


def noticed(copied: Path, file: Path, source: str, timeout: float) -> bool:
    """Whether a test fails, or none ends in time."""
    place = copied / file.relative_to(ROOT)
    original = place.read_text("utf-8")
    place.write_text(source, "utf-8")
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-x",
        "-q",
        "-p",
        "no:cacheprovider",
        "-p",
        "no:randomly",
        *tests_of(file),
    ]
    variables = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1", "SDL_VIDEODRIVER": "dummy"}
    try:
        return subprocess.run(command, cwd=copied, env=variables, capture_output=True, timeout=timeout).returncode != 0
    except subprocess.TimeoutExpired:
        return True
    finally:
        place.write_text(original, "utf-8")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--number", type=int, default=300)
    parser.add_argument("--seed", type=int, default=18)
    parser.add_argument("--part", default="1/1", help="every N-th mutant from the I-th on: I/N")
    parser.add_argument("--timeout", type=float, default=120.0, help="s for the tests of one mutant")
    arguments = parser.parse_args()
    part, parts = map(int, arguments.part.split("/"))
    survivors = tried = 0
    with tempfile.TemporaryDirectory() as folder:
        copied = Path(folder) / "tree"
        shutil.copytree(ROOT, copied, ignore=shutil.ignore_patterns(".git", ".venv", "__pycache__", "dist"))
        for file, place in drawn(arguments.number, arguments.seed)[part - 1 :: parts]:
            source, what = mutant(file, place)
            tried += 1
            if not noticed(copied, file, source, arguments.timeout):
                survivors += 1
                sys.stdout.write(f"survived ({survivors} of {tried})  {what}\n")
                sys.stdout.flush()
    sys.stdout.write(f"{survivors} of {tried} mutants survived\n")


if __name__ == "__main__":
    main()
