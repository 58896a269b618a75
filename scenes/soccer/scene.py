"""Soccer in side view: a free kick over the wall and under the bar, or a kick up the field.

Models: gravity; drag with its crisis; Magnus lift and dip; an even wind; bouncing, sliding and rolling on grass; the
wall of players, the crossbar and the net as things to hit.
Leaves out: everything sideways (see the view from above); the ball's loss of spin in the air; the wobble of a ball
without spin; players who move; the give of grass, net and ball.

What that is worth: if a soccer ball lost its spin as a golf ball does (k = 6e-5 in dw/dt = -k v w / r; nothing
published for soccer), the dipping free kick would come 1.2 cm higher to the goal.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from math import cos, hypot, pi, radians, sin
from typing import Any, Literal

from sandbox.aerodynamics import (
    ConstantDrag,
    ConstantLift,
    NoDrag,
    NoLift,
    OutdoorAir,
    SpinRatioLift,
    aerodynamic_forces,
)
from sandbox.controls import Controls, Spin, Spread
from sandbox.engine.run import Event, Run
from sandbox.engine.setup import HOLLOW_SPHERE, Ball, Circle, Segment, Setup, Surface
from sandbox.errors import RequestError
from sandbox.parameters import Accuracy, Group, choice, either, group, quantity, switch
from sandbox.physics.coefficients import SOCCER_DRAG, SOCCER_LIFT
from sandbox.physics.forces import Gravity

RPM = pi / 30.0  # rad/s

# --------------------------------------------------------------------------------------------------------- parameters


class Launch(Group):
    """The ball just after the kick."""

    speed: float = quantity(27.0, "m/s", 0, 340, "ball speed")
    angle: float = quantity(20.0, "deg", -90, 180, "direction above the horizontal")
    spin: float = quantity(-300.0, "rpm", -20000, 20000, "backspin positive; topspin, negative, makes the ball dip")


class ModelDrag(Group):
    """Drag of a soccer ball by its source."""

    model: Literal["goff-carre", "textbook"] = choice("goff-carre", "drag coefficient by its source")


class ModelLift(Group):
    """Lift of a soccer ball by its source."""

    model: Literal["asai", "power-law"] = choice("asai", "lift coefficient by its source")
    velocity: Literal["air", "ground"] = choice("air", "velocity that lift is reckoned by: relative to air or ground")


class BallParameters(Group):
    """The soccer ball, a hollow sphere."""

    mass: float = quantity(0.430, "kg", 0.001, 10, "mass")
    radius: float = quantity(0.110, "m", 0.01, 0.5, "radius")
    drag: ModelDrag | ConstantDrag | NoDrag = either(ModelDrag(), "drag of the air")
    lift: ModelLift | ConstantLift | SpinRatioLift | NoLift = either(ModelLift(), "Magnus lift")


class Goal(Group):
    """The goal at the far end, seen from the side."""

    present: bool = switch(True, "whether there is a goal")
    distance: float = quantity(22.0, "m", 0, 2000, "from the ball to the middle of the goal line")
    height: float = quantity(2.44, "m", 0.1, 100, "from the ground to the lower edge of the bar")
    post_radius: float = quantity(0.06, "m", 0.001, 1, "radius of the bar; the goal line is as wide as the bar")
    restitution: float = quantity(0.7, "", 0, 1, "of ball and bar")
    friction: float = quantity(0.3, "", 0, 10, "of ball and bar")
    depth: float = quantity(2.0, "m", 0.5, 10, "from the goal line to the back of the net, a box")
    net_restitution: float = quantity(0.05, "", 0, 1, "of ball and net")
    net_friction: float = quantity(0.1, "", 0, 10, "of ball and net")


class Wall(Group):
    """The wall of players."""

    present: bool = switch(True, "whether there is a wall of players")
    distance: float = quantity(9.15, "m", 0, 2000, "from the ball to the middle of the wall")
    height: float = quantity(1.85, "m", 0.05, 20, "height, a jump included")
    thickness: float = quantity(0.3, "m", 0.01, 5, "how deep a player is")
    restitution: float = quantity(0.4, "", 0, 1, "of ball and player")
    friction: float = quantity(0.5, "", 0, 10, "of ball and player")


class Ground(Group):
    """The grass."""

    restitution: float = quantity(0.6, "", 0, 1, "of ball and grass")
    friction: float = quantity(0.5, "", 0, 10, "of ball and grass")
    rolling_resistance: float = quantity(0.1, "", 0, 10, "deceleration of a rolling ball over gravity")


class Parameters(Group):
    """All numbers of a kick."""

    launch: Launch = group(Launch(), "the ball just after the kick")
    gravity: float = quantity(9.81, "m/s^2", 0, 30, "gravity")
    air: OutdoorAir = group(OutdoorAir(), "the air")
    ball: BallParameters = group(BallParameters(), "the ball")
    wall: Wall = group(Wall(), "the wall of players")
    goal: Goal = group(Goal(), "the goal")
    ground: Ground = group(Ground(), "the grass")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


CONTROLS = Controls(
    strongest=45.0,
    spins=(Spin("launch.spin", 50.0),),
    sliders=("launch.speed", "launch.angle", "launch.spin", "goal.distance", "wall.present", "wall.height", "air.wind"),
    scores="goal",
    spread=(Spread("launch.speed", 0.02), Spread("launch.angle", least=1.0), Spread("launch.spin", 0.1)),  # assumed
)

# -------------------------------------------------------------------------------------------------------------- build

#: A kick still under way after this time in s is ended.
LONGEST = 60.0

#: The grass reaches this far either way, in m: as far as the fastest ball gets in that time.
FAR = 25_000.0

#: Bounces lower than this, in m, are lost in the grass and the ball rolls; assumed.
LOWEST_BOUNCE = 0.01

#: Advertising boards behind the ball and beyond the goal, in m; a ball that gets there is out of play.
BOARDS_BEHIND, BOARDS_BEYOND, BOARDS_HEIGHT = -30.0, 8.0, 0.9


def build(parameters: Parameters) -> Setup:
    """Ball, pitch, wall and goal. Raises RequestError where they do not go together."""
    _check(parameters)
    launch, ball = parameters.launch, parameters.ball
    angle = radians(launch.angle)
    forces = aerodynamic_forces(parameters.air, ball.radius, ball.drag, ball.lift, SOCCER_DRAG | SOCCER_LIFT)
    if parameters.gravity > 0.0:
        forces.append(Gravity(ball.mass, parameters.gravity))
    kicked = Ball(
        "ball",
        ball.mass,
        ball.radius,
        position=(0.0, ball.radius),
        velocity=(launch.speed * cos(angle), launch.speed * sin(angle)),
        spin=launch.spin * RPM,
        inertia_factor=HOLLOW_SPHERE,
        forces=forces,
    )
    return Setup([kicked], _pitch(parameters), duration=LONGEST, until=OutOfPlay(_beyond(parameters)))


@dataclass(frozen=True)
class OutOfPlay:
    """The ball reaches the boards, or the ground on their other side."""

    beyond: float  # m, place of the boards behind the goal

    def __call__(self, event: Event) -> bool:
        if event.partner == "boards":
            return True
        return event.partner == "ground" and not BOARDS_BEHIND < event.x < self.beyond


def _check(parameters: Parameters) -> None:
    goal, wall, radius = parameters.goal, parameters.wall, parameters.ball.radius
    if goal.present and goal.distance <= goal.post_radius + radius:
        raise RequestError(
            f"goal.distance = {goal.distance:g} m puts the goal on the ball, "
            f"whose ball.radius is {radius:g} m: move it away, or set goal.present = false"
        )
    if not wall.present:
        return
    if wall.distance <= 0.5 * wall.thickness + radius:
        raise RequestError(
            f"wall.distance = {wall.distance:g} m puts the wall on the ball, "
            f"whose ball.radius is {radius:g} m: move it away, or set wall.present = false"
        )
    if goal.present and wall.distance + 0.5 * wall.thickness >= goal.distance - goal.post_radius:
        raise RequestError(
            f"wall.distance = {wall.distance:g} m is not in front of the goal, which is at "
            f"goal.distance = {goal.distance:g} m: bring it nearer, or set wall.present = false"
        )


def _beyond(parameters: Parameters) -> float:
    """Where the boards beyond the goal stand, or beyond the wall where that is further."""
    wall = parameters.wall
    return max(parameters.goal.distance, wall.distance if wall.present else 0.0) + BOARDS_BEYOND


def _pitch(parameters: Parameters) -> list[Surface]:
    ground, goal, wall = parameters.ground, parameters.goal, parameters.wall
    surfaces = [
        Surface(
            "ground",
            Segment((-FAR, 0.0), (FAR, 0.0)),
            ground.restitution,
            ground.friction,
            rolling_resistance=ground.rolling_resistance,
            lowest_bounce=LOWEST_BOUNCE,
        )
    ]
    surfaces += [
        Surface("boards", Segment((x, 0.0), (x, BOARDS_HEIGHT)), 0.0, 0.0) for x in (BOARDS_BEHIND, _beyond(parameters))
    ]
    if wall.present:
        front, back = wall.distance - 0.5 * wall.thickness, wall.distance + 0.5 * wall.thickness
        corners = [(front, 0.0), (front, wall.height), (back, wall.height), (back, 0.0)]
        surfaces += [Surface("wall", Segment(a, b), wall.restitution, wall.friction) for a, b in pairwise(corners)]
    if goal.present:
        bar = (goal.distance, goal.height + goal.post_radius)
        back = goal.distance + goal.depth
        corners = [bar, (back, bar[1]), (back, 0.0)]
        surfaces.append(Surface("bar", Circle(bar, goal.post_radius), goal.restitution, goal.friction))
        net = goal.net_restitution, goal.net_friction
        surfaces += [Surface("net", Segment(a, b), *net) for a, b in pairwise(corners)]
    return surfaces


# ------------------------------------------------------------------------------------------------------------- result


#: Units of the result's numbers, for charts and tables.
UNITS = {
    "height_at_wall": "m",
    "height_at_goal": "m",
    "speed_at_goal": "m/s",
    "flight_time": "s",
    "carry": "m",
    "apex": "m",
}


def result(run: Run, parameters: Parameters) -> dict[str, Any]:
    """Goal or not, and the numbers of the flight; lengths in m, speeds in m/s, times in s.

    Heights are those of the ball's centre over the ground where it first passes the middle of the wall and the goal
    line, None where it never does. ``apex`` is over the point of the kick. ``flight_time`` lasts until the ball first
    touches anything, or is in the goal; ``carry`` is where it first comes down on the grass, None where something else
    was in the way. A goal is one with the whole of the ball over the whole of the line, as in the Laws.
    """
    goal = parameters.goal
    at_wall = next(_forward(run, parameters.wall.distance), None)
    at_goal = next(_forward(run, goal.distance), None)
    over_the_line = goal.distance + goal.post_radius + parameters.ball.radius
    scored = next((t for t, state in _forward(run, over_the_line) if goal.present and state[1] < goal.height), None)
    touched = next((event for event in run.events if event.kind != "leave"), None)
    moments = [t for t in (scored, None if touched is None else touched.t) if t is not None]
    return {
        "goal": scored is not None,
        "verdict": _verdict(run, parameters, scored is not None, None if at_goal is None else at_goal[1][1]),
        "height_at_wall": None if at_wall is None else at_wall[1][1],
        "height_at_goal": None if at_goal is None else at_goal[1][1],
        "speed_at_goal": None if at_goal is None else hypot(at_goal[1][2], at_goal[1][3]),
        "flight_time": min(moments, default=None),
        "carry": touched.x if touched is not None and touched.partner == "ground" else None,
        "apex": run.highest("ball")[1][1] - run.state("ball", 0.0)[1],
        "ended": run.ended,
    }


def _forward(run: Run, x: float) -> Any:
    """Times and states at which the ball's centre passes x (m) on its way forward."""
    return run.crossings("ball", (x, 0.0), (-1.0, 0.0))


