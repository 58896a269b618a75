"""Speed against accuracy, measured on this machine: every method over its steps or tolerances, and the three levels."""

from __future__ import annotations

import gc
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from math import isfinite
from time import perf_counter
from typing import Any

from sandbox.engine import simulate
from sandbox.engine.accuracy import LEVELS, Accuracy, settle_for
from sandbox.errors import RunError
from sandbox.lab.ablation import Ablated, ablation
from sandbox.lab.ablation import as_text as ablation_text
from sandbox.lab.reference import Reference, converge
from sandbox.lab.tables import length, length_above, paragraph, significant, table, time
from sandbox.lab.verdicts import ShotMap, shot_map
from sandbox.physics.integrators import INTEGRATORS
from sandbox.scene import Scene

#: Steps of the fixed-step methods, in 1/s, from the longest to the shortest.
RATES = (2, 5, 10, 20, 60, 240, 1000, 4000, 16_000, 64_000)

#: Tolerances of the method with error control, in m.
TOLERANCES = (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)

#: Errors in m for which the cheapest setting is reported.
TARGETS = (0.1, 0.01, 0.001, 0.0001)

#: A finer setting is left out if it would take longer than this, in s.
_LONGEST = 1.0

#: Growth of a nudge until the measure, above which a large error does not imply an unstable method.
_CHAOTIC = 1e3

#: Relative variation of the time of the same run.
_NOISE = 0.1

#: Time in s to spend on the repeats of one setting, and the most repeats.
_PATIENCE, _REPEATS = 0.1, 15

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class Point:
    """One method at one setting. ``error_m`` is None if the run failed; ``problem`` says why."""

    method: str
    setting: str
    accuracy: Accuracy
    error_m: float | None
    wall_s: float  # shortest of the repeats
    repeats: int
    force_evaluations: int
    times_real_time: float
    stable: bool
    problem: str = ""


@dataclass(frozen=True)
class Trade:
    """The measurements of ``sandbox trade`` for a scene."""

    reference: Reference
    points: list[Point]
    levels: dict[str, Point]
    ablation: list[Ablated] = field(default_factory=list)
    verdicts: ShotMap | None = None

    def best(self, target: float) -> Point | None:
        """The cheapest setting with an error of at most ``target`` m.

        Times that differ by less than the noise count as equal; then the fewest force evaluations win.
        """
        good = [point for point in self.points if point.error_m is not None and point.error_m <= target]
        least = min((point.wall_s for point in good), default=0.0)
        alike = [point for point in good if point.wall_s <= (1.0 + _NOISE) * least]
        return min(alike, key=lambda point: point.force_evaluations, default=None)

    def behind_front(self, level: str) -> float | None:
        """Time of a level relative to the cheapest setting that is as accurate; 1 on the Pareto front."""
        own = self.levels[level]
        if own.error_m is None:
            return None
        best = self.best(own.error_m)
        return 1.0 if best is None else max(1.0, own.wall_s / best.wall_s)


def trade(scene: Scene, progress: Progress = lambda done, total: None) -> Trade:
    """Measure a scene. Raises RunError if it cannot be run."""
    reference = converge(scene)
    measured = list(_measured(reference, progress))
    points = [point for point in measured if point.method != "level"]
    levels = {point.setting: point for point in measured if point.method == "level"}
    return Trade(reference, points, levels, ablation(reference), shot_map(scene))


def settings(reference: Reference) -> Iterator[tuple[str, str, Accuracy]]:
    """Method, setting and accuracy, from coarse to fine for each method; the levels last."""
    plain = replace(LEVELS["balanced"], method="plain")
    for rate in RATES:
        yield "plain", f"1/{rate} s", replace(plain, step=1 / rate)
    exact = LEVELS["precise"]
    if reference.closed_form:  # no integrator is involved
        yield "closed form", "", exact
    else:
        for name, integrator in INTEGRATORS.items():
            if integrator.controls_error:
                for tolerance in TOLERANCES:
                    how = replace(exact, integrator=name, tolerance=tolerance, settle=settle_for(tolerance))
                    yield name, f"{tolerance:g} m", how
            else:
                for rate in RATES:
                    yield name, f"1/{rate} s", replace(exact, integrator=name, step=1 / rate)
    for name, level in LEVELS.items():
        yield "level", name, level


class _Trial:
    """One setting and the results of its runs so far."""

    def __init__(self, reference: Reference, method: str, setting: str, accuracy: Accuracy) -> None:
        self.method = method
        self.setting = setting
        self.accuracy = accuracy
        self.walls: list[float] = []
        self.error: float | None = None
        self.evaluations = 0
        self.problem = ""
        self._reference = reference

    def run(self) -> None:
        setup = self._reference.setup()
        started = perf_counter()
        try:
            run = simulate(setup, self.accuracy)
        except RunError as error:
            self.problem = str(error)
            return
        finally:
            self.walls.append(perf_counter() - started)
        if not self.evaluations:
            self.error = self._reference.error_of(run)
            self.evaluations = run.numerics.force_evaluations

    def _why_far_off(self) -> str:
        far, growth = "error larger than the length of the shot", self._reference.growth
        if growth < _CHAOTIC:
            return f"unstable: {far}"
        return f"{far}, where small errors grow {significant(growth)} times"

    @property
    def wants_more(self) -> bool:
        return not self.problem and sum(self.walls) < _PATIENCE and len(self.walls) < _REPEATS

    def point(self) -> Point:
        wall, error = min(self.walls), self.error
        stable = error is not None and isfinite(error) and error < max(self._reference.size, 1e-9)
        problem = self.problem or ("" if stable else self._why_far_off())
        return Point(
            self.method,
            self.setting,
            self.accuracy,
            error,
            wall,
            len(self.walls),
            self.evaluations,
            self._reference.time / wall,
            stable,
            problem,
        )


