"""Balls that press on one another: a heap, stepped by pymunk until its balls part or rest.

Impacts between balls that lie on one another never end: each is weaker than the one before. So a bounce that lasts less
than two steps (of ``accuracy.step``, or shorter for small balls) is sustained contact, and the balls are stepped
together in a Space of real shapes. In the middle of each step the impulses act that keep apart what overlaps; the paths
are parabolas between. Second order in the forces, first order in the curvature of what they roll on. Faster impacts are
exact events, as ever. No step creates energy (``stepping.py``).

Rolling resistance is a torque on the ball up to ``c N R (1 + k)``, with k the inertia over m R^2: then a ball that
rolls freely is slowed by c N / m. Left out: the exact time and the event of an impact inside the heap that is slower
than 8 a h, with a the acceleration by forces and h the step. Balls of a heap that are struck leave it for the time of
the contact (``cluster_search.py``); while it forms, a blow on it is that on a rigid lump.
"""

from __future__ import annotations

from collections.abc import Collection, KeysView, Mapping, Sequence
from math import hypot, inf

from sandbox.engine.contact.manifold import (
    ContactManifold,
    all_round,
    meeting,
    resting_points,
    rounding,
    surface_met,
    touches_again,
)
from sandbox.engine.contact.surfaces import press
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.heap.member import Member
from sandbox.engine.heap.stepping import Group, HeapState, Stepper, Touch
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import outline_of, thickness
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import failed
from sandbox.engine.model.tolerances import STILL, TOUCHING_GAP
from sandbox.engine.motion.body_point_contact import body_point_contact
from sandbox.engine.motion.carried_ball import CarriedBall
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.motion.rest import next_jump, steady_end
from sandbox.engine.paths.arc import Arc, resting_arc
from sandbox.engine.paths.phase import InHeap
from sandbox.engine.paths.run import Numerics
from sandbox.physics.integrators import Acceleration, State

#: Gap, as a fraction of the smallest radius, up to which shapes are in contact in a heap: at rest they stay in touch.
_MARGIN = 1e-3

#: Steps without pressure after which two balls have parted, and with all at a standstill after which these rest; and
#: the speed, in units of what forces give a ball in a step, up to which it stands still: all its forces are balanced.
_PATIENCE, _STANDSTILL = 8, 1e-6

#: Speed, in units of what forces give a ball in a step, up to which balls of a heap meet in its steps, found late and
#: overlapped by up to half of what they move in a step; if faster, they have an impact at its exact time.
_SLOW = 8.0

#: Share of a step within which the next one begins if an impact cuts it short at once, and how often in a row, for each
#: ball or body, until a step takes all that meets in it: two that touch with a corner and fall together on the next one
#: would meet at the first again and again, and the run would not go on.
_AT_ONCE, _STUCK = 1e-3, 4

#: Impulse, as a fraction of the largest that forces give a ball in a step, below which it is rounding.
_PRESSURE = 1e-6

#: In units of sqrt(d / a), with d the thickness of the thinnest ball or body and a the acceleration by forces: the
#: longest step, of balls and where bodies lie on others (one that turns comes down deeper than a ball does); and the
#: time for which all have to be slow before they rest, and for which a ball has to lie in a heap before a blow goes
#: through it by contact mechanics.
_STEP, _STEP_OF_BODIES, _REST = 0.1, 0.028, 3.5

#: The tolerance in m at which bodies take these steps; their length goes with its fourth root, depths with its square
#: root. So one level of accuracy is three times as fast as the next, and ten times as deep.
_TOLERANCE = 1e-3

#: An acceleration in m/s^2 that is common.
_COMMON = 10.0

#: How many times too long a step may have been for the spins that it ended with, and how often it is done again with
#: the length that they need. More: corners of what is flung around come down deep in others.
_TOO_LONG, _ATTEMPTS = 1.2, 4

#: Depth, as a share of the thickness of the thinnest ball or body, that what touches may reach within half a step.
_DEEP = 1e-3

#: Share of the margin that position correction may move balls in a step when they part or come to rest.
_APART = 1e-2


