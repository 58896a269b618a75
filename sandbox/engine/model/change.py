"""The changes of a run that goes on: of forces, of motion and places of balls, of the balls there are, of the setup."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from itertools import zip_longest
from math import isfinite
from typing import Any, TypedDict, cast

from sandbox.engine.model.ball import Ball, Force, Torque
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Bounds, ContactModel, ForceRegion, Setup, Until
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import BounceLaw, Surface, Trap
from sandbox.errors import RequestError
from sandbox.physics.integrators import State
from sandbox.physics.plane import Plane


class Changes(TypedDict, total=False):
    """Changes at one time. What is said of balls is given by name, or as it is where there is only one ball."""

    forces: Mapping[str, Sequence[Force]] | Sequence[Force]  # from now on, in place of its own
    torques: Mapping[str, Sequence[Torque]] | Sequence[Torque]
    velocity: Mapping[str, Vector] | Vector  # m/s
    spin: Mapping[str, float] | float  # rad/s
    impulse: Mapping[str, Vector] | Vector  # N s, at the centre
    position: Mapping[str, Vector] | Vector  # m
    add: Ball | Sequence[Ball]  # as they are at this time
    remove: str | Sequence[str]
    surfaces: Sequence[Surface]  # this and the following as in a Setup
    duration: float  # s, from the start of the run
    until: Callable[[Event], bool] | Until | None
    between_balls: BounceLaw
    plane: Plane
    traps: Sequence[Trap]
    bounds: Bounds
    force_regions: Sequence[ForceRegion]
    contact: ContactModel
    pairs: Sequence[tuple[str, str, BounceLaw]]
    planes: Sequence[tuple[str, Plane]]
    discontinuities: Sequence[float]


#: Changes of a ball's own terms, and of its state.
_TERMS, _MOTION = ("forces", "torques"), ("velocity", "spin", "impulse", "position")


@dataclass(frozen=True)
class _MotionChange:
    """A change of the state of one ball; None for what stays as it is."""

    velocity: Vector | None = None  # m/s
    spin: float | None = None  # rad/s
    impulse: Vector = (0.0, 0.0)  # N s
    position: Vector | None = None  # m

    def applied(self, ball: Ball, state: State, t: float) -> State:
        """Return the state of the ball after the change at t in s."""
        x, y, vx, vy, spin, *others = state
        x, y = self.position or (x, y)
        vx, vy = self.velocity or (vx, vy)
        mass = ball.mass * float(ball.mass_fraction(t))
        vx, vy = vx + self.impulse[0] / mass, vy + self.impulse[1] / mass
        return (x, y, vx, vy, spin if self.spin is None else self.spin, *others)


@dataclass(frozen=True)
class Change:
    """Changes that were checked."""

    setup: Setup  # that is valid from then on, with all balls that there are or were
    forced: frozenset[str]  # balls with other forces or torques
    motion: Mapping[str, _MotionChange]
    added: Sequence[Ball]
    removed: frozenset[str]
    given: frozenset[str]  # fields of the setup

    def places(self, ball: str) -> bool:
        """Return True if a ball is put elsewhere."""
        return ball in self.motion and self.motion[ball].position is not None


def checked(changes: Mapping[str, Any], setup: Setup, present: Collection[str]) -> Change:
    """Return changes to a run of this setup, in which these balls are ``present``. Raises RequestError if they are
    invalid."""
    for name in changes:
        if name not in Changes.__annotations__:
            raise RequestError(f"unknown change {name!r}: choose from {', '.join(Changes.__annotations__)}")
    of_balls = {name: _by_ball(name, changes[name], present) for name in (*_TERMS, *_MOTION) if name in changes}
    motion: dict[str, dict[str, Any]] = {}
    for name in (name for name in _MOTION if name in changes):
        for ball, value in of_balls[name].items():
            motion.setdefault(ball, {})[name] = (_number if name == "spin" else _point)(name, ball, value)
    terms: dict[str, dict[str, Any]] = {}
    for name in (name for name in _TERMS if name in changes):
        for ball, value in of_balls[name].items():
            terms.setdefault(ball, {})[name] = value
    added, removed = _added(_several(changes.get("add", ())), setup), _several(changes.get("remove", ()))
    for ball in removed:
        _refuse_unknown("remove", ball, present)
        if ball in motion or ball in terms:
            raise RequestError(f"remove: ball {ball!r} is changed at the same time: do one of them")
    given = {name: value for name, value in changes.items() if name not in (*_TERMS, *_MOTION, "add", "remove")}
    try:
        balls = [replace(ball, **terms.get(ball.name, {})) for ball in setup.balls]
        new = replace(setup, balls=[*balls, *added], **given)
    except (ValueError, TypeError) as error:
        raise RequestError(str(error)) from None
    if _rolls(new, balls) != _rolls(setup, balls):
        raise RequestError("plane: balls that move in the picture's plane, on cloth, or on ice go on in their own way")
    changed = {ball: _MotionChange(**values) for ball, values in motion.items()}
    return Change(new, frozenset(terms), changed, added, frozenset(removed), frozenset(given))


def changes_between(before: Setup, after: Setup) -> Changes:
    """Return the changes of a run that make what follows that of another setup: forces, surfaces and all that is no
    start. Raises RequestError for a difference in the balls and how they start."""
    changes: dict[str, Any] = {
        each.name: getattr(after, each.name)
        for each in fields(Setup)
        if each.name != "balls" and getattr(before, each.name) != getattr(after, each.name)
    }
    for one, other in zip_longest(before.balls, after.balls):
        if one is None or other is None or replace(one, forces=other.forces, torques=other.torques) != other:
            name = (one or other).name
            raise RequestError(f"such parameters change ball {name!r} or its start, which is over: give velocity or so")
        for term in _TERMS:
            if getattr(one, term) != getattr(other, term):
                changes.setdefault(term, {})[one.name] = getattr(other, term)
    return cast(Changes, changes)


def _rolls(setup: Setup, balls: Sequence[Ball]) -> list[bool | None]:
    """Return of each ball if it rolls on a plane, None without one."""
    return [None if setup.plane is None else setup.plane_of(ball.name).rolls for ball in balls]


def _several(value: Any) -> list[Any]:
    """Return a list of what is given, one or several."""
    return list(value) if isinstance(value, list | tuple | set | frozenset) else [value]


def _added(added: list[Any], setup: Setup) -> list[Ball]:
    """Return these balls. Raises RequestError for one that is none, or whose name is taken."""
    for ball in added:
        if not isinstance(ball, Ball):
            raise RequestError(f"add = {ball!r}: must be a Ball or a Body")
        names = [each.name for each in (*setup.balls, *added)]
        if names.count(ball.name) > 1:
            raise RequestError(f"add: there is, or was, a ball {ball.name!r} already: give it another name")
    return added


def _by_ball(name: str, value: Any, present: Collection[str]) -> dict[str, Any]:
    """Return what is given of balls by name."""
    if not isinstance(value, Mapping):
        if len(present) != 1:
            like = next(iter(present), "ball")
            raise RequestError(f'{name}: there are {len(present)} balls: give it by name, as {{"{like}": ...}}')
        return dict.fromkeys(present, value)
    for ball in value:
        _refuse_unknown(name, ball, present)
    return dict(value)


def _refuse_unknown(name: str, ball: str, present: Collection[str]) -> None:
    if not isinstance(ball, str) or ball not in present:
        there = ", ".join(map(repr, present)) or "none"
        raise RequestError(f"{name}: there is no ball {ball!r} at that time; there are {there}")


def _point(name: str, ball: str, value: Any) -> Vector:
    try:
        x, y = map(float, value)
    except (TypeError, ValueError):
        x = y = float("nan")
    if not (isfinite(x) and isfinite(y)):
        raise RequestError(f"{name} of ball {ball!r} = {value!r}: must be two finite numbers, (x, y)")
    return x, y


def _number(name: str, ball: str, value: Any) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = float("nan")
    if not isfinite(number):
        raise RequestError(f"{name} of ball {ball!r} = {value!r}: must be a finite number")
    return number
