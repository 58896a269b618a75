"""Other runs of the same scene, drawn pale behind the one that a picture is of."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import cos, dist, pi, sin
from typing import Any

import numpy as np

from sandbox.picture.palette import Colour, mix, palette
from sandbox.picture.path import FINEST, apart, chip
from sandbox.picture.sheet import CARD, Entry, Sheet

TRACE = palette("trace")

#: How much lighter than its trace a ghost's text on the card is.
LIGHTER = 0.45
#: Colours no further apart than this, in levels, are too much alike for two traces.
ALIKE = 100


@dataclass(frozen=True)
class Ghost:
    """Another run: what it is called, its own picture, and its colour."""

    label: str
    picture: Any  # of the same class as the picture that it is drawn on
    colour: Colour

    @property
    def row(self) -> tuple[Colour, list[Entry]]:
        """Its numbers for the card, in its colour."""
        return mix(self.colour, CARD["text"], LIGHTER), self.picture.numbers()

    @property
    def note(self) -> str:
        return f"{self.label}: {self.picture.verdict()[0].lower()}{self.picture.verdict()[1:]}"


def ghosts_of(kind: Any, runs: Mapping[str, Any], size: tuple[int, int], trace: Colour | None = None) -> list[Ghost]:
    """Ghosts for runs of a scene by their labels, in other colours than the picture's own trace.

    ``kind`` is the scene's class of pictures.
    """
    own = trace or TRACE["colours"][0]
    colours = [colour for colour in TRACE["colours"] if colour != own and (trace is None or dist(colour, own) > ALIKE)]
    return [
        Ghost(label, kind(run, run.scene.parameters, size), colours[i % len(colours)])
        for i, (label, run) in enumerate(runs.items())
    ]


def draw_ghost(sheet: Sheet, ghost: Ghost, points: np.ndarray, trace: np.ndarray) -> None:
    """A ghost's path (px, shape (n, 2)) and its label, where it is farthest from the picture's own ``trace``."""
    points = points[apart(points, FINEST)]
    width = max(2.5, 4.5 * sheet.unit)
    on_dark = sheet.ink == CARD["text"]
    sheet.painter.line(points, width, ghost.row[0] if on_dark else ghost.colour, TRACE["earlier"])
    sheet.painter.disc(points[-1], 1.3 * width, ghost.row[0], 0.9)
    sheet.labels.take_path(points, 3 * sheet.unit)
    away = np.hypot(*(points[:, None] - trace[None, :: max(1, len(trace) // 100)]).T).min(axis=0)
    x, y = points[int(away.argmax())]
    directions = [(cos(turn), -sin(turn)) for turn in np.linspace(pi / 2, 5 * pi / 2, 9)]
    spots = [
        (float(x + across * far * sheet.unit), float(y + down * far * sheet.unit), across, down)
        for far in (8, 16, 28)
        for across, down in directions
    ]
    chip(sheet, ghost.label, spots, ghost.row[0])
