"""Step size control: how long a step may be and whether it is accepted, for one ball (floats) or many shots
(arrays)."""

from __future__ import annotations

from math import inf
from typing import Any

from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.tolerances import AT_DISCONTINUITY, ROUNDING, SHORTEST_STEP, TINY
from sandbox.physics.elementwise import anywhere, clip, maximum, minimum, smallest, stacked, where
from sandbox.physics.integrators import INTEGRATORS, Acceleration, Method, State

#: Local error of a step relative to the tolerance at the end. Each impact on a round shape multiplies an error by ten
#: or more, so the flight must be much more accurate; this value is enough for shots with several rim contacts.
LOCAL_SHARE = 3e-4

#: Weight of an error in spin as an error in m: it moves the ball only through lift and the next bounce.
SPIN_WEIGHT = 0.1  # s

#: First step tried under error control; it shrinks by 5 until the error fits.
FIRST_STEP = 0.05  # s

#: Longest step, so that forces that vary along the path are evaluated several times a second. It may be longer, up to a
#: share of the time so far, while a ball moves by no more than NEARBY; and FAR where nothing acts, for rounding's sake.
LONGEST, LONGER_SHARE = 0.5, 0.1  # s, 1
NEARBY, FAR = 0.01, 100.0  # m

#: Ratio of the next step to the last: a safety factor, the bounds, and the ratio after an error that is not finite.
SAFETY, SHORTER, LONGER, AFTER_NONFINITE = 0.9, 0.2, 5.0, 0.1

#: Largest product of a fixed step and the forces' rate of change with velocity (1/s). Explicit steps are smooth below
#: 1 and unstable above 2, where drag reverses the motion; the drag of water on a bullet is the case that needs the
#: limit.
STIFFEST = 0.5

#: Changes of velocity below this fraction of the speed do not show stiffness: a force may jump.
JUMP = 0.01

#: A border of a region has been reached if it is nearer than this share of the region's longest step, or of the time to
#: fly across, which is taken for no less than a share of that step: that much the predicted time may be wrong.
_AT_BORDER, _THINNEST = 0.02, 1e-3


class StepControl:
    """The steps of one method at one accuracy, controlled by its order and its error estimate, if any."""

    def __init__(self, accuracy: Accuracy) -> None:
        method = self.integrator = INTEGRATORS[accuracy.integrator]
        self._exponent = 1.0 / method.order
        self._local_error = accuracy.tolerance * LOCAL_SHARE  # m
        self._step = accuracy.step  # s
        self.evaluations = method.evaluations  # of the forces in each step
        self.first = FIRST_STEP if method.controls_error else accuracy.step  # s

    def attempt(
        self, step: Method, t: Any, state: State, acceleration: Acceleration, h: Any, wanted: Any, radius: Any
    ) -> tuple[Any, Any, State, Acceleration]:
        """One ``step`` of ``h`` s, which may be a part of the ``wanted`` step, from a state with this acceleration.

        Returns whether it is accepted, the step in s to try next, after it or in its place, and the state and the
        acceleration at its end.
        """
        try:
            end, last, error = step(t, state, acceleration, h)
        except OverflowError:  # of ``x ** 2`` in a scene's force, where a step that is too long leads; x * x is inf
            shorter = AFTER_NONFINITE * h
            if shorter < shortest(t):
                raise
            return False, shorter, state, acceleration
        if error is None:
            too_long = stiff(state, end, acceleration, last, h)
            longer = where(h >= wanted, clip(2.0 * h, 0.0, self._step), wanted)
            return too_long ^ True, where(too_long, 0.5 * h, longer), end, last
        off = size(error, radius)
        fits = off <= self._local_error
        change = clip(SAFETY * (self._local_error / (off + TINY)) ** self._exponent, SHORTER, LONGER)
        following = h * where(off < inf, change, AFTER_NONFINITE)
        # a step that was cut, as by a border of a region, says nothing against a longer one after it
        was_cut = fits & (h < (1.0 - ROUNDING) * wanted) & (following < wanted)
        return fits, where(was_cut, wanted, following), end, last


def size(error: State, radius: Any) -> Any:
    """Local error in m: that of the position, plus that of the velocity over a second; of a body's turning and a ball's
    rolling, too."""
    ex, ey, evx, evy, spin = error[:5]
    off = abs(ex) + abs(ey) + abs(evx) + abs(evy) + SPIN_WEIGHT * radius * abs(spin)
    if len(error) == 5:
        return off
    return off + radius * sum(map(abs, error[4:6] if len(error) == 6 else error[5:]))


