"""A 2D sports sandbox: pick a sport, let go, and see real physics.

>>> import sandbox
>>> scene = sandbox.load("golf", {"launch.speed": 70.0})
>>> run = sandbox.simulate(scene)
>>> run.result["carry"]
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sandbox.errors import RequestError, RunError, SandboxError
    from sandbox.scene import Check, Scene, check, load, simulate

__version__ = "0.1.0"

__all__ = ["Check", "RequestError", "RunError", "SandboxError", "Scene", "check", "load", "simulate"]


def __getattr__(name: str) -> Any:
    """Import on first use: ``sandbox --help`` needs none of it."""
    if name not in __all__:
        raise AttributeError(f"module 'sandbox' has no attribute {name!r}")
    from importlib import import_module

    home = "sandbox.errors" if name.endswith("Error") else "sandbox.scene"
    return getattr(import_module(home), name)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
