"""Nearest the pin: three balls each from the same tee, in turn; the nearest of all wins.

A ball in the water does not count; one in the hole wins, unless the other holes one, too.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from sandbox.sport.amounts import roughly
from sandbox.tasks.match import Match, Outcome

SHOTS = 3  # of each


@dataclass(frozen=True)
class NearestThePin(Match):
    """Three balls each; the nearest to the pin wins."""

    title = "Nearest the pin"
    goal = "Three balls each, in turn: the one nearest to the pin wins"
    preset = "9-iron"
    facts = ("distance_to_pin", "holed", "ended")
    opponents = True

    best: tuple[float | None, float | None] = (None, None)  # m from the pin, of each
    shots: int = 0  # of both

    def value(self, outcome: Outcome) -> float:
        return -1e3 if outcome["ended"] == "water" else 0.0 if outcome["holed"] else -outcome["distance_to_pin"]

    def after(self, outcome: Outcome) -> NearestThePin:
        wet = outcome["ended"] == "water"
        far = 0.0 if outcome["holed"] else outcome["distance_to_pin"]
        said = "in the water" if wet else "in the hole" if outcome["holed"] else f"{roughly(far)} from the pin"
        best, own = list(self.best), self.best[self.turn]
        if not wet and (own is None or far < own):
            best[self.turn] = far
        both, shots = (best[0], best[1]), self.shots + 1
        if shots < 2 * SHOTS:
            return self.going_on(f"{self.player}: {said}", 1 - self.turn, best=both, shots=shots)
        first, second = (float("inf") if far is None else far for far in both)
        winner = None if first == second else int(second < first)
        return self.won_by(winner, f"{self.player}: {said}", best=both, shots=shots)

    @property
    def scores(self) -> tuple[str, str]:
        first, second = ("-" if far is None else "holed" if far == 0.0 else roughly(far) for far in self.best)
        return first, second

    @property
    def start(self) -> Mapping[str, Any]:
        return {"launch.speed": 40.0}  # m/s: too short


GAME = NearestThePin
