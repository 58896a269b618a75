"""TOML: files that are read, and single values as a file would write them."""

from __future__ import annotations

import json
import re
import sys
import tomllib
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

from sandbox import units
from sandbox.errors import RequestError
from sandbox.files import read_given
from sandbox.text import shortened

#: Most bytes of a scene file; the largest of the project's own has 5 kB.
_LARGEST = 1_000_000

#: Most parts of a key; deeper tables take time with the square of their depth.
_DEEPEST = 100


def read_toml(path: Path) -> Mapping[str, Any]:
    """The nested tables of a TOML file, not to be changed; RequestError says in one line why it cannot be read."""
    try:
        text = read_given(path, _LARGEST).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise RequestError(f"{path}: not a text file in UTF-8 (byte {error.start})") from None
    try:
        return _tables(text)
    except ValueError as error:
        raise RequestError(f"{path}: {error}") from None


@lru_cache(maxsize=256)
def _tables(text: str) -> Mapping[str, Any]:
    """The tables of a text, parsed once in a process. Raises ValueError, which says what is wrong with it."""
    deep = next((n for n, line in enumerate(text.splitlines(), 1) if _parts_of_key(line) > _DEEPEST), None)
    if deep is not None:
        raise ValueError(f"line {deep}: a key has at most {_DEEPEST} parts")
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"broken TOML: {error}{_toml_hint(text, str(error))}") from None
    except RecursionError:
        raise ValueError("its lists or tables are nested too deeply") from None
    except ValueError as error:  # Python's limit for whole numbers
        digits = max(map(len, re.findall(r"\d+", text)), default=0)
        if digits <= sys.int_info.default_max_str_digits:
            raise ValueError(f"cannot be read as TOML: {error}") from None
        raise ValueError(f"a number in it has {digits:,} digits, too many") from None


def _parts_of_key(line: str) -> int:
    """The parts of the key with which a line begins, roughly: dots in a text before an equals sign count, too."""
    return line.partition("=")[0].partition("#")[0].count(".") + 1


def _toml_hint(text: str, error: str) -> str:
    """Return what is probably wrong in the line that a TOML error names: missing quotes, as the end of a sentence; ""
    if it is something else."""
    number = re.search(r"at line (\d+)", error)
    lines = text.splitlines()
    if number is None or not 1 <= int(number[1]) <= len(lines):
        return ""
    line = lines[int(number[1]) - 1]
    given = re.fullmatch(r"\s*[\w.-]+\s*=\s*([^#]*?)\s*(#.*)?", line)
    if given is not None and (comma := units.comma_error(given[1])):
        return f"; {given[1]} {comma}"
    bare = re.search(rf"({units.NUMBER})\s*([A-Za-z°%][\w/^²%.]*)\s*(?=[,\]#]|$)", line)
    if bare is not None and units.suggestion(bare[2]):
        return f'; a value with a unit goes in quotes: "{bare[1]} {units.suggestion(bare[2])}"'
    word = re.fullmatch(r"\s*[\w.-]+\s*=\s*([A-Za-z][\w/-]*)\s*(#.*)?", line)
    return f'; a word goes in quotes: "{word[1]}"' if word is not None else ""


def toml_value(text: str) -> Any:
    """A TOML value, or else the text as a string."""
    try:
        parsed = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        return text
    return parsed["value"] if len(parsed) == 1 else text


def short_toml(value: Any) -> str:
    """A value as a TOML file would write it, shortened."""
    try:
        text = json.dumps(value, ensure_ascii=False, default=str)
    except (ValueError, RecursionError):
        text = str(type(value).__name__)
    text = {"NaN": "nan", "Infinity": "inf", "-Infinity": "-inf"}.get(text, text)
    return shortened(text, 60)
