"""Shots that have flown together, as rows: paths, events, ends and counts, from which a run is made when it is asked
for. Whatever computes many shots gives them in this form."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from itertools import chain, compress
from math import inf, nan
from typing import Any

import numpy as np

from sandbox.engine.live import Record
from sandbox.engine.many.arc_rows import END, START, T0, T1, Paths
from sandbox.engine.many.stacking import Stack, selector
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Vector
from sandbox.engine.paths.path import Above, Path
from sandbox.engine.paths.run import Numerics, Run, State, is_meeting, touched_until

#: What is counted of each run: the first fields of ``Numerics``.
COUNTS = ("force_evaluations", "steps", "refined_steps", "impacts", "pymunk_steps", "queries")


class Flown(Sequence[Any]):
    """The runs of many shots, in order; in place of one that failed the exception with which it ended."""

    def __init__(
        self,
        setups: Stack,
        accuracy: Accuracy,
        paths: Paths,
        events: Sequence[list[Event]],
        durations: Sequence[float],
        ended: list[str],
        counts: np.ndarray,
        alone: Mapping[int, Run | Exception],
        seconds: float,
    ) -> None:
        """For each shot: its path, its events, its duration in s, how it ended and what it cost. ``counts`` has the
        shape (shots, those of COUNTS); each shot took so many ``seconds``. Those that ran
        ``alone`` have only a path."""
        self.setups = setups
        self.accuracy = accuracy
        self.paths = paths
        self.events = events
        self.durations = [*durations]
        self.ended = ended
        self.counts = counts
        self.seconds = seconds
        self._alone = alone
        self.failures = {shot: run for shot, run in alone.items() if isinstance(run, Exception)}
        self.ball: str = setups.whole.balls[0].name
        for shot, run in alone.items():
            if isinstance(run, Run):
                run.arcs = {self.ball: paths[shot]}
                self.durations[shot], self.ended[shot] = run.duration, run.ended
                self.counts[shot] = [getattr(run.numerics, name) for name in COUNTS]

    def __len__(self) -> int:
        return len(self.setups)

    def __getitem__(self, shot: Any) -> Any:
        return self._alone.get(shot) or FlownRun(self, shot)


class FlownRun(Run):
    """The run of one of many shots: what is asked of it is read from their rows then."""

    def __init__(self, flown: Flown, shot: int) -> None:
        self._flown, self._shot = flown, shot
        self.duration = flown.durations[shot]
        self.ended = flown.ended[shot]

    @cached_property
    def accuracy(self) -> Accuracy:  # type: ignore[override]
        return self._flown.accuracy

    @cached_property
    def setup(self) -> Setup:  # type: ignore[override]
        return self._flown.setups[self._shot]

    @cached_property
    def arcs(self) -> Mapping[str, Path]:  # type: ignore[override]
        return {self._flown.ball: self._flown.paths[self._shot]}

    @cached_property
    def events(self) -> list[Event]:  # type: ignore[override]
        return self._flown.events[self._shot]

    @cached_property
    def numerics(self) -> Numerics:  # type: ignore[override]
        found = Numerics(*self._flown.counts[self._shot].tolist())
        found.wall_s = self._flown.seconds
        return found

    @cached_property
    def record(self) -> Record:  # type: ignore[override]
        return Record(self.setup, self.accuracy)


class AllRuns:
    """All runs as one, with arrays in place of numbers: what a fact may read of them at once.

    A time or state that a run does not have is NaN where a run alone has None; ``missing`` lists which runs that
    concerns. Whatever else a fact reads it reads of one run after another: here it is an AttributeError.
    """

    def __init__(self, flown: Flown) -> None:
        self.setup: Setup = flown.setups.whole
        self.missing: list[np.ndarray] = []  # masks, shape (shots,)
        self._flown = flown
        self._passed: list[tuple[Above, tuple[np.ndarray, np.ndarray, np.ndarray]]] = []
        self._met: dict[tuple[str | None, str], np.ndarray] = {}

    def highest(self, ball: str, until: Any = inf) -> tuple[np.ndarray, State]:
        """As ``Run.highest``."""
        return self._found(ball, *self._paths.summits(until))

    def first_crossing(self, ball: str, point: Vector, normal: Vector, before: Any = inf) -> tuple[np.ndarray, State]:
        """As ``Run.first_crossing``; line and time may be others for each run."""
        numbers, t, states = self._passing(Above.line(point, normal))
        numbers, first = np.unique(numbers, return_index=True)
        return self._found(ball, *self._paths.spread(numbers, t[first], states[first]), before)

    def crossings(self, ball: str, point: Vector, normal: Vector) -> Iterator[tuple[np.ndarray, State]]:
        """As ``Run.crossings``: the first of all runs, then the second, and so on; NaN where a run has fewer."""
        return self._in_turn(ball, *self._passing(Above.line(point, normal)))

    def _passing(self, line: Above) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The passages of all through a line, which may be another for each."""
        if all(type(part) is float for part in line):
            return self._paths.passages_of_all(line)
        for known, found in self._passed:
            if all(a is b or (type(a) is type(b) is float and a == b) for a, b in zip(known, line, strict=True)):
                return found
        lengths = self._paths.lengths
        lines = (np.repeat(part, lengths) if isinstance(part, np.ndarray) else part for part in line)
        found = self._paths.passing(Above(*lines))
        self._passed.append((line, found))
        return found

    def first_start(self, ball: str, holds: Callable[[State], Any], among: Any = True) -> np.ndarray:
        """As ``Run.first_start``: of a dataclass, which may have a number for each run, as ``among`` may."""
        if ball != self._flown.ball:
            raise KeyError(ball)
        paths = self._paths
        rows = np.repeat(np.broadcast_to(among, len(paths.lengths)), paths.lengths).nonzero()[0]
        numbers = paths.numbers[rows]
        there = np.broadcast_to(selector(holds)(numbers)(State(*paths.rows[rows, START].T)), len(rows)).nonzero()[0]
        numbers, first = np.unique(numbers[there], return_index=True)
        found = np.full(len(self._flown), inf)
        found[numbers] = paths.rows[rows[there[first]], T0]
        return found

    def steps(self, ball: str, until: Any) -> tuple[np.ndarray, np.ndarray]:
        """As ``Run.steps``, shapes (arcs, shots) and (6, arcs, 3, shots): a shot with fewer arcs has its last again,
        with a duration of 0; NaN where ``until`` is."""
        if ball != self._flown.ball:
            raise KeyError(ball)
        return self._paths.steps(until)

    def first_event(self, partner: str) -> Event | None:
        """As ``Run.first_event``: one with arrays, not a number for runs without; None if all are."""
        firsts = self._firsts([event.partner == partner for event in self._events])
        if not firsts:
            return None
        numbers: Any = np.full((4, len(self._flown)), nan)
        numbers[:, [*firsts]] = np.array([(each.t, each.speed, each.x, each.y) for each in firsts.values()]).T
        t, speed, x, y = numbers
        return next(iter(firsts.values()))._replace(t=t, speed=speed, x=x, y=y)

    def touched(self, until: Any) -> np.ndarray:
        """As ``Run.touched``: lists as an array."""
        found, times = np.empty(len(self._flown), dtype=object), np.broadcast_to(until, len(self._flown)).tolist()
        found[:] = [touched_until(events, t) for events, t in zip(self._flown.events, times, strict=True)]
        return found

    def before_meeting(
        self, partner: str | None = None, ball: str = "ball", before: Any = inf
    ) -> tuple[np.ndarray, State]:
        """As ``Run.before_meeting``."""
        flown, paths = self._flown, self._paths
        t = self._meeting_times(partner, ball)
        ends = np.flatnonzero(paths.rows[:, T1] == np.repeat(t, paths.lengths))
        numbers, first = np.unique(np.repeat(np.arange(len(t)), paths.lengths)[ends], return_index=True)
        _, states = paths.spread(numbers, t[numbers], paths.rows[ends[first], END])
        for shot in np.flatnonzero(np.isfinite(t) & np.isnan(states[0])).tolist():  # at its start
            states[:, shot] = flown[shot].before(flown.ball, float(t[shot]))
        return self._found(ball, t, states, before)

    def until_meeting(self, partner: str) -> np.ndarray:
        """As ``Run.until_meeting``."""
        return np.minimum(self._meeting_times(partner), self._flown.durations)

    def _meeting_times(self, partner: str | None, ball: str = "") -> np.ndarray:
        """``meeting_time`` of each run, computed once."""
        if (partner, ball) not in self._met:
            found = np.full(len(self._flown), inf)
            firsts = self._firsts([is_meeting(event, partner, ball) for event in self._events])
            found[[*firsts]] = [event.t for event in firsts.values()]
            self._met[partner, ball] = found
        return self._met[partner, ball]

    def _firsts(self, chosen: Sequence[bool]) -> dict[int, Event]:
        """The first of the chosen events of each run that has one."""
        found = [*compress(zip(self._runs_of_events, self._events, strict=True), chosen)]
        return dict(reversed(found))

    @cached_property
    def _events(self) -> list[Event]:
        """The events of all runs, one after another."""
        return [*chain.from_iterable(self._flown.events)]

    @cached_property
    def _runs_of_events(self) -> list[int]:
        """The number of the run of each of them."""
        return [run for run, events in enumerate(self._flown.events) for _ in events]

    def _in_turn(
        self, ball: str, numbers: np.ndarray, t: np.ndarray, states: np.ndarray
    ) -> Iterator[tuple[np.ndarray, State]]:
        """The first times and states of all runs, then the second, and so on; ``numbers`` are the runs', ascending."""
        if ball != self._flown.ball:
            raise KeyError(ball)
        place = np.arange(len(numbers)) - np.searchsorted(numbers, numbers)
        order, first = np.argsort(place, kind="stable"), 0
        numbers, t, states = numbers[order], t[order], states[order]
        for last in np.cumsum(np.bincount(place)).tolist():
            times, there = self._paths.spread(numbers[first:last], t[first:last], states[first:last])
            yield times, State(*there)
            first = last

    @property
    def _paths(self) -> Paths:
        return self._flown.paths

    def _found(self, ball: str, t: np.ndarray, states: np.ndarray, before: Any = inf) -> tuple[np.ndarray, State]:
        if ball != self._flown.ball:
            raise KeyError(ball)
        missing = ~(t < before)
        self.missing.append(missing)
        return np.where(missing, nan, t), State(*np.where(missing, nan, states))
