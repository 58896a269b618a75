"""Many shots at once: flights, slides and rolls in arrays over the shots, impacts by pymunk.

The shots of a batch are similar: one ball and the same kinds of forces and surfaces, with different numbers. Each shot
has its own time and its own steps, and moves exactly as in simulation.py. Rare cases (sustained contact with anything
but a straight side, two surfaces at once, an invalid state) leave the batch, and are continued alone from their current
state (``continuation.py``).
"""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter
from typing import Any

import numpy as np

from sandbox.engine.kernel.library import compiled
from sandbox.engine.kernel.rows import tables
from sandbox.engine.kernel.step_control import StepControl, StepLimits
from sandbox.engine.many.arc_rows import END, START, T0, T1, X, Y, arc_of, cut, resting_columns, stepped
from sandbox.engine.many.batch_contact import BatchContacts
from sandbox.engine.many.batch_forces import NotVectorizable, accelerations, check_forces
from sandbox.engine.many.batch_impacts import BatchImpacts
from sandbox.engine.many.batch_record import QUERIES, REFINED, STEPS, BatchRecord
from sandbox.engine.many.batch_steps import allowed, attempt, shortest
from sandbox.engine.many.continuation import BatchExit, ExitReason
from sandbox.engine.many.flown import Flown
from sandbox.engine.many.in_flight import InFlight
from sandbox.engine.many.legs import Legs
from sandbox.engine.many.outlines import BatchSurfaces
from sandbox.engine.many.stacking import FEWEST, Stack, selector
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.setup import Setup, Until
from sandbox.engine.model.tolerances import CLOSING, NEGLIGIBLE_OVERLAP
from sandbox.engine.paths.arc import hermite_arc

#: Fields of a setup that are combined for flights together; their ``until`` is called for each.
_FLIGHT = ("balls", "surfaces", "force_regions", "bounds", "duration", "discontinuities")

#: Pieces of path in a batch, 300 bytes each, beyond which its shots continue one at a time, where the number of steps
#: is limited.
MOST_PIECES = 500_000

#: Shots whose forces are checked one by one at the start; later one shot is checked in each step.
_WATCHED = 32


def simulate_batch(setups: Sequence[Setup], accuracy: Accuracy) -> Flown | None:
    """A run of each setup, in order, or the exception it ended with; None if they cannot fly together."""
    stack = _stack(setups)
    if stack is None:
        return None
    batch = Batch(stack, accuracy)
    try:
        batch.fly()
    except NotVectorizable:
        return None  # one at a time they run, or raise an error of their own
    return batch.flown()


def _stack(setups: Sequence[Setup]) -> Stack | None:
    """The setups as one, if they can fly together."""
    if isinstance(setups, Stack):
        return setups if setups.whole.is_single_ball else None
    if len(setups) < FEWEST or not all(setup.is_single_ball for setup in setups):
        return None
    try:
        return Stack.of(setups, (*_FLIGHT, "until") if isinstance(setups[0].until, Until) else _FLIGHT)
    except Exception:  # NotStackable, or what a class of the scene raises when it is compared
        return None


