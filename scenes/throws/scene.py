"""Throws from the side: the shot, how far it goes, and the angle that would have been best.

Models: gravity; drag of a sphere; lift, if chosen; a release above the ground. The best angle in the air is searched;
without air it has a closed form.
Leaves out: everything sideways; that people throw faster at flatter angles, which is why they choose 37 to 38 deg and
not the best angle for one speed (Lenz & Rappl 2010, arXiv:1007.3689); discus and javelin, which fly like wings.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from math import atan2, cos, degrees, hypot, radians, sin, sqrt

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import Accuracy
from sandbox.kit import (
    APEX,
    BALL_SPEED,
    DISTANCE,
    ENDED,
    FLIGHT_TIME,
    LANDING_ANGLE,
    LAUNCH_ANGLE,
    SOLID_SPHERE,
    Controls,
    Fact,
    Flight,
    Gravity,
    Handle,
    Release,
    Run,
    SceneRun,
    Setup,
    Sphere,
    Spread,
    Surface,
    Touches,
    before,
    group,
    level,
    quantity,
    roughly,
)


class Shot(Sphere):
    """The shot."""

    INERTIA = SOLID_SPHERE


class Parameters(Flight):
    """All parameters of a throw; x = 0 is the inner edge of the stop board."""

    release: Release = group(..., "where the shot leaves the hand")
    ball: Shot = group(..., "the shot")
    record: float = quantity(..., "m", 0, 200, "the distance to beat, marked in the sector")


CONTROLS = Controls(
    full_pull_speed=18.0,
    sliders=("launch.speed", "launch.angle", "release.height", "record", "air.density", "gravity"),
    handles=(Handle("release.place", "release.height"), Handle("record", goal=True)),
    scores="record_beaten",
    spread=(Spread("launch.speed", 0.02), Spread("launch.angle", minimum=2.0)),  # assumed
)


#: Angles in deg: between the first throws of a search for the best angle, the accuracy of that, the steepest throw; and
#: the most throws.
STEP, FINE, STEEPEST, MOST_THROWS = 5.0, 0.03, 89.0, 30


def build(parameters: Parameters) -> Setup:
    """The shot over level ground; its distance is that of its centre at height 0, so the ground lies a radius lower."""
    thrown = parameters.launched((parameters.release.place, parameters.release.height))
    ground = Surface("ground", level(-parameters.ball.radius), 0.0, 0.5)
    return Setup([thrown], [ground], 60.0, Touches("ground"))


def best_angle(run: Run, parameters: Parameters) -> float | None:
    """Angle in deg at which this speed goes farthest from this height: without air tan = v / (v^2 + 2 g h)^(1/2), else
    searched by throws at other angles. None if nothing brings the shot down."""
    ball, gravity = run.setup.balls[0], parameters.gravity
    speed = hypot(*ball.velocity)
    if gravity == 0.0 or speed == 0.0:
        return None
    vacuum = degrees(atan2(speed, sqrt(speed**2 + 2.0 * gravity * parameters.release.height)))
    if all(isinstance(force, Gravity) for force in ball.forces):
        return vacuum
    return farthest(lambda angle: _distance_at(angle, run.setup, speed, run.accuracy), vacuum)


def _distance_at(angle: float, setup: Setup, speed: float, accuracy: Accuracy) -> float:
    """The distance in m of a throw at this angle in deg."""
    velocity = speed * cos(radians(angle)), speed * sin(radians(angle))
    run = simulate(replace(setup, balls=[replace(setup.balls[0], velocity=velocity)]), accuracy)
    return before(run, run.duration).x


def farthest(distance: Callable[[float], float], angle: float) -> float | None:
    """The angle in deg at which a distance is greatest, from a first guess on: the vertex of the parabola through the
    best three angles so far, until it is within FINE of one of them."""
    known = {each: distance(each) for each in (angle - 2.0 * STEP, angle - STEP, angle)}
    for _ in range(MOST_THROWS):
        (a, at_a), (b, at_b), (c, at_c) = sorted(sorted(known.items(), key=lambda each: -each[1])[:3])
        rise, drop = at_b - at_a, at_b - at_c
        bend = (b - a) * drop + (c - b) * rise
        top = max(known, key=lambda each: known[each])
        if bend > 0.0:
            vertex = b - 0.5 * ((b - a) ** 2 * drop - (c - b) ** 2 * rise) / bend
        else:  # a slope that is not yet bent downwards
            vertex = top + (STEP if at_c > at_a else -STEP)
        vertex = min(max(vertex, top - 2.0 * STEP, -STEEPEST), top + 2.0 * STEP, STEEPEST)
        if min(abs(vertex - each) for each in known) < FINE:
            return vertex
        known[vertex] = distance(vertex)
    return None


def vacuum_distance(run: Run, parameters: Parameters) -> float | None:
    """The distance in m that the shot would go without air: a parabola."""
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
    Fact("best_angle", "best angle", "deg", best_angle, final_when="start"),
    Fact("record_beaten", "", "", lambda run, it: (DISTANCE.compute(run, it) or 0.0) > it.record, final_when="ground"),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    distance, record = run.result["distance"], parameters.record
    if distance is None:
        return "Did not come down"
    beyond = distance - record
    if abs(beyond) < 0.005:
        return f"{THROWN.text(distance)} equals the mark"
    return f"{THROWN.text(distance)}, {roughly(abs(beyond))} {'beyond' if beyond > 0.0 else 'short of'} the mark"