def _measured(reference: Reference, progress: Progress) -> Iterator[Point]:
    wanted = list(settings(reference))
    trials: list[_Trial] = []
    for done, (method, setting, accuracy) in enumerate(wanted):
        progress(done, 2 * len(wanted))
        before = trials[-1] if trials and trials[-1].method == method else None
        if before is not None and _expected(before, accuracy) > _LONGEST:
            continue
        trial = _Trial(reference, method, setting, accuracy)
        trial.run()
        trials.append(trial)
    for turn in range(1, _REPEATS):  # interleaved, so that other load affects all settings equally
        progress(len(wanted) * (_REPEATS + turn) // _REPEATS, 2 * len(wanted))
        gc.collect()
        gc.disable()
        try:
            for trial in trials:
                if trial.wants_more:
                    trial.run()
        finally:
            gc.enable()
    yield from (trial.point() for trial in trials)


def _expected(before: _Trial, accuracy: Accuracy) -> float:
    """Expected seconds of a setting, from the previous one and the ratio of the steps."""
    return before.walls[0] * max(1.0, before.accuracy.step / accuracy.step)


# --------------------------------------------------------------------------------------------------------------- report


def as_dict(found: Trade) -> dict[str, Any]:
    """For JSON."""
    reference = found.reference
    return {
        "scene": reference.scene.name,
        "preset": reference.scene.preset,
        "reference": {
            "time_s": reference.time,
            "points_m": reference.points,
            "error_m": reference.error,
            "exact_error_m": reference.exact_error,
            "growth": reference.growth,
            "diverges_at_s": reference.diverges_at,
        },
        "points": [_point(point) for point in found.points],
        "best": {f"{target:g}": _named(found.best(target)) for target in TARGETS},
        "levels": {
            name: {**_point(point), "times_front": found.behind_front(name)} for name, point in found.levels.items()
        },
        "ablation": [row.as_dict() for row in found.ablation],
        "verdicts": None if found.verdicts is None else found.verdicts.as_dict(),
    }


def _point(point: Point) -> dict[str, Any]:
    return {
        "method": point.accuracy.method if point.method == "level" else point.method,
        "setting": point.setting,
        "error_m": point.error_m,
        "wall_s": point.wall_s,
        "repeats": point.repeats,
        "force_evaluations": point.force_evaluations,
        "times_real_time": point.times_real_time,
        "stable": point.stable,
        "problem": point.problem,
    }


def _named(point: Point | None) -> dict[str, Any] | None:
    return None if point is None else _point(point)


def as_text(found: Trade) -> list[str]:
    """For people."""
    lines = [*_about(found.reference), ""]
    headings = ("method", "setting", "error", "time", "x real time", "forces")
    least = found.reference.error
    lines += table(headings, [_row(point, least) for point in found.points], "llrrrr")
    lines += _problems(found.points)
    lines += ["", "levels"]
    rows = []
    for name, point in found.levels.items():
        behind = found.behind_front(name)
        aim = length(point.accuracy.tolerance)
        place = "" if behind is None else significant(behind)
        error = length_above(point.error_m, least)
        rows.append((name, aim, error, time(point.wall_s), significant(point.times_real_time), place))
    lines += table(("level", "target", "error", "time", "x real time", "x cheapest as accurate"), rows, "lrrrrr")
    lines += ["", "cheapest choice"]
    choices = [(target, best) for target in TARGETS if (best := found.best(target)) is not None]
    cells = [
        (length(target), f"{best.method} {best.setting}", length_above(best.error_m, least), time(best.wall_s))
        for target, best in choices
    ]
    lines += table(("for", "method", "error", "time"), cells, "llrr")
    if found.ablation:
        lines += ["", *ablation_text(found.ablation, found.reference.time)]
    if found.verdicts is not None:
        lines += ["", *found.verdicts.as_text()]
    return lines


def _about(reference: Reference) -> list[str]:
    scene = reference.scene
    how = (
        "contacts are computed, the rest is in closed form"
        if reference.closed_form
        else "checked with another integrator"
    )
    many = "every ball" if len(reference.points) > 1 else "the ball"
    lines = [
        f"{scene.name}/{scene.preset}" if scene.preset else scene.name,
        f"  measure    position of {many} after {reference.time:.4g} s",
        f"  reference  error {length(reference.error)}, {how}",
    ]
    if scene.measure is not None:
        lines[1] = "  measure    the scene's own"
    if reference.exact_error is not None:
        lines.append(
            f"  exact      the reference is off the parabola by {length(reference.exact_error)} at first contact"
        )
    growth = f"a nudge at the start grows {significant(reference.growth)} times until then"
    if reference.diverges_at is not None:
        growth = f"chaotic: a nudge of 1e-9 has grown to 1 mm after {reference.diverges_at:.4g} s"
    return [*lines, f"  growth     {growth}"]


def _row(point: Point, least: float) -> tuple[str, ...]:
    return (
        point.method,
        point.setting,
        length_above(point.error_m, least),
        time(point.wall_s),
        significant(point.times_real_time),
        str(point.force_evaluations),
    )


def _problems(points: Sequence[Point]) -> Iterator[str]:
    """Each problem once, with its methods and settings."""
    for problem in dict.fromkeys(point.problem for point in points if point.problem):
        settings: dict[str, list[str]] = {}
        for point in points:
            if point.problem == problem:
                settings.setdefault(point.method, []).append(point.setting)
        where = "; ".join(f"{method} at {', '.join(own)}" for method, own in settings.items())
        yield from paragraph(f"{problem}: {where}", "    ")
