"""Motion between impacts: a ball in flight, or sliding, rolling and resting on a surface.

In flight a ball moves under its forces. In lasting contact the surface adds its normal force N, which keeps the
distance, and its friction: ``mu N`` against the slip ``v + r w`` while sliding, and what the constraint ``v = -r w``
requires while rolling, up to ``mu N``. Rolling resistance slows a rolling ball by ``c N / m``.
Both are the same integration with one more force, so a roll is as accurate as a flight.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from math import isfinite
from typing import NamedTuple

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.acting import acceleration, checked
from sandbox.engine.arc import Arc, still, through
from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball, Bounds, Patch, Surface
from sandbox.engine.step_control import LONGEST, StepControl, size, within
from sandbox.engine.surfaces import press
from sandbox.engine.touch import SIDE, Obstacle, Touching
from sandbox.errors import RunError
from sandbox.physics.integrators import INTEGRATORS, Acceleration, Law, State

#: Largest angle in rad that one arc covers around a round feature.
_LONGEST_TURN = 0.3

#: A ball that needs all the available grip still rolls.
_WITHIN_ROUNDING = 1.0 + 1e-9

_UNITS = ("m", "m", "m/s", "m/s", "rad/s")

SLIDING, ROLLING, PINNED, RESTING = "sliding", "rolling", "pinned", "resting"


class Diverged(RunError):
    """A ball's state became invalid: not finite, or outside the world."""


class LastingContact(NamedTuple):
    """What a ball is in lasting contact with, and how it moves there."""

    mode: str
    obstacle: Obstacle
    touching: Touching  # at the start of the contact: normal, curvature, feature
    direction: float = (
        0.0  # sign of the slip if sliding, of the motion along the surface if rolling, of the spin if pinned
    )
    spin_rate: float = 0.0  # rad/s^2, at which the spin of a pinned ball decays


