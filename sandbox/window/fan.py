"""A fan: the same shot varied at random by a stated spread, drawn as a cloud, with the share of them that scores."""

from __future__ import annotations

from concurrent.futures import Future
from math import sqrt
from typing import TYPE_CHECKING

import numpy as np
import pygame

from sandbox import parameters as declared
from sandbox.controls import Spread, controls_of
from sandbox.picture.camera import Camera
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import Colour, palette
from sandbox.picture.sheet import Sheet
from sandbox.window.beside import FanShot, varied
from sandbox.window.path import few
from sandbox.window.session import Shot

if TYPE_CHECKING:
    from sandbox.workers import Processes

CARD, TRACE = palette("card"), palette("trace")

SHOTS = 200
#: Where a scene states no spread: of the speed, as a share of it, and of the angle, in deg.
SPEED, ANGLE = 0.01, 0.5
#: A spread may be made so many times wider or narrower.
WIDEST = 16.0
#: Shots are computed so many at first, and then so many as take this long, in s: another aim must not wait for more.
FIRST, AT_ONCE = 8, 0.05
#: So many paths are drawn in one frame; the others in the next.
PER_FRAME = 6
#: Opacity of a path, of 255: where many go, it is dense.
FAINT, FAINT_MISS = 70, 50


class Fan:
    """Shots around one of them. ``go_on`` after each frame has them computed; ``draw`` shows those there are."""

    def __init__(self, shot: Shot, width: float = 1.0) -> None:
        self.shot, self.width = shot, width
        self.known = {p.key: p for p in declared.walk(shot.scene.parameters)}
        self.spread = {key: width * sigma for key, sigma in self._sigmas().items()}
        self.draws = np.random.default_rng(1).standard_normal((SHOTS, len(self.spread)))
        self.shots: list[FanShot] = []
        self.failed = 0
        self.work: Future[tuple[list[FanShot | None], float]] | None = None
        self.next = FIRST
        self.layer: pygame.Surface | None = None
        self.camera: Camera | None = None
        self.drawn = 0

    def _sigmas(self) -> dict[str, float]:
        """Standard deviation of each parameter that a player does not hit exactly, in its unit."""
        controls = controls_of(self.shot.scene.module)
        values = {key: parameter.value for key, parameter in self.known.items()}
        if any(values.get(key) != value for key, value in controls.also.items()):
            return {}  # the shot begins otherwise than a player's, and what a player varies would change nothing
        spread = controls.spread or (Spread(controls.speed, SPEED), Spread(controls.angle, least=ANGLE))
        sigmas = {item.key: item.sigma(values[item.key]) for item in spread if isinstance(values.get(item.key), float)}
        return {key: sigma for key, sigma in sigmas.items() if sigma > 0}

    @property
    def complete(self) -> bool:
        return len(self.shots) + self.failed >= SHOTS or not self.spread

    def go_on(self, runs: Processes) -> None:
        """Take the shots that were computed, and have more of them computed."""
        if self.work is not None and self.work.done():
            self._take(self.work)
            self.work = None
        done = len(self.shots) + self.failed
        if self.work is None and not self.complete:
            controls = controls_of(self.shot.scene.module)
            told = controls.tells[0] if controls.tells is not None else None
            points = [self._point(draws) for draws in self.draws[done : done + self.next]]
            self.work = runs.submit(varied, self.shot.scene, list(self.spread), points, told)

    def _take(self, work: Future[tuple[list[FanShot | None], float]]) -> None:
        try:
            found, seconds = work.result()
        except Exception:  # the process was killed, and another will take its place
            self.failed += 1
            return
        good = [shot for shot in found if shot is not None]
        self.shots += good
        self.failed += len(found) - len(good)
        self.next = max(1, round(AT_ONCE * len(found) / seconds))

    def _point(self, draws: np.ndarray) -> list[float]:
        """Each parameter of the spread moved, within its bounds."""
        values = []
        for (key, sigma), draw in zip(self.spread.items(), draws, strict=True):
            low, high = self.known[key].low, self.known[key].high
            value = self.known[key].value + sigma * float(draw)
            values.append(value if low is None or high is None else min(max(value, low), high))
        return values

    # Drawing

    def draw(self, sheet: Sheet, camera: Camera) -> None:
        """The cloud under the path; those that score in the colour of success."""
        if self.layer is None or self.camera != camera or self.layer.get_size() != sheet.size:
            self.layer, self.camera, self.drawn = blank(sheet.size, transparent=True), camera, 0
        for shot in self.shots[self.drawn : self.drawn + PER_FRAME]:
            self._add(self.layer, shot, camera, sheet.unit)
            self.drawn += 1
        sheet.surface.blit(self.layer, (0, 0))

    @staticmethod
    def _add(layer: pygame.Surface, shot: FanShot, camera: Camera, unit: float) -> None:
        pixels = np.clip(camera.pixels(shot.points[:, 1:]), -2000, 6000)
        pixels = few(pixels)
        colour: Colour = CARD["good"] if shot.scored else CARD["text"]
        low, high = pixels.min(axis=0) - 2, pixels.max(axis=0) + 3
        box = pygame.Rect(*low.astype(int), *(high - low).astype(int)).clip(layer.get_rect())
        if box.width and box.height and len(pixels) > 1:
            line = blank(box.size, transparent=True)
            line.fill((*colour, 0))
            faint = FAINT if shot.scored else FAINT_MISS
            pygame.draw.lines(line, (*colour, faint), False, pixels - box.topleft, max(1, round(1.6 * unit)))
            layer.blit(line, box)
        Painter(layer).disc(tuple(pixels[-1]), 2.2 * unit, colour, 0.75)

    def told(self) -> tuple[str, str]:
        """How many score, and by what the shots differ."""
        count = len(self.shots)
        name = controls_of(self.shot.scene.module).scores
        if not self.spread:
            share = "no fan: this shot does not begin as a player's does"
        elif not count:
            share = "the fan ..."
        elif name:
            scored = sum(shot.scored for shot in self.shots)
            p = scored / count
            off = sqrt(p * (1 - p) / count)
            share = f"{scored} of {count} score: {100 * p:.0f} ± {max(1.0, 100 * off):.0f} %"
        else:
            share = f"{count} shots"
        told = controls_of(self.shot.scene.module).tells
        numbers = [shot.value for shot in self.shots if shot.value is not None]
        if told is not None and len(numbers) > 1:
            share += f"; {told[0]} {np.mean(numbers):.1f} ± {np.std(numbers):.1f} {told[1]}"
        parts = [
            f"{key.rpartition('.')[2]} ± {_short(sigma)} {self.known[key].unit or ''}".rstrip()
            for key, sigma in self.spread.items()
        ]
        return share, ", ".join(parts) or "nothing to vary"


def _short(sigma: float) -> str:
    """To two digits, but whole from 100 on: ``0.087``, ``370``."""
    return f"{float(f'{sigma:.2g}'):.0f}" if sigma >= 99.5 else f"{sigma:.2g}"
