"""Many shots at once: flights and distances in arrays over the shots, impacts by pymunk.

The shots of a batch are alike: one ball, the same kinds of forces and surfaces, other numbers. Each keeps its own time
and its own steps, and goes the way that simulation.py would lead it. What is rare there (lasting contact, two surfaces
at once, a state that makes no sense) is left to it: it takes the shot over from where it is.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from time import perf_counter
from typing import NamedTuple

import numpy as np

from sandbox.engine import flies_in_batches, simulate
from sandbox.engine.accuracy import Accuracy
from sandbox.engine.arc import Arc, through
from sandbox.engine.arc_rows import COLUMNS, ArcRows
from sandbox.engine.bernstein_many import until
from sandbox.engine.blame import blamed
from sandbox.engine.event import Event
from sandbox.engine.impacts import STILL
from sandbox.engine.lanes import Lanes
from sandbox.engine.lasting import leaves_at
from sandbox.engine.motion import FIRST_STEP, LOCAL_SHARE, LONGEST, SPIN_WEIGHT
from sandbox.engine.outlines import Outlines
from sandbox.engine.run import Numerics, Run
from sandbox.engine.setup import Bounce, Setup, Surface, possible
from sandbox.engine.simulation import Simulation
from sandbox.engine.stacking import Alike, chosen, stacked
from sandbox.physics.integrators import INTEGRATORS, Acceleration, State

#: Fewer shots than this are quicker one at a time: a round of arrays costs as much as some thirty steps.
_FEWEST = 24

#: Rows of the counts.
STEPS, REFINED, IMPACTS, QUERIES = range(4)

#: Pieces of path in a batch, 300 bytes each, beyond which its shots go on one at a time, where no run goes on for ever.
_MOST_PIECES = 500_000

#: Share of a ball's forces by which arrays and floats may differ, beyond which they are not the same forces.
_ROUNDING = 1e-9


def simulate_many(setups: Sequence[Setup], accuracy: Accuracy) -> Iterator[Run | Exception]:
    """A run of each setup, in order, or the exception that it ended in.

    As ``simulate`` one by one, to rounding; much quicker for setups that are alike. Forces are called with arrays,
    shape (n,), for time, position, velocity and spin; where one cannot take them, its shots run one at a time.
    """
    groups: dict[Hashable, list[int]] = {}
    alike = Alike()
    for number, setup in enumerate(setups):
        if flies_in_batches(setup, accuracy):
            groups.setdefault(_kind(setup, alike), []).append(number)
    batch_of: dict[int, Iterator[Run | Exception]] = {}
    for members in groups.values():
        if len(members) >= _FEWEST:
            batch = _Batch([setups[member] for member in members], accuracy)
            try:
                batch.fly()
            except _OnlyFloats:
                continue  # one at a time they run, or say themselves what is wrong
            batch_of |= dict.fromkeys(members, batch.runs())
    for number, setup in enumerate(setups):
        yield next(batch_of[number]) if number in batch_of else _one(setup, accuracy)


def _one(setup: Setup, accuracy: Accuracy) -> Run | Exception:
    try:
        return simulate(setup, accuracy)
    except Exception as error:
        return error


def _kind(setup: Setup, alike: Alike) -> Hashable:
    """What setups of one batch have in common: they differ in numbers only, and in their laws of impacts."""
    ball = setup.balls[0]
    shapes = tuple((type(surface.shape), surface.name) for surface in setup.surfaces)
    return ball.name, shapes, len(setup.patches), alike.key((tuple(ball.forces), tuple(ball.torques)))


def _answer(surface: Surface, approach: float, along: float) -> Bounce | None:
    """Restitution, friction and tilt; None where the surface's law fails, which its shot alone then says."""
    if surface.law is None:
        return Bounce(surface.restitution, surface.friction)
    try:
        return possible(surface.law(approach, abs(along)), surface.name)
    except FAILURES:
        return None


def _over(setup: Setup, event: Event) -> str:
    """ "until" where this event ends the run, "" where not; "after" where that cannot be told, which its shot alone
    then says."""
    try:
        return "until" if setup.until is not None and setup.until(event) else ""
    except FAILURES:
        return "after"


#: What a scene's own function may end in.
FAILURES = (Exception, SystemExit)


class _OnlyFloats(Exception):
    """Forces that cannot take arrays, or answer otherwise than with floats."""


