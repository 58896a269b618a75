"""Tables and numbers as readable text."""

from __future__ import annotations

import re
import shutil
import textwrap
from collections.abc import Iterable, Sequence
from itertools import zip_longest
from unicodedata import east_asian_width

from sandbox.sport.amounts import significant
from sandbox.text import one_line
from sandbox.units import KIND_OF

#: Units of length, with the length in m from which each is used.
_LENGTHS = (
    (1e3, "km", 1e-3),
    (1.0, "m", 1.0),
    (1e-2, "cm", 1e2),
    (1e-3, "mm", 1e3),
    (1e-6, "µm", 1e6),
    (0.0, "nm", 1e9),
)
_TIMES = ((60.0, "min", 1 / 60), (1.0, "s", 1.0), (1e-3, "ms", 1e3), (0.0, "µs", 1e6))


#: A number and its unit; and a space where a line is not broken.
_UNITS = "|".join(re.escape(unit) for unit in sorted(KIND_OF, key=len, reverse=True) if unit)
_AMOUNT = re.compile(rf"(?:± [\d.,]*)?\d (?:{_UNITS})(?!\w)")
_FIXED_SPACE = "\u00a0"


#: A word of so many characters, or a part of it between hyphens, is broken only if lines fit then; one so short never.
_LONGEST_WORD, _SHORTEST_PART = 16, 8
#: Where a word may be broken after a hyphen: as ``textwrap`` does.
_AFTER_HYPHEN = re.compile(r"(?<=\w[^\W\d]-)(?=\w+[^\W\d])")


def width() -> int:
    """Maximum characters in a line: those of the terminal, or 80 if there is none."""
    return shutil.get_terminal_size((80, 24)).columns


def table(headings: Sequence[str], rows: Iterable[Sequence[str]], align: str, indent: str = "  ") -> list[str]:
    """Lines with columns aligned by ``align``, a letter for each: l or r.

    Headings and left-aligned cells are wrapped between words, or else after hyphens, or else, if that is enough, within
    words that are not short, so that lines fit ``width``; right-aligned numbers never, even if lines are longer then.
    Empty headings give no heading line; a column without any text is left out.
    """
    cells = [[one_line(cell) for cell in row] for row in rows]
    every = [headings, *cells] if any(headings) else cells
    used = [place for place in range(len(headings)) if any(row[place] for row in every)]
    widths = {place: max(_columns_of(row[place]) for row in every) for place in used}
    too_wide = len(indent) + sum(widths.values()) + 2 * (len(used) - 1) - width()
    for place in used if too_wide > 0 else ():
        if align[place] == "r":
            least = max(map(_columns_of, (*headings[place].split(), *(row[place] for row in cells))), default=0)
            too_wide, widths[place] = too_wide - widths[place] + least, least
    texts = [place for place in used if align[place] == "l"]
    words = {place: {word for row in every for word in row[place].split()} for place in texts}
    pieces = {place: [piece for word in own for piece in _AFTER_HYPHEN.split(word)] for place, own in words.items()}
    for whole, longest in ((words, _LONGEST_WORD), (pieces, _LONGEST_WORD), (pieces, _SHORTEST_PART)):
        shortest = {place: min(max(map(_columns_of, own), default=1), longest) for place, own in whole.items()}
        if longest == _SHORTEST_PART and too_wide > sum(max(0, widths[place] - shortest[place]) for place in texts):
            break  # lines would be too long all the same
        while too_wide > 0:
            widest = max(texts, key=lambda place: widths[place] - shortest[place], default=None)
            if widest is None or widths[widest] <= shortest[widest]:
                break
            too_wide, widths[widest] = too_wide - 1, widths[widest] - 1
    lines = []
    for row in every:
        wrapped = [_wrapped(row[place], widths[place]) for place in used]
        for parts in zip_longest(*wrapped, fillvalue=""):
            padded = [_padded(part, widths[place], align[place]) for part, place in zip(parts, used, strict=True)]
            lines.append((indent + "  ".join(padded)).rstrip())
    return lines


def _wrapped(text: str, room: int) -> list[str]:
    if _columns_of(text) <= room:
        return [text]
    letters = room if _columns_of(text) == len(text) else max(1, room // 2)  # some may take two columns
    return _lines(text, letters, hyphens=max(map(len, text.split())) > letters)


def _lines(
    text: str, letters: int, indent: str = "", later: str = "", breaks: bool = True, hyphens: bool = False
) -> list[str]:
    """The text in lines of so many letters; a number and its unit stay on one line. ``breaks`` a longer word, and with
    ``hyphens`` words after these."""
    joined = _AMOUNT.sub(lambda found: found[0].replace(" ", _FIXED_SPACE), text)
    wrapper = textwrap.TextWrapper(letters, indent, later, break_on_hyphens=hyphens, break_long_words=breaks)
    return [line.replace(_FIXED_SPACE, " ") for line in wrapper.wrap(joined)]


def _padded(text: str, room: int, side: str) -> str:
    spaces = " " * (room - _columns_of(text))
    return spaces + text if side == "r" else text + spaces


def _columns_of(text: str) -> int:
    """The columns of a terminal that a text takes."""
    return len(text) + sum(east_asian_width(letter) in "WF" for letter in text)


def paragraph(text: str, indent: str = "  ") -> list[str]:
    """A text wrapped to ``width``; lines after the first are indented by two more. A file's name stays whole."""
    return _lines(one_line(text), width(), indent, indent + "  ", breaks=False)


#: Lengths below this, in m, are rounding.
_ROUNDING = 1e-12


def length(metres: float | None) -> str:
    """``0.0032`` as ``3.2 mm``; less than rounding is 0."""
    return _scaled(0.0 if metres is not None and abs(metres) < _ROUNDING else metres, _LENGTHS)


def length_or_below(metres: float | None, least: float) -> str:
    """The same, but less than ``least`` (m), the resolution, as ``< 3.2 mm``."""
    if metres is None or metres >= least or least <= _ROUNDING:
        return length(metres)
    return f"< {length(least)}"


def unit_of_length(metres: float) -> tuple[str, float]:
    """The unit in which a length is shown, and the factor from m to it."""
    return _unit_for(metres, _LENGTHS)


def time(seconds: float | None) -> str:
    """``0.0032`` as ``3.2 ms``."""
    return _scaled(seconds, _TIMES)


def percent(share: float) -> str:
    """``0.0032`` as ``0.3 %``; less than rounding is "none"."""
    return "none" if share < 1e-12 else f"{significant(100.0 * share, 1)} %"


def _scaled(value: float | None, units: Sequence[tuple[float, str, float]]) -> str:
    if value is None:
        return ""
    if value == 0.0:
        return f"0 {units[-1][1]}"
    unit, factor = _unit_for(value, units)
    return f"{significant(value * factor)} {unit}"


def _unit_for(value: float, units: Sequence[tuple[float, str, float]]) -> tuple[str, float]:
    for begins, unit, factor in units:
        if abs(value) >= begins:
            return unit, factor
    raise AssertionError("the smallest unit starts at 0")
