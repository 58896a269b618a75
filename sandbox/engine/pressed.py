"""Impacts of balls that reach others while in contact: finds the cluster and simulates its contact."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from itertools import combinations
from math import hypot, inf

import numpy as np

from sandbox.engine.arc import Arc
from sandbox.engine.clusters import Asking, Body, Cluster, Entered, Link, Unresolved
from sandbox.engine.impacts import Hit, Outcome
from sandbox.engine.setup import Always, Setup
from sandbox.engine.surfaces import bounce_of_balls, bounce_off
from sandbox.engine.touch import TOUCHING_GAP, Obstacle
from sandbox.engine.track import Pressing, Track
from sandbox.physics.hertz import contact_time
from sandbox.physics.integrators import State

#: Depth in radii up to which a ball may enter a wall that pushes back only after the balls have separated; in a deeper
#: one the wall is rigid: against it a ball is 2 sqrt(2) times as stiff as against one of its kind. Where forces press
#: balls on one another they may stay for long, one on the other: there they get impulses.
_DEEP, _RIGID, _DEEP_IN_A_HEAP = 0.25, 8.0**0.5, 0.05

#: Share of the slowest blow on a heap that a contact among its balls leaves to lasting contact.
_LEFT = 0.0125

#: Steps through a contact in one arc of the path: the cubic that joins them is as accurate.
_STEPS = 2

#: Approach speed in m/s below which balls push rather than strike each other: these get impulses.
FAINTEST = 1e-3


class Pressed:
    """Finds clusters among the balls of a run, according to its contact model."""

    def __init__(self, setup: Setup, tracks: Sequence[Track], step: float) -> None:
        """``step`` is a fraction of the shortest possible contact."""
        self._setup = setup
        self._tracks = tracks
        self._step = step

    def through(
        self, t: float, touching: dict[int, State], slow: float = 0.0, fresh: Collection[int] = ()
    ) -> Asking[Outcome | None]:
        """Simulate the contact of the cluster around the balls that touch at t (with their states).

        None if impulses are right: no two balls strike each other, other forces change their speed more during the
        contact than they approach with, no other body is touched during the contact, or balls are too soft; and if
        balls of a heap that is still forming, ``fresh``, can be reached. What is slower than ``slow`` (m/s) lasts.
        """
        model = self._setup.contact
        struck = [
            (self._approach(a, b), i, j)
            for (i, a), (j, b) in combinations(touching.items(), 2)
            if self._gap(i, a, j, b) <= TOUCHING_GAP
        ]
        speed, i, j = max(struck, default=(0.0, 0, 0))
        if model.name == "rigid" or speed <= max(slow, FAINTEST):
            return None
        first, second = self._tracks[i].ball, self._tracks[j].ball
        mass = first.mass * second.mass / (first.mass + second.mass)
        stiffness = model.between(first.radius, second.radius)
        lasts = contact_time(mass, stiffness, speed)
        pushed = [(*touching[index][:2], *self._tracks[index].arc.acceleration(t)) for index in (i, j)]
        if self._approach(*pushed) * lasts > speed:  # in place of velocities
            return None
        moving = max(track.arc.fastest() for track in self._tracks if not track.caught)
        fastest = 2.0 * max(speed, moving) * max(first.mass, second.mass) / (first.mass + second.mass)
        members = dict(touching)
        met: set[frozenset[int]] = set()  # pairs that are within reach only as the others leave them
        hard, deep = model.wall_stiffness, _DEEP_IN_A_HEAP if slow > 0.0 else _DEEP
        reach = fastest * lasts  # m, up to which walls take part, if they are rigid
        while True:
            self._add_reached(t, members, fastest, lasts, fresh)
            if not members.keys().isdisjoint(fresh):
                return None
            room = dict.fromkeys(members, inf)
            near: list[tuple[int, Obstacle]] = []
            for index, (x, y, *_) in members.items():
                for obstacle in self._tracks[index].obstacles:
                    left, bottom, right, top = obstacle.box
                    if max(left - x, x - right, bottom - y, y - top) > max(reach, room[index]):
                        continue  # farther than that
                    gap = obstacle.near(x, y).gap
                    if gap <= reach:
                        near.append((index, obstacle))
                    if gap > reach or not hard:
                        room[index] = min(room[index], gap + deep * self._tracks[index].ball.radius)
            if model.name == "auto" and len(members) == 2 and not near:
                return None
            walls = near if hard else []
            pairs = [
                (i, j)
                for i, j in combinations(members, 2)
                if frozenset((i, j)) in met
                or self._gap(i, members[i], j, members[j]) <= 2.0 * fastest * lasts + TOUCHING_GAP
            ]
            try:
                parted = yield from self._passed(t, members, room, walls, pairs, speed, hard, _LEFT * slow)
            except Entered:
                if slow > 0.0:
                    return None
                hard, reach = _RIGID * stiffness, reach * (2.0 if hard else 1.0)
                continue
            except Unresolved:
                return None
            late = self._met_late(t, parted) - {frozenset(pair) for pair in pairs}
            if late:
                met |= late
                for index in frozenset().union(*late) - members.keys():
                    members[index] = self._tracks[index].arc.state(t)
            else:
                alone = model.name == "auto" and len(parted.states) == 2 and len(parted.hits) == 1
                return None if alone else parted

    # ------------------------------------------------------------------ members of the cluster

    def _gap(self, i: int, a: State, j: int, b: State) -> float:
        return hypot(a[0] - b[0], a[1] - b[1]) - self._tracks[i].ball.radius - self._tracks[j].ball.radius

    @staticmethod
    def _approach(a: State, b: State) -> float:
        dx, dy = a[0] - b[0], a[1] - b[1]
        return -((a[2] - b[2]) * dx + (a[3] - b[3]) * dy) / hypot(dx, dy)

    def _add_reached(
        self, t: float, members: dict[int, State], fastest: float, lasts: float, fresh: Collection[int]
    ) -> None:
        """Add the balls that can be reached during the contact, and those that these can reach; up to a ``fresh``
        one."""
        waiting = list(members)
        while waiting and members.keys().isdisjoint(fresh):
            index = waiting.pop()
            state = members[index]
            for other, track in enumerate(self._tracks):
                if other in members or track.caught:
                    continue
                x, y = track.arc.position(t)
                apart = track.ball.radius + self._tracks[index].ball.radius
                if abs(x - state[0]) + abs(y - state[1]) > 2.0 * apart + 2.0 * fastest * lasts:
                    continue
                there = track.arc.state(t)
                towards = max(0.0, self._approach(state, there))
                if self._gap(index, state, other, there) <= (fastest + towards) * lasts:
                    members[other] = there
                    waiting.append(other)

    def _met_late(self, t: float, parted: Outcome) -> set[frozenset[int]]:
        """The pairs, of a ball that was touched and any other, that come to overlap on straight ways from t until the
        balls have separated."""
        ways = {}
        for index, track in enumerate(self._tracks):
            if not track.caught:
                end = parted.states[index][:2] if index in parted.states else track.arc.position(parted.t)
                ways[index] = (*track.arc.position(t), *end)
        pairs = set()
        for index in parted.states:
            x, y, u, v = ways[index]
            for other, (ox, oy, ou, ov) in ways.items():
                ax, ay, bx, by = x - ox, y - oy, u - ou, v - ov
                reach = self._tracks[index].ball.radius + self._tracks[other].ball.radius - TOUCHING_GAP
                if other != index and _nearest(ax, ay, bx - ax, by - ay) < reach:
                    pairs.add(frozenset((index, other)))
        return pairs

    # ------------------------------------------------------------------ from tracks to bodies and back

    def _passed(
        self,
        t: float,
        members: dict[int, State],
        room: dict[int, float],
        walls: Sequence[tuple[int, Obstacle]],
        pairs: Sequence[tuple[int, int]],
        speed: float,
        hard: float,
        faint: float,
    ) -> Asking[Outcome]:
        place = {index: number for number, index in enumerate(members)}
        bodies = [self._body(t, index, state, room[index]) for index, state in members.items()]
        contacts: list[tuple[tuple[int, ...], str, Link]] = [
            ((i, j), self._tracks[j].ball.name, self._link(place, members, i, j, speed)) for i, j in pairs
        ]
        for index, obstacle in walls:
            link = self._wall_link(place[index], members[index], obstacle, hard)
            contacts.append(((index,), obstacle.surface.name, link))
        outcome = yield Cluster(bodies, [link for *_, link in contacts]), self._step, faint
        touched = np.flatnonzero(outcome.approach > 0.0).tolist()
        closed, approach = (t + outcome.closed).tolist(), outcome.approach.tolist()
        hits = [Hit(closed[link], contacts[link][0][0], contacts[link][1], approach[link]) for link in touched]
        times = t + outcome.times
        hit = [*{ball: None for link in touched for ball in contacts[link][0]}]
        motion, components = outcome.motion[:, [place[index] for index in hit]], [len(members[index]) for index in hit]
        arcs = dict(zip(hit, _arcs(times, motion, components), strict=True))
        until = float(times[-1])
        return Outcome(until, {index: each[-1].state(until) for index, each in arcs.items()}, sorted(hits), arcs)

    def _body(self, t: float, index: int, state: State, room: float) -> Body:
        track = self._tracks[index]
        ball, push = track.ball, track.arc.acceleration(t)
        turning = (*state[5:7], state[4]) if len(state) > 5 else (0.0, 0.0, state[4])
        return Body(ball.mass, ball.radius, ball.inertia, state[:2], state[2:4], turning, push, room)

    def _link(self, place: dict[int, int], members: dict[int, State], i: int, j: int, speed: float) -> Link:
        first, second = self._tracks[i].ball, self._tracks[j].ball
        approach = max(speed, self._approach(members[i], members[j]))
        bounce = bounce_of_balls(self._setup, approach, 0.0, first.name, second.name)
        law = self._setup.between(first.name, second.name)
        stiffness = self._setup.contact.between(first.radius, second.radius)
        return Link(place[i], place[j], stiffness, bounce.restitution, law, approach)

    def _wall_link(self, place: int, state: State, obstacle: Obstacle, stiffness: float) -> Link:
        touching = obstacle.near(state[0], state[1])
        approach = max(0.0, -(state[2] * touching.nx + state[3] * touching.ny))
        bounce = bounce_off(obstacle.surface, approach, state[2] * touching.ny - state[3] * touching.nx)
        return Link(place, None, stiffness, bounce.restitution, Always(bounce), approach, obstacle.near)


def _arcs(times: np.ndarray, motion: np.ndarray, components: Sequence[int]) -> Iterator[list[Arc]]:
    """The path of each ball through its states at these times, shape (times, balls, 7), of which it has so many
    ``components``: places are the cubics that match velocities, too."""
    times, motion = np.concatenate((times[:-1:_STEPS], times[-1:])), np.concatenate((motion[:-1:_STEPS], motion[-1:]))
    here, there, h = motion[:-1], motion[1:], np.diff(times)[:, None, None]
    (a, u), (b, v) = ((states[..., :2], states[..., 2:4] * h / 3.0) for states in (here, there))
    places = np.stack((a, a + u, b - v, b), axis=-1)
    speeds = 3.0 * np.diff(places) / h[..., None]
    spins = np.stack((here[..., 4:], there[..., 4:]), axis=-1)
    curves = zip(*(each.swapaxes(0, 1).tolist() for each in (places, speeds, spins)), strict=True)
    contact, moments, ways = Pressing(*times[[0, -1]].tolist()), times.tolist(), motion.swapaxes(0, 1).tolist()
    for way, pieces, count in zip(ways, curves, components, strict=True):
        states = [tuple(state[:count]) for state in way]
        yield [
            Arc(t0, t1, start, (*place, *speed, *spin[: count - 4]), contact, end)
            for t0, t1, start, end, place, speed, spin in zip(
                moments[:-1], moments[1:], states[:-1], states[1:], *pieces, strict=True
            )
        ]


def _nearest(x: float, y: float, dx: float, dy: float) -> float:
    """The smallest distance from the origin of a point on its straight way from (x, y)."""
    far = dx * dx + dy * dy
    share = min(1.0, max(0.0, -(x * dx + y * dy) / far)) if far > 0.0 else 0.0
    return hypot(x + share * dx, y + share * dy)
