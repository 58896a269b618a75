"""The main loop: exact flight, exact times of contact, impulses by pymunk.

Each ball moves along its own arc. The next event is the earliest of: an arc's end, contact with a surface, contact of
two balls. Only the balls it changes get a new arc and new predictions.
"""

from __future__ import annotations

import heapq
from collections.abc import Callable, Collection, Mapping, Sequence
from functools import cached_property, partial
from itertools import count
from math import inf
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.arc import Arc, still
from sandbox.engine.event import Event
from sandbox.engine.impacts import Impacts, Outcome
from sandbox.engine.lasting import RESTING, LastingContact
from sandbox.engine.meeting import discs, pair_touches
from sandbox.engine.on_plane import OnPlane, slowest_hop
from sandbox.engine.path import Path
from sandbox.engine.run import Numerics, Run
from sandbox.engine.setup import Setup, Surface, Until
from sandbox.engine.setup_errors import failed, setup_errors_named
from sandbox.engine.start import starts
from sandbox.engine.touch import TOUCHING_GAP, Obstacle
from sandbox.engine.track import Track
from sandbox.engine.turning import Turning
from sandbox.errors import RunError
from sandbox.physics.integrators import State

if TYPE_CHECKING:
    from sandbox.engine.clusters import Asking
    from sandbox.engine.heap import Heap
    from sandbox.engine.pressed import Pressed

#: Most events while time advances by less than _STANDSTILL s, beyond which the run has stalled.
_MOST_AT_ONCE = 2_000
_STANDSTILL = 1e-6

#: Most impacts in one run, beyond which it has stalled; Galperin's billiard with mass ratio 1e8 needs 31,415.
_MOST_IMPACTS = 200_000

#: Most steps in one run, beyond which its forces are too stiff: about 5 s of computing.
MOST_STEPS = 100_000


class Left(NamedTuple):
    """How a shot left a batch of many (batch.py): at its end (``how`` is "until", "rest" or "duration"), or to be
    continued here: from its start ("start"), on its way ("flight"), where it touches something, just before the impact
    ("before") or after it ("after"), or where a slide or a roll has ended ("ended")."""

    t: float  # s
    how: str
    state: State
    step: float  # s, that the integrator would try next
    contact: LastingContact | None
    arcs: list[Arc]  # the last one, if there is any and it is to be continued


