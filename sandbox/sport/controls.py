"""Controls: the parameters that a pull of the mouse sets, and those that get a slider.

A scene defines them next to its parameters::

    CONTROLS = Controls(full_pull_speed=90.0, spins=(Spin("launch.spin", 100.0),), sliders=("launch.speed", "air.wind"))
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from sandbox.parameters import Group, every_key
from sandbox.text import nearest, no_such_result


@dataclass(frozen=True)
class Spin:
    """A parameter that the mouse wheel changes, by ``step`` per notch, in its unit."""

    key: str
    step: float


@dataclass(frozen=True)
class Spread:
    """The precision of a practised player at a parameter: a standard deviation of ``share`` times its value, or at
    least ``minimum``, which is in the parameter's unit.

    One with ``sd``, the key of a parameter that holds it, is of what the picture does not show, such as the direction
    to the side: it is in every fan, map and spread.
    """

    key: str
    share: float = 0.0
    minimum: float = 0.0
    sd: str = ""

    def sigma(self, value: float) -> float:
        """Standard deviation around a value."""
        return max(self.share * abs(value), self.minimum)


@dataclass(frozen=True)
class Handle:
    """A place to drag in the picture: ``Handle("hoop.distance", "hoop.height")`` is at (distance, height) in m.

    One without ``x`` or ``y`` moves only along the other. ``[*]`` in the keys, as in ``balls[*].x``, gives every entry
    of a list a handle. The wind, ``air.wind``, has one in every scene.
    """

    x: str = ""
    y: str = ""
    #: Its position (m), from the parameters, if that is not what its keys say.
    at: Callable[[Any], tuple[float, float]] | None = None
    with_y: tuple[str, ...] = ()  # keys of what moves up and down with it, such as the board behind a hoop
    where: str = ""  # the switch without which there is none
    goal: bool = False  # whether a shot that gets there scores
    #: From the parameters to the changes without which the keys have no effect, such as a rack that is broken up.
    prerequisites: Callable[[Any], Mapping[str, Any]] | None = None


@dataclass(frozen=True)
class Goal:
    """A goal for which a shot can be found: the facts that are ``wanted``, and where the player clicks for it (m).

    ``vary`` has the ranges of the parameters that are tried, by default of speed and angle. Goals of the same name are
    several ways to the same.
    """

    name: str
    wanted: Mapping[str, Any]
    at: tuple[float, float] | None = None
    vary: Mapping[str, tuple[float, float]] = field(default_factory=dict)


@dataclass(frozen=True)
class Held:
    """A key that the player holds while the shot runs, which moves something at once: ``key`` is the name that pygame
    has for it, ``times`` the parameter that lists when it is held, in s: ``[[from, to], ...]``, and ``name`` what it
    moves. Such a scene is played live: each press and each release changes the parameters of the rest of the run.
    """

    key: str
    times: str
    name: str


@dataclass(frozen=True)
class Controls:
    """The controls of a scene: most fields are keys of parameters."""

    speed: str = "launch.speed"
    angle: str = "launch.angle"  # deg, counter-clockwise from +x
    full_pull_speed: float = 30.0  # the highest speed of a full pull, in the speed's unit
    #: From the parameters to the highest speed that they allow, where that may be less: what strings can bear.
    speed_limit: Callable[[Any], float] | None = None
    softest: float = 0.05  # the speed of the shortest pull, as a share of the scene file's
    spins: tuple[Spin, ...] = ()  # of the wheel, and of the wheel with Shift
    ball: str = "ball"  # the ball that is pulled: its name, or the key that holds its name
    #: Other parameters that a pull sets, such as how the shot begins.
    set_on_pull: Mapping[str, Any] = field(default_factory=dict)
    sliders: tuple[str, ...] = ()  # shown first; ``balls[0].mass`` is of an entry of a list
    handles: tuple[Handle, ...] = ()
    #: From the parameters to what a shot can be found for, besides the handles that are goals.
    goals: Callable[[Any], Sequence[Goal]] | None = None
    scores: str = ""  # the fact that is true, or not empty, if the shot scored
    spread: tuple[Spread, ...] = ()  # of a fan of shots; where empty, of speed and angle
    fan_fact: str = ""  # the fact whose mean and spread a fan reports
    fan_shots: int = 0  # more than usual, where they differ much
    landing: tuple[str, ...] = ()  # two facts, in m, that say where it lands, where a shot scatters in two directions
    #: Keys that the player holds while the shot runs: it is simulated as it is played.
    held: tuple[Held, ...] = ()
    #: From a run and its parameters to the changes with which the next shot begins; without it, every shot begins the
    #: same way.
    next_start: Callable[[Any, Any], Mapping[str, Any]] | None = None

    def problem(self, schema: type[Group], facts: Sequence[str]) -> str | None:
        """The problem with these controls for a scene with such parameters and facts, in a line; or None."""
        kinds = ("sliders", str), ("handles", Handle), ("spins", Spin), ("spread", Spread), ("held", Held)
        for name, kind in kinds:
            entries = getattr(self, name)
            if not isinstance(entries, tuple | list) or not all(isinstance(entry, kind) for entry in entries):
                what = "keys" if kind is str else kind.__name__
                return f"{name} = {entries!r}: must be a tuple of {what}; a single one needs a trailing comma"
        for name, fact in (
            ("scores", self.scores),
            ("fan_fact", self.fan_fact),
            *(("landing", key) for key in self.landing),
        ):
            if fact and fact not in facts:
                return f'{name} "{fact}": {no_such_result(fact, facts)}'
        known = list(every_key(schema))
        for name, keys in self._keys().items():
            for key in (key for key in keys if key not in known):
                near = nearest(key, known)
                return f'{name} "{key}": unknown key' + (f"; did you mean {near}?" if near else "")
        return None

    def _keys(self) -> dict[str, list[str]]:
        """The keys of parameters, by the field that names them; a scene may lack those of the defaults."""
        return {
            "speed": [self.speed] if self.speed != Controls.speed else [],
            "angle": [self.angle] if self.angle != Controls.angle else [],
            "spins": [spin.key for spin in self.spins],
            "set_on_pull": [*self.set_on_pull],
            "sliders": [key.partition("[")[0] for key in self.sliders],
            "handles": [
                key.partition("[")[0] for it in self.handles for key in (it.x, it.y, *it.with_y, it.where) if key
            ],
            "spread": [key for spread in self.spread for key in (spread.key, spread.sd) if key],
            "held": [held.times for held in self.held],
        }
