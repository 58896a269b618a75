"""Things dragged in the picture: where the scene's handles are, and which changes a drag makes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from sandbox.engine.model.shapes import Vector
from sandbox.parameters import Group, value_at
from sandbox.sport.amounts import amount
from sandbox.sport.controls import Handle
from sandbox.window.session import Session

#: What every scene with air has.
WIND = Handle("air.wind[0]", "air.wind[1]")


@dataclass(frozen=True)
class Grip:
    """A handle of a scene as it is now."""

    keys: tuple[str, str]  # along x and y, "" for none
    place: Vector  # m, or m/s for the wind
    name: str  # of what is dragged
    slopes: tuple[float, float]  # how far it moves along x and y per change of the parameters
    values: tuple[float, float]  # of the parameters
    bounds: list[tuple[float, float]]
    prerequisites: dict[str, Any]
    with_y: dict[str, float]  # what moves up and down with it: keys and values, m

    @property
    def in_list(self) -> bool:
        """True if it is one of many."""
        return "]" in "".join(self.keys) and not self.is_wind

    @property
    def is_wind(self) -> bool:
        return self.keys == (WIND.x, WIND.y)

    def changes(self, place: Vector, step: float) -> dict[str, Any]:
        """The changes that move it to a place, or near it, in whole steps."""
        found = {}
        axes = zip(self.keys, self.values, place, self.place, self.slopes, self.bounds, strict=True)
        for key, value, to, was, slope, bounds in axes:
            if key and slope:
                low, high = bounds
                found[key] = min(max(float(f"{round((value + (to - was) / slope) / step) * step:.9g}"), low), high)
        rise = found[self.keys[1]] - self.values[1] if self.keys[1] in found else 0.0
        carried = {key: max(0.0, float(f"{value + rise:.9g}")) for key, value in self.with_y.items()}
        return {**self.prerequisites, **found, **carried}

    def value_text(self, session: Session) -> str:
        """The parameters and their current values: ``hoop distance 4.19 m, height 3.05 m``."""
        unit = "m/s" if self.is_wind else "m"
        names = ["", ""] if self.is_wind else [key.rpartition(".")[2].replace("_", " ") for key in self.keys]
        texts = []
        for key, name, value in zip(self.keys, names, self.values, strict=True):
            now = session.value(key) if key else None
            texts += [f"{name} {amount(value if now is None else now, unit)}".lstrip()] * bool(key)
        return f"{self.name} {', '.join(texts)}".lstrip()


def grips(session: Session) -> list[Grip]:
    """The handles of the current scene, or in a contest those of what the player may set."""
    scene, found = session.scene, []
    for handle in (*session.controls.handles, WIND):
        first = dict(handle.prerequisites(scene.parameters)) if handle.prerequisites is not None else {}
        parameters = session.with_changes({**session.changes.values, **first}).parameters if first else scene.parameters
        for keys in _entries(handle, parameters):
            values = [value_at(parameters, key) if key else 0.0 for key in keys]
            shown = session.may_change(keys) and (not handle.where or value_at(parameters, handle.where))
            if not shown or not all(isinstance(value, float) for value in values):
                continue
            place = handle.at(parameters) if handle.at is not None else (values[0], values[1])
            slopes = _slopes(handle, keys, values, place, session)
            declared = [session.parameters.get(key) for key in keys]
            bounds = [
                (-inf, inf) if p is None or p.low is None or p.high is None else (p.low, p.high) for p in declared
            ]
            name = _name(parameters, next(filter(None, keys)))
            with_y = {key: value_at(parameters, key) for key in handle.with_y}
            found.append(Grip(keys, place, name, slopes, (values[0], values[1]), bounds, first, with_y))
    return found


def _entries(handle: Handle, parameters: Group) -> Iterator[tuple[str, str]]:
    """The keys of a handle, for each entry of its list."""
    name, star, _ = (handle.x or handle.y).partition("[*]")
    count = len(value_at(parameters, name) or ()) if star else 1
    for index in range(count):
        yield handle.x.replace("[*]", f"[{index}]"), handle.y.replace("[*]", f"[{index}]")


def _slopes(
    handle: Handle, keys: tuple[str, str], values: Sequence[float], place: Vector, session: Session
) -> tuple[float, float]:
    """The distance that the handle moves per change of its parameters; 0 where that cannot be told."""
    if handle.at is None:
        return 1.0, 1.0
    slopes = []
    for axis, (key, value) in enumerate(zip(keys, values, strict=True)):
        slope = 0.0
        for step in (1e-3, -1e-3) if key else ():
            try:
                changes = {**session.changes.values, key: value + step}
                there = handle.at(session.with_changes(changes).parameters)
            except Exception:  # beyond the parameter's bounds
                continue
            slope = (there[axis] - place[axis]) / step
            break
        slopes.append(round(slope, 6))
    return slopes[0], slopes[1]


def _name(parameters: Group, key: str) -> str:
    """The group of a parameter, or what its entry of a list is called: ``hoop``, ``ball cue``, ``stone 2``."""
    group = key.rpartition(".")[0]
    name, bracket, number = group.partition("[")
    if not bracket:
        return key.partition("[")[0].replace("air.", "") if "[" in key else (group or key).replace(".", " ")
    called = value_at(parameters, f"{group}.name") or int(number.rstrip("]")) + 1
    return f"{name.removesuffix('s')} {called}"
