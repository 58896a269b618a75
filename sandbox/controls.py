"""Controls: which parameters a pull of the mouse sets, and which are worth a slider.

A scene offers them beside its parameters::

    CONTROLS = Controls(strongest=90.0, spins=(Spin("launch.spin", 100.0),), sliders=("launch.speed", "air.wind"))
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any


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
    scores: str = ""  # the entry of the result that is true, or not empty, when the shot scored
    spread: tuple[Spread, ...] = ()  # of a fan of shots; where empty, of speed and angle
    tells: tuple[str, str] | None = None  # an entry of the result, with its unit: a fan says its mean and its spread
    #: From a run and its parameters to the changes with which the next shot begins; where there is none, every shot
    #: begins alike.
    goes_on: Callable[[Any, Any], Mapping[str, Any]] | None = None


def controls_of(module: Any) -> Controls:
    """The controls of a scene's module; those of a plain launch where it has none."""
    found = getattr(module, "CONTROLS", None)
    return found if isinstance(found, Controls) else Controls()
