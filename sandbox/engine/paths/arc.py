"""A piece of a ball's path: polynomials in time, used to find the time of contact and to sample the path."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot
from typing import Any

from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Surface
from sandbox.engine.paths.bernstein import derivative, evaluate, first_part
from sandbox.engine.paths.phase import ArcContact, Phase
from sandbox.physics.elementwise import everywhere, where
from sandbox.physics.integrators import Acceleration, State

#: Step in s below which the mean velocity (x1 - x0) / h is mostly rounding (1e-14 m at 100 m) and is not used.
_SHORT = 1e-3


@dataclass(slots=True, eq=False)
class Arc:
    """The path of one ball from t0 to t1.

    ``curves`` has a polynomial for each component of the state, as Bernstein coefficients in u = (t - t0) / (t1 - t0).
    After a step a coordinate is the quintic that matches it, its velocity and its acceleration at both ends (error of
    order h^6), and its velocity the derivative; a ball's spin is the cubic that matches spin and its rate at both ends.
    ``contact`` is None in free motion; ``phase``, ``surface``, ``contact_span`` and ``drift`` describe it.
    """

    t0: float  # s
    t1: float  # s
    start: State
    curves: tuple[Sequence[float], ...]  # m, m/s, rad/s; the angle of a body in rad
    contact: ArcContact | None = None
    end: State | None = None  # the state at t1, if known without evaluation
    _box: tuple[float, float, float, float] | None = None
    _fastest: float | None = None
    _last: float | None = None

    @property
    def x(self) -> Sequence[float]:
        return self.curves[0]

    @property
    def y(self) -> Sequence[float]:
        return self.curves[1]

    @property
    def phase(self) -> Phase:
        """The phase of the ball's motion."""
        return Phase.FREE if self.contact is None else self.contact.phase

    @property
    def surface(self) -> Surface | None:
        """The surface that it slides, rolls or rests on, if any."""
        return None if self.contact is None else self.contact.surface

    @property
    def contact_span(self) -> tuple[float, float] | None:
        """Begin and end in s of the simulated contact with others that it is in; None if it is in none."""
        return None if self.contact is None else self.contact.span

    @property
    def drift(self) -> Vector:
        """The velocity in m/s by position correction in a heap, which is no part of the ball's own."""
        return (0.0, 0.0) if self.contact is None else self.contact.drift

    def state(self, t: float) -> State:
        """Position, velocity, spin and what else is in its state at time t in [t0, t1]."""
        h = self.t1 - self.t0
        if h <= 0.0 or t <= self.t0:
            return self.start
        if t >= self.t1 and self.end is not None:
            return self.end
        u = (t - self.t0) / h if t < self.t1 else 1.0
        return tuple([evaluate(curve, u) for curve in self.curves])

    def spins(self, t: float) -> State:
        """The part of the state from the spin on, at time t in [t0, t1]."""
        h = self.t1 - self.t0
        if h <= 0.0 or t <= self.t0:
            return self.start[4:]
        if t >= self.t1 and self.end is not None:
            return self.end[4:]
        u = (t - self.t0) / h if t < self.t1 else 1.0
        return tuple([evaluate(curve, u) for curve in self.curves[4:]])

    def position(self, t: float) -> tuple[float, float]:
        """x and y at time t, in m."""
        h = self.t1 - self.t0
        x, y = self.curves[0], self.curves[1]
        if h <= 0.0 or t <= self.t0 or len(x) == 1:
            return x[0], y[0]
        u = min(1.0, max(0.0, (t - self.t0) / h))
        return evaluate(x, u), evaluate(y, u)

    def acceleration(self, t: float) -> tuple[float, float]:
        """Return the ball's acceleration at time t, in m/s^2; zero on an arc without duration."""
        h = self.t1 - self.t0
        if h <= 0.0:
            return 0.0, 0.0
        u = min(1.0, max(0.0, (t - self.t0) / h))
        return evaluate(derivative(self.curves[2]), u) / h, evaluate(derivative(self.curves[3]), u) / h

    @property
    def rests(self) -> bool:
        """True if the ball neither moves nor spins, for some time."""
        return len(self.curves[0]) == 1 == len(self.curves[4]) and self.t1 > self.t0

    def box(self) -> tuple[float, float, float, float]:
        """Left, bottom, right, top (m) of a rectangle that holds the path, as far as it is truncated."""
        if self._box is None:
            x, y = self.curves[0], self.curves[1]
            self._box = min(x), min(y), max(x), max(y)
        return self._box

    @property
    def truncated_at(self) -> float:
        """The time in s up to which it is followed."""
        return self.t1 if self._last is None else self._last

    def truncate_at(self, t: float) -> None:
        """It will not be followed farther than to t."""
        if t < self.t1:
            self._last = t
            u = (t - self.t0) / (self.t1 - self.t0)
            x, y = first_part(self.curves[0], u), first_part(self.curves[1], u)
            self._box = min(x), min(y), max(x), max(y)

    def box_within(self, t: float, h: float) -> tuple[float, float, float, float]:
        """Left, bottom, right, top (m) of a rectangle that holds the path for h s from t."""
        (x, y), reach = self.position(t), self.fastest() * h
        return x - reach, y - reach, x + reach, y + reach

    def fastest(self) -> float:
        """A speed in m/s that the ball does not exceed."""
        if self._fastest is None:
            self._fastest = hypot(max(map(abs, self.curves[2])), max(map(abs, self.curves[3])))
        return self._fastest

    def until(self, t: float) -> Arc:
        """The same path, ending at t."""
        if t >= self.t1:
            return self
        u = max(0.0, (t - self.t0) / (self.t1 - self.t0))
        if u == 0.0:
            return resting_arc(self.t0, self.t0, self.start, self.contact)
        return Arc(self.t0, t, self.start, tuple([first_part(curve, u) for curve in self.curves]), self.contact)


