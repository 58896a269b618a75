"""The report of a session: tables by group, gaps, where shots come down, the model, and what differs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from math import floor, log10
from statistics import median
from typing import Any

from sandbox.lab.misfit import Compared
from sandbox.lab.misfit import document as misfit_document
from sandbox.lab.report import Column, Notes, Report, Table, words
from sandbox.lab.session.chart import charts
from sandbox.lab.session.shots import FEWEST, LAUNCH, NARROW, SHARES, SIDE, Measure, Shots
from sandbox.lab.session.summary import Difference, Part, Session
from sandbox.lab.statistics import Numbers, Share
from sandbox.parameters import value_at
from sandbox.text import argument, with_noun

#: Most mishits that the text names one by one, and most columns next to each other: of means, and of differences.
_MOST, _MOST_COLUMNS, _MOST_CHANGES = 12, 5, 3


def report_of(session: Session) -> Report:
    """Groups, gaps and ellipses, mishits, the model, other air, and a second session."""
    parts = [part for part in (session.first, session.second) if part is not None]
    shots = session.first.shots
    title = f"{shots.scene.title}: {' and '.join(_title(part) for part in parts)}"
    tables = [table for part in parts for table in _tables(session, part)]
    return Report(
        partial(document, session),
        title,
        [
            *tables,
            *_differences(session),
            *charts(session, title),
            *_model(session),
            *_today(session),
            _about(session, parts),
        ],
    )


def _title(part: Part) -> str:
    shots = part.shots
    return f"{with_noun(len(shots.rows), 'shot')} of {shots.path.name}"


# ---------------------------------------------------------------------------------------------------------------- JSON


def document(session: Session) -> dict[str, Any]:
    """For JSON; each number is in the unit of the file, which stands next to it, and shares are from 0 to 1."""
    found = {"scene": session.first.shots.scene.title, **_part(session.first), "model": _model_document(session)}
    if session.model.changed:
        found["today"] = {
            "changes": session.model.changes,
            "groups": {
                name: {key: _changed(one) for key, one in by.items()} for name, by in session.changed_by_group().items()
            },
        }
    if session.second is not None:
        names = {name: session.differences(name) for name in session.first.groups}
        found["second"] = _part(session.second)
        found["difference"] = {
            name: {key: {**vars(one), "unit": session.first.shots.measures[key].unit} for key, one in by.items()}
            for name, by in names.items()
            if by
        }
    return found


def _part(part: Part) -> dict[str, Any]:
    shots = part.shots
    return {
        "file": shots.path.name,
        "by": shots.by,
        "rows": len(shots.rows),
        "groups": {name: _group(part, name) for name in shots.groups},
        "set_aside": part.set_aside,
        "left_out": shots.left_out,
        "notes": shots.notes,
    }


def _group(part: Part, name: str) -> dict[str, Any]:
    """The count of the shots that count, and each column's numbers."""
    found: dict[str, Any] = {"n": int(part.groups[name].sum()), "set_aside": _aside(part, name)}
    for key, measure in part.shots.measures.items():
        if (one := part.summary(name, measure)) is not None:
            found[key] = _numbers(one, measure.unit)
    ellipses = part.ellipses(name)
    if ellipses and part.shots.places is not None:
        across, along = part.shots.places
        found["dispersion"] = {
            "across": across.key,
            "along": along.key,
            "unit": along.unit,
            "center": ellipses[0].center,
            "ellipses": {
                f"{ellipse.share:g}": {"semi_axes": ellipse.axes, "angle": ellipse.angle, "inside": ellipse.inside}
                for ellipse in ellipses
            },
        }
    return found


def _numbers(one: Numbers | Share, unit: str) -> dict[str, Any]:
    low, high = one.interval or (None, None)
    if isinstance(one, Share):
        return {"n": one.shots, "share": one.value, "low": low, "high": high}
    sd = one.sd if one.count > 1 else None
    return {"n": one.count, "mean": one.mean, "sd": sd, "low": low, "high": high, "unit": unit}


