"""Other runs of the same scene, drawn pale behind the one that a picture is of."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from math import cos, pi, sin

import numpy as np

from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.path import FINEST, Path, apart, chip
from sandbox.picture.sheet import CARD, Entry, Sheet

TRACE = palette("trace")

#: How much lighter than its trace a ghost's text on the card is.
LIGHTER = 0.45
#: The label of a ghost may stand at about so many points of its path.
ANCHORS = 12
#: The path of a ghost in a frame has so many points at most.
MOST_POINTS = 480


@dataclass(frozen=True)
class Ghost:
    """Another run: what it is called, the path of its ball, its colour, and how far it is moved (m) to lie over this
    one; ``said`` is what a frame's card says of it at a time in s."""

    label: str
    path: Path
    colour: Colour
    shift: tuple[float, float]
    said: Callable[[float], list[Entry]]

    @cached_property
    def points(self) -> np.ndarray:
        """Its path where it is drawn, in m, shape (n, 2)."""
        return self.path.points + self.shift

    def at(self, t: float) -> np.ndarray:
        """Its ball where it is drawn at time t in s, in m, shape (1, 2)."""
        return np.array([self.path.run.state(self.path.name, min(t, self.path.run.duration))[:2]]) + self.shift

    @property
    def row(self) -> tuple[Colour, list[Entry]]:
        """Its numbers for the card, in its colour."""
        return self.light, self.path.run.scene.rows(self.path.run)

    @property
    def light(self) -> Colour:
        """Its colour on a dark ground."""
        return mix(self.colour, CARD["text"], LIGHTER)

    def live(self, t: float) -> tuple[Colour, list[Entry]]:
        """The same for a frame at time t in s."""
        return self.light, self.said(min(t, self.path.run.duration))

    def colour_on(self, sheet: Sheet) -> Colour:
        """Lighter where the picture's ground is dark."""
        return self.light if sheet.ink == CARD["text"] else self.colour

    @property
    def note(self) -> str:
        verdict = self.path.run.scene.verdict(self.path.run)
        return f"{self.label}: {verdict[0].lower()}{verdict[1:]}"


def colours_beside(kind: type) -> Sequence[Colour]:
    """Of other runs on pictures of this class: its own ``EARLIER`` where the usual ones would be hard to see."""
    return getattr(kind, "EARLIER", TRACE["colours"][1:])


def draw_in_frame(sheet: Sheet, ghost: Ghost, points: np.ndarray, at: Sequence[float]) -> None:
    """A ghost's path (px, shape (n, 2)) as a thin line, and where its ball is (px); kept out of the header."""
    colour = ghost.colour_on(sheet)
    sheet.surface.set_clip((0, sheet.top_row, *sheet.size))
    if len(points) > 1:
        kept = np.unique(np.linspace(0, len(points) - 1, MOST_POINTS).astype(int))
        sheet.painter.thread(points[kept], sheet.unit, colour)
    sheet.painter.disc((at[0], at[1]), max(2.5, 5 * sheet.unit), colour, 0.9)
    sheet.surface.set_clip(None)


def draw_ghost(sheet: Sheet, ghost: Ghost, points: np.ndarray) -> None:
    """A ghost's path (px, shape (n, 2)); no label will be placed on it."""
    points = points[apart(points, FINEST)]
    width = max(2.5, 4.5 * sheet.unit)
    sheet.painter.line(points, width, ghost.colour_on(sheet), TRACE["earlier"])
    sheet.painter.disc(points[-1], 1.3 * width, ghost.light, 0.9)
    sheet.labels.take_path(points, 3 * sheet.unit)


def label_ghost(sheet: Sheet, ghost: Ghost, points: np.ndarray, trace: np.ndarray) -> None:
    """What a ghost is called, beside its path (px, shape (n, 2)), far from the picture's own ``trace``.

    The last thing to be written: the picture's own labels come first.
    """
    points = points[apart(points, FINEST)]
    away = np.hypot(*(points[:, None] - trace[None, :: max(1, len(trace) // 100)]).T).min(axis=0)
    far_first = points[np.argsort(-away, kind="stable")[:: max(1, len(points) // ANCHORS)]]
    directions = [(cos(turn), -sin(turn)) for turn in np.linspace(pi / 2, 5 * pi / 2, 9)]
    spots = [
        (float(x + across * far * sheet.unit), float(y + down * far * sheet.unit), across, down)
        for x, y in far_first
        for far in (8, 16, 28)
        for across, down in directions
    ]
    chip(sheet, ghost.label, spots, ghost.light)
