"""The report of a spread: its numbers as tables, histograms and causes as charts."""

from __future__ import annotations

from functools import partial
from typing import Any

from sandbox.lab.axes import Span
from sandbox.lab.report import Column, Notes, Report, Table, words
from sandbox.lab.spread.chart import charts
from sandbox.lab.spread.needs import Need
from sandbox.lab.spread.spreading import Indices, Spread
from sandbox.lab.spread.texts import deviation, name_of, percent, value
from sandbox.lab.statistics import QUANTILES, Ellipse, Numbers, Share
from sandbox.scene.writing import command
from sandbox.sport.amounts import in_chosen_unit, margin, signed, significant
from sandbox.text import argument, one_line
from sandbox.units import convert

#: The quantiles of the text, of those that JSON has.
_SHOWN = (0.05, 0.5, 0.95)

#: Most words with a share each in the text.
_MOST_WORDS = 6


def report_of(spread: Spread) -> Report:
    """Shares, numbers, ellipses, causes, and the shots that a real test needs."""
    points = "at Sobol points" if spread.sampling == "sobol" else "at random points"
    shots = f"{spread.samples:,} shots {points}, seed {spread.seed}"
    about = ", ".join(each.as_text() for each in spread.by)
    tables = [_shares(spread), _numbers(spread), _ellipses(spread), _causes(spread), _needs(spread)]
    return Report(
        partial(document, spread),
        f"{spread.scene.title}: {shots}",
        [Notes([about]), *charts(spread, f"{shots}\n{about}"), *tables, Notes(_failures(spread))],
        command=command(spread.scene, "spread", *_options(spread)),
    )


def _options(spread: Spread) -> list[str]:
    """The options of the command that makes the page."""
    options = []
    for each in spread.by:
        axis = each.axis
        text = (
            f"{argument(axis.low)}:{argument(axis.high)}" if isinstance(axis, Span) else each.given or argument(axis.sd)
        )
        options += ["--by", f"{each.key}={text}"]
    if spread.only:
        options += [word for name in spread.runs.facts for word in ("--of", name)]
    options += ["--samples", str(spread.samples), "--seed", str(spread.seed)]
    options += ["--sampling", "random"] if spread.sampling == "random" else []
    options += [word for name, width in spread.within.items() for word in ("--within", f"{name}={width:g}")]
    return [*options, *([] if spread.points.pairs or len(spread.by) == 1 else ["--no-causes"]), "--html", "spread.html"]


# ---------------------------------------------------------------------------------------------------------------------
# JSON
# ---------------------------------------------------------------------------------------------------------------------


def document(spread: Spread) -> dict[str, Any]:
    """For JSON; every number is in its fact's unit, shares are from 0 to 1."""
    facts = {name: _number(found) | {"unit": spread.scene.units[name]} for name, found in spread.numbers.items()}
    return {
        "scene": spread.scene.name,
        "preset": spread.scene.preset,
        "by": {each.key: {"sd": each.sd, "unit": each.unit} for each in spread.by},
        "samples": spread.samples,
        "seed": spread.seed,
        "sampling": spread.sampling,
        "facts": facts,
        "share": {name: _share(found) for name, found in spread.shares.items()},
        "words": {name: {word: _share(it) for word, it in each.items()} for name, each in spread.words.items()},
        "causes": spread.causes,
        "ellipses": {name: _ellipse(found) for name, found in spread.ellipses.items()},
        "needed": spread.needs,
        "failures": spread.failures,
        "first_error": next(iter(spread.runs.errors.values()), None),
    }


def _number(found: Numbers) -> dict[str, Any]:
    counts, edges = found.histogram()
    return {
        "mean": found.mean,
        "sd": found.sd,
        "quantiles": {f"{share:g}": value for share, value in found.quantiles(QUANTILES).items()},
        "shots": found.count,
        "histogram": {"edges": edges.tolist(), "counts": counts.tolist()},
    }


def _share(found: Share) -> dict[str, Any]:
    low, high = found.interval
    return {"value": found.value, "low": low, "high": high}


def _ellipse(found: Ellipse) -> dict[str, Any]:
    long, short = found.axes
    about = {"center": list(found.center), "semi_axes": [long, short], "angle": found.angle, "inside": found.inside}
    return about | {"unit": "m"}


