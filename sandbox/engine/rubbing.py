"""Friction between bodies that are pressed together: impulses limited by the normal impulses (Coulomb).

Over an interval in which normal impulses and slips change evenly, a link that can hold ends without slip, and one that
cannot slides against its slip in the middle: both are second order. Where a slip reverses or is held too early, the
interval is halved, so that the kink is first order only over what is left. All links are treated at once, so that the
outcome does not depend on their order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from math import log2
from typing import Any

import numpy as np

from sandbox.engine.setup import Bounce

#: Most iterations, and the change of a slip relative to the fastest speed at which they stop; after some iterations it
#: is clear whether the interval has a kink.
_ITERATIONS, _CONVERGED, _CLEAR = 50, 5e-5, 3

#: Links up to which their laws are asked one by one, which is quicker; and the difference in a coefficient of friction
#: that is rounding: a law that takes arrays may mean something else by them.
_FEW, _SAME = 16, 1e-9

#: How often an interval is halved around a kink; and the step, as a fraction of the shortest contact, from which on
#: both errors grow as that of the step, with its square.
_HALVINGS, _FINE = 3, 0.07

#: Length of an iteration's step over the inverse row sum; from 2 on it may diverge.
_SHARE = 1.5

#: The bounce at a speed of approach and one of slip, in m/s; arrays of them where it can take arrays.
Law = Callable[[Any, Any], Bounce]


class Rubbing:
    """Friction in the links of clusters, one after another in arrays: a kink in one does not shorten the intervals of
    the others.

    A motion has three rows of complex numbers, one for each body: ``vx + i vy``, ``wx + i wy`` and ``vz + i wz`` (m/s
    and rad/s). Slips and impulses are complex, too: along the contact in the plane, and out of it.
    """

    def __init__(
        self,
        clusters: int,
        first: np.ndarray,
        second: np.ndarray,
        radius: np.ndarray,
        light: np.ndarray,
        easy: np.ndarray,
        laws: Sequence[tuple[Law, float]],
    ) -> None:
        """``first`` and ``second`` are the bodies of each link; ``light`` and ``easy`` are the inverse masses (1/kg)
        and inertias (1/(kg m^2)) of bodies; ``laws`` has that of each link, and the approach in m/s at which it is
        asked. All ``clusters`` have as many bodies, and as many links."""
        bodies, every = len(radius) // clusters, np.arange(len(first))
        self._links, self._arms = (first, second), (radius.take(first), radius.take(second))
        signs, arms = np.zeros((2, len(first), bodies))
        signs[every, first % bodies], signs[every, second % bodies] = 1.0, -1.0
        arms[every, first % bodies], arms[every, second % bodies] = self._arms
        signs, arms = signs.reshape(clusters, -1, bodies), arms.reshape(clusters, -1, bodies)
        pulls, turns = signs * light.reshape(clusters, 1, -1), arms * easy.reshape(clusters, 1, -1)
        self.pull, self._turn = (each.transpose(0, 2, 1).astype(complex, order="C") for each in (pulls, turns))
        # 1/kg: links that share a body
        self._shifts, self._twists = pulls @ signs.transpose(0, 2, 1), turns @ arms.transpose(0, 2, 1)
        self._used = np.zeros(len(first), complex)  # of the normal impulses, in the last interval: a first guess
        self._approach = np.array([approach for _, approach in laws])
        self._laws: list[Law] = []
        self._only_floats: set[int] = set()  # numbers of laws that take no arrays
        self._law_of = np.array([self._number(law) for law, _ in laws])

    def _number(self, law: Law) -> int:
        """The number of a law among those of all links."""
        with suppress(Exception):  # it is new, or a class of the scene raises when it is compared
            return self._laws.index(law)
        self._laws.append(law)
        return len(self._laws) - 1

    def after(
        self,
        motion: np.ndarray,
        normal: np.ndarray,
        pressed: np.ndarray,
        gain: np.ndarray,
        back: float,
        ahead: float,
        fastest: float,
        share: float,
    ) -> np.ndarray:
        """The motion after the friction of the time from ``back`` s before now to ``ahead`` s after.

        ``pressed`` are the normal impulses (N s) of that time, ``gain`` the accelerations (m/s^2) by normal forces;
        ``share`` is the step as a fraction of the shortest contact.
        """
        rows, links = len(self._shifts), self._shifts.shape[1]
        some = np.flatnonzero((pressed.reshape(rows, links) > 0.0).any(axis=0))  # of each cluster
        if not some.size:
            return motion
        acting = (links * np.arange(rows)[:, None] + some).ravel()
        first, second = (bodies.take(acting) for bodies in self._links)
        arm, other_arm = (arms.take(acting) for arms in self._arms)
        normal, pressed = normal.take(acting), pressed.take(acting)
        one, other = motion.take(first, 1), motion.take(second, 1)
        velocity, _, out = one - other
        _, roll, spin = one * arm + other * other_arm
        across = normal.conj()
        slip = spin.imag - (velocity * across).imag + 1j * (out.real + (roll * across).imag)
        laws, approach = self._law_of.take(acting), self._approach.take(acting)
        if not self._friction(laws, approach, slip).any():
            return motion
        drift = -((gain.take(first) - gain.take(second)) * across).imag  # m/s^2
        turned = (normal.reshape(rows, -1, 1) * across.reshape(rows, 1, -1)).real
        shifts, twists = (mobility.take(some, 1).take(some, 2) for mobility in (self._shifts, self._twists))
        mobility = np.zeros((rows, 2 * some.size, 2 * some.size))  # 1/kg: of the parts along, and out of the plane
        mobility[:, ::2, ::2], mobility[:, 1::2, 1::2] = shifts * turned + twists, shifts + twists * turned
        coarse = max(1.0, share / _FINE)
        total, used = np.zeros_like(slip), self._used.take(acting)
        places = np.arange(acting.size).reshape(rows, -1)
        waiting: list[tuple[float, float, int, Any]] = [(-back, ahead, round(_HALVINGS - log2(coarse)), slice(None))]
        while waiting:
            begun, ended, halvings, chosen = waiting.pop()
            own, at = mobility[chosen], places[chosen].ravel()
            part = (ended - begun) / (ahead + back) * pressed[at]
            before, after = slip[at] + begun * drift[at], slip[at] + ended * drift[at]
            guess, close = used[at] * part, _CONVERGED * coarse * coarse * fastest
            law = partial(self._friction, laws[at], approach[at])
            impulse, kinked = _slid(before, after, own, part, law, guess, close, halvings)
            if not kinked.all():
                of_no_use = np.repeat(kinked, some.size)
                impulse[of_no_use] = 0.0
                total[at] += impulse
                slip[at] += _times(own, impulse)
                used[at] = np.where(of_no_use, used[at], impulse / np.maximum(part, 1e-300))
            if kinked.any():
                middle, again = 0.5 * (begun + ended), np.arange(rows)[chosen][kinked]
                waiting += [(middle, ended, halvings - 1, again), (begun, middle, halvings - 1, again)]
        self._used[acting] = used
        pull, turn = self.pull.take(some, 2), self._turn.take(some, 2)
        along, upward, shape = total.real, total.imag, (rows, 1, -1)
        change = (
            np.vecdot(pull, (-1j * along * normal).reshape(shape)),
            np.vecdot(turn, (1j * upward * normal).reshape(shape)),
            np.vecdot(pull, upward.reshape(shape)) + 1j * np.vecdot(turn, along.reshape(shape)),
        )
        return np.add(motion, np.reshape(change, motion.shape))

    def _friction(self, laws: np.ndarray, approach: np.ndarray, slip: np.ndarray) -> np.ndarray:
        """The coefficient of friction of each link at its slip; ``laws`` are the numbers of their laws."""
        speed = np.abs(slip)
        if speed.size <= _FEW:
            each = zip(laws.tolist(), approach.tolist(), speed.tolist(), strict=True)
            return np.array([self._laws[number](*speeds).friction for number, *speeds in each])
        found = np.empty_like(speed)
        for number, law in enumerate(self._laws):
            its = laws == number if len(self._laws) > 1 else ...
            speeds = approach[its], speed[its]
            if number not in self._only_floats:
                with suppress(Exception):  # what cannot be asked of many
                    found[its] = law(*speeds).friction
                    some = [speeds[1].argmin(), speeds[1].argmax()]
                    alone = _one_by_one(law, *(each[some] for each in speeds))
                    if np.abs(found[its][some] - alone).max() <= _SAME:
                        continue
                self._only_floats.add(number)
            found[its] = _one_by_one(law, *speeds)
        return found


def _one_by_one(law: Law, approach: np.ndarray, slip: np.ndarray) -> np.ndarray:
    """The coefficients of friction by a law that is asked for each link."""
    return np.array([law(*speeds).friction for speeds in zip(approach.tolist(), slip.tolist(), strict=True)])


def _slid(
    before: np.ndarray,
    end: np.ndarray,
    mobility: np.ndarray,
    pressed: np.ndarray,
    friction: Callable[[np.ndarray], np.ndarray],
    impulse: np.ndarray,
    tolerance: float,
    halvings: int,
) -> tuple[np.ndarray, np.ndarray]:
    """Friction impulses (N s) in an interval in which the slips (m/s) would otherwise go from ``before`` to ``end``,
    and in which clusters there is a kink, if it can be halved: theirs are of no use.

    By projected gradient steps from a guess; their lengths are a share of what the row sums of the matrices
    ``mobility`` (1/kg) of the clusters allow.
    """
    sums = np.abs(mobility).sum(axis=2).ravel()
    ease = np.maximum(sums[::2], sums[1::2])
    step, kinked = _SHARE / ease, np.zeros(len(mobility), bool)
    end = end + _times(mobility, impulse)
    for iteration in range(_ITERATIONS):
        middle = 0.5 * (before + end)
        if iteration < 2:  # from then on the speeds change too little to matter
            limit = pressed * friction(middle)
        holds, slides = impulse - end * step, impulse - middle * step
        held = np.abs(holds) <= limit
        wanted = slides * (limit / np.maximum(np.abs(slides), 1e-300))
        np.copyto(wanted, holds, where=held)
        change, impulse = wanted - impulse, wanted
        end += _times(mobility, change)
        done = np.maximum.reduce(np.abs(change) * ease) <= tolerance
        if done or iteration == _CLEAR:
            own = mobility.diagonal(axis1=1, axis2=2).ravel()
            least = (end - before).real / own[::2] + 1j * ((end - before).imag / own[1::2])
            keeps = np.abs(least - impulse) <= limit
            turns = (before * end.conj()).real < 0.5 * np.abs(before) * np.abs(end)
            if halvings > 0:
                kinked = (np.where(held, ~keeps, turns) & (pressed > 0.0)).reshape(len(mobility), -1).any(axis=1)
            if done or kinked.all():
                break
    return impulse, kinked


def _times(mobility: np.ndarray, impulse: np.ndarray) -> np.ndarray:
    """The slips (m/s) that impulses (N s) change."""
    slips: np.ndarray = np.vecdot(mobility, impulse.view(float).reshape(len(mobility), 1, -1))
    return slips.ravel().view(complex)
