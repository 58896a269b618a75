"""Impacts of many shots, each on one surface."""

from __future__ import annotations

from typing import Any

import numpy as np

from sandbox.engine.contact.surfaces import bounce_off, tilted
from sandbox.engine.contact.touch import SIDE
from sandbox.engine.many.batch_forces import raise_if_ctrl_c
from sandbox.engine.many.batch_record import IMPACTS, BatchRecord
from sandbox.engine.many.continuation import ExitReason
from sandbox.engine.many.in_flight import InFlight
from sandbox.engine.many.outlines import BatchSurfaces
from sandbox.engine.model.tolerances import CLOSING
from sandbox.physics.impulse import after_plane_impulse, exchange, plane_speeds
from sandbox.physics.integrators import Acceleration


class BatchImpacts:
    """Resolves the impacts of a batch. What touches several surfaces, or does not close, is to be continued alone."""

    def __init__(self, flying: InFlight, outlines: BatchSurfaces, record: BatchRecord) -> None:
        setups = record.setups
        self._flying = flying
        self._outlines = outlines
        self._record = record
        self._has_law = np.array([surface.law is not None for surface in setups.whole.surfaces], dtype=bool)
        ball = setups.whole.balls[0]
        self._radius, self._factor, self._mass = (
            np.broadcast_to(each, len(setups)) for each in (ball.radius, ball.inertia_factor, ball.mass)
        )  # of all shots: m, of m R^2, kg

    def collide(self, lanes: np.ndarray) -> None:
        """Change the velocities of shots that touch a surface."""
        flying = self._flying
        shots = flying.shot[lanes]
        x, y, vx, vy, _ = flying.state[:, lanes]
        count, surface, near = self._outlines.near(shots, x, y, flying.surface[lanes])
        approach = -(vx * near.nx + vy * near.ny)
        along = vx * near.ny - vy * near.nx
        resolved = (count == 1) & (approach > CLOSING)
        bounces, lawful = self._bounces(shots, surface, approach, along, resolved)
        resolved &= lawful
        normal, kick = tilted(near.nx, near.ny, bounces[:, 2], along), self._outlines.of(surface, shots).surface.kick
        motion = np.array(self._exchanged(lanes, *normal, bounces, kick))
        held = (flying.surface[lanes] >= 0).nonzero()[0]
        if len(held):  # what it is on may act, too, and does not if it is not pressed on that
            own = self._outlines.of(flying.surface[lanes[held]], shots[held]).on_feature(SIDE, x[held], y[held])
            resolved[held] &= motion[0, held] * own.nx + motion[1, held] * own.ny >= -CLOSING
        flying.exit[lanes[~resolved]] = ExitReason.BEFORE_IMPACT
        lanes, shots, surface = lanes[resolved], shots[resolved], surface[resolved]
        self._record.counts[IMPACTS, shots] += 1
        flying.state[2:, lanes] = motion[:, resolved]
        flying.met[lanes], flying.normal[:, lanes] = surface, np.array(near[1:4])[:, resolved]
        rows = flying.t[lanes], surface, approach[resolved], x[resolved], y[resolved]
        self._record.add_impacts(shots, np.array(rows).T)

    def _bounces(
        self, shots: np.ndarray, surface: np.ndarray, approach: np.ndarray, along: np.ndarray, resolved: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray]:
        """Rows of a Bounce for each impact, and a mask of those of which the surface's law could be called: run alone,
        the others report what is wrong with it."""
        bounces, lawful = np.zeros((len(shots), 4)), np.ones(len(shots), dtype=bool)
        properties = self._outlines.of(surface, shots).surface
        bounces[:, 0], bounces[:, 1] = properties.restitution, properties.friction
        for i in (resolved & self._has_law[surface]).nonzero()[0].tolist():
            own = self._record.setups[shots[i]].surfaces[surface[i]]
            try:
                bounces[i] = bounce_off(own, float(approach[i]), float(along[i]))
            except BaseException as error:
                raise_if_ctrl_c(error)
                lawful[i] = False
        return bounces, lawful

    def _exchanged(
        self, lanes: np.ndarray, nx: np.ndarray, ny: np.ndarray, bounces: np.ndarray, kick: Any
    ) -> Acceleration:
        """The velocities (m/s) and spins (rad/s) after impacts on surfaces with these normals, which ``kick`` (N s)."""
        (vx, vy, spin), shots = self._flying.state[2:, lanes], self._flying.shot[lanes]
        r, factor = self._radius[shots], self._factor[shots]
        approach, slip = plane_speeds(vx, vy, spin, nx, ny, r)
        restitution, friction, _, tangential = bounces.T
        push, rub = exchange(approach, (1.0 + tangential) * slip, factor, restitution, friction)
        return after_plane_impulse(vx, vy, spin, nx, ny, r, factor, push + kick / self._mass[shots], rub)
