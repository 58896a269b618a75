"""Writes what follows from the code: the JSON schemas of the scenes, and lists in pages: ``make lists``. Tests hold the
files against it.

A list stands between two comments, such as ``<!-- coefficients -->`` and ``<!-- end -->``.
"""

from __future__ import annotations

import ast
import inspect
import json
import re
import textwrap
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from math import inf, isinf
from pathlib import Path

from sandbox.parameters import Group, groups_of
from sandbox.physics.coefficients import ANY, Coefficient, Laws, Origin, Range
from sandbox.scene import parameters_of
from sandbox.scene.discovery import docstring, installed_folders
from sandbox.schema import json_schema
from sandbox.text import with_noun

ROOT = Path(__file__).resolve().parent.parent

#: The sports that the sandbox is made for.
FIRST = ("golf", "soccer", "basketball", "billiards")


def filled(page: str, name: str, lines: Iterable[str]) -> str:
    """The page with new lines between the marks of a block."""
    block = "\n".join([f"<!-- {name} -->", *lines, "<!-- end -->"])
    page, count = re.subn(rf"<!-- {name} -->\n.*?<!-- end -->", lambda match: block, page, flags=re.DOTALL)
    assert count == 1, name
    return page


def sports() -> Iterator[str]:
    """Every scene that comes with the sandbox, as a row of a table."""
    yield from ("| scene | | has |", "|---|---|---|")
    for name, folder in scenes():
        kinds = {"preset": "presets/*.toml", "task": "tasks/*.toml", "game": "games/[a-z]*.py"}
        numbers = {kind: len(list(folder.glob(pattern))) for kind, pattern in kinds.items()}
        has = ", ".join(with_noun(number, kind) for kind, number in numbers.items() if number)
        yield f"| [{name}](scenes/{name}/scene.py) | {docstring(folder / 'scene.py')} | {has} |"


def models() -> Iterator[str]:
    """What each scene models, by the docstring of its ``scene.py``."""
    for name, text in paragraphs("Models", r": (.*?)\.?$(?=\n\n|\nLeaves out|\Z)"):
        yield item(f"[{name}](../scenes/{name}/scene.py): {text}.")


def left_out() -> Iterator[str]:
    """What each scene leaves out, with sizes where they are known, by the docstring of its ``scene.py``."""
    for name, text in paragraphs("Leaves out", r":?\s*(.*)"):
        yield item(f"**{name}**: {text.removeprefix(', ')}")


def paragraphs(begins: str, goes_on: str) -> Iterator[tuple[str, str]]:
    """Each scene, and the paragraph of its ``scene.py`` that begins so, without these words, on one line."""
    for name, folder in scenes():
        about = ast.get_docstring(ast.parse((folder / "scene.py").read_text("utf-8"))) or ""
        found = re.search(rf"^{begins}{goes_on}", about, re.DOTALL | re.MULTILINE)
        if found is None:
            raise SystemExit(f"scenes/{name}/scene.py: its docstring has no line that begins with {begins}")
        yield name, " ".join(found[1].split())


def scenes() -> list[tuple[str, Path]]:
    """Names and folders of the scenes that come with the sandbox: ``FIRST``, then in the order of the tiles."""
    folders = [path.parent for path in (ROOT / "scenes").glob("*/scene.py")]
    places = {folder: tomllib.loads(file.read_text("utf-8"))["place"] for folder in folders
              if (file := folder / "tile.toml").exists()}  # fmt: skip
    first = {ROOT / "scenes" / name: place for place, name in enumerate(FIRST)}
    folders.sort(key=lambda it: (first.get(it, inf), places.get(it, inf), it.name))
    return [(folder.name, folder) for folder in folders]


def item(text: str) -> str:
    """An item of a list."""
    return textwrap.fill(
        f"- {text.replace('``', '`')}", 120, subsequent_indent="  ", break_long_words=False, break_on_hyphens=False
    )


def coefficients() -> Iterator[str]:
    """Every drag and lift coefficient that a scene file may name, by ball: formula, source, range, values."""
    yield ""
    balls: dict[str, list[Laws]] = {}
    for laws in all_laws():
        balls.setdefault(laws.ball, []).append(laws)
    for ball, of_ball in sorted(balls.items(), key=lambda each: (each[0] != "any ball", each[0])):
        yield f"## {ball.capitalize()}\n"
        for laws in of_ball:
            symbol = {"drag": "Cd", "lift": "Cl"}[laws.kind]
            yield f"By name in a scene file, `ball.{laws.kind}.model`:\n"
            yield from (entry(symbol, name, law, laws.origins[name]) for name, law in laws.items())
            yield ""


def all_laws() -> list[Laws]:
    """The coefficients of all balls of the scenes that come with the sandbox."""
    found: dict[int, Laws] = {}
    for folder in sorted(installed_folders().values()):
        _, parameters = parameters_of(folder)
        found |= {id(laws): laws for laws in laws_in(type(parameters))}
    return list(found.values())


def laws_in(schema: type[Group]) -> Iterator[Laws]:
    """The registered coefficients that the groups of a scene's parameters may be set to."""
    laws = getattr(schema, "LAWS", None)
    if isinstance(laws, Laws):
        yield laws
    for field in schema.model_fields.values():
        for inner in groups_of(field.annotation):
            yield from laws_in(inner)


def entry(symbol: str, name: str, law: Coefficient, origin: Origin) -> str:
    """One coefficient as an item of a list."""
    code = getattr(law, "__name__", type(law).__name__)
    about = (inspect.getdoc(law) or "").partition("\n\n")[0]
    about = " ".join(about.split())
    parts = [about.rstrip(".")]
    limits = [span(of, limit) for of, limit in (("Re", origin.reynolds), ("S", origin.spin_ratio)) if limit != ANY]
    if limits:
        parts.append(f"For {' and '.join(limits)}")
    parts.append(f"Source{f', *{origin.mark}*' if origin.mark else ''}: {origin.source}")
    values = [f"{symbol}({number(re)}, {s:g}) = {value:g}" for (re, s), value in origin.points.items()]
    parts.append(", ".join(values) + (f", within {origin.within:g}" if origin.within > 1e-4 else ""))
    return item(f"`{name}`, `{code}`: {'. '.join(parts)}.")


def span(symbol: str, limits: Range) -> str:
    low, high = (number(limit) if symbol == "Re" else f"{limit:g}" for limit in limits)
    if isinf(limits[1]):
        return f"{symbol} above {low}"
    return f"{symbol} up to {high}" if limits[0] == 0.0 else f"{symbol} from {low} to {high}"


def number(reynolds: float) -> str:
    return f"{reynolds / 1e5:g}e5"


#: The blocks of each page.
LISTS: Mapping[Path, Mapping[str, Callable[[], Iterable[str]]]] = {
    ROOT / "README.md": {"sports": sports},
    ROOT / "docs" / "physics.md": {"scenes": models, "left out": left_out, "coefficients": coefficients},
}


def page_with_lists(page: Path) -> str:
    """The text of a page as it should be."""
    text = page.read_text("utf-8")
    for name, lines in LISTS[page].items():
        text = filled(text, name, lines())
    return text


if __name__ == "__main__":
    for name, folder in scenes():
        schema = json_schema(parameters_of(folder)[1], name)
        (folder / f"{name}.schema.json").write_text(json.dumps(schema, indent=2) + "\n", "utf-8")
    for page in LISTS:
        page.write_text(page_with_lists(page), "utf-8")
