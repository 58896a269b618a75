"""The map of a shot: which speeds and angles around it score, everything else being equal; and its card."""

from __future__ import annotations

from collections.abc import Callable
from statistics import NormalDist
from time import perf_counter
from typing import NamedTuple

import numpy as np
import pygame

from sandbox import parameters as declared
from sandbox.errors import RequestError
from sandbox.lab.runs import columns_at
from sandbox.lab.scatter import ANGLE, SPEED, players_spread
from sandbox.picture.palette import Colour, mix, palette
from sandbox.scene import Scene
from sandbox.sport.controls import Spread
from sandbox.window.canvas import Canvas
from sandbox.window.fan import within
from sandbox.window.layout import Form

_CARD = palette("card")

#: Half of each side, in standard deviations of what a player hits.
_REACH = 15.0
#: Cells along speed and angle: at first, and three times as many, if the first took less than this time in s. Odd, so
#: that the shot itself is the middle of a cell.
COARSE, FINER, QUICK = (13, 9), 3, 0.5
#: Size of the map's cells together, in px on 720 rows.
_MAP = (210, 150)
#: What is said of a map on which nothing scores: where to look.
_NOTHING = "none scores; / looks farther"
#: What is not in the picture, such as the direction to the side, has so many values at each cell, on one side, since
#: left and right are alike: each stands for as many shots.
_ASIDE = 5


class ScoreMap(NamedTuple):
    """The share of shots that score at each cell of a grid over speed and angle, in their units."""

    speeds: tuple[float, float]  # lowest and highest
    angles: tuple[float, float]
    units: tuple[str, str]
    cells: np.ndarray  # shape (speeds, angles), from 0 to 1, NaN where none could be computed
    seconds: float  # that it took

    def holds(self, speed: float, angle: float) -> bool:
        """True if an aim lies on the map."""
        across, up = self.place(speed, angle)
        return 0 <= across <= 1 and 0 <= up <= 1

    def place(self, speed: float, angle: float) -> tuple[float, float]:
        """The place of an aim, as shares of both sides."""
        (slow, fast), (low, high) = self.speeds, self.angles
        return (speed - slow) / (fast - slow), (angle - low) / (high - low)

    def aim(self, across: float, up: float) -> tuple[float, float]:
        """The aim at a place."""
        (slow, fast), (low, high) = self.speeds, self.angles
        return slow + across * (fast - slow), low + up * (high - low)

    @property
    def share(self) -> float:
        """The share of all shots that score."""
        return float(np.nan_to_num(self.cells).mean())

    @property
    def summary(self) -> str:
        """The share for people; where nothing scores, what to do."""
        return f"{100 * self.share:.0f} % of these score" if self.share else _NOTHING


def score_map(scene: Scene, finer: int = 1) -> ScoreMap:
    """The map around a scene's own aim. Raises RequestError for a scene that does not score, or has no such aim."""
    controls, known = scene.controls, {p.key: p for p in declared.walk(scene.parameters)}
    spread = {item.key: item for item in controls.spread}
    keys, started = [controls.speed, controls.angle], perf_counter()
    if not controls.scores or any(not isinstance(getattr(known.get(key), "value", None), float) for key in keys):
        raise RequestError("no map: this scene defines no scoring")
    if any(known[key].value != value for key, value in controls.set_on_pull.items()):
        raise RequestError("no map: this shot does not start from the player's controls")
    usual = Spread(controls.speed, SPEED), Spread(controls.angle, minimum=ANGLE)
    ends, middles = [], []
    for key, other, count in zip(keys, usual, COARSE, strict=True):
        parameter = known[key]
        reach = _REACH * spread.get(key, other).sigma(parameter.value)
        low, high = within(parameter, np.array([parameter.value - reach, parameter.value + reach])).tolist()
        ends.append((low, max(high, low + 1e-9)))
        shares = (np.arange(finer * count) + 0.5) / (finer * count)
        middles.append(low + shares * (high - low))
    points = np.stack(np.meshgrid(*middles, indexing="ij"), axis=-1).reshape(-1, 2)
    unseen = _unseen(scene)
    several = [[*point, *others] for point in points.tolist() for others in unseen.tolist()]
    found = columns_at(scene, [*keys, *_hidden(scene)], several, asked=[controls.scores])
    scored = np.array(found.facts[controls.scores], dtype=bool).astype(float)  # None counts as no
    scored[[*found.errors]] = np.nan
    units = known[controls.speed].unit or "", known[controls.angle].unit or ""
    shape = finer * COARSE[0], finer * COARSE[1]
    return ScoreMap(ends[0], ends[1], units, _means(scored, len(unseen)).reshape(shape), perf_counter() - started)


