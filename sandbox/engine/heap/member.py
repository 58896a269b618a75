"""A ball or body in a heap, and its counterpart in pymunk's Space."""

from __future__ import annotations

from collections.abc import Mapping
from math import hypot
from typing import Any

import pymunk

from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.heap.pymunk_world import PymunkWorld
from sandbox.engine.model.ball import kinetic
from sandbox.engine.model.surface import Surface
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.phase import InHeap
from sandbox.physics.integrators import Acceleration, State

#: The attributes of a member that outlast a step.
_KEPT = ("since", "slow_for", "resistance", "start", "end", "applied")


class Member:
    """A ball or body in a heap. A step is half a drift, the impulses of forces and contacts, and half a drift.

    Chipmunk's unit of time is ``unit`` s.
    """

    def __init__(self, index: int, mover: MovingBall, world: PymunkWorld, unit: float, since: float) -> None:
        self.index = index
        self.mover = mover
        self.ball = mover.ball
        self.since = since  # s, when it came to press on others; from the start, forever
        self.slow_for = 0.0  # s
        self.resistance = 0.0  # N m, of rolling, by the pressure of the step before
        self.touching: set[Obstacle | int] = set()  # obstacles, and balls by index, in this step
        self.before: set[Obstacle | int] = set()  # the same in the step before
        self.left_out: set[Obstacle | int] = set()  # what it met too fast in this step: left to an impact
        self.start: State = mover.state
        self.end: State = mover.state
        self.applied: Acceleration | None = None  # by forces in the middle of the last step, in m/s^2 and rad/s^2
        self.x = self.y = self.turn = 0.0  # m and rad, in the middle of the step
        self.velocity = 0.0, 0.0, 0.0  # m/s and rad/s, after the impulses
        self.fastest = 0.0  # m/s, that no point of a body, or of a ball its centre, exceeds at either end of the step
        self.body, self.disc = world.add(self.ball)
        self.brake = pymunk.SimpleMotor(self.body, world.space.static_body, 0.0)  # rolling resistance
        self._unit, self._h = unit, 0.0  # s
        world.space.add(self.brake)

    def state(self) -> dict[str, Any]:
        """Return what its next step depends on, apart from its mover and what it touches, which is found again."""
        return {name: getattr(self, name) for name in _KEPT}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Go on from such a state."""
        for name, value in state.items():
            setattr(self, name, value)

    def place(self, t: float, h: float, state: State) -> None:
        """Begin a step of h s at t: Chipmunk will move it from here to the middle."""
        x, y, vx, vy, spin, *angle = state
        unit, ball, body = self._unit, self.ball, self.body
        turned = [angle[0] + 0.5 * h * spin] if angle else []
        middle = (x + 0.5 * h * vx, y + 0.5 * h * vy, vx, vy, spin, *turned)
        self.start, self._h = state, h
        self.x, self.y = middle[:2]  # until Chipmunk has corrected it
        self.applied = ax, ay, turning = self.mover.applied(t + 0.5 * h, middle)
        body.position = (x - 0.5 * h * vx, y - 0.5 * h * vy)
        body.angle = angle[0] - 0.5 * h * spin if angle else 0.0
        body.velocity, body.angular_velocity = (unit * vx, unit * vy), unit * spin
        mass, inertia = unit * unit * ball.mass, unit * unit * ball.inertia
        body.force, body.torque = (mass * ax, mass * ay), inertia * turning
        self.brake.max_force = unit * unit * self.resistance
        self.touching, self.left_out = set(), set()

    def read(self) -> None:
        """Take over what Chipmunk has made of it in the middle of the step."""
        body, unit = self.body, self._unit
        (self.x, self.y), self.turn = body.position, body.angle
        (vx, vy), spin = body.velocity, body.angular_velocity
        self.velocity = vx / unit, vy / unit, spin / unit

    @property
    def freely(self) -> tuple[float, float, float]:
        """The velocity that it would have after this step by forces alone, in m/s and rad/s."""
        assert self.applied is not None
        (_, _, vx, vy, spin, *_), (ax, ay, turning), h = self.start, self.applied, self._h
        return vx + h * ax, vy + h * ay, spin + h * turning

    def velocity_at(self, x: float, y: float) -> tuple[float, float]:
        """The velocity in m/s, before the impulses, of its point that is at (x, y) in the middle of the step."""
        _, _, vx, vy, spin, *_ = self.start
        return vx - spin * (y - self.y), vy + spin * (x - self.x)

    def velocity_after(self, x: float, y: float) -> tuple[float, float]:
        """The same after the impulses."""
        vx, vy, spin = self.velocity
        return vx - spin * (y - self.y), vy + spin * (x - self.x)

    @property
    def energy(self) -> float:
        """Kinetic energy in J after the impulses."""
        return kinetic(self.ball, (0.0, 0.0, *self.velocity))

    @property
    def gain(self) -> float:
        """The energy in J that it gains in the step beyond the work of forces, which act where it is moved by position
        correction, too."""
        assert self.applied is not None
        (x, y, ux, uy, spun, *_), (ax, ay, turning) = self.start, self.applied
        (vx, vy, spin), ball, half = self.velocity, self.ball, 0.5 * self._h
        dx, dy = self.x + half * vx - x, self.y + half * vy - y
        by_speed = 0.5 * (vx * vx + vy * vy - ux * ux - uy * uy) - ax * dx - ay * dy
        by_spin = 0.5 * (spin * spin - spun * spun) - turning * half * (spun + spin)
        return ball.mass * by_speed + ball.inertia * by_spin

    def driven(self, spin: float, t: float) -> float:
        """The acceleration in m/s^2 by forces, of the last step or else at t, together with that of the farthest point
        of a body with this spin (rad/s): it presses on others without a force, too."""
        if self.applied is None:
            self.applied = self.mover.applied(t, self.mover.state)
        by_spin = spin * spin * self.ball.radius if self.ball.rotates else 0.0
        return hypot(*self.applied[:2]) + by_spin

    def resist(self, surface: Surface, push: float, height: float) -> None:
        """Add the torque of rolling resistance on a surface that presses with ``push`` (N) and is ``height`` (m) from
        the centre."""
        self.resistance += surface.rolling_resistance * push * (height + self.ball.inertia / (self.ball.mass * height))

    def arc(self, t: float) -> Arc:
        """The path of the step from t, in which the velocity changes evenly, moved by position correction."""
        h, px, py, turn = self._h, self.x, self.y, self.turn
        x, y, ux, uy, spun, *angle = self.start
        vx, vy, spin = self.velocity
        dx, dy = px - x - 0.5 * h * ux, py - y - 0.5 * h * uy
        reach = self.ball.radius if self.ball.rotates else 0.0
        self.fastest = max(hypot(ux, uy) + reach * abs(spun), hypot(vx, vy) + reach * abs(spin))
        turned = tuple((at, 0.5 * (at + turn) + 0.25 * h * spun, turn + 0.5 * h * spin) for at in angle)
        self.end = (px + 0.5 * h * vx, py + 0.5 * h * vy, vx, vy, spin, *(curve[-1] for curve in turned))
        curves = (
            (x, x + 0.5 * (h * ux + dx), self.end[0]),
            (y, y + 0.5 * (h * uy + dy), self.end[1]),
            (ux, vx),
            (uy, vy),
            (spun, spin),
            *turned,
        )
        return Arc(t, t + h, self.start, curves, InHeap(dx / h, dy / h), self.end)
