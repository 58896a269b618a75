"""A ball among surfaces that move: what it stays on carries it.

As seen from a surface that does not turn, a ball in contact moves as on one that stands still, under the applied forces
and the inertial force ``-m A`` of the surface's acceleration A. So it slides, rolls and rests there as exactly as
elsewhere, and its path is the sum of two polynomials. While a surface stands it is like any other. On one that turns a
ball that would stay on it goes along in hops of ``_HOP``.
"""

from __future__ import annotations

from collections.abc import Sequence

from sandbox.engine.contact.driven import Frame, MovingObstacle, PosedObstacle
from sandbox.engine.contact.manifold import relative
from sandbox.engine.contact.surfaces import press, takeoff_speed
from sandbox.engine.contact.touch import Near, Obstacle
from sandbox.engine.kernel.event_kind import EventKind
from sandbox.engine.model.setup_errors import failed
from sandbox.engine.model.tolerances import PUSH
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.motion.rest import AHEAD, first_change
from sandbox.engine.motion.sustained_contact import SustainedContact, rest_margin
from sandbox.engine.paths.arc import Arc, resting_arc
from sandbox.engine.paths.phase import Phase
from sandbox.physics.integrators import Acceleration, State

#: Height in m of the hops in which a ball goes along with what turns: higher is less true, lower takes longer.
_HOP = 1e-6

#: Points of an arc at rest on what moves at which it is tested that it stays so.
_TESTS = 16


