"""Depth for side views: what lies behind the plane of play is drawn smaller, in central perspective."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sandbox.picture.camera import Camera


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
        """Where along the plane of play, in m, what is seen in a column (px) and z m behind the plane stands."""
        return self.camera.world(self.centre + (px - self.centre) / self.share(z), 0.0)[0]

    def share(self, z: float) -> float:
        """How large things are z m behind the plane of play, against those in it."""
        return self.distance / (self.distance + z)

    def depth(self, share: float) -> float:
        """How far behind the plane of play, in m, things look so much smaller."""
        return self.distance * (1 / share - 1)

    def scale_at(self, points: np.ndarray) -> float:
        """How large things at these points (m, shape (n, 3)) are, in px/m."""
        return self.camera.scale * float(np.mean([self.share(z) for *_, z in points.tolist()]))

    def points(self, points: np.ndarray) -> np.ndarray:
        """World points in m, shape (n, 3), to picture points in px, shape (n, 2)."""
        points = np.asarray(points, dtype=float)
        share = self.distance / (self.distance + points[:, 2:])
        middle = np.array([self.centre, self.level])
        return middle + (self.camera.pixels(points) - middle) * share
