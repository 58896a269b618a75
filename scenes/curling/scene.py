"""Curling from above: a stone slides up the sheet, curls towards its spin, and meets those that lie there.

Models: friction that grows as the stone slows, and the curl, by the law of the Digital Curling competition; sweeping as
factors on both over a stretch; impacts with friction; stones across a side line or the back line, or short of the hog
line, are taken off.
Leaves out: the wear of the pebble; the rule on early guards. Not validated: sweeping, and how stones meet.
"""

from __future__ import annotations

from dataclasses import replace
from math import hypot
from typing import Any, Literal

from sandbox.kit import (
    ENDED,
    Controls,
    CurlingIce,
    Fact,
    Group,
    Handle,
    Run,
    SceneRun,
    Setup,
    Spin,
    Spread,
    Strips,
    Vector,
    choice,
    fact_from,
    group,
    groups,
    passing,
    quantity,
    roughly,
)
from sandbox.sport.sliding import (
    REST_TIME,
    Sliding,
    SlidingDisc,
    beside,
    beyond,
    end_of,
    in_play,
    lateral_offset,
    removed_by,
)

Team = Literal["red", "yellow"]
#: The sheet (World Curling, rule R1), in m from the tee: back line, hog line, the one of release; radii of the rings.
BACK, HOG, RELEASE, RINGS = 1.8288, -6.4008, -28.3464, (1.8288, 1.2192, 0.6096, 0.1524)
DELIVERED, LONGEST = "stone", 120.0  # its name; s after which a throw is ended


class Ice(Group):
    """The ice, compared with that of the law."""

    friction: float = quantity(..., "", 0.1, 5, "factor on the friction")
    curl: float = quantity(..., "", 0, 5, "factor on the curl")


class Sweeping(Ice):
    """Sweeping in front of the stone that is delivered; places from the tee on."""

    start: float = quantity(..., "m", -28.3464, 5, "where it begins")
    end: float = quantity(..., "m", -28.3464, 5, "where it ends; before its start: nobody sweeps")


class LyingStone(Group):
    """A stone that lies on the sheet; the tee is the origin."""

    team: Team = choice("yellow", "whose stone it is")
    x: float = quantity(0.0, "m", -28, 1.97, "beyond the tee; negative before it")
    y: float = quantity(0.0, "m", -2.2, 2.2, "to the left")


class Parameters(Sliding):
    """All parameters of a throw."""

    team: Team = choice(..., "whose stone is thrown")
    stones: list[LyingStone] = groups(..., "those that lie on the sheet")
    sweep: Sweeping = group(..., "sweeping")
    ice: Ice = group(..., "the ice")
    width: float = quantity(..., "m", 2, 6, "of the sheet, between the side lines")
    stone: SlidingDisc = group(..., "the stones")


CONTROLS = Controls(
    full_pull_speed=4.0,
    spins=(Spin("launch.spin", 1.0),),
    ball=DELIVERED,
    handles=(Handle("stones[*].x", "stones[*].y"),),
    sliders=("launch.speed", "launch.angle", "sweep.start", "sweep.end", "ice.friction", "ice.curl"),
    scores="good",
    spread=(Spread("launch.speed", 0.01), Spread("launch.angle", minimum=0.15)),  # assumed
    next_start=lambda run, parameters: left_on_sheet(run, parameters),
)


def build(parameters: Parameters) -> Setup:
    """The stones, the ice, swept for one of them, and the lines that take stones off."""
    it, stone, sweep, side = parameters, parameters.stone, parameters.sweep, 0.5 * parameters.width
    it.launch.check(side - stone.radius)
    lying = [stone.at(f"{spot.team} {i}", (spot.x, spot.y)) for i, spot in enumerate(it.stones, 1)]
    balls = [stone.at(DELIVERED, (RELEASE, it.launch.aside), it.launch.velocity, it.launch.turning), *lying]
    ice = _ice(it)
    swept = replace(ice, friction=ice.friction * sweep.friction, curl=ice.curl * sweep.curl)
    own = [(DELIVERED, Strips((sweep.start, sweep.end), (ice, swept, ice)))] if sweep.end > sweep.start else []
    sides = beside("side line", side, RELEASE - 1.0, BACK + 1.0, -stone.radius)
    back = beyond("back line", (BACK, -side), (BACK, side), stone.radius)
    return Setup(balls, duration=LONGEST, between_balls=stone.bounce, plane=ice, planes=own, traps=[*sides, back])


