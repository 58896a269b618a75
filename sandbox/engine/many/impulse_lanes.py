"""Impulses of many contacts, each of one ball and what stands still, computed by pymunk in one step.

Each contact is a disc of radius 1 and mass 1 on level ground (``impact/impulses.py``) in a lane of its own.
"""

from __future__ import annotations

import threading

import numpy as np
from pymunk import batch

from sandbox.engine.impact.impulses import INSTANT, OVERLAP, PARKED, disc_over_ground, still_space

#: Distance between lanes, and how many lie side by side.
_SPACING, _SIDE = 4.0, 8

#: Fewest and most lanes: a step costs about 0.4 us for each, used or not. More contacts are done in several steps.
FEW, MANY = 8, 64

_MOTION = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
_ALL = batch.BodyFields.POSITION | _MOTION


class Lanes:
    """Discs, each above level ground of its own."""

    def __init__(self, count: int) -> None:
        self._space = still_space(1)
        at = np.array([(_SPACING * (lane % _SIDE), _SPACING * (lane // _SIDE)) for lane in range(count)])
        self._discs = [disc_over_ground(self._space, x, y) for x, y in at.tolist()]
        self._pairs = [(0.0, 0.0, 1.0)] * count  # restitution, friction, moment of inertia
        self._buffers = batch.Buffer(), batch.Buffer()
        # x, y, vx, vy and spin of discs that are not in use, and of the static body
        self._parked = np.zeros((count + 1, 5))
        self._parked[:-1, :2] = at + np.array([0.0, 1.0 - OVERLAP + PARKED])

    def exchange(self, approach: np.ndarray, slip: np.ndarray, bounces: np.ndarray) -> np.ndarray:
        """The impulses away from the ground and along it, shape (2, contacts), of discs that approach at these speeds
        and whose surfaces slip at those; all in m/s. ``bounces`` has rows of restitution, friction and moment of
        inertia."""
        impulses, count = np.empty((2, len(slip))), len(self._discs)
        for first in range(0, len(slip), count):
            some = slice(first, first + count)
            self._prepare(bounces[some])
            impulses[:, some] = self._step(approach[some], slip[some])
        return impulses

    def _step(self, approach: np.ndarray, slip: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The impulses of no more contacts than there are lanes, which are prepared."""
        entering, leaving = self._buffers
        here = slice(len(slip))
        entered = self._parked.copy()
        entered[here, 1] -= PARKED
        entered[here, 2], entered[here, 3] = slip, -approach
        entering.set_float_buf(entered)
        try:
            batch.set_space_bodies(self._space, _ALL, entering)
            self._space.step(INSTANT)
            leaving.clear()
            batch.get_space_bodies(self._space, _MOTION, leaving)
            along, away, _ = np.frombuffer(leaving.float_buf()).reshape(-1, 3)[here].T
            return away + approach, along - slip
        finally:  # apart, so that pymunk forgets the contacts
            entering.set_float_buf(self._parked)
            batch.set_space_bodies(self._space, _ALL, entering)
            self._space.step(INSTANT)

    def _prepare(self, bounces: np.ndarray) -> None:
        """Set restitution, friction and inertia of the first lanes; most are those of the contact before."""
        for lane, pair in enumerate(map(tuple, bounces.tolist())):
            before = self._pairs[lane]
            if before != pair:
                disc, body = self._discs[lane]
                disc.elasticity, disc.friction, inertia = self._pairs[lane] = pair
                if before[2] != inertia:
                    body.moment = inertia


_made = threading.local()


def lanes_for(contacts: int) -> Lanes:
    """Enough lanes of this thread for so many contacts, or the most; made once, as a contact leaves no trace in
    them."""
    count = min(MANY, max(FEW, 1 << (contacts - 1).bit_length()))
    of_thread: dict[int, Lanes] = _made.__dict__.setdefault("lanes", {})
    if count not in of_thread:
        of_thread[count] = Lanes(count)
    return of_thread[count]
