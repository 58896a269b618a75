"""Targets and results of a search."""

from __future__ import annotations

from dataclasses import dataclass, field
from math import isfinite
from typing import Any, ClassVar

import numpy as np

from sandbox import display, units
from sandbox.errors import RequestError
from sandbox.lab.axes import Span
from sandbox.scene import Scene

#: The wanted value of a number that is to be maximized.
MAXIMIZE = object()


@dataclass(frozen=True)
class Target:
    """A result and its wanted value: a number in the result's unit, an int if the result counts; true, false or a word;
    or MAXIMIZE."""

    name: str
    value: Any

    @property
    def is_number(self) -> bool:
        """True for a number that may have any value between others."""
        return isinstance(self.value, float)

    @property
    def is_ordered(self) -> bool:
        """True for any number, which results can be near to."""
        return isinstance(self.value, int | float) and not isinstance(self.value, bool)

    @property
    def is_maximum(self) -> bool:
        """True if the result is to be maximized."""
        return self.value is MAXIMIZE

    def __str__(self) -> str:
        return f"maximum {self.name}" if self.is_maximum else f"{self.name} = {self.value}"

    def met(self, value: Any) -> bool:
        """True if a run's value is the wanted one, or holds it; for targets that are not numbers."""
        if isinstance(value, list | dict):
            return self.value in value or (isinstance(value, dict) and self.value in value.values())
        return bool(value == self.value and isinstance(value, bool) == isinstance(self.value, bool))


@dataclass(frozen=True)
class Trial:
    """One run of a search: its parameter values, and the targeted results, None if missing."""

    values: tuple[float, ...]
    found: tuple[Any, ...]
    phase: str  # "scan", or "solve" with the number of the start or bracket


@dataclass(frozen=True)
class Interval:
    """An interval in which the target is met throughout; it may continue beyond an end of the range."""

    low: float
    high: float
    low_error: float | None  # None if the finer runs find no such end, or the interval is cut off by the range
    high_error: float | None
    open_low: bool  # cut off by the range
    open_high: bool

    @property
    def width(self) -> float:
        return self.high - self.low


@dataclass(frozen=True)
class Region:
    """A connected region of two parameters in which the target is met."""

    share: float  # of the whole range, by area
    room: dict[str, float]  # by which each parameter may be off, in its unit, as long as the other is right


@dataclass(frozen=True)
class Solution:
    """Values that meet the targets, their numerical errors (None: unknown), and the run's result with its errors."""

    values: dict[str, float]
    errors: dict[str, float | None]
    result: dict[str, Any]
    result_errors: dict[str, float]
    interval: Interval | None = None  # for a target that is not a number; the value is its middle
    region: Region | None = None  # the same for two parameters; the values are its most forgiving point


@dataclass(frozen=True)
class Aim(display.Reported):
    """The result of a search. ``solutions`` are in order of the value, or the widest interval first.

    >>> import sandbox
    >>> found = sandbox.aim("golf", {"launch.angle": (2, 40)}, {"carry": "250 yd"})
    >>> len(found.solutions), sorted(found.solutions[0].values)
    (2, ['launch.angle'])
    """

    REPORTED_BY: ClassVar = "sandbox.lab.aim.report"

    scene: Scene
    spans: tuple[Span, ...]
    targets: tuple[Target, ...]
    solutions: list[Solution]
    nearest: Trial | None  # the best of all tries, if there is no solution
    jumps: list[tuple[Trial, Trial]]  # where the result jumps over the target between two nearly equal values
    tries: list[Trial] = field(repr=False)
    failures: int = 0  # tries that failed
    resolution: dict[str, float] = field(default_factory=dict)  # by key: intervals or regions, and gaps in them, that
    # are narrower than this may be missed; empty for targets that are numbers

    def __repr__(self) -> str:
        targets = ", ".join(map(str, self.targets))
        found = "; ".join(", ".join(f"{k} = {v:.6g}" for k, v in one.values.items()) for one in self.solutions)
        return f"<Aim of {self.scene.title} at {targets}: {found or 'no solution'}>"

    @property
    def misses(self) -> dict[str, float]:
        """By how much the nearest try misses each target; empty if there is a solution, or no nearest try."""
        if self.nearest is None:
            return {}
        return {
            target.name: value - target.value
            for target, value in zip(self.targets, self.nearest.found, strict=True)
            if target.is_ordered and value is not None
        }


def parse_target(text: str, scene: Scene) -> Target:
    """``carry=200``, ``carry="219 yd"``, ``made=true``, ``verdict=swish`` or, of a ball named 1, ``potted="1"``. Raises
    RequestError."""
    name, equals, value = (part.strip() for part in text.partition("="))
    if not name or not equals or not value:
        raise RequestError(f"--target {text}: write it as NAME=VALUE, for example --target carry=200")
    return as_target(name, value, scene, "--target")


def as_target(name: str, value: Any, scene: Scene, option: str = "target") -> Target:
    """A target from Python. A number is in the unit of the scene's fact, or has a unit of its own."""
    if isinstance(value, bool | np.bool_):
        return Target(name, bool(value))
    if isinstance(value, str):
        text, unit = value.strip().strip("\"'"), scene.units.get(name, "")
        if text in ("true", "false"):
            return Target(name, text == "true")
        if not unit and (option == "target" or text != value.strip()):
            return Target(name, text)
        try:
            value = units.parse(text, unit)
        except ValueError as error:
            if not unit:
                return Target(name, text)
            raise RequestError(f"{option} {name}={text}: {error}") from None
    if not isinstance(value, int | float | np.number):
        raise RequestError(f"{option} {name}: {value!r} is not a number, true, false or a word")
    if not isfinite(value):
        raise RequestError(f"{option} {name}: {value} cannot be aimed at")
    return Target(name, float(value))
