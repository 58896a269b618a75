"""A bullet fired into water, from the side: how fast it slows, and how deep it is harmful. Not validated.

Models: gravity; drag by Mach number in the air; in the water quadratic drag with one coefficient, the more of it the
more of the bullet is below the surface. Then the speed falls by ``v = v0 exp(-k s)`` along the way s: it halves every
ln 2 / k, which for any speed is some decimetres, so a bullet that is twice as fast goes hardly deeper. Or, with a flat
nose, drag of that nose alone in a cavity of vapour (supercavitation), until the cavity no longer holds the bullet. The
muzzle may be under water.
Leaves out: the air that a bullet takes with it into its cavity, and slaps of its tail against the wall; tumbling,
except that the coefficient is that of a bullet which has begun to; breaking up, as fast rifle bullets do; buoyancy;
ricochet.
"""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Callable
from math import dist, exp, log, pi
from typing import Literal

from sandbox.kit import (
    ENDED,
    LAUNCH_ANGLE,
    Ball,
    Constant,
    Controls,
    Directed,
    Drag,
    Fact,
    Force,
    ForceRegion,
    Gravity,
    Group,
    Handle,
    Inside,
    Moment,
    Run,
    SceneParameters,
    SceneRun,
    Setup,
    Spread,
    Weather,
    cached_per_run,
    choice,
    fact_from,
    group,
    metres,
    one_of,
    quantity,
)
from sandbox.physics.cavity import DISC, CavityDrag, closing_cavitation

from ..bullet.scene import MUZZLE_SPEED, Bullet

FINEST = 2**40  # moments in which a speed is looked for


class Muzzle(Directed):
    """The bullet as it leaves the barrel."""

    speed: float = quantity(..., "m/s", 1, 1700, "muzzle speed")
    angle: float = quantity(..., "deg", -90, 90, "direction, below the horizontal if negative")
    height: float = quantity(..., "m", -200, 10, "of the muzzle above the water; negative under it")


class Wetted(Group):
    """Water all round the bullet."""

    model: Literal["wetted"] = choice("wetted", "what of the bullet is wet: all of it, or its nose alone")


class Cavity(Group):
    """A cavity of vapour, which the bullet's flat nose opens."""

    model: Literal["cavity"] = choice("cavity", "what of the bullet is wet: all of it, or its nose alone")
    cavitator: float = quantity(..., "m", 1e-4, 0.4, "diameter of the flat nose")
    length: float = quantity(..., "m", 0.001, 2, "of the bullet")
    vapour: float = quantity(2339.0, "Pa", 0, 20000, "pressure of the vapour")


class Water(Group):
    """The water, which fills everything below 0 m."""

    density: float = quantity(..., "kg/m^3", 100, 2000, "density")
    coefficient: float = quantity(..., "", 0.01, 5, "drag coefficient in it of a bullet that is wet all round")
    drag: Wetted | Cavity = one_of(Wetted(), "what of the bullet is wet")


class Parameters(SceneParameters):
    """All parameters of a shot; x = 0 is below the muzzle, y = 0 the surface of the water."""

    launch: Muzzle = group(..., "the bullet as it leaves the barrel")
    bullet: Bullet = group(..., "the bullet")
    water: Water = group(..., "the water")
    harmless: float = quantity(..., "m/s", 1, 300, "speed below which it does not break the skin")
    duration: float = quantity(..., "s", 1e-4, 10, "how long it is watched")
    gravity: float = quantity(..., "m/s^2", 0, 100, "gravity")
    air: Weather = group(..., "the air")


CONTROLS = Controls(
    softest=0.3,
    full_pull_speed=1000.0,
    handles=(Handle(y="launch.height"),),
    sliders=("bullet.mass", "bullet.radius", "water.coefficient", "launch.height", "harmless"),
    spread=(Spread("launch.speed", 0.02), Spread("water.coefficient", 0.3)),  # assumed
)


def halving(parameters: Parameters) -> float:
    """Way in m on which water halves any speed, by its drag alone: ln 2 / k with k = rho Cd A / (2 m); in a cavity at
    high speed."""
    bullet, water = parameters.bullet, parameters.water
    area = water.coefficient * bullet.radius**2
    if isinstance(water.drag, Cavity):
        area = DISC * 0.25 * water.drag.cavitator**2
    return log(2.0) * 2.0 * bullet.mass / (water.density * pi * area)


