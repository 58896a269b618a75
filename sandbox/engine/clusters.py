"""Impacts of several bodies at once, simulated through the contact with its forces.

An impulse is right for an isolated pair. If two bodies reach a third while they are in contact, the outcome depends on
how the contacts overlap in the fraction of a millisecond they last. So the contact is simulated: positions and
velocities under the forces of Hertz's law (``physics/hertz.py``) by Kutta's method of order 4, and friction impulses
at the ends of its steps (``rubbing.py``).

The force of damping, ``c d^(1/4) dd/dt``, is the rate of ``c 4/5 d^(5/4)``, which is how much of the momentum it has
taken in all. So the velocities without that part are integrated: their forces have no steep start, and equal steps are
accurate though contacts close and open within them.

All contacts are treated at once, as entries of arrays, so that the outcome does not depend on the order of the bodies.
Vectors in the plane are complex numbers, x + iy. Products with matrices are by ``vecdot``: with ``@`` large ones are
shared by threads, a hundred times as slow where other programs keep the processors busy.
"""

from __future__ import annotations

from collections.abc import Callable, Generator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from math import hypot
from typing import Any, NamedTuple, TypeVar

import numpy as np

from sandbox.engine.rubbing import Rubbing
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
    friction: Callable[[float], float]  # of the slip in m/s
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

    def part(self, bodies: slice, links: slice) -> ClusterOutcome:
        """That of some of the bodies and links."""
        each = self.impulse[links], self.approach[links], self.closed[links]
        return ClusterOutcome(self.times, self.motion[:, bodies], *each)

    @property
    def velocity(self) -> np.ndarray:
        """At the end, in m/s, shape (bodies, 2)."""
        return self.motion[-1, :, 2:4]

    @property
    def spin(self) -> np.ndarray:
        """At the end, in rad/s about z, x and y, shape (bodies, 3)."""
        return self.motion[-1, :, 4:]


