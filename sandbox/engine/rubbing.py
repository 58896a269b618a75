"""Friction between bodies that are pressed together: impulses limited by the normal impulses (Coulomb).

Over an interval in which normal impulses and slips change evenly, a link that can hold ends without slip, and one that
cannot slides against its slip in the middle: both are second order. Where a slip reverses or is held too early, the
interval is halved, so that the kink is first order only over what is left. All links are treated at once, so that the
outcome does not depend on their order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

#: Most iterations, and the change of a slip relative to the fastest speed at which they stop; after some iterations it
#: is clear whether the interval has a kink.
_ITERATIONS, _CONVERGED, _CLEAR = 50, 5e-5, 3

#: Length of an iteration's step over the inverse row sum; from 2 on it may diverge.
_SHARE = 1.5

#: How often an interval is halved around a kink.
_HALVINGS = 3

Law = Callable[[float], float]


class Rubbing:
    """Friction in the links of a cluster.

    A motion has three rows of complex numbers, one for each body: ``vx + i vy``, ``wx + i wy`` and ``vz + i wz`` (m/s
    and rad/s). Slips and impulses are complex, too: along the contact in the plane, and out of it.
    """

    def __init__(
        self,
        first: np.ndarray,
        second: np.ndarray,
        radius: np.ndarray,
        light: np.ndarray,
        easy: np.ndarray,
        laws: Sequence[Law],
        groups: np.ndarray,
    ) -> None:
        """``first`` and ``second`` are the bodies of each link; ``light`` and ``easy`` are the inverse masses (1/kg)
        and inertias (1/(kg m^2)) of bodies; ``laws`` have the friction of each link at a slip in m/s. Links of
        different ``groups`` share no body: a kink in one does not shorten the intervals of the others."""
        every = range(len(laws))
        self._links, self._arms, self._laws = (first, second), (radius[first], radius[second]), laws
        self._groups = groups
        signs, arms = np.zeros((2, len(laws), len(radius)))
        signs[every, first], signs[every, second] = 1.0, -1.0
        arms[every, first], arms[every, second] = self._arms
        self._pull, self._turn = (signs * light).T.astype(complex), (arms * easy).T.astype(complex)
        self._shifts, self._twists = signs * light @ signs.T, arms * easy @ arms.T  # 1/kg: links that share a body
        self._used = np.zeros(len(laws), complex)  # of the normal impulses, in the last interval: a first guess

    def after(
        self,
        motion: np.ndarray,
        normal: np.ndarray,
        pressed: np.ndarray,
        gain: np.ndarray,
        back: float,
        ahead: float,
        fastest: float,
    ) -> np.ndarray:
        """The motion after the friction of the time from ``back`` s before now to ``ahead`` s after.

        ``pressed`` are the normal impulses (N s) of that time, ``gain`` the accelerations (m/s^2) by normal forces.
        """
        acting = np.flatnonzero(pressed > 0.0)
        if not acting.size:
            return motion
        first, second = (bodies[acting] for bodies in self._links)
        arm, other_arm = (arms[acting] for arms in self._arms)
        normal, pressed = normal[acting], pressed[acting]
        one, other = motion.take(first, 1), motion.take(second, 1)
        velocity, _, out = one - other
        _, roll, spin = one * arm + other * other_arm
        across = normal.conj()
        slip = spin.imag - (velocity * across).imag + 1j * (out.real + (roll * across).imag)
        laws = [self._laws[link] for link in acting.tolist()]
        if not any(law(speed) for law, speed in zip(laws, np.abs(slip).tolist(), strict=True)):
            return motion
        drift = -((gain.take(first) - gain.take(second)) * across).imag  # m/s^2
        turned = (normal[:, None] * across).real
        shifts, twists = (mobility.take(acting, 0).take(acting, 1) for mobility in (self._shifts, self._twists))
        mobility = np.zeros((2 * acting.size,) * 2)  # 1/kg: of the parts along, and of those out of the plane
        mobility[::2, ::2], mobility[1::2, 1::2] = shifts * turned + twists, shifts + twists * turned
        total, used = np.zeros_like(slip), self._used[acting]
        every, groups = slice(None), self._groups[acting]
        waiting: list[tuple[float, float, int, Any]] = [(-back, ahead, _HALVINGS, every)]
        while waiting:
            begun, ended, halvings, some = waiting.pop()
            own = mobility if some is every else _of_some(mobility, some)
            its = laws if some is every else [laws[link] for link in some.tolist()]
            part = (ended - begun) / (ahead + back) * pressed[some]
            before, after = slip[some] + begun * drift[some], slip[some] + ended * drift[some]
            guess, close = used[some] * part, _CONVERGED * fastest
            impulse, kinked = _slid(before, after, own, part, its, guess, close, halvings, groups[some])
            if not kinked.all():
                impulse[kinked] = 0.0
                total[some] += impulse
                slip[some] += _times(own, impulse)
                used[some] = np.where(kinked, used[some], impulse / part)
            if kinked.any():
                middle = 0.5 * (begun + ended)
                again = some if kinked.all() else np.arange(acting.size)[some][kinked]
                waiting += [(middle, ended, halvings - 1, again), (begun, middle, halvings - 1, again)]
        self._used[acting] = used
        pull, turn = self._pull.take(acting, 1), self._turn.take(acting, 1)
        along, upward = total.real, total.imag
        change = (
            np.vecdot(pull, -1j * along * normal),
            np.vecdot(turn, 1j * upward * normal),
            np.vecdot(pull, upward) + 1j * np.vecdot(turn, along),
        )
        return np.add(motion, change)


def _slid(
    before: np.ndarray,
    end: np.ndarray,
    mobility: np.ndarray,
    pressed: np.ndarray,
    laws: Sequence[Law],
    impulse: np.ndarray,
    tolerance: float,
    halvings: int,
    groups: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Friction impulses (N s) in an interval in which the slips (m/s) would otherwise go from ``before`` to ``end``,
    and which are of a group with a kink, if it can be halved: these are of no use.

    By projected gradient steps from a guess; their lengths are a share of what the row sums of the matrix ``mobility``
    (1/kg) allow.
    """
    sums = np.abs(mobility).sum(axis=1)
    ease = np.maximum(sums[::2], sums[1::2])
    step, kinked = _SHARE / ease, np.zeros(len(laws), bool)
    end = end + _times(mobility, impulse)
    for iteration in range(_ITERATIONS):
        middle = 0.5 * (before + end)
        if iteration < 2:  # from then on the speeds change too little to matter
            limit = pressed * [law(speed) for law, speed in zip(laws, np.abs(middle).tolist(), strict=True)]
        holds, slides = impulse - end * step, impulse - middle * step
        held = np.abs(holds) <= limit
        wanted = slides * (limit / np.maximum(np.abs(slides), 1e-300))
        np.copyto(wanted, holds, where=held)
        change, impulse = wanted - impulse, wanted
        end += _times(mobility, change)
        done = np.maximum.reduce(np.abs(change) * ease) <= tolerance
        if done or iteration == _CLEAR:
            own = mobility.diagonal()
            least = (end - before).real / own[::2] + 1j * ((end - before).imag / own[1::2])
            keeps = np.abs(least - impulse) <= limit
            turns = (before * end.conj()).real < 0.5 * np.abs(before) * np.abs(end)
            if halvings:
                has_kink = np.zeros(groups.max() + 1, bool)
                has_kink[groups[~np.where(held, keeps, ~turns)]] = True
                kinked = has_kink[groups]
            if done or kinked.all():
                break
    return impulse, kinked


def _of_some(mobility: np.ndarray, links: np.ndarray) -> np.ndarray:
    """The rows and columns of these links."""
    both = (2 * links[:, None] + np.array([0, 1])).ravel()
    return mobility.take(both, 0).take(both, 1)


def _times(mobility: np.ndarray, impulse: np.ndarray) -> np.ndarray:
    """The slips (m/s) that impulses (N s) change."""
    slips: np.ndarray = np.vecdot(mobility, impulse.view(float)).view(complex)
    return slips
