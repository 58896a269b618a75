"""The loop: fly exactly, touch exactly, let pymunk push.

Each ball moves along its own arc. The next thing to happen is the earliest of: an arc's end, a touch with a surface, a touch
of two balls. Only the balls it changes get a new arc and new predictions.
"""

from __future__ import annotations

import heapq
from collections.abc import Sequence
from itertools import count
from time import perf_counter

from sandbox.engine import contacts as pushing
from sandbox.engine.accuracy import Accuracy
from sandbox.engine.arc import Arc, still
from sandbox.engine.lasting import Near, conclude, settle
from sandbox.engine.motion import RESTING, Contact, Mover
from sandbox.engine.run import Event, Numerics, Run
from sandbox.engine.setup import Ball, Bounce, Setup
from sandbox.engine.touch import CONTACT, Obstacle, balls_touch, box
from sandbox.errors import RequestError, RunError
from sandbox.physics.integrators import State

#: Events that may pass while time advances by less than _STANDSTILL s, before the run is declared stalled.
_MOST_AT_ONCE = 2_000
_STANDSTILL = 1e-9

#: Impacts in one run beyond which it is declared stalled; Galperin's billiard with mass ratio 1e8 needs 31,415.
_MOST_IMPACTS = 200_000

#: Deepest overlap at the start that is pushed apart, as a share of the radius; deeper is an error in the scene.
_SLIGHT = 0.02

#: Approach speed in m/s that is rounding, not an impact.
_STILL = 1e-10


class Stalled(RunError):
    """Events without end at one place."""


class _Track:
    """One ball on its way."""

    def __init__(self, mover: Mover, obstacles: Sequence[Obstacle], state: State) -> None:
        self.mover = mover
        self.ball = mover.ball
        self.obstacles = obstacles
        self.state = state
        self.contact: Contact | None = None
        self.arc = still(0.0, 0.0, state)
        self.path: list[Arc] = []
        self.version = 0


