"""The scatter of a practised player: parameters that are not hit exactly, each with its standard deviation."""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

from sandbox.parameters import Parameter, walk
from sandbox.scene import Scene
from sandbox.sport.controls import Spread

if TYPE_CHECKING:
    import numpy as np

#: Spread if the scene gives none: of the speed, as a share of it, and of the angle, in deg.
SPEED, ANGLE = 0.01, 0.5


def players_spread(scene: Scene, width: float = 1.0) -> dict[str, tuple[Parameter, float]]:
    """Each parameter that a player does not hit exactly, and its standard deviation, ``width`` times the usual one;
    none where the shot does not start as a player's does."""
    controls, known = scene.controls, {p.key: p for p in walk(scene.parameters)}
    if any(known[key].value != value for key, value in controls.set_on_pull.items()):
        return {}  # these parameters have no effect
    spread = controls.spread or (Spread(controls.speed, SPEED), Spread(controls.angle, minimum=ANGLE))
    varied = [(known[item.key], item) for item in spread if item.key in known]
    sigmas = [
        (p, width * (known[item.sd].value if item.sd else item.sigma(p.value)))
        for p, item in varied
        if isinstance(p.value, float)
    ]
    return {p.key: (p, sigma) for p, sigma in sigmas if sigma > 0}


def scattered(
    scene: Scene, random: np.random.Generator, width: float = 1.0, keys: Collection[str] | None = None
) -> dict[str, float]:
    """The values of these parameters in one shot of a player with ``width`` times the usual scatter; only those among
    ``keys`` if given."""
    return {
        key: known.within(float(random.normal(known.value, sd)))
        for key, (known, sd) in players_spread(scene, width).items()
        if keys is None or key in keys
    }