def _hidden(scene: Scene) -> list[str]:
    """The parameters that scatter, but are not in the picture."""
    hidden = {item.key for item in scene.controls.spread if item.sd}
    return [key for key in players_spread(scene) if key in hidden]


def _unseen(scene: Scene) -> np.ndarray:
    """Values of these parameters at each cell, shape (values, parameters): the middles of equal shares of a normal
    distribution to one side."""
    scatter = [players_spread(scene)[key] for key in _hidden(scene)]
    if not scatter:
        return np.empty((1, 0))
    sizes = [NormalDist().inv_cdf(0.5 + 0.5 * (place + 0.5) / _ASIDE) for place in range(_ASIDE)]
    return np.array([[parameter.value + sd * size for parameter, sd in scatter] for size in sizes])


def _means(scored: np.ndarray, shots: int) -> np.ndarray:
    """The share that scores of so many shots at each cell, of those that could be computed."""
    cells = scored.reshape(-1, shots)
    known = np.isfinite(cells)
    return np.where(known.any(axis=1), np.nan_to_num(cells).sum(axis=1) / np.maximum(known.sum(axis=1), 1), np.nan)


def map_forms(
    sheet: Canvas, found: ScoreMap, aim: tuple[float, float], drawn: Callable[[pygame.Rect], object]
) -> list[Form]:
    """The map on a card with a ring at the aim, smaller ones, and at last the share that scores alone; ``drawn`` is
    told where the cells are."""
    maps = [_map_form(sheet, found, aim, drawn, share) for share in (1.0, 0.75, 0.55)]
    return [*maps, sheet.text([(found.summary, _CARD["text"])])._replace(whole=False)]


def _coloured(cells: np.ndarray) -> np.ndarray:
    """The colours of cells, shape (speeds, angles, 3): greener the more shots score."""
    missed, failed = np.array(mix(_CARD["background"], _CARD["quiet"], 0.3)), np.array(_CARD["bad"])
    share = np.nan_to_num(cells)[..., None]
    colours = missed + share * (np.array(_CARD["good"]) - missed)
    return np.where(np.isnan(cells)[..., None], failed, colours).round().astype(np.uint8)


def _map_form(
    sheet: Canvas, found: ScoreMap, aim: tuple[float, float], drawn: Callable[[pygame.Rect], object], share: float
) -> Form:
    letters, gap, unit = sheet.lettering, sheet.gap, sheet.unit
    row, (wide, tall) = letters.height("small"), (round(share * length * unit) for length in _MAP)
    (slow, fast), (low, high) = found.speeds, found.angles
    below = f"{slow:.3g}  {found.units[0]}  {fast:.3g}"
    wide = max(wide, letters.width(below, "small"))
    up = max(letters.width(f"{angle:.3g}", "small") for angle in (low, high))
    whole = max(wide + up + 2 * gap, letters.width(found.summary, "small")) + 4 * gap

    def write(text: str, at: tuple[float, float], anchor: str, colour: Colour = _CARD["quiet"]) -> None:
        letters.write(sheet.surface, text, "small", at, colour, anchor)

    def draw(card: pygame.Rect) -> None:
        sheet.painter.panel(card, _CARD["background"], 0.9, 8 * unit)
        cells = pygame.Rect(card.right - 2 * gap - wide, card.top + row + 2 * gap, wide, tall)
        image = pygame.surfarray.make_surface(_coloured(found.cells[:, ::-1]))
        sheet.surface.blit(pygame.transform.scale(image, cells.size), cells)
        across, along = found.place(*aim)
        if 0 <= across <= 1 and 0 <= along <= 1:
            at = cells.left + across * wide, cells.bottom - along * tall
            for radius, colour in ((6.5, _CARD["background"]), (5.0, _CARD["accent"])):
                sheet.painter.ring(at, radius * unit, 2.5 * unit, colour)
        write(found.summary, (card.left + 2 * gap, card.top + gap), "topleft", _CARD["text"])
        speed, angle = found.units
        foot = cells.bottom + gap // 2
        write(f"{slow:.3g}", (cells.left, foot), "topleft")
        write(speed, (cells.centerx, foot), "midtop")
        write(f"{fast:.3g}", (cells.right, foot), "topright")
        write(f"{high:.3g}", (cells.left - gap, cells.top), "topright")
        write(angle, (cells.left - gap, cells.centery), "midright")
        write(f"{low:.3g}", (cells.left - gap, cells.bottom), "bottomright")
        drawn(cells)

    return Form((whole, tall + 2 * row + 4 * gap), draw)
