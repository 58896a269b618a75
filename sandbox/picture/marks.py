"""A path on a sheet: its trace, and marks where its ball struck something."""

from __future__ import annotations

from collections.abc import Iterable
from math import atan2, dist, hypot, pi

import numpy as np

from sandbox.picture.camera import Camera
from sandbox.picture.lettering import around
from sandbox.picture.palette import Colour, palette
from sandbox.picture.path import Mark
from sandbox.picture.sheet import Sheet
from sandbox.sport.amounts import amount

CARD, TRACE = palette("card"), palette("trace")

#: A label this far from its mark, in px on 720 rows, has a line that leads to it.
FARTHER = (25, 36, 50)


def draw_trace(sheet: Sheet, points: np.ndarray, colour: Colour, share: float = 1.0) -> None:
    """The path as a thick line with a thin dark rim, or a ``share`` as thick; no label will be placed on it."""
    sheet.labels.take_path(points, 4 * sheet.unit)
    width = share * max(2.5, 4.5 * sheet.unit)
    sheet.painter.trace(points, width, colour, TRACE["rim"], max(0.75, sheet.unit))


def draw_mark(sheet: Sheet, at: tuple[float, float]) -> None:
    """Where a ball struck something."""
    radius = max(2.5, 4.2 * sheet.unit)
    sheet.painter.disc(at, radius + max(0.8, 1.2 * sheet.unit), TRACE["rim"], 0.8)
    sheet.painter.disc(at, radius, CARD["accent"])
    sheet.painter.disc(at, 0.4 * radius, CARD["background"])


def mark_impacts(
    sheet: Sheet, camera: Camera, marks: Iterable[Mark], last: tuple[tuple[float, float], float] | None = None
) -> None:
    """Impacts as marks with the speed at which the ball came.

    The ball in its ``last`` place, of a radius, lies over them; in px.
    """
    places = [(camera.pixel(*mark.at), mark) for mark in marks]
    for at, _ in places:
        if last is None or dist(at, last[0]) > last[1]:
            draw_mark(sheet, at)
        sheet.labels.take_path([at], 4 * sheet.unit)
    for at, mark in places:
        label_mark(sheet, at, mark.towards, amount(mark.speed, "m/s", 1))


def label_mark(sheet: Sheet, at: tuple[float, float], towards: tuple[float, float], text: str) -> None:
    """A text on a dark chip beside a mark, rather on the side of what was struck (``towards``), if there is room.

    Where the chip is far from the mark, a thin line leads to it.
    """
    unit, first = sheet.unit, atan2(towards[1], towards[0])
    turns = [first + turn for turn in (0.0, 0.6, -0.6, 1.2, -1.2, 1.9, -1.9, pi)]
    placed = sheet.chip(text, around(at, [far * unit for far in (9, 16, *FARTHER)], turns))
    if placed is None:
        return
    near = min(max(at[0], placed.left), placed.right), min(max(at[1], placed.top), placed.bottom)
    length = hypot(near[0] - at[0], near[1] - at[1])
    if length > FARTHER[0] * unit * 0.9:
        start = at[0] + (near[0] - at[0]) * 4.2 * unit / length, at[1] + (near[1] - at[1]) * 4.2 * unit / length
        sheet.painter.line([start, near], max(1.0, 1.3 * unit), CARD["text"], 0.8)