class CarriedBall(MovingBall):
    """A ball that moving surfaces may carry."""

    _frame: Frame | None = None  # of the surface that it is on, if that moves
    _beside: Sequence[PosedObstacle] = ()  # the driven surfaces that it touches, which stand

    def advance(self, t: float, until: float) -> tuple[Arc, EventKind]:
        """The next arc from t, at most to ``until`` and while the motion of what carries it is smooth."""
        contact = self.contact
        if contact is None or not isinstance(contact.obstacle, MovingObstacle):
            return self._advance_while_all_stands(t, until)
        obstacle = contact.obstacle
        frame = self._frame = obstacle.frame(t)
        until = min(until, frame.arc.t1)
        outside, self.state = self.state, frame.into(t, self.state)
        try:
            arc, kind = self._advance_in(frame, contact, t, until)
        finally:
            self.state = outside
        if kind is EventKind.ARC_END and arc.t1 == frame.arc.t1 and obstacle.path.breaks_at(frame.arc):
            kind = EventKind.EDGE
        return frame.carried(arc), kind

    def _advance_while_all_stands(self, t: float, until: float) -> tuple[Arc, EventKind]:
        """The next arc of a ball that is not carried: in contact, until a surface that it touches begins to move."""
        stands = min((each.stands_until for each in self._beside), default=until) if self.contact is not None else until
        arc, kind = super().advance(t, min(until, stands))
        return arc, EventKind.EDGE if kind is EventKind.ARC_END and arc.t1 == stands < until else kind

    @property
    def held_by(self) -> Sequence[Obstacle]:
        if self.contact is None:
            return ()
        own = self.contact.obstacle
        standing = [each.source for each in self._beside if each is own or self.contact.phase is Phase.RESTING]
        return own, *standing

    def _advance_in(self, frame: Frame, contact: SustainedContact, t: float, until: float) -> tuple[Arc, EventKind]:
        """The next arc, and why it ends, as seen from what carries it."""

        def applied(t: float, state: State) -> Acceleration:
            return frame.relative_acceleration(t, self.applied(t, frame.out_of(t, state)))

        ball = self.ball
        if contact.phase is not Phase.RESTING:
            arc = self._under(lambda t, state: contact.forces(ball, applied(t, state), state)[0], t, until)
            return self._cut_where_contact_changes(arc, contact, applied)

        def holds(at: float) -> bool:
            return rest_margin(ball, self.state, contact, applied(at, self.state)) >= 0.0

        timing = ball.timing
        until = min(until, t + AHEAD) if timing.depends else until
        wakes = first_change(holds, t, until, min(timing.scale, (until - t) / _TESTS), timing.jumps)
        if wakes is not None:
            return resting_arc(t, wakes, self.state, contact), EventKind.WAKE
        return resting_arc(t, until, self.state, contact), EventKind.ARC_END

    def snap_to_contact(self, t: float, kind: EventKind) -> None:
        """Move the ball exactly onto its surface where an arc ends."""
        frame = self._frame
        if frame is None or self.contact is None or not self.contact.obstacle.moves:
            super().snap_to_contact(t, kind)
            return
        self.state = frame.into(t, self.state)
        super().snap_to_contact(t, kind)
        self.state = frame.out_of(t, self.state)

    def find_sustained_contact(self, t: float, height: float) -> None:
        """Find the contact that lasts after a touch, as seen from what the ball touches if that moves."""
        self.contact, self._frame = None, None
        slips, self._slips = self._slips, False
        near = self.near(t, *self.state[:2])
        driven = [(self._leaving(each, self.state), each[0]) for each in near if isinstance(each[0], PosedObstacle)]
        moving = [each for each in driven if each[1].moves]
        self._beside = [each for _, each in driven] if not moving else ()
        if not moving:
            if near:
                self._stay(near, self.applied(t, self.state), slips, height)
            return
        on = min(moving, key=lambda each: each[0])[1].source
        frame, applied = on.frame(t), self.applied(t, self.state)
        if frame.turns:
            self._hop(t, near, frame, applied, height)
            return
        self.state = frame.into(t, self.state)
        own = [obstacle.source for _, obstacle in moving if obstacle.surface.motion == on.surface.motion]
        seen = [(source, source.near(*self.state[:2])) for source in own]
        self._stay(seen, frame.relative_acceleration(t, applied), slips, height)
        self._frame = frame
        self.state = frame.out_of(t, self.state)
        if self.contact is not None:
            self._refuse_wedged(t, near, frame)

    def carried_by(self, t: float, state: State, height: float) -> str:
        """Return the name of a surface with a motion that it stays on in this state, as it would bounce no higher than
        ``height`` (m); "" if there is none."""
        for obstacle, touch in self.near(t, *state[:2]):
            by = press(state, self.applied(t, state), touch.nx, touch.ny, touch.curvature)
            if obstacle.surface.motion and self._leaving((obstacle, touch), state) <= takeoff_speed(by, height):
                return obstacle.surface.name
        return ""

    def _leaving(self, near: Near, state: State) -> float:
        """The speed in m/s at which it leaves a surface in this state."""
        obstacle, touch = near
        point = state[0] - self.ball.radius * touch.nx, state[1] - self.ball.radius * touch.ny
        _, _, vx, vy, *_ = relative(state, obstacle.velocity_at(point))
        return vx * touch.nx + vy * touch.ny

    def _hop(self, t: float, near: Sequence[Near], frame: Frame, applied: Acceleration, height: float) -> None:
        """Leave what turns by a hop where it would stay on it."""
        x, y, vx, vy, spin, _ = frame.arc.state(t)
        (ax, ay), turning = frame.arc.acceleration(t), frame.angular_acceleration(t)
        for obstacle, touch in near:
            if not obstacle.moves:
                continue
            u, v, ux, uy, *spins = self.state
            dx, dy = u - x, v - y
            seen = u, v, ux - vx + spin * dy, uy - vy - spin * dx
            inertial = (
                applied[0] - ax + turning * dy + spin**2 * dx + 2.0 * spin * seen[3],
                applied[1] - ay - turning * dx + spin**2 * dy - 2.0 * spin * seen[2],
                0.0,
            )
            by = press(seen, inertial, touch.nx, touch.ny, touch.curvature)
            short = takeoff_speed(by, max(height, _HOP)) - self._leaving((obstacle, touch), self.state)
            if by > PUSH and short >= 0.0:
                self.state = (u, v, ux + short * touch.nx, uy + short * touch.ny, *spins)

    def _refuse_wedged(self, t: float, near: Sequence[Near], frame: Frame) -> None:
        """Raise RunError if what carries it presses it on something else."""
        contact, ball = self.contact, self.ball
        assert contact is not None
        state = frame.into(t, self.state)
        applied = frame.relative_acceleration(t, self.applied(t, self.state))
        other = ""
        if contact.phase is Phase.PINNED or (
            contact.phase is Phase.RESTING and rest_margin(ball, state, contact, applied) < 0.0
        ):
            other = contact.obstacle.surface.name
        ax, ay = frame.unseen(t, contact.forces(ball, applied, state)[0])
        for obstacle, touch in near:
            by = -(ax * touch.nx + ay * touch.ny)
            if (
                not obstacle.moves
                and by > PUSH
                and self._leaving((obstacle, touch), self.state) <= takeoff_speed(by, 0.0)
            ):
                other = obstacle.surface.name
        if other:
            what = f"{contact.obstacle.surface.name!r}, which moves, presses it on {other!r}"
            raise failed(t, ball.name, f"{what}: a ball can be carried by one straight side or round shape only")
