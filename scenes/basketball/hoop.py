"""Stand, board, ring, and the net that hangs from it."""

from __future__ import annotations

from functools import lru_cache
from math import cos, exp, pi, sin, tau

import numpy as np

from sandbox.kit import Eye, Painter, Post, SceneRun, Shape, Thing, mix, palette, scene_colours
from sandbox.picture.answer import yielding

from .scene import Parameters, on_floor

COLOURS, SHADOW = scene_colours(__file__)["hoop"], palette("card")["shadow"]

#: Half the width of the board and of the square on it, and the square's height, in m.
BOARD, SQUARE, SQUARE_HEIGHT = 0.915, 0.305, 0.46
#: Strands around the ring, knots on each, and the width of the net's lower end over that of the ring.
STRANDS, KNOTS, NARROW = 11, 9, 0.56
#: Board and ring go down by so many m for each m/s of an impact on the ring or the board, at most so far, swing at this
#: rate (rad/s) and settle at this one (1/s); assumed.
SHAKES, DIPS, DEEPEST, RATTLES, CALMS = ("rim front", "rim back", "backboard"), 0.006, 0.03, 38.0, 5.0
#: After the ball has left, the net swings at this rate (rad/s) and settles at this rate (1/s), until its swing
#: has fallen to exp(-SETTLED).
SWING, SETTLE, SETTLED = 11.0, 3.0, 5.0


def stand(parameters: Parameters) -> list[Thing]:
    """The support of the board: a mast that leans towards the ring, on a heavy foot."""
    _, bottom, back, top = parameters.board
    foot, head, height = back + 1.45, back + 0.95, top - bottom
    up = bottom + 0.30 * height
    bars = [((foot + 0.75, 0.25), (head + 0.02, up), 0.04, "strut"), ((foot, 0.2), (head, up), 0.08, "stand")]
    bars += [((back, bottom + share * height), (head, up - 0.06), 0.03, "stand") for share in (0.15, 0.55)]
    base = [(foot + x, y, 0.0) for x, y in ((-0.62, 0.0), (-0.55, 0.36), (0.95, 0.36), (0.95, 0.0))]
    posts = [Post([(*a, 0.0), (*b, 0.0)], radius, COLOURS[part]) for a, b, radius, part in bars]
    return [*posts, Shape(base, COLOURS["stand"])]


def hoop(parameters: Parameters) -> list[Thing]:
    """The glass board with its square, and the ring, whose near half is in front of the ball."""
    face, bottom, _, top = parameters.board
    (front, height), (back, _) = parameters.hoop.rims
    middle, radius, tube = (front + back) / 2, (back - front) / 2, parameters.hoop.tube_radius
    low = max(bottom, height)
    high, shaded = max(low, min(top, low + SQUARE_HEIGHT)), mix(COLOURS["ring"], SHADOW, 0.35)
    glass, square = (
        [(face, y, z) for y, z in ((down, -half), (down, half), (up, half), (up, -half), (down, -half))]
        for down, up, half in ((bottom, top, BOARD), (low, high, SQUARE))
    )
    behind, before = (
        [(middle + radius * cos(turn), height, radius * sin(turn)) for turn in np.linspace(start, start + pi, 33)]
        for start in (0.0, pi)
    )
    return [
        Shape(glass, COLOURS["glass"], 0.30),
        *(Post(edge, 0.011, COLOURS["edge"]) for edge in (glass, square)),
        Post([(back, height, 0.0), (face, height, 0.0)], tube, shaded),
        Post(behind, tube, shaded),
        Post(before, tube, COLOURS["ring"], near=True),
    ]


def shaken(run: SceneRun, t: float) -> float:
    """The distance in m by which board and ring are down at a time in s of a run, after all hits so far."""
    hits = (e for e in run.events if e.kind == "impact" and e.partner in SHAKES and e.t < t)
    down = sum(DIPS * hit.speed * yielding(t - hit.t, RATTLES, CALMS) for hit in hits)
    return min(max(down, -DEEPEST), DEEPEST)