class Mover:
    """One ball, and the integration of its motion."""

    def __init__(
        self, ball: Ball, accuracy: Accuracy, bounds: Bounds, patches: Sequence[Patch], numerics: Numerics
    ) -> None:
        self.ball = ball
        self._bounds = bounds
        self._patches = patches
        self._numerics = numerics
        self._law: Law = partial(acceleration, ball)
        self._method = INTEGRATORS[accuracy.integrator]
        self._control = StepControl(accuracy)
        self._suggested = self._control.first  # s
        self._known: tuple[State, Acceleration] = ((), (0.0, 0.0, 0.0))  # the end of the last step: the next start

    def suggest(self, step: float) -> None:
        """Use this step in s for the next attempt."""
        self._suggested = step

    # ------------------------------------------------------------------ forces

    def acceleration(self, t: float, state: State) -> Acceleration:
        """Acceleration of the ball from the applied forces, without the contact's; m/s^2, rad/s^2. Counts
        evaluations."""
        self._numerics.force_evaluations += 1
        return checked(self.ball, t, state)

    # ------------------------------------------------------------------ one piece of path

    def advance(self, t: float, until: float, state: State, contact: LastingContact | None) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``, and why it ends: "" if only because of its length.

        Raises Diverged with the time, the ball and the quantity if the state is not finite or out of bounds.
        """
        if contact is None:
            return self._integrate(t, until, state, self._law, None), ""
        if contact.mode == RESTING:
            return still(t, until, state, contact), ""
        if contact.mode == PINNED:
            return _spin_down(t, until, state, contact)
        ball = self.ball
        arc = self._integrate(
            t, until, state, lambda at, there: on_surface(ball, checked(ball, at, there), there, contact)[0], contact
        )
        return self._cut_where_contact_changes(arc, contact)

    def _integrate(self, t: float, until: float, state: State, law: Law, contact: LastingContact | None) -> Arc:
        known, acceleration = self._known
        if known is not state:
            acceleration = law(t, state)
            self._numerics.force_evaluations += 1
        wanted = self._suggested
        h = within(self._patches, min(wanted, LONGEST, until - t), state, acceleration)
        if contact is not None and contact.touching.feature != SIDE:
            # a quintic follows a circle to 1e-9 of its radius for an eighth of a turn or less
            h = min(h, _LONGEST_TURN / (contact.touching.curvature * (abs(state[2]) + abs(state[3])) + 1e-30))
        shortest = max(1e-15, 1e-15 * t)
        while True:
            after, last, error = self._method.step(law, t, state, acceleration, h)
            end_acceleration = law(t + h, after) if last is None else last
            self._numerics.steps += 1
            self._numerics.force_evaluations += self._method.evaluations
            if not isinstance(acceleration[0] + end_acceleration[0] + end_acceleration[1] + end_acceleration[2], float):
                self._method.step(
                    partial(checked, self.ball), t, state, checked(self.ball, t, state), h
                )  # raises the error, with its cause
            off = None if error is None else size(error, self.ball.radius)
            fits, following = self._control.judge(h, wanted, state, after, (acceleration, end_acceleration), off)
            if fits:
                break
            if following < shortest:
                raise self._too_short(t, h, after, end_acceleration)
            self._numerics.refined_steps += 1
            h = wanted = following
        self._suggested = following
        self._check(t + h, after)
        self._known = (after, end_acceleration)
        return through(t, h, state, acceleration, after, end_acceleration, contact)

    def _too_short(self, t: float, h: float, after: State, acceleration: Acceleration) -> Diverged:
        self._check(t + h, after)
        if not all(map(isfinite, acceleration)):
            return Diverged(
                f"t = {t + h:.6g} s, ball {self.ball.name!r}: a force or torque is not finite; check the scene's forces"
            )
        return Diverged(
            f"t = {t:.6g} s, ball {self.ball.name!r}: the velocity changes too fast for any step "
            f"(down to {h:.1e} s); look for a force that is not smooth, or raise accuracy.tolerance"
        )

    def _check(self, t: float, state: State) -> None:
        x, y, vx, vy, spin = state
        total = x + y + vx + vy + spin
        left, bottom, right, top = self._bounds
        if total - total == 0.0 and left <= x <= right and bottom <= y <= top:
            return
        for quantity, unit, value in zip(("x", "y", "vx", "vy", "spin"), _UNITS, state, strict=True):
            if not isfinite(value):
                raise Diverged(
                    f"t = {t:.6g} s, ball {self.ball.name!r}: {quantity} is {value} {unit}; "
                    "check the forces, or lower accuracy.step or accuracy.tolerance"
                )
        quantity, value, low, high = ("x", x, left, right) if not left <= x <= right else ("y", y, bottom, top)
        raise Diverged(
            f"t = {t:.6g} s, ball {self.ball.name!r}: {quantity} = {value:.6g} m is outside the world "
            f"({low:g} to {high:g} m); shorten the duration, or widen the scene's bounds"
        )

    # ------------------------------------------------------------------ lasting contact

    def _cut_where_contact_changes(self, arc: Arc, contact: LastingContact) -> tuple[Arc, str]:
        ends: list[tuple[float, str]] = []
        last = arc.state(arc.t1)
        if self._progress(arc.t1, last, contact) < 0.0:
            reason = "grip" if contact.mode == SLIDING else "stop"
            ends.append((_crossing(arc, lambda t, state: self._progress(t, state, contact)), reason))

        def held(t: float, state: State) -> tuple[Acceleration, float, float]:
            return on_surface(self.ball, self.acceleration(t, state), state, contact)

        _, normal, spare = held(arc.t1, last)
        if normal < 0.0:
            ends.append((_crossing(arc, lambda t, state: held(t, state)[1]), "leave"))
        elif spare < 0.0:
            ends.append((_crossing(arc, lambda t, state: held(t, state)[2]), "slip"))
        edge = contact.obstacle.edge(contact.touching.feature, arc)
        if edge is not None:
            ends.append((arc.t0 + edge * (arc.t1 - arc.t0), "edge"))
        if not ends:
            return arc, ""
        t, reason = min(ends)
        return arc.until(t), reason

    def _progress(self, t: float, state: State, contact: LastingContact) -> float:
        """The slip while sliding, or the speed while rolling, in m/s; positive while the motion lasts."""
        nx, ny, _ = contact.touching.normal_at(state[0], state[1])
        speed = state[2] * ny - state[3] * nx
        if contact.mode == SLIDING:
            speed += self.ball.radius * state[4]
        return contact.direction * speed


def on_surface(
    ball: Ball, applied: Acceleration, state: State, contact: LastingContact
) -> tuple[Acceleration, float, float]:
    """Acceleration in lasting contact; the normal force and the remaining grip, both divided by the mass, in
    m/s^2.

    ``applied`` is the acceleration that the ball would have in flight.
    """
    surface = contact.obstacle.surface
    nx, ny, curvature = contact.touching.normal_at(state[0], state[1])
    tx, ty = ny, -nx
    along = applied[0] * tx + applied[1] * ty
    normal = press(state, applied, nx, ny, curvature)
    pressed = max(normal, 0.0)
    if contact.mode == SLIDING:
        friction = -contact.direction * surface.friction * pressed
        a = along + friction
        alpha = applied[2] + friction / (ball.inertia_factor * ball.radius)
        spare = 0.0
    else:
        a, spare = rolling(ball, surface, along, applied[2], pressed, contact.direction)
        alpha = -a / ball.radius
    speed = state[2] * tx + state[3] * ty
    centripetal = curvature * speed * speed
    return (a * tx - centripetal * nx, a * ty - centripetal * ny, alpha), normal, spare


def rolling(
    ball: Ball, surface: Surface, along: float, turning: float, pressed: float, direction: float
) -> tuple[float, float]:
    """Acceleration in m/s^2 along the surface of a ball that rolls in ``direction``, and the remaining grip.

    ``along`` and ``pressed`` (m/s^2) are the accelerations from the applied force along the surface and onto it,
    ``turning`` (rad/s^2) that from the torque. Friction, up to ``mu N``, keeps the ball rolling and transmits the
    rolling resistance. If the remaining grip is negative, friction cannot keep the ball rolling, and it slides.
    """
    grip = surface.friction * pressed
    needed = friction_of_rolling(ball, along, turning)
    friction = needed - direction * surface.rolling_resistance * pressed
    friction = max(-grip, min(grip, friction))
    return along + friction, grip * _WITHIN_ROUNDING - abs(needed)


def friction_of_rolling(ball: Ball, along: float, turning: float) -> float:
    """Acceleration in m/s^2 that friction must add to keep a ball rolling."""
    factor = ball.inertia_factor
    return -(factor * along + factor * ball.radius * turning) / (1.0 + factor)


def _spin_down(t: float, until: float, state: State, contact: LastingContact) -> tuple[Arc, str]:
    spin = state[4]
    lasts = abs(spin) / contact.spin_rate if contact.spin_rate > 0.0 else until - t
    end = min(until, t + lasts)
    slower = spin - contact.direction * contact.spin_rate * (end - t)
    return still(t, end, state, contact, slower), "stop" if end < until else ""


def _crossing(arc: Arc, value: Callable[[float, State], float]) -> float:
    """The time at which ``value``, negative at the end of the arc, falls to zero; the start if it is never
    positive.
    """
    low, high = arc.t0, arc.t1
    at_low, at_high = value(low, arc.start), value(high, arc.state(high))
    if at_low <= 0.0:  # it may start at zero, as slip does when a rolling ball loses its grip
        for halvings in range(1, 40):
            low = arc.t0 + (high - arc.t0) * 0.5**halvings
            at_low = value(low, arc.state(low))
            if at_low > 0.0:
                break
        else:
            return arc.t0
    last, kept = low, 0  # which end was replaced last
    for _ in range(60):  # regula falsi with the Illinois weights
        t = low + (high - low) * at_low / (at_low - at_high)
        if not low < t < high:
            t = 0.5 * (low + high)
            if not low < t < high:
                break
        here = value(t, arc.state(t))
        if here == 0.0 or abs(t - last) <= 1e-15 * (1.0 + t):
            return t
        last = t
        if here > 0.0:
            low, at_low = t, here
            if kept == 1:
                at_high *= 0.5
            kept = 1
        else:
            high, at_high = t, here
            if kept == -1:
                at_low *= 0.5
            kept = -1
    return high
