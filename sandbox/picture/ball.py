"""Balls: a colour and marks that turn with it in three dimensions, lit from above the left shoulder.

Directions are x to the right, y up, z out of the picture.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from functools import cache, lru_cache
from math import ceil, cos, floor, hypot, pi, sin, tau
from typing import ClassVar, NamedTuple

import numpy as np
import pygame

from sandbox.picture.painter import Painter, Point, blank
from sandbox.picture.palette import Colour, palette

_CARD, _TRACE = palette("card"), palette("trace")

#: A smaller ball is drawn this large, in px across on 360 rows and in proportion on more.
SMALLEST = 7.0
#: The balls along a path are so much smaller than the one at its end, where they are all drawn too large.
_MARK = 0.62

#: The surface is looked up at so many places along each side of a pixel, in a skin of so many places along each side.
_FINER, FACE = 3, 128
#: Balls are placed to this share of a px.
_PHASE = 1 / 4
#: Direction of the light: over the left shoulder.
LIGHT = np.array([-0.42, 0.50, 0.76])
#: Share of its colour that a ball shows where no light falls, and where its surface turns away.
DARK, EDGE = 0.55, 0.7
#: Opacity of the thin dark rim around balls and bodies.
RIM = 0.65
#: Width of the darker edge of a flat body, as a share of its radius.
_BEVEL = 0.07
#: s over which a spin whose axis turns is taken as even.
_STEP = 1 / 60


def least_radius(rows: int) -> float:
    """Least radius of a ball in px on a picture of so many rows."""
    return SMALLEST / 2 * max(1.0, rows / 360)


def mark_radius(rows: int) -> float:
    """Least radius in px of the balls along a path."""
    return max(SMALLEST / 2, _MARK * least_radius(rows))


class Mark(NamedTuple):
    """A mark on a ball: its colour, and the share of it (0 to 1) in each direction of an array of shape (..., 3)."""

    colour: Colour
    cover: Callable[[np.ndarray], np.ndarray]
    least: float = 0.0  # px; a smaller ball shows its colour instead


class Look:
    """The look of a ball: its colour, the marks on it, later ones on top, and how bright the light's image on it is."""

    #: Up to this share of its radius it hides what lies behind it, however it is turned.
    solid: float = 1.0

    def __init__(self, colour: Colour, *marks: Mark, gloss: float = 0.2):
        self.colour, self.marks, self.gloss = colour, marks, gloss
        self.skin = cache(self._skin)

    def draw(
        self, painter: Painter, centre: Point, radius: float, turn: np.ndarray, unit: float, enlarged: bool = False
    ) -> None:
        """Draw it, turned by a matrix; the ring says that it is enlarged."""
        painter.disc(centre, radius + max(0.7, 0.8 * unit), _TRACE["rim"], RIM)
        x, y = (round(value / _PHASE) * _PHASE for value in centre)
        column, row = floor(x), floor(y)
        phase = x - column - 0.5, y - row - 0.5
        sprite = _sprite(self, round(radius * 8) / 8, phase, np.round(turn, 3).astype(np.float32).tobytes())
        painter.surface.blit(sprite, (column - sprite.get_width() // 2, row - sprite.get_height() // 2))
        if enlarged:
            painter.ring(centre, radius + 4.5 * unit, max(1.2, 1.7 * unit), _CARD["accent"])

    def _skin(self, shown: int) -> np.ndarray:
        """Colours (0 to 255) of the halves around its +z and its -z, with so many marks, shape (2, FACE, FACE, 3)."""
        places = (np.arange(FACE) + 0.5) / FACE * 2 - 1
        x, y = np.meshgrid(places, places, indexing="ij")
        beyond = np.maximum(np.hypot(x, y), 1.0)  # the corners show what is on the edge
        x, y = x / beyond, y / beyond
        z = np.sqrt(np.maximum(0.0, 1 - x**2 - y**2))
        at = np.stack([np.stack([x, y, side * z], axis=-1) for side in (1.0, -1.0)])
        colours = np.broadcast_to(np.array(self.colour, float), at.shape)
        for mark in self.marks[:shown]:
            colours = colours + (np.array(mark.colour, float) - colours) * mark.cover(at)[..., None]
        return colours.astype(np.uint8)


class Silhouette(Look):
    """Not a ball but something flat that points where it is turned: shapes of a colour, with corners in radii."""

    rimmed: ClassVar[bool] = False  # the first shape has a thin dark rim, as balls have

    def __init__(self, colour: Colour, *shapes: tuple[Sequence[Point], Colour]):
        super().__init__(colour)
        self.shapes = shapes

    def draw(
        self, painter: Painter, centre: Point, radius: float, turn: np.ndarray, unit: float, enlarged: bool = False
    ) -> None:
        shapes = [
            (np.asarray(centre) + radius * (np.asarray(corners) @ turn[:2, :2].T) * (1.0, -1.0), colour)
            for corners, colour in self.shapes
        ]
        if self.rimmed:
            outline = shapes[0][0]
            painter.line([*outline, outline[0]], 2 * max(0.7, 0.8 * unit), _TRACE["rim"], RIM)
        for corners, colour in shapes:
            painter.polygon(corners, colour)
        if enlarged:
            reach = max(hypot(*corner) for corners, _ in self.shapes for corner in corners)
            painter.ring(centre, reach * radius + 2.0 * unit, max(1.2, 1.7 * unit), _CARD["accent"])


class Flat(Silhouette):
    """A body of any outline: corners in radii around its centre, a darker edge, and a cross where its mass is."""

    rimmed = True  # so that a thin one stands out on its path

    def __init__(self, colour: Colour, rim: Sequence[Point]):
        edge, mark = (tuple(round(share * part) for part in colour) for share in (0.62, 0.78))
        corners = np.asarray(rim)
        sides = np.roll(corners, -1, axis=0) - corners
        self.solid = float(np.min(abs(corners[:, 0] * sides[:, 1] - corners[:, 1] * sides[:, 0]) / np.hypot(*sides.T)))
        inner = corners * (1.0 - _BEVEL * np.abs(corners).max() / np.maximum(np.hypot(*corners.T), _BEVEL))[:, None]
        arm, thick = 0.16 * np.hypot(*corners.T).min(), 0.05 * np.hypot(*corners.T).min()
        bars = [[(-x, -y), (x, -y), (x, y), (-x, y)] for x, y in ((arm, thick), (thick, arm))]
        super().__init__(colour, (corners, edge), (inner, colour), *((bar, mark) for bar in bars))  # type: ignore[arg-type]


class Fall(NamedTuple):
    """The fall of a ball that begins standing, such as a pin: it is then seen from the side."""

    start: float  # s
    towards: float  # rad, where its head goes
    takes: float  # s
    shapes: Sequence[tuple[np.ndarray, Colour]]  # corners in radii, its head along x


def near(points: np.ndarray, angle: float) -> Callable[[np.ndarray], np.ndarray]:
    """Discs around points (unit vectors, shape (n, 3)), within ``angle`` (rad) as seen from the ball's middle."""
    return lambda at: ((at @ points.T).max(axis=-1) > cos(angle)).astype(float)


def seams(colour: Colour) -> Mark:
    """The seams of a basketball: two great circles, and an arc on either side."""

    def cover(at: np.ndarray) -> np.ndarray:
        x, y, _ = np.moveaxis(at, -1, 0)
        line = np.minimum(np.minimum(abs(x), abs(y)), abs(np.hypot(1.28 - abs(x), y) - 0.77))
        return (line < 0.055).astype(float)

    return Mark(colour, cover)


def dimples(colour: Colour) -> Mark:
    """The dimples of a golf ball: a spiral of them, evenly spread (Fibonacci)."""
    z, turn = np.linspace(-1, 1, 240), np.arange(240) * pi * (3 - 5**0.5)
    wide = np.sqrt(1 - z**2)
    return Mark(colour, near(np.column_stack([wide * np.cos(turn), wide * np.sin(turn), z]), 0.07), least=12)


def patches(colour: Colour) -> Mark:
    """The twelve patches of a soccer ball, one of them in front."""
    ring = [(sin(i * tau / 5), cos(i * tau / 5)) for i in range(5)]
    front = [(0.0, 0.0, 1.0), *((x * 2 / 5**0.5, y * 2 / 5**0.5, 1 / 5**0.5) for x, y in ring)]
    middles = np.array(front)
    return Mark(colour, near(np.concatenate([middles, -middles]), 0.27))


def turned(axis_angle: Sequence[float]) -> np.ndarray:
    """The matrix that turns by the length of the vector, in rad, about its direction."""
    angle = hypot(*axis_angle)
    x, y, z = (part / angle for part in axis_angle) if angle else (0.0, 0.0, 1.0)
    across = np.array([(0.0, -z, y), (z, 0.0, -x), (-y, x, 0.0)])
    return np.eye(3) + sin(angle) * across + (1 - cos(angle)) * across @ across


class Orientation:
    """The orientation of a ball at any time, from its spin (rad/s, about x, y and z) as a function of time.

    ``times`` (s) are where the spin or its rate may jump; between two of them it changes evenly, and is followed in
    steps of STEP s where that turns its axis. The columns of the matrices are the ball's own axes.
    """

    def __init__(self, spin: Callable[[float], tuple[float, float, float]], times: Sequence[float], start: np.ndarray):
        self.spin = spin
        self.times: list[float] = []
        self.matrices: list[np.ndarray] = []
        matrix = start
        for a, b in zip(times, [*times[1:], times[-1]], strict=True):
            one, other = spin(a + (b - a) / 3), spin(b - (b - a) / 3)
            straight = np.linalg.norm(np.cross(one, other)) <= 1e-9 * hypot(*one) * hypot(*other)  # along one line
            pieces = 1 if straight else ceil((b - a) / _STEP)
            for i in range(pieces):
                t, until = a + (b - a) * i / pieces, a + (b - a) * (i + 1) / pieces
                self.times.append(t)
                self.matrices.append(matrix)
                matrix = self._after(matrix, t, until)

    def _after(self, matrix: np.ndarray, t: float, until: float) -> np.ndarray:
        """Exact where the axis does not turn and the rate changes evenly."""
        if until <= t:
            return matrix
        spin = self.spin((t + until) / 2)
        return turned([(until - t) * rate for rate in spin]) @ matrix if any(spin) else matrix

    def at(self, t: float) -> np.ndarray:
        """The ball's axes at time t in s."""
        i = max(0, bisect_right(self.times, t) - 1)
        return self._after(self.matrices[i], self.times[i], t)


@lru_cache(maxsize=256)
def _sprite(look: Look, radius: float, phase: Point, turn: bytes) -> pygame.Surface:
    """A ball of ``radius`` px whose middle lies ``phase`` px past the middle pixel's centre."""
    seen, normals, counts, shade, image, coverage = _grid(radius, phase)
    side = len(coverage)
    own = normals @ np.frombuffer(turn, np.float32).reshape(3, 3)  # directions in the ball's own axes
    column, row = (np.minimum((own[:, i] + 1) * (0.5 * FACE), FACE - 1).astype(np.intp) for i in (0, 1))
    found = np.zeros((side * _FINER, side * _FINER, 3), np.float32)
    skin = look.skin(sum(radius >= mark.least for mark in look.marks))
    found[seen] = skin[(own[:, 2] < 0).astype(np.intp), column, row]
    sprite = blank((side, side), transparent=True)
    pixels, alpha = pygame.surfarray.pixels3d(sprite), pygame.surfarray.pixels_alpha(sprite)
    pixels[...] = np.clip(_sums(found) / counts * shade + look.gloss * image, 0, 255)
    alpha[...] = coverage
    return sprite


def _sums(values: np.ndarray) -> np.ndarray:
    """Over the places in each pixel."""
    side = len(values) // _FINER
    return values.reshape(side, _FINER, side, _FINER, -1).sum(axis=(1, 3))


@lru_cache(maxsize=64)
def _grid(radius: float, phase: Point) -> tuple[np.ndarray, ...]:
    """Everything that balls of one size have in common: which places are on the ball, and their directions; how many
    of them each px has, how bright it is, how much of the light's image (0 to 255) it shows, and how much of it is
    covered (0 to 255)."""
    reach = ceil(radius + 1)
    side = 2 * reach + 1
    places = ((np.arange(side * _FINER) + 0.5) / _FINER - reach - 0.5)[None] - np.array(phase)[:, None]
    x, y = np.meshgrid(places[0] / radius, -places[1] / radius, indexing="ij")
    away = np.hypot(x, y)
    seen = away < 1 + 1 / radius  # a px that is covered by a sliver shows what is on the edge
    x, y = x / np.maximum(away, 1.0), y / np.maximum(away, 1.0)
    z = np.sqrt(np.maximum(0.0, 1 - x**2 - y**2))
    normals = np.stack([x, y, z], axis=-1)
    light = LIGHT / np.linalg.norm(LIGHT)
    halfway = light + np.array([0.0, 0.0, 1.0])
    lit, shine = (np.clip(normals @ way / np.linalg.norm(way), 0, 1) for way in (light, halfway))
    bright = (DARK + (1.16 - DARK) * lit) * (EDGE + (1 - EDGE) * np.sqrt(z))  # darker where the surface turns away
    counts = np.maximum(_sums(seen.astype(float)), 1)
    centres = np.arange(-reach, reach + 1)
    distance = np.hypot(centres[:, None] - phase[0], centres[None, :] - phase[1])
    coverage = (np.clip(radius - distance + 0.5, 0, 1) * 255 + 0.5).astype(np.uint8)
    shade, image = _sums(bright * seen) / counts, _sums(255 * shine**60 * seen) / counts
    return seen, normals[seen].astype(np.float32), counts, shade, image, coverage
