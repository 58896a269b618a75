"""Soccer from the side: a free kick over the wall and under the bar, or a kick up the field.

Models: gravity; drag with its crisis; Magnus lift and dip; a uniform wind; bouncing, sliding and rolling on grass; the
wall of players, the crossbar and the net as things to hit.
Leaves out: everything sideways (see the view from above); the ball's loss of spin in the air; the wobble of a ball
without spin; players who move; the deformation of grass, net and ball.

Size of an effect: if a soccer ball lost its spin like a golf ball (k = 6e-5 in dw/dt = -k v w / r; nothing
published for soccer), the dipping free kick would reach the goal 1.2 cm higher.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from sandbox.engine.run import Event, Run
from sandbox.engine.setup import Circle, Segment, Setup, Surface, Until
from sandbox.parameters import Accuracy, Group, group, quantity, switch
from sandbox.physics.integrators import State
from sandbox.sport.air import OutdoorAir
from sandbox.sport.amounts import roughly
from sandbox.sport.controls import Controls, Handle, Spin
from sandbox.sport.facts import ENDED, Fact, once
from sandbox.sport.flight import Launch, forces_in_flight, launched_ball
from sandbox.sport.readings import LAUNCH, Moment, at, first_touch, passing
from sandbox.sport.solids import Extent, Solid, check_apart, disc

from .kick import SPREAD, Goal, SoccerBall, Wall


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


class Parameters(Group):
    """All parameters of a kick."""

    launch: Launch = group(..., "the ball just after the kick")
    gravity: float = quantity(..., "m/s^2", 0, 30, "gravity")
    air: OutdoorAir = group(..., "the air")
    ball: SoccerBall = group(..., "the ball")
    wall: HighWall = group(..., "the wall of players")
    goal: HighGoal = group(..., "the goal")
    ground: Grass = group(..., "the grass")
    accuracy: Accuracy = group(Accuracy(), "speed against accuracy")


CONTROLS = Controls(
    strongest=45.0,
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

#: The grass reaches this far in both directions, in m: as far as the fastest ball gets in that time.
FAR = 25_000.0

#: Bounces lower than this, in m, are lost in the grass and the ball rolls; assumed.
LOWEST_BOUNCE = 0.01

#: A ball that crosses the goal line so far under the bar, in m, is known to be in before its path is.
UNDER = 0.1

#: Advertising boards behind the ball and beyond the goal, in m; a ball that gets there is out of play.
BOARDS_BEHIND, BOARDS_BEYOND, BOARDS_HEIGHT = -30.0, 8.0, 0.9


def build(parameters: Parameters) -> Setup:
    """Ball, pitch, wall and goal. Raises RequestError if they overlap."""
    _check(parameters)
    ball = parameters.ball
    forces = forces_in_flight(ball, parameters.air, parameters.gravity)
    kicked = launched_ball(parameters.launch, ball, (0.0, ball.radius), forces)
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
    """Raise RequestError where ball, wall and goal are in each other, or the wall behind the goal."""
    goal, wall, radius = parameters.goal, parameters.wall, parameters.ball.radius
    standing = [disc("the ball", ("ball.radius",), 0.0, radius, radius)]
    if wall.present:
        front, back = wall.distance - 0.5 * wall.thickness, wall.distance + 0.5 * wall.thickness
        standing.append(Extent("the wall", ("wall.distance",), front, 0.0, back, wall.height))
    if goal.present:
        standing.append(Extent("the goal", ("goal.distance",), goal.distance, 0.0, inf, inf, goal.post_radius))
    check_apart(parameters, *standing)


def _beyond(parameters: Parameters) -> float:
    """Position of the boards beyond the goal, or beyond the wall if that is further."""
    wall = parameters.wall
    return max(parameters.goal.distance, wall.distance if wall.present else 0.0) + BOARDS_BEYOND


def _pitch(parameters: Parameters) -> list[Surface]:
    ground, goal, wall = parameters.ground, parameters.goal, parameters.wall
    grass = {"rolling_resistance": ground.rolling_resistance, "lowest_bounce": LOWEST_BOUNCE}
    boards = [Segment((x, 0.0), (x, BOARDS_HEIGHT)) for x in (BOARDS_BEHIND, _beyond(parameters))]
    surfaces = [ground.surface("ground", Segment((-FAR, 0.0), (FAR, 0.0)), **grass)]
    surfaces += [Surface("boards", shape, 0.0, 0.0) for shape in boards]
    if wall.present:
        front, back = wall.distance - 0.5 * wall.thickness, wall.distance + 0.5 * wall.thickness
        surfaces += wall.outline("wall", [(front, 0.0), (front, wall.height), (back, wall.height), (back, 0.0)])
    if goal.present:
        bar, back = (goal.distance, goal.height + goal.post_radius), goal.distance + goal.depth
        surfaces.append(goal.surface("bar", Circle(bar, goal.post_radius)))
        surfaces += goal.net([bar, (back, bar[1]), (back, 0.0)])
    return surfaces


@once
def at_wall(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it first passes the middle of the wall."""
    return passing(run, parameters.wall.distance)


