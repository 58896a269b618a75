"""Energy by cause over a run: what the balls have, what was put in, and where the rest has gone."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from math import inf

import numpy as np

from sandbox.engine.arc import Arc
from sandbox.engine.bernstein import piece
from sandbox.engine.ledger import Ledger, ledger
from sandbox.engine.path import Path
from sandbox.engine.run import Run
from sandbox.engine.setup import kinetic
from sandbox.picture.path import instants

#: The run is cut into so many pieces.
PIECES = 160


@dataclass(frozen=True)
class Course:
    """Energy in J over time: arrays of the shape of ``times``."""

    times: np.ndarray  # s
    has: dict[str, np.ndarray]  # "height", "speed" and "spin" of all balls
    work: dict[str, np.ndarray]  # of each cause until then: positive what it put in, negative what it took

    @property
    def start(self) -> float:
        """All there is at the start, in J."""
        return float(sum(energy[0] for energy in self.has.values()))

    @property
    def taken(self) -> dict[str, np.ndarray]:
        """What each cause has taken."""
        return {name: np.maximum(-work, 0.0) for name, work in self.work.items()}

    @property
    def put_in(self) -> dict[str, np.ndarray]:
        """What each cause has put in, as wind does: with the start it makes up what there is and what was taken."""
        return {name: np.maximum(work, 0.0) for name, work in self.work.items()}


def course(run: Run) -> Course:
    """The energy of a run over time; height counts from the lowest that the balls come to."""
    called, times = _names(run), instants(run, PIECES)
    gained: dict[str, np.ndarray] = defaultdict(lambda: np.zeros(len(times)))
    for i, (a, b) in enumerate(pairwise([-inf, *times[1:]])):
        part = _piece_of(run, a, float(b))
        for kind in (part.work, part.impacts, part.contacts):
            for name, energy in kind.items():
                gained[called(name)][i + 1] += energy
    has = {name: np.zeros(len(times)) for name in ("height", "speed", "spin")}
    for ball in run.setup.balls:
        caught = run.caught_at(ball.name)
        for i, t in enumerate(times):
            x, y, vx, vy, *spins = run.state(ball.name, float(t))
            if run.setup.plane is not None:
                spins += run.rolling_spin(ball.name, float(t))
            if caught is not None and t >= caught:
                gained["pockets"][i] -= kinetic(ball, (x, y, vx, vy, *spins))
                break
            has["speed"][i] += kinetic(ball, (x, y, vx, vy, 0.0), t)
            has["spin"][i] += kinetic(ball, (x, y, 0.0, 0.0, *spins), t)
    sums = {name: np.cumsum(energy) for name, energy in gained.items()}
    fallen = sums.pop("gravity", np.zeros(len(times)))
    has["height"] = fallen.max() - fallen
    return Course(times, has, sums)


def _names(run: Run) -> Callable[[str], str]:
    """What causes are called here: two balls "balls", and surfaces by their kind where there are several of it."""
    balls = {ball.name for ball in run.setup.balls}
    surfaces = {surface.name for surface in run.setup.surfaces}
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