class Heap:
    """All balls of a run that press on one another, in one heap or in several; they are stepped together."""

    def __init__(self, setup: Setup, movers: Sequence[MovingBall], accuracy: Accuracy, numerics: Numerics) -> None:
        self._setup = setup
        self._movers = movers
        self._longest, self._settle = accuracy.step, accuracy.settle
        self._numerics = numerics
        self._members: dict[int, Member] = {}
        self._pressed: dict[frozenset[int], float] = {}  # s, when two balls pressed on each other last
        self._resting: dict[int, set[int]] = {}  # balls at rest, each with its heap
        self._forced = 0.0  # m/s^2, the largest acceleration by forces, or of a point of a body that turns
        self._fastest = 0.0  # m/s, approach in the heap that is no impact of its own
        self._some_move = any(surface.motion is not None for surface in setup.surfaces)
        self._thin = min(map(thickness, setup.balls))  # m
        self._coarser = 1.0 if all_round(*setup.balls) else (accuracy.tolerance / _TOLERANCE) ** 0.25
        self._share = _STEP if all_round(*setup.balls) else _STEP_OF_BODIES * self._coarser
        self._span = accuracy.step  # s, of a step that nothing cuts
        self._t = 0.0  # s, the start of this step
        self._cut_short = 0  # steps in a row that an impact cut short at once
        self.margin = _MARGIN * min(ball.radius for ball in setup.balls)  # m, gap up to which shapes touch
        self._stepper = Stepper(setup, self.margin, self._lasting(1.0, _COMMON))  # corrects overlaps per unit

    def state(self) -> HeapState:
        """Return all that its next steps depend on, apart from the balls themselves and its Space."""
        members = {index: member.state() for index, member in self._members.items()}
        numbers = self._forced, self._fastest, self._span, self._t, self._cut_short
        return HeapState(members, dict(self._pressed), dict(self._resting), numbers, self._stepper.accounts())

    def restore(self, state: HeapState) -> None:
        """Go on from this state, in a new Space."""
        self._forced, self._fastest, self._span, self._t, self._cut_short = state.numbers
        self._pressed, self._resting = dict(state.pressed), dict(state.resting)
        self._stepper.restore(state.accounts)
        for index, values in state.members.items():
            member = Member(index, self._movers[index], self._stepper.world, self._stepper.unit, 0.0)
            member.restore(values)
            self._members[index] = member
            self._stepper.add(member)

    @property
    def members(self) -> KeysView[int]:
        """The balls that are stepped."""
        return self._members.keys()

    def has(self, indices: Collection[int]) -> bool:
        """True if some of these balls lie in the heap, at rest or not."""
        return any(index in self._members or index in self._resting for index in indices)

    def note_energy(self, states: Mapping[int, State]) -> None:
        """Note how much kinetic energy these balls have: what a heap creates is compared with the most."""
        for index, state in states.items():
            self._stepper.note_energy(self._movers[index].ball, state, index)

    def wake(self, indices: Collection[int]) -> None:
        """Step the heaps again in which these balls lie at rest."""
        woken = set[int]().union(*(self._resting.get(index, ()) for index in indices))
        self._take(self._members.keys() | woken)
        for index in woken:
            del self._resting[index]
            self._members[index].since = -inf

    def belongs_in_heap(self, t: float, states: Mapping[int, State], pairs: Sequence[tuple[int, int]]) -> bool:
        """True if balls that touch at t, in ``pairs``, belong in the heap: some are in it, or two part too slowly to
        stay apart for two steps."""
        members, pressing = self._members.keys(), {frozenset((i,)) for i, a in states.items() if self._lies(i, t, a)}
        forced = {index: self._forced_in_a_step(index, t, state) for index, state in states.items()}
        for i, j in pairs:
            a, b, balls = states[i], states[j], (self._movers[i].ball, self._movers[j].ball)
            met = meeting(balls[0], a, balls[1], b, self.margin)
            if (
                -met.closing < max(forced[i], forced[j])
                or (met.closing <= 0.0 and not members.isdisjoint((i, j)))
                or (not all_round(*balls) and self._come_back(t, (i, j), (a, b), met))
            ):
                pressing.add(frozenset((i, j)))
                self._refuse_carried(t, i, j, a)
                self._refuse_carried(t, j, i, b)
        self._pressed |= dict.fromkeys(pressing, t)
        return bool(pressing) or self.has(states)

    def _refuse_carried(self, t: float, index: int, other: int, state: State) -> None:
        """Raise RunError if a ball that another presses on is carried by a surface: no heap is stepped on that."""
        mover = self._movers[index]
        on = mover.carried_by(t, state, self._settle) if isinstance(mover, CarriedBall) else ""
        if on:
            what = f"{self._movers[other].ball.name!r} presses on it, and it is on {on!r}, which moves"
            raise failed(t, mover.ball.name, f"{what}: balls that press on one another cannot be carried")

    def _come_back(self, t: float, indices: Sequence[int], states: Sequence[State], met: ContactManifold) -> bool:
        """True if bodies that touch and part touch again at once, as they turn."""
        applied = [self._applied(index, t, state) for index, state in zip(indices, states, strict=True)]
        one, other = (outline_of(self._movers[index].ball) for index in indices)
        return touches_again((one, other), states, applied, met, self._settle)

    def slow(self, t: float, states: Mapping[int, State]) -> float:
        """The speed in m/s below which a blow among these balls is sustained contact, or one that a heap takes in its
        steps."""
        forced = max(self._forced_in_a_step(index, t, state) for index, state in states.items())
        return _SLOW * forced if self.has(states) else forced

    def fresh(self, t: float) -> set[int]:
        """The balls that have come to press on others of late: a heap that is still forming."""
        return {
            index for index, member in self._members.items() if t - member.since < self._lasting(_REST, self._forced)
        }

    def _forced_in_a_step(self, index: int, t: float, state: State) -> float:
        """The speed in m/s that forces give in a step: for a body at least what is rounding, while rounding does not
        press balls on each other."""
        ball = self._movers[index].ball
        least = -inf if all_round(ball) else rounding(ball, state)
        forced = hypot(*self._applied(index, t, state)[:2])
        speed = forced * min(self._longest, self._lasting(self._share, forced))
        return max(speed, least) if speed > STILL else least

    def _lies(self, index: int, t: float, state: State) -> bool:
        """True if a body leaves surfaces too slowly for a bounce that counts: at two points or more, or at one that its
        own path cannot follow."""
        mover = self._movers[index]
        if all_round(mover.ball):
            return False
        applied = self._applied(index, t, state)
        within = self.margin if index in self._members else TOUCHING_GAP
        found = resting_points(mover.ball, mover.obstacles_at(t), state, within, applied, self._settle)
        alone = len(found) == 1 and body_point_contact(mover.ball, state, *found[0], applied) is not None
        carrying = next((obstacle.surface for obstacle, *_ in found if obstacle.surface.motion is not None), None)
        if carrying is not None:
            what = f"it stays on {carrying.name!r}, which moves"
            raise failed(t, mover.ball.name, f"{what}: a body bounces off what moves, but is not carried by it")
        return bool(found) and not alone

    def step(self, t: float, until: float, states: Mapping[int, State]) -> dict[int, Arc]:
        """Step these balls from t, not beyond ``until``; returns the arcs of those that press on others or did just
        before."""
        self._cut_short = self._cut_short + 1 if t - self._t < _AT_ONCE * self._span else 0
        self._t = t
        self.note_energy(states)
        fresh = states.keys() - self._members.keys()
        self._take(states)
        self._forced = max(self._members[index].driven(state[4], t) for index, state in states.items())
        self._span = min(self._longest, self._lasting(self._share, self._forced))
        for index in fresh:
            self._resist_at_once(index, t, states[index])
        jump = next_jump(self._setup, (self._movers[index].ball for index in states), t, until)
        groups, h = self._do(t, min(self._span, jump - t), states)
        self._stepper.settle_accounts(t + h, groups, self._forced)
        for member in self._members.values():
            member.resistance = 0.0
        for touch in (touch for _, touches in groups for touch in touches):
            self._note(touch, touch.push / h)
        arcs = {index: self._members[index].arc(t) for index in sorted(states)}
        moved = {i: hypot(*arc.contact.drift) for i, arc in arcs.items() if isinstance(arc.contact, InHeap)}
        overlapped = {index for index, speed in moved.items() if speed * self._span > _APART * self.margin}
        held = self._held() | overlapped
        arcs = {index: arc for index, arc in arcs.items() if index in held}
        rests = self._lasting(_REST, self._forced)
        for index, arc in arcs.items():
            self._refuse_leap(index, arc)
            if self._some_move:  # what it may have come to lie on is refused
                self._lies(index, arc.t1, arc.state(arc.t1))
            member = self._members[index]
            slow = member.fastest**2 <= 2.0 * self._forced * self._settle and index not in overlapped
            still = member.fastest <= _STANDSTILL * self._forced * self._span
            member.slow_for = member.slow_for + max(h, still * rests / _PATIENCE) if slow else 0.0
        for heap in self._apart(held):
            if all(self._members[index].slow_for >= rests for index in heap):
                at_rest = {index: (*states[index][:2], 0.0, 0.0, 0.0, *states[index][5:]) for index in heap}
                end = steady_end(self._movers, at_rest, t, t, until)
                if end - t < min(rests, until - t):  # forces that change now would wake it at once
                    for index in heap:
                        self._members[index].slow_for = 0.0
                    continue
                self._resting |= dict.fromkeys(heap, heap)
                arcs |= {index: resting_arc(t, end, state, InHeap()) for index, state in at_rest.items()}
        self._take(held - self._resting.keys())
        return arcs

    def rest_on(self, t: float, until: float, index: int) -> dict[int, Arc]:
        """Return the arcs of the balls that rest with this one, as far as they are known to rest longer than to t; none
        if their forces change then."""
        arcs = {each: self._movers[each].arc for each in sorted(self._resting.get(index, ()))}
        states, since = {each: arc.start for each, arc in arcs.items()}, self._movers[index].arc.t0
        end = steady_end(self._movers, states, since, t, until)
        return {each: resting_arc(since, end, state, InHeap()) for each, state in states.items() if end > t}

    def _do(self, t: float, h: float, states: Mapping[int, State]) -> tuple[list[Group], float]:
        """Step the members by h s from t, or by less if they end with spins that need shorter steps: what touches in
        groups, and the length of the step in s."""
        for member in self._members.values():
            member.before = member.touching
        for attempt in range(_ATTEMPTS):
            for index, state in states.items():
                self._members[index].place(t, h, state)
            stuck = self._cut_short > _STUCK * len(self._members)
            self._fastest = inf if stuck else _SLOW * self._forced * self._span
            groups = self._stepper.step(h, self._span, self._forced * h, self._fastest)
            self._numerics.pymunk_steps += 1
            fits = self._fitting(h, groups)
            if h <= _TOO_LONG * fits or not self._stepper.directly or attempt == _ATTEMPTS - 1:
                break
            h = self._span = fits
        return groups, h

    def _fitting(self, h: float, groups: Sequence[Group]) -> float:
        """The length in s that a step of h s should have had: for the spins that it ended with, and so that nothing
        came deep into another before it was noticed."""
        forced = max(member.driven(member.velocity[2], self._t) for member in self._members.values())
        fits, deep = self._lasting(self._share, forced), _DEEP * self._coarser**2 * self._thin
        for touch in (touch for _, touches in groups for touch in touches):
            depth = max((-gap for _, gap in touch.points), default=0.0)
            if min(depth, 0.5 * h * touch.approach) > deep:
                fits = min(fits, 2.0 * deep / touch.approach)
        return fits

    def _resist_at_once(self, index: int, t: float, state: State) -> None:
        """Resist the rolling of a ball that has come into the heap, by what presses it on surfaces now."""
        ball, mover = self._movers[index].ball, self._movers[index]
        if ball.rotates:
            return
        applied = self._applied(index, t, state)
        for obstacle, touching in mover.near(t, state[0], state[1], self.margin):
            pushed = press(state, applied, touching.nx, touching.ny, touching.curvature)
            self._members[index].resist(obstacle.surface, ball.mass * max(0.0, pushed), ball.radius)

    def _note(self, touch: Touch, push: float) -> None:
        """Note which balls press on each other, and how hard, in N, one presses on a surface that resists its
        rolling."""
        here, there = touch.first, touch.second
        if touch.surface is not None and touch.height > 0.0:
            here.resist(touch.surface, push, touch.height)
        if (there is not None or not all_round(here.ball)) and push > _PRESSURE * here.ball.mass * self._forced:
            pair = (here.index,) if there is None else (here.index, there.index)
            self._pressed[frozenset(pair)] = self._t

    def _apart(self, held: set[int]) -> list[set[int]]:
        """These balls as heaps that do not press on each other."""
        heap_of = {index: {index} for index in held}
        for one, other in (pair for pair in self._pressed if len(pair) == 2):
            if heap_of[one] is not heap_of[other]:
                joined = heap_of[one] | heap_of[other]
                heap_of |= dict.fromkeys(joined, joined)
        return list({id(heap): heap for heap in heap_of.values()}.values())

    def _refuse_leap(self, index: int, arc: Arc) -> None:
        """Raise RunError if a body's centre passed through a surface: it was too thin for the step."""
        ball = self._movers[index].ball
        passed = self._stepper.world.passed(arc.position(arc.t0), arc.position(arc.t1)) if ball.rotates else None
        if passed is not None:
            what = f"it is so thin that others pressed it through {self._setup.surfaces[passed].name!r}"
            raise failed(arc.t1, ball.name, f"{what}; lower accuracy.step")

    def _lasting(self, share: float, forced: float) -> float:
        """A share of the time in s in which this acceleration (m/s^2) moves something by its own thickness."""
        return share * (self._thin / forced) ** 0.5 if forced > 0.0 else inf

    def _applied(self, index: int, t: float, state: State) -> Acceleration:
        return self._movers[index].applied(t, state)

    def _take(self, indices: Collection[int]) -> None:
        """Make these balls the members."""
        for index in self._members.keys() - indices:
            self._stepper.remove(self._members.pop(index))
        for index in indices - self._members.keys():
            member = Member(index, self._movers[index], self._stepper.world, self._stepper.unit, self._t or -inf)
            self._members[index] = member
            self._stepper.add(member)

    def release(self, indices: Collection[int]) -> None:
        """Let go of balls that are struck."""
        self.wake(indices)
        self._take(self._members.keys() - indices)
        for member in self._members.values():
            member.touching -= {*indices}

    def _held(self) -> set[int]:
        """The balls of the pairs that pressed on each other in the last steps."""
        held: set[int] = set()
        for pair, last in list(self._pressed.items()):
            if self._t - last < _PATIENCE * self._span and pair <= self._members.keys():
                held |= pair
            else:
                del self._pressed[pair]
        return held

    def keeps_apart(self, index: int, other: Obstacle | int) -> bool:
        """True if the heap keeps a ball from this obstacle or ball, so that they have no impact of their own: they
        touch, or would meet slowly."""
        if isinstance(other, Obstacle) and other.moves:
            return False
        if index in self._resting:
            return isinstance(other, Obstacle) or other in self._resting[index]
        here, there = self._members[index], self._members.get(other) if isinstance(other, int) else None
        touching = other in here.touching
        if touching and all_round(here.ball, *([] if there is None else [there.ball])):
            return True
        if other in here.left_out:  # at the corners of what stands for an ellipse, speeds differ from those on it
            return False
        # one that touches with one corner may be flung round, and down on the next one
        ways = [here.end] if touching else [here.start, here.end]
        if isinstance(other, Obstacle):
            together = here.fastest
            met = (surface_met(here.ball, at, (other, other.near(*at[:2]))) for at in ways)
        elif there is None:
            return False
        else:
            together = here.fastest + there.fastest
            others = [there.end] if touching else [there.start, there.end]
            pairs = zip(ways, others, strict=True)
            met = (meeting(here.ball, at, there.ball, then) for at, then in pairs)
        return together <= self._fastest or all(each.closing <= self._fastest for each in met)
