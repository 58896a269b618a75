"""Comparison with published numbers: the tables in published/, each row with its source.

A table is ``NAME.csv`` with the columns scene, case, set, result, value, tolerance, unit, source, reason, kind, tests,
tolerance_from: ``set`` holds ``key=value`` separated by ``;``, ``result`` is a key of the scene's result, with dots
into lists and tables, ``kind`` is one of KINDS, ``tests`` names the effects that the number is to show (see teeth.py),
and ``tolerance_from`` says what the tolerance is: the uncertainty of the measurement, or why it is not. A table in
another format has a ``NAME.toml`` next to it that maps its columns to such rows.
"""

from __future__ import annotations

import csv
import math
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.tables import paragraph, table
from sandbox.parameters import parse_assignment
from sandbox.scene import Scene, load, parameters_of, simulate
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import significant

PUBLISHED = Path(__file__).resolve().parent / "published"

#: What a published number is. Only those of COUNTED say how true a model is.
KINDS = {
    "exact": "a closed form, or a solution to many digits",
    "fitted": "a constant of the model, or of the scene, was chosen to meet it",
    "program": "computed by another program",
    "model": "computed by another model, or a rule of thumb",
    "measured": "measured, and used for no constant",
    "held-out": "measured; others of the same set were fitted, this one was not",
}
COUNTED = ("measured", "held-out")


@dataclass(frozen=True)
class Case:
    """One published number, or one published word."""

    scene: str  # with its preset
    set: str  # changed parameters, as written in the table
    name: str  # as shown
    result: str
    value: str
    tolerance: float | None  # in ``unit``; None for words
    unit: str
    source: str
    reason: str  # why it does not match, if known
    kind: str  # of KINDS
    tests: str  # effects that it is to show: causes of forces, keys of parameters, or key=value; separated by ``;``
    tolerance_from: str  # what the tolerance is


@dataclass(frozen=True)
class Compared(Case):
    """A case and the number computed here, in the case's unit."""

    computed: Any
    difference: float | None  # None for words
    holds: bool


def cases() -> Iterator[Case]:
    """Every published number."""
    for path in sorted(PUBLISHED.glob("*.csv")):
        with path.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        form = path.with_suffix(".toml")
        if form.is_file():
            yield from _by_form(rows, tomllib.loads(form.read_text("utf-8")))
        else:
            yield from (_case(row) for row in rows)


def _case(row: Mapping[str, str]) -> Case:
    given = dict(row)
    name = given.pop("case")
    tolerance = given.pop("tolerance")
    return Case(name=name, tolerance=float(tolerance) if tolerance else None, **given)


def _by_form(rows: Sequence[Mapping[str, str]], form: Mapping[str, Any]) -> Iterator[Case]:
    """The cases of a table in another format. In ``form``, ``{column}`` stands for the row's value in that column.

    It has ``scene``, ``name``, ``source``, ``kind``, ``set``; ``value``, ``unit``, ``tolerance``, ``tests`` and
    ``tolerance_from`` of each of ``results``, with the rows that it does not have as ``unless``, words by column; and
    ``reasons`` by name and result.
    """
    for row in rows:
        name = form["name"].format(**row)
        settings = "; ".join(f"{key}={value.format(**row)}" for key, value in form["set"].items())
        for result, how in form["results"].items():
            if any(row[column] in words for column, words in how.get("unless", {}).items()):
                continue
            reason = form.get("reasons", {}).get(f"{name} {result}", "")
            value, source, kind = (text.format(**row) for text in (how["value"], form["source"], form["kind"]))
            allowed = float(str(how["tolerance"]).format(**row)), how["unit"]
            last = kind, how["tests"].format(**row), how["tolerance_from"]
            yield Case(form["scene"], settings, name, result, value, *allowed, source, reason, *last)


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


def assignments(text: str) -> dict[str, Any]:
    """``key=value; key=value`` as a dictionary."""
    return dict(parse_assignment(part) for part in text.split(";") if part.strip())


def _of(source: str) -> list[Case]:
    name = source if source in {case.scene for case in cases()} else parameters_of(source)[0]
    found = [case for case in cases() if name in (case.scene, case.scene.partition("/")[0])]
    if not found:
        raise RequestError(f"{source}: no published numbers; sandbox validate lists all there are")
    return found


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
        tables.setdefault(f"{row.scene.partition('/')[0]}, {row.kind}: {row.source}", []).append(row)
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
    first = f"{counted(rows)} hold" if measured else "nothing measured among these"
    others = "; those of the other kinds do not count" if len(measured) < len(rows) else ""
    return [*paragraph(first + others, ""), *table(("kind", "hold", ""), body, "lrl")]


def counted(rows: Sequence[Compared]) -> str:
    """Count the numbers that hold, of those measured and not fitted: the count of README.md and of the report."""
    return f"{_holding([row for row in rows if row.kind in COUNTED])} measured numbers"


def _holding(rows: Sequence[Compared]) -> str:
    return f"{sum(row.holds for row in rows)} of {len(rows)}"


def cells(row: Compared) -> tuple[str, ...]:
    """A row of the table."""
    about = f"{row.scene.partition('/')[2]} {row.name}".strip(), row.result.replace("_", " ")
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
