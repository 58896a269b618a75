"""Three-cushion points (UMB): a point for meeting both other balls, the second one after three cushions at least.

The players have the white and the yellow ball. A point gives another shot. The first shot must meet the red one first.
Whoever has ``POINTS`` first wins, but the second player, who has had one turn less, plays to the end of his inning.
Leaves out: frozen balls; that he begins his last inning from the position of the first.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from sandbox.tasks.match import Match, Outcome
from sandbox.text import with_noun

POINTS, CUSHIONS = 5, 3
CUES, RED = ("white", "yellow"), "red"
#: The start (UMB), in m on a table of 2.84 m by 1.42 m: red on the foot spot, the other's ball on the head spot, and
#: the striker's 182.5 mm to the side of it.
HEAD, FOOT, ASIDE = -0.71, 0.71, 0.1825
START = (("white", HEAD, -ASIDE), ("yellow", HEAD, 0.0), (RED, FOOT, 0.0))


@dataclass(frozen=True)
class ThreeCushion(Match):
    """Five points by three cushions."""

    title = "Three-cushion"
    goal = f"Meet both other balls, the second after three cushions: {POINTS} points win"
    preset = "three-rail-carom"
    shown = "first contact"
    facts = ("point", "first_contact", "positions")

    players: tuple[str, str] = ("White", "Yellow")
    points: tuple[int, int] = (0, 0)
    balls: tuple[tuple[str, float, float], ...] = START
    opening: bool = True  # the first shot

    def after(self, outcome: Outcome) -> ThreeCushion:
        cushions, first = outcome["point"], outcome["first_contact"]
        foul = "meets the other ball before the red" if self.opening and first not in (None, RED) else ""
        scored = cushions is not None and cushions >= CUSHIONS and not foul
        points = list(self.points)
        points[self.turn] += scored
        both = (points[0], points[1])
        what = "a point" if scored else "no point"
        way = "misses a ball" if cushions is None else f"after {with_noun(cushions, 'cushion')}"
        text = f"{self.player}: {foul or f'{what}, {way}'}"
        balls = tuple((name, x, y) for name, (x, y) in outcome["positions"].items())
        after = replace(self, balls=balls, opening=False, points=both)
        ended = self.turn == 1 and not scored and points[0] >= POINTS
        if points[1] >= POINTS or ended:
            winner = None if points[0] == points[1] else int(points[1] > points[0])
            return after.won_by(winner, text, foul=foul)
        done = not scored or points[0] >= POINTS > self.points[0]
        return after.going_on(text, 1 - self.turn if done else self.turn, foul=foul)

    @property
    def scores(self) -> tuple[str, str]:
        first, second = map(str, self.points)
        return first, second

    @property
    def start(self) -> Mapping[str, Any]:
        return {
            "balls": [{"name": name, "x": x, "y": y} for name, x, y in self.balls],
            "cue.ball": CUES[self.turn],
        }


GAME = ThreeCushion