class Cluster:
    """Bodies and the links between them. The cost grows with all of them: leave out what cannot be reached."""

    def __init__(self, bodies: Sequence[Body], links: Sequence[Link], groups: Sequence[int] = ()) -> None:
        """``groups`` has a number, from 0 on, for each link: those of one group share bodies with no other."""
        count, every = len(bodies), range(len(links))
        self.bodies, self.links = bodies, links
        self._groups = np.array(groups or [0] * len(links))
        first = self._first = np.array([link.first for link in links])
        second = self._second = np.array([count if link.second is None else link.second for link in links])
        self._weights = np.array([(body.mass, body.inertia) for body in bodies]).T
        light, easy = np.column_stack((1.0 / self._weights, (0.0, 0.0)))  # the last body is what walls belong to
        radius = np.array([*(body.radius for body in bodies), np.inf])
        self._room = np.array([*(body.room for body in bodies), np.inf])
        self._push = np.array([*(complex(*body.push) for body in bodies), 0.0])
        self._mass = 1.0 / (light[first] + light[second])  # kg, reduced
        self._stiffness = np.array([link.stiffness for link in links])
        self._damping = np.array([damping(link.restitution) for link in links]) * np.sqrt(self._mass * self._stiffness)
        self._taken = 0.8 * self._damping
        self._pushed = np.zeros((count + 1, len(links)), complex)  # 1/kg: by an impulse at each link
        self._pushed[first, every], self._pushed[second, every] = light[first], -light[second]
        self._deepest = _TOO_DEEP * np.minimum(radius[first], radius[second])
        radius[count] = 0.0
        self._reach = radius[first] + radius[second]
        self._rubbing = Rubbing(first, second, radius, light, easy, [link.friction for link in links], self._groups)
        self._walls = [(place, link.wall, link.first) for place, link in enumerate(links) if link.wall is not None]

    @property
    def is_apart(self) -> bool:
        """Whether it takes steps of its own, or has walls."""
        return len(self.links) == 1 or bool(self._walls)

    def pass_through(self, share: float, faint: float = 0.0) -> ClusterOutcome:
        """Simulate the contact until nothing touches, in steps of this fraction of the shortest possible contact, or
        until what is left is slower than ``faint`` (m/s).

        Raises Unresolved if it does not end, or after too many steps; Entered if a body moves farther than it may.
        """
        while (passage := self._stepped_through(share, faint)) is None:
            share *= 0.5
        return passage

    def _stepped_through(self, share: float, faint: float) -> ClusterOutcome | None:
        """The same with steps that are not repeated; None if one has too large an error."""
        count, links = len(self.bodies), len(self.links)
        rows = [
            (complex(*body.position), complex(*body.velocity), complex(*body.spin[:2]), 1j * body.spin[2])
            for body in self.bodies
        ]
        state = np.array([*rows, (0.0, 0.0, 0.0, 0.0)]).T
        self._origin = state[_PLACE, 0]
        state[_PLACE] -= self._origin
        state[_PLACE, count] = 1e3  # m: a placeholder for walls, never read
        fastest = max(2.0 * float(np.abs(state[_VELOCITY]).max()), CLOSING)
        quickest = max(fastest, *(hypot(*body.spin) * body.radius for body in self.bodies))
        at = partial(contact_time, self._mass, self._stiffness)
        slowest = _SLOWEST + _TIMES * np.abs(self._push).max() * at(_SLOWEST).max()
        shortest, longest = at(fastest).min(), at(min(slowest, fastest)).max()
        started = state[_PLACE].copy()
        scale = np.repeat([fastest * shortest, fastest], count + 1)
        whole, h, t = share * shortest, 0.0, 0.0
        rates, elastic = np.empty((5, 2, count + 1), complex), np.empty((5, links))
        flat = rates.reshape(5, -1)
        # Links that are closed at the start store no energy: their distance then is where their force begins.
        self._overlap = np.zeros(links)
        self._rates(state[:2], rates[0])
        self._overlap = np.minimum(self._gap, 0.0)
        elastic[0] = self._rates(state[:2], rates[0])
        pushed, rubbed, closed = (np.zeros(links) for _ in range(3))  # N s: elastic, and what has had its friction
        force, closing, normal = elastic[0], self._closing, self._normal
        approach = np.where(self._gap < _TOUCH, np.maximum(closing, 0.0), 0.0)
        moments, states, ends = [0.0], list[np.ndarray](), False
        while True:
            # Friction of the previous and next half step: second order, and mu times the impulse in total.
            back, h = 0.5 * h, whole
            if links == 1:
                kink = abs(float(self._gap[0])) / max(abs(float(closing[0])), CLOSING)  # s, from here
                h *= _OF_A_PAIR * min(1.0, max(_FINEST, kink / h))
            ahead = 0.0 if ends else 0.5 * h
            reached = np.maximum(pushed + self._held + ahead * force, rubbed)
            gain = np.vecdot(self._pushed, force * self._normal) + self._push  # m/s^2
            state[1:] = self._rubbing.after(state[1:], self._normal, reached - rubbed, gain, back, ahead, quickest)
            states.append(state)
            if ends:
                break
            if t > (_PATIENCE[0] * count + _PATIENCE[1]) * longest or len(moments) > _MOST_STEPS:
                raise Unresolved(f"bodies do not separate within {t:.3g} s")
            if ((self._depth > self._deepest) | ((normal.conj() * self._normal).real < 0.0)).any():
                raise Unresolved(f"bodies pass through each other after {t:.3g} s")
            if (np.abs(state[_PLACE] - started) > self._room).any():
                raise Entered(f"a body has left its place after {t:.3g} s")
            rubbed, before, gap, normal = reached, closing, self._gap, self._normal
            start = state[:2].copy()
            start[1] -= np.vecdot(self._pushed, self._held * self._normal)
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
        motion = np.array(states)[:, :, :count]
        motion[:, _PLACE] += self._origin
        place, velocity, roll, out = motion.swapaxes(0, 1)
        parts = place.real, place.imag, velocity.real, velocity.imag, out.imag, roll.real, roll.imag
        return ClusterOutcome(np.array(moments), np.stack(parts, axis=-1), impulse, approach, closed)

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
            there = place[body] + self._origin
            gap[link], nx, ny, curvature[link], *_ = wall(there.real, there.imag)
            normal[link] = complex(nx, ny)
        gap -= self._overlap
        depth = np.maximum(-gap, 0.0)
        root = np.sqrt(depth)
        held, elastic = self._taken * depth * np.sqrt(root), self._stiffness * depth * root
        velocity = velocity + np.vecdot(self._pushed, held * normal)
        along = (velocity.take(self._first) - velocity.take(self._second)) * normal.conj()
        turned = (elastic - 1j * (held * curvature * along.imag)) * normal  # damping's impulse turns with the normal
        rates[0], rates[1] = velocity, np.vecdot(self._pushed, turned) + self._push
        self._gap, self._depth, self._normal, self._closing, self._held = gap, depth, normal, -along.real, held
        return elastic

    def _remove_excess_energy(self, start: np.ndarray, end: np.ndarray, impulse: np.ndarray, way: float) -> None:
        """Slow the bodies that were touched towards the common motion of their group if numerical errors have raised
        its energy; other causes may have added what they do along the ``way`` in m."""
        for group in range(self._groups.max() + 1):
            acted = (impulse > 0.0) & (self._groups == group)
            touched = np.flatnonzero(self._pushed[:-1, acted].any(axis=1))
            mass, _ = weights = self._weights[:, touched]
            common = np.zeros((4, touched.size), complex)
            if touched.size and not self._walls:
                common[_VELOCITY] = mass @ end[_VELOCITY, touched] / mass.sum()
            apart, worked = end[:, touched] - common, float(np.abs(self._push[touched]) @ mass) * way
            most = _energy(weights, start[:, touched]) + worked - _energy(weights, common)
            has = _energy(weights, apart)
            if has > most:
                end[1:, touched] = (common + np.sqrt(max(0.0, most / has)) * apart)[1:]


def _energy(weights: np.ndarray, motion: np.ndarray) -> float:
    """Of bodies in J; the ``weights`` are their masses (kg) and inertias (kg m^2), shape (2, bodies)."""
    (mass, inertia), (_, velocity, roll, out) = weights, motion
    moving, turning = np.abs(velocity) ** 2 + out.real**2, np.abs(roll) ** 2 + out.imag**2
    return 0.5 * float(mass @ moving + inertia @ turning)


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
            return _pass_together(clusters, *how)
    return [found for each in asked for found in pass_through([each])]


def _pass_together(clusters: Sequence[Cluster], share: float, faint: float) -> list[ClusterOutcome | Exception]:
    """The outcomes of several clusters that are passed through as one, with steps in common."""
    bodies, links, groups, parts = list[Body](), list[Link](), list[int](), list[tuple[slice, slice]]()
    for group, cluster in enumerate(clusters):
        moved = [
            link._replace(first=len(bodies) + link.first, second=len(bodies) + link.second)
            for link in cluster.links
            if link.second is not None
        ]
        before = len(bodies), len(links)
        bodies, links, groups = [*bodies, *cluster.bodies], [*links, *moved], groups + [group] * len(moved)
        parts.append((slice(before[0], len(bodies)), slice(before[1], len(links))))
    outcome = Cluster(bodies, links, groups).pass_through(share, faint)
    return [outcome.part(*part) for part in parts]