def _verdict(run: Run, parameters: Parameters, scored: bool, height_at_goal: float | None) -> str:
    """goal; bar or wall, where that was touched and it is no goal; over; short, a ball that stops on the line included;
    past, where there is no goal to hit."""
    if scored:
        return "goal"
    touched = {event.partner for event in run.events}
    for name in ("bar", "wall"):
        if name in touched:
            return name
    if height_at_goal is None:
        return "short"
    if not parameters.goal.present:
        return "past"
    return "over" if height_at_goal > parameters.goal.height else "short"


def card(result: dict[str, Any], parameters: Parameters) -> list[tuple[str, str]]:
    """The result for people."""
    launch, wall, goal = parameters.launch, parameters.wall, parameters.goal
    spin = f"{abs(launch.spin):.0f} rpm {'topspin' if launch.spin < 0 else 'backspin'}"
    lines = [
        ("kick", f"{_speed(launch.speed)} at {launch.angle:.1f}°, {spin if launch.spin else 'no spin'}"),
        ("apex", f"{result['apex']:.2f} m above the kick"),
    ]
    if wall.present and result["height_at_wall"] is not None:
        clear = result["height_at_wall"] - parameters.ball.radius - wall.height
        lines.append(("height at wall", f"{result['height_at_wall']:.2f} m ({clear:.2f} m clear of the heads)"))
    if result["height_at_goal"] is not None:
        lines.append(("height at goal", _under_the_bar(result["height_at_goal"], parameters)))
        lines.append(("speed at goal", _speed(result["speed_at_goal"])))
    elif result["carry"] is not None:
        lines.append(("carry", f"{result['carry']:.1f} m"))
    if result["flight_time"] is not None:
        lines.append(("flight time", f"{result['flight_time']:.2f} s"))
    endings = {
        "goal": "goal",
        "over": "over the bar",
        "wall": "into the wall",
        "bar": "off the bar",
        "short": f"short of the goal, {goal.distance:.1f} m away",
        "past": f"past {goal.distance:.1f} m",
    }
    lines.append(("verdict", endings[result["verdict"]]))
    return lines


def _speed(metres_per_second: float) -> str:
    return f"{metres_per_second:.1f} m/s ({metres_per_second * 3.6:.0f} km/h)"


def _under_the_bar(height: float, parameters: Parameters) -> str:
    if not parameters.goal.present:
        return f"{height:.2f} m"
    under = parameters.goal.height - height - parameters.ball.radius
    where = "under the bar" if under >= 0.0 else "too high for it"
    return f"{height:.2f} m ({abs(under):.2f} m {where})"
