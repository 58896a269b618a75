"""Free throws: ten each, in turn; then sudden death."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sandbox.tasks.match import Shootout


class FreeThrows(Shootout):
    """Ten throws each; more of them in wins."""

    title = "Free throws"
    goal = "Ten throws each, in turn: more of them in wins"
    preset = "free-throw"
    facts = ("made",)
    fact = "made"
    shots = 10
    words = ("missed", "scored")

    @property
    def start(self) -> Mapping[str, Any]:
        return {"launch.speed": 6.5}  # m/s: too short


GAME = FreeThrows
