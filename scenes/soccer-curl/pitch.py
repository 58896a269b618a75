"""The end of a pitch from above: what it is made of, where, and in which colours."""

from __future__ import annotations

from math import acos, degrees

from sandbox.picture.ball import Look, patches
from sandbox.picture.camera import Box
from sandbox.picture.palette import scene_colours
from sandbox.picture.places.plan import BREADTH, Bar, Ground, Kit, Line, Net, Person, Plan, Spot, Stripes, Worn, arc

from .scene import BOARDS_ASIDE, BOARDS_BEHIND, BOARDS_BEYOND, Goal, Parameters, Wall

COLOURS = scene_colours(__file__)

BALL = Look(COLOURS["ball"], patches(COLOURS["patch"]))
WALL, KICKER, KEEPER = (
    Kit(COLOURS["skin"], COLOURS["skin_far"], COLOURS["hair"], shirt, COLOURS["gloves"]) for shirt in COLOURS["shirts"]
)

#: Stripes as wide as the goal area is deep, lines, and what they bound (Laws of the Game, law 1), in m.
STRIPE, LINE = 5.5, 0.12
GOAL_AREA, PENALTY_AREA, SPOT, CIRCLE = (5.5, 18.32), (16.5, 40.32), 11.0, 9.15
LENGTH, WIDTH = 105.0, 68.0
#: Boards are so thick and so long, in m; behind them there is nothing to see, however far the camera looks.
BOARD, BOARD_LENGTH, FAR = 0.4, 6.0, 1000.0
#: The net's mesh, and how far behind the ball the kicker stands, in m.
MESH, BEHIND = 0.12, 0.75


def pitch(parameters: Parameters) -> Plan:
    """Grass between boards, lines, goal, wall and kicker."""
    return (
        *_grass(parameters.goal.distance + BOARDS_BEYOND, parameters.goal.distance),
        *_lines(parameters.goal.distance, parameters.goal.offset),
        *_goal(parameters.goal),
        *(_wall(parameters.wall) if parameters.wall.present else ()),
        Person((0.0, 0.0), parameters.launch.angle, KICKER, behind=BEHIND),
    )


def _grass(right: float, goal_line: float) -> Plan:
    left, aside = BOARDS_BEHIND, BOARDS_ASIDE
    boards = (Box(left - BOARD, -aside, left, aside), Box(right, -aside, right + BOARD, aside))
    return (
        Ground(Box(-FAR, -FAR, FAR, FAR), COLOURS["beyond"]),
        Stripes(Box(left, -aside, right, aside), COLOURS["grass"], STRIPE, goal_line),
        *(Stripes(box, COLOURS["boards"], BOARD_LENGTH, -aside, along=True) for box in boards),
    )


def _lines(end: float, middle: float) -> Plan:
    """As far as there is any of them between the boards, with the goal line at x = ``end``."""
    half_way, start = end - LENGTH / 2, max(end - LENGTH, BOARDS_BEHIND)
    side = min(WIDTH / 2, BOARDS_ASIDE - abs(middle))
    left, right = middle + side, middle - side
    lines = [((end, right), (end, left)), ((start, left), (end, left)), ((start, right), (end, right))]
    lines += [((half_way, right), (half_way, left))] if half_way > start else []
    for deep, wide in (GOAL_AREA, PENALTY_AREA):
        front, aside = max(end - deep, start), wide / 2
        lines += [((front, middle + way * aside), (end, middle + way * aside)) for way in (-1, 1)]
        lines += [((front, middle - aside), (front, middle + aside))] if end - deep > start else []
    spot, turn = (end - SPOT, middle), degrees(acos((PENALTY_AREA[0] - SPOT) / CIRCLE))
    curve = arc(spot, CIRCLE, 180 - turn, 180 + turn)
    return (*(Line(points, LINE, COLOURS["line"]) for points in (*lines, curve)), Spot(spot, LINE, COLOURS["line"]))


def _goal(goal: Goal) -> Plan:
    """The worn grass before it, its net, bar and posts."""
    line, aside = goal.distance, goal.width / 2 + goal.post_radius
    right, left = goal.offset - aside, goal.offset + aside
    return (
        Worn((line - 0.3, goal.offset), 1.2, 0.42 * goal.width, COLOURS["worn"], 0.4),
        Net(Box(line, right, line + goal.depth, left), MESH, COLOURS["net"]),
        Bar((line, right), (line, left), goal.post_radius, COLOURS["post"]),
    )


def _wall(wall: Wall) -> Plan:
    """Players shoulder to shoulder."""
    count = max(1, round(wall.width / BREADTH))
    breadth = wall.width / count
    places = [wall.offset + (i - (count - 1) / 2) * breadth for i in range(count)]
    return tuple(Person((wall.distance, y), 180.0, WALL, breadth) for y in places)
