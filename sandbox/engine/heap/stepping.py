"""One step of a heap: pymunk finds the contacts in its middle, and their impulses; it creates no energy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple

import pymunk

from sandbox.engine.contact.manifold import all_round
from sandbox.engine.contact.surfaces import bounce_of_balls, bounce_off
from sandbox.engine.heap.member import Member
from sandbox.engine.heap.pymunk_world import PymunkWorld, rolls
from sandbox.engine.model.ball import Ball, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Surface
from sandbox.engine.model.tolerances import ROUNDING
from sandbox.errors import RunError
from sandbox.physics.integrators import State

if TYPE_CHECKING:
    from sandbox.engine.heap.contact_solver import Contacts

#: Solver iterations for balls that are alike, for each body, and at most for bodies; and the largest ratio of masses up
#: to which they are alike. Each step starts from the impulses of the one before. Fewer: balls sink into one another, or
#: more is solved directly; a larger ratio needs as many times more.
_ITERATIONS, _OF_A_BODY, _MOST, _ALIKE = 100, 50, 1_000, 10.0

#: Share of an overlap that is left after a step; in Chipmunk after a unit of time at least, without underflow. Smaller:
#: a step moves what lies on others by more than its velocity; larger: overlaps of fast steps last.
_LEFT, _LEAST_LEFT = 0.6, 1e-300

#: Closing speed, in units of what forces give in a step or of the fastest approach, and gain of energy, in units of
#: what forces give, below which Chipmunk's iterations have come to their end. Larger: blows are less exact; smaller:
#: more is solved directly.
_CLOSING, _GAIN = 1e-3, 1e-6

#: Share of restitution that is left where energy would grow, and below which there is none.
_REDUCED, _LEAST = 0.5, 0.1

#: Energy that all steps of heaps together may create: as a share of the largest kinetic energies, and as much as lifts
#: those that touch by this many margins, a twentieth of the smallest radius, which they may overlap while they are
#: poured. Less: heaps that come to rest are errors; more: energy from nothing is not noticed.
_CREATED, _LIFTED = 1e-3, 50.0


@dataclass(slots=True)
class Touch:
    """Two that touch in a step."""

    first: Member
    second: Member | None
    surface: Surface | None
    normal: Vector  # unit vector from the first
    points: Sequence[tuple[Vector, float]]  # m, and the gap there in m
    restitution: float
    friction: float
    approach: float  # m/s, before the impulses, where they approach fastest
    height: float  # m, of the centre above the surface that resists its rolling; 0 if none does
    push: float = 0.0  # N s, of the normal impulse


Group = tuple[list[Member], list[Touch]]


class _Accounts(NamedTuple):
    """The energies of the steps of a heap so far."""

    gained: float  # J, negative, as contacts take energy
    most: dict[int, float]  # J, of kinetic energy, by index


class HeapState(NamedTuple):
    """The state of a heap between two steps; plain data."""

    members: dict[int, dict[str, Any]]  # by index, in the order in which they are stepped
    pressed: dict[frozenset[int], float]
    resting: dict[int, set[int]]
    numbers: tuple[float, float, float, float, int]
    accounts: _Accounts


class Stepper:
    """Steps the balls and bodies of a heap.

    Balls that are alike are solved by Chipmunk's iterations, and so are bodies that are alike, where these come to
    their end; they take long where heavy ones lie on light ones: there the contacts are solved directly. A step gains
    no energy: restitution is reduced first, and what remains, mostly of lifting what overlaps, is taken from the
    motion of those that touch one another.
    """

    def __init__(self, setup: Setup, margin: float, unit: float) -> None:
        """``margin`` is the gap in m up to which shapes touch, ``unit`` Chipmunk's unit of time in s."""
        self.unit = unit
        self.margin = margin
        masses = [ball.mass for ball in setup.balls]
        self._ratio = max(masses) / min(masses)
        self._alike = self._ratio <= _ALIKE
        self.directly = not (self._alike and all_round(*setup.balls))
        if self.directly:  # it brings numpy, which takes long in the midst of a frame, and others do not need
            import sandbox.engine.heap.contact_solver  # noqa: F401
        self._setup = setup
        self._h, self._pressed_speed, self._impact_speed = 0.0, 0.0, 0.0  # s, m/s, m/s
        self._touches: dict[tuple[pymunk.Shape, ...], Touch] = {}  # in this step
        self._of_disc: dict[pymunk.Shape, Member] = {}
        self._gained = 0.0  # J, in all steps; negative, as contacts take energy
        self._most: dict[int, float] = {}  # J, of kinetic energy, by index

    @cached_property
    def world(self) -> PymunkWorld:
        """The Space, made when there is something to step."""
        # at rest shapes stay in touch: their margins overlap
        iterations = int(_ITERATIONS * self._ratio**0.5)
        world = PymunkWorld(self._setup.surfaces, iterations, self.margin, 0.5 * self.margin)
        world.on_contact(self._meet, self._press)
        return world

    def add(self, member: Member) -> None:
        """Step this one, too."""
        self._of_disc[member.disc] = member

    def remove(self, member: Member) -> None:
        """Step it no more."""
        del self._of_disc[member.disc]
        self.world.space.remove(member.body, member.disc, member.brake)

    def accounts(self) -> _Accounts:
        """Return the energies of its steps so far."""
        return _Accounts(self._gained, dict(self._most))

    def restore(self, accounts: _Accounts) -> None:
        """Go on with these accounts."""
        self._gained, self._most = accounts.gained, dict(accounts.most)

    def step(self, h: float, span: float, pressed_speed: float, impact_speed: float) -> list[Group]:
        """Do a step of h s from where the members are placed; returns those that touch one another, in groups.

        ``span`` is the length in s of a step that nothing cuts. What approaches no faster than ``pressed_speed`` (m/s)
        does not bounce; what does so faster than ``impact_speed`` is left to an impact of its own.
        """
        if self.directly and abs(h - self._h) > ROUNDING * h:
            self.world.forget(self._of_disc)
        self._h, self._pressed_speed, self._impact_speed = h, pressed_speed, impact_speed
        space = self.world.space
        if self.directly:
            space.iterations = min(_MOST, _OF_A_BODY * len(self._of_disc))
        space.collision_bias = max(_LEFT ** (self.unit / span), _LEAST_LEFT) if self._alike else 1.0
        self._touches = {}
        self.world.step(h / self.unit)
        for member in self._of_disc.values():
            member.read()
        groups = self._groups()
        for members, touches in groups:
            if self.directly and touches:
                self._solve(members, touches, 1.0 - _LEFT ** (h / span))
        return groups

    def note_energy(self, ball: Ball, state: State, index: int) -> None:
        """Note how much kinetic energy a ball or body has: the energy that a heap creates is compared with the most."""
        self._most[index] = max(self._most.get(index, 0.0), kinetic(ball, state))

    def settle_accounts(self, t: float, groups: Sequence[Group], forced: float) -> None:
        """Take what a step that ends at t has gained from the motion. Raises RunError if energy appears that no motion
        can pay for; ``forced`` is the largest acceleration by forces in m/s^2."""
        for members, _ in groups:
            gain, moving = sum(member.gain for member in members), sum(member.energy for member in members)
            if gain > 0.0:
                share = max(0.0, 1.0 - gain / moving) ** 0.5 if moving > 0.0 else 0.0
                for member in members:
                    vx, vy, spin = member.velocity
                    member.velocity = share * vx, share * vy, share * spin
                gain = max(0.0, gain - moving)
            self._gained += gain
            had = sum(self._most.values())
            lifting = forced * _LIFTED * self.margin * sum(member.ball.mass for member in members)
            if self._gained > _CREATED * had + lifting:
                names = ", ".join(sorted(repr(member.ball.name) for member in members))
                raise RunError(
                    f"t = {t:.6g} s: {self._gained:.3g} J appeared from nothing in the heap of {names}, whose largest "
                    f"kinetic energy is {had:.3g} J; lower accuracy.step"
                )

    def _groups(self) -> list[Group]:
        """The members in groups that touch one another, directly or through others, each with its contacts."""
        of = {member.index: {member.index} for member in self._of_disc.values()}
        for touch in self._touches.values():
            if touch.second is not None and of[touch.first.index] is not of[touch.second.index]:
                joined = of[touch.first.index] | of[touch.second.index]
                of |= dict.fromkeys(joined, joined)
        groups: dict[int, Group] = {id(group): ([], []) for group in of.values()}
        for member in self._of_disc.values():
            groups[id(of[member.index])][0].append(member)
        for touch in self._touches.values():
            groups[id(of[touch.first.index])][1].append(touch)
        return list(groups.values())

    # ------------------------------------------------------------------ the direct solution

    def _solve(self, members: Sequence[Member], touches: Sequence[Touch], share: float) -> None:
        """Solve the contacts of a group where Chipmunk's iterations have not come to their end. Where masses differ
        much, move its members out of this share of their overlaps, which Chipmunk does of others."""
        restitutions = (touch.restitution for touch in touches for _ in touch.points)
        closing = _closing(touches, Member.velocity_at)
        partings = [bounce * max(0.0, speed) for bounce, speed in zip(restitutions, closing, strict=True)]
        if self._alike and self._iterated(members, touches, partings):
            return
        contacts = self._contacts(members, touches)
        pushes = [touch.push / len(touch.points) for touch in touches for _ in touch.points]
        restitution = 1.0
        while True:
            velocities, pushes = contacts.impulses([restitution * parting for parting in partings], pushes)
            for member, (vx, vy, spin) in zip(members, velocities, strict=True):
                member.velocity = vx, vy, spin
            if restitution == 0.0 or not any(partings) or sum(member.gain for member in members) <= 0.0:
                break
            restitution = _REDUCED * restitution if restitution > _LEAST else 0.0
        of_points = iter(pushes)
        for touch in touches:
            touch.push = sum(next(of_points) for _ in touch.points)
        depths = [-gap for touch in touches for _, gap in touch.points]
        if not self._alike and max(depths) > 0.0:
            moved = contacts.moved_apart([share * depth for depth in depths])
            for member, (dx, dy, turn) in zip(members, moved, strict=True):
                member.x, member.y, member.turn = member.x + dx, member.y + dy, member.turn + turn

    def _iterated(self, members: Sequence[Member], touches: Sequence[Touch], partings: Sequence[float]) -> bool:
        """True if Chipmunk's iterations have come to their end in this group: nothing closes any more, nothing that
        opens is pushed, and restitution has gained no energy but by rounding."""
        most = _CLOSING * max(self._pressed_speed, *(touch.approach for touch in touches))
        left = map(sum, zip(_closing(touches, Member.velocity_after), partings, strict=True))
        for touch in touches:
            closing = max(next(left) for _ in touch.points)
            if closing > most or (closing < -most and touch.push > 0.0):
                return False
        mass = sum(member.ball.mass for member in members)
        return not any(partings) or sum(member.gain for member in members) <= _GAIN * mass * self._pressed_speed**2

    def _contacts(self, members: Sequence[Member], touches: Sequence[Touch]) -> Contacts:
        """The contacts of a group."""
        from sandbox.engine.heap.contact_solver import ContactPoint, Contacts, SolverBody

        number = {member.index: place for place, member in enumerate(members)}
        bodies = [
            SolverBody(
                each.x,
                each.y,
                1.0 / each.ball.mass,
                1.0 / each.ball.inertia,
                each.freely,
                self._h * each.resistance,
            )
            for each in members
        ]
        points = []
        for touch in touches:
            second = None if touch.second is None else number[touch.second.index]
            for point, _ in touch.points:
                points.append(ContactPoint(number[touch.first.index], second, point, touch.normal, touch.friction))
        return Contacts(bodies, points)

    # ------------------------------------------------------------------ callbacks

    def _meet(self, arbiter: pymunk.Arbiter) -> None:
        """Leave out what meets too fast for sustained contact: it has an impact of its own, at its exact time."""
        first, second = shapes = arbiter.shapes
        here, there = self._of_disc[first], self._of_disc.get(second)
        place = -1 if there is not None else self.world.surface_of[second]
        surface = None if there is not None else self._setup.surfaces[place]
        other = here.mover.obstacles[place] if there is None else there.index
        (nx, ny), met = arbiter.normal, arbiter.contact_point_set.points
        points = [
            ((0.5 * (ax + bx), 0.5 * (ay + by)), distance + self.margin)
            for (ax, ay), (bx, by), distance in map(_AT, met)
        ]
        approach, along, slip = _speeds(here, there, (nx, ny), points)
        # pymunk remembers it while they touch: one that was left out is taken again here
        arbiter.process_collision = other in here.before or approach <= self._impact_speed
        if not arbiter.process_collision:
            here.left_out.add(other)
            if there is not None:
                there.left_out.add(here.index)
            return
        here.touching.add(other)
        bounces, friction, restitution, height = approach > self._pressed_speed, arbiter.friction, 0.0, 0.0
        if there is not None:
            there.touching.add(here.index)
            restitution, friction, *_ = bounce_of_balls(
                self._setup, approach, abs(slip), here.ball.name, there.ball.name
            )
        elif surface is not None:
            if bounces:
                restitution, friction, *_ = bounce_off(surface, approach, along)
            if rolls(here.ball, met):
                (x, y), _ = points[0]
                height = abs((x - here.x) * nx + (y - here.y) * ny) if here.ball.rotates else here.ball.radius
        if not bounces:
            restitution = 0.0
        arbiter.restitution, arbiter.friction = restitution, friction
        self._touches[shapes] = Touch(here, there, surface, (nx, ny), points, restitution, friction, approach, height)

    def _press(self, arbiter: pymunk.Arbiter) -> None:
        """Note how hard two press on each other."""
        self._touches[arbiter.shapes].push = abs(arbiter.total_impulse.dot(arbiter.normal)) / self.unit


