"""One instant of impact: who touches whom, what each contact is like, and the exchange of impulses."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import hypot
from typing import NamedTuple

from sandbox.engine.contacts import Contact, Contacts, Moving
from sandbox.engine.on_cloth import looseness, rub_over, slip_over
from sandbox.engine.setup import Ball, Bounce, Setup
from sandbox.engine.surfaces import STILL, answer, answer_of_balls
from sandbox.engine.touch import CONTACT
from sandbox.engine.track import Track
from sandbox.physics.integrators import State

#: Share of the energy that a cluster may gain in an impact: the rounding of Chipmunk's rounds.
_GAIN = 1e-7


#: Turns of balls and walls at one instant, after which all exchange their impulses at once.
_TURNS = 9


class Hit(NamedTuple):
    """One contact that closed."""

    ball: int  # its place among the balls of the setup
    partner: str
    speed: float  # m/s, normal speed of approach


class Impacts:
    """Resolves impacts among the balls of a run."""

    def __init__(self, setup: Setup, tracks: Sequence[Track], contacts: Contacts, slowest_hop: float) -> None:
        self._setup = setup
        self._tracks = tracks
        self._contacts = contacts
        self._slowest_hop = slowest_hop  # m/s, at which balls on cloth part at least
        # Walls that give way more than balls push back when the balls have parted.
        self._gives_way = len(setup.balls) > 1 and setup.contact.name != "rigid" and setup.contact.wall_stiffness == 0.0
        self._heaviest = max(ball.mass for ball in setup.balls)  # kg

    def exchange(self, states: dict[int, State]) -> tuple[dict[int, State], list[Hit]]:
        """The states after the impact of balls that touch, directly or through others, and what closed.

        Where walls give way more than balls, balls exchange their impulses first and the walls push back afterwards.
        """
        if self._gives_way:
            hits: list[Hit] = []
            before = states
            for turn in range(_TURNS):
                after = self._exchange_at_once(before, turn % 2 == 0, hits)
                if after is None and turn > 0:
                    return before, hits
                before = after or before
        hits = []
        return self._exchange_at_once(states, None, hits) or states, hits

    def _exchange_at_once(
        self, states: dict[int, State], balls_only: bool | None, hits: list[Hit]
    ) -> dict[int, State] | None:
        """The states after all contacts, or those of balls only, or of walls only, closed at once; None if none did."""
        members = list(states)
        cluster = [Moving(index, *states[index][:5]) for index in members]
        found: list[Contact] = []
        partners: list[tuple[int, str]] = []
        slips: list[tuple[float, float]] = []  # m/s, in the plane and upward
        if balls_only is not True:
            for place, index in enumerate(members):
                self._meet_surfaces(place, index, states[index], found, partners, slips)
        if balls_only is not False:
            for place in range(len(members)):
                for later in range(place + 1, len(members)):
                    self._meet_ball(place, later, members, states, found, partners, slips)
        if not any(contact.approach > STILL for contact in found):
            return None
        self._exchange_without_gain(cluster, found)
        after = {
            moving.index: (*states[moving.index][:2], moving.vx, moving.vy, moving.spin, *states[moving.index][5:])
            for moving in cluster
        }
        if self._setup.cloth is not None:
            self._rub(members, states, after, found, slips)
        hits += [
            Hit(index, partner, contact.approach)
            for contact, (index, partner) in zip(found, partners, strict=True)
            if contact.approach > STILL
        ]
        return after

    def _exchange_without_gain(self, cluster: Sequence[Moving], found: Sequence[Contact]) -> None:
        """Exchange impulses. Where several contacts close at once, the speeds with which they are to part may ask for
        energy that is not there. Restitution beside friction is known for it as Kane's paradox (the slip turns over
        while the normal speeds are forced back): friction then counts for less, down to nothing. If it is not that,
        as where a light ball is squeezed between a wall and a heavy one, restitution does: without either nothing is
        gained."""
        start = [replace(moving) for moving in cluster]
        self._contacts.exchange(cluster, found)
        if len(found) == 1:
            return
        most = (1.0 + _GAIN) * self._energy(start) + self._hops(found)
        friction = restitution = 1.0
        while self._energy(cluster) > most and restitution > 0.0:
            if friction > 0.0:
                friction = 0.5 * friction if friction > 1e-3 else 0.0
            else:
                restitution = 0.9 * restitution if restitution > 1e-2 else 0.0
            for moving, before in zip(cluster, start, strict=True):
                moving.vx, moving.vy, moving.spin = before.vx, before.vy, before.spin
            self._contacts.exchange(cluster, [_weaker(contact, friction, restitution) for contact in found])

    def _hops(self, found: Sequence[Contact]) -> float:
        """The energy in J that the slowest hops of balls on cloth may take: at most their speed at each contact."""
        return len(found) * self._heaviest * self._slowest_hop**2

    def _energy(self, cluster: Sequence[Moving]) -> float:
        """Kinetic energy in J, that of turning in the plane included."""
        total = 0.0
        for moving in cluster:
            ball = self._tracks[moving.index].ball
            total += 0.5 * ball.mass * (moving.vx * moving.vx + moving.vy * moving.vy)
            total += 0.5 * ball.inertia * moving.spin * moving.spin
        return total

    def touching(self, t: float, seeds: Sequence[int]) -> dict[int, State]:
        """The states at t of all balls that touch those of ``seeds``, directly or through others."""
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
                reach = track.ball.radius + neighbour.ball.radius + CONTACT
                x, y = neighbour.arc.position(t)
                if (x - state[0]) ** 2 + (y - state[1]) ** 2 <= reach * reach:
                    waiting.append(other)
        return states

    def _meet_surfaces(
        self,
        place: int,
        index: int,
        state: State,
        found: list[Contact],
        partners: list[tuple[int, str]],
        slips: list[tuple[float, float]],
    ) -> None:
        track = self._tracks[index]
        x, y, vx, vy, spin = state[:5]
        first = len(found)
        for obstacle, touching in track.near(x, y):
            nx, ny = touching.nx, touching.ny
            if any(nx * other.nx + ny * other.ny > 1.0 - 1e-12 for other in found[first:]):
                continue  # laid flush with one already met
            approach = -(vx * nx + vy * ny)
            along = vx * ny - vy * nx
            slip = (along + track.ball.radius * spin, self._upward(index, state, nx, ny))
            surface = obstacle.surface
            bounce = answer(surface, approach, along)
            forward = 1.0 if along >= 0.0 else -1.0
            found.append(
                Contact(place, None, nx, ny, self._shared(bounce, approach, slip), bounce.friction, approach, forward)
            )
            partners.append((index, surface.name))
            slips.append(slip)

    def _meet_ball(
        self,
        place: int,
        later: int,
        members: Sequence[int],
        states: dict[int, State],
        found: list[Contact],
        partners: list[tuple[int, str]],
        slips: list[tuple[float, float]],
    ) -> None:
        i, j = members[place], members[later]
        a, b = self._tracks[i].ball, self._tracks[j].ball
        x, y, vx, vy, spin = states[i][:5]
        u, v, wx, wy, other_spin = states[j][:5]
        distance = ((x - u) ** 2 + (y - v) ** 2) ** 0.5
        if distance > a.radius + b.radius + CONTACT:
            return
        nx, ny = (x - u) / distance, (y - v) / distance
        approach = (wx - vx) * nx + (wy - vy) * ny
        flat = (vx - wx) * ny - (vy - wy) * nx + a.radius * spin + b.radius * other_spin
        slip = (flat, self._upward(i, states[i], nx, ny) - self._upward(j, states[j], -nx, -ny))
        bounce = answer_of_balls(self._setup, approach, hypot(*slip), b.name)
        found.append(
            Contact(place, later, nx, ny, self._shared(bounce, approach, slip), bounce.friction, approach, 1.0)
        )
        partners.append((i, b.name))
        slips.append(slip)

    # ------------------------------------------------------------------ balls on cloth, whose spin has three components

    def _upward(self, index: int, state: State, nx: float, ny: float) -> float:
        return slip_over(self._tracks[index].ball, state, nx, ny) if len(state) > 5 else 0.0

    def _shared(self, bounce: Bounce, approach: float, slip: tuple[float, float]) -> Bounce:
        """What pymunk, which sees the plane alone, is told: the plane's share of the friction.

        Friction acts against the whole slip and all directions of a sphere's surface give way alike, so its part in
        the plane is to the whole as that part of the slip is, sticking or sliding.
        """
        flat, upward = slip
        if upward != 0.0:
            bounce = bounce._replace(friction=bounce.friction * abs(flat) / hypot(flat, upward))
        if approach > STILL and bounce.restitution * approach < self._slowest_hop:
            bounce = bounce._replace(restitution=self._slowest_hop / approach)
        return bounce

    def _rub(
        self,
        members: Sequence[int],
        before: dict[int, State],
        after: dict[int, State],
        found: Sequence[Contact],
        slips: Sequence[tuple[float, float]],
    ) -> None:
        """The upward share of the friction, in closed form from the normal impulse that pymunk found."""
        pushes = self._contacts.normal_impulses
        for contact, (flat, upward), push in zip(found, slips, pushes, strict=True):
            if upward == 0.0 or push <= 0.0:
                continue
            i = members[contact.first]
            balls: list[tuple[int, Ball]] = [(i, self._tracks[i].ball)]
            if contact.second is not None:
                j = members[contact.second]
                balls.append((j, self._tracks[j].ball))
            share = abs(upward) / hypot(flat, upward)
            most = contact.full_friction * push * share
            stopping = abs(upward) / sum(looseness(ball) for _, ball in balls)
            impulse = -min(most, stopping) if upward > 0.0 else min(most, stopping)
            for index, ball in balls:
                after[index] = rub_over(ball, after[index], contact.nx, contact.ny, impulse)


def _weaker(contact: Contact, friction: float, restitution: float) -> Contact:
    """The contact with shares of its friction and of its restitution."""
    bounce = contact.bounce
    less = bounce._replace(restitution=restitution * bounce.restitution, friction=friction * bounce.friction)
    return replace(contact, bounce=less)
