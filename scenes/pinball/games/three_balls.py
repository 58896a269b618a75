"""Three balls of pinball each, in turn: more points win."""

from __future__ import annotations

from dataclasses import dataclass

from sandbox.tasks.match import Match, Outcome

BALLS = 3  # of each


@dataclass(frozen=True)
class ThreeBalls(Match):
    """Three balls each; more points win."""

    title = "Three balls"
    goal = "Three balls each, in turn: more points win"
    shown = "first contact"
    facts = ("score",)

    points: tuple[int, int] = (0, 0)
    balls: int = 0  # of both

    def after(self, outcome: Outcome) -> ThreeBalls:
        won, points = int(outcome["score"]), list(self.points)
        points[self.turn] += won
        both, balls, text = (points[0], points[1]), self.balls + 1, f"{self.player}: {won} points"
        if balls < 2 * BALLS:
            return self.going_on(text, 1 - self.turn, points=both, balls=balls)
        winner = None if both[0] == both[1] else int(both[1] > both[0])
        return self.won_by(winner, text, points=both, balls=balls)

    @property
    def scores(self) -> tuple[str, str]:
        first, second = map(str, self.points)
        return first, second


GAME = ThreeBalls
