"""Rest under forces that depend on time: until when it lasts.

It is asked again at each of the forces' times: at their discontinuities, and in between as often as their time scale
says. Where it does not stay, the time at which it begins to move is found to rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from itertools import pairwise
from math import ceil
from typing import Protocol

from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.tolerances import AT_DISCONTINUITY, ROUNDING, SHORTEST_STEP
from sandbox.physics.integrators import Acceleration, State
from sandbox.physics.timing import Timing

#: How far ahead in s it is asked at once: more makes single frames of a world take longer.
AHEAD = 1.0


class _Forced(Protocol):
    """A ball or body on which forces act."""

    ball: Ball

    def applied(self, t: float, state: State) -> Acceleration:
        """The acceleration by forces at t, in m/s^2 and rad/s^2."""


def rest_end(
    timing: Timing,
    applied: Callable[[float], Acceleration],
    rests: Callable[[float, Acceleration], bool],
    t: float,
    until: float,
) -> tuple[float, bool]:
    """Return the time in s up to which a ball at rest at t is known to stay so, and True if it begins to move then.

    ``applied(t)`` is the acceleration that it would have without contact, ``rests(t, applied)`` True if that leaves it
    at rest. What depends on time is asked ``AHEAD`` at most.
    """
    if not timing.depends:
        return until, False
    known: Acceleration | None = None

    def holds(at: float) -> bool:
        nonlocal known
        here = applied(at)
        if here != known and not rests(at, here):
            return False
        known = here
        return True

    until = min(until, t + AHEAD)
    wakes = first_change(holds, t, until, timing.scale, timing.jumps)
    return (until, False) if wakes is None else (wakes, True)


def steady_end(movers: Sequence[_Forced], states: Mapping[int, State], since: float, t: float, until: float) -> float:
    """Return the time in s up to which the forces on balls that rest in these states are known to stay as they were at
    ``since``; t if they do not now."""
    for index, state in states.items():
        timing = movers[index].ball.timing
        if not timing.depends:
            continue
        applied = partial(movers[index].applied, state=state)
        rests = partial(_unchanged, applied(since))
        if not rests(t, applied(t)):
            return t
        until, _ = rest_end(timing, applied, rests, t, until)
    return until


def _unchanged(before: Acceleration, t: float, applied: Acceleration) -> bool:
    """Return True if an acceleration is that of before, but for rounding."""
    most = ROUNDING * max(map(abs, before))
    return all(abs(now - then) <= most for now, then in zip(applied, before, strict=True))


def next_jump(setup: Setup, balls: Iterable[Ball], t: float, until: float) -> float:
    """Return the next time in s at which a force on one of these balls may jump; ``until`` at most."""
    jumps = (*setup.discontinuities, *(jump for ball in balls for jump in ball.timing.jumps))
    return min((jump for jump in jumps if t + AT_DISCONTINUITY < jump < until), default=until)


def first_change(
    holds: Callable[[float], bool], t: float, until: float, scale: float, jumps: Iterable[float] = ()
) -> float | None:
    """Return the first time in s from t up to ``until`` at which ``holds`` is not true, None if there is none.

    It is asked at least every ``scale`` s, at each of the ``jumps``, and between two of these.
    """
    low = t
    for start, end in pairwise(sorted({t, until, *(jump for jump in jumps if t < jump < until)})):
        parts = max(2, ceil((end - start) / scale))
        for part in range(1, parts + 1):
            high = start + part * (end - start) / parts if part < parts else end
            if not holds(high):
                return _root(holds, low, high)
            low = high
    return None


def _root(holds: Callable[[float], bool], low: float, high: float) -> float:
    """Return the time in s at which it ends to hold, after ``low`` and up to ``high``."""
    while low < (middle := low + 0.5 * (high - low)) < high and high - low > SHORTEST_STEP * max(1.0, high):
        low, high = (middle, high) if holds(middle) else (low, middle)
    return high
