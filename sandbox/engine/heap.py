"""Balls that press on one another: a heap, stepped by pymunk until its balls part or rest.

Impacts between balls that lie on one another never end: each is weaker than the one before. So a bounce that lasts less
than two steps (of ``accuracy.step``, or shorter for small balls) is lasting contact, and the balls are stepped together
in a Space of real shapes. In the middle of each step Chipmunk finds the impulses that keep apart what overlaps,
starting from those of the step before; the paths are parabolas between. Second order in the forces, first order in the
curvature of what they roll on. Faster impacts are exact events, as ever.

Rolling resistance is a torque on the ball up to ``c N R (1 + k)``, with k the inertia over m R^2: then a ball that
rolls freely is slowed by c N / m. Left out: the exact time and the event of an impact inside the heap that is slower
than 8 a h, with a the acceleration by forces and h the step. Balls of a heap that are struck leave it for the time of
the contact (``pressed.py``); while it forms, a blow on it is that on a rigid lump.
"""

from __future__ import annotations

from collections.abc import Collection, KeysView, Mapping, Sequence
from functools import cached_property
from math import hypot, inf

import pymunk

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.arc import Arc, still
from sandbox.engine.meeting import Meeting, discs, kept, meeting, returns, rounding, surface_met
from sandbox.engine.one_point import one_point
from sandbox.engine.real_space import RealSpace, rolls, speeds_at
from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball, Setup, Surface, outline_of
from sandbox.engine.setup_errors import failed
from sandbox.engine.surfaces import STILL, bounce_of_balls, bounce_off, press
from sandbox.engine.touch import TOUCHING_GAP, Obstacle
from sandbox.engine.track import Heaped, Track
from sandbox.physics.integrators import Acceleration, State

#: Gap, as a fraction of the smallest radius, up to which shapes are in contact in a heap: at rest they stay in touch.
_MARGIN = 1e-3

#: Solver iterations where all are equally heavy, and at most. Each step starts from the impulses of the one before; the
#: heavier one that lies on a light one is, the slower they are found.
_ITERATIONS, _MOST_ITERATIONS = 100, 3000

#: Steps without pressure after which two balls have parted.
_PATIENCE = 8

#: Speed, in units of what forces give a ball in a step, up to which balls of a heap meet in its steps, found late and
#: overlapped by up to half of what they move in a step; if faster, they have an impact at its exact time.
_SLOW = 8.0

#: Impulse, as a fraction of the largest that forces give a ball in a step, below which it is rounding.
_PRESSURE = 1e-6

#: In units of sqrt(d / a), with d the thickness of the thinnest ball or body and a the acceleration by forces: the
#: longest step, of balls and where bodies lie on others (one that turns comes down deeper than a ball does); and the
#: time for which all have to be slow before they rest, and for which a ball has to lie in a heap before a blow goes
#: through it by contact mechanics.
_STEP, _STEP_OF_BODIES, _REST = 0.1, 0.033, 3.5

#: An acceleration in m/s^2 that is common.
_COMMON = 10.0

#: Share of an overlap that is left after a step; and after a unit of time at least, without underflow.
_LEFT, _LEAST_LEFT = 0.6, 1e-300

#: Share of the margin that position correction may move balls in a step when they part or come to rest.
_APART = 1e-2


class _Member:
    """A ball of the heap in pymunk's Space."""

    def __init__(self, ball: Ball, real: RealSpace, since: float) -> None:
        self.ball = ball
        self.since = since  # s, when it came to press on others; from the start, forever
        self.body, self.disc = real.add(ball)
        self.brake = pymunk.SimpleMotor(self.body, real.space.static_body, 0.0)  # rolling resistance
        self.slow_for = 0.0  # s
        self.resistance = 0.0  # N m, of this step's pressure: for the next
        self.start: State = ()
        self.fastest = 0.0  # m/s, that no point of a body, or of a ball its centre, exceeds at the start
        self.touching: set[Obstacle | int] = set()  # obstacles, and balls by index, in this step
        self.before: set[Obstacle | int] = set()  # the same in the step before
        real.space.add(self.brake)

    def resist(self, surface: Surface, push: float, height: float) -> None:
        """Add the torque of rolling resistance on a surface that presses with ``push`` (N) and is ``height`` (m) from
        the centre."""
        self.resistance += surface.rolling_resistance * push * (height + self.ball.inertia / (self.ball.mass * height))


