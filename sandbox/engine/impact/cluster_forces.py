"""Normal forces in a cluster: Hertz's law with its damping (``physics/hertz.py``), in all links at once.

The force of damping, ``c d^(1/4) dd/dt``, is the rate of ``c 4/5 d^(5/4)``, which is how much of the momentum it has
taken in all. So the velocities without that part are integrated: their forces have no steep start, and equal steps are
accurate though contacts close and open within them.

What a cluster knows of the law of its normal forces is in this module; stiffness, damping and the time of a contact are
in ``physics/hertz.py``.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sandbox.engine.impact.cluster_parts import ClusterBall, Link
from sandbox.physics.hertz import damping

#: Rows of a state under normal forces: position (m) and velocity (m/s), complex.
POSITION, VELOCITY = 0, 1
FORCE_ROWS = 2


class ClusterForces:
    """The links of a cluster and their normal forces. Arrays of balls have one more entry, which stands for walls.

    ``evaluate`` leaves, of each link, the gap and depth (m), the normal, the closing speed (m/s), and the impulse of
    damping since it closed, ``damped`` (N s).
    """

    def __init__(self, balls: Sequence[ClusterBall], links: Sequence[Link]) -> None:
        wall = len(balls)
        self.first = np.array([link.first for link in links])
        self.second = np.array([wall if link.second is None else link.second for link in links])
        self.inverse_mass = np.array([*(1.0 / ball.mass for ball in balls), 0.0])  # 1/kg
        self.inverse_inertia = np.array([*(1.0 / ball.inertia for ball in balls), 0.0])  # 1/(kg m^2)
        self.radius = np.array([*(ball.radius for ball in balls), 0.0])  # m
        self.acceleration = np.array([*(complex(*ball.acceleration) for ball in balls), 0.0])  # m/s^2, by other causes
        one, other = self.inverse_mass[self.first], self.inverse_mass[self.second]
        self.mass = 1.0 / (one + other)  # kg, reduced, of each link
        self.stiffness = np.array([link.stiffness for link in links])  # N/m^1.5
        restitutions = [damping(link.restitution) for link in links]
        self._damping = np.array(restitutions) * np.sqrt(self.mass * self.stiffness)
        self._taken = 0.8 * self._damping
        self.pull = np.zeros((len(balls) + 1, len(links)), complex)  # 1/kg: of a ball, by an impulse at each link
        every = np.arange(len(links))
        self.pull[self.first, every], self.pull[self.second, every] = one, -other
        reach, size = self.radius[self.first], self.radius[self.second]
        self.smaller = np.where(size > 0.0, np.minimum(reach, size), reach)  # m, radius of the smaller ball
        self._reach = reach + size
        self._walls = [(place, link.wall, link.first) for place, link in enumerate(links) if link.wall is not None]
        self.has_walls = bool(self._walls)
        self.origin: complex = 0j  # m, from which positions are counted
        self._overlap = np.zeros(len(links))  # m, at the start

    def begin(self, state: np.ndarray) -> None:
        """Make the gaps of links that overlap in this state zero."""
        self.evaluate(state[:FORCE_ROWS], np.empty_like(state[:FORCE_ROWS]))
        self._overlap = np.minimum(self.gap, 0.0)

    def evaluate(self, state: np.ndarray, rates: np.ndarray) -> np.ndarray:
        """Write the ``rates`` of positions and of velocities, both without the momentum that damping has taken; return
        the elastic force of each link in N."""
        place, velocity = state
        apart = place.take(self.first) - place.take(self.second)
        distance = np.abs(apart)
        normal, curvature, gap = apart / distance, 1.0 / distance, distance - self._reach
        for link, wall, ball in self._walls:
            there = complex(place[ball] + self.origin)
            gap[link], nx, ny, curvature[link], *_ = wall(there.real, there.imag)
            normal[link] = complex(nx, ny)
        gap -= self._overlap
        depth = np.maximum(-gap, 0.0)
        root = np.sqrt(depth)
        damped, elastic = self._taken * depth * np.sqrt(root), self.stiffness * depth * root
        velocity = velocity + self.velocities(damped * normal)
        along = (velocity.take(self.first) - velocity.take(self.second)) * normal.conj()
        turned = (elastic - 1j * (damped * curvature * along.imag)) * normal  # damping's impulse turns with the normal
        rates[POSITION], rates[VELOCITY] = velocity, self.velocities(turned) + self.acceleration
        self.gap, self.depth, self.normal, self.closing, self.damped = gap, depth, normal, -along.real, damped
        return elastic

    def velocities(self, impulses: np.ndarray) -> np.ndarray:
        """Changes of the balls' velocities (m/s) by impulses (N s) at the links; or accelerations, by forces."""
        changes: np.ndarray = np.vecdot(self.pull, impulses)
        return changes

    def squared_rebound(self) -> np.ndarray:
        """The square of the speed (m^2/s^2) at which the energy stored in each link would part its balls: that energy
        is ``2/5 k d^(5/2)``."""
        squares: np.ndarray = 0.8 * self.stiffness / self.mass * self.depth**2.5
        return squares

    def damping_force(self) -> np.ndarray:
        """The force of damping in each link, in N."""
        force: np.ndarray = self._damping * np.sqrt(np.sqrt(self.depth)) * self.closing
        return force
