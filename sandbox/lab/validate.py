"""Comparison with published numbers, those of the scenes or a user's own."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.against import own_cases
from sandbox.lab.published import COUNTED, KINDS, Case, assignments, cases, cases_of
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.tables import paragraph, table
from sandbox.scene import Scene, load, simulate
from sandbox.scene.finding import as_path, find, is_installed
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import significant


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
    found: dict[tuple[str, str], SceneRun] = {}
    compared = []
    for done, case in enumerate(against):
        progress(done, len(against))
        key = case.scene, case.set
        if key not in found:
            found[key] = simulate(scene_of(case, changes))
        compared.append(compare(case, found[key]))
    return compared


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
    for part in key.split("."):
        try:
            result = result[int(part)] if isinstance(result, list) else result[part]
        except LookupError:  # a pin that was not struck, a ball that was potted
            return None
    return result


def compare(case: Case, run: SceneRun) -> Compared:
    """The number of a case in a run."""
    computed, difference, holds = _inside(run.result, case.result), None, False
    if computed is None:
        pass
    elif case.tolerance is None:
        computed = str(computed).lower() if isinstance(computed, bool) else str(computed)
        holds = computed == case.value
    else:
        own = run.scene.facts[case.result.partition(".")[0]].unit
        si = next(iter(units.KINDS[units.KIND_OF[case.unit]]))  # of what is in a table of several units
        computed = units.convert(float(computed), own or si, case.unit)
        difference = computed - float(case.value)
        holds = abs(difference) <= case.tolerance  # not where it is NaN
    return Compared(**{**vars(case), "computed": computed, "difference": difference, "holds": holds})


# ------------------------------------------------------------------------------------------------------------- report


def as_text(rows: Sequence[Compared], given: str = "published") -> list[str]:
    """A table for each source; what the numbers are is said by ``given``."""
    tables: dict[str, list[Compared]] = {}
    for row in rows:
        tables.setdefault(f"{row.sport}, {row.kind}: {row.source}", []).append(row)
    headings = ("case", "result", given, "computed", "off by", "allowed", "")
    lines = [*counts_by_kind(rows), ""]
    for title, own in tables.items():
        lines += [*paragraph(title, ""), *table(headings, [cells(row) for row in own], "llrrrrl")]
        for row in own:
            if not row.holds:
                case, result, *_ = cells(row)
                lines += paragraph(f"{case}, {result}, does not hold: {row.reason or 'no reason known'}")
        lines.append("")
    return lines[:-1]


def counts_by_kind(rows: Sequence[Compared]) -> list[str]:
    """The counts of rows that hold, those that say how true the models are first."""
    own = {kind: [row for row in rows if row.kind == kind] for kind in sorted(KINDS, key=lambda it: it not in COUNTED)}
    body = [(kind, _holding(those), KINDS[kind]) for kind, those in own.items() if those]
    measured = [row for row in rows if row.kind in COUNTED]
    first = f"{share_that_holds(rows)} hold" if measured else "nothing measured among these"
    others = "; those of the other kinds do not count" if len(measured) < len(rows) else ""
    return [*paragraph(first + others, ""), *table(("kind", "hold", ""), body, "lrl")]


def share_that_holds(rows: Sequence[Compared]) -> str:
    """Count the numbers that hold, of those measured and not fitted: the count of README.md and of the report."""
    return f"{_holding([row for row in rows if row.kind in COUNTED])} measured numbers"


def _holding(rows: Sequence[Compared]) -> str:
    return f"{sum(row.holds for row in rows)} of {len(rows)}"


def cells(row: Compared) -> tuple[str, ...]:
    """A row of the table."""
    about = f"{row.preset} {row.name}".strip(), row.result.replace("_", " ")
    verdict = "holds" if row.holds else "does not"
    if row.difference is None:
        return *about, row.value, "none" if row.computed is None else row.computed, "", "", verdict
    digits = _digits(row)
    published = f"{float(row.value):.{digits}f}" if len(row.value.partition(".")[2]) > digits else row.value
    return (
        *about,
        f"{published} {row.unit}".strip(),
        f"{row.computed:.{digits}f}",
        ("-" if row.difference < 0.0 else "+") + significant(abs(row.difference)),
        significant(row.tolerance or 0.0),
        verdict,
    )


def _digits(case: Case) -> int:
    """Digits after the point: one more than the published number has, as far as the tolerance justifies."""
    given = len(case.value.partition(".")[2]) if "e" not in case.value else 0
    seen = 1 - math.floor(math.log10(case.tolerance or 1.0))
    return max(0, min(10, seen if given > seen else max(given + 1, seen)))
