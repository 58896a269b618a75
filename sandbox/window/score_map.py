"""The map of a shot: which speeds and angles around it score, everything else being equal; and its card."""

from __future__ import annotations

from time import perf_counter
from typing import NamedTuple

import numpy as np
import pygame

from sandbox import parameters as declared
from sandbox.errors import RequestError
from sandbox.lab.runs import runs
from sandbox.picture.palette import Colour, mix, palette
from sandbox.scene import Scene
from sandbox.sport.controls import Spread
from sandbox.window.canvas import Canvas
from sandbox.window.fan import ANGLE, SPEED, within

CARD = palette("card")

#: Half of each side, in standard deviations of what a player hits.
REACH = 15.0
#: Cells along speed and angle: at first, and three times as many, if the first took less than this time in s. Odd, so
#: that the shot itself is the middle of a cell.
COARSE, FINER, QUICK = (13, 9), 3, 0.5
#: Size of the map's cells together, in px on 720 rows.
MAP = (210, 150)
#: A cell's value.
MISSED, SCORED, FAILED = 0, 1, 2


class ScoreMap(NamedTuple):
    """The outcome at each cell of a grid over speed and angle, in their units."""

    speeds: tuple[float, float]  # lowest and highest
    angles: tuple[float, float]
    units: tuple[str, str]
    cells: np.ndarray  # shape (speeds, angles)
    seconds: float  # that it took

    def holds(self, speed: float, angle: float) -> bool:
        """Whether an aim lies on the map."""
        across, up = self.place(speed, angle)
        return 0 <= across <= 1 and 0 <= up <= 1

    def place(self, speed: float, angle: float) -> tuple[float, float]:
        """Where an aim lies, as shares of both sides."""
        (slow, fast), (low, high) = self.speeds, self.angles
        return (speed - slow) / (fast - slow), (angle - low) / (high - low)

    def aim(self, across: float, up: float) -> tuple[float, float]:
        """The aim at a place."""
        (slow, fast), (low, high) = self.speeds, self.angles
        return slow + across * (fast - slow), low + up * (high - low)

    @property
    def share(self) -> float:
        """Of the cells that score."""
        return float((self.cells == SCORED).mean())


def score_map(scene: Scene, finer: int = 1) -> ScoreMap:
    """The map around a scene's own aim. Raises RequestError for a scene that does not score, or has no such aim."""
    controls, known = scene.controls, {p.key: p for p in declared.walk(scene.parameters)}
    spread = {item.key: item for item in controls.spread}
    keys, started = [controls.speed, controls.angle], perf_counter()
    if not controls.scores or any(not isinstance(getattr(known.get(key), "value", None), float) for key in keys):
        raise RequestError("no map: this scene says of no shot that it scores")
    if any(known[key].value != value for key, value in controls.also.items()):
        raise RequestError("no map: this shot does not begin as a player's does")
    usual = Spread(controls.speed, SPEED), Spread(controls.angle, least=ANGLE)
    ends, middles = [], []
    for key, other, count in zip(keys, usual, COARSE, strict=True):
        parameter = known[key]
        reach = REACH * spread.get(key, other).sigma(parameter.value)
        low, high = within(parameter, np.array([parameter.value - reach, parameter.value + reach])).tolist()
        ends.append((low, max(high, low + 1e-9)))
        shares = (np.arange(finer * count) + 0.5) / (finer * count)
        middles.append(low + shares * (high - low))
    points = np.stack(np.meshgrid(*middles, indexing="ij"), axis=-1).reshape(-1, 2)
    found = runs(scene, keys, points.tolist(), asked=[controls.scores])
    cells = [FAILED if isinstance(run, Exception) else SCORED if run.result[controls.scores] else MISSED
             for run in found]  # fmt: skip
    units = known[controls.speed].unit or "", known[controls.angle].unit or ""
    shape = finer * COARSE[0], finer * COARSE[1]
    return ScoreMap(ends[0], ends[1], units, np.array(cells, np.uint8).reshape(shape), perf_counter() - started)


def draw_map(sheet: Canvas, found: ScoreMap, aim: tuple[float, float]) -> pygame.Rect:
    """The map on a card down the right side, with a ring at the aim; returns where its cells are."""
    letters, gap, unit = sheet.lettering, sheet.gap, sheet.unit
    row, (wide, tall) = letters.height("small"), (round(length * unit) for length in MAP)
    (slow, fast), (low, high) = found.speeds, found.angles
    up = max(letters.width(f"{angle:.3g}", "small") for angle in (low, high))
    card = sheet.stacked((wide + up + 6 * gap, tall + 2 * row + 4 * gap))
    sheet.painter.panel(card, CARD["background"], 0.9, 8 * unit)
    cells = pygame.Rect(card.right - 2 * gap - wide, card.top + row + 2 * gap, wide, tall)
    colours = np.array([mix(CARD["background"], CARD["quiet"], 0.3), CARD["good"], CARD["bad"]], np.uint8)
    image = pygame.surfarray.make_surface(colours[found.cells[:, ::-1]])
    sheet.surface.blit(pygame.transform.scale(image, cells.size), cells)
    across, along = found.place(*aim)
    if 0 <= across <= 1 and 0 <= along <= 1:
        at = cells.left + across * wide, cells.bottom - along * tall
        for radius, colour in ((6.5, CARD["background"]), (5.0, CARD["accent"])):
            sheet.painter.ring(at, radius * unit, 2.5 * unit, colour)

    def write(text: str, at: tuple[float, float], anchor: str, colour: Colour = CARD["quiet"]) -> None:
        letters.write(sheet.surface, text, "small", at, colour, anchor)

    write(f"{100 * found.share:.0f} % of these score", (cells.left, card.top + gap), "topleft", CARD["text"])
    speed, angle = found.units
    foot = cells.bottom + gap // 2
    write(f"{slow:.3g}", (cells.left, foot), "topleft")
    write(speed, (cells.centerx, foot), "midtop")
    write(f"{fast:.3g}", (cells.right, foot), "topright")
    write(f"{high:.3g}", (cells.left - gap, cells.top), "topright")
    write(angle, (cells.left - gap, cells.centery), "midright")
    write(f"{low:.3g}", (cells.left - gap, cells.bottom), "bottomright")
    return cells
