"""Motions of surfaces that are driven: where a surface is at each time, whatever meets it.

A motion moves a surface, drawn where it is without one, as a rigid body: its point ``about`` is at ``place(t)[:2]``,
and it is turned about that point by the angle ``place(t)[2]``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import cos, inf, isfinite, pi, sin
from typing import NamedTuple, Protocol, runtime_checkable

from sandbox.engine.model.shapes import Vector
from sandbox.physics.checks import check


class Placing(NamedTuple):
    """Where a motion has taken its point ``about``, in m, and how far it has turned the surface, in rad; or the rates
    of these, in m/s and rad/s."""

    x: float
    y: float
    angle: float = 0.0


@runtime_checkable
class Motion(Protocol):
    """A motion, smooth from the start on. Your own: a frozen dataclass at the level of a module, with these three."""

    @property
    def about(self) -> Vector:
        """The point of the surface that is placed, in m, and about which it turns."""

    def place(self, t: float) -> Placing:
        """Where that point is at time t in s, in m, and how far the surface has turned, in rad."""

    def rates(self, t: float) -> Placing:
        """The derivative of ``place``, in m/s and rad/s."""


@dataclass(frozen=True)
class Sliding:
    """A displacement that is a polynomial in time: ``Sliding(x=(0.0, 0.5))`` moves at 0.5 m/s, ``Sliding(y=(0, 0, 1))``
    is accelerated at 2 m/s^2, ``Sliding()`` stays. Coefficients of the time since ``start``, from the constant up, in
    m, m/s, m/s^2, ..."""

    x: Sequence[float] = ()
    y: Sequence[float] = ()
    start: float = 0.0  # s
    about: Vector = (0.0, 0.0)  # m
    angle: float = 0.0  # rad, by which it is turned all the time

    def __post_init__(self) -> None:
        check("sliding", self, lists=["x", "y"], points=["about"], finite=["start", "angle"])
        if not all(map(isfinite, (*self.x, *self.y))):
            raise ValueError(f"sliding: x = {self.x}, y = {self.y}: all must be finite")

    def place(self, t: float) -> Placing:
        since = t - self.start
        return Placing(
            self.about[0] + _polynomial(self.x, since), self.about[1] + _polynomial(self.y, since), self.angle
        )

    def rates(self, t: float) -> Placing:
        since = t - self.start
        return Placing(_polynomial(_derivative(self.x), since), _polynomial(_derivative(self.y), since), 0.0)


@dataclass(frozen=True)
class Swinging:
    """To and fro, harmonically: displaced by ``amplitude`` times sin(2 pi t / period + phase), and turned by ``turn``
    (rad) times that about a point."""

    period: float  # s
    amplitude: Vector = (0.0, 0.0)  # m
    turn: float = 0.0  # rad
    phase: float = 0.0  # rad
    about: Vector = (0.0, 0.0)  # m

    def __post_init__(self) -> None:
        check("swinging", self, positive=["period"], points=["amplitude", "about"], finite=["turn", "phase"])

    def place(self, t: float) -> Placing:
        share = sin(2.0 * pi * t / self.period + self.phase)
        (ax, ay), (x, y) = self.amplitude, self.about
        return Placing(x + share * ax, y + share * ay, share * self.turn)

    def rates(self, t: float) -> Placing:
        rate = 2.0 * pi / self.period
        share = rate * cos(rate * t + self.phase)
        return Placing(share * self.amplitude[0], share * self.amplitude[1], share * self.turn)


@dataclass(frozen=True)
class Turning:
    """Turning at a constant ``rate`` (rad/s, counter-clockwise) about a point, from ``angle`` (rad) at ``start``."""

    rate: float  # rad/s
    about: Vector = (0.0, 0.0)  # m
    angle: float = 0.0  # rad
    start: float = 0.0  # s

    def __post_init__(self) -> None:
        check("turning", self, finite=["rate", "angle", "start"], points=["about"])

    def place(self, t: float) -> Placing:
        return Placing(*self.about, self.angle + self.rate * (t - self.start))

    def rates(self, t: float) -> Placing:
        return Placing(0.0, 0.0, self.rate)


@dataclass(frozen=True)
class Given:
    """A motion of your own: a function of time that returns (x, y) in m or (x, y, angle) in m and rad, and its
    derivative. Both are called with the time in s, and must be smooth and depend on nothing else."""

    position: Callable[[float], Sequence[float]]
    velocity: Callable[[float], Sequence[float]]
    about: Vector = (0.0, 0.0)  # m

    def place(self, t: float) -> Placing:
        return Placing(*self.position(t))

    def rates(self, t: float) -> Placing:
        return Placing(*self.velocity(t))


#: How far in m, or rad, two motions that follow each other may be apart when one takes over: rounding.
_JUMP = 1e-9


@dataclass(frozen=True)
class InTurn:
    """Motions one after another: ``InTurn([(0.0, Sliding()), (0.5, Sliding(x=(0.0, 1.0), start=0.5))])``, each from its
    time in s on. The velocity may jump where one takes over, the place must not."""

    motions: Sequence[tuple[float, Motion]]

    def __post_init__(self) -> None:
        check("motions in turn", self, lists=["motions"])
        if not self.motions:
            raise ValueError("motions in turn: there are none")
        for (before, motion), (t, after) in zip(self.motions[:-1], self.motions[1:], strict=True):
            if t <= before:
                raise ValueError(f"motions in turn: that from {t:g} s must begin after that from {before:g} s")
            if after.about != self.about:
                raise ValueError(f"motions in turn: about = {after.about} m from {t:g} s on, {self.about} m before")
            ends, begins = motion.place(t), after.place(t)
            jump = max(abs(a - b) for a, b in zip(ends, begins, strict=True))
            if not jump <= _JUMP * (1.0 + max(map(abs, ends))):
                raise ValueError(f"motions in turn: at {t:g} s the place jumps from {_said(ends)} to {_said(begins)}")

    @property
    def about(self) -> Vector:
        return self.motions[0][1].about

    def piece(self, t: float) -> tuple[Motion, float]:
        """The motion at time t, and until when it lasts, in s."""
        until = inf
        for start, motion in reversed(self.motions):
            if start <= t:
                return motion, until
            until = start
        return self.motions[0][1], until if len(self.motions) == 1 else self.motions[1][0]

    def place(self, t: float) -> Placing:
        return self.piece(t)[0].place(t)

    def rates(self, t: float) -> Placing:
        return self.piece(t)[0].rates(t)


def piece_of(motion: Motion, t: float) -> tuple[Motion, float]:
    """The smooth motion at time t, and until when it lasts, in s."""
    return motion.piece(t) if isinstance(motion, InTurn) else (motion, inf)


def moved(point: Vector, motion: Motion, t: float) -> Vector:
    """The place in m, at time t, of a point of what is moved."""
    (x, y), (u, v, angle) = motion.about, motion.place(t)
    c, s, dx, dy = cos(angle), sin(angle), point[0] - x, point[1] - y
    return u + c * dx - s * dy, v + s * dx + c * dy


def _said(place: Placing) -> str:
    return f"({place.x:.6g}, {place.y:.6g}) m, {place.angle:.6g} rad"


def _polynomial(coefficients: Sequence[float], t: float) -> float:
    value = 0.0
    for coefficient in reversed(coefficients):
        value = value * t + coefficient
    return value


def _derivative(coefficients: Sequence[float]) -> list[float]:
    return [power * coefficient for power, coefficient in enumerate(coefficients)][1:]
