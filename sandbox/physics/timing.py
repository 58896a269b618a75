"""Which forces depend on time, how finely, and when they jump.

Steps look at a force at a few times, and what lies still is not looked at again: so a force says that it does not
depend on time, or is asked often enough. A force, a torque, a wind or a loss of mass may have

- ``depends_on_time``: False or True;
- ``time_scale``: the shortest time in s in which it changes: no step is longer;
- ``discontinuities``: the times in s at which it jumps or bends: no step goes across;
- ``timed``: the names of those of its attributes through which alone it depends on time, such as ``("wind",)``.

One that says nothing depends on time if its code uses its first argument.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dis import get_instructions
from functools import cache, partial, reduce
from types import CodeType, FunctionType, MethodType
from typing import Any, NamedTuple

from sandbox.physics.checks import short
from sandbox.physics.elementwise import everywhere, finite, minimum

#: Longest step in s of what depends on time and names no ``time_scale``: gusts of a few hundredths of a second count,
#: and a flight of seconds takes some hundred steps; assumed.
TIME_SCALE = 0.01


class Timing(NamedTuple):
    """The dependence of some forces on time; the numbers are floats, or arrays for many shots."""

    depends: bool  # on time
    scale: Any  # s, longest step
    jumps: tuple[Any, ...]  # s


#: That of forces that do not depend on time.
STEADY = Timing(False, float("inf"), ())


def timing_of(terms: Iterable[Any]) -> Timing:
    """Return how these forces and torques together depend on time. Raises ValueError for a time that is none."""
    timings = [timing for timing in map(_timing, terms) if timing is not STEADY]
    if not timings:
        return STEADY
    scale = reduce(minimum, (timing.scale for timing in timings))
    return Timing(True, scale, tuple(jump for timing in timings for jump in timing.jumps))


def _timing(term: Any) -> Timing:
    """Return how one force, torque, wind or loss of mass depends on time."""
    if term is None:
        return STEADY
    kind: Any = type(term)
    parts = _timed(kind)
    if parts is not None:
        return timing_of([getattr(term, name) for name in parts])
    scale, jumps = getattr(term, "time_scale", None), getattr(term, "discontinuities", ())
    depends = getattr(term, "depends_on_time", None)
    if depends is None:
        depends = scale is not None or len(jumps) > 0 or _uses_time(term)
    if not depends:
        return STEADY
    scale, jumps = TIME_SCALE if scale is None else scale, tuple(jumps)
    if not _holds(lambda: everywhere(scale > 0.0)):
        raise ValueError(f"{short(term)}: time_scale = {short(scale)} must be positive, in s")
    if not _holds(lambda: all(map(finite, jumps))):
        raise ValueError(f"{short(term)}: discontinuities = {short(jumps)} must be finite numbers, in s")
    return Timing(True, scale, jumps)


def _holds(condition: Callable[[], bool]) -> bool:
    """Return the condition; False where it cannot be computed, as of text in place of a number."""
    try:
        return condition()
    except TypeError:
        return False


@cache
def _timed(kind: Any) -> tuple[str, ...] | None:
    """Return the ``timed`` of a class; None where it has none, or was written for another ``__call__``."""
    classes = kind.__mro__
    at = next((place for place, each in enumerate(classes) if "timed" in vars(each)), None)
    if at is None or any("__call__" in vars(each) for each in classes[:at]):
        return None
    if isinstance(kind.timed, str):
        raise ValueError(f"{kind.__name__}: timed = {kind.timed!r} must be a tuple: ({kind.timed!r},)")
    return tuple(kind.timed)


def _uses_time(term: Any) -> bool:
    """Return True if the code of a function or of an object's ``__call__`` uses its first argument, or cannot be
    read."""
    place = 0
    while isinstance(term, partial):
        place += len(term.args)
        term = term.func
    if not isinstance(term, FunctionType | MethodType):
        term = getattr(type(term), "__call__", None)  # noqa: B004, a loss of mass has none
        place += 1
    if isinstance(term, MethodType):
        term = term.__func__
        place += 1
    return not isinstance(term, FunctionType) or _uses(term.__code__, place)


@cache
def _uses(code: CodeType, place: int) -> bool:
    """Return True if a function's code reads the argument in this place."""
    if place >= code.co_argcount:
        return True  # one of *arguments
    name = code.co_varnames[place]
    read = (each.argval for each in get_instructions(code) if "LOAD_FAST" in each.opname)
    return name in code.co_cellvars or any(name in (names if type(names) is tuple else (names,)) for names in read)
