"""The share of verdicts that depend on the accuracy: shots around the scene's own, run at every level."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from time import perf_counter
from typing import Any

from sandbox import parameters as declared
from sandbox.engine.model.accuracy import LEVELS
from sandbox.lab.runs import runs
from sandbox.lab.tables import paragraph, table
from sandbox.scene import Scene

#: Range of the map: fraction of the speed, and degrees to either side.
_SPEED, _ANGLE = 0.1, 5.0

#: Time in s to spend on the finest runs, and the shots along one side of the map.
PATIENCE, FEWEST, MOST = 2.0, 5, 15

#: A method that would take longer than this, in s, is left out.
TOO_LONG = 10.0

#: Results whose value is clear without its name.
_WITHOUT_NAME = ("verdict", "ended")

#: Changes of the scene's accuracy that are compared with the finest runs.
_WAYS: dict[str, dict[str, Any]] = {
    **{name: {"accuracy.level": name} for name in LEVELS},
    **{f"plain 1/{rate} s": {"accuracy.method": "plain", "accuracy.step": 1 / rate} for rate in (60, 240)},
}


@dataclass(frozen=True)
class VerdictChanges:
    """Fraction of the shots whose verdict differs from the finest run's, by level."""

    over: tuple[str, str]  # the keys of speed and angle
    shots: int
    changed: dict[str, float]

    def as_text(self) -> list[str]:
        about = f"{self.shots} shots, {self.over[0]} within {100 * _SPEED:.0f} %, {self.over[1]} within {_ANGLE:g} deg"
        rows = [(name, f"{100.0 * share:.1f} %") for name, share in self.changed.items()]
        return [
            *paragraph(f"verdicts that change with the accuracy ({about})", ""),
            *table(("by", "changed"), rows, "lr"),
        ]


def verdict(scene: Scene, result: Mapping[str, Any]) -> str:
    """The verdict of a result, or else its values that are not numbers, without lists of what happened in order."""
    if isinstance(result.get("verdict"), str):
        return str(result["verdict"])
    words = []
    for name, value in result.items():
        if value is True:
            words.append(name)
        elif isinstance(value, str):
            words.append(value if name in _WITHOUT_NAME else f"{name} {value}")
        elif value and isinstance(value, list) and not scene.facts[name].in_order:
            words.append(" ".join([name, *value]))
    return ", ".join(words)


def shot_map(scene: Scene) -> VerdictChanges | None:
    """Run the map; None for a scene without speed and angle to vary, or without a verdict."""
    controls = scene.controls
    known = {parameter.key: parameter for parameter in declared.walk(scene.parameters)}
    speed, angle = known.get(controls.speed), known.get(controls.angle)
    if speed is None or angle is None or not speed.value:
        return None
    keys = (speed.key, angle.key)

    def shots(side: int) -> list[tuple[float, float]]:
        places = [2.0 * k / (side - 1) - 1.0 for k in range(side)]
        return [
            (speed.within(speed.value * (1.0 + _SPEED * p)), angle.within(angle.value + _ANGLE * q))
            for p, q in product(places, places)
        ]

    def verdicts(points: list[tuple[float, float]], how: Mapping[str, Any], finer: bool = False) -> list[str]:
        found = runs(scene.changed({**controls.set_on_pull, **how}), keys, points, finer)
        return [
            f"failed: {type(run).__name__}" if isinstance(run, Exception) else verdict(scene, run.result)
            for run in found
        ]

    started = perf_counter()
    own = [(speed.value, angle.value)]
    if not verdicts(own, _WAYS["precise"], finer=True)[0]:
        return None
    side = int((PATIENCE / (perf_counter() - started)) ** 0.5)
    points = shots(max(FEWEST, min(MOST, side)))
    truth = verdicts(points, _WAYS["precise"], finer=True)
    changed = {}
    for name, how in _WAYS.items():
        started = perf_counter()
        verdicts(own, how)
        if len(points) * (perf_counter() - started) <= TOO_LONG:
            changed[name] = sum(a != b for a, b in zip(truth, verdicts(points, how), strict=True)) / len(points)
    return VerdictChanges(keys, len(points), changed)
