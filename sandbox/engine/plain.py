"""The plain method: stock pymunk at a fixed step, forces in ``velocity_func``. The baseline for comparison.

Chipmunk moves bodies first, then finds contacts, updates velocities and applies impulses: so a contact is found up to
one step late, at whatever depth that step gives, and forces are integrated to first order. Nothing here improves on
that, but errors are reported: cffi prints and swallows what a callback raises, so it is stored and raised after the
step, and a ball that passes through a surface within a step is an error. The friction of a plane acts in
``velocity_func`` too; the upward part of the friction between balls and at cushions is applied after Chipmunk's.
"""

from __future__ import annotations

from collections.abc import Callable
from math import hypot, isfinite
from time import perf_counter
from typing import Any, NamedTuple

import pymunk

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.acting import checked
from sandbox.engine.arc import Arc
from sandbox.engine.event import Event
from sandbox.engine.path import Path
from sandbox.engine.real_space import ONLY_SURFACES, RealSpace, rolls, speeds_at
from sandbox.engine.run import Numerics, Run
from sandbox.engine.setup import Ball, Body, Setup, Surface
from sandbox.engine.shapes import Ellipse
from sandbox.engine.step_control import JUMP, stiff
from sandbox.engine.surfaces import (
    bounce_of_balls,
    bounce_off,
    friction_in_plane,
    rubbed_upward,
    speeds_where_touching,
)
from sandbox.engine.touch import Outline
from sandbox.errors import RequestError, RunError
from sandbox.physics.cushion import rebound
from sandbox.physics.integrators import Acceleration, State

#: Overlap in m that Chipmunk allows, as its default of 0.1 is meant for pixels, and its iterations.
_SLOP, _ITERATIONS = 1e-5, 30

#: Interval in s at which the path is recorded and balls are checked for rest and for having left the world.
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

#: What to do about an error that a finer step avoids.
_REMEDY = 'lower accuracy.step, or use accuracy.method = "exact"'


class _Pending(NamedTuple):
    """A contact between Chipmunk's ``pre_solve`` and ``post_solve`` callbacks."""

    friction: float  # of the pair, in all directions
    slip: tuple[float, float]  # m/s, along and upward
    resistance: float = 0.0  # rolling resistance, of lasting contact
    lowest: float = 0.0  # m/s, a bounce no faster than this is absorbed
    turned: float = 0.0  # rad, rotation of the velocity during contact with a tilted surface


