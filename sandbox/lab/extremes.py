"""The extremes of the stress test: those of each scene's parameters, and setups without a scene for other cases."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from itertools import pairwise
from math import inf, nan, pi
from typing import Any, NamedTuple

from sandbox import parameters as declared
from sandbox.engine.setup import Ball, Bounce, Circle, Force, Segment, Setup, Surface
from sandbox.lab.ablation import with_changes
from sandbox.lab.verdicts import aimed_by
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity, Magnus
from sandbox.scene import Scene

#: Steps in s at which fixed-step methods are tested.
STEPS = (1e-5, 1e-4, 1e-3, 1 / 60, 0.1, 0.5)

#: Most steps of a run at a short step.
_MOST_STEPS = 1_500

#: Simulated time in s after which a run is ended; one hour is an extreme of its own.
_LONGEST, HOUR = 10.0, 3600.0

#: The methods that an extreme applies to.
ALL, EXACT, ERROR_CONTROL, PLAIN, FIXED_STEP = "all", "exact", "error control", "plain", "fixed step"


class Extreme(NamedTuple):
    """One row. ``build`` raises RequestError if the scene refuses; ``step`` (s) replaces that of the method."""

    name: str
    build: Callable[[], Setup]
    methods: str = ALL
    step: float | None = None


def of_scene(scene: Scene) -> Iterator[Extreme]:
    """Every extreme of the scene's parameters, and its own setup at extreme steps."""
    for name, changes in _changes(scene):

        def build(changes: Mapping[str, Any] = changes) -> Setup:
            return _ended(with_changes(scene, dict(changes)).build(), _LONGEST)

        yield Extreme(name, build)

    yield Extreme("an hour", lambda: replace(scene.build(), duration=HOUR, until=None), ERROR_CONTROL)
    for step in STEPS:

        def at_step(step: float = step) -> Setup:
            return _ended(scene.build(), min(_LONGEST, _MOST_STEPS * step))

        yield Extreme(f"step {step:.3g} s", at_step, FIXED_STEP, step)


def _changes(scene: Scene) -> Iterator[tuple[str, dict[str, Any]]]:
    keys = {parameter.key: parameter for parameter in declared.walk(scene.parameters)}
    aim = aimed_by(scene)
    if aim is not None:
        speed, angle = aim
        for value in (340.0, 30.0, 1e-9, 0.0):
            yield f"speed {value:g} m/s", {speed: value}
        for value in (90.0, 180.0, -90.0):
            yield f"angle {value:g} deg", {angle: value}
    if "launch.spin" in keys:
        for value in (20_000.0, -20_000.0):
            yield f"spin {value:g} rpm", {"launch.spin": value}
    masses = [key for key in keys if key.endswith(".mass")]
    if "ball.mass" in masses:
        for name, own, others in (("lightest", -inf, inf), ("heaviest", inf, -inf)):
            yield f"{name} ball", {k: _within(keys[k], own if k == "ball.mass" else others) for k in masses}
    for part, values in (("restitution", (0.0, 1.0)), ("friction", (0.0, 10.0)), ("resistance", (0.0, 10.0))):
        for value in values:
            changes = _alike(scene, part, value)
            if changes:
                yield f"{part} {value:g}", changes
    if "air.density" in keys:
        for value in (0.0, 1000.0):
            yield f"density {value:g} kg/m3", {"air.density": value}
        if aim is not None:
            yield "a bullet in water", {"air.density": 1000.0, aim[0]: 340.0}
        for wind in ((100.0, 0.0), (-100.0, 0.0), (0.0, 100.0), (-70.0, -70.0)):
            yield f"wind {wind[0]:g}, {wind[1]:g} m/s", {"air.wind": wind}
    if "gravity" in keys:
        for value in (0.0, 25.0):
            yield f"gravity {value:g} m/s2", {"gravity": value}
    if "ball.radius" in keys:
        for value in (0.001, 1.0):
            yield f"ball of {value:g} m", {"ball.radius": value}
    walls = [k for k in keys if k.endswith(("thickness", "tube_radius", "post_radius", "jaw_radius"))]
    if walls:
        yield "walls of 0.1 mm", dict.fromkeys(walls, 1e-4)
        yield "walls as thin as allowed", {key: _within(keys[key], -inf) for key in walls}
        if aim is not None:
            fastest = _within(keys[aim[0]], inf)
            yield "thin walls, full speed", {**{k: _within(keys[k], -inf) for k in walls}, aim[0]: fastest}
    for key in keys:
        if key.endswith("gap") and keys[key].unit == "m" and "." not in key:
            yield "a tight rack", {key: keys[key].low}
    numbers = [p for p in keys.values() if p.low is not None and isinstance(p.value, float) and "accuracy" not in p.key]
    yield "all numbers at their lowest", {p.key: p.low for p in numbers}
    yield "all numbers at their highest", {p.key: p.high for p in numbers}


