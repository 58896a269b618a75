"""The main loop: exact flight, exact times of contact, impulses by pymunk.

Each ball moves along its own arc, a piece of path. For each arc the first event on it is predicted: its end, contact
with a surface or another ball, a trap. The earliest of all events is next; it is resolved, and only the balls that it
changes get new arcs and new predictions.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from contextlib import contextmanager
from functools import cached_property, partial
from math import inf
from time import perf_counter
from typing import TYPE_CHECKING

from sandbox.engine.contact.manifold import all_round
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.event_queue import EventQueue, QueuedEvent
from sandbox.engine.guard import Guard
from sandbox.engine.heap.heap import Heap
from sandbox.engine.impact.impacts import Hit, Impacts, Outcome
from sandbox.engine.kernel.event_kind import EventKind
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Setup, Until
from sandbox.engine.model.setup_errors import UserFunctionError, failed
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.motion.on_plane import slowest_hop
from sandbox.engine.movers import movers_at_start
from sandbox.engine.paths.arc import Arc, resting_arc
from sandbox.engine.paths.path import Path
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Numerics, Run
from sandbox.engine.prediction import Prediction
from sandbox.physics.integrators import State

if TYPE_CHECKING:
    from sandbox.engine.impact.cluster_search import ClusterSearch

#: Events that change nothing at the end of the run's duration.
_GO_ON = EventKind.ARC_END, EventKind.HEAP_STEP, EventKind.CLUSTER_END


class Simulation:
    """One run of a setup. Raises RunError with the time, the ball and the quantity if it cannot be completed."""

    def __init__(
        self,
        setup: Setup,
        accuracy: Accuracy,
        numerics: Numerics | None = None,
        movers: Sequence[MovingBall] | None = None,
    ) -> None:
        """``numerics`` is the cost so far of a run that is continued here, ``movers`` are its balls."""
        self._accuracy = accuracy
        self._numerics = Numerics() if numerics is None else numerics
        self._events: list[Event] = []
        self._t = 0.0  # s, of the last event
        self._over = False  # as the setup's ``until`` says
        self._ended = ""  # how, once the run is over
        self._movers = movers_at_start(setup, accuracy, self._numerics) if movers is None else [*movers]
        self._moving = {*range(len(self._movers))}  # the balls that neither rest nor are caught
        self._queue = EventQueue(self._movers)
        self._guard = Guard()
        self._set_up(setup)

    def _set_up(self, setup: Setup) -> None:
        """Make what follows from a setup."""
        self._setup = setup
        self._prediction = Prediction(self._movers, self._queue, self._numerics, self._accuracy.skin)
        slowest = 0.0 if setup.plane is None else slowest_hop(setup, self._accuracy.hop)
        self._impacts = Impacts(setup, self._movers, self._numerics, slowest)
        self._all_round = all_round(*setup.balls)

    @cached_property
    def _clusters(self) -> ClusterSearch:
        with self._uncounted():  # here, not above: it brings numpy, which a run in which no balls meet does not need
            from sandbox.engine.impact.cluster_search import ClusterSearch

        return ClusterSearch(self._setup, self._movers, self._accuracy.contact_step)

    @cached_property
    def _heap(self) -> Heap | None:
        """The balls and bodies that lie on one another; None if none can, nor a body on an edge."""
        if self._all_round and (self._setup.plane is not None or len(self._setup.balls) == 1):
            return None
        return Heap(self._setup, self._movers, self._accuracy, self._numerics)

    @contextmanager
    def _uncounted(self) -> Iterator[None]:
        """Inside, time does not count as the run's: imports, which only the first run of a program waits for."""
        started = perf_counter()
        yield
        self._numerics.wall_s -= perf_counter() - started

    # ------------------------------------------------------------------ the algorithm

    def run(self) -> Run:
        """Run from start to end."""
        started = perf_counter()
        self.begin()
        return self._finish(started)

    def begin(self) -> None:
        """Resolve the contacts at the start, which come first."""
        for index, mover in enumerate(self._movers):
            if mover.version == 0:
                with self._where(index):
                    self._collide(0.0, [index])

    def _finish(self, started: float) -> Run:
        """Go on to the end of the run; ``started`` is the clock time of its start."""
        self._loop()
        self._end_at_rest()
        self._numerics.wall_s += perf_counter() - started
        return self._run_until(self._t, self._movers)

    def _end_at_rest(self) -> None:
        """End the run where all came to rest, if what depends on time moved nothing from then on."""
        if self._ended == "duration" and not self._moving and all(each.motion is None for each in self._setup.surfaces):
            ends = (mover.path[-1].t1 if mover.caught else mover.arc.t0 for mover in self._movers)
            self._t, self._ended = max(ends), "rest"

    def _run_until(self, t: float, movers: Sequence[MovingBall]) -> Run:
        """Return the run up to t in s, in which these balls take part."""
        for mover in movers:
            if not mover.caught:
                mover.finish(t)
        events = sorted(self._events, key=lambda event: event.t)  # a contact with a duration is noted at its start
        arcs = {mover.ball.name: Path(mover.path) for mover in movers}
        ended = self._ended or ("until" if self._over else "rest")
        return Run(self._setup, self._accuracy, arcs, events, self._numerics, t, ended)

    def _loop(self, until: float = inf) -> None:
        """Resolve one event after another, up to ``until`` in s or to the end of the run."""
        while not self._over and not self._ended and self._goes_on and (event := self._queue.pop(until)):
            self._t = event.t
            self._guard.check(event.t, self._movers[event.ball], self._numerics, self._events)
            if event.kind in _GO_ON and event.t >= self._setup.duration:
                self._t, self._ended = self._setup.duration, "duration"
            else:
                with self._where(event.ball):
                    self._resolve(event)

    @contextmanager
    def _where(self, index: int) -> Iterator[None]:
        """Inside, an error of a function of the scene gets the time in s of the last event, and the ball."""
        try:
            yield
        except UserFunctionError as error:
            raise failed(self._t, self._movers[index].ball.name, str(error)) from None

    @property
    def _goes_on(self) -> bool:
        """True if a ball moves, or one at rest may: by forces that depend on time, or struck by a surface."""
        return (
            bool(self._moving)
            or any(mover.ball.timing.depends and not mover.caught for mover in self._movers)
            or (
                any(surface.motion is not None for surface in self._setup.surfaces)
                and any(event.kind in (EventKind.TOUCH, EventKind.EDGE) for event in self._queue.pending())
            )
        )

    def _resolve(self, event: QueuedEvent) -> None:
        """Resolve an event, the earliest."""
        t, kind = event.t, event.kind
        match kind:
            case EventKind.ARC_END:
                self._next_arc(t, event.ball)
            case EventKind.TOUCH:
                self._touch(t, event.balls)
            case EventKind.SPIN_END:
                self._end_spin(t, event.ball)
            case EventKind.TRAP:
                self._catch(t, event.ball)
            case EventKind.CLUSTER_END:
                self._collide(t, [event.ball])  # with the walls it has entered during the contact
            case EventKind.HEAP_STEP:
                self._go_on_in_heap(t, event.ball)
            case _:
                self._change_contact(t, event.ball, kind)

    def _next_arc(self, t: float, index: int) -> None:
        """Move a ball to the end of its arc, and plan the next: it goes on as before. A rest is one arc in the end."""
        mover, before = self._movers[index], self._movers[index].arc
        lasts = before.rests and mover.ball.timing.depends
        if not lasts:
            self._arrive_at_end(t, index, EventKind.ARC_END)
        self._plan(index, t)
        if lasts and mover.arc.rests:
            mover.arc.t0 = before.t0
        elif lasts:  # what carries it moves
            mover.path.append(before)

    def _end_spin(self, t: float, index: int) -> None:
        """Go on along the predicted path, without spin: what is on it is known."""
        self._arrive_at_end(t, index, EventKind.SPIN_END)
        self._movers[index].end_spin(t)

    def _arrive_at_end(self, t: float, index: int, kind: EventKind) -> None:
        mover = self._movers[index]
        self._over = self._passes(t, index)
        mover.arrive(t, mover.arc.state(t))
        mover.snap_to_contact(t, kind)

    def _change_contact(self, t: float, index: int, kind: EventKind) -> None:
        """Go on where an arc ends because the contact with a surface changes."""
        mover = self._movers[index]
        mover.arrive(t, mover.arc.state(t))
        mover.snap_to_contact(t, kind)
        mover.arc = resting_arc(t, t, mover.state)
        self._collide(t, [index])

    def _touch(self, t: float, balls: Sequence[int]) -> None:
        """Resolve a touch of a ball and a surface, or of two balls."""
        self._over = any(self._passes(t, index) for index in balls)
        if not self._over:
            self._collide(t, balls)

    def _catch(self, t: float, index: int) -> None:
        """Remove a ball that is caught; one that is too fast goes on."""
        mover = self._movers[index]
        x, y, vx, vy = mover.arc.state(t)[:4]
        nearest = min(mover.open_traps, key=lambda trap: trap.near(x, y).gap)
        if not self._holds(nearest, mover.arc.state(t)):
            mover.passed = (*mover.passed, nearest)
            self._note(t, "over", mover, nearest.surface.name, (x, y), (vx * vx + vy * vy) ** 0.5)
            self._next_arc(t, index)
            return
        mover.finish(t)
        x, y, vx, vy = mover.path[-1].state(t)[:4]
        mover.version += 1
        mover.caught = True
        self._moving.discard(index)
        self._note(t, "caught", mover, nearest.surface.name, (x, y), (vx * vx + vy * vy) ** 0.5)

    def _holds(self, place: Obstacle, state: State) -> bool:
        """True if a ball in this state is slow enough for a trap."""
        surface = place.surface
        traps = [trap for trap in self._setup.traps if trap.name == surface.name and trap.shape == surface.shape]
        return all(trap.holds(state) for trap in traps)

    def _passes(self, t: float, index: int) -> bool:
        """True if the run ends with a ball's arc up to t, without an event."""
        arc, until = self._movers[index].arc, self._setup.until
        return isinstance(until, Until) and bool(until.passed(arc.start, arc.state(t)))

    # ------------------------------------------------------------------ impacts, clusters and heaps

    def _collide(self, t: float, seeds: Sequence[int]) -> None:
        """Resolve the impact of all that touch at t, directly or through others, the balls in ``seeds``: by impulses,
        or through a contact that lasts, or as sustained contact in a heap."""
        group = self._impacts.touching(t, seeds)
        if self._heap:
            self._heap.note_energy(group.states)
        outcome = self._resolve_cluster(t, group.states)
        if outcome is None:
            if self._heap and self._heap.has(seeds):
                group = self._impacts.touching(t, seeds, self._heap.margin)
            outcome = self._impacts.exchange(t, group, self._resolve_cluster)
        self._note_hits(t, outcome.hits, group.states)
        if outcome.t > t:
            self._apply_cluster(t, group.states, outcome)
            return
        for index, state in outcome.states.items():
            self._movers[index].arrive(t, state)
            self._movers[index].passed = ()
        held: Collection[int] = ()
        if self._heap and self._heap.belongs_in_heap(t, outcome.states, group.pairs):
            held = self._step_heap(t, outcome.states.keys())
        for index in outcome.states:
            if index not in held:
                self._resume(index, t)

    def _resolve_cluster(self, t: float, states: dict[int, State]) -> Outcome | None:
        """The outcome of balls that touch in these states, by contact mechanics; None if impulses are right."""
        if not self._all_round or len(states) < 2:
            return None
        heap = self._heap
        slow, fresh = (heap.slow(t, states), heap.fresh(t)) if heap else (0.0, set[int]())
        return self._clusters.resolve(t, states, slow, fresh)

    def _apply_cluster(self, t: float, states: dict[int, State], parted: Outcome) -> None:
        """Follow the outcome of a contact that lasts from t until the balls separate; those that touched them in
        these ``states`` without taking part go on at once."""
        self._numerics.clusters += 1
        heap = self._heap
        if heap:
            heap.release(parted.states.keys())
        for index, arcs in parted.arcs.items():
            mover = self._movers[index]
            mover.append_contact(t, arcs)
            self._queue.push(parted.t, EventKind.CLUSTER_END, index)
            caught = (self._prediction.first_touch(index, arc, mover.open_traps, arc.t1) for arc in arcs)
            at = next((at for at in caught if at is not None), inf)
            if at < self._setup.duration:
                self._queue.push(at, EventKind.TRAP, index)
        for index in states.keys() - parted.states.keys() - (heap.members if heap else set()):
            self._movers[index].arrive(t, states[index])
            self._resume(index, t)
        if heap and heap.members:
            self._step_heap(t, ())

    def _go_on_in_heap(self, t: float, index: int) -> None:
        """Step the heap from t; or let the part in which a ball rests do so longer than it was known to."""
        heap = self._heap
        assert heap is not None
        resting = heap.rest_on(t, self._setup.duration, index)
        if resting:
            self._follow_in_heap(t, resting)
            return
        heap.wake([index])
        self._step_heap(t, ())

    def _step_heap(self, t: float, joining: Collection[int]) -> Collection[int]:
        """Step the heap from t, with these balls if they press on others. Returns the balls in it."""
        heap = self._heap
        assert heap is not None
        heap.wake(joining)
        members = set(heap.members)
        for index in members - set(joining):
            self._movers[index].arrive(t, self._movers[index].arc.state(t))
        states = {index: self._movers[index].state for index in sorted(members.union(joining))}
        stepped = heap.step(t, self._setup.duration, states)
        self._follow_in_heap(t, stepped)
        for index in members - set(joining) - stepped.keys():
            self._resume(index, t)
        return stepped.keys()

    def _follow_in_heap(self, t: float, arcs: dict[int, Arc]) -> None:
        """Let the balls of a heap go on along these arcs from t."""
        heap = self._heap
        assert heap is not None
        for index, arc in arcs.items():
            self._movers[index].version += 1
            self._movers[index].arc = arc
        for index, others in self._prediction.neighbours(arcs.keys(), t).items():
            self._note_rest(index, t)
            self._prediction.predict(index, t, EventKind.HEAP_STEP, partial(heap.keeps_apart, index), others)

    # ------------------------------------------------------------------ planning

    def _resume(self, index: int, t: float) -> None:
        """Continue from the ball's state: find its contacts and plan its next arc."""
        mover = self._movers[index]
        was = mover.on
        mover.find_sustained_contact(t, self._accuracy.settle)
        if was and was != mover.on:
            self._note(t, "leave", mover, was, mover.state)
        if mover.contact is not None and was != mover.on and mover.contact.phase is not Phase.RESTING:
            self._note(t, "contact", mover, mover.on, mover.state)
        self._plan(index, t)

    def _plan(self, index: int, t: float) -> None:
        """Create a new arc from the ball's state at t, and predict the first event on it."""
        mover, kind = self._movers[index], EventKind.ARC_END
        mover.version += 1
        if t < self._setup.duration and not self._over:
            mover.arc, kind = mover.advance(t, self._setup.duration)
        else:
            mover.arc = resting_arc(t, t, mover.state, mover.contact)
        if self._over:
            return  # nothing left to plan
        self._note_rest(index, t)
        own = mover.held_by
        everyone = range(len(self._movers))
        self._prediction.predict(index, t, kind, lambda other: other in own, everyone if len(everyone) > 1 else ())

    # ------------------------------------------------------------------ noting

    def _note(
        self, t: float, kind: str, mover: MovingBall, partner: str, at: Sequence[float], speed: float = 0.0
    ) -> None:
        """Note an event of the ball ``at`` a place, in m."""
        self._events.append(Event(t, kind, mover.ball.name, partner, speed, at[0], at[1]))
        if self._setup.ends_with(self._events):
            self._over = True

    def _note_hits(self, t: float, hits: Sequence[Hit], states: dict[int, State]) -> None:
        """Note the contacts that closed in an impact at t of balls that touched in these states."""
        for hit in hits:
            self._numerics.impacts += 1
            mover = self._movers[hit.ball]
            at = states[hit.ball][:2] if hit.ball in states else mover.arc.position(t)
            self._note(hit.t, "impact", mover, hit.partner, at, hit.speed)

    def _note_rest(self, index: int, t: float) -> None:
        """Note if a ball has come to rest, or moves again."""
        mover = self._movers[index]
        if not mover.arc.rests:
            self._moving.add(index)
        elif index in self._moving:
            self._moving.discard(index)
            if t > 0.0 or mover.on:
                self._note(t, "rest", mover, mover.on, mover.state)
