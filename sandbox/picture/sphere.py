"""Balls that turn in three dimensions, their marks with them: x to the right, y up, z out of the picture."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Callable, Sequence
from functools import lru_cache
from math import ceil, cos, floor, hypot, sin

import numpy as np
import pygame

from sandbox.picture.painter import Painter, Point, blank

#: The surface is looked up at so many places along each side of a pixel.
FINER = 3
#: Places along each side of a face of a skin.
FACE = 128
#: Balls are placed to this share of a px.
PHASE = 1 / 4
#: Where the light comes from: over the left shoulder.
LIGHT = np.array([-0.42, 0.50, 0.76])
#: s over which a spin whose axis turns is taken as even.
STEP = 1 / 60
#: How much of its colour a ball shows where no light falls, and how bright the light's image on it is.
DARK, GLOSS = 0.48, 0.75

#: Colours (0 to 255, shape (..., 3)) for directions from a ball's middle (unit vectors, shape (..., 3)).
Paint = Callable[[np.ndarray], np.ndarray]


def skin(paint: Paint) -> np.ndarray:
    """A ball's surface as ``draw`` reads it: seen from its own +x and from its -x, shape (2, FACE, FACE, 3)."""
    places = (np.arange(FACE) + 0.5) / FACE * 2 - 1
    y, z = np.meshgrid(places, places, indexing="ij")
    beyond = np.maximum(np.hypot(y, z), 1.0)  # the corners show what is on the edge
    y, z = y / beyond, z / beyond
    x = np.sqrt(np.maximum(0.0, 1 - y**2 - z**2))
    faces = [paint(np.stack([side * x, y, z], axis=-1)) for side in (1.0, -1.0)]
    return np.clip(np.stack(faces), 0, 255).astype(np.uint8)


def turned(axis_angle: Sequence[float] | np.ndarray) -> np.ndarray:
    """The matrix that turns by the length of the vector, in rad, about its direction."""
    x, y, z = axis_angle
    angle = hypot(x, y, z)
    if angle == 0.0:
        return np.eye(3)
    x, y, z = x / angle, y / angle, z / angle
    c, s = cos(angle), sin(angle)
    d = 1 - c
    return np.array(
        [
            [c + x * x * d, x * y * d - z * s, x * z * d + y * s],
            [y * x * d + z * s, c + y * y * d, y * z * d - x * s],
            [z * x * d - y * s, z * y * d + x * s, c + z * z * d],
        ]
    )


class Turning:
    """How a ball lies at any time, from its spin (rad/s, about x, y and z) as a function of time.

    ``times`` (s) are where the spin or its rate may jump; between two of them it changes evenly, and is followed in
    steps of STEP s where that turns its axis. The columns of the matrices are the ball's own axes.
    """

    def __init__(
        self,
        spin: Callable[[float], tuple[float, float, float]],
        times: Sequence[float],
        start: np.ndarray,
    ):
        self.spin = spin
        self.times: list[float] = []
        self.matrices: list[np.ndarray] = []
        matrix = start
        for a, b in zip(times, [*times[1:], times[-1]], strict=True):
            straight = _parallel(spin(a + (b - a) / 3), spin(b - (b - a) / 3))
            pieces = 1 if straight else ceil((b - a) / STEP)
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
        """How the ball lies at time t in s."""
        i = max(0, bisect_right(self.times, t) - 1)
        return self._after(self.matrices[i], self.times[i], t)


def _parallel(a: Sequence[float], b: Sequence[float]) -> bool:
    """Whether two vectors lie along one line, to rounding."""
    across = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return hypot(*across) <= 1e-9 * hypot(*a) * hypot(*b)


def draw(painter: Painter, centre: Point, radius: float, skin: np.ndarray, matrix: np.ndarray) -> None:
    """A ball of ``radius`` px with its skin turned by the matrix."""
    x, y = (round(value / PHASE) * PHASE for value in centre)
    column, row = floor(x), floor(y)
    sprite = _sprite(round(radius * 8) / 8, (x - column - 0.5, y - row - 0.5), _Kept(skin, np.round(matrix, 3)))
    painter.surface.blit(sprite, (column - sprite.get_width() // 2, row - sprite.get_height() // 2))


class _Kept:
    """A skin and how it lies, fit for a cache."""

    def __init__(self, skin: np.ndarray, matrix: np.ndarray):
        self.skin, self.matrix = skin, matrix
        self.key = id(skin), matrix.tobytes()

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Kept) and self.key == other.key

    def __hash__(self) -> int:
        return hash(self.key)


@lru_cache(maxsize=256)
def _sprite(radius: float, phase: Point, ball: _Kept) -> pygame.Surface:
    side, seen, normals, counts, shade, gloss, coverage = _grid(radius, phase)
    y, z = (((normals @ ball.matrix[:, axis]) * (0.5 * FACE) + 0.5 * FACE).astype(np.intp) for axis in (1, 2))
    face = (normals @ ball.matrix[:, 0] < 0).astype(np.intp)
    found = np.zeros((side * FINER, side * FINER, 3), np.float32)
    found[seen] = ball.skin[face, np.minimum(y, FACE - 1), np.minimum(z, FACE - 1)]
    colours = found.reshape(side, FINER, side, FINER, 3).sum(axis=(1, 3)) / counts
    sprite = blank((side, side), transparent=True)
    pixels = pygame.surfarray.pixels3d(sprite)
    pixels[...] = np.clip(colours * shade + gloss, 0, 255)
    del pixels
    alpha = pygame.surfarray.pixels_alpha(sprite)
    alpha[...] = coverage
    del alpha
    return sprite


@lru_cache(maxsize=64)
def _grid(
    radius: float, phase: Point
) -> tuple[int, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """What all balls of one size have in common: side in px, which places are on the ball, their directions, how many
    of them each px has, how bright and how glossy it is, and how much of it is covered (0 to 255)."""
    reach = ceil(radius + 1)
    side = 2 * reach + 1
    places = ((np.arange(side * FINER) + 0.5) / FINER - reach - 0.5)[None] - np.array(phase)[:, None]
    x, y = np.meshgrid(places[0] / radius, -places[1] / radius, indexing="ij")
    away = np.hypot(x, y)
    seen = away < 1 + 1 / radius  # a px that is covered by a sliver shows what is on the edge
    x, y = x / np.maximum(away, 1.0), y / np.maximum(away, 1.0)
    z = np.sqrt(np.maximum(0.0, 1 - x**2 - y**2))
    normals = np.stack([x, y, z], axis=-1)
    light = LIGHT / np.linalg.norm(LIGHT)
    halfway = light + np.array([0.0, 0.0, 1.0])
    halfway /= np.linalg.norm(halfway)
    lit = np.clip(normals @ light, 0, 1)
    bright = (DARK + (1.16 - DARK) * lit) * (0.62 + 0.38 * np.sqrt(z))  # darker where the surface turns away
    shine = 255 * GLOSS * np.clip(normals @ halfway, 0, 1) ** 60

    def mean(values: np.ndarray) -> np.ndarray:
        return (values * seen).reshape(side, FINER, side, FINER).sum(axis=(1, 3))

    counts = np.maximum(mean(np.ones_like(away)), 1)
    centres = np.arange(-reach, reach + 1)
    distance = np.hypot(centres[:, None] - phase[0], centres[None, :] - phase[1])
    coverage = (np.clip(radius - distance + 0.5, 0, 1) * 255 + 0.5).astype(np.uint8)
    shade, gloss = mean(bright) / counts, mean(shine) / counts
    return side, seen, normals[seen].astype(np.float32), counts[..., None], shade[..., None], gloss[..., None], coverage
