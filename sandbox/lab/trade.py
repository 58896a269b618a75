"""The speed-accuracy trade-off, measured on this machine: every method over its steps or tolerances, and the levels."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from functools import partial
from itertools import takewhile
from math import isfinite
from typing import Any

from sandbox.engine.model.accuracy import LEVELS, Accuracy, settle_for
from sandbox.lab.ablation import Ablated, ablation
from sandbox.lab.ablation import tables as ablation_tables
from sandbox.lab.chart import mark
from sandbox.lab.reference import Reference, converge
from sandbox.lab.report import Chart, Column, Notes, Panel, Report, Table, words
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.tables import length, length_or_below, time
from sandbox.lab.timing import Timed, repeat
from sandbox.lab.verdicts import VerdictChanges, shot_map
from sandbox.physics.integrators import INTEGRATORS
from sandbox.scene import Scene
from sandbox.scene.writing import command
from sandbox.sport.amounts import significant

#: Steps of the fixed-step methods, in 1/s, from the longest to the shortest.
RATES = (2, 5, 10, 20, 60, 240, 1000, 4000, 16_000, 64_000)

#: Tolerances of the method with error control, in m.
TOLERANCES = (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)

#: Errors in m for which the cheapest setting is reported; and the least that is drawn, for smaller ones do not matter.
TARGETS, _LEAST = (0.1, 0.01, 0.001, 0.0001), 1e-9

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
    def failure(self) -> str:
        """The name of its failure."""
        name = self.problem.partition(":")[0]
        return name if name.isalpha() else "failed"

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


def report_of(found: Trade) -> Report:
    """The cheapest way to each accuracy, and its time compared with that of pymunk alone; error against speed; and as
    details every setting, the levels, the parts of the model, and the verdicts."""
    reference = found.reference
    error, took = Column("error", write=partial(length_or_below, least=reference.error)), Column("time", write=time)
    choice = [Column("for", write=length, align="l"), words("cheapest"), error, took]
    choice += [words("pymunk alone"), took, Column("times", write=significant)]
    cost = [error, took, Column("x real time", write=significant)]
    behind = Column("x cheapest equally accurate setting", write=significant)
    levels = [
        [name, point.accuracy.tolerance, *_cells(point), found.slowdown_from_pareto(name)]
        for name, point in found.levels.items()
    ]
    settings = [[point.method, point.setting, *_cells(point), point.force_evaluations] for point in found.points]
    return Report(
        partial(document, found),
        f"{reference.scene.title}: position of {_whose(reference)} after {reference.time:.4g} s",
        [
            Table(choice, [_choice(found, target) for target in TARGETS], notes=list(_in_short(found))),
            _chart(found),
            Notes(_about(reference), detail=True),
            Table([words("method"), words("setting"), *cost, Column("forces", write=str)], settings,
                  notes=list(_problems(found.points)), detail=True),
            Table([words("level"), Column("target", write=length), *cost, behind], levels, "levels", detail=True),
            *ablation_tables(found.ablation, reference.time),
            *([] if found.verdicts is None else [found.verdicts.table()]),
        ],
        more="every setting, the verdicts, and the parts of the model",
        command=command(reference.scene, "trade", "--html", "trade.html"),
    )  # fmt: skip


def document(found: Trade) -> dict[str, Any]:
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


def _whose(reference: Reference) -> str:
    return "every ball" if len(reference.points) > 1 else "the ball"


def _choice(found: Trade, target: float) -> list[Any]:
    """The cheapest setting of all for an error in m, the cheapest of pymunk alone, and the ratio of their times."""
    best, plain = found.best(target), found.best(target, "plain")
    ours: list[Any] = ["none", None, None] if best is None else [best.name, best.error_m, best.wall_s]
    theirs: list[Any] = ["none", None, None]
    if best is not None and plain is not None:
        theirs = [plain.setting, plain.wall_s, plain.wall_s / best.wall_s]
    return [target, *ours, *theirs]


def _cells(point: Point) -> list[Any]:
    """The error in m, or the name of the failure; the time in s, and how many times real time that is."""
    return [point.failure if point.error_m is None else point.error_m, point.wall_s, point.times_real_time]


def _in_short(found: Trade) -> Iterator[str]:
    """Sentences on the levels, and on how many shots come out differently or fail by each method."""

    def level(name: str, point: Point) -> str:
        error = point.failure if point.error_m is None else length_or_below(point.error_m, found.reference.error)
        return f"{name} {error} in {time(point.wall_s)}"

    yield f"levels: {', '.join(level(name, point) for name, point in found.levels.items())}"
    changes = found.verdicts
    if changes is not None and changes.methods:  # on a slow machine none may be quick enough to be counted
        counts = (
            f"{name} {of.other} other" + (f", {of.failed} failed" if of.failed else "")
            for name, of in changes.methods.items()
        )
        yield f"verdicts: of {changes.shots} shots around it, by {'; '.join(counts)}"


def _about(reference: Reference) -> list[str]:
    chaotic = reference.diverges_at
    how = (
        "contacts are computed, the rest is in closed form"
        if reference.closed_form
        else "checked with another integrator"
    )
    growth = f"a nudge at the start grows {significant(reference.growth)} times until then"
    if chaotic is not None:
        growth = f"chaotic: a nudge of 1e-9 m has grown to 1 mm after {chaotic:.4g} s"
    return [f"reference: error {length(reference.error)}, {how}", growth]


def _problems(points: Sequence[Point]) -> Iterator[str]:
    """Each problem once, with its methods and settings."""
    for problem in dict.fromkeys(point.problem for point in points if point.problem):
        settings: dict[str, list[str]] = {}
        for point in points:
            if point.problem == problem:
                settings.setdefault(point.method, []).append(point.setting)
        where = "; ".join(f"{method} at {', '.join(own)}" for method, own in settings.items())
        yield f"{problem}: {where}"


def _chart(found: Trade) -> Chart:
    """Error against speed: one curve per method, best at the top right, levels marked."""
    reference = found.reference
    floor = max(_LEAST, reference.error)

    def places(*points: Point) -> tuple[list[float], list[float]]:
        return [point.times_real_time for point in points], [max(point.error_m or 0.0, floor) for point in points]

    def curves(axes: Any, colours: Mapping[str, Any]) -> None:
        card, methods = colours["card"], list(dict.fromkeys(point.method for point in found.points))
        traces = iter(colours["trace"]["colours"])  # the levels' method, which is the last, has the first
        own = {method: card["quiet"] if method == "plain" else next(traces) for method in reversed(methods)}
        for method in methods:
            finest_first = reversed([point for point in found.points if point.method == method])
            points = list(takewhile(lambda point: point.stable, finest_first))
            if points:
                axes.plot(*places(*points), color=own[method], marker="o", markersize=4.5, label=method, zorder=3)
        for level, point in found.levels.items():
            if point.error_m is not None:
                mark(axes, tuple(value for (value,) in places(point)), level, card, beside=True)
        for target in TARGETS:
            axes.axhline(target, color=card["quiet"], linewidth=0.8, linestyle=(0, (1, 3)), zorder=1)
        axes.set(xscale="log", yscale="log")
        slowest, fastest = axes.get_xlim()
        axes.set_xlim(slowest, fastest * (fastest / slowest) ** 0.1)  # room for the levels' names
        axes.invert_yaxis()
        axes.xaxis.set_major_formatter(lambda value, position: significant(value))
        axes.tick_params(axis="x", which="minor", pad=7)  # aligned with the other labels, which have ticks
        axes.xaxis.set_minor_formatter(lambda value, position: significant(value) if f"{value:e}"[0] in "25" else "")
        axes.yaxis.set_major_formatter(lambda value, position: length(value))

    what = "the worst ball" if len(reference.points) > 1 else "the ball"
    about = f"position error of {what} after {reference.time:.3g} s, on this machine"
    if reference.diverges_at is not None:
        about += f"; chaotic from {reference.diverges_at:.3g} s on"
    panel = Panel(curves, "speed, times real time", "error, smaller upwards")
    return Chart([panel], f"{reference.scene.title}: error against speed", about)
