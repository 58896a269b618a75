"""Other runs of the same scene, drawn pale behind the one that a picture is of."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from sandbox.engine.run import Run
from sandbox.picture.lettering import around
from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.path import FINEST, apart
from sandbox.picture.sheet import CARD, Sheet

if TYPE_CHECKING:
    from sandbox.picture.view import View

#: How much lighter than its trace a ghost's text on the card is.
LIGHTER = 0.45
#: The label of a ghost may stand at about so many points of its path.
ANCHORS = 12


@dataclass(frozen=True)
class Ghost:
    """Another run: what it is called, its picture, its colour, and how far it is moved (m) to lie over this one."""

    label: str
    view: View[Any]
    colour: Colour
    shift: tuple[float, float]

    @property
    def run(self) -> Run:
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
        return mix(self.colour, CARD["text"], LIGHTER)

    def colour_on(self, sheet: Sheet) -> Colour:
        """Lighter where the picture's ground is dark."""
        return self.light if sheet.ink == CARD["text"] else self.colour

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
        sheet.painter.line(points, width, self.colour_on(sheet), palette("trace")["earlier"])
        sheet.painter.disc(points[-1], 1.3 * width, self.light, 0.9)
        sheet.labels.take_path(points, 3 * sheet.unit)

    def name(self, sheet: Sheet, points: np.ndarray, trace: np.ndarray) -> None:
        """Write what it is called beside its path (px, shape (n, 2)), far from the picture's own ``trace``.

        The last thing to be written: the picture's own labels come first.
        """
        points = points[apart(points, FINEST)]
        away = np.hypot(*(points[:, None] - trace[None, :: max(1, len(trace) // 100)]).T).min(axis=0)
        far_first = points[np.argsort(-away, kind="stable")[:: max(1, len(points) // ANCHORS)]]
        distances, turns = [far * sheet.unit for far in (8, 16, 28)], np.linspace(pi / 2, 5 * pi / 2, 9).tolist()
        spots = [spot for place in far_first.tolist() for spot in around(place, distances, turns)]
        sheet.chip(self.label, spots, self.light)
