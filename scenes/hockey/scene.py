"""Hockey from above, a puck off the boards and past the players, or on an air table. Not validated.

Models: constant friction of the ice, none of an air table; drag of a puck that flies flat; impacts with boards, posts,
net and players, with friction and the puck's spin; players, or mallets, that stand or move at an even speed; a goalie
who dives to where it goes.
Leaves out: the third dimension, and with it the saucer pass and every shot that leaves the ice; how a spinning puck is
slowed less along its path (0.1 % of the friction at 45 m/s and 20 rev/s, all of it where it spins without moving); the
near slot of a table. A rounded corner is 64 chords, 0.7 deg off at most.
Assumed, as nothing measured was found: drag, the friction of ice, and how boards and players answer.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal

import numpy as np

from sandbox.kit import (
    ENDED,
    Circle,
    Controls,
    Fact,
    Glide,
    Group,
    Handle,
    Run,
    SceneRun,
    Segment,
    Setup,
    Spin,
    Spread,
    Surface,
    Touches,
    Trap,
    Vector,
    before,
    choice,
    group,
    groups,
    quantity,
    roughly,
)
from sandbox.sport.dive import Dive
from sandbox.sport.sliding import Slide, Sliding, SlidingDisc, check_inside, collisions_of, end_of, removed_by, rounded

DECIDING = {"goal", "goalie", "defender", "receiver"}
POST, DEPTH = 0.030, 1.0  # m: radius of a post (NHL rule 2.1), depth of the net
LOOK = 0.01  # s between places of which the nearest to a receiver is found


class PuckShot(Slide):
    """The puck as it leaves the stick."""

    x: float = quantity(..., "m", -40, 40, "where it starts, from the middle towards the goal")


class Rink(Group):
    """The ice, or the table."""

    length: float = quantity(..., "m", 0.5, 80, "from end to end")
    width: float = quantity(..., "m", 0.3, 40, "from side to side")
    corner: float = quantity(..., "m", 0.01, 15, "radius of the corners")
    goal_line: float = quantity(..., "m", 0, 10, "from the boards; 0: the goal is a slot in them, as of a table")
    goal_width: float = quantity(..., "m", 0.1, 5, "between the posts")
    sliding: float = quantity(..., "", 0, 1, "friction of puck and ice")

    @property
    def line(self) -> float:
        """The distance of the goal line from the middle, in m."""
        return 0.5 * self.length - self.goal_line

    @property
    def outline(self) -> list[Vector]:
        """The boards' inside, from one side of the goal to the other."""
        return rounded(self.length, self.width, self.corner, self.goal_width)


class Player(Group):
    """A player, or a mallet: a disc that keeps its speed; one that stands holds its ground when it is hit."""

    role: Literal["goalie", "defender", "receiver", "mallet"] = choice("goalie", "what it does; a pass is received")
    x: float = quantity(0.0, "m", -40, 40, "from the middle towards the goal")
    y: float = quantity(0.0, "m", -20, 20, "to the left")
    vx: float = quantity(0.0, "m/s", -15, 15, "towards the goal")
    vy: float = quantity(0.0, "m/s", -15, 15, "to the left")


class Puck(SlidingDisc):
    """The puck, and how it meets the boards."""

    height: float = quantity(..., "m", 0.001, 0.2, "thickness")
    drag: float = quantity(..., "", 0, 2, "drag coefficient, edge on")


class Air(Group):
    """The air."""

    density: float = quantity(..., "kg/m^3", 0, 1500, "density")


class Parameters(Sliding):
    """All parameters of a shot."""

    launch: PuckShot = group(..., "the puck as it leaves the stick")
    players: list[Player] = groups(..., "who is on the ice")
    player: SlidingDisc = group(..., "what they are, and how the puck meets them")
    dive: Dive = group(..., "the goalie's dive")
    puck: Puck = group(..., "the puck, and how it meets the boards")
    air: Air = group(..., "the air")
    rink: Rink = group(..., "the ice, or the table")
    duration: float = quantity(..., "s", 0.1, 60, "shown at most")


CONTROLS = Controls(
    full_pull_speed=50.0,
    spins=(Spin("launch.spin", 50.0),),
    ball="puck",
    handles=(Handle("players[*].x", "players[*].y"), Handle("launch.x", "launch.aside")),
    sliders=(
        "launch.speed",
        "launch.angle",
        "launch.x",
        "launch.aside",
        "rink.sliding",
        "puck.restitution",
        "dive.dives",
    ),
    scores="done",
    spread=(Spread("launch.speed", 0.05), Spread("launch.angle", minimum=1.0)),  # assumed
)


