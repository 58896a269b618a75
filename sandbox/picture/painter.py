"""Smooth shapes on a pygame surface. Positions and sizes are in px and may lie between pixels.

pygame's own shapes have rough edges, so discs and shadows are computed exactly, and everything else is drawn larger and
scaled down. Small shapes are cached: while the camera stands still, or moves by whole px, they are the same.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from functools import lru_cache
from itertools import accumulate, pairwise
from math import ceil, dist, floor, hypot

import numpy as np
import pygame

from sandbox.picture.palette import Colour

Point = tuple[float, float]
_Points = Sequence[Point] | np.ndarray  # an array has shape (n, 2)

#: A shape is drawn so many times larger before it is scaled down. 4 gives 16 levels along an edge; 2 shows steps.
OVERSAMPLING = 4
#: Half the width of an arrow's head over its length.
_ARROW = 0.62
#: Discs are kept for centres this far apart (px) and radii half as far: finer than the eye, coarse enough to be reused.
_PHASE = 1 / 8
#: So many shapes are kept, none of more than so many px. Larger discs and shadows are computed anew, where they are
#: seen: under a camera that zooms each frame has its own, and they may be far larger than the picture.
_MOST_KEPT, _LARGEST_KEPT = 512, 40_000


def blank(size: tuple[int, int], transparent: bool = False) -> pygame.Surface:
    """A new surface: 32 bits whatever the display is, and black or see-through."""
    surface = pygame.Surface(size, pygame.SRCALPHA if transparent else 0, 32)
    if transparent:
        surface.fill((0, 0, 0, 0))
    return surface


def scratch(size: tuple[int, int], colour: Colour) -> pygame.Surface:
    """A surface to draw on and forget, see-through and ready for shapes of the colour; it is valid until the next one.

    New memory is slow, and every shape needs some, so each thread keeps its own.
    """
    kept = getattr(_kept, "surface", None)
    if kept is None or kept.get_width() < size[0] or kept.get_height() < size[1]:
        width, height = kept.get_size() if kept is not None else (1024, 1024)
        kept = _kept.surface = blank((max(width, size[0]), max(height, size[1])), transparent=True)
    part = kept.subsurface((0, 0, *size))
    part.fill((*colour, 0))  # the colour everywhere, or scaling down would mix black into the edges
    return part


_kept = threading.local()
#: Shapes by what draws them, their points and their colour.
_sprites: dict[tuple[object, ...], pygame.Surface] = {}


def from_coverage(coverage: np.ndarray, colour: Colour) -> pygame.Surface:
    """A surface of one colour whose opacity is the array (0 to 1, shape (width, height))."""
    surface = blank(coverage.shape, transparent=True)
    surface.fill((*colour, 0))
    alpha = pygame.surfarray.pixels_alpha(surface)
    alpha[...] = np.clip(coverage, 0, 1) * 255 + 0.5
    del alpha  # unlocks the surface
    return surface


def from_colours(colours: np.ndarray) -> pygame.Surface:
    """An opaque surface from an array of colours (0 to 255, shape (width, height, 3))."""
    surface = blank(colours.shape[:2])
    pygame.surfarray.blit_array(surface, np.clip(colours + 0.5, 0, 255).astype(np.uint8))
    return surface


@lru_cache(maxsize=16)
def gradient(size: tuple[int, int], colours: tuple[Colour, ...]) -> pygame.Surface:
    """A surface from the first colour at the top over the others, evenly spaced, to the last."""
    rows = np.linspace(0, len(colours) - 1, size[1])
    column = np.stack([np.interp(rows, range(len(colours)), channel) for channel in zip(*colours, strict=True)], axis=1)
    return from_colours(np.broadcast_to(column, (*size, 3)))


@lru_cache(maxsize=2048)
def _disc(radius: float, width: float, phase: Point, colour: Colour) -> pygame.Surface:
    """A disc, or with ``width`` > 0 a ring, whose centre lies ``phase`` px past the middle pixel's centre."""
    reach = ceil(radius + width / 2 + 1)
    grid = np.arange(-reach, reach + 1)
    distance = np.hypot(grid[:, None] - phase[0], grid[None, :] - phase[1])
    return from_coverage(_round(distance, radius, width), colour)


def _round(distance: np.ndarray, radius: float, width: float) -> np.ndarray:
    """The coverage of a disc, or of a ring of that width, at distances from its centre in px."""
    return (radius - distance if width == 0 else width / 2 - abs(distance - radius)) + 0.5


