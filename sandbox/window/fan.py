"""A fan: the same shot varied at random with a given spread, and the share of such shots that score."""

from __future__ import annotations

from concurrent.futures import Future
from math import sqrt

import numpy as np

from sandbox import parameters as declared
from sandbox.sport.controls import Spread
from sandbox.window.shot import Shot
from sandbox.window.worker import FanShot, varied
from sandbox.workers import Processes

SHOTS = 200
#: Spread if the scene gives none: of the speed, as a share of it, and of the angle, in deg.
SPEED, ANGLE = 0.01, 0.5
#: The spread can be made this many times wider or narrower.
WIDEST = 16.0
#: Size of the first batch of shots, and the duration of the later ones in s: a new aim must not wait for longer.
FIRST, AT_ONCE = 8, 0.05


class Fan:
    """Random variations of a shot; ``advance`` after each frame computes more of them."""

    def __init__(self, shot: Shot, width: float = 1.0) -> None:
        self.shot, self.width = shot, width
        self.known = {p.key: p for p in declared.walk(shot.scene.parameters)}
        self.spread = {key: width * sigma for key, sigma in self._sigmas().items()}
        self.draws = np.random.default_rng(1).standard_normal((SHOTS, len(self.spread)))
        self.shots: list[FanShot] = []
        self.failed = 0
        self.work: Future[tuple[list[FanShot | None], float]] | None = None
        self.next = FIRST

    def _sigmas(self) -> dict[str, float]:
        """Standard deviation of each parameter that a player does not hit exactly, in its unit."""
        controls = self.shot.scene.controls
        values = {key: parameter.value for key, parameter in self.known.items()}
        if any(values.get(key) != value for key, value in controls.also.items()):
            return {}  # the shot does not start as a player's does, so these parameters have no effect
        spread = controls.spread or (Spread(controls.speed, SPEED), Spread(controls.angle, least=ANGLE))
        sigmas = {item.key: item.sigma(values[item.key]) for item in spread if isinstance(values.get(item.key), float)}
        return {key: sigma for key, sigma in sigmas.items() if sigma > 0}

    @property
    def complete(self) -> bool:
        return len(self.shots) + self.failed >= SHOTS or not self.spread

    def advance(self, worker: Processes) -> None:
        """Take the shots that were computed, and start computing more."""
        if self.work is not None and self.work.done():
            self._take(self.work)
            self.work = None
        done = len(self.shots) + self.failed
        if self.work is None and not self.complete:
            controls = self.shot.scene.controls
            points = [self._point(draws) for draws in self.draws[done : done + self.next]]
            self.work = worker.submit(varied, self.shot.scene, list(self.spread), points, controls.fan_fact)

    def _take(self, work: Future[tuple[list[FanShot | None], float]]) -> None:
        try:
            found, seconds = work.result()
        except BaseException:  # the process was killed, and another will take its place
            self.failed += 1
            return
        good = [shot for shot in found if shot is not None]
        self.shots += good
        self.failed += len(found) - len(good)
        self.next = max(1, round(AT_ONCE * len(found) / seconds))

    def _point(self, draws: np.ndarray) -> list[float]:
        """The values of one random shot, within their bounds."""
        values = []
        for (key, sigma), draw in zip(self.spread.items(), draws, strict=True):
            low, high = self.known[key].low, self.known[key].high
            value = self.known[key].value + sigma * float(draw)
            values.append(value if low is None or high is None else min(max(value, low), high))
        return values

    def summary(self) -> tuple[str, str]:
        """How many score, and the spread of the shots."""
        count = len(self.shots)
        name = self.shot.scene.controls.scores
        if not self.spread:
            share = "no fan: this shot does not begin as a player's does"
        elif not count:
            share = "the fan ..."
        elif name:
            scored = sum(shot.scored for shot in self.shots)
            p = scored / count
            off = sqrt(p * (1 - p) / count)
            share = f"{scored} of {count} score: {100 * p:.0f} ± {max(1.0, 100 * off):.0f} %"
        else:
            share = f"{count} shots"
        fact = self.shot.scene.facts.get(self.shot.scene.controls.fan_fact)
        numbers = [shot.value for shot in self.shots if shot.value is not None]
        if fact is not None and len(numbers) > 1:
            share += f"; {fact.label} {np.mean(numbers):.1f} ± {np.std(numbers):.1f} {fact.unit}"
        parts = [
            f"{key.rpartition('.')[2]} ± {_short(sigma)} {self.known[key].unit or ''}".rstrip()
            for key, sigma in self.spread.items()
        ]
        return share, ", ".join(parts) or "nothing to vary"


def _short(sigma: float) -> str:
    """To two digits, but whole from 100 on: ``0.087``, ``370``."""
    return f"{float(f'{sigma:.2g}'):.0f}" if sigma >= 99.5 else f"{sigma:.2g}"
