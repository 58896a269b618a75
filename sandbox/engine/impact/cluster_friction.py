"""Friction in a cluster: impulses limited by the normal impulses (Coulomb).

Over an interval in which normal impulses and slips change evenly, a link that can hold ends without slip, and one that
cannot slides against its slip in the middle: both are second order. Where a slip reverses or is held too early, the
interval is halved, so that the kink is first order only over what is left. All links are treated at once, so that the
outcome does not depend on their order.

Slips and impulses are complex: along the contact in the plane, and out of it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import log2

import numpy as np

from sandbox.engine.impact.cluster_forces import ClusterForces
from sandbox.engine.impact.cluster_parts import Link
from sandbox.engine.model.tolerances import TINY

#: Most iterations, and the change of a slip relative to the fastest speed at which they stop; after some iterations it
#: is clear whether the interval has a kink.
_ITERATIONS, _CONVERGED, _CLEAR = 50, 5e-5, 3

#: Iterations in which the coefficient of friction follows the slip: later the slip changes too little to matter.
_FOLLOWED = 2

#: Most halvings of an interval around a kink; and the step, as a fraction of the shortest contact, from which on
#: both errors grow as that of the step, with its square.
_HALVINGS, _FINE = 3, 0.07

#: Length of an iteration's step over the inverse row sum; from 2 on it may diverge.
_STEP_OVER_ROW_SUM = 1.5

#: The coefficient of friction of each link, at slips in m/s.
Coefficients = Callable[[np.ndarray], np.ndarray]


class ClusterFriction:
    """Friction in the links of a cluster.

    A motion has three rows of complex numbers, one for each ball: ``vx + i vy``, ``wx + i wy`` and ``vz + i wz`` (m/s
    and rad/s).
    """

    def __init__(self, forces: ClusterForces, links: Sequence[Link]) -> None:
        self._first, self._second = first, second = forces.first, forces.second
        self._laws = [(link.law, link.approach) for link in links]
        self._arms = forces.radius[first], forces.radius[second]  # m
        every = np.arange(len(links))
        signs, arms = np.zeros((2, len(links), len(forces.radius)))
        signs[every, first], signs[every, second] = 1.0, -1.0
        arms[every, first], arms[every, second] = self._arms
        pull, turn = signs * forces.inverse_mass, arms * forces.inverse_inertia
        self._pull, self._turn = pull.T.astype(complex, order="C"), turn.T.astype(complex, order="C")
        self._shifts, self._twists = pull @ signs.T, turn @ arms.T  # 1/kg: links that share a ball
        self._used = np.zeros(len(links), complex)  # of the normal impulses, in the last interval: a first guess

    def motion_after(
        self,
        motion: np.ndarray,
        normal: np.ndarray,
        pressed: np.ndarray,
        gain: np.ndarray,
        span: tuple[float, float],
        fastest: float,
        relative_step: float,
    ) -> np.ndarray:
        """The motion after the friction of a ``span`` of time: so many s before now, to so many after.

        ``pressed`` are the normal impulses (N s) of that time, ``gain`` the accelerations (m/s^2) by normal forces,
        ``fastest`` is the fastest speed of a surface (m/s), and ``relative_step`` the step as a fraction of the
        shortest contact.
        """
        acting = np.flatnonzero(pressed > 0.0)
        if not acting.size:
            return motion
        normal, pressed = normal.take(acting), pressed.take(acting)
        slip = self._slips(motion, acting, normal)
        coefficients = self._coefficients(acting)
        if not coefficients(slip).any():
            return motion
        mobility = self._mobility(acting, normal)
        apart = gain.take(self._first.take(acting)) - gain.take(self._second.take(acting))
        drift = -(apart * normal.conj()).imag  # m/s^2
        coarse = max(1.0, relative_step / _FINE)
        tolerance = _CONVERGED * coarse * coarse * fastest  # m/s
        total, used = np.zeros_like(slip), self._used.take(acting)
        back, ahead = span
        waiting = [(-back, ahead, round(_HALVINGS - log2(coarse)))]
        while waiting:
            begun, ended, halvings = waiting.pop()
            part = (ended - begun) / (ahead + back) * pressed
            before, after = slip + begun * drift, slip + ended * drift
            impulse = _impulses(before, after, mobility, part, coefficients, used * part, tolerance, halvings)
            if impulse is None:
                middle = 0.5 * (begun + ended)
                waiting += [(middle, ended, halvings - 1), (begun, middle, halvings - 1)]
            else:
                total += impulse
                slip = slip + _slips_by(mobility, impulse)
                used = impulse / np.maximum(part, TINY)
        self._used[acting] = used
        return motion + self._changes(acting, normal, total)

    def _coefficients(self, acting: np.ndarray) -> Coefficients:
        """The laws of friction of the links that are ``acting``."""
        laws = [self._laws[link] for link in acting.tolist()]

        def coefficients(slip: np.ndarray) -> np.ndarray:
            return np.array([law(a, s).friction for (law, a), s in zip(laws, np.abs(slip).tolist(), strict=True)])

        return coefficients

    def _slips(self, motion: np.ndarray, acting: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """The slips in m/s of the links that are ``acting``."""
        arm, other_arm = (arms.take(acting) for arms in self._arms)
        one, other = motion.take(self._first.take(acting), 1), motion.take(self._second.take(acting), 1)
        velocity, _, out = one - other
        _, roll, spin = one * arm + other * other_arm
        across = normal.conj()
        slips: np.ndarray = spin.imag - (velocity * across).imag + 1j * (out.real + (roll * across).imag)
        return slips

    def _mobility(self, acting: np.ndarray, normal: np.ndarray) -> np.ndarray:
        """The matrix (1/kg) of slips that impulses at these links cause: real parts and imaginary parts in turn."""
        turned = (normal[:, None] * normal.conj()).real
        shifts, twists = (each.take(acting, 0).take(acting, 1) for each in (self._shifts, self._twists))
        mobility = np.zeros((2 * acting.size, 2 * acting.size))
        mobility[::2, ::2], mobility[1::2, 1::2] = shifts * turned + twists, shifts + twists * turned
        return mobility

    def _changes(self, acting: np.ndarray, normal: np.ndarray, impulse: np.ndarray) -> np.ndarray:
        """Changes of the motion by friction impulses (N s) at these links."""
        pull, turn = self._pull.take(acting, 1), self._turn.take(acting, 1)
        along, upward = impulse.real, impulse.imag
        change = (
            np.vecdot(pull, -1j * along * normal),
            np.vecdot(turn, 1j * upward * normal),
            np.vecdot(pull, upward) + 1j * np.vecdot(turn, along),
        )
        return np.array(change)


def _impulses(
    before: np.ndarray,
    end: np.ndarray,
    mobility: np.ndarray,
    pressed: np.ndarray,
    coefficients: Coefficients,
    impulse: np.ndarray,
    tolerance: float,
    halvings: int,
) -> np.ndarray | None:
    """Friction impulses (N s) in an interval in which the slips (m/s) would otherwise go from ``before`` to ``end``;
    None if there is a kink in it, and so many ``halvings`` are left.

    By projected gradient steps from a guess; their lengths are a fraction of what the row sums of the matrix
    ``mobility`` (1/kg) allow. They end when slips change by less than ``tolerance`` (m/s).
    """
    sums = np.abs(mobility).sum(axis=1)
    ease = np.maximum(sums[::2], sums[1::2])
    step = _STEP_OVER_ROW_SUM / ease
    end = end + _slips_by(mobility, impulse)
    for iteration in range(_ITERATIONS):
        middle = 0.5 * (before + end)
        if iteration < _FOLLOWED:
            limit = pressed * coefficients(middle)
        holds, slides = impulse - end * step, impulse - middle * step
        held = np.abs(holds) <= limit
        wanted = slides * (limit / np.maximum(np.abs(slides), TINY))
        np.copyto(wanted, holds, where=held)
        change, impulse = wanted - impulse, wanted
        end += _slips_by(mobility, change)
        done = np.maximum.reduce(np.abs(change) * ease) <= tolerance
        if halvings > 0 and (done or iteration == _CLEAR) and _has_kink(before, end, mobility, impulse, limit, held):
            return None
        if done:
            break
    return impulse


def _has_kink(
    before: np.ndarray, end: np.ndarray, mobility: np.ndarray, impulse: np.ndarray, limit: np.ndarray, held: np.ndarray
) -> bool:
    """True if a link is held that would slide by itself, or slides while its slip (m/s) turns by more than 60 deg."""
    own = mobility.diagonal()
    least = (end - before).real / own[::2] + 1j * ((end - before).imag / own[1::2])  # N s, by this link alone
    keeps = np.abs(least - impulse) <= limit
    turns = (before * end.conj()).real < 0.5 * np.abs(before) * np.abs(end)
    return bool(np.where(held, ~keeps, turns).any())


def _slips_by(mobility: np.ndarray, impulse: np.ndarray) -> np.ndarray:
    """The slips (m/s) that impulses (N s) cause."""
    slips: np.ndarray = np.vecdot(mobility, impulse.view(float)).view(complex)
    return slips
