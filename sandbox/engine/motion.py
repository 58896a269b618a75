"""Motion between impacts: a ball in flight, or sliding, rolling and resting on a surface.

In flight a ball moves under its forces. In lasting contact the surface adds its normal force N, which keeps the
distance, and its friction: while sliding ``mu N`` against the slip ``v + r w``, while rolling what the constraint ``v
= -r w`` asks for, as long as that is no more than ``mu N``. Rolling resistance slows a rolling ball by ``c N / m``.
Both are the same integration with one more force, so a roll is as accurate as a flight.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import isfinite
from typing import Any, NamedTuple

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.arc import Arc, still, through
from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball, Bounds, Patch, Surface
from sandbox.engine.touch import Obstacle, Touching
from sandbox.errors import RunError
from sandbox.physics.integrators import INTEGRATORS, Acceleration, Law, State

#: Local error of a step over the error aimed at in the end. Each impact on a round shape multiplies an error by ten
#: or more, so the flight has to be much better than the promise; this keeps it on shots with several rim contacts.
LOCAL_SHARE = 3e-4

#: What error in spin counts as error in m: a spin's error moves the ball only through lift and the next bounce.
SPIN_WEIGHT = 0.1  # s

#: First step tried under error control; it shrinks by 5 until the error fits.
FIRST_STEP = 0.05  # s

#: Longest step, so that forces which change along the way are met several times a second.
LONGEST = 0.5  # s

#: Longest turn in rad that one arc makes around a round feature.
_LONGEST_TURN = 0.3

#: Largest product of a fixed step and the forces' rate of change with velocity (1/s). Explicit steps are smooth below
#: 1 and unstable above 2, where drag reverses the motion; the drag of water on a bullet is the case that needs the
#: limit.
STIFFEST = 0.5

#: Changes of velocity below this share of the speed are no sign of stiffness: a force may jump.
JUMP = 0.01

#: A ball that needs all the grip there is still rolls.
_WITHIN_ROUNDING = 1.0 + 1e-9

_UNITS = ("m", "m", "m/s", "m/s", "rad/s")

SLIDING, ROLLING, PINNED, RESTING = "sliding", "rolling", "pinned", "resting"


class Diverged(RunError):
    """A ball's state stopped making sense."""


class Contact(NamedTuple):
    """What a ball is in lasting contact with, and how it moves there."""

    mode: str
    obstacle: Obstacle
    touching: Touching  # where the contact began: normal, curvature, feature
    direction: float = 0.0  # sign of: the slip if sliding, the motion along the surface if rolling, the spin if pinned
    spin_rate: float = 0.0  # rad/s^2, how fast the spin of a pinned ball dies


