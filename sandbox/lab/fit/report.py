"""The report of a fit: its values, and what is to be said of them."""

from __future__ import annotations

import re
from collections.abc import Iterator
from functools import partial
from math import inf
from typing import Any

from sandbox.lab.fit.advice import advice
from sandbox.lab.fit.chart import charts
from sandbox.lab.fit.falling import gravity_hint
from sandbox.lab.fit.intervals import HARDLY
from sandbox.lab.fit.loss import OUTLIER, SQUARES, TUKEY
from sandbox.lab.fit.squares import Fit, Value
from sandbox.lab.report import Column, Notes, Report, Table, words
from sandbox.lab.selection import used
from sandbox.lab.tables import length
from sandbox.scene.writing import command
from sandbox.sport.amounts import significant
from sandbox.text import one_line, with_noun

#: Errors of two values that are correlated more than this are strongly so, and this cannot be told apart at all.
_STRONG, _NOT = 0.95, 0.999

#: Differences of Akaike's criterion up to which models are alike, and from which one is ruled out (Burnham & Anderson
#: 2002, section 2.6).
_AS_GOOD, _RULED_OUT = 2.0, 10.0

#: Most outliers that are listed, and other minima.
_MOST, _OTHERS = 12, 3

#: Names of columns that say what a scene in one plane leaves out: they are listed first.
_SIDEWAYS = re.compile(r"side|direction|azimuth|curve|offline|deviation|launch h|aim|axis|dispersion", re.IGNORECASE)

#: Digits of a value that are shown, at most: data without noise tell more.
_SHOWN = 7


def report_of(found: Fit) -> Report:
    """The values with their intervals, points and residuals as charts, and what is to be said of them; as details the
    correlations, and the models that were compared."""
    pairs = [
        (f"{one} and {other}", value, "hardly told apart" if abs(value) > HARDLY else "")
        for (one, other), value in found.correlations.items()
    ]
    correlations = [words(), Column("correlation", write="{:.3f}".format), words()]
    models = [(name, each.failure if each.fit is None else each.behind) for name, each in found.models.items()]
    behind = [words(), Column("AICc above the best", write="{:.1f}".format)]
    values = [words(), Column("value"), words(), words("95 % interval"), Column()]
    return Report(
        partial(document, found),
        title(found),
        [
            Table(values, value_rows(found)),
            *charts(found, title(found), value_rows(found)),
            Notes(list(sentences(found))),
            Table(correlations, pairs, "correlations of the errors", detail=True),
            Table(behind, models, f"models: {found.models_of}", detail=True),
        ],
        command=command(found.scene),
    )


def title(found: Fit) -> str:
    """``basketball: 40 points, least squares``."""
    return f"{found.scene.title}: {with_noun(found.measured.count, found.measured.what)}, {found.loss}"


def value_rows(found: Fit) -> list[tuple[str, ...]]:
    """Key, value, unit, interval, and half of it as a share of the value."""
    rows: list[tuple[str, ...]] = []
    for key, one in found.values.items():
        half = one.half
        digits = _digits(one, half if one.at_bound else found.half_widths[key])
        if half is None:
            why = "no result: at the end of its range" if one.at_bound else "none: hardly told apart"
            rows.append((key, f"{one.value:.{digits}f}", one.unit, why, ""))
            continue
        percent = round(100.0 * half / abs(one.value), _SHOWN - 1) if one.value and half < abs(one.value) else None
        share = "" if percent is None else f"± {significant(percent)} %"
        rows.append((key, f"{one.value:.{digits}f}", one.unit, f"{one.low:.{digits}f} to {one.high:.{digits}f}", share))
    return rows


def _digits(one: Value, half: float | None) -> int:
    """Decimals that show half an interval with two digits, but at most seven digits of the value; the fewest that show
    a value without one."""
    if half is None:
        return min(len(f"{one.value:.6f}".rstrip("0").partition(".")[2]), 6)
    most = _SHOWN - 1 - _exponent(one.value)
    return max(0, min(1 - _exponent(half), most) if half > 0.0 else most)


def _exponent(number: float) -> int:
    return int(f"{number:e}".partition("e")[2])


def residual_text(found: Fit) -> str:
    """``4.7 mm in x, 4.4 mm in y``."""
    sds = zip(found.residual_sd.items(), found.measured.units, strict=True)
    parts = [f"{length(sd) if unit == 'm' else f'{significant(sd)} {unit}'.rstrip()} in {name}"
             for (name, sd), unit in sds]  # fmt: skip
    return ", ".join(parts)


