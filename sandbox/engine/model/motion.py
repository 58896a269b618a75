"""Motions of surfaces that are driven: where a surface is at each time, whatever meets it.

A motion moves a surface, drawn where it is without one, as a rigid body: its point ``about`` is at ``place(t)[:2]``,
and it is turned about that point by the angle ``place(t)[2]``.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from math import cos, hypot, inf, isfinite, pi, sin
from typing import Any, NamedTuple, Protocol, cast, runtime_checkable

from sandbox.engine.model.setup_errors import call_user_function
from sandbox.engine.model.shapes import Vector
from sandbox.physics.checks import check, short


class Placing(NamedTuple):
    """The place in m to which a motion has taken its point ``about``, and the angle in rad by which it has turned the
    surface; or the rates of these, in m/s and rad/s.

    >>> from sandbox import Turning
    >>> Turning((1.0, 0.0), rate=3.0).rates(0.5)
    Placing(x=0.0, y=0.0, angle=3.0)
    """

    x: float
    y: float
    angle: float = 0.0


@runtime_checkable
class Motion(Protocol):
    """A motion, smooth from the start on. Your own: a frozen dataclass at the level of a module, with these three.

    >>> from sandbox import Motion, Turning
    >>> isinstance(Turning((0.0, 0.0), 1.0), Motion)
    True
    """

    @property
    def about(self) -> Vector:
        """The point of the surface that is placed, in m, and about which it turns."""

    def place(self, t: float) -> Placing:
        """Return the place in m of that point at time t in s, and the angle in rad that the surface has turned by."""

    def rates(self, t: float) -> Placing:
        """The derivative of ``place``, in m/s and rad/s."""


@dataclass(frozen=True)
class Sliding:
    """Sliding at a ``velocity`` (vx, vy) in m/s, or in pieces [(time, velocity), ...]: each from its time in s on, and
    at rest before the first. A component is a number, or the coefficients of a polynomial in the time since the
    velocity began, from the constant up, in m/s, m/s^2, ... Times are since ``start``.

    >>> from sandbox import Sliding
    >>> Sliding((0.5, 0.0)).place(2.0)[:2]  # m
    (1.0, 0.0)
    >>> Sliding((0.0, (1.0, 3.0))).place(2.0)[:2]  # from 1 m/s, accelerated at 3 m/s^2
    (0.0, 8.0)
    >>> dive = Sliding([(0.25, (0.0, 4.0)), (0.75, (0.0, 0.0))])  # waits, goes 2 m, stays
    >>> dive.place(0.2)[:2], dive.place(9.0)[:2]
    ((0.0, 0.0), (0.0, 2.0))
    """

    velocity: Sequence[Any] = (0.0, 0.0)  # m/s
    start: float = 0.0  # s
    shift: Vector = (0.0, 0.0)  # m, at the start
    about: Vector = (0.0, 0.0)  # m
    angle: float = 0.0  # rad, by which it is turned all the time

    def __post_init__(self) -> None:
        check("sliding", self, points=["about", "shift"], finite=["start", "angle"])
        times = [start for start, _ in self.pieces]
        if times != sorted(set(times)):
            raise ValueError(f"sliding: the pieces begin at {times} s: each must begin after the one before")

    @cached_property
    def pieces(self) -> list[tuple[float, Sliding]]:
        """Each velocity by itself, with the time in s from which it holds."""
        try:
            if not _in_pieces(self.velocity):
                x, y = map(_coefficients, self.velocity)
                if not all(map(isfinite, (*x, *y))):
                    raise ValueError
                return [(-inf, self)]
            made = [(-inf, replace(self, velocity=(0.0, 0.0)))]
            for start, velocity in self.velocity:
                t = self.start + float(start)
                at = made[-1][1].place(t)
                shift = at.x - self.about[0], at.y - self.about[1]
                made.append((t, replace(self, velocity=tuple(velocity), start=t, shift=shift)))
        except (TypeError, ValueError):
            wanted = "two finite numbers, (vx, vy) in m/s, or pieces, [(time, (vx, vy)), ...]"
            raise ValueError(f"sliding: velocity = {short(self.velocity)} must be {wanted}") from None
        return made

    def piece(self, t: float) -> tuple[Motion, float]:
        """The motion at time t, and until when it lasts, in s."""
        return _piece(self.pieces, t)

    def place(self, t: float) -> Placing:
        if len(self.pieces) > 1:
            return self.piece(t)[0].place(t)
        x, y = ([shift, *_integral(v)] for shift, v in zip(self.shift, self.velocity, strict=True))
        since = t - self.start
        return Placing(self.about[0] + _polynomial(x, since), self.about[1] + _polynomial(y, since), self.angle)

    def rates(self, t: float) -> Placing:
        if len(self.pieces) > 1:
            return self.piece(t)[0].rates(t)
        x, y = (_polynomial(_coefficients(v), t - self.start) for v in self.velocity)
        return Placing(x, y, 0.0)


@dataclass(frozen=True)
class Swinging:
    """To and fro, harmonically: turned about ``center`` by ``amplitude`` (rad) times sin(2 pi t / period + phase), and
    displaced by ``shift`` (m) times that.

    >>> from math import pi
    >>> from sandbox import Swinging
    >>> round(Swinging((0.0, 1.0), amplitude=0.5, period=2.0).place(0.5).angle, 6)  # rad, a pendulum
    0.5
    >>> gate = Swinging((0.0, 0.0), 0.0, period=2.0, shift=(0.0, 0.3))  # 0.3 m to either side
    >>> round(gate.place(0.5).y, 6)  # m
    0.3
    """

    center: Vector  # m
    amplitude: float  # rad
    period: float  # s
    phase: float = 0.0  # rad
    shift: Vector = (0.0, 0.0)  # m

    def __post_init__(self) -> None:
        check("swinging", self, positive=["period"], points=["center", "shift"], finite=["amplitude", "phase"])

    @property
    def about(self) -> Vector:
        return self.center

    def place(self, t: float) -> Placing:
        share = sin(2.0 * pi * t / self.period + self.phase)
        (x, y), (dx, dy) = self.center, self.shift
        return Placing(x + share * dx, y + share * dy, share * self.amplitude)

    def rates(self, t: float) -> Placing:
        rate = 2.0 * pi / self.period
        share = rate * cos(rate * t + self.phase)
        return Placing(share * self.shift[0], share * self.shift[1], share * self.amplitude)


@dataclass(frozen=True)
class Turning:
    """Turning at a constant ``rate`` (rad/s, counter-clockwise) about ``center``, from ``angle`` (rad) at ``start``.

    >>> from sandbox import Turning
    >>> Turning((0.0, 0.0), rate=2.0, angle=0.5).place(1.0).angle  # rad
    2.5
    """

    center: Vector  # m
    rate: float  # rad/s
    angle: float = 0.0  # rad
    start: float = 0.0  # s

    def __post_init__(self) -> None:
        check("turning", self, finite=["rate", "angle", "start"], points=["center"])

    @property
    def about(self) -> Vector:
        return self.center

    def place(self, t: float) -> Placing:
        return Placing(*self.center, self.angle + self.rate * (t - self.start))

    def rates(self, t: float) -> Placing:
        return Placing(0.0, 0.0, self.rate)


@dataclass(frozen=True)
class Given:
    """A motion of your own: a function of time that returns (x, y) in m or (x, y, angle) in m and rad, and its
    derivative. Both are called with the time in s, and must be smooth and depend on nothing else.

    >>> from math import cos, sin
    >>> from sandbox import Given
    >>> round_and_round = Given(lambda t: (0.2 * cos(t), 0.2 * sin(t)), lambda t: (-0.2 * sin(t), 0.2 * cos(t)))
    >>> round_and_round.place(0.0)
    Placing(x=0.2, y=0.0, angle=0.0)
    """

    position: Callable[[float], Sequence[float]]
    velocity: Callable[[float], Sequence[float]]
    about: Vector = (0.0, 0.0)  # m

    def __post_init__(self) -> None:
        for name in ("position", "velocity"):
            if not callable(getattr(self, name)):
                raise ValueError(f"given motion: {name} = {short(getattr(self, name))} must be a function of time")

    def place(self, t: float) -> Placing:
        return _placing(call_user_function(self.position, "a motion's position is called as position(t)", t))

    def rates(self, t: float) -> Placing:
        return _placing(call_user_function(self.velocity, "a motion's velocity is called as velocity(t)", t))


def _placing(found: Any) -> Placing:
    """Return what a function has returned as a Placing, or as it is where that cannot be."""
    try:
        return Placing(*found)
    except TypeError:
        return cast(Placing, found)


#: How far in m, or rad, two motions that follow each other may be apart when one takes over: rounding.
_JUMP = 1e-9


@dataclass(frozen=True)
class InTurn:
    """Motions one after another, each from its time in s on. The velocity may jump where one takes over, the place must
    not.

    >>> from math import pi
    >>> from sandbox import InTurn, Sliding, Turning
    >>> quarter = InTurn([(0.0, Turning((1.0, 0.0), pi)), (0.5, Sliding(about=(1.0, 0.0), angle=pi / 2))])
    >>> round(quarter.place(9.0).angle / pi, 6)
    0.5
    """

    motions: Sequence[tuple[float, Motion]]

    def __post_init__(self) -> None:
        check("motions in turn", self, lists=["motions"])
        if not self.motions:
            raise ValueError("motions in turn: there are none")
        for t, each in self.motions:
            if not isinstance(each, Motion) or not isfinite(t):
                raise ValueError(f"motions in turn: ({t}, {short(each)}) must be a finite time in s and a motion")
        for (before, motion), (t, after) in zip(self.motions[:-1], self.motions[1:], strict=True):
            if t <= before:
                raise ValueError(f"motions in turn: that from {t:g} s must begin after that from {before:g} s")
            if after.about != self.about:
                raise ValueError(f"motions in turn: about = {after.about} m from {t:g} s on, {self.about} m before")
            ends, begins = motion.place(t), after.place(t)
            jump = max(abs(a - b) for a, b in zip(ends, begins, strict=True))
            if not jump <= _JUMP * (1.0 + max(map(abs, ends))):
                raise ValueError(
                    f"motions in turn: at {t:g} s the place jumps from {_as_text(ends)} to {_as_text(begins)}"
                )

    @property
    def about(self) -> Vector:
        return self.motions[0][1].about

    def piece(self, t: float) -> tuple[Motion, float]:
        """The motion at time t, and until when it lasts, in s."""
        return _piece(self.motions, t)

    def place(self, t: float) -> Placing:
        return self.piece(t)[0].place(t)

    def rates(self, t: float) -> Placing:
        return self.piece(t)[0].rates(t)


def piece_of(motion: Motion, t: float) -> tuple[Motion, float]:
    """The smooth motion at time t, and until when it lasts, in s."""
    if not isinstance(motion, InTurn | Sliding):
        return motion, inf
    piece, until = motion.piece(t)
    if piece is motion or not isinstance(piece, InTurn | Sliding):
        return piece, until
    inner, ends = piece_of(piece, t)
    return inner, min(until, ends)


def stands_until(motion: Motion, t: float) -> float:
    """Until when in s a motion stands still from time t on; t if it moves, or is not known to stand."""
    piece, until = piece_of(motion, t)
    known = isinstance(piece, Sliding | Turning | Swinging)
    still = known and not any(piece.rates(t)) and not (isinstance(piece, Sliding) and any(map(_varies, piece.velocity)))
    return until if still and not isinstance(piece, Swinging) else t


#: The left, bottom, right and top edge of a box, in m.
Box = tuple[float, float, float, float]

_ANYWHERE = (-inf, -inf, inf, inf)


def stays_within(motion: Motion, points: Sequence[Vector]) -> Box:
    """The edges in m of a box that these points of what is moved never leave, at any time; infinite if not known."""
    size = max(hypot(x - motion.about[0], y - motion.about[1]) for x, y in points)
    match motion:
        case InTurn():
            return _around(stays_within(each, points) for _, each in motion.motions)
        case Turning() | Swinging():
            (x, y), (dx, dy) = motion.about, motion.shift if isinstance(motion, Swinging) else (0.0, 0.0)
            dx, dy = abs(dx) + size, abs(dy) + size
            return x - dx, y - dy, x + dx, y + dy
        case Sliding():
            pieces = motion.pieces
            stays = not any(any(map(_varies, piece.velocity)) for _, piece in pieces)
            if not stays or any(pieces[0][1].rates(0.0)) or any(pieces[-1][1].rates(0.0)):
                return _ANYWHERE
            places = [motion.place(start) for start, _ in pieces[1:]] or [motion.place(0.0)]
            return _around((p.x - size, p.y - size, p.x + size, p.y + size) for p in places)
    return _ANYWHERE


def _around(boxes: Iterable[Box]) -> Box:
    """The box around all of these."""
    left, bottom, right, top = zip(*boxes, strict=True)
    return min(left), min(bottom), max(right), max(top)


def _piece(pieces: Sequence[tuple[float, Motion]], t: float) -> tuple[Motion, float]:
    """The piece at time t of those that begin at their times, the first at any time, and until when it lasts, in s."""
    until = inf
    for start, motion in reversed(pieces[1:]):
        if start <= t:
            return motion, until
        until = start
    return pieces[0][1], until


def moved(point: Vector, motion: Motion, t: float) -> Vector:
    """The place in m, at time t, of a point of what is moved."""
    (x, y), (u, v, angle) = motion.about, motion.place(t)
    c, s, dx, dy = cos(angle), sin(angle), point[0] - x, point[1] - y
    return u + c * dx - s * dy, v + s * dx + c * dy


def _as_text(place: Placing) -> str:
    return f"({place.x:.6g}, {place.y:.6g}) m, {place.angle:.6g} rad"


def _polynomial(coefficients: Sequence[float], t: float) -> float:
    value = 0.0
    for coefficient in reversed(coefficients):
        value = value * t + coefficient
    return value


def _in_pieces(velocity: Sequence[Any]) -> bool:
    """True if it is [(time, velocity), ...]."""
    first = velocity[0] if len(velocity) else 0.0
    return isinstance(first, Sequence) and len(first) == 2 and isinstance(first[1], Sequence)


def _coefficients(component: Any) -> list[float]:
    """Those of a component of a velocity, from the constant up."""
    return [float(c) for c in component] if isinstance(component, Sequence) else [float(component)]


def _varies(component: Any) -> bool:
    """True if a component of a velocity is not constant."""
    return any(_coefficients(component)[1:])


def _integral(component: Any) -> list[float]:
    """The coefficients of its integral but for the constant."""
    return [c / power for power, c in enumerate(_coefficients(component), 1)]