def curves_between(
    h: Any, start: State, acceleration: Acceleration, end: State, end_acceleration: Acceleration
) -> tuple[Any, ...]:
    """The curves of the arc of a ball in flight that matches both ends of a step of length h, as in ``Arc.curves``."""
    x0, y0, vx0, vy0, w0 = start
    x1, y1, vx1, vy1, w1 = end
    ax0, ay0, al0 = acceleration
    ax1, ay1, al1 = end_acceleration
    p, q, quarter, third = 0.2 * h, 0.05 * h * h, 0.25 * h, h / 3.0
    mx = 5.0 * (x1 - x0) / h - 2.0 * (vx0 + vx1) + quarter * (ax1 - ax0)
    my = 5.0 * (y1 - y0) / h - 2.0 * (vy0 + vy1) + quarter * (ay1 - ay0)
    if not everywhere(h > _SHORT):
        mx = where(h > _SHORT, mx, 0.5 * (vx0 + vx1 + third * (ax0 - ax1)))
        my = where(h > _SHORT, my, 0.5 * (vy0 + vy1 + third * (ay0 - ay1)))
    xp0, yp0, xp1, yp1 = p * vx0, p * vy0, p * vx1, p * vy1
    return (
        (x0, x0 + xp0, x0 + 2.0 * xp0 + q * ax0, x1 - 2.0 * xp1 + q * ax1, x1 - xp1, x1),
        (y0, y0 + yp0, y0 + 2.0 * yp0 + q * ay0, y1 - 2.0 * yp1 + q * ay1, y1 - yp1, y1),
        (vx0, vx0 + quarter * ax0, mx, vx1 - quarter * ax1, vx1),
        (vy0, vy0 + quarter * ay0, my, vy1 - quarter * ay1, vy1),
        (w0, w0 + third * al0, w1 - third * al1, w1),
    )


def hermite_arc(
    t: Any,
    h: Any,
    start: State,
    acceleration: Acceleration,
    end: State,
    end_acceleration: Acceleration,
    contact: ArcContact | None = None,
) -> Arc:
    """The arc that matches both ends of a step of length h. Arrays of shape (n,) in place of floats give n arcs in
    one."""
    parts = (start, acceleration, end, end_acceleration)
    if len(start) == 5:
        return Arc(t, t + h, start, curves_between(h, *parts), contact, end)
    flying = [part[:count] for part, count in zip(parts, (5, 3, 5, 3), strict=True)]
    curves: tuple[Sequence[Any], ...] = curves_between(h, *flying)
    w0, al0, w1, al1 = (part[-1] for part in flying)
    third = h / 3.0
    if len(start) == 6:  # the angle is a coordinate, as x is
        ends = (start[5], 0.0, w0, 0.0, 0.0), (al0, 0.0, 0.0), (end[5], 0.0, w1, 0.0, 0.0), (al1, 0.0, 0.0)
        angle, _, spin, *_ = hermite_arc(t, h, *ends).curves
        curves = (*curves[:4], spin, angle)
    else:  # rolling spins, which change evenly unless their rates are given
        ends_of_spins = zip(start[5:], end[5:], strict=True)
        if len(acceleration) > 3:
            rates = zip(acceleration[3:], end_acceleration[3:], strict=True)
            spins = [(w, w + third * a, v - third * b, v) for (w, v), (a, b) in zip(ends_of_spins, rates, strict=True)]
            curves = (*curves, *spins)
        else:
            curves = (*curves, *ends_of_spins)
    return Arc(t, t + h, start, curves, contact, end)


def resting_arc(t: float, until: float, state: State, contact: ArcContact | None = None) -> Arc:
    """A ball that stays in place from t to ``until`` and spins evenly."""
    x, y, _, _, *spins = state
    return Arc(t, until, state, ((x,), (y,), (0.0,), (0.0,), *((spin,) for spin in spins)), contact)


def uniform_arc(t: float, until: float, state: State, contact: ArcContact | None = None) -> Arc:
    """A ball on which nothing acts from t to ``until``."""
    x, y, vx, vy, *spins = state
    h = until - t
    return Arc(t, until, state, ((x, x + h * vx), (y, y + h * vy), (vx,), (vy,), *((spin,) for spin in spins)), contact)


def crossing(arc: Arc, value: Callable[[float, State], float], rounding: float = 0.0) -> float:
    """The time at which ``value``, negative at the end of the arc, falls to zero; the start if it is never positive
    and more than ``rounding``."""
    low, high = arc.t0, arc.t1
    at_low, at_high = value(low, arc.start), value(high, arc.state(high))
    for halvings in range(1, 40):  # it may start at zero, as slip does when a rolling ball loses its grip
        if at_low > rounding:
            break
        low = arc.t0 + (high - arc.t0) * 0.5**halvings
        at_low = value(low, arc.state(low))
    else:
        return arc.t0
    for _ in range(60):  # regula falsi with the Illinois weights: high is the latest point, low on the other side
        t = low + (high - low) * at_low / (at_low - at_high)
        here = value(t, arc.state(t))
        if here == 0.0 or abs(t - high) <= 1e-15 * (1.0 + t):
            return t
        if here * at_high < 0.0:
            low, at_low = high, at_high
        else:
            at_low *= 0.5
        high, at_high = t, here
    return high