def _aside(part: Part, name: str) -> int:
    return sum(one.group == name for one in part.set_aside)


def _model_document(session: Session) -> dict[str, Any]:
    if session.model.results is None:
        return {"results": {}, "by": {}, "why": session.model.why}
    found = misfit_document(session.model.results)
    return {key: found[key] for key in ("results", "by", "left_out", "notes")}


def _changed(one: Compared) -> dict[str, Any]:
    return {"n": one.off.count, "difference": one.off.mean, "sd": one.off.sd, "unit": one.unit}


# -------------------------------------------------------------------------------------------------------------- tables


def _tables(session: Session, part: Part) -> list[Table]:
    """The results by group, and the launches."""
    shots = part.shots
    results, launch, more = _in_order(shots)
    name = f"{shots.path.name}: " if session.second is not None else ""
    blocks = {"results": results, "launches": launch}
    blocks |= {
        "" if place else "more": more[place : place + _MOST_COLUMNS] for place in range(0, len(more), _MOST_COLUMNS)
    }
    tables = [_table(part, some, f"{name}{title}" if title else "") for title, some in blocks.items() if some]
    tables[0] = replace(tables[0], notes=["mean ± standard deviation", *_gaps(part)])
    return tables


def _in_order(shots: Shots) -> tuple[list[Measure], list[Measure], list[Measure]]:
    """The most important results, the launch, and what else there is."""
    known = {key: one for key, one in shots.measures.items() if not key.startswith("air.")}
    main = shots.main.key if shots.main.key in shots.scene.facts else ""
    results = [known.pop(key) for key in (main, "total", SIDE, *shots.scene.facts) if key in known]
    launch = [known.pop(key) for key in LAUNCH if key in known]
    return results[:_MOST_COLUMNS], launch, [*results[_MOST_COLUMNS:], *known.values()]


def _table(part: Part, measures: Sequence[Measure], title: str) -> Table:
    rows = []
    digits = {one.key: _digits([part.summary(name, one) for name in part.groups]) for one in measures}
    for name, inside in part.groups.items():
        cells = [_cell(part.summary(name, one), digits[one.key]) for one in measures]
        rows.append([name, f"{int(inside.sum())}", *cells])
    return Table([words(part.shots.by), Column("n"), *(Column(one.heading) for one in measures)], rows, title)


def _digits(found: Sequence[Numbers | Share | None]) -> int:
    """Digits after the point that the median scatter of the groups justifies."""
    sds = [one.sd for one in found if isinstance(one, Numbers) and one.sd > 0.0]
    return _digits_for(median(sds)) if sds else 1


def _digits_for(uncertainty: float) -> int:
    """Digits after the point of a number that is uncertain by so much: 254 ± 6, 139.7 ± 0.7, 22.1 ± 1.4."""
    return min(max(-floor(log10(0.5 * uncertainty)), 0), 3) if uncertainty > 0.0 else 1


def _cell(one: Numbers | Share | None, digits: int) -> str:
    """``254.3 ± 6.1``, ``63 %``."""
    if one is None:
        return ""
    if isinstance(one, Share):
        low, high = one.interval
        return f"{100 * one.value:.0f} % ({100 * low:.0f} to {100 * high:.0f})"
    mean = f"{one.mean:z.{digits}f}".replace("-", "−")
    return f"{mean} ± {one.sd:.{digits}f}" if one.count > 1 else mean


def _gaps(part: Part) -> list[str]:
    """The gaps between neighbours in the bag: how far each club goes beyond the next."""
    main = part.shots.main
    if main.is_share or len(part.groups) < 3:
        return []
    means = [(name, found.mean) for name in part.groups if isinstance(found := part.summary(name, main), Numbers)]
    gaps = [(first, second, a - b) for (first, a), (second, b) in pairwise(means)]
    if not gaps:
        return []
    widest, least = max(gaps, key=lambda gap: gap[2]), min(gaps, key=lambda gap: gap[2])
    return [
        f"gaps in {main.label}: widest {widest[2]:.0f} {main.unit} from {widest[0]} to {widest[1]}, narrowest "
        f"{least[2]:.0f} {main.unit} from {least[0]} to {least[1]}"
    ]


