"""Friction in a cluster of balls that also give way along their contact: springs that slide where friction does.

A contact is a row of springs, each with its share of the normal force: in Hertz's law those that a depth d presses in
reach to a radius of ``sqrt(d)``, as in the method of dimensionality reduction (Popov & Hess 2015, Method of
Dimensionality Reduction in Contact Mechanics and Friction, chapter 5). A spring is stretched by the slip, is as stiff
as Mindlin's contact, and slides where its force would be larger than mu times its share: at the rim first. So a pair
leaves as Maw, Barber & Fawcett 1976 found (``physics/throw.py``); and as springs that slide lose energy, none appears.

The coefficient of friction is that of the greatest slip since the contact closed, as it was measured: by the slip with
which balls meet.

Stretches and slips are complex: along the contact in the plane, and out of it. The impulses act between steps, on which
the slips are known: second order in the step.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sandbox.engine.impact.cluster_forces import ClusterForces
from sandbox.engine.impact.cluster_friction import ClusterFriction
from sandbox.engine.impact.cluster_parts import Link
from sandbox.engine.model.tolerances import TINY

#: Springs from the middle of the largest circle of contact to its rim, each this fraction as far out as the next: a
#: blow a thousand times as slow, whose circle is a sixteenth as large, still has six of them.
_SPRINGS, _CLOSER = 14, 0.75


class SpringFriction(ClusterFriction):
    """Friction in the links of a cluster of elastic balls, whose stiffness along a contact is ``ratio`` times that
    across it; no circle of contact is larger than at the depths ``deepest`` (m) of the links."""

    def __init__(self, forces: ClusterForces, links: Sequence[Link], ratio: float, deepest: np.ndarray) -> None:
        super().__init__(forces, links)
        self._forces = forces
        edges = np.array([0.0, *(_CLOSER ** np.arange(_SPRINGS)[::-1])])  # radii of circles, over the largest
        inner, outer = edges[:-1], edges[1:]
        self._begins = deepest[:, None] * (inner**2 + inner * outer + outer**2) / 3.0  # m, depth that presses a spring
        self._wide = np.sqrt(deepest)[:, None] * (outer - inner)  # m^0.5
        self._stiff = ratio * 1.5 * forces.stiffness[:, None] * self._wide  # N/m, along the contact
        self._stretch = np.zeros_like(self._stiff, complex)  # m
        self._slip = np.zeros(len(links), complex)  # m/s, after the last impulses
        self._fastest = np.zeros(len(links))  # m/s, slip since a link has closed

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
        every = np.arange(len(pressed))
        slip = self._slips(motion, every, normal)
        back, ahead = span
        room = np.maximum(self._forces.depth[:, None] - self._begins, 0.0)  # m
        share = room * self._wide
        self._fastest = np.maximum(np.abs(slip), np.where(pressed > 0.0, self._fastest, 0.0))
        limit = self._coefficients(every)(self._fastest) * pressed / (back + ahead)  # N
        most = limit[:, None] * share / (np.maximum(share.sum(axis=1)[:, None], TINY) * self._stiff)
        stretch = self._stretch + (back * (self._slip + slip))[:, None]
        self._stretch = stretch * np.minimum(1.0, most / np.maximum(np.abs(stretch), TINY))
        impulse = -(back + ahead) * (self._stiff * self._stretch).sum(axis=1)
        motion = motion + self._changes(every, normal, impulse)
        self._slip = self._slips(motion, every, normal)
        return motion
