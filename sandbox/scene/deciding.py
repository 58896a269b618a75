"""The time at which the run of a scene is decided: its events are known, also those to come."""

from __future__ import annotations

import numpy as np

from sandbox.engine.model.setup import Touches
from sandbox.scene.scene_run import SceneRun

#: States are looked at so often, in s, and among so many events the one that decides is looked for.
_STEP, _MOST = 1 / 60, 100


def decided_at(run: SceneRun, ball: str) -> float:
    """The time in s at which a run is decided: when its verdict is known. Where that is not known before the end it is
    with the last ball that the one that is played meets, or the last impact."""
    known = known_before_end(run, ball)
    if known is not None:
        return known
    met = [event for event in run.events if event.kind == "impact" and ball in (event.ball, event.partner)]
    balls = {each.name for each in run.setup.balls}
    among = [event for event in met if {event.ball, event.partner} <= balls]
    return max([event.t for event in among or met], default=run.duration)


def known_before_end(run: SceneRun, ball: str) -> float | None:
    """The time in s at which the fact that a shot scored is final, or else a trap, such as a pocket or a cup, takes the
    last body; None if neither happens."""
    scene = run.scene
    fact = scene.facts.get(scene.controls.scores)
    final = fact.final_when if fact is not None else "end"
    found = []
    if final not in ("start", "end"):
        condition = Touches(final) if isinstance(final, str) else final(scene.parameters)
        times = np.linspace(0.0, run.duration, max(2, round(run.duration / _STEP)))
        states = [tuple(state) for state in run.states(ball, times)]
        found += [t for t, a, b in zip(times[1:], states, states[1:], strict=False) if condition.passed(a, b)][:1]
        found += [e.t for i, e in enumerate(run.events[:_MOST], 1) if condition.over(run.events[:i])][:1]
    if found:
        return float(min(found))
    return max((event.t for event in run.events if event.kind == "caught"), default=None)
