"""Energy by cause over a run: what the balls have, what was put in, and where the rest has gone."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf

import numpy as np

from sandbox.engine.ledger import Ledger, ledger
from sandbox.engine.model.ball import Ball, Force, kinetic
from sandbox.engine.motion.forces_on_ball import cause
from sandbox.engine.paths.arc import Arc
from sandbox.engine.paths.bernstein import piece
from sandbox.engine.paths.path import Path
from sandbox.engine.paths.run import Run
from sandbox.picture.path import instants

#: The run is cut into so many pieces.
_PIECES = 160

#: Name of the energy that a conservative force stores, with the force's name.
STORED = "stored by "

#: States of a run at which a force is examined.
_STATES = 40


@dataclass(frozen=True)
class Course:
    """Energy in J over time: arrays of the shape of ``times``."""

    times: np.ndarray  # s
    has: dict[str, np.ndarray]  # "height", "speed" and "spin" of all balls; "stored by" each conservative force
    work: dict[str, np.ndarray]  # of each cause until then: positive what it put in, negative what it took

    @property
    def start(self) -> float:
        """All there is at the start, in J."""
        return float(sum(energy[0] for energy in self.has.values()))

    @property
    def taken_by_cause(self) -> dict[str, np.ndarray]:
        """The energy that each cause has taken."""
        return {name: np.maximum(-work, 0.0) for name, work in self.work.items()}

    @property
    def put_in(self) -> dict[str, np.ndarray]:
        """The energy that each cause put in, as wind does; with the start it makes up what is there and was taken."""
        return {name: np.maximum(work, 0.0) for name, work in self.work.items()}


def course(run: Run) -> Course:
    """The energy of a run over time; height counts from the lowest that the balls come to."""
    called, times = _names(run), instants(run, _PIECES)
    gained: dict[str, np.ndarray] = defaultdict(lambda: np.zeros(len(times)))
    for i, (a, b) in enumerate(pairwise([-inf, *times[1:]])):
        part = _piece_of(run, a, float(b))
        for kind in (part.work, part.impacts, part.contacts):
            for name, energy in kind.items():
                gained[called(name)][i + 1] += energy
    catches = {event.ball: event.partner for event in run.events if event.kind == "caught"}
    has = {name: np.zeros(len(times)) for name in ("height", "speed", "spin")}
    for ball in run.setup.balls:
        caught = run.caught_at(ball.name)
        for i, t in enumerate(times):
            x, y, vx, vy, *spins = run.state(ball.name, float(t))
            if run.setup.plane is not None:
                spins += run.rolling_spin(ball.name, float(t))
            if caught is not None and t >= caught:
                gained[called(catches[ball.name])][i] -= kinetic(ball, (x, y, vx, vy, *spins))
                break
            has["speed"][i] += kinetic(ball, (x, y, vx, vy, 0.0), t)
            has["spin"][i] += kinetic(ball, (x, y, 0.0, 0.0, *spins), t)
    sums = {name: np.cumsum(energy) for name, energy in gained.items()}
    fallen = sums.pop("gravity", np.zeros(len(times)))
    has["height"] = fallen.max() - fallen
    for name in sorted(name for name in sums if _gives_back(run, name)):
        given = sums.pop(name)
        has[f"{STORED}{name}"] = given.max() - given
    return Course(times, has, sums)


def _gives_back(run: Run, name: str) -> bool:
    """True if all forces of this name are conservative, as springs are: they depend on the position alone, and have no
    curl. Judged at some states of the run."""
    balls = run.setup.balls
    forces = [(ball, force) for ball in balls for force in ball.forces if cause(force) == name]
    torques = any(cause(torque) == name for ball in balls for torque in ball.torques)
    if not forces or torques:
        return False
    try:
        return all(_is_conservative(force, run, ball) for ball, force in forces)
    except Exception:  # a force that cannot be computed for other states than those of its run
        return False


def _is_conservative(force: Force, run: Run, ball: Ball) -> bool:
    acts = False
    for t in instants(run, _STATES).tolist():
        x, y, vx, vy, spin = run.state(ball.name, t)
        here = force(t, (x, y), (vx, vy), spin)
        if force(0.5 * t + 0.1, (x, y), (1.0 - vy, vx - 2.0), spin + 10.0) != here:
            return False
        d = 1e-4 * ball.radius
        along_x, along_y = (
            [b - a for a, b in zip(force(t, low, (vx, vy), spin), force(t, high, (vx, vy), spin), strict=True)]
            for low, high in (((x - d, y), (x + d, y)), ((x, y - d), (x, y + d)))
        )
        rounding = 1e-12 * max(map(abs, here))
        if abs(along_x[1] - along_y[0]) > 1e-4 * max(map(abs, (*along_x, *along_y))) + rounding:
            return False
        acts = acts or any(here)
    return acts


def _names(run: Run) -> Callable[[str], str]:
    """The name of each cause: two balls are "balls", and surfaces and catches, as pockets, go by their kind where
    there are several of it."""
    balls = {ball.name for ball in run.setup.balls}
    surfaces = {surface.name for surface in run.setup.surfaces} | {catch.name for catch in run.setup.traps}
    kinds = Counter(name.split()[-1] for name in surfaces)

    def called(name: str) -> str:
        if not name:  # a contact of several balls, cut where none of its impacts is
            return "balls"
        kind = name.split()[-1]
        if name in surfaces:
            return f"{kind}s" if kinds[kind] > 1 else name
        return "balls" if set(name.split(" and ")) <= balls else name

    return called


def _piece_of(run: Run, a: float, b: float) -> Ledger:
    """The ledger of what happened after a and until b, in s."""
    arcs = {
        name: Path([_cut(arc, a, b) for arc in path if arc.t0 <= b and (arc.t1 > a or arc is path[-1])])
        for name, path in run.arcs.items()
    }
    return ledger(replace(run, arcs=arcs))


def _cut(arc: Arc, a: float, b: float) -> Arc:
    """The part of an arc between two times; its first instant where it begins at b or ended before a."""
    a, b = max(a, arc.t0), min(b, arc.t1)
    if a == arc.t0 and b == arc.t1:
        return arc
    if b <= a:
        return arc.until(arc.t0)
    h = arc.t1 - arc.t0
    u, v = (a - arc.t0) / h, (b - arc.t0) / h
    return Arc(a, b, arc.state(a), tuple(piece(curve, u, v) for curve in arc.curves), arc.contact)
