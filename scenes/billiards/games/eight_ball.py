"""Eight-ball (WPA, rules of play 3): pot your seven, solids or stripes, and then the eight.

The groups are open until a ball is potted in a legal shot after the break; if balls of both are, the first decides. An
eight that is potted in the break is spotted. ``pool.py`` has what is left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from sandbox.tasks.match import Outcome

from ..pool import CUE, Pool

EIGHT = "8"
GROUPS = {
    "solids": tuple(str(ball) for ball in range(1, 8)),
    "stripes": tuple(str(ball) for ball in range(9, 16)),
}
OTHER = {"solids": "stripes", "stripes": "solids"}


def group_of(ball: str) -> str:
    """The group of a ball; "" for the eight."""
    return next((group for group, balls in GROUPS.items() if ball in balls), "")


@dataclass(frozen=True)
class EightBall(Pool):
    """Solids against stripes; ``groups`` are "" while they are open."""

    title = "Eight-ball"
    goal = "Pot all solids or all stripes, and then the eight"
    preset = "eight-ball-break"
    rack = "eight-ball"
    behind_after_break = True
    opponents = True

    groups: tuple[str, str] = ("", "")  # of each player

    def left(self, player: int) -> list[str]:
        """The balls of a player's group that are on the table."""
        group, balls = self.groups[player], self.balls
        return [] if not group else [ball for ball in GROUPS[group] if balls is None or ball in balls]

    @property
    def targets(self) -> Sequence[str]:
        if not self.groups[self.turn]:
            return [ball for balls in GROUPS.values() for ball in balls]
        return self.left(self.turn) or [EIGHT]

    def after(self, outcome: Outcome) -> EightBall:
        potted, foul = [name for name in outcome["potted"] if name != CUE], self.fault(outcome)
        if self.breaks:
            table = self.table_after(outcome, spotted=[EIGHT] if EIGHT in potted else [])
            again = self.illegal_break(outcome)
            return again or self.next_shot(outcome, foul, bool(potted), balls=table)
        if EIGHT in potted:
            return self._eight(foul)
        groups = self.groups
        if not groups[0] and potted and not foul:
            group = group_of(potted[0])
            groups = (group, OTHER[group]) if self.turn == 0 else (OTHER[group], group)
        own = [ball for ball in potted if group_of(ball) == groups[self.turn] != ""]
        return self.next_shot(outcome, foul, bool(own), groups=groups)

    def _eight(self, foul: str) -> EightBall:
        """The match after the eight was potted: won if it was its turn, and without a foul."""
        early = self.targets != [EIGHT]
        if foul or early:
            why = foul or "before its turn"
            return self.won_by(1 - self.turn, f"{self.player} pots the 8: {why}", foul=foul or "the 8 too early")
        return self.won_by(self.turn, f"{self.player} pots the 8")

    @property
    def scores(self) -> tuple[str, str]:
        def score(player: int) -> str:
            group, left = self.groups[player], len(self.left(player))
            return f"{group}, {left} left" if left else f"{group}, on the 8" if group else "open"

        return score(0), score(1)


GAME = EightBall
