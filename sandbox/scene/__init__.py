"""Scenes: what they are, how they are found and run, and how accurate their results are."""

from __future__ import annotations

from importlib import import_module

_TYPE_CHECKING = False
if _TYPE_CHECKING:
    from typing import Any

    from sandbox.scene.discovery import Listing, listings, listings_in, listings_of, reference
    from sandbox.scene.running import Check, check, compare, errors_of, simulate
    from sandbox.scene.scene import Scene, as_scene, load, parameters_of

#: The names of each module, which is imported on first use: to list scenes takes none of what it takes to run one.
_MODULES = {
    "discovery": ("Listing", "listings", "listings_in", "listings_of", "reference"),
    "running": ("Check", "check", "compare", "errors_of", "simulate"),
    "scene": ("Scene", "as_scene", "load", "parameters_of"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            found = globals()[name] = getattr(import_module(f"sandbox.scene.{module}"), name)
            return found
    raise AttributeError(f"module 'sandbox.scene' has no attribute {name!r}")
