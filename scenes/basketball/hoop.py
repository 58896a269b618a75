"""Drawing of stand, board and ring; the net is in its own file."""

from __future__ import annotations

from math import pi, tau

import numpy as np

from sandbox.picture.depth import Eye
from sandbox.picture.painter import Painter
from sandbox.picture.palette import Colour, mix, palette, scene_colours

from .scene import Parameters, board, rims

COLOURS, SHADOW = scene_colours(__file__)["hoop"], palette("card")["shadow"]

#: Width of the board, and size and height of the square on it, in m.
BOARD_WIDTH, SQUARE_WIDTH, SQUARE_HEIGHT = 1.83, 0.61, 0.46


class Stand:
    """What carries the board."""

    def __init__(self, parameters: Parameters):
        _, self.bottom, self.back, self.top = board(parameters)

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None:
        if near:
            return
        scale = eye.camera.scale
        foot, head = self.back + 1.45, self.back + 0.95  # m, the mast leans towards the ring
        height = self.top - self.bottom
        top = self.bottom + 0.30 * height

        def line(a: tuple[float, float], b: tuple[float, float], width: float, colour: Colour) -> None:
            painter.line([eye.point(*a), eye.point(*b)], width * scale, colour)

        painter.shadow(eye.point(foot + 0.1, 0.0), 0.9 * scale, 0.07 * scale, SHADOW, 0.4)
        line((foot + 0.75, 0.25), (head + 0.02, top), 0.08, COLOURS["strut"])
        for share in (0.15, 0.55):
            line((self.back, self.bottom + share * height), (head, top - 0.06), 0.06, COLOURS["stand"])
        line((foot, 0.2), (head, top), 0.16, COLOURS["stand"])
        sides = ((-0.62, 0.0), (-0.55, 0.36), (0.95, 0.36), (0.95, 0.0))
        painter.polygon([eye.point(foot + x, y) for x, y in sides], COLOURS["stand"])


class Hoop:
    """The glass board with its square, and the ring, whose near half is in front of the ball."""

    def __init__(self, parameters: Parameters):
        self.face, self.bottom, _, self.top = board(parameters)
        (front, self.height), self.back = rims(parameters)
        self.middle, self.radius = (front + self.back[0]) / 2, (self.back[0] - front) / 2
        self.tube = parameters.hoop.tube_radius

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None:
        tube = max(2.4 * eye.unit, 2 * self.tube * eye.camera.scale)
        if near:
            painter.line(self._ring(eye, pi, tau), tube, COLOURS["ring"])
            return
        thin = max(1.2 * eye.unit, 0.022 * eye.camera.scale)
        glass = self._on_board(eye, self.bottom, self.top, BOARD_WIDTH / 2)
        painter.polygon(glass, COLOURS["glass"], 0.30)
        low = max(self.bottom, self.height)
        square = self._on_board(eye, low, max(low, min(self.top, low + SQUARE_HEIGHT)), SQUARE_WIDTH / 2)
        for corners in (glass, square):
            painter.lines([[*corners, *corners[:2]]], thin, COLOURS["edge"], 0.92)
        colour = mix(COLOURS["ring"], SHADOW, 0.35)
        painter.line([eye.point(*self.back), eye.point(self.face, self.height)], 0.9 * tube, colour)
        painter.line(self._ring(eye, 0.0, pi), tube, colour)

    def _on_board(self, eye: Eye, bottom: float, top: float, half: float) -> np.ndarray:
        """Corners in px of a rectangle on the board's face, ``half`` m to either side of the plane of play."""
        corners = ((bottom, -half), (bottom, half), (top, half), (top, -half))
        return eye.points(np.array([(self.face, y, z) for y, z in corners]))

    def _ring(self, eye: Eye, start: float, end: float) -> np.ndarray:
        """A part of the ring in px, from one angle to another; from 0 to pi it lies behind the plane of play."""
        turn = np.linspace(start, end, 33)
        x, z = self.middle + self.radius * np.cos(turn), self.radius * np.sin(turn)
        return eye.points(np.column_stack([x, np.full(33, self.height), z]))
