"""Soccer from above: a free kick that bends round the wall, past the keeper, between the posts.

Models: drag with its crisis; the sideways part of the Magnus force; loss of spin; an even wind; posts, wall, keeper
(standing, moving at a given speed, or diving to where he sees the ball go) and net as things to hit.
Leaves out: everything upright. Gravity has no part in this plane, so the scene does not know how high the ball is,
whether it clears the wall, or when it would come down: give it kicks that stay in the air. The speed upward adds to
that over the ground, and so to drag and lift.

Size of what is left out: the default kick, computed in three dimensions, passes the goal line 1 cm farther left if it
rises at 10 deg, 4 cm at 15, 8 cm at 20 and 15 cm at 25; Mencke's kick 3 cm farther right. Far more uncertain is the
lift: published coefficients differ by a factor of two and more (preset mencke-2020).
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from math import cos, inf, radians, tan

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import resolve
from sandbox.kit import (
    BALL_SPEED,
    ENDED,
    LAUNCH_ANGLE,
    LAUNCH_SPIN,
    Air,
    Ball,
    Circle,
    Controls,
    Event,
    Extent,
    Fact,
    Handle,
    Moment,
    Run,
    SceneParameters,
    SceneRun,
    Segment,
    Setup,
    Solid,
    Spin,
    Surface,
    Vector,
    cached_per_run,
    check_apart,
    disc,
    fact_from,
    first_touch,
    group,
    passing,
    quantity,
    rectangle,
    roughly,
    switch,
)
from sandbox.sport import flight
from sandbox.sport.dive import Dive

from ..soccer.scene import SPREAD, Goal, SoccerBall, Wall


class CurledKick(flight.Launch):
    """The ball just after the kick."""

    angle: float = quantity(..., "deg", -180, 180, "direction, to the left of straight at the goal line")
    spin: float = quantity(..., "rpm", -20000, 20000, "positive bends the ball to the left")
    tilt: float = quantity(..., "deg", -90, 90, "lean of the spin's axis from the upright; its cosine bends the ball")

    @property
    def lift_share(self) -> float:
        """The cosine of its tilt."""
        return cos(radians(self.tilt))


class WideGoal(Goal):
    """The goal from above."""

    offset: float = quantity(..., "m", -40, 40, "middle of the goal to the left of the ball")
    width: float = quantity(..., "m", 0, 20, "between the posts")

    @property
    def posts(self) -> tuple[Vector, Vector]:
        """Middles of the right and the left post, in m."""
        aside = 0.5 * self.width + self.post_radius
        return (self.distance, self.offset - aside), (self.distance, self.offset + aside)


class WideWall(Wall):
    """The wall of players, from above."""

    offset: float = quantity(..., "m", -40, 40, "middle of the wall to the left of the ball")
    width: float = quantity(..., "m", 0.1, 40, "from side to side")

    @property
    def extent(self) -> tuple[float, float, float, float]:
        """Front, right, back and left, in m."""
        (front, back), aside = self.sides, 0.5 * self.width
        return front, self.offset - aside, back, self.offset + aside


class Keeper(Solid):
    """The keeper, a disc: heavy, or with a dive as a wall that moves."""

    present: bool = switch(..., "whether there is a keeper")
    distance: float = quantity(..., "m", 0, 20, "in front of the goal line")
    offset: float = quantity(..., "m", -20, 20, "at the kick, to the left of the middle of the goal")
    speed: float = quantity(..., "m/s", -15, 15, "along the goal line from the kick on, to the left")
    radius: float = quantity(..., "m", 0.05, 5, "half the width that he covers")
    mass: float = quantity(..., "kg", 1, 1000, "mass")
    dive: Dive = group(..., "his dive")


class Parameters(SceneParameters):
    """All parameters of a kick."""

    launch: CurledKick = group(..., "the ball just after the kick")
    air: Air = group(..., "the air")
    ball: SoccerBall = group(..., "the ball")
    wall: WideWall = group(..., "the wall of players")
    keeper: Keeper = group(..., "the keeper")
    goal: WideGoal = group(..., "the goal")

    @property
    def stand(self) -> Vector:
        """The place of the keeper at the kick, in m."""
        return self.goal.distance - self.keeper.distance, self.goal.offset + self.keeper.offset


CONTROLS = Controls(
    full_pull_speed=45.0,
    spins=(Spin("launch.spin", 50.0), Spin("launch.tilt", 5.0)),
    sliders=(
        "launch.speed",
        "launch.angle",
        "launch.spin",
        "launch.tilt",
        "goal.distance",
        "air.wind",
        "keeper.dive.dives",
    ),
    handles=(
        Handle("wall.distance", "wall.offset", where="wall.present"),
        Handle("keeper.distance", "keeper.offset", at=lambda it: it.stand, where="keeper.present"),
        Handle("goal.distance", "goal.offset", goal=True),
    ),
    scores="goal",
    spread=SPREAD,
)

#: A kick still moving after this time in s is ended: no ball stays in the air so long. A fast one is ended earlier,
#: after this many times its flight time to the goal line without air, plus a moment to see it saved.
LONGEST, PATIENCE, MOMENT = 10.0, 3.0, 1.0

#: Advertising boards behind the ball, behind the goal line and on either side, in m; a ball that gets there is out.
BOARDS_BEHIND, BOARDS_BEYOND, BOARDS_ASIDE = -15.0, 8.0, 60.0


def build(parameters: Parameters) -> Setup:
    """Ball, keeper, wall, goal and boards. Raises RequestError where one is in another, or the wall behind the goal."""
    launch, air, ball, wall = parameters.launch, parameters.air, parameters.ball, parameters.wall
    goal, keeper, stand, (right, left) = parameters.goal, parameters.keeper, parameters.stand, parameters.goal.posts
    start = disc("the ball", ("ball.radius",), 0.0, 0.0, ball.radius)
    players = [Extent("the wall", ("wall.distance", "wall.offset"), *wall.extent)] if wall.present else []
    line = Extent("the goal", ("goal.distance",), goal.distance, -inf, inf, inf, goal.post_radius)
    check_apart(parameters, start, *players, line)
    forces = flight.forces_in_flight(ball, air, lift_share=launch.lift_share)
    kicked = flight.launched_ball(launch, ball, air, (0.0, 0.0), forces)
    balls, pairs, saves = [kicked], [], []
    if keeper.present:
        standing = disc("the keeper", ("keeper.distance", "keeper.offset"), *stand, keeper.radius)
        check_apart(parameters, start, *players, standing)
        for post in (right, left):
            check_apart(parameters, standing, disc("a post", ("goal.width",), *post, goal.post_radius))
        if keeper.dive.dives:
            saves = [diving_keeper(parameters, kicked)]
        else:
            balls.append(Ball("keeper", keeper.mass, keeper.radius, stand, (0.0, keeper.speed)))
            pairs.append(("ball", "keeper", keeper.bounce))
    back = goal.distance + goal.depth
    boards = rectangle(BOARDS_BEHIND, -BOARDS_ASIDE, goal.distance + BOARDS_BEYOND, BOARDS_ASIDE)
    surfaces = [
        *(Surface("boards", Segment(*ends), 0.0, 0.0) for ends in pairwise(boards)),
        goal.surface("right post", Circle(right, goal.post_radius)),
        goal.surface("left post", Circle(left, goal.post_radius)),
        *goal.net([right, (back, right[1]), (back, left[1]), left]),
        *(wall.outline("wall", rectangle(*wall.extent)) if wall.present else ()),
        *saves,
    ]
    longest = min(LONGEST, PATIENCE * (goal.distance / max(launch.speed, 0.1)) + MOMENT)
    return Setup(balls, surfaces, longest, is_over, pairs=pairs)


def diving_keeper(parameters: Parameters, kicked: Ball) -> Surface:
    """The keeper, who goes where the ball would pass him if it went on as he sees it when he moves: straight."""
    keeper, stand, (right, left) = parameters.keeper, parameters.stand, parameters.goal.posts
    seen = simulate(Setup([kicked], duration=max(keeper.dive.reaction, 1e-3)), resolve("balanced"))
    x, y, vx, vy, _ = seen.state("ball", seen.duration)
    aside = keeper.dive.aside(stand, (x, y), (vx, vy), right[1], left[1])
    return keeper.dive.diving(keeper.surface("keeper", Circle(stand, keeper.radius)), aside)


def is_over(event: Event) -> bool:
    """True if the ball is in the net, or out."""
    return event.ball == "ball" and event.partner in ("net", "boards")


@cached_per_run
def at_goal(run: Run, parameters: Parameters) -> Moment | None:
    """The ball as it passes the goal line; None if it does not get there, or is touched on its way."""
    passed, touched = passing(run, parameters.goal.distance), first_touch(run)
    return None if passed is None or (touched is not None and touched.t < passed.t) else passed


@cached_per_run
def scored(run: Run, parameters: Parameters) -> bool:
    """True if the ball was in the goal, between the posts."""
    goal = parameters.goal
    entries = goal.entries(run, parameters.ball.radius)
    return any(abs(state[1] - goal.offset) < 0.5 * goal.width for _, state in entries)


def deviation(ball: Moment, it: Parameters) -> float | None:
    """Along the goal line in m, from where the straight line of the launch meets it, if it does."""
    angle = it.launch.angle
    return None if abs(angle) >= 90.0 else ball.y - it.goal.distance * tan(radians(angle))


def inside_post(ball: Moment, it: Parameters) -> float:
    """Gap in m between the ball and the nearer post; negative if the ball goes wide."""
    return 0.5 * it.goal.width - abs(ball.y - it.goal.offset) - it.ball.radius


def flight_time(run: Run, parameters: Parameters) -> float | None:
    """Until the goal line or the first touch, in s."""
    found = at_goal(run, parameters) or first_touch(run)
    return None if found is None else found.t


def outcome(run: Run, parameters: Parameters) -> str:
    """goal; saved, post or wall, where that was touched and it is no goal; wide; short of the goal line."""
    if scored(run, parameters):
        return "goal"
    touched = {e.partner if e.ball == "ball" else e.ball for e in run.events if "ball" in (e.ball, e.partner)}
    for name, said in (("keeper", "saved"), ("left post", "post"), ("right post", "post"), ("wall", "wall")):
        if name in touched:
            return said
    return "short" if passing(run, parameters.goal.distance) is None else "wide"


SIDES = ("right", "left")

FACTS = (
    Fact("goal", "", "", scored),
    Fact("saved", "", "", lambda run, it: outcome(run, it) == "saved", most=1),
    Fact("verdict", "", "", outcome),
    Fact("deviation", "bend", "m", fact_from(at_goal, deviation), sides=SIDES),
    Fact("inside_post", "nearer post", "m", fact_from(at_goal, inside_post), sides=("outside", "inside")),
    Fact("speed_at_goal", "speed at goal", "m/s", fact_from(at_goal, "speed"), also="km/h"),
    Fact("flight_time", "flight time", "s", flight_time),
    BALL_SPEED,
    replace(LAUNCH_ANGLE, sides=SIDES),
    replace(LAUNCH_SPIN, sides=SIDES),
    Fact(
        "offset_at_goal",
        "from the middle",
        "m",
        fact_from(at_goal, lambda ball, it: ball.y - it.goal.offset),
        sides=SIDES,
    ),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    said, bend, inside = (run.result[key] for key in ("verdict", "deviation", "inside_post"))
    if said == "goal":
        if inside is None:
            return "Goal"
        if bend is not None and abs(bend) >= 0.05:
            return f"Goal, bent {roughly(abs(bend))} to the {SIDES[bend > 0.0]}"
        return f"Goal, {roughly(max(0.0, inside))} inside the post"
    if said == "wide" and inside is not None:
        return f"Wide by {roughly(max(0.0, -inside))}"
    ways = {"saved": "Saved by the keeper", "post": "Off the post", "wall": "Into the wall"}
    return ways.get(said, "Wide of the goal" if said == "wide" else "Short of the goal line")
