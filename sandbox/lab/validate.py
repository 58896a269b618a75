"""Comparison with published numbers, those of the scenes or a user's own."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.against import own_cases
from sandbox.lab.aim.question import MAXIMIZE, Target
from sandbox.lab.aim.share import most_often
from sandbox.lab.aim.shots import Shots
from sandbox.lab.axes import parse_span, unit_of
from sandbox.lab.published import COUNTED, KINDS, Case, assignments, cases, cases_of
from sandbox.lab.report import Chart, Column, Notes, Panel, Report, Table, words
from sandbox.lab.runs import Progress, no_progress
from sandbox.scene import Scene, load, simulate
from sandbox.scene.discovery import as_path, find, is_installed
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import significant

#: Tolerances by which a number may be off on the chart; more is drawn there.
_FARTHEST = 4.0


#: Shots around each point where the best launch is looked for, and around those near it. All points have the same
#: deviations, so that the place is as with four times as many; the share has a standard error of 0.04 at most.
_SHOTS = 32, 128


@dataclass(frozen=True)
class MostOften:
    """The launch of which a practised player scores most often, in place of a run: its parameters, and the share."""

    scene: Scene
    result: Mapping[str, Any]


@dataclass(frozen=True)
class Compared(Case):
    """A case and the number computed here, in the case's unit."""

    computed: Any
    difference: float | None  # None for words
    holds: bool


def validate(
    source: str | None = None,
    changes: Mapping[str, Any] | None = None,
    progress: Progress = no_progress,
    against: Sequence[Case] | None = None,
) -> list[Compared]:
    """Compute the cases of one scene or preset, or all, or those of ``against``. ``changes`` override what the cases
    set."""
    if against is None:
        against = list(cases()) if source is None else _of(source)
    found: dict[tuple[str, str, str], SceneRun | MostOften] = {}
    compared = []
    for done, case in enumerate(against):
        progress(done, len(against))
        key = case.scene, case.set, case.vary
        if key not in found:
            scene = scene_of(case, changes)
            found[key] = most_often_in(scene, case.vary) if case.vary else simulate(scene)
        compared.append(compare(case, found[key]))
    return compared


def most_often_in(scene: Scene, vary: str) -> MostOften:
    """The best launch among ranges: ``launch.angle=46:60; launch.speed=7.2:7.8``."""
    spans = [parse_span(scene, "vary", part.strip()) for part in vary.split(";")]
    shots = Shots(scene, spans, [Target(scene.controls.scores, MAXIMIZE)], no_progress)
    best = next(iter(most_often(shots, _SHOTS)), None)
    return MostOften(scene, {} if best is None else {**best.result, **best.values})


def scene_of(case: Case, changes: Mapping[str, Any] | None = None) -> Scene:
    """The scene of a case; ``changes`` override what it sets."""
    return load(case.scene, assignments(case.set)).changed(changes or {}, "--set")


def _of(source: str) -> list[Case]:
    """The published numbers of a preset, or of a scene with its presets, also of a user's own."""
    found = find(source)
    if is_installed(found.folder):
        every = list(cases_of(found.name, found.folder))
    else:
        every = own_cases(as_path(found.folder), found.folder)
    own = [case for case in every if found.preset and case.preset == found.preset] or every
    if not own:
        raise RequestError(f"{source}: no published numbers; sandbox validate lists all there are")
    return own


def _inside(result: Any, key: str) -> Any:
    """The value at a key with dots into lists and tables; None if these do not hold it."""
    if key in result:
        return result[key]
    for part in key.split("."):
        try:
            result = result[int(part)] if isinstance(result, list) else result[part]
        except LookupError:  # a pin that was not struck, a ball that was potted
            return None
    return result


def compare(case: Case, run: SceneRun | MostOften) -> Compared:
    """The number of a case in a run, or in the best launch."""
    computed, difference, holds = _inside(run.result, case.result), None, False
    if computed is None:
        pass
    elif case.tolerance is None:
        computed = str(computed).lower() if isinstance(computed, bool) else str(computed)
        holds = computed == case.value
    else:
        fact = run.scene.facts.get(case.result.partition(".")[0])
        own = unit_of(run.scene, case.result) if fact is None else fact.unit
        si = next(iter(units.KINDS[units.KIND_OF[case.unit]]))  # of what is in a table of several units
        computed = units.convert(float(computed), own or si, case.unit)
        difference = computed - float(case.value)
        holds = abs(difference) <= case.tolerance  # not where it is NaN
    return Compared(**{**vars(case), "computed": computed, "difference": difference, "holds": holds})


