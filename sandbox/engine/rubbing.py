"""Friction between bodies that are pressed together: impulses limited by the normal impulses (Coulomb).

Over an interval in which normal impulses and slips change evenly, a link that can hold ends without slip, and one that
cannot slides against its slip in the middle: both are second order. Where a slip reverses or is held too early, the
interval is halved, so that the kink is first order only over what is left. All links are treated at once, so that the
outcome does not depend on their order.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

#: Most iterations, and the change of a slip relative to the fastest speed at which they stop; after some iterations it
#: is clear whether the interval has a kink.
_ITERATIONS, _CONVERGED, _CLEAR = 50, 1e-6, 3

#: Length of an iteration's step over the inverse row sum; from 2 on it may diverge.
_SHARE = 1.5

#: How often an interval is halved around a kink.
_HALVINGS = 3

Law = Callable[[float], float]


class Rubbing:
    """Friction in the links of a cluster.

    A motion is an array of the velocities along x, y and z (m/s) and the spins about them (rad/s) of all bodies, shape
    (6, bodies). Slips and impulses have two rows: along the contact in the plane, and out of the plane.
    """

    def __init__(
        self, incidence: np.ndarray, radius: np.ndarray, light: np.ndarray, easy: np.ndarray, laws: Sequence[Law]
    ) -> None:
        """``incidence`` is 1 at the first and -1 at the second body of each link, shape (bodies, links); ``light`` and
        ``easy`` are the inverse masses (1/kg) and inertias (1/(kg m^2)); ``laws`` have the friction of each link at a
        slip in m/s."""
        arms = np.abs(incidence) * radius[:, None]
        self._pull, self._turn = (incidence.T * light), (arms.T * easy)
        self._incidence, self._arms, self._laws = incidence, arms, laws
        self._shifts, self._twists = self._pull @ incidence, self._turn @ arms  # 1/kg: links that share a body
        self._used = np.zeros((2, len(laws)))  # of the normal impulses, in the last interval: a first guess

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
        (nx, ny), pressed = normal[:, acting], pressed[acting]
        incidence, both = self._incidence[:, acting], (acting[:, None], acting)
        ux, uy, uz = motion[:3] @ incidence
        wx, wy, wz = motion[3:] @ self._arms[:, acting]
        ax, ay = gain @ incidence
        slip = np.array([ux * ny - uy * nx + wz, uz - wx * ny + wy * nx])
        laws = [self._laws[link] for link in acting.tolist()]
        if all(law(speed) == 0.0 for law, speed in zip(laws, _size(slip).tolist(), strict=True)):
            return motion
        drift = np.array([ax * ny - ay * nx, np.zeros_like(ax)])  # m/s^2
        turned = nx[:, None] * nx + ny[:, None] * ny
        shifts, twists = self._shifts[both], self._twists[both]
        mobility = np.array([shifts * turned + twists, shifts + twists * turned])
        total, used = np.zeros_like(slip), self._used[:, acting]
        waiting = [(-back, ahead, _HALVINGS)]
        while waiting:
            begun, ended, halvings = waiting.pop()
            part = (ended - begun) / (ahead + back) * pressed
            before, after = slip + begun * drift, slip + ended * drift
            impulse, smooth = _slid(before, after, mobility, part, laws, used * part, _CONVERGED * fastest, halvings)
            if smooth or halvings == 0:
                total += impulse
                slip += _times(mobility, impulse)
                used = impulse / part
            else:
                middle = 0.5 * (begun + ended)
                waiting += [(middle, ended, halvings - 1), (begun, middle, halvings - 1)]
        self._used[:, acting] = used
        along, out = total
        pulls, moments = np.array([along * ny, -along * nx, out]), np.array([-out * ny, out * nx, along])
        return motion + np.concatenate([pulls @ self._pull[acting], moments @ self._turn[acting]])


def _slid(
    before: np.ndarray,
    end: np.ndarray,
    mobility: np.ndarray,
    pressed: np.ndarray,
    laws: Sequence[Law],
    impulse: np.ndarray,
    tolerance: float,
    halvings: int,
) -> tuple[np.ndarray, bool]:
    """Friction impulses (N s) in an interval in which the slips (m/s) would otherwise go from ``before`` to ``end``,
    and whether they change without a kink; if not, and it can be halved, the impulses are of no use.

    By projected gradient steps from a guess; their lengths are a share of what the row sums of the matrix ``mobility``
    (1/kg) allow.
    """
    ease = np.abs(mobility).sum(axis=2).max(axis=0)
    step, smooth = _SHARE / ease, True
    end = end + _times(mobility, impulse)
    for iteration in range(_ITERATIONS):
        middle = 0.5 * (before + end)
        if iteration < 2:  # from then on the speeds change too little to matter
            limit = pressed * [law(speed) for law, speed in zip(laws, _size(middle).tolist(), strict=True)]
        holds, slides = impulse - end * step, impulse - middle * step
        held = _size(holds) <= limit
        change = np.where(held, holds, slides * (limit / np.maximum(_size(slides), 1e-300))) - impulse
        impulse = impulse + change
        end += _times(mobility, change)
        done = np.abs(change * ease).max() <= tolerance
        if done or iteration == _CLEAR:
            own = mobility.diagonal(axis1=1, axis2=2)
            keeps = _size((end - before) / own - impulse) <= limit
            turns = np.add.reduce(before * end) < 0.5 * _size(before) * _size(end)
            smooth = bool(np.where(held, keeps, ~turns).all())
            if done or (halvings and not smooth):
                break
    return impulse, smooth


def _times(mobility: np.ndarray, impulse: np.ndarray) -> np.ndarray:
    """The slips (m/s) that impulses (N s) change."""
    slips: np.ndarray = np.matmul(mobility, impulse[:, :, None])[:, :, 0]
    return slips


def _size(vectors: np.ndarray) -> np.ndarray:
    size: np.ndarray = np.hypot(vectors[0], vectors[1])
    return size
