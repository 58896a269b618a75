"""Many shots at once: flights, slides and rolls in arrays over the shots, impacts by pymunk.

The shots of a batch are similar: one ball and the same kinds of forces and surfaces, with different numbers. Each shot
has its own time and its own steps, and moves exactly as in simulation.py. Rare cases (lasting contact with anything but
a straight side, two surfaces at once, an invalid state) are handed to simulation.py, which continues the shot from its
current state.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.acting import by_cause, law_of
from sandbox.engine.arc import Arc, through
from sandbox.engine.arc_rows import CURVES, END, START, T0, T1, Paths, X, Y, arc_of, columns_of, cut, stepped, still
from sandbox.engine.bernstein_many import elevated, first_downward_crossing
from sandbox.engine.event import Event
from sandbox.engine.impulses import FEW, MANY
from sandbox.engine.impulses import lanes as impact_lanes
from sandbox.engine.lasting import BECOMES, FLYING, RESTING, ROLLING, SLIDING, LastingContact, motion_on
from sandbox.engine.outlines import Outlines
from sandbox.engine.run import Numerics, Run
from sandbox.engine.setup import Ball, Setup, Until
from sandbox.engine.setup_errors import setup_errors_named
from sandbox.engine.simulation import Left, Simulation, alone
from sandbox.engine.stacking import FEWEST, Stack, selector
from sandbox.engine.step_control import StepControl, allowed, shortest
from sandbox.engine.surfaces import CLOSING, bounce_off, leaves_at, press, tilted
from sandbox.engine.touch import SEAM, SIDE
from sandbox.physics.impulse import after_impulse, surface_speeds
from sandbox.physics.integrators import Acceleration, Law

#: What setups need for flights together; how they end is asked of each.
FLIGHT = ("balls", "surfaces", "patches", "bounds", "duration", "breaks")

#: What is known of each shot in flight: attributes of Batch, arrays with shots along the last axis.
_OF_EACH = ["_shot", "_t", "_state", "_wanted", "_again", "_how"]
_OF_EACH += ["_met", "_normal", "_ends", "_surface", "_mode", "_direction", "_contact"]  # after touches and in contact

#: Rows of the counters.
STEPS, REFINED, IMPACTS, QUERIES = range(4)

#: Pieces of path in a batch, 300 bytes each, beyond which its shots continue one at a time, where the number of steps
#: is limited.
MOST_PIECES = 500_000

#: Largest relative difference between the forces computed with arrays and with floats; beyond it the shots run one at
#: a time.
_ROUNDING = 1e-9

#: What a scene's own function may raise.
FAILURES = (Exception, SystemExit)

#: Shots whose forces are checked one by one at the start; later one shot is checked in each step.
_WATCHED = 32


def together(setups: Sequence[Setup], accuracy: Accuracy) -> Iterator[Run | Exception] | None:
    """A run of each setup, in order, or the exception it ended with; None if they cannot fly together."""
    stack = _stack(setups)
    if stack is None:
        return None
    batch = Batch(stack, accuracy)
    try:
        batch.fly()
    except _OnlyFloats:
        return None  # one at a time they run, or raise an error of their own
    return batch.runs()


def _stack(setups: Sequence[Setup]) -> Stack | None:
    """The setups as one, if they can fly together."""
    if isinstance(setups, Stack):
        return setups if setups.whole.is_flight else None
    if len(setups) < FEWEST or not all(setup.is_flight for setup in setups):
        return None
    try:
        return Stack.of(setups, (*FLIGHT, "until") if isinstance(setups[0].until, Until) else FLIGHT)
    except Exception:  # Unlike, or what a class of the scene raises when it is compared
        return None


class _OnlyFloats(Exception):
    """Forces that cannot take arrays, or that return other values for arrays than for floats."""


#: Why a shot leaves the batch, as in Left, where the first three are complete; none if it stays.
_HOW = ("until", "rest", "duration", "before", "after", "flight", "ended", "start", "")
_UNTIL, _REST, _DURATION, _BEFORE, _AFTER, _FLIGHT, _ENDED, _START, _STAYS = range(len(_HOW))
_ENDS = _HOW[:_BEFORE]


class _Held(NamedTuple):
    """Shots that slide, or that roll."""

    lanes: np.ndarray
    ball: Ball
    contact: LastingContact


class Batch:
    """Shots that fly together. Arrays have one entry for each shot still in flight, or rows of them."""

    def __init__(self, setups: Stack, accuracy: Accuracy) -> None:
        self.setups = setups
        self._accuracy = accuracy
        self._control = StepControl(accuracy)
        self._step = self._control.integrator.step_of_many(self._law)
        whole, ball = setups.whole, setups.whole.balls[0]
        numbers = whole.duration, ball.radius, ball.inertia_factor  # of all shots, in or out of flight
        self._duration, self._radius, self._factor = (np.broadcast_to(each, len(setups)) for each in numbers)
        self._has_law = np.array([surface.law is not None for surface in whole.surfaces], dtype=bool)
        self._select = selector(whole)
        self._until = selector(whole.until)
        self._outlines = Outlines(setups, accuracy.skin)
        self._events: list[list[Event]] = [[] for _ in setups]
        self._left: dict[int, Left] = {}
        self._contacts: list[Any] = []
        nothing = (np.zeros(0, dtype=int), columns_of([], []))
        self._paths = [nothing]  # of each round: shots, and the rows of their arcs as columns
        self._counts = np.zeros((4, len(setups)), dtype=int)  # of all shots

        # of those in flight
        self._shot = np.arange(len(setups))
        self._t = np.zeros(len(setups))
        start = whole.start_of(ball)
        self._state: Any = np.array([np.broadcast_to(part, len(setups)) for part in start], float)
        self._wanted = np.full(len(setups), self._control.first)  # s, the next step
        self._again = np.zeros(len(setups), dtype=bool)  # the last step was too long and is repeated
        self._how = np.full(len(setups), _STAYS)  # why it leaves now: a place in _HOW
        self._met = np.full(len(setups), -1)  # surface that it has just met, or -1
        self._normal = np.zeros((3, len(setups)))  # of that: nx, ny and the curvature of the ball's path along it
        self._ends = np.zeros(len(setups), dtype=bool)  # its way of sliding or rolling has just ended
        self._surface = np.full(len(setups), -1)  # on which it slides or rolls; -1 in flight
        self._mode = np.full(len(setups), FLYING, dtype="U8")
        self._direction = np.zeros(len(setups))  # of the motion in contact, as in LastingContact
        self._contact = np.full(len(setups), -1)  # index in _contacts
        self._held: list[_Held] = []
        self._keep(whole)

    def fly(self) -> None:
        """Fly all shots to their end, or until they leave the batch."""
        started = perf_counter()
        with np.errstate(all="ignore"):
            some = np.arange(0, len(self._shot), max(1, len(self._shot) // _WATCHED))
            self._check_forces(some, self._acceleration(self._flight, self._t, self._state))
            self._begin()
            rounds = pieces = 0
            while len(self._shot) >= FEWEST and pieces < MOST_PIECES:
                self._advance_all(rounds % len(self._shot))
                rounds += 1
                pieces += len(self._paths[-1][0])
        self._how = np.where(self._met >= 0, _AFTER, np.where(self._ends, _ENDED, _FLIGHT))
        self._drop()
        self._seconds = perf_counter() - started

    def runs(self) -> Iterator[Run | Exception]:
        """Each shot's run, in order."""
        found = [self._run(number) for number in range(len(self.setups))]
        shots = np.concatenate([shots for shots, _ in self._paths])
        order = np.argsort(shots, kind="stable")
        rows = np.concatenate([columns for _, columns in self._paths], axis=1)[:, order].T
        paths = Paths(rows, np.cumsum(np.bincount(shots, minlength=len(self.setups))).tolist(), self._contacts)
        for number, run in enumerate(found):
            if isinstance(run, Run):
                run.arcs = {run.setup.balls[0].name: paths[number]}
            yield run

    # ------------------------------------------------------------------ forces

    def _acceleration(self, law: Law, t: np.ndarray, state: np.ndarray) -> Any:
        """As rows: ax, ay, alpha. Raises _OnlyFloats for what is not a real number of each shot, or of all."""
        for array in (t := t.view(), state := state.view()):
            array.flags.writeable = False  # ``vx -= wind`` in a force leaves a float as it was, but not an array
        found = np.empty((3, len(t)))
        try:
            for row, part in zip(found, law(t, tuple(state)), strict=True):
                np.copyto(row, part)
        except FAILURES as error:  # such as complex numbers, or arrays of the wrong shape
            raise _OnlyFloats from error
        return found

    def _check_forces(self, lanes: np.ndarray, together: np.ndarray) -> None:
        """Raise _OnlyFloats if the accelerations of these lanes, computed with arrays, differ from those computed with
        floats, as if a force mixes up shots. If they are not numbers, the shot run alone reports why."""
        for lane in lanes.tolist():
            ball, now = self.setups[self._shot[lane]].balls[0], tuple(self._state[:, lane].tolist())
            try:
                alone = law_of(ball)(t := float(self._t[lane]), now)
                off = max(abs(one - other) for one, other in zip(together[:, lane].tolist(), alone, strict=True))
                if off > _ROUNDING * sum(map(abs, alone)):  # they may cancel
                    size = sum(abs(fx) + abs(fy) for _, (fx, fy) in by_cause(ball.forces, t, now)) / ball.mass
                    if off > _ROUNDING * (size + abs(alone[2])):
                        raise _OnlyFloats
            except FAILURES as error:
                raise _OnlyFloats from error

    # ------------------------------------------------------------------ one step, or an impact, for each shot

    def _begin(self) -> None:
        count, obstacle, near = self._outlines.near(self._shot, self._state[0], self._state[1])
        away = self._state[2] * near.nx + self._state[3] * near.ny
        self._met, self._normal = np.where(count == 1, obstacle, -1), np.array(near[1:4])
        self._how[~((count == 0) | ((count == 1) & (near.gap >= -1e-12) & (away >= -CLOSING)))] = _START
        self._drop()

    def _advance_all(self, watched: int) -> None:
        known = self._acceleration(self._flight, self._t, self._state)
        self._check_forces(np.array([watched]), known)
        self._settle(known)
        known = known[:, self._drop()]
        if not len(self._shot):
            return
        kinds = set(self._mode[self._surface >= 0].tolist())
        self._held = [self._placed(self._mode == mode, mode) for mode in sorted(kinds)]
        if self._held:
            known = self._law(self._t, self._state)
        h = np.minimum(self._wanted, self._now.duration - self._t)
        h = np.where(self._again, self._wanted, allowed(self._now, self._t, h, self._state, known))
        fits, following, after, last = self._control.attempt(
            self._step, self._t, self._state, known, h, self._wanted, self._now.balls[0].radius
        )
        self._again = ~fits
        self._counts[STEPS, self._shot] += 1
        self._counts[REFINED, self._shot] += ~fits
        accepted = fits & self._now.bounds.hold(after)
        stuck = ~accepted & (fits | (following < shortest(self._t)))
        self._how[stuck] = _FLIGHT  # which raises the error
        wanted, self._wanted = self._wanted, np.where(stuck, h, following)
        lanes = accepted.nonzero()[0]
        ends: Any = self._state, known, after, last
        arc = through(self._t[lanes], h[lanes], *(part[:, lanes] for part in ends))
        rows = stepped(arc, self._contact[lanes])
        changes, lasts = self._changes(rows, accepted)
        if not lasts.all():
            unclear = lanes[~lasts]  # what follows the contact: this step is made again, alone
            self._how[unclear], self._wanted[unclear] = _FLIGHT, wanted[unclear]
            self._counts[STEPS, self._shot[unclear]] -= 1
            lanes, rows, changes = lanes[lasts], rows[:, lasts], changes[lasts]
        if len(lanes):
            self._travel(lanes, rows, changes)
        self._drop()

    # ------------------------------------------------------------------ lasting contact

    def _placed(self, held: np.ndarray, mode: str) -> _Held:
        """The shots of this mask, placed exactly on their surfaces as moving or resting there."""
        lanes = held.nonzero()[0]
        shots, state = self._shot[lanes], tuple(self._state[:, lanes])
        obstacles, ball = self._outlines.of(self._surface[lanes], shots), self._select(shots).balls[0]
        contact = LastingContact(mode, obstacles, obstacles.on_feature(SIDE, *state[:2]), self._direction[lanes])
        for row, part in zip(self._state, contact.placed(ball, state), strict=True):
            row[lanes] = part
        return _Held(lanes, ball, contact)

    def _law(self, t: np.ndarray, state: Any) -> Any:
        """The acceleration of shots in flight and in contact."""
        found = self._acceleration(self._flight, t, state)
        for at, ball, contact in self._held:
            found[:, at] = contact.forces(ball, found[:, at], state[:, at])[0]
        return found

    def _changes(self, rows: np.ndarray, accepted: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Where on these arcs, of shots whose step is ``accepted``, slip or speed ends, as u, inf where it does not;
        and a mask of those that stay on their surface until then, as far as can be told here."""
        changes, lasts = np.full(rows.shape[1], np.inf), np.ones(rows.shape[1], dtype=bool)
        if not (self._held and accepted.any()):
            return changes, lasts
        place = accepted.cumsum() - 1
        for lanes, ball, contact in self._held:
            here = rows[:, place[lanes]]
            x, y, vx, vy, spin = (here[part] for part in CURVES)
            end: Any = here[END]
            applied = self._acceleration(law_of(ball), here[T1], end)
            _, normal, spare = contact.forces(ball, applied, end)
            progress = contact.progress(ball, (x, y, vx, vy, elevated(spin, len(vx) - 1)))
            u, unclear = first_downward_crossing(progress)
            ends = progress[-1] < 0.0
            side = contact.obstacle.outline
            along = side.along(x, y)
            inside = (along.min(axis=0) > 0.0) & (along.max(axis=0) < side.length)
            stays = inside & (normal >= 0.0) & (spare >= 0.0) & ~(ends & (unclear | ~np.isfinite(u)))
            some = accepted[lanes]
            changes[place[lanes[some]]] = np.where(ends, u, np.inf)[some]
            lasts[place[lanes[some]]] = stays[some]
        return changes, lasts

    def _settle(self, acceleration: np.ndarray) -> None:
        """Whether shots that have met a surface, or whose slide or roll has ended, fly on, or slide, roll or rest."""
        hit = self._met >= 0
        at = (hit | self._ends).nonzero()[0]
        if not len(at):
            return
        hit, held, shots = hit[at], self._surface[at] >= 0, self._shot[at]
        on = np.where(held, self._surface[at], self._met[at])
        (x, y, vx, vy, spin), applied = self._state[:, at], tuple(acceleration[:, at])
        obstacles, (nx, ny, curvature) = self._outlines.of(on, shots), self._normal[:, at]
        if held.any():
            touching = obstacles.near(x, y)
            nx, ny, curvature = np.where(held, touching[1:4], self._normal[:, at])
        pressed = press((x, y, vx, vy, spin), applied, nx, ny, curvature)
        away = vx * nx + vy * ny
        stays = away <= leaves_at(pressed, np.maximum(self._accuracy.settle, obstacles.surface.lowest_bounce))
        known = ~(hit & held)
        if not known.all():
            known |= self._leaves(at, abs(applied[0]) + abs(applied[1]) + obstacles.surface.friction * pressed)
        flies = hit & ~stays & known
        self._met[at], self._ends[at], self._surface[at] = -1, False, np.where(flies, -1, on)
        self._mode[at[flies]] = FLYING
        holds = rests = np.zeros(len(at), dtype=bool)
        mode = direction = np.zeros(0)
        if not flies.all():
            self._how[at[~flies]] = np.where(hit, _AFTER, _ENDED)[~flies]
            state = np.array((x, y, vx - away * nx, vy - away * ny, spin))
            ball = self._select(shots).balls[0]
            touching = obstacles.near(x, y)
            mode, direction = motion_on(ball, tuple(state), obstacles.surface, touching, applied)
            along = obstacles.outline.along(x, y)
            inside = known & stays & (along > SEAM) & (along < obstacles.outline.length - SEAM)
            holds, rests = inside & ((mode == SLIDING) | (mode == ROLLING)), inside & ~hit & (mode == RESTING)
            here = at[holds]
            self._state[:, here], self._mode[here] = state[:, holds], mode[holds]
            self._direction[here] = direction[holds]
        some = (flies | holds | rests).nonzero()[0]
        parts = [part[some].tolist() for part in (at, shots, on, hit, held, flies, rests)]
        for i, lane, shot, surface, has_hit, was_held, leaves, stops in zip(some.tolist(), *parts, strict=True):
            what = "rest" if stops else "" if leaves != was_held else "leave" if leaves else "contact"
            how = self._how[lane] = self._noted(lane, what, surface, has_hit)
            if how in (_AFTER, _ENDED):
                continue  # run alone, the shot raises the error
            self._contact[lane] = -1 if leaves else len(self._contacts)
            if not leaves:
                obstacle = self._outlines.obstacle(surface, shot)
                side = obstacle.on_feature(SIDE, float(x[i]), float(y[i]))
                self._contacts.append(LastingContact(str(mode[i]), obstacle, side, float(direction[i])))
        ended = at[rests | (self._how[at] == _UNTIL)]  # the last state is included, though no arc follows
        if rests.any():
            near = self._outlines.in_reach(shots[rests], x[None, rests], y[None, rests], on[rests])
            self._counts[QUERIES, shots[rests]] += near.sum(axis=0)
        if len(ended):
            self._paths.append((self._shot[ended], still(self._t[ended], self._state[:, ended])))

    def _noted(self, lane: int, what: str, surface: int, hit: bool) -> int:
        """Note what becomes of a shot on a surface, if that is an event, after an impact there if it ``hit`` it.
        Returns why it leaves now, as a place in _HOW."""
        setup, events = self.setups[self._shot[lane]], self._events[self._shot[lane]]
        noted = len(events)
        try:
            over = hit and bool(events) and setup.ends_with(events)
            if what:
                names, (x, y) = (setup.balls[0].name, setup.surfaces[surface].name), self._state[:2, lane].tolist()
                events.append(Event(float(self._t[lane]), what, *names, 0.0, x, y))
                over = setup.ends_with(events) or over
        except FAILURES:
            del events[noted:]
            return _AFTER if hit else _ENDED
        return _UNTIL if over else _REST if what == "rest" else _STAYS

    def _leaves(self, at: np.ndarray, most: np.ndarray) -> np.ndarray:
        """Whether these shots leave what they have met, on which no more than this presses them, in m/s^2."""
        (x, y, vx, vy, _), met = self._state[:, at], self._outlines.of(self._met[at], self._shot[at])
        near, height = met.near(x, y), np.maximum(self._accuracy.settle, met.surface.lowest_bounce)
        leaves: np.ndarray = vx * near.nx + vy * near.ny > leaves_at(most, height)
        return leaves

    # ------------------------------------------------------------------ travelling

    def _travel(self, lanes: np.ndarray, rows: np.ndarray, changes: np.ndarray) -> None:
        """Take the accepted step of these lanes, up to the first touch, or to where the motion in contact changes."""
        shots, t0 = self._shot[lanes], rows[T0]
        ends = np.isfinite(changes).nonzero()[0]
        if len(ends):
            u = changes[ends]
            rows[:, ends] = cut(rows[:, ends], t0[ends] + u * (rows[T1, ends] - t0[ends]), u)
        u, looked_at = self._outlines.first_touch(
            shots, rows[X], rows[Y], lambda i: arc_of(rows[:, i].tolist()), self._surface[lanes]
        )
        self._counts[QUERIES, shots] += looked_at
        t = t0 + u * (rows[T1] - t0)
        hits = (t <= rows[T1]).nonzero()[0]
        if len(hits):
            self._wanted[lanes[hits]] = np.minimum(self._wanted[lanes[hits]], rows[T1, hits] - t0[hits])
            rows[:, hits] = cut(rows[:, hits], t[hits], u[hits])
            changes[hits] = np.inf
        self._paths.append((shots, rows))
        self._t[lanes], self._state[:, lanes] = rows[T1], rows[END]
        if self._held:
            self._ends[lanes] = changes < np.inf
            for held in self._held:
                if (ended := self._ends & (self._mode == held.contact.mode)).any():
                    self._placed(ended, BECOMES[held.contact.mode])
        how = np.where(rows[T1] >= self._duration[shots], _DURATION, _STAYS)
        how[hits] = _STAYS
        if isinstance(self._now.until, Until):
            passed = self._until(shots).passed(tuple(rows[START]), tuple(rows[END]))
            how[(how == _STAYS) & ~np.isfinite(changes) & passed] = _UNTIL
            hits = hits[how[hits] == _STAYS]
        self._how[lanes] = how
        if len(hits):
            self._impact(lanes[hits])

    # ------------------------------------------------------------------ impacts

    def _impact(self, lanes: np.ndarray) -> None:
        """Let pymunk change the velocities of shots that touch a surface."""
        shots = self._shot[lanes]
        x, y, vx, vy, _ = self._state[:, lanes]
        count, obstacle, near = self._outlines.near(shots, x, y, self._surface[lanes])
        approach = -(vx * near.nx + vy * near.ny)
        along = vx * near.ny - vy * near.nx
        plain = (count == 1) & (approach > CLOSING)
        bounces = np.zeros((len(lanes), 4))  # as in Bounce
        grip = self._outlines.of(obstacle, shots).surface
        bounces[:, 0], bounces[:, 1] = grip.restitution, grip.friction
        for i in (plain & self._has_law[obstacle]).nonzero()[0].tolist():
            surface = self.setups[shots[i]].surfaces[obstacle[i]]
            try:
                bounces[i] = bounce_off(surface, float(approach[i]), float(along[i]))
            except FAILURES:
                plain[i] = False  # run alone, the shot reports what is wrong with the surface's law
        motion = self._exchanged(lanes, *tilted(near.nx, near.ny, bounces[:, 2], along), bounces)
        held = (self._surface[lanes] >= 0).nonzero()[0]
        if len(held):  # what it is on may act, too, and does not if it is not pressed on that
            own = self._outlines.of(self._surface[lanes[held]], shots[held]).on_feature(SIDE, x[held], y[held])
            plain[held] &= motion[0][held] * own.nx + motion[1][held] * own.ny >= -CLOSING
        self._how[lanes[~plain]] = _BEFORE
        lanes, shots, obstacle = lanes[plain], shots[plain], obstacle[plain]
        self._counts[IMPACTS, shots] += 1
        self._state[2:, lanes] = np.array(motion)[:, plain]
        self._met[lanes], self._normal[:, lanes] = obstacle, np.array(near[1:4])[:, plain]
        places = zip(
            self._t[lanes].tolist(), approach[plain].tolist(), x[plain].tolist(), y[plain].tolist(), strict=True
        )
        for shot, what, (t, speed, *place) in zip(shots.tolist(), obstacle.tolist(), places, strict=True):
            setup = self.setups[shot]
            names = setup.balls[0].name, setup.surfaces[what].name
            self._events[shot].append(Event(t, "impact", *names, speed, *place))

    def _exchanged(self, lanes: np.ndarray, nx: np.ndarray, ny: np.ndarray, bounces: np.ndarray) -> Acceleration:
        """The velocities and spins after impacts on surfaces with these normals."""
        motion, shots = tuple(self._state[2:, lanes]), self._shot[lanes]
        r, factor = self._radius[shots], self._factor[shots]
        approach, slip, _ = surface_speeds(motion, nx, ny, r)
        count = min(MANY, max(FEW, 1 << (len(lanes) - 1).bit_length()))
        push, rub = impact_lanes(count).exchange_all(
            approach, (1.0 + bounces[:, 3]) * slip, np.column_stack((bounces[:, :2], factor))
        )
        return after_impulse(motion, nx, ny, r, factor, (push, rub, 0.0))

    # ------------------------------------------------------------------ leaving the batch

    def _drop(self) -> np.ndarray:
        """Note how shots leave, and keep the others. Returns a mask of these."""
        staying: np.ndarray = self._how == _STAYS
        leaving = (~staying).nonzero()[0].tolist()
        for lane in leaving:
            state, number = tuple(self._state[:, lane].tolist()), int(self._contact[lane])
            contact = self._contacts[number] if number >= 0 else None
            shot, how = int(self._shot[lane]), _HOW[self._how[lane]]
            arcs = [] if how in _ENDS else self._last_arc(shot)
            self._left[shot] = Left(float(self._t[lane]), how, state, float(self._wanted[lane]), contact, arcs)
        if leaving:
            for name in _OF_EACH:
                setattr(self, name, getattr(self, name)[..., staying])
            self._keep(self._select(self._shot))
        return staying

    def _keep(self, now: Setup) -> None:
        """Go on with these shots, as one."""
        self._now, self._flight = now, law_of(now.balls[0])

    def _last_arc(self, shot: int) -> list[Arc]:
        """The last arc of a shot, if it has one."""
        for shots, rows in reversed(self._paths):
            if shot in shots:
                return [arc_of(rows[:, np.flatnonzero(shots == shot)[-1]].tolist(), self._contacts)]
        return []

    def _run(self, number: int) -> Run | Exception:
        """The run of a shot, without its arcs, which become rows if they are not."""
        setup, left, events = self.setups[number], self._left[number], self._events[number]
        steps, refined, impacts, queries = self._counts[:, number].tolist()
        seconds = self._seconds / len(self.setups)
        numerics = Numerics((self._control.evaluations + 1) * steps, steps, refined, impacts, impacts, queries, seconds)
        if left.how in _ENDS:
            return Run(setup, self._accuracy, {}, events, numerics, left.t, left.how)
        try:
            with setup_errors_named():
                simulation = Simulation(setup, self._accuracy, numerics)
                run = alone(simulation.run() if left.how == "start" else simulation.take_over(left, events))
        except Exception as error:
            return error
        arcs = list(run.arcs[setup.balls[0].name])[len(left.arcs) :]
        contacts = range(len(self._contacts), len(self._contacts) + len(arcs))
        self._contacts += [arc.contact for arc in arcs]
        self._paths.append((np.full(len(arcs), number), columns_of(arcs, contacts)))
        return run
