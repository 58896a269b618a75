"""The speed-accuracy trade-off, measured on this machine: every method over its steps or tolerances, and the levels."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from math import isfinite
from typing import Any

from sandbox.engine.model.accuracy import LEVELS, Accuracy, settle_for
from sandbox.lab.ablation import Ablated, ablation
from sandbox.lab.ablation import as_text as ablation_text
from sandbox.lab.reference import Reference, converge
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.tables import length, length_or_below, paragraph, table, time
from sandbox.lab.timing import Timed, repeat
from sandbox.lab.verdicts import VerdictChanges, shot_map
from sandbox.physics.integrators import INTEGRATORS
from sandbox.scene import Scene
from sandbox.sport.amounts import significant

#: Steps of the fixed-step methods, in 1/s, from the longest to the shortest.
RATES = (2, 5, 10, 20, 60, 240, 1000, 4000, 16_000, 64_000)

#: Tolerances of the method with error control, in m.
TOLERANCES = (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)

#: Errors in m for which the cheapest setting is reported.
TARGETS = (0.1, 0.01, 0.001, 0.0001)

#: A finer setting is left out if it would take longer than this, in s.
LONGEST = 1.0

#: Growth of a nudge until the measure, above which a large error does not imply an unstable method.
_CHAOTIC = 1e3

#: Relative variation of the time of the same run.
_NOISE = 0.1

#: Time in s to spend on the repeats of one setting.
_PATIENCE = 0.1


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

    @property
    def name(self) -> str:
        """The method and its setting."""
        return f"{self.method} {self.setting}".strip()

    @property
    def error(self) -> str:
        """Its error, or the name of its failure."""
        name = self.problem.partition(":")[0]
        return length(self.error_m) or (name if name.isalpha() else "failed")

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        method = self.accuracy.method if self.method == "level" else self.method
        return {**asdict(self), "accuracy": self.accuracy.level, "method": method}


@dataclass(frozen=True)
class Trade:
    """The measurements of ``sandbox trade`` for a scene."""

    reference: Reference
    points: list[Point]
    levels: dict[str, Point]
    ablation: list[Ablated] = field(default_factory=list)
    verdicts: VerdictChanges | None = None

    def best(self, target: float, method: str | None = None) -> Point | None:
        """The cheapest setting with an error of at most ``target`` m, of all or of one method.

        Times that differ by less than the noise count as equal; then the fewest force evaluations win.
        """
        among = [point for point in self.points if method in (None, point.method)]
        good = [point for point in among if point.error_m is not None and point.error_m <= target]
        least = min((point.wall_s for point in good), default=0.0)
        alike = [point for point in good if point.wall_s <= (1.0 + _NOISE) * least]
        return min(alike, key=lambda point: point.force_evaluations, default=None)

    def slowdown_from_pareto(self, level: str) -> float | None:
        """Time of a level relative to the cheapest setting that is as accurate; 1 on the Pareto front."""
        own = self.levels[level]
        if own.error_m is None:
            return None
        best = self.best(own.error_m)
        return 1.0 if best is None else max(1.0, own.wall_s / best.wall_s)


def trade(scene: Scene, progress: Progress = no_progress) -> Trade:
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


def _measured(reference: Reference, progress: Progress) -> Iterator[Point]:
    """Every setting once, from coarse to fine, and then again in turns."""
    wanted = list(settings(reference))
    trials: dict[tuple[str, str], Timed[tuple[float, int]]] = {}
    last: dict[str, Timed[tuple[float, int]]] = {}  # by method
    for done, (method, setting, accuracy) in enumerate(wanted):
        progress(done, 2 * len(wanted))
        coarser = None if method == "level" else last.get(method)  # levels are measured however long they take
        if coarser is not None and coarser.walls[0] * coarser.accuracy.step / accuracy.step > LONGEST:
            continue
        trial = Timed(
            reference.setup(), accuracy, lambda run: (reference.error_of(run), run.numerics.force_evaluations)
        )
        trial.run()
        trials[method, setting] = trial
        if not trial.problem:
            last[method] = trial
    repeat(list(trials.values()), _PATIENCE, lambda done, total: progress(total + done, 2 * total))
    for (method, setting), trial in trials.items():
        yield _point(reference, method, setting, trial)


def _point(reference: Reference, method: str, setting: str, trial: Timed[tuple[float, int]]) -> Point:
    error, evaluations = trial.seen or (None, 0)
    stable = error is not None and isfinite(error) and error < max(reference.size, 1e-9)
    far = "error larger than the length of the shot"
    if reference.growth < _CHAOTIC:
        why = f"unstable: {far}"
    else:
        why = f"{far}, where small errors grow {significant(reference.growth)} times"
    return Point(
        method,
        setting,
        trial.accuracy,
        error,
        trial.wall,
        len(trial.warm),
        evaluations,
        reference.time / trial.wall,
        stable,
        trial.problem or ("" if stable else why),
    )


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
            "growth": reference.growth,
            "diverges_at_s": reference.diverges_at,
        },
        "points": [point.as_dict() for point in found.points],
        "best": {f"{target:g}": best and best.as_dict() for target in TARGETS for best in [found.best(target)]},
        "levels": {
            name: {**point.as_dict(), "times_front": found.slowdown_from_pareto(name)}
            for name, point in found.levels.items()
        },
        "ablation": [{**asdict(row), "nothing": row.is_nothing} for row in found.ablation],
        "verdicts": found.verdicts,
    }


def as_text(found: Trade, everything: bool = False) -> list[str]:
    """For people: the cheapest way to each accuracy, and its time compared with that of pymunk alone; or everything."""
    reference = found.reference
    lines = [
        f"{reference.scene.title}: position of {_whose(reference)} after {reference.time:.4g} s",
        *table(
            ("for", "cheapest", "error", "time", "pymunk alone", "time", "times"),
            [_choice(found, target) for target in TARGETS],
            "llrrlrr",
        ),
        *paragraph(f"levels: {', '.join(_in_short(found, name) for name in found.levels)}"),
        *(paragraph(f"verdicts: {_verdicts(found.verdicts)}") if found.verdicts is not None else []),
    ]
    if not everything:
        return [*lines, "  --all shows every setting, the verdicts, and the parts of the model"]
    return [*lines, "", *_everything(found)]


def _whose(reference: Reference) -> str:
    return "every ball" if len(reference.points) > 1 else "the ball"


def _choice(found: Trade, target: float) -> list[str]:
    """The cheapest setting of all for an error in m, the cheapest of pymunk alone, and the ratio of their times."""
    best, plain = found.best(target), found.best(target, "plain")
    ours, theirs = ["none", "", ""], ["none", "", ""]
    if best is not None:
        ours = [best.name, length_or_below(best.error_m, found.reference.error), time(best.wall_s)]
    if best is not None and plain is not None:
        theirs = [plain.setting, time(plain.wall_s), significant(plain.wall_s / best.wall_s)]
    return [length(target), *ours, *theirs]


def _in_short(found: Trade, name: str) -> str:
    point = found.levels[name]
    return f"{name} {length_or_below(point.error_m, found.reference.error) or point.error} in {time(point.wall_s)}"


def _verdicts(changes: VerdictChanges) -> str:
    """How many shots come out differently or fail, by method."""
    counts = (
        f"{name} {of.other} other" + (f", {of.failed} failed" if of.failed else "")
        for name, of in changes.methods.items()
    )
    return f"of {changes.shots} shots around it, by {'; '.join(counts)}"


def _everything(found: Trade) -> list[str]:
    """Every setting, the levels, the verdicts, and the parts of the model."""
    least = found.reference.error

    def cells(point: Point) -> list[str]:
        error = length_or_below(point.error_m, least) or point.error
        return [error, time(point.wall_s), significant(point.times_real_time)]

    settings = [[p.method, p.setting, *cells(p), str(p.force_evaluations)] for p in found.points]
    levels = [
        [name, length(point.accuracy.tolerance), *cells(point), "" if behind is None else significant(behind)]
        for name, point in found.levels.items()
        for behind in [found.slowdown_from_pareto(name)]
    ]
    return [
        *_about(found.reference),
        "",
        *table(("method", "setting", "error", "time", "x real time", "forces"), settings, "llrrrr"),
        *_problems(found.points),
        "",
        "levels",
        *table(
            ("level", "target", "error", "time", "x real time", "x cheapest equally accurate setting"), levels, "lrrrrr"
        ),
        *(["", *ablation_text(found.ablation, found.reference.time)] if found.ablation else []),
        *(["", *found.verdicts.as_text()] if found.verdicts is not None else []),
    ]


def _about(reference: Reference) -> list[str]:
    scene, chaotic = reference.scene, reference.diverges_at
    closed = reference.closed_form
    how = "contacts are computed, the rest is in closed form" if closed else "checked with another integrator"
    growth = f"a nudge at the start grows {significant(reference.growth)} times until then"
    if chaotic is not None:
        growth = f"chaotic: a nudge of 1e-9 m has grown to 1 mm after {chaotic:.4g} s"
    return [
        scene.title,
        f"  measure    position of {_whose(reference)} after {reference.time:.4g} s",
        f"  reference  error {length(reference.error)}, {how}",
        f"  growth     {growth}",
    ]


def _problems(points: Sequence[Point]) -> Iterator[str]:
    """Each problem once, with its methods and settings."""
    for problem in dict.fromkeys(point.problem for point in points if point.problem):
        settings: dict[str, list[str]] = {}
        for point in points:
            if point.problem == problem:
                settings.setdefault(point.method, []).append(point.setting)
        where = "; ".join(f"{method} at {', '.join(own)}" for method, own in settings.items())
        yield from paragraph(f"{problem}: {where}", "    ")
