"""All golden failures of a test run as one page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from PIL import Image

from sandbox.page.parts import filled, html, picture


def failure(
    name: str, lines: Sequence[str], changes: Sequence[str], images: tuple[Image.Image, Image.Image, Image.Image] | None
) -> dict[str, Any]:
    """What the page needs of a failure, in JSON's types: what the test said, what differs in the run, and expected,
    actual and difference as pictures."""
    return {
        "name": name,
        "lines": list(lines),
        "changes": list(changes),
        "pictures": None if images is None else [picture(image.convert("RGB"), exact=True) for image in images],
    }


def page_of(failures: Iterable[tuple[str, Mapping[str, Any]]]) -> str:
    """The page of failures, each after the test that it is of."""
    sections = [_section(test, failed) for test, failed in failures]
    count = len(sections)
    title = f"{count} golden failure{'' if count == 1 else 's'}" if count else "No golden failures"
    return filled("golden.html", title=title, failures="\n".join(sections))


def _section(test: str, failed: Mapping[str, Any]) -> str:
    lines = "".join(f"<p>{html(line)}</p>" for line in failed["lines"])
    changes = "".join(f"<li>{html(change)}</li>" for change in failed["changes"])
    told = f"<h3>What differs in the run</h3><ul>{changes}</ul>" if changes else ""
    shown = "" if failed["pictures"] is None else _pictures(failed["name"], *failed["pictures"])
    return f"<section><h2>{html(failed['name'])}</h2><p>{html(test)}</p>{lines}{told}{shown}</section>"


def _pictures(name: str, expected: str, actual: str, difference: str) -> str:
    return (
        f'<div class="pictures"><figure><div class="between"><img alt="expected" src="{expected}">'
        f'<img class="above" alt="actual" src="{actual}"><i></i>'
        f'<input type="range" min="0" max="100" value="50" aria-label="{html(name)}: expected and actual"></div>'
        f"<figcaption>expected to the left of the line, actual to the right</figcaption></figure>"
        f'<figure><img alt="difference" src="{difference}"><figcaption>changed pixels red</figcaption></figure></div>'
    )
