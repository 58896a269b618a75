"""One end of curling: eight stones each, in turn; the team whose stone lies nearest to the tee scores one for each of
its stones in the house that is nearer than all of the other's (World Curling, rules R5 and R11).

A guard, which lies between hog line and tee line outside the house, may not be taken out before the sixth stone (rule
R7): the stone that did is taken off, and the others are put back. Leaves out: stones that are touched; the centre line.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from math import hypot
from typing import Any

from sandbox.tasks.match import Match, Outcome

from ..scene import DELIVERED, HOG, RINGS

STONES = 16  # of both
PROTECTED = 5  # stones that may not take out a guard
TEAMS = ("red", "yellow")
RADIUS = 0.145  # m, of a stone

Stone = tuple[str, float, float]  # its team; m beyond the tee, and to the left


def is_guard(stone: Stone) -> bool:
    """True if a stone lies between the hog line and the tee line, and outside the house."""
    _, x, y = stone
    return HOG - RADIUS < x < 0.0 and hypot(x, y) > RINGS[0] + RADIUS


def score(stones: tuple[Stone, ...]) -> tuple[int | None, int]:
    """The team that scores, None if no stone lies in the house, and its points."""
    far = sorted((hypot(x, y), team) for team, x, y in stones)
    house = [team for distance, team in far if distance < RINGS[0] + RADIUS]
    if not house:
        return None, 0
    points = next((i for i, team in enumerate(house) if team != house[0]), len(house))
    return TEAMS.index(house[0]), points


@dataclass(frozen=True)
class End(Match):
    """Eight stones each; the second team has the last one."""

    title = "One end"
    goal = "Eight stones each, in turn: score for every stone nearer to the tee than all of the other's"
    facts = ("positions",)

    players: tuple[str, str] = ("Red", "Yellow")
    stones: tuple[Stone, ...] = ()  # that lie on the sheet
    thrown: int = 0  # of both

    def after(self, outcome: Outcome) -> End:
        team, places = TEAMS[self.turn], outcome["positions"]
        names = {DELIVERED: team} | {f"{stone[0]} {i}": stone[0] for i, stone in enumerate(self.stones, 1)}
        stones = tuple((names[name], x, y) for name, (x, y) in places.items())
        out = [i for i, (side, *_) in enumerate(self.stones, 1) if f"{side} {i}" not in places]
        guards = [i for i in out if is_guard(self.stones[i - 1]) and self.stones[i - 1][0] != team]
        foul = "took out a guard before the sixth stone" if guards and self.thrown < PROTECTED else ""
        stones = self.stones if foul else stones
        nearest, points = score(stones)
        lies = "nobody lies in the house" if nearest is None else f"{self.players[nearest]} lies {points}"
        said = f"{self.player} {foul}, and all is put back; {lies}" if foul else f"{self.player}'s stone: {lies}"
        after = replace(self, stones=stones, thrown=self.thrown + 1)
        if after.thrown < STONES:
            return after.going_on(said, 1 - self.turn, foul=foul)
        what = "a blank end" if nearest is None else f"{self.players[nearest]} scores {points}"
        return after.won_by(nearest, f"{self.player}'s stone: {what}", foul=foul)

    @property
    def scores(self) -> tuple[str, str]:
        team, points = score(self.stones)
        first, second = (f"lies {points}" if team == side else "lies 0" for side in (0, 1))
        return first, second

    @property
    def start(self) -> Mapping[str, Any]:
        return {
            "team": TEAMS[self.turn],
            "stones": [{"team": team, "x": x, "y": y} for team, x, y in self.stones],
            "launch.speed": 1.85,  # m/s: short of the hog line
            "launch.angle": 0.0,
        }


GAME = End
