"""Rifle bullets from the side: how they drop, slow down and take their time, every hundred yards.

Models: gravity; drag by Mach number with the standard shapes and a ballistic coefficient; wind along the path; air by
weather and height above the sea; sights above the barrel, and a barrel that is zeroed for a distance.
Leaves out: everything sideways, as wind across the path and the drift of a spinning bullet; yaw and the length of the
boat tail (with 4 deg of yaw 17 % of the drag at Mach 0.82); air that thins on the way up (0.1 % in 10 m); the turning
Earth (up to 0.2 m of height at 1,000 yd); the ground.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import atan2, degrees
from typing import Literal, cast

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS
from sandbox.kit import (
    BALL_SPEED,
    DEGREE,
    ENDED,
    LAUNCH_ANGLE,
    Ball,
    Controls,
    Directed,
    Fact,
    Force,
    Gravity,
    Group,
    Handle,
    Moment,
    RequestError,
    Run,
    SceneParameters,
    SceneRun,
    Segment,
    Setup,
    Spread,
    Surface,
    Touches,
    Weather,
    amount,
    apex,
    choice,
    cos,
    fact_from,
    group,
    metres,
    passing,
    quantity,
    sin,
    wind_in,
)
from sandbox.physics.ballistics import POUND_PER_INCH, BulletDrag, drag_by_mach, speed_of_sound

MUZZLE_SPEED = replace(BALL_SPEED, label="muzzle speed")
HUNDRED_YARDS = 91.44  # m
MOA = 60.0 * degrees(1.0)  # minutes of arc in 1 rad
SIDES, HOLDS = ("low", "high"), ("under", "over")
#: Nearer than this (m) is on the line of sight; so many secants find the angle if there is one.
MET, SECANTS = 1e-9, 20


class Muzzle(Directed):
    """The bullet as it leaves the barrel."""

    speed: float = quantity(..., "m/s", 1, 1700, "muzzle speed")
    angle: float = quantity(..., "deg", -90, 90, "direction above the line of sight, if zero.distance is 0")


class BulletDragModel(Group):
    """The standard shape to which the bullet is compared."""

    model: Literal["G1", "G7", "GS"] = choice(..., "flat base, boat tail, sphere")


class Bullet(Group):
    """The bullet."""

    mass: float = quantity(..., "kg", 1e-5, 100, "mass")
    radius: float = quantity(..., "m", 0.0005, 0.2, "half the calibre")
    coefficient: float = quantity(..., "", 0.001, 10, "ballistic coefficient in lb/in^2")
    drag: BulletDragModel = group(..., "its standard shape")

    def drag_in(self, weather: Weather) -> list[Force]:
        """The force of that air on it; none without air."""
        density, sound = cast(float, weather.air.density), speed_of_sound(weather.temperature + 273.15)
        given = self.mass, self.drag.model, self.coefficient, density, sound, wind_in(weather)
        return [BulletDrag(*given)] if density > 0.0 else []


class Zero(Group):
    """The distance at which the bullet crosses the line of sight on its way down."""

    distance: float = quantity(..., "m", 0, 2000, "0: launch.angle counts instead")


class Sight(Group):
    """The sight."""

    height: float = quantity(..., "m", 0, 0.5, "above the barrel")


class Range(Group):
    """The shooting range."""

    distance: float = quantity(..., "m", 1, 5000, "from the muzzle to the target")


class Parameters(SceneParameters):
    """All parameters of a shot; x = 0 is the muzzle, and y = 0 the line of sight."""

    launch: Muzzle = group(..., "the bullet as it leaves the barrel")
    bullet: Bullet = group(..., "the bullet")
    zero: Zero = group(..., "where the sights are zeroed")
    sight: Sight = group(..., "the sight")
    range: Range = group(..., "the shooting range")
    gravity: float = quantity(..., "m/s^2", 0, 100, "gravity")
    air: Weather = group(..., "the air")


CONTROLS = Controls(
    softest=0.3,
    full_pull_speed=1000.0,
    set_on_pull={"zero.distance": 0.0},
    sliders=("bullet.coefficient", "zero.distance", "range.distance", "air.wind", "air.elevation", "air.temperature"),
    handles=(Handle("range.distance"), Handle("zero.distance")),
    spread=(Spread("launch.speed", 0.005), Spread("launch.angle", minimum=0.02)),  # assumed
)


def build(parameters: Parameters) -> Setup:
    """The bullet, and the target in which the run ends."""
    bullet = parameters.bullet
    forces = [Gravity(parameters.gravity), *bullet.drag_in(parameters.air)]
    angle = zeroed(parameters, forces) if parameters.zero.distance > 0.0 else parameters.launch.angle * DEGREE
    return _setup(parameters, forces, angle, parameters.range.distance)


def _setup(parameters: Parameters, forces: Sequence[Force], angle: float, distance: float) -> Setup:
    bullet, speed = parameters.bullet, parameters.launch.speed
    start, velocity = (0.0, -parameters.sight.height), (speed * cos(angle), speed * sin(angle))
    target = Surface("target", Segment((distance + bullet.radius, -5e3), (distance + bullet.radius, 5e3)), 0.0, 0.0)
    fired = [Ball("ball", bullet.mass, bullet.radius, start, velocity, forces=forces)]
    return Setup(fired, [target], 60.0, Touches("target"))


def zeroed(parameters: Parameters, forces: Sequence[Force]) -> float:
    """The angle in rad at which the bullet meets the line of sight where the sights are zeroed. Raises RequestError if
    it does not get there."""
    distance = parameters.zero.distance

    def height(angle: float) -> float | None:
        run = simulate(_setup(parameters, forces, angle, distance), LEVELS["precise"])
        return run.state("ball", run.duration)[1] if run.ended == "until" else None

    before, angle, miss = 0.0, 1e-3, height(0.0)
    for _ in range(SECANTS):
        missed = height(angle)
        if missed is None or miss is None:
            break
        if abs(missed) < MET or missed == miss:
            return angle
        before, angle, miss = angle, angle - missed * (angle - before) / (missed - miss), missed
    raise RequestError(f"zero.distance = {distance:g} m: the bullet does not get there")


def at_distance(run: Run, distance: float) -> Moment | None:
    """The bullet at a distance in m; None if it does not get there."""
    if distance == 0.0 or (run.ended == "until" and distance >= run.state("ball", run.duration)[0]):
        t = 0.0 if distance == 0.0 else run.duration
        return Moment(t, *run.before("ball", t))
    return passing(run, distance)


def at_target(run: Run, parameters: Parameters) -> Moment | None:
    """The bullet at the target."""
    return at_distance(run, parameters.range.distance)


def table(run: Run, parameters: Parameters) -> list[dict[str, float]]:
    """Range and height over the line of sight (m), speed (m/s) and time (s), every 100 yd."""
    places = range(int(parameters.range.distance / HUNDRED_YARDS + 1e-9) + 1)
    moments = (at_distance(run, i * HUNDRED_YARDS) for i in places)
    return [{"range": it.x, "speed": it.speed, "height": it.y, "time": it.t} for it in moments if it is not None]


def drag_coefficient(run: Run, parameters: Parameters) -> float:
    """The bullet's own, as it leaves the barrel in still air: ``Cd(M) m / (BC d^2)``, Cd(M) of the standard shape."""
    bullet = parameters.bullet
    mach = parameters.launch.speed / speed_of_sound(parameters.air.temperature + 273.15)
    density = bullet.mass / (2.0 * bullet.radius) ** 2  # kg/m^2
    return drag_by_mach(bullet.drag.model, mach) * density / (bullet.coefficient * POUND_PER_INCH)


