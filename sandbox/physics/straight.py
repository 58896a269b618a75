"""Functions written out: loops over a few numbers take several times as long as straight Python."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any


def straight(head: str, lines: Iterable[str], file: str, names: Mapping[str, Any] = {}) -> Any:
    """The function ``def head:`` with these lines, in which ``names`` are known; ``file`` is where it was written
    out."""
    scope = dict(names)
    exec(compile("\n ".join([f"def {head}:", *lines]), f"{file}:{head}", "exec"), scope)
    return scope[head.partition("(")[0]]
