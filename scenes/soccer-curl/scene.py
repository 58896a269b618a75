"""Soccer from above: a free kick that bends round the wall, past the keeper, between the posts.

Models: drag with its crisis; the sideways part of the Magnus force; an even wind; posts, wall, keeper (standing, or
moving at a given speed) and net as things to hit.
Leaves out: everything upright. Gravity has no part in this plane, so the scene does not know how high the ball is,
whether it clears the wall, or when it would come down: give it kicks that stay in the air. The ball's loss of spin.

What that is worth: if a soccer ball lost its spin as a golf ball does (k = 6e-5 in dw/dt = -k v w / r; nothing
published for soccer), Beckham's kick would bend 0.8 cm less and Roberto Carlos's 2.8 cm less.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import cos, hypot, radians, tan

from sandbox.engine.run import Event, Run
from sandbox.engine.setup import Always, Ball, Bounce, Circle, Segment, Setup, Surface, Vector
from sandbox.errors import RequestError
from sandbox.parameters import Accuracy, Group, group, quantity, switch
from sandbox.sport.air import Air
from sandbox.sport.amounts import roughly
from sandbox.sport.controls import Controls, Spin, Spread
from sandbox.sport.facts import ENDED, Fact, once
from sandbox.sport.flight import forces_in_flight, launched_ball
from sandbox.sport.readings import BALL_SPEED, LAUNCH_ANGLE, LAUNCH_SPIN, Moment, at, first_touch, passing

from ..soccer.ball import SoccerBall

# --------------------------------------------------------------------------------------------------------- parameters


class Launch(Group):
    """The ball just after the kick."""

    speed: float = quantity(..., "m/s", 0, 340, "ball speed")
    angle: float = quantity(..., "deg", -180, 180, "direction, to the left of straight at the goal line")
    spin: float = quantity(..., "rpm", -20000, 20000, "positive bends the ball to the left")
    tilt: float = quantity(
        ..., "deg", -90, 90, "lean of the spin's axis from the upright; only its cosine bends the ball"
    )


class Goal(Group):
    """The goal from above."""

    distance: float = quantity(..., "m", 0, 200, "from the ball straight to the middle of the goal line's width")
    offset: float = quantity(..., "m", -40, 40, "middle of the goal to the left of the ball")
    width: float = quantity(..., "m", 0, 20, "between the posts")
    post_radius: float = quantity(..., "m", 0.001, 1, "radius of the posts; the goal line is as wide")
    restitution: float = quantity(..., "", 0, 1, "of ball and post")
    friction: float = quantity(..., "", 0, 10, "of ball and post")
    depth: float = quantity(..., "m", 0.5, 5, "from the goal line to the back of the net")
    net_restitution: float = quantity(..., "", 0, 1, "of ball and net")
    net_friction: float = quantity(..., "", 0, 10, "of ball and net")


class Wall(Group):
    """The wall of players."""

    present: bool = switch(..., "whether there is a wall of players")
    distance: float = quantity(..., "m", 0, 200, "from the ball straight to the middle of the wall")
    offset: float = quantity(..., "m", -40, 40, "middle of the wall to the left of the ball")
    width: float = quantity(..., "m", 0.1, 40, "from side to side")
    thickness: float = quantity(..., "m", 0.01, 5, "how deep a player is")
    restitution: float = quantity(..., "", 0, 1, "of ball and player")
    friction: float = quantity(..., "", 0, 10, "of ball and player")


class Keeper(Group):
    """The keeper, a heavy disc."""

    present: bool = switch(..., "whether there is a keeper")
    distance: float = quantity(..., "m", 0, 20, "in front of the goal line")
    offset: float = quantity(..., "m", -20, 20, "at the kick, to the left of the middle of the goal")
    speed: float = quantity(..., "m/s", -15, 15, "along the goal line from the kick on, to the left")
    radius: float = quantity(..., "m", 0.05, 5, "half the width that he covers")
    mass: float = quantity(..., "kg", 1, 1000, "mass")
    restitution: float = quantity(..., "", 0, 1, "of ball and keeper")
    friction: float = quantity(..., "", 0, 10, "of ball and keeper")


class Parameters(Group):
    """All parameters of a kick."""

    launch: Launch = group(..., "the ball just after the kick")
    air: Air = group(..., "the air")
    ball: SoccerBall = group(..., "the ball")
    wall: Wall = group(..., "the wall of players")
    keeper: Keeper = group(..., "the keeper")
    goal: Goal = group(..., "the goal")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


CONTROLS = Controls(
    strongest=45.0,
    spins=(Spin("launch.spin", 50.0),),
    sliders=("launch.speed", "launch.angle", "launch.spin", "launch.tilt", "goal.distance", "air.wind"),
    scores="goal",
    spread=(Spread("launch.speed", 0.02), Spread("launch.angle", least=1.0), Spread("launch.spin", 0.1)),  # assumed
)

# -------------------------------------------------------------------------------------------------------------- build

#: A kick still moving after this time in s is ended: no ball stays in the air so long. A fast one is ended earlier,
#: after this many times its flight time to the goal line without air, plus a moment to see it saved.
LONGEST, PATIENCE, MOMENT = 10.0, 3.0, 1.0

#: Advertising boards behind the ball, behind the goal line and on either side, in m; a ball that gets there is out.
BOARDS_BEHIND, BOARDS_BEYOND, BOARDS_ASIDE = -15.0, 8.0, 60.0


def build(parameters: Parameters) -> Setup:
    """Ball, keeper, wall and goal. Raises RequestError if they overlap."""
    _check(parameters)
    launch, ball, keeper = parameters.launch, parameters.ball, parameters.keeper
    forces = forces_in_flight(ball, parameters.air, lift_share=cos(radians(launch.tilt)))
    balls = [launched_ball(launch, ball, (0.0, 0.0), forces)]
    if keeper.present:
        balls.append(
            Ball("keeper", keeper.mass, keeper.radius, position=_keeper(parameters), velocity=(0.0, keeper.speed))
        )
    needed = parameters.goal.distance / max(launch.speed, 0.1)
    return Setup(
        balls,
        _pitch(parameters),
        duration=min(LONGEST, PATIENCE * needed + MOMENT),
        until=_is_over,
        pairs=[("ball", "keeper", Always(Bounce(keeper.restitution, keeper.friction)))],
    )


def _is_over(event: Event) -> bool:
    return event.ball == "ball" and event.partner in ("net", "boards")


def _keeper(parameters: Parameters) -> Vector:
    """Where the keeper stands at the kick."""
    goal, keeper = parameters.goal, parameters.keeper
    return goal.distance - keeper.distance, goal.offset + keeper.offset


def _posts(parameters: Parameters) -> tuple[Vector, Vector]:
    """Middles of the right and the left post."""
    goal = parameters.goal
    aside = 0.5 * goal.width + goal.post_radius
    return (goal.distance, goal.offset - aside), (goal.distance, goal.offset + aside)


def _from_wall(parameters: Parameters, point: Vector) -> float:
    """Distance in m from a point to the wall, 0 inside."""
    wall = parameters.wall
    ahead = abs(point[0] - wall.distance) - 0.5 * wall.thickness
    aside = abs(point[1] - wall.offset) - 0.5 * wall.width
    return hypot(max(ahead, 0.0), max(aside, 0.0))


def _check(parameters: Parameters) -> None:
    goal, wall, keeper, radius = parameters.goal, parameters.wall, parameters.keeper, parameters.ball.radius
    at_goal = f"goal.distance = {goal.distance:g} m"
    at_wall = f"wall.distance = {wall.distance:g} m, wall.offset = {wall.offset:g} m"
    at_keeper = f"keeper.distance = {keeper.distance:g} m, keeper.offset = {keeper.offset:g} m"
    ball = f"the ball, which starts at 0 m with ball.radius = {radius:g} m"
    if goal.distance <= goal.post_radius + radius:
        raise RequestError(f"{at_goal} puts the goal on {ball}: move it away")
    if wall.present and _from_wall(parameters, (0.0, 0.0)) <= radius:
        raise RequestError(f"{at_wall} puts the wall on {ball}: move it away, or set wall.present = false")
    if wall.present and wall.distance + 0.5 * wall.thickness >= goal.distance - goal.post_radius:
        raise RequestError(
            f"wall.distance = {wall.distance:g} m is not in front of the goal, which is at {at_goal}: "
            "bring it nearer, or set wall.present = false"
        )
    if not keeper.present:
        return
    x, y = _keeper(parameters)
    if hypot(x, y) <= keeper.radius + radius:
        raise RequestError(f"{at_keeper} puts the keeper on {ball}: move him, or set keeper.present = false")
    if wall.present and _from_wall(parameters, (x, y)) <= keeper.radius:
        raise RequestError(f"{at_keeper} puts the keeper into the wall, {at_wall}: move one of them")
    if any(hypot(x - px, y - py) <= keeper.radius + goal.post_radius for px, py in _posts(parameters)):
        raise RequestError(f"{at_keeper} puts the keeper into a post of goal.width = {goal.width:g} m: move him")


def _pitch(parameters: Parameters) -> list[Surface]:
    goal, wall = parameters.goal, parameters.wall
    behind, beyond = BOARDS_BEHIND, goal.distance + BOARDS_BEYOND
    corners = _rectangle(behind, beyond, -BOARDS_ASIDE, BOARDS_ASIDE)
    surfaces = [Surface("boards", Segment(a, b), 0.0, 0.0) for a, b in pairwise(corners)]
    right, left = _posts(parameters)
    for name, center in (("right post", right), ("left post", left)):
        surfaces.append(Surface(name, Circle(center, goal.post_radius), goal.restitution, goal.friction))
    back = goal.distance + goal.depth
    corners = [right, (back, right[1]), (back, left[1]), left]
    net = goal.net_restitution, goal.net_friction
    surfaces += [Surface("net", Segment(a, b), *net) for a, b in pairwise(corners)]
    if wall.present:
        half, aside = 0.5 * wall.thickness, 0.5 * wall.width
        corners = _rectangle(wall.distance - half, wall.distance + half, wall.offset - aside, wall.offset + aside)
        surfaces += [Surface("wall", Segment(a, b), wall.restitution, wall.friction) for a, b in pairwise(corners)]
    return surfaces


def _rectangle(left: float, right: float, bottom: float, top: float) -> list[Vector]:
    return [(left, bottom), (right, bottom), (right, top), (left, top), (left, bottom)]


# -------------------------------------------------------------------------------------------------------------- facts


@once
def at_goal(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it passes the goal line; None if it does not get there, or is touched on its way."""
    passed, touched = passing(run, parameters.goal.distance), first_touch(run)
    return None if passed is None or (touched is not None and touched.t < passed.t) else passed