class Batch:
    """Shots that fly together, each by its own steps: in each round all take one, or have an impact."""

    def __init__(self, setups: Stack, accuracy: Accuracy) -> None:
        self.setups = setups
        self._control = StepControl(accuracy)
        self._flying = InFlight(setups, self._control.first)
        self._record = BatchRecord(setups, accuracy, self._control.evaluations)
        self._outlines = BatchSurfaces(setups, accuracy.skin)
        self._contacts = BatchContacts(self._flying, self._outlines, self._record, accuracy.settle)
        self._impacts = BatchImpacts(self._flying, self._outlines, self._record)
        fly_all = compiled()
        rows = None if fly_all is None else tables(setups.whole, accuracy, len(setups))
        self._legs = None if fly_all is None or rows is None else Legs(fly_all, rows, self._flying, self._record)
        self._step = self._control.integrator.step_of_many(self._contacts.acceleration_at)
        self._duration = np.broadcast_to(setups.whole.duration, len(setups))  # s
        self._until = selector(setups.whole.until)

    def fly(self) -> None:
        """Fly all shots to their end, or until they leave the batch."""
        started, flying = perf_counter(), self._flying
        with np.errstate(all="ignore"):
            if self._legs is None:
                some = np.arange(0, len(flying), max(1, len(flying) // _WATCHED))
                check_forces(self.setups, flying, some, accelerations(flying.acceleration_at, flying.t, flying.state))
            self._begin()
            self._fly_legs()
            rounds = 0
            while len(flying) >= FEWEST and self._record.pieces < MOST_PIECES:
                self._advance_all(rounds % len(flying))
                self._fly_legs()
                rounds += 1
        on_the_way = np.where(flying.motion_ended, ExitReason.CONTACT_CHANGE, ExitReason.IN_FLIGHT)
        flying.exit = np.where(flying.met >= 0, ExitReason.AFTER_IMPACT, on_the_way)
        self._drop()
        self._seconds = perf_counter() - started

    def flown(self) -> Flown:
        """Each shot's run, in order, or the exception it ended with."""
        return self._record.flown(self._seconds)

    def _begin(self) -> None:
        """Start the shots that are in the air, or lie on one surface; the others are to be computed alone."""
        flying = self._flying
        self._record.add_arcs(flying.shot, resting_columns(flying.t, flying.state))  # as each was launched
        x, y, vx, vy, _ = flying.state
        count, surface, near = self._outlines.near(flying.shot, x, y)
        away = vx * near.nx + vy * near.ny
        flying.met, flying.normal = np.where(count == 1, surface, -1), np.array(near[1:4])
        flying.exit[~((count == 0) | ((count == 1) & (near.gap >= -NEGLIGIBLE_OVERLAP) & (away >= -CLOSING)))] = (
            ExitReason.START
        )
        self._drop()

    def _fly_legs(self) -> None:
        """Let shots that are on nothing fly in the compiled kernel, if it takes them, as far as it does."""
        if self._legs is not None and len(self._flying):
            touching = self._legs.fly()
            if len(touching):
                self._impacts.collide(touching)
            self._drop()

    def _advance_all(self, watched: int) -> None:
        """Take one step of each shot, up to the first touch, which is resolved; the forces of the lane that is
        ``watched`` are checked."""
        flying = self._flying
        known = accelerations(flying.acceleration_at, flying.t, flying.state)
        if self._legs is None:
            check_forces(self.setups, flying, np.array([watched]), known)
        self._contacts.find_next_motions(known)
        known = known[:, self._drop()]
        if not len(flying) or (self._legs is not None and not (flying.surface >= 0).any()):
            return
        self._contacts.hold()
        if self._contacts.any_held:
            known = self._contacts.acceleration_at(flying.t, flying.state)
        lanes, rows, changes = self._stepped(known)
        if len(lanes):
            self._travel(lanes, rows, changes)
        self._drop()

    def _stepped(self, known: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Try a step of each shot, from the accelerations that are ``known``. Returns the lanes that can take it, their
        arcs as columns, and where on them a slide or a roll ends, as u."""
        flying, counts = self._flying, self._record.counts
        h = np.minimum(flying.next_step, flying.setup.duration - flying.t)
        ball = flying.setup.balls[0]
        longest = allowed(StepLimits.of(flying.setup, ball), flying.t, h, flying.state, known)
        h = np.where(flying.repeats, flying.next_step, longest)
        fits, following, after, last = attempt(
            self._control, self._step, flying.t, flying.state, known, h, flying.next_step, ball.radius
        )
        here = np.ones(len(flying), dtype=bool) if self._legs is None else flying.surface >= 0  # others fly in legs
        flying.repeats = here & ~fits
        counts[STEPS, flying.shot] += here
        counts[REFINED, flying.shot] += flying.repeats
        accepted = here & fits & flying.setup.bounds.hold(after)
        stuck = here & ~accepted & (fits | (following < shortest(flying.t)))
        flying.exit[stuck] = ExitReason.IN_FLIGHT  # which raises the error
        wanted, flying.next_step = flying.next_step, np.where(here, np.where(stuck, h, following), flying.next_step)
        lanes = accepted.nonzero()[0]
        ends: Any = flying.state, known, after, last
        arc = hermite_arc(flying.t[lanes], h[lanes], *(part[:, lanes] for part in ends))
        rows = stepped(arc, flying.contact[lanes])
        changes, lasts = self._contacts.changes(rows, accepted)
        if not lasts.all():
            unclear = lanes[~lasts]  # what follows the contact: this step is made again, alone
            flying.exit[unclear], flying.next_step[unclear] = ExitReason.IN_FLIGHT, wanted[unclear]
            counts[STEPS, flying.shot[unclear]] -= 1
            lanes, rows, changes = lanes[lasts], rows[:, lasts], changes[lasts]
        return lanes, rows, changes

    def _travel(self, lanes: np.ndarray, rows: np.ndarray, changes: np.ndarray) -> None:
        """Take the accepted step of these lanes, up to the first touch, or to where the motion in contact changes."""
        flying = self._flying
        shots, t0 = flying.shot[lanes], rows[T0]
        ends = np.isfinite(changes).nonzero()[0]
        if len(ends):
            u = changes[ends]
            rows[:, ends] = cut(rows[:, ends], t0[ends] + u * (rows[T1, ends] - t0[ends]), u)
        u, looked_at = self._outlines.first_touch(
            shots, rows[X], rows[Y], lambda i: arc_of(rows[:, i].tolist()), flying.surface[lanes]
        )
        self._record.counts[QUERIES, shots] += looked_at
        t = t0 + u * (rows[T1] - t0)
        hits = (t <= rows[T1]).nonzero()[0]
        if len(hits):
            flying.next_step[lanes[hits]] = np.minimum(flying.next_step[lanes[hits]], rows[T1, hits] - t0[hits])
            rows[:, hits] = cut(rows[:, hits], t[hits], u[hits])
            changes[hits] = np.inf
        self._record.add_arcs(shots, rows)
        flying.t[lanes], flying.state[:, lanes] = rows[T1], rows[END]
        self._contacts.end_motions(lanes, changes < np.inf)
        reasons = np.where(rows[T1] >= self._duration[shots], ExitReason.DURATION, ExitReason.NONE)
        reasons[hits] = ExitReason.NONE
        if isinstance(flying.setup.until, Until):
            passed = self._until(shots).passed(tuple(rows[START]), tuple(rows[END]))
            reasons[(reasons == ExitReason.NONE) & ~np.isfinite(changes) & passed] = ExitReason.UNTIL
            hits = hits[reasons[hits] == ExitReason.NONE]
        flying.exit[lanes] = reasons
        if len(hits):
            self._impacts.collide(lanes[hits])

    def _drop(self) -> np.ndarray:
        """Record the state of shots that leave, and keep the others. Returns a mask of these."""
        flying, record = self._flying, self._record
        staying: np.ndarray = flying.exit == ExitReason.NONE
        leaving = (~staying).nonzero()[0]
        record.ends[flying.shot[leaving]], record.reasons[flying.shot[leaving]] = (
            flying.t[leaving],
            flying.exit[leaving],
        )
        for lane in leaving[flying.exit[leaving] > ExitReason.DURATION].tolist():  # to be continued
            shot, reason, contact = int(flying.shot[lane]), ExitReason(flying.exit[lane]), int(flying.contact[lane])
            record.exits[shot] = BatchExit(
                float(flying.t[lane]),
                reason,
                tuple(flying.state[:, lane].tolist()),
                float(flying.next_step[lane]),
                record.contacts[contact] if contact >= 0 else None,
                record.last_arc(shot),
            )
        if len(leaving):
            flying.keep(staying)
        return staying
