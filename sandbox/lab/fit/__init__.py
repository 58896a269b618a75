"""Fit: the parameters of a scene that explain a measured track.

Least squares over runs that are computed together. Times of impact are exact, so positions are smooth in the
parameters through bounces too, and differences of neighbouring runs are good derivatives.
"""

from __future__ import annotations

from importlib import import_module

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from sandbox.lab.fit.fitting import fit, fit_track, parse_varied, read_data
    from sandbox.lab.fit.squares import Fit
    from sandbox.lab.fit.track import Track

#: The names of each module, which is imported on first use: to list commands takes none of them.
_MODULES = {
    "fitting": (
        "fit",
        "fit_track",
        "parse_varied",
        "read_data",
    ),
    "squares": ("Fit",),
    "track": ("Track",),
}

__all__ = ["Fit", "Track", "fit", "fit_track", "parse_varied", "read_data"]


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            return getattr(import_module(f"sandbox.lab.fit.{module}"), name)
    raise AttributeError(f"module 'sandbox.lab.fit' has no attribute {name!r}")
