"""The parts of all pages: templates that are filled in, packed data, images."""

from __future__ import annotations

import base64
import io
import zlib
from collections.abc import Iterable, Mapping
from functools import cache
from html import escape
from itertools import zip_longest
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from sandbox.files import atomic_write, json_text
from sandbox.page.templates import PLAYER, framed, source, with_player
from sandbox.picture.palette import ASSETS, Colour
from sandbox.text import one_line

_WEIGHTS = {"400": "Regular", "700": "Bold"}
#: The scripts of each page with data, in order.
SCRIPTS = {
    "run.html": (*PLAYER, "run.js"),
    "sweep.html": ("page.js", "sweep.js"),
}


def filled(name: str, title: str, data: str = "", **parts: str) -> str:
    """A page: a template with its parts, which are HTML already; with packed ``data`` also its scripts."""
    body = with_player(source(name), title=title, **parts)
    if data:
        script = "".join(map(source, SCRIPTS[name]))
        body += f'<script type="text/plain" id="data">{data}</script>\n<script>\n{script}\n</script>\n'
    return framed(title, f"<style>\n{source('page.css')}\n</style>", body)


def save(page: str, path: Path | str) -> None:
    """Write a page completely or not at all. Raises OSError where it cannot be written."""
    with atomic_write(Path(path)) as file:
        file.write(page)


def html(text: str) -> str:
    """Text as HTML, on one line."""
    return escape(one_line(text))


def css(colour: Colour) -> str:
    """A colour as browsers write it."""
    return "#{:02x}{:02x}{:02x}".format(*colour)


def packed(data: Any) -> str:
    """Data as JSON, with all digits of its numbers, deflated and in letters."""
    return _letters(json_text(data).encode())


def _letters(data: bytes) -> str:
    return base64.b64encode(zlib.compress(data, 9)).decode()


@cache
def fonts() -> dict[str, str]:
    """The letters of pictures by weight, packed."""
    return {
        weight: _letters((ASSETS / "fonts" / f"NotoSans-{name}.ttf").read_bytes()) for weight, name in _WEIGHTS.items()
    }


def picture(image: Image.Image, exact: bool = False, quick: bool = False) -> str:
    """An image as an address that contains it; ``exact`` keeps every pixel, a ``quick`` one is made in a quarter of the
    time and twice as large."""
    out = io.BytesIO()
    image.save(out, "WEBP", quality=82, method=0 if quick else 4, lossless=exact)
    return f"data:image/webp;base64,{base64.b64encode(out.getvalue()).decode()}"


def what_changed(before: np.ndarray, after: np.ndarray) -> Image.Image:
    """The pixels of the second that differ from the first, everything else see-through; shape (height, width, 3)."""
    changed = np.any(before != after, axis=2)
    return Image.fromarray(np.dstack([after * changed[..., None], changed * np.uint8(255)]))


def rows(cells: Iterable[Iterable[str]], colours: Iterable[str] = ()) -> str:
    """Rows of a table, the first cell of each its heading; texts, the columns of values in ``colours``."""
    styles = [f' style="color: {colour}"' for colour in colours]
    return "\n".join(
        f'<tr role="row"><th scope="row" role="rowheader">{html(label)}</th>'
        + "".join(
            f'<td role="cell"{style}>{html(text)}</td>' for text, style in zip_longest(texts, styles, fillvalue="")
        )
        + "</tr>"
        for label, *texts in cells
    )


def table(cells: Iterable[Iterable[str]], caption: str, kind: str, heads: Mapping[str, str] | None = None) -> str:
    """A table for people and screen readers; ``heads`` are the names of its columns of values, each with a colour."""
    head = ""
    if heads:
        columns = "".join(
            f'<th scope="col" role="columnheader" style="color: {colour}">{html(name)}</th>'
            for name, colour in heads.items()
        )
        head = f'<thead><tr role="row"><td role="cell"></td>{columns}</tr></thead>'
    return (
        f'<table class="{kind}" role="table"><caption class="hidden">{html(caption)}</caption>{head}\n'
        f'<tbody role="rowgroup">\n{rows(cells, ["inherit", *list((heads or {}).values())[1:]])}\n</tbody></table>'
    )
