"""Penalty kicks to decide a match: best of five, then sudden death (Laws of the Game, law 10.3).

Leaves out: who may kick; the toss; a keeper who leaves his line.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sandbox.tasks.match import Shootout

#: The computer's keeper by its strength: how late he dives, in s, how fast, in m/s, and how far, in m. The second is
#: the scene's, as a person's is; the others are assumed, and so is how unsteady each is (standard deviations).
KEEPERS = {1: (0.34, 3.2, 1.8), 2: (0.245, 3.9, 2.0), 3: (0.17, 4.8, 2.4)}
UNSTEADY = {1: (0.05, 0.5, 0.3), 2: (0.035, 0.3, 0.2), 3: (0.02, 0.2, 0.1)}
DIVE = ("keeper.dive.reaction", "keeper.dive.speed", "keeper.dive.reach")


class PenaltyKicks(Shootout):
    """Five kicks each from 11 m; the keeper dives to where he sees the ball go."""

    title = "Penalty kicks"
    goal = "Five kicks each, past a keeper who dives: more goals win"
    facts = ("goal",)
    fact = "goal"
    shots = 5

    def _of_keeper(self, each: Mapping[int, tuple[float, ...]]) -> dict[str, float]:
        """The values of the computer's keeper, as he faces the other's kick."""
        return dict(zip(DIVE, each.get(self.opponent if self.turn == 0 else 0, ()), strict=False))

    @property
    def scatter(self) -> Mapping[str, float]:
        return self._of_keeper(UNSTEADY)

    @property
    def start(self) -> Mapping[str, Any]:
        return {
            **self._of_keeper(KEEPERS),
            "wall.present": False,
            "launch.angle": 0.0,  # deg: at the keeper
            "launch.spin": 0.0,  # rpm: a kick that bends is the player's choice
            "goal.distance": 11.0,  # m (Laws of the Game, law 14)
            "keeper.distance": 0.1,  # m, on his line
            "keeper.offset": 0.0,
            "keeper.dive.dives": True,
        }


GAME = PenaltyKicks
