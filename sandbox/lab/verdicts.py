"""Verdicts by method and level: shots around the scene's own, and how many come out the same, differently, or fail."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import product
from time import perf_counter
from typing import Any

from sandbox import parameters as declared
from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.setup_errors import MethodFailed
from sandbox.lab.report import Column, Table, words
from sandbox.lab.runs import columns_at
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
class Verdicts:
    """The shots of one method, counted by how their verdict compares with that of the finest run."""

    same: int = 0
    other: int = 0
    failed: int = 0


@dataclass(frozen=True)
class VerdictChanges:
    """The verdicts of shots by method and level, compared with those of the finest runs."""

    over: tuple[str, str]  # the keys of speed and angle
    shots: int
    methods: dict[str, Verdicts]
    failures: dict[str, dict[str, int]] = field(default_factory=dict)  # of each method, how many by their name

    def table(self) -> Table:
        """Counts of shots with the same verdict, another one, or a failure and its kind, by method."""
        about = f"{self.shots} shots, {self.over[0]} within {100 * _SPEED:.0f} %, {self.over[1]} within {_ANGLE:g} deg"
        count = [Column(heading, write=lambda shots: str(shots or "-")) for heading in ("same", "other", "failed")]
        rows = [[name, of.same, of.other, of.failed, self.named(name)] for name, of in self.methods.items()]
        title = f"verdicts, compared with the finest run's ({about})"
        return Table([words("by"), *count, words()], rows, title, detail=True)

    def named(self, method: str) -> str:
        """The kinds of failure of its shots, with counts."""
        return ", ".join(f"{name} {count}" for name, count in self.failures.get(method, {}).items())


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

    def verdicts(points: list[tuple[float, float]], how: Mapping[str, Any], finer: bool = False) -> list[Any]:
        found = columns_at(scene.changed({**controls.set_on_pull, **how}), keys, points, finer)
        return [
            found.errors[place] if result is None else verdict(scene, result)
            for place, result in enumerate(found.results())
        ]

    started = perf_counter()
    own = [(speed.value, angle.value)]
    if not verdicts(own, _WAYS["precise"], finer=True)[0]:
        return None
    side = int((PATIENCE / (perf_counter() - started)) ** 0.5)
    points = shots(max(FEWEST, min(MOST, side)))
    truth = verdicts(points, _WAYS["precise"], finer=True)
    methods, failures = {}, {}
    for name, how in _WAYS.items():
        started = perf_counter()
        verdicts(own, how)
        if len(points) * (perf_counter() - started) <= TOO_LONG:
            found = verdicts(points, how)
            methods[name] = compared(truth, found)
            pairs = zip(truth, found, strict=True)
            failures[name] = dict(Counter(failure(b) for a, b in pairs if _has_failed(a, b)))
    return VerdictChanges(keys, len(points), methods, {name: each for name, each in failures.items() if each})


def compared(truth: Sequence[Any], found: Sequence[Any]) -> Verdicts:
    """The verdicts found, or exceptions, compared with the true ones."""
    pairs = list(zip(truth, found, strict=True))
    failed = sum(_has_failed(a, b) for a, b in pairs)
    other = sum(a != b and not isinstance(b, Exception) for a, b in pairs)
    return Verdicts(len(pairs) - failed - other, other, failed)


def _has_failed(truth: Any, found: Any) -> bool:
    """True if the run failed and the true one did not."""
    return isinstance(found, Exception) and not isinstance(truth, Exception)


def failure(error: Exception) -> str:
    """The name of a failure: that of the method's, or of another error."""
    return error.name if isinstance(error, MethodFailed) else type(error).__name__
