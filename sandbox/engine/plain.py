"""The plain method: stock pymunk at a fixed step, forces in ``velocity_func``. The baseline for comparison.

Chipmunk moves bodies first, then finds contacts, updates velocities and applies impulses: so a contact is found up to
one step late, at whatever depth that step gives, and forces are integrated to first order. Nothing here improves on
that, but errors are reported: cffi prints and swallows what a callback raises, so it is stored and raised after the
step, and a ball that passes through a surface within a step is an error. The friction of a plane acts in
``velocity_func`` too. A contact that takes more than restitution and friction in the plane is solved as by the exact
method, in Chipmunk's place and with its normal: a cushion's nose, friction upward, turf that tilts or returns slip.
"""

from __future__ import annotations

from collections.abc import Callable
from math import dist
from time import perf_counter
from typing import Any

import pymunk

from sandbox.engine.contact.manifold import meeting_at
from sandbox.engine.contact.surfaces import press, takeoff_speed
from sandbox.engine.contact.touch import Outline
from sandbox.engine.heap.pymunk_world import PymunkWorld, rolls, speeds_at
from sandbox.engine.impact.impact_contacts import after_single_contact, contact_of_two, contact_with_surface
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import failed
from sandbox.engine.model.shapes import Ellipse
from sandbox.engine.model.surface import Surface
from sandbox.engine.motion.forces_on_ball import acceleration_function, force_error
from sandbox.engine.motion.step_control import JUMP, stiff
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.path import Path
from sandbox.engine.paths.run import Numerics, Run
from sandbox.errors import RequestError, RunError
from sandbox.physics.integrators import Acceleration, State

#: Overlap in m that Chipmunk allows, as its default of 0.1 is meant for pixels, and its iterations.
_SLOP, _ITERATIONS = 1e-5, 30

#: Interval in s at which the path is recorded and balls are checked for rest.
_RECORD_EVERY = 1 / 240

#: Most steps in one run: about two minutes of computing.
MOST_STEPS = 10_000_000

#: A ball rests once it is slower than this (m/s, and r w as well) for this long (s) while touching something.
_REST_SPEED, _REST_TIME = 0.01, 0.25

#: A change of velocity in a step larger than the velocity gained so far by more than this factor is a reversal by
#: drag, which should only slow.
_REVERSAL = 1.0

#: A ball rolls if its slip is below this fraction of its speed.
_GRIP = 0.01

#: A ball that moves more than this fraction of its radius in a step may pass through a surface unnoticed.
_LEAP = 0.5

#: The remedy for an error that a finer step avoids.
_REMEDY = 'lower accuracy.step, or use accuracy.method = "exact"'


class _Tracked:
    """A ball's body, its recorded path, and what it touched."""

    def __init__(self, ball: Ball, body: pymunk.Body, start: State) -> None:
        self.ball = ball
        self.body = body
        self.take(start)
        self.law = acceleration_function(ball)
        self.path: list[Arc] = []
        self.since = 0.0  # s, start of the current arc
        self.start: State = self.state()
        self.last: tuple[State, Acceleration] = self.start, (0.0, 0.0, 0.0)  # before the forces of the last step
        self.touched = -2  # number of the last step in which it touched something
        self.resisted: dict[Any, float] = {}  # rolling resistance of sustained contact, by the surface's shape
        self.caught = False
        self.moved = 0.0  # s, when it last moved, or touched nothing

    def state(self) -> State:
        body = self.body
        more = (body.angle,) if self.ball.rotates else self.rolling_spin
        return (*body.position, *body.velocity, body.angular_velocity, *more)

    def take(self, state: State) -> None:
        """Set the velocities and spins to those of this state."""
        self.body.velocity, self.body.angular_velocity = state[2:4], state[4]
        self.rolling_spin: tuple[float, ...] = () if self.ball.rotates else state[5:]  # rad/s

    def record(self, t: float) -> None:
        if t > self.since or not self.path:
            after = self.state()
            self.path.append(Arc(self.since, t, self.start, tuple(zip(self.start, after, strict=True)), end=after))
            self.start = after
            self.since = t


