"""Paths on a sheet: the trace of one, marks where its ball struck something, and other runs, pale behind it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import atan2, dist, hypot, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from sandbox.picture.camera import Camera
from sandbox.picture.lettering import around
from sandbox.picture.painter import Painter, Point
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.path import FINEST, ImpactMark, apart
from sandbox.picture.sheet import Sheet
from sandbox.scene.scene_run import SceneRun
from sandbox.sport.amounts import amount

if TYPE_CHECKING:
    from sandbox.picture.view import View

_CARD, _TRACE = palette("card"), palette("trace")

#: A label this far from its mark, in px on 720 rows, has a line that leads to it.
_FARTHER = (25, 36, 50)
#: And one that is alone may be so far away.
_ALONE = 66
#: Lightening of a ghost's text on the card, compared with its trace.
_LIGHTER = 0.45
#: The label of a ghost may stand at about so many points of its path.
_ANCHORS = 12


def draw_trace(sheet: Sheet, points: np.ndarray, colour: Colour, share: float = 1.0) -> None:
    """The path as a thick line with a thin dark rim, or a ``share`` as thick; no label will be placed on it."""
    sheet.labels.take_path(points, 4 * sheet.unit)
    width = share * max(2.5, 4.5 * sheet.unit)
    sheet.painter.trace(points, width, colour, _TRACE["rim"], max(0.75, sheet.unit))


def draw_mark(sheet: Sheet, at: tuple[float, float]) -> None:
    """Mark the place where a ball struck something."""
    radius = max(2.5, 4.2 * sheet.unit)
    sheet.painter.disc(at, radius + max(0.8, 1.2 * sheet.unit), _TRACE["rim"], 0.8)
    sheet.painter.disc(at, radius, _CARD["accent"])
    sheet.painter.disc(at, 0.4 * radius, _CARD["background"])


def is_under(at: Point, ball: tuple[Point, float], edge: float) -> bool:
    """True if a ball, at a place with a radius, hides a mark or bead: its middle, by more than an ``edge``; in px.

    Where a ball touches something is on its rim, or by rounding a little inside.
    """
    return dist(at, ball[0]) < ball[1] - edge


def mark_impacts(
    sheet: Sheet, camera: Camera, marks: Iterable[ImpactMark], last: tuple[Point, float] = ((0.0, 0.0), 0.0)
) -> None:
    """Impacts as marks with the speed at which the ball came; the ball in its ``last`` place lies over them."""
    places = [(camera.pixel(*mark.at), mark) for mark in marks]
    for at, _ in places:
        if not is_under(at, last, sheet.unit):
            draw_mark(sheet, at)
        sheet.labels.take_path([at], 4 * sheet.unit)
    for at, mark in places:
        label_mark(sheet, at, mark.towards, amount(mark.speed, "m/s", 1), alone=len(places) == 1)


def label_mark(
    sheet: Sheet, at: tuple[float, float], towards: tuple[float, float], text: str, alone: bool = False
) -> None:
    """A text on a dark chip beside a mark, rather on the side of what was struck (``towards``), if there is room.

    Where the chip is far from the mark, a thin line leads to it.
    """
    unit, first = sheet.unit, atan2(towards[1], towards[0])
    turns = [first + turn for turn in (0.0, 0.6, -0.6, 1.2, -1.2, 1.9, -1.9, *((2.5, -2.5) if alone else ()), pi)]
    placed = sheet.chip(
        text, around(at, [far * unit for far in (9, 16, *_FARTHER, *([_ALONE] if alone else []))], turns)
    )
    if placed is None:
        return
    near = min(max(at[0], placed.left), placed.right), min(max(at[1], placed.top), placed.bottom)
    length = hypot(near[0] - at[0], near[1] - at[1])
    if length > _FARTHER[0] * unit * 0.9:
        start = at[0] + (near[0] - at[0]) * 4.2 * unit / length, at[1] + (near[1] - at[1]) * 4.2 * unit / length
        sheet.painter.line([start, near], max(1.0, 1.3 * unit), _CARD["text"], 0.8)


def lighter(colour: Colour) -> Colour:
    """Return the colour of another run as it is on a dark ground."""
    return mix(colour, _CARD["text"], _LIGHTER)


@dataclass(frozen=True)
class Ghost:
    """Another run: what it is called, its picture, its colour, and how far it is moved (m) to lie over this one."""

    label: str
    view: View[Any]
    colour: Colour
    shift: tuple[float, float]

    @property
    def run(self) -> SceneRun:
        return self.view.run

    @cached_property
    def points(self) -> np.ndarray:
        """Its path where it is drawn, in m, shape (n, 2)."""
        return self.view.path.points + self.shift

    def at(self, t: float) -> np.ndarray:
        """Its ball where it is drawn at time t in s, in m, shape (1, 2)."""
        return np.array([self.run.state(self.view.ball, min(t, self.run.duration))[:2]]) + self.shift

    @property
    def light(self) -> Colour:
        """Its colour on a dark ground."""
        return lighter(self.colour)

    def colour_on(self, sheet: Sheet) -> Colour:
        """Lighter where the picture's ground is dark."""
        return self.light if sheet.ink == _CARD["text"] else self.colour

    @property
    def note(self) -> str:
        verdict = self.run.scene.verdict(self.run)
        return f"{self.label}: {verdict[0].lower()}{verdict[1:]}"

    def draw_in_frame(self, sheet: Sheet, points: np.ndarray, at: Sequence[float]) -> None:
        """Its path (px, shape (n, 2)) as a thin line, and where its ball is (px)."""
        colour = self.colour_on(sheet)
        if len(points) > 1:
            sheet.painter.thread(points, sheet.unit, colour)
        sheet.painter.disc((at[0], at[1]), max(2.5, 5 * sheet.unit), colour, 0.9)

    def draw(self, sheet: Sheet, points: np.ndarray) -> None:
        """Its path (px, shape (n, 2)); no label will be placed on it."""
        width = max(2.5, 4.5 * sheet.unit)
        sheet.painter.line(points, width, self.colour_on(sheet), _TRACE["earlier"])
        sheet.painter.disc(points[-1], 1.3 * width, self.light, 0.9)
        sheet.labels.take_path(points, 3 * sheet.unit)

    def name(self, sheet: Sheet, points: np.ndarray, trace: np.ndarray) -> None:
        """Write what it is called beside its path (px, shape (n, 2)), far from the picture's own ``trace``.

        The last thing to be written: the picture's own labels come first.
        """
        points = points[apart(points, FINEST)]
        away = np.hypot(*(points[:, None] - trace[None, :: max(1, len(trace) // 100)]).T).min(axis=0)
        far_first = points[np.argsort(-away, kind="stable")[:: max(1, len(points) // _ANCHORS)]]
        distances, turns = [far * sheet.unit for far in (8, 16, 28)], np.linspace(pi / 2, 5 * pi / 2, 9).tolist()
        spots = [spot for place in far_first.tolist() for spot in around(place, distances, turns)]
        sheet.chip(self.label, spots, self.light)


def mark_measured(painter: Painter, places: np.ndarray, unit: float) -> None:
    """Dots at measured places in px, shape (n, 2), that are seen on any ground and on a path."""
    for at in places.tolist():
        painter.disc(at, 3.4 * unit, _TRACE["rim"])
        painter.disc(at, 2.3 * unit, _CARD["text"])
