"""Many shots at once: flights and distances in arrays over the shots, impacts by pymunk.

The shots of a batch are similar: one ball and the same kinds of forces and surfaces, with different numbers. Each shot
has its own time and its own steps, and moves exactly as in simulation.py. Rare cases (lasting contact, two surfaces at
once, an invalid state) are handed to simulation.py, which continues the shot from its current state.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from time import perf_counter
from typing import NamedTuple

import numpy as np

from sandbox.engine.accuracy import Accuracy
from sandbox.engine.acting import acceleration, by_cause
from sandbox.engine.arc import through
from sandbox.engine.arc_rows import COLUMNS, END, ArcRows, Paths, X, Y, arc_of, cut
from sandbox.engine.event import Event
from sandbox.engine.impulses import MANY, lanes
from sandbox.engine.outlines import Outlines
from sandbox.engine.run import Numerics, Run
from sandbox.engine.setup import Setup, Until
from sandbox.engine.setup_errors import setup_errors_named
from sandbox.engine.simulation import Simulation
from sandbox.engine.stacking import FEWEST, Stack, selector
from sandbox.engine.step_control import LONGEST, StepControl, before_break, within
from sandbox.engine.surfaces import CLOSING, bounce_off, leaves_at, press, tilted
from sandbox.physics.impulse import after_impulse, surface_speeds
from sandbox.physics.integrators import Acceleration, State

#: What setups need for flights together; how they end is asked of each.
FLIGHT = ("balls", "surfaces", "patches", "bounds", "duration", "breaks")

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


def _ending(setup: Setup, events: Sequence[Event]) -> str:
    """ "until" if the last of these events ends the run, "" if not; "after" if the condition fails, so that the shot
    runs alone and raises the error."""
    try:
        return "until" if events and setup.ends_with(events) else ""
    except FAILURES:
        return "after"


class _OnlyFloats(Exception):
    """Forces that cannot take arrays, or that return other values for arrays than for floats."""


class _Left(NamedTuple):
    """How a shot left the batch: at its end (``how`` is "until" or "duration"), or to be continued by simulation.py:
    from its start ("start"), in flight, or where it touches something, "before" an impact or "after" it."""

    t: float  # s
    how: str
    state: State
    wanted: float  # s, the next step


class Batch:
    """Shots that fly together. Arrays have one entry for each shot still in flight, or rows of them."""

    def __init__(self, setups: Stack, accuracy: Accuracy) -> None:
        self.setups = setups
        self._accuracy = accuracy
        self._control = StepControl(accuracy)
        whole = setups.whole
        self._select = selector(whole)
        self._until = selector(whole.until)
        self._outlines = Outlines(setups, accuracy.skin)
        self._lanes = lanes(MANY)
        self._events: list[list[Event]] = [[] for _ in setups]
        self._left: dict[int, _Left] = {}
        nothing = (np.zeros(0, dtype=int), np.zeros((COLUMNS, 0)))
        self._paths = [nothing]  # of each round: shots, and the rows of their arcs as columns
        self._counts = np.zeros((4, len(setups)), dtype=int)  # of all shots

        # of those in flight
        self._shot = np.arange(len(setups))
        self._t = np.zeros(len(setups))
        ball = whole.balls[0]
        start = (*ball.position, *ball.velocity, ball.spin)
        self._state = np.array([np.broadcast_to(part, len(setups)) for part in start], float)
        self._wanted = np.full(len(setups), self._control.first)  # s, the next step
        self._again = np.zeros(len(setups), dtype=bool)  # the last step was too long and is repeated
        self._how = np.full(len(setups), "", dtype="U8")  # why it leaves now, as in _Left; "" if it stays
        self._now: Setup = whole

    def fly(self) -> None:
        """Fly all shots to their end, or until they leave the batch."""
        started = perf_counter()
        with np.errstate(all="ignore"):
            some = np.arange(0, len(self._shot), max(1, len(self._shot) // _WATCHED))
            self._check_forces(some, np.array(self._acceleration(self._t, tuple(self._state))))
            self._begin()
            rounds = pieces = 0
            while len(self._shot) >= FEWEST and pieces < MOST_PIECES:
                self._advance_all(rounds % len(self._shot))
                rounds += 1
                pieces += len(self._paths[-1][0])
        self._how = np.where(self._touched < 0, "flight", "after")
        self._drop()
        self._seconds = perf_counter() - started

    def runs(self) -> Iterator[Run | Exception]:
        """Each shot's run, in order."""
        shots = np.concatenate([shots for shots, _ in self._paths])
        order = np.argsort(shots, kind="stable")
        rows = np.concatenate([columns for _, columns in self._paths], axis=1)[:, order].T
        paths = Paths(rows, np.cumsum(np.bincount(shots, minlength=len(self.setups))).tolist())
        for number in range(len(self.setups)):
            yield self._run(number, paths[number])

    # ------------------------------------------------------------------ forces

    def _acceleration(self, t: np.ndarray, state: State) -> Acceleration:
        for array in (t := t.view(), *state):
            array.flags.writeable = False  # ``vx -= wind`` in a force leaves a float as it was, but not an array
        try:
            ax, ay, alpha = acceleration(self._now.balls[0], t, state)
            every = np.broadcast_to(ax, t.shape), np.broadcast_to(ay, t.shape), np.broadcast_to(alpha, t.shape)
            if any(map(np.iscomplexobj, every)):
                raise TypeError("complex numbers")
        except FAILURES as error:  # such as arrays of the wrong shape
            raise _OnlyFloats from error
        return every

    def _check_forces(self, lanes: np.ndarray, together: np.ndarray) -> None:
        """Raise _OnlyFloats if the accelerations of these lanes, computed with arrays, differ from those computed with
        floats, as if a force mixes up shots. If they are not numbers, the shot run alone reports why."""
        for lane in lanes.tolist():
            ball, now = self.setups[self._shot[lane]].balls[0], tuple(self._state[:, lane].tolist())
            try:
                alone = np.array(acceleration(ball, float(self._t[lane]), now))
                terms = by_cause(ball.forces, float(self._t[lane]), now)
                size = sum(abs(fx) + abs(fy) for _, (fx, fy) in terms) / ball.mass + abs(alone[2])
            except FAILURES as error:
                raise _OnlyFloats from error
            off = np.abs(together[:, lane] - alone)
            if not ((off <= _ROUNDING * size) | np.isnan(off)).all():
                raise _OnlyFloats

    # ------------------------------------------------------------------ one step, or an impact, for each shot

    def _begin(self) -> None:
        count, obstacle, near = self._outlines.near(self._shot, self._state[0], self._state[1])
        away = self._state[2] * near.nx + self._state[3] * near.ny
        plain = (count == 0) | ((count == 1) & (near.gap >= -1e-12) & (away >= -CLOSING))
        self._touched = np.where(count == 1, obstacle, -1)  # surface that was just left, or -1
        self._normal = np.array((near.nx, near.ny, near.curvature))
        self._how[~plain] = "start"
        self._drop()

    def _advance_all(self, watched: int) -> None:
        known = np.array(self._acceleration(self._t, tuple(self._state)))
        self._check_forces(np.array([watched]), known)
        self._after_touches(known)
        known = known[:, self._drop()]
        if not len(self._shot):
            return
        self._touched = np.full(len(self._shot), -1)
        before = tuple(self._state)
        h = np.minimum(np.minimum(self._wanted, LONGEST), self._now.duration - self._t)
        h = before_break(self._now.breaks, self._t, h)
        h = np.where(self._again, self._wanted, within(self._now.patches, h, before, tuple(known)))
        fits, following, after, last = self._control.attempt(
            self._acceleration, self._t, before, tuple(known), h, self._wanted, self._now.balls[0].radius
        )
        self._again = ~fits
        self._counts[STEPS, self._shot] += 1
        self._counts[REFINED, self._shot] += ~fits
        accepted = fits & self._now.bounds.hold(after)
        stuck = ~accepted & (fits | (following < np.maximum(1e-15, 1e-15 * self._t)))
        self._how[stuck] = "flight"  # which raises the error
        self._wanted = np.where(stuck, h, following)
        if accepted.any():
            self._travel(np.flatnonzero(accepted), h, known, np.array(after), np.array(last))
        self._drop()

    # ------------------------------------------------------------------ travelling

    def _travel(
        self, lanes: np.ndarray, h: np.ndarray, acceleration: np.ndarray, after: np.ndarray, last: np.ndarray
    ) -> None:
        """Take the accepted step of these lanes, up to the first touch."""
        shots, h = self._shot[lanes], h[lanes]
        t0, t1 = self._t[lanes], self._t[lanes] + h
        start, after = self._state[:, lanes], after[:, lanes]
        arc = through(t0, h, tuple(start), tuple(acceleration[:, lanes]), tuple(after), tuple(last[:, lanes]))
        rows = np.vstack((t0, t1, start, *map(np.array, arc.curves), after))
        u, looked_at = self._outlines.first_touch(shots, rows[X], rows[Y], lambda i: arc_of(rows[:, i].tolist()))
        self._counts[QUERIES, shots] += looked_at
        hits = np.flatnonzero(t0 + u * h <= t1)
        t1[hits] = t0[hits] + u[hits] * h[hits]
        if len(hits):
            rows[:, hits] = cut(rows[:, hits], t1[hits], u[hits])
        self._paths.append((shots, rows))
        self._t[lanes], self._state[:, lanes] = t1, rows[END]
        how = np.where(t1 >= np.broadcast_to(self._now.duration, self._t.shape)[lanes], "duration", "")
        if isinstance(self._now.until, Until):
            how[(how == "") & self._until(shots).passed(tuple(start), tuple(rows[END]))] = "until"
        how[hits] = ""
        self._how[lanes] = how
        if len(hits):
            self._impact(lanes[hits])

    # ------------------------------------------------------------------ impacts

    def _impact(self, lanes: np.ndarray) -> None:
        """Let pymunk change the velocities of shots that touch a surface."""
        shots = self._shot[lanes]
        x, y, vx, vy, _ = self._state[:, lanes]
        count, obstacle, near = self._outlines.near(shots, x, y)
        approach = -(vx * near.nx + vy * near.ny)
        along = vx * near.ny - vy * near.nx
        plain = (count == 1) & (approach > CLOSING)
        bounces = np.zeros((len(lanes), 4))  # as in Bounce
        for i in np.flatnonzero(plain).tolist():
            setup = self.setups[shots[i]]
            surface, speed = setup.surfaces[obstacle[i]], float(approach[i])
            try:
                bounces[i] = bounce_off(surface, speed, float(along[i]))
            except FAILURES:
                plain[i] = False  # run alone, the shot reports what is wrong with the surface's law
                continue
            t = float(self._t[lanes[i]])
            event = Event(t, "impact", setup.balls[0].name, surface.name, speed, float(x[i]), float(y[i]))
            self._events[shots[i]].append(event)
        self._how[lanes[~plain]] = "before"
        at = np.flatnonzero(plain)
        if len(at):
            here = lanes[at]
            self._counts[IMPACTS, shots[at]] += 1
            nx, ny = near.nx[at], near.ny[at]
            self._exchange(here, *tilted(nx, ny, bounces[at, 2], along[at]), bounces[at])
            self._touched[here] = obstacle[at]
            self._normal = np.zeros((3, len(self._shot)))
            self._normal[:, here] = nx, ny, near.curvature[at]

    def _exchange(self, lanes: np.ndarray, nx: np.ndarray, ny: np.ndarray, bounces: np.ndarray) -> None:
        """Change velocities and spins by impacts on surfaces with these normals."""
        motion, ball = tuple(self._state[2:, lanes]), self._now.balls[0]
        r, factor = (np.broadcast_to(part, self._t.shape)[lanes] for part in (ball.radius, ball.inertia_factor))
        approach, slip, _ = surface_speeds(motion, nx, ny, r)
        push, rub = self._lanes.exchange_all(
            approach, (1.0 + bounces[:, 3]) * slip, np.column_stack((bounces[:, :2], factor))
        )
        self._state[2:, lanes] = after_impulse(motion, nx, ny, r, factor, (push, rub, 0.0))

    def _after_touches(self, acceleration: np.ndarray) -> None:
        """Whether the shots that touch a surface, and do not approach it, continue to fly."""
        at = np.flatnonzero(self._touched >= 0)
        if not len(at):
            return
        state, (nx, ny, curvature) = self._state[:, at], self._normal[:, at]
        pressed = press(tuple(state), tuple(acceleration[:, at]), nx, ny, curvature)
        away = state[2] * nx + state[3] * ny
        lowest = [self.setups[self._shot[lane]].surfaces[self._touched[lane]].lowest_bounce for lane in at.tolist()]
        stays = away <= leaves_at(pressed, np.maximum(self._accuracy.settle, lowest))
        for lane, kept in zip(at.tolist(), stays.tolist(), strict=True):
            shot = self._shot[lane]
            self._how[lane] = "after" if kept else _ending(self.setups[shot], self._events[shot])

    # ------------------------------------------------------------------ leaving the batch

    def _drop(self) -> np.ndarray:
        """Note how shots leave, and keep the others. Returns a mask of these."""
        staying: np.ndarray = self._how == ""
        for lane in np.flatnonzero(~staying).tolist():
            state, how = tuple(self._state[:, lane].tolist()), str(self._how[lane])
            self._left[int(self._shot[lane])] = _Left(float(self._t[lane]), how, state, float(self._wanted[lane]))
        if not staying.all():
            self._shot, self._t, self._state = self._shot[staying], self._t[staying], self._state[:, staying]
            self._wanted, self._again, self._how = self._wanted[staying], self._again[staying], self._how[staying]
            self._touched, self._normal = self._touched[staying], self._normal[:, staying]
            self._now = self._select(self._shot)
        return staying

    def _run(self, number: int, path: ArcRows) -> Run | Exception:
        setup, left, events = self.setups[number], self._left[number], self._events[number]
        steps, refined, impacts, queries = self._counts[:, number].tolist()
        seconds = self._seconds / len(self.setups)
        numerics = Numerics((self._control.evaluations + 1) * steps, steps, refined, impacts, impacts, queries, seconds)
        if left.how in ("until", "duration"):
            arcs = {setup.balls[0].name: path}
            return Run(setup, self._accuracy, arcs, events, numerics, left.t, left.how)
        try:
            with setup_errors_named():
                simulation = Simulation(setup, self._accuracy, numerics)
                if left.how == "start":
                    return simulation.run()
                return simulation.take_over(left.t, left.state, list(path), events, left.wanted, left.how)
        except Exception as error:
            return error
