"""Shots of a batch that fly in the compiled kernel: many steps and impacts at once, until something else happens."""

from __future__ import annotations

import numpy as np

from sandbox.engine.kernel.leg import (
    AFTER_IMPACT,
    ARCS,
    BEFORE_IMPACT,
    CURVATURE,
    DURATION,
    ERROR,
    EVENTS,
    MET,
    NX,
    PASSED,
    SPIN,
    STEP,
    UNTIL,
    WHY,
    T,
    X,
)
from sandbox.engine.kernel.leg import STEPS as FIRST_COUNT
from sandbox.engine.kernel.library import FlyAll, fly_together
from sandbox.engine.kernel.rows import Tables, rules_of
from sandbox.engine.many.arc_rows import END, START, T1
from sandbox.engine.many.batch_record import IMPACTS, BatchRecord
from sandbox.engine.many.continuation import ExitReason
from sandbox.engine.many.in_flight import InFlight
from sandbox.engine.many.stacking import selector
from sandbox.engine.model.setup import Until

#: The columns of a shot's state.
_STATE = slice(X, SPIN + 1)

#: Where a leg's end leaves a shot, by why it ended. One whose next step is an error runs alone, which raises it.
_EXITS = np.array([ExitReason.NONE] * (PASSED + 1))
_EXITS[[DURATION, UNTIL, ERROR]] = ExitReason.DURATION, ExitReason.UNTIL, ExitReason.IN_FLIGHT


class Legs:
    """The flight of those shots of a batch that are on nothing, leg by leg."""

    def __init__(self, fly_all: FlyAll, tables: Tables, flying: InFlight, record: BatchRecord) -> None:
        self._fly_all = fly_all
        self._tables = tables
        self._flying = flying
        self._record = record
        setup = record.setups.whole
        self._until = selector(setup.until)
        self._passes = isinstance(setup.until, Until) and type(setup.until).passed is not Until.passed

    def fly(self) -> np.ndarray:
        """Fly all shots that are on nothing to the end of a leg. Returns the lanes of those that touch what is to be
        resolved."""
        flying, record = self._flying, self._record
        lanes = ((flying.surface < 0) & (flying.met < 0)).nonzero()[0]
        if not len(lanes):
            return lanes
        shots, rows = flying.shot[lanes], np.empty((len(lanes), STEP + 1))
        rows[:, T], rows[:, _STATE], rows[:, STEP] = flying.t[lanes], flying.state[:, lanes].T, flying.next_step[lanes]
        tables = self._tables if len(shots) == len(record.setups) else self._tables.of(shots)
        after, arcs, events = fly_together(self._fly_all, rows, tables, self._impacts_so_far(shots))
        of_arcs, of_events = (
            np.repeat(np.arange(len(shots)), np.diff(after[:, column].astype(int), prepend=0))
            for column in (ARCS, EVENTS)
        )
        if self._passes:
            stay, happened = self._until_passed(after, shots[of_arcs], of_arcs, arcs, of_events, events)
            of_arcs, arcs, of_events, events = of_arcs[stay], arcs[stay], of_events[happened], events[happened]
        record.add_arcs(shots[of_arcs], arcs.T)
        counts = after[:, FIRST_COUNT : FIRST_COUNT + 4].astype(int)
        counts[:, IMPACTS] = np.bincount(of_events, minlength=len(shots))
        record.counts[:, shots] += counts.T
        record.add_impacts(shots[of_events], events)
        flying.t[lanes], flying.state[:, lanes], flying.next_step[lanes] = (
            after[:, T],
            after[:, _STATE].T,
            after[:, STEP],
        )
        why = after[:, WHY].astype(int)
        flying.exit[lanes] = _EXITS[why]
        hit = why == AFTER_IMPACT
        flying.met[lanes[hit]] = after[hit, MET].astype(int)
        flying.normal[:, lanes[hit]] = after[hit, NX : CURVATURE + 1].T
        touching: np.ndarray = lanes[why == BEFORE_IMPACT]
        return touching

    def _impacts_so_far(self, shots: np.ndarray) -> np.ndarray:
        """The impacts so far of each of these shots that each rule is about."""
        setups, counted = self._record.setups, np.zeros((len(shots), self._tables.rules.shape[1]))
        if counted.shape[1] > 0:
            for place, shot in enumerate(shots.tolist()):
                if events := self._record.events[shot]:
                    rules = rules_of(setups[shot]) or ()
                    counted[place] = [sum(map(rule.counts, events)) for rule in rules]
        return counted

    def _until_passed(
        self,
        after: np.ndarray,
        shots: np.ndarray,
        of_arcs: np.ndarray,
        arcs: np.ndarray,
        of_events: np.ndarray,
        events: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray]:
        """End each shot with the first arc on which its run's condition is passed. Returns masks of the arcs and of the
        events up to there."""
        stay, happened = np.ones(len(arcs), dtype=bool), np.ones(len(events), dtype=bool)
        passed = self._until(shots).passed(tuple(arcs[:, START].T), tuple(arcs[:, END].T))
        places = np.broadcast_to(passed, len(arcs)).nonzero()[0]
        ended, first = np.unique(of_arcs[places], return_index=True)
        if len(ended):
            last = places[first]
            final, until = np.full(len(after), len(arcs)), np.full(len(after), np.inf)
            final[ended], until[ended] = last, arcs[last, T1]
            in_time = (after[ended, WHY] != DURATION) | (arcs[last, T1] < after[ended, T])
            after[ended[in_time], WHY], after[ended, T], after[ended, _STATE] = UNTIL, arcs[last, T1], arcs[last, END]
            stay, happened = np.arange(len(arcs)) <= final[of_arcs], events[:, 0] < until[of_events]
        return stay, happened
