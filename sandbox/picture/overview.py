"""A small map in frames whose camera goes along with the ball: the whole path, and where on it the ball is."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
import pygame

from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.painter import Painter
from sandbox.picture.palette import palette
from sandbox.picture.path import FINEST, apart

if TYPE_CHECKING:
    from sandbox.picture.side import SideView

CARD = palette("card")
#: Its size, as shares of the picture's width and height.
SIZE = 0.24, 0.15


class Overview:
    """The map of a side view."""

    def __init__(self, view: SideView[Any]) -> None:
        self.view, self.unit = view, view.unit
        self.rect = pygame.Rect(0, 0, *(round(share * side) for share, side in zip(SIZE, view.size, strict=True)))
        self.rect.topright = view.sheet.frame.topright

    @cached_property
    def camera(self) -> Camera:
        """Shows all paths, and what is aimed at."""
        view, rect, inset, (goal, _) = self.view, self.rect, 2.4 * self.view.sheet.gap, self.view.datum[0]
        (left, _), (right, top) = view.points.min(axis=0), view.points.max(axis=0)
        left, right = min(left, goal), max(right, goal, left + 60 * view.radius)
        heights = view.profile(left, right)[:, 1]
        area = Area(rect.left + inset, rect.top + inset, rect.right - 2 * inset, rect.bottom - inset)
        return Camera.fit(Box(left, heights.min(), right, max(top, heights.max())), area, view.camera.stretch)

    @cached_property
    def ground(self) -> np.ndarray:
        """The ground, in px."""
        gap = self.view.sheet.gap
        low, high = (self.camera.world(px, 0)[0] for px in (self.rect.left + gap, self.rect.right - gap))
        return self.camera.pixels(self.view.profile(low, high))

    @cached_property
    def kept(self) -> list[int]:
        """Which points of the path can be told apart."""
        return apart(self.camera.pixels(self.view.path.points), FINEST)

    def draw(self, painter: Painter, t: float) -> pygame.Rect:
        """As it is at time t in s; returns where it is."""
        view, camera, thin = self.view, self.camera, max(1, round(1.6 * self.unit))
        painter.panel(self.rect, CARD["background"], CARD["opacity"], 8 * self.unit)
        painter.thread(self.ground, thin, view.turf)
        for ghost in view.ghosts:
            points = camera.pixels(ghost.points)
            painter.thread(points[apart(points, FINEST)], 1, ghost.light)
        path, past = camera.pixels(view.path.points[self.kept]), view.path.samples[self.kept, 0] <= t
        at = camera.pixel(*view.run.state(view.ball, t)[:2])
        painter.thread(path, 1, CARD["quiet"])
        painter.thread([*path[past], at], thin + 1, view.TRACE)
        view.on_map(painter, camera)
        painter.disc(at, max(2.5, 4 * self.unit), CARD["accent"])
        return self.rect