def _ice(parameters: Parameters) -> CurlingIce:
    return CurlingIce(parameters.ice.friction, parameters.ice.curl, gravity=parameters.gravity)


def team_of(name: str, parameters: Parameters) -> str:
    """The team of a stone, by its name."""
    return parameters.team if name == DELIVERED else name.partition(" ")[0]


def _lie(run: Run, parameters: Parameters) -> dict[str, Vector]:
    """The positions of the stones in play, in m; not the delivered one short of the hog line, unless it met one."""
    places, met = in_play(run), any(event.kind == "impact" for event in run.events)
    if end_of(run, DELIVERED)[0] < HOG + parameters.stone.radius and not met:
        places.pop(DELIVERED, None)
    return places


def _score(run: Run, parameters: Parameters) -> tuple[str, int]:
    """The team that would score, and its points: its stones in the house, nearer to the tee than all others'."""
    far = sorted((hypot(*place), team_of(name, parameters)) for name, place in _lie(run, parameters).items())
    house = [team for distance, team in far if distance < RINGS[0] + parameters.stone.radius]
    others = next((i for i, team in enumerate(house) if team != house[0]), len(house))
    return (house[0] if house else ""), others


def removed(run: Run, parameters: Parameters) -> list[str]:
    """The stones that are no longer in play."""
    lie = _lie(run, parameters)
    return [stone.name for stone in run.setup.balls if stone.name not in lie]


FACTS = (
    Fact("scores", "scores", "", lambda run, it: _score(run, it)[0]),
    Fact("points", "points", "", lambda run, it: _score(run, it)[1]),
    Fact(
        "to_tee",
        "to the tee",
        "m",
        fact_from(lambda run, it: _lie(run, it).get(DELIVERED), lambda place, _: hypot(*place)),
    ),
    Fact("curl", "curl", "m", lambda run, it: lateral_offset(run, DELIVERED, it.launch), sides=("right", "left")),
    Fact("distance", "way up the sheet", "m", lambda run, it: end_of(run, DELIVERED)[0] - RELEASE),
    Fact("hog_to_hog", "hog to hog", "s", fact_from(lambda run, it: passing(run, HOG, DELIVERED), "t")),
    REST_TIME,
    Fact("removed", "taken off", "", removed, names=True),
    Fact("friction", "", "%", lambda run, it: 100.0 * _ice(it).deceleration(it.launch.speed) / it.gravity, "start"),
    Fact("good", "", "", lambda run, it: _score(run, it)[0] == it.team),
    Fact("positions", "", "m", lambda run, it: {name: [*place] for name, place in _lie(run, it).items()}),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    (team, points), line = _score(run, parameters), removed_by(run).get(DELIVERED)
    gone = [name for name in run.result["removed"] if name != DELIVERED]
    text = "stays" if gone else f"lies {roughly(run.result['to_tee'] or 0.0)} from the tee"
    if DELIVERED in run.result["removed"]:
        text = f"goes over the {line}" if line else "stops short of the hog line"
    text = f"takes out {len(gone)} and {text}" if gone else text
    return f"{text[0].upper()}{text[1:]}; " + (f"{team} lies {points}" if team else "nobody lies in the house")


def left_on_sheet(run: Run, parameters: Parameters) -> dict[str, Any]:
    """The stones for the next throw, of the other team."""
    there, other = _lie(run, parameters), "yellow" if parameters.team == "red" else "red"
    spots = [{"team": team_of(name, parameters), "x": x, "y": y} for name, (x, y) in there.items()]
    return {"stones": spots, "team": other}
