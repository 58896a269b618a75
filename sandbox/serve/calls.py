"""Calls of the server to other processes. It knows these names only: what they need, such as pygame and the
scenes, is never imported in its own process."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from time import monotonic
from typing import Any, Literal, NamedTuple, TypedDict

_Changes = Mapping[str, Any]
Kind = Literal["path", "hidden", "stage", "fan", "shot"]
#: The room for a picture where a page does not say.
ROOM = (960, 640)


class Game(NamedTuple):
    """A player's place in a task: the seed of its starts, the player's number, and the values of each shot so far."""

    seed: int
    player: int
    shots: tuple[Mapping[str, float], ...] = ()


class Duel(NamedTuple):
    """The match of two players in a game of a scene: their names, the seed of their aims, the facts of each shot."""

    game: str
    players: tuple[str, str]
    seed: int
    outcomes: tuple[Mapping[str, Any], ...] = ()


class Ask(NamedTuple):
    """A player's question: a scene with changes or, with a ``game``, a task or a match with its controls set."""

    source: str
    changes: _Changes
    n: int  # by which the browser recognises the answer
    room: tuple[int, int] = ROOM  # px of the page for the picture, across and down
    units: str = "si"
    game: Game | Duel | None = None


class Reply(TypedDict, total=False):
    """A result: a message for the browser, ready to be sent, and what the server keeps of it; or an error."""

    message: bytes  # JSON, deflated; of a small picture the image
    kept: dict[str, Any]
    error: str


def timed(work: Callable[..., Reply], *args: Any) -> tuple[Reply, float]:
    """The reply of ``work(*args)``, and the time in s that it took, without that in which others had the core."""
    began, waited = monotonic(), _waited_for_core()
    reply = work(*args)
    return reply, monotonic() - began - (_waited_for_core() - waited)


def _waited_for_core() -> float:
    """The time in s in which this process was ready to go on and had no core; 0 where the system does not say."""
    try:
        return int(Path("/proc/self/schedstat").read_text("ascii").split()[1]) / 1e9
    except (OSError, ValueError, IndexError):
        return 0.0


def described(source: str, is_task: bool, duel: Duel | None = None) -> Reply:
    """A scene, a task or the next shot of a match for the browser: its parameters with their bounds, what a pull does,
    the results to predict."""
    from sandbox.serve import work

    return work.described(source, is_task, duel)


def small(ask: Ask) -> Reply:
    """A small picture of a shot, as an image file."""
    from sandbox.serve import work

    return work.small(ask)


def computed(kind: Kind, ask: Ask) -> Reply:
    """The path, the place, the fan or the whole shot that is asked for; or the start of a hidden path."""
    from sandbox.serve import work

    return work.WORKS[kind](ask)


def warmed(sources: Sequence[str]) -> Reply:
    """Import what is needed, and run each scene once: the first player does not wait for that."""
    from sandbox.serve import work

    return work.warmed(sources)
