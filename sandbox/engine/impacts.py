"""Impacts at one instant: which bodies touch, the properties of each contact, and the exchange of impulses."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import combinations
from math import hypot
from typing import NamedTuple

from sandbox.engine.contacts import BallAtImpact, Contact, ImpulseSpace
from sandbox.engine.on_cloth import in_plane, off_nose, rubbed, slip_over
from sandbox.engine.setup import Bounce, Setup, kinetic
from sandbox.engine.surfaces import STILL, bounce_of_balls, bounce_off
from sandbox.engine.touch import TOUCHING_GAP, Touching
from sandbox.engine.track import Track
from sandbox.physics.integrators import State

#: Largest relative energy gain of a cluster in an impact: rounding in Chipmunk's iterations.
_GAIN = 1e-7

#: Alternations between balls and walls at one instant, after which all exchange impulses at once.
_TURNS = 9


class Hit(NamedTuple):
    """One contact that closed."""

    ball: int  # index into the balls of the setup
    partner: str
    speed: float  # m/s, normal speed of approach


class Impacts:
    """Resolves impacts among the balls of a run."""

    def __init__(self, setup: Setup, tracks: Sequence[Track], contacts: ImpulseSpace, slowest_hop: float) -> None:
        self._setup = setup
        self._tracks = tracks
        self._contacts = contacts
        self._slowest_hop = slowest_hop  # m/s, minimum speed at which balls on cloth separate
        # Walls softer than balls push back after the balls have separated.
        self._soft_walls = (
            len(setup.balls) > 1 and setup.contact.name != "rigid" and setup.contact.wall_stiffness == 0.0
        )
        self._noses = any(surface.nose_height is not None for surface in setup.surfaces)
        self._heaviest = max(ball.mass for ball in setup.balls)  # kg

    def exchange(self, states: dict[int, State]) -> tuple[dict[int, State], list[Hit]]:
        """The states after the impact of balls that touch, directly or through others, and the hits.

        If walls are softer than balls, balls exchange impulses first and the walls push back afterwards.
        """
        if self._soft_walls or self._noses:
            hits: list[Hit] = []
            before = states
            for turn in range(_TURNS):
                if turn % 2 == 0:
                    after = self._exchange_at_once(before, True if self._soft_walls else None, hits)
                else:
                    after = self._exchange_at_once(before, False, hits) if self._soft_walls else None
                    after = self._off_noses(after or before, hits) or after
                if after is None and turn > 0:
                    return before, hits
                before = after or before
            if self._noses:
                return before, hits
        hits = []
        return self._exchange_at_once(states, None, hits) or states, hits

    def _off_noses(self, states: dict[int, State], hits: list[Hit]) -> dict[int, State] | None:
        """The states after each ball has met the cushion noses it touches, one after another; None if there are
        none."""
        after = dict(states)
        for index, state in states.items():
            ball = self._tracks[index].ball
            for obstacle, touching in self._tracks[index].near(*state[:2]):
                surface, (nx, ny) = obstacle.surface, (touching.nx, touching.ny)
                vx, vy = after[index][2:4]
                approach, along = -(vx * nx + vy * ny), vx * ny - vy * nx
                if surface.nose_height is None or approach <= STILL:
                    continue
                bounce = bounce_off(surface, approach, along)
                x, y, vx, vy, *spins = off_nose(ball, after[index], (nx, ny), surface.nose_height, bounce)
                slow = max(0.0, self._slowest_hop - (vx * nx + vy * ny))
                after[index] = (x, y, vx + slow * nx, vy + slow * ny, *spins)
                hits.append(Hit(index, surface.name, approach))
        if after == states:
            return None
        self._pay_for_hops(states, after)
        return after

    def _exchange_at_once(
        self, states: dict[int, State], balls_only: bool | None, hits: list[Hit]
    ) -> dict[int, State] | None:
        """The states after all contacts, or only those between balls, or only those with walls, closed at once; None if
        none closed."""
        found = [] if balls_only is True else [*self._with_surfaces(states)]
        found += [] if balls_only is False else [*self._with_balls(states)]
        if not any(contact.approach > STILL for contact in found):
            return None
        after = self._after(states, found)
        if self._slowest_hop > 0.0:
            self._pay_for_hops(states, after)
        members = list(states)
        closed = [contact for contact in found if contact.approach > STILL]
        hits += [Hit(members[contact.first], contact.partner, contact.approach) for contact in closed]
        return after

    def _after(self, states: dict[int, State], found: Sequence[Contact]) -> dict[int, State]:
        """The states after the exchange of impulses; balls on cloth separate no slower than the slowest hop."""
        cluster = [BallAtImpact(index, *state[:5]) for index, state in states.items()]
        self._exchange_without_gain(cluster, [_hopping(contact, self._slowest_hop) for contact in found])
        after = {
            moving.index: (*states[moving.index][:2], moving.vx, moving.vy, moving.spin, *states[moving.index][5:])
            for moving in cluster
        }
        for contact, push in zip(found, self._contacts.normal_impulses, strict=True):
            if contact.slip[1] != 0.0 and push > 0.0:
                pair = [cluster[place].index for place in (contact.first, contact.second) if place is not None]
                balls, before = [self._tracks[index].ball for index in pair], [after[index] for index in pair]
                normal = contact.nx, contact.ny
                after.update(
                    zip(pair, rubbed(balls, before, normal, contact.slip, contact.friction * push), strict=True)
                )
        return after

    def _pay_for_hops(self, before: dict[int, State], after: dict[int, State]) -> None:
        """Remove the energy that minimum hops added from the motion of all balls: energy never increases."""
        had, has = self._energy(before), self._energy(after)
        if has > had:
            share = (had / has) ** 0.5
            for index, (x, y, *motion) in after.items():
                after[index] = (x, y, *(share * speed for speed in motion))

    def _exchange_without_gain(self, cluster: Sequence[BallAtImpact], found: Sequence[Contact]) -> None:
        """Exchange impulses without gaining energy.

        If several contacts close at once, restitution may demand more energy than there is. With friction this is
        known as Kane's paradox (the slip reverses while the normal speeds are imposed): friction is reduced, down to
        zero. If energy still increases, as when a light ball is squeezed between a wall and a heavy ball, restitution
        is reduced: with both at zero no energy is gained."""
        if len(found) == 1:
            self._contacts.exchange(cluster, found)
            return
        start = [replace(moving) for moving in cluster]
        self._contacts.exchange(cluster, found)
        most = (1.0 + _GAIN) * self._in_the_plane(start) + len(found) * self._heaviest * self._slowest_hop**2
        friction = restitution = 1.0
        while self._in_the_plane(cluster) > most and restitution > 0.0:
            if friction > 0.0:
                friction = 0.5 * friction if friction > 1e-3 else 0.0
            else:
                restitution = 0.9 * restitution if restitution > 1e-2 else 0.0
            for moving, before in zip(cluster, start, strict=True):
                moving.vx, moving.vy, moving.spin = before.vx, before.vy, before.spin
            self._contacts.exchange(cluster, [_weaker(contact, friction, restitution) for contact in found])

    def _in_the_plane(self, cluster: Sequence[BallAtImpact]) -> float:
        return self._energy({moving.index: (0.0, 0.0, moving.vx, moving.vy, moving.spin) for moving in cluster})

    def _energy(self, states: dict[int, State]) -> float:
        """Kinetic energy in J, including rotation."""
        return sum(kinetic(self._tracks[index].ball, state) for index, state in states.items())

    def touching(self, t: float, seeds: Sequence[int]) -> dict[int, State]:
        """The states at t of all balls that touch those in ``seeds``, directly or through others."""
        states: dict[int, State] = {}
        waiting = list(seeds)
        while waiting:
            index = waiting.pop(0)
            if index in states:
                continue
            track = self._tracks[index]
            states[index] = state = track.arc.state(t)
            for other, neighbour in enumerate(self._tracks):
                if other in states or neighbour.caught:
                    continue
                reach = track.ball.radius + neighbour.ball.radius + TOUCHING_GAP
                x, y = neighbour.arc.position(t)
                if (x - state[0]) ** 2 + (y - state[1]) ** 2 <= reach * reach:
                    waiting.append(other)
        return states

    def _with_surfaces(self, states: dict[int, State]) -> Iterator[Contact]:
        for place, (index, state) in enumerate(states.items()):
            ball, (x, y, vx, vy, spin, *_) = self._tracks[index].ball, state
            met: list[Touching] = []
            for obstacle, touching in self._tracks[index].near(x, y):
                nx, ny = touching.nx, touching.ny
                if obstacle.surface.nose_height is not None or any(
                    nx * other.nx + ny * other.ny > 1.0 - 1e-12 for other in met
                ):
                    continue  # flush with a surface already counted
                met.append(touching)
                approach, along = -(vx * nx + vy * ny), vx * ny - vy * nx
                slip = along + ball.radius * spin, slip_over(ball, state, nx, ny)
                bounce, forward = bounce_off(obstacle.surface, approach, along), 1.0 if along >= 0.0 else -1.0
                yield _contact(place, None, (nx, ny), bounce, approach, forward, obstacle.surface.name, slip)

    def _with_balls(self, states: dict[int, State]) -> Iterator[Contact]:
        for (place, (i, here)), (later, (j, there)) in combinations(enumerate(states.items()), 2):
            a, b = self._tracks[i].ball, self._tracks[j].ball
            (x, y, vx, vy, spin), (u, v, wx, wy, other_spin) = here[:5], there[:5]
            distance = ((x - u) ** 2 + (y - v) ** 2) ** 0.5
            if distance > a.radius + b.radius + TOUCHING_GAP:
                continue
            nx, ny = (x - u) / distance, (y - v) / distance
            approach = (wx - vx) * nx + (wy - vy) * ny
            flat = (vx - wx) * ny - (vy - wy) * nx + a.radius * spin + b.radius * other_spin
            slip = flat, slip_over(a, here, nx, ny) - slip_over(b, there, -nx, -ny)
            bounce = bounce_of_balls(self._setup, approach, hypot(*slip), a.name, b.name)
            yield _contact(place, later, (nx, ny), bounce, approach, 1.0, b.name, slip)


def _contact(
    first: int,
    second: int | None,
    normal: tuple[float, float],
    bounce: Bounce,
    approach: float,
    forward: float,
    partner: str,
    slip: tuple[float, float],
) -> Contact:
    """The contact as passed to pymunk, which sees only the plane."""
    flat = bounce._replace(friction=in_plane(bounce.friction, *slip))
    return Contact(first, second, *normal, flat, approach, forward, partner, bounce.friction, slip)


def _hopping(contact: Contact, slowest: float) -> Contact:
    """The contact with enough restitution to separate at ``slowest`` (m/s) or faster."""
    bounce, approach = contact.bounce, contact.approach
    if approach <= STILL or bounce.restitution * approach >= slowest:
        return contact
    return replace(contact, bounce=bounce._replace(restitution=slowest / approach))


def _weaker(contact: Contact, friction: float, restitution: float) -> Contact:
    """The contact with its friction and restitution multiplied by these factors."""
    bounce = contact.bounce
    less = bounce._replace(restitution=restitution * bounce.restitution, friction=friction * bounce.friction)
    return replace(contact, bounce=less)
