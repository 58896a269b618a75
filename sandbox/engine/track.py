"""One ball during a run: its state, current arc and path."""

from __future__ import annotations

from collections.abc import Sequence

from sandbox.engine.arc import Arc, still, through
from sandbox.engine.lasting import LastingContact
from sandbox.engine.setup import Ball
from sandbox.engine.touch import TOUCHING_GAP, Near, Obstacle, touched
from sandbox.physics.integrators import State

#: Value of ``Arc.contact`` for a ball in a simulated contact with others.
PRESSED = "pressed"

#: Difference in m/s and rad/s below which it is rounding.
_SAME = 1e-9


class Track:
    """A ball's state, the arc it is on, and the path behind it; a subclass has how it moves."""

    def __init__(self, ball: Ball, state: State, obstacles: Sequence[Obstacle], catches: Sequence[Obstacle]) -> None:
        self.ball = ball
        self.obstacles = obstacles
        self.catches = catches
        self.state = state
        self.contact: LastingContact | None = None
        self.arc = still(0.0, 0.0, state)  # the current arc
        self.path: list[Arc] = []
        self.version = 0  # of the arc: predictions for an earlier one are invalid
        self.at_rest = False  # as noted in the events
        self.caught = False

    # ------------------------------------------------------------------ how the ball moves

    def advance(self, t: float, until: float) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``, and why it ends: "" if only because of its length."""
        raise NotImplementedError

    def conclude(self, reason: str) -> None:
        """Make the state at the end of an arc that ended for ``reason`` exact."""

    def settle(self, t: float, height: float) -> None:
        """Find the contact that lasts after a touch: of a ball that would not bounce higher than ``height`` (m)."""

    # ------------------------------------------------------------------ its path

    def first_touch(self, obstacle: Obstacle) -> float | None:
        """The time in s at which it starts to touch on its current arc, or None."""
        u = obstacle.first_touch(self.arc)
        return None if u is None else self.arc.t0 + u * (self.arc.t1 - self.arc.t0)

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
        arc.curves += tuple(zip(before[5:], state[5:], strict=True))
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

    def near(self, x: float, y: float, gap: float = TOUCHING_GAP) -> list[Near]:
        """The surfaces that the ball touches at (x, y), up to a ``gap`` in m, each at its nearest feature."""
        return touched(self.obstacles, x, y, gap)
