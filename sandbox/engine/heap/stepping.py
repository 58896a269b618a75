"""One step of a heap: pymunk finds the contacts in its middle, and their impulses; it creates no energy."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import pymunk

from sandbox.engine.contact.manifold import all_round
from sandbox.engine.contact.surfaces import bounce_of_balls, bounce_off
from sandbox.engine.heap.member import Member
from sandbox.engine.heap.pymunk_world import PymunkWorld, rolls, speeds_at
from sandbox.engine.model.ball import Ball, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Bounce, Surface
from sandbox.engine.model.tolerances import ROUNDING
from sandbox.errors import RunError
from sandbox.physics.integrators import State

if TYPE_CHECKING:
    from sandbox.engine.heap.contact_solver import Contacts

#: Solver iterations for balls that are alike, and the largest ratio of masses up to which they are. Each step starts
#: from the impulses of the one before. Fewer: balls sink into one another; a larger ratio needs as many times more.
_ITERATIONS, _ALIKE = 100, 10.0

#: Share of an overlap that is left after a step; in Chipmunk after a unit of time at least, without underflow. Smaller:
#: a step moves what lies on others by more than its velocity; larger: overlaps of fast steps last.
_LEFT, _LEAST_LEFT = 0.6, 1e-300

#: Closing speed, in units of what forces give in a step, and gain of energy, in units of what has that speed, below
#: which Chipmunk's iterations have come to their end; and overlap, in margins, that is left as it is. A larger gain:
#: motion is slowed; smaller: what stands still is solved directly, for rounding.
_CLOSING, _GAIN, _LEVEL = 1e-3, 1e-6, 1e-3

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


class Accounts(NamedTuple):
    """The energies of the steps of a heap so far."""

    gained: float  # J, negative, as contacts take energy
    most: dict[int, float]  # J, of kinetic energy, by index


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
        self.directly = not all_round(*setup.balls) or self._ratio > _ALIKE
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
        iterations = _ITERATIONS if self.directly else int(_ITERATIONS * self._ratio**0.5)
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

    def accounts(self) -> Accounts:
        """Return the energies of its steps so far."""
        return Accounts(self._gained, dict(self._most))

    def restore(self, accounts: Accounts) -> None:
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
        space.collision_bias = 1.0 if self.directly else max(_LEFT ** (self.unit / span), _LEAST_LEFT)
        self._touches = {}
        self.world.step(h / self.unit)
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
        """Solve the contacts of a group, and move its members out of this share of their overlaps."""
        restitutions = (touch.restitution for touch in touches for _ in touch.points)
        closing = _closing(touches, Member.velocity_at)
        partings = [bounce * max(0.0, speed) for bounce, speed in zip(restitutions, closing, strict=True)]
        depths = [-gap for touch in touches for _, gap in touch.points]
        iterated = self._ratio <= _ALIKE and self._iterated(members, touches, partings)
        if iterated and max(depths) <= _LEVEL * self.margin:
            return
        contacts = self._contacts(members, touches)
        guess = [touch.push / len(touch.points) for touch in touches for _ in touch.points]
        restitution = 1.0
        while not iterated:
            velocities, pushes = contacts.impulses([restitution * parting for parting in partings], guess)
            for member, (vx, vy, spin) in zip(members, velocities, strict=True):
                member.velocity = vx, vy, spin
            if restitution == 0.0 or not any(partings) or sum(member.gain for member in members) <= 0.0:
                break
            restitution = _REDUCED * restitution if restitution > _LEAST else 0.0
        if not iterated:
            of_points = iter(pushes)
            for touch in touches:
                touch.push = sum(next(of_points) for _ in touch.points)
        if max(depths) > 0.0:
            moved = contacts.moved_apart([share * depth for depth in depths])
            for member, (dx, dy, turn) in zip(members, moved, strict=True):
                member.body.position += (dx, dy)
                member.body.angle += turn

    def _iterated(self, members: Sequence[Member], touches: Sequence[Touch], partings: Sequence[float]) -> bool:
        """True if Chipmunk's iterations have come to their end in this group: nothing closes any more, and it has
        gained no energy but by rounding."""
        most = _CLOSING * self._pressed_speed
        closing = _closing(touches, Member.velocity_after)
        if any(speed + parting > most for speed, parting in zip(closing, partings, strict=True)):
            return False
        mass = sum(member.ball.mass for member in members)
        return sum(member.gain for member in members) <= _GAIN * mass * self._pressed_speed**2

    def _contacts(self, members: Sequence[Member], touches: Sequence[Touch]) -> Contacts:
        """The contacts of a group."""
        # here, not above: it brings numpy, which balls that are alike do not need
        from sandbox.engine.heap.contact_solver import ContactPoint, Contacts, SolverBody

        number = {member.index: place for place, member in enumerate(members)}
        bodies = [
            SolverBody(
                *each.body.position,
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
        normal, met = (arbiter.normal.x, arbiter.normal.y), arbiter.contact_point_set.points
        approach, along, slip = (speed / self.unit for speed in _speeds(here, there, normal, met))
        arbiter.process_collision = other in here.before or approach <= self._impact_speed  # it is remembered
        if not arbiter.process_collision:
            here.left_out.add(other)
            if there is not None:
                there.left_out.add(here.index)
            return
        here.touching.add(other)
        bounces, bounce = approach > self._pressed_speed, Bounce(0.0, arbiter.friction)
        if there is not None:
            there.touching.add(here.index)
            bounce = bounce_of_balls(self._setup, approach, abs(slip), here.ball.name, there.ball.name)
        elif surface is not None and bounces:
            bounce = bounce_off(surface, approach, along)
        arbiter.restitution, arbiter.friction = bounce.restitution if bounces else 0.0, bounce.friction
        height = 0.0
        if surface is not None and rolls(here.ball, met):
            height = here.ball.radius
            if not all_round(here.ball):
                height = abs(arbiter.normal.dot(met[0].point_a - here.body.position))
        points = [
            ((0.5 * (at.point_a.x + at.point_b.x), 0.5 * (at.point_a.y + at.point_b.y)), at.distance + self.margin)
            for at in (met if self.directly else ())
        ]
        law = arbiter.restitution, arbiter.friction
        self._touches[shapes] = Touch(here, there, surface, normal, points, *law, approach, height)

    def _press(self, arbiter: pymunk.Arbiter) -> None:
        """Note how hard two press on each other."""
        self._touches[arbiter.shapes].push = abs(arbiter.total_impulse.dot(arbiter.normal)) / self.unit


def _closing(touches: Sequence[Touch], velocity: Callable[[Member, float, float], Vector]) -> list[float]:
    """The closing speeds in m/s at the points of these contacts, by the velocities before or after the impulses."""
    found = []
    for touch in touches:
        nx, ny = touch.normal
        for (x, y), _ in touch.points:
            (vx, vy), (ux, uy) = velocity(touch.first, x, y), (0.0, 0.0)
            if touch.second is not None:
                ux, uy = velocity(touch.second, x, y)
            found.append((vx - ux) * nx + (vy - uy) * ny)
    return found


def _speeds(
    here: Member, there: Member | None, normal: Vector, met: Sequence[pymunk.ContactPoint]
) -> tuple[float, float, float]:
    """Speed of approach in m/s where two shapes meet, and speeds along, of the centres and of the surfaces."""
    if not all_round(here.ball, *([] if there is None else [there.ball])):
        approach, slip = speeds_at(here.body, None if there is None else there.body, normal, met)
        return approach, slip, slip
    nx, ny = normal
    (vx, vy), (ux, uy) = here.body.velocity, (0.0, 0.0) if there is None else there.body.velocity
    along = slip = (vy - uy) * nx - (vx - ux) * ny
    for member in (here, there):
        slip += 0.0 if member is None else member.ball.radius * member.body.angular_velocity
    return (vx - ux) * nx + (vy - uy) * ny, along, slip
