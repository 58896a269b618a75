"""The number of shots that a given certainty needs: what is asked for, and the answer."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf
from typing import Any

from sandbox import units
from sandbox.errors import RequestError
from sandbox.scene import Scene
from sandbox.text import no_such_result


@dataclass(frozen=True)
class Need:
    """The number of random shots that tell a fact to within +-``within``, in 95 of 100 cases."""

    fact: str
    within: float  # a share from 0 to 1, or in the fact's unit
    shots: int


def width_of(scene: Scene, option: str, name: str, given: Any) -> float:
    """Half the width of an interval: a number in the fact's unit, or as ``"1 yd"``; of a share as 0.05 or ``"5%"``.
    Raises RequestError."""
    if name not in scene.facts:
        raise RequestError(f"{option} {name}: {no_such_result(name, list(scene.facts))}")
    unit = scene.units[name]
    try:
        width = units.parse(given, unit) if isinstance(given, str) else float(given)
    except (TypeError, ValueError) as error:
        raise RequestError(f'{option} {name}: "{given}" {error}') from None
    if not 0.0 < width < inf:
        raise RequestError(f"{option} {name}={given}: must be more than 0, and finite")
    return width


def parse_within(scene: Scene, text: str) -> tuple[str, float]:
    """``NAME=WIDTH``. Raises RequestError."""
    name, equals, body = (part.strip() for part in text.partition("="))
    if not name or not equals or not body:
        raise RequestError(f"--within {text}: write it as NAME=WIDTH, for example --within carry=1")
    return name, width_of(scene, "--within", name, body)
