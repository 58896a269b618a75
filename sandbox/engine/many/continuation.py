"""Shots that leave a batch: the reason, and each one's continuation alone."""

from __future__ import annotations

from enum import IntEnum, auto
from time import perf_counter
from typing import NamedTuple

from sandbox.engine.model.event import Event
from sandbox.engine.motion.sustained_contact import SustainedContact
from sandbox.engine.paths.arc import Arc, resting_arc
from sandbox.engine.paths.run import Run
from sandbox.engine.single_flight import FlightSimulation
from sandbox.physics.integrators import State


class ExitReason(IntEnum):
    """The reason for which a shot leaves its batch."""

    NONE = 0
    """It stays."""

    UNTIL = auto()
    """Its run is over: what it should last until has happened."""

    REST = auto()
    """Its run is over: the ball rests."""

    DURATION = auto()
    """Its run is over: its duration has passed."""

    START = auto()
    """It is to be computed alone from its start."""

    IN_FLIGHT = auto()
    """It is to be continued in the middle of its flight."""

    BEFORE_IMPACT = auto()
    """It is to be continued where it touches something, before the impact."""

    AFTER_IMPACT = auto()
    """It is to be continued after an impact."""

    CONTACT_CHANGE = auto()
    """It is to be continued where its slide or roll has ended."""


#: The ``ended`` of a run, for shots that leave with their run complete.
ENDED = {ExitReason.UNTIL: "until", ExitReason.REST: "rest", ExitReason.DURATION: "duration"}


class BatchExit(NamedTuple):
    """The state in which a shot leaves its batch."""

    t: float  # s
    reason: ExitReason
    state: State
    step: float  # s, that the integrator would try next
    contact: SustainedContact | None
    arcs: list[Arc]  # the last one, if there is any and it is to be continued


class Continuation(FlightSimulation):
    """A run of one ball that a batch has begun."""

    def resume(self, left: BatchExit, events: list[Event]) -> Run:
        """Run from where the shot has left its batch, with these events so far, to its end."""
        if left.reason is ExitReason.START:
            return self.run()
        started = perf_counter()
        t, reason, state, step, contact, arcs = left
        mover, self._t = self._movers[0], t
        if contact is not None:
            surface = contact.obstacle.surface
            contact = contact._replace(obstacle=next(each for each in mover.obstacles if each.surface is surface))
        mover.arc, mover.state, mover.path = resting_arc(t, t, state, contact), state, [*arcs]
        mover.next_step, mover.contact = step, contact
        self._events = events
        if reason is ExitReason.AFTER_IMPACT and events:
            self._over = self._setup.ends_with(events)  # the earlier events were checked before
        if reason is ExitReason.IN_FLIGHT:
            self._plan(0, t)
        elif reason is ExitReason.BEFORE_IMPACT:
            self._collide(t, [0])
        else:
            self._resume(0, t)
        return self._finish(started)
