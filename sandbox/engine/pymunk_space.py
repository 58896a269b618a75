"""A setup as a pymunk Space, built and stepped as somebody who knows pymunk would. The plain method steps it.

Chipmunk moves bodies first, finds contacts at the depth that the step gives, changes velocities, then solves impulses.
It has no continuous collision, and its defaults are for pixels. Done about it, by pymunk's own means:

- A step is split where a ball first touches something, found by ``Shape.segment_query`` along its way relative to the
  shape: a contact is not late, and nothing is passed through. Bodies not round, and over 25 balls, take shorter steps
  instead where something is near: no longer than half a radius.
- Half of a step's forces act before it and half in ``velocity_func`` (velocity Verlet), which is second order. Where
  drag would reverse a motion it acts in shorter pieces.
- Ground and walls around everything are 1 m thick. Surfaces that move are kinematic bodies.
- Restitution, friction and rolling resistance are those of the setup's laws at the speed of the contact. One that takes
  more than Chipmunk has (a cushion's nose, friction upward, turf that tilts, a kick) is solved as by the exact method,
  in Chipmunk's place and with its normal.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import chain, count
from math import hypot, inf
from typing import Any, NamedTuple

import pymunk

from sandbox.engine.contact.manifold import fixed_outline, meeting_at, relative
from sandbox.engine.contact.surfaces import press, takeoff_speed
from sandbox.engine.heap.pymunk_world import PymunkWorld, rolls, speeds_at
from sandbox.engine.impact.impact_contacts import after_single_contact, contact_of_two, contact_with_surface
from sandbox.engine.impact.impulses import after_kick
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.motion import Motion
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import MethodFailed, failed
from sandbox.engine.model.shapes import Ellipse, Vector
from sandbox.engine.model.surface import Surface
from sandbox.engine.motion.forces_on_ball import wrong_term
from sandbox.engine.pymunk_parts import SLOP, Mover, thick_outline
from sandbox.errors import RequestError, RunError
from sandbox.physics.integrators import Acceleration, State

#: Rounds of the solver: 10 leave 2 cm/s of asymmetry in a rack of balls, 50 leave 1e-7.
_ITERATIONS = 50

#: Share of an overlap that is left after a second: Chipmunk's own, by which a tenth goes in 1/60 s. Others measured no
#: better, as contacts are hardly late.
_BIAS = 0.9**60

#: A touch noticed with less overlap than this, in m, is not late; and the overlap with which it is noticed.
_LATE, _SEEN = 1e-7, 1e-9

#: Most parts of a step, and most balls whose ways are followed: pairs grow with the square.
_MOST_PARTS, _MOST_FOLLOWED = 32, 25

#: Share of its radius that what is not followed moves in a step near something; and that anything moves without a look
#: at whether it went through a surface.
_LEAP = 0.5

#: The remedy for a failure that a finer step avoids.
_REMEDY = 'lower accuracy.step, or use accuracy.method = "exact"'

#: Steps are of one length if they differ by less than this share.
_ROUNDING = 1e-6

#: Speed in m/s of what leaves the world because the method has exploded.
_BURST = 1e4

_EVERYTHING = pymunk.ShapeFilter()
_NONE: Acceleration = (0.0, 0.0, 0.0)

#: A ball rolls if its slip is below this fraction of its speed.
_GRIP = 0.01


class Hit(NamedTuple):
    """An impact, with the states of its balls before it."""

    ball: str
    partner: str  # name of the surface, or of the second ball
    speed: float  # m/s, of approach
    before: dict[str, State]


class SetupSpace(pymunk.Space):
    """A pymunk Space with the bodies, shapes and forces of a setup; ``step`` moves it, as the plain method does.

    ``named`` has the bodies by name. Bodies, shapes and constraints of your own are added as to any Space.
    """

    def __init__(self, setup: Setup) -> None:
        super().__init__()
        self._setup = setup
        self.time = 0.0  # s
        self.parts = 0  # steps of Chipmunk
        self.hits: list[Hit] = []  # in the last step
        self._h = self._longest = 0.0  # s, of the current step, and of the one asked for
        self._touching: set[Any] = set()  # pairs of shapes that touched in the last step
        self._touched: set[Any] = set()  # and those in this
        self._world = PymunkWorld(setup.surfaces, _ITERATIONS, SLOP, space=self, outline=partial(thick_outline, setup))
        self.collision_bias = _BIAS
        self._motions = dict(self._drive(*each) for each in enumerate(setup.surfaces) if each[1].motion is not None)
        self._world.on_contact(self._meet, self._part)
        self.movers: dict[pymunk.Body, Mover] = {}
        for ball in setup.balls:
            self._refuse_ellipse(ball)
            body, shape = self._world.add(ball)
            body.position = ball.position
            if isinstance(ball, Body):
                body.angle = ball.angle
            body.velocity_func = self._world.guarded(self._push_after)
            plane = None if setup.plane is None else setup.plane_of(ball.name)
            self.movers[body] = Mover(ball, body, shape, setup.start_of(ball), plane)
            self.reindex_shape(shape)
        self._all = list(self.movers.values())
        self.named = {mover.ball.name: body for body, mover in self.movers.items()}

    # ------------------------------------------------------------------ building

    def _refuse_ellipse(self, ball: Ball) -> None:
        resists = next((each.name for each in self._setup.surfaces if each.rolling_resistance > 0.0), None)
        if resists is not None and isinstance(ball, Body) and isinstance(ball.shape, Ellipse):
            raise RequestError(
                f"body {ball.name!r} is an ellipse, whose rolling the plain method cannot resist: set the "
                f'rolling_resistance of {resists!r} to 0, or use accuracy.method = "exact"'
            )

    def _drive(self, place: int, surface: Surface) -> tuple[pymunk.Body, Motion]:
        """A surface that moves, as a kinematic body, and its motion."""
        motion = surface.motion
        assert motion is not None
        body = pymunk.Body(body_type=pymunk.Body.KINEMATIC)
        outline = fixed_outline(surface.shape).shape.as_polygon().moved(-motion.about[0], -motion.about[1])
        self.add(body)
        self._world.add_surface(place, surface, body, outline)
        x, y, body.angle = motion.place(0.0)
        body.position = x, y
        self.reindex_shapes_for_body(body)
        return body, motion

    @property
    def evaluations(self) -> int:
        """Number of evaluations of forces."""
        return sum(mover.evaluations for mover in self._all)

    def remove_ball(self, mover: Mover) -> None:
        """Take a ball out of the Space."""
        del self.movers[mover.body]
        self.remove(mover.body, mover.shape)

    # ------------------------------------------------------------------ stepping

    def step(self, dt: float) -> None:
        """Step by dt s. Raises what a force or law raises, and MethodFailed for what pymunk cannot do."""
        self.hits = [hit for hits in self.advance(self.time + dt) for hit in hits]

    def advance(self, end: float) -> Iterator[list[Hit]]:
        """Step to the time ``end`` in s, in parts; yield the impacts in each."""
        self._longest = end - self.time
        for number in count():
            self.parts, left = self.parts + 1, end - self.time
            part = self._until_touch(left)
            part = part if number < _MOST_PARTS else left
            self._step_part(part, end if part >= left else self.time + part)
            yield self.hits
            if self.time >= end:
                return

    def _step_part(self, h: float, end: float) -> None:
        """Step by h s to the time ``end`` in s."""
        if abs(h - self._h) > _ROUNDING * h:  # or Chipmunk would begin with their impulses, scaled to the step
            self._world.forget(shape for shape in {*chain(*self._touched)} if shape.body in self.movers)
        self._h, self.time, self.hits = h, end, []
        self._touching, self._touched = self._touched, set()
        for body, motion in self._motions.items():
            x, y, angle = motion.place(end)
            body.velocity = (x - body.position.x) / h, (y - body.position.y) / h
            body.angular_velocity = (angle - body.angle) / h
        for mover in self.movers.values():
            self._push_before(mover, end - h)
        super().step(h)
        self._world.raise_stored()
        for mover in self.movers.values():
            if mover.touched == self.parts != mover.held:
                mover.pull = None  # at another velocity
            if mover.far > _LEAP * mover.ball.radius:
                self._report_tunnelling(mover)

    def _report_tunnelling(self, mover: Mover) -> None:
        passed = self._world.passed(mover.start[:2], mover.body.position)
        if passed is not None:
            surface = self._setup.surfaces[passed].name
            what = f"went through {surface!r} within a step of {self._longest:.3g} s; {_REMEDY}"
            raise MethodFailed(f"tunnelled: {failed(self.time, mover.ball.name, what)}")

    def _until_touch(self, h: float) -> float:
        """The part of a step of h s until a ball first touches something; or until what is not followed, and is near
        something, has moved by half its radius."""
        soonest, follows = h, len(self.movers) <= _MOST_FOLLOWED
        for body, mover in self.movers.items():
            mover.start = mover.state()
            (x, y, vx, vy), r = mover.start[:4], mover.ball.radius
            ax, ay = (0.0, 0.0) if self._is_held(mover) else self._pull(mover)[:2]
            dx, dy = h * (vx + 0.5 * h * ax), h * (vy + 0.5 * h * ay)
            mover.far = abs(dx) + abs(dy)
            if mover.far <= _LATE:
                continue
            way = pymunk.BB(min(x, x + dx) - r, min(y, y + dy) - r, max(x, x + dx) + r, max(y, y + dy) + r)
            near = [each for each in self.bb_query(way, _EVERYTHING) if each.body is not body and not each.sensor]
            if not follows or not isinstance(mover.shape, pymunk.Circle):
                soonest = min(soonest, h * _LEAP * mover.girth / mover.far) if near else soonest
                continue
            for shape in near:
                ux, uy = _body(shape).velocity_at_world_point((x, y))
                met = shape.segment_query((x, y), (x + dx - h * ux, y + dy - h * uy), r)
                if met is None:
                    continue
                nx, ny = met.normal
                speed, pulled = (ux - vx) * nx + (uy - vy) * ny, -(ax * nx + ay * ny)  # towards the shape
                toward = h * (speed + 0.5 * h * pulled)  # m
                if toward * (1.0 - met.alpha) > _LATE:
                    gap = met.alpha * toward + _SEEN
                    soonest = min(soonest, 2.0 * gap / (speed + max(0.0, speed**2 + 2.0 * gap * pulled) ** 0.5))
        return soonest

    def _is_held(self, mover: Mover) -> bool:
        """True if it was pressed on something in the last step."""
        return mover.held == self.parts - 1

    def _pull(self, mover: Mover) -> Acceleration:
        """The acceleration by forces at the start of the step."""
        if mover.pull is None:
            mover.pull = (0.0, 0.0, 0.0) if mover.plane is not None else mover.acceleration(self.time, mover.start)
        return mover.pull

    def _push_before(self, mover: Mover, t: float) -> None:
        """Apply half of the forces of a step; none to what is pressed on something, which does not fall meanwhile."""
        mover.ahead, mover.settled = None, False
        mover.share = self._h if self._is_held(mover) else 0.5 * self._h
        if mover.share < self._h:
            mover.take(mover.after_forces(t, mover.start, self._pull(mover), mover.share))

    def _ahead(self, mover: Mover, now: State) -> State:
        """Its state at the end of the step, but for contacts; what is pressed on something as it is ``now``."""
        if mover.ahead is None:
            pressed = mover.share == self._h
            mover.ahead = now if pressed else mover.after_forces(self.time, now, self._pull(mover), mover.share)
        return mover.ahead

    def _push_after(self, body: pymunk.Body, gravity: Any, damping: float, h: float) -> None:
        """Apply the rest of the forces, or of the plane's friction."""
        mover = self.movers[body]
        if mover.settled:
            return
        before = mover.state()
        if mover.plane is None:
            mover.pull = mover.acceleration(self.time, self._ahead(mover, before))
        after = mover.after_forces(self.time, before, self._pull(mover), mover.share)
        if not self._setup.bounds.hold(after):
            raise self._lost(mover, before, after)
        mover.take(after)

    def _lost(self, mover: Mover, before: State, after: State) -> RunError:
        """An error that says what is wrong: a force, or the method, or that it is outside the world."""
        wrong = wrong_term(mover.ball, self.time, before if mover.ball.rotates else before[:5])
        error = failed(self.time, mover.ball.name, wrong or self._setup.bounds.describe_violation(after))
        exploded = wrong is None and not hypot(*after[2:4]) <= _BURST  # nor NaN
        return MethodFailed(f"exploded: {error}") if exploded else error

    # ------------------------------------------------------------------ contacts

    def _meet(self, arbiter: pymunk.Arbiter) -> None:
        """Set the restitution and friction of a contact, before Chipmunk solves it; solve one that needs more."""
        first, second = arbiter.shapes
        place = self._world.surface_of.get(second)
        surface = None if place is None else self._setup.surfaces[place]
        met = [self.movers[_body(shape)] for shape in ((first, second) if surface is None else (first,))]
        begins = arbiter.shapes not in self._touching
        self._touched.add(arbiter.shapes)
        nx, ny = normal = -arbiter.normal.x, -arbiter.normal.y
        points = [(point.point_a.x, point.point_a.y) for point in arbiter.contact_point_set.points]
        drive = self._velocity_of(_body(second), points[0])
        balls, ahead = [each.ball for each in met], [self._ahead(each, each.state()) for each in met]
        states = ahead if drive == (0.0, 0.0) else [relative(ahead[0], drive)]
        found = meeting_at(balls, states, 0.0, normal, points)
        if surface is None:
            contact = contact_of_two((0, 1), balls, self._setup, found, found.fastest)
        else:
            contact = contact_with_surface(0, balls[0], states[0], surface, found, found.fastest)
        if begins and contact.speed > 0.0:
            names = [ball.name for ball in balls]
            self.hits.append(Hit(names[0], contact.partner, contact.speed, dict(zip(names, ahead, strict=True))))
        bounce, lasts, lowest = contact.bounce, False, 0.0
        if surface is not None:
            by = press(states[0], met[0].pull or _NONE, nx, ny, 0.0)  # m/s^2
            # no faster than what weight alone adds in a step or two
            lasts = abs(contact.speed) <= 2.0 * by * self._longest
            lowest = takeoff_speed(by, surface.lowest_bounce)  # m/s, a bounce no faster than this is absorbed
        absorbed = lasts or bounce.restitution * contact.speed <= lowest
        for mover in met:
            mover.touched = self.parts
            mover.held = self.parts if absorbed or not begins else mover.held
        more = any((contact.sine, *bounce[2:], contact.speeds[2], contact.kick, *drive))  # than Chipmunk has
        arbiter.process_collision = not more or lasts or contact.speed <= 0.0  # it is remembered
        if not arbiter.process_collision:
            after = after_single_contact(balls, states, contact)
            away = (after[0][2] * nx + after[0][3] * ny) if surface is not None else inf
            for mover, state in zip(met, after, strict=True):
                mover.take(relative(after_kick(mover.ball, state, contact), (-drive[0], -drive[1])))
                mover.settled = True
            if away <= lowest:
                met[0].body.velocity += away * arbiter.normal
            return
        restitution = 0.0 if absorbed else bounce.restitution
        if begins and restitution > 0.0:  # Chipmunk takes the speed before the rest of the forces acts
            raw = meeting_at(balls, [relative(each.state(), drive) for each in met], 0.0, normal, points).closing
            restitution *= found.closing / raw if 0.0 < 0.5 * found.closing < raw else 1.0
        arbiter.restitution, arbiter.friction = restitution, bounce.friction
        if surface is not None and lasts and rolls(balls[0], arbiter.contact_point_set.points):
            met[0].resisted[second] = surface.rolling_resistance

    def _velocity_of(self, body: pymunk.Body, point: Vector) -> Vector:
        """The velocity in m/s of a surface that moves, at a point; 0 for anything else."""
        motion = self._motions.get(body)
        if motion is None:
            return 0.0, 0.0
        place, rates = motion.place(self.time), motion.rates(self.time)
        return rates.x - rates.angle * (point[1] - place.y), rates.y + rates.angle * (point[0] - place.x)

    def _part(self, arbiter: pymunk.Arbiter) -> None:
        """Slow what rolls, after Chipmunk has solved the contact."""
        mover = self.movers[_body(arbiter.shapes[0])]
        resistance, body = mover.resisted.pop(arbiter.shapes[1], 0.0), mover.body
        speed, met = body.velocity.length, arbiter.contact_point_set.points
        if resistance > 0.0 and abs(speeds_at(body, None, arbiter.normal, met)[1]) <= _GRIP * speed:
            push = abs(arbiter.total_impulse.dot(arbiter.normal))
            slower = max(0.0, 1.0 - resistance * push / mover.ball.mass / (speed + 1e-30))
            body.velocity, body.angular_velocity = slower * body.velocity, slower * body.angular_velocity


def _body(shape: pymunk.Shape) -> pymunk.Body:
    assert shape.body is not None
    return shape.body


def pymunk_space(setup: Setup) -> SetupSpace:
    """A new Space of a setup, at its start; ``sandbox.load("golf").build()`` is the setup of a scene.

    >>> import pymunk, sandbox
    >>> from sandbox import Ball, Drag, Gravity, Setup
    >>> bob = Ball("bob", mass=0.6, radius=0.12, position=(1, 0), forces=[Gravity(9.81), Drag()])
    >>> space = sandbox.pymunk_space(Setup([bob]))
    >>> space.add(pymunk.PinJoint(space.named["bob"], space.static_body))
    >>> for _ in range(240):
    ...     space.step(1 / 240)
    >>> round(space.time, 9), round(space.named["bob"].position.length, 2)  # s, m: it swings about the origin
    (1.0, 1.0)
    """
    return SetupSpace(setup)
