"""The camera of frames that goes with a ball, smoothly; it may be asked for any time in any order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sandbox.engine.paths.run import Run
from sandbox.picture.camera import Area, Camera
from sandbox.picture.path import MOST_SAMPLES

#: The camera moves smoothly over so long, in s; with a fast ball, over so much of the width in which it keeps the ball.
_SETTLE, _SETTLE_WIDTH = 0.25, 0.07
#: In sight is a ball that is so far outside the area in which the camera keeps it, as a share of that.
_SLACK = 0.1
#: From the side the highest ball is so far up, as a share of the room over the ground.
_HIGHEST = 0.8


class Chase:
    """Stays at ``home`` while the ball is in sight there: inside an ``area`` of the picture (px).

    From the side, over ``ground`` (height in m for an array of x), what is under the ball stays in home's row, and a
    ball that is too high there is seen from farther away.
    """

    def __init__(
        self, run: Run, ball: str, home: Camera, area: Area, ground: Callable[[np.ndarray], np.ndarray] | None = None
    ):
        self.run, self.ball, self.anchor, self.upright = run, ball, home.anchor, ground is not None
        self.radius: float = next(b.radius for b in run.setup.balls if b.name == ball)
        across, down = home.anchor
        self.reach = (area.left - across, area.right - across), (down - area.bottom, down - area.top)  # px, y up
        self.times = np.linspace(0.0, run.duration, max(2, min(MOST_SAMPLES, round(run.duration * 60))))
        x, y, *velocity = np.array([run.state(ball, t)[:4] for t in self.times]).T
        scales = np.full(len(x), home.scale)
        if ground is not None:
            under = ground(x)
            scales = np.minimum(scales, _HIGHEST * self.reach[1][1] / np.maximum(y + self.radius - under, 1e-9))
        at = [np.clip(home.at[0], *self._bounds(0, x, scales))]
        at.append(np.clip(home.at[1], *self._bounds(1, y, scales)) if ground is None else under)
        width, fastest = (area.right - area.left) / home.scale, max(float(np.hypot(*velocity).max()), 1e-9)
        spread = min(_SETTLE, _SETTLE_WIDTH * width / fastest) / (self.times[1] or 1.0)
        # the scale in its logarithm: so a zoom looks even
        self.paths = [_smooth(path, spread) for path in (*at, np.log(scales))]

    def _bounds(self, axis: int, place: Any, scale: Any, slack: float = 0.0) -> tuple[Any, Any]:
        """The least and greatest place in m at which the camera can look for a ball there to be inside the area."""
        low, high = self.reach[axis]
        spare = slack * (high - low)
        return place - (high + spare) / scale, place - (low - spare) / scale

    def camera(self, t: float) -> Camera:
        """The camera at time t in s, on whole px, and with the ball in sight whatever smoothing says."""
        *at, log_scale = (float(np.interp(t, self.times, path)) for path in self.paths)
        place, scale = self.run.state(self.ball, t)[:2], float(np.exp(log_scale))
        if self.upright:
            at[1] = round(at[1] * scale) / scale
            scale = float(f"{min(scale, self.reach[1][1] / max(place[1] + self.radius - at[1], 1e-9)):.4g}")
        for axis in (0,) if self.upright else (0, 1):
            low, high = self._bounds(axis, place[axis], scale, _SLACK)
            at[axis] = round(min(max(at[axis], low), high) * scale) / scale
        return Camera((at[0], at[1]), self.anchor, scale)


def _smooth(values: np.ndarray, spread: float) -> np.ndarray:
    """Weighted with a bell of ``spread`` samples; the ends are held."""
    reach = int(3 * spread) + 1
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / max(spread, 1e-9)) ** 2)
    padded = np.concatenate([np.full(reach, values[0]), values, np.full(reach, values[-1])])
    return np.convolve(padded, bell / bell.sum(), mode="valid")
