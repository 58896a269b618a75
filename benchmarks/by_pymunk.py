"""A shot with pymunk alone, as a user would write it: a Space, drag in ``velocity_func``, ``space.step`` in a loop.

Nothing is recorded. Unlike in many programs, ``collision_slop`` is lowered from its default, which is meant for pixels
and would let the ball sink 10 cm into the floor, and the floor is thick, or the ball would fall through. The best that
pymunk can do alone is the plain method.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import pymunk
from shots import Shot

from sandbox.engine.model.surface import Circle
from sandbox.engine.pymunk_parts import thick_outline

SLOP = 1e-5  # m


class Stepped(NamedTuple):
    """Final position of a shot in m, and its number of steps."""

    x: float
    y: float
    steps: int


def shoot(shot: Shot, rate: float) -> Stepped:
    """At ``rate`` steps per second; to the setup's duration, or to the first impact if that ends it."""
    setup, ball, law = shot.setup, shot.setup.balls[0], shot.law
    space = pymunk.Space()
    space.collision_slop = SLOP
    for surface in setup.surfaces:
        shape, outline = surface.shape, thick_outline(setup, surface)
        fixed: pymunk.Shape
        if isinstance(shape, Circle):
            fixed = pymunk.Circle(space.static_body, shape.radius, shape.center)
        elif len(outline.corners) > 2:
            fixed = pymunk.Poly(space.static_body, outline.corners, radius=outline.radius)
        else:
            fixed = pymunk.Segment(space.static_body, shape.a, shape.b, shape.radius)
        fixed.elasticity, fixed.friction, fixed.collision_type = surface.restitution, surface.friction, 2
        space.add(fixed)
    body = pymunk.Body(ball.mass, ball.inertia)
    body.position, body.velocity, body.angular_velocity = ball.position, ball.velocity, ball.spin
    disc = pymunk.Circle(body, ball.radius)
    disc.elasticity, disc.friction, disc.collision_type = 1.0, 1.0, 1
    space.add(body, disc)

    def update(body: pymunk.Body, gravity: Any, damping: float, dt: float) -> None:
        vx, vy = body.velocity
        ax, ay, alpha = law(vx, vy, body.angular_velocity)
        body.velocity = vx + dt * ax, vy + dt * ay
        body.angular_velocity += dt * alpha

    body.velocity_func = update
    over = False

    def begin(arbiter: pymunk.Arbiter, space: pymunk.Space, data: Any) -> None:
        nonlocal over
        nx, ny = arbiter.normal
        vx, vy = body.velocity
        over = over or vx * nx + vy * ny > 0.0  # the ball starts on the tee and moves away from it

    if setup.until is not None:
        space.on_collision(1, 2, begin=begin)
    steps, dt = round(setup.duration * rate), 1.0 / rate
    for step in range(steps):
        space.step(dt)
        if over:
            return Stepped(*body.position, step + 1)
    return Stepped(*body.position, steps)
