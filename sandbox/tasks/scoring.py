"""The worth of a shot, and the score that the attempts of a session add up to."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import groupby
from math import inf
from typing import Any, ClassVar

from sandbox.errors import RequestError
from sandbox.sport.amounts import amount

#: The distance from a target, over the one that passes, that counts for a shot that has none.
_FARTHEST = 10.0


@dataclass(frozen=True)
class Condition:
    """A fact and the value that it must have, or that a list must hold; or the range that it must be in."""

    fact: str
    value: Any = None
    within: tuple[float, float] | None = None

    def met(self, result: Mapping[str, Any]) -> bool:
        """True if the facts of a shot have it."""
        found = result[self.fact]
        if self.within is not None:
            return isinstance(found, int | float) and self.within[0] <= found <= self.within[1]
        if isinstance(found, list | dict):
            return self.value in found or (isinstance(found, dict) and self.value in found.values())
        return bool(found == self.value and isinstance(found, bool) == isinstance(self.value, bool))


@dataclass(frozen=True)
class Score:
    """The rule by which the facts of shots become a score; a kind of score is a subclass, and a row of ``KINDS``.

    What shots are worth adds up, unless a kind says otherwise. All numbers are in the fact's unit.
    """

    how: ClassVar[str]  # its name in task files
    lower_is_better: ClassVar[bool] = False
    has_unit: ClassVar[bool] = True  # False where points or shots add up, whatever the fact's unit
    noun: ClassVar[str] = ""  # that follows a score without a unit, in the plural; "" for ``word``

    fact: str
    unit: str = ""
    wanted: tuple[Condition, ...] = field(default=(), kw_only=True)  # without which a shot counts nothing
    word: str = field(default="made", kw_only=True)  # of the fact: ``pins``
    most: float = field(default=inf, kw_only=True)  # that the fact can be of one shot

    @property
    def total_unit(self) -> str:
        """The unit of a score, "" for points and counts."""
        return self.unit if self.has_unit else ""

    @property
    def facts(self) -> tuple[str, ...]:
        """The facts of the scene that are read."""
        return tuple(dict.fromkeys((self.fact, *(wanted.fact for wanted in self.wanted))))

    def of_shot(self, result: Mapping[str, Any]) -> float | None:
        """The worth of a shot with these facts; None if it has none at all."""
        value = result[self.fact]
        if isinstance(value, str):
            raise RequestError(
                f'score.fact = "{self.fact}": is "{value}" here; what counts is a number, a list, true or false'
            )
        return self._of_value(value if all(wanted.met(result) for wanted in self.wanted) else None)

    def _of_value(self, value: Any) -> float | None:
        """The worth of a shot whose fact has this value; None if a fact that is wanted is missing."""
        return _size(value)

    def of_attempt(self, shots: Sequence[float | None], most: int) -> float | None:
        """The worth of an attempt with shots of these worths; it has at most ``most``."""
        return float(sum(worth or 0.0 for worth in shots))

    def total(self, attempts: Sequence[float | None]) -> float | None:
        """The score of a session whose attempts are worth this; None if none of them is worth anything."""
        return float(sum(worth or 0.0 for worth in attempts))

    def best_total(self, attempts: int, shots: int) -> float:
        """The best score that so many attempts can reach, of so many shots each; inf if the facts set no limit."""
        return attempts * shots * self.most

    def reaches(self, score: float | None, threshold: float) -> bool:
        """True if a score is as good as the threshold."""
        if score is None:
            return False
        return score <= threshold if self.lower_is_better else score >= threshold

    def is_made(self, worth: float | None, passing: float, attempts: int) -> bool:
        """True if a shot of this worth is a success: as good as the mean of the attempts that just pass."""
        return worth is not None and worth > 0.0 and self.reaches(worth, passing / attempts)

    def ends_attempt(self, worth: float | None) -> bool:
        """True if an attempt is over with a shot of this worth, though it may have more."""
        return False

    def reward(self, worth: float | None, passing: float, missed: bool = False) -> float:
        """The reward of one shot for a program that learns: more is better. ``missed`` if it ended its attempt, and was
        no success."""
        return worth or 0.0

    def best_shots(self, worths: Sequence[float | None]) -> list[int]:
        """The places of the shots that count something, the best first."""
        return [i for worth, i in sorted((-(worth or 0.0), i) for i, worth in enumerate(worths)) if worth < 0.0]

    def number(self, score: float) -> str:
        """A score, or what a part of it is worth, as a number: ``4``, ``1.25 m``."""
        return amount(score, self.total_unit) if self.total_unit else f"{score:g}"

    def text(self, score: float | None) -> str:
        """The same in words: ``4 made``, ``26 pins``, ``1.25 m``."""
        if score is None:
            return "no score"
        noun = self.noun or self.word
        return (
            self.number(score) if self.total_unit else f"{score:g} {noun.removesuffix('s') if score == 1.0 else noun}"
        )

    def total_text(self, attempts: Sequence[float | None], shots: int) -> str:
        """The score of attempts that are worth this, of ``shots`` shots at most, in words."""
        return self.text(self.total(attempts))

    def shot_text(self, worth: float | None) -> str:
        """The worth of a shot, ``off by 0.34 m/s``, ``counts 5 points``; "" where its verdict says it."""
        return ""

    @property
    def summary(self) -> str:
        """The rule in a few words: ``made``, ``nearest: to_tee``."""
        return f"{self.how}: {self.fact}"


@dataclass(frozen=True)
class Sum(Score):
    """Numbers add up, true counts one, a list its length."""

    how = "sum"

    def total_text(self, attempts: Sequence[float | None], shots: int) -> str:
        """``4 of 5 made``, where each attempt is made or not."""
        if self.word == "made" and shots == 1 and {0.0, 1.0}.issuperset(attempts):
            return f"{self.number(self.total(attempts) or 0.0)} of {len(attempts)} made"
        return super().total_text(attempts, shots)

    @property
    def summary(self) -> str:
        """The fact alone: adding up is what one expects."""
        return self.fact


@dataclass(frozen=True)
class Greatest(Score):
    """The greatest number of all shots."""

    how = "greatest"

    def _of_value(self, value: Any) -> float | None:
        return float(value) if isinstance(value, int | float) else None

    def of_attempt(self, shots: Sequence[float | None], most: int) -> float | None:
        """The worth of its best shot."""
        return self.total(shots)

    def total(self, attempts: Sequence[float | None]) -> float | None:
        """The worth of the best attempt."""
        known = [worth for worth in attempts if worth is not None]
        return (min if self.lower_is_better else max)(known) if known else None

    def best_total(self, attempts: int, shots: int) -> float:
        """The most of one shot."""
        return self.most

    def is_made(self, worth: float | None, passing: float, attempts: int) -> bool:
        """True if this shot alone passes."""
        return self.reaches(worth, passing)

    def best_shots(self, worths: Sequence[float | None]) -> list[int]:
        """Every shot that has the number counts."""
        sign = 1.0 if self.lower_is_better else -1.0
        return [i for _, i in sorted((sign * worth, i) for i, worth in enumerate(worths) if worth is not None)]


@dataclass(frozen=True)
class Nearest(Greatest):
    """The smallest distance of a number from ``target``."""

    how = "nearest"
    lower_is_better = True
    target: float = field(default=0.0, kw_only=True)

    def _of_value(self, value: Any) -> float | None:
        return abs(value - self.target) if isinstance(value, int | float) else None

    def best_total(self, attempts: int, shots: int) -> float:
        """A hit."""
        return 0.0

    def reward(self, worth: float | None, passing: float, missed: bool = False) -> float:
        """Minus the distance; at most ``_FARTHEST`` times the one that passes."""
        farthest = _FARTHEST * passing
        return -min(farthest if worth is None else worth, farthest)

    def shot_text(self, worth: float | None) -> str:
        """The distance."""
        return "" if worth is None else f"off by {self.number(worth)}"

    @property
    def summary(self) -> str:
        """The rule with its target."""
        return super().summary + _target_text(self.target, self.unit)


@dataclass(frozen=True)
class Points(Score):
    """Points by ``rings`` around a target, each a distance from it and what it is worth, the nearest first."""

    how = "points"
    has_unit = False
    noun = "points"
    rings: tuple[tuple[float, float], ...] = field(kw_only=True)
    target: float = field(default=0.0, kw_only=True)

    def _of_value(self, value: Any) -> float | None:
        if not isinstance(value, int | float):
            return 0.0
        return next((points for within, points in self.rings if abs(value - self.target) <= within), 0.0)

    def best_total(self, attempts: int, shots: int) -> float:
        """Every shot in the best ring."""
        return attempts * shots * max(0.0, *(points for _, points in self.rings))

    def shot_text(self, worth: float | None) -> str:
        """The points."""
        return f"counts {self.text(worth)}"

    @property
    def summary(self) -> str:
        """The rule with its target."""
        return super().summary + _target_text(self.target, self.unit)


@dataclass(frozen=True)
class Fewest(Score):
    """The shots until the fact is true, and one more than there are if it never is."""

    how = "fewest"
    lower_is_better = True
    has_unit = False
    noun = "shots"

    def of_attempt(self, shots: Sequence[float | None], most: int) -> float | None:
        """The number of its shots, or one more than ``most``."""
        return float(len(shots) if shots and shots[-1] else most + 1)

    def best_total(self, attempts: int, shots: int) -> float:
        """One shot in each attempt."""
        return float(attempts)

    def is_made(self, worth: float | None, passing: float, attempts: int) -> bool:
        """True if the fact is."""
        return bool(worth)

    def ends_attempt(self, worth: float | None) -> bool:
        """True if the fact is."""
        return bool(worth)

    def reward(self, worth: float | None, passing: float, missed: bool = False) -> float:
        """Each shot costs one, and a last one that is missed one more."""
        return -2.0 if missed else -1.0


@dataclass(frozen=True)
class Streak(Score):
    """The most attempts in a row in which the fact is true."""

    how = "streak"
    has_unit = False
    noun = "in a row"

    def _of_value(self, value: Any) -> float | None:
        return float(bool(_size(value)))

    def of_attempt(self, shots: Sequence[float | None], most: int) -> float | None:
        """1 if one of its shots counts, else 0."""
        return max((worth or 0.0 for worth in shots), default=0.0)

    def total(self, attempts: Sequence[float | None]) -> float | None:
        """The length of the longest streak."""
        return float(max((len(list(group)) for made, group in groupby(attempts, bool) if made), default=0))

    def best_total(self, attempts: int, shots: int) -> float:
        """All attempts."""
        return float(attempts)

    def is_made(self, worth: float | None, passing: float, attempts: int) -> bool:
        """True if the fact is."""
        return bool(worth)


#: The kinds of score by their names in task files.
KINDS: dict[str, type[Score]] = {kind.how: kind for kind in (Sum, Greatest, Nearest, Points, Fewest, Streak)}


def _target_text(target: float, unit: str) -> str:
    return f" to {target:g} {unit}".rstrip() if target else ""


def _size(value: Any) -> float:
    """A fact as a number to add up."""
    if isinstance(value, Collection) and not isinstance(value, str):
        return float(len(value))
    return float(value) if isinstance(value, int | float) else 0.0