def _differences(session: Session) -> list[Table | Notes]:
    """The second session minus the first, with the intervals that do not hold 0 marked."""
    if session.second is None:
        return []
    found = {name: by for name in session.first.groups if (by := session.differences(name))}
    if not found:
        return [Notes(["the two sessions have no group in common: name one that they share by --by"])]
    measures = session.first.shots.measures
    results, launch, more = _in_order(session.first.shots)
    keys = [one.key for one in (*results, *launch, *more) if any(one.key in by for by in found.values())]
    tables: list[Table] = []
    for place in range(0, len(keys), _MOST_CHANGES):
        some = keys[place : place + _MOST_CHANGES]
        rows = [[name, *(_change(by.get(key), measures[key]) for key in some)] for name, by in found.items()]
        tables.append(Table([words(session.first.shots.by), *(Column(measures[key].heading) for key in some)], rows))
    title = f"{session.second.shots.path.name} minus {session.first.shots.path.name}"
    how = "difference of the means with its 95 % interval (Welch); * where that does not hold 0, as in one of 20 "
    tables[0] = replace(tables[0], title=title)
    tables[-1] = replace(tables[-1], notes=[f"{how}that differ by chance alone", *_in_one_only(session, set(found))])
    return [*tables]


def _in_one_only(session: Session, common: set[str]) -> list[str]:
    """Name the groups that are in one of two sessions only."""
    parts = (session.first, session.second)
    found = {part.shots.path.name: [n for n in part.groups if n not in common] for part in parts if part is not None}
    named = [f"{', '.join(names)} in {name}" for name, names in found.items() if names]
    return [f"without one of the same name in the other file: {'; '.join(named)}"] if named else []


def _change(one: Difference | None, measure: Measure) -> str:
    """``+3.1 (+1.0 to +5.2) *``."""
    if one is None:
        return ""
    factor, unit = (100.0, " %") if measure.is_share else (1.0, "")
    if one.low is None or one.high is None:
        return f"{factor * one.value:+z.1f}{unit}".replace("-", "−")
    half = 0.5 * factor * (one.high - one.low)
    digits = _digits_for(0.3 * half)  # so that an end near 0 shows its sign
    numbers = (f"{factor * number:+z.{digits}f}" for number in (one.value, one.low, one.high))
    value, low, high = numbers
    star = " *" if one.low > 0.0 or one.high < 0.0 else ""
    return f"{value}{unit} ({low} to {high}){star}".replace("-", "−")


def _model(session: Session) -> list[Table | Notes]:
    """Computed minus measured by group, with the half-width of the 95 % interval."""
    found = session.model.results
    if found is None:
        return [Notes([f"not compared with the model: {session.model.why}"])]
    tables: list[Table] = []
    groups = [*found.groups.items(), *_all(found.groups)]
    for place in range(0, len(found.results), _MOST_COLUMNS - 1):
        some = found.results[place : place + _MOST_COLUMNS - 1]
        names = [one.result.replace("_", " ") for one in some]
        heads = [Column(f"{name} ({one.unit})" if one.unit else name) for name, one in zip(names, some, strict=True)]
        rows = [[name, f"{int(inside.sum())}", *(_bias(one.of(inside)) for one in some)] for name, inside in groups]
        tables.append(Table([words(found.by), Column("n"), *heads], rows))
    how = "mean of computed minus measured, with half of its 95 % interval if shots are independent"
    of = f" of {session.first.shots.path.name}" if session.second is not None else ""
    tables[0] = replace(tables[0], title=f"model minus monitor{of}")
    tables[-1] = replace(tables[-1], notes=[how])
    return list(tables)


