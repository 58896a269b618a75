"""A 2D sports sandbox: pick a sport, let go, and see real physics.

>>> import sandbox
>>> scene = sandbox.load("golf", {"launch.speed": 70.0})
>>> run = sandbox.simulate(scene)
>>> run.result["carry"]
"""

from __future__ import annotations

from sandbox.scene import display

TYPE_CHECKING = False  # not from typing, which is slow to import: Ctrl-C is not handled until imports are done
if TYPE_CHECKING:
    from types import ModuleType
    from typing import Any

    from sandbox.errors import RequestError, RunError, SandboxError
    from sandbox.lab.aim import Aim, aim
    from sandbox.lab.sweep import Sweep, sweep
    from sandbox.scene import Check, Scene, check, load, simulate

__version__ = "0.1.0"

#: The module of each name, imported on first use: ``sandbox --help`` needs none of them.
_MODULES = {
    **dict.fromkeys(("RequestError", "RunError", "SandboxError"), "sandbox.errors"),
    **dict.fromkeys(("Check", "Scene", "check", "load", "simulate"), "sandbox.scene"),
    **dict.fromkeys(("Aim", "aim"), "sandbox.lab.aim"),
    **dict.fromkeys(("Sweep", "sweep"), "sandbox.lab.sweep"),
}

__all__ = [
    "Aim",
    "Check",
    "RequestError",
    "RunError",
    "SandboxError",
    "Scene",
    "Sweep",
    "aim",
    "check",
    "load",
    "simulate",
    "sweep",
]


def __getattr__(name: str) -> Any:
    if name not in _MODULES:
        raise AttributeError(f"module 'sandbox' has no attribute {name!r}")
    from importlib import import_module

    return getattr(import_module(_MODULES[name]), name)


def _pictures() -> ModuleType:
    from sandbox.picture import plain

    return plain


def _notebook() -> ModuleType:
    from sandbox.page import notebook

    return notebook


display.show_with(_pictures, _notebook)


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
