"""Random surfaces that move, and a ball in their way: whether it ever passes through, and what is refused.

Run ``python benchmarks/moving.py``, with ``--count N``, ``--seed N``, ``--level L``, ``--quick`` or ``--json F``.
Segments and circles slide, swing, turn, or follow a function; surface and ball have speeds from 0.1 to 10,000 m/s, with
and without gravity. The gap between the two is computed from the place of the surface, apart from the engine, so often
that they approach by half the ball's radius at most from one time to the next. The overlap is the deepest gap
below zero, as a share of the ball's radius.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import ceil, cos, hypot, pi, sin
from random import Random
from typing import Any, NamedTuple

import numpy as np
from measured import command_line, keep, say, show, timed
from numpy.typing import NDArray

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS, resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.motion import Given, Motion, Placing, Sliding, Swinging, Turning
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Circle, Moving, Segment, Surface
from sandbox.engine.paths.run import Run
from sandbox.errors import SandboxError
from sandbox.physics.forces import Gravity

G, MASS, RADIUS = 9.81, 0.6, 0.1  # m/s^2, kg, m
KINDS = ("slides", "swings", "turns", "follows a function")
#: How far the two approach between times at which the gap is computed, in radii.
_APPROACH = 0.5
#: Above this share of the radius a ball has passed through.
LIMITS = (1e-9, 1e-6, 1e-3, 0.01)
_SHOWN = 5


@dataclass(frozen=True)
class Wobble:
    """Two harmonics of a place and one of an angle, or their derivative."""

    rate: float  # rad/s
    derivative: bool = False

    def __call__(self, t: float) -> Placing:
        rates = self.rate, 1.7 * self.rate, 0.6 * self.rate
        wave = [rate * cos(rate * t) if self.derivative else sin(rate * t) for rate in rates]
        return Placing(0.3 * wave[0], 0.2 * wave[1], 0.5 * wave[2])


class Case(NamedTuple):
    """A ball in the way of a surface that moves."""

    setup: Setup
    kind: str
    fastest: float  # m/s: of any point of the surface, at most

    @property
    def surface(self) -> Surface:
        return self.setup.surfaces[0]


def case(seed: int) -> Case:
    """The random case of this number."""
    rng = Random(seed)
    draw, kind = rng.uniform, KINDS[seed % len(KINDS)]
    speed, pace = 10.0 ** draw(-1.0, 4.0), 10.0 ** draw(-1.0, 4.0)  # m/s, of the surface and of the ball
    shape, about = random_shape(rng), (draw(-0.5, 0.5), draw(-0.5, 0.5))
    ends = [shape.center] if isinstance(shape, Circle) else [shape.a, shape.b]
    reach = max(hypot(x - about[0], y - about[1]) for x, y in ends) + shape.radius  # m
    # Close enough that a slow ball arrives before a fast surface has come round a hundred times.
    far = reach + 1.1 * RADIUS + min(2.0, 100.0 * pace / speed)  # m
    place, aside = draw(0.0, 2.0 * pi), draw(-0.35, 0.35)
    start = about[0] + far * cos(place), about[1] + far * sin(place)
    velocity = -pace * cos(place + aside), -pace * sin(place + aside)
    forces = [Gravity(MASS, G)] if pace > 5.0 and rng.random() < 0.5 else []
    ball = Ball("ball", MASS, RADIUS, start, velocity, draw(-50.0, 50.0), forces=forces)
    motion = random_motion(rng, kind, speed, about, reach, draw(0.5, 1.0) * far / pace)
    surface = Moving(Surface("blade", shape, draw(0.3, 1.0), draw(0.0, 1.0)), motion)
    return Case(Setup([ball], [surface], min(3.0 * far / pace, (far + 200.0) / speed)), kind, speed)


def random_shape(rng: Random) -> Segment | Circle:
    """A circle or a segment near the origin, up to 3 m long."""
    middle, half, lean = (rng.uniform(-0.5, 0.5), rng.uniform(-0.5, 0.5)), rng.uniform(0.3, 1.5), rng.uniform(0.0, pi)
    if rng.random() < 0.25:
        return Circle(middle, rng.uniform(0.05, 0.4))
    x, y = half * cos(lean), half * sin(lean)
    return Segment((middle[0] - x, middle[1] - y), (middle[0] + x, middle[1] + y), rng.uniform(0.0, 0.05))


def random_motion(
    rng: Random, kind: str, speed: float, about: tuple[float, float], reach: float, meets: float
) -> Motion:
    """A motion of this kind whose fastest point, within ``reach`` (m) of ``about``, has this speed (m/s) or less; one
    that slides is where it is drawn at the time ``meets`` (s)."""
    if kind == "slides":
        way = rng.uniform(0.0, 2.0 * pi)
        vx, vy = speed * cos(way), speed * sin(way)
        return Sliding((vx, vy), shift=(-vx * meets, -vy * meets))
    if kind == "swings":
        size = rng.uniform(0.1, 1.0)  # rad
        return Swinging(about, size, 2.0 * pi * size * reach / speed, rng.uniform(0.0, 6.0))
    if kind == "turns":
        return Turning(about, rng.choice((-1.0, 1.0)) * speed / reach, rng.uniform(0.0, 6.0))
    rate = speed / (0.65 + 0.3 * (reach + hypot(*about)))
    return Given(Wobble(rate), Wobble(rate, derivative=True))


class Measured(NamedTuple):
    """What a run of a case has done."""

    seed: int
    kind: str
    error: str = ""
    hits: int = 0
    overlap: float = 0.0  # as a share of the ball's radius
    overlap_at: float = 0.0  # s
    time_s: float = 0.0


def measure(seed: int, level: str = "balanced") -> Measured:
    """Run a case and measure it."""
    found = case(seed)
    try:
        spent, run = timed(simulate, found.setup, resolve(level))
    except SandboxError as error:
        return Measured(seed, found.kind, str(error))
    hits = sum(event.kind == "impact" for event in run.events)
    return Measured(seed, found.kind, "", hits, *overlapped(run, found), spent)


def overlapped(run: Run, found: Case) -> tuple[float, float]:
    """The deepest overlap as a share of the ball's radius, and when in s."""
    ends = [0.0, *sorted({event.t for event in run.events if event.t < run.duration}), run.duration]
    parts = []
    for t0, t1 in pairwise(ends):
        state = run.state("ball", t0)
        closing = hypot(state.vx, state.vy) + G * (t1 - t0) + found.fastest
        parts.append(np.linspace(t0, t1, 2 + ceil(closing * (t1 - t0) / (_APPROACH * RADIUS))))
    times = np.concatenate(parts)
    gaps = gap(run, found.surface, times)
    deepest = int(np.argmin(gaps))
    return max(0.0, -float(gaps[deepest])) / RADIUS, float(times[deepest])


