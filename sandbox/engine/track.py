"""One ball during a run: its state, current arc and path."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol

from sandbox.engine.arc import Arc, still, through
from sandbox.engine.motion import LastingContact
from sandbox.engine.setup import Ball
from sandbox.engine.touch import TOUCHING_GAP, Obstacle, Touching
from sandbox.physics.integrators import State

#: Value of ``Arc.contact`` for a ball in a simulated contact with others.
PRESSED = "pressed"

#: Difference in m/s and rad/s below which it is rounding.
_SAME = 1e-9

Near = tuple[Obstacle, Touching]


class Motion(Protocol):
    """How one ball moves: in the plane of the picture, or on cloth."""

    ball: Ball

    def advance(self, t: float, until: float, state: State, contact: LastingContact | None) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``, and why it ends: "" if only because of its length."""

    def settle(self, t: float, state: State, track: Track, height: float) -> tuple[State, LastingContact | None]:
        """The state from which the ball continues after a touch, and its lasting contact if it stays there because it
        would not bounce higher than ``height`` (m)."""

    def conclude(self, state: State, contact: LastingContact | None, reason: str) -> State:
        """The state at the end of an arc that ended for ``reason``."""

    def rests(self, arc: Arc) -> bool:
        """Whether the ball is at rest on this arc."""


class Track:
    """A ball's state, the arc it is on, and the path behind it."""

    def __init__(self, mover: Motion, obstacles: Sequence[Obstacle], catches: Sequence[Obstacle], state: State) -> None:
        self.mover = mover
        self.ball = mover.ball
        self.obstacles = obstacles
        self.catches = catches
        self.state = state
        self.contact: LastingContact | None = None
        self.arc = still(0.0, 0.0, state)  # the current arc
        self.path: list[Arc] = []
        self.version = 0  # of the arc: predictions for an earlier one are invalid
        self.rests = False
        self.caught = False

    def begin(self, x: float, y: float) -> None:
        """Start at (x, y), in m."""
        self.state = (x, y, *self.state[2:])
        self.arc = still(0.0, 0.0, self.state)

    def keep(self, t: float) -> None:
        """Add the arc up to t to the path."""
        if t < self.arc.t0:
            return  # within a contact that is already in the path
        arc = self.arc.until(t)
        if arc.t1 > arc.t0 or not self.path:
            self.path.append(arc)

    def meet(self, t: float, until: float, state: State) -> None:
        """Add a contact that lasts from t to ``until`` and ends in ``state``; the path is complete up to t."""
        before = self.arc.state(t)
        arc = through(t, until - t, before[:5], (0.0, 0.0, 0.0), state[:5], (0.0, 0.0, 0.0), PRESSED)
        arc.start, arc.end = before, state
        arc.rolling_spin = tuple(zip(before[5:], state[5:], strict=True))
        self.path.append(arc)
        self.arc, self.state = still(until, until, state), state

    def finish(self, t: float) -> None:
        """Add the rest of the path, as the run ends at t. The outcome of an impact at t is included, though no arc
        follows."""
        self.keep(t)
        last, before = self.arc.until(t), self.path[-1]
        if last.t1 == last.t0 and any(
            abs(a - b) > _SAME for a, b in zip(last.start[2:], before.state(t)[2:], strict=True)
        ):
            self.path.append(last)

    def near(self, x: float, y: float) -> list[Near]:
        """The surfaces that the ball touches at (x, y), each at its nearest feature."""
        point = (x, y, x, y)
        found = [(obstacle, obstacle.near(x, y)) for obstacle in self.obstacles if obstacle.may_meet(point)]
        return [(obstacle, touching) for obstacle, touching in found if touching.gap <= TOUCHING_GAP]