@lru_cache(maxsize=256)
def _shadow(half_width: float, half_height: float, colour: Colour) -> pygame.Surface:
    reach = ceil(half_width * 1.5), ceil(half_height * 1.5) + 1
    across, down = (np.arange(-r, r + 1) / size for r, size in zip(reach, (half_width, half_height), strict=True))
    return from_coverage(_soft(across[:, None], down[None, :]), colour)


def _soft(across: np.ndarray, down: np.ndarray) -> np.ndarray:
    """The coverage of a shadow at places in half widths and half heights from its centre."""
    return np.clip(1.5 - np.hypot(across, down), 0, 1) ** 1.5


@lru_cache(maxsize=64)
def _panel(size: tuple[int, int], colour: Colour, corner: float) -> pygame.Surface:
    across, down = (np.arange(pixels) + 0.5 - pixels / 2 for pixels in size)
    return from_coverage(_cornered(across[:, None], down[None, :], size, corner), colour)


def _cornered(across: np.ndarray, down: np.ndarray, size: tuple[int, int], corner: float) -> np.ndarray:
    """The coverage of a rectangle with round corners at places in px from its centre."""
    beyond = [abs(line) - (pixels / 2 - corner) for line, pixels in zip((across, down), size, strict=True)]
    return corner - np.hypot(np.maximum(beyond[0], 0), np.maximum(beyond[1], 0)) + 0.5


def around_corners(surface: pygame.Surface, rect: pygame.Rect, corner: float) -> pygame.Surface:
    """The part in sight of a surface's rectangle outside its round corners: to be put back once that is filled."""
    seen = rect.clip(surface.get_rect())
    inside, kept = blank(seen.size, transparent=True), blank(seen.size, transparent=True)
    Painter(inside).panel(rect.move(-seen.left, -seen.top), (0, 0, 0), 1.0, corner)
    kept.blit(surface, (0, 0), seen)
    alpha = pygame.surfarray.pixels_alpha(kept)
    alpha[...] = 255 - pygame.surfarray.array_alpha(inside)
    del alpha  # unlocks the surface
    return kept


