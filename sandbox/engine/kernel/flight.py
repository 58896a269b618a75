"""Flight of a single ball among fixed surfaces: steps and impacts one after another, without a queue.

What happens to it is the same as in ``simulation.py``, computed by the same functions. Only what is plain happens here:
the end of a step, and an impact on one surface from which the ball flies on. Whatever else comes next, such as two
surfaces at once, a slide, a trap or an error, is left to the simulation: it goes on from the event before.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from enum import Enum, auto
from typing import NamedTuple, Protocol

from sandbox.engine.contact.surfaces import bounce_off, press, takeoff_speed, tilted
from sandbox.engine.contact.touch import Obstacle, touched
from sandbox.engine.kernel.event_kind import EventKind
from sandbox.engine.kernel.step_control import StepControl, StepLimits, allowed
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup, Until
from sandbox.engine.model.surface import Bounce
from sandbox.engine.model.tolerances import CLOSING, CREATED
from sandbox.engine.paths.arc import Arc, hermite_arc
from sandbox.engine.paths.run import Numerics
from sandbox.physics.impulse import Motion, after_impulse, surface_speeds
from sandbox.physics.integrators import Acceleration, AccelerationFunction, Method, State

#: The impulses over the mass, in m/s, away from what a ball hits and along it, from its speeds of approach and of slip
#: there, the moment of inertia over m r^2, restitution and friction: pymunk's, as ``DiscOnGround.exchange``.
Exchange = Callable[[float, float, float, float, float], tuple[float, float]]

#: The first time in s up to a given one at which a ball on an arc touches one of these, or None.
FirstTouch = Callable[[Arc, Sequence[Obstacle], float], float | None]

#: Notes an impact at a time (s) on a surface, of a ball in a state that approaches at a speed (m/s). Returns True if
#: the run is over with that.
NoteImpact = Callable[[float, str, State, float], bool]

#: Coefficients of each coordinate on an arc after a step.
QUINTIC = 6


class Next(Enum):
    """The next step for a ball that flies on, unless it waits for an event on its arc."""

    ARC = auto()
    """Plan its next arc."""

    CONTACT = auto()
    """After an impact, find out whether it stays on what it has hit, and plan its next arc."""


class _Flying(Protocol):
    """The ball that flies, as a ``MovingBall``."""

    ball: Ball
    state: State
    arc: Arc
    path: list[Arc]
    next_step: float
    known: tuple[State, Acceleration]  # the state at the end of the last step, and the acceleration there
    obstacles: Sequence[Obstacle]
    passed: Sequence[Obstacle]

    @property
    def open_traps(self) -> Sequence[Obstacle]: ...


class Flight(NamedTuple):
    """Constants of a flight, and the receivers of its events."""

    setup: Setup
    control: StepControl
    limits: StepLimits
    settle: float  # m, bounces lower than this end in sustained contact
    acceleration_at: AccelerationFunction
    step: Method
    numerics: Numerics
    exchange: Exchange
    first_touch: FirstTouch
    check: Callable[[float], None]  # is called at the time of each event
    note_impact: NoteImpact


def after_impact(
    motion: Motion,
    nx: float,
    ny: float,
    ball: Ball,
    speeds: tuple[float, float],
    bounce: Bounce,
    exchange: Exchange,
    sine: float = 0.0,
) -> Motion:
    """Velocity (m/s) and spin (rad/s) of a ball after its impact on a surface, with which it closes and along which it
    slips at these ``speeds`` (m/s). ``sine`` is that of the angle above its centre at which it is touched."""
    (approach, slip), mass, factor = speeds, ball.mass, ball.inertia_factor
    mobility, turning, size = 1.0 / mass, 1.0 / (mass * factor), abs(slip)
    reversed_too = (1.0 + bounce.tangential) * size  # ending that much slip is reversing a share of what there is
    push, rub = exchange(approach, reversed_too, mobility / turning, bounce.restitution, bounce.friction)
    along = rub / (size * mobility) * slip if size > 0.0 else 0.0
    impulse = push / mobility / mass, along / mass, 0.0
    return after_impulse(motion, nx, ny, ball.radius, factor, impulse, sine)


def fly(
    flight: Flight, mover: _Flying, t: float, touches: bool, until: float, most: int
) -> tuple[int, EventKind | Next, float]:
    """Follow a ball from an event at t (s) on its arc, a touch or the arc's end, through events up to ``until`` (s).

    Returns how many events are resolved, ``most`` of them at most, what is next, and at what time. What is next on an
    arc has not happened yet: the ball is at the arc's start.
    """
    setup, control, limits, _, acceleration_at, step, numerics, _, first_touch, check, _ = flight
    radius, duration, evaluations, depends = mover.ball.radius, setup.duration, control.evaluations, limits.depends
    west, south, east, north = setup.bounds
    passed = setup.until.passed if isinstance(setup.until, Until) else None
    obstacles, traps, path, events = mover.obstacles, mover.open_traps, mover.path, 0
    while True:
        # the event at t
        arc = mover.arc
        state = arc.end if arc.end is not None and not touches else arc.state(t)
        if passed is not None and passed(arc.start, state):
            return events, EventKind.TOUCH if touches else EventKind.ARC_END, t
        if touches:
            after = _after_touch(flight, mover, t, state)
            if after is None:
                return events, EventKind.TOUCH, t
            events += 1
            if after is Next.CONTACT:
                return events, Next.CONTACT, t
            traps = mover.open_traps
        else:
            events += 1
            path.append(arc)
            mover.state = state
            if mover.known[0] is not state:
                mover.known = state, acceleration_at(t, state)
                numerics.force_evaluations += 1
        # the next arc
        state, acceleration = mover.known
        if t >= duration or (depends and not any(state[2:])):
            return events, Next.ARC, t
        wanted = mover.next_step
        h = allowed(limits, t, min(wanted, duration - t), state, acceleration)
        fits, tries, h, following, end, last = control.advance(step, t, state, acceleration, h, wanted, radius)
        x, y, vx, vy, spin = end
        motion = vx + vy + spin
        if not (fits and west <= x <= east and south <= y <= north and motion - motion == 0.0):
            return events, Next.ARC, t  # which raises the error
        numerics.steps += tries
        numerics.refined_steps += tries - 1
        numerics.force_evaluations += tries * evaluations
        mover.next_step, mover.known = following, (end, last)
        mover.arc = arc = hermite_arc(t, h, state, acceleration, end, last)
        # the first event on it
        touch = first_touch(arc, obstacles, arc.t1)
        touches = touch is not None
        t = arc.t1 if touch is None else touch
        if traps and (caught := first_touch(arc, traps, t)) is not None:
            return events, EventKind.TRAP, caught
        if t > until or events >= most or (t >= duration and not touches):
            return events, EventKind.TOUCH if touches else EventKind.ARC_END, t
        check(t)


def _after_touch(flight: Flight, mover: _Flying, t: float, state: State) -> Next | None:
    """Move a ball that touches something in this state at t (s) past its impact: what is next, or None if it has none
    that is plain."""
    found = touched(mover.obstacles, state[0], state[1])
    if len(found) != 1:
        return None
    ((obstacle, (_, nx, ny, curvature, *_)),) = found
    ball, arc, surface, (x, y, vx, vy, _) = mover.ball, mover.arc, obstacle.surface, state
    approach, along = -(vx * nx + vy * ny), vx * ny - vy * nx
    if approach <= CLOSING:
        return None
    bounce = bounce_off(surface, approach, along)
    normal = (nx, ny) if bounce.tilt == 0.0 else tilted(nx, ny, bounce.tilt, along)
    speeds = surface_speeds(state[2:], *normal, ball.radius)[:2]
    vx, vy, spin = after_impact(state[2:], *normal, ball, speeds, bounce, flight.exchange)
    if _energy(ball, vx, vy, spin) > (1.0 + CREATED) * _energy(ball, *state[2:]):
        return None  # which raises the error
    after = x, y, vx, vy, spin
    flight.numerics.impacts += 1
    flight.numerics.pymunk_steps += 1
    over = flight.note_impact(t, surface.name, state, approach)
    cut = arc.until(t)
    if cut.t1 > cut.t0 or not mover.path:
        mover.path.append(cut)
    if t < arc.t1:
        mover.next_step = min(mover.next_step, arc.t1 - arc.t0)
    mover.state, mover.passed = after, ()
    if over:
        return Next.CONTACT
    acceleration = flight.acceleration_at(t, after)
    pressed = press(after, acceleration, nx, ny, curvature)
    if not vx * nx + vy * ny > takeoff_speed(pressed, max(flight.settle, surface.lowest_bounce)):
        return Next.CONTACT
    flight.numerics.force_evaluations += 1
    mover.known = after, acceleration
    return Next.ARC


def _energy(ball: Ball, vx: float, vy: float, spin: float) -> float:
    """Kinetic energy over half the mass, in (m/s)^2."""
    rim = ball.radius * spin
    return vx * vx + vy * vy + ball.inertia_factor * rim * rim