class _Left(NamedTuple):
    """How a shot left the batch: at its end (``how`` is "until" or "duration"), or to be taken over."""

    t: float  # s
    how: str
    state: State
    wanted: float  # s, the next step


class _Batch:
    """Shots that fly together. Arrays have one entry for each shot still in flight, or rows of them."""

    def __init__(self, setups: Sequence[Setup], accuracy: Accuracy) -> None:
        self._setups = setups
        self._accuracy = accuracy
        self._local_error = accuracy.tolerance * LOCAL_SHARE
        self._step = INTEGRATORS[accuracy.integrator].step
        balls = [setup.balls[0] for setup in setups]
        self._stack = stacked([(tuple(ball.forces), tuple(ball.torques)) for ball in balls])
        self._outlines = Outlines(setups, accuracy.skin)
        self._lanes = Lanes()
        self._events: list[list[Event]] = [[] for _ in setups]
        self._left: dict[int, _Left] = {}
        nothing = (np.zeros(0, dtype=int), np.zeros((COLUMNS, 0)))
        self._paths = [nothing]  # of each round: shots, and the rows of their arcs as columns

        # of all shots
        self._mass = np.array([ball.mass for ball in balls])
        self._radius = np.array([ball.radius for ball in balls])
        self._factor = np.array([ball.inertia_factor for ball in balls])
        self._duration = np.array([setup.duration for setup in setups])
        self._bounds = np.array([setup.bounds for setup in setups]).T
        patches = [[tuple(patch) for patch in setup.patches] for setup in setups]
        self._patches = np.array(patches).reshape(len(setups), -1, 5).transpose(1, 2, 0)  # (patches, 5, shots)

        self._counts = np.zeros((4, len(setups)), dtype=int)  # steps, refined steps, impacts, queries

        # of those in flight
        self._shot = np.arange(len(setups))
        self._t = np.zeros(len(setups))
        self._state = np.array([(*ball.position, *ball.velocity, ball.spin) for ball in balls], dtype=float).T
        self._wanted = np.full(len(setups), FIRST_STEP)  # s, the next step
        self._again = np.zeros(len(setups), dtype=bool)  # a step that was too long is tried again
        self._gather()

    def fly(self) -> None:
        """All of them, to the end, or as far as they go here."""
        started = perf_counter()
        with np.errstate(all="ignore"):
            self._check_forces(self._shot, self._now())
            self._begin()
            rounds = pieces = 0
            while len(self._shot) >= _FEWEST and pieces < _MOST_PIECES:
                self._round(rounds % len(self._shot))
                rounds += 1
                pieces += len(self._paths[-1][0])
        for lane in range(len(self._shot)):
            self._leave(lane, "flight" if self._touched[lane] < 0 else "after")
        self._seconds = perf_counter() - started

    def runs(self) -> Iterator[Run | Exception]:
        """Each shot's run, in order."""
        shots = np.concatenate([shots for shots, _ in self._paths])
        order = np.argsort(shots, kind="stable")
        rows = np.ascontiguousarray(np.concatenate([columns for _, columns in self._paths], axis=1)[:, order].T)
        ends = np.cumsum(np.bincount(shots, minlength=len(self._setups)))
        for number, path in enumerate(np.split(rows, ends[:-1])):
            yield self._run(number, path)

    # ------------------------------------------------------------------ forces

    def _gather(self) -> None:
        """What belongs to the shots in flight."""
        self._forces, self._torques = chosen(self._stack, self._shot)
        self._m = self._mass[self._shot]
        self._inertia = self._factor[self._shot] * self._m * self._radius[self._shot] ** 2

    def _acceleration(self, t: np.ndarray, state: State) -> Acceleration:
        x, y, vx, vy, spin = state
        for array in (t := t.view(), *state):
            array.flags.writeable = False  # ``vx -= wind`` in a force leaves a float as it was, but not an array
        fx = fy = torque = np.zeros(len(t))
        try:
            for force in self._forces:
                px, py = force(t, (x, y), (vx, vy), spin)
                fx = fx + px
                fy = fy + py
            for turn in self._torques:
                torque = torque + turn(t, (x, y), (vx, vy), spin)
        except FAILURES as error:
            raise _OnlyFloats from error
        if any(np.iscomplexobj(value) for value in (fx, fy, torque)):
            raise _OnlyFloats
        return fx / self._m, fy / self._m, torque / self._inertia

    def _now(self) -> np.ndarray:
        """Accelerations as rows of an array."""
        try:
            return np.array(self._acceleration(self._t, tuple(self._state))).reshape(3, len(self._t))
        except ValueError as error:
            raise _OnlyFloats from error  # forces of another shape

    def _check_forces(self, lanes: np.ndarray, together: np.ndarray) -> None:
        """Whether arrays, by which these lanes have these accelerations, give what floats give; not so where a force
        mixes shots up. Where they give no numbers the shot alone says why."""
        alone, sizes = [], []
        for lane in lanes.tolist():
            ball = self._setups[self._shot[lane]].balls[0]
            x, y, vx, vy, spin = self._state[:, lane].tolist()
            now = (float(self._t[lane]), (x, y), (vx, vy), spin)
            try:
                forces = [force(*now) for force in ball.forces]
                torques = [torque(*now) for torque in ball.torques]
                ax, ay = sum(fx for fx, _ in forces) / ball.mass, sum(fy for _, fy in forces) / ball.mass
                alone.append(tuple(map(float, (ax, ay, sum(torques) / ball.inertia))))
                size = sum(abs(fx) + abs(fy) for fx, fy in forces) / ball.mass
                sizes.append(max(size, sum(map(abs, torques)) / ball.inertia))
            except FAILURES as error:
                raise _OnlyFloats from error
        agree = np.abs(together - np.array(alone).T) <= _ROUNDING * np.array(sizes)
        if not (agree | np.isnan(together)).all():
            raise _OnlyFloats

    # ------------------------------------------------------------------ a round: one step, or an impact, for each

    def _begin(self) -> None:
        near = self._outlines.near(self._shot, self._state[0], self._state[1])
        away = self._state[2] * near.nx + self._state[3] * near.ny
        plain = (near.touching == 0) | ((near.touching == 1) & (near.gap >= -1e-12) & (away >= -STILL))
        self._touched = np.where(near.touching == 1, near.obstacle, -1)  # surface that was just left, or -1
        self._normal = np.array((near.nx, near.ny, near.curvature))
        self._go_on_with(plain)

    def _round(self, watched: int) -> None:
        acceleration = self._now()
        self._check_forces(np.array([watched]), acceleration[:, [watched]])
        flying = self._leaving(acceleration)
        if not flying.all():
            acceleration = acceleration[:, flying]
            self._go_on_with(flying)
            if not len(self._shot):
                return
        self._touched = np.full(len(self._shot), -1)
        h = np.minimum(np.minimum(self._wanted, LONGEST), self._duration[self._shot] - self._t)
        h = np.where(self._again, self._wanted, self._halved_for_patches(h, acceleration))
        found = self._step(self._acceleration, self._t, tuple(self._state), tuple(acceleration), h)
        after, last, error = map(np.array, found)
        fits = self._judge(h, error)
        accepted = np.flatnonzero(fits & self._makes_sense(after))
        staying = ~fits & (self._wanted >= np.maximum(1e-15, 1e-15 * self._t))
        staying[accepted] = True
        self._wanted = np.where(staying, self._wanted, h)
        for lane in np.flatnonzero(~staying).tolist():
            self._leave(lane, "flight")  # which says what is wrong
        if len(accepted):
            staying[accepted[self._travel(accepted, h, acceleration, after, last)]] = False
        if not staying.all():
            self._go_on_with(staying)

    def _judge(self, h: np.ndarray, error: np.ndarray) -> np.ndarray:
        """Whether steps of length h are good enough; how long the next shall be, or the same again."""
        off = np.abs(error[:4]).sum(axis=0) + SPIN_WEIGHT * self._radius[self._shot] * np.abs(error[4])
        fits = off <= self._local_error
        change = 0.9 * (self._local_error / off) ** 0.2
        longer = h * np.where(off > 0.0, np.minimum(5.0, change), 5.0)
        shorter = h * np.where(np.isfinite(off), np.maximum(0.2, change), 0.1)
        longer = np.where(h >= self._wanted, longer, np.maximum(longer, self._wanted))
        self._wanted = np.where(fits, longer, shorter)
        self._again = ~fits
        self._counts[STEPS, self._shot] += 1
        self._counts[REFINED, self._shot] += ~fits
        return fits

    def _halved_for_patches(self, h: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
        x, y, vx, vy, _ = self._state
        ax, ay, _ = acceleration
        for patch in self._patches:
            left, bottom, right, top, step = patch[:, self._shot]
            while True:
                half = 0.5 * h
                xs, ys = (x, x + half * vx, x + h * (vx + half * ax)), (y, y + half * vy, y + h * (vy + half * ay))
                crossed = (np.minimum.reduce(xs) <= right) & (np.maximum.reduce(xs) >= left)
                crossed &= (np.minimum.reduce(ys) <= top) & (np.maximum.reduce(ys) >= bottom)
                crossed &= h > step
                if not crossed.any():
                    break
                h = np.where(crossed, np.maximum(half, step), h)
        return h

    def _makes_sense(self, state: np.ndarray) -> np.ndarray:
        left, bottom, right, top = self._bounds[:, self._shot]
        x, y = state[:2]
        return np.isfinite(state).all(axis=0) & (left <= x) & (x <= right) & (bottom <= y) & (y <= top)

    # ------------------------------------------------------------------ travelling

    def _travel(
        self, lanes: np.ndarray, h: np.ndarray, acceleration: np.ndarray, after: np.ndarray, last: np.ndarray
    ) -> np.ndarray:
        """Go the accepted step of these lanes, as far as the first touch; which of them leave the batch, as a mask."""
        shots, h = self._shot[lanes], h[lanes]
        t0, t1 = self._t[lanes], self._t[lanes] + h
        start, after = self._state[:, lanes], after[:, lanes]
        curves = through(t0, h, tuple(start), tuple(acceleration[:, lanes]), tuple(after), tuple(last[:, lanes]))
        x, y = np.array(curves.x), np.array(curves.y)
        velocity, spin = np.array((curves.vx, curves.vy)).transpose(1, 0, 2), np.array(curves.spin)

        def arc(i: int) -> Arc:
            return Arc(
                float(t0[i]),
                float(t1[i]),
                tuple(start[:, i].tolist()),
                x[:, i].tolist(),
                y[:, i].tolist(),
                velocity[:, 0, i].tolist(),
                velocity[:, 1, i].tolist(),
                spin[:, i].tolist(),
                end=tuple(after[:, i].tolist()),
            )

        u, looked_at = self._outlines.first_touch(shots, x, y, arc)
        self._counts[QUERIES, shots] += looked_at
        hits = np.flatnonzero(t0 + u * h <= t1)
        touch = u[hits]
        t1[hits] = t0[hits] + touch * h[hits]
        x[:, hits], y[:, hits] = until(x[:, hits], touch), until(y[:, hits], touch)
        velocity[:, :, hits], spin[:, hits] = until(velocity[:, :, hits], touch), until(spin[:, hits], touch)
        after[:, hits] = x[-1, hits], y[-1, hits], *velocity[-1][:, hits], spin[-1, hits]
        rows = np.vstack((t0, t1, start, x, y, velocity[:, 0], velocity[:, 1], spin, after))
        self._paths.append((shots, rows))
        self._t[lanes], self._state[:, lanes] = t1, after
        leaving = t1 >= self._duration[shots]
        leaving[hits] = False
        for lane in lanes[leaving].tolist():
            self._leave(lane, "duration")
        if len(hits):
            leaving[hits[~self._impact(lanes[hits])]] = True
        return leaving

    # ------------------------------------------------------------------ impacts

    def _impact(self, lanes: np.ndarray) -> np.ndarray:
        """Let pymunk turn the velocities of shots that have come to touch; which of them stay in the batch."""
        shots = self._shot[lanes]
        x, y, vx, vy, spin = self._state[:, lanes]
        near = self._outlines.near(shots, x, y)
        approach = -(vx * near.nx + vy * near.ny)
        along = vx * near.ny - vy * near.nx
        plain = (near.touching == 1) & (approach > STILL)
        answers = np.zeros((len(lanes), 3))  # restitution, friction, tilt
        for i in np.flatnonzero(plain).tolist():
            setup = self._setups[shots[i]]
            surface, speed = setup.surfaces[near.obstacle[i]], float(approach[i])
            answer = _answer(surface, speed, float(along[i]))
            if answer is None:
                plain[i] = False
                continue
            answers[i] = answer
            t = float(self._t[lanes[i]])
            event = Event(t, "impact", setup.balls[0].name, surface.name, speed, float(x[i]), float(y[i]))
            self._events[shots[i]].append(event)
        for lane in lanes[~plain].tolist():
            self._leave(lane, "before")
        at = np.flatnonzero(plain)
        if len(at):
            here = lanes[at]
            self._counts[IMPACTS, shots[at]] += 1
            nx, ny = near.nx[at], near.ny[at]
            self._state[2:, here] = self._exchanged(shots[at], nx, ny, vx[at], vy[at], spin[at], answers[at])
            self._touched[here] = near.obstacle[at]
            self._normal = np.zeros((3, len(self._shot)))
            self._normal[:, here] = nx, ny, near.curvature[at]
        return plain

    def _exchanged(
        self,
        shots: np.ndarray,
        nx: np.ndarray,
        ny: np.ndarray,
        vx: np.ndarray,
        vy: np.ndarray,
        spin: np.ndarray,
        answers: np.ndarray,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Velocities (m/s) and spins (rad/s) after impacts on surfaces with these normals."""
        restitution, friction, tilt = answers.T
        tilt = np.where(vx * ny - vy * nx >= 0.0, tilt, -tilt)
        c, s, r = np.cos(tilt), np.sin(tilt), self._radius[shots]
        nx, ny = c * nx - s * ny, c * ny + s * nx
        pairs = np.array((restitution, friction, self._factor[shots])).T
        level, up, spin = self._lanes.exchange((vx * ny - vy * nx) / r, (vx * nx + vy * ny) / r, spin, pairs)
        return r * (level * ny + up * nx), r * (up * ny - level * nx), spin

    def _leaving(self, acceleration: np.ndarray) -> np.ndarray:
        """Of the shots that touch a surface and do not close in on it: which fly on. The others leave the batch."""
        flying = np.ones(len(self._shot), dtype=bool)
        at = np.flatnonzero(self._touched >= 0)
        if not len(at):
            return flying
        _, _, vx, vy, _ = self._state[:, at]
        nx, ny, curvature = self._normal[:, at]
        along = vx * ny - vy * nx
        press = -(acceleration[0][at] * nx + acceleration[1][at] * ny) - curvature * along * along
        away = vx * nx + vy * ny
        for lane, pressed, speed in zip(at.tolist(), press.tolist(), away.tolist(), strict=True):
            shot = self._shot[lane]
            setup = self._setups[shot]
            lowest = setup.surfaces[self._touched[lane]].lowest_bounce
            if speed <= leaves_at(pressed, max(self._accuracy.settle, lowest)):
                self._leave(lane, "after")
                flying[lane] = False
            elif self._events[shot] and (how := _over(setup, self._events[shot][-1])):
                self._leave(lane, how)
                flying[lane] = False
        return flying

    # ------------------------------------------------------------------ leaving the batch

    def _go_on_with(self, staying: np.ndarray) -> None:
        self._shot, self._t, self._state = self._shot[staying], self._t[staying], self._state[:, staying]
        self._wanted, self._again = self._wanted[staying], self._again[staying]
        self._touched = self._touched[staying]
        self._normal = self._normal[:, staying]
        if len(self._shot):
            self._gather()

    def _leave(self, lane: int, how: str) -> None:
        state = tuple(self._state[:, lane].tolist())
        self._left[int(self._shot[lane])] = _Left(float(self._t[lane]), how, state, float(self._wanted[lane]))

    def _run(self, number: int, rows: np.ndarray) -> Run | Exception:
        setup = self._setups[number]
        if number not in self._left:  # not even begun
            return _one(setup, self._accuracy)
        steps, refined, impacts, queries = self._counts[:, number].tolist()
        seconds = self._seconds / len(self._setups)
        numerics = Numerics(7 * steps, steps, refined, impacts, 2 * impacts, queries, seconds)
        left, events = self._left[number], self._events[number]
        if left.how in ("until", "duration"):
            arcs = {setup.balls[0].name: ArcRows(rows)}
            return Run(setup, self._accuracy, arcs, events, numerics, left.t, left.how)
        try:
            with blamed(setup):
                simulation = Simulation(setup, self._accuracy, numerics)
                return simulation.take_over(left.t, left.state, list(ArcRows(rows)), events, left.wanted, left.how)
        except Exception as error:
            return error
