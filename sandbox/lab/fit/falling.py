"""The gravity that a track itself shows, by the parabolas between its bounces: a check of its scale and clock."""

from __future__ import annotations

from collections.abc import Sequence
from math import sqrt

import numpy as np

from sandbox.lab.fit.measured import Measured
from sandbox.lab.statistics import student
from sandbox.physics.forces import Gravity
from sandbox.scene import Scene

#: Points of an arc, at least; points next to a bounce that belong to none; and the share of the greatest vertical speed
#: with which a ball comes to a bounce and leaves it.
_FEWEST, _BESIDE, _SHARP = 5, 1, 0.2

#: A point that is off the middle of its neighbours by this share of most heights is a gross error, and in no arc.
_GROSS = 0.3

#: A gravity that differs by less than this share, or by fewer of its intervals, is no other one: drag and lift change
#: that of most balls by less.
_OFF, _SURELY = 0.1, 1.5


def gravity_hint(scene: Scene, measured: Measured, free: Sequence[float]) -> str:
    """Say that a track falls with another gravity than the scene's, so that scale or clock are wrong; "" otherwise."""
    found = other_gravity(scene, measured, free)
    if found is None:
        return ""
    g, half, own = found
    scale, clock = 100.0 * abs(g / own - 1.0), 100.0 * abs(sqrt(own / g) - 1.0)
    return (
        f"each of its arcs fits with g = {g:.3g} +- {half:.1g} m/s^2, not {own:.3g}: your scale is {scale:.0f} % off, "
        f"or your clock {clock:.0f} %"
    )


def other_gravity(scene: Scene, measured: Measured, free: Sequence[float]) -> tuple[float, float, float] | None:
    """The gravity in m/s^2 with which a track falls, half of its 95 % interval, and the scene's; None if they agree."""
    points, setup = measured.points(scene, free), scene.build()
    own = next((float(force.gravity) for force in setup.balls[0].forces if isinstance(force, Gravity)), 0.0)
    if points is None or setup.plane is not None or own <= 0.0 or np.isnan(points.t).any():
        return None
    found = fall(points.t, points.positions[:, 1], np.array(points.balls))
    if found is None:
        return None
    g, half = found
    alike = abs(g / own - 1.0) < _OFF or abs(g - own) < _SURELY * half or g <= 0.0
    return None if alike else (g, half, own)


def fall(t: np.ndarray, y: np.ndarray, balls: np.ndarray) -> tuple[float, float] | None:
    """The gravity in m/s^2 that all arcs of a track have in common, y = a + b t - g t^2 / 2, and half of its 95 %
    interval; None without an arc."""
    columns: list[np.ndarray] = []
    rows: list[np.ndarray] = []
    for ball in np.unique(balls):
        own = np.flatnonzero(balls == ball)
        for arc in arcs_of(t[own], y[own]):
            rows.append(own[arc])
            columns.append(t[own[arc]] - t[own[arc]].mean())
    if not rows:
        return None
    count = sum(map(len, rows))
    design = np.zeros((count, 2 * len(rows) + 1))
    at = 0
    for place, since in enumerate(columns):
        some = slice(at, at + len(since))
        design[some, 2 * place], design[some, 2 * place + 1], design[some, -1] = 1.0, since, -0.5 * since**2
        at += len(since)
    freedom = count - design.shape[1]
    if freedom < 1:
        return None
    heights = y[np.concatenate(rows)]
    values = np.linalg.lstsq(design, heights, rcond=None)[0]
    variance = float(((heights - design @ values) ** 2).sum()) / freedom
    error = sqrt(variance * float(np.linalg.pinv(design.T @ design)[-1, -1]))
    return float(values[-1]), student(freedom) * error


def arcs_of(t: np.ndarray, y: np.ndarray) -> list[np.ndarray]:
    """The places of the points between bounces, in each arc that has enough."""
    if len(t) < _FEWEST or (np.diff(t) <= 0.0).any():
        return []
    jumps = np.abs(y[1:-1] - 0.5 * (y[:-2] + y[2:])) > _GROSS * np.ptp(np.sort(y)[[len(y) // 10, -1 - len(y) // 10]])
    good = np.flatnonzero(np.concatenate(([True], ~jumps, [True])))
    if len(good) < len(t):
        return [good[arc] for arc in arcs_of(t[good], y[good])]
    speed = np.diff(y) / np.diff(t)
    sharp = _SHARP * float(np.abs(speed).max())
    ends = [0]
    for place in range(1, len(speed)):
        before = speed[max(place - 2, ends[-1]) : place].min()
        if before < -sharp and speed[place] > 0.0 and speed[place : place + 2].max() > sharp:
            ends.append(place)
    parts = np.split(np.arange(len(t)), ends[1:])
    inner = [part[_BESIDE if number else 0 : len(part) - _BESIDE if number < len(parts) - 1 else None]
             for number, part in enumerate(parts)]  # fmt: skip
    return [part for part in inner if len(part) >= _FEWEST]
