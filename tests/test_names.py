"""Names and docstrings: the field's words and Python's, and no public name of ``sandbox`` that nobody uses."""

from __future__ import annotations

import ast
import re
from collections import Counter
from collections.abc import Iterator
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PACKAGE = ROOT / "sandbox"
USERS = ("sandbox", "scenes", "template", "template_above", "tests", "docs", "benchmarks")

#: Folders whose functions and docstrings are read.
NAMED = ("sandbox", "scenes")
#: Participles and everyday words that say nothing of what a function returns or does.
VAGUE = {"told", "said", "shown", "wanted", "counted", "placed", "worth", "asked", "seen", "taken", "room", "heard"}
#: Beginnings of docstrings that put a question in place of what is returned or done.
QUESTION = re.compile(r"(What|Whether|How|Where|When|Of)\b")
#: A module-level name at the start of a line: a function, a class, or constants.
DEFINED = re.compile(r"^(?:def|class) ([A-Za-z]\w*)|^([A-Za-z]\w*(?:, [A-Za-z]\w*)*)(?::[^=\n]+)? = ", re.MULTILINE)


@cache
def modules(*folders: str) -> dict[Path, str]:
    return {path: path.read_text("utf-8") for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))}


def defined(source: str) -> Iterator[ast.Module | ast.ClassDef | ast.FunctionDef]:
    """The module, its classes, functions and methods."""
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            yield node


def vague_names(source: str) -> list[str]:
    nodes = (node for node in defined(source) if not isinstance(node, ast.Module | ast.ClassDef))
    return [node.name for node in nodes if node.name.strip("_") in VAGUE]


def questions(source: str) -> list[str]:
    texts = (ast.get_docstring(node) or "" for node in defined(source))
    return [text.partition("\n")[0] for text in texts if QUESTION.match(text)]


def public_names(source: str) -> list[str]:
    """Public names of a module; an ``__all__`` makes those in it, and pytest finds its hooks, without users."""
    names = [name for pair in DEFINED.findall(source) for name in (pair[0] or pair[1]).split(", ")]
    return [name for name in names if not name.startswith("pytest_")]


def test_functions_are_called_what_they_return_or_do():
    assert {str(path): found for path, source in modules(*NAMED).items() if (found := vague_names(source))} == {}
    assert vague_names("class Text:\n    def said(self): ...\n\ndef _told(): ...") == ["_told", "said"]


def test_docstrings_say_what_is_returned_or_done():
    assert {str(path): found for path, source in modules(*NAMED).items() if (found := questions(source))} == {}
    assert questions('"""What it has."""\n\ndef length():\n    """How long it is."""') == [
        "What it has.",
        "How long it is.",
    ]


def test_public_names_are_used_by_another_module():
    """Or documented, in backticks; otherwise they have an underscore. Groups of parameters are named in schemas."""
    files = [path for folder in USERS for path in (ROOT / folder).rglob("*.py")]
    count = Counter(word for path in files for word in set(re.findall(r"\w+", path.read_text("utf-8"))))
    pages = [path.read_text("utf-8") for path in (*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"))]
    documented = {
        word for page in pages for code in re.findall(r"`[^`\n]+`", page) for word in re.findall(r"\w+", code)
    }
    schemas = "".join(path.read_text("utf-8") for path in (ROOT / "scenes").glob("*/*.schema.json"))
    alone = {
        f"{path.relative_to(PACKAGE)}: {name}"
        for path, source in modules("sandbox").items()
        for name in public_names(source)
        if count[name] < 2 and name not in documented and f'"{name}": {{' not in schemas
    }
    assert alone == set()
    assert public_names("FIRST, SECOND = 1, 2\n\ndef third(): ...\n\n_FOURTH: int = 4") == ["FIRST", "SECOND", "third"]
