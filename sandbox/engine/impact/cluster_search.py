"""Impacts of balls that reach others while in contact: finds the cluster and simulates its contact."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import combinations
from math import hypot, inf
from typing import NamedTuple

import numpy as np

from sandbox.engine.contact.surfaces import bounce_of_balls, bounce_off
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.impact.cluster_parts import ClusterBall, Link
from sandbox.engine.impact.clusters import Cluster, ClusterOutcome, TooDeep, Unresolved
from sandbox.engine.impact.impacts import Hit, Outcome
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import ConstantBounce
from sandbox.engine.model.tolerances import TOUCHING_GAP
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.phase import InCluster
from sandbox.errors import RunError
from sandbox.physics.hertz import contact_time
from sandbox.physics.integrators import State

#: Depth in radii up to which a ball may enter a wall that pushes back only after the balls have separated; in a deeper
#: one the wall is rigid: against it a ball is 2 sqrt(2) times as stiff as against one of its kind. Where forces press
#: balls on one another they may stay for long, one on the other: there they get impulses.
_DEEP, _RIGID, _DEEP_IN_A_HEAP = 0.25, 8.0**0.5, 0.05

#: Fraction of the slowest blow on a heap below which a contact among its balls is left to sustained contact.
_NEGLIGIBLE = 0.0125

#: How many times as long as without damping the contact of two may last.
_LONGER = 3.0

#: Steps through a contact in one arc of the path: the cubic that joins them is as accurate.
_STEPS = 2

#: Relative gain of energy by numerical errors in a contact that ends the run; what is less is taken from the motion. In
#: the scenes of this project there is none, at any level.
_CREATED = 1e-3

#: Approach speed in m/s below which balls push rather than strike each other: these get impulses.
_FAINTEST = 1e-3


class _Blow(NamedTuple):
    """The fastest approach of two balls that touch, and what it can set in motion."""

    speed: float  # m/s
    stiffness: float  # N/m^1.5, of the two
    lasts: float  # s, for which they would touch alone
    fastest: float  # m/s, that no ball exceeds during the contact


class ClusterSearch:
    """Finds clusters among the balls of a run, according to its contact model."""

    def __init__(self, setup: Setup, movers: Sequence[MovingBall], step: float) -> None:
        """``step`` is a fraction of the shortest possible contact."""
        self._setup = setup
        self._movers = movers
        self._step = step

    def resolve(
        self, t: float, touching: dict[int, State], slow: float = 0.0, fresh: Collection[int] = ()
    ) -> Outcome | None:
        """Simulate the contact of the cluster around the balls that touch at t (with their states).

        None if impulses are right: no two balls strike each other, other forces change their speed more during the
        contact than they approach with, no other body is touched during the contact, or balls are too soft; and if
        balls of a heap that is still forming, ``fresh``, or a surface that moves can be reached. What is slower than
        ``slow`` (m/s) lasts.
        """
        model = self._setup.contact
        blow = self._hardest_blow(t, touching, max(slow, _FAINTEST)) if model.name != "rigid" else None
        if blow is None:
            return None
        members = dict(touching)
        met: set[frozenset[int]] = set()  # pairs that are within reach only as the others leave them
        hard, deep = model.wall_stiffness, _DEEP_IN_A_HEAP if slow > 0.0 else _DEEP
        reach = blow.fastest * blow.lasts  # m, up to which walls take part, if they are rigid
        while True:
            self._add_reached(t, members, blow, fresh)
            if not members.keys().isdisjoint(fresh):
                return None
            walls, room = self._walls_near(t, members, reach, hard > 0.0, deep)
            if model.name == "auto" and len(members) == 2 and self._parts_before(members, walls, blow, hard, deep):
                return None
            if any(wall.surface.motion is not None or wall.surface.kick > 0.0 for _, wall in walls):
                return None
            pairs = self._pairs(members, blow, met)
            try:
                parted = self._simulate(t, members, room, walls if hard else [], pairs, blow, hard, _NEGLIGIBLE * slow)
            except TooDeep:
                if slow > 0.0:
                    return None
                hard, reach = _RIGID * blow.stiffness, reach * (2.0 if hard else 1.0)
                continue
            except Unresolved:
                return None
            late = self._met_late(t, parted) - {frozenset(pair) for pair in pairs}
            if not late:
                alone = model.name == "auto" and len(parted.states) == 2 and len(parted.hits) == 1
                return None if alone else parted
            met |= late
            for index in frozenset().union(*late) - members.keys():
                members[index] = self._movers[index].arc.state(t)

    def _hardest_blow(self, t: float, touching: dict[int, State], slowest: float) -> _Blow | None:
        """The hardest blow among balls that touch; None if all are slower than ``slowest`` (m/s), or if other forces
        change its speed by more than that during the contact."""
        struck = [
            (self._approach(a, b), i, j)
            for (i, a), (j, b) in combinations(touching.items(), 2)
            if self._gap(i, a, j, b) <= TOUCHING_GAP
        ]
        speed, i, j = max(struck, default=(0.0, 0, 0))
        if speed <= slowest:
            return None
        first, second = self._movers[i].ball, self._movers[j].ball
        stiffness = self._setup.contact.between(first.radius, second.radius)
        lasts = contact_time(first.mass * second.mass / (first.mass + second.mass), stiffness, speed)
        pushed = [(*touching[index][:2], *self._movers[index].arc.acceleration(t)) for index in (i, j)]
        if self._approach(*pushed) * lasts > speed:  # accelerations in place of velocities
            return None
        moving = max(mover.arc.fastest() for mover in self._movers if not mover.caught)
        fastest = 2.0 * max(speed, moving) * max(first.mass, second.mass) / (first.mass + second.mass)
        return _Blow(speed, stiffness, lasts, fastest)

    # ------------------------------------------------------------------ members of the cluster

    def _gap(self, i: int, a: State, j: int, b: State) -> float:
        """The gap in m between two balls in these states."""
        return hypot(a[0] - b[0], a[1] - b[1]) - self._movers[i].ball.radius - self._movers[j].ball.radius

    @staticmethod
    def _approach(a: State, b: State) -> float:
        """The speed in m/s at which two balls approach each other."""
        dx, dy = a[0] - b[0], a[1] - b[1]
        return -((a[2] - b[2]) * dx + (a[3] - b[3]) * dy) / hypot(dx, dy)

    def _add_reached(self, t: float, members: dict[int, State], blow: _Blow, fresh: Collection[int]) -> None:
        """Add the balls that can be reached during the contact, and those that these can reach; up to a ``fresh``
        one."""
        waiting = list(members)
        while waiting and members.keys().isdisjoint(fresh):
            index = waiting.pop()
            state = members[index]
            for other, mover in enumerate(self._movers):
                if other in members or mover.caught:
                    continue
                apart = mover.ball.radius + self._movers[index].ball.radius
                far = 2.0 * apart + 2.0 * blow.fastest * blow.lasts
                left, bottom, right, top = mover.arc.box()
                if not (left - far <= state[0] <= right + far and bottom - far <= state[1] <= top + far):
                    continue
                x, y = mover.arc.position(t)
                if abs(x - state[0]) + abs(y - state[1]) > far:
                    continue
                there = mover.arc.state(t)
                towards = max(0.0, self._approach(state, there))
                if self._gap(index, state, other, there) <= (blow.fastest + towards) * blow.lasts:
                    members[other] = there
                    waiting.append(other)

    def _walls_near(
        self, t: float, members: dict[int, State], reach: float, hard: bool, deep: float
    ) -> tuple[list[tuple[int, Obstacle]], dict[int, float]]:
        """The walls within ``reach`` (m) of each ball; and how far (m) each may move before it is in a wall that is not
        among them, or that is not ``hard``, by more than ``deep`` radii."""
        near: list[tuple[int, Obstacle]] = []
        room = dict.fromkeys(members, inf)
        for index, (x, y, *_) in members.items():
            for obstacle in self._movers[index].obstacles_at(t):
                left, bottom, right, top = obstacle.box
                if max(left - x, x - right, bottom - y, y - top) > max(reach, room[index]):
                    continue  # farther than that
                gap = obstacle.near(x, y).gap
                if gap <= reach:
                    near.append((index, obstacle))
                if gap > reach or not hard:
                    room[index] = min(room[index], gap + deep * self._movers[index].ball.radius)
        return near, room

    def _parts_before(
        self, members: dict[int, State], walls: Sequence[tuple[int, Obstacle]], blow: _Blow, hard: float, deep: float
    ) -> bool:
        """True if two that strike each other part before one of these walls is touched, or entered by more than
        ``deep`` radii if it is not ``hard``: they move on with their common velocity, along their own tangents, and
        towards each other, each for as long and as far as is certain."""
        (i, a), (j, b) = members.items()
        masses, (dx, dy) = (self._movers[i].ball.mass, self._movers[j].ball.mass), (a[0] - b[0], a[1] - b[1])
        whole, apart, lasts = sum(masses), hypot(dx, dy), _LONGER * blow.lasts
        nx, ny = dx / apart, dy / apart
        common = ((masses[0] * a[2] + masses[1] * b[2]) * nx + (masses[0] * a[3] + masses[1] * b[3]) * ny) / whole
        for index, wall in walls:
            x, y, vx, vy, *_ = members[index]
            gap, wx, wy, *_ = wall.near(x, y)
            normal, along = wx * nx + wy * ny, (vx * ny - vy * nx) * (wx * ny - wy * nx)
            pressed = blow.speed * lasts * (whole - self._movers[index].ball.mass) / whole
            inward = -normal if index == i else normal
            left = gap + min(0.0, common * normal * lasts) + min(0.0, along * lasts) + min(0.0, inward * pressed)
            if left < (0.0 if hard else -deep * self._movers[index].ball.radius):
                return False
        return True

    def _pairs(self, members: dict[int, State], blow: _Blow, met: set[frozenset[int]]) -> list[tuple[int, int]]:
        """The pairs of balls that may touch during the contact, with those that are known to have ``met``."""
        apart = 2.0 * blow.fastest * blow.lasts + TOUCHING_GAP
        return [
            (i, j)
            for i, j in combinations(members, 2)
            if frozenset((i, j)) in met or self._gap(i, members[i], j, members[j]) <= apart
        ]

    def _met_late(self, t: float, parted: Outcome) -> set[frozenset[int]]:
        """The pairs, of a ball that was touched and any other, that come to overlap on straight lines from t until the
        balls have separated."""
        lines = {}
        for index, mover in enumerate(self._movers):
            if not mover.caught:
                end = parted.states[index][:2] if index in parted.states else mover.arc.position(parted.t)
                lines[index] = (*mover.arc.position(t), *end)
        pairs = set()
        for index in parted.states:
            x, y, u, v = lines[index]
            for other, (ox, oy, ou, ov) in lines.items():
                ax, ay, bx, by = x - ox, y - oy, u - ou, v - ov
                reach = self._movers[index].ball.radius + self._movers[other].ball.radius - TOUCHING_GAP
                if other != index and _nearest(ax, ay, bx - ax, by - ay) < reach:
                    pairs.add(frozenset((index, other)))
        return pairs

    # ------------------------------------------------------------------ from movers to the cluster and back

    def _simulate(
        self,
        t: float,
        members: dict[int, State],
        room: dict[int, float],
        walls: Sequence[tuple[int, Obstacle]],
        pairs: Sequence[tuple[int, int]],
        blow: _Blow,
        wall_stiffness: float,
        negligible: float,
    ) -> Outcome:
        """The outcome of the cluster of these members, walls and pairs."""
        place = {index: number for number, index in enumerate(members)}
        balls = [self._ball(t, index, state, room[index]) for index, state in members.items()]
        contacts = [(i, self._movers[j].ball.name, self._link(place, members, i, j, blow.speed)) for i, j in pairs]
        for index, obstacle in walls:
            link = self._wall_link(place[index], members[index], obstacle, wall_stiffness)
            contacts.append((index, obstacle.surface.name, link))
        links = [link for *_, link in contacts]
        outcome = Cluster(balls, links, self._setup.contact.along).pass_through(self._step, negligible)
        if outcome.gained > _CREATED * outcome.energy:
            names = ", ".join(sorted(repr(self._movers[index].ball.name) for index in members))
            raise RunError(
                f"t = {t:.6g} s: {outcome.gained:.3g} J appeared from nothing in the contact of {names}, whose kinetic "
                f"energy was {outcome.energy:.3g} J; try a finer accuracy"
            )
        touched = np.flatnonzero(outcome.approach > 0.0).tolist()
        closed, approach = (t + outcome.closed).tolist(), outcome.approach.tolist()
        hits = [Hit(closed[link], contacts[link][0], contacts[link][1], approach[link]) for link in touched]
        hit = dict.fromkeys(place for link in touched for place in links[link][:2] if place is not None)
        indices = [*members]
        found = _arcs(t, outcome, {place: len(members[indices[place]]) for place in hit})
        arcs = {indices[place]: each for place, each in found.items()}
        until = t + float(outcome.times[-1])
        return Outcome(until, {index: each[-1].state(until) for index, each in arcs.items()}, sorted(hits), arcs)

    def _ball(self, t: float, index: int, state: State, room: float) -> ClusterBall:
        mover = self._movers[index]
        ball, acceleration = mover.ball, mover.arc.acceleration(t)
        spin = (*state[5:7], state[4]) if len(state) > 5 else (0.0, 0.0, state[4])
        return ClusterBall(ball.mass, ball.radius, ball.inertia, state[:2], state[2:4], spin, acceleration, room)

    def _link(self, place: dict[int, int], members: dict[int, State], i: int, j: int, speed: float) -> Link:
        first, second = self._movers[i].ball, self._movers[j].ball
        approach = max(speed, self._approach(members[i], members[j]))
        bounce = bounce_of_balls(self._setup, approach, 0.0, first.name, second.name)
        law = self._setup.between(first.name, second.name)
        stiffness = self._setup.contact.between(first.radius, second.radius)
        return Link(place[i], place[j], stiffness, bounce.restitution, law, approach)

    def _wall_link(self, place: int, state: State, obstacle: Obstacle, stiffness: float) -> Link:
        touching = obstacle.near(state[0], state[1])
        approach = max(0.0, -(state[2] * touching.nx + state[3] * touching.ny))
        bounce = bounce_off(obstacle.surface, approach, state[2] * touching.ny - state[3] * touching.nx)
        return Link(place, None, stiffness, bounce.restitution, ConstantBounce(bounce), approach, obstacle.near)


def _arcs(t: float, outcome: ClusterOutcome, components: dict[int, int]) -> dict[int, list[Arc]]:
    """The path of each ball in ``components``, which says how many numbers its state has, by its place in the cluster;
    the contact begins at t. Positions are the cubics that match velocities, too."""
    every = [*range(0, len(outcome.times) - 1, _STEPS), len(outcome.times) - 1]
    times, motion = t + outcome.times[every], outcome.motion[every][:, [*components]]
    here, there, h = motion[:-1], motion[1:], np.diff(times)[:, None, None]
    (a, u), (b, v) = ((states[..., :2], states[..., 2:4] * h / 3.0) for states in (here, there))
    positions = np.stack((a, a + u, b - v, b), axis=-1)
    velocities = 3.0 * np.diff(positions) / h[..., None]
    spins = np.stack((here[..., 4:], there[..., 4:]), axis=-1)
    curves = zip(*(each.swapaxes(0, 1).tolist() for each in (positions, velocities, spins)), strict=True)
    moments, of_balls = times.tolist(), motion.swapaxes(0, 1).tolist()
    contact = InCluster(moments[0], moments[-1])
    arcs = {}
    for (place, count), numbers, pieces in zip(components.items(), of_balls, curves, strict=True):
        states = [tuple(state[:count]) for state in numbers]
        arcs[place] = [
            Arc(t0, t1, start, (*position, *velocity, *spin[: count - 4]), contact, end)
            for t0, t1, start, end, position, velocity, spin in zip(
                moments[:-1], moments[1:], states[:-1], states[1:], *pieces, strict=True
            )
        ]
    return arcs


def _nearest(x: float, y: float, dx: float, dy: float) -> float:
    """The smallest distance in m from the origin of a point on its straight path from (x, y) by (dx, dy)."""
    far = dx * dx + dy * dy
    along = min(1.0, max(0.0, -(x * dx + y * dy) / far)) if far > 0.0 else 0.0
    return hypot(x + along * dx, y + along * dy)
