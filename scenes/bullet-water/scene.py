"""A bullet fired into water, from the side: how fast it slows, and how deep it is harmful. Not validated.

Models: gravity; drag by Mach number in the air; in the water quadratic drag with one coefficient, the more of it the
more of the bullet is below the surface. Then the speed falls by ``v = v0 exp(-k s)`` along the way s: it halves every
ln 2 / k, which for any speed is some decimetres, so a bullet that is twice as fast goes hardly deeper.
Leaves out: the cavity behind a fast bullet (supercavitation), which would carry a blunt one farther; tumbling, except
that the coefficient is that of a bullet which has begun to; breaking up, as fast rifle bullets do; buoyancy; ricochet.
"""

from __future__ import annotations

from bisect import bisect_left
from math import dist, log, pi

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
    fact_from,
    group,
    metres,
    quantity,
)

from ..bullet.scene import MUZZLE_SPEED, Bullet

FINEST = 2**40  # moments in which a speed is looked for


class Muzzle(Directed):
    """The bullet as it leaves the barrel."""

    speed: float = quantity(..., "m/s", 1, 1700, "muzzle speed")
    angle: float = quantity(..., "deg", -90, -1, "direction, below the horizontal")
    height: float = quantity(..., "m", 0.01, 10, "of the muzzle above the water")


class Water(Group):
    """The water, which fills everything below 0 m."""

    density: float = quantity(..., "kg/m^3", 100, 2000, "density")
    coefficient: float = quantity(..., "", 0.01, 5, "drag coefficient of the bullet in it")


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
    """Way in m on which water halves any speed, by its drag alone: ln 2 / k with k = rho Cd A / (2 m)."""
    bullet, water = parameters.bullet, parameters.water
    return log(2.0) * 2.0 * bullet.mass / (water.density * water.coefficient * pi * bullet.radius**2)


def build(parameters: Parameters) -> Setup:
    """The bullet over the water; what acts on it in one medium acts on the part of it that is there."""
    launch, bullet, water = parameters.launch, parameters.bullet, parameters.water
    surface = (0.0, 0.0)
    wet = Drag(bullet.radius, water.density, Constant(water.coefficient))
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
    """The bullet as its middle passes the surface."""
    return next((Moment(t, *state) for t, state in run.crossings("ball", (0.0, 0.0), (0.0, 1.0))), None)


@cached_per_run
def harmless(run: Run, parameters: Parameters) -> Moment | None:
    """The bullet where it has become harmless in the water."""
    entered = entry(run, parameters)
    if entered is None:
        return None

    def at_share(i: int) -> Moment:
        t = entered.t + (run.duration - entered.t) * i / FINEST
        return Moment(t, *run.state("ball", t))

    i = bisect_left(range(FINEST), True, key=lambda i: at_share(i).speed <= parameters.harmless)
    return None if i == FINEST else at_share(i)


def _way(run: Run, parameters: Parameters) -> float | None:
    start, end = entry(run, parameters), harmless(run, parameters)
    return None if start is None or end is None else dist((start.x, start.y), (end.x, end.y))


FACTS = (
    Fact("penetration", "harmless after", "m", _way),
    Fact("depth", "at a depth of", "m", fact_from(harmless, lambda bullet, _: -bullet.y)),
    Fact("halving", "speed halves every", "m", lambda run, parameters: halving(parameters), final_when="start"),
    Fact("entry_speed", "into the water at", "m/s", fact_from(entry, "speed")),
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