class Heap:
    """All balls of a run that press on one another, in one heap or in several; they are stepped together."""

    def __init__(self, setup: Setup, tracks: Sequence[Track], accuracy: Accuracy, numerics: Numerics) -> None:
        self._setup = setup
        self._tracks = tracks
        self._longest = accuracy.step
        self._settle = accuracy.settle
        self._numerics = numerics
        self._members: dict[int, _Member] = {}
        self._of_disc: dict[pymunk.Shape, int] = {}
        self._pressed: dict[frozenset[int], float] = {}  # s, when two balls pressed on each other last
        self._resting: dict[int, set[int]] = {}  # balls at rest, each with its heap
        self._forced = 0.0  # m/s^2, the largest acceleration by forces in this step
        self._fastest = 0.0  # m/s, approach in the heap that is no impact of its own
        self._thin = min(map(_thickness, setup.balls))  # m
        self._share = _STEP if discs(*setup.balls) else _STEP_OF_BODIES
        self._span = accuracy.step  # s, of a step that nothing cuts
        self._unit = self._lasting(1.0, _COMMON)  # s, of Chipmunk's time: its correction of overlaps is per unit
        self._h, self._t = 0.0, 0.0  # s, the length of this step and its start
        self.margin = _MARGIN * min(ball.radius for ball in setup.balls)  # m, gap up to which shapes touch

    @cached_property
    def _real(self) -> RealSpace:
        """The Space, made when there is something to step."""
        # at rest shapes stay in touch: their margins overlap
        masses = [ball.mass for ball in self._setup.balls]
        iterations = min(_MOST_ITERATIONS, int(_ITERATIONS * (max(masses) / min(masses)) ** 0.5))
        real = RealSpace(self._setup.surfaces, iterations, self.margin, 0.5 * self.margin)
        real.on_contact(self._meet, self._press)
        return real

    @property
    def members(self) -> KeysView[int]:
        """The balls that are stepped."""
        return self._members.keys()

    def has(self, indices: Collection[int]) -> bool:
        """Whether some of these balls lie in the heap, at rest or not."""
        return any(index in self._members or index in self._resting for index in indices)

    def wake(self, indices: Collection[int]) -> None:
        """Step the heaps again in which these balls lie at rest."""
        woken = set[int]().union(*(self._resting.get(index, ()) for index in indices))
        self._take(self._members.keys() | woken)
        for index in woken:
            del self._resting[index]
            self._members[index].since = -inf

    def presses(self, t: float, states: Mapping[int, State], pairs: Sequence[tuple[int, int]]) -> bool:
        """Whether balls that touch at t, in ``pairs``, belong in the heap: some are in it, or two part too slowly to
        stay apart for two steps."""
        members, pressing = self._members.keys(), {frozenset((i,)) for i, a in states.items() if self._lies(i, t, a)}
        forced = {index: self._forced_in_a_step(index, t, state) for index, state in states.items()}
        for i, j in pairs:
            a, b, balls = states[i], states[j], (self._tracks[i].ball, self._tracks[j].ball)
            met = meeting(balls[0], a, balls[1], b, self.margin)
            if (
                -met.closing < max(forced[i], forced[j])
                or (met.closing <= 0.0 and not members.isdisjoint((i, j)))
                or (not discs(*balls) and self._come_back(t, (i, j), (a, b), met))
            ):
                pressing.add(frozenset((i, j)))
        self._pressed |= dict.fromkeys(pressing, t)
        return bool(pressing) or self.has(states)

    def _come_back(self, t: float, indices: Sequence[int], states: Sequence[State], met: Meeting) -> bool:
        """Whether bodies that touch and part touch again at once, as they turn."""
        applied = [self._applied(index, t, state) for index, state in zip(indices, states, strict=True)]
        one, other = (outline_of(self._tracks[index].ball) for index in indices)
        return returns((one, other), states, applied, met, self._settle)

    def slow(self, t: float, states: Mapping[int, State]) -> float:
        """The speed in m/s below which a blow among these balls is lasting contact, or one that a heap takes in its
        steps."""
        forced = max(self._forced_in_a_step(index, t, state) for index, state in states.items())
        return _SLOW * forced if self.has(states) else forced

    def fresh(self, t: float) -> set[int]:
        """The balls that have come to press on others of late: a heap that is still forming."""
        return {
            index for index, member in self._members.items() if t - member.since < self._lasting(_REST, self._forced)
        }

    def _forced_in_a_step(self, index: int, t: float, state: State) -> float:
        """The speed in m/s that forces give in a step: for a body at least what is rounding, while rounding does not
        press balls on each other."""
        ball = self._tracks[index].ball
        least = -inf if discs(ball) else rounding(ball, state)
        forced = hypot(*self._applied(index, t, state)[:2])
        speed = forced * min(self._longest, self._lasting(self._share, forced))
        return max(speed, least) if speed > STILL else least

    def _lies(self, index: int, t: float, state: State) -> bool:
        """Whether a body leaves surfaces too slowly for a bounce that counts: at two points or more, or at one that its
        own path cannot follow."""
        track = self._tracks[index]
        if discs(track.ball):
            return False
        applied = self._applied(index, t, state)
        within = self.margin if index in self._members else TOUCHING_GAP
        found = kept(track.ball, track.obstacles, state, within, applied, self._settle)
        alone = len(found) == 1 and one_point(track.ball, state, *found[0], applied) is not None
        return bool(found) and not alone

    def step(self, t: float, until: float, states: Mapping[int, State]) -> dict[int, Arc]:
        """Step these balls from t; returns the arcs of those that press on others or did just before.

        The step is half a drift, the impulses of forces and contacts, and half a drift; none goes beyond ``until``.
        """
        forced = self._forced or max(hypot(*self._applied(index, t, state)[:2]) for index, state in states.items())
        self._span = min(self._longest, self._lasting(self._share, forced))
        self._t, self._h = t, min(self._span, until - t)
        h, unit = self._h, self._unit
        fresh = states.keys() - self._members.keys()
        self._take(states)
        applied = {}
        for index, (x, y, vx, vy, spin, *angle) in states.items():
            turned = [angle[0] + 0.5 * h * spin] if angle else []
            middle = (x + 0.5 * h * vx, y + 0.5 * h * vy, vx, vy, spin, *turned)
            applied[index] = self._applied(index, t + 0.5 * h, middle)
            if index in fresh and not angle:
                for obstacle, touching in self._tracks[index].near(x, y, self.margin):
                    pushed = press(states[index], applied[index], touching.nx, touching.ny, touching.curvature)
                    ball = self._tracks[index].ball
                    self._members[index].resist(obstacle.surface, ball.mass * max(0.0, pushed), ball.radius)
        self._forced = max(hypot(*applied[index][:2]) + self._swing(index, state) for index, state in states.items())
        self._fastest = _SLOW * self._forced * self._span
        for index, (x, y, vx, vy, spin, *angle) in states.items():
            member, (ax, ay, turning) = self._members[index], applied[index]
            body, ball = member.body, member.ball
            body.position = (x - 0.5 * h * vx, y - 0.5 * h * vy)  # from which Chipmunk moves it to the middle
            body.angle = angle[0] - 0.5 * h * spin if angle else 0.0
            body.velocity, body.angular_velocity = (unit * vx, unit * vy), unit * spin
            mass, inertia = unit * unit * ball.mass, unit * unit * ball.inertia
            body.force, body.torque = (mass * ax, mass * ay), inertia * turning
            member.start = states[index]
            member.fastest = hypot(vx, vy) + (ball.radius * abs(spin) if angle else 0.0)
            member.before, member.touching = member.touching, set()
            member.brake.max_force, member.resistance = unit * unit * member.resistance, 0.0
        self._real.space.collision_bias = max(_LEFT ** (unit / self._span), _LEAST_LEFT)
        self._real.step(h / unit)
        self._numerics.pymunk_steps += 1
        arcs = {index: self._arc(t, self._members[index]) for index in sorted(states)}
        moved = {i: hypot(*arc.contact) for i, arc in arcs.items() if isinstance(arc.contact, Heaped)}
        overlapped = {index for index, speed in moved.items() if speed * self._span > _APART * self.margin}
        held = self._held() | overlapped
        arcs = {index: arc for index, arc in arcs.items() if index in held}
        for index, arc in arcs.items():
            self._refuse_leap(index, arc)
            member = self._members[index]
            slow = member.fastest**2 <= 2.0 * self._forced * self._settle and index not in overlapped
            member.slow_for = member.slow_for + h if slow else 0.0
        rests = self._lasting(_REST, self._forced)
        for heap in self._apart(held):
            if all(self._members[index].slow_for >= rests for index in heap):
                self._resting |= dict.fromkeys(heap, heap)
                for index in heap:
                    at_rest = (*states[index][:2], 0.0, 0.0, 0.0, *states[index][5:])
                    arcs[index] = still(t, until, at_rest, Heaped())
        self._take(held - self._resting.keys())
        return arcs

    def _apart(self, held: set[int]) -> list[set[int]]:
        """These balls as heaps that do not press on each other."""
        heap_of = {index: {index} for index in held}
        for one, other in (pair for pair in self._pressed if len(pair) == 2):
            if heap_of[one] is not heap_of[other]:
                joined = heap_of[one] | heap_of[other]
                heap_of |= dict.fromkeys(joined, joined)
        return list({id(heap): heap for heap in heap_of.values()}.values())

    def _refuse_leap(self, index: int, arc: Arc) -> None:
        """Raise RunError if a body's centre passed through a surface: it was too thin for the step."""
        ball = self._tracks[index].ball
        passed = self._real.passed(arc.position(arc.t0), arc.position(arc.t1)) if ball.turns else None
        if passed is not None:
            what = f"it is so thin that others pressed it through {self._setup.surfaces[passed].name!r}"
            raise failed(arc.t1, ball.name, f"{what}; lower accuracy.step")

    def _lasting(self, share: float, forced: float) -> float:
        """A share of the time in s in which this acceleration (m/s^2) moves something by its own thickness."""
        return share * (self._thin / forced) ** 0.5 if forced > 0.0 else inf

    def _swing(self, index: int, state: State) -> float:
        """The acceleration in m/s^2 of a turning body's farthest point: it presses on others without a force, too."""
        return 0.0 if len(state) == 5 else float(state[4] ** 2) * self._tracks[index].ball.radius

    def _applied(self, index: int, t: float, state: State) -> Acceleration:
        return self._tracks[index].applied(t, state)

    def _take(self, indices: Collection[int]) -> None:
        """Make these balls the members."""
        for index in self._members.keys() - indices:
            member = self._members.pop(index)
            del self._of_disc[member.disc]
            self._real.space.remove(member.body, member.disc, member.brake)
        for index in indices - self._members.keys():
            member = self._members[index] = _Member(self._tracks[index].ball, self._real, self._t or -inf)
            self._of_disc[member.disc] = index

    def release(self, indices: Collection[int]) -> None:
        """Let go of balls that are struck."""
        self.wake(indices)
        self._take(self._members.keys() - indices)
        for member in self._members.values():
            member.touching -= {*indices}

    def _held(self) -> set[int]:
        """The balls of the pairs that pressed on each other in the last steps."""
        held: set[int] = set()
        for pair, last in list(self._pressed.items()):
            if self._t - last < _PATIENCE * self._span and pair <= self._members.keys():
                held |= pair
            else:
                del self._pressed[pair]
        return held

    def _arc(self, t: float, member: _Member) -> Arc:
        """The path of a step in which the velocity changes evenly, moved by position correction."""
        h, unit, body = self._h, self._unit, member.body
        x, y, ux, uy, spun, *angle = member.start
        (px, py), (vx, vy), spin = body.position, body.velocity / unit, body.angular_velocity / unit
        dx, dy = px - x - 0.5 * h * ux, py - y - 0.5 * h * uy
        turn = body.angle
        turned = tuple((at, 0.5 * (at + turn) + 0.25 * h * spun, turn + 0.5 * h * spin) for at in angle)
        end = (px + 0.5 * h * vx, py + 0.5 * h * vy, vx, vy, spin, *(curve[-1] for curve in turned))
        curves = (
            (x, x + 0.5 * (h * ux + dx), end[0]),
            (y, y + 0.5 * (h * uy + dy), end[1]),
            (ux, vx),
            (uy, vy),
            (spun, spin),
            *turned,
        )
        return Arc(t, t + h, member.start, curves, Heaped(dx / h, dy / h), end)

    def keeps_apart(self, index: int, other: Obstacle | int) -> bool:
        """Whether the heap keeps a ball from this obstacle or ball, so that they have no impact of their own: they
        touch, or would meet slowly."""
        if index in self._resting:
            return isinstance(other, Obstacle) or other in self._resting[index]
        here, there = self._members[index], self._members.get(other) if isinstance(other, int) else None
        if other in here.touching:
            return True
        if isinstance(other, Obstacle):
            if here.fastest <= self._fastest:
                return True
            met = surface_met(here.ball, here.start, (other, other.near(*here.start[:2])))
        elif there is None or here.fastest + there.fastest <= self._fastest:
            return there is not None
        else:
            met = meeting(here.ball, here.start, there.ball, there.start)
        return met.closing <= self._fastest

    # ------------------------------------------------------------------ callbacks

    def _meet(self, arbiter: pymunk.Arbiter) -> None:
        """Leave out what meets too fast for lasting contact: it has an impact of its own, at its exact time."""
        first, second = arbiter.shapes
        i = self._of_disc[first]
        here, there = self._members[i], self._members.get(self._of_disc.get(second, -1))
        other = self._tracks[i].obstacles[self._real.surface_of[second]] if there is None else self._of_disc[second]
        approach, along, slip = (speed / self._unit for speed in _speeds(arbiter, here, there))
        arbiter.process_collision = other in here.before or approach <= self._fastest  # it is remembered
        if not arbiter.process_collision:
            return
        here.touching.add(other)
        bounces = approach > self._forced * self._h
        if there is not None:
            there.touching.add(i)
            bounce = bounce_of_balls(self._setup, approach, abs(slip), here.ball.name, there.ball.name)
        elif bounces:
            bounce = bounce_off(self._setup.surfaces[self._real.surface_of[second]], approach, along)
        else:
            arbiter.restitution = 0.0
            return
        arbiter.restitution, arbiter.friction = bounce.restitution if bounces else 0.0, bounce.friction

    def _press(self, arbiter: pymunk.Arbiter) -> None:
        """Note which balls press on each other, and how hard a ball presses on a surface that resists its rolling."""
        first, second = arbiter.shapes
        i = self._of_disc[first]
        here = self._members[i]
        push = abs(arbiter.total_impulse.dot(arbiter.normal)) / self._unit
        on_surface = second in self._real.surface_of
        if on_surface and rolls(here.ball, arbiter):
            height = here.ball.radius
            if not discs(here.ball):
                height = abs(arbiter.normal.dot(arbiter.contact_point_set.points[0].point_a - here.body.position))
            here.resist(self._setup.surfaces[self._real.surface_of[second]], push / self._h, height)
        if not (on_surface and discs(here.ball)) and push > _PRESSURE * here.ball.mass * self._forced * self._h:
            self._pressed[frozenset((i,) if on_surface else (i, self._of_disc[second]))] = self._t


def _thickness(body: Ball) -> float:
    """Of a ball or body across its long side, in m."""
    return outline_of(body).mass_properties().area / (2.0 * body.radius)


def _speeds(arbiter: pymunk.Arbiter, here: _Member, there: _Member | None) -> tuple[float, float, float]:
    """Speed of approach in m/s where two shapes meet, and speeds along, of the centres and of the surfaces."""
    if not discs(here.ball, *([] if there is None else [there.ball])):
        approach, slip = speeds_at(arbiter)
        return approach, slip, slip
    nx, ny = arbiter.normal
    (vx, vy), (ux, uy) = here.body.velocity, (0.0, 0.0) if there is None else there.body.velocity
    along = slip = (vy - uy) * nx - (vx - ux) * ny
    for member in (here, there):
        slip += 0.0 if member is None else member.ball.radius * member.body.angular_velocity
    return (vx - ux) * nx + (vy - uy) * ny, along, slip
