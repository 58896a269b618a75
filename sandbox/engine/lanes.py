"""Impacts of many shots at once, by one step of a pymunk Space in which each has a lane of its own.

An impact of one ball with one surface does not depend on place, direction or size: rotated so that the normal points
up, and scaled by the ball's radius and mass, it is an impact of a disc of radius 1 and mass 1 on level ground. So the
discs and grounds stay in place, and only velocities, restitution and friction are set.
"""

from __future__ import annotations

import numpy as np
import pymunk
from pymunk import batch

#: Lanes of a Space: a step costs about 0.4 us for each, used or not. More impacts are done in several steps.
_SIDE = 8
_LANES = _SIDE * _SIDE

#: Distance between lanes. The lanes are near the origin, where rounding is smallest.
_SPACING = 4.0

#: As in contacts.py: nothing moves in such a short step, and a slight overlap makes Chipmunk see the contact.
_INSTANT, _OVERLAP = 1e-15, 1e-6

#: Height above its ground at which an unused disc is parked.
_PARKED = 1.5

_ALL = batch.BodyFields.POSITION | batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY
_VELOCITIES = batch.BodyFields.VELOCITY | batch.BodyFields.ANGULAR_VELOCITY


class Lanes:
    """A Space for impacts of single balls with surfaces."""

    def __init__(self) -> None:
        self._space = pymunk.Space()
        self._space.collision_slop = 1.0
        self._space.collision_bias = 1.0
        self._space.collision_persistence = 1
        self._space.iterations = 1  # a single contact is exact after one iteration
        self._discs: list[pymunk.Circle] = []
        self._bodies: list[pymunk.Body] = []
        self._bounces = np.zeros((_LANES, 3))  # restitution, friction and inertia factor now set
        self._parked = np.zeros((_LANES + 1, 5))  # x, y, vx, vy, spin; the last is the static body
        for lane in range(_LANES):
            x, y = _SPACING * (lane % _SIDE), _SPACING * (lane // _SIDE)
            ground = pymunk.Segment(self._space.static_body, (x - 0.1, y), (x + 0.1, y), 0.0)
            ground.elasticity = ground.friction = 1.0  # pymunk multiplies both shapes' values: the disc has the pair's
            body = pymunk.Body(1.0, 1.0)
            disc = pymunk.Circle(body, 1.0)
            disc.elasticity = disc.friction = 0.0
            self._bounces[lane] = 0.0, 0.0, 1.0
            self._space.add(ground, body, disc)
            self._bodies.append(body)
            self._discs.append(disc)
            self._parked[lane] = x, y + _PARKED, 0.0, 0.0, 0.0
        self._entered = self._parked.copy()
        self._entering, self._parking, self._leaving = batch.Buffer(), batch.Buffer(), batch.Buffer()
        self._entering.set_float_buf(self._entered)
        self._parking.set_float_buf(self._parked)
        batch.set_space_bodies(self._space, _ALL, self._parking)

    def exchange(
        self, along: np.ndarray, away: np.ndarray, spin: np.ndarray, bounces: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Velocities along the surface and away from it, both divided by the radius (1/s), and spin (rad/s), after
        impacts.

        ``along`` is positive to the right of the normal. ``bounces`` has rows of restitution, friction and inertia
        factor. All arrays have an entry for each impact.
        """
        after = np.empty((len(along), 3))
        for first in range(0, len(along), _LANES):
            some = slice(first, first + _LANES)
            after[some] = self._exchange_in_lanes(along[some], away[some], spin[some], bounces[some])
        return after[:, 0], after[:, 1], after[:, 2]

    def _exchange_in_lanes(
        self, along: np.ndarray, away: np.ndarray, spin: np.ndarray, bounces: np.ndarray
    ) -> np.ndarray:
        count = len(along)
        for lane in np.flatnonzero((self._bounces[:count] != bounces).any(axis=1)).tolist():
            restitution, friction, inertia = bounces[lane].tolist()
            disc = self._discs[lane]
            disc.elasticity, disc.friction = restitution, friction
            if inertia != self._bounces[lane, 2]:
                self._bodies[lane].moment = inertia
        self._bounces[:count] = bounces
        self._entered[:] = self._parked
        self._entered[:count, 1] += 1.0 - _OVERLAP - _PARKED
        self._entered[:count, 2] = along
        self._entered[:count, 3] = away
        self._entered[:count, 4] = spin
        batch.set_space_bodies(self._space, _ALL, self._entering)
        self._space.step(_INSTANT)
        self._leaving.clear()
        batch.get_space_bodies(self._space, _VELOCITIES, self._leaving)
        after = np.frombuffer(self._leaving.float_buf()).reshape(_LANES + 1, 3)[:count].copy()
        # apart: pymunk drops the contacts, so that the next impact starts fresh
        batch.set_space_bodies(self._space, _ALL, self._parking)
        self._space.step(_INSTANT)
        return after
