"""The ground behind the plane of play, in central perspective, and the cut along it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from math import ceil, floor, hypot, log2
from typing import Any

import numpy as np
import pygame

from sandbox.picture.camera import Eye
from sandbox.picture.painter import Painter, blank, from_coverage, gradient
from sandbox.picture.palette import Colour, mix, palette

_FLOOR, _GRASS, _WHITE = palette("floor"), palette("grass")["mown"], (255, 255, 255)

#: The ground differs little from place to place, so a lower factor than for other shapes will do.
_OVERSAMPLING = 2
#: Stripes stripes narrower than this, in px on 720 rows, are drawn twice as wide.
_LEAST_STRIPE = 12

#: Points (x, z) of the ground in m: along the plane of play, and away from the eye.
Line = Sequence[tuple[float, float]]
#: From points of the ground in m to those of what is drawn, larger, in px.
_Project = Callable[[Line], np.ndarray]


@dataclass(frozen=True)
class Stripes:
    """Stripes across the plane of play, as of mown grass: even ones, odd ones, ``width`` m wide from ``start`` m on."""

    colours: tuple[Colour, Colour] = _GRASS
    width: float = 4.0
    start: float = 0.0

    def draw(self, drawn: pygame.Surface, eye: Eye, far: float, near: float, project: _Project) -> None:
        """Between the distances ``far`` and ``near`` behind the plane of play, in m."""
        drawn.fill(self.colours[0])
        width = self.width * 2.0 ** max(0, ceil(log2(_LEAST_STRIPE * eye.unit / (self.width * eye.camera.scale))))
        low, high = (eye.along(px, far) for px in (0, drawn.get_width() / _OVERSAMPLING))
        odd = range(floor((low - self.start) / width) | 1, ceil((high - self.start) / width), 2)
        corners = [
            (self.start + (i + j) * width, z) for i in odd for j, z in ((0, near), (1, near), (1, far), (0, far))
        ]
        for stripe in project(corners).reshape(-1, 4, 2) if corners else ():
            pygame.draw.polygon(drawn, self.colours[1], stripe)


@dataclass(frozen=True)
class Planks:
    """A wooden floor: far colour, near colour, and one of which every plank has some."""

    colours: tuple[Colour, Colour, Colour]

    def draw(self, drawn: pygame.Surface, eye: Eye, far: float, near: float, project: _Project) -> None:
        """Planks along the plane of play, so low on the picture that their slanting ends may stand upright."""
        distant, close, tinge = self.colours
        plank, length, width = eye.distance * 0.04, eye.distance * 0.30, drawn.get_width()
        least = eye.share(far)
        for i in range(ceil(far / plank)):
            middle, shift = (i + 0.5) * plank, i * 0.618 % 1
            share = eye.share(middle)
            colour = mix(distant, close, (share - least) / (1 - least))
            first, last = (floor(eye.along(px, middle) / length - shift) for px in (0, width / _OVERSAMPLING))
            joints = [((j + shift) * length, middle) for j in range(first, last + 2)]
            seen = project([(0.0, i * plank), (0.0, (i + 1) * plank), *joints])
            low, top, edges = seen[0, 1], seen[1, 1], zip(seen[2:, 0], range(first, last + 2), strict=True)
            for (a, j), (b, _) in pairwise(edges):
                tone = (i * 0.7549 + j * 0.5698) % 1
                rect = (round(a), round(top), round(b) - round(a), round(low) - round(top))
                drawn.fill(mix(colour, tinge, tone), rect)


@dataclass(frozen=True)
class Ground:
    """Level ground with what is on it, and under it what it is made of, cut open.

    ``areas`` and ``lines`` lie on the ground; ``far`` is how much smaller things look where it ends, in front of what
    stands there; ``beyond`` colours the rest of the way to the horizon, far and near, where nothing does.
    """

    surface: Stripes | Planks = Planks(_FLOOR["wood"])
    soil: tuple[Colour, Colour, Colour] = _FLOOR["beneath"]  # from the top down
    edges: Sequence[tuple[Colour, float]] = ()  # thin layers at the top of the cut, how deep they go, px on 720 rows
    areas: Sequence[tuple[Line, Colour]] = ()
    lines: Sequence[Line] = ()
    line: tuple[Colour, float] = (_WHITE, 0.05)  # their colour, and width in m
    far: float = 0.4
    haze: Colour | None = None
    beyond: tuple[Colour, Colour] | None = None

    def foot(self, eye: Eye) -> int:
        """The row in which what lies behind stands on the ground, in px."""
        return round(eye.level + (0.0 if self.beyond else self.far) * (eye.base - eye.level))

    def draw(self, painter: Painter, eye: Eye, deepest: int | None = None) -> None:
        """Down to the row ``deepest`` (px), or to the plane of play; below it the cut."""
        (width, height), foot = painter.surface.get_size(), self.foot(eye)
        if foot >= height:  # the camera looks over it
            return
        deepest = round(eye.base) if deepest is None else deepest
        drawn = _canvas((width * _OVERSAMPLING, (max(height, deepest) - foot) * _OVERSAMPLING))
        drawn = drawn.subsurface((0, 0, width * _OVERSAMPLING, (deepest - foot) * _OVERSAMPLING))
        begin = 0
        if self.beyond is not None:
            begin = round(self.far * (eye.base - eye.level) * _OVERSAMPLING)
            drawn.blit(gradient((drawn.get_width(), begin), self.beyond), (0, 0))

        def project(line: Line) -> np.ndarray:
            seen = eye.points(np.array([(x, eye.camera.at[1], z) for x, z in line]))
            return (seen - (0, foot + begin / _OVERSAMPLING)) * _OVERSAMPLING

        part = drawn.subsurface((0, begin, drawn.get_width(), drawn.get_height() - begin))
        far, near = eye.depth(self.far), eye.depth((deepest - eye.level) / (eye.base - eye.level))
        self.surface.draw(part, eye, far, near, project)
        for area, colour in self.areas:
            pygame.draw.polygon(part, colour, project(area))
        for line in self.lines:
            self._line(part, eye, line, project)
        if self.haze is not None:
            part.blit(_haze(part.get_size(), self.haze), (0, 0))
        painter.surface.blit(pygame.transform.smoothscale(drawn, (width, deepest - foot)), (0, foot))
        painter.surface.blit(gradient((width, max(0, height - deepest)), self.soil), (0, deepest))
        for colour, deep in reversed(self.edges):
            painter.surface.fill(colour, (0, deepest, width, max(1, round(deep * eye.unit))))

    def _line(self, drawn: pygame.Surface, eye: Eye, line: Line, project: _Project) -> None:
        """Behind the plane of play: as wide as it is at its nearest, and narrower where it runs along that plane."""
        colour, width = self.line
        for near, far in (sorted(ends, key=lambda point: point[1]) for ends in pairwise(line)):
            if far[1] < 0.0:
                continue
            cut = max(0.0, -near[1]) / (far[1] - near[1] or 1.0)  # the part of it before the plane of play
            a, b = (near[0] + cut * (far[0] - near[0]), max(near[1], 0.0)), far
            along, away = b[0] - a[0], b[1] - a[1]
            seen = hypot(0.35 * along, 0.5 * away) / (hypot(along, away) or 1.0)
            thick = width * eye.camera.scale * eye.share(a[1]) * seen * _OVERSAMPLING
            pygame.draw.lines(drawn, colour, False, project([a, b]), max(2, round(thick)))


def turf(
    colours: Mapping[str, Any], stripe: float, edge: float = 5, line: float = 0.05, start: float = 0.0, **more: Any
) -> Ground:
    """Mown grass in a scene's colours ``grass``, ``soil``, ``edge`` and ``line``: widths of stripes and lines in m."""
    kinds = Stripes(colours["grass"], stripe, start), colours["soil"], [(colours["edge"], edge)]
    return Ground(*kinds, line=(colours.get("line", _WHITE), line), **more)


def boards(colours: Mapping[str, Any], **more: Any) -> Ground:
    """The floor of a hall in a scene's colours ``wood``, ``beneath``, ``lit``, ``cut`` and ``line``."""
    edges = [(colours["lit"], 2), (colours["cut"], 7)]
    return Ground(Planks(colours["wood"]), colours["beneath"], edges, line=(colours["line"], 0.05), far=0.44, **more)


@lru_cache(maxsize=4)
def _canvas(size: tuple[int, int]) -> pygame.Surface:
    """The surface on which ground is drawn, larger: new memory is slow."""
    return blank(size)


@lru_cache(maxsize=4)
def _haze(size: tuple[int, int], colour: Colour) -> pygame.Surface:
    """The colour into which the ground fades with distance."""
    fade = np.linspace(150 / 255, 0, round(0.8 * size[1]))
    return from_coverage(np.broadcast_to(fade, (size[0], len(fade))), colour)
