"""Reports of a spread: text for the terminal, and JSON."""

from __future__ import annotations

from typing import Any

from sandbox.files import json_text
from sandbox.lab.spread import Indices, Spread
from sandbox.lab.spread.needs import Need
from sandbox.lab.statistics import QUANTILES, Ellipse, Numbers, Share
from sandbox.lab.tables import paragraph, table
from sandbox.sport.amounts import amount, in_chosen_unit, ladder, margin, signed, significant, written
from sandbox.text import one_line
from sandbox.units import convert

#: The quantiles of the text, of those that JSON has.
_SHOWN = (0.05, 0.5, 0.95)

#: Most words with a share each in the text.
_MOST_WORDS = 6

# ---------------------------------------------------------------------------------------------------------------------
# JSON
# ---------------------------------------------------------------------------------------------------------------------


def as_json(spread: Spread) -> str:
    """One JSON object; every number is in its fact's unit, shares are from 0 to 1."""
    told: dict[str, Any] = {
        "scene": spread.scene.name,
        "preset": spread.scene.preset,
        "by": {each.key: {"sd": each.sd, "unit": each.unit} for each in spread.by},
        "samples": spread.samples,
        "seed": spread.seed,
        "sampling": spread.sampling,
        "facts": {name: _numbers(found) | {"unit": spread.scene.units[name]} for name, found in spread.numbers.items()},
        "share": {name: _share(found) for name, found in spread.shares.items()},
        "words": {name: {word: _share(it) for word, it in words.items()} for name, words in spread.words.items()},
        "causes": {name: {key: _indices(it) for key, it in by.items()} for name, by in spread.causes.items()},
        "ellipses": {name: _ellipse(found) for name, found in spread.ellipses.items()},
        "needed": [{"fact": it.fact, "within": it.within, "shots": it.shots} for it in spread.needs],
        "failures": spread.failures,
        "first_error": next(iter(spread.runs.errors.values()), None),
    }
    return json_text(told)


def _numbers(found: Numbers) -> dict[str, Any]:
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


def _indices(found: Indices) -> dict[str, float]:
    errors = {"first_error": found.first_error, "total_error": found.total_error}
    return {"first": found.first, "total": found.total} | errors


def _ellipse(found: Ellipse) -> dict[str, Any]:
    long, short = found.axes
    about = {"center": list(found.center), "semi_axes": [long, short], "angle": found.angle, "inside": found.inside}
    return about | {"unit": "m"}


# ---------------------------------------------------------------------------------------------------------------------
# Text
# ---------------------------------------------------------------------------------------------------------------------


def as_text(spread: Spread) -> list[str]:
    """Lines for the terminal."""
    parts = [
        [*paragraph(title(spread), ""), *paragraph(about(spread))],
        _share_lines(spread),
        _number_lines(spread),
        _ellipse_lines(spread),
        _cause_lines(spread),
        _need_lines(spread),
        _failure_lines(spread),
    ]
    lines: list[str] = []
    for part in filter(None, parts):
        lines += [*([""] if lines else []), *part]
    return lines


def title(spread: Spread) -> str:
    """``golf: 1,024 shots at Sobol points, seed 0``."""
    points = "at Sobol points" if spread.sampling == "sobol" else "at random points"
    return f"{spread.scene.title}: {spread.samples:,} shots {points}, seed {spread.seed}"


def about(spread: Spread) -> str:
    """Return the parameters that scatter, each with its scatter, as text."""
    return ", ".join(each.as_text() for each in spread.by)


def name_of(spread: Spread, fact: str) -> str:
    """A fact as people read it."""
    return spread.scene.facts[fact].label or fact.replace("_", " ")


def value(spread: Spread, fact: str, number: float) -> str:
    """A number of a fact with its unit, and its sign where its two sides have words."""
    it = spread.scene.facts[fact]
    return amount(float(number), it.unit, it.digits)


def deviation(spread: Spread, fact: str, sd: float) -> str:
    """A standard deviation in a fact's unit or the chosen one, to two digits."""
    size, unit = in_chosen_unit(sd, spread.scene.units[fact])
    return f"{significant(size)} {unit}".rstrip().replace(" deg", "°")


def mean_and_deviation(spread: Spread, fact: str, mean: float, sd: float) -> str:
    """Both in the unit of the larger: ``−0.02 m ± 0.14 m``."""
    it = spread.scene.facts[fact]
    steps = ladder(it.unit)
    step = next((step for step in steps if max(abs(mean), sd) >= step.least), None)
    if step is None:
        return f"{value(spread, fact, mean)} ± {deviation(spread, fact, sd)}"
    size = convert(sd, it.unit, step.unit) if it.unit != step.unit else sd
    deviates = f"{significant(size)} {step.unit}".replace(" deg", "°")
    return f"{written(float(mean), it.unit, [step], it.digits)} ± {deviates}"


def percent(share: float) -> str:
    """``63.1 %``."""
    return f"{100.0 * share:.1f} %"


