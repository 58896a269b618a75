"""One ball during a run: its state, its path, and how it moves in the plane of the picture.

It flies under its forces, and slides, rolls and rests on surfaces. Both are the same integration: in sustained contact
the surface adds a force, so a roll is as accurate as a flight.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import hypot
from typing import Any, Self

from sandbox.engine.contact.driven import MovingObstacle
from sandbox.engine.contact.surfaces import press, takeoff_speed
from sandbox.engine.contact.touch import Near, Obstacle, flush, touched
from sandbox.engine.kernel.event_kind import EventKind
from sandbox.engine.kernel.flight import QUINTIC, Exchange, FirstTouch, Flight, NoteImpact
from sandbox.engine.kernel.step_control import StepControl, StepLimits, allowed
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.tolerances import AT_DISCONTINUITY, CLOSING, PUSH, STARTING, STILL, TOUCHING_GAP
from sandbox.engine.motion.forces_on_ball import acceleration_function, force_error
from sandbox.engine.motion.rest import rest_end
from sandbox.engine.motion.sustained_contact import BECOMES, SustainedContact, motion_on, wedged
from sandbox.engine.paths.arc import Arc, crossing, hermite_arc, resting_arc
from sandbox.engine.paths.phase import Phase
from sandbox.engine.paths.run import Numerics
from sandbox.physics.integrators import Acceleration, AccelerationFunction, Method, State

_TOO_FAST = (
    "the velocity changes too fast for any step (down to {:.1e} s); look for a force that is not smooth, or raise "
    "accuracy.tolerance"
)


class MovingBall:
    """A ball's state, the arc it is on, and the path behind it; a subclass is for bodies, another for planes."""

    def __init__(
        self,
        ball: Ball,
        state: State,
        obstacles: Sequence[Obstacle],
        traps: Sequence[Obstacle],
        setup: Setup,
        accuracy: Accuracy,
        numerics: Numerics,
    ) -> None:
        self.ball = ball
        self.obstacles = obstacles
        self.traps = traps
        self.passed: Sequence[Obstacle] = ()  # traps that it was too fast for, since it last hit something
        self._moves = any(obstacle.moves for obstacle in obstacles)
        self.state = state
        self.contact: SustainedContact | None = None
        self.arc = resting_arc(0.0, 0.0, state)  # the current arc
        self.path: list[Arc] = []
        self.version = 0  # of the arc: predictions for an earlier one are invalid
        self.caught = False
        self._setup = setup
        self._accuracy = accuracy
        self._numerics = numerics
        self._control = StepControl(accuracy)
        self._prepare()
        self.known: tuple[State, Acceleration] = ((), (0.0, 0.0, 0.0))  # the end of the last step: the next start
        self._slips = False  # it has just lost its grip
        self.next_step = self._control.first  # s, to try

    def _prepare(self) -> None:
        """Make the functions of its forces."""
        self._acceleration_at = acceleration_function(self.ball)
        self._step = self._control.integrator.step_of(self._acceleration_at, self.ball.rotates)

    # ------------------------------------------------------------------ copies and changes

    def copy(self, path: list[Arc], numerics: Numerics) -> Self:
        """Return one that goes on as this one would, with this path behind it; its cost counts there."""
        other = object.__new__(type(self))
        other.__dict__.update(self.__dict__)
        other.path, other._numerics = path, numerics
        return other

    def change(self, ball: Ball, setup: Setup) -> None:
        """Be this ball from now on, in this setup."""
        self.ball, self._setup = ball, setup
        self.known = (), (0.0, 0.0, 0.0)
        self._prepare()

    def place(self, t: float, state: State) -> None:
        """Be in this state from t on, without an arc yet: what was predicted for it no longer holds."""
        self.state, self.arc = state, resting_arc(t, t, state)
        self.version += 1

    def __getstate__(self) -> dict[str, Any]:
        """Return what is written to a file: all but functions, which are made again."""
        made = ("_acceleration_at", "_control", "_forces", "_step")
        return {name: value for name, value in self.__dict__.items() if name not in made}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        self._control = StepControl(self._accuracy)
        self._prepare()

    # ------------------------------------------------------------------ its path

    @property
    def open_traps(self) -> Sequence[Obstacle]:
        """The traps that may catch it."""
        return [trap for trap in self.traps if trap not in self.passed] if self.passed else self.traps

    def first_touch(self, obstacle: Obstacle, arc: Arc) -> float | None:
        """The time in s at which it starts to touch on this arc, or None."""
        if isinstance(obstacle, MovingObstacle):
            return obstacle.first_touch_of(self.ball, arc)
        u = obstacle.first_touch(arc)
        return None if u is None else arc.t0 + u * (arc.t1 - arc.t0)

    @property
    def flies(self) -> bool:
        """True if it is on an arc in flight."""
        return self.contact is None and self.arc.contact is None and len(self.arc.x) == QUINTIC

    def flight(
        self, exchange: Exchange, first_touch: FirstTouch, check: Callable[[float], None], note_impact: NoteImpact
    ) -> Flight:
        """The data from which its flight is followed."""
        setup, limits, settle = self._setup, StepLimits.of(self._setup, self.ball), self._accuracy.settle
        own = setup, self._control, limits, settle, self._acceleration_at, self._step, self._numerics
        return Flight(*own, exchange, first_touch, check, note_impact)

    @property
    def predicted_path(self) -> Arc:
        """The path ahead: its arc, together with those after it that begin only because its spin ends."""
        return self.arc

    def end_spin(self, t: float) -> None:
        """Begin the second arc of its predicted path, where its spin has ended at t."""

    @property
    def on(self) -> str:
        """The name of the surface that it is in sustained contact with, if any."""
        return "" if self.contact is None else self.contact.obstacle.surface.name

    @property
    def held_by(self) -> Sequence[Obstacle]:
        """The obstacles that it is in sustained contact with, and so does not meet."""
        return () if self.contact is None else (self.contact.obstacle,)

    def arrive(self, t: float, state: State) -> None:
        """Move it along its arc up to t, where it is in this state.

        After an event within the arc the next step is no longer than the one that it cut: an impact changes how long a
        step may be, and a quarter of the steps were rejected.
        """
        if t < self.arc.t1:
            self.next_step = min(self.next_step, self.arc.t1 - self.arc.t0)
        self._keep(t)
        self.state = state

    def _keep(self, t: float) -> None:
        """Add the arc up to t to the path."""
        if t < self.arc.t0:
            return  # within a contact that is already in the path
        arc = self.arc.until(t)
        if arc.t1 > arc.t0 or not self.path:
            self.path.append(arc)

    def append_contact(self, t: float, arcs: Sequence[Arc]) -> None:
        """Add the arc up to t, and those through a contact with others that begins then."""
        self._keep(t)
        self.path += arcs
        until, self.state = arcs[-1].t1, arcs[-1].state(arcs[-1].t1)
        self.arc = resting_arc(until, until, self.state)
        self.version += 1

    def finish(self, t: float) -> None:
        """Add the rest of the path, as the run ends at t. The outcome of an impact at t is included, though no arc
        follows."""
        if t < self.arc.t0:  # within a contact
            self.path = [arc.until(t) for arc in self.path if arc.t0 < t]
            return
        self._keep(t)
        last, before = self.arc.until(t), self.path[-1]
        if last.t1 == last.t0 and any(
            abs(a - b) > CLOSING for a, b in zip(last.start[2:], before.state(t)[2:], strict=True)
        ):
            self.path.append(last)

    def obstacles_at(self, t: float) -> Sequence[Obstacle]:
        """The surfaces where they are at time t in s."""
        return [obstacle.at(t) for obstacle in self.obstacles] if self._moves else self.obstacles

    def near(self, t: float, x: float, y: float, gap: float = TOUCHING_GAP) -> list[Near]:
        """The surfaces that the ball touches at (x, y) at time t, up to a ``gap`` in m, each at its nearest feature."""
        within = [each.at(t) for each in self.obstacles if each.reaches(x, y, gap)] if self._moves else self.obstacles
        return touched(within, x, y, gap)

    # ------------------------------------------------------------------ one piece of path

    def advance(self, t: float, until: float) -> tuple[Arc, EventKind]:
        """The next arc from t, at most to ``until``, and why it ends.

        Raises RunError with the time, the ball and the quantity if the state is not finite or out of bounds.
        """
        contact, ball = self.contact, self.ball
        if contact is None:
            if ball.timing.depends and not any(self.state[2:5]) and not any(self.applied(t, self.state)):
                arc, kind = self._rest(t, until)
                if arc.t1 - t > AT_DISCONTINUITY * max(1.0, t):
                    return arc, kind
            return self._integrate(t, until, self._acceleration_at, self._step), EventKind.ARC_END
        if contact.phase is Phase.RESTING:
            return self._rest(t, until)
        arc = self._under(lambda at, state: contact.forces(ball, self._acceleration_at(at, state), state)[0], t, until)
        arc, kind = self._cut_where_contact_changes(arc, contact, self.applied)
        held_anew = contact.phase is Phase.PINNED and ball.timing.depends and arc.t1 < until
        return arc, EventKind.EDGE if held_anew and kind is EventKind.ARC_END else kind

    def _rest(self, t: float, until: float) -> tuple[Arc, EventKind]:
        """A rest from t, as far as it is known to last."""
        state = self.state
        end, wakes = rest_end(self.ball.timing, lambda at: self.applied(at, state), self._rests_under, t, until)
        return resting_arc(t, end, state, self.contact), EventKind.WAKE if wakes else EventKind.ARC_END

    def _rests_under(self, t: float, applied: Acceleration) -> bool:
        """Return True if it would come to rest where it is, under this acceleration at t."""
        if self.contact is None:
            return not any(applied)
        before = self.state, self.contact, self.known
        self.contact = None
        self._stay(self.near(t, *self.state[:2]), applied, False, self._accuracy.settle, leaves=PUSH)
        phase = Phase.FREE if self.contact is None else self.contact.phase
        self.state, self.contact, self.known = before
        return phase is Phase.RESTING

    def _under(self, acceleration_at: AccelerationFunction, t: float, until: float) -> Arc:
        """A step under accelerations that are not those of the ball in flight."""
        return self._integrate(
            t, until, acceleration_at, self._control.integrator.step_of(acceleration_at, self.ball.rotates)
        )

    def _integrate(self, t: float, until: float, acceleration_at: AccelerationFunction, step: Method) -> Arc:
        state, contact = self.state, self.contact
        known, acceleration = self.known
        if known is not state:
            acceleration = acceleration_at(t, state)
            self._numerics.force_evaluations += 1
        wanted = self.next_step
        h = allowed(StepLimits.of(self._setup, self.ball), t, min(wanted, until - t), state, acceleration)
        if contact is not None:
            h = min(h, contact.longest(state))
        ball, control, numerics = self.ball, self._control, self._numerics
        fits, tries, h, following, end, last = control.advance(step, t, state, acceleration, h, wanted, ball.radius)
        numerics.steps += tries
        numerics.refined_steps += tries - 1
        numerics.force_evaluations += tries * control.evaluations
        if not fits:
            self._check(t + h, end)
            raise force_error(ball, t + h, end, _TOO_FAST.format(h))
        self.next_step = following
        self._check(t + h, end)
        self.known = (end, last)
        return hermite_arc(t, h, state, acceleration, end, last, contact)

    def _check(self, t: float, after: State) -> None:
        """Raise RunError, which names a force that is not finite, if a state is outside the world or not finite."""
        if not self._setup.bounds.hold(after):
            raise force_error(self.ball, t, self.state, self._setup.bounds.describe_violation(after))

    # ------------------------------------------------------------------ sustained contact

    def _cut_where_contact_changes(
        self, arc: Arc, contact: SustainedContact, applied: AccelerationFunction
    ) -> tuple[Arc, EventKind]:
        def progress(t: float, state: State) -> float:
            return contact.progress(self.ball, state)

        def held(t: float, state: State) -> tuple[Acceleration, float, float]:
            return contact.forces(self.ball, applied(t, state), state)

        ends: list[tuple[float, EventKind]] = []
        edge, last = contact.edge(self.ball, arc), arc.state(arc.t1)
        if edge is not None:
            ends.append((edge, EventKind.EDGE))
        if progress(arc.t1, last) < 0.0:
            ends.append((crossing(arc, progress, STARTING), EventKind.MOTION_END))
        _, normal, grip_margin = held(arc.t1, last)
        if normal < 0.0:
            ends.append((crossing(arc, lambda t, state: held(t, state)[1]), EventKind.LIFT_OFF))
        if grip_margin < 0.0:
            ends.append((crossing(arc, lambda t, state: held(t, state)[2]), EventKind.GRIP_LOSS))
        t, kind = min(ends, key=lambda end: end[0], default=(arc.t1, EventKind.ARC_END))
        return arc.until(t), kind

    def snap_to_contact(self, t: float, kind: EventKind) -> None:
        """Move the ball exactly onto its surface, which the arc follows only closely; make it exactly rolling, or
        exactly at rest, if that is why the arc ended."""
        if self.contact is not None:
            phase = BECOMES[self.contact.phase] if kind is EventKind.MOTION_END else self.contact.phase
            self.state = self.contact._replace(phase=phase).projected_onto_surface(self.ball, self.state)
        self._slips = kind is EventKind.GRIP_LOSS

    def find_sustained_contact(self, t: float, height: float) -> None:
        """Find the sustained contact after a touch; None in flight.

        A ball stays on a surface if it is pressed on it and would not bounce higher than ``height`` (m). A lower
        bounce is removed from the state, as is the overlap, of at most TOUCHING_GAP, at which the surface was found.
        """
        self.contact = None
        slips, self._slips = self._slips, False
        near = self.near(t, *self.state[:2])
        if near:
            self._stay(near, self.applied(t, self.state), slips, height)

    def _stay(
        self, near: Sequence[Near], applied: Acceleration, slips: bool, height: float, leaves: float = -PUSH
    ) -> None:
        """Find the contact that lasts among the surfaces that are touched; a second one holds the ball up to an
        acceleration away from it, in m/s^2, at which it ``leaves``."""
        x, y, vx, vy, spin = self.state
        kept: list[Near] = []
        hardest = 0.0
        for obstacle, touch in near:
            by = press(self.state, applied, touch.nx, touch.ny, touch.curvature)
            if vx * touch.nx + vy * touch.ny <= takeoff_speed(by, max(height, obstacle.surface.lowest_bounce)):
                kept.append((obstacle, touch))
                hardest = max(hardest, by)
        if not kept:
            self.known = self.state, applied
            return
        first = min(kept, key=lambda near: vx * near[1].nx + vy * near[1].ny)[1]
        together = [(obstacle, touch) for obstacle, touch in kept if flush(touch, first)]
        if len(together) < len(kept) and hypot(vx, vy) <= takeoff_speed(hardest, height):
            vx = vy = 0.0  # held in two directions
        else:  # along the surface that the ball leaves most slowly; it may leave the others, but not enter them
            kept = together
            for _, touch in kept:
                leaving = vx * touch.nx + vy * touch.ny
                vx, vy = vx - leaving * touch.nx, vy - leaving * touch.ny
            if any(vx * other.nx + vy * other.ny < -STILL and not flush(other, first) for _, other in near):
                return
        self.state = (x, y, vx, vy, spin)
        self._hold(kept, near, applied, slips, height, leaves)

    def _hold(
        self,
        kept: Sequence[Near],
        near: Sequence[Near],
        applied: Acceleration,
        slips: bool,
        height: float,
        leaves: float,
    ) -> None:
        """Choose the contact among the surfaces that the ball stays on; a ball that ``slips`` has lost its grip.

        Friction on one may press the ball on another that is ``near``: then it is wedged between the two.
        """
        ball, state = self.ball, self.state
        x, y, vx, vy, spin = state
        mx, my = (vx, vy) if vx or vy else applied[:2]  # direction in which it will move
        held: list[SustainedContact] = []
        for obstacle, touching in kept:
            ahead = obstacle.next_feature(touching, x, y, mx, my)
            phase, direction = motion_on(ball, state, obstacle.surface, ahead, applied, slips)
            if phase is not Phase.FREE:
                held.append(SustainedContact(phase, obstacle, ahead, direction))
        # the next piece's side before this one's corner; of two that share the corner the one that it is above
        held.sort(key=lambda by: (by.touching.curvature, by.obstacle.tilt_from_side(by.touching.nx, by.touching.ny)))
        two = None
        for contact in held:
            (ax, ay, _), _, _ = contact.forces(ball, applied, state)
            against = [
                (obstacle, other)
                for obstacle, other in near
                if not flush(other, contact.touching)
                and (by := -(ax * other.nx + ay * other.ny)) > -leaves
                and vx * other.nx + vy * other.ny <= takeoff_speed(by, max(height, obstacle.surface.lowest_bounce))
            ]
            if not against:
                self.state, self.contact = contact.projected_onto_surface(ball, state), contact
                return
            two = two or against[0]
        if two:
            one = held[0].obstacle, held[0].touching
            self.contact = wedged(ball, spin, one, two, applied)
            for obstacle, touching in (one, two):
                gap = obstacle.on_feature(touching.feature, x, y).gap
                x, y = x - gap * touching.nx, y - gap * touching.ny
            self.state = (x, y, 0.0, 0.0, 0.0 if self.contact.phase is Phase.RESTING else spin)

    def applied(self, t: float, state: State) -> Acceleration:
        """Acceleration from the applied forces, without the contact's; m/s^2, rad/s^2. Counts evaluations."""
        self._numerics.force_evaluations += 1
        return self._acceleration_at(t, state)