@once
def _scored(run: Run, parameters: Parameters) -> bool:
    """Whether the whole of the ball was over the whole of the line, between the posts."""
    goal = parameters.goal
    over_the_line = goal.distance + goal.post_radius + parameters.ball.radius
    crossings = run.crossings("ball", (over_the_line, 0.0), (-1.0, 0.0))
    return any(abs(state[1] - goal.offset) < 0.5 * goal.width for _, state in crossings)


def _deviation(run: Run, parameters: Parameters) -> float | None:
    """Along the goal line in m, from where the straight line of the launch meets it, if it does."""
    passed, angle = at_goal(run, parameters), parameters.launch.angle
    return None if passed is None or abs(angle) >= 90.0 else passed.y - parameters.goal.distance * tan(radians(angle))


def _offset(run: Run, parameters: Parameters) -> float | None:
    passed = at_goal(run, parameters)
    return None if passed is None else passed.y - parameters.goal.offset


def _inside_post(run: Run, parameters: Parameters) -> float | None:
    """Gap in m between the ball and the nearer post; negative if the ball goes wide."""
    offset = _offset(run, parameters)
    return None if offset is None else 0.5 * parameters.goal.width - abs(offset) - parameters.ball.radius


def _flight_time(run: Run, parameters: Parameters) -> float | None:
    """Until the goal line or the first touch, in s."""
    passed, touched = at_goal(run, parameters), first_touch(run)
    return passed.t if passed else touched.t if touched else None


