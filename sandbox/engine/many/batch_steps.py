"""Step size control of many shots: the same as in ``kernel/step_control.py``, with arrays of shape (n,) in place of
floats."""

from __future__ import annotations

from typing import Any

import numpy as np

from sandbox.engine.kernel.step_control import (
    AFTER_NONFINITE,
    AT_BORDER,
    FAR,
    JUMP,
    LONGER,
    LONGER_SHARE,
    LONGEST,
    NEARBY,
    SAFETY,
    SHORTER,
    STIFFEST,
    THINNEST,
    StepControl,
    StepLimits,
    size,
)
from sandbox.engine.model.setup import ForceRegion
from sandbox.engine.model.tolerances import AT_DISCONTINUITY, ROUNDING, SHORTEST_STEP, TINY
from sandbox.physics.integrators import Method


def attempt(
    control: StepControl, step: Method, t: Any, state: Any, acceleration: Any, h: Any, wanted: Any, radius: Any
) -> tuple[Any, Any, Any, Any]:
    """As ``StepControl.attempt``."""
    end, last, error = step(t, state, acceleration, h)
    if error is None:
        too_long = _stiff(state, end, acceleration, last, h)
        longer = np.where(h >= wanted, np.minimum(2.0 * h, control.step), wanted)
        return ~too_long, np.where(too_long, 0.5 * h, longer), end, last
    off = size(error, radius)
    fits = off <= control.local_error
    change = np.minimum(np.maximum(SAFETY * (control.local_error / (off + TINY)) ** control.exponent, SHORTER), LONGER)
    following = h * np.where(off < np.inf, change, AFTER_NONFINITE)
    was_cut = fits & (h < (1.0 - ROUNDING) * wanted) & (following < wanted)
    return fits, np.where(was_cut, wanted, following), end, last


def shortest(t: Any) -> Any:
    """The shortest step in s from t."""
    return SHORTEST_STEP * np.maximum(t, 1.0)


def allowed(limits: StepLimits, t: Any, h: Any, state: Any, acceleration: Any) -> Any:
    """As for one ball; the limits have arrays where the shots differ in them."""
    if np.count_nonzero(h > LONGEST):  # in a third of the time of any()
        calm = np.minimum(_time_nearby(state, acceleration), LONGER_SHARE * t)
        h = np.minimum(h, np.maximum(calm, LONGEST))
    h = np.minimum(h, limits.scale)
    for at in limits.jumps:
        room = at - t
        h = np.where((room > AT_DISCONTINUITY) & (room < h), room, h)
    for region in limits.regions:
        h = _allowed_near(region, h, state, acceleration)
    return h


def _allowed_near(region: ForceRegion, h: Any, state: Any, acceleration: Any) -> Any:
    (x, y, vx, vy), (ax, ay) = state[:4], acceleration[:2]
    whole, half = h, 0.5 * h
    end_x, end_y = x + h * (vx + half * ax), y + h * (vy + half * ay)
    near = _may_cross(region, (x, x + half * vx, end_x), (y, y + half * vy, end_y))
    if not np.count_nonzero(near):
        return h
    for place, end, speed, change, lines in (
        (x, end_x, vx, ax, np.stack(np.broadcast_arrays(region.left, region.right, whole)[:2])),
        (y, end_y, vy, ay, np.stack(np.broadcast_arrays(region.bottom, region.top, whole)[:2])),
    ):
        turns = speed * (speed + whole * change) < 0.0
        passes = near & (turns | ((place < lines) ^ (end < lines)))
        if np.count_nonzero(passes):
            across = (lines[1] - lines[0]) / (abs(speed) + TINY)
            soonest = AT_BORDER * np.minimum(np.maximum(across, THINNEST * region.step), region.step)
            reached = np.where(passes, _time_to_travel(lines - place, speed, change, soonest), np.inf)
            h = np.minimum(h, reached.min(axis=0))
    half = 0.5 * h
    x, y = x + half * (vx + 0.5 * half * ax), y + half * (vy + 0.5 * half * ay)
    inside = (region.left < x) & (x < region.right) & (region.bottom < y) & (y < region.top)
    return np.where(near & inside & (h > region.step), region.step, h)


def _may_cross(region: ForceRegion, xs: tuple[Any, Any, Any], ys: tuple[Any, Any, Any]) -> Any:
    """A mask of the paths in the hull of three points, in m, that could cross a region."""
    x, between_x, end_x = xs
    y, between_y, end_y = ys
    beside = np.minimum(np.minimum(x, between_x), end_x) > region.right
    beside |= np.maximum(np.maximum(x, between_x), end_x) < region.left
    beside |= np.minimum(np.minimum(y, between_y), end_y) > region.top
    return ~(beside | (np.maximum(np.maximum(y, between_y), end_y) < region.bottom))


def _time_nearby(state: Any, acceleration: Any) -> Any:
    speed, change = abs(state[2]) + abs(state[3]), abs(acceleration[0]) + abs(acceleration[1])
    reach = np.where(change == 0.0, FAR, NEARBY)
    return np.minimum(0.5 * reach / (speed + TINY), (reach / (change + TINY)) ** 0.5)


def _time_to_travel(distance: Any, speed: Any, change: Any, soonest: Any) -> Any:
    square = speed * speed + 2.0 * distance * change
    both = speed + np.where(speed < 0.0, -1.0, 1.0) * np.maximum(square, 0.0) ** 0.5
    first, second = 2.0 * distance / (both + TINY), -both / (change + TINY)
    first, second = (np.where(t > soonest, t, np.inf) for t in (first, second))
    return np.where(square < 0.0, np.inf, np.minimum(first, second))


def _stiff(before: Any, after: Any, acceleration: Any, following: Any, h: Any) -> Any:
    pulled, follows = (abs(each[0]) + abs(each[1]) for each in (acceleration, following))
    starts = (abs(before[2]) + abs(before[3]) == 0.0) & (pulled <= JUMP * follows)
    change = h * (abs(following[0] - acceleration[0]) + abs(following[1] - acceleration[1]))
    gain = abs(after[2] - before[2]) + abs(after[3] - before[3])
    speed = np.maximum(abs(before[2]) + abs(before[3]), abs(after[2]) + abs(after[3]))
    return ~((change <= STIFFEST * gain) | (change <= JUMP * speed) | starts)