def shortest(t: Any) -> Any:
    """The shortest step in s from t."""
    return SHORTEST_STEP * maximum(t, 1.0)


def allowed(setup: Setup, ball: Ball, t: Any, h: Any, state: State, acceleration: Acceleration) -> Any:
    """Return a step from t of h s or less: not across a discontinuity or a region's border, where it would be rejected,
    or lose its order; and no longer than forces that depend on time, or a region, allow."""
    if anywhere(h > LONGEST):
        calm = minimum(_time_nearby(state, acceleration), LONGER_SHARE * t)
        h = minimum(h, maximum(calm, LONGEST))
    timing = ball.timing
    if timing.depends:
        h = minimum(h, timing.scale)
    for at in (*setup.discontinuities, *timing.jumps):
        room = at - t
        h = where((room > AT_DISCONTINUITY) & (room < h), room, h)
    for region in setup.force_regions:
        (x, y, vx, vy), (ax, ay) = state[:4], acceleration[:2]
        whole, half = h, 0.5 * h
        end_x, end_y = x + h * (vx + half * ax), y + h * (vy + half * ay)
        near = region.crossed((x, x + half * vx, end_x), (y, y + half * vy, end_y))  # points of the predicted parabola
        if not anywhere(near):
            continue
        for place, end, speed, change, *lines in (
            (x, end_x, vx, ax, region.left, region.right),
            (y, end_y, vy, ay, region.bottom, region.top),
        ):
            turns = speed * (speed + whole * change) < 0.0
            for line in stacked(lines, whole):
                passes = near & (turns | ((place < line) ^ (end < line)))
                if anywhere(passes):
                    across = (lines[1] - lines[0]) / (abs(speed) + TINY)
                    soonest = _AT_BORDER * clip(across, _THINNEST * region.step, region.step)
                    reached = where(passes, _time_to_travel(line - place, speed, change, soonest), inf)
                    h = minimum(h, smallest(reached))
        half = 0.5 * h
        inside = region.holds(x + half * (vx + 0.5 * half * ax), y + half * (vy + 0.5 * half * ay))
        h = where(near & inside & (h > region.step), region.step, h)
    return h


def _time_nearby(state: State, acceleration: Acceleration) -> Any:
    """Return a time in s in which it moves no farther than NEARBY at a constant acceleration; FAR without any."""
    speed, change = abs(state[2]) + abs(state[3]), abs(acceleration[0]) + abs(acceleration[1])
    reach = where(change == 0.0, FAR, NEARBY)
    return minimum(0.5 * reach / (speed + TINY), (reach / (change + TINY)) ** 0.5)


def _time_to_travel(distance: Any, speed: Any, change: Any, soonest: Any) -> Any:
    """Return the first time in s after the ``soonest`` at which it has travelled this ``distance`` (m) at a constant
    acceleration; inf if it never has."""
    square = speed * speed + 2.0 * distance * change
    both = speed + where(speed < 0.0, -1.0, 1.0) * maximum(square, 0.0) ** 0.5
    first, second = 2.0 * distance / (both + TINY), -both / (change + TINY)
    first, second = (where(t > soonest, t, inf) for t in (first, second))
    return where(square < 0.0, inf, minimum(first, second))


def stiff(
    before: State, after: State, acceleration: Acceleration, following: Acceleration, h: Any, limit: float = STIFFEST
) -> Any:
    """Return True if a fixed step is too long for forces that depend on velocity: in it they change by more than
    ``limit`` times the change of velocity, over h. A force that starts on a ball at rest, as a thrust, is not."""
    pulled, follows = (abs(each[0]) + abs(each[1]) for each in (acceleration, following))
    starts = (abs(before[2]) + abs(before[3]) == 0.0) & (pulled <= JUMP * follows)
    change = h * (abs(following[0] - acceleration[0]) + abs(following[1] - acceleration[1]))
    gain = abs(after[2] - before[2]) + abs(after[3] - before[3])
    speed = maximum(abs(before[2]) + abs(before[3]), abs(after[2]) + abs(after[3]))
    return ((change <= limit * gain) | (change <= JUMP * speed) | starts) ^ True