def _alike(scene: Scene, part: str, value: float) -> dict[str, Any]:
    """Every number whose key ends in ``part`` set to ``value``, within its bounds."""
    return {p.key: _within(p, value) for p in declared.walk(scene.parameters) if p.key.endswith(part) and _is_number(p)}


def _is_number(parameter: declared.Parameter) -> bool:
    return parameter.low is not None and isinstance(parameter.value, float)


def _within(parameter: declared.Parameter, value: float) -> float:
    assert parameter.low is not None
    assert parameter.high is not None
    return min(max(value, parameter.low), parameter.high)


def _ended(setup: Setup, time: float) -> Setup:
    return replace(setup, duration=min(setup.duration, time))


# ------------------------------------------------------------------------------------------------------- bare setups

_BOX = ((-5.0, 0.0), (5.0, 0.0), (5.0, 10.0), (-5.0, 10.0), (-5.0, 0.0))


def bare() -> Iterator[Extreme]:
    """Extremes that no scene's parameters can express."""
    yield Extreme("wall of 0.1 mm at 340 m/s", lambda: _against_wall(0.00005, 0.02, 340.0))
    yield Extreme("wall of no thickness, ball of 1 mm", lambda: _against_wall(0.0, 0.001, 340.0))
    yield Extreme("into a corner of 90 deg", lambda: _into_corner(10.0, 1.0))
    yield Extreme("into a corner of 10 deg", lambda: _into_corner(10.0, 0.1763))
    for ratio in (100.0, 1e4, 1e6):
        yield Extreme(f"mass ratio {ratio:g}", lambda ratio=ratio: _galperin(ratio))  # type: ignore[misc]
    yield Extreme("rack of 15 that touch", lambda: _rack(0.0))
    yield Extreme("rack of 15, gaps of 0.1 um", lambda: _rack(1e-7))
    yield Extreme("start half inside a wall", lambda: _overlapping(0.5))
    yield Extreme("start 1 % inside a wall", lambda: _overlapping(0.99))
    yield Extreme("two balls in one place", _coinciding)
    yield Extreme("an hour in a box, no loss", lambda: replace(_boxed(1.0), duration=HOUR), ERROR_CONTROL)
    yield Extreme("20,000 rpm, friction 10", lambda: _spinning(20_000.0, 10.0))
    yield Extreme("a bullet in water", _bullet)
    yield Extreme("a force that is not a number", lambda: _forced(lambda t, position, velocity, spin: (nan, 0.0)))
    yield Extreme(
        "a force with a pole", lambda: _forced(lambda t, position, velocity, spin: (0.0, -1.0 / position[1] ** 3))
    )
    yield Extreme("drag that reverses the motion", lambda: _forced(_wrong_drag))
    yield Extreme("1,000 balls in a pile", _heap, PLAIN)


def _lone(ball: Ball, surfaces: list[Surface], duration: float = 2.0) -> Setup:
    return Setup([ball], surfaces, duration=duration)


def _against_wall(half: float, radius: float, speed: float) -> Setup:
    walls = [Surface("wall", Segment((x, -1.0), (x, 1.0), half), 1.0, 0.5) for x in (-1.0, 1.0)]
    return _lone(Ball("ball", 0.05, radius, (0.0, 0.0), (speed, 0.0)), walls, 1.0)


def _into_corner(speed: float, slope: float) -> Setup:
    """Straight into the corner of the floor and a wall that rises by ``slope``, from the right."""
    sides = [Segment((0.0, 0.0), (10.0, 0.0)), Segment((0.0, 0.0), (10.0, 10.0 * slope))]
    surfaces = [Surface(f"side {k}", side, 0.9, 0.3) for k, side in enumerate(sides)]
    rise = ((1.0 + slope * slope) ** 0.5 - 1.0) / slope  # of the bisector of the corner
    ball = Ball("ball", 0.1, 0.05, (9.0, 9.0 * rise), (-speed, -speed * rise), forces=[Gravity(0.1, 9.81)])
    return _lone(ball, surfaces)


