"""Penalty kicks to decide a match: best of five, then sudden death (Laws of the Game, law 10.3).

Leaves out: who may kick; the toss; a keeper who leaves his line.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from sandbox.tasks.match import Shootout

#: The computer's keeper by its strength: how late he dives, in s, and how fast, in m/s. The second is the scene's, as a
#: person's is; the others are assumed.
KEEPERS = {
    1: {"keeper.dive.reaction": 0.34, "keeper.dive.speed": 3.2},
    2: {},
    3: {"keeper.dive.reaction": 0.19, "keeper.dive.speed": 4.4},
}


class PenaltyKicks(Shootout):
    """Five kicks each from 11 m; the keeper dives to where he sees the ball go."""

    title = "Penalty kicks"
    goal = "Five kicks each, past a keeper who dives: more goals win"
    facts = ("goal",)
    fact = "goal"
    shots = 5

    @property
    def start(self) -> Mapping[str, Any]:
        keeper = KEEPERS.get(self.opponent if self.turn == 0 else 0, {})
        return {
            **keeper,
            "wall.present": False,
            "launch.angle": 0.0,  # deg: at the keeper
            "goal.distance": 11.0,  # m (Laws of the Game, law 14)
            "keeper.distance": 0.1,  # m, on his line
            "keeper.offset": 0.0,
            "keeper.dive.dives": True,
        }


GAME = PenaltyKicks
