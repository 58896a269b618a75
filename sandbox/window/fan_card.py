"""The card of a fan: how many of the shots score, and the histogram of their most important number."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import pygame

from sandbox.lab.statistics import Numbers
from sandbox.picture.palette import Colour, palette
from sandbox.sport.amounts import amount
from sandbox.sport.facts import Fact
from sandbox.window.canvas import Canvas
from sandbox.window.layout import Form

_CARD = palette("card")

#: Height of the bars and least width of the card, px on 720 rows; the number of bars.
_HEIGHT, _WIDE, _BARS = 44, 210, 20
#: The shares of the shots between which a range is given.
_RANGE = (0.05, 0.95)


class Bars(NamedTuple):
    """A histogram of the shots of a fan."""

    title: str  # mean and range
    ends: tuple[str, str]  # the lowest and the highest value, with its unit
    good: tuple[int, ...]  # shots that score, in each bar
    rest: tuple[int, ...]
    mean: float  # its place, as a share of the width


def bars_of(fact: Fact, values: Sequence[float], scored: Sequence[bool]) -> Bars | None:
    """The histogram of a number over the shots that have it; None if it does not vary."""
    found, hits = Numbers(np.array(values, float)), np.array(scored)
    if found.count < 2 or not found.varies:
        return None
    counts, edges = found.histogram(_BARS)
    good = np.histogram(found.values[hits], edges)[0]
    low, high = (amount(each, fact.unit, fact.digits) for each in found.quantiles(_RANGE).values())
    title = f"{fact.label} {amount(found.mean, fact.unit, fact.digits)}, 90 % {low} to {high}"
    ends = amount(float(edges[0]), fact.unit, fact.digits), amount(float(edges[-1]), fact.unit, fact.digits)
    place = (found.mean - edges[0]) / (edges[-1] - edges[0])
    return Bars(title, ends, tuple(good.tolist()), tuple((counts - good).tolist()), float(place))


def fan_forms(sheet: Canvas, lines: Sequence[tuple[str, Colour]], bars: Bars | None) -> list[Form]:
    """The texts with the histogram below them, wide and narrower; and the texts alone."""
    texts = sheet.notes(lines)
    if bars is None:
        return texts
    letters, gap = sheet.lettering, sheet.gap
    longest = max(letters.width(bars.title, "small"), letters.width("".join(bars.ends), "small") + 2 * gap)
    below = 2 * letters.height("small") + round(_HEIGHT * sheet.unit) + gap
    forms = sheet.notes(lines, max(round(_WIDE * sheet.unit), longest + 4 * gap), below)
    shorter = [form._replace(whole=False) for form in texts]
    return [*(_with_bars(sheet, form, bars, below) for form in forms if form.whole), *shorter]


def _with_bars(sheet: Canvas, card_form: Form, bars: Bars, below: int) -> Form:
    letters, gap, unit = sheet.lettering, sheet.gap, sheet.unit
    row, tall = letters.height("small"), round(_HEIGHT * unit)

    def draw(card: pygame.Rect) -> None:
        card_form.draw(card)
        left, right = card.left + 2 * gap, card.right - 2 * gap
        top = card.bottom - below
        letters.write(sheet.surface, bars.title, "small", (left, top), _CARD["text"])
        foot = top + row + gap // 2 + tall
        most = max(map(sum, zip(bars.good, bars.rest, strict=True)))
        each = (right - left) / len(bars.good)
        for place, counts in enumerate(zip(bars.good, bars.rest, strict=True)):
            begin, end = round(left + place * each), round(left + (place + 1) * each)
            base = foot
            for count, colour in zip(counts, (_CARD["good"], _CARD["quiet"]), strict=True):
                high = round(tall * count / most)
                sheet.surface.fill(colour, (begin, base - high, end - begin - 1, high))
                base -= high
        thin = max(1, round(2 * unit))
        sheet.surface.fill(_CARD["accent"], (round(left + bars.mean * (right - left)), foot - tall, thin, tall))
        letters.write(sheet.surface, bars.ends[0], "small", (left, foot), _CARD["quiet"])
        letters.write(sheet.surface, bars.ends[1], "small", (right, foot), _CARD["quiet"], "topright")

    return card_form._replace(draw=draw)
