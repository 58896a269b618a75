"""The camera that knows the sport: it shows what is still to come, goes in where a run is decided, and comes back.

A scene's picture declares its :class:`Story`. From that and from the run, whose events are all known, a
:class:`Camerawork` says for any time what is seen, and how fast time passes: window, films and pages all take it.

There are two clocks, both in s: t is that of the run, w that of the viewer, which goes on while time is slow, and after
the run is over.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, log2

import numpy as np

from sandbox.engine.paths.run import Run
from sandbox.picture.camera import Area, Box, Camera

#: The camera shows the mean of what had to be seen in the last so many s: so it eases from one to the next.
_EASE = 0.8
#: What comes to the decisive place crosses the picture in no less than so many s; time slows at most so much for that.
_APPROACH, _SLOWEST = 0.9, 16
#: Time slows within so many s and stays slow for so many after the decision; for so many the camera stays close.
_RAMP, _AFTER, _HOLD = 0.4, 0.5, 1.3
#: The camera comes back within so many s.
_BACK = 1.0
#: The share at which time slows where the camera does not move.
_NEAR_BY = 0.35
#: So often in a second the run is looked at, and how often at most; and the camera's keyframes in a second.
_LOOKS, _MOST, _KEYS = 240, 8000, 60


@dataclass(frozen=True)
class Story:
    """The thing that decides a run, such as keeper, ring, net or cup: its place in m, and when, in s.

    ``share`` says how far the camera goes in: the larger side of the place as a share of the picture's height then; 0
    where it stays and only time slows, as the picture has a part that shows the place from near by.
    ``balls`` are followed, each until a time in s, the one that decides last; if none is named, the one that is played.
    """

    place: Box
    at: float
    share: float = 0.35
    balls: Sequence[tuple[str, float]] = ()

    @property
    def side(self) -> float:
        """The larger side of the place, in m."""
        return max(self.place.right - self.place.left, self.place.top - self.place.bottom)


def frame_times(duration: float, fps: float) -> list[float]:
    """Times of the frames in s: ``fps`` of them per second from 0, and the end."""
    count = int(duration * fps * (1 + 1e-12)) + 1
    times = [i / fps for i in range(count)]
    # The end replaces a frame that is nearer to it than a tenth of a frame's time.
    return [t for t in times if t < duration - 0.1 / fps] + [duration] if duration > 0 else [0.0]


class Camerawork:
    """The part of a run that is seen in the ``area`` (px) of a picture so many px high, and the pace of time.

    It begins as the camera ``first`` shows it, and comes back to that or to the ``last``. ``slower`` is the factor by
    which all of the run is in slow motion. With a ``floor``, a height in m, nothing lower comes into the area.
    """

    def __init__(
        self,
        run: Run,
        story: Story,
        ball: str,
        area: Area,
        height: float,
        first: Camera,
        slower: int = 1,
        floor: float | None = None,
        last: Camera | None = None,
    ) -> None:
        self.story, self.area, self.first, self.last = story, area, first, last or first
        self._up = np.array([1.0, first.stretch])  # heights are in m of the picture, which may stretch them
        self._aspect = (area.right - area.left) / (area.bottom - area.top)
        self._floor = -np.inf if floor is None else floor * first.stretch
        self.decided = min(max(story.at, 0.0), run.duration)
        self.times = np.linspace(0.0, run.duration, int(np.clip(run.duration * _LOOKS, 2, _MOST)))
        followed = story.balls or [(ball, self.decided)]
        names = {ball, *(name for name, _ in followed)}
        ways = {name: run.states(name, self.times)[:, :2] * self._up for name in names}
        self._played = ways[ball]
        self._ways = np.array([ways[name] for name, _ in followed])
        ends = np.array([min(until, self.decided) for _, until in followed])
        self._ways[self.times > ends[:, None] + self.times[1]] = np.nan

        place = np.array([story.place[:2], story.place[2:]]) * self._up
        radius = max(each.radius for each in run.setup.balls if each.name == followed[-1][0])
        there = np.array(run.state(followed[-1][0], self.decided)[:2]) * self._up
        low, high = np.minimum(place[0], there - radius), np.maximum(place[1], there + radius)
        wide, full = area.right - area.left, (area.right - area.left) / first.scale
        least = min(full, wide * story.side / ((story.share or _NEAR_BY) * height))
        self.close = self._framed(low, high, least)
        self._slow(slower)
        self._go(low, high, least, full)

    def _framed(self, low: np.ndarray, high: np.ndarray, least: float) -> np.ndarray:
        """Boxes of the area's shape around corners in m, shape (..., 2), no narrower than ``least``; shape (..., 3):
        the middle along and up, and the width."""
        wide = np.maximum(np.maximum(high[..., 0] - low[..., 0], self._aspect * (high[..., 1] - low[..., 1])), least)
        middle = (low + high) / 2
        up = np.maximum(middle[..., 1], self._floor + wide / self._aspect / 2)
        return np.stack([middle[..., 0], up, wide], axis=-1)

    def _slow(self, slower: int) -> None:
        """Set the pace: the factor by which time is slower, at each of the times, and the viewer's clock."""
        x, y, wide = self.close
        half = np.array([wide / 2, wide / self._aspect / 2])
        with np.errstate(invalid="ignore"):
            outside = (np.abs(self._ways[-1] - (x, y)) > half).any(axis=1) & (self.times < self.decided)
        comes = float(self.times[np.flatnonzero(outside)[-1]]) if outside.any() else 0.0
        needed = _APPROACH / max(self.decided - comes, 1e-9) if outside.any() else 1.0
        self.slowest = max(slower, min(_SLOWEST, 2 ** ceil(log2(max(needed, 1.0)))))
        ramp = _RAMP * 2 / (slower + self.slowest)
        ends = self.decided + _AFTER / self.slowest
        nodes = np.array([comes - ramp, comes, ends, ends + ramp])
        self.pace = 1.0 / np.interp(self.times, nodes, 1.0 / np.array([slower, self.slowest, self.slowest, slower]))
        passes = np.diff(self.times) * (self.pace[1:] + self.pace[:-1]) / 2
        self.clock = np.concatenate([[0.0], np.cumsum(passes)])

    def _go(self, low: np.ndarray, high: np.ndarray, least: float, full: float) -> None:
        """Set the keyframes: at even times of the viewer, the middle along and up in m, and the width in m."""
        decided = float(np.interp(self.decided, self.times, self.clock))
        back = decided + _HOLD
        self.lasts = max(float(self.clock[-1]), back + _BACK)
        self.keys = np.linspace(0.0, self.lasts, max(2, ceil(self.lasts * _KEYS)) + 1)
        lowest, highest = (each.accumulate(each.reduce(self._ways)[::-1])[::-1] for each in (np.fmin, np.fmax))
        boxes = self._framed(np.fmin(lowest, low), np.fmax(highest, high), least)
        seen = np.column_stack([np.interp(self.keys, self.clock, column) for column in boxes.T])
        seen[self.keys > decided - _EASE] = self.close  # so that it is there in time
        late, over = self.keys > decided, self.times >= self.decided
        if not self.story.balls and over.any():  # the ball stays in sight
            gone = [how.accumulate(self._played[over]) for how in (np.minimum, np.maximum)]
            ahead = self.keys[late] + np.minimum(self.keys[late] - decided, _EASE)
            reached = np.column_stack([np.interp(ahead, self.clock[over], axis) for ends in gone for axis in ends.T])
            seen[late] = self._framed(np.minimum(reached[:, :2], low), np.maximum(reached[:, 2:], high), least)
        begins = self._box_of(self.first)
        step = self.keys[1]
        bell = 1.0 - np.cos(np.linspace(0.0, 2.0 * np.pi, max(3, round(_EASE / step)) + 2)[1:-1])
        bell /= bell.sum()
        edges = np.concatenate([np.tile(begins, (len(bell) - 1, 1)), seen])
        eased = np.column_stack([np.convolve(column, bell, mode="valid") for column in edges.T])
        after = self.keys > back
        eased[after] = self._between(eased[np.argmax(after) - 1], self._end(), (self.keys[after] - back) / _BACK)
        self.boxes = eased

    def _end(self) -> np.ndarray:
        """The box that is seen in the end: by the last camera, or from farther away, if the ball has left that."""
        box, end = self._box_of(self.last), self._played[-1]
        middle, half = box[:2], np.array([box[2] / 2, box[2] / self._aspect / 2])
        if (np.abs(end - middle) <= half).all():
            return box
        return self._framed(np.minimum(middle - half, end), np.maximum(middle + half, end), box[2])

    def _box_of(self, camera: Camera) -> np.ndarray:
        """The middle and the width of what a camera shows in the area."""
        x, y = camera.world(*self.area.middle)
        return np.array([x, y * self._up[1], (self.area.right - self.area.left) / camera.scale])

    @staticmethod
    def _between(here: np.ndarray, there: np.ndarray, shares: np.ndarray) -> np.ndarray:
        """Boxes on an even way from one to another, about the point that stays in its place."""
        eased = np.clip(shares, 0.0, 1.0)
        eased = eased * eased * (3.0 - 2.0 * eased)
        wide = np.exp((1.0 - eased) * np.log(here[2]) + eased * np.log(there[2]))
        change = there[2] - here[2]
        gone = (wide - here[2]) / change if abs(change) > 1e-6 * here[2] else eased
        return np.column_stack([here[:2] + gone[:, None] * (there[:2] - here[:2]), wide])

    # Queries

    def camera(self, t: float) -> Camera:
        """The camera at a time of the run, in s; for times after its end the viewer's clock goes on."""
        over = max(0.0, t - self.times[-1])
        at = float(np.interp(t, self.times, self.clock)) + over
        x, y, wide = (float(np.interp(at, self.keys, column)) for column in self.boxes.T)
        if self.story.share == 0.0:
            return self.first
        for camera in (self.first, self.last):
            box = self._box_of(camera)
            if np.allclose((x, y, wide), box, rtol=0.0, atol=1e-4 * box[2]):
                return camera
        scale = (self.area.right - self.area.left) / wide
        (across, down), (_, level) = self.area.middle, self.first.at
        return Camera((x, level), (across, round(down + (y - level * self._up[1]) * scale)), scale, self.first.stretch)

    @property
    def goes_on(self) -> float:
        """For how long in s the camera moves after the end of the run."""
        return self.lasts - float(self.clock[-1])

    def slower(self, t: float) -> float:
        """The factor by which time is slower, at a time of the run in s."""
        return float(np.interp(t, self.times, self.pace))

    def keyframes(self, fps: float) -> list[tuple[float, float, float, float, float]]:
        """Return for so many moments in each s of the viewer the time in s of the run, the middle of what is seen along
        and up in m, how many times larger it is than at first, and the factor by which time is slower."""
        full, found = self._box_of(self.first)[2], []
        for t, at in zip(self.film(fps), np.arange(0.0, self.lasts, 1.0 / fps), strict=True):
            x, y, wide = (float(np.interp(at, self.keys, column)) for column in self.boxes.T)
            found.append((t, x, y / self._up[1], full / wide, self.slower(t)))
        return found

    def film(self, fps: float) -> list[float]:
        """The times of a film's frames, so many for each s of the viewer, whose clock goes on after the end."""
        seen = np.arange(0.0, self.lasts, 1.0 / fps)
        over = np.maximum(seen - self.clock[-1], 0.0)
        return (np.interp(seen, self.clock, self.times) + over).tolist()