class Mover:
    """One ball and everything that moves it."""

    def __init__(
        self, ball: Ball, accuracy: Accuracy, bounds: Bounds, patches: Sequence[Patch], numerics: Numerics
    ) -> None:
        self.ball = ball
        self._inertia = ball.inertia
        self._bounds = bounds
        self._patches = patches
        self._numerics = numerics
        self._integrator = INTEGRATORS[accuracy.integrator]
        self._step = accuracy.step  # s
        self._local_error = accuracy.tolerance * LOCAL_SHARE  # m
        self._suggested = FIRST_STEP if self._integrator.controls_error else accuracy.step  # s

        self._known: tuple[State, Acceleration] = ((), (0.0, 0.0, 0.0))  # the end of the last step: the next start

    def suggest(self, step: float) -> None:
        """Try this step in s next."""
        self._suggested = step

    # ------------------------------------------------------------------ forces

    def force(self, t: float, state: State) -> tuple[float, float, float]:
        """Applied force in N and torque in N m, without the contact's own."""
        x, y, vx, vy, spin = state
        self._numerics.force_evaluations += 1
        position = (x, y)
        velocity = (vx, vy)
        fx = fy = torque = 0.0
        cause: object = None
        try:
            for cause in self.ball.forces:
                px, py = cause(t, position, velocity, spin)
                fx += px
                fy += py
            for cause in self.ball.torques:
                torque += cause(t, position, velocity, spin)
            if not isinstance(fx + fy + torque, float):
                raise not_a_number(self.ball, t, position, velocity, spin)
        except (TypeError, ValueError, OverflowError) as error:
            raise misused(cause, error) from None
        return fx, fy, torque

    def _in_flight(self, t: float, state: State) -> Acceleration:
        fx, fy, torque = self.force(t, state)
        mass = self.ball.mass
        return fx / mass, fy / mass, torque / self._inertia

    def on_surface(self, t: float, state: State, contact: Contact) -> tuple[Acceleration, float, float]:
        """Acceleration in lasting contact, the normal force in N, and the grip still to spare in N."""
        fx, fy, torque = self.force(t, state)
        mass, radius, surface = self.ball.mass, self.ball.radius, contact.obstacle.surface
        nx, ny, curvature = contact.touching.normal_at(state[0], state[1])
        tx, ty = ny, -nx
        speed = state[2] * tx + state[3] * ty
        centripetal = curvature * speed * speed
        along = fx * tx + fy * ty
        normal = -(fx * nx + fy * ny) - mass * centripetal
        pressed = max(normal, 0.0)
        if contact.mode == SLIDING:
            friction = -contact.direction * surface.friction * pressed
            a = (along + friction) / mass
            alpha = (torque + radius * friction) / self._inertia
            spare = 0.0
        else:
            a, spare = rolling(self.ball, surface, along, torque, pressed, contact.direction)
            alpha = -a / radius
        return (a * tx - centripetal * nx, a * ty - centripetal * ny, alpha), normal, spare

    # ------------------------------------------------------------------ one piece of path

    def advance(self, t: float, until: float, state: State, contact: Contact | None) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``, and why it ends: "" for no reason but its length.

        Raises Diverged if the state is not finite or out of bounds, with the time, the ball and the quantity.
        """
        if contact is None:
            return self._integrate(t, until, state, self._in_flight, None), ""
        if contact.mode == RESTING:
            return still(t, until, state, contact), ""
        if contact.mode == PINNED:
            return _spin_down(t, until, state, contact)
        arc = self._integrate(t, until, state, lambda at, there: self.on_surface(at, there, contact)[0], contact)
        return self._cut_where_contact_changes(arc, contact)

    def _integrate(self, t: float, until: float, state: State, law: Law, contact: Contact | None) -> Arc:
        known, acceleration = self._known
        if known is not state:
            acceleration = law(t, state)
        step = self._integrator.step
        wanted = self._suggested
        h = min(wanted, LONGEST, until - t)
        for patch in self._patches:
            h = _halved_for(patch, h, state, acceleration)
        if contact is not None and contact.touching.center is not None:
            # around a round feature a quintic follows the circle to 1e-9 of its radius for an eighth of a turn or less
            h = min(h, _LONGEST_TURN / (contact.touching.curvature * (abs(state[2]) + abs(state[3])) + 1e-30))
        shortest = max(1e-15, 1e-15 * t)
        while True:
            after, last, error = step(law, t, state, acceleration, h)
            end_acceleration = law(t + h, after) if last is None else last
            self._numerics.steps += 1
            if error is not None:
                off = self._size(error)
                if off <= self._local_error:
                    longer = h * min(5.0, 0.9 * (self._local_error / off) ** 0.2 if off > 0.0 else 5.0)
                    self._suggested = longer if h >= wanted else max(longer, wanted)
                    break
                shorter = h * max(0.2, 0.9 * (self._local_error / off) ** 0.2) if isfinite(off) else 0.1 * h
            else:
                if not _stiff(state, after, acceleration, end_acceleration, h):
                    self._suggested = min(2.0 * h, self._step) if h >= wanted else wanted
                    break
                shorter = 0.5 * h
            if shorter < shortest:
                self._check(t + h, after)
                if not all(map(isfinite, end_acceleration)):
                    raise Diverged(
                        f"t = {t + h:.6g} s, ball {self.ball.name!r}: a force or torque is not finite; "
                        "check the scene's forces"
                    )
                raise Diverged(
                    f"t = {t:.6g} s, ball {self.ball.name!r}: the velocity changes too fast for any step "
                    f"(down to {h:.1e} s); look for a force that is not smooth, or raise accuracy.tolerance"
                )
            self._numerics.refined_steps += 1
            h = wanted = shorter
        self._check(t + h, after)
        self._known = (after, end_acceleration)
        return through(t, h, state, acceleration, after, end_acceleration, contact)

    def _size(self, error: State) -> float:
        """Local error in m: that of the position, and what that of the velocity makes of it in a second."""
        ex, ey, evx, evy, spin = error
        off = abs(ex) + abs(ey) + abs(evx) + abs(evy) + SPIN_WEIGHT * self.ball.radius * abs(spin)
        return off if isfinite(off) else float("inf")

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

    def _cut_where_contact_changes(self, arc: Arc, contact: Contact) -> tuple[Arc, str]:
        ends: list[tuple[float, str]] = []
        last = arc.state(arc.t1)
        if self._progress(arc.t1, last, contact) < 0.0:
            reason = "grip" if contact.mode == SLIDING else "stop"
            ends.append((_crossing(arc, lambda t, state: self._progress(t, state, contact)), reason))
        _, normal, spare = self.on_surface(arc.t1, last, contact)
        if normal < 0.0:
            ends.append((_crossing(arc, lambda t, state: self.on_surface(t, state, contact)[1]), "leave"))
        elif spare < 0.0:
            ends.append((_crossing(arc, lambda t, state: self.on_surface(t, state, contact)[2]), "slip"))
        edge = contact.obstacle.edge(contact.touching.feature, arc)
        if edge is not None:
            ends.append((arc.t0 + edge * (arc.t1 - arc.t0), "edge"))
        if not ends:
            return arc, ""
        t, reason = min(ends)
        return arc.until(t), reason

    def _progress(self, t: float, state: State, contact: Contact) -> float:
        """Sliding: the slip; rolling: the speed; in m/s and positive while it goes on."""
        nx, ny, _ = contact.touching.normal_at(state[0], state[1])
        speed = state[2] * ny - state[3] * nx
        if contact.mode == SLIDING:
            speed += self.ball.radius * state[4]
        return contact.direction * speed


def misused(cause: object, error: Exception) -> Exception:
    """What to raise where calling a force or torque, or adding what it returned, failed: an error from inside it
    as it is, else one that says how it is called.
    """
    inside = error.__traceback__ is not None and error.__traceback__.tb_next is not None
    return error if inside else RunError(f"{_rule(cause)}: {error}")


def not_a_number(ball: Ball, t: float, position: Any, velocity: Any, spin: float) -> RunError:
    """What to raise where the forces and torques on a ball do not add up to real numbers."""
    for cause in (*ball.forces, *ball.torques):
        found = cause(t, position, velocity, spin)
        parts = found if isinstance(found, tuple | list) else (found,)
        if not all(isinstance(part, int | float) for part in parts):
            returned = " ".join(repr(found).split())
            return RunError(f"t = {t:.6g} s, ball {ball.name!r}: {_rule(cause)}, and returned {returned:.60}")
    return RunError(f"t = {t:.6g} s, ball {ball.name!r}: the sum of its forces and torques is not a real number")


def _rule(cause: object) -> str:
    """How a force or torque is called, for a sentence."""
    name = getattr(cause, "__name__", type(cause).__name__)
    return (
        f"{name} is called with (t, position, velocity, spin) and must return (fx, fy) in N, a torque one number in N m"
    )


def rolling(
    ball: Ball, surface: Surface, along: float, torque: float, pressed: float, direction: float
) -> tuple[float, float]:
    """Acceleration in m/s^2 along the surface of a ball that rolls in ``direction``, and the grip to spare in N.

    Friction turns the ball as fast as it moves and passes on the rolling resistance, as far as ``mu N`` reaches;
    less than nothing to spare means that it cannot even do the first, and the ball slides.
    """
    grip = surface.friction * pressed
    turning = (along - torque / ball.radius) / (1.0 + ball.inertia_factor) - along
    friction = turning - direction * surface.rolling_resistance * pressed
    friction = max(-grip, min(grip, friction))
    return (along + friction) / ball.mass, grip * _WITHIN_ROUNDING - abs(turning)


def _spin_down(t: float, until: float, state: State, contact: Contact) -> tuple[Arc, str]:
    spin = state[4]
    lasts = abs(spin) / contact.spin_rate if contact.spin_rate > 0.0 else until - t
    end = min(until, t + lasts)
    slower = spin - contact.direction * contact.spin_rate * (end - t)
    return still(t, end, state, contact, slower), "stop" if end < until else ""


def _crossing(arc: Arc, value: Callable[[float, State], float]) -> float:
    """The time at which ``value``, negative at the end of the arc, comes to zero from above; the start if it is
    nowhere positive.
    """
    low, high = arc.t0, arc.t1
    at_low, at_high = value(low, arc.start), value(high, arc.state(high))
    if at_low <= 0.0:  # perhaps it only begins at zero, as slip does where a rolling ball loses its grip
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


def _halved_for(patch: Patch, h: float, state: State, acceleration: Acceleration) -> float:
    """A step that stops short of the patch, or is no longer than it asks for."""
    x, y, vx, vy, _ = state
    ax, ay, _ = acceleration
    while h > patch.step:
        half = 0.5 * h
        xs = (x, x + half * vx, x + h * (vx + half * ax))  # control points of the parabola ahead
        ys = (y, y + half * vy, y + h * (vy + half * ay))
        if not patch.crossed(xs, ys):
            return h
        h = max(half, patch.step)
    return h


def _stiff(before: State, after: State, acceleration: Acceleration, following: Acceleration, h: float) -> bool:
    """Whether a fixed step is too long for forces that depend on velocity, judged by how they changed over the step."""
    change = h * (abs(following[0] - acceleration[0]) + abs(following[1] - acceleration[1]))
    gain = abs(after[2] - before[2]) + abs(after[3] - before[3])
    speed = max(abs(before[2]) + abs(before[3]), abs(after[2]) + abs(after[3]))
    return not (change <= STIFFEST * gain or change <= JUMP * speed)
