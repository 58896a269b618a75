"""Cameras of frames that go with a ball, smoothly; they may be asked for any time in any order."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sandbox.engine.run import Run
from sandbox.picture.camera import Camera
from sandbox.picture.path import MOST_SAMPLES

#: The camera moves smoothly over so long, in s; with a fast ball, over so much of the picture's width.
SETTLE, SETTLE_WIDTH = 0.25, 0.05


class Follow:
    """A camera that goes with something.

    ``times`` (s) are evenly spaced, ``at`` (m, shape (n, 2)) is where to look and ``scales`` (px/m, shape (n,)) how
    near. Both are averaged over about ``settle`` s before and after, the scale in its logarithm: so a zoom looks even.
    """

    def __init__(
        self, times: np.ndarray, at: np.ndarray, scales: np.ndarray, anchor: tuple[float, float], settle: float = SETTLE
    ):
        self.times, self.anchor = times, anchor
        step = (times[1] - times[0]) or 1.0
        self.paths = [_smooth(path, settle / step) for path in (at[:, 0], at[:, 1], np.log(scales))]

    def camera(self, t: float) -> Camera:
        """The camera at time t in s."""
        x, y, log_scale = (float(np.interp(t, self.times, path)) for path in self.paths)
        return Camera((x, y), self.anchor, float(np.exp(log_scale)))


def _smooth(values: np.ndarray, spread: float) -> np.ndarray:
    """Weighted with a bell of ``spread`` samples; the ends are held."""
    reach = int(3 * spread) + 1
    bell = np.exp(-0.5 * (np.arange(-reach, reach + 1) / max(spread, 1e-9)) ** 2)
    padded = np.concatenate([np.full(reach, values[0]), values, np.full(reach, values[-1])])
    return np.convolve(padded, bell / bell.sum(), mode="valid")


def sampled(run: Run, ball: str, width: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Even times of a run in s, the ball's state at each, and over how long, in s, a camera moves smoothly that shows
    ``width`` m and goes with the ball."""
    times = np.linspace(0.0, run.duration, max(2, min(MOST_SAMPLES, round(run.duration * 60))))
    states = np.array([run.state(ball, t) for t in times])
    fastest = max(float(np.hypot(states[:, 2], states[:, 3]).max()), 1e-9)
    return times, states, min(SETTLE, SETTLE_WIDTH * width / fastest)


class Chase:
    """Stays at ``home`` while the ball is in sight there, between two columns (px) and under ``top`` (px).

    ``ground`` gives the height of the ground in m for an array of x; under the ball it stays on home's row.
    """

    def __init__(
        self,
        run: Run,
        ball: str,
        home: Camera,
        columns: tuple[float, float],
        top: float,
        ground: Callable[[np.ndarray], np.ndarray],
    ):
        self.run, self.ball, self.columns = run, ball, columns
        self.radius: float = next(b.radius for b in run.setup.balls if b.name == ball)
        self.room = home.anchor[1] - top
        times, states, settle = sampled(run, ball, (columns[1] - columns[0]) / home.scale)
        under = ground(states[:, 0])
        scales = np.minimum(home.scale, 0.8 * self.room / np.maximum(states[:, 1] + self.radius - under, 1e-9))
        at = np.clip(home.at[0], *self._bounds(states[:, 0], home.anchor[0], scales))
        self.follow = Follow(times, np.column_stack([at, under]), scales, home.anchor, settle)

    def _bounds(self, x: Any, anchor: float, scale: Any) -> tuple[Any, Any]:
        """Where the camera has to look at least and at most, in m, for a ball at x to be between the columns."""
        low, high = self.columns
        return x - (high - anchor) / scale, x - (low - anchor) / scale

    def camera(self, t: float) -> Camera:
        """The camera at time t in s, on whole px, and with the ball in sight whatever smoothing says."""
        smooth = self.follow.camera(t)
        x, y, *_ = self.run.state(self.ball, t)
        under = round(smooth.at[1] * smooth.scale) / smooth.scale
        scale = float(f"{min(smooth.scale, self.room / max(y + self.radius - under, 1e-9)):.4g}")
        low, high = self._bounds(x, smooth.anchor[0], scale)
        return Camera((round(min(max(smooth.at[0], low), high) * scale) / scale, under), smooth.anchor, scale)