def build(parameters: Parameters) -> Setup:
    """The puck, the players, boards and goal. The run ends with a goal, and where the puck stops."""
    it, puck, rink, line = parameters, parameters.puck, parameters.rink, parameters.rink.line
    half, boards, inside = 0.5 * rink.goal_width, rink.outline, line + puck.radius + POST
    surfaces = puck.outline("boards", boards if rink.goal_line == 0.0 else [*boards, boards[0]])
    for x, back in ((line, line + DEPTH), (-line, -line - DEPTH)) if rink.goal_line > 0.0 else ():
        corners = [(x, half + POST), (back, half + POST), (back, -half - POST), (x, -half - POST)]
        surfaces += [puck.surface("post", Circle(post, POST)) for post in (corners[0], corners[3])]
        surfaces += [Surface("net", Segment(*ends), 0.1, 0.5) for ends in pairwise(corners)]
    goal = Trap("goal", (inside, POST - half), POST, (inside, half - POST), ["puck"])
    bodies = [puck.at("puck", (it.launch.x, it.launch.aside), it.launch.velocity, it.launch.turning)]
    bodies += [it.player.at(name, (who.x, who.y), (who.vx, who.vy)) for name, who in named(it.players)]
    drag = 0.5 * it.air.density * puck.drag * 2.0 * puck.radius * puck.height / puck.mass
    check_inside(bodies, rink.length, rink.width, rink.corner)
    dives = [name for name, who in named(it.players) if it.dive.dives and who.role == "goalie"]
    for goalie in [who for who in bodies if who.name in dives]:
        aside = it.dive.aside(goalie.position, bodies[0].position, bodies[0].velocity, -half, half)
        shape = Circle(goalie.position, goalie.radius)
        surfaces.append(it.dive.diving(it.player.surface(goalie.name, shape), aside))
    bodies = [who for who in bodies if who.name not in dives]
    return Setup(
        bodies,
        surfaces,
        it.duration,
        Touches("goal"),
        it.player.bounce,
        Glide(rink.sliding, 2.0 / 3.0 * rink.sliding, it.gravity, drag=drag),
        [goal],
        planes=[(who.name, Glide(0.0 if any(who.velocity) else 1.0)) for who in bodies[1:]],
    )


def named(players: Sequence[Player]) -> list[tuple[str, Player]]:
    """The players with their names: what they do, and a number."""
    return [(f"{who.role} {i}", who) for i, who in enumerate(players, 1)]


def touches(run: Run, parameters: Parameters) -> list[str]:
    """The things that the puck meets, in order."""
    return [what for what, _ in collisions_of(run, "puck")]


def decided(run: Run, parameters: Parameters) -> tuple[float, str]:
    """The time in s at which the shot is decided, and by the goal or which player; "" where by none."""
    found = ((event.t, what.partition(" ")[0]) for what, event in collisions_of(run, "puck"))
    return next(((t, what) for t, what in found if what in DECIDING), (run.duration, ""))


def _word(run: Run, parameters: Parameters) -> str:
    """goal, received, saved, or who else stops it; post, wide; short of the goal line."""
    by, line = decided(run, parameters)[1], parameters.rink.line
    if by:
        return {"receiver": "received", "goalie": "saved"}.get(by, by)
    farthest = max(state[0] for _, state in run.ends("puck"))
    return "post" if "post" in touches(run, parameters) else "wide" if farthest > line - 0.1 else "short"


def _off_boards(run: Run, parameters: Parameters) -> int:
    """The number of times the puck goes off the boards, until the shot is decided."""
    end = decided(run, parameters)[0]
    return sum(what == "boards" and event.t <= end for what, event in collisions_of(run, "puck"))


FACTS = (
    Fact("speed", "at the end", "m/s", lambda run, it: before(run, decided(run, it)[0], "puck").speed, also="mph"),
    Fact("time", "time", "s", lambda run, it: decided(run, it)[0]),
    Fact("boards", "off the boards", "", _off_boards),
    Fact("release", "release", "m/s", lambda run, it: it.launch.speed, "start", also="mph"),
    Fact("goal", "", "", lambda run, it: "puck" in removed_by(run), most=1),
    Fact("saved", "", "", lambda run, it: _word(run, it) == "saved", most=1),
    Fact("verdict", "", "", _word),
    Fact("done", "", "", lambda run, it: _word(run, it) in ("goal", "received")),
    Fact("touches", "", "", touches),
    ENDED,
)


def missed_by(run: SceneRun, parameters: Parameters) -> float | None:
    """Return the distance in m at which the puck passes the nearest receiver, between their edges; None without one."""
    names = [name for name, who in named(parameters.players) if who.role == "receiver"]
    times = np.linspace(0.0, run.duration, 2 + round(run.duration / LOOK))
    puck, touching = run.states("puck", times)[:, :2], parameters.puck.radius + parameters.player.radius
    gaps = [np.hypot(*(run.states(name, times)[:, :2] - puck).T).min() - touching for name in names]
    return max(0.0, float(min(gaps))) if gaps else None


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    said, off = run.result["verdict"], ", off the boards" if run.result["boards"] else ""
    if said in ("goal", "received"):
        return f"{said.capitalize()} at {run.result['speed']:.1f} m/s{off}"
    missed = missed_by(run, parameters) if said in ("wide", "short", "post") else None
    if missed is not None:
        return f"Misses the receiver by {roughly(missed)}{off}"
    ways = {"saved": "Saved by the goalie", "post": "Off the post", "wide": "Wide of the goal"}
    before = f"Stops {roughly(max(0.0, parameters.rink.line - end_of(run, 'puck')[0]))} before the goal line"
    return ways.get(said, before if said == "short" else f"Stopped by the {said}")