def gap(run: Run, surface: Surface, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """The gap in m at each of the times, shape (n,), from where the surface is by its motion."""
    balls = np.array([complex(*state[:2]) for state in run.states("ball", times)])
    motion, shape = surface.motion, surface.shape
    assert motion is not None
    places = np.array([motion.place(t) for t in times.tolist()])
    ends = (shape.a, shape.b) if isinstance(shape, Segment) else (shape.center, shape.center)
    about, origin, turn = complex(*motion.about), places[:, 0] + 1j * places[:, 1], np.exp(1j * places[:, 2])
    a, b = (origin + turn * (complex(*end) - about) for end in ends)
    length = np.maximum(np.abs(b - a) ** 2, 1e-300)
    share = np.clip(((balls - a) * (b - a).conjugate()).real / length, 0.0, 1.0)
    return np.asarray(np.abs(balls - a - share * (b - a)) - shape.radius - RADIUS)


def report(found: Sequence[Measured]) -> None:
    """Print how many balls overlap by more than some limits, the worst of them, and what is refused."""
    whole = [each for each in found if not each.error]
    rows = [
        {
            "kind": kind,
            "cases": len(these),
            "hit": sum(each.hits > 0 for each in these),
            "hits": sum(each.hits for each in these),
            "refused": sum(each.kind == kind for each in found) - len(these),
            "deepest": max((each.overlap for each in these), default=0.0),
        }
        for kind in KINDS
        for these in [[each for each in whole if each.kind == kind]]
    ]
    columns = ("cases", "hit", "hits", "refused")
    form = {"a surface that": "{kind}", **{name: f"{{{name}:,}}" for name in columns}, "overlap": "{deepest:.1e}"}
    show(f"{len(found):,} surfaces that move", rows, form)
    above = ", ".join(f"{sum(each.overlap > limit for each in whole)} above {limit:g}" for limit in LIMITS)
    worst = sorted(whole, key=lambda each: -each.overlap)[:_SHOWN]
    show(f"overlap: {above}", [each._asdict() for each in worst], {"case": "{seed}", "overlap": "{overlap:.1e}"})
    refused = Counter(re.sub(r"-?\d[\d.e+-]*", "...", each.error) for each in found if each.error)
    say("", *(f"{count} refused: {error}" for error, count in refused.most_common()))
    say(f"{sum(each.time_s for each in whole):.0f} s of processor time")


def main() -> None:
    options: dict[str, dict[str, Any]] = {
        "--count": {"type": int, "default": 10_000},
        "--seed": {"type": int, "default": 0, "help": "number of the first case"},
        "--level": {"default": "balanced", "choices": LEVELS},
    }
    arguments = command_line(__doc__, options=options)
    count = 24 if arguments.quick else arguments.count
    found = [measure(seed, arguments.level) for seed in range(arguments.seed, arguments.seed + count)]
    report(found)
    keep(arguments.json, [each._asdict() for each in found])


if __name__ == "__main__":
    main()
