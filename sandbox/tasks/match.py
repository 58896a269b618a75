"""A match: two players or teams take turns, by the rules of a game.

A ``Match`` is where a match stands, and does not change: ``match.after(outcome)`` is where it stands after one more
shot, from the facts of its run alone. So rules need no window and no simulation, and a match can be written down move
by move. A game is a subclass in ``games/<name>.py`` of the scene that it is played in, which calls it ``GAME``.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar, TypeVar

#: The facts of a run, by their keys.
Outcome = Mapping[str, Any]
PLAYERS = ("Player 1", "Player 2")
_Same = TypeVar("_Same", bound="Match")


@dataclass(frozen=True)
class Match:
    """The state of a match. A game defines ``after``, ``scores`` and, unless all shots begin alike, ``start``."""

    title: ClassVar[str] = ""
    goal: ClassVar[str] = ""  # what it is about, in one sentence
    preset: ClassVar[str] = ""  # of the scene, from which it is played; "" for the scene itself
    facts: ClassVar[tuple[str, ...]] = ()  # that ``after`` reads
    shown: ClassVar[str] = "one metre"  # how much of the path the players see, as in a task

    opponents: ClassVar[bool] = False  # whether a computer can play it: ``value`` says what is good

    players: tuple[str, str] = PLAYERS
    turn: int = 0  # 0 or 1, whose it is
    said: str = ""  # what came of the last shot, in a sentence
    foul: str = ""  # what was against the rules in it
    finished: bool = False
    winner: int | None = None  # 0 or 1; None for a draw, and before the end
    opponent: int = 0  # how strong the computer is that plays second, from 1 to 3; 0 if a person does

    def after(self: _Same, outcome: Outcome) -> _Same:
        """The match after the shot of the player whose turn it is."""
        raise NotImplementedError

    def value(self, outcome: Outcome) -> float:
        """The value of a shot with these facts to the player whose turn it is: more is better."""
        after = self.after(outcome)
        if after.finished:
            return 2.0 if after.winner == self.turn else -2.0
        return -1.0 if after.foul else float(after.turn == self.turn)

    def allows(self, wanted: Mapping[str, Any]) -> bool:
        """False for a shot that is against the rules if it comes to these facts: a computer does not try it."""
        return True

    @property
    def by_computer(self) -> bool:
        """True if the computer has the next shot."""
        return bool(self.opponent) and self.turn == 1 and not self.finished

    @property
    def scores(self) -> tuple[str, str]:
        """The score of each of the two, in a word or two."""
        raise NotImplementedError

    @property
    def start(self) -> Mapping[str, Any]:
        """The changes of the scene's parameters with which the next shot begins. It is aimed so that who shoots at once
        gains nothing."""
        return {}

    @property
    def scatter(self) -> Mapping[str, float]:
        """The standard deviations of what the computer does in the other's shot, such as a keeper's dive, by the keys
        of the scene's parameters."""
        return {}

    @property
    def free(self) -> tuple[str, ...]:
        """The keys of what the player may place as he likes, such as a ball in hand."""
        return ()

    @property
    def placement_area(self) -> tuple[float, float, float, float] | None:
        """The area where that may be placed: from x, y to x, y, in m; None for anywhere."""
        return None

    @property
    def placing(self) -> str:
        """The hint to the player on that, in a few words."""
        return ""

    @property
    def player(self) -> str:
        """The one whose turn it is."""
        return self.players[self.turn]

    @property
    def status(self) -> str:
        """Whose turn it is, or how it ended, in a sentence."""
        if not self.finished:
            return f"{self.player} to play"
        return "A draw" if self.winner is None else f"{self.players[self.winner]} wins"

    def going_on(self: _Same, said: str, turn: int, **changes: Any) -> _Same:
        """The match with another shot to be played, by the player ``turn``."""
        return replace(self, said=said, turn=turn, **{"foul": "", **changes})

    def won_by(self: _Same, winner: int | None, said: str, **changes: Any) -> _Same:
        """The match at its end; without a winner it is a draw."""
        return replace(self, said=said, finished=True, winner=winner, **{"foul": "", **changes})


@dataclass(frozen=True)
class Shootout(Match):
    """Each in turn has ``shots`` shots; whoever scores more often wins, as soon as the other can no longer draw level.
    If they are level then, one more each, until one has scored and the other has not."""

    fact: ClassVar[str] = ""  # true if a shot scored
    shots: ClassVar[int] = 5
    words: ClassVar[tuple[str, str]] = ("missed", "scored")
    opponents: ClassVar[bool] = True

    taken: tuple[tuple[bool, ...], tuple[bool, ...]] = ((), ())  # by each player, in order: whether it scored

    def value(self, outcome: Outcome) -> float:
        return float(bool(outcome[self.fact]))

    def after(self, outcome: Outcome) -> Shootout:
        scored, taken = bool(outcome[self.fact]), list(self.taken)
        taken[self.turn] = (*taken[self.turn], scored)
        first, second = taken
        lead, (one, other) = sum(first) - sum(second), (len(first), len(second))
        said = f"{self.player} {self.words[scored]}: {sum(first)} to {sum(second)}"
        left = max(self.shots - one, 0), max(self.shots - other, 0)
        decided = lead > left[1] or -lead > left[0]
        if (one == other if max(one, other) > self.shots else True) and decided:
            return self.won_by(0 if lead > 0 else 1, said, taken=(first, second))
        return self.going_on(said, 1 - self.turn, taken=(first, second))

    @property
    def scores(self) -> tuple[str, str]:
        first, second = (f"{sum(shots)} of {len(shots)}" for shots in self.taken)
        return first, second


def named(balls: Sequence[str]) -> str:
    """``the 1, the 3 and the 7``."""
    called = [f"the {name}" for name in balls]
    return " and ".join([", ".join(called[:-1]), called[-1]] if len(called) > 1 else called)