class Simulation:
    """One run of a setup. Raises RunError when it cannot be completed, with the time, the ball and the quantity."""

    def __init__(self, setup: Setup, accuracy: Accuracy) -> None:
        self._setup = setup
        self._accuracy = accuracy
        self._numerics = Numerics()
        self._events: list[Event] = []
        self._contacts = pushing.Contacts(setup.balls, self._numerics)
        self._queue: list[tuple[float, int, str, int, int, int, int]] = []
        self._order = count()
        self._over = False
        by_radius: dict[float, list[Obstacle]] = {}
        self._tracks: list[_Track] = []
        for ball in setup.balls:
            if ball.radius not in by_radius:
                by_radius[ball.radius] = [Obstacle(surface, ball.radius) for surface in setup.surfaces]
            obstacles = by_radius[ball.radius]
            mover = Mover(ball, accuracy, setup.bounds, setup.longest_step, self._numerics)
            x, y = _clear_of(ball, obstacles)
            self._tracks.append(_Track(mover, obstacles, (x, y, *ball.velocity, ball.spin)))
        self._separate_balls()

    def run(self) -> Run:
        started = perf_counter()
        for index in range(len(self._tracks)):
            self._begin(index, 0.0)
        t, ended = self._loop()
        for track in self._tracks:
            _keep(track, track.arc.until(t))
        self._numerics.wall_s = perf_counter() - started
        arcs = {track.ball.name: track.path for track in self._tracks}
        return Run(self._setup, self._accuracy, arcs, self._events, self._numerics, t, ended)

    def _loop(self) -> tuple[float, str]:
        duration = self._setup.duration
        moment, at_once = 0.0, 0
        while self._queue:
            t, _, kind, i, version, j, other_version = heapq.heappop(self._queue)
            if self._tracks[i].version != version or (j >= 0 and self._tracks[j].version != other_version):
                continue
            if t > moment + _STANDSTILL:
                moment, at_once = t, 0
            at_once += 1
            if at_once > _MOST_AT_ONCE or self._numerics.impacts > _MOST_IMPACTS:
                raise self._stalled(t, i)
            if kind == "touch":
                self._collide(t, [i] if j < 0 else [i, j])
                if self._over:
                    return t, "until"
                if all(track.contact is not None and track.contact.mode == RESTING for track in self._tracks):
                    return t, "rest"
                continue
            track = self._tracks[i]
            if track.arc.t1 >= duration and kind == "":
                return duration, "duration"
            _keep(track, track.arc)
            track.state = conclude(track.mover, track.arc.state(track.arc.t1), track.contact, kind)
            if kind == "":
                self._plan(i, t)
            else:
                self._resume(i, t)
            if self._over:
                return t, "until"
            if all(track.contact is not None and track.contact.mode == RESTING for track in self._tracks):
                return t, "rest"
        return duration, "duration"

    # ------------------------------------------------------------------ planning

    def _begin(self, index: int, t: float) -> None:
        """Start a ball: in flight, or already in contact."""
        self._resume(index, t)

    def _resume(self, index: int, t: float) -> None:
        """Go on from the ball's state: sort out what it is in contact with, and plan its way."""
        track = self._tracks[index]
        near = self._near(track, track.state)
        before = track.contact
        track.state, track.contact = settle(track.mover, t, track.state, near, self._accuracy.settle)
        self._note_contact(track, t, before)
        self._plan(index, t)

    def _note_contact(self, track: _Track, t: float, before: Contact | None) -> None:
        after = track.contact
        was = "" if before is None else before.obstacle.surface.name
        now = "" if after is None else after.obstacle.surface.name
        if was and was != now:
            self._note(track, t, "leave", was, 0.0)
        if after is not None and after.mode == RESTING:
            if before is None or before.mode != RESTING:
                self._note(track, t, "rest", now, 0.0)
        elif now and was != now:
            self._note(track, t, "contact", now, 0.0)

    def _note(self, track: _Track, t: float, kind: str, partner: str, speed: float) -> None:
        event = Event(t, kind, track.ball.name, partner, speed, track.state[0], track.state[1])
        self._events.append(event)
        if self._setup.until is not None and self._setup.until(event):
            self._over = True

    def _plan(self, index: int, t: float) -> None:
        """A new arc from the ball's state at t, and what will happen on it first."""
        track = self._tracks[index]
        track.version += 1
        arc, reason = track.mover.advance(t, self._setup.duration, track.state, track.contact)
        own = None if track.contact is None else track.contact.obstacle
        limits = box(arc)
        first = None
        for obstacle in track.obstacles:
            if obstacle is own or not obstacle.may_meet(limits):
                continue
            self._numerics.queries += 1
            u = obstacle.first_touch(arc)
            if u is not None and (first is None or u < first):
                first = u
        track.arc = arc
        if first is not None:
            self._push(arc.t0 + first * (arc.t1 - arc.t0), "touch", index)
        else:
            self._push(arc.t1, reason, index)
        for other in range(len(self._tracks)):
            if other != index:
                self._plan_pair(index, other, t)

    def _plan_pair(self, i: int, j: int, t: float) -> None:
        first, second = self._tracks[i], self._tracks[j]
        left, bottom, right, top = box(first.arc)
        reach = first.ball.radius + second.ball.radius
        a, b, c, d = box(second.arc)
        if left > c + reach or right < a - reach or bottom > d + reach or top < b - reach:
            return
        self._numerics.queries += 1
        at = balls_touch(first.arc, second.arc, reach, t)
        if at is not None:
            self._push(at, "touch", i, j)

    def _push(self, t: float, kind: str, i: int, j: int = -1) -> None:
        other = self._tracks[j].version if j >= 0 else 0
        heapq.heappush(self._queue, (t, next(self._order), kind, i, self._tracks[i].version, j, other))

    # ------------------------------------------------------------------ impacts

    def _near(self, track: _Track, state: State) -> list[Near]:
        """The surfaces that a ball touches, each at its nearest feature; flush ones once."""
        x, y = state[0], state[1]
        point = (x, y, x, y)
        near: list[Near] = []
        for obstacle in track.obstacles:
            if obstacle.may_meet(point):
                touching = obstacle.near(x, y)
                if touching.gap <= CONTACT:
                    near.append((obstacle, touching))
        return near

    def _collide(self, t: float, seeds: list[int]) -> None:
        """Everything that touches at this instant exchanges impulses at once."""
        members: list[int] = []
        waiting = list(seeds)
        found: list[pushing.Contact] = []
        partners: list[tuple[int, str]] = []
        cluster: list[pushing.Moving] = []
        pairs: list[tuple[int, int]] = []
        place: dict[int, int] = {}
        while waiting:
            index = waiting.pop(0)
            if index in place:
                continue
            place[index] = len(members)
            members.append(index)
            track = self._tracks[index]
            state = track.arc.state(t)
            cluster.append(pushing.Moving(index, *state))
            for other, neighbour in enumerate(self._tracks):
                if other == index:
                    continue
                x, y = neighbour.arc.state(t)[:2]
                gap = ((x - state[0]) ** 2 + (y - state[1]) ** 2) ** 0.5 - track.ball.radius - neighbour.ball.radius
                if gap <= CONTACT:
                    waiting.append(other)
                    pairs.append((index, other))
        for index in members:
            self._meet_surfaces(place[index], cluster[place[index]], found, partners)
        for i, j in pairs:
            if i < j:
                self._meet_balls(place[i], place[j], cluster, found, partners)
        closing = any(contact.approach > _STILL for contact in found)
        for index, moving in zip(members, cluster, strict=True):
            track = self._tracks[index]
            track.state = (moving.x, moving.y, moving.vx, moving.vy, moving.spin)
            _keep(track, track.arc.until(t))
        if closing:
            before = [contact.approach for contact in found]
            self._contacts.exchange(cluster, found)
            for contact, (index, partner), approach in zip(found, partners, before, strict=True):
                if approach > _STILL:
                    self._numerics.impacts += 1
                    self._note(self._tracks[index], t, "impact", partner, approach)
            for index, moving in zip(members, cluster, strict=True):
                self._tracks[index].state = (moving.x, moving.y, moving.vx, moving.vy, moving.spin)
        for index in members:
            self._resume(index, t)

    def _meet_surfaces(
        self, first: int, moving: pushing.Moving, found: list[pushing.Contact], partners: list[tuple[int, str]]
    ) -> None:
        track = self._tracks[moving.index]
        normals: list[tuple[float, float]] = []
        for obstacle, touching in self._near(track, (moving.x, moving.y, moving.vx, moving.vy, moving.spin)):
            nx, ny = touching.nx, touching.ny
            if any(nx * mx + ny * my > 1.0 - 1e-12 for mx, my in normals):
                continue  # laid flush with one already met
            normals.append((nx, ny))
            approach = -(moving.vx * nx + moving.vy * ny)
            along = moving.vx * ny - moving.vy * nx
            surface = obstacle.surface
            bounce = (
                Bounce(surface.restitution, surface.friction)
                if surface.law is None or approach <= 0.0
                else surface.law(approach, abs(along))
            )
            found.append(pushing.Contact(first, None, nx, ny, bounce, approach, 1.0 if along >= 0.0 else -1.0))
            partners.append((moving.index, surface.name))

    def _meet_balls(
        self,
        first: int,
        second: int,
        cluster: list[pushing.Moving],
        found: list[pushing.Contact],
        partners: list[tuple[int, str]],
    ) -> None:
        a, b = cluster[first], cluster[second]
        distance = ((a.x - b.x) ** 2 + (a.y - b.y) ** 2) ** 0.5
        nx, ny = (a.x - b.x) / distance, (a.y - b.y) / distance
        ux, uy = a.vx - b.vx, a.vy - b.vy
        radii = self._tracks[a.index].ball.radius * a.spin + self._tracks[b.index].ball.radius * b.spin
        approach = -(ux * nx + uy * ny)
        slip = ux * ny - uy * nx + radii
        bounce = self._setup.between_balls(max(approach, 0.0), abs(slip))
        found.append(pushing.Contact(first, second, nx, ny, bounce, approach, 1.0))
        partners.append((a.index, self._tracks[b.index].ball.name))

    # ------------------------------------------------------------------ the start, and errors

    def _separate_balls(self) -> None:
        for i, first in enumerate(self._tracks):
            for second in self._tracks[i + 1 :]:
                dx, dy = first.state[0] - second.state[0], first.state[1] - second.state[1]
                reach = first.ball.radius + second.ball.radius
                distance = (dx * dx + dy * dy) ** 0.5
                if distance < (1.0 - _SLIGHT) * reach:
                    raise RequestError(
                        f"balls {first.ball.name!r} and {second.ball.name!r} overlap at the start by "
                        f"{reach - distance:.3g} m: move one of them"
                    )
                if distance < reach - CONTACT:
                    share = 0.5 * (reach - distance) / distance
                    for track, sign in ((first, share), (second, -share)):
                        x, y, *rest = track.state
                        track.state = (x + sign * dx, y + sign * dy, *rest)

    def _stalled(self, t: float, index: int) -> Stalled:
        track = self._tracks[index]
        x, y = track.arc.state(t)[:2]
        last = next((e.partner for e in reversed(self._events) if e.ball == track.ball.name), "nothing")
        return Stalled(
            f"t = {t:.6g} s, ball {track.ball.name!r} at ({x:.4g}, {y:.4g}) m: events without end, last with {last!r}; "
            "a heap of balls needs accuracy.method = \"plain\""
        )


def _keep(track: _Track, arc: Arc) -> None:
    if arc.t1 > arc.t0:
        track.path.append(arc)


def _clear_of(ball: Ball, obstacles: Sequence[Obstacle]) -> tuple[float, float]:
    """Where the ball starts: pushed out of a slight overlap. Raises RequestError for a deep one, naming both."""
    x, y = ball.position
    for _ in range(20):
        deepest = min(((obstacle.near(x, y), obstacle) for obstacle in obstacles), key=lambda near: near[0].gap, default=None)
        if deepest is None or deepest[0].gap >= -1e-12:
            return x, y
        touching, obstacle = deepest
        if -touching.gap > _SLIGHT * ball.radius:
            raise RequestError(
                f"ball {ball.name!r} at ({x:.4g}, {y:.4g}) m overlaps {obstacle.surface.name!r} at the start by "
                f"{-touching.gap:.3g} m: move one of them"
            )
        x -= touching.gap * touching.nx
        y -= touching.gap * touching.ny
    raise RequestError(f"ball {ball.name!r} does not fit where it starts: surfaces overlap it from several sides")

