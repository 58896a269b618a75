"""A camera for frames that stays at home while the ball is in sight there, and goes with it when it leaves."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from sandbox.engine.run import Run
from sandbox.picture.camera import Camera, Follow
from sandbox.picture.path import MOST_SAMPLES

#: The camera moves smoothly over so long, in s; with a fast ball, over so much of the picture's width.
SETTLE, SETTLE_WIDTH = 0.25, 0.05


def sampled(run: Run, ball: str) -> tuple[np.ndarray, np.ndarray]:
    """Even times of a run in s, and the ball's state at each."""
    times = np.linspace(0.0, run.duration, max(2, min(MOST_SAMPLES, round(run.duration * 60))))
    return times, np.array([run.state(ball, t) for t in times])


def settling(states: np.ndarray, width: float) -> float:
    """Over how long, in s, a camera that shows ``width`` m moves smoothly when it goes with the ball."""
    fastest = max(float(np.hypot(states[:, 2], states[:, 3]).max()), 1e-9)
    return min(SETTLE, SETTLE_WIDTH * width / fastest)


class Chase:
    """Keeps the ball between two columns (px) and under ``top`` (px), seen from ``home`` if it can.

    The ground under the ball, whose height in m ``ground`` gives for an array of x, stays on home's row. The camera may
    be asked for any time in any order.
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
        self.run, self.ball, self.home, self.columns = run, ball, home, columns
        self.radius: float = next(b.radius for b in run.setup.balls if b.name == ball)
        self.room = home.anchor[1] - top
        times, states = sampled(run, ball)
        under = ground(states[:, 0])
        scales = np.minimum(home.scale, 0.8 * self.room / np.maximum(states[:, 1] + self.radius - under, 1e-9))
        at = np.clip(home.at[0], *self._bounds(states[:, 0], home.anchor[0], scales))
        settle = settling(states, (columns[1] - columns[0]) / home.scale)
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
