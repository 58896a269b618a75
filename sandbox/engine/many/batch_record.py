"""The record of a batch: events, pieces of path and counts of all its shots, from which their runs are made."""

from __future__ import annotations

from typing import Any

import numpy as np

from sandbox.engine.live import Record
from sandbox.engine.many.arc_rows import COLUMNS, Paths, arc_of, columns_of
from sandbox.engine.many.continuation import ENDED, BatchExit, Continuation
from sandbox.engine.many.flown import Flown
from sandbox.engine.many.stacking import Stack
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup_errors import setup_errors_named
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.run import Numerics, Run

#: Rows of the counts.
STEPS, REFINED, IMPACTS, QUERIES = range(4)


class BatchRecord:
    """Events, arcs and counts of each shot so far."""

    def __init__(self, setups: Stack, accuracy: Accuracy, evaluations: int) -> None:
        """``evaluations`` of the forces are made in each step."""
        self.setups = setups
        self.names = [each.name for each in (*setups.whole.balls, *setups.whole.surfaces)]
        self._accuracy = accuracy
        self._evaluations = evaluations
        self.events: list[list[Event]] = [[] for _ in range(len(setups))]
        self.counts = np.zeros((4, len(setups)), dtype=int)
        self.contacts: list[Any] = []  # sustained ones, in the order in which they began
        self.exits: dict[int, BatchExit] = {}  # by shot, of those that are to be continued
        self.ends, self.reasons = np.zeros(len(setups)), np.zeros(len(setups), dtype=int)  # s; why each shot left
        self.pieces = 0  # of path, of all shots
        self._paths = [(np.zeros(0, dtype=int), columns_of([], []))]  # shots, and the rows of their arcs as columns

    def add_arcs(self, shots: np.ndarray, rows: np.ndarray) -> None:
        """Add an arc to the path of each of these shots."""
        self._paths.append((shots, rows))
        self.pieces += len(shots)

    def add_impacts(self, shots: np.ndarray, rows: np.ndarray) -> None:
        """Add an impact of each of these shots: rows of the time in s, the surface, the speed in m/s, x and y in m."""
        ball, *surfaces = self.names
        for shot, (t, what, speed, x, y) in zip(shots.tolist(), rows.tolist(), strict=True):
            self.events[shot].append(Event(t, "impact", ball, surfaces[int(what)], speed, x, y))

    def last_arc(self, shot: int) -> list[Arc]:
        """The last arc of a shot, if it has one."""
        for shots, rows in reversed(self._paths):
            if shot in shots:
                return [arc_of(rows[:, np.flatnonzero(shots == shot)[-1]].tolist(), self.contacts)]
        return []

    def flown(self, seconds: float) -> Flown:
        """The runs of all shots, of which those that are not over are continued alone; the batch took so many
        ``seconds``."""
        alone = {shot: self._continued(shot) for shot in self.exits}
        shots = np.concatenate([shots for shots, _ in self._paths])
        places, rows, first = np.empty(len(shots), dtype=int), np.empty((len(shots), COLUMNS)), 0
        places[np.argsort(shots, kind="stable")] = np.arange(len(shots))
        for part, columns in self._paths:
            rows[places[first : first + len(part)]] = columns.T
            first += len(part)
        paths = Paths(rows, np.cumsum(np.bincount(shots, minlength=len(self.setups))).tolist(), self.contacts)
        return Flown(
            self.setups,
            self._accuracy,
            paths,
            self.events,
            self.ends.tolist(),
            [ENDED.get(reason, "") for reason in self.reasons.tolist()],
            self._numbers(slice(None)).T,
            alone,
            seconds / len(self.setups),
        )

    def _numbers(self, shots: int | slice) -> np.ndarray:
        """Evaluations of the forces, steps, refined steps, impacts, steps of pymunk, and queries of these shots."""
        steps, refined, impacts, queries = self.counts[:, shots]
        return np.array(((self._evaluations + 1) * steps, steps, refined, impacts, impacts, queries))

    def _continued(self, shot: int) -> Run | Exception:
        """The run of a shot that is continued alone, without its arcs, which become rows if they are not."""
        setup, left, events = self.setups[shot], self.exits[shot], self.events[shot]
        try:
            with setup_errors_named():
                numerics = Numerics(*self._numbers(shot).tolist())
                run = Continuation(setup, self._accuracy, numerics).resume(left, events)
        except Exception as error:
            return error
        run.record = Record(setup, self._accuracy)
        self.events[shot] = run.events
        arcs = list(run.arcs[setup.balls[0].name])[len(left.arcs) :]
        contacts = range(len(self.contacts), len(self.contacts) + len(arcs))
        self.contacts += [arc.contact for arc in arcs]
        self._paths.append((np.full(len(arcs), shot), columns_of(arcs, contacts)))
        return run
