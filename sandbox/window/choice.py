"""A choice among what is seen in the picture: a list, and marks or paths that can be clicked too."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import pygame

from sandbox.picture.palette import Colour, mix, palette
from sandbox.window.measure import away_from
from sandbox.window.overlay import Board, Row
from sandbox.window.stage import draw_line

CARD, TRACE = palette("card"), palette("trace")

#: From this distance in px on 720 rows a mark or a path is clicked.
NEAR = 16.0


class Mark(NamedTuple):
    """What can be chosen: a line in the picture (px, shape (n, 2)), or a point; and its name there."""

    action: str
    line: np.ndarray
    name: str
    colour: Colour


class Choice(Board):
    """A list above a button of the bar, and marks that do the same."""

    def __init__(
        self,
        title: str,
        rows: Sequence[Row],
        choose: Callable[[str], object],
        foot: pygame.Rect,
        marks: Callable[[], Sequence[Mark]],
    ) -> None:
        super().__init__(rows, choose, foot, title, now=rows[0].action)
        self.marks, self.near = marks, NEAR

    def at(self, position: tuple[int, int]) -> Row | None:
        found: Row | None = super().at(position)
        marks = {} if found else {mark.action: away_from(mark.line, position)[0] for mark in self.marks()}
        nearest = min(marks, key=lambda action: marks[action], default="")
        near = [row for row in self.rows if row.action == nearest and marks[nearest] <= self.near]
        return near[0] if near else found

    def compose(self) -> None:
        sheet, unit, painter = self.sheet, self.sheet.unit, self.sheet.painter
        self.near = NEAR * unit
        hovered = self.at(self.mouse) or self.chosen
        for mark in sorted(self.marks(), key=lambda mark: mark.action == hovered.action):
            here, middle = mark.action == hovered.action, tuple(mark.line[len(mark.line) // 2])
            colour = mark.colour if here else mix(mark.colour, CARD["background"], 0.25)
            if len(mark.line) > 1:
                width = (4.0 if here else 2.5) * unit
                draw_line(sheet.surface, mark.line, width + 2, TRACE["rim"])
                draw_line(sheet.surface, mark.line, width, colour)
            painter.disc(middle, 12 * unit, CARD["background"], 0.85)
            painter.ring(middle, 11 * unit, 2.2 * unit, CARD["accent"] if here else colour)
            sheet.lettering.write(sheet.surface, mark.name, "small", middle, CARD["text"], "center", bold=True)
        super().compose()