def _word(run: Run, parameters: Parameters) -> str:
    """goal; saved, post or wall, where that was touched and it is no goal; wide; short of the goal line."""
    if _scored(run, parameters):
        return "goal"
    meetings = [event for event in run.events if "ball" in (event.ball, event.partner)]
    touched = {name for event in meetings for name in (event.ball, event.partner)}
    for word, names in (("saved", {"keeper"}), ("post", {"left post", "right post"}), ("wall", {"wall"})):
        if touched & names:
            return word
    return "short" if passing(run, parameters.goal.distance) is None else "wide"


ASIDE = ("right", "left")

FACTS = (
    Fact("goal", "", "", _scored),
    Fact("verdict", "", "", _word),
    Fact("deviation", "bend", "m", _deviation, sides=ASIDE),
    Fact("inside_post", "nearer post", "m", _inside_post, sides=("outside", "inside")),
    Fact("speed_at_goal", "speed at goal", "m/s", at(at_goal, lambda ball: ball.speed), also="km/h"),
    Fact("flight_time", "flight time", "s", _flight_time),
    BALL_SPEED,
    replace(LAUNCH_ANGLE, sides=ASIDE),
    replace(LAUNCH_SPIN, sides=ASIDE),
    Fact("offset_at_goal", "from the middle", "m", _offset, sides=ASIDE),
    ENDED,
)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
    result = run.result
    bend, inside = result["deviation"], result["inside_post"]
    if result["verdict"] == "goal":
        if inside is None:
            return "Goal"
        if bend is not None and abs(bend) >= 0.05:
            return f"Goal, bent {roughly(abs(bend))} to the {ASIDE[bend > 0.0]}"
        return f"Goal, {roughly(max(0.0, inside))} inside the post"
    if result["verdict"] == "wide":
        outside = None if inside is None else -inside - parameters.ball.radius
        return "Wide of the goal" if outside is None else f"Wide by {roughly(max(0.0, outside))}"
    return {
        "saved": "Saved by the keeper",
        "post": "Off the post",
        "wall": "Into the wall",
        "short": "Short of the goal line",
    }[result["verdict"]]
