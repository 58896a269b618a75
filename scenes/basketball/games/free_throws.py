"""Free throws: ten each, in turn; then sudden death."""

from __future__ import annotations

from sandbox.sport.match import Shootout


class FreeThrows(Shootout):
    """Ten throws each; more of them in wins."""

    title = "Free throws"
    goal = "Ten throws each, in turn: more of them in wins"
    preset = "free-throw"
    facts = ("made",)
    fact = "made"
    shots = 10
    words = ("missed", "scored")


GAME = FreeThrows