class PlainSimulation:
    """One run in a Space of real shapes at ``accuracy.step``. Raises RunError, and what the scene's own forces
    raise."""

    def __init__(
        self, setup: Setup, accuracy: Accuracy, progress: Callable[[float, float], None] | None = None
    ) -> None:
        """``progress`` is called regularly with the time simulated and the most that it can become, in s."""
        moving = next((surface.name for surface in setup.surfaces if surface.motion is not None), None)
        if moving is not None:
            raise RequestError(
                f'the plain method has no surfaces that move, as {moving!r} does: use accuracy.method = "exact"'
            )
        kicking = next((surface.name for surface in setup.surfaces if surface.kick > 0.0), None)
        if kicking is not None:
            raise RequestError(
                f'the plain method has no surfaces that kick, as {kicking!r} does: use accuracy.method = "exact"'
            )
        self._setup = setup
        self._accuracy = accuracy
        self._progress = progress
        self._numerics = Numerics()
        self._events: list[Event] = []
        self._over = False
        self._t = 0.0
        self._steps = 0
        self._hit: list[_Tracked] = []  # in the current step
        self._real = PymunkWorld(setup.surfaces, _ITERATIONS, _SLOP)
        self._real.on_contact(self._meet, self._part)
        self._tracked: dict[Any, _Tracked] = {}
        for ball in setup.balls:
            body, _ = self._real.add(ball)
            body.position = ball.position
            if isinstance(ball, Body):
                body.angle = ball.angle
                resists = next((surface.name for surface in setup.surfaces if surface.rolling_resistance > 0.0), None)
                if resists is not None and isinstance(ball.shape, Ellipse):
                    raise RequestError(
                        f"body {ball.name!r} is an ellipse, whose rolling the plain method cannot resist: set the "
                        f'rolling_resistance of {resists!r} to 0, or use accuracy.method = "exact"'
                    )
            body.velocity_func = self._real.guarded(self._move)
            self._tracked[body] = _Tracked(ball, body, setup.start_of(ball))

    def run(self) -> Run:
        started = perf_counter()
        ended = self._loop()
        for tracked in self._tracked.values():
            if not tracked.caught:
                tracked.record(self._t)
        self._numerics.wall_s = perf_counter() - started
        arcs = {tracked.ball.name: Path(tracked.path) for tracked in self._tracked.values()}
        return Run(self._setup, self._accuracy, arcs, self._events, self._numerics, self._t, ended)

    def _loop(self) -> str:
        step, duration = self._accuracy.step, self._setup.duration
        next_record = 0.0
        while self._t < duration:
            self._steps += 1
            if self._steps > MOST_STEPS:
                raise RunError(
                    f"t = {self._t:.3g} s of {duration:g} s: {MOST_STEPS:,} steps of {step:.3g} s; lengthen "
                    'accuracy.step, shorten the duration, or use accuracy.method = "exact"'
                )
            # bodies move first: contacts and forces belong to the end of the step
            before, self._t = self._t, min(self._steps * step, duration)
            self._real.step(self._t - before)
            for tracked in self._hit:
                tracked.start = tracked.state()  # the next arc starts from the state after the impact
            self._hit.clear()
            if self._over:
                break
            if self._t >= next_record:
                next_record = self._t + _RECORD_EVERY
                if self._record_all():
                    break
        self._numerics.pymunk_steps = self._numerics.steps = self._steps
        return "until" if self._over else "duration" if self._t >= duration else "rest"

    def _record_all(self) -> bool:
        """Record the state of all balls. Returns whether all are at rest."""
        if self._progress is not None:
            self._progress(self._t, min(self._setup.duration, MOST_STEPS * self._accuracy.step))
        rest = True
        for tracked in self._tracked.values():
            if not tracked.caught:
                tracked.record(self._t)
                self._catch(tracked)
                rest = self._rests(tracked) and rest
        return rest

    def _catch(self, tracked: _Tracked) -> None:
        """Remove a ball that is in a pocket; noticed at the next recording, so up to one interval late."""
        x, y = tracked.body.position
        for trap in self._setup.traps:
            inside = trap.takes(tracked.ball.name) and Outline.of(trap.shape, 0.0).near(x, y).gap <= 0.0
            if inside and trap.holds(tracked.state()):
                tracked.caught = True
                self._real.space.remove(tracked.body, *tracked.body.shapes)
                speed = tracked.body.velocity.length
                self._note(Event(self._t, "caught", tracked.ball.name, trap.name, speed, x, y))
                return

    def _rests(self, tracked: _Tracked) -> bool:
        _, _, vx, vy, spin = tracked.state()[:5]
        slow = (vx * vx + vy * vy) ** 0.5 + tracked.ball.radius * abs(spin) < _REST_SPEED
        held = self._setup.plane is not None or self._steps - tracked.touched <= 1
        if not (slow and held):
            tracked.moved = self._t
        return not tracked.ball.timing.depends and self._t - tracked.moved >= _REST_TIME

    def _note(self, event: Event) -> None:
        self._events.append(event)
        if self._setup.ends_with(self._events):
            self._over = True

    # ------------------------------------------------------------------ callbacks

    def _move(self, body: pymunk.Body, gravity: Any, damping: float, h: float) -> None:
        """Apply forces, torques and the plane's friction to a ball for a step."""
        self._numerics.force_evaluations += 1
        tracked, setup = self._tracked[body], self._setup
        state = tracked.state()
        x, y, vx, vy, spin = state[:5]
        before = state if tracked.ball.rotates else state[:5]
        acceleration = tracked.law(self._t, before)
        self._refuse_leap(tracked, tracked.last[0][:2], (x, y))
        if tracked.touched != self._steps:
            self._refuse_reversal(tracked, *tracked.last, state, acceleration, h)
        tracked.last = state, acceleration
        ax, ay, alpha = acceleration
        after: State = (x, y, vx + h * ax, vy + h * ay, *state[4:])
        if setup.plane is not None:
            phase = setup.plane_of(tracked.ball.name).phase(after, tracked.ball.radius)
            after = (x, y, *phase.after(h)[2:])
        after = (*after[:4], after[4] + h * alpha, *after[5:])
        if not setup.bounds.hold(after):
            raise force_error(tracked.ball, self._t, before, setup.bounds.describe_violation(after))
        tracked.take(after)

    def _meet(self, arbiter: pymunk.Arbiter) -> None:
        """Set the restitution and friction of a contact, before Chipmunk solves it; solve one that needs more."""
        met, surface = self._touching(arbiter)
        balls, states, first = [each.ball for each in met], [each.state() for each in met], met[0]
        nx, ny = normal = -arbiter.normal.x, -arbiter.normal.y
        points = [(point.point_a.x, point.point_a.y) for point in arbiter.contact_point_set.points]
        found = meeting_at(balls, states, 0.0, normal, points)
        if surface is None:
            contact = contact_of_two((0, 1), balls, self._setup, found, found.fastest)
        else:
            contact = contact_with_surface(0, first.ball, states[0], surface, found, found.fastest)
        for tracked in met:
            tracked.touched = self._steps
        if arbiter.is_first_contact and contact.speed > 0.0:
            self._numerics.impacts += 1
            for tracked in met:
                tracked.record(self._t)
                self._hit.append(tracked)
            self._note(Event(self._t, "impact", first.ball.name, contact.partner, contact.speed, *states[0][:2]))
        bounce, lasts, lowest = contact.bounce, False, 0.0
        if surface is not None:
            by = press(states[0], first.last[1], nx, ny, 0.0)  # m/s^2
            # no faster than what weight alone adds in a step or two
            lasts = abs(contact.speed) <= 2.0 * by * self._accuracy.step
            lowest = takeoff_speed(by, surface.lowest_bounce)  # m/s, a bounce no faster than this is absorbed
        more = any((contact.sine, *bounce[2:], contact.speeds[2]))  # than Chipmunk has
        arbiter.process_collision = not more or lasts or contact.speed <= 0.0  # it is remembered
        if not arbiter.process_collision:
            for tracked, state in zip(met, after_single_contact(balls, states, contact), strict=True):
                tracked.take(state)
            away = first.body.velocity.dot(normal)
            if surface is not None and away <= lowest:
                first.body.velocity += away * arbiter.normal
            return
        absorbed = lasts or bounce.restitution * contact.speed <= lowest
        arbiter.restitution, arbiter.friction = 0.0 if absorbed else bounce.restitution, bounce.friction
        if surface is not None and lasts and rolls(first.ball, arbiter.contact_point_set.points):
            first.resisted[arbiter.shapes[1]] = surface.rolling_resistance

    def _part(self, arbiter: pymunk.Arbiter) -> None:
        """Slow what rolls, after Chipmunk has solved the contact."""
        first = self._touching(arbiter)[0][0]
        resistance, body = first.resisted.pop(arbiter.shapes[1], 0.0), first.body
        speed, met = body.velocity.length, arbiter.contact_point_set.points
        if resistance > 0.0 and abs(speeds_at(body, None, arbiter.normal, met)[1]) <= _GRIP * speed:
            push = abs(arbiter.total_impulse.dot(arbiter.normal))
            slower = max(0.0, 1.0 - resistance * push / first.ball.mass / (speed + 1e-30))
            body.velocity, body.angular_velocity = slower * body.velocity, slower * body.angular_velocity

    def _touching(self, arbiter: pymunk.Arbiter) -> tuple[list[_Tracked], Surface | None]:
        """The ball or balls of a contact, and the surface, if it is with one."""
        first, second = arbiter.shapes
        place = self._real.surface_of.get(second)
        surface = None if place is None else self._setup.surfaces[place]
        return [self._tracked[shape.body] for shape in ((first, second) if surface is None else (first,))], surface

    # ------------------------------------------------------------------ guards

    def _refuse_reversal(
        self, tracked: _Tracked, before: State, known: Acceleration, state: State, acceleration: Acceleration, h: float
    ) -> None:
        """Raise RunError if a force grows faster with the velocity than a step can follow."""
        gain = abs(state[2] - before[2]) + abs(state[3] - before[3])
        gains = gain > JUMP * (abs(state[2]) + abs(state[3]))
        if gains and before[2:4] != (0.0, 0.0) and stiff(before, state, known, acceleration, h, _REVERSAL):
            raise self._too_coarse(tracked, "drag would reverse its velocity")

    def _refuse_leap(self, tracked: _Tracked, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Raise RunError if the ball's centre passed through a surface in the last step."""
        if dist(start, end) <= _LEAP * tracked.ball.radius:
            return
        passed = self._real.passed(start, end)
        if passed is not None:
            raise self._too_coarse(tracked, f"went through {self._setup.surfaces[passed].name!r}")

    def _too_coarse(self, tracked: _Tracked, what: str) -> RunError:
        step = f"within a step of {self._accuracy.step:.3g} s"
        return failed(self._t, tracked.ball.name, f"{what} {step}; {_REMEDY}")
