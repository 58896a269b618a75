"""The slingshot: a pull in px becomes the parameters of a shot."""

from __future__ import annotations

from math import atan2, cos, degrees, hypot, radians, sin
from typing import TYPE_CHECKING, Any

from sandbox.parameters import Parameter

if TYPE_CHECKING:
    from sandbox.window.session import Session

#: A full pull, as a share of the stage's height.
FULL = 0.42
#: A shorter pull in px is a click and no shot.
LEAST = 8.0
#: What one press of a key changes: the angle in deg, the speed as a share of the strongest shot; finer with Shift.
TURN, PUSH, FINER = 1.0, 0.01, 0.1


def pulled(session: Session, pull: tuple[float, float], height: float, stretch: float) -> dict[str, Any] | None:
    """The changes that a pull (px, y down) on a stage of ``height`` px asks for; None where it is no shot.

    The ball goes the other way. ``stretch`` is how many times heights are drawn as large as lengths.
    """
    controls = session.controls
    length = hypot(*pull)
    if length < LEAST or session.parameter(controls.speed) is None or session.parameter(controls.angle) is None:
        return None
    share = min(1.0, (length - LEAST) / (FULL * height - LEAST))
    # More than in proportion, so that soft shots have room too.
    return {
        **controls.also,
        controls.speed: _within(session.parameter(controls.speed), round(controls.strongest * share**1.5, 2)),
        controls.angle: _turned(
            session.parameter(controls.angle), round(degrees(atan2(pull[1] / stretch, -pull[0])), 2)
        ),
    }


def pull_of(session: Session, height: float, stretch: float) -> tuple[float, float]:
    """The pull that would give the shot as it stands."""
    controls = session.controls
    speed, angle = session.value(controls.speed), session.value(controls.angle)
    if not isinstance(speed, float) or not isinstance(angle, float):
        return (0.0, 0.0)
    share = min(1.0, max(0.0, speed / controls.strongest)) ** (2 / 3)
    length = LEAST + share * (FULL * height - LEAST)
    along, up = cos(radians(angle)), sin(radians(angle)) * stretch
    scale = length / (hypot(along, up) or 1.0)
    return (-along * scale, up * scale)


def nudged(session: Session, turn: int = 0, push: int = 0, fine: bool = False) -> dict[str, Any]:
    """The changes of a key: ``turn`` counter-clockwise, ``push`` stronger."""
    controls, finer = session.controls, FINER if fine else 1.0
    changes: dict[str, Any] = {}
    angle, speed = session.parameter(controls.angle), session.parameter(controls.speed)
    if turn and angle is not None:
        changes[controls.angle] = _turned(angle, round(angle.value + turn * TURN * finer, 3))
    if push and speed is not None:
        step = PUSH * controls.strongest * finer
        changes[controls.speed] = _within(speed, round(speed.value + push * step, 4))
    return {**controls.also, **changes} if changes else {}


def spun(session: Session, which: int, notches: int, fine: bool = False) -> dict[str, Any]:
    """The changes of the wheel; ``which`` of the spins."""
    spins = session.controls.spins
    if which >= len(spins):
        return {}
    spin, parameter = spins[which], session.parameter(spins[which].key)
    if parameter is None:
        return {}
    value = round(parameter.value + notches * spin.step * (FINER if fine else 1.0), 6)
    return {**session.controls.also, spin.key: _within(parameter, value)}


def _within(parameter: Parameter | None, value: float) -> float:
    assert parameter is not None
    low, high = parameter.low, parameter.high
    return value if low is None or high is None else min(max(value, low), high)


def _turned(parameter: Parameter | None, angle: float) -> float:
    """An angle within the parameter's bounds, by whole turns where that helps."""
    assert parameter is not None
    for turned in (angle, angle - 360.0, angle + 360.0):
        if turned == _within(parameter, turned):
            return turned
    return _within(parameter, angle)
