"""Names of an earlier version that scenes and scripts may still use: each gives an error that says the new one."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import fields
from functools import wraps
from typing import Any, NoReturn, TypeVar, cast

T = TypeVar("T")

_PACKAGE = "sandbox."

#: Modules of the package, by their old names.
MODULES = {
    "engine.setup": "engine.model.ball, engine.model.surface and engine.model.setup",
    "engine.accuracy": "engine.model.accuracy",
    "engine.shapes": "engine.model.shapes",
    "engine.event": "engine.model.event",
    "engine.run": "engine.paths.run",
    "engine.path": "engine.paths.path",
    "engine.arc": "engine.paths.arc",
    "engine.acting": "engine.motion.forces_on_ball",
    "engine.meeting": "engine.contact.manifold",
    "engine.touch": "engine.contact.touch",
    "engine.track": "engine.motion.moving_ball",
}

_ELEMENTWISE = {"least": "minimum", "most": "maximum", "choose": "where"}
_FACTS = {"once": "cached_per_run"}
_READINGS = {"at": "fact_from", "coming_to": "first_contact_with"}
_AMOUNTS = {"nice": "round_number_above", "twice": "in_two_units"}

#: Functions and classes, by module of the package and old name.
NAMES: dict[str, dict[str, str]] = {
    "engine.model.setup": {
        **dict.fromkeys(
            ("Body", "Force", "Torque", "SOLID_SPHERE", "HOLLOW_SPHERE", "DISC", "kinetic", "outline_of"),
            "in engine.model.ball",
        ),
        "Vector": "in engine.model.shapes",
        "Catch": "engine.model.surface.Trap",
        "Always": "engine.model.surface.ConstantBounce",
        "Patch": "ForceRegion",
    },
    "parameters": {"word": "text", "either": "one_of"},
    "kit": {
        "Catch": "Trap",
        "Always": "ConstantBounce",
        "Patch": "ForceRegion",
        "word": "text",
        "either": "one_of",
        **_ELEMENTWISE,
        **_FACTS,
        **_READINGS,
        **_AMOUNTS,
        "stamp": "text_mask",
    },
    "physics.elementwise": _ELEMENTWISE,
    "picture.lettering": {"stamp": "text_mask"},
    "picture.path": {"Mark": "ImpactMark"},
    "picture.views": {"nice": "round_number_above"},
    "sport.facts": _FACTS,
    "sport.readings": _READINGS,
    "sport.amounts": _AMOUNTS,
    "sport.net_game": {"word": "outcome", "taken": "received_at"},
    "sport.sliding": {
        "Body": "SlidingDisc",
        "aside": "lateral_offset",
        "meetings": "all_collisions",
        "met": "collisions_of",
        "taken": "removed_by",
        "left": "in_play",
    },
}

#: Arguments and attributes, by class and old name.
FIELDS: dict[str, dict[str, str]] = {
    "Ball": {"turns": "rotates", "turned": "initial_angle", "left": "mass_fraction"},
    "Body": {"turns": "rotates", "turned": "initial_angle", "left": "mass_fraction"},
    "Setup": {
        "catches": "traps",
        "patches": "force_regions",
        "breaks": "discontinuities",
        "is_flight": "is_single_ball",
    },
    "Fact": {"how": "compute", "settled": "final_when"},
    "Controls": {"strongest": "full_pull_speed", "also": "set_on_pull"},
    "Handle": {"first": "prerequisites"},
    "Spread": {"least": "minimum"},
    "Check": {"unsettled": "changed_by_nudge"},
}

#: Options of a scene's picture, by old name.
OPTIONS = {
    "told": "story_end",
    "company": "must_be_visible",
    "FROM": "MEASURED_FROM",
    "LENGTHS": "LENGTH_ROWS",
    "STRETCHES": "MAX_STRETCH",
    "LEAST_PATH": "MIN_PATH_SHARE",
    "LEVEL": "EYE_HEIGHT",
    "ASIDE": "EYE_COLUMN",
    "EARLIER": "OTHER_TRACES",
    "FAINT": "FAINT_TRACE",
    "OTHERS": "OTHER_WIDTH",
    "LEAST_IMPACT": "MIN_IMPACT",
    "SOFT": "MIN_IMPACT_SHARE",
    "LEAST_SPAN": "MIN_STROBE_SHARE",
    "SPINS": "SPIN_NAMES",
    "STRING": "STRING_COLOUR",
    "ONE_GROUND": "SHARED_GROUND",
    "least": "min_radius",
    "near_view": "frame_width",
    "NEAREST": "FRAME_WIDTH",
    "closeups_of": "closeup_boxes",
    "ROOM": "ROOM_COLOUR",
    "WIDER": "WIDTH_SCALE",
    "lying": "initial_turn",
    "span": "strobe_end",
    "target": "preferred_view",
}


class _MovedModules:
    """Finds no module: an import of one that has moved is an error that says where it is now."""

    @staticmethod
    def find_spec(name: str, path: object, target: object = None) -> None:
        now = MODULES.get(name.removeprefix(_PACKAGE))
        if now is not None:
            where = now.replace("engine", f"{_PACKAGE}engine")
            raise ModuleNotFoundError(f"{name} is now {where}; a scene imports from sandbox.kit", name=name)


def name_old_modules() -> None:
    """From now on the import of a module by its old name says the new one."""
    if _MovedModules not in sys.meta_path:
        sys.meta_path.append(_MovedModules)


def name_old_names(module: str) -> None:
    """From now on an import of an old name from this module says the new one."""

    def missing(name: str) -> NoReturn:
        raise_if_old(module, name)
        raise AttributeError(f"module {module!r} has no attribute {name!r}")

    sys.modules[module].__dict__["__getattr__"] = missing


def raise_if_old(module: str, name: str) -> None:
    """Raise ImportError with the new name if this one, which the module does not have, is an old one."""
    now = NAMES[module.removeprefix(_PACKAGE)].get(name)
    if now is not None:
        raise ImportError(f"{name} is now {now.replace('engine', f'{_PACKAGE}engine')}", name=module)


def with_old_fields_named(cls: type[T]) -> type[T]:
    """Return a dataclass that names the new argument or attribute where an old one is used, and its fields where an
    argument is unknown: a TypeError that says so."""
    names, made = FIELDS.get(cls.__name__, {}), cls.__init__
    known = {field.name: None for field in fields(cast(Any, cls)) if field.init}

    @wraps(made)
    def init(self: Any, *arguments: Any, **named: Any) -> None:
        if not known.keys() >= named.keys():
            wrong = next(name for name in named if name not in known)
            if wrong in names:
                raise TypeError(f"{cls.__name__}: {wrong} is now {names[wrong]}")
            raise TypeError(f"{cls.__name__}: unexpected keyword argument {wrong!r}; it takes {', '.join(known)}")
        made(self, *arguments, **named)

    def missing(self: Any, name: str) -> NoReturn:
        now = f" is now {names[name]}" if name in names else f": {cls.__name__!r} object has no attribute {name!r}"
        raise AttributeError(f"{cls.__name__}.{name}{now}")

    made_to_name: dict[str, Callable[..., Any]] = {"__init__": init, "__getattr__": missing}
    for name, function in made_to_name.items():
        setattr(cls, name, function)
    return cls