class _Tracked:
    """A ball's body, its recorded path, and what it touched."""

    def __init__(self, ball: Ball, body: pymunk.Body, rolls: bool) -> None:
        self.ball = ball
        self.rolling_spin: tuple[float, ...] = ball.rolling_spin if rolls else ()  # rad/s
        self.turns = ball.turns
        self.body = body
        self.path: list[Arc] = []
        self.since = 0.0  # s, start of the current arc
        self.start: State = self.state()
        self.last: tuple[State, Acceleration] | None = None  # before the forces of the last step
        self.touched = -2  # number of the last step in which it touched something
        self.pending: dict[Any, _Pending] = {}  # by the other's shape
        self.caught = False
        self.still_since: float | None = None

    def state(self) -> State:
        body = self.body
        more = (body.angle,) if self.turns else self.rolling_spin
        return (*body.position, *body.velocity, body.angular_velocity, *more)

    def take(self, state: State) -> None:
        """Set the velocities and spins to those of this state."""
        self.body.velocity, self.body.angular_velocity = state[2:4], state[4]
        self.rolling_spin = () if self.turns else state[5:]

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
        self._setup = setup
        self._accuracy = accuracy
        self._progress = progress
        self._numerics = Numerics()
        self._events: list[Event] = []
        self._over = False
        self._t = 0.0
        self._steps = 0
        self._hit: list[_Tracked] = []  # in the current step
        self._real = RealSpace(setup.surfaces, _ITERATIONS, _SLOP)
        self._real.on_contact(self._meet, self._part)
        self._tracked: dict[Any, _Tracked] = {}
        for ball in setup.balls:
            body, _ = self._real.add(ball)
            body.position, body.velocity, body.angular_velocity = ball.position, ball.velocity, ball.spin
            if isinstance(ball, Body):
                body.angle = ball.angle
                resists = next((surface.name for surface in setup.surfaces if surface.rolling_resistance > 0.0), None)
                if resists is not None and isinstance(ball.shape, Ellipse):
                    raise RequestError(
                        f"body {ball.name!r} is an ellipse, whose rolling the plain method cannot resist: set the "
                        f'rolling_resistance of {resists!r} to 0, or use accuracy.method = "exact"'
                    )
            body.velocity_func = self._real.guarded(self._move)
            self._tracked[body] = _Tracked(ball, body, setup.plane is not None and setup.plane_of(ball.name).rolls)

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
        """Record and check the state of all balls. Returns whether all are at rest."""
        if self._progress is not None:
            self._progress(self._t, min(self._setup.duration, MOST_STEPS * self._accuracy.step))
        rest = True
        for tracked in self._tracked.values():
            if not tracked.caught:
                tracked.record(self._t)
                if not self._setup.bounds.hold(tracked.state()):
                    raise self._diverged(tracked, tracked.state())
                self._catch(tracked)
                rest = self._rests(tracked) and rest
        return rest

    def _catch(self, tracked: _Tracked) -> None:
        """Remove a ball that is in a pocket; noticed at the next recording, so up to one interval late."""
        x, y = tracked.body.position
        for catch in self._setup.catches:
            takes = not catch.only or tracked.ball.name in catch.only
            if takes and Outline.of(catch.shape, 0.0).near(x, y).gap <= 0.0:
                tracked.caught = True
                self._real.space.remove(tracked.body, *tracked.body.shapes)
                speed = tracked.body.velocity.length
                self._note(Event(self._t, "caught", tracked.ball.name, catch.name, speed, x, y))
                return

    def _rests(self, tracked: _Tracked) -> bool:
        _, _, vx, vy, spin = tracked.state()[:5]
        slow = (vx * vx + vy * vy) ** 0.5 + tracked.ball.radius * abs(spin) < _REST_SPEED
        held = self._setup.plane is not None or self._steps - tracked.touched <= 1
        if not (slow and held):
            tracked.still_since = None
            return False
        if tracked.still_since is None:
            tracked.still_since = self._t
        return self._t - tracked.still_since >= _REST_TIME

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
        if h * h * (vx * vx + vy * vy) > (_LEAP * tracked.ball.radius) ** 2:
            self._refuse_leap(tracked, (x - h * vx, y - h * vy), (x, y))
        acceleration = checked(tracked.ball, self._t, state if tracked.turns else state[:5])
        if tracked.last is not None and tracked.touched != self._steps:
            self._refuse_reversal(tracked, *tracked.last, state, acceleration, h)
        tracked.last = state, acceleration
        ax, ay, alpha = acceleration
        after: State = (x, y, vx + h * ax, vy + h * ay, *state[4:])
        if setup.plane is not None:
            phase = setup.plane_of(tracked.ball.name).phase(after, tracked.ball.radius)
            after = (x, y, *phase.after(h)[2:])
        after = (*after[:4], after[4] + h * alpha, *after[5:])
        if not isfinite(sum(after)):
            raise self._diverged(tracked, after)
        tracked.take(after)

    def _meet(self, arbiter: pymunk.Arbiter) -> None:
        """Set the restitution and friction of a contact, before Chipmunk solves it."""
        balls, surface = self._touching(arbiter)
        first, states = balls[0], [tracked.state() for tracked in balls]
        nx, ny = -arbiter.normal
        if any(tracked.turns for tracked in balls):
            approach, *slips = *speeds_at(arbiter), 0.0
        else:
            approach, *slips = speeds_where_touching([tracked.ball for tracked in balls], states, nx, ny)
        slip = slips[0], slips[1]
        for tracked in balls:
            tracked.touched = self._steps
        partner = balls[1].ball.name if surface is None else surface.name
        if arbiter.is_first_contact and approach > 0.0:
            self._numerics.impacts += 1
            for tracked in balls:
                tracked.record(self._t)
                self._hit.append(tracked)
            self._note(Event(self._t, "impact", first.ball.name, partner, approach, *states[0][:2]))
        if surface is None:
            bounce = bounce_of_balls(self._setup, approach, hypot(*slip), first.ball.name, partner)
            arbiter.restitution, arbiter.friction = bounce.restitution, friction_in_plane(bounce.friction, *slip)
            first.pending[arbiter.shapes[1]] = _Pending(bounce.friction, slip)
            return
        along = states[0][2] * ny - states[0][3] * nx
        acceleration = (0.0, 0.0) if first.last is None else first.last[1]
        press = max(0.0, -acceleration[0] * nx - acceleration[1] * ny)  # m/s^2
        lasts = abs(approach) <= 2.0 * press * self._accuracy.step  # the speed that weight alone adds in a step or two
        if surface.nose_height is not None:  # Chipmunk sees only the plane, so it cannot solve this
            arbiter.process_collision = False
            if approach > 0.0:
                bounce = bounce_off(surface, approach, along)
                radius, height = first.ball.radius, surface.nose_height
                first.take((0.0, 0.0, *rebound(states[0][2:], (nx, ny), radius, height, *bounce[:2])))
        elif approach > 0.0 or lasts:
            restitution, friction, tilt, tangential = bounce_off(surface, approach, along)
            arbiter.restitution, arbiter.friction = 0.0 if lasts else restitution, friction_in_plane(friction, *slip)
            back = 0.0 if lasts else tangential * slip[0]
            arbiter.surface_velocity = -back * ny, back * nx
            # a tilted surface is equivalent to a level one that meets a velocity rotated the other way; it is rotated
            # back afterwards
            turned = 0.0 if lasts or any(pending.turned for pending in first.pending.values()) else tilt
            turned = turned if along >= 0.0 else -turned
            first.body.velocity = first.body.velocity.rotated(-turned)
            resistance = surface.rolling_resistance if lasts and rolls(first.ball, arbiter) else 0.0
            lowest = (2.0 * press * surface.lowest_bounce) ** 0.5
            first.pending[arbiter.shapes[1]] = _Pending(friction, slip, resistance, lowest, turned)

    def _part(self, arbiter: pymunk.Arbiter) -> None:
        """Apply what Chipmunk does not know of, after it has solved the contact."""
        balls, surface = self._touching(arbiter)
        first, (nx, ny) = balls[0], -arbiter.normal
        pending = first.pending.pop(arbiter.shapes[1], None)
        if pending is None:
            return
        push = abs(arbiter.total_impulse.dot(arbiter.normal))
        if surface is not None:
            body = first.body
            body.velocity = body.velocity.rotated(pending.turned)
            approach, slip = speeds_at(arbiter)
            if 0.0 < -approach <= pending.lowest:  # a bounce that the surface absorbs
                point = arbiter.contact_point_set.points[0].point_a
                moved = 1.0 / body.mass + arbiter.normal.cross(point - body.position) ** 2 / body.moment
                body.apply_impulse_at_world_point(-approach / moved * arbiter.normal, point)
            speed = body.velocity.length
            if pending.resistance > 0.0 and abs(slip) <= _GRIP * speed:
                slower = max(0.0, 1.0 - pending.resistance * push / first.ball.mass / (speed + 1e-30))
                body.velocity, body.angular_velocity = slower * body.velocity, slower * body.angular_velocity
        if pending.slip[1] != 0.0 and push > 0.0:
            states, most = [tracked.state() for tracked in balls], pending.friction * push
            after = rubbed_upward([tracked.ball for tracked in balls], states, nx, ny, pending.slip, most)
            for tracked, state in zip(balls, after, strict=True):
                tracked.take(state)

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
            raise RunError(
                f"t = {self._t:.6g} s, ball {tracked.ball.name!r}: drag would reverse its velocity within a step of "
                f"{h:.3g} s; {_REMEDY}"
            )

    def _refuse_leap(self, tracked: _Tracked, start: tuple[float, float], end: tuple[float, float]) -> None:
        """Raise RunError if the ball's centre passed through a surface in the last step."""
        met = self._real.space.segment_query_first(start, end, 0.0, ONLY_SURFACES)
        if met is not None:
            surface = self._setup.surfaces[self._real.surface_of[met.shape]]
            raise RunError(
                f"t = {self._t:.6g} s, ball {tracked.ball.name!r}: went through {surface.name!r} "
                f"within a step of {self._accuracy.step:.3g} s; {_REMEDY}"
            )

    def _diverged(self, tracked: _Tracked, state: State) -> RunError:
        x, y, vx, vy, spin = state[:5]
        return RunError(
            f"t = {self._t:.6g} s, ball {tracked.ball.name!r}: position ({x:.6g}, {y:.6g}) m, velocity "
            f"({vx:.6g}, {vy:.6g}) m/s, spin {spin:.6g} rad/s is not finite, or outside the world; {_REMEDY}"
        )