# ------------------------------------------------------------------------------------------------------------- report


def report_of(rows: Sequence[Compared], given: str = "published", notes: Sequence[str] = ()) -> Report:
    """A table for each source, with what does not hold and why; the numbers are called ``given``."""
    sources: dict[str, list[Compared]] = {}
    for row in rows:
        sources.setdefault(f"{row.sport}, {row.kind}: {row.source}", []).append(row)
    measured = [row for row in rows if row.kind in COUNTED]
    first = f"{share_that_holds(rows)} hold" if measured else "nothing measured among these"
    others = "; those of the other kinds do not count" if len(measured) < len(rows) else ""
    return Report(
        lambda: rows,
        first + others,
        [_kinds(rows), _chart(rows), *(_table(*own, given) for own in sources.items()), Notes(notes)],
    )


def _kinds(rows: Sequence[Compared]) -> Table:
    """The counts of rows that hold, those that say how true the models are first."""
    own = {kind: [row for row in rows if row.kind == kind] for kind in sorted(KINDS, key=lambda it: it not in COUNTED)}
    body = [(kind, _holding(those), KINDS[kind]) for kind, those in own.items() if those]
    return Table([words("kind"), Column("hold"), words()], body)


def _table(title: str, rows: Sequence[Compared], given: str) -> Table:
    columns = [words("case"), words("result"), *map(Column, (given, "computed", "off by", "allowed")), words()]
    body = [cells(row) for row in rows]
    missed = [
        f"{case}, {result}, does not hold: {row.reason or 'no reason known'}"
        for row, (case, result, *_) in zip(rows, body, strict=True)
        if not row.holds
    ]
    return Table(columns, body, title, notes=missed)


def _chart(rows: Sequence[Compared]) -> Chart:
    """The error of each number over its tolerance, by scene: those that count in colour."""
    scenes = list(dict.fromkeys(row.sport for row in rows))[::-1]
    known = [row for row in rows if row.difference is not None and row.tolerance]

    def dots(axes: Any, colours: Mapping[str, Any]) -> None:
        card = colours["card"]
        axes.axvspan(-1.0, 1.0, color=card["quiet"], alpha=0.2, linewidth=0.0)
        groups = {"does not count": card["quiet"], "holds": card["good"], "does not": card["bad"]}
        for name, colour in groups.items():
            own = [row for row in known if name == (_verdict(row) if row.kind in COUNTED else "does not count")]
            off = [max(-_FARTHEST, min(_FARTHEST, (row.difference or 0.0) / (row.tolerance or 1.0))) for row in own]
            places = [scenes.index(row.sport) for row in own]
            axes.scatter(off, places, s=18, color=colour, label=name, zorder=3)
        axes.set_yticks(range(len(scenes)), scenes)
        axes.set_xlim(-1.05 * _FARTHEST, 1.05 * _FARTHEST)

    label = f"off by, over what is allowed; {_FARTHEST:g} and more at the edge"
    return Chart([Panel(dots, label)], "Computed and given numbers", height=0.8 + 0.3 * len(scenes))


def _verdict(row: Compared) -> str:
    return "holds" if row.holds else "does not"


def share_that_holds(rows: Sequence[Compared]) -> str:
    """Count the numbers that hold, of those measured and not fitted: the count of README.md and of the report."""
    return f"{_holding([row for row in rows if row.kind in COUNTED])} measured numbers"


def _holding(rows: Sequence[Compared]) -> str:
    return f"{sum(row.holds for row in rows)} of {len(rows)}"


def cells(row: Compared) -> tuple[str, ...]:
    """A row of the table."""
    about = f"{row.preset} {row.name}".strip(), row.result.replace("_", " ")
    if row.difference is None:
        return *about, row.value, "none" if row.computed is None else row.computed, "", "", _verdict(row)
    digits = _digits(row)
    published = f"{float(row.value):.{digits}f}" if len(row.value.partition(".")[2]) > digits else row.value
    return (
        *about,
        f"{published} {row.unit}".strip(),
        f"{row.computed:.{digits}f}",
        ("-" if row.difference < 0.0 else "+") + significant(abs(row.difference)),
        significant(row.tolerance or 0.0),
        _verdict(row),
    )


def _digits(case: Case) -> int:
    """Digits after the point: one more than the published number has, as far as the tolerance justifies."""
    given = len(case.value.partition(".")[2]) if "e" not in case.value else 0
    seen = 1 - math.floor(math.log10(case.tolerance or 1.0))
    return max(0, min(10, seen if given > seen else max(given + 1, seen)))
