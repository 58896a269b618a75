"""All golden failures of a test run as one page."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from PIL import Image

from sandbox.page.parts import filled, html, picture, save


def failure(
    name: str,
    lines: Sequence[str],
    changes: Sequence[str],
    expected: Image.Image | None,
    actual: Image.Image,
    difference: Image.Image | None,
) -> dict[str, Any]:
    """A failure as the page needs it, in JSON's types: the lines of the test, the differences in the run, and the
    pictures; ``expected`` is None if there is none, ``difference`` if the two are not of one size."""
    images = {"expected": expected, "actual": actual, "difference": difference}
    return {
        "name": name,
        "lines": list(lines),
        "changes": list(changes),
        "pictures": {
            kind: picture(image.convert("RGB"), exact=True) for kind, image in images.items() if image is not None
        },
    }


def save_page(failures: Iterable[tuple[str, Mapping[str, Any]]], path: Path) -> None:
    """Write the page of failures, each after the test that it is of."""
    save(page_of(failures), path)


def page_of(failures: Iterable[tuple[str, Mapping[str, Any]]]) -> str:
    """The page of failures, each after the test that it is of."""
    sections = [_section(test, failed) for test, failed in failures]
    count = len(sections)
    title = f"{count} golden failure{'' if count == 1 else 's'}" if count else "No golden failures"
    return filled("golden.html", title=title, failures="\n".join(sections))


def _section(test: str, failed: Mapping[str, Any]) -> str:
    lines = "".join(f"<p>{html(line)}</p>" for line in failed["lines"])
    changes = "".join(f"<li>{html(change)}</li>" for change in failed["changes"])
    differences = f"<h3>What differs in the run</h3><ul>{changes}</ul>" if changes else ""
    pictures = failed["pictures"]
    comparison = _compared(failed["name"], **pictures) if "difference" in pictures else _alone(pictures)
    return f"<section><h2>{html(failed['name'])}</h2><p>{html(test)}</p>{lines}{differences}{comparison}</section>"


def _alone(pictures: Mapping[str, str]) -> str:
    figures = (
        f'<figure><img alt="{kind}" src="{source}"><figcaption>{kind}</figcaption></figure>'
        for kind, source in pictures.items()
    )
    return f'<div class="pictures">{"".join(figures)}</div>'


def _compared(name: str, expected: str, actual: str, difference: str) -> str:
    return (
        f'<div class="pictures"><figure><div class="between"><img alt="expected" src="{expected}">'
        f'<img class="above" alt="actual" src="{actual}"><i></i>'
        f'<input type="range" min="0" max="100" value="50" aria-label="{html(name)}: expected and actual"></div>'
        f"<figcaption>expected to the left of the line, actual to the right</figcaption></figure>"
        f'<figure><img alt="difference" src="{difference}"><figcaption>changed pixels red</figcaption></figure></div>'
    )
