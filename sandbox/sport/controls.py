"""Controls: which parameters a pull of the mouse sets, and which are worth a slider.

A scene offers them beside its parameters::

    CONTROLS = Controls(strongest=90.0, spins=(Spin("launch.spin", 100.0),), sliders=("launch.speed", "air.wind"))
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from sandbox.parameters import Group, every_key, nearest, no_such_result


@dataclass(frozen=True)
class Spin:
    """A parameter that the wheel turns, by ``step`` a notch, in its unit."""

    key: str
    step: float


@dataclass(frozen=True)
class Spread:
    """How well a practised player hits a parameter: the standard deviation is a ``share`` of it, or at least ``least``.

    ``least`` is in the parameter's unit.
    """

    key: str
    share: float = 0.0
    least: float = 0.0

    def sigma(self, value: float) -> float:
        """Standard deviation around a value."""
        return max(self.share * abs(value), self.least)


@dataclass(frozen=True)
class Controls:
    """How a player plays: every name is the key of a parameter."""

    speed: str = "launch.speed"
    angle: str = "launch.angle"  # deg, counter-clockwise from +x
    strongest: float = 30.0  # speed of a full pull, in the speed's unit
    spins: tuple[Spin, ...] = ()  # the wheel's, and the wheel's with Shift
    ball: str = "ball"  # the ball that is pulled: its name, or the key that holds its name
    also: Mapping[str, Any] = field(default_factory=dict)  # what else a pull sets, such as how the shot begins
    sliders: tuple[str, ...] = ()  # shown first
    scores: str = ""  # the fact that is true, or not empty, when the shot scored
    spread: tuple[Spread, ...] = ()  # of a fan of shots; where empty, of speed and angle
    tells: str = ""  # the fact of which a fan says the mean and the spread
    #: From a run and its parameters to the changes with which the next shot begins; where there is none, every shot
    #: begins alike.
    goes_on: Callable[[Any, Any], Mapping[str, Any]] | None = None

    def mistake(self, schema: type[Group], facts: Sequence[str]) -> str | None:
        """What is wrong with these controls for a scene with such parameters and facts, in a line; None if nothing."""
        for name, kind in (("sliders", str), ("spins", Spin), ("spread", Spread)):
            entries = getattr(self, name)
            if not isinstance(entries, tuple | list) or not all(isinstance(entry, kind) for entry in entries):
                what = "keys" if kind is str else kind.__name__
                return f"{name} = {entries!r}: must be a tuple of {what}; one alone has a comma after it"
        for name, fact in (("scores", self.scores), ("tells", self.tells)):
            if fact and fact not in facts:
                return f'{name} "{fact}": {no_such_result(fact, facts)}'
        known = list(every_key(schema))
        for name, key in self._keys():
            if key not in known:
                near = nearest(key, known)
                return f'{name} "{key}": unknown key' + (f"; did you mean {near}?" if near else "")
        return None

    def _keys(self) -> Iterator[tuple[str, str]]:
        """Each field with the key of a parameter that it names; a scene may lack those that are not its own choice."""
        plain = Controls()
        yield from (("speed", self.speed),) if self.speed != plain.speed else ()
        yield from (("angle", self.angle),) if self.angle != plain.angle else ()
        yield from (("spins", spin.key) for spin in self.spins)
        yield from (("also", key) for key in self.also)
        yield from (("sliders", key) for key in self.sliders)
        yield from (("spread", spread.key) for spread in self.spread)
