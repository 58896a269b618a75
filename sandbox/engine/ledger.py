"""Energy balance of a run: the work of each force, the loss at each surface, and the numerical error.

Computed from the finished path on request, so that it costs a run nothing.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections import defaultdict
from dataclasses import dataclass
from itertools import pairwise

from sandbox.engine.contact.driven import MovingObstacle
from sandbox.engine.contact.touch import Outline
from sandbox.engine.model.ball import Ball, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.tolerances import CLOSING, TOUCHING_GAP
from sandbox.engine.motion.forces_on_ball import acceleration_function, by_cause
from sandbox.engine.motion.leaning import Leaning
from sandbox.engine.motion.sustained_contact import SustainedContact
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.phase import InCluster, InHeap, SetByHand
from sandbox.engine.paths.run import Run
from sandbox.physics.integrators import INTEGRATORS, Acceleration, State
from sandbox.physics.plane import Applied, Plane, strip
from sandbox.physics.slope import pull_of

#: Gauss-Legendre nodes and weights on [0, 1]: exact for polynomials of degree 9.
_NODES = (0.04691007703066802, 0.23076534494715845, 0.5, 0.7692346550528415, 0.953089922969332)
_WEIGHTS = (0.11846344252809454, 0.23931433524968324, 0.28444444444444444, 0.23931433524968324, 0.11846344252809454)


#: Fraction of the energy that an integrator without error control may gain or lose without a warning.
_LOST = 0.03


@dataclass(frozen=True)
class Ledger:
    """Energies in J: ``start`` and the sums of ``work``, ``impacts``, ``contacts`` and ``residue`` make up ``end``."""

    start: float  # kinetic, of all balls where they come in, including rotation
    end: float
    #: By force or torque; by "lost mass", what that takes away; "driven by" a surface that moves; "kicked by" one that
    #: kicks; and "set by hand", what changes of a ball's motion from outside add.
    work: dict[str, float]
    impacts: dict[str, float]  # by the partner; an impact of two balls under both names
    #: By the surface slid or rolled on, including bounces too low to simulate; by "heap" where balls press on one
    #: another, and "position correction", what moving them apart there adds.
    contacts: dict[str, float]
    residue: float  # kinetic energy gained along the path that no cause accounts for: the numerical error
    #: What impacts and contacts add at the times at which all balls together gain, beyond what surfaces do.
    jumped: float


def ledger(run: Run) -> Ledger:
    """The energy ledger of a run."""
    books = _Books(run)
    start = end = 0.0
    for ball in run.setup.balls:
        arcs = run.arcs[ball.name]
        start += kinetic(ball, arcs[0].start)
        end += kinetic(ball, arcs[-1].state(arcs[-1].t1), arcs[-1].t1)
        for arc in arcs:
            setup, ball = _at(run, arc.t0, ball)
            books.enter_arc(setup, ball, arc)
        for before, after in pairwise(arcs):
            books.enter_jump(ball, before, after)
    jumped = sum(jump for jump in books.jumps.values() if jump > 0.0)
    return Ledger(start, end, dict(books.work), dict(books.impacts), dict(books.contacts), books.residue, jumped)


class _Books:
    """The books of a run: the kinetic energy in J that each cause has added so far."""

    def __init__(self, run: Run) -> None:
        self._run, self._met = run, _Impacts(run)
        self.work: dict[str, float] = defaultdict(float)
        self.impacts: dict[str, float] = defaultdict(float)
        self.contacts: dict[str, float] = defaultdict(float)
        self.jumps: dict[float, float] = defaultdict(float)  # by time in s
        self.residue = 0.0

    def enter_arc(self, setup: Setup, ball: Ball, arc: Arc) -> None:
        """Book what a ball gains along an arc."""
        gain = kinetic(ball, arc.state(arc.t1), arc.t1) - kinetic(ball, arc.start, arc.t0)
        if isinstance(arc.contact, InCluster):
            self.impacts[self._met.partner(ball.name, *arc.contact.span) or ""] += gain
        elif setup.plane is not None:
            self.residue += gain - _book_on_plane(setup.plane_of(ball.name), ball, arc, self.work, self.contacts)
        elif isinstance(arc.contact, InHeap):
            lifted = -_work_of_forces(ball, arc, arc.contact)
            self.contacts["position correction"] += lifted
            self.contacts["heap"] += gain - lifted - _book(ball, arc, self.work, self.contacts)
        else:
            self.residue += gain - _book(ball, arc, self.work, self.contacts)

    def enter_jump(self, ball: Ball, before: Arc, after: Arc) -> None:
        """Book what a ball gains at once, between two arcs."""
        jump = kinetic(ball, after.start, after.t0) - kinetic(ball, before.state(before.t1), after.t0)
        hit = self._met.partner(ball.name, after.t0, after.t0)
        lasting = after.contact or before.contact
        if isinstance(after.contact, SetByHand):
            self.work["set by hand"] += jump
            return
        by = lasting.obstacle.surface.name if hit is None and isinstance(lasting, SustainedContact) else hit
        if by is None and jump != 0.0 and not lasting:
            by = _driven_off(self._run, ball, after)
        driven, kicked = _active_in_impact(self._run, ball, by, before.state(before.t1), after) if by else (0.0, 0.0)
        if driven:
            self.work[f"driven by {by}"] += driven
        if kicked:
            self.work[f"kicked by {by}"] += kicked
        jump -= driven + kicked
        self.jumps[after.t0] += jump
        if hit is not None:
            self.impacts[hit] += jump
        elif isinstance(lasting, InHeap):
            self.contacts["heap"] += jump
        elif by is not None:
            self.contacts[by] += jump
        else:
            self.residue += jump


def warnings(run: Run) -> list[str]:
    """Reasons to doubt a run, one sentence each; normally none."""
    accuracy = run.accuracy
    if accuracy.method == "plain" or INTEGRATORS[accuracy.integrator].controls_error:
        return []
    found = ledger(run)
    most = max(found.start, found.end, *map(abs, found.work.values()), 0.0)
    if abs(found.residue) <= _LOST * most:
        return []
    how = "appeared" if found.residue > 0.0 else "was lost"
    return [
        f"{abs(found.residue):.3g} J {how} by the error of {accuracy.integrator} with steps of {accuracy.step:.3g} s "
        f"(largest energy during the run: {most:.3g} J); lower accuracy.step, or use an integrator with error control"
    ]


def _at(run: Run, t: float, ball: Ball) -> tuple[Setup, Ball]:
    """The setup that is valid from t on, and a ball in it."""
    if not run.eras:
        return run.setup, ball
    setup = run.eras[bisect_right(run.eras, t, key=lambda era: era[0]) - 1][1]
    return setup, next(each for each in setup.balls if each.name == ball.name)


class _Impacts:
    """The impacts of a run, in order of time."""

    def __init__(self, run: Run) -> None:
        self._balls = {ball.name for ball in run.setup.balls}
        self._hits = [event for event in run.events if event.kind == "impact"]

    def partner(self, ball: str, start: float, end: float) -> str | None:
        """The name of what a ball met between two times, in its own impact or in one of balls that touch it."""
        first = bisect_left(self._hits, start, key=lambda hit: hit.t)
        during = self._hits[first : bisect_right(self._hits, end, key=lambda hit: hit.t)]
        own = next((hit for hit in during if ball in (hit.ball, hit.partner)), during[0] if during else None)
        if own is None:
            return None
        return " and ".join(sorted((own.ball, own.partner))) if own.partner in self._balls else own.partner


def _book_on_plane(plane: Plane, ball: Ball, arc: Arc, work: dict[str, float], contacts: dict[str, float]) -> float:
    """Add the work done along an arc on a plane to ``work`` and ``contacts``; returns its sum in J.

    What friction does is the power of the law in the state at each node, not the energy that the path has lost.
    """
    law, h, booked = strip(plane, arc.start)[0], arc.t1 - arc.t0, 0.0
    acceleration_at, pushed = acceleration_function(ball), len(ball.forces) + len(ball.torques) > 0

    def forces(t: float, state: State) -> Acceleration:
        return acceleration_at(t, state[:5])

    acting: Applied = forces
    if isinstance(arc.contact, Leaning):
        acting, pushed = arc.contact.applied(forces, law), True

    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        t = arc.t0 + node * h
        state = arc.state(t)
        _, _, vx, vy, spin = seen = state[:5]
        for name, (fx, fy) in by_cause(ball.forces, t, seen):
            work[name] += weight * h * (fx * vx + fy * vy)
        for name, torque in by_cause(ball.torques, t, seen):
            work[name] += weight * h * torque * spin
        px, py, turning = acting(t, state)
        phase = law.phase_under(acting, t, state, ball.radius) if pushed else law.phase(state, ball.radius)
        slope = pull_of(law, *state[:2])
        if slope != (0.0, 0.0):
            work["slope"] += weight * h * ball.mass * (slope[0] * vx + slope[1] * vy)
        spun = zip((phase.alpha_z - turning, phase.alpha_x, phase.alpha_y), state[4:], strict=False)
        lost = ball.mass * ((phase.ax - px - slope[0]) * vx + (phase.ay - py - slope[1]) * vy)
        lost += ball.inertia * sum(alpha * w for alpha, w in spun)
        contacts[plane.name] += weight * h * lost
        applied = ball.mass * ((px + slope[0]) * vx + (py + slope[1]) * vy) + ball.inertia * turning * spin
        booked += weight * h * (applied + lost)
    return booked


def _driven_off(run: Run, ball: Ball, after: Arc) -> str | None:
    """The name of a moving surface that a ball leaves by a hop: it touches it where an arc begins."""
    t, (x, y, *_) = after.t0, after.start
    for surface in _at(run, t, ball)[0].surfaces:
        if surface.motion is not None and Outline.of(surface.at(t).shape, ball.radius).near(x, y).gap < TOUCHING_GAP:
            return surface.name
    return None


def _active_in_impact(run: Run, ball: Ball, name: str, before: State, after: Arc) -> tuple[float, float]:
    """The work in J that a surface of this name does in an impact of a ball: by moving, its velocity at the point of
    contact times the change of momentum; and by its kick, which comes last, as seen from it. 0 if it does neither."""
    active = [each for each in _at(run, after.t0, ball)[0].surfaces if each.name == name]
    active = [each for each in active if each.motion is not None or each.kick > 0.0]
    if not active:
        return 0.0, 0.0
    t, (x, y, vx, vy, *_) = after.t0, after.start
    found = [(Outline.of(each.at(t).shape, ball.radius).near(x, y), each) for each in active]
    (_, nx, ny, *_), surface = min(found, key=lambda each: abs(each[0].gap))
    ux = uy = 0.0
    if surface.motion is not None:
        place, rates = surface.motion.place(t), surface.motion.rates(t)
        ux = rates.x - rates.angle * (y - ball.radius * ny - place.y)
        uy = rates.y + rates.angle * (x - ball.radius * nx - place.x)
    mass = ball.mass * ball.mass_fraction(t)
    driven = mass * ((vx - before[2]) * ux + (vy - before[3]) * uy)
    hit = (before[2] - ux) * nx + (before[3] - uy) * ny < -CLOSING
    leaving = (vx - ux) * nx + (vy - uy) * ny
    return driven, surface.kick * (leaving - 0.5 * surface.kick / mass) if hit else 0.0


def _work_of_forces(ball: Ball, arc: Arc, moved: InHeap) -> float:
    """The work in J of the forces on a ball while position correction moves it."""
    forces = [force for _, force in by_cause(ball.forces, arc.t0, arc.start)]
    return (arc.t1 - arc.t0) * sum(fx * moved.vx + fy * moved.vy for fx, fy in forces)


def _book(ball: Ball, arc: Arc, work: dict[str, float], contacts: dict[str, float]) -> float:
    """Add the work done along an arc to ``work`` and ``contacts``; returns its sum in J."""
    h, contact = arc.t1 - arc.t0, arc.contact
    booked = 0.0
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        t = arc.t0 + node * h
        state = arc.state(t)
        _, _, vx, vy, spin = state[:5]
        applied = 0.0
        powers = [(name, fx * vx + fy * vy) for name, (fx, fy) in by_cause(ball.forces, t, state)]
        powers += [(name, torque * spin) for name, torque in by_cause(ball.torques, t, state)]
        if ball.loss is not None:
            powers.append(("lost mass", -kinetic(ball, state) * ball.loss.rate(t) / ball.mass))
        for name, power in powers:
            work[name] += weight * h * power
            applied += power
        if isinstance(contact, SustainedContact):
            free = acceleration_function(ball)(t, state)
            if isinstance(contact.obstacle, MovingObstacle):
                frame = contact.obstacle.frame(t)
                seen = contact.forces(ball, frame.relative_acceleration(t, free), frame.into(t, state))[0]
                ax, ay, alpha = *frame.unseen(t, seen), seen[2]
                ux, uy, mass = *frame.arc.state(t)[2:4], ball.mass * ball.mass_fraction(t)
                pushed = mass * ((ax - free[0]) * ux + (ay - free[1]) * uy)
                work[f"driven by {contact.obstacle.surface.name}"] += weight * h * pushed
                applied += pushed
            else:
                (ax, ay, alpha), _, _ = contact.forces(ball, free, state)
            lost = powers[-1][1] if ball.loss is not None else 0.0
            total = ball.mass_fraction(t) * (ball.mass * (ax * vx + ay * vy) + ball.inertia * alpha * spin) + lost
            contacts[contact.obstacle.surface.name] += weight * h * (total - applied)
            applied = total
        booked += weight * h * applied
    return booked
