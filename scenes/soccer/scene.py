"""Soccer from the side: a free kick over the wall and under the bar, or a kick up the field.

Models: gravity; drag with its crisis; Magnus lift and dip; loss of spin; a uniform wind; bouncing, sliding and rolling
on grass; the wall of players, the crossbar and the net as things to hit.
Leaves out: everything sideways but the drift of a tilted spin axis (see the view from above); the wobble of a ball
without spin; players who move; the deformation of grass, net and ball.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import inf

from sandbox.kit import (
    ENDED,
    LAUNCH,
    SOCCER_DRAG,
    SOCCER_LIFT,
    Circle,
    Controls,
    Extent,
    Fact,
    Flight,
    Handle,
    Moment,
    OutdoorAir,
    Passes,
    Rule,
    Run,
    SceneRun,
    Segment,
    Setup,
    Solid,
    Spin,
    Spread,
    State,
    Surface,
    Until,
    Vector,
    apex,
    before,
    cached_per_run,
    check_apart,
    disc,
    fact_from,
    first_touch,
    group,
    level,
    passing_at,
    quantity,
    roughly,
    switch,
)
from sandbox.sport.flight import SlowedSphere
from sandbox.sport.sideways import Crosswind, GroundPlace, SidewaysLaunch, ground_track, side

SPREAD = (Spread("launch.speed", 0.02), Spread("launch.angle", minimum=1.0), Spread("launch.spin", 0.1))  # assumed


# What soccer from above has, too.


class SoccerBall(SlowedSphere, drag=SOCCER_DRAG, lift=SOCCER_LIFT):
    """The soccer ball, a hollow sphere."""


class Wall(Solid):
    """The wall of players."""

    present: bool = switch(..., "whether there is a wall of players")
    distance: float = quantity(..., "m", 0, 2000, "from the ball straight to the middle of the wall")
    thickness: float = quantity(..., "m", 0.01, 5, "how deep a player is")

    @property
    def sides(self) -> Vector:
        """Its front and its back, in m from the ball."""
        return self.distance - 0.5 * self.thickness, self.distance + 0.5 * self.thickness


class Goal(Solid):
    """The goal: bar, posts and net."""

    distance: float = quantity(..., "m", 0, 2000, "from the ball straight to the middle of the goal line's width")
    post_radius: float = quantity(..., "m", 0.001, 1, "radius of bar and posts; the goal line is as wide")
    depth: float = quantity(..., "m", 0.5, 10, "from the goal line to the back of the net, a box")
    net_restitution: float = quantity(..., "", 0, 1, "of ball and net")
    net_friction: float = quantity(..., "", 0, 10, "of ball and net")

    def net(self, corners: Sequence[Vector]) -> list[Surface]:
        """The net along a line through the corners, in m."""
        return [Surface("net", Segment(*ends), self.net_restitution, self.net_friction) for ends in pairwise(corners)]

    def over_line(self, radius: float) -> float:
        """The place in m of a ball of that radius the whole of which is over the whole of the line, as in the Laws."""
        return self.distance + self.post_radius + radius

    def entries(self, run: Run, radius: float) -> Iterator[tuple[float, State]]:
        """Each time and state at which the ball comes there."""
        return run.crossings("ball", (self.over_line(radius), 0.0), (-1.0, 0.0))


class HighGoal(Goal):
    """The goal at the far end, seen from the side."""

    present: bool = switch(..., "whether there is a goal")
    height: float = quantity(..., "m", 0.1, 100, "from the ground to the lower edge of the bar")


class HighWall(Wall):
    """The wall of players, seen from the side."""

    height: float = quantity(..., "m", 0.05, 20, "height, a jump included")


class Grass(Solid):
    """The ground."""

    rolling_resistance: float = quantity(..., "", 0, 10, "deceleration of a rolling ball over gravity")


class PitchAir(Crosswind, OutdoorAir):
    """The air over the pitch."""


class Parameters(Flight):
    """All parameters of a kick."""

    launch: SidewaysLaunch = group(..., "the ball as it is launched")
    air: PitchAir = group(..., "the air")
    ball: SoccerBall = group(..., "the ball")
    wall: HighWall = group(..., "the wall of players")
    goal: HighGoal = group(..., "the goal")
    ground: Grass = group(..., "the grass")


CONTROLS = Controls(
    full_pull_speed=45.0,
    spins=(Spin("launch.spin", 50.0),),
    sliders=("launch.speed", "launch.angle", "launch.spin", "goal.distance", "wall.present", "wall.height", "air.wind"),
    handles=(
        Handle("wall.distance", "wall.height", where="wall.present"),
        Handle("goal.distance", "goal.height", where="goal.present", goal=True),
    ),
    scores="goal",
    spread=SPREAD,
)

#: A kick still moving after this time in s is ended.
LONGEST = 60.0

#: Bounces lower than this, in m, are lost in the grass and the ball rolls; assumed.
LOWEST_BOUNCE = 0.01

#: A ball that crosses the goal line so far under the bar, in m, is known to be in before its path is.
UNDER = 0.1

#: Advertising boards behind the ball and beyond the goal, in m; a ball that gets there is out of play.
BOARDS_BEHIND, BOARDS_BEYOND, BOARDS_HEIGHT = -30.0, 8.0, 0.9


def build(parameters: Parameters) -> Setup:
    """Ball, pitch, wall, goal and boards. Raises RequestError where one is in another, or the wall behind the goal."""
    ball, ground, wall, goal = parameters.ball, parameters.ground, parameters.wall, parameters.goal
    farthest = max(goal.distance, wall.distance if wall.present else 0.0) + BOARDS_BEYOND
    grass = {"rolling_resistance": ground.rolling_resistance, "lowest_bounce": LOWEST_BOUNCE}
    boards = [Segment((x, 0.0), (x, BOARDS_HEIGHT)) for x in (BOARDS_BEHIND, farthest)]
    surfaces = [ground.surface("ground", level(), **grass), *(Surface("boards", shape, 0.0, 0.0) for shape in boards)]
    standing = [disc("the ball", ("ball.radius",), 0.0, ball.radius, ball.radius)]
    if wall.present:
        front, back = wall.sides
        standing.append(Extent("the wall", ("wall.distance",), front, 0.0, back, wall.height))
        surfaces += wall.outline("wall", [(front, 0.0), (front, wall.height), (back, wall.height), (back, 0.0)])
    if goal.present:
        bar, back = (goal.distance, goal.height + goal.post_radius), goal.distance + goal.depth
        standing.append(Extent("the goal", ("goal.distance",), goal.distance, 0.0, inf, inf, goal.post_radius))
        surfaces += [goal.surface("bar", Circle(bar, goal.post_radius)), *goal.net([bar, (back, bar[1]), (back, 0.0)])]
    check_apart(parameters, *standing)
    return Setup([parameters.launched((0.0, ball.radius))], surfaces, LONGEST, OutOfPlay(farthest))


@dataclass(frozen=True)
class OutOfPlay(Until):
    """The ball reaches the boards, or the ground on their other side."""

    farthest: float  # m, place of the boards behind the goal

    def rules(self) -> Sequence[Rule]:
        return [Rule(("boards",)), Rule(("ground",), left=BOARDS_BEHIND, right=self.farthest)]


#: The ball as it first passes the middle of the wall, and that of the goal line.
at_wall, at_goal = passing_at(lambda it: it.wall.distance), passing_at(lambda it: it.goal.distance)


@cached_per_run
def scored(run: Run, parameters: Parameters) -> float | None:
    """The time in s at which the ball was in the goal, under the bar; None if never."""
    goal = parameters.goal
    entries = goal.entries(run, parameters.ball.radius)
    return next((t for t, state in entries if goal.present and state[1] < goal.height), None)


def entered(parameters: Parameters) -> Passes:
    """The condition at which a kick is known to be a goal, well under the bar; that it is none is known at the end."""
    goal = parameters.goal
    line, top = goal.over_line(parameters.ball.radius), goal.height - UNDER if goal.present else 0.0
    return Passes("nothing", 1, (line, 0.0), (line, top))


def flight_time(run: Run, parameters: Parameters) -> float | None:
    """Until the ball first touches anything, or is in the goal, in s."""
    touched = first_touch(run)
    moments = (scored(run, parameters), None if touched is None else touched.t)
    return min((t for t in moments if t is not None), default=None)


def carry(run: Run, parameters: Parameters) -> float | None:
    """The place where the ball first comes down on the grass; None where something else was in the way."""
    touched = first_touch(run)
    return touched.x if touched is not None and touched.partner == "ground" else None


def track(run: Run, parameters: Parameters) -> list[GroundPlace]:
    """The track over the ground of a ball that leaves the plane: to the goal line, or to what it touches first."""
    touched, passed = first_touch(run), at_goal(run, parameters)
    if passed is not None and (touched is None or passed.t <= touched.t):
        return ground_track(run, parameters, passed, forward=True)
    end = before(run, run.duration if touched is None else touched.t)
    return ground_track(run, parameters, end, forward=touched is not None and touched.partner != "ground")


def outcome(run: Run, parameters: Parameters) -> str:
    """goal; bar or wall, where that was touched and it is no goal; over; short, a ball that stops on the line included;
    past, where there is no goal to hit."""
    if scored(run, parameters) is not None:
        return "goal"
    touched, passed = {event.partner for event in run.events}, at_goal(run, parameters)
    if touched & {"bar", "wall"}:
        return "bar" if "bar" in touched else "wall"
    if passed is not None and not parameters.goal.present:
        return "past"
    return "over" if passed is not None and passed.y > parameters.goal.height else "short"


def over_wall(ball: Moment, it: Parameters) -> float | None:
    """Gap in m between ball and heads."""
    return ball.y - it.ball.radius - it.wall.height if it.wall.present else None


def under_bar(ball: Moment, it: Parameters) -> float | None:
    """Gap in m between ball and bar; negative if the ball is too high."""
    return it.goal.height - ball.y - it.ball.radius if it.goal.present else None


FACTS = (
    Fact("goal", "", "", lambda run, it: scored(run, it) is not None, entered),
    Fact("verdict", "", "", outcome),
    Fact("height_at_goal", "height at goal", "m", fact_from(at_goal, "y")),
    Fact("speed_at_goal", "speed at goal", "m/s", fact_from(at_goal, "speed"), also="km/h"),
    Fact("under_bar", "under the bar", "m", fact_from(at_goal, under_bar)),
    Fact("height_at_wall", "height at wall", "m", fact_from(at_wall, "y"), where=lambda _, it: it.wall.present),
    Fact("over_wall", "over the wall", "m", fact_from(at_wall, over_wall)),
    side(track),
    Fact("carry", "carry", "m", carry),
    Fact("apex", "apex", "m", lambda run, it: apex(run, it) - it.ball.radius),
    Fact("flight_time", "flight time", "s", flight_time),
    *LAUNCH,
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    result, goal = run.result, parameters.goal
    if result["verdict"] == "goal":
        under = result["under_bar"]
        return "Goal" if under is None or under < 0 else f"Goal, {roughly(under)} under the bar"
    if result["verdict"] == "over":
        over = result["height_at_goal"] - parameters.ball.radius - goal.height - 2 * goal.post_radius
        return f"Over the bar by {roughly(over)}" if over > 0 else "Just over the bar"
    if result["verdict"] in ("bar", "wall"):
        return "Off the bar" if result["verdict"] == "bar" else "Into the wall"
    x = run.state("ball", run.duration)[0]
    if result["verdict"] == "past":
        return f"{roughly(abs(x))} up the field"
    if run.ended == "duration":
        return f"Still under way after {run.duration:.0f} s"
    if x < 0:
        return f"Ends {roughly(-x)} behind the kick"
    away = goal.distance - x
    return f"Short, {roughly(away)} from the goal" if away > 0 else "Short of the goal"
