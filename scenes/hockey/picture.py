"""Hockey from above: the ice with its lines, creases and goals, or a table; who stands there, and where the puck goes.

The middle of the rink is the origin, lengths are in m. Where the lines are follows NHL rule 1.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from itertools import chain, product
from math import dist, inf

import numpy as np
import pygame

from sandbox.kit import (
    AboveView,
    Area,
    Box,
    Camera,
    Colour,
    Event,
    Look,
    Mark,
    Painter,
    Shape,
    Story,
    goal,
    near,
    scene_colours,
)
from sandbox.picture.answer import Pulled
from sandbox.picture.places.plan import Ground, Kit, Line, Person, Plan, Point, Spot, Worn, arc
from sandbox.sport.dive import place_of

from .scene import Parameters, Player, Rink, decided, named

COLOURS = scene_colours(__file__)
MARK = Mark(COLOURS["shine"], near(np.array([(0.0, 0.7, 0.7)]), 0.25))
LOOKS = {name: Look(COLOURS[name], MARK, gloss=0.6) for name in ("puck", "air_puck", "mallet")}

#: From the middle to the blue lines and to the spots of the neutral zone; from the goal lines to the spots of the ends;
#: across to all of them; radii of circles, creases and spots; widths of the wide and the thin lines; depth of a goal.
BLUE, NEUTRAL, END, ASIDE, RING, CREASE = 7.62, 6.1, 6.1, 6.706, 4.572, 1.83
SPOT, WIDE, THIN, DEPTH = 0.3, 0.3, 0.05, 1.0
#: Thickness of the boards, as a share of the rink's width; reach of the hall; a post's radius; a goal's height;
#: between the holes of an air table.
BOARDS, FAR, POST, HEIGHT, HOLES = 0.025, 200.0, 0.03, 1.22, 0.075

#: The picture shows so much ice around the puck's path, and whoever is so near to it, in m.
AROUND, WITH = 3.0, 4.0
#: How far a goalie who dives holds out each hand, in m.
SPREAD = 0.6

BOTH = (-1, 1)


class Picture(AboveView[Parameters]):
    OTHER_TRACES, THING, CAVEAT = COLOURS["earlier"], "puck", "not validated"
    STANDS_UPRIGHT = True

    @property
    def table(self) -> bool:
        return self.parameters.rink.goal_line == 0.0

    @property
    def balls(self) -> list[str]:
        """With the mallets of a table; players are drawn as people."""
        return [ball.name for ball in self.run.setup.balls if self.table or ball.name == "puck"]

    @cached_property
    def story_end(self) -> float:
        return min(self.run.duration, decided(self.run, self.parameters)[0] + 0.5)

    @property
    def aims(self) -> list[Box]:
        """The goals, or the slots of a table."""
        rink = self.parameters.rink
        end, half, deep = rink.line, 0.5 * rink.goal_width, DEPTH if rink.goal_line else 0.02 * rink.length
        return [Box(end, -half, end + deep, half), Box(-end - deep, -half, -end, half)]

    @property
    def story(self) -> Story:
        """The goal, or where the puck ends up."""
        at = decided(self.run, self.parameters)[0]
        return self.meeting(*self.aims, share=0.4, spot=0.3 if self.table else 3.0, at=at)

    @cached_property
    def must_show(self) -> np.ndarray:
        """All of a table; of the ice what the puck crosses, with whoever it comes near."""
        rink = self.parameters.rink
        whole = 0.51 * np.array([(-rink.length, -rink.width), (rink.length, rink.width)])
        if self.table:
            return whole
        names = ["puck", *(name for name, _ in named(self.parameters.players))]
        spots = [*self.points, *(self.place_of(name, self.story_end) for name in names)]
        close = np.array([spot for spot in spots if np.hypot(*(self.points - spot).T).min() < WITH])
        return np.clip([close.min(axis=0) - AROUND, close.max(axis=0) + AROUND], *whole)

    @cached_property
    def plan(self) -> Plan:
        return air_table(self.parameters.rink) if self.table else ice_rink(self.parameters.rink)

    @property
    def area(self) -> Area:
        area = super().area
        return area if self.table else area._replace(bottom=area.bottom - 12 * self.unit)

    @property
    def opening(self) -> pygame.Rect:
        frame, area = self.sheet.frame, self.area
        top, bottom = round(area.top - 8 * self.unit), round(area.bottom + 8 * self.unit)
        return pygame.Rect(frame.left, top, frame.width, bottom - top)

    def backdrop(self, painter: Painter, camera: Camera) -> None:
        """The ice as through a window, so that text stands on dark ground."""
        super().backdrop(painter, camera)
        (width, height), ice = self.size, self.opening
        for left, high, right, low in (
            *((0, 0, width, ice.top), (0, ice.bottom, width, height)),
            *((0, ice.top, ice.left, ice.bottom), (ice.right, ice.top, width, ice.bottom)),
        ):
            painter.surface.fill(COLOURS["hall"], (left, high, right - left, low - high))

    def place_of(self, name: str, t: float) -> Point:
        """Return the place of someone on the ice at time t in s, in m."""
        dives = place_of(self.run.setup.surfaces, name, t)
        if dives is not None:
            return dives
        x, y, *_ = self.run.state(name, t)
        return x, y

    @cached_property
    def goal(self) -> Event | None:
        """The goal, if it is one."""
        return next((e for e in self.run.events if e.kind == "caught" and e.ball == "puck"), None)

    @cached_property
    def pulled(self) -> Sequence[Pulled]:
        """The back of the net behind a goal, too, which ends the run."""
        nets, goal, half = [*super().pulled], self.goal, 0.5 * self.parameters.rink.goal_width
        if goal is not None and not self.table:
            _, _, vx, vy, _ = self.run.before("puck", goal.t)
            back = self.parameters.rink.line + DEPTH
            far = back - goal.x
            y = goal.y + far * vy / vx
            nets.append(Pulled(goal.t, (back, y), (1.0, 0.0), (half - y, y + half), vx, True, COLOURS["net"]))
        return nets

    def position_of(self, name: str, t: float) -> Point:
        """A puck in the goal goes on into the net, as that answers."""
        if self.answering is None or self.table or t < self.caught.get(name, inf):
            return super().position_of(name, t)
        (x, y), (nx, _) = self.pulled[-1].at, self.pulled[-1].normal
        return x - nx * self.radii[name], y

    def draw_driven(self, painter: Painter, camera: Camera, t: float, opacity: float = 1.0) -> None:
        """Nothing moves but the goalie, who is drawn as a person."""

    @property
    def moment(self) -> float:
        """The time in s at which a poster shows the players: of a dive when it is over or the puck is met."""
        return decided(self.run, self.parameters)[0] if self.parameters.dive.dives else 0.0

    @property
    def people(self) -> list[Person]:
        """Those on the ice when one of them dives: no label may hide that."""
        players = named(self.parameters.players) if self.parameters.dive.dives and not self.table else []
        return [self._person(name, who, self.moment) for name, who in players]

    def look_of(self, name: str) -> Look:
        return LOOKS["mallet" if name != "puck" else "air_puck" if self.table else "puck"]

    def colour_of(self, name: str) -> Colour:
        return COLOURS["mallet" if name != "puck" else "air_trace" if self.table else "trace"]

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """Whoever is on the ice, at time t in s, in the circle that the puck cannot enter."""
        reach, thin = self.parameters.player.radius * camera.scale, max(1.0, 1.2 * self.unit)
        for name, who in [] if self.table else named(self.parameters.players):
            person = self._person(name, who, t)
            if person.arms:
                painter.ring(camera.pixel(who.x, who.y), reach, thin, COLOURS["shadow"], 0.6)
            painter.disc(camera.pixel(*person.at), reach, COLOURS["shirts"][who.role], 0.35)
            person.draw(painter, camera)

    def _person(self, name: str, who: Player, t: float) -> Person:
        """Someone on the ice at time t in s; a goalie who dives holds out the arms."""
        place, kit = self.place_of(name, t), Kit(**COLOURS["kit"], shirt=COLOURS["shirts"][who.role])
        dives = self.parameters.dive.dives and who.role == "goalie" and dist(place, (who.x, who.y)) > 0.05
        return Person(place, 180.0, kit, arms=SPREAD if dives else 0.0)


def _walls(around: Sequence[Point], boards: Colour, floor: Colour) -> Plan:
    """The hall, the boards along an outline, and what is inside."""
    x, y = (max(point[axis] for point in around) for axis in (0, 1))
    thick = 2.0 * BOARDS * y
    outer = tuple((a * (1.0 + thick / x), b * (1.0 + thick / y)) for a, b in around)
    return Ground(Box(-FAR, -FAR, FAR, FAR), COLOURS["hall"]), Shape(outer, boards), Shape(tuple(around), floor)


def _across(around: Sequence[Point], x: float) -> tuple[Point, Point]:
    """The line across at x, between the boards."""
    side = min(around, key=lambda point: (abs(point[0] - x), -point[1]))[1]
    return (x, -abs(side)), (x, abs(side))


def ice_rink(rink: Rink) -> Plan:
    """Ice inside the boards."""
    red, blue, post, net = (COLOURS[part] for part in ("red", "blue", "post", "net"))
    around, line, half = rink.outline, rink.line, 0.5 * rink.goal_width
    ends = (-line, -DEPTH), (line, DEPTH)
    end, neutral = ([(sx * x, sy * ASIDE) for sx, sy in product(BOTH, BOTH)] for x in (line - END, NEUTRAL))
    creases = [arc((side * line, 0.0), CREASE, 90.0 * side, 90.0 * side + 180.0) for side in BOTH]
    return (
        *_walls(around, COLOURS["boards"], COLOURS["ice"]),
        *(Worn((x, 4.0), 7.0, 4.5, COLOURS["lamp"], 0.5) for x in (-20, -7, 7, 20)),
        *(Shape(crease, COLOURS["crease"]) for crease in creases),
        *(Line(_across(around, x), WIDE, blue) for x in (-BLUE, BLUE)),
        Line(_across(around, 0.0), WIDE, red),
        *(Line(_across(around, x), THIN, red) for x in (-line, line)),
        Spot((0.0, 0.0), RING, blue, THIN),
        *(Spot(spot, RING, red, THIN) for spot in end),
        *(Spot(spot, SPOT, red) for spot in (*end, *neutral)),
        Line((*around, around[0]), 0.15, COLOURS["kick"]),
        *chain(*(goal(x, deep, HEIGHT, rink.goal_width, POST, post, post, net, -half, 0.5) for x, deep in ends)),
    )


def air_table(rink: Rink) -> Plan:
    """A table, with a slot in its far end for a goal."""
    around, half, thin, marking = rink.outline, 0.5 * rink.goal_width, 0.006, COLOURS["marking"]
    end = max(point[0] for point in around)
    side = max(point[1] for point in around)
    holes = product(np.arange(-0.96 * end, 0.97 * end, HOLES), np.arange(-0.94 * side, 0.95 * side, HOLES))
    return (
        *_walls(around, COLOURS["rail"], COLOURS["table"]),
        Worn((-0.1 * end, 0.2 * side), 0.6 * end, 0.55 * side, COLOURS["lamp"], 0.16),
        *(Spot((float(x), float(y)), 0.004, COLOURS["hole"]) for x, y in holes),
        Line(_across(around, 0.0), thin, marking),
        Spot((0.0, 0.0), half, marking, thin),
        *(Line(arc((side * end, 0.0), half, 90.0 * side, 90.0 * side + 180.0), thin, marking) for side in BOTH),
        Ground(Box(end, -half, 1.02 * end, half), COLOURS["slot"]),
    )
