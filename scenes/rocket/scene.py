"""Rockets from the side: up from a rail, or out of a tube at a target; how high, how far, how fast.

Models: thrust by a measured curve; mass that falls as propellant burns; gravity; drag with one coefficient, in air that
thins on the way up; wind, into which the nose turns; a pad on which the rocket stands until its thrust exceeds its
weight, and a rail without friction that guides it at first.
Leaves out: swinging about the direction of flight and what it costs; the speed of sound, so it holds below Mach 0.8;
less drag while the motor burns; parachutes. All of it together is 3 % of the height of the one flight that was
measured.
"""

from __future__ import annotations

from itertools import pairwise
from math import hypot

from sandbox.kit import (
    DEGREE,
    ENDED,
    Air,
    Ball,
    Controls,
    Directed,
    Fact,
    Force,
    Gravity,
    Group,
    Handle,
    Moment,
    NoForce,
    RequestError,
    Run,
    SceneParameters,
    SceneRun,
    Segment,
    Setup,
    Sphere,
    Spread,
    Surface,
    Touches,
    anywhere,
    below,
    check_apart,
    cos,
    disc,
    fact_from,
    forces_in_flight,
    group,
    level,
    quantity,
    roughly,
    sin,
    vectors,
    where,
    wind_in,
)
from sandbox.physics.forces import Thinning
from sandbox.physics.rocket import Motor, Thrust


class Start(Directed):
    """The rocket on its rail, or as it leaves a tube."""

    speed: float = quantity(..., "m/s", 0, 270, "speed at the start")
    angle: float = quantity(..., "deg", 1, 179, "of rail or tube above the horizontal")
    height: float = quantity(..., "m", 0.1, 100, "of the rocket above the ground")
    rail: float = quantity(..., "m", 0.01, 20, "length of the rail")


class Solid(Group):
    """A solid motor."""

    curve: list[tuple[float, float]] = vectors(..., 2, "", 0, 1e6, "time in s and thrust in N, point by point")
    propellant: float = quantity(..., "kg", 1e-9, 100, "what burns")
    strength: float = quantity(..., "", 0.01, 10, "of so many such motors")


class Rocket(Sphere):
    """The rocket."""

    mass: float = quantity(..., "kg", 0.001, 1000, "mass at the start, propellant included")
    lift: NoForce = group(NoForce(), "none")


class Parameters(SceneParameters):
    """All parameters of a flight; x = 0 is the start."""

    launch: Start = group(..., "rail or tube")
    motor: Solid = group(..., "the motor")
    ball: Rocket = group(..., "the rocket")
    duration: float = quantity(..., "s", 0.01, 300, "longest flight: until ejection or self-destruction")
    gravity: float = quantity(..., "m/s^2", 0, 100, "gravity")
    air: Air = group(..., "the air")


#: Height in m above the pad up to which a rocket has not left it.
LIFTED = 1e-6

CONTROLS = Controls(
    ball="rocket",
    speed="motor.strength",
    softest=0.5,
    full_pull_speed=2.0,
    handles=(Handle(y="launch.height"),),
    sliders=("motor.propellant", "ball.mass", "ball.drag.coefficient", "launch.rail", "air.wind", "gravity"),
    spread=(Spread("launch.angle", minimum=2.0), Spread("ball.mass", 0.02)),  # assumed
)


def motor_of(parameters: Parameters) -> Motor:
    """Raises RequestError for a curve that is none."""
    curve, strength = parameters.motor.curve, parameters.motor.strength
    propellant = strength * parameters.motor.propellant
    times, thrusts = zip(*curve, strict=True) if curve else ((), ())
    if not any(thrusts) or any(before >= after for before, after in pairwise(times)) or len(times) < 2:
        raise RequestError("motor.curve: needs two points or more, each later than the last, and some thrust")
    if anywhere(propellant >= parameters.ball.mass):
        raise RequestError("motor.propellant: must be less than ball.mass, of which it is a part")
    return Motor(times, [strength * thrust for thrust in thrusts], propellant)


def build(parameters: Parameters) -> Setup:
    """The rocket on its rail, over level ground. Raises RequestError if it is in the ground."""
    launch, rocket, motor = parameters.launch, parameters.ball, motor_of(parameters)
    held = disc("the rocket", ("launch.height", "ball.radius"), 0.0, launch.height, rocket.radius)
    check_apart(parameters, held, below("the ground"))
    start, ex, ey = (0.0, launch.height), cos(launch.angle * DEGREE), sin(launch.angle * DEGREE)
    thrust = Thrust(motor, start, (ex, ey), launch.rail, wind_in(parameters.air))
    weight = Gravity(parameters.gravity, rocket.mass, loss=motor)
    forces: list[Force] = [weight, *map(Thinning, forces_in_flight(rocket, parameters.air)), thrust]
    flying = Ball("rocket", rocket.mass, rocket.radius, start, launch.velocity, forces=forces, loss=motor)
    side = where(launch.angle <= 90.0, rocket.radius, -rocket.radius)

    def at(along: float, aside: float) -> tuple[float, float]:
        """A place along the rail from the start, and towards it, in m."""
        return aside * ey + along * ex, launch.height - aside * ex + along * ey

    foot = at(-rocket.radius, side)
    rail = Surface("rail", Segment(foot, at(launch.rail, side)), 0.0, 0.0)
    pad = Surface("pad", Segment(foot, at(-rocket.radius, -2.0 * side)), 0.0, 1.0, rolling_resistance=1.0)  # assumed
    ground = Surface("ground", level(), 0.0, 0.5)
    return Setup([flying], [ground, rail, pad], parameters.duration, Touches("ground"))


def top_speed(run: Run, parameters: Parameters) -> float:
    """In m/s; it is reached where a step ends, as the thrust gives way."""
    return max(hypot(*state[2:4]) for _, state in run.ends("rocket"))


def burnout(run: Run, parameters: Parameters) -> Moment | None:
    """The rocket when its motor has burnt out; None if the flight is over before."""
    t = parameters.motor.curve[-1][0]
    return Moment(t, *run.state("rocket", t)) if t <= run.duration else None


FACTS = (
    Fact("apex", "apex", "m", lambda run, parameters: run.highest("rocket")[1][1], final_when="ground", also="ft"),
    Fact("apex_time", "apex after", "s", lambda run, parameters: run.highest("rocket")[0], final_when="ground"),
    Fact("top_speed", "top speed", "m/s", top_speed, final_when="ground", also="mph"),
    Fact("distance", "distance", "m", lambda run, parameters: run.before("rocket", run.duration)[0]),
    Fact("flight_time", "flight time", "s", lambda run, parameters: run.duration),
    Fact("end_speed", "speed at the end", "m/s", lambda run, _: Moment(0.0, *run.before("rocket", run.duration)).speed),
    Fact("burnout_speed", "at burnout", "m/s", fact_from(burnout, "speed")),
    Fact("burnout_height", "", "m", fact_from(burnout, "y")),
    Fact("impulse", "impulse", "N s", lambda run, parameters: motor_of(parameters).impulse, final_when="start"),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    if not parameters.launch.speed and run.result["apex"] <= parameters.launch.height + LIFTED:
        motor, weight = motor_of(parameters), parameters.ball.mass * parameters.gravity
        return f"its motor never lifts it: {max(motor.thrusts):.3g} N at most, and it weighs {weight:.3g} N"
    high, far = roughly(run.result["apex"]), roughly(abs(run.result["distance"]))
    return f"{high} high, {'down ' * (run.ended == 'until')}{far} away after {run.duration:.1f} s"
