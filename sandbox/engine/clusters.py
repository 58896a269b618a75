"""Impacts of several bodies at once, simulated through the contact with its forces.

An impulse is right for an isolated pair. If two bodies reach a third while they are in contact, the outcome depends on
how the contacts overlap in the fraction of a millisecond they last. So the contact is simulated: positions and
velocities under the forces of Hertz's law (``physics/hertz.py``) by Kutta's method of order 4, and friction impulses
at the ends of its steps (``rubbing.py``).

The force of damping, ``c d^(1/4) dd/dt``, is the rate of ``c 4/5 d^(5/4)``, which is how much of the momentum it has
taken in all. So the velocities without that part are integrated: their forces have no steep start, and equal steps are
accurate though contacts close and open within them.

All contacts are treated at once, as entries of arrays, so that the outcome does not depend on the order of the bodies;
and several clusters, such as the racks of a fan's breaks, one after another in the same arrays. Vectors in the plane
are complex numbers, x + iy. Products with matrices are by ``vecdot``: with ``@`` large ones are shared by threads, a
hundred times as slow where other programs keep the processors busy.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from math import hypot
from typing import Any, NamedTuple, TypeVar

import numpy as np

from sandbox.engine.rubbing import Law, Rubbing
from sandbox.engine.surfaces import CLOSING
from sandbox.errors import RunError, no_exit
from sandbox.physics.hertz import contact_time, damping
from sandbox.physics.integrators import INTEGRATORS

_STAGES = [np.array(stage.weights) for stage in INTEGRATORS["rk4"].stages]

#: Largest error of a step, relative to the fastest speed; if it is larger, all is repeated with half the step. It is
#: taken from the rates at the end, of the last stage and of the outcome: with those in its place the order is 3. Steps
#: are otherwise equal, so that the outcome depends smoothly on the input and rounding stays small.
_LARGEST_ERROR = 1e-3
_ERROR = np.array([0.0, 0.0, 0.0, 1.0, -1.0]) / 6.0

#: A lone pair, which has to have its restitution to 1e-6, takes half the usual steps, and shorter ones near the kinks
#: of its force: half the time since its closing or to its opening, down to a share.
_OF_A_PAIR, _FINEST = 0.5, 1 / 64

#: Most steps through a contact. Those of a break are about 50; 10,000 are a second of computing.
_MOST_STEPS = 10_000

#: Depth in radii of the smaller ball from which balls would pass through each other.
_TOO_DEEP = 1.0

#: Longest contact times, for each body and in addition, after which bodies that press on one another will not separate
#: by themselves; a chain of n equal balls takes 1 + (n - 1) / 2.
_PATIENCE = 1.0, 10.0

#: The slowest blow that they wait for, in m/s: a grazing ball leaves little. Where something else presses them together
#: it is what that gives them in so many contact times.
_SLOWEST, _TIMES = 1e-3, 10.0

#: Depth in m below which it is rounding.
_TOUCH = 1e-12

#: Rows of a motion: place (m), velocity (m/s) and spin (rad/s) in the plane, and out of it ``vz + i wz``.
_PLACE, _VELOCITY, _ROLL, _OUT = range(4)


class Unresolved(RunError):
    """A contact without an end: something presses the bodies together, or through each other."""


class Entered(Unresolved):
    """A body has moved farther than it may."""


class Body(NamedTuple):
    """A ball at the start of the contact, in m, kg, s, rad; ``push`` is its acceleration from other causes."""

    mass: float
    radius: float
    inertia: float  # kg m^2
    position: tuple[float, float]
    velocity: tuple[float, float]
    spin: tuple[float, float, float]  # rad/s, about x, y and the axis out of the picture
    push: tuple[float, float] = (0.0, 0.0)  # m/s^2
    room: float = np.inf  # m, by which it may move


class Link(NamedTuple):
    """Two bodies that may touch, or a body and a wall."""

    first: int
    second: int | None  # None for a wall
    stiffness: float  # N/m^1.5
    restitution: float
    law: Law  # of its friction
    approach: float = 0.0  # m/s, at which it is asked
    #: Gap (m), normal, and curvature (1/m) of the path along the wall, and what else, of a body at (x, y).
    wall: Callable[[float, float], Sequence[Any]] | None = None


@dataclass(frozen=True)
class ClusterOutcome:
    """A cluster through the contact: ``motion`` at the ``times``, and an entry for each link."""

    times: np.ndarray  # s, from 0 to the end, shape (times,)
    motion: np.ndarray  # x, y, vx, vy and the spins about z, x, y, shape (times, bodies, 7); m, m/s, rad/s
    impulse: np.ndarray  # N s, normal, shape (links,); 0 if the link never closed
    approach: np.ndarray  # m/s, when it first closed, shape (links,)
    closed: np.ndarray  # s, time when it first closed, shape (links,)

    @property
    def velocity(self) -> np.ndarray:
        """At the end, in m/s, shape (bodies, 2)."""
        return self.motion[-1, :, 2:4]

    @property
    def spin(self) -> np.ndarray:
        """At the end, in rad/s about z, x and y, shape (bodies, 3)."""
        return self.motion[-1, :, 4:]


@dataclass(frozen=True)
class Cluster:
    """Bodies and the links between them. The cost grows with all of them: leave out what cannot be reached."""

    bodies: Sequence[Body]
    links: Sequence[Link]

    @property
    def is_apart(self) -> bool:
        """Whether it takes steps of its own, or has walls."""
        return len(self.links) == 1 or any(link.wall is not None for link in self.links)

    def pass_through(self, share: float, faint: float = 0.0) -> ClusterOutcome:
        """Simulate the contact until nothing touches, in steps of this fraction of the shortest possible contact, or
        until what is left is slower than ``faint`` (m/s).

        Raises Unresolved if it does not end, or after too many steps; Entered if a body moves farther than it may.
        """
        return _Passage([self]).outcomes(share, faint)[0]


#: What takes the place of the second body of a link to a wall, and of what a cluster has fewer of than others.
_NOTHING = Body(np.inf, 0.0, np.inf, (0.0, 0.0), (0.0, 0.0), (0.0, 0.0, 0.0))
_FAR = 1e3  # m, from all others


class _Passage:
    """Clusters that are passed through with steps in common: one after another in arrays, each with as many bodies and
    links as the largest has."""

    def __init__(self, clusters: Sequence[Cluster]) -> None:
        self._clusters, rows = clusters, len(clusters)
        count, most = 1 + max(len(each.bodies) for each in clusters), max(len(each.links) for each in clusters)
        self._bodies, links = list[Body](), list[Link]()
        for each in clusters:
            self._bodies += [*each.bodies, *[_NOTHING] * (count - len(each.bodies))]
            # more links are of the first body, to nothing
            links += [*each.links, *[each.links[0]._replace(second=None)] * (most - len(each.links))]
        begun: np.ndarray = np.repeat(count * np.arange(rows), most)
        self._first = begun + [link.first for link in links]
        self._second = begun + [count - 1 if link.second is None else link.second for link in links]
        self._weights = np.array([(body.mass, body.inertia) for body in self._bodies]).T
        light, easy = 1.0 / self._weights
        radius = np.array([body.radius for body in self._bodies])
        self._room = np.array([body.room for body in self._bodies])
        self._push = np.array([complex(*body.push) for body in self._bodies])
        self._mass = 1.0 / (light.take(self._first) + light.take(self._second))  # kg, reduced
        self._stiffness = np.array([link.stiffness for link in links])
        self._damping = np.array([damping(link.restitution) for link in links]) * np.sqrt(self._mass * self._stiffness)
        self._taken = 0.8 * self._damping
        one, other = radius.take(self._first), radius.take(self._second)
        self._deepest = _TOO_DEEP * np.where(other > 0.0, np.minimum(one, other), one)
        self._reach = one + other
        laws = [(link.law, link.approach) for link in links]
        self._rubbing = Rubbing(rows, self._first, self._second, radius, light, easy, laws)
        self._pushed = self._rubbing.pull  # 1/kg: by an impulse at each link
        self._walls = [(place, link.wall, link.first) for place, link in enumerate(links) if link.wall is not None]

    def outcomes(self, share: float, faint: float) -> list[ClusterOutcome]:
        """Of each; raises what one of them does."""
        while (passage := self._stepped_through(share, faint)) is None:
            share *= 0.5
        return passage

    def _stepped_through(self, share: float, faint: float) -> list[ClusterOutcome] | None:
        """The same with steps that are not repeated; None if one has too large an error."""
        rows, links = len(self._clusters), len(self._first)
        each = [
            (complex(*body.position), complex(*body.velocity), complex(*body.spin[:2]), 1j * body.spin[2])
            for body in self._bodies
        ]
        state = np.array(each).T.copy()
        count = state.shape[1] // rows
        self._origin = np.repeat(state[_PLACE, ::count], count)
        state[_PLACE] -= self._origin
        state[_PLACE, np.isinf(self._weights[0])] = _FAR
        fastest = max(2.0 * float(np.abs(state[_VELOCITY]).max()), CLOSING)
        quickest = max(fastest, *(hypot(*body.spin) * body.radius for body in self._bodies))
        at = partial(contact_time, self._mass, self._stiffness)
        slowest = _SLOWEST + _TIMES * np.abs(self._push).max() * at(_SLOWEST).max()
        shortest, longest = at(fastest).min(), at(min(slowest, fastest)).max()
        started = state[_PLACE].copy()
        scale = np.repeat([fastest * shortest, fastest], len(started))
        whole, h, t = share * shortest, 0.0, 0.0
        rates, elastic = np.empty((5, 2, len(started)), complex), np.empty((5, links))
        flat = rates.reshape(5, -1)
        # Links that are closed at the start store no energy: their distance then is where their force begins.
        self._overlap = np.zeros(links)
        self._rates(state[:2], rates[0])
        self._overlap = np.minimum(self._gap, 0.0)
        elastic[0] = self._rates(state[:2], rates[0])
        pushed, rubbed, closed = (np.zeros(links) for _ in range(3))  # N s: elastic, and what has had its friction
        force, closing, normal = elastic[0], self._closing, self._normal
        approach = np.where(self._gap < _TOUCH, np.maximum(closing, 0.0), 0.0)
        moments, ends = [0.0], False
        states: list[np.ndarray] = []
        while True:
            # Friction of the previous and next half step: second order, and mu times the impulse in total.
            back, h = 0.5 * h, whole
            if links == 1:
                kink = abs(float(self._gap[0])) / max(abs(float(closing[0])), CLOSING)  # s, from here
                h *= _OF_A_PAIR * min(1.0, max(_FINEST, kink / h))
            ahead = 0.0 if ends else 0.5 * h
            reached = np.maximum(pushed + self._held + ahead * force, rubbed)
            gain = self._pushing(force * self._normal) + self._push  # m/s^2
            normals, pressed = self._normal, reached - rubbed
            state[1:] = self._rubbing.after(state[1:], normals, pressed, gain, back, ahead, quickest, share)
            states.append(state)
            if ends:
                break
            if t > (_PATIENCE[0] * (count - 1) + _PATIENCE[1]) * longest or len(moments) > _MOST_STEPS:
                raise Unresolved(f"bodies do not separate within {t:.3g} s")
            if ((self._depth > self._deepest) | ((normal.conj() * self._normal).real < 0.0)).any():
                raise Unresolved(f"bodies pass through each other after {t:.3g} s")
            if (np.abs(state[_PLACE] - started) > self._room).any():
                raise Entered(f"a body has left its place after {t:.3g} s")
            rubbed, before, gap, normal = reached, closing, self._gap, self._normal
            start = state[:2].copy()
            start[1] -= self._pushing(self._held * self._normal)
            elastic[0] = self._rates(start, rates[0])
            for stage, weights in enumerate(_STAGES, 1):
                moved = start + (h * weights @ flat[:stage]).reshape(2, -1)
                elastic[stage] = self._rates(moved, rates[stage])
            if np.abs(_ERROR @ flat / scale).max() * h > _LARGEST_ERROR:
                return None
            state = state.copy()
            state[:2] = moved[0], rates[4, 0]
            pushed, closing = pushed + h * (_STAGES[-1] @ elastic[:4]), self._closing
            force = elastic[4] + self._damping * np.sqrt(np.sqrt(self._depth)) * closing
            first = np.flatnonzero((self._depth > 0.0) & (approach == 0.0))
            if first.size:  # sped up evenly until then
                was, left, gained = np.maximum(before, 0.0)[first], np.maximum(gap, 0.0)[first], closing - before
                approach[first] = np.sqrt(was**2 + 2.0 * left * np.maximum(gained[first], 0.0) / h) + CLOSING
                closed[first] = t + np.minimum(2.0 * left / (was + approach[first]), h)
            t += h
            moments.append(t)
            moving = (self._depth > _TOUCH) | ((self._gap < _TOUCH) & (closing > CLOSING))
            if faint > 0.0:
                energy = 0.8 * self._stiffness / self._mass * self._depth**2.5  # stored: m^2/s^2
                moving &= np.maximum(closing, 0.0) ** 2 + energy > faint * faint
            ends = not moving.any()
        opened = (elastic > 0.0).any(axis=0)  # in the last step
        early = float((self._gap / np.maximum(-closing, CLOSING))[opened].min(initial=h)) if opened.any() else 0.0
        if early > 0.0:  # s; they flew freely since
            moments[-1] -= early
            state[_PLACE] -= early * state[_VELOCITY] - 0.5 * early**2 * self._push
            state[_VELOCITY] -= early * self._push
        impulse = pushed + self._held
        self._remove_excess_energy(states[0], state, impulse, t * fastest)
        motion = np.array(states)
        motion[:, _PLACE] += self._origin
        place, velocity, roll, out = motion.swapaxes(0, 1)
        parts = place.real, place.imag, velocity.real, velocity.imag, out.imag, roll.real, roll.imag
        times, motion = np.array(moments), np.stack(parts, axis=-1).reshape(len(moments), rows, count, -1)
        of_links = [its.reshape(rows, -1) for its in (impulse, approach, closed)]
        return [
            ClusterOutcome(times, motion[:, row, : len(one.bodies)], *(its[row, : len(one.links)] for its in of_links))
            for row, one in enumerate(self._clusters)
        ]

    def _rates(self, moving: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Find the ``rates`` of places and of velocities without what damping has taken; returns the elastic forces in
        N.

        It leaves of each link the gap and depth (m), the normal, the closing speed (m/s), and the impulse (N s) of
        damping since it closed.
        """
        place, velocity = moving
        apart = place.take(self._first) - place.take(self._second)
        distance = np.abs(apart)
        normal, curvature, gap = apart / distance, 1.0 / distance, distance - self._reach
        for link, wall, body in self._walls:
            there = complex(place[body] + self._origin[body])
            gap[link], nx, ny, curvature[link], *_ = wall(there.real, there.imag)
            normal[link] = complex(nx, ny)
        gap -= self._overlap
        depth = np.maximum(-gap, 0.0)
        root = np.sqrt(depth)
        held, elastic = self._taken * depth * np.sqrt(root), self._stiffness * depth * root
        velocity = velocity + self._pushing(held * normal)
        along = (velocity.take(self._first) - velocity.take(self._second)) * normal.conj()
        turned = (elastic - 1j * (held * curvature * along.imag)) * normal  # damping's impulse turns with the normal
        rates[0], rates[1] = velocity, self._pushing(turned) + self._push
        self._gap, self._depth, self._normal, self._closing, self._held = gap, depth, normal, -along.real, held
        return elastic

    def _pushing(self, impulses: np.ndarray) -> np.ndarray:
        """What they change of the bodies' velocities."""
        changes: np.ndarray = np.vecdot(self._pushed, impulses.reshape(len(self._clusters), 1, -1))
        return changes.ravel()

    def _remove_excess_energy(self, start: np.ndarray, end: np.ndarray, impulse: np.ndarray, way: float) -> None:
        """Slow the bodies that were touched towards the common motion of their cluster if numerical errors have raised
        its energy; other causes may have added what they do along the ``way`` in m."""
        rows = len(self._clusters)
        start, end = start.reshape(4, rows, -1), end.reshape(4, rows, -1)
        touched = (self._pushed.real * (impulse > 0.0).reshape(rows, 1, -1)).any(axis=2)
        weights = np.where(touched, self._weights.reshape(2, rows, -1), 0.0)
        mass, common = weights[0], np.zeros_like(end)
        if not self._walls:
            common[_VELOCITY] = (np.vecdot(mass, end[_VELOCITY]) / np.maximum(mass.sum(axis=1), 1e-300))[:, None]
        most = (
            _energy(weights, start)
            + np.vecdot(mass, np.abs(self._push).reshape(rows, -1)) * way
            - _energy(weights, common)
        )
        has = _energy(weights, end - common)
        share = np.where(has > most, np.sqrt(np.maximum(0.0, most / np.maximum(has, 1e-300))), 1.0)[:, None]
        end[1:] = np.where(touched & (share < 1.0), common + share * (end - common), end)[1:]


