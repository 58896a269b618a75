"""The extremes of the stress test: those of each scene's parameters, and setups without a scene for other cases."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from math import nan, pi
from typing import Any, NamedTuple

from sandbox import parameters as declared
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball, Force
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.shapes import Vector
from sandbox.engine.model.surface import Bounce, Circle, ConstantBounce, Segment, Surface
from sandbox.errors import RequestError
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity, Magnus
from sandbox.physics.integrators import INTEGRATORS
from sandbox.scene import Scene

#: Steps in s at which fixed-step methods are tested.
STEPS = (1e-5, 1e-4, 1e-3, 1 / 60, 0.1, 0.5)

#: Most steps of a run at a short step.
_MOST_STEPS = 1_500

#: Simulated time in s after which a run is ended; one hour is an extreme of its own.
_LONGEST, HOUR = 10.0, 3600.0


def controls_error(how: Accuracy) -> bool:
    """True if the integrator chooses its steps."""
    return how.method == "exact" and INTEGRATORS[how.integrator].controls_error


class Extreme(NamedTuple):
    """One row, for the methods that it suits. ``build`` raises RequestError if the scene refuses; ``step`` (s) replaces
    that of the method. What does not make sense must be refused, and is counted apart."""

    name: str
    build: Callable[[], Setup]
    suits: Callable[[Accuracy], bool] = lambda how: True
    step: float | None = None
    makes_sense: bool = True


def of_scene(scene: Scene) -> Iterator[Extreme]:
    """Each number of the scene at its lowest and its highest, all of them, and its own setup at extreme steps."""
    numbers = [
        p
        for p in declared.walk(scene.parameters)
        if p.low is not None and not isinstance(p.value, list) and not p.key.startswith("accuracy.")
    ]
    own = scene.build()
    for p in numbers:
        for bound in (p.low, p.high):
            extreme = _changed(scene, f"{p.key} {bound:g} {p.unit}".rstrip(), {p.key: _alike(p.value, bound)})
            if not _is_built(extreme, own):
                yield extreme
    set_numbers = [p for p in numbers if p.value is not None]
    yield _changed(scene, "all numbers at their lowest", {p.key: _alike(p.value, p.low) for p in set_numbers})
    yield _changed(scene, "all numbers at their highest", {p.key: _alike(p.value, p.high) for p in set_numbers})
    yield Extreme("an hour", lambda: replace(scene.build(), duration=HOUR, until=None), controls_error)
    for step in STEPS:
        ended = _ended(own, min(_LONGEST, _MOST_STEPS * step))
        yield Extreme(f"step {step:.3g} s", lambda ended=ended: ended, lambda how: not controls_error(how), step)  # type: ignore[misc]


def _alike(value: Any, number: Any) -> Any:
    """The number, or as many of it as a vector has."""
    return [number] * len(value) if isinstance(value, tuple) else number


def _changed(scene: Scene, name: str, changes: dict[str, Any]) -> Extreme:
    return Extreme(name, lambda: _ended(scene.changed(changes).build(), _LONGEST))


def _is_built(extreme: Extreme, own: Setup) -> bool:
    """True if it is the scene's own setup: its number is one that this shot does not need."""
    try:
        return extreme.build() == _ended(own, _LONGEST)
    except RequestError:
        return False


def _ended(setup: Setup, time: float) -> Setup:
    return replace(setup, duration=min(setup.duration, time))


# ------------------------------------------------------------------------------------------ setups without a scene

_FLOOR = Segment((-50.0, 0.0), (50.0, 0.0))
_BOX = [(-5.0, 0.0), (5.0, 0.0), (5.0, 10.0), (-5.0, 10.0), (-5.0, 0.0)]


def setups_without_scene() -> Iterator[Extreme]:
    """Extremes that no scene's parameters can express."""
    yield Extreme("wall of 0.1 mm at 340 m/s", lambda: _against_walls(0.00005, 0.02))
    yield Extreme("wall of no thickness, ball of 1 mm", lambda: _against_walls(0.0, 0.001))
    yield Extreme("into a corner of 90 deg", lambda: _into_corner(1.0))
    yield Extreme("into a corner of 10 deg", lambda: _into_corner(0.1763))
    for ratio in (100.0, 1e4, 1e6):
        yield Extreme(f"mass ratio {ratio:g}", lambda ratio=ratio: _galperin(ratio))  # type: ignore[misc]
    yield Extreme("rack of 15 that touch", lambda: _rack(0.0))
    yield Extreme("rack of 15, gaps of 0.1 um", lambda: _rack(1e-7))
    on_floor = partial(_lone, {"floor": _FLOOR}, (0.8, 0.5), 1.0, 0.1)
    yield Extreme("start half inside a wall", lambda: on_floor((0.0, 0.05)), makes_sense=False)
    yield Extreme("start 1 % inside a wall", lambda: on_floor((0.0, 0.099)))
    pair = [Ball(name, 1.0, 0.1, (0.0, 0.0)) for name in ("a", "b")]
    yield Extreme("two balls in one place", lambda: Setup(pair), makes_sense=False)
    sides = {f"side {k}": Segment(*ends) for k, ends in enumerate(pairwise(_BOX))}
    boxed = partial(_lone, sides, (1.0, 0.0), 0.4, 0.11, (0.0, 5.0), (4.0, 3.0), duration=HOUR)
    yield Extreme("an hour in a box, no loss", boxed, controls_error)
    post: dict[str, Segment | Circle] = {"floor": _FLOOR, "post": Circle((1.0, 0.5), 0.01)}
    spinning = partial(_lone, post, (0.9, 10.0), 0.05, 0.02, (0.0, 1.0), (2.0, 0.0), 20_000.0 * pi / 30.0)
    yield Extreme("20,000 rpm, friction 10", spinning)
    yield Extreme("a bullet in water", _bullet)
    forced = partial(_lone, {"floor": _FLOOR}, (0.8, 0.5), 1.0, 0.1, (0.0, 2.0), (1.0, 0.0), 0.0)
    not_a_number = partial(forced, [lambda t, position, velocity, spin: (nan, 0.0)])
    yield Extreme("a force that is not a number", not_a_number, makes_sense=False)
    yield Extreme("a force with a pole", lambda: forced([_with_a_pole]), makes_sense=False)
    yield Extreme("drag that reverses the motion", lambda: forced([_wrong_drag]))
    yield Extreme("1,000 balls in a pile", _heap, lambda how: how.method == "plain")


