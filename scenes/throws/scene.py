"""Throws from the side: the shot, how far it goes, and the angle that would have been best.

Models: gravity; drag of a sphere; a release above the ground. Without air the best angle has a closed form.
Leaves out: everything sideways; that people throw faster at flatter angles, which is why they choose 37 to 38 deg and
not the best angle for one speed (Lenz & Rappl 2010, arXiv:1007.3689); discus and javelin, which fly like wings.
"""

from __future__ import annotations

from dataclasses import replace
from math import atan2, degrees, hypot, sqrt

from sandbox.engine.run import Run
from sandbox.engine.setup import SOLID_SPHERE, Setup, Surface, Touches
from sandbox.parameters import group, quantity
from sandbox.sport.air import NoForce
from sandbox.sport.amounts import roughly
from sandbox.sport.controls import Controls, Handle, Spread
from sandbox.sport.facts import ENDED, Fact
from sandbox.sport.flight import Flight, Release, Sphere
from sandbox.sport.readings import APEX, BALL_SPEED, DISTANCE, FLIGHT_TIME, LANDING_ANGLE, LAUNCH_ANGLE
from sandbox.sport.solids import level


class Shot(Sphere):
    """The shot."""

    INERTIA = SOLID_SPHERE
    lift: NoForce = group(NoForce(), "none")


class Parameters(Flight):
    """All parameters of a throw; x = 0 is the inner edge of the stop board."""

    release: Release = group(..., "where the shot leaves the hand")
    ball: Shot = group(..., "the shot")
    record: float = quantity(..., "m", 0, 200, "the distance to beat, marked in the sector")


CONTROLS = Controls(
    strongest=18.0,
    sliders=("launch.speed", "launch.angle", "release.height", "record", "air.density", "gravity"),
    handles=(Handle("release.place", "release.height"), Handle("record", goal=True)),
    scores="record_beaten",
    spread=(Spread("launch.speed", 0.02), Spread("launch.angle", least=2.0)),  # assumed
)


def build(parameters: Parameters) -> Setup:
    """The shot over level ground; its distance is that of its centre at height 0, so the ground lies a radius lower."""
    thrown = parameters.launched((parameters.release.place, parameters.release.height))
    ground = Surface("ground", level(-parameters.ball.radius), 0.0, 0.5)
    return Setup([thrown], [ground], 60.0, Touches("ground"))


def best_angle(run: Run, parameters: Parameters) -> float:
    """Angle in deg at which this speed goes farthest from this height, without air: tan = v / (v^2 + 2 g h)^(1/2)."""
    speed = hypot(*run.setup.balls[0].velocity)
    return degrees(atan2(speed, sqrt(speed**2 + 2.0 * parameters.gravity * parameters.release.height)))


def vacuum_distance(run: Run, parameters: Parameters) -> float | None:
    """How far in m the shot would go without air: a parabola."""
    (x, y), (vx, vy), gravity = run.setup.balls[0].position, run.setup.balls[0].velocity, parameters.gravity
    return x + vx * (vy + sqrt(vy * vy + 2.0 * gravity * y)) / gravity if gravity > 0.0 else None


#: Throws are measured to the cm.
THROWN = replace(DISTANCE, digits=2)
FACTS = (
    THROWN,
    Fact("vacuum_distance", "without air", "m", vacuum_distance, "start", also="ft", digits=2),
    APEX,
    FLIGHT_TIME,
    LANDING_ANGLE,
    BALL_SPEED,
    LAUNCH_ANGLE,
    Fact("best_angle", "best angle", "deg", best_angle, settled="start"),
    Fact("record_beaten", "", "", lambda run, it: (DISTANCE.how(run, it) or 0.0) > it.record, settled="ground"),
    ENDED,
)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
    distance, record = run.result["distance"], parameters.record
    if distance is None:
        return "Did not come down"
    beyond = distance - record
    if abs(beyond) < 0.005:
        return f"{THROWN.text(distance)} equals the mark"
    return f"{THROWN.text(distance)}, {roughly(abs(beyond))} {'beyond' if beyond > 0.0 else 'short of'} the mark"
