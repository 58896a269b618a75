"""Motion on a plane seen from above: exact arcs in closed form, one per phase, where the law has one and no force acts;
otherwise steps under error control."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, isfinite

from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.kernel.event_kind import EventKind
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import failed
from sandbox.engine.motion.leaning import Leaning
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.arc import Arc, crossing
from sandbox.engine.paths.bernstein import downward_crossings
from sandbox.physics.integrators import Acceleration, AccelerationFunction, State
from sandbox.physics.plane import Applied, Plane, PlaneMode, PlanePhase, no_force, strip
from sandbox.physics.slope import pull_of

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
    """A body on a plane; it stays at a cushion only where a force or a slope presses it there."""

    contact: Leaning | None  # type: ignore[assignment]  # of another kind than in the plane of the picture

    _forces: Applied | None  # the accelerations by forces and torques, if there are any
    _on: Plane | None = None  # the law of the last arc
    _past_spin: tuple[int, Arc] | None = None  # the version of an arc, and the path beyond the end of its spin

    def _prepare(self) -> None:
        """Make the functions of its forces, which see it as any ball: without the spins of its rolling."""
        super()._prepare()
        acceleration_at = self._acceleration_at
        acts = len(self.ball.forces) + len(self.ball.torques) > 0
        self._forces = (lambda t, state: acceleration_at(t, state[:5])) if acts else None

    def _under(self, acceleration_at: AccelerationFunction, t: float, until: float) -> Arc:
        """A step under accelerations that the plane has a part in."""
        step = self._control.integrator.step_of(acceleration_at, rolls=len(self.state) > 5)
        return self._integrate(t, until, acceleration_at, step)

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
            self._on, self.known = law, ((), (0.0, 0.0, 0.0))
        phase = self._phase_from(law, t)
        if phase.mode is PlaneMode.RESTING:
            self._numerics.steps += 1
            return self._rest(t, until)
        if phase.acceleration_at is None:
            h = min(phase.duration, until - t)
            arc = self._in_closed_form(law, phase, t, h)
            out = _leaves(arc, low, high)
            if h < phase.moves_for < inf and t + h < until and (low, high) == (-inf, inf) and self._forces is None:
                self._predict_past_spin(phase, t, min(phase.moves_for, until - t))
            return arc if out is None else self._in_closed_form(law, phase, t, out * h), EventKind.ARC_END
        arc = self._under(phase.acceleration_at, t, min(until, t + _LONGEST * phase.slows_in))
        if phase.mode is PlaneMode.ROLLING:
            arc = self._rolling(arc)
        out = _leaves(arc, low, high)
        spin_end = next(downward_crossings([state[4] * spin for spin in arc.curves[4]]), None)
        u = min((u for u in (out, spin_end) if u is not None), default=inf)
        if u < inf:
            arc = arc.until(arc.t0 + u * (arc.t1 - arc.t0))
        if spin_end == u:
            arc.end = (*arc.state(arc.t1)[:4], 0.0, *arc.state(arc.t1)[5:])
        arc = self._while_it_lasts(phase, arc)
        return (arc, EventKind.ARC_END) if self.contact is None else self._cut_where_it_leaves(law, arc, self.contact)

    def applied(self, t: float, state: State) -> Acceleration:
        """Acceleration from the applied forces, without the plane's; m/s^2, rad/s^2. Counts evaluations."""
        return super().applied(t, state[:5])

    def _rests_under(self, t: float, applied: Acceleration) -> bool:
        law, _, _ = strip(self._setup.plane_of(self.ball.name), self.state)
        return self._phase_from(law, t).mode is PlaneMode.RESTING

    def _phase_from(self, law: Plane, t: float) -> PlanePhase:
        """The phase that starts at t under the plane's law, and under the forces on the ball if there are any."""
        contact = self.contact
        if contact is None:
            return self._free_phase(law, t, self.state)
        left = contact.applied(self._forces or no_force, law)
        phase = law.phase_under(left, t, self.state, self.ball.radius)
        acceleration_at = phase.acceleration_at

        def along_sides(t: float, state: State) -> Acceleration:
            assert acceleration_at is not None
            ax, ay, *spins = acceleration_at(t, state)
            return *contact.held_back(ax, ay), *spins

        ax, ay = contact.held_back(phase.ax, phase.ay)
        return phase._replace(ax=ax, ay=ay, acceleration_at=along_sides if acceleration_at is not None else None)

    def _free_phase(self, law: Plane, t: float, state: State) -> PlanePhase:
        """The phase that starts at t in a state under the plane and the forces, if no side held the ball back."""
        if self._forces is None:
            return law.phase(state, self.ball.radius)
        return law.phase_under(self._forces, t, state, self.ball.radius)

    def _cut_where_it_leaves(self, law: Plane, arc: Arc, contact: Leaning) -> tuple[Arc, EventKind]:
        """The part of an arc on which the ball leans on sides, and why it ends."""

        def pressed(t: float, state: State) -> float:
            free = self._free_phase(law, t, state)
            return min(-free.ax * nx - free.ay * ny for nx, ny in contact.normals)

        edge, ends = contact.edge(arc), [(arc.t1, EventKind.ARC_END)]
        if edge is not None:
            ends.append((edge, EventKind.EDGE))
        if pressed(arc.t1, arc.state(arc.t1)) < 0.0:
            ends.append((crossing(arc, pressed), EventKind.LIFT_OFF))
        t, kind = min(ends, key=lambda end: end[0])
        return arc.until(t), kind

    def _rolling(self, arc: Arc) -> Arc:
        """The same arc, without slip all along it."""
        r, (_, _, vx, vy, *_) = self.ball.radius, arc.curves
        rolling = tuple(-v / r for v in vy), tuple(v / r for v in vx)
        end = (*arc.state(arc.t1)[:5], *(spin[-1] for spin in rolling))
        return Arc(arc.t0, arc.t1, arc.start, (*arc.curves[:5], *rolling), arc.contact, end)

    def _while_it_lasts(self, phase: PlanePhase, arc: Arc) -> Arc:
        """The part of an arc in which its phase lasts: until a grip is lost."""
        if phase.margin is None or phase.margin(arc.t1, arc.state(arc.t1)) >= 0.0:
            return arc
        return arc.until(crossing(arc, phase.margin))

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
        return Arc(t, t + h, state, curves, self.contact, end)

    def _predict_past_spin(self, phase: PlanePhase, t: float, h: float) -> None:
        """Predict its path for h s: its spin ends before that, and does not change it."""
        x, y, vx, vy, *_ = self.state
        ux, uy = vx + h * phase.ax, vy + h * phase.ay
        places = (x, x + 0.5 * h * vx, x + 0.5 * h * (vx + ux)), (y, y + 0.5 * h * vy, y + 0.5 * h * (vy + uy))
        self._past_spin = self.version, Arc(t, t + h, self.state, (*places, (vx, ux), (vy, uy), (0.0,)))

    @property
    def held_by(self) -> Sequence[Obstacle]:
        return () if self.contact is None else self.contact.obstacles

    def end_spin(self, t: float) -> None:
        """Go on along the predicted path without spin."""
        until = self.predicted_path.t1
        self.arc, _ = self.advance(t, until)
        self.arc.t1 = until  # to the last bit

    def snap_to_contact(self, t: float, kind: EventKind) -> None:
        """Move it exactly along the sides that it leans on."""
        if self.contact is not None:
            self.state = self.contact.projected(self.state)

    def find_sustained_contact(self, t: float, height: float) -> None:
        """Find the sides that forces or a slope press it on, after a touch: else, what it slides on is the plane."""
        self.contact = None
        law = strip(self._setup.plane_of(self.ball.name), self.state)[0]
        pressed = self._forces is not None or pull_of(law, *self.state[:2]) != (0.0, 0.0)
        if pressed and (near := self.near(t, *self.state[:2])):
            phase = self._free_phase(law, t, self.state)
            slowest = slowest_hop(self._setup, self._accuracy.hop)
            self.contact = Leaning.on(near, self.state, (phase.ax, phase.ay), slowest)
            self.snap_to_contact(t, EventKind.TOUCH)


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