def _all(groups: Mapping[str, Any]) -> list[tuple[str, Any]]:
    """All groups as one, where there are several."""
    return [("all", sum(groups.values()) > 0)] if len(groups) > 1 else []


def _bias(one: Compared) -> str:
    off = one.off
    if off.interval is None:
        return f"{off.mean:+z.1f}".replace("-", "−")
    half = off.interval[1] - off.mean
    digits = _digits_for(half)
    return f"{off.mean:+z.{digits}f} ± {half:.{digits}f}".replace("-", "−")


def _today(session: Session) -> list[Table]:
    """Each result as measured, and what it becomes in the changed air: the measured one plus the model's change."""
    if not session.model.changed:
        return []
    measures = [session.first.shots.measures[key] for key in session.model.changed]
    rows = []
    for name, by in session.changed_by_group().items():
        means = [session.first.summary(name, one) for one in measures]
        rows.append([name, *(_then(mean, by.get(one.key)) for mean, one in zip(means, measures, strict=True))])
    what = ", ".join(f"{key} = {argument(value)}" for key, value in session.model.changes.items())
    how = "measured mean plus the model's change (in brackets), for the same launches"
    columns = [Column(one.heading) for one in measures]
    return [Table([words(session.first.shots.by), *columns], rows, f"with {what}", [how])]


def _then(mean: Numbers | Share | None, change: Compared | None) -> str:
    """``241.3 (−3.8)``."""
    if not isinstance(mean, Numbers) or change is None:
        return ""
    return f"{mean.mean + change.off.mean:.1f} ({change.off.mean:+z.1f})".replace("-", "−")


# --------------------------------------------------------------------------------------------------------------- notes


def _about(session: Session, parts: Sequence[Part]) -> Notes:
    notes = [_rule(session)]
    for part in parts:
        name = f"{part.shots.path.name}: " if len(parts) > 1 else ""
        notes += [f"{name}{sentence}" for sentence in (*_mishits(part), *part.shots.notes)]
    found = session.model.results
    if found is not None:
        usual = [note for note in found.notes if "taken as usual" in note]
        notes += [*usual, *_assumed(session, " ".join(usual))]
    if any(part.ellipses(name) for part in parts for name in part.groups):
        inner, outer = (f"{100 * share:.0f} %" for share in SHARES)
        notes.append(f"ellipses hold {inner} and {outer} of shots that scatter normally as these do")
    return Notes(notes, "how it was done")


def _rule(session: Session) -> str:
    if session.mishit is None or session.first.shots.distance is None:
        return "all shots count" + ("" if session.mishit is None else ", since the file has no distance of a shot")
    return (
        f"mishits are set aside: shots that are too slow, too short, or too far to either side for their group, by a "
        f"modified z-score beyond {session.mishit:g} (Iglewicz and Hoaglin 1993), in groups of {FEWEST} shots or more, "
        f"which scatter by {100 * NARROW:g} % of their distance at least; --set-aside none counts all"
    )


def _mishits(part: Part) -> list[str]:
    if not part.set_aside:
        return []
    named = "; ".join(f"row {one.row} ({one.group}), {one.why}" for one in part.set_aside[:_MOST])
    more = f"; and {len(part.set_aside) - _MOST} more, which --json lists" if len(part.set_aside) > _MOST else ""
    return [f"set aside: {named}{more}"]


def _assumed(session: Session, usual: str) -> list[str]:
    """Name the parts of a launch, such as the spin, that the model needs and neither the file has nor is ``usual``."""
    shots = session.first.shots
    needs = ("launch.speed", "launch.angle", "launch.spin")
    lacking = (key for key in needs if key not in shots.measures and key not in usual)
    values = (f"{key} = {value_at(shots.scene.parameters, key):g}" for key in lacking)
    return [f"{value} is not in the file, and taken from the scene" for value in values]
