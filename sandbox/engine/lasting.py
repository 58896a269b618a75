"""What follows a touch: flight, or lasting contact (sliding, rolling, wedged or at rest)."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

from sandbox.engine.arc import Arc
from sandbox.engine.motion import (
    PINNED,
    RESTING,
    ROLLING,
    SLIDING,
    LastingContact,
    Mover,
    friction_of_rolling,
    on_surface,
    rolling,
)
from sandbox.engine.setup import Ball
from sandbox.engine.surfaces import leaves_at, press
from sandbox.engine.touch import SIDE, Obstacle, Touching
from sandbox.engine.track import Near, Track
from sandbox.physics.integrators import Acceleration, State

#: Speed in m/s and acceleration in m/s^2 below which a value is rounding.
_STILL = 1e-10

#: Fraction of the applied force below which a normal force is rounding, as when a ball has just left a round top.
_PRESSING = 1e-9

#: Normals closer than this (sine of the angle) count as one: two flush surfaces.
_FLUSH = 1e-7


class InPlane(Mover):
    """A ball that flies in the plane of the picture, and slides, rolls and rests on the surfaces there."""

    def settle(self, t: float, state: State, track: Track, height: float) -> tuple[State, LastingContact | None]:
        """The state from which the ball continues, and its lasting contact, or None for flight.

        A ball stays on a surface if it is pressed on it and would not bounce higher than ``height`` (m). A lower
        bounce is removed from the state, as is the overlap, of at most TOUCHING_GAP, at which the surface was found.
        """
        near = track.near(*state[:2])
        if not near:
            return state, None
        applied = self.acceleration(t, state)
        kept, hardest = _stays_on(near, state, applied, height)
        if not kept:
            return state, None
        x, y, vx, vy, spin = state
        first = min(kept, key=lambda near: vx * near[1].nx + vy * near[1].ny)[1]
        together = [(obstacle, touching) for obstacle, touching in kept if _sine(touching, first) <= _FLUSH]
        if len(together) < len(kept) and hypot(vx, vy) <= leaves_at(hardest, height):
            vx = vy = 0.0  # held in two directions
        else:  # along the surface that the ball leaves most slowly; it may leave the others, but not enter them
            kept = together
            for _, touching in kept:
                leaving = vx * touching.nx + vy * touching.ny
                vx -= leaving * touching.nx
                vy -= leaving * touching.ny
            if any(vx * other.nx + vy * other.ny < -_STILL and _sine(other, first) > _FLUSH for _, other in near):
                return state, None
        state = (x, y, vx, vy, spin)

        held: list[LastingContact] = []
        for obstacle, touching in kept:
            mx, my = (vx, vy) if vx or vy else applied[:2]  # direction in which it will move
            place = obstacle.next_feature(touching, x, y, mx, my)
            contact = _contact_on(self.ball, state, obstacle, place, applied)
            if contact is None:
                continue
            held.append(contact)
        held.sort(key=lambda contact: contact.touching.curvature)  # the next piece's side before this one's corner
        for contact in held:
            (ax, ay, _), _, _ = on_surface(self.ball, applied, state, contact)
            if contact.mode == RESTING:
                ax = ay = 0.0
            if all(
                ax * other.nx + ay * other.ny >= -1e-9 or _sine(other, contact.touching) <= _FLUSH for _, other in kept
            ):
                return _placed_on(self.ball, state, contact), contact
        if not held:
            return state, None
        return _wedged(self.ball, state, kept, held, applied)

    def conclude(self, state: State, contact: LastingContact | None, reason: str) -> State:
        """The state at the end of an arc: moved back exactly onto a round surface, which the arc follows only closely;
        exactly rolling, or exactly at rest, if that is why the arc ended."""
        if contact is None:
            return state
        x, y, vx, vy, spin = state
        nx, ny, _ = contact.touching.normal_at(x, y)
        if contact.touching.feature != SIDE and contact.mode in (SLIDING, ROLLING):
            x = contact.touching.center[0] + contact.obstacle.outline.reach * nx
            y = contact.touching.center[1] + contact.obstacle.outline.reach * ny
            leaving = vx * nx + vy * ny
            vx -= leaving * nx
            vy -= leaving * ny
        if reason == "grip":
            spin = -(vx * ny - vy * nx) / self.ball.radius
        if reason == "stop":
            vx = vy = spin = 0.0
        return x, y, vx, vy, spin

    def rests(self, arc: Arc) -> bool:
        """Whether the ball is at rest on this arc."""
        return isinstance(arc.contact, LastingContact) and arc.contact.mode == RESTING


def _stays_on(near: Sequence[Near], state: State, applied: Acceleration, height: float) -> tuple[list[Near], float]:
    """The surfaces off which a ball would bounce no higher than ``height`` or than their own lowest bounce, and
    the largest pressing acceleration (m/s^2) on one of them."""
    kept, hardest = [], 0.0
    for obstacle, touching in near:
        pressed = press(state, applied, touching.nx, touching.ny, touching.curvature)
        away = state[2] * touching.nx + state[3] * touching.ny
        if away <= leaves_at(pressed, max(height, obstacle.surface.lowest_bounce)):
            kept.append((obstacle, touching))
            hardest = max(hardest, pressed)
    return kept, hardest


def _contact_on(
    ball: Ball, state: State, obstacle: Obstacle, touching: Touching, applied: Acceleration
) -> LastingContact | None:
    """Sliding, rolling or resting on one surface; None if nothing presses the ball on."""
    _, _, vx, vy, spin = state
    ax, ay, turning = applied
    nx, ny = touching.nx, touching.ny
    pressed = press(state, applied, nx, ny, touching.curvature)
    if pressed <= _PRESSING * (abs(ax) + abs(ay)):
        return None
    speed = vx * ny - vy * nx
    slip = speed + ball.radius * spin
    if abs(slip) > _STILL * (1.0 + abs(speed)):
        return LastingContact(SLIDING, obstacle, touching, 1.0 if slip > 0.0 else -1.0)
    along = ax * ny - ay * nx
    moves = abs(speed) > _STILL
    drive = speed if moves else along - ball.inertia_factor * ball.radius * turning
    direction = 1.0 if drive > 0.0 else -1.0
    a, spare = rolling(ball, obstacle.surface, along, turning, pressed, direction)
    needed = friction_of_rolling(ball, along, turning)
    if spare < 0.0 or (spare == 0.0 and needed != 0.0):
        return LastingContact(SLIDING, obstacle, touching, 1.0 if needed < 0.0 else -1.0)
    if not moves and direction * a <= _STILL:
        return LastingContact(RESTING, obstacle, touching)
    return LastingContact(ROLLING, obstacle, touching, direction)


def _placed_on(ball: Ball, state: State, contact: LastingContact) -> State:
    """The state moved exactly onto the surface, and made exactly rolling or at rest if it is."""
    x, y, vx, vy, spin = state
    nx, ny = contact.touching.nx, contact.touching.ny
    gap = contact.obstacle.gap(contact.touching, x, y)
    x -= gap * nx
    y -= gap * ny
    if contact.mode == RESTING:
        return x, y, 0.0, 0.0, 0.0
    if contact.mode == ROLLING:
        spin = -(vx * ny - vy * nx) / ball.radius
    return x, y, vx, vy, spin


def _wedged(
    ball: Ball, state: State, kept: Sequence[Near], held: Sequence[LastingContact], applied: Acceleration
) -> tuple[State, LastingContact]:
    """Held by two surfaces at once: the position is fixed, and friction on both slows the spin.

    The two normal forces balance only the applied force; the effect of friction on them is ignored.
    """
    first = held[0]
    others = [near for near in kept if _sine(near[1], first.touching) > _FLUSH]
    obstacle, second = others[0]
    a, b = first.touching, second
    ax, ay, _ = applied
    determinant = a.nx * b.ny - a.ny * b.nx
    on_first = max(0.0, (-ax * b.ny + ay * b.nx) / determinant)
    on_second = max(0.0, (-ay * a.nx + ax * a.ny) / determinant)
    friction = first.obstacle.surface.friction * on_first + obstacle.surface.friction * on_second
    x, y, _, _, spin = state
    for place, touching in ((first.obstacle, a), (obstacle, second)):
        gap = place.gap(touching, x, y)
        x -= gap * touching.nx
        y -= gap * touching.ny
    still = (x, y, 0.0, 0.0, spin)
    if abs(spin) <= _STILL:
        return (x, y, 0.0, 0.0, 0.0), LastingContact(RESTING, first.obstacle, a)
    rate = friction / (ball.inertia_factor * ball.radius)
    return still, LastingContact(PINNED, first.obstacle, a, 1.0 if spin > 0.0 else -1.0, rate)


def _sine(a: Touching, b: Touching) -> float:
    """Sine of the angle between two normals; 2 where they face each other."""
    if a.nx * b.nx + a.ny * b.ny < 0.0:
        return 2.0
    return abs(a.nx * b.ny - a.ny * b.nx)
