"""Which module of the window may import which: ``session <- game <- shown <- stages <- view <- commands <- app``."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import sandbox.window
from tests.test_directions import imported

WINDOW = Path(sandbox.window.__file__).parent

#: A module may import, late or for types too, only from rows above its own.
ROWS = (
    {"background", "best", "contest", "desktop", "history", "layout", "memory", "messages", "sound"},
    {"canvas", "jobs", "shots"},
    {"bar", "charts", "decathlon", "fan_card", "prediction"},
    {"fan", "live", "measure", "session", "stage"},
    {"aim", "export", "handles", "overlay", "pad", "replay", "score_map"},
    {"hand", "menu", "table", "worker"},
    {"find", "path", "watching"},
    {"aiming", "opponent"},
    {"grasp", "opening", "referee"},
    {"banner"},
    {"game", "scoreboard"},
    {"front", "panel", "shown"},
    {"screen"},
    {"stages"},
    {"fan_of_shot", "map_of_shot", "targets", "viewpoint"},
    {"cards"},
    {"drawing"},
    {"view"},
    {"keeping"},
    {"actions"},
    {"commands"},
    {"pointer"},
    {"app"},
    {"command"},
    {"entry"},
)
ROW = {name: row for row, names in enumerate(ROWS) for name in names}


def upward(name: str, source: str) -> list[str]:
    """The imports of a module from its own row, or a row below it."""
    modules = [module.split(".") for module in imported(ast.parse(source), "sandbox.window")]
    used = {parts[2] for parts in modules if parts[:2] == ["sandbox", "window"] and len(parts) > 2}
    return [f"{name} imports {other}" for other in sorted(used) if ROW.get(other, len(ROWS)) >= ROW[name]]


def test_modules_of_the_window_import_only_from_rows_above():
    files = {path.stem: path for path in WINDOW.glob("*.py") if path.stem != "__init__"}
    assert files.keys() == ROW.keys()
    assert [line for name, path in sorted(files.items()) for line in upward(name, path.read_text("utf-8"))] == []


@pytest.mark.parametrize(
    ("name", "source"),
    [
        ("game", "from sandbox.window.view import View"),
        ("stages", "def late():\n    from sandbox.window import commands"),
        ("targets", "if TYPE_CHECKING:\n    from .viewpoint import Viewpoint"),
        ("shots", "import sandbox.window.game"),
    ],
)
def test_an_import_upward_is_seen(name, source):
    assert len(upward(name, source)) == 1


def test_no_module_reads_what_is_private_to_another():
    """``_replace`` and ``_asdict`` of named tuples are public."""
    private = [
        f"{path.stem}, line {node.lineno}: {node.attr}"
        for path in sorted(WINDOW.glob("*.py"))
        for node in ast.walk(ast.parse(path.read_text("utf-8")))
        if isinstance(node, ast.Attribute) and node.attr.startswith("_") and not node.attr.startswith("__")
        and node.attr not in ("_replace", "_asdict")
        and not (isinstance(node.value, ast.Name) and node.value.id in ("self", "cls"))
    ]  # fmt: skip
    assert private == []
