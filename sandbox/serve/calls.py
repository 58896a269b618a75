"""What the server has called in other processes. It knows these names only: what they need, such as pygame and the
scenes, is never imported in its own process."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypedDict

Changes = Mapping[str, Any]
Kind = Literal["path", "hidden", "stage", "fan", "shot"]


class Reply(TypedDict, total=False):
    """What was computed: a message for the browser, ready to be sent; what the server keeps of it; or an error."""

    message: bytes  # JSON, deflated
    kept: dict[str, Any]
    error: str


def described(source: str) -> Reply:
    """A scene for the browser: its parameters with their bounds, what a pull does, the results it can predict."""
    from sandbox.serve import work

    return work.described(source)


def computed(kind: Kind, source: str, changes: Changes, n: int, narrow: bool, units: str) -> Reply:
    """The path, the place, the fan or the whole shot of a scene with these parameters; or a hidden path's start."""
    from sandbox.serve import work

    return work.WORKS[kind](source, changes, n, narrow, units)


def warmed(sources: Sequence[str]) -> Reply:
    """Import what is needed, and run each scene once: the first player does not wait for that."""
    from sandbox.serve import work

    return work.warmed(sources)
