"""Nine-ball (WPA, rules of play 2): meet the lowest ball first; whoever pots the nine in a legal shot wins.

A nine that is potted in a foul is spotted, other balls stay down. Three fouls one after the other lose. ``pool.py`` has
what is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sandbox.tasks.match import Outcome

from ..pool import CUE, Pool

NINE, FOULS = "9", 3


@dataclass(frozen=True)
class NineBall(Pool):
    """The lowest ball first, until the nine is potted."""

    title = "Nine-ball"
    goal = "Meet the lowest ball first; whoever pots the 9 wins"
    preset = "nine-ball-break"
    rack = "nine-ball"

    @property
    def targets(self) -> Sequence[str]:
        balls = ["1"] if self.balls is None else [name for name in self.balls if name != CUE]
        return [min(balls, key=int)]

    def after(self, outcome: Outcome) -> NineBall:
        foul = self.fault(outcome)
        if self.breaks and outcome["first_contact"] not in (None, "1") and not foul:
            foul = f"meets the {outcome['first_contact']} first"
        potted = [name for name in outcome["potted"] if name != CUE]
        if NINE in potted and not foul:
            return self.won_by(self.turn, f"{self.player} pots the 9")
        if foul and self.fouls[self.turn] + 1 == FOULS:
            return self.won_by(1 - self.turn, f"{self.player}: {foul}, the third foul in a row", foul=foul)
        again = self.illegal_break(outcome) if not foul else None
        table = self.table_after(outcome, spotted=[NINE] if NINE in potted else [])
        return again or self.next_shot(outcome, foul, bool(potted), balls=table)

    @property
    def scores(self) -> tuple[str, str]:
        def score(player: int) -> str:
            fouls = self.fouls[player]
            return f"{fouls} foul{'s' * (fouls > 1)} in a row" if fouls else "on the " + self.targets[0]

        return score(0), score(1)


GAME = NineBall
