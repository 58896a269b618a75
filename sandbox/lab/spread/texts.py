"""The facts of a spread in words and numbers for people."""

from __future__ import annotations

from sandbox.lab.spread.spreading import Spread
from sandbox.sport.amounts import amount, in_chosen_unit, ladder, significant, written
from sandbox.units import convert


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