def cavity_drag(parameters: Parameters) -> CavityDrag | None:
    """The drag of a bullet that runs in a cavity; None for one that does not."""
    bullet, water, air = parameters.bullet, parameters.water, parameters.air
    drag, calibre = water.drag, 2.0 * bullet.radius
    if not isinstance(drag, Cavity):
        return None
    closes = closing_cavitation(calibre / drag.cavitator, drag.length / drag.cavitator)
    above_vapour = 100.0 * air.pressure * exp(-0.0001217 * air.elevation) - drag.vapour
    given = water.density, calibre, water.coefficient, drag.cavitator, closes, above_vapour, parameters.gravity
    return CavityDrag(*given)


def build(parameters: Parameters) -> Setup:
    """The bullet over the water, or in it; what acts on it in one medium acts on the part of it that is there."""
    launch, bullet, water = parameters.launch, parameters.bullet, parameters.water
    surface = (0.0, 0.0)
    wet = cavity_drag(parameters) or Drag(bullet.radius, water.density, Constant(water.coefficient))
    forces: list[Force] = [
        Gravity(parameters.gravity),
        Inside(wet, surface, (0.0, 1.0), bullet.radius, "drag of water"),
    ]
    forces += [
        Inside(dry, surface, (0.0, -1.0), bullet.radius, "drag of air") for dry in bullet.drag_in(parameters.air)
    ]
    fired = Ball("ball", bullet.mass, bullet.radius, (0.0, launch.height), launch.velocity, forces=forces)
    skin = ForceRegion(-1e4, -bullet.radius, 1e4, bullet.radius, 0.5 * bullet.radius / launch.speed)  # of the water
    return Setup([fired], duration=parameters.duration, force_regions=[skin])


def entry(run: Run, parameters: Parameters) -> Moment | None:
    """The bullet as its middle passes the surface, or as it leaves a muzzle under water."""
    if parameters.launch.height <= 0.0:
        return Moment(0.0, *run.state("ball", 0.0))
    return next((Moment(t, *state) for t, state in run.crossings("ball", (0.0, 0.0), (0.0, 1.0))), None)


def _first(run: Run, start: Moment, holds: Callable[[Moment], bool]) -> Moment | None:
    """The first moment from a start on at which something holds, which then goes on to; None if it never does."""

    def at_share(i: int) -> Moment:
        t = start.t + (run.duration - start.t) * i / FINEST
        return Moment(t, *run.state("ball", t))

    i = bisect_left(range(FINEST), True, key=lambda i: holds(at_share(i)))
    return None if i == FINEST else at_share(i)


@cached_per_run
def harmless(run: Run, parameters: Parameters) -> Moment | None:
    """The bullet where it has become harmless in the water."""
    start = entry(run, parameters)
    end = start and _first(run, start, lambda bullet: bullet.speed <= parameters.harmless)
    return end if end and end.y <= parameters.bullet.radius else None


@cached_per_run
def closing(run: Run, parameters: Parameters) -> Moment | None:
    """The bullet where its cavity closes on it; None without a cavity, and if it does not close in the water."""
    start, drag = entry(run, parameters), cavity_drag(parameters)
    if start is None or drag is None:
        return None

    def closed(bullet: Moment) -> bool:
        return bool(drag.cavitation((bullet.x, bullet.y), (bullet.vx, bullet.vy)) >= drag.closes)

    end = None if closed(start) else _first(run, start, closed)
    return end if end and end.y <= parameters.bullet.radius else None


def _way_to(end_of: Callable[[Run, Parameters], Moment | None]) -> Callable[[Run, Parameters], float | None]:
    def way(run: Run, parameters: Parameters) -> float | None:
        start, end = entry(run, parameters), end_of(run, parameters)
        return None if start is None or end is None else dist((start.x, start.y), (end.x, end.y))

    return way


FACTS = (
    Fact("penetration", "harmless after", "m", _way_to(harmless)),
    Fact("depth", "at a depth of", "m", fact_from(harmless, lambda bullet, _: -bullet.y)),
    Fact("halving", "speed halves every", "m", lambda run, parameters: halving(parameters), final_when="start"),
    Fact(
        "entry_speed",
        "into the water at",
        "m/s",
        fact_from(entry, "speed"),
        where=lambda _, parameters: parameters.launch.height > 0.0,
    ),
    Fact("cavity_way", "cavity closes after", "m", _way_to(closing)),
    Fact("cavity_speed", "cavity closes at", "m/s", fact_from(closing, "speed")),
    Fact("cavity_time", "", "s", fact_from(closing, "t")),
    Fact("flight_time", "", "s", fact_from(harmless, "t")),
    MUZZLE_SPEED,
    LAUNCH_ANGLE,
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    way, depth = run.result["penetration"], run.result["depth"]
    if way is None:
        return "Does not get into the water" if run.result["entry_speed"] is None else "Still fast at the end"
    return f"Harmless after {metres(way)} of water, {metres(depth)} deep"