FACTS = (
    Fact("height", "at the target", "m", fact_from(at_target, "y"), final_when="target", sides=SIDES),
    Fact("hold", "hold", "moa", fact_from(at_target, lambda it, _: -MOA * atan2(it.y, it.x)), "target", sides=HOLDS),
    Fact("speed", "speed there", "m/s", fact_from(at_target, "speed"), final_when="target", also="ft/s"),
    Fact("flight_time", "flight time", "s", fact_from(at_target, "t"), final_when="target"),
    Fact("apex", "most over sight line", "m", apex, final_when="target"),
    MUZZLE_SPEED,
    replace(LAUNCH_ANGLE, label=""),
    Fact(
        "elevation", "barrel up", "moa", lambda run, parameters: 60.0 * LAUNCH_ANGLE.compute(run, parameters), "start"
    ),
    Fact("table", "", "", table),
    Fact("drag_coefficient", "", "", drag_coefficient, "start"),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    height, distance = run.result["height"], metres(parameters.range.distance)
    if height is None:
        return f"Does not reach {distance}"
    if abs(height) < 0.0005:
        return f"On the line of sight at {distance}"
    hold = f"hold {amount(abs(run.result['hold']), 'moa')} {HOLDS[height < 0.0]}"
    return f"{amount(abs(height), 'm')} {SIDES[height > 0.0]} at {distance}: {hold}"
