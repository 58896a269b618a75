"""The map of a shot: which speeds and angles around it score, everything else being equal."""

from __future__ import annotations

from time import perf_counter
from typing import NamedTuple

import numpy as np

from sandbox import parameters as declared
from sandbox.errors import RequestError
from sandbox.lab.runs import runs
from sandbox.scene import Scene
from sandbox.sport.controls import Spread
from sandbox.window.fan import ANGLE, SPEED, within

#: Half of each side, in standard deviations of what a player hits.
REACH = 15.0
#: Cells along speed and angle: at first, and three times as many, if the first took less than this time in s. Odd, so
#: that the shot itself is the middle of a cell.
COARSE, FINER, QUICK = (13, 9), 3, 0.5
#: A cell's value.
MISSED, SCORED, FAILED = 0, 1, 2


class ScoreMap(NamedTuple):
    """The outcome at each cell of a grid over speed and angle, in their units."""

    speeds: tuple[float, float]  # lowest and highest
    angles: tuple[float, float]
    units: tuple[str, str]
    cells: np.ndarray  # shape (speeds, angles)
    seconds: float  # that it took

    def holds(self, speed: float, angle: float) -> bool:
        """Whether an aim lies on the map."""
        across, up = self.place(speed, angle)
        return 0 <= across <= 1 and 0 <= up <= 1

    def place(self, speed: float, angle: float) -> tuple[float, float]:
        """Where an aim lies, as shares of both sides."""
        (slow, fast), (low, high) = self.speeds, self.angles
        return (speed - slow) / (fast - slow), (angle - low) / (high - low)

    def aim(self, across: float, up: float) -> tuple[float, float]:
        """The aim at a place."""
        (slow, fast), (low, high) = self.speeds, self.angles
        return slow + across * (fast - slow), low + up * (high - low)

    @property
    def share(self) -> float:
        """Of the cells that score."""
        return float((self.cells == SCORED).mean())


def score_map(scene: Scene, finer: int = 1) -> ScoreMap:
    """The map around a scene's own aim. Raises RequestError for a scene that does not score, or has no such aim."""
    controls, known = scene.controls, {p.key: p for p in declared.walk(scene.parameters)}
    spread = {item.key: item for item in controls.spread}
    keys, started = [controls.speed, controls.angle], perf_counter()
    if not controls.scores or any(not isinstance(getattr(known.get(key), "value", None), float) for key in keys):
        raise RequestError("no map: this scene says of no shot that it scores")
    if any(known[key].value != value for key, value in controls.also.items()):
        raise RequestError("no map: this shot does not begin as a player's does")
    usual = Spread(controls.speed, SPEED), Spread(controls.angle, least=ANGLE)
    ends, middles = [], []
    for key, other, count in zip(keys, usual, COARSE, strict=True):
        parameter = known[key]
        reach = REACH * spread.get(key, other).sigma(parameter.value)
        low, high = within(parameter, np.array([parameter.value - reach, parameter.value + reach])).tolist()
        ends.append((low, max(high, low + 1e-9)))
        shares = (np.arange(finer * count) + 0.5) / (finer * count)
        middles.append(low + shares * (high - low))
    points = np.stack(np.meshgrid(*middles, indexing="ij"), axis=-1).reshape(-1, 2)
    found = runs(scene, keys, points.tolist(), asked=[controls.scores])
    cells = [FAILED if isinstance(run, Exception) else SCORED if run.result[controls.scores] else MISSED
             for run in found]  # fmt: skip
    units = known[controls.speed].unit or "", known[controls.angle].unit or ""
    shape = finer * COARSE[0], finer * COARSE[1]
    return ScoreMap(ends[0], ends[1], units, np.array(cells, np.uint8).reshape(shape), perf_counter() - started)
