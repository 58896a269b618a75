"""Text from files and from other people's code, made safe to print: it may hold anything."""

from __future__ import annotations

import re

#: What a terminal obeys instead of showing it: control characters (C0 but for tab and newline, DEL, C1) and those that
#: turn the direction of writing round or break lines.
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ufeff]|[\ud800-\udfff]")

#: What a spreadsheet takes for a formula.
_FORMULA = ("=", "+", "-", "@")


def printable(text: str) -> str:
    r"""The text with control characters written out as ``\u001b``, as JSON writes them; newlines and tabs stay."""
    return _CONTROL.sub(lambda match: f"\\u{ord(match[0]):04x}", text)


def one_line(text: str) -> str:
    """The text on one line, without control characters: for a name, a label, a cell of a table."""
    return printable(" ".join(text.split()) if any(mark in text for mark in "\n\r\t\v\f\x85") else text)


def csv_text(text: str) -> str:
    """The text as a cell of a CSV file: one line, and a quote before what a spreadsheet would compute."""
    line = one_line(text)
    return f"'{line}" if line.startswith(_FORMULA) else line
