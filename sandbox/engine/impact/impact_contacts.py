"""One contact in an impact: its direction, speeds and bounce, and what two bodies do after it alone."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from sandbox.engine.contact.manifold import ContactManifold, all_round, farthest, speeds_at
from sandbox.engine.contact.surfaces import (
    after_impulses,
    bounce_of_balls,
    bounce_off,
    speeds_where_touching,
    tilted,
)
from sandbox.engine.impact.impulses import ImpactContact, after_contact_of_bodies, disc_on_ground
from sandbox.engine.kernel.flight import after_impact
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, Surface
from sandbox.engine.model.tolerances import CLOSING
from sandbox.physics.cushion import nose_sine
from sandbox.physics.integrators import State


def contact_with_surface(
    index: int, ball: Ball, state: State, surface: Surface, found: ContactManifold, number: int
) -> ImpactContact:
    """The contact at one of the points where they meet; what depends on the speed along takes that of the centre."""
    (nx, ny), point, sine = found.normal, found.points[number], 0.0
    approach, along = found.speeds[number][0], state[2] * ny - state[3] * nx
    bounce = bounce_off(surface, approach, along)
    if bounce.tilt != 0.0:
        nx, ny = tilted(nx, ny, bounce.tilt, along)
        point = farthest(ball, state, (nx, ny)) if len(found.points) == 1 else point
    if not ball.rotates:
        sine = 0.0 if surface.nose_height is None else nose_sine(ball.radius, surface.nose_height)
        speeds = speeds_where_touching([ball], [state], nx, ny, sine)
    else:
        bounce = _without_pull(bounce, approach)
        speeds = speeds_at((state,), point, (nx, ny))
    return ImpactContact((index,), surface.name, nx, ny, sine, bounce, approach, speeds, point, kick=surface.kick)


def contact_of_two(
    indices: tuple[int, int], balls: Sequence[Ball], setup: Setup, found: ContactManifold, number: int
) -> ImpactContact:
    """The contact of two balls or bodies at one of the points where they meet."""
    (a, b), speeds = balls, found.speeds[number]
    bounce = bounce_of_balls(setup, speeds[0], hypot(*speeds[1:]), a.name, b.name)
    bounce = bounce if all_round(a, b) else _without_pull(bounce, speeds[0])
    return ImpactContact(indices, b.name, *found.normal, 0.0, bounce, speeds[0], speeds, found.points[number])


def after_single_contact(balls: Sequence[Ball], states: Sequence[State], contact: ImpactContact) -> list[State]:
    """The states of one or two after a single contact: of balls in units of the reduced mass; friction acts against the
    whole slip."""
    if not all_round(*balls):
        return list(after_contact_of_bodies(balls, dict(enumerate(states)), contact, contact.bounce)[0].values())
    approach, along, upward = contact.speeds
    if len(balls) == 1 and upward == 0.0:
        (ball,), (state,), (nx, ny) = balls, states, (contact.nx, contact.ny)
        exchange = disc_on_ground().exchange
        motion = after_impact(state[2:], nx, ny, ball, (approach, along), contact.bounce, exchange, contact.sine)
        return [(*state[:2], *motion)]
    mobility = sum([1.0 / ball.mass for ball in balls])  # 1/kg
    turning = sum([1.0 / (ball.mass * ball.inertia_factor) for ball in balls])
    slip = hypot(along, upward)
    restitution, friction, _, tangential = contact.bounce
    wanted = (1.0 + tangential) * slip  # ending that much slip is reversing a share of what there is
    push, rub = disc_on_ground().exchange(approach, wanted, mobility / turning, restitution, friction)
    share = rub / (slip * mobility) if slip > 0.0 else 0.0
    impulse = push / mobility, share * along, share * upward
    return after_impulses(balls, states, contact.nx, contact.ny, impulse, contact.sine)


def _without_pull(bounce: Bounce, approach: float) -> Bounce:
    """The bounce, without restitution where a point of contact does not close: it may be pressed on, not pulled."""
    return bounce if approach > CLOSING else bounce._replace(restitution=0.0)