class Painter:
    """Draws on one surface."""

    def __init__(self, surface: pygame.Surface):
        self.surface = surface

    def disc(self, centre: Point, radius: float, colour: Colour, opacity: float = 1.0, width: float = 0.0) -> None:
        """A disc, or with ``width`` > 0 the ring of that width along its edge."""
        x, y = (round(value / _PHASE) * _PHASE for value in centre)
        radius = round(radius * 2 / _PHASE) * _PHASE / 2
        if (2 * radius + width) ** 2 > _LARGEST_KEPT:
            reach = radius + width / 2 + 1
            self._large((x, y), (reach, reach), lambda x, y: _round(np.hypot(x, y), radius, width), colour, opacity)
            return
        column, row = floor(x), floor(y)  # pixel i covers i to i + 1, so its centre is at i + 1/2
        phase = x - column - 0.5, y - row - 0.5
        sprite = _disc(radius, width, phase, colour)
        self._blit(sprite, (column - sprite.get_width() // 2, row - sprite.get_height() // 2), opacity)

    def ring(self, centre: Point, radius: float, width: float, colour: Colour, opacity: float = 1.0) -> None:
        self.disc(centre, radius, colour, opacity, width)

    def shadow(self, centre: Point, half_width: float, half_height: float, colour: Colour, opacity: float) -> None:
        """A soft ellipse, fading over its outer half."""
        half_width, half_height = (max(0.5, round(half * 2) / 2) for half in (half_width, half_height))
        width, height = 2 * ceil(half_width * 1.5) + 1, 2 * ceil(half_height * 1.5) + 3
        left, top = round(centre[0] - width / 2), round(centre[1] - height / 2)
        if width * height > _LARGEST_KEPT:
            middle, reach = (left + width / 2, top + height / 2), (width / 2, height / 2)
            self._large(middle, reach, lambda x, y: _soft(x / half_width, y / half_height), colour, opacity)
            return
        self._blit(_shadow(half_width, half_height, colour), (left, top), opacity)

    def polygon(self, points: _Points, colour: Colour, opacity: float = 1.0) -> None:
        self._shape(points, 0, colour, opacity, pygame.draw.polygon)

    def line(self, points: _Points, width: float, colour: Colour, opacity: float = 1.0) -> None:
        """A line through the points with round ends and joints."""
        self._shape(points, width, colour, opacity, _line, width * OVERSAMPLING / 2)

    def lines(self, lines: Sequence[_Points] | np.ndarray, width: float, colour: Colour, opacity: float = 1.0) -> None:
        """Many thin lines at once, such as the mesh of a net; where they cross they are no denser."""
        points = lines.reshape(-1, 2) if isinstance(lines, np.ndarray) else np.concatenate(lines)
        ends = tuple(accumulate(map(len, lines), initial=0))
        self._shape(points, width, colour, opacity, _lines, max(1, round(width * OVERSAMPLING)), ends)

    def thread(self, points: _Points, width: float, colour: Colour) -> None:
        """A line of whole px, at least one, without round joints: quick enough for every frame.

        Piece by piece: what pygame's ``aalines`` draws is not the same each time.
        """
        for a, b in pairwise(np.asarray(points, dtype=float).tolist()):
            pygame.draw.aaline(self.surface, colour, a, b, max(1, round(width)))

    def trace(self, points: _Points, width: float, colour: Colour, rim: Colour, rim_width: float) -> None:
        """A line with a thin edge of another colour, so that it stands out on any ground."""
        self.line(points, width + 2 * rim_width, rim, 0.55)
        self.line(points, width, colour)

    def dashes(
        self, points: _Points, width: float, colour: Colour, dash: float, gap: float, opacity: float = 1.0
    ) -> None:
        """A dashed line along the points; ``dash`` and ``gap`` in px."""
        for piece in _dashed(points, dash, gap):
            self.line(piece, width, colour, opacity)

    def dashed_thread(self, points: _Points, width: float, colour: Colour, dash: float, gap: float) -> None:
        """A dashed line, quick enough for every frame."""
        for piece in _dashed(points, dash, gap):
            self.thread(piece, width, colour)

    def fading(self, points: _Points, width: float, colour: Colour, opacity: float) -> None:
        """A line that grows from nothing at its first point to full width and opacity at its last."""
        array = np.asarray(points, dtype=float)
        if len(array) < 2:
            return
        ahead = np.gradient(array, axis=0)
        across = np.column_stack([-ahead[:, 1], ahead[:, 0]]) / np.maximum(np.hypot(*ahead.T), 1e-9)[:, None]
        share = np.linspace(0, 1, len(array))
        half = across * (share * width / 2)[:, None]
        edges = np.concatenate([array + half, array - half])
        opacities = tuple(round(255 * part) for part in share[1:])
        self._shape(edges, 0, colour, opacity, _fading, opacities, larger=3)

    def arrow(
        self,
        a: Point,
        b: Point,
        width: float,
        colour: Colour,
        opacity: float = 1.0,
        rim: tuple[Colour, float] | None = None,
    ) -> None:
        """From a to b, with a head 3.5 line widths long; ``rim`` is the colour and width of a thin edge."""
        length = dist(a, b)
        if length == 0:
            return
        along, down = (b[0] - a[0]) / length, (b[1] - a[1]) / length
        head = min(3.5 * width, length)

        def outline(wider: float) -> list[Point]:
            beyond = wider * hypot(1, _ARROW) / _ARROW  # by which the tip of a head whose sides move out moves on
            neck, shaft, wide = length - head - wider, width / 2 + wider, _ARROW * (head + wider + beyond)
            half = (-wider, shaft), (neck, shaft), (neck, wide), (length + beyond, 0.0)
            corners = [*half, *((far, -aside) for far, aside in half[2::-1])]
            return [(a[0] + far * along - aside * down, a[1] + far * down + aside * along) for far, aside in corners]

        if rim is not None:
            self.polygon(outline(rim[1]), rim[0], 0.6 * opacity)
        self.polygon(outline(0.0), colour, opacity)

    def panel(self, rect: pygame.Rect, colour: Colour, opacity: float, corner: float) -> None:
        """A rectangle with round corners."""
        if not self.surface.get_rect().contains(rect):
            centre, reach = (rect.left + rect.width / 2, rect.top + rect.height / 2), (rect.width / 2, rect.height / 2)
            self._large(centre, reach, lambda x, y: _cornered(x, y, rect.size, corner), colour, opacity)
            return
        self._blit(_panel(rect.size, colour, corner), rect.topleft, opacity)

    def _large(
        self,
        centre: Point,
        reach: tuple[float, float],
        coverage: Callable[[np.ndarray, np.ndarray], np.ndarray],
        colour: Colour,
        opacity: float,
    ) -> None:
        """Put on our surface what of a shape is seen that reaches so far (px) from its centre; ``coverage`` gives its
        opacity at places in px from there."""
        low = [floor(max(0.0, at - far)) for at, far in zip(centre, reach, strict=True)]
        high = [ceil(min(px, at + far)) for px, at, far in zip(self.surface.get_size(), centre, reach, strict=True)]
        if high[0] > low[0] and high[1] > low[1]:
            across, down = (np.arange(a, b) + 0.5 - at for a, b, at in zip(low, high, centre, strict=True))
            shape = np.broadcast_to(coverage(across[:, None], down[None, :]), (len(across), len(down)))
            self._blit(from_coverage(shape, colour), (low[0], low[1]), opacity)

    def _shape(
        self,
        points: _Points,
        width: float,
        colour: Colour,
        opacity: float,
        draw: Callable[..., object],
        *how: object,
        larger: int = OVERSAMPLING,
    ) -> None:
        """Put on our surface what of a shape is seen, which ``draw`` draws ``larger`` times its size."""
        array = np.asarray(points, dtype=float)
        low, high = array.min(axis=0) - width / 2 - 1, array.max(axis=0) + width / 2 + 1
        box = pygame.Rect(floor(low[0]), floor(low[1]), ceil(high[0] - low[0]) + 1, ceil(high[1] - low[1]) + 1)
        seen = box.clip(self.surface.get_rect())
        if seen.width == 0 or seen.height == 0:
            return
        drawn = ((array - seen.topleft) * larger).round(6)  # or a shape would depend on which like it came first
        key = draw, drawn.tobytes(), seen.size, colour, how
        sprite = _sprites.get(key)
        if sprite is None:
            mask = scratch((seen.width * larger, seen.height * larger), colour)
            draw(mask, colour, drawn.tolist(), *how)
            sprite = pygame.transform.smoothscale(mask, seen.size)
            if seen.width * seen.height <= _LARGEST_KEPT:
                _sprites[key] = sprite
                if len(_sprites) > _MOST_KEPT:
                    _sprites.pop(next(iter(_sprites)), None)
        self._blit(sprite, seen.topleft, opacity)

    def _blit(self, sprite: pygame.Surface, position: tuple[int, int], opacity: float) -> None:
        sprite.set_alpha(round(255 * opacity))
        self.surface.blit(sprite, position)


def _line(mask: pygame.Surface, colour: Colour, points: list[Point], radius: float) -> None:
    for a, b in pairwise(points):
        pygame.draw.polygon(mask, colour, _quad(a, b, radius))
    for point in points:
        pygame.draw.circle(mask, colour, point, radius)


def _lines(mask: pygame.Surface, colour: Colour, points: list[Point], thick: int, ends: tuple[int, ...]) -> None:
    for start, end in pairwise(ends):
        pygame.draw.lines(mask, colour, False, points[start:end], thick)


def _fading(mask: pygame.Surface, colour: Colour, points: list[Point], opacities: tuple[int, ...]) -> None:
    one, other = points[: len(points) // 2], points[len(points) // 2 :]
    for i, opacity in enumerate(opacities):
        pygame.draw.polygon(mask, (*colour, opacity), [one[i], one[i + 1], other[i + 1], other[i]])


def _quad(a: Point, b: Point, radius: float) -> list[Point]:
    """The rectangle from a to b, ``radius`` to either side."""
    along, down = b[0] - a[0], b[1] - a[1]
    share = radius / (hypot(along, down) or 1.0)
    x, y = -down * share, along * share
    return [(a[0] + x, a[1] + y), (b[0] + x, b[1] + y), (b[0] - x, b[1] - y), (a[0] - x, a[1] - y)]


def _dashed(points: _Points, dash: float, gap: float) -> list[list[Point]]:
    """The pieces of a line that a dashed pen leaves."""
    array = np.asarray(points, dtype=float)
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(array, axis=0).T))])
    pieces = []
    for start in np.arange(0, along[-1], dash + gap):
        cuts = [start, *along[(along > start) & (along < start + dash)], min(start + dash, along[-1])]
        pieces.append(
            [(float(np.interp(s, along, array[:, 0])), float(np.interp(s, along, array[:, 1]))) for s in cuts]
        )
    return pieces