def _galperin(ratio: float) -> Setup:
    """Two balls and a wall without loss: the number of impacts has the digits of pi (Galperin 2003)."""
    balls = [Ball("light", 1.0, 0.1, (1.0, 0.0)), Ball("heavy", ratio, 0.1, (2.0, 0.0), (-1.0, 0.0))]
    return Setup(balls, [Surface("wall", Segment((0.0, -1.0), (0.0, 1.0)), 1.0, 0.0)], duration=10.0)


def _rack(gap: float) -> Setup:
    radius = 0.0286
    pitch = 2.0 * radius + gap
    balls = [Ball("cue", 0.17, radius, (-1.0, 0.0), (8.0, 0.1))]
    for row in range(5):
        for place in range(row + 1):
            at = (0.5 * 3**0.5 * pitch * row, pitch * (place - 0.5 * row))
            balls.append(Ball(f"{row}-{place}", 0.17, radius, at))
    return Setup(balls, duration=1.0, between_balls=lambda normal, slip: Bounce(0.95, 0.05))


def _overlapping(height: float) -> Setup:
    """A ball whose centre is ``height`` radii above the floor."""
    floor = Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 0.8, 0.5)
    return _lone(Ball("ball", 1.0, 0.1, (0.0, 0.1 * height), forces=[Gravity(1.0, 9.81)]), [floor])


def _coinciding() -> Setup:
    return Setup([Ball("one", 1.0, 0.1, (0.0, 0.0)), Ball("other", 1.0, 0.1, (0.0, 0.0))], duration=1.0)


def _boxed(restitution: float) -> Setup:
    sides = [Segment(a, b) for a, b in pairwise(_BOX)]
    walls = [Surface(f"side {k}", side, restitution, 0.0) for k, side in enumerate(sides)]
    ball = Ball("ball", 0.4, 0.11, (0.0, 5.0), (4.0, 3.0), forces=[Gravity(0.4, 9.81)])
    return _lone(ball, walls)


def _spinning(rpm: float, friction: float) -> Setup:
    floor = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.9, friction)
    post = Surface("post", Circle((1.0, 0.5), 0.01), 0.9, friction)
    ball = Ball("ball", 0.05, 0.02, (0.0, 1.0), (2.0, 0.0), rpm * pi / 30.0, forces=[Gravity(0.05, 9.81)])
    return _lone(ball, [floor, post])


def _bullet() -> Setup:
    """9 mm and 8 g at 340 m/s: water halves its speed within 35 cm."""
    radius, density = 0.0045, 1000.0
    drag, lift = Drag(radius, density, Constant(0.5)), Magnus(radius, density, Constant(0.1))
    forces: list[Force] = [Gravity(0.008, 9.81), drag, lift]
    return _lone(Ball("ball", 0.008, radius, (0.0, 1.0), (340.0, 0.0), 100.0, forces=forces), [], 5.0)


def _forced(force: Callable[..., tuple[Any, Any]]) -> Setup:
    floor = Surface("floor", Segment((-5.0, -1.0), (5.0, -1.0)), 0.8, 0.5)
    return _lone(Ball("ball", 1.0, 0.1, (0.0, 1.0), (1.0, 0.0), forces=[force]), [floor])


def _wrong_drag(t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
    """Far stiffer than any step: the speed falls by 1/e in 0.1 ms."""
    return -1e4 * velocity[0], -1e4 * velocity[1]


def _heap() -> Setup:
    """Balls of 2 cm that fall into a box."""
    walls = [((-0.7, 0.0), (0.7, 0.0)), ((-0.7, 0.0), (-0.7, 3.0)), ((0.7, 0.0), (0.7, 3.0))]
    surfaces = [Surface(f"side {k}", Segment(a, b, 0.02), 0.5, 0.4) for k, (a, b) in enumerate(walls)]
    gravity = Gravity(0.005, 9.81)
    balls = [
        Ball(
            f"{k}",
            0.005,
            0.01,
            (-0.65 + 0.026 * (k % 50) + 0.001 * (k // 50 % 2), 0.05 + 0.03 * (k // 50)),
            forces=[gravity],
        )
        for k in range(1000)
    ]
    return Setup(balls, surfaces, duration=0.5, between_balls=lambda normal, slip: Bounce(0.5, 0.3))
