"""A body that moves and turns in the plane of the picture. Its state has the angle as a sixth component.

The angle is the integral of the spin. Forces may depend on it: a step is made with the angle that the spin at its start
predicts, and made again with that of the spin it found, until both agree within the error aimed at.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import accumulate

from sandbox.engine.acting import checked
from sandbox.engine.arc import Arc, still
from sandbox.engine.bernstein import evaluate
from sandbox.engine.in_plane import InPlane, crossing
from sandbox.engine.lasting import RESTING, LastingContact
from sandbox.engine.meeting import standing, stays, surfaces_met
from sandbox.engine.one_point import OnePoint, one_point
from sandbox.engine.setup import outline_of
from sandbox.engine.step_control import LOCAL_SHARE
from sandbox.engine.touch import TOUCHING_GAP, Obstacle
from sandbox.engine.turning_touch import Mover, first_touch
from sandbox.physics.integrators import Acceleration, State

#: Repetitions of a step until its angle agrees with its spin, after which it is halved.
_PATIENCE = 5

#: Turn in rad, or way in m, from the next point of contact that is rounding: as when a body leaves what it lay on.
_FLUSH = 1e-13

#: Most repetitions.
_MOST = 1_000

#: Largest turn in rad in one arc of a body in contact, and the spin in rad/s at which it counts as turning.
_LONGEST_TURN, _SLOW = 0.35, 0.7


class Turning(InPlane):
    """A body: its path, and when it touches what stands still."""

    def advance(self, t: float, until: float) -> tuple[Arc, str]:
        """The next arc from t, at most to ``until``, and why it ends: "" if only because of its length."""
        error = LOCAL_SHARE * self._accuracy.tolerance / self.ball.radius  # rad
        contact, start, known, angle = self.contact, self.state, self._known[0], self.state[5]
        if contact is not None:
            if contact.mode == RESTING:
                return still(t, until, start, contact), ""
            until = min(until, t + _LONGEST_TURN / (abs(start[4]) + _SLOW))
        flat = known if known == start[:5] else start[:5]
        curve: Sequence[float] = (angle, angle + (until - t) * start[4])
        t1 = until

        def law(at: float, state: State) -> Acceleration:
            now = (*state, evaluate(curve, (at - t) / (t1 - t)))
            applied = checked(self.ball, at, now)
            return applied if contact is None else contact.forces(self.ball, applied, now)[0]

        for count in range(1, _MOST):
            self.state = flat
            arc = self._integrate(t, until, law)
            h = arc.t1 - t
            found = list(accumulate((h * spin / len(arc.spin) for spin in arc.spin), initial=angle))
            off = max(abs(evaluate(curve, share * h / (t1 - t)) - evaluate(found, share)) for share in (0.5, 1.0))
            curve, t1 = found, arc.t1
            if off <= error:
                break
            until = t + 0.5 * h if count % _PATIENCE == 0 else arc.t1
        self.state, arc.start, arc.rolling_spin = start, start, (curve,)
        arc.end = (*(arc.end or arc.state(arc.t1))[:5], curve[-1])
        if contact is None:
            return arc, ""
        return self._cut_where_contact_changes(arc, contact)

    def settle(self, t: float, height: float) -> None:
        """Find the contact that lasts after a touch: at one point of a straight side, left no faster than for a bounce
        of ``height`` (m). What is touched at more points, or elsewhere, is left to the heap."""
        self.contact = None
        slips, self._slips = self._slips, False
        applied = self._applied(t, self.state)
        found = [
            (obstacle, met, point)
            for obstacle, met in surfaces_met(self.ball, self.obstacles, self.state, TOUCHING_GAP)
            for point, (approach, *_) in zip(met.points, met.speeds, strict=True)
            if stays(self.ball, self.state, obstacle, met, approach, applied, height)
        ]
        if len(found) == 1:
            self.contact = one_point(self.ball, self.state, *found[0], applied, slips)
        if self.contact is not None:
            self.state = self.contact.placed(self.ball, self.state)

    def _reaches_edge(self, arc: Arc, contact: LastingContact) -> float | None:
        """The time in s at which the point of contact changes, or None."""
        assert isinstance(contact, OnePoint)
        if contact.room(self.ball, arc.state(arc.t1)) >= 0.0:
            return None
        return crossing(arc, lambda t, state: contact.room(self.ball, state), _FLUSH)

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
        return first_touch(
            Mover(outline_of(self.ball), arc), standing(obstacle.surface.shape), start, arc.t1, self._accuracy.skin
        )
