"""Sustained contact: a ball that slides, rolls or rests on a surface, or is wedged between two.

The surface adds its normal force N, which keeps the distance, and its friction: ``mu N`` against the slip ``v + r w``
while sliding, and what the constraint ``v = -r w`` requires while rolling, up to ``mu N``. Rolling resistance slows a
rolling ball by ``c N / m``. A wedged ball stays in place, and friction on both surfaces slows its spin.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

from sandbox.engine.contact.surfaces import press
from sandbox.engine.contact.touch import SIDE, Obstacle, Touching
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Surface
from sandbox.engine.model.tolerances import ROUNDING, STILL, TINY
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.phase import Phase
from sandbox.physics.elementwise import clip, where
from sandbox.physics.integrators import Acceleration, State

#: The phase that follows where slip or speed has fallen to zero.
BECOMES = {Phase.SLIDING: Phase.ROLLING, Phase.ROLLING: Phase.RESTING, Phase.PINNED: Phase.RESTING}

#: Largest angle in rad that one arc covers around a round feature: a quintic follows a circle to 1e-9 of its radius
#: for an eighth of a turn or less.
_LONGEST_TURN = 0.3


class SustainedContact(NamedTuple):
    """A ball's sustained contact with a surface, and how it moves there; or many balls that move alike on straight
    sides, with arrays for numbers."""

    phase: Phase
    obstacle: Obstacle
    touching: Touching  # at the start of the contact: normal, curvature, feature
    direction: Any = 0.0  # sign of the slip if sliding, of the motion if rolling, of the spin if pinned
    spin_rate: float = 0.0  # rad/s^2, at which the spin of a pinned ball decays

    @property
    def surface(self) -> Surface:
        return self.obstacle.surface

    @property
    def span(self) -> None:
        return None

    @property
    def drift(self) -> Vector:
        return 0.0, 0.0

    def longest(self, state: State) -> float:
        """The longest step in s."""
        if self.touching.feature == SIDE:
            return inf
        return _LONGEST_TURN / (self.touching.curvature * (abs(state[2]) + abs(state[3])) + TINY)

    def progress(self, ball: Ball, state: State) -> Any:
        """Return the slip or speed in m/s, or the spin of a wedged ball in rad/s, whose fall to zero ends this
        motion."""
        _, _, vx, vy, spin = state
        if self.phase is Phase.PINNED:
            return self.direction * spin
        nx, ny, _ = self.touching.normal_at(state[0], state[1])
        speed = vx * ny - vy * nx
        return self.direction * (speed + ball.radius * spin if self.phase is Phase.SLIDING else speed)

    def forces(self, ball: Ball, applied: Acceleration, state: State) -> tuple[Acceleration, Any, Any]:
        """Acceleration in contact; the normal force and the remaining grip, both divided by the mass, in m/s^2.

        ``applied`` is the acceleration that the ball would have in flight.
        """
        if self.phase in (Phase.PINNED, Phase.RESTING):
            return (0.0, 0.0, -self.direction * self.spin_rate), inf, inf
        surface = self.obstacle.surface
        nx, ny, curvature = self.touching.normal_at(state[0], state[1])
        tx, ty = ny, -nx
        along = applied[0] * tx + applied[1] * ty
        normal = press(state, applied, nx, ny, curvature)
        pressed = where(normal > 0.0, normal, 0.0)
        if self.phase is Phase.SLIDING:
            friction = -self.direction * surface.friction * pressed
            a = along + friction
            alpha = applied[2] + friction / (ball.inertia_factor * ball.radius)
            grip_margin = 0.0
        else:
            a, grip_margin, _ = _rolling(ball, surface, along, applied[2], pressed, self.direction)
            alpha = -a / ball.radius
        speed = state[2] * tx + state[3] * ty
        centripetal = curvature * speed * speed
        return (a * tx - centripetal * nx, a * ty - centripetal * ny, alpha), normal, grip_margin

    def edge(self, ball: Ball, arc: Arc) -> float | None:
        """The time in s at which the ball reaches the end of what it is on, or None."""
        u = self.obstacle.edge(self.touching.feature, arc)
        return None if u is None else arc.t0 + u * (arc.t1 - arc.t0)

    def projected_onto_surface(self, ball: Ball, state: State) -> State:
        """The state exactly on the surface, without speed away from it; exactly rolling or at rest if the ball is."""
        x, y, vx, vy, spin = state
        gap, nx, ny = self.obstacle.on_feature(self.touching.feature, x, y)[:3]
        leaving = vx * nx + vy * ny
        x, y, vx, vy = x - gap * nx, y - gap * ny, vx - leaving * nx, vy - leaving * ny
        if self.phase is Phase.RESTING:
            return x, y, 0.0, 0.0, 0.0
        if self.phase is Phase.ROLLING:
            spin = -(vx * ny - vy * nx) / ball.radius
        return x, y, vx, vy, spin


def motion_on(
    ball: Ball, state: State, surface: Surface, touching: Touching, applied: Acceleration, slips: bool = False
) -> tuple[Any, Any]:
    """Return the phase of a ball on one surface, FREE if nothing presses it on, and the direction of its motion.

    One that ``slips`` has just lost its grip, whatever rounding says.
    """
    _, _, vx, vy, spin = state
    ax, ay, turning = applied
    nx, ny = touching.nx, touching.ny
    pressed = press(state, applied, nx, ny, touching.curvature)
    speed = vx * ny - vy * nx
    slip = speed + ball.radius * spin
    along = ax * ny - ay * nx
    stands = abs(speed) <= STILL
    drive = where(stands, along - ball.inertia_factor * ball.radius * turning, speed)
    direction = where(drive > 0.0, 1.0, -1.0)
    a, grip_margin, needed = _rolling(ball, surface, along, turning, pressed, direction)
    slides = abs(slip) > STILL * (1.0 + abs(speed))
    lost = (grip_margin < 0.0) | ((grip_margin == 0.0) & (needed != 0.0)) | slips
    rests = stands & (direction * a <= STILL)
    phase = where(slides | lost, Phase.SLIDING, where(rests, Phase.RESTING, Phase.ROLLING))
    direction = where(slides, where(slip > 0.0, 1.0, -1.0), where(lost, where(needed < 0.0, 1.0, -1.0), direction))
    return where(pressed > ROUNDING * (abs(ax) + abs(ay)), phase, Phase.FREE), direction


def rest_margin(ball: Ball, state: State, contact: SustainedContact, applied: Acceleration) -> float:
    """More than 0 in m/s^2 while a ball that rests is pressed on and neither rolls nor slides, as ``motion_on``
    says."""
    (ax, ay, turning), (_, nx, ny, *_) = applied, contact.touching
    pressed, along = press(state, applied, nx, ny, 0.0), ax * ny - ay * nx
    direction = 1.0 if along - ball.inertia_factor * ball.radius * turning > 0.0 else -1.0
    a, grip_margin, needed = _rolling(ball, contact.obstacle.surface, along, turning, pressed, direction)
    held = STILL - direction * a
    return float(min(pressed, held if needed == 0.0 else min(held, grip_margin)))


def wedged(
    ball: Ball, spin: float, first: tuple[Obstacle, Touching], second: tuple[Obstacle, Touching], applied: Acceleration
) -> SustainedContact:
    """Held by two surfaces at once. The two normal forces balance only the applied force; the effect of friction on
    them is ignored."""
    (obstacle, a), (other, b), (ax, ay, _) = first, second, applied
    determinant = a.nx * b.ny - a.ny * b.nx
    on_first = max(0.0, (-ax * b.ny + ay * b.nx) / determinant)
    on_second = max(0.0, (-ay * a.nx + ax * a.ny) / determinant)
    if abs(spin) <= STILL:
        return SustainedContact(Phase.RESTING, obstacle, a)
    friction = obstacle.surface.friction * on_first + other.surface.friction * on_second
    rate = friction / (ball.inertia_factor * ball.radius)
    return SustainedContact(Phase.PINNED, obstacle, a, 1.0 if spin > 0.0 else -1.0, rate)


def _rolling(
    ball: Ball, surface: Surface, along: Any, turning: Any, pressed: Any, direction: Any
) -> tuple[Any, Any, Any]:
    """Return, in m/s^2, for a ball that rolls in ``direction``: the acceleration along the surface, the remaining grip,
    and what friction must add to keep it rolling without resistance.

    ``along`` and ``pressed`` (m/s^2) are the accelerations from the applied force along the surface and onto it,
    ``turning`` (rad/s^2) that from the torque. Friction, up to ``mu N``, keeps the ball rolling and transmits the
    rolling resistance. If the remaining grip is negative, friction cannot keep the ball rolling, and it slides.
    """
    grip, factor = surface.friction * pressed, ball.inertia_factor
    needed = -(factor * along + factor * ball.radius * turning) / (1.0 + factor)
    friction = needed - direction * surface.rolling_resistance * pressed
    friction = clip(friction, -grip, grip)
    return along + friction, grip * (1.0 + ROUNDING) - abs(needed), needed
