"""From a film's own times and coordinates to those of the scene: what is not known of these is fitted too."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, radians, sin

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.fit.measured import Free
from sandbox.scene import Scene

#: The keys of what may be free.
_KEYS = {"time": ("track.time",), "origin": ("track.origin.x", "track.origin.y"), "tilt": ("track.tilt",)}

#: A camera is tilted by at most this, in deg: assumed, more is seen while filming.
_TILT = 10.0

#: A track is shifted by at most this in m, or by its own extent if that is more: assumed.
_SHIFT = 1.0


@dataclass(frozen=True)
class Frame:
    """The axes and the clock of a film: ``free`` are those of KEYS that are fitted, in their order."""

    free: tuple[Free, ...] = ()

    def places(self, positions: np.ndarray, free: Sequence[float]) -> np.ndarray:
        """Positions in the scene in m, shape (points, 2): turned by the tilt, and then shifted by the origin."""
        values = self._named(free)
        angle = radians(values.get("track.tilt", 0.0))
        turn = np.array([[cos(angle), sin(angle)], [-sin(angle), cos(angle)]])
        shift = values.get("track.origin.x", 0.0), values.get("track.origin.y", 0.0)
        turned = positions @ turn if angle else positions
        return np.asarray(turned + shift)

    def elapsed(self, t: np.ndarray, free: Sequence[float]) -> np.ndarray:
        """Times since the launch in s."""
        return np.asarray(t - self._named(free).get("track.time", 0.0))

    def latest(self, t: np.ndarray) -> np.ndarray:
        """The greatest times since the launch in s that the ranges allow."""
        return self.elapsed(t, [one.low for one in self.free])

    def _named(self, free: Sequence[float]) -> dict[str, float]:
        return {one.key: value for one, value in zip(self.free, free, strict=True)}


def parse_free(option: str, texts: Sequence[str]) -> tuple[str, ...]:
    """The names in ``origin,time,tilt``, in the order of KEYS. Raises RequestError."""
    names = [name.strip() for text in texts for name in text.split(",")]
    for name in names:
        if name not in _KEYS:
            raise RequestError(f"{option} {name}: what may be free is {', '.join(_KEYS)}, as in {option} origin,time")
    return tuple(name for name in _KEYS if name in names)


def frame_of(scene: Scene, where: str, t: np.ndarray | None, positions: np.ndarray, names: Sequence[str]) -> Frame:
    """The frame of a film with these times in s and positions in m; it is searched near where its first point is that
    of the launch. Raises RequestError."""
    free: list[Free] = []
    extent = max(float(np.ptp(positions, axis=0).max()), _SHIFT)
    for name in names:
        if name == "time":
            if t is None:
                raise RequestError(f"{where}: has no times, so time cannot be free")
            first, last = float(t.min()), float(t.max())
            free.append(Free("track.time", first - max(last - first, 1.0), last, first, "s"))
        elif name == "origin":
            launch = scene.build().balls[0].position
            apart = np.asarray(launch) - positions[0]
            for axis, start in zip("xy", apart.tolist(), strict=True):
                free.append(Free(f"track.origin.{axis}", start - extent, start + extent, start, "m"))
        else:
            free.append(Free("track.tilt", -_TILT, _TILT, 0.0, "deg"))
    return Frame(tuple(free))
