"""Impacts of several balls at once, simulated through the contact with its forces.

An impulse is right for an isolated pair. If two balls reach a third while they are in contact, the outcome depends on
how the contacts overlap in the fraction of a millisecond they last. So the contact is simulated: positions and
velocities under the normal forces (``cluster_forces.py``) by Kutta's method of order 4, and friction impulses at the
ends of its steps (``cluster_friction.py``, ``cluster_springs.py``).

All contacts are treated at once, as entries of arrays, so that the outcome does not depend on the order of the balls.
Vectors in the plane are complex numbers, x + iy. Products with matrices are by ``vecdot``: with ``@`` large ones are
shared by threads, a hundred times as slow where other programs keep the processors busy.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from math import hypot, inf

import numpy as np

from sandbox.engine.impact.cluster_forces import FORCE_ROWS, POSITION, VELOCITY, ClusterForces
from sandbox.engine.impact.cluster_friction import ClusterFriction
from sandbox.engine.impact.cluster_parts import ClusterBall, Link
from sandbox.engine.impact.cluster_springs import SpringFriction
from sandbox.engine.model.tolerances import CLOSING, NEGLIGIBLE_OVERLAP
from sandbox.errors import RunError
from sandbox.physics.hertz import contact_time, largest_overlap
from sandbox.physics.integrators import INTEGRATORS

_STAGES = [np.array(stage.weights) for stage in INTEGRATORS["rk4"].stages]

#: Largest error of a step, relative to the fastest speed; if it is larger, all is repeated with half the step. It is
#: estimated from the rates at the end, of the last stage and of the outcome: with those in its place the order is 3.
#: Steps are otherwise equal, so that the outcome depends smoothly on the input and rounding stays small.
_LARGEST_ERROR = 1e-3
_ERROR = np.array([0.0, 0.0, 0.0, 1.0, -1.0]) / 6.0

#: A lone pair, which has to have its restitution to 1e-6, takes half the usual steps, and shorter ones near the kinks
#: of its force: half the time since its closing or to its opening, down to a fraction.
_OF_A_PAIR, _FINEST = 0.5, 1 / 64

#: Most steps through a contact. Those of a break are about 50; 10,000 are a second of computing.
_MOST_STEPS = 10_000

#: Depth in radii of the smaller ball from which balls would pass through each other.
_TOO_DEEP = 1.0

#: Longest contact times, for each ball and in addition, after which balls that press on one another will not separate
#: by themselves; a chain of n equal balls takes 1 + (n - 1) / 2.
_PATIENCE = 1.0, 10.0

#: The slowest blow that they wait for, in m/s: a grazing ball leaves little. Where something else presses them together
#: it is the speed that this gives them in so many contact times.
_SLOWEST, _TIMES = 1e-3, 10.0

#: Where a link to a wall has its second ball: far (m) from all others.
_FAR = 1e3


class Unresolved(RunError):
    """A contact that does not end: something presses the balls together, or through each other."""


class TooDeep(Unresolved):
    """A ball has moved farther than it may."""


@dataclass(frozen=True)
class ClusterOutcome:
    """A cluster through the contact: ``motion`` at the ``times``, and an entry for each link."""

    times: np.ndarray  # s, from 0 to the end, shape (times,)
    motion: np.ndarray  # x, y, vx, vy and the spins about z, x, y, shape (times, balls, 7); m, m/s, rad/s
    impulse: np.ndarray  # N s, normal, shape (links,); 0 if the link never closed
    approach: np.ndarray  # m/s, when it first closed, shape (links,)
    closed: np.ndarray  # s, time when it first closed, shape (links,)
    energy: float  # J, kinetic, of the balls at the start
    gained: float  # J, by numerical errors; taken from the motion at the end

    @property
    def velocity(self) -> np.ndarray:
        """At the end, in m/s, shape (balls, 2)."""
        return self.motion[-1, :, 2:4]

    @property
    def spin(self) -> np.ndarray:
        """At the end, in rad/s about z, x and y, shape (balls, 3)."""
        return self.motion[-1, :, 4:]


@dataclass(frozen=True)
class Cluster:
    """Balls and the links between them, with stiffness along a contact over that across it; infinite for balls that
    give way across it only. The cost grows with all of them: leave out what cannot be reached."""

    balls: Sequence[ClusterBall]
    links: Sequence[Link]
    along: float = inf

    def pass_through(self, step: float, negligible: float = 0.0) -> ClusterOutcome:
        """Simulate the contact until nothing touches, or until all blows that are left are slower than ``negligible``
        (m/s), in steps of this fraction of the shortest possible contact.

        Raises Unresolved if it does not end, or after too many steps; TooDeep if a ball moves farther than it may.
        """
        while (outcome := _Passage(self, step, negligible).outcome()) is None:
            step *= 0.5
        return outcome


class _Passage:
    """A cluster on its way through the contact, in equal steps.

    A state has four rows of complex numbers, one for each ball: position (m), velocity (m/s), spin in the plane
    (rad/s), and motion out of it, ``vz + i wz``.
    """

    def __init__(self, cluster: Cluster, step: float, negligible: float) -> None:
        balls, links = cluster.balls, cluster.links
        self._negligible = negligible  # m/s
        self._relative_step = step
        self._forces = ClusterForces(balls, links)
        self._weights = np.array([(ball.mass, ball.inertia) for ball in balls]).T
        self._room = np.array([*(ball.room for ball in balls), np.inf])

        start = [
            (complex(*ball.position), complex(*ball.velocity), complex(*ball.spin[:2]), 1j * ball.spin[2])
            for ball in balls
        ]
        self._state = np.array([*start, (_FAR, 0.0, 0.0, 0.0)]).T  # the last one stands for walls
        self._origin = self._state[POSITION, 0]
        self._state[POSITION, :-1] -= self._origin
        self._forces.origin = self._origin
        self._started = self._state[POSITION].copy()

        self._fastest = max(2.0 * float(np.abs(self._state[VELOCITY]).max()), CLOSING)  # m/s
        self._fastest_surface = max(self._fastest, *(hypot(*ball.spin) * ball.radius for ball in balls))  # m/s
        lasts = partial(contact_time, self._forces.mass, self._forces.stiffness)
        pushed = np.abs(self._forces.acceleration).max()
        slowest = _SLOWEST + _TIMES * pushed * lasts(_SLOWEST).max()
        shortest, longest = lasts(self._fastest).min(), lasts(min(slowest, self._fastest)).max()
        self._latest = (_PATIENCE[0] * len(balls) + _PATIENCE[1]) * longest  # s, by which all must have separated
        self._longest_step = step * shortest  # s
        self._friction = ClusterFriction(self._forces, links)
        if cluster.along < inf:
            deepest = largest_overlap(self._forces.mass, self._forces.stiffness, self._fastest)
            self._friction = SpringFriction(self._forces, links, cluster.along, deepest)
        self._scale = np.repeat([self._fastest * shortest, self._fastest], len(balls) + 1)

        self._t = self._h = 0.0  # s
        self._times = [0.0]
        self._states: list[np.ndarray] = []
        self._rates = np.empty((5, FORCE_ROWS, len(balls) + 1), complex)  # of each stage, and of the outcome
        self._elastic = np.empty((5, len(links)))  # N, the same
        # Links that are closed at the start store no energy: their distance then is where their force begins.
        self._forces.begin(self._state)
        self._elastic[0] = self._forces.evaluate(self._state[:2], self._rates[0])
        self._force = self._elastic[0]  # N
        self._pushed = np.zeros(len(links))  # N s, of the elastic forces
        self._rubbed = np.zeros(len(links))  # N s, normal, for which friction has acted
        self._closing = self._forces.closing  # m/s
        self._normal = self._forces.normal
        self._approach = np.where(self._forces.gap < NEGLIGIBLE_OVERLAP, np.maximum(self._closing, 0.0), 0.0)  # m/s
        self._closed = np.zeros(len(links))  # s

    def outcome(self) -> ClusterOutcome | None:
        """Go through the contact to its end; None if a step has too large an error."""
        over = False
        while True:
            self._rub(over)
            self._states.append(self._state)
            if over:
                break
            self._refuse_endless()
            gap, closing = self._forces.gap, self._closing
            if not self._take_step():
                return None
            self._note_first_contacts(gap, closing)
            over = not self._touches()
        self._go_back_to_opening()
        impulse = self._pushed + self._forces.damped
        energy = _energy(self._weights, self._states[0][:, :-1])
        gained = self._remove_excess_energy(impulse)
        times, motion = np.array(self._times), np.array(self._states)[:, :, :-1]
        motion[:, POSITION] += self._origin
        place, velocity, roll, out = motion.swapaxes(0, 1)
        parts = place.real, place.imag, velocity.real, velocity.imag, out.imag, roll.real, roll.imag
        return ClusterOutcome(times, np.stack(parts, axis=-1), impulse, self._approach, self._closed, energy, gained)

    def _rub(self, over: bool) -> None:
        """Apply the friction of the previous and the next half step: second order, and mu times the impulse in
        total."""
        forces, back, self._h = self._forces, 0.5 * self._h, self._longest_step
        if len(self._pushed) == 1:
            kink = abs(float(forces.gap[0])) / max(abs(float(self._closing[0])), CLOSING)  # s, from here
            self._h *= _OF_A_PAIR * min(1.0, max(_FINEST, kink / self._h))
        ahead = 0.0 if over else 0.5 * self._h
        reached = np.maximum(self._pushed + forces.damped + ahead * self._force, self._rubbed)
        gain = forces.velocities(self._force * forces.normal) + forces.acceleration  # m/s^2
        self._state[1:] = self._friction.motion_after(
            self._state[1:],
            forces.normal,
            reached - self._rubbed,
            gain,
            (back, ahead),
            self._fastest_surface,
            self._relative_step,
        )
        self._rubbed = reached

    def _refuse_endless(self) -> None:
        """Raise Unresolved if this cannot end well, TooDeep if a ball has moved farther than it may."""
        forces, t = self._forces, self._t
        if t > self._latest or len(self._times) > _MOST_STEPS:
            raise Unresolved(f"balls do not separate within {t:.3g} s")
        if ((forces.depth > _TOO_DEEP * forces.smaller) | ((self._normal.conj() * forces.normal).real < 0.0)).any():
            raise Unresolved(f"balls pass through each other after {t:.3g} s")
        if (np.abs(self._state[POSITION] - self._started) > self._room).any():
            raise TooDeep(f"a ball has left its place after {t:.3g} s")
        self._normal = forces.normal

    def _take_step(self) -> bool:
        """Move by one step of Kutta's method. Returns False, and leaves the state, if its error is too large."""
        forces, rates, elastic, h = self._forces, self._rates, self._elastic, self._h
        start, flat = self._state[:2].copy(), self._rates.reshape(5, -1)
        start[1] -= forces.velocities(forces.damped * forces.normal)
        elastic[0] = forces.evaluate(start, rates[0])
        for stage, weights in enumerate(_STAGES, 1):
            moved = start + (h * weights @ flat[:stage]).reshape(2, -1)
            elastic[stage] = forces.evaluate(moved, rates[stage])
        if np.abs(_ERROR @ flat / self._scale).max() * h > _LARGEST_ERROR:
            return False
        self._state = self._state.copy()
        self._state[:2] = moved[0], rates[4, 0]
        self._pushed = self._pushed + h * (_STAGES[-1] @ elastic[:4])
        self._closing = forces.closing
        self._force = elastic[4] + forces.damping_force()
        return True

    def _note_first_contacts(self, gap: np.ndarray, closing: np.ndarray) -> None:
        """Note when links that were open, at this ``gap`` (m) and ``closing`` speed (m/s) before the step, first
        closed, and how fast: they sped up evenly until then. The step ends here."""
        first = np.flatnonzero((self._forces.depth > 0.0) & (self._approach == 0.0))
        if first.size:
            was, left = np.maximum(closing, 0.0)[first], np.maximum(gap, 0.0)[first]
            gained = np.maximum((self._closing - closing)[first], 0.0)
            self._approach[first] = np.sqrt(was**2 + 2.0 * left * gained / self._h) + CLOSING
            self._closed[first] = self._t + np.minimum(2.0 * left / (was + self._approach[first]), self._h)
        self._t += self._h
        self._times.append(self._t)

    def _touches(self) -> bool:
        """True while links are closed, or close, with more than negligible energy."""
        forces, closing = self._forces, self._closing
        moving = (forces.depth > NEGLIGIBLE_OVERLAP) | ((forces.gap < NEGLIGIBLE_OVERLAP) & (closing > CLOSING))
        if self._negligible > 0.0:
            moving &= np.maximum(closing, 0.0) ** 2 + forces.squared_rebound() > self._negligible**2
        return bool(moving.any())

    def _go_back_to_opening(self) -> None:
        """End where the last link opened, within the last step: the balls flew freely since."""
        opened = (self._elastic > 0.0).any(axis=0)
        since = (self._forces.gap / np.maximum(-self._closing, CLOSING))[opened]
        early = float(since.min(initial=self._h)) if opened.any() else 0.0  # s
        if early > 0.0:
            self._times[-1] -= early
            acceleration = self._forces.acceleration
            self._state[POSITION] -= early * self._state[VELOCITY] - 0.5 * early**2 * acceleration
            self._state[VELOCITY] -= early * acceleration

    def _remove_excess_energy(self, impulse: np.ndarray) -> float:
        """Slow the balls that were touched towards their common motion if numerical errors have raised their energy;
        other causes may have added what they do along the distance moved. Returns the energy in J that was too much."""
        start, end, forces = self._states[0], self._state, self._forces
        touched = np.flatnonzero(forces.pull[:-1, impulse > 0.0].any(axis=1))
        if not touched.size:
            return 0.0
        weights = self._weights[:, touched]
        common = np.zeros((4, 1), complex)
        if not forces.has_walls:
            common[VELOCITY] = weights[0] @ end[VELOCITY, touched] / weights[0].sum()
        apart = end[:, touched] - common
        worked = float(weights[0] @ np.abs(forces.acceleration[touched])) * self._t * self._fastest  # J
        most = _energy(weights, start[:, touched]) + worked - _energy(weights, np.repeat(common, touched.size, axis=1))
        has = _energy(weights, apart)
        if has > most:
            end[1:, touched] = (common + np.sqrt(max(0.0, most / has)) * apart)[1:]
        return max(0.0, has - most)


def _energy(weights: np.ndarray, state: np.ndarray) -> float:
    """The kinetic energy of balls in J; the ``weights`` are their masses (kg) and inertias (kg m^2)."""
    (mass, inertia), (_, velocity, roll, out) = weights, state
    moving, turning = np.abs(velocity) ** 2 + out.real**2, np.abs(roll) ** 2 + out.imag**2
    return 0.5 * float(mass @ moving + inertia @ turning)
