"""A 2D sports sandbox: pick a sport, or describe a setup, let go, and see real physics.

>>> import sandbox
>>> scene = sandbox.load("golf", {"launch.speed": 70.0})
>>> run = sandbox.simulate(scene)
>>> 200 < run.result["carry"] < 250
True

``help(sandbox.simulate)`` and ``help(sandbox.Run)`` say more; docs/python.md has all names.
"""

from __future__ import annotations

TYPE_CHECKING = False  # not from typing, which is slow to import: Ctrl-C is not handled until imports are done
if TYPE_CHECKING:
    from typing import Any

    from sandbox.engine.model.accuracy import Accuracy
    from sandbox.engine.model.ball import DISC, HOLLOW_SPHERE, SOLID_SPHERE, Ball, Body, Force, Torque
    from sandbox.engine.model.event import Event
    from sandbox.engine.model.motion import Given, InTurn, Motion, Placing, Sliding, Swinging, Turning
    from sandbox.engine.model.setup import Bounds, ContactModel, ForceRegion, Setup, Touches, Until
    from sandbox.engine.model.shapes import Ellipse, Polygon, box, capsule, disc, regular
    from sandbox.engine.model.surface import Bounce, Circle, ConstantBounce, Moving, Segment, Surface, Trap
    from sandbox.engine.paths.run import Numerics, Run, State
    from sandbox.engine.pymunk_space import pymunk_space
    from sandbox.errors import RequestError, RunError, SandboxError
    from sandbox.lab.aim import Aim, aim
    from sandbox.lab.fit import Fit, fit
    from sandbox.lab.many import Runs, simulate_many
    from sandbox.lab.session import Session, session
    from sandbox.lab.spread import Spread, spread
    from sandbox.lab.sweep import Sweep, sweep
    from sandbox.physics.air import Gusts, LogWind, UniformWind
    from sandbox.physics.cloth import Cloth
    from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
    from sandbox.physics.ice import CurlingIce, Glide
    from sandbox.physics.slope import Slope
    from sandbox.scene import Check, Scene, check, load, simulate
    from sandbox.scene.scene_run import SceneRun
    from sandbox.scene.world import World

__version__ = "0.1.0"

#: The module of each name, imported on first use: ``sandbox --help`` needs none of them.
_MODULES = {
    **dict.fromkeys(("Accuracy",), "sandbox.engine.model.accuracy"),
    **dict.fromkeys(
        ("DISC", "HOLLOW_SPHERE", "SOLID_SPHERE", "Ball", "Body", "Force", "Torque"), "sandbox.engine.model.ball"
    ),
    **dict.fromkeys(("Event",), "sandbox.engine.model.event"),
    **dict.fromkeys(
        ("Given", "InTurn", "Motion", "Placing", "Sliding", "Swinging", "Turning"), "sandbox.engine.model.motion"
    ),
    **dict.fromkeys(
        ("Bounds", "ContactModel", "ForceRegion", "Setup", "Touches", "Until"), "sandbox.engine.model.setup"
    ),
    **dict.fromkeys(("Ellipse", "Polygon", "box", "capsule", "disc", "regular"), "sandbox.engine.model.shapes"),
    **dict.fromkeys(
        ("Bounce", "Circle", "ConstantBounce", "Moving", "Segment", "Surface", "Trap"), "sandbox.engine.model.surface"
    ),
    **dict.fromkeys(("Numerics", "Run", "State"), "sandbox.engine.paths.run"),
    **dict.fromkeys(("pymunk_space",), "sandbox.engine.pymunk_space"),
    **dict.fromkeys(("RequestError", "RunError", "SandboxError"), "sandbox.errors"),
    **dict.fromkeys(("Aim", "aim"), "sandbox.lab.aim"),
    **dict.fromkeys(("Fit", "fit"), "sandbox.lab.fit"),
    **dict.fromkeys(("Runs", "simulate_many"), "sandbox.lab.many"),
    **dict.fromkeys(("Session", "session"), "sandbox.lab.session"),
    **dict.fromkeys(("Spread", "spread"), "sandbox.lab.spread"),
    **dict.fromkeys(("Sweep", "sweep"), "sandbox.lab.sweep"),
    **dict.fromkeys(("Gusts", "LogWind", "UniformWind"), "sandbox.physics.air"),
    **dict.fromkeys(("Cloth",), "sandbox.physics.cloth"),
    **dict.fromkeys(("Drag", "Gravity", "Magnus", "SpinDecay"), "sandbox.physics.forces"),
    **dict.fromkeys(("CurlingIce", "Glide"), "sandbox.physics.ice"),
    **dict.fromkeys(("Slope",), "sandbox.physics.slope"),
    **dict.fromkeys(("Check", "Scene", "check", "load", "simulate"), "sandbox.scene"),
    **dict.fromkeys(("SceneRun",), "sandbox.scene.scene_run"),
    **dict.fromkeys(("World",), "sandbox.scene.world"),
}

__all__ = [
    "DISC",
    "HOLLOW_SPHERE",
    "SOLID_SPHERE",
    "Accuracy",
    "Aim",
    "Ball",
    "Body",
    "Bounce",
    "Bounds",
    "Check",
    "Circle",
    "Cloth",
    "ConstantBounce",
    "ContactModel",
    "CurlingIce",
    "Drag",
    "Ellipse",
    "Event",
    "Fit",
    "Force",
    "ForceRegion",
    "Given",
    "Glide",
    "Gravity",
    "Gusts",
    "InTurn",
    "LogWind",
    "Magnus",
    "Motion",
    "Moving",
    "Numerics",
    "Placing",
    "Polygon",
    "RequestError",
    "Run",
    "RunError",
    "Runs",
    "SandboxError",
    "Scene",
    "SceneRun",
    "Segment",
    "Session",
    "Setup",
    "Sliding",
    "Slope",
    "SpinDecay",
    "Spread",
    "State",
    "Surface",
    "Sweep",
    "Swinging",
    "Torque",
    "Touches",
    "Trap",
    "Turning",
    "UniformWind",
    "Until",
    "World",
    "aim",
    "box",
    "capsule",
    "check",
    "disc",
    "fit",
    "load",
    "pymunk_space",
    "regular",
    "session",
    "simulate",
    "simulate_many",
    "spread",
    "sweep",
]


if not TYPE_CHECKING:  # or a misspelt name would pass as one of any type

    def __getattr__(name: str) -> Any:
        if name not in _MODULES:
            raise AttributeError(f"module 'sandbox' has no attribute {name!r}")
        from importlib import import_module

        found = globals()[name] = getattr(import_module(_MODULES[name]), name)
        return found


def __dir__() -> list[str]:
    return [*__all__, "__version__"]
