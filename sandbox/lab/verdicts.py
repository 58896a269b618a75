"""How often the verdict depends on the accuracy: shots around the scene's own, run at every level."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import product
from time import perf_counter
from typing import Any

from sandbox import parameters as declared
from sandbox.engine import simulate
from sandbox.engine.accuracy import LEVELS, Accuracy
from sandbox.errors import SandboxError
from sandbox.lab.tables import paragraph, table
from sandbox.scene import Scene

#: Range of the map: fraction of the speed, and degrees to either side.
_SPEED, _ANGLE = 0.1, 5.0

#: Time in s to spend on the finest runs, and the shots along one side of the map.
_PATIENCE, _FEWEST, _MOST = 2.0, 5, 15

#: A method that would take longer than this, in s, is left out.
_TOO_LONG = 10.0

#: Results whose value is clear without its name.
_WITHOUT_NAME = ("verdict", "ended")

_PLAIN = {f"plain 1/{rate} s": replace(LEVELS["balanced"], method="plain", step=1 / rate) for rate in (60, 240)}


@dataclass(frozen=True)
class ShotMap:
    """Fraction of the shots whose verdict differs from the finest run's, by level."""

    keys: tuple[str, str]
    shots: int
    changed: dict[str, float]

    def as_dict(self) -> dict[str, Any]:
        return {"over": list(self.keys), "shots": self.shots, "changed": self.changed}

    def as_text(self) -> list[str]:
        about = f"{self.shots} shots, {self.keys[0]} within {100 * _SPEED:.0f} %, {self.keys[1]} within {_ANGLE:g} deg"
        rows = [(name, f"{100.0 * share:.1f} %") for name, share in self.changed.items()]
        return [
            *paragraph(f"verdicts that change with the accuracy ({about})", ""),
            *table(("by", "changed"), rows, "lr"),
        ]


def verdict(result: Mapping[str, Any]) -> str:
    """The verdict of a result, or else its values that are not numbers."""
    if isinstance(result.get("verdict"), str):
        return str(result["verdict"])
    words = []
    for name, value in result.items():
        if value is True:
            words.append(name)
        elif isinstance(value, str):
            words.append(value if name in _WITHOUT_NAME else f"{name} {value}")
        elif isinstance(value, list) and name != "touches" and all(isinstance(item, str) for item in value):
            words.append(" ".join([name, *value]) if value else "")
    return ", ".join(word for word in words if word)


def shot_map(scene: Scene) -> ShotMap | None:
    """Run the map; None for a scene without speed and angle to vary, or without a verdict."""
    keys = aimed_by(scene)
    if keys is None:
        return None
    finest = LEVELS["precise"].finer()
    started = perf_counter()
    if not _verdict_of(scene, finest):
        return None
    side = int((_PATIENCE / (perf_counter() - started)) ** 0.5)
    shots = list(_shots(scene, keys, max(_FEWEST, min(_MOST, side))))
    truth = [_verdict_of(shot, finest) for shot in shots]
    changed = {}
    for name, accuracy in {**LEVELS, **_PLAIN}.items():
        started = perf_counter()
        others = [_verdict_of(shots[0], accuracy)]
        if len(shots) * (perf_counter() - started) > _TOO_LONG:
            continue
        others += [_verdict_of(shot, accuracy) for shot in shots[1:]]
        changed[name] = sum(a != b for a, b in zip(truth, others, strict=True)) / len(shots)
    return ShotMap(keys, len(shots), changed)


def aimed_by(scene: Scene) -> tuple[str, str] | None:
    """The keys of speed and angle of the first group that has both, and whose speed is not zero."""
    values = {parameter.key: parameter.value for parameter in declared.walk(scene.parameters)}
    for key, value in values.items():
        group, _, last = key.rpartition(".")
        if last == "speed" and f"{group}.angle" in values and value:
            return key, f"{group}.angle"
    return None


def _shots(scene: Scene, keys: tuple[str, str], side: int) -> Iterator[Scene]:
    places = [2.0 * k / (side - 1) - 1.0 for k in range(side)]
    bounds = {parameter.key: parameter for parameter in declared.walk(scene.parameters)}
    speed, angle = (bounds[key] for key in keys)
    values = scene.parameters.model_dump()
    for p, q in product(places, places):
        changes = {
            keys[0]: _within(speed, speed.value * (1.0 + _SPEED * p)),
            keys[1]: _within(angle, angle.value + _ANGLE * q),
        }
        yield replace(scene, parameters=declared.validate(type(scene.parameters), values, scene.name, changes))


def _within(bound: declared.Parameter, value: float) -> float:
    assert bound.low is not None
    assert bound.high is not None
    return min(max(value, bound.low), bound.high)


def _verdict_of(scene: Scene, accuracy: Accuracy) -> str:
    try:
        run = simulate(scene.build(), accuracy)
    except SandboxError as error:
        return f"failed: {type(error).__name__}"
    return verdict(scene.result(run))