def _lone(
    met: Mapping[str, Segment | Circle],
    bounce: tuple[float, float],
    mass: float,
    radius: float,
    position: Vector,
    velocity: Vector = (0.0, 0.0),
    spin: float = 0.0,
    forces: Sequence[Force] | None = None,
    duration: float = 2.0,
) -> Setup:
    """A ball, with its weight unless ``forces`` are given, and what it meets, of that restitution and friction."""
    own = [Gravity(9.81)] if forces is None else forces
    surfaces = [Surface(name, shape, *bounce) for name, shape in met.items()]
    return Setup([Ball("ball", mass, radius, position, velocity, spin, forces=own)], surfaces, duration=duration)


def _against_walls(half: float, radius: float) -> Setup:
    walls = [Surface("wall", Segment((x, -1.0), (x, 1.0), half), 1.0, 0.5) for x in (-1.0, 1.0)]
    return Setup([Ball("ball", 0.05, radius, (0.0, 0.0), (340.0, 0.0))], walls, duration=1.0)


def _into_corner(slope: float) -> Setup:
    """At 10 m/s straight into the corner of the floor and a wall that rises by ``slope``, from the right."""
    sides = {"floor": Segment((0.0, 0.0), (10.0, 0.0)), "wall": Segment((0.0, 0.0), (10.0, 10.0 * slope))}
    rise = ((1.0 + slope * slope) ** 0.5 - 1.0) / slope  # of the bisector of the corner
    return _lone(sides, (0.9, 0.3), 0.1, 0.05, (9.0, 9.0 * rise), (-10.0, -10.0 * rise))


def _galperin(ratio: float) -> Setup:
    """Two balls and a wall without loss: the number of impacts has the digits of pi (Galperin 2003)."""
    balls = [Ball("light", 1.0, 0.1, (1.0, 0.0)), Ball("heavy", ratio, 0.1, (2.0, 0.0), (-1.0, 0.0))]
    return Setup(balls, [Surface("wall", Segment((0.0, -1.0), (0.0, 1.0)), 1.0, 0.0)], duration=10.0)


def _rack(gap: float) -> Setup:
    radius = 0.0286
    pitch = 2.0 * radius + gap
    spots = [(0.5 * 3**0.5 * pitch * row, pitch * (k - 0.5 * row)) for row in range(5) for k in range(row + 1)]
    balls = [Ball("cue", 0.17, radius, (-1.0, 0.0), (8.0, 0.1))]
    balls += [Ball(f"{k}", 0.17, radius, spot) for k, spot in enumerate(spots, 1)]
    return Setup(balls, duration=1.0, between_balls=ConstantBounce(Bounce(0.95, 0.05)))


def _bullet() -> Setup:
    """9 mm and 8 g at 340 m/s: water halves its speed within 35 cm."""
    radius, density = 0.0045, 1000.0
    drag, lift = Drag(radius, density, Constant(0.5)), Magnus(radius, density, Constant(0.1))
    forces: list[Force] = [Gravity(9.81), drag, lift]
    return _lone({}, (0.0, 0.0), 0.008, radius, (0.0, 1.0), (340.0, 0.0), 100.0, forces, duration=5.0)


def _with_a_pole(t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
    """Endless at a height of 1 m."""
    return 0.0, -1.0 / (position[1] - 1.0) ** 3


def _wrong_drag(t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
    """Far stiffer than any step: the speed falls by 1/e in 0.1 ms."""
    return -1e4 * velocity[0], -1e4 * velocity[1]


def _heap() -> Setup:
    """Balls of 2 cm that fall into a box."""
    walls = [((-0.7, 0.0), (0.7, 0.0)), ((-0.7, 0.0), (-0.7, 3.0)), ((0.7, 0.0), (0.7, 3.0))]
    surfaces = [Surface(f"side {k}", Segment(a, b, 0.02), 0.5, 0.4) for k, (a, b) in enumerate(walls)]
    weight = [Gravity(9.81)]
    spots = [(-0.65 + 0.026 * (k % 50) + 0.001 * (k // 50 % 2), 0.05 + 0.03 * (k // 50)) for k in range(1000)]
    balls = [Ball(f"{k}", 0.005, 0.01, spot, forces=weight) for k, spot in enumerate(spots)]
    return Setup(balls, surfaces, duration=0.5, between_balls=ConstantBounce(Bounce(0.5, 0.3)))
