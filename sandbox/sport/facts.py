"""Facts: the results of a run, each defined once.

A scene lists them, the most important first, and adds one sentence::

    FACTS = (
        Fact("carry", "carry", "m", carry, final_when="ground"),
        Fact("apex", "apex", "m", lambda run, parameters: run.highest("ball")[1][1]),
    )

    def verdict(run, parameters) -> str:
        return f"{roughly(run.result['carry'])} carry"

The terminal's card, JSON, posters, frames, the window, charts and all their units are made from these.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from inspect import signature
from math import dist
from typing import TYPE_CHECKING, Any, TypeVar
from weakref import ref

from sandbox import units
from sandbox.sport.amounts import amount, in_both, margin, metres

if TYPE_CHECKING:
    from sandbox.engine.model.setup import Until
    from sandbox.engine.paths.run import Run

#: ``"start"``, ``"end"``, the name of what must have been touched, or a function of the parameters that gives the
#: condition.
FinalWhen = str | Callable[[Any], "Until"]
_Value = TypeVar("_Value")


@dataclass(frozen=True)
class Fact:
    """One result of a run: a number with its unit, a word, true or false, or a list of words.

    ``compute(run, parameters)`` returns the value in ``unit``, None if it did not happen. ``final_when`` says when it
    can no longer change: ``"start"``, ``"end"``, the first touch of a surface or ball of that name (``"floor"``), or
    a function of the parameters that gives a condition as for the end of a run.

    Of many shots at once it is first asked for all values together: run and parameters then have arrays, as far as
    ``first_crossing``, ``before_meeting`` and ``highest`` of a run give them. What cannot work with these, such as a
    comparison or the list of events, is an error, and the fact is computed from one run after another.
    """

    key: str  # its name in the result, in JSON and CSV
    label: str  # on cards; "" leaves it out of them
    unit: str  # "" for a value without one
    compute: Callable[[Run, Any], Any]
    final_when: FinalWhen = "end"
    also: str = ""  # a second unit that is common in the sport, shown where there is room
    sides: tuple[str, str] | None = None  # words for below and above zero, in place of a sign
    where: Callable[[Run, Any], bool] | None = None  # on cards only where this holds
    in_order: bool = True  # whether the order of a list matters where many runs are compared
    digits: int | None = None  # after the point, where its unit usually has others
    names: bool = False  # whether its words are names of balls, surfaces and traps
    most: float | None = None  # that it can be, or count, in one shot: what a task may ask for depends on it

    def text(self, value: Any, error: float | None = None, also: bool = False) -> str:
        """The value as text; "" for what did not happen.

        With its estimated error if there is one and, if ``also``, in the second unit too.
        """
        if value is None or (not value and isinstance(value, Sequence | Mapping)):
            return ""
        if isinstance(value, bool):
            return "yes" if value else "no"
        if isinstance(value, int | float):
            return self._number(value, error, also)
        if isinstance(value, Mapping):
            return ", ".join(f"{name} ({what})" for name, what in value.items())
        return value if isinstance(value, str) else ", ".join(map(self.text, value))

    def _number(self, value: float, error: float | None, also: bool) -> str:
        size = abs(value) if self.sides else value
        first, second = amount(size, self.unit, self.digits), ""
        if self.also:
            first, second = in_both(size, self.unit, self.also, self.digits)
        words = [first]
        if error is not None and self.final_when != "start":
            words.append(margin(error, self.unit, isinstance(value, int)))
        if self.sides and value:
            words.append(self.sides[value > 0.0])
        if second and also:
            words.append(f"({second})")
        return " ".join(filter(None, words))


def cached_per_run(compute: Callable[[Run, Any], _Value]) -> Callable[[Run, Any], _Value]:
    """Cache a value that several facts are computed from, such as the landing: computed once for each run."""
    last: list[tuple[ref[Run], Any, _Value]] = []

    @wraps(compute)
    def remembered(run: Run, parameters: Any) -> _Value:
        for known, by, value in last:
            if known() is run and by is parameters:
                return value
        value = compute(run, parameters)
        last[:] = [(ref(run), parameters, value)]
        return value

    return remembered


def problem_with(facts: Any) -> str | None:
    """The problem with a scene's FACTS, as the end of a message; None if there is none."""
    if not isinstance(facts, tuple | list):
        return f" must be a tuple of facts, but is {facts!r}"
    keys: set[str] = set()
    for fact in facts:
        if not isinstance(fact, Fact):
            return f" must be a tuple of facts, but {fact!r} is not one"
        if not isinstance(fact.key, str) or not isinstance(fact.label, str):
            return f": key and label must be text, but are {fact.key!r} and {fact.label!r}"
        if fact.key in keys:
            return f": two are called {fact.key}"
        keys.add(fact.key)
        try:
            signature(fact.compute).bind("run", "parameters")
        except TypeError as error:
            return f": {fact.key} is computed as compute(run, parameters): {error}"
        for unit in (fact.unit, fact.also):
            if unit not in units.KIND_OF:
                return f': {fact.key} has the unit "{unit}", which is not known'
    return None


ENDED = Fact("ended", "", "", lambda run, parameters: run.ended)


def _travelled(run: Run, parameters: Any) -> float:
    ball = run.setup.balls[0].name
    return dist(run.state(ball, 0.0)[:2], run.state(ball, run.duration)[:2])


#: The facts of a scene that defines none.
FALLBACK_FACTS = (
    Fact("distance", "distance", "m", _travelled),
    Fact("duration", "time", "s", lambda run, parameters: run.duration),
    ENDED,
)


def fallback_verdict(run: Run, parameters: Any) -> str:
    """The verdict of a scene that defines none."""
    how = {"rest": "At rest", "duration": "Still moving"}.get(run.ended, "Over")
    return f"{how} after {run.duration:.2f} s, {metres(_travelled(run, parameters))} from the start"