def _energy(weights: np.ndarray, motion: np.ndarray) -> np.ndarray:
    """Of the bodies of each cluster in J; the ``weights`` are their masses (kg) and inertias (kg m^2)."""
    (mass, inertia), (_, velocity, roll, out) = weights, motion
    moving, turning = np.abs(velocity) ** 2 + out.real**2, np.abs(roll) ** 2 + out.imag**2
    return 0.5 * (np.vecdot(mass, moving) + np.vecdot(inertia, turning))


T = TypeVar("T")

#: What computes something and asks meanwhile for clusters to be passed through: with these steps, until what is left is
#: slower than this (m/s).
Asking = Generator[tuple[Cluster, float, float], ClusterOutcome, T]


def pass_through(asked: Sequence[tuple[Cluster, float, float]]) -> list[ClusterOutcome | Exception]:
    """The outcomes of clusters, or what they raise; of several as one, if they are alike and none raises anything."""
    (one, *how), *others = asked
    if not others:
        try:
            with no_exit():
                return [one.pass_through(*how)]
        except Exception as error:  # also what a law of the scene raises
            return [error]
    clusters = [one, *(cluster for cluster, *_ in others)]
    if all(its == how for _, *its in others) and not any(cluster.is_apart for cluster in clusters):
        with suppress(Exception), no_exit():  # it is found below whose it is
            return [*_Passage(clusters).outcomes(*how)]
    return [found for each in asked for found in pass_through([each])]
