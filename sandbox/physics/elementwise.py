"""Functions of floats or arrays: one ball uses fast Python floats, many shots use numpy."""

from __future__ import annotations

import math
from typing import Any


def exp(x: Any) -> Any:
    """e to the x."""
    if isinstance(x, float):
        return math.exp(x)
    import numpy as np

    return np.exp(x)


def sin(x: Any) -> Any:
    """Sine of x in rad."""
    if isinstance(x, float):
        return math.sin(x)
    import numpy as np

    return np.sin(x)


def cos(x: Any) -> Any:
    """Cosine of x in rad."""
    if isinstance(x, float):
        return math.cos(x)
    import numpy as np

    return np.cos(x)


def log(x: Any) -> Any:
    """Natural logarithm."""
    if isinstance(x, float):
        return math.log(x)
    import numpy as np

    return np.log(x)


def clip(x: Any, low: float, high: float) -> Any:
    """x clamped to the range from ``low`` to ``high``."""
    if isinstance(x, float):
        return low if x < low else high if x > high else x
    import numpy as np

    return np.clip(x, low, high)


def hypot(x: Any, y: Any) -> Any:
    """Length of (x, y)."""
    if isinstance(x, float):
        return math.hypot(x, y)
    import numpy as np

    return np.hypot(x, y)


def least(*values: Any) -> Any:
    """Elementwise minimum."""
    if isinstance(values[0], float):
        return min(values)
    import numpy as np

    return np.minimum.reduce(values)


def most(*values: Any) -> Any:
    """Elementwise maximum."""
    if isinstance(values[0], float):
        return max(values)
    import numpy as np

    return np.maximum.reduce(values)


def finite(x: Any) -> bool:
    """Whether x is finite, everywhere."""
    if isinstance(x, float | int):
        return math.isfinite(x)
    import numpy as np

    return bool(np.isfinite(x).all())


def anywhere(condition: Any) -> bool:
    """Whether the condition holds anywhere."""
    return condition if isinstance(condition, bool) else bool(condition.any())


def everywhere(condition: Any) -> bool:
    """Whether the condition holds everywhere."""
    return condition if isinstance(condition, bool) else bool(condition.all())


def choose(condition: Any, yes: Any, no: Any) -> Any:
    """``yes`` where the condition holds, ``no`` elsewhere."""
    if isinstance(condition, bool):
        return yes if condition else no
    import numpy as np

    return np.where(condition, yes, no) if condition.ndim else (yes if condition else no)
