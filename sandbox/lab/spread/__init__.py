"""Scatter in the parameters and what becomes of it in the results: the same shot many times, as a player would hit it.

Each cause, a parameter with its standard deviation, is drawn independently of the others, at points of Sobol's
sequence, which cover the distribution evenly. Sobol's indices (2001, Math. Comput. Simul. 55:271) say how much of
the variance each cause accounts for: the first-order index is its share alone, the total one includes what it does
together with others.
"""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from sandbox.lab.spread.spreading import Indices, Spread, check_scipy, spread, spread_of

#: The names of each module, which is imported on first use: to list commands takes none of them.
_MODULES = {
    "spreading": (
        "Indices",
        "Spread",
        "check_scipy",
        "spread",
        "spread_of",
    ),
}

__all__ = ["Indices", "Spread", "check_scipy", "spread", "spread_of"]


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"sandbox.lab.spread.{module}"), name)
    raise AttributeError(f"module 'sandbox.lab.spread' has no attribute {name!r}")
