"""Functions of floats or arrays: one ball uses fast Python floats, many shots use numpy."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import reduce
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


exp, log, sin, cos, degrees = map(_either, ("exp", "log", "sin", "cos", "degrees"))

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


def stacked(values: Sequence[Any], like: Any) -> Sequence[Any]:
    """Return the values for a float; for an array of shape (n,) one array of shape (values, n)."""
    if isinstance(like, float):
        return values
    import numpy as np

    found = np.empty((len(values), len(like)))
    for row, value in zip(found, values, strict=True):
        row[:] = value
    return (found,)


def smallest(x: Any) -> Any:
    """Return a float as it is; of an array of shape (values, n) the smallest of each column."""
    return x if isinstance(x, float) else x.min(axis=0)


def everywhere(condition: Any) -> bool:
    """Return True if the condition holds everywhere."""
    return condition if isinstance(condition, bool) else bool(condition.all())


def where(condition: Any, yes: Any, no: Any) -> Any:
    """Return ``yes`` where the condition holds, ``no`` elsewhere."""
    if isinstance(condition, bool):
        return yes if condition else no
    import numpy as np

    return np.where(condition, yes, no) if condition.ndim else (yes if condition else no)