# ---------------------------------------------------------------------------------------------------------------------
# Tables
# ---------------------------------------------------------------------------------------------------------------------


def _shares(spread: Spread) -> Table:
    """The share of what is true or false, and of the most common words, with its interval."""
    found = [(name_of(spread, name), it) for name, it in spread.shares.items()]
    for name, by_word in spread.words.items():
        if len(by_word) > 1:
            found += [(f"{name_of(spread, name)}: {word}", it) for word, it in list(by_word.items())[:_MOST_WORDS]]
    rows = [(name, it.value, " to ".join(map(percent, it.interval))) for name, it in found]
    return Table([words(), Column("share", write=percent), Column("95 % interval")], rows)


def _numbers(spread: Spread) -> Table:
    """Mean, standard deviation and quantiles of each number, and how many shots have it, if not all."""
    rows = []
    for name in spread.displayed:
        if name in spread.numbers:
            it = spread.numbers[name]
            numbers = [value(spread, name, number) for number in (it.mean, *it.quantiles(_SHOWN).values())]
            some = it.count if it.count < spread.samples else None
            rows.append([name_of(spread, name), numbers[0], deviation(spread, name, it.sd), *numbers[1:], some])
    still = [name_of(spread, name) for name, it in spread.numbers.items() if not it.varies]
    same = [f"the same in all shots: {', '.join(still)}"] if still else []
    shots = Column("shots" if any(row[-1] for row in rows) else "", write="{:,}".format)
    heads = ("mean", "sd", *(f"{100 * share:g} %" for share in _SHOWN))
    return Table([words(), *map(Column, heads), shots], rows, notes=same)


def _ellipses(spread: Spread) -> Table:
    """Centre, axes and direction of where balls come to lie, and the share of the shots that are inside."""
    rows: list[list[Any]] = []
    for name, it in spread.ellipses.items():
        _, unit = in_chosen_unit(max(it.axes), "m")  # of the whole row
        x, y, long, short = (convert(each, "m", unit) for each in (*it.center, *it.axes))
        axes = (f"{significant(half)} {unit}" for half in (long, short))
        rows.append([name, f"{signed(f'{x:.2f}')}, {signed(f'{y:.2f}')} {unit}", *axes, it.angle, it.inside])
    columns = [words("95 % ellipse"), *map(Column, ("centre", "half long", "half short"))]
    columns += [Column("direction", "deg", digits=0), Column("inside", write=percent)]
    return Table(columns, rows)


def _causes(spread: Spread) -> Table:
    """The share of the variance that each cause makes alone, and with all that it does together with others."""
    several = {name: by for name, by in spread.causes.items() if name in spread.displayed and len(by) > 1}
    worst = max((max(it.first_error, it.total_error) for by in several.values() for it in by.values()), default=0.0)
    title = "share of the variance that each cause makes alone / with all that it does together with others"
    columns = [words(), *(Column(each.key, write=_both) for each in spread.by)]
    rows = [[name_of(spread, name), *by.values()] for name, by in several.items()]
    return Table(columns, rows, f"{title} (± {100 * worst:.0f} % at most)")


def _both(found: Indices) -> str:
    alone, together = (min(max(100.0 * share, 0.0), 100.0) for share in (found.first, found.total))
    return f"{alone:.0f} / {together:.0f} %"


def _needs(spread: Spread) -> Table:
    rows = [(f"{name_of(spread, it.fact)} within {_width(spread, it)}", it.shots) for it in spread.needs]
    title = "shots that a real test needs, to be 95 % certain of the mean or the share"
    return Table([words(), Column(write="{:,}".format)], rows, title)


def _width(spread: Spread, need: Need) -> str:
    if need.fact in spread.shares:
        return f"± {significant(100.0 * need.within)} %"
    return margin(need.within, spread.scene.units[need.fact])


def _failures(spread: Spread) -> list[str]:
    errors = spread.runs.errors
    if not errors:
        return []
    return [f"{len(errors):,} of {len(spread.runs):,} shots failed, first with: {one_line(errors[min(errors)])}"]