#: What is read of a point of contact.
_AT = attrgetter("point_a", "point_b", "distance")


def _closing(touches: Sequence[Touch], velocity: Callable[[Member, float, float], Vector]) -> list[float]:
    """The closing speeds in m/s at the points of these contacts, by the velocities before or after the impulses."""
    found = []
    for touch in touches:
        nx, ny = touch.normal
        for (x, y), _ in touch.points:
            u, v = _relative(touch.first, touch.second, x, y, velocity)
            found.append(u * nx + v * ny)
    return found


def _relative(
    here: Member, there: Member | None, x: float, y: float, velocity: Callable[[Member, float, float], Vector]
) -> Vector:
    """The velocity in m/s of a point of one, as seen from the other."""
    if there is None:
        return velocity(here, x, y)
    (vx, vy), (ux, uy) = velocity(here, x, y), velocity(there, x, y)
    return vx - ux, vy - uy


def _speeds(
    here: Member, there: Member | None, normal: Vector, points: Sequence[tuple[Vector, float]]
) -> tuple[float, float, float]:
    """Speed of approach in m/s where two meet, of two points the faster, and speeds along, of the centres and of the
    surfaces."""
    nx, ny = normal
    if not all_round(here.ball, *([] if there is None else [there.ball])):
        seen = (_relative(here, there, x, y, Member.velocity_at) for (x, y), _ in points)
        approach, slip = max((u * nx + v * ny, v * nx - u * ny) for u, v in seen)
        return approach, slip, slip
    (vx, vy), (ux, uy) = here.start[2:4], (0.0, 0.0) if there is None else there.start[2:4]
    along = slip = (vy - uy) * nx - (vx - ux) * ny
    for member in (here, there):
        slip += 0.0 if member is None else member.ball.radius * member.start[4]
    return (vx - ux) * nx + (vy - uy) * ny, along, slip
