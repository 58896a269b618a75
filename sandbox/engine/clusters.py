"""Impacts of several bodies at once, simulated through the contact with its forces.

An impulse is right for an isolated pair. If two bodies reach a third while they are in contact, the outcome depends on
how the contacts overlap in the fraction of a millisecond they last. So the contact is simulated: positions and
velocities under the forces of Hertz's law (``physics/hertz.py``) by Dormand and Prince's pair, and friction impulses
at the ends of its steps (``rubbing.py``).

All contacts are treated at once, as rows of arrays, so that the outcome does not depend on the order of the bodies.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sandbox.engine.rubbing import Rubbing
from sandbox.engine.surfaces import CLOSING
from sandbox.errors import RunError
from sandbox.physics.hertz import contact_time, damping
from sandbox.physics.integrators import DORMAND_PRINCE

_STAGES = [np.array(stage.weights) for stage in DORMAND_PRINCE.stages]
_ERROR = np.array(DORMAND_PRINCE.error)

#: Largest error of a step by the embedded pair, relative to the fastest speed; if it is larger, all is repeated with
#: half the step. Steps are otherwise equal, so that the outcome depends smoothly on the input and rounding stays small.
_LARGEST_ERROR = 1e-3

#: Up to this many links, steps end where a link closes or opens, and are graded around that time: by this ratio, so
#: often for one link, and for more.
_MAX_GRADED_LINKS, _RATIO, _GRADES_OF_ONE, _GRADES = 6, 4.0, 6, 2

#: Longest contact times, for each body and in addition, after which bodies that press on one another will not separate
#: by themselves; a chain of n equal balls takes 1 + (n - 1) / 2.
_PATIENCE = 1.0, 10.0

#: Depth in m below which it is rounding.
_TOUCH = 1e-12


class StaysPressed(RunError):
    """Bodies that do not separate: something presses them together."""


class Body(NamedTuple):
    """A ball at the start of the contact, in m, kg, s, rad; ``push`` is its acceleration from other causes."""

    mass: float
    radius: float
    inertia: float  # kg m^2
    position: tuple[float, float]
    velocity: tuple[float, float]
    spin: tuple[float, float, float]  # rad/s, about x, y and the axis out of the picture
    push: tuple[float, float] = (0.0, 0.0)  # m/s^2


class Link(NamedTuple):
    """Two bodies that may touch, or a body and a wall."""

    first: int
    second: int | None  # None for a wall
    stiffness: float  # N/m^1.5
    restitution: float
    friction: Callable[[float], float]  # of the slip in m/s
    wall: Callable[[float, float], tuple[float, float, float]] | None = None  # gap (m) and normal of a body at (x, y)


@dataclass(frozen=True)
class ClusterOutcome:
    """The state of a cluster after the contact: arrays with a row for each body, or an entry for each link."""

    duration: float  # s
    position: np.ndarray  # m, shape (n, 2)
    velocity: np.ndarray  # m/s, shape (n, 2)
    spin: np.ndarray  # rad/s, shape (n, 3)
    impulse: np.ndarray  # N s, normal, shape (links,); 0 if the link never closed
    approach: np.ndarray  # m/s, when it first closed, shape (links,)
    closed: np.ndarray  # s, time when it first closed, shape (links,)
    steps: int


class Cluster:
    """Bodies and the links between them. The cost grows with all of them: leave out what cannot be reached."""

    def __init__(self, bodies: Sequence[Body], links: Sequence[Link]) -> None:
        count = len(bodies)
        self._count, self._links = count, links
        self._bodies = bodies
        self._first = np.array([link.first for link in links])
        self._second = np.array([count if link.second is None else link.second for link in links])  # a wall: the last
        radius = np.array([*(body.radius for body in bodies), 0.0])
        inverse_mass = np.array([*(1.0 / body.mass for body in bodies), 0.0])
        inverse_inertia = np.array([*(1.0 / body.inertia for body in bodies), 0.0])
        self._inertia = np.repeat([1.0 / inverse_mass[:-1], 1.0 / inverse_inertia[:-1]], 3, axis=0)  # kg, kg m^2
        self._reach = radius[self._first] + radius[self._second]
        self._stiffness = np.array([link.stiffness for link in links])
        self._mass = 1.0 / (inverse_mass[self._first] + inverse_mass[self._second])  # kg, reduced
        self._damping = np.array([damping(link.restitution) for link in links]) * np.sqrt(self._mass * self._stiffness)
        self._stored = 0.8 * self._stiffness / self._mass  # times depth^2.5: m^2/s^2
        every = range(len(links))
        self._incidence = np.zeros((count + 1, len(links)))
        self._incidence[self._first, every] = 1.0
        self._incidence[self._second, every] = -1.0
        laws = [link.friction for link in links]
        self._rubbing = Rubbing(self._incidence, radius, inverse_mass, inverse_inertia, laws)
        self._pushed = np.ascontiguousarray((self._incidence * inverse_mass[:, None]).T)  # force to acceleration
        self._walls = [(place, link.wall, link.first) for place, link in enumerate(links) if link.wall is not None]

    def pass_through(self, share: float, faint: float = 0.0) -> ClusterOutcome:
        """Simulate the contact until nothing touches, in steps of this fraction of the shortest possible contact, or
        until what is left is slower than ``faint`` (m/s).

        Raises StaysPressed if it does not end.
        """
        while True:
            passage, error = self._stepped_through(share, faint)
            if error <= _LARGEST_ERROR:
                return passage
            share *= 0.5

    def _stepped_through(self, share: float, faint: float) -> tuple[ClusterOutcome, float]:
        count, links = self._count, len(self._links)
        state = np.zeros((8, count + 1))  # x, y, vx, vy, vz, and the spins
        for i, body in enumerate(self._bodies):
            state[:, i] = (*body.position, *body.velocity, 0.0, *body.spin)
        origin = state[:2, :1].copy()
        state[:2, :count] -= origin
        state[:2, count] = 1e3  # m: a placeholder for walls, never read
        self._origin = origin[:, 0]
        self._push = np.array([*(body.push for body in self._bodies), (0.0, 0.0)]).T
        before = state.copy()
        surface = np.abs(state[5:8, :count]).max(axis=0) * [body.radius for body in self._bodies]
        fastest = max(2.0 * float(np.hypot(*state[2:4]).max()), CLOSING)
        quickest = max(fastest, float(surface.max()))
        times = [contact_time(m, k, fastest) for m, k in zip(self._mass, self._stiffness, strict=True)]
        shortest, longest = min(times), max(times)
        scale = np.repeat([fastest * shortest, fastest], 2 * count + 2)
        whole, t, steps, worst = share * shortest, 0.0, 0, 0.0
        lands, grades = links <= _MAX_GRADED_LINKS, _grades(_GRADES_OF_ONE if links == 1 else _GRADES)
        impulse, approach, closed, rubbed = (np.zeros(links) for _ in range(4))
        rates, forces = np.empty((7, 4, count + 1)), np.empty((7, links))
        flat = rates.reshape(7, -1)
        # Links that are closed at the start store no energy: their distance then is where their force begins.
        self._overlap = np.zeros(links)
        self._motion(state[:4])
        self._overlap = np.minimum(self._gap, 0.0)
        rates[0], depth, closing, normal, force = self._motion(state[:4])
        gain, gap = rates[0, 2:].copy(), self._gap  # m/s^2, m
        approach[:] = np.where(self._gap < _TOUCH, np.maximum(closing, 0.0), 0.0)
        plan, back = [whole * part for part in grades] if lands else [whole], 0.0
        while True:
            h = plan[0]
            # Friction of the previous and next half step: second order, and mu times the impulse in total.
            reached = np.maximum(impulse + 0.5 * h * force, rubbed)
            start = state.copy()
            start[2:] = self._rubbing.after(state[2:], normal, reached - rubbed, gain, back, 0.5 * h, quickest)
            rates[0], *_, forces[0] = self._motion(start[:4])
            for stage, weights in enumerate(_STAGES, 1):
                moved = start[:4] + (h * weights @ flat[:stage]).reshape(4, -1)
                rates[stage], depth, closing_then, normal, forces[stage] = self._motion(moved)
            if lands and len(plan) == 1:
                kink = _first_kink(h, gap, self._gap, closing, closing_then)
                if kink is not None:
                    plan = [*(kink * part for part in reversed(grades)), *((h - kink) * part for part in grades)]
                    continue
            worst, back = max(worst, float(np.abs(_ERROR @ flat / scale).max()) * h), 0.5 * h
            plan, gap = plan[1:] or [whole], self._gap
            state, rubbed, force, gain = start, reached, forces[6].copy(), rates[6, 2:].copy()
            state[:4] = moved
            impulse += h * (_STAGES[-1] @ forces[:6])
            first = (depth > 0.0) & (approach == 0.0)
            approach[first], closed[first] = closing[first], t
            closing = closing_then
            t, steps = t + h, steps + 1
            moving = (depth > _TOUCH) | ((self._gap < _TOUCH) & (closing > CLOSING))
            if faint > 0.0:
                moving &= np.maximum(closing, 0.0) ** 2 + self._stored * depth**2.5 > faint * faint
            if not moving.any():
                rest = np.maximum(impulse - rubbed, 0.0)
                state[2:] = self._rubbing.after(state[2:], normal, rest, gain, back, 0.0, quickest)
                break
            if t > (_PATIENCE[0] * count + _PATIENCE[1]) * longest:
                raise StaysPressed(f"bodies do not separate within {t:.3g} s")
        worked = float(np.hypot(*self._push[:, :count]) @ self._inertia[0]) * fastest * t  # J, an upper bound
        touched = np.flatnonzero(np.abs(self._incidence[:-1]) @ (impulse > 0.0))
        if touched.size:
            self._remove_excess_energy(state, touched, self._energy(before, touched) + worked)
        position = (state[:2, :count] + origin).T
        velocity, spin = state[2:4, :count].T, state[5:8, :count].T
        return ClusterOutcome(float(t), position, velocity, spin, impulse, approach, closed, steps), worst

    def _motion(self, moving: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
        """The derivative of (x, y, vx, vy), and for each link the depth (m), closing speed (m/s), normal, force (N)."""
        apart = moving @ self._incidence
        distance = np.hypot(apart[0], apart[1])
        normal = apart[:2] / distance
        gap = distance - self._reach
        for place, wall, body in self._walls:
            x, y = moving[:2, body] + self._origin
            gap[place], *normal[:, place] = wall(float(x), float(y))
        gap -= self._overlap
        opening = np.add.reduce(apart[2:] * normal)
        depth = np.maximum(-gap, 0.0)
        root = np.sqrt(depth)
        force = root * (self._stiffness * depth) - np.sqrt(root) * (self._damping * opening)
        rate = np.concatenate([moving[2:], (force * normal) @ self._pushed + self._push])
        self._gap = gap
        return rate, depth, -opening, normal, force

    def _energy(self, state: np.ndarray, bodies: np.ndarray) -> float:
        """Kinetic energy in J of these bodies, including rotation."""
        return 0.5 * float((state[2:, bodies] ** 2 * self._inertia[:, bodies]).sum())

    def _remove_excess_energy(self, state: np.ndarray, touched: np.ndarray, before: float) -> None:
        """Slow the bodies that were touched towards their common motion if numerical errors have raised their energy
        above ``before``."""
        common, inertia = np.zeros((6, 1)), self._inertia[:, touched]
        if not self._walls:
            common[:2, 0] = state[2:4, touched] @ inertia[0] / inertia[0].sum()
        kept = 0.5 * float((common**2 * inertia).sum())
        excess = self._energy(state, touched) - before
        if excess > 0.0:
            share = np.sqrt(max(0.0, (before - kept) / (before - kept + excess)))
            state[2:, touched] = common + share * (state[2:, touched] - common)


def _grades(count: int) -> list[float]:
    """The parts of a step that is divided more finely towards its start, where the force has a kink."""
    return [_RATIO**-count, *((_RATIO - 1.0) * _RATIO**-power for power in range(count, 0, -1))]


def _first_kink(
    h: float, gap: np.ndarray, gap_after: np.ndarray, closing: np.ndarray, closing_after: np.ndarray
) -> float | None:
    """The time in a step of h s at which the first link closes or opens, by the cubic through gaps and speeds, or
    None."""
    first = None
    for link in np.flatnonzero(gap * gap_after < 0.0).tolist():
        a, b = float(gap[link]), float(gap_after[link])
        p, q = -h * float(closing[link]), -h * float(closing_after[link])
        low, high = 0.0, 1.0
        for _ in range(50):
            u = 0.5 * (low + high)
            v = 1.0 - u
            here = v * v * (a * (1.0 + 2.0 * u) + p * u) + u * u * (b * (1.0 + 2.0 * v) - q * v)
            low, high = (u, high) if here * a > 0.0 else (low, u)
        if 1e-3 < low < 1.0 - 1e-3 and (first is None or low * h < first):
            first = low * h
    return first