class Simulation:
    """One run of a setup. Raises RunError with the time, the ball and the quantity if it cannot be completed."""

    def __init__(self, setup: Setup, accuracy: Accuracy, spent: Numerics | None = None) -> None:
        """``spent`` is the cost so far of a run that is continued here."""
        self._setup = setup
        self._accuracy = accuracy
        self._numerics = Numerics() if spent is None else spent
        self._events: list[Event] = []
        self._queue: list[tuple[float, int, str, int, int, int, int]] = []
        self._order = count()
        self._over = False
        self._tracks = self._make_tracks()
        self._moving = {*range(len(self._tracks))}  # the balls that neither rest nor are caught
        slowest = 0.0 if setup.plane is None else slowest_hop(setup, accuracy.hop)
        self._impacts = Impacts(setup, self._tracks, self._numerics, slowest)
        self._all_round = discs(*setup.balls)

    @cached_property
    def _pressed(self) -> Pressed:
        # here, not above: it brings numpy, which a run in which no balls meet does not need
        from sandbox.engine.pressed import Pressed

        return Pressed(self._setup, self._tracks, self._accuracy.contact_step)

    @cached_property
    def _heap(self) -> Heap | None:
        """Where balls or bodies can lie on one another, or a body on an edge."""
        if self._all_round and (self._setup.plane is not None or len(self._setup.balls) == 1):
            return None
        # here, not above: no run of one ball needs it
        from sandbox.engine.heap import Heap

        return Heap(self._setup, self._tracks, self._accuracy, self._numerics)

    def _make_tracks(self) -> list[Track]:
        setup = self._setup
        obstacles: dict[float, list[Obstacle]] = {}
        skin = self._accuracy.skin
        catches = [(each, Obstacle(Surface(each.name, each.shape, 0.0, 0.0), 0.0, skin)) for each in setup.catches]
        for radius in {ball.radius for ball in setup.balls}:
            obstacles[radius] = [Obstacle(surface, radius, skin) for surface in setup.surfaces]
        tracks: list[Track] = []
        for ball, (x, y) in zip(setup.balls, starts(setup.balls, obstacles), strict=True):
            state: State = (x, y, *map(float, setup.start_of(ball)[2:]))
            kind = OnPlane if setup.plane is not None else Turning if ball.turns else Track
            near = [place for catch, place in catches if catch.takes(ball.name)]
            tracks.append(kind(ball, state, obstacles[ball.radius], near, setup, self._accuracy, self._numerics))
        return tracks

    def run(self) -> Asking[Run]:
        """Run from start to end."""
        started = perf_counter()
        for index, track in enumerate(self._tracks):
            if track.version == 0:
                yield from self._collide(0.0, [index])  # contacts at the start come first
        return (yield from self._finished(0.0, started))

    def _finished(self, t: float, started: float) -> Asking[Run]:
        """Continue the run from t to its end; ``started`` is the clock time of its start."""
        t, ended = yield from self._loop(t)
        for track in self._tracks:
            if not track.caught:
                track.finish(t)
        self._numerics.wall_s += perf_counter() - started
        self._events.sort(key=lambda event: event.t)  # a contact with a duration is noted at its start
        arcs = {track.ball.name: Path(track.path) for track in self._tracks}
        return Run(self._setup, self._accuracy, arcs, self._events, self._numerics, t, ended)

    def take_over(self, left: Left, events: list[Event]) -> Asking[Run]:
        """Finish a run of one ball that batch.py has begun, with these events so far."""
        started = perf_counter()
        t, how, state, step, contact, arcs = left
        track = self._tracks[0]
        if contact is not None:
            surface = contact.obstacle.surface
            contact = contact._replace(obstacle=next(each for each in track.obstacles if each.surface is surface))
        track.arc, track.state, track.path = still(t, t, state, contact), state, [*arcs]
        track.next_step, track.contact = step, contact
        self._events = events
        if how == "after" and events:
            self._over = self._setup.ends_with(events)  # the earlier events were checked before
        if how == "flight":
            self._plan(0, t)
        elif how == "before":
            yield from self._collide(t, [0])
        else:
            self._resume(0, t)
        return (yield from self._finished(t, started))

    def _loop(self, t: float) -> Asking[tuple[float, str]]:
        duration = self._setup.duration
        moment, at_once = t, 0
        while self._queue and self._moving and not self._over:
            t, _, kind, i, version, j, other_version = heapq.heappop(self._queue)
            track = self._tracks[i]
            if track.version != version or (j >= 0 and self._tracks[j].version != other_version):
                continue
            if t > moment + _STANDSTILL:
                moment, at_once = t, 0
            at_once += 1
            if at_once > _MOST_AT_ONCE or self._numerics.impacts > _MOST_IMPACTS:
                raise self._stalled(t, i)
            if self._numerics.steps > MOST_STEPS:
                what = "its forces are very stiff: raise accuracy.tolerance, or shorten the duration"
                raise failed(t, track.ball.name, f"{MOST_STEPS:,} steps without an end; {what}")
            if kind in ("", "spun") and t < duration:
                self._go_on(t, i, kind)
            elif kind == "touch":
                seeds = [i] if j < 0 else [i, j]
                self._over = any(self._passed(t, index) for index in seeds)
                if not self._over:
                    yield from self._collide(t, seeds)
            elif kind == "part" and t < duration:
                yield from self._collide(t, [i])  # with the walls it has entered during the contact
            elif kind == "catch":
                self._catch(t, i)
            elif kind in ("", "heap", "part") and track.arc.t1 >= duration:
                return duration, "duration"
            elif kind == "heap" and self._heap:
                self._press_on(self._heap, t, ())
            else:
                yield from self._change(t, i, kind)
        return t, "until" if self._over else "rest"

    def _go_on(self, t: float, index: int, kind: str) -> None:
        """Plan the next arc where one ends only because of its length; where only the spin changes, what is on its way
        is known."""
        track = self._tracks[index]
        self._over = self._passed(t, index)
        track.arrive(t, track.arc.state(t))
        track.conclude("")
        if kind == "spun":
            track.spun(t)
        else:
            self._plan(index, t)

    def _change(self, t: float, index: int, reason: str) -> Asking[None]:
        """Go on where an arc ends because the contact changes."""
        track = self._tracks[index]
        track.arrive(t, track.arc.state(t))
        track.conclude(reason)
        track.arc = still(t, t, track.state)
        yield from self._collide(t, [index])

    def _passed(self, t: float, index: int) -> bool:
        """Whether the run ends with a ball's arc up to t."""
        arc, until = self._tracks[index].arc, self._setup.until
        return isinstance(until, Until) and bool(until.passed(arc.start, arc.state(t)))

    def _collide(self, t: float, seeds: Sequence[int]) -> Asking[None]:
        """Everything that touches at this instant exchanges impulses at once, or is simulated through the contact."""
        self._impacts.gap = TOUCHING_GAP
        touching = self._impacts.touching(t, seeds)
        outcome = yield from self._through(t, touching)
        if outcome is None:
            if self._heap and self._heap.has(seeds):
                self._impacts.gap = self._heap.margin
                touching = self._impacts.touching(t, seeds)
            outcome = yield from self._impacts.exchange(t, touching, self._through)
        for hit in outcome.hits:
            self._numerics.impacts += 1
            track = self._tracks[hit.ball]
            at = touching[hit.ball][:2] if hit.ball in touching else track.arc.position(t)
            self._note(hit.t, "impact", track, hit.partner, at, hit.speed)
        if outcome.t > t:
            self._go_through(t, touching, outcome)
            return
        for index, state in outcome.states.items():
            self._tracks[index].arrive(t, state)
        held: Collection[int] = ()
        if self._heap and self._heap.presses(t, outcome.states, self._impacts.pairs):
            held = self._press_on(self._heap, t, outcome.states.keys())
        for index in outcome.states:
            if index not in held:
                self._resume(index, t)

    def _press_on(self, heap: Heap, t: float, joining: Collection[int]) -> Collection[int]:
        """Step the heap from t, with these balls if they press on others. Returns the balls in it."""
        heap.wake(joining)
        members = set(heap.members)
        for index in members - set(joining):
            self._tracks[index].arrive(t, self._tracks[index].arc.state(t))
        states = {index: self._tracks[index].state for index in sorted(members.union(joining))}
        stepped = heap.step(t, self._setup.duration, states)
        for index, arc in stepped.items():
            self._tracks[index].version += 1
            self._tracks[index].arc = arc
        for index, others in self._neighbours(stepped, t).items():
            self._note_rest(index, t)
            self._predict(index, t, "heap", partial(heap.keeps_apart, index), others)
        for index in members - set(joining) - stepped.keys():
            self._resume(index, t)
        return stepped.keys()

    def _through(self, t: float, touching: dict[int, State]) -> Asking[Outcome | None]:
        """The outcome of balls that touch, by contact mechanics; None if impulses are right."""
        if not self._all_round or len(touching) < 2:
            return None
        heap = self._heap
        slow, fresh = (heap.slow(t, touching), heap.fresh(t)) if heap else (0.0, set[int]())
        return (yield from self._pressed.through(t, touching, slow, fresh))

    def _go_through(self, t: float, touching: dict[int, State], parted: Outcome) -> None:
        """Apply the outcome of a contact that lasts from t until the balls separate: then they go on."""
        self._numerics.clusters += 1
        heap = self._heap
        if heap:
            heap.release(parted.states.keys())
        for index, arcs in parted.arcs.items():
            self._tracks[index].meet(t, arcs)
            self._push(parted.t, "part", index)
            caught = (self._first_touch(index, arc, self._tracks[index].catches, arc.t1) for arc in arcs)
            at = next((at for at in caught if at is not None), inf)
            if at < self._setup.duration:
                self._push(at, "catch", index)
        for index in touching.keys() - parted.states.keys() - (heap.members if heap else set()):
            self._tracks[index].arrive(t, touching[index])
            self._resume(index, t)
        if heap and heap.members:
            self._press_on(heap, t, ())

    def _catch(self, t: float, index: int) -> None:
        """Remove a ball that is caught."""
        track = self._tracks[index]
        track.finish(t)
        x, y, vx, vy = track.path[-1].state(t)[:4]
        track.version += 1
        track.caught = True
        self._moving.discard(index)
        nearest = min(track.catches, key=lambda catch: catch.near(x, y).gap)
        self._note(t, "caught", track, nearest.surface.name, (x, y), (vx * vx + vy * vy) ** 0.5)

    def _note(self, t: float, kind: str, track: Track, partner: str, at: Sequence[float], speed: float = 0.0) -> None:
        """Note an event of the ball ``at`` a place, in m."""
        self._events.append(Event(t, kind, track.ball.name, partner, speed, at[0], at[1]))
        if self._setup.ends_with(self._events):
            self._over = True

    # ------------------------------------------------------------------ planning

    def _resume(self, index: int, t: float) -> None:
        """Continue from the ball's state: find its contacts and plan its next arc."""
        track = self._tracks[index]
        was = track.on
        track.settle(t, self._accuracy.settle)
        if was and was != track.on:
            self._note(t, "leave", track, was, track.state)
        if track.contact is not None and was != track.on and track.contact.mode != RESTING:
            self._note(t, "contact", track, track.on, track.state)
        self._plan(index, t)

    def _note_rest(self, index: int, t: float) -> None:
        track = self._tracks[index]
        if not track.arc.rests:
            self._moving.add(index)
        elif index in self._moving:
            self._moving.discard(index)
            if t > 0.0 or track.on:
                self._note(t, "rest", track, track.on, track.state)

    def _plan(self, index: int, t: float) -> None:
        """Create a new arc from the ball's state at t, and predict the first event on it."""
        track, kind = self._tracks[index], ""
        track.version += 1
        if t < self._setup.duration and not self._over:
            track.arc, kind = track.advance(t, self._setup.duration)
        else:
            track.arc = still(t, t, track.state, track.contact)
        if self._over:
            return  # nothing left to plan
        self._note_rest(index, t)
        own = None if track.contact is None else track.contact.obstacle
        everyone = range(len(self._tracks))
        self._predict(index, t, kind, lambda other: other is own, everyone if len(everyone) > 1 else ())

    def _neighbours(self, stepped: Mapping[int, Arc], t: float) -> dict[int, list[int]]:
        """For each ball of a heap the others that it may meet on its new arc from t; of two in the heap for the first.

        Found by sweeping along x.
        """
        ranges, longest = [], max((arc.t1 - t for arc in stepped.values()), default=0.0)  # at rest, to the run's end
        for index, track in enumerate(self._tracks):
            if not track.caught:
                arc, radius = track.arc, track.ball.radius
                left, bottom, right, top = arc.box() if index in stepped else arc.box_within(t, longest)
                ranges.append((left - radius, right + radius, bottom - radius, top + radius, index))
        found: dict[int, list[int]] = {index: [] for index in stepped}
        passing: list[tuple[float, float, float, float, int]] = []
        for here in sorted(ranges):
            left, _, bottom, top, index = here
            passing = [there for there in passing if there[1] >= left]
            for _, _, low, high, other in passing:
                if low <= top and high >= bottom:
                    first, second = (index, other) if index < other else (other, index)
                    if first in found:
                        found[first].append(second)
                    elif second in found:
                        found[second].append(first)
            passing.append(here)
        return {index: sorted(others) for index, others in found.items()}

    def _predict(
        self,
        index: int,
        t: float,
        kind: str,
        in_contact: Callable[[Obstacle | int], bool],
        others: Sequence[int],
    ) -> None:
        """Predict the first event on a ball's new arc, which ends for the reason ``kind``, alone or with ``others``; it
        does not meet what it is ``in_contact`` with: obstacles, and balls by index."""
        track = self._tracks[index]
        arc = track.way
        at = arc.t1
        touch = self._first_touch(index, arc, track.obstacles, at, in_contact)
        if touch is not None:
            at, kind = touch, "touch"
        if track.catches and (caught := self._first_touch(index, arc, track.catches, at)) is not None:
            at, kind = caught, "catch"
        self._push(at, kind, index)
        if track.arc.t1 < at:
            self._push(track.arc.t1, "spun", index)
        if not others:
            return
        left, bottom, right, top = arc.box()
        for other in others:
            neighbour = self._tracks[other]
            if other == index or neighbour.caught:
                continue
            reach = track.ball.radius + neighbour.ball.radius
            a, b, c, d = neighbour.way.box()
            if left <= c + reach and right >= a - reach and bottom <= d + reach and top >= b - reach:
                dx, dy = max(0.0, left - c, a - right), max(0.0, bottom - d, b - top)
                if dx * dx + dy * dy > reach * reach or in_contact(other):
                    continue
                self._numerics.queries += 1
                pair_at = pair_touches(track, neighbour, max(t, neighbour.arc.t0), self._accuracy.skin)
                if pair_at is not None and pair_at <= at:
                    self._push(pair_at, "touch", index, other)

    def _first_touch(
        self,
        index: int,
        arc: Arc,
        obstacles: Sequence[Obstacle],
        until: float,
        in_contact: Callable[[Obstacle], bool] = lambda obstacle: False,
    ) -> float | None:
        """The first time up to ``until`` (s) at which a ball touches one of these on an arc, or None; it does not meet
        what it is ``in_contact`` with."""
        first, (left, bottom, right, top) = None, arc.box()
        for obstacle in obstacles:
            west, south, east, north = obstacle.box
            if right >= west and left <= east and bottom <= north and top >= south and not in_contact(obstacle):
                self._numerics.queries += 1
                touch = self._tracks[index].first_touch(obstacle, arc)
                if touch is not None and touch <= until:
                    first = until = touch
                    arc.follow(touch)
                    left, bottom, right, top = arc.box()
        return first

    def _push(self, t: float, kind: str, i: int, j: int = -1) -> None:
        other = self._tracks[j].version if j >= 0 else 0
        heapq.heappush(self._queue, (t, next(self._order), kind, i, self._tracks[i].version, j, other))

    def _stalled(self, t: float, index: int) -> RunError:
        track = self._tracks[index]
        x, y = track.arc.state(t)[:2]
        where = f"t = {t:.6g} s, ball {track.ball.name!r} at ({x:.4g}, {y:.4g}) m"
        name = track.ball.name
        last = next((event for event in reversed(self._events) if name in (event.ball, event.partner)), None)
        if last is None or last.t < t - _STANDSTILL:
            return RunError(f"{where}: the velocity changes too fast for any step; look for a force that is not smooth")
        other = last.partner if last.ball == name else last.ball
        return RunError(f"{where}: endless events, the last with {other!r}")


def side_by_side(runs: Sequence[Asking[Run]]) -> list[Run | Exception]:
    """What these runs come to, or the exceptions they end with; the clusters that they meet are passed through
    together."""
    found: dict[int, Run | Exception] = {}
    answers: dict[int, Any] = dict.fromkeys(range(len(runs)))
    while answers:
        asked = {}
        for number, answer in answers.items():
            run = runs[number]
            try:
                with setup_errors_named():  # not in the run: what is left off is closed, by a GeneratorExit
                    asked[number] = run.throw(answer) if isinstance(answer, Exception) else run.send(answer)
            except StopIteration as end:
                found[number] = end.value
            except Exception as error:
                found[number] = error
        if not asked:
            break
        from sandbox.engine.clusters import pass_through  # here, not above, as it brings numpy

        answers = dict(zip(asked, pass_through([*asked.values()]), strict=True))
    return [found[number] for number in range(len(runs))]


def alone(run: Asking[Run]) -> Run:
    """What one run comes to."""
    (found,) = side_by_side([run])
    if isinstance(found, Exception):
        raise found
    return found
