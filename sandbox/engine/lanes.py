"""Single contacts of many shots at once, by one step of a pymunk Space in which each has a lane of its own."""

from __future__ import annotations

import numpy as np
from pymunk import batch

from sandbox.engine.impulses import INSTANT, Lanes

#: Lanes of a Space: a step costs about 0.4 us for each, used or not. More contacts are done in several steps.
_LANES = 64

_MOTION = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
_ALL = batch.BodyFields.POSITION | _MOTION


class ManyLanes(Lanes):
    """Lanes for arrays."""

    COUNT = _LANES

    def __init__(self) -> None:
        super().__init__()
        parked = [(*body.position, 0.0, 0.0, 0.0) for body in self._bodies]
        self._parked = np.array([*parked, (0.0, 0.0, 0.0, 0.0, 0.0)])  # x, y, vx, vy, spin; the last is the static body
        self._heights = np.array(self._places)[:, 1]
        self._entered = self._parked.copy()
        self._entering, self._parking, self._leaving = batch.Buffer(), batch.Buffer(), batch.Buffer()
        self._entering.set_float_buf(self._entered)
        self._parking.set_float_buf(self._parked)

    def exchange_all(self, approach: np.ndarray, slip: np.ndarray, bounces: np.ndarray) -> np.ndarray:
        """The impulses of ``exchange``, shape (2, contacts); ``bounces`` has rows of restitution, friction and inertia
        factor."""
        impulses = np.empty((2, len(slip)))
        for first in range(0, len(slip), _LANES):
            some = slice(first, first + _LANES)
            impulses[:, some] = self._exchange_in_lanes(approach[some], slip[some], bounces[some])
        return impulses

    def _exchange_in_lanes(
        self, approach: np.ndarray, slip: np.ndarray, bounces: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        count = len(slip)
        for lane, pair in enumerate(map(tuple, bounces.tolist())):
            self._prepare(lane, pair)
        self._entered[:count, 1] = self._heights[:count]
        self._entered[:count, 2] = slip
        self._entered[:count, 3] = -approach
        try:
            batch.set_space_bodies(self._space, _ALL, self._entering)
            self._space.step(INSTANT)
            self._leaving.clear()
            batch.get_space_bodies(self._space, _MOTION, self._leaving)
            along, away, _ = np.frombuffer(self._leaving.float_buf()).reshape(_LANES + 1, 3)[:count].T
            return away + approach, along - slip
        finally:  # apart, so that pymunk forgets the contacts
            batch.set_space_bodies(self._space, _ALL, self._parking)
            self._space.step(INSTANT)