class HangingNet:
    """The net of one run, at any time of it. It is drawn apart from the physics: it yields to the ball and swings after
    it."""

    def __init__(self, run: SceneRun, parameters: Parameters):
        hoop = parameters.hoop
        self.run, self.wide, self.length = run, hoop.inner_diameter / 2 + hoop.tube_radius, parameters.net.length
        (self.middle, self.top), self.radius = hoop.middle, run.setup.balls[0].radius
        self._lines = lru_cache(maxsize=8)(self._strings)  # the same as long as net and camera rest
        self.entered, self.left = self._passage() if run.result["made"] else (np.inf, np.inf)

    def _passage(self) -> tuple[float, float]:
        """The times in s at which the ball enters the net for the last time and leaves it below."""
        floor = on_floor(self.run)
        into = [t for t, _ in self.run.crossings("ball", (0.0, self.top), (0.0, 1.0)) if t <= floor]
        end = self.top - self.length - 0.5 * self.radius
        out = (t for t, _ in self.run.crossings("ball", (0.0, end), (0.0, 1.0)) if t > into[-1])
        return into[-1], next(out, floor)

    @property
    def fullest(self) -> float:
        """A time in s at which the ball is well inside the net, or one at which the net is at rest."""
        return self.entered + 0.4 * (self.left - self.entered) if self.left < np.inf else 0.0

    def draw(self, painter: Painter, eye: Eye, near: bool, t: float) -> None:
        """The half in front of the ball or the one behind it, at time t in s."""
        width = max(0.9 * eye.unit, 0.012 * eye.camera.scale)
        lines = self._lines(eye, near, t if self._moves(t) else 0.0)
        painter.lines(lines, width, COLOURS["net"], 0.75 if near else 0.3)

    def _moves(self, t: float) -> bool:
        return self.entered < t <= self.left + SETTLED / SETTLE

    def _strings(self, eye: Eye, near: bool, t: float) -> np.ndarray:
        """Their ends in px, shape (n, 2, 2)."""
        down = np.linspace(0, 1, KNOTS)
        aside, wide = self._shape(down, t)
        strand = np.arange(2 * STRANDS)[:, None]
        turn = strand // 2 / STRANDS * tau + (-1) ** strand * down * (KNOTS - 1) * pi / STRANDS
        x, y, z = self.middle + aside + wide * np.cos(turn), self.top - self.length * down, wide * np.sin(turn)
        places = np.stack([x, np.broadcast_to(y, x.shape), z], axis=-1)
        points = eye.points(places.reshape(-1, 3)).reshape(*turn.shape, 2)
        seen = (np.sin(turn) < 0) == near
        return np.stack([points[:, :-1], points[:, 1:]], axis=2)[seen[:, :-1] | seen[:, 1:]]

    def _shape(self, down: np.ndarray, t: float) -> tuple[np.ndarray, np.ndarray]:
        """The displacement and the width of the net, in m, at shares ``down`` of its length below the ring."""
        wide = self.wide * (1 - (1 - NARROW) * down**0.7)
        if not self._moves(t):
            return 0.0 * down, wide
        x, y, *_ = self.run.state("ball", min(t, self.left))
        depth = max(0.05, (self.top - y) / self.length)
        pushed = 0.7 * (x - self.middle) * np.where(down < depth, down / depth, 1 - 0.5 * (down - depth))
        if t <= self.left:
            around = np.sqrt(np.maximum(0.0, self.radius**2 - ((down - depth) * self.length) ** 2))
            return pushed, np.maximum(wide, around * np.minimum(1.0, 6 * down))
        after = t - self.left
        swing = exp(-SETTLE * after)
        return pushed * swing * cos(SWING * after), wide * (1 + 0.3 * down * swing * sin(1.7 * SWING * after))
