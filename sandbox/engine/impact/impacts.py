"""Impacts at one instant: which bodies touch, and who exchanges impulses with whom, in which order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import dist
from typing import NamedTuple

from sandbox.engine.contact.manifold import ContactManifold, all_round, meeting, relative, speeds_at, surfaces_met
from sandbox.engine.contact.surfaces import after_vertical_friction, friction_in_plane, speeds_where_touching
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.impact.impact_contacts import after_single_contact, contact_of_two, contact_with_surface
from sandbox.engine.impact.impulses import ImpactContact, after_contact_of_bodies, after_contacts_at_once, after_kick
from sandbox.engine.model.ball import Ball, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, Surface
from sandbox.engine.model.tolerances import CLOSING, CREATED, TOUCHING_GAP
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.arc import Arc, uniform_arc
from sandbox.engine.paths.phase import InCluster
from sandbox.engine.paths.run import Numerics
from sandbox.errors import RunError
from sandbox.physics.integrators import State

#: Largest relative energy gain of a cluster in an impact: rounding in Chipmunk's iterations.
_GAIN = 1e-7

#: Alternations between balls and soft walls at one instant, after which all exchange impulses at once.
_TURNS = 9


#: Fraction of the fastest approach that may remain after an impact; it is another, at the same time. Less: of many that
#: touch one another, whose loads Chipmunk's iterations share out slowly, friction is left out without need.
_REMAINING = 1e-3

#: Fraction of the radius by which two contacts that are one differ in place and normal, where flush surfaces join.
_SAME_POINT = 2e-6

#: Fraction of the fastest approach in an impact below which another is rounding: of a body that has been lying.
_FAINT = 1e-4


class _ImpactGroup(NamedTuple):
    """Balls that touch at one time, directly or through others."""

    t: float  # s
    states: dict[int, State]  # by index into the balls of the setup
    pairs: list[tuple[int, int]]
    gap: float = TOUCHING_GAP  # m, up to which shapes touch; wider in a heap


class Hit(NamedTuple):
    """One contact that closed."""

    t: float  # s
    ball: int  # index into the balls of the setup
    partner: str
    speed: float  # m/s, normal speed of approach


class Outcome(NamedTuple):
    """The states after an impact, and the contacts that closed."""

    t: float  # s, when the last two bodies separate
    states: dict[int, State]  # then, of all balls that are touched
    hits: list[Hit]  # in order of time
    arcs: Mapping[int, Sequence[Arc]] = {}  # their paths through a contact that lasts


#: Simulates the contact at t of balls in these states; returns None if impulses are right.
_ResolveCluster = Callable[[float, dict[int, State]], Outcome | None]


class Impacts:
    """Resolves impacts among the balls of a run."""

    def __init__(self, setup: Setup, movers: Sequence[MovingBall], numerics: Numerics, slowest_hop: float) -> None:
        self._setup = setup
        self._movers = movers
        self._numerics = numerics
        self._slowest_hop = slowest_hop  # m/s, minimum speed at which balls on cloth separate
        # Walls softer than balls push back after the balls have separated.
        model = setup.contact
        self._all_soft = len(setup.balls) > 1 and model.name != "rigid" and model.wall_stiffness == 0.0
        self._some_soft = self._all_soft or any(map(self._soft, setup.surfaces))
        self._some_kick = any(surface.kick > 0.0 for surface in setup.surfaces)
        self._some_move = any(surface.motion is not None for surface in setup.surfaces)
        self._walls: dict[tuple[int, bool | None], list[Obstacle]] = {}  # soft or hard, of each ball
        self._all_round = all_round(*setup.balls)
        self._heaviest = max(ball.mass for ball in setup.balls)  # kg

    def exchange(self, t: float, group: _ImpactGroup, resolve_cluster: _ResolveCluster) -> Outcome:
        """The outcome of the impact at t of balls that touch.

        Balls and hard walls exchange impulses at once; soft walls push back afterwards, one after another, and so on
        until nothing closes; balls that a wall sends on others that touch still others may form a cluster. If that
        takes too many turns, or in a heap, all exchange impulses at once instead.
        """
        start = states = group.states
        hits: list[Hit] = []  # not list[Hit](), which takes thirty times as long, here and below
        last = _TURNS if self._some_soft and group.gap == TOUCHING_GAP and not self._any_body(states) else 0
        for turn in range(last + 1):
            if turn in (0, last):
                states, hits, work = dict(start), [], 0.0
                group = group._replace(states=states)
            elif turn % 2 == 0 and (parted := resolve_cluster(t, states)) is not None:
                marker = InCluster(t, parted.t)
                others = {i: [uniform_arc(t, parted.t, state, marker)] for i, state in states.items()}
                arcs = {**others, **parted.arcs}
                ends = {i: each[-1].state(parted.t) for i, each in arcs.items()}
                return Outcome(parted.t, ends, hits + parted.hits, arcs)
            before = dict(states)
            if turn < last and turn % 2:
                closed, done = self._close_soft_walls(group)
            else:
                closed, done = self._close_at_once(group, None if turn == last else False)
            if turn > 0 and not closed:
                break
            if closed and self._slowest_hop > 0.0:
                self._pay_for_hops(before, states, done)
            work += done
            if self._some_kick:
                work += self._kick(group, closed)
            hits += _hits(t, closed)
        self._refuse_gain(t, start, states, hits, work)
        return Outcome(t, states, hits)

    def _refuse_gain(
        self, t: float, before: dict[int, State], after: dict[int, State], hits: Sequence[Hit], work: float
    ) -> None:
        """Raise RunError if the bodies that touch at t have more energy after their impact than before, and the
        ``work`` (J) of what moves."""
        had, has = self._energy(before) + abs(work), self._energy(after) + abs(work) - work
        if has - had > CREATED * had + len(hits) * self._heaviest * self._slowest_hop**2:
            names = {self._movers[index].ball.name for index in before} | {hit.partner for hit in hits}
            raise RunError(
                f"t = {t:.6g} s: {has - had:.3g} J appeared from nothing in the impact of "
                f"{', '.join(sorted(map(repr, names)))}, whose kinetic energy was {had:.3g} J; "
                "look for masses that differ by very much, or extreme friction"
            )

    def _any_body(self, indices: Iterable[int]) -> bool:
        """True if some of these are bodies, not balls."""
        return not self._all_round and any(self._movers[index].ball.rotates for index in indices)

    def _close_at_once(self, group: _ImpactGroup, soft: bool | None) -> tuple[list[ImpactContact], float]:
        """Close all contacts of balls with each other and with soft or hard walls, or both, at once; returns those that
        were closing, and the work in J of moving surfaces. If a ball closes one, and does not come to close the others
        by that, these do not act."""
        states = group.states
        found = [*self._contacts_with_surfaces(group, soft), *self._contacts_of_balls(group)]
        closed = [contact for contact in found if contact.speed > CLOSING]
        if len(closed) == 1 == min(len(found), len(states)) and not self._any_body(states):
            before = dict(states)
            work = self._exchange_alone(states, closed[0])
            if not any(self._closes(other, states) for other in found if other is not closed[0]):
                return closed, work
            states.update(before)
        return closed, self._exchange_at_once(states, found) if closed else 0.0

    def _closes(self, contact: ImpactContact, states: dict[int, State]) -> bool:
        balls, met = self._balls(contact), contact.relative_states(states)
        return speeds_where_touching(balls, met, contact.nx, contact.ny, contact.sine)[0] > CLOSING

    def _close_soft_walls(self, group: _ImpactGroup) -> tuple[list[ImpactContact], float]:
        """Close the contacts with soft walls, one after another; returns them, and the work in J of those that move."""
        closed, work = [], 0.0
        for contact in self._contacts_with_surfaces(group, True):
            if contact.speed > CLOSING:
                work += self._exchange_alone(group.states, contact)
                closed.append(contact)
        return closed, work

    def _kick(self, group: _ImpactGroup, closed: Sequence[ImpactContact]) -> float:
        """Add what surfaces that were hit kick with, shared among the points of one contact; returns the work in J of
        this, and of what moves where balls are kicked into something else."""
        kicking = [contact for contact in closed if contact.kick > 0.0]
        if not kicking:
            return 0.0
        states, had = group.states, self._energy(group.states)
        for contact in kicking:
            points = sum((other.balls, other.partner) == (contact.balls, contact.partner) for other in kicking)
            index, share = contact.balls[0], contact._replace(kick=contact.kick / points)
            states[index] = after_kick(self._movers[index].ball, states[index], share)
        work = self._energy(states) - had
        found = [*self._contacts_with_surfaces(group, None), *self._contacts_of_balls(group)]
        if any(contact.speed > CLOSING for contact in found):
            work += self._exchange_at_once(states, found)
        return work

    def touching(self, t: float, seeds: Sequence[int], gap: float = TOUCHING_GAP) -> _ImpactGroup:
        """All balls that touch those in ``seeds`` at t, directly or through others, up to a ``gap`` in m."""
        states: dict[int, State] = {}
        waiting = list(seeds)
        pairs: list[tuple[int, int]] = []
        while waiting:
            index = waiting.pop(0)
            if index in states:
                continue
            mover = self._movers[index]
            states[index] = state = mover.arc.state(t)
            for other, neighbour in enumerate(self._movers):
                if other in states or neighbour.caught or neighbour.arc.t0 > t:
                    continue
                reach = mover.ball.radius + neighbour.ball.radius + gap
                left, bottom, right, top = neighbour.arc.box()
                if not (left - reach <= state[0] <= right + reach and bottom - reach <= state[1] <= top + reach):
                    continue
                x, y = neighbour.arc.position(t)
                if (x - state[0]) ** 2 + (y - state[1]) ** 2 <= reach * reach and (
                    all_round(mover.ball, neighbour.ball)
                    or meeting(mover.ball, state, neighbour.ball, neighbour.arc.state(t)).gap <= gap
                ):
                    waiting.append(other)
                    pairs.append((index, other))
        place = {index: number for number, index in enumerate(states)}
        pairs.sort(key=lambda pair: (place[pair[0]], place[pair[1]]))
        return _ImpactGroup(t, states, pairs, gap)

    # ------------------------------------------------------------------ contacts

    def _contacts_with_surfaces(self, group: _ImpactGroup, soft: bool | None) -> Iterator[ImpactContact]:
        """The contacts with soft or hard walls, or both, each from the states at the time when it is yielded. Where two
        surfaces join, a point of both counts once, for the surface with the least ``tilt_from_side``."""
        states = group.states
        for index in states:
            mover = self._movers[index]
            met: dict[tuple[float, ...], tuple[Obstacle, ContactManifold, int]] = {}
            walls = self._walls.get((index, soft))
            if walls is None:
                walls = [o for o in mover.obstacles if soft is None or self._soft(o.surface) is soft]
                self._walls[index, soft] = walls
            if self._some_move:
                here = *states[index][:2], group.gap
                walls = [wall.at(group.t) for wall in walls if wall.reaches(*here)]
            for obstacle, found in surfaces_met(mover.ball, walls, states[index], group.gap):
                for number, point in enumerate(found.points):
                    place = *point, *(mover.ball.radius * part for part in found.normal)
                    near = (each for each in met if dist(place, each) <= _SAME_POINT * mover.ball.radius)
                    place = next(near, place)
                    tilt = obstacle.tilt_from_side(*found.normal)
                    if place not in met or tilt < met[place][0].tilt_from_side(*met[place][1].normal):
                        met[place] = obstacle, found, number
            for obstacle, found, number in met.values():
                state, drive = states[index], (0.0, 0.0)
                if obstacle.moves:
                    drive = obstacle.velocity_at(found.points[number])
                    state = relative(state, drive)
                contact = contact_with_surface(index, mover.ball, state, obstacle.surface, found, number)
                yield self._hopping(contact if drive == (0.0, 0.0) else contact._replace(drive=drive))

    def _soft(self, surface: Surface) -> bool:
        return self._all_soft or surface.nose_height is not None

    def _contacts_of_balls(self, group: _ImpactGroup) -> Iterator[ImpactContact]:
        states, pairs, gap = group.states, group.pairs, group.gap
        for pair in pairs:
            balls = [self._movers[index].ball for index in pair]
            found = meeting(balls[0], states[pair[0]], balls[1], states[pair[1]], gap)
            for number in range(len(found.points)) if found.gap <= gap else ():
                yield self._hopping(contact_of_two(pair, balls, self._setup, found, number))

    # ------------------------------------------------------------------ impulses

    def _exchange_alone(self, states: dict[int, State], contact: ImpactContact) -> float:
        """A single contact of balls; returns the work in J of a surface that moves. Below a nose a ball that spins may
        be drawn on, or leave more slowly than the slowest hop: it is given that."""
        balls, before = self._balls(contact), [states[index] for index in contact.balls]
        after = after_single_contact(balls, before, contact)
        x, y, vx, vy, *spins = after[0]
        (ux, uy), mass = contact.drive, balls[0].mass
        short = self._slowest_hop - (vx - ux) * contact.nx - (vy - uy) * contact.ny
        if contact.sine != 0.0 and short > 0.0:
            after[0] = (x, y, vx + short * contact.nx, vy + short * contact.ny, *spins)
        self._numerics.pymunk_steps += 1
        states.update(zip(contact.balls, after, strict=True))
        return mass * ((after[0][2] - before[0][2]) * ux + (after[0][3] - before[0][3]) * uy)

    def _exchange_at_once(self, states: dict[int, State], found: Sequence[ImpactContact]) -> float:
        """Several contacts, without gain of energy; returns the work in J of surfaces that move.

        If several contacts close at once, restitution may demand more energy than there is. With friction this is
        known as Kane's paradox (the slip reverses while the normal speeds are imposed): friction is reduced, down to
        zero. If energy still increases, as when a light ball is squeezed between a wall and a heavy ball, restitution
        is reduced: with both at zero no energy is gained. Chipmunk sees only the plane, so the upward part of the
        friction comes afterwards.
        """
        balls = [mover.ball for mover in self._movers]
        had, hopped = self._energy(states), len(found) * self._heaviest * self._slowest_hop**2
        wanted = [
            (contact.bounce.restitution, friction_in_plane(contact.bounce.friction, *contact.speeds[1:]))
            for contact in found
        ]
        friction = restitution = 1.0
        while True:
            bounces = [Bounce(restitution * e, friction * mu) for e, mu in wanted]
            if len(found) == 1:
                after, pushes, work = after_contact_of_bodies(balls, states, found[0], bounces[0])
            else:
                after, pushes, work = after_contacts_at_once(balls, states, found, bounces)
            self._numerics.pymunk_steps += 1
            most = (1.0 + _GAIN) * (had + abs(work)) + work - abs(work) + hopped
            if (self._energy(after) <= most and self._parted(after, found)) or restitution == 0.0:
                break
            if friction > 0.0:
                friction = 0.5 * friction if friction > 1e-3 else 0.0
            else:
                restitution = 0.9 * restitution if restitution > 1e-2 else 0.0
        states.update(after)
        for contact, push in zip(found, pushes, strict=True):
            if contact.speeds[2] != 0.0 and push > 0.0:
                before, most = [states[index] for index in contact.balls], contact.bounce.friction * push
                slip = contact.speeds[1:]
                rubbed = after_vertical_friction(self._balls(contact), before, contact.nx, contact.ny, slip, most)
                states.update(zip(contact.balls, rubbed, strict=True))
        return work

    def _parted(self, after: dict[int, State], found: Sequence[ImpactContact]) -> bool:
        """True if no body closes any more: with much friction on a slim one Chipmunk does not come to an end."""
        closing = max(contact.speed for contact in found)
        return all(
            all_round(*self._balls(contact))
            or speeds_at(contact.relative_states(after), contact.point, (contact.nx, contact.ny))[0]
            <= _REMAINING * closing
            for contact in found
        )

    def _balls(self, contact: ImpactContact) -> list[Ball]:
        return [self._movers[index].ball for index in contact.balls]

    def _hopping(self, contact: ImpactContact) -> ImpactContact:
        """The contact with enough restitution to separate no slower than the slowest hop."""
        bounce, slowest = contact.bounce, self._slowest_hop
        if contact.speed <= CLOSING or bounce.restitution * contact.speed >= slowest:
            return contact
        return contact._replace(bounce=bounce._replace(restitution=slowest / contact.speed))

    def _pay_for_hops(self, before: dict[int, State], after: dict[int, State], work: float) -> None:
        """Remove the energy that minimum hops added from the motion of all balls: energy never increases by more than
        the ``work`` (J) of surfaces that move."""
        had, has = self._energy(before) + work, self._energy(after)
        if has > had:
            share = (max(0.0, had) / has) ** 0.5
            for index, (x, y, *motion) in after.items():
                after[index] = (x, y, *(share * speed for speed in motion))

    def _energy(self, states: dict[int, State]) -> float:
        """Kinetic energy in J, including rotation."""
        return sum(kinetic(self._movers[index].ball, state) for index, state in states.items())


def _hits(t: float, closed: Sequence[ImpactContact]) -> list[Hit]:
    """The contacts that closed, as hits: of two points of one contact the faster; none that is rounding, where bodies
    lie."""
    fastest: dict[tuple[tuple[int, ...], str], Hit] = {}
    least = _FAINT * max((contact.speed for contact in closed), default=0.0)
    for contact in closed:
        pair = contact.balls, contact.partner
        if contact.speed >= least and (pair not in fastest or contact.speed > fastest[pair].speed):
            fastest[pair] = Hit(t, contact.balls[0], contact.partner, contact.speed)
    return list(fastest.values())
