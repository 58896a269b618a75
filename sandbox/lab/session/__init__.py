"""A session: a player's shots by club, pitch or any other column, as a coach wants them; and what the model says."""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from sandbox.lab.session.summary import Session, session

__all__ = ["Session", "session"]


def __getattr__(name: str) -> Any:
    if name in __all__:
        return getattr(import_module("sandbox.lab.session.summary"), name)
    raise AttributeError(f"module 'sandbox.lab.session' has no attribute {name!r}")
