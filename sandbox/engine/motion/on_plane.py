"""Motion on a plane seen from above: exact arcs in closed form, one per phase, where the law has one; otherwise steps
under error control."""

from __future__ import annotations

from math import hypot, inf, isfinite

from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import failed
from sandbox.engine.motion.event_kind import EventKind
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.arc import Arc, resting_arc
from sandbox.engine.paths.bernstein import downward_crossings
from sandbox.physics.plane import Plane, PlaneMode, PlanePhase, strip

#: Longest step as a fraction of the time in which a body would stop: none steps over its rest.
_LONGEST = 0.5


def slowest_hop(setup: Setup, hop: float) -> float:
    """Minimum speed in m/s at which bodies that a plane presses together separate, for an accuracy's ``hop`` (m).

    A steady push then becomes a series of equal hops instead of an endless series of smaller and smaller ones. The
    energy of the first hop of such a series, half the reduced mass times this speed squared (2e-7 J for pool balls at
    "balanced"), is removed from the motion of all balls.
    """
    return float((2.0 * max(setup.plane_of(ball.name).strongest for ball in setup.balls) * hop) ** 0.5)


class OnPlane(MovingBall):
    """A body on a plane, where there is no sustained contact with a cushion."""

    _ends_spin = False  # with its current arc
    _on: Plane | None = None  # the law of the last arc
    _past_spin: tuple[int, Arc] | None = None  # the version of an arc, and the path beyond the end of its spin

    @property
    def predicted_path(self) -> Arc:
        if self._past_spin is None or self._past_spin[0] != self.version:
            return self.arc
        return self._past_spin[1]

    def advance(self, t: float, until: float) -> tuple[Arc, EventKind]:
        """The next arc from t, at most to ``until``: a whole phase in closed form, or a step; within one strip."""
        state = self.state
        plane = self._setup.plane_of(self.ball.name)
        law, low, high = strip(plane, state)
        if law is not self._on:
            self._on, self._known = law, ((), (0.0, 0.0, 0.0))
        phase = law.phase(state, self.ball.radius)
        if phase.mode is PlaneMode.RESTING:
            self._numerics.steps += 1
            return resting_arc(t, until, state), EventKind.ARC_END
        if phase.acceleration_at is None:
            h = min(phase.duration, until - t)
            arc = self._in_closed_form(law, phase, t, h)
            out = _leaves(arc, low, high)
            if h < phase.moves_for < inf and t + h < until and (low, high) == (-inf, inf):
                self._predict_past_spin(phase, t, min(phase.moves_for, until - t))
            return arc if out is None else self._in_closed_form(law, phase, t, out * h), EventKind.ARC_END
        stops_in = hypot(*state[2:4]) / (hypot(phase.ax, phase.ay) or 1.0)
        arc = self._under(phase.acceleration_at, t, min(until, t + _LONGEST * stops_in))
        out = _leaves(arc, low, high)
        spin_end = next(downward_crossings([state[4] * spin for spin in arc.curves[4]]), None)
        u = min((u for u in (out, spin_end) if u is not None), default=inf)
        self._ends_spin = spin_end == u
        return arc if u == inf else arc.until(arc.t0 + u * (arc.t1 - arc.t0)), EventKind.ARC_END

    def _in_closed_form(self, law: Plane, phase: PlanePhase, t: float, h: float) -> Arc:
        """The first h s of a phase with constant accelerations."""
        state = self.state
        self._numerics.steps += 1
        end = phase.after(h)
        if not all(map(isfinite, end)):
            remedy = f"check its radius and speed, and the friction of the {law.name}"
            raise failed(t, self.ball.name, f"its motion on the {law.name} cannot be computed; {remedy}")
        x, y, vx, vy, spin, *rolling = state
        half = 0.5 * h
        accelerations = (phase.alpha_x, phase.alpha_y)
        curves = (
            (x, x + half * vx, end[0]),
            (y, y + half * vy, end[1]),
            (vx, vx + h * phase.ax),
            (vy, vy + h * phase.ay),
            (spin, spin + h * phase.alpha_z),
            *((w, w + h * alpha) for w, alpha in zip(rolling, accelerations, strict=False)),
        )
        return Arc(t, t + h, state, curves, end=end)

    def _predict_past_spin(self, phase: PlanePhase, t: float, h: float) -> None:
        """Predict its path for h s: its spin ends before that, and does not change it."""
        x, y, vx, vy, *_ = self.state
        ux, uy = vx + h * phase.ax, vy + h * phase.ay
        places = (x, x + 0.5 * h * vx, x + 0.5 * h * (vx + ux)), (y, y + 0.5 * h * vy, y + 0.5 * h * (vy + uy))
        self._past_spin = self.version, Arc(t, t + h, self.state, (*places, (vx, ux), (vy, uy), (0.0,)))

    def end_spin(self, t: float) -> None:
        """Go on along the predicted path without spin."""
        until = self.predicted_path.t1
        self.arc, _ = self.advance(t, until)
        self.arc.t1 = until  # to the last bit

    def snap_to_contact(self, t: float, kind: EventKind) -> None:
        """Make the spin exactly zero where it ends."""
        if self._ends_spin:
            self.state = (*self.state[:4], 0.0)

    def find_sustained_contact(self, t: float, height: float) -> None:
        """There is none: what it slides on is the plane."""


def _leaves(arc: Arc, low: float, high: float) -> float | None:
    """The first u at which the path leaves a strip from ``low`` to ``high`` (m) along x, or None."""
    left, _, right, _ = arc.box()
    if low <= left and right <= high:
        return None
    found = []
    if right > high:
        found.append(next(downward_crossings([high - x for x in arc.x]), None))
    if left < low:
        found.append(next(downward_crossings([x - low for x in arc.x]), None))
    return min((u for u in found if u is not None), default=None)
