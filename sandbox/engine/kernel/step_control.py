"""Step size control: how long a step of one ball may be, and whether it is accepted."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf, sqrt
from typing import NamedTuple

from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import ForceRegion, Setup
from sandbox.engine.model.tolerances import AT_DISCONTINUITY, ROUNDING, SHORTEST_STEP, TINY
from sandbox.physics.integrators import INTEGRATORS, Acceleration, Method, State

#: Local error of a step relative to the tolerance at the end. Each impact on a round shape multiplies an error by ten
#: or more, so the flight must be much more accurate; this value is enough for shots with several rim contacts.
_LOCAL_SHARE = 3e-4

#: Weight of an error in spin as an error in m: it moves the ball only through lift and the next bounce.
_SPIN_WEIGHT = 0.1  # s

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
AT_BORDER, THINNEST = 0.02, 1e-3


class StepControl:
    """The steps of one method at one accuracy, controlled by its order and its error estimate, if any."""

    def __init__(self, accuracy: Accuracy) -> None:
        method = self.integrator = INTEGRATORS[accuracy.integrator]
        self.exponent = 1.0 / method.order
        self.local_error = accuracy.tolerance * _LOCAL_SHARE  # m
        self.step = accuracy.step  # s
        self.evaluations = method.evaluations  # of the forces in each step
        self.first = FIRST_STEP if method.controls_error else accuracy.step  # s

    def advance(
        self, step: Method, t: float, state: State, acceleration: Acceleration, h: float, wanted: float, radius: float
    ) -> tuple[bool, int, float, float, State, Acceleration]:
        """Shorten a step of ``h`` s, which may be a part of the ``wanted`` step, until it is accepted; or until no step
        from t can be shorter. Returns True if it is accepted, how many were tried, the last one in s and the next to
        try, and the state and the acceleration at its end."""
        tries = 1
        while True:
            fits, following, end, last = self.attempt(step, t, state, acceleration, h, wanted, radius)
            if fits or following < shortest(t):
                return fits, tries, h, following, end, last
            h = wanted = following
            tries += 1

    def attempt(
        self, step: Method, t: float, state: State, acceleration: Acceleration, h: float, wanted: float, radius: float
    ) -> tuple[bool, float, State, Acceleration]:
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
            if _stiff(state, end, acceleration, last, h):
                return False, 0.5 * h, end, last
            return True, min(2.0 * h, self.step) if h >= wanted else wanted, end, last
        off = size_of_ball(error, radius) if len(error) == 5 else size(error, radius)
        fits, following = judged(off, self.local_error, self.exponent, h, wanted)
        return fits, following, end, last


def judged(off: float, most: float, exponent: float, h: float, wanted: float) -> tuple[bool, float]:
    """True if a step of ``h`` s, a part of the ``wanted`` one, with an error of ``off`` is accepted, where ``most`` is,
    both in m; and the step in s to try next, after it or in its place. ``exponent`` is 1 over the order."""
    if off < inf:
        change = SAFETY * (most / (off + TINY)) ** exponent
        following = h * (SHORTER if change < SHORTER else LONGER if change > LONGER else change)
    else:
        following = h * AFTER_NONFINITE
    if not off <= most:
        return False, following
    # a step that was cut, as by a border of a region, says nothing against a longer one after it
    was_cut = h < (1.0 - ROUNDING) * wanted and following < wanted
    return True, wanted if was_cut else following


def size(error: State, radius: float) -> float:
    """Local error in m: that of the position, plus that of the velocity over a second; of a body's turning and a ball's
    rolling, too."""
    off = size_of_ball(error[:5], radius)
    if len(error) == 5:
        return off
    return off + radius * sum(map(abs, error[4:6] if len(error) == 6 else error[5:]))


def size_of_ball(error: State, radius: float) -> float:
    """The same of a ball that flies."""
    ex, ey, evx, evy, spin = error
    return abs(ex) + abs(ey) + abs(evx) + abs(evy) + _SPIN_WEIGHT * radius * abs(spin)


def shortest(t: float) -> float:
    """The shortest step in s from t."""
    return SHORTEST_STEP * max(t, 1.0)


class StepLimits(NamedTuple):
    """Times and places that steps of a ball must not skip."""

    depends: bool  # its forces do, on time
    scale: float  # s, in which they change
    jumps: Sequence[float]  # s, times at which they do so at once
    regions: Sequence[ForceRegion]

    @classmethod
    def of(cls, setup: Setup, ball: Ball) -> StepLimits:
        """The limits for a ball of a setup."""
        depends, scale, jumps = ball.timing
        return cls(depends, scale, (*setup.discontinuities, *jumps), setup.force_regions)


def allowed(limits: StepLimits, t: float, h: float, state: State, acceleration: Acceleration) -> float:
    """Return a step from t of h s or less: not across a discontinuity or a region's border, where it would be rejected,
    or lose its order; and no longer than forces that depend on time, or a region, allow."""
    _, scale, jumps, regions = limits
    h = not_too_long(t, h, state, acceleration)
    if h > scale:
        h = scale
    for at in jumps:
        if AT_DISCONTINUITY < at - t < h:
            h = at - t
    return allowed_near(regions, h, state, acceleration) if regions else h


def not_too_long(t: float, h: float, state: State, acceleration: Acceleration) -> float:
    """Return a step from t of h s or less, which is longer than LONGEST only where nothing moves far."""
    if h > LONGEST:
        return min(h, max(min(_time_nearby(state, acceleration), LONGER_SHARE * t), LONGEST))
    return h


def allowed_near(regions: Sequence[ForceRegion], h: float, state: State, acceleration: Acceleration) -> float:
    """Return a step of h s or less that ends where a ball comes to the border of a region, and is no longer than its
    step inside."""
    x, y, vx, vy = state[:4]
    ax, ay = acceleration[:2]
    for i in range(len(regions)):  # a row of numbers where it is compiled
        region = regions[i]
        left, bottom, right, top, longest = region[0], region[1], region[2], region[3], region[4]
        whole, half = h, 0.5 * h  # the parabola that is predicted lies among its ends and a point between them
        end_x, between_x = x + h * (vx + half * ax), x + half * vx
        if (x > right and between_x > right and end_x > right) or (x < left and between_x < left and end_x < left):
            continue
        end_y, between_y = y + h * (vy + half * ay), y + half * vy
        if (y > top and between_y > top and end_y > top) or (y < bottom and between_y < bottom and end_y < bottom):
            continue
        for place, end, speed, change, low, high in ((x, end_x, vx, ax, left, right), (y, end_y, vy, ay, bottom, top)):
            turns = speed * (speed + whole * change) < 0.0
            for line in (low, high):
                if turns or (place < line) != (end < line):
                    across = (high - low) / (abs(speed) + TINY)
                    soonest = AT_BORDER * min(max(across, THINNEST * longest), longest)
                    h = min(h, _time_to_travel(line - place, speed, change, soonest))
        half = 0.5 * h
        middle_x, middle_y = x + half * (vx + 0.5 * half * ax), y + half * (vy + 0.5 * half * ay)
        if h > longest and left < middle_x < right and bottom < middle_y < top:
            h = longest
    return h


def _time_nearby(state: State, acceleration: Acceleration) -> float:
    """Return a time in s in which it moves no farther than NEARBY at a constant acceleration; FAR without any."""
    speed, change = abs(state[2]) + abs(state[3]), abs(acceleration[0]) + abs(acceleration[1])
    reach = FAR if change == 0.0 else NEARBY
    return min(0.5 * reach / (speed + TINY), sqrt(reach / (change + TINY)))


def _time_to_travel(distance: float, speed: float, change: float, soonest: float) -> float:
    """Return the first time in s after the ``soonest`` at which it has travelled this ``distance`` (m) at a constant
    acceleration; inf if it never has."""
    square = speed * speed + 2.0 * distance * change
    if square < 0.0:
        return inf
    both = speed + (-sqrt(square) if speed < 0.0 else sqrt(square))
    first, second = 2.0 * distance / (both + TINY), -both / (change + TINY)
    return min(first if first > soonest else inf, second if second > soonest else inf)


def _stiff(before: State, after: State, acceleration: Acceleration, following: Acceleration, h: float) -> bool:
    """Return True if a fixed step is too long for forces that depend on velocity: in it they change by more than
    STIFFEST times the change of velocity, over h. A force that starts on a ball at rest, as a thrust, is not."""
    pulled, follows = (abs(each[0]) + abs(each[1]) for each in (acceleration, following))
    starts = abs(before[2]) + abs(before[3]) == 0.0 and pulled <= JUMP * follows
    change = h * (abs(following[0] - acceleration[0]) + abs(following[1] - acceleration[1]))
    gain = abs(after[2] - before[2]) + abs(after[3] - before[3])
    speed = max(abs(before[2]) + abs(before[3]), abs(after[2]) + abs(after[3]))
    return not (change <= STIFFEST * gain or change <= JUMP * speed or starts)
