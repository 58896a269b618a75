"""Metres to pixels: straight, and from the side in central perspective, in which what lies behind is drawn smaller.

The only place where y is flipped: up in the world, down on the picture.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np


class Box(NamedTuple):
    """A rectangle of the world in m, y up."""

    left: float
    bottom: float
    right: float
    top: float


class Area(NamedTuple):
    """A rectangle of the picture in px, y down."""

    left: float
    top: float
    right: float
    bottom: float

    @property
    def middle(self) -> tuple[float, float]:
        return (self.left + self.right) / 2, (self.top + self.bottom) / 2


@dataclass(frozen=True)
class Camera:
    """Shows the world point ``at`` (m) at the picture's point ``anchor`` (px), with ``scale`` px/m.

    Heights are drawn ``stretch`` times as large as lengths; a picture that stretches them says so.
    """

    at: tuple[float, float]
    anchor: tuple[float, float]
    scale: float
    stretch: float = 1.0

    def pixel(self, x: float, y: float) -> tuple[float, float]:
        """World point in m to picture point in px."""
        return (
            self.anchor[0] + (x - self.at[0]) * self.scale,
            self.anchor[1] - (y - self.at[1]) * self.scale * self.stretch,
        )

    def pixels(self, points: np.ndarray) -> np.ndarray:
        """World points in m, shape (n, 2), to picture points in px, shape (n, 2)."""
        return np.asarray(self.anchor) + (np.asarray(points)[:, :2] - self.at) * (
            self.scale,
            -self.scale * self.stretch,
        )

    def world(self, px: float, py: float) -> tuple[float, float]:
        """Picture point in px to world point in m."""
        return (
            self.at[0] + (px - self.anchor[0]) / self.scale,
            self.at[1] - (py - self.anchor[1]) / (self.scale * self.stretch),
        )

    def points(self, points: np.ndarray) -> np.ndarray:
        """From above: points in m on the ground, shape (n, 2), or over it, shape (n, 3), to points in px."""
        return self.pixels(np.asarray(points)[:, [0, -1]])

    def scale_at(self, points: np.ndarray) -> float:
        """From above: the same everywhere."""
        return self.scale

    @classmethod
    def fit(cls, box: Box, area: Area, stretch: float = 1.0) -> Camera:
        """The largest scale at which the box is inside the area: in its middle along, standing on its floor."""
        width, height = area.right - area.left, area.bottom - area.top
        spans = ((width, box.right - box.left), (height, (box.top - box.bottom) * stretch))
        scale = min(pixels / metres for pixels, metres in spans if metres > 0)
        middle = (box.left + box.right) / 2
        return cls((middle, box.bottom), ((area.left + area.right) / 2, area.bottom), scale, stretch)


@dataclass(frozen=True)
class Eye:
    """Sees the plane of play as the camera shows it, and what is ``z`` m behind it smaller, in central perspective.

    It looks at the point in column ``centre`` and row ``level`` (px), from ``distance`` m before the plane of play;
    ``unit`` is what 1 px is on a picture of 720 rows.
    """

    camera: Camera
    centre: float
    level: float
    distance: float
    unit: float = 1.0

    @property
    def base(self) -> float:
        """The row in which the plane of play meets level ground, in px."""
        return self.camera.anchor[1]

    def along(self, px: float, z: float) -> float:
        """The place along the plane of play, in m, of a thing z m behind the plane that is seen in a column (px)."""
        return self.camera.world(self.centre + (px - self.centre) / self.share(z), 0.0)[0]

    def share(self, z: float) -> float:
        """The size of things z m behind the plane of play, as a share of that in it."""
        return self.distance / (self.distance + z)

    def depth(self, share: float) -> float:
        """The distance behind the plane of play, in m, at which things look so much smaller."""
        return self.distance * (1 / share - 1)

    def scale_at(self, points: np.ndarray) -> float:
        """The scale at these points (m, shape (n, 3)), in px/m."""
        return self.camera.scale * float(np.mean([self.share(z) for *_, z in points.tolist()]))

    def points(self, points: np.ndarray) -> np.ndarray:
        """World points in m, shape (n, 3), to picture points in px, shape (n, 2)."""
        points = np.asarray(points, dtype=float)
        share = self.distance / (self.distance + points[:, 2:])
        middle = np.array([self.centre, self.level])
        return middle + (self.camera.pixels(points) - middle) * share
