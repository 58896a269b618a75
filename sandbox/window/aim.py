"""The slingshot: converts a pull in px to the parameters of a shot; and what keys and the wheel change."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees, exp, hypot, inf, log
from typing import Any, NamedTuple

from sandbox.parameters import Parameter
from sandbox.sport.controls import Controls
from sandbox.window.session import Session

#: The longest full pull, as a share of the stage's height; the shortest, in px, however near the window's edge is; and
#: what it leaves free before that edge, in px.
_FULL, _SHORTEST, _BORDER = 0.42, 60.0, 4.0
#: A shorter pull in px is a click, not a shot.
LEAST = 8.0
#: A full pull gives this many times the scene's own speed, unless that is more than its ``full_pull_speed``.
_HARDEST = 2.0
#: At this share of a full pull the shot has the scene's own speed; near there a px changes the speed this many times as
#: much as it would if the same px everywhere changed it by the same factor.
_OWN, _EVENNESS = 0.6, 0.3
#: A scene whose own speed is 0 is aimed with as if it were this share of its ``full_pull_speed``.
_FROM_REST = 0.1
#: What one press of a key changes: the angle in deg, the speed as a share of a full pull; a tenth with Shift.
_TURN, PUSH = 1.0, 0.01
#: With Shift only this share of a move of the mouse counts: a px turns a shot by 0.04 deg instead of 0.4, and a stone
#: must be aimed to 0.15.
_FINE = 0.1


class Speeds(NamedTuple):
    """The speeds of pulls, in the speed's unit: the shortest, the one at ``_OWN`` of a full one, and a full one."""

    lowest: float
    own: float
    highest: float

    def at(self, share: float) -> float:
        """The speed at this share of a full pull, from 0 to 1.

        The logarithm of speed over the scene's own is quadratic in the distance from ``_OWN`` on either side of it, so
        that a few px change little where the scene is played, and soft shots are still within reach.
        """
        end, length = (self.lowest, _OWN) if share < _OWN else (self.highest, 1.0 - _OWN)
        away = abs(share - _OWN) / length
        return self.own * exp(log(end / self.own) * (_EVENNESS * away + (1.0 - _EVENNESS) * away**2))


def speeds(session: Session) -> Speeds:
    """The speeds within reach of a pull: scaled to the scene's own, since one pull serves putts and drives."""
    controls = session.controls
    speed = session.parameters.get(controls.speed)
    return pull_speeds(controls, session.scene.parameters, speed, session.base_value(controls.speed))


def pull_speeds(controls: Controls, parameters: Any, parameter: Parameter | None, base: Any) -> Speeds:
    """The speeds within reach of a pull in a scene with these controls and parameters, whose own speed is ``base``; all
    within the bounds of the speed's ``parameter``."""
    own = base if isinstance(base, float) and base > 0 else _FROM_REST * controls.full_pull_speed
    limit = controls.speed_limit(parameters) if controls.speed_limit is not None else inf
    own = min(own, _OWN * limit)
    low, high = controls.softest * own, min(controls.full_pull_speed, _HARDEST * own, limit)
    if parameter is not None:
        low, high = parameter.within(low), parameter.within(high)
    return Speeds(min(low, own), own, max(high, own))


@dataclass
class Pull:
    """A pull of the mouse, which may start anywhere; it is full at the window's edge, or before it."""

    start: tuple[int, int]  # px
    speeds: Speeds
    window: tuple[int, int]  # width and height of it, px
    height: float  # of the stage, px
    stretch: float  # vertical scale over horizontal scale
    vector: tuple[float, float] = (0.0, 0.0)  # px, y down

    def __post_init__(self) -> None:
        self._mouse = self.start

    def move(self, to: tuple[int, int], fine: bool) -> None:
        """Pull on as the mouse moves to a place in px; where ``fine``, by the share ``_FINE`` of that."""
        share = _FINE if fine else 1.0
        across, down = (share * (px - before) for px, before in zip(to, self._mouse, strict=True))
        self.vector, self._mouse = (self.vector[0] + across, self.vector[1] + down), to

    @property
    def length(self) -> float:
        """In px."""
        return hypot(*self.vector)

    @property
    def full(self) -> float:
        """Length of a full pull in this direction, in px: as far as there is room."""
        room = inf
        for at, by, end in zip(self.start, self.vector, self.window, strict=True):
            if by:
                room = min(room, ((end - at if by > 0 else at) - _BORDER) * self.length / abs(by))
        return max(_SHORTEST, min(_FULL * self.height, room))

    @property
    def drawn(self) -> tuple[float, float]:
        """The part of it that counts, in px."""
        shorter = min(1.0, self.full / max(self.length, 1e-9))
        return self.vector[0] * shorter, self.vector[1] * shorter

    @property
    def shoots(self) -> bool:
        """True if it is long enough for a shot."""
        return self.length >= LEAST

    @property
    def share(self) -> float:
        """The share of a full pull, from 0 to 1."""
        return min(1.0, max(0.0, (self.length - LEAST) / (self.full - LEAST)))

    def changes(self, session: Session) -> dict[str, Any] | None:
        """The changes that the pull makes; None if it is not a shot. The ball goes in the opposite direction."""
        controls = session.controls
        speed, angle = session.parameters.get(controls.speed), session.parameters.get(controls.angle)
        if not self.shoots or speed is None or angle is None:
            return None
        along, down = self.vector
        return {
            **controls.set_on_pull,
            controls.speed: speed.within(float(f"{self.speeds.at(self.share):.4g}")),
            controls.angle: _turned(angle, round(degrees(atan2(down / self.stretch, -along)), 2)),
        }


def nudged(session: Session, turn: float = 0.0, push: float = 0.0) -> dict[str, Any]:
    """The changes of a key pressed so many times: ``turn`` counter-clockwise, ``push`` stronger."""
    controls = session.controls
    changes: dict[str, Any] = {}
    angle, speed = session.parameters.get(controls.angle), session.parameters.get(controls.speed)
    if turn and angle is not None:
        changes[controls.angle] = _turned(angle, round(angle.value + turn * _TURN, 3))
    if push and speed is not None:
        step = float(f"{PUSH * speeds(session).highest:.1g}")
        changes[controls.speed] = speed.within(round(speed.value + push * step, 6))
    return {**controls.set_on_pull, **changes} if changes else {}


def spun(session: Session, which: int, notches: float) -> dict[str, Any]:
    """The changes of the wheel; ``which`` of the spins."""
    spins = session.controls.spins
    if which >= len(spins):
        return {}
    spin, parameter = spins[which], session.parameters.get(spins[which].key)
    if parameter is None:
        return {}
    value = round(parameter.value + notches * spin.step, 6)
    return {**session.controls.set_on_pull, spin.key: parameter.within(value)}


def aimed(session: Session, speed: float, angle: float) -> dict[str, Any]:
    """The changes that aim with this speed and angle, in their units."""
    controls = session.controls
    return {**controls.set_on_pull, controls.speed: float(f"{speed:.4g}"), controls.angle: round(angle, 2)}


def _turned(parameter: Parameter, angle: float) -> float:
    """An angle within the parameter's bounds, by whole turns where that helps."""
    for turned in (angle, angle - 360.0, angle + 360.0):
        if turned == parameter.within(turned):
            return turned
    return parameter.within(angle)
