"""The slingshot: converts a pull in px to the parameters of a shot; and what keys and the wheel change."""

from __future__ import annotations

from dataclasses import dataclass
from math import atan2, degrees, hypot
from typing import Any

from sandbox.parameters import Parameter
from sandbox.window.session import Session

#: A full pull, as a share of the stage's height.
FULL = 0.42
#: A shorter pull in px is a click, not a shot.
LEAST = 8.0
#: A full pull gives this many times the speed of the current shot or of the scene file, whichever is larger; and at
#: least this share of the strongest shot.
TIMES, WEAKEST = 2.0, 0.005
#: What one press of a key changes: the angle in deg, the speed as a share of a full pull; a tenth with Shift.
TURN, PUSH = 1.0, 0.01


def strongest(session: Session) -> float:
    """The speed of a full pull, in the speed's unit: scaled to the shot, since one pull serves putts and drives."""
    controls = session.controls
    speeds = [session.value(controls.speed), session.base_value(controls.speed)]
    speed = max((value for value in speeds if isinstance(value, float)), default=0.0)
    return min(controls.strongest, max(TIMES * speed, WEAKEST * controls.strongest))


@dataclass
class Pull:
    """A pull of the mouse, which may start anywhere; its scale stays the same until it ends."""

    start: tuple[int, int]  # px
    strongest: float  # of a full pull
    height: float  # of the stage, px
    stretch: float  # vertical scale over horizontal scale
    vector: tuple[float, float] = (0.0, 0.0)  # px, y down

    @property
    def length(self) -> float:
        """In px."""
        return hypot(*self.vector)

    @property
    def drawn(self) -> tuple[float, float]:
        """The part of it that counts, in px."""
        shorter = min(1.0, FULL * self.height / max(self.length, 1e-9))
        return self.vector[0] * shorter, self.vector[1] * shorter

    @property
    def shoots(self) -> bool:
        """Whether it is long enough for a shot."""
        return self.length >= LEAST

    @property
    def share(self) -> float:
        """Of a full pull, from 0 to 1."""
        return min(1.0, max(0.0, (self.length - LEAST) / (FULL * self.height - LEAST)))

    def changes(self, session: Session) -> dict[str, Any] | None:
        """The changes that the pull makes; None if it is not a shot. The ball goes in the opposite direction."""
        controls = session.controls
        speed, angle = session.parameters.get(controls.speed), session.parameters.get(controls.angle)
        if not self.shoots or speed is None or angle is None:
            return None
        along, down = self.vector
        # More than proportional, for finer control of soft shots.
        return {
            **controls.also,
            controls.speed: speed.within(float(f"{self.strongest * self.share**1.5:.4g}")),
            controls.angle: _turned(angle, round(degrees(atan2(down / self.stretch, -along)), 2)),
        }


def nudged(session: Session, turn: float = 0.0, push: float = 0.0) -> dict[str, Any]:
    """The changes of a key pressed so many times: ``turn`` counter-clockwise, ``push`` stronger."""
    controls = session.controls
    changes: dict[str, Any] = {}
    angle, speed = session.parameters.get(controls.angle), session.parameters.get(controls.speed)
    if turn and angle is not None:
        changes[controls.angle] = _turned(angle, round(angle.value + turn * TURN, 3))
    if push and speed is not None:
        step = float(f"{PUSH * strongest(session):.1g}")
        changes[controls.speed] = speed.within(round(speed.value + push * step, 6))
    return {**controls.also, **changes} if changes else {}


def spun(session: Session, which: int, notches: float) -> dict[str, Any]:
    """The changes of the wheel; ``which`` of the spins."""
    spins = session.controls.spins
    if which >= len(spins):
        return {}
    spin, parameter = spins[which], session.parameters.get(spins[which].key)
    if parameter is None:
        return {}
    value = round(parameter.value + notches * spin.step, 6)
    return {**session.controls.also, spin.key: parameter.within(value)}


def aimed(session: Session, speed: float, angle: float) -> dict[str, Any]:
    """The changes that aim with this speed and angle, in their units."""
    controls = session.controls
    return {**controls.also, controls.speed: float(f"{speed:.4g}"), controls.angle: round(angle, 2)}


def _turned(parameter: Parameter, angle: float) -> float:
    """An angle within the parameter's bounds, by whole turns where that helps."""
    for turned in (angle, angle - 360.0, angle + 360.0):
        if turned == parameter.within(turned):
            return turned
    return parameter.within(angle)
