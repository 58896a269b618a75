"""A simulation that can be stopped, changed and gone on with; and the record from which a run is forked.

Its state is kept at checkpoints, one after so many events. Between two checkpoints nothing is kept: the state at any
time is that of the checkpoint before it, and the few events since then are resolved again, to the same last bit.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import product
from math import dist
from time import perf_counter
from typing import TYPE_CHECKING, Any

from sandbox.engine.checkpoint import Checkpoint
from sandbox.engine.contact.manifold import meeting, surfaces_met
from sandbox.engine.event_queue import QueuedEvent
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.change import Change, checked
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import setup_errors_named
from sandbox.engine.model.tolerances import TOUCHING_GAP
from sandbox.engine.motion.forces_on_ball import refuse_unrepeatable
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.movers import Surroundings
from sandbox.engine.paths.arc import resting_arc
from sandbox.engine.paths.path import Path
from sandbox.engine.paths.phase import SetByHand
from sandbox.engine.paths.run import Run
from sandbox.engine.single_flight import FlightSimulation
from sandbox.engine.start import SLIGHT
from sandbox.errors import RequestError
from sandbox.physics.integrators import State

if TYPE_CHECKING:
    from sandbox.engine.heap.heap import Heap
    from sandbox.engine.heap.stepping import HeapState

#: Events from one checkpoint to the next: at least so many, and so many for each ball. Fewer: runs take more time and
#: memory; more: a fork first resolves more events again.
_EVENTS, _EVENTS_OF_A_BALL = 32, 4

#: A cluster, which takes as long as so many other events.
_EVENTS_OF_A_CLUSTER = 64


class Record:
    """The origin of a run: its setup, the changes made on the way, and checkpoints, which a pickled record does
    without."""

    def __init__(self, setup: Setup, accuracy: Accuracy) -> None:
        self.setup = setup  # at the start
        self.accuracy = accuracy
        self.changes: list[tuple[float, Mapping[str, Any]]] = []  # with the times in s
        self.checkpoints: list[Checkpoint] = []

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "checkpoints": []}

    def copy(self) -> Record:
        """Return the record of what has happened so far."""
        other = Record(self.setup, self.accuracy)
        other.changes, other.checkpoints = [*self.changes], [*self.checkpoints]
        return other

    def saved_at(self, t: float, history: bool) -> Record:
        """Return what is needed to go on from t in s, with at most one checkpoint, where it begins without
        ``history``."""
        last = [each for each in self.checkpoints if each.t <= t][-1:]
        begins = last and not history
        other = Record(last[0].eras[-1][1] if begins else self.setup, self.accuracy)
        other.changes = self.changes[last[0].changes :] if begins else [*self.changes]
        other.checkpoints = [each.alone(history) for each in last]
        return other

    def at(self, t: float) -> LiveSimulation:
        """Return the simulation with all that has happened and was changed up to t in s."""
        known = bisect_right(self.checkpoints, t, key=lambda each: each.t)
        simulation = LiveSimulation(self.setup, self.accuracy, self.checkpoints[known - 1] if known else None)
        simulation.record.checkpoints = self.checkpoints[:known]
        done = self.checkpoints[known - 1].changes if known else 0
        simulation.record.changes = self.changes[:done]
        if not known:
            simulation.begin()
        for at, changes in self.changes[done:]:
            if at <= t:
                simulation.advance(at)
                simulation.change(at, changes)
        simulation.advance(t)
        return simulation

    def fork(self, t: float, changes: Mapping[str, Any]) -> Run:
        """Return the run that goes on from t in s with what is given changed."""
        started = perf_counter()
        with setup_errors_named():
            simulation = self.at(t)
            if changes:
                simulation.change(t, changes)
            return simulation.complete(started)


class LiveSimulation(FlightSimulation):
    """A simulation that can be stopped at any time, changed, and gone on with."""

    def __init__(self, setup: Setup, accuracy: Accuracy, checkpoint: Checkpoint | None = None) -> None:
        """It starts with ``setup``, or where a ``checkpoint`` of such a run was made."""
        self.record = Record(setup, accuracy)
        self._eras = [(0.0, setup)]
        self._count = 0  # events since the last checkpoint
        if checkpoint is None:
            super().__init__(setup, accuracy)
            return
        numerics = replace(checkpoint.numerics, wall_s=0.0)
        copies = zip(checkpoint.movers, checkpoint.arcs, strict=True)
        movers = [mover.copy(mover.path[:count], numerics) for mover, count in copies]
        super().__init__(checkpoint.eras[-1][1], accuracy, numerics, movers)
        self._eras = [*checkpoint.eras]
        self._events = checkpoint.events[: checkpoint.noted]
        self._t, self._over, self._ended = checkpoint.t, checkpoint.over, checkpoint.ended
        self._moving = {*checkpoint.moving}
        self._queue.restore(checkpoint.pending)
        self._guard.moment, self._guard.in_place = checkpoint.standstill
        if checkpoint.heap is not None and self._heap is not None:
            self._heap.restore(checkpoint.heap)

    # ------------------------------------------------------------------ going on

    def advance(self, t: float) -> None:
        """Resolve all events up to t in s."""
        self._guard.begin(self._t, self._numerics)
        self._loop(t)

    def complete(self, started: float) -> Run:
        """Go on to the end; ``started`` is the clock time from which the run's cost is counted."""
        self._guard.begin(self._t, self._numerics)
        return self._finish(started)

    def so_far(self, t: float) -> Run:
        """Return the run up to t in s, up to which all events are resolved; the simulation can go on."""
        numerics = replace(self._numerics)
        run = self._run_until(t, [mover.copy([*mover.path], numerics) for mover in self._movers])
        run.numerics, run.ended = numerics, self.ended or "duration"
        run.events = [event for event in run.events if event.t <= t]
        return run

    def states(self, t: float) -> dict[str, State]:
        """Return the states of all balls that there are at t in s, up to which all events are resolved, by name."""
        return {
            mover.ball.name: self.state_at(index, t)
            for index, mover in enumerate(self._movers)
            if not mover.caught and t >= (mover.path[0] if mover.path else mover.arc).t0
        }

    def noted_since(self, count: int) -> list[Event]:
        """Return the events after the first ``count``, in the order in which they were noted."""
        return self._events[count:]

    @property
    def ended(self) -> str:
        """The way it has ended: "until" or "duration"; "rest" while nothing moves, "" while something does."""
        return self._ended or ("until" if self._over else "" if self._goes_on else "rest")

    @property
    def end(self) -> float:
        """The time in s of the last event: the end of a run that has ended."""
        return self._t

    def _run_until(self, t: float, movers: Sequence[MovingBall]) -> Run:
        run = super()._run_until(t, movers)
        run.eras = tuple(self._eras) if len(self._eras) > 1 else ()
        run.record = self.record.copy()
        return run

    # ------------------------------------------------------------------ checkpoints

    def _resolve(self, event: QueuedEvent) -> None:
        clusters = self._numerics.clusters
        super()._resolve(event)
        self._count += self._at_once if self._numerics.clusters == clusters else _EVENTS_OF_A_CLUSTER
        due = self._count >= _EVENTS and self._count >= _EVENTS_OF_A_BALL * len(self._movers)
        if due and not (self._heap_made and self._heap_made.members):
            self.record.checkpoints.append(self.checkpoint())

    @property
    def _most_at_once(self) -> int:
        return _EVENTS - self._count

    @property
    def _heap_made(self) -> Heap | None:
        """The heap, if it was asked for before."""
        heap: Heap | None = self.__dict__.get("_heap")
        return heap

    def checkpoint(self) -> Checkpoint:
        """Return the present state, in which no heap is stepped: what Chipmunk makes of the same contacts depends on
        the order in which it came to know them. The heap goes on in a new Space, as it will from the checkpoint."""
        self._count = 0
        heap = self._renew_heap()
        numerics = replace(self._numerics)
        return Checkpoint(
            self._t,
            tuple(self._eras),
            len(self.record.changes),
            [mover.copy(mover.path, numerics) for mover in self._movers],
            [len(mover.path) for mover in self._movers],
            self._events,
            len(self._events),
            numerics,
            frozenset(self._moving),
            self._queue.pending(),
            self._over,
            self._ended,
            (self._guard.moment, self._guard.in_place),
            heap,
        )

    def _renew_heap(self) -> HeapState | None:
        """Make the heap anew, if there is one, from its state, which is returned."""
        heap = self._heap_made
        if heap is None:
            self.__dict__.pop("_heap", None)
            return None
        del self._heap
        state = heap.state()
        if self._heap is not None:
            self._heap.restore(state)
        return state

    # ------------------------------------------------------------------ changes

    def state_at(self, index: int, t: float) -> State:
        """Return the state of a ball at t in s, up to which all events are resolved."""
        mover = self._movers[index]
        if mover.caught or t < mover.arc.t0:  # in a simulated contact, which is in its path already
            return Path(mover.path).at(t).state(t)
        return mover.arc.state(t)

    def change(self, t: float, changes: Mapping[str, Any]) -> None:
        """Change something at t in s, up to which all events are resolved; balls in a simulated contact with others
        go through it first. Raises RequestError if that cannot be."""
        present = {mover.ball.name: i for i, mover in enumerate(self._movers) if not mover.caught}
        change = checked(changes, self._setup, present)
        everything = bool(change.given - {"until"}) or self._over
        concerned = present if everything else change.forced | change.motion.keys() | change.removed
        touched = sorted(present[name] for name in concerned)
        t = max(t, self._t)
        while (later := max((self._movers[index].arc.t0 for index in touched), default=t)) > t:
            self.advance(t := later)
        self._refuse_late(t, change)
        here = {index: self.state_at(index, t) for index in touched if not self._movers[index].caught}
        there = {
            index: change.motion[name].applied(self._movers[index].ball, state, t)
            for index, state in here.items()
            if (name := self._movers[index].ball.name) in change.motion
        }
        around = Surroundings(change.setup, self._accuracy.skin)
        new = [around.mover(ball, _start(change.setup, ball), self._accuracy, self._numerics) for ball in change.added]
        self._refuse_overlaps(t, change, there, new)
        for ball in change.setup.balls:
            if ball.name in change.forced:
                refuse_unrepeatable(ball, t, self.state_at(present[ball.name], t))
        self.record.changes.append((t, changes))
        self._eras.append((t, change.setup))
        self._t = t
        self._over = self._over and "until" not in change.given
        self._ended = ""
        self._place(t, here, there, change.setup, around if everything else None)
        self._add(t, new)
        woken = self._take_out(t, [present[name] for name in change.removed])
        if everything or new:
            self._set_up(change.setup)
            self.__dict__.pop("_clusters", None)
            self._renew_heap()
        self._setup = change.setup
        self._resolve_contacts(t, [*here, *range(len(self._movers) - len(new), len(self._movers))], woken)

    def _place(
        self,
        t: float,
        here: Mapping[int, State],
        there: Mapping[int, State],
        setup: Setup,
        around: Surroundings | None,
    ) -> None:
        """Go on at t in s with balls that are ``here``, at once ``there`` if they are moved, in a new setup, and with
        other surfaces and traps ``around`` them."""
        balls = {ball.name: ball for ball in setup.balls}
        for index, state in here.items():
            mover = self._movers[index]
            mover.arrive(t, state)
            if index in there:
                mover.path.append(resting_arc(t, t, there[index], SetByHand()))
            mover.change(balls[mover.ball.name], setup)
            mover.place(t, there.get(index, state))
            if around is not None:
                mover.obstacles, mover.traps = around.obstacles[mover.ball.radius], around.traps_for(mover.ball)

    def _add(self, t: float, new: Sequence[MovingBall]) -> None:
        """Begin with new balls at t in s."""
        for mover in new:
            mover.place(t, mover.state)
            self._moving.add(len(self._movers))
            self._movers.append(mover)

    def _take_out(self, t: float, indices: Sequence[int]) -> bool:
        """Take these balls out; returns True if others in a heap have lain on them or under them."""
        woken = False
        for index in indices:
            mover = self._movers[index]
            heap = self._heap_made
            if heap is not None and heap.has([index]):
                heap.release([index])
                woken = True
            mover.caught = True
            self._moving.discard(index)
            self._note(t, "removed", mover, "", mover.state)
        return woken

    def _resolve_contacts(self, t: float, indices: Sequence[int], woken: bool) -> None:
        """Go on with these balls from t: contacts that close come first, as at the start of a run."""
        before = {index: self._movers[index].version for index in indices}
        if woken and self._heap is not None and self._heap.members:
            self._step_heap(t, ())
        for index, version in before.items():
            mover = self._movers[index]
            if mover.version == version and not mover.caught:
                self._collide(t, [index])

    # ------------------------------------------------------------------ invalid changes

    def _refuse_late(self, t: float, change: Change) -> None:
        if self._over and "until" not in change.given:
            raise RequestError(
                f"t = {t:.6g} s: the run is over, as its until says: change something before that, or until as well"
            )
        if t >= change.setup.duration:
            raise RequestError(
                f"t = {t:.6g} s: the run lasts {change.setup.duration:g} s: change something before that, or duration "
                "as well"
            )

    def _refuse_overlaps(self, t: float, change: Change, there: Mapping[int, State], new: Sequence[MovingBall]) -> None:
        """Raise RequestError if a ball that comes in or is put elsewhere overlaps something, or a new surface does."""
        inside = (i for i, mover in enumerate(self._movers) if not (mover.caught or mover.ball.name in change.removed))
        others = [(self._movers[i].ball, there.get(i) or self.state_at(i, t)) for i in inside]
        others += [(mover.ball, mover.state) for mover in new]
        put = [each for each in others if each[0] in change.added or change.places(each[0].name)]
        for (ball, state), (other, its) in product(put, others):
            reach = ball.radius + other.radius
            if other.name != ball.name and dist(state[:2], its[:2]) < reach:
                gap = meeting(ball, state, other, its).gap
                if gap < -TOUCHING_GAP:
                    raise _overlap(t, ball, state, other.name, -gap)
        around = Surroundings(change.setup, self._accuracy.skin)
        for ball, state in others if "surfaces" in change.given else put:
            deep = TOUCHING_GAP if (ball, state) in put else SLIGHT * ball.radius
            here = [obstacle.at(t) for obstacle in around.obstacles[ball.radius]]
            for obstacle, met in surfaces_met(ball, here, state, -deep):
                raise _overlap(t, ball, state, obstacle.surface.name, -met.gap)


def _start(setup: Setup, ball: Ball) -> State:
    """The state in which a ball comes in."""
    return tuple(map(float, setup.start_of(ball)))


def _overlap(t: float, ball: Ball, state: State, other: str, depth: float) -> RequestError:
    where = f"t = {t:.6g} s, ball {ball.name!r} at ({state[0]:.4g}, {state[1]:.4g}) m"
    return RequestError(f"{where}: it would overlap {other!r} by {depth:.3g} m")
