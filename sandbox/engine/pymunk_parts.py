"""Parts of a pymunk Space of a setup: what moves, with the forces on it, and surfaces that are thick."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from math import ceil
from typing import Any

import pymunk

from sandbox.engine.contact.manifold import fixed_outline
from sandbox.engine.kernel.step_control import STIFFEST
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Polygon, Vector
from sandbox.engine.model.surface import Circle, Surface
from sandbox.engine.motion.forces_on_ball import acceleration_function
from sandbox.physics.integrators import Acceleration, State
from sandbox.physics.plane import Plane

#: Overlap in m that is left; Chipmunk's own, 0.1, would be 10 cm here.
SLOP = 1e-5

#: Thickness in m of the ground and of walls around everything.
DEPTH = 1.0

#: Forces that change a speed by less than this share cannot reverse it; those that can act in pieces, at most so many.
_EASY, _MOST_PIECES = 0.05, 1000


class Mover:
    """A ball or body in the Space."""

    def __init__(self, ball: Ball, body: pymunk.Body, shape: pymunk.Shape, start: State, plane: Plane | None) -> None:
        self.ball, self.body, self.shape, self.plane = ball, body, shape, plane
        self.law = acceleration_function(ball)
        self.take(start)
        self.start: State = start  # of the step
        self.far = 0.0  # m, that it moves in it
        self.pull: Acceleration | None = None  # by forces; None if it must be evaluated
        self.share = 0.0  # s, for which forces act at the end of the step
        self.ahead: State | None = None  # at the end of the step, but for contacts
        self.evaluations = 0
        self.girth = min(_reaches(shape), default=ball.radius)  # m, the smallest distance from the centre to a side
        self.settled = False  # its contact in this step has been solved already
        self.touched = self.held = -2  # number of the last step in which it touched something, or was pressed on it
        self.resisted: dict[Any, float] = {}  # rolling resistance of sustained contact, by the surface's shape

    def state(self) -> State:
        body = self.body
        more = (body.angle,) if self.ball.rotates else self.rolling_spin
        return (*body.position, *body.velocity, body.angular_velocity, *more)

    def take(self, state: State) -> None:
        """Set the velocities and spins to those of this state."""
        self.body.velocity, self.body.angular_velocity = state[2:4], state[4]
        self.rolling_spin: tuple[float, ...] = () if self.ball.rotates else state[5:]  # rad/s

    def acceleration(self, t: float, state: State) -> Acceleration:
        """The acceleration by forces and torques, at time t in s."""
        self.evaluations += 1
        return self.law(t, state if self.ball.rotates else state[:5])

    def after_forces(self, t: float, state: State, a: Acceleration, tau: float) -> State:
        """The state after tau s of forces, or of the plane's friction; ``a`` is their acceleration now. It is not
        moved."""
        if self.plane is not None:
            return self._along(self.plane, t, state, tau)
        gain = tau * self._size(a)
        if gain > _EASY * (abs(state[2]) + abs(state[3])):
            there = self.acceleration(t, _after(state, a, tau))
            change = tau * self._size((there[0] - a[0], there[1] - a[1], there[2] - a[2]))
            pieces = min(_MOST_PIECES, ceil(change / (STIFFEST * gain))) if change < 1e300 else _MOST_PIECES
            for _ in range(pieces - 1):
                state = _after(state, a, tau / pieces)
                a = self.acceleration(t, state)
            return _after(state, a, tau / max(1, pieces))
        return _after(state, a, tau)

    def _along(self, plane: Plane, t: float, state: State, tau: float) -> State:
        """The state after tau s on a plane, in all its phases; it is not moved."""
        forces, radius = len(self.ball.forces) + len(self.ball.torques) > 0, self.ball.radius
        while tau > 0.0:
            phase = plane.phase_under(self.acceleration, t, state, radius) if forces else plane.phase(state, radius)
            part = min(tau, phase.duration)
            state = (*state[:2], *phase.after(part)[2:])
            tau -= part
        return state

    def _size(self, a: Acceleration) -> float:
        return float(abs(a[0]) + abs(a[1]) + self.ball.radius * abs(a[2]))


def _after(state: State, a: Acceleration, tau: float) -> State:
    x, y, vx, vy, spin, *more = state
    return (x, y, vx + tau * a[0], vy + tau * a[1], spin + tau * a[2], *more)


def _reaches(shape: pymunk.Shape) -> Iterator[float]:
    """The distances in m of a polygon's sides from its body's centre."""
    if isinstance(shape, pymunk.Poly):
        corners = shape.get_vertices()
        for one, other in pairwise([*corners, corners[0]]):
            yield one.cross(other) / (other - one).length + shape.radius


def thick_outline(setup: Setup, surface: Surface) -> Polygon:
    """The outline of a surface at rest: thick away from the balls if its line spans everything, up to what is there."""
    shape, outline = surface.shape, fixed_outline(surface.shape).shape.as_polygon()
    if isinstance(shape, Circle) or shape.length == 0.0:
        return outline
    (ax, ay), (bx, by), length = shape.a, shape.b, shape.length
    tx, ty = (bx - ax) / length, (by - ay) / length
    starts = [ball.position for ball in setup.balls]
    points = [*starts, *(point for each in setup.surfaces for point in _points(each))]
    places = [((x - ax) * tx + (y - ay) * ty, (y - ay) * tx - (x - ax) * ty) for x, y in points]  # m, along and across
    fronts = [across for _, across in places[: len(starts)]]
    side = 1.0 if max(fronts) > 0.0 else -1.0
    line = [along for along, across in places if abs(across) <= SLOP]
    spans = all(min(line) <= along <= max(line) for along, _ in places)
    behind = [-side * across for along, across in places if SLOP < along < length - SLOP]
    depth = min([DEPTH, *(each for each in behind if each > SLOP)])
    if not spans or any(side * across < 0.0 for across in fronts) or depth <= 2.0 * shape.radius:
        return outline
    nx, ny = side * ty * depth, -side * tx * depth
    return Polygon(((ax, ay), (bx, by), (bx + nx, by + ny), (ax + nx, ay + ny)), shape.radius)


def _points(surface: Surface) -> list[Vector]:
    """Points that a surface reaches to, in m."""
    shape = surface.shape
    if not isinstance(shape, Circle):
        return [shape.a, shape.b]
    (x, y), r = shape.center, shape.radius
    return [(x - r, y), (x + r, y), (x, y - r), (x, y + r)]
