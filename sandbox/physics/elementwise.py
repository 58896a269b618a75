"""Functions of floats or arrays: one ball uses fast Python floats, many shots use numpy."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import cache, reduce
from types import FunctionType
from typing import Any


def _either(name: str) -> Callable[[Any], Any]:
    """Return the function of this name: that in math for a float, in numpy for an array."""
    of_float = getattr(math, name)

    def function(x: Any) -> Any:
        if isinstance(x, float):
            return of_float(x)
        import numpy as np

        return getattr(np, name)(x)

    return function


def _of_several(of_float: Callable[..., Any], of_arrays: str) -> Callable[..., Any]:
    """Return the function of floats, or numpy's of two arrays at a time."""

    def function(*values: Any) -> Any:
        if isinstance(values[0], float):
            return of_float(*values)
        import numpy as np

        return reduce(getattr(np, of_arrays), values)

    return function


exp, log, sin, cos, sqrt, degrees = map(_either, ("exp", "log", "sin", "cos", "sqrt", "degrees"))

#: Length of (x, y); the angle of y and x; elementwise minimum and maximum.
hypot, atan2, minimum, maximum = (
    _of_several(*both) for both in ((math.hypot, "hypot"), (math.atan2, "arctan2"), (min, "minimum"), (max, "maximum"))
)


def clip(x: Any, low: float, high: float) -> Any:
    """Return x clamped to the range from ``low`` to ``high``."""
    if isinstance(x, float):
        return low if x < low else high if x > high else x
    import numpy as np

    return np.minimum(np.maximum(x, low), high)  # in a third of the time of np.clip


def rounded(x: Any, digits: int) -> Any:
    """Return x to so many digits after the point."""
    if isinstance(x, float):
        return round(x, digits)
    import numpy as np

    return np.round(x, digits)


def smooth(x: Any) -> Any:
    """Return 0 below 0, 1 above 1, and between them a rise without kinks."""
    s = clip(x, 0.0, 1.0)
    return s * s * (3.0 - 2.0 * s)


def finite(x: Any) -> bool:
    """Return True if x is finite, everywhere."""
    if isinstance(x, float | int):
        return math.isfinite(x)
    import numpy as np

    return bool(np.isfinite(x).all())


def anywhere(condition: Any) -> bool:
    """Return True if the condition holds anywhere."""
    if isinstance(condition, bool):
        return condition
    import numpy as np

    return bool(np.count_nonzero(condition))  # in a third of the time of any()


def everywhere(condition: Any) -> bool:
    """Return True if the condition holds everywhere."""
    return condition if isinstance(condition, bool) else bool(condition.all())


def where(condition: Any, yes: Any, no: Any) -> Any:
    """Return ``yes`` where the condition holds, ``no`` elsewhere."""
    if isinstance(condition, bool):
        return yes if condition else no
    import numpy as np

    return np.where(condition, yes, no) if condition.ndim else (yes if condition else no)


def _clip_float(x: float, low: float, high: float) -> float:
    return low if x < low else high if x > high else x


def _where_bool(condition: Any, yes: Any, no: Any) -> Any:
    return yes if condition else no


#: What the functions above do with floats.
_OF_FLOATS: dict[Any, Any] = {
    exp: math.exp,
    log: math.log,
    sin: math.sin,
    cos: math.cos,
    sqrt: math.sqrt,
    hypot: math.hypot,
    minimum: min,
    maximum: max,
    clip: _clip_float,
    finite: math.isfinite,
    anywhere: bool,
    everywhere: bool,
    where: _where_bool,
}


def of_floats(law: Any) -> Any:
    """Return a function of sandbox.physics or sandbox.engine as it is for floats alone, as in a run of one ball: the
    same code, but where it calls what may take arrays, it calls what takes floats, without a look at what it is given.
    So this is decided once, and not in each call. Anything else, as a function of a scene's own, is returned as it is.
    """
    ours = isinstance(law, FunctionType) and law.__module__.startswith(("sandbox.physics.", "sandbox.engine."))
    return _made_of_floats(law) if ours else law


@cache
def _made_of_floats(law: FunctionType) -> Any:
    return remade(law, _OF_FLOATS)


def remade(function: Any, others: Mapping[Any, Any]) -> Any:
    """Return a function with the same code that calls ``others`` in place of some of the sandbox's functions, and so do
    all that it calls; itself, where nothing changes."""
    return _remade(function, others, {})


def _remade(function: Any, others: Mapping[Any, Any], made: dict[Any, Any]) -> Any:
    if function in others:
        return others[function]
    if not (isinstance(function, FunctionType) and function.__module__.startswith("sandbox.")):
        return function
    if function not in made:
        named = {name: function.__globals__.get(name) for name in function.__code__.co_names}
        instead = {name: _remade(f, others, made) for name, f in named.items() if isinstance(f, FunctionType)}
        changed = any(instead[name] is not named[name] for name in instead)
        globals_, closure = {**function.__globals__, **instead}, function.__closure__
        code, defaults = function.__code__, function.__defaults__
        made[function] = FunctionType(code, globals_, function.__name__, defaults, closure) if changed else function
    return made[function]
