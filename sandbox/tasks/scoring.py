"""The worth of a shot, and the score that the attempts of a session add up to."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sandbox.errors import RequestError
from sandbox.sport.amounts import amount


@dataclass(frozen=True)
class Wanted:
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
    """The rule by which the facts of shots become a score.

    ``how`` is ``sum`` (numbers add up, true counts one, a list its length), ``greatest`` (of a number), ``nearest``
    (the smallest distance of a number from ``target``), ``points`` (by ``rings`` around the target) or ``fewest`` (the
    shots until the fact is true). All numbers are in the fact's unit.
    """

    fact: str
    unit: str
    how: str = "sum"
    target: float = 0.0
    rings: tuple[tuple[float, float], ...] = ()  # distance from the target, points; the nearest first
    wanted: tuple[Wanted, ...] = ()  # without which a shot counts nothing
    farthest: float = 0.0  # the distance that counts for a shot that has none, and at most
    word: str = "made"  # that follows a score without a unit, in the plural: pins, points, shots

    @property
    def lower_is_better(self) -> bool:
        """True where a smaller score is a better one."""
        return self.how in ("nearest", "fewest")

    @property
    def total_unit(self) -> str:
        """The unit of a score, "" for points and counts."""
        return "" if self.how in ("points", "fewest") else self.unit

    @property
    def facts(self) -> tuple[str, ...]:
        """The facts of the scene that are read."""
        return tuple(dict.fromkeys((self.fact, *(wanted.fact for wanted in self.wanted))))

    def of_shot(self, result: Mapping[str, Any]) -> float | None:
        """The worth of a shot with these facts; None for a number that it does not have.

        Of ``fewest`` 1 if it is made, and else 0.
        """
        value = result[self.fact]
        if isinstance(value, str):
            raise RequestError(
                f'score.fact = "{self.fact}": is "{value}" here; what counts is a number, a list, true or false'
            )
        counts = all(wanted.met(result) for wanted in self.wanted)
        if self.how in ("sum", "fewest"):
            return _size(value) if counts else 0.0
        if not counts or not isinstance(value, int | float):
            return 0.0 if self.how == "points" else None
        distance = abs(value - self.target)
        if self.how == "nearest":
            return distance
        if self.how == "points":
            return next((points for within, points in self.rings if distance <= within), 0.0)
        return float(value)

    def of_attempt(self, shots: Sequence[float | None], most: int) -> float | None:
        """The worth of an attempt with shots of these worths; it has at most ``most``."""
        if self.how == "fewest":
            return float(len(shots) if shots and shots[-1] else most + 1)
        return self._together(shots)

    def total(self, attempts: Sequence[float | None]) -> float | None:
        """The score of a session whose attempts are worth this; None before there is one."""
        return sum(value or 0.0 for value in attempts) if self.how == "fewest" else self._together(attempts)

    def _together(self, values: Sequence[float | None]) -> float | None:
        if self.how in ("sum", "points"):
            return float(sum(value or 0.0 for value in values))
        known = [value for value in values if value is not None]
        return (min if self.lower_is_better else max)(known) if known else None

    def reaches(self, score: float | None, threshold: float) -> bool:
        """True if a score is as good as the threshold."""
        if score is None:
            return False
        return score <= threshold if self.lower_is_better else score >= threshold

    def reward(self, worth: float | None) -> float:
        """The reward of one shot for a program that learns: more is better."""
        if self.how == "nearest":
            return -min(self.farthest if worth is None else worth, self.farthest)
        if self.how == "fewest":
            return -1.0
        return worth or 0.0

    def number(self, score: float) -> str:
        """A score, or what a part of it is worth, as a number: ``4``, ``1.25 m``."""
        return amount(score, self.total_unit) if self.total_unit else f"{score:g}"

    def text(self, score: float | None) -> str:
        """The same in words: ``4 made``, ``26 pins``, ``1.25 m``."""
        if score is None:
            return "no score"
        word = self.word.removesuffix("s") if score == 1.0 else self.word
        return self.number(score) if self.total_unit else f"{score:g} {word}"

    def counted(self, worth: float | None) -> str:
        """Return what a shot counts where a distance or rings do: ``off by 0.34 m/s``, ``counts 5 points``; else ""."""
        if self.how == "nearest":
            return "" if worth is None else f"off by {self.number(worth)}"
        return f"counts {self.text(worth)}" if self.how == "points" else ""

    @property
    def said(self) -> str:
        """The score in words: ``"made"``, ``"sum of pins"``, ``"nearest: to_tee"``."""
        if self.how == "sum":
            return self.fact
        return f"{self.how}: {self.fact}" + (f" to {self.target:g} {self.unit}".rstrip() if self.target else "")


def _size(value: Any) -> float:
    """A fact as a number to add up."""
    if isinstance(value, Collection) and not isinstance(value, str):
        return float(len(value))
    return float(value) if isinstance(value, int | float) else 0.0
