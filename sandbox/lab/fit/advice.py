"""Advice on which measurement would tell two values apart that a track does not."""

from __future__ import annotations

import numpy as np

from sandbox.lab.fit.flown import flown
from sandbox.lab.fit.intervals import inverse_of
from sandbox.lab.fit.squares import Fit
from sandbox.lab.runs import runs
from sandbox.parameters import value_at
from sandbox.scene.scene_run import SceneRun

#: Points that are imagined after the last one, at most up to so many times its time; and how much better the worse
#: known of two values must become.
_IMAGINED, LONGER, BETTER = 12, 2.0, 2.0

#: The difference of neighbouring runs, as a share of the half width of an interval.
STEP = 0.1


def advice(found: Fit, first: str, second: str) -> str:
    """Say in a few words which more of the track would tell two values apart; "" if none would, or none is known."""
    points = found.measured.points(found.scene, found.free)
    if points is None or np.isnan(points.t).any() or found.free:
        return ""
    last, ball = float(points.t.max()), points.balls[0]
    own = next(runs(found.scene, (), [()]))
    if isinstance(own, Exception) or own.duration <= 1.05 * last:
        return ""
    times = np.linspace(last, min(own.duration, LONGER * last), _IMAGINED + 1)[1:]
    for end in (times[_IMAGINED // 3 - 1], times[-1]):
        if _gain(found, (first, second), ball, times[times <= end]) >= BETTER:
            return f"{_named(own, ball, last, float(end))} would help, up to {end:.3g} s"
    return ""


def _gain(found: Fit, pair: tuple[str, str], ball: str, times: np.ndarray) -> float:
    """The factor by which points at these times would narrow the interval of the worse known of two values."""
    keys = list(found.values)
    middle = np.array([float(value_at(found.scene.parameters, key)) for key in keys])
    half = np.array(list(found.half_widths.values()))
    steps = np.where(half > 0.0, STEP * half, 1e-9)
    moved = flown(found.scene, keys, np.vstack([middle + np.diag(steps), middle - np.diag(steps)]), float(times[-1]))
    if any(run is None for run in moved):
        return 0.0
    places = np.array([
        run.states(ball, np.minimum(times, run.duration))[:, :2].ravel() for run in moved if run is not None
    ])  # fmt: skip
    later = ((places[: len(keys)] - places[len(keys) :]) / (2.0 * steps[:, None])).T
    sds = np.array(list(found.residual_sd.values()))
    before = found.slopes / sds[found.measured.groups][:, None]
    after = np.vstack([before, later / np.tile(sds[:2] if len(sds) > 1 else sds[[0, 0]], len(times))[:, None]])
    errors = [_sds(part) for part in (before, after)]
    places_of = [keys.index(key) for key in pair]
    return float(max(errors[0][place] / max(errors[1][place], 1e-300) for place in places_of))


def _sds(slopes: np.ndarray) -> np.ndarray:
    """Standard errors of the values, for residuals with a standard deviation of 1."""
    return np.asarray(np.sqrt(np.diag(inverse_of(slopes)[0])))


def _named(run: SceneRun, ball: str, start: float, end: float) -> str:
    """Name what happens between two times: ``more of the descent``, ``the path after the impact on floor``."""
    met = next((event for event in run.events if start < event.t < end and event.partner and ball == event.ball), None)
    if met is not None:
        return f"the path after the impact on {met.partner}"
    falls = run.setup.plane is None and run.state(ball, start).vy < 0.0 and run.state(ball, end).vy < 0.0
    return "more of the descent" if falls else "more of the path"
