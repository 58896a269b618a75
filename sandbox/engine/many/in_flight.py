"""The shots that are still in a batch: where they are, and what holds for each at present."""

from __future__ import annotations

from typing import Any

import numpy as np

from sandbox.engine.many.continuation import ExitReason
from sandbox.engine.many.stacking import Stack, selector
from sandbox.engine.model.ball import Ball
from sandbox.engine.motion.forces_on_ball import acceleration_function
from sandbox.engine.paths.phase import Phase

#: Attributes of InFlight that are arrays with shots along the last axis.
_ARRAYS = (
    *("shot", "t", "state", "next_step", "repeats", "exit"),
    *("met", "normal"),
    *("surface", "phase", "direction", "contact", "motion_ended"),
)


class InFlight:
    """The shots that are in flight, or slide or roll. Arrays have one entry for each, or rows of them; a place in these
    arrays is a lane."""

    def __init__(self, setups: Stack, first_step: float) -> None:
        """All shots, at their start; ``first_step`` is in s."""
        self.setup, count = setups.whole, len(setups)  # of those that are still in the batch, with arrays for numbers
        self._select = selector(self.setup)
        ball = self.setup.balls[0]
        self.acceleration_at = acceleration_function(ball, floats=False)
        self.shot = np.arange(count)  # index of its setup
        self.t = np.zeros(count)  # s
        self.state: Any = np.array([np.broadcast_to(part, count) for part in self.setup.start_of(ball)], float)
        self.next_step = np.full(count, first_step)  # s
        self.repeats = np.zeros(count, dtype=bool)  # the last step was too long and is repeated
        self.exit = np.full(count, ExitReason.NONE)  # why it leaves the batch now
        # after a touch
        self.met = np.full(count, -1)  # surface that it has just met, or -1
        self.normal = np.zeros((3, count))  # of that: nx, ny and the curvature of the ball's path along it in 1/m
        # in sustained contact
        self.surface = np.full(count, -1)  # on which it slides or rolls; -1 in flight
        self.phase = np.full(count, Phase.FREE, dtype=object)
        self.direction = np.zeros(count)  # of the motion in contact, as in SustainedContact
        self.contact = np.full(count, -1)  # place in the record's contacts
        self.motion_ended = np.zeros(count, dtype=bool)  # its sliding or rolling has just ended

    def __len__(self) -> int:
        return len(self.shot)

    def keep(self, staying: np.ndarray) -> None:
        """Drop all shots but those of this mask."""
        for name in _ARRAYS:
            setattr(self, name, getattr(self, name)[..., staying])
        self.setup = self._select(self.shot)
        self.acceleration_at = acceleration_function(self.setup.balls[0], floats=False)

    def ball_of(self, shots: np.ndarray) -> Ball:
        """The ball of these shots, with arrays for numbers."""
        ball: Ball = self._select(shots).balls[0]
        return ball
