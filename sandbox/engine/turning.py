"""A body that moves and turns in the plane of the picture. Its state has the angle as a sixth component.

The angle is the integral of the spin. Forces may depend on it: a step is made with the angle that the spin at its start
predicts, and made again with that of the spin it found, until both agree within the error aimed at.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.acting import checked
from sandbox.engine.arc import Arc
from sandbox.engine.bernstein import evaluate
from sandbox.engine.in_plane import InPlane
from sandbox.engine.meeting import standing
from sandbox.engine.run import Numerics
from sandbox.engine.setup import Ball, Setup, outline_of
from sandbox.engine.step_control import LOCAL_SHARE
from sandbox.engine.touch import Obstacle
from sandbox.engine.turning_touch import Mover, first_touch
from sandbox.physics.integrators import Acceleration, State

#: Repetitions of a step until its angle agrees with its spin, after which it is halved.
_PATIENCE = 5


class Turning(InPlane):
    """A body: its path, and when it touches what stands still."""

    def __init__(
        self,
        body: Ball,
        state: State,
        obstacles: Sequence[Obstacle],
        catches: Sequence[Obstacle],
        setup: Setup,
        accuracy: Accuracy,
        numerics: Numerics,
    ) -> None:
        super().__init__(body, state, obstacles, catches, setup, accuracy, numerics)
        self.outline = outline_of(body)
        self._skin = accuracy.skin
        self._angle_error = LOCAL_SHARE * accuracy.tolerance / body.radius  # rad

    def advance(self, t: float, until: float) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``; it ends only because of its length."""
        start, known = self.state, self._known[0]
        flat, angle = known if known == start[:5] else start[:5], start[5]
        curve: Sequence[float] = (angle, angle + (until - t) * start[4])
        t1 = until

        def law(at: float, state: State) -> Acceleration:
            return checked(self.ball, at, (*state, evaluate(curve, (at - t) / (t1 - t))))

        for count in range(1, 1000):
            self.state = flat
            arc = self._integrate(t, until, law)
            h = arc.t1 - t
            found = list(accumulate((h * spin / len(arc.spin) for spin in arc.spin), initial=angle))
            off = max(abs(evaluate(curve, share * h / (t1 - t)) - evaluate(found, share)) for share in (0.5, 1.0))
            curve, t1 = found, arc.t1
            if off <= self._angle_error:
                break
            until = t + 0.5 * h if count % _PATIENCE == 0 else arc.t1
        self.state, arc.start, arc.rolling_spin = start, start, (curve,)
        arc.end = (*(arc.end or arc.state(arc.t1))[:5], curve[-1])
        return arc, ""

    def settle(self, t: float, height: float) -> None:
        """It never stays on a surface by itself."""
        self.contact = None

    def first_touch(self, obstacle: Obstacle) -> float | None:
        """The time in s at which the body starts to touch on its current arc, or None.

        ``obstacle`` is prepared for a ball around the body: nothing touches the body before it touches that.
        """
        arc = self.arc
        start = arc.t0
        if obstacle in self.catches:
            return super().first_touch(obstacle)
        if obstacle.near(*arc.start[:2]).gap > 0.0:
            u = obstacle.first_touch(arc)
            if u is None:
                return None
            start += u * (arc.t1 - arc.t0)
        return first_touch(Mover(self.outline, arc), standing(obstacle.surface.shape), start, arc.t1, self._skin)