def share_rows(spread: Spread) -> list[tuple[str, str, str]]:
    """Name, share, and its interval: of what is true or false, and of the most common words."""
    rows = [(name_of(spread, name), it) for name, it in spread.shares.items()]
    for name, words in spread.words.items():
        if len(words) > 1:
            rows += [(f"{name_of(spread, name)}: {word}", it) for word, it in list(words.items())[:_MOST_WORDS]]
    return [(name, percent(it.value), " to ".join(percent(end) for end in it.interval)) for name, it in rows]


def _share_lines(spread: Spread) -> list[str]:
    rows = share_rows(spread)
    return table(("", "share", "95 % interval"), rows, "lrr") if rows else []


def number_rows(spread: Spread) -> list[tuple[str, ...]]:
    """Name, mean, standard deviation, quantiles, and how many shots have it, if not all."""
    rows = []
    for name in spread.displayed:
        if name in spread.numbers:
            it = spread.numbers[name]
            quantiles = [value(spread, name, each) for each in it.quantiles(_SHOWN).values()]
            some = f"{it.count:,}" if it.count < spread.samples else ""
            rows.append((name_of(spread, name), value(spread, name, it.mean), deviation(spread, name, it.sd),
                         *quantiles, some))  # fmt: skip
    return rows


#: The headings of ``number_rows``.
NUMBERS = ("", "mean", "sd", *(f"{100 * share:g} %" for share in _SHOWN), "shots")


def _number_lines(spread: Spread) -> list[str]:
    rows = number_rows(spread)
    still = [name_of(spread, name) for name, it in spread.numbers.items() if not it.varies]
    same = paragraph(f"the same in all shots: {', '.join(still)}") if still else []
    heads = NUMBERS if any(row[-1] for row in rows) else (*NUMBERS[:-1], "")
    return [*(table(heads, rows, "lrrrrrr") if rows else []), *same]


def ellipse_rows(spread: Spread) -> list[tuple[str, ...]]:
    """Name, centre, axes, direction, and the share of the shots that are inside."""
    rows: list[tuple[str, ...]] = []
    for name, it in spread.ellipses.items():
        _, unit = in_chosen_unit(max(it.axes), "m")  # of the whole row
        x, y, long, short = (convert(each, "m", unit) for each in (*it.center, *it.axes))
        rows.append((name, f"{signed(f'{x:.2f}')}, {signed(f'{y:.2f}')} {unit}", f"{significant(long)} {unit}",
                     f"{significant(short)} {unit}", f"{signed(f'{it.angle:.0f}')}°", percent(it.inside)))  # fmt: skip
    return rows


#: The headings of ``ellipse_rows``.
ELLIPSES = ("95 % ellipse", "centre", "half long", "half short", "direction", "inside")


def _ellipse_lines(spread: Spread) -> list[str]:
    rows = ellipse_rows(spread)
    return table(ELLIPSES, rows, "lrrrrr") if rows else []


def cause_rows(spread: Spread) -> list[tuple[str, ...]]:
    """Name, and for each cause the share of the variance that it makes alone, and with others."""
    rows = []
    for name, by in spread.causes.items():
        if name in spread.displayed and len(by) > 1:
            texts = (f"{_whole(it.first)} / {_whole(it.total)} %" for it in by.values())
            rows.append((name_of(spread, name), *texts))
    return rows


def _whole(share: float) -> str:
    return f"{min(max(100.0 * share, 0.0), 100.0):.0f}"


#: What the numbers of ``cause_rows`` are.
CAUSES = "share of the variance that each cause makes alone / with all that it does together with others"


def _cause_lines(spread: Spread) -> list[str]:
    rows = cause_rows(spread)
    if not rows:
        return []
    keys = [each.key for each in spread.by]
    worst = max(max(it.first_error, it.total_error) for by in spread.causes.values() for it in by.values())
    lines = [*paragraph(f"{CAUSES} (± {100 * worst:.0f} % at most)", "")]
    return [*lines, *table(("", *keys), rows, "l" + "r" * len(keys))]


def need_rows(spread: Spread) -> list[tuple[str, str]]:
    """Return rows of a certainty and the random shots that it needs."""
    return [(f"{name_of(spread, it.fact)} within {_width(spread, it)}", f"{it.shots:,}") for it in spread.needs]


def _need_lines(spread: Spread) -> list[str]:
    rows = need_rows(spread)
    if not rows:
        return []
    return [*paragraph("shots that a real test needs, to be 95 % certain of the mean or the share", ""),
            *table(("", ""), rows, "lr")]  # fmt: skip


def _width(spread: Spread, need: Need) -> str:
    if need.fact in spread.shares:
        return f"± {significant(100.0 * need.within)} %"
    return margin(need.within, spread.scene.units[need.fact])


def _failure_lines(spread: Spread) -> list[str]:
    errors = spread.runs.errors
    if not errors:
        return []
    return paragraph(
        f"{len(errors):,} of {len(spread.runs):,} shots failed, first with: {one_line(errors[min(errors)])}"
    )
