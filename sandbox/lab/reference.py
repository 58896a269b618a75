"""The converged reference that runs are compared with: by the position of every ball at one time, the end of the run
or, if the scene is chaotic, the last moment before that shows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import hypot

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS, Accuracy
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.tolerances import SKIN
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError
from sandbox.scene import Scene
from sandbox.scene.running import NUDGE, nudged

#: A thousand times finer than the finest level.
REFERENCE = replace(LEVELS["precise"], level="reference", tolerance=1e-3 * LEVELS["precise"].tolerance, settle=1e-14)

#: Step in s, and most steps, of the second reference, computed by another integrator.
_CHECK_STEP, _CHECK_STEPS = 1 / 2000, 60_000

#: Lowest bounce in m of the second reference. The error of ignored bounces grows with the root of their height, so this
#: reference has twice the error.
_CHECK_SETTLE = 4.0 * REFERENCE.settle

#: If a nudge grows to this, in m, the scene is chaotic from then on: a growth of 1e6.
DIVERGED = 1e-3

#: Fraction of the duration at which a run that an event ends is measured, before that event matters.
_BEFORE_THE_END = 0.98

#: Times at which two runs are compared, in addition to those of the events.
_LOOKS = 240


@dataclass(frozen=True)
class Reference:
    """The converged result of a scene."""

    scene: Scene
    time: float  # s, when positions are compared
    points: list[Vector]  # m
    error: float  # m, estimated
    first_touch: float  # s, the first contact of a ball; ``time`` if there is none
    size: float  # m, largest distance of a ball from its start
    growth: float  # how many times as large a nudge of the start is at ``time``
    diverges_at: float | None  # s, when a nudge of 1e-9 m, or the method's own error, has grown to 1 mm; None if never
    closed_form: bool  # whether the motion has a closed form, so that only contacts are computed

    def setup(self) -> Setup:
        """A new setup of the scene, ending at ``time``."""
        return until(self.scene.build(), self.time)

    def error_of(self, run: Run) -> float:
        """Largest position error of a ball of a run, in m."""
        return apart(self.points, places(run, self.time))


def converge(scene: Scene) -> Reference:
    """Compute the reference, and a second one to check it.

    Raises RunError if the scene cannot be run, RequestError if the run ends immediately.
    """
    setup = scene.build()
    first = simulate(setup, REFERENCE)
    if first.duration == 0.0:
        raise RequestError(f"{scene.name}: the run ends immediately; there is nothing to measure")
    whole = _BEFORE_THE_END * first.duration if first.ended == "until" else first.duration
    first = simulate(until(scene.build(), whole), REFERENCE)
    other = simulate(until(nudged(scene.build(), NUDGE, 1), whole), REFERENCE)
    check = simulate(until(scene.build(), whole), _check(whole))
    time, diverges_at = whole, None
    looks = {whole * k / _LOOKS for k in range(_LOOKS + 1)} | {event.t for event in first.events if event.t <= whole}
    for t in sorted(looks):
        here = places(first, t)
        if max(apart(here, places(run, t)) for run in (other, check)) > DIVERGED:
            diverges_at = t
            break
        time = t
    growth = apart(places(first, time), places(other, time)) / NUDGE
    points = places(first, time)
    return Reference(
        scene,
        time,
        points,
        # contacts are found to within SKIN, and that error grows like a nudge
        max(apart(points, places(check, time)), SKIN * max(growth, 1.0)),
        min([time, *(event.t for event in first.events)]),
        _size(first, time),
        growth,
        diverges_at,
        setup.plane is not None and all(map(setup.moves_in_closed_form, setup.balls)),
    )


def apart(a: Sequence[Vector], b: Sequence[Vector]) -> float:
    """The largest distance between corresponding points of both lists, in m."""
    return max((hypot(p[0] - q[0], p[1] - q[1]) for p, q in zip(a, b, strict=True)), default=0.0)


def places(run: Run, t: float) -> list[Vector]:
    """Positions of the balls at time t, in m; after the end of the run where they are then, at rest or caught."""
    at = min(t, run.duration)
    return [(state[0], state[1]) for state in (run.state(ball.name, at) for ball in run.setup.balls)]


def until(setup: Setup, time: float) -> Setup:
    """The same setup, ending only at ``time`` (s)."""
    return replace(setup, duration=time, until=None)


def _check(time: float) -> Accuracy:
    step = max(_CHECK_STEP, time / _CHECK_STEPS)
    return replace(REFERENCE.finer(), level="check", integrator="rk4", step=step, settle=_CHECK_SETTLE)


def _size(run: Run, time: float) -> float:
    starts = {ball.name: run.state(ball.name, 0.0) for ball in run.setup.balls}
    ends = ((name, run.state(name, min(arc.t1, time))) for name in starts for arc in run.arcs[name])
    return max((hypot(x - starts[name][0], y - starts[name][1]) for name, (x, y, *_) in ends), default=0.0)
