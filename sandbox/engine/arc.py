"""A piece of a ball's path: polynomials in time, used to find the time of contact and to sample the path."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot
from typing import Any

from sandbox.engine.bernstein import evaluate, until
from sandbox.physics.elementwise import choose
from sandbox.physics.integrators import Acceleration, State

#: Step in s below which the mean velocity (x1 - x0) / h is mostly rounding (1e-14 m at 100 m) and is not used.
_SHORT = 1e-3


@dataclass(slots=True, eq=False)
class Arc:
    """The path of one ball from t0 to t1.

    The position is the quintic that matches position, velocity and acceleration at both ends (error of order h^6),
    the velocity is its derivative, and the spin is the cubic that matches spin and its rate at both ends; all stored
    as Bernstein coefficients in u = (t - t0) / (t1 - t0). ``contact`` is what the ball slides or rolls on, or None in
    flight; ``rolling_spin`` holds the coefficients of the spin about x and about y of a ball that rolls on a plane, as
    its state has two more components.
    """

    t0: float  # s
    t1: float  # s
    start: State
    x: Sequence[float]  # m
    y: Sequence[float]
    vx: Sequence[float]  # m/s
    vy: Sequence[float]
    spin: Sequence[float]  # rad/s
    contact: object = None
    rolling_spin: tuple[Sequence[float], ...] = ()
    end: State | None = None  # the state at t1, if known without evaluation
    _box: tuple[float, float, float, float] | None = None
    _fastest: float | None = None

    def state(self, t: float) -> State:
        """Position, velocity and spin at time t in [t0, t1]."""
        h = self.t1 - self.t0
        if h <= 0.0 or t <= self.t0:
            return self.start
        if t >= self.t1 and self.end is not None:
            return self.end
        u = (t - self.t0) / h if t < self.t1 else 1.0
        return (
            evaluate(self.x, u),
            evaluate(self.y, u),
            evaluate(self.vx, u),
            evaluate(self.vy, u),
            evaluate(self.spin, u),
            *[evaluate(curve, u) for curve in self.rolling_spin],
        )

    def position(self, t: float) -> tuple[float, float]:
        """x and y at time t, in m."""
        h = self.t1 - self.t0
        if h <= 0.0 or len(self.x) == 1:
            return self.x[0], self.y[0]
        u = min(1.0, max(0.0, (t - self.t0) / h))
        return evaluate(self.x, u), evaluate(self.y, u)

    @property
    def rests(self) -> bool:
        """Whether the ball neither moves nor spins, for some time."""
        return len(self.x) == len(self.spin) == 1 and self.t1 > self.t0

    def box(self) -> tuple[float, float, float, float]:
        """Left, bottom, right, top (m) of a rectangle that holds the whole path."""
        if self._box is None:
            self._box = min(self.x), min(self.y), max(self.x), max(self.y)
        return self._box

    def fastest(self) -> float:
        """A speed in m/s that the ball does not exceed."""
        if self._fastest is None:
            self._fastest = hypot(max(map(abs, self.vx)), max(map(abs, self.vy)))
        return self._fastest

    def until(self, t: float) -> Arc:
        """The same path, ending at t."""
        if t >= self.t1:
            return self
        u = max(0.0, (t - self.t0) / (self.t1 - self.t0))
        if u == 0.0:
            return still(self.t0, self.t0, self.start, self.contact)
        return Arc(
            self.t0,
            t,
            self.start,
            until(self.x, u),
            until(self.y, u),
            until(self.vx, u),
            until(self.vy, u),
            until(self.spin, u),
            self.contact,
            tuple(until(curve, u) for curve in self.rolling_spin),
        )


def through(
    t: Any,
    h: Any,
    start: State,
    acceleration: Acceleration,
    end: State,
    end_acceleration: Acceleration,
    contact: object = None,
) -> Arc:
    """The arc that matches both ends of a step of length h. Arrays of shape (n,) in place of floats give n arcs in
    one."""
    x0, y0, vx0, vy0, w0 = start[:5]
    x1, y1, vx1, vy1, w1 = end[:5]
    ax0, ay0, al0 = acceleration
    ax1, ay1, al1 = end_acceleration
    p = 0.2 * h
    q = 0.05 * h * h
    quarter = 0.25 * h
    third = h / 3.0
    mx = 5.0 * (x1 - x0) / h - 2.0 * (vx0 + vx1) + quarter * (ax1 - ax0)
    my = 5.0 * (y1 - y0) / h - 2.0 * (vy0 + vy1) + quarter * (ay1 - ay0)
    if not isinstance(h, float) or h <= _SHORT:
        mx = choose(h > _SHORT, mx, 0.5 * (vx0 + vx1 + third * (ax0 - ax1)))
        my = choose(h > _SHORT, my, 0.5 * (vy0 + vy1 + third * (ay0 - ay1)))
    arc = Arc(
        t,
        t + h,
        start,
        (x0, x0 + p * vx0, x0 + 2.0 * p * vx0 + q * ax0, x1 - 2.0 * p * vx1 + q * ax1, x1 - p * vx1, x1),
        (y0, y0 + p * vy0, y0 + 2.0 * p * vy0 + q * ay0, y1 - 2.0 * p * vy1 + q * ay1, y1 - p * vy1, y1),
        (vx0, vx0 + quarter * ax0, mx, vx1 - quarter * ax1, vx1),
        (vy0, vy0 + quarter * ay0, my, vy1 - quarter * ay1, vy1),
        (w0, w0 + third * al0, w1 - third * al1, w1),
        contact,
        end=end,
    )
    if len(start) == 6:  # a body's angle changes as a coordinate does
        turns = [(angle, 0.0, spin, 0.0, 0.0) for *_, spin, angle in (start, end)]
        turn = through(t, h, turns[0], (al0, 0.0, 0.0), turns[1], (al1, 0.0, 0.0))
        arc.spin, arc.rolling_spin = turn.vx, (turn.x,)
    return arc


def still(t: float, until: float, state: State, contact: object = None) -> Arc:
    """A ball that stays in place from t to ``until`` and spins evenly."""
    x, y, _, _, spin, *rolling_spin = state
    rolling = tuple((component,) for component in rolling_spin)
    return Arc(t, until, state, (x,), (y,), (0.0,), (0.0,), (spin,), contact, rolling)
