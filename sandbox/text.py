"""Makes text from files and other people's code safe to print, and command lines to copy."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

from sandbox.errors import RequestError

#: Characters that a terminal interprets instead of showing: control characters (C0 except tab and newline, DEL, C1),
#: and those that change the writing direction or break lines.
_CONTROL = "[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ufeff]|[\ud800-\udfff]"

#: Halves of a character of UTF-16.
_SURROGATE = "[\ud800-\udfff]"

#: Characters that end a line, or are not one space wide.
_BREAK = "[\n\r\t\v\f\x85]"

#: Text that TOML reads as no value of another kind, so that it needs no quotes.
_WORD = "(?!(true|false|inf|nan)$)[a-zA-Z][a-zA-Z-]*"

#: First characters of a formula in a spreadsheet.
_FORMULA = ("=", "+", "-", "@")


def printable(text: str) -> str:
    r"""The text with control characters written out as ``\u001b``, as in JSON; newlines and tabs stay."""
    return re.sub(_CONTROL, lambda match: f"\\u{ord(match[0]):04x}", text)


def encodable(text: str) -> str:
    """The text with lone surrogates, which UTF-8 cannot have, written out as in JSON; all else stays."""
    return text if text.isascii() else re.sub(_SURROGATE, lambda match: f"\\u{ord(match[0]):04x}", text)


def one_line(text: str) -> str:
    """The text on one line, without control characters: for a name, a label, a table cell."""
    return printable(" ".join(text.split()) if re.search(_BREAK, text) else text)


def shortened(text: str, most: int = 80) -> str:
    """The text cut to at most ``most`` characters, for a message."""
    return text if len(text) <= most else text[: most - 3] + "..."


def title_of(name: str) -> str:
    """``Free throw`` for ``free-throw``."""
    return name.replace("-", " ").capitalize()


def with_article(noun: str) -> str:
    """``a ball``, ``an arrow``."""
    return f"{'an' if noun[:1].lower() in tuple('aeiou') else 'a'} {noun}"


def with_noun(count: int, what: str) -> str:
    """``1 point``, ``40 points``, ``1,000 points``."""
    return f"{count:,} {what}{'s' * (count != 1)}"


def check_mapping(name: str, value: object, example: str) -> None:
    """Raise RequestError if the argument of this name is no mapping, such as the ``example``."""
    if not isinstance(value, Mapping):
        raise RequestError(f"{name} = {shortened(repr(value))}: must be a dictionary such as {example}")


def nearest(word: str, known: Sequence[str]) -> str | None:
    """The known dotted key most similar to ``word``: in the same group, or by its last part anywhere; or None."""
    import difflib

    inside, _, last = word.rpartition(".")
    anywhere = {key.rpartition(".")[2]: key for key in reversed(known)}
    siblings = {key.rpartition(".")[2]: key for key in known if key.rpartition(".")[0] == inside}
    for among, cutoff in ((siblings, 0.6), (anywhere, 0.75)):
        for found in difflib.get_close_matches(last, among, n=1, cutoff=cutoff):
            return among[found]
    return None


def no_such_result(name: str, known: Sequence[str]) -> str:
    """The end of a message about an entry that a result does not have."""
    near = nearest(name, known)
    return "no such result; " + (f"did you mean {near}?" if near else f"the results are {', '.join(known)}")


@lru_cache(maxsize=1024)  # a sweep has the same words in all rows
def csv_text(text: str) -> str:
    """The text as a cell of a CSV file: one line, with a quote before what a spreadsheet would take for a formula."""
    line = one_line(text)
    return f"'{line}" if line.startswith(_FORMULA) else line


def command_line(source: str, changes: Mapping[str, Any], does: str = "run", *options: str) -> str:
    """The command that runs a scene with values at keys, or ``does`` something else with it."""
    import shlex  # here, not above: no start of the program needs it

    settings = [word for key, value in changes.items() for word in ("--set", f"{key}={argument(value)}")]
    return shlex.join(["sandbox", does, source, *settings, *options])


def argument(value: Any) -> str:
    """A value as ``--set`` and ``--over`` take it, without quotes where it needs none."""
    return value if isinstance(value, str) and re.fullmatch(_WORD, value) else toml_text(value).removesuffix(".0")


def toml_text(value: Any) -> str:
    """A value as TOML on one line, a group of parameters as a table."""
    import tomlkit

    if hasattr(value, "model_dump"):
        value = value.model_dump(mode="json", exclude_none=True)
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{key} = {toml_text(item)}" for key, item in value.items()) + "}"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml_text, value)) + "]"
    return str(tomlkit.item(value).as_string())
