"""Options with which a track fits that no run comes near as it was asked for: the launch, the clock and axes of the
film, another gravity, gross errors. They are tried before they are named."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import atan2, ceil, degrees, floor, hypot

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.axes import Span
from sandbox.lab.fit.descent import Place
from sandbox.lab.fit.falling import arcs_of, gravity_hint, other_gravity
from sandbox.lab.fit.frame import frame_of
from sandbox.lab.fit.problem import Problem
from sandbox.lab.fit.search import follow, robust_sds
from sandbox.lab.fit.squares import FarOff
from sandbox.lab.fit.track import Track
from sandbox.parameters import walk
from sandbox.scene import Scene

#: The height of the ball's centre at its start, by how scenes call it.
_HEIGHTS = ("balls[0].y", "release.height")

#: A path is near a track whose points are off by less than this share of their extent, by the median.
_FITS = 0.1

#: A point so many standard deviations off is a gross error.
_GROSS = 10.0

#: A launch is searched within this share of the speed of the first points, and so many deg to both sides of their
#: direction; below so many m/s they have none.
_FASTER, _ASIDE, _SLOW = 0.6, 25.0, 0.5

#: Candidates for what was asked for that are tried with that launch, for each value, and those that are followed.
_TRIED, _FOLLOWED = 16, 2


def explained(error: FarOff, problem: Problem) -> RequestError:
    """The refusal of a track that no run comes near, with what makes it fit, or what may be wrong."""
    scene, measured = problem.scene, problem.measured
    free = [one.start for one in measured.free]
    options = _options(scene, measured, problem.spans) if isinstance(measured, Track) else ""
    hint = gravity_hint(scene, measured, free) or (
        "" if options else "is it of this scene, in m and s from its origin, and are the ranges wide enough?"
    )
    return RequestError(f"{error}: {'; '.join(filter(None, (hint, options)))}")


def _options(scene: Scene, track: Track, spans: Sequence[Span]) -> str:
    """Say with which options a run comes near; "" if none does."""
    points = track.points(scene, [one.start for one in track.free])
    t, (x, y) = points.t, points.positions.T
    arcs = arcs_of(t, y) if len(set(points.balls)) == 1 and (np.diff(t) > 0.0).all() else []
    if not arcs:
        return ""
    known = {one.key for one in walk(scene.parameters, entries=True)}
    given = {span.key for span in spans}
    other = None if "gravity" in given else other_gravity(scene, track, [one.start for one in track.free])
    settings = {} if other is None else {"gravity": float(f"{other[0]:.3g}")}
    height = next((key for key in _HEIGHTS if key in known and key not in given), None)
    if height is not None and len(arcs) > 1:
        settings[height] = round(float(y[0] - y.min()) + scene.build().balls[0].radius, 3)
    launch, added = _launch(t[arcs[0]], x[arcs[0]], y[arcs[0]])
    added = [span for span in added if span.key in known - given]
    had = {one.key.split(".")[1] for one in track.free}
    names = tuple(name for name in ("time", "origin", "tilt") if name in had or name != "tilt")
    changed = scene.changed(settings | {span.key: launch[span.key] for span in added}, "--set")
    problem = Problem(
        changed, replace(track, frame=frame_of(changed, track.where, track.t, track.positions, names)), [*spans, *added]
    )
    place = _nearest(problem, len(spans))
    if place is None:
        return ""
    named = [f"--vary {span.key}={span.low:g}:{span.high:g}" for span in added]
    named += [f"--set {key}={value:g}" for key, value in settings.items()]
    named += ["--free " + ",".join(names)] if had != {*names} else []
    sds = robust_sds(place.residuals, track.groups)
    named += ["--robust"] if (np.abs(place.residuals) > _GROSS * sds).any() else []
    return f"one comes near if you add {' '.join(named)}" if named else ""


def _nearest(problem: Problem, asked: int) -> Place | None:
    """The place that leaves the least, by the median, from starts that differ in the values that were ``asked`` for;
    None if it explains nothing, or a value stopped at an end of its range."""
    rng, count = np.random.default_rng(0), _TRIED * asked
    starts = np.tile(problem.own, (count, 1))
    columns = [(rng.permutation(count) + rng.random(count)) / count for _ in range(asked)]
    starts[1:, :asked] = np.column_stack(columns)[1:]
    costs = np.nan_to_num(np.median(np.abs(problem.residuals(starts)), axis=1), nan=np.inf)
    followed = [follow(problem, starts[best]) for best in np.argsort(costs, kind="stable")[:_FOLLOWED]]
    places = [place for place in followed if place is not None and ((place.share > 0.0) & (place.share < 1.0)).all()]
    place = min(places, key=lambda one: float(np.median(np.abs(one.residuals))), default=None)
    points = problem.measured.points(problem.scene, [one.start for one in problem.measured.free])
    if place is None or points is None:
        return None
    extent = float(np.sqrt(((points.positions - points.positions.mean(axis=0)) ** 2).mean()))
    return place if float(np.median(np.abs(place.residuals))) < _FITS * extent else None


def _launch(t: np.ndarray, x: np.ndarray, y: np.ndarray) -> tuple[dict[str, float], list[Span]]:
    """Speed (m/s) and direction (deg) of the first points of an arc, and ranges around them."""
    since = t - t[0]
    vx, vy = float(np.polyfit(since, x, 1)[0]), float(np.polyfit(since, y, 2)[1])
    speed, angle = hypot(vx, vy), degrees(atan2(vy, vx))
    ends = (-90.0, 90.0) if speed < _SLOW else (floor((angle - _ASIDE) / 5) * 5.0, ceil((angle + _ASIDE) / 5) * 5.0)
    fastest = ceil(10.0 * max((1.0 + _FASTER) * speed, _SLOW)) / 10.0
    slowest = floor(10.0 * (1.0 - _FASTER) * speed) / 10.0 if speed >= _SLOW else 0.0
    found = {"launch.speed": speed, "launch.angle": angle}
    return found, [Span("launch.speed", slowest, fastest), Span("launch.angle", *ends)]