@once
def at_goal(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it first passes the middle of the goal line."""
    return passing(run, parameters.goal.distance)


@once
def scored(run: Run, parameters: Parameters) -> float | None:
    """When the ball was in the goal, under the bar; None if never."""
    goal = parameters.goal
    entries = goal.entries(run, parameters.ball.radius)
    return next((t for t, state in entries if goal.present and state[1] < goal.height), None)


@dataclass(frozen=True)
class Entered(Until):
    """The ball has crossed the goal line, well under the bar: a goal, whatever comes later."""

    line: float  # m, of the middle of a ball that is over the line
    height: float  # m

    def over(self, events: Sequence[Event]) -> bool:
        return False

    def passed(self, start: State, end: State) -> Any:
        (x0, y0, *_), (x1, y1, *_) = start, end
        return (x0 < self.line) & (x1 >= self.line) & (y0 < self.height) & (y1 < self.height)


def entered(parameters: Parameters) -> Entered:
    """When it is known that a kick is a goal; that it is none is known at the end."""
    goal, under = parameters.goal, parameters.goal.height - UNDER
    return Entered(goal.distance + goal.post_radius + parameters.ball.radius, under if goal.present else -inf)


def _clearance(run: Run, parameters: Parameters) -> float | None:
    """Gap in m between ball and heads."""
    passed, wall = at_wall(run, parameters), parameters.wall
    return passed.y - parameters.ball.radius - wall.height if passed and wall.present else None


def _under_bar(run: Run, parameters: Parameters) -> float | None:
    """Gap in m between ball and bar; negative if the ball is too high."""
    passed, goal = at_goal(run, parameters), parameters.goal
    return goal.height - passed.y - parameters.ball.radius if passed and goal.present else None


def _flight_time(run: Run, parameters: Parameters) -> float | None:
    """Until the ball first touches anything, or is in the goal, in s."""
    touched = first_touch(run)
    moments = (scored(run, parameters), None if touched is None else touched.t)
    return min((t for t in moments if t is not None), default=None)


def _carry(run: Run, parameters: Parameters) -> float | None:
    """Where the ball first comes down on the grass; None where something else was in the way."""
    touched = first_touch(run)
    return touched.x if touched is not None and touched.partner == "ground" else None


def _apex(run: Run, parameters: Parameters) -> float:
    """Greatest height in m above the point of the kick."""
    return run.highest("ball")[1][1] - run.setup.balls[0].position[1]


def _word(run: Run, parameters: Parameters) -> str:
    """goal; bar or wall, where that was touched and it is no goal; over; short, a ball that stops on the line included;
    past, where there is no goal to hit."""
    if scored(run, parameters) is not None:
        return "goal"
    touched = {event.partner for event in run.events}
    for name in ("bar", "wall"):
        if name in touched:
            return name
    passed = at_goal(run, parameters)
    if passed is None:
        return "short"
    if not parameters.goal.present:
        return "past"
    return "over" if passed.y > parameters.goal.height else "short"


FACTS = (
    Fact("goal", "", "", lambda run, parameters: scored(run, parameters) is not None, entered),
    Fact("verdict", "", "", _word),
    Fact("height_at_goal", "height at goal", "m", at(at_goal, lambda ball: ball.y)),
    Fact("speed_at_goal", "speed at goal", "m/s", at(at_goal, lambda ball: ball.speed), also="km/h"),
    Fact("under_bar", "under the bar", "m", _under_bar),
    Fact("height_at_wall", "height at wall", "m", at(at_wall, lambda ball: ball.y), where=lambda _, p: p.wall.present),
    Fact("over_wall", "over the wall", "m", _clearance),
    Fact("carry", "carry", "m", _carry),
    Fact("apex", "apex", "m", _apex),
    Fact("flight_time", "flight time", "s", _flight_time),
    *LAUNCH,
    ENDED,
)


def verdict(run: Run, parameters: Parameters) -> str:
    """What happened, in a sentence."""
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