def sentences(found: Fit) -> Iterator[str]:
    """All that is to be said of a fit, the most important first."""
    yield f"standard deviation of the residuals: {residual_text(found)}"
    measured = found.measured
    if measured.left_out:
        yield used(measured.count + len(measured.left_out), measured.left_out, measured.what)
    if found.pattern:
        yield (
            f"the model does not explain all: the residuals have a pattern, and are {significant(found.pattern)} times "
            "as large as neighbouring ones differ"
        )
        hint = "" if "gravity" in found.values else gravity_hint(found.scene, measured, found.free)
        if hint:
            yield hint
    if found.robust_by:
        alike = ", ".join(f"each {name}" if not name.startswith("blocks") else name for name in found.robust_by)
        yield (
            f"errors are alike in {alike}, by more than chance: the intervals come from how much these differ "
            "(robust). What they have in common, such as a wrong scale, no interval shows"
        )
    yield from _of_values(found)
    yield from _of_others(found)
    yield from _of_pairs(found)
    if found.models:
        yield _models_text(found)
    if found.outliers:
        rows = ", ".join(map(str, found.outliers[:_MOST]))
        more = f" and {len(found.outliers) - _MOST} more" if len(found.outliers) > _MOST else ""
        hint = "; --robust counts them less" if found.loss == SQUARES.name else ""
        yield f"{'outliers' if len(found.outliers) > 1 else 'outlier'}, beyond {OUTLIER:g} sd: row {rows}{more}{hint}"
    if found.late:
        yield (
            f"{with_noun(found.late, found.measured.what)} later than {found.end:.3g} s, where this scene ends its "
            "runs: compared with the run that goes on"
        )
    yield from found.remarks
    if measured.unused:
        more = f" and {len(measured.unused) - _MOST} more" if len(measured.unused) > _MOST else ""
        first = sorted(measured.unused, key=lambda name: not _SIDEWAYS.search(name))
        yield f"columns that are not used: {', '.join(first[:_MOST])}{more}"
    yield assumed(found)


def assumed(found: Fit) -> str:
    """Say what was assumed of the errors."""
    *most, last = found.measured.names
    names = f"{', '.join(most)} and {last}" if most else last
    alike = "" if len(found.measured.names) == 1 else f", alike in {names}" if found.pooled else f"; {names} weighted"
    apart = "" if found.pooled or len(found.measured.names) == 1 else " by the scatter of each"
    robust = f"; what is {TUKEY:.1f} sd off does not count" if found.loss != SQUARES.name else ""
    groups = " but for these groups" if found.robust_by else ""
    return f"assumed: errors of all {found.measured.what}s are independent{groups} and normal{alike}{apart}{robust}"


def _of_values(found: Fit) -> Iterator[str]:
    for key, one in found.values.items():
        if one.at_bound:
            end = f"{one.value:g} {one.unit}".rstrip()
            yield (
                f"{key} stopped at the end of its range, {end}: that is no result, and has no interval. A wider range, "
                "or other rows, may have one"
            )
        elif one.unknown:
            yield f"{key} is not determined by these {found.measured.what}s: its interval is all of its range"


def _of_pairs(found: Fit) -> Iterator[str]:
    for (first, second), value in found.correlations.items():
        known = not (found.values[first].unknown or found.values[second].unknown)
        if abs(value) > _STRONG and known:
            help_ = advice(found, first, second)
            how = f"have strongly correlated errors ({value:.3f})"
            if abs(value) > HARDLY:
                can = "cannot" if abs(value) > _NOT else "can hardly"
                how = f"{can} be told apart (correlation {value:.3f}), and have no intervals"
            yield f"{first} and {second} {how}" + (f": {help_}" if help_ else "")


def _of_others(found: Fit) -> Iterator[str]:
    """Say which other values explain the data as well."""
    if not found.others:
        return
    said = []
    for other in found.others[:_OTHERS]:
        apart = [key for key, one in found.values.items() if not one.holds(other.values[key])]
        named = [f"{key} = {other.values[key]:.{_digits(found.values[key], found.half_widths[key])}f} "
                 f"{found.values[key].unit}".rstrip() for key in apart]  # fmt: skip
        said.append(f"{', '.join(named)} (chi^2 {other.more:.1f} more)")
    more = f"; and {len(found.others) - _OTHERS} more" if len(found.others) > _OTHERS else ""
    well = "as well" if found.others[0].more < _AS_GOOD else "nearly as well"
    listed, what = "; ".join(said) + more, found.measured.what
    yield (
        f"other values explain these {what}s {well}: {listed}. The intervals are for those above only; narrower ranges "
        "(--vary) decide"
    )


def _models_text(found: Fit) -> str:
    """Say in a sentence which model fits best."""
    (best, _), *others = found.models.items()
    limits = {
        ("fits", "fit", "as well"): _AS_GOOD,
        ("fits", "fit", "worse"): _RULED_OUT,
        ("is", "are", "ruled out"): inf,
    }
    said, beyond = [f"{found.models_of}: {best} fits best"], -inf
    for (one, several, rest), limit in limits.items():
        some = [f"{name} (AICc {each.behind:.1f} more)" for name, each in others if beyond <= each.behind < limit]
        said += [f"{', '.join(some)} {several if len(some) > 1 else one} {rest}"] if some else []
        beyond = limit
    failed = [f"{name}: {one_line(each.failure)}" for name, each in others if each.fit is None]
    return "; ".join([*said, *(f"not fitted, {why}" for why in failed)])


def document(found: Fit) -> dict[str, Any]:
    """For JSON; every value in its unit."""
    kinds = {one.interval_kind for one in found.values.values()}
    return {
        "scene": found.scene.name,
        "preset": found.scene.preset,
        "values": found.values,
        "residual_sd": found.residual_sd,
        "correlations": {f"{one}, {other}": value for (one, other), value in found.correlations.items()},
        "others": [{"values": other.values, "chi2_more": other.more} for other in found.others],
        "outliers": found.outliers,
        "points": found.measured.count,
        "left_out": found.measured.left_out,
        "unused": found.measured.unused,
        "late": found.late,
        "loss": found.loss,
        "pattern": found.pattern,
        "interval_kind": next((kind for kind in ("robust", "normal") if kind in kinds), None),
        "robust_by": found.robust_by,
        "models": {
            word: {"behind": each.behind if each.fit is not None else None, "failure": each.failure or None}
            for word, each in found.models.items()
        },
        "said": list(sentences(found)),
    }
