"""Billiards from above: the table under its lamp, each path in its ball's colour, and what was struck where."""

from __future__ import annotations

from functools import cached_property
from math import floor

import numpy as np
import pygame

from sandbox.kit import (
    AboveView,
    Area,
    Box,
    Camera,
    Colour,
    Entry,
    Look,
    Painter,
    Sheet,
    Story,
    mix,
    palette,
    round_number_above,
    scene_colours,
)
from sandbox.picture.places.plan import Ground, Line, Plan, Point, Spot, arc
from sandbox.picture.places.table import Lamp, Pocket, Rails, Room, around, cushions, sights
from sandbox.sport.sliding import collisions_of

from . import balls
from .scene import Parameters

CARD, COLOURS = palette("card"), scene_colours(__file__)

#: Most dots on the struck ball's path.
DOTS = 16
#: A ball that goes no further than this, in radii, is taken not to have moved.
LEAST_WAY = 0.3
#: Least width of the wood beyond the cushions, and beyond the pockets; of a line on the cloth and of a spot, in m.
WOOD, ROUND_POCKETS, LINE, SPOT = 0.10, 0.032, 0.004, 0.0055
#: The maker's plate on the head rail: its width and length, and how far from the table's edge its middle lies, in m.
PLATE, PLATE_LENGTH, PLATE_INSIDE = 0.013, 0.16, 0.026
#: Head spot, centre spot and foot spot, as shares of half the length.
SPOTS = (-0.5, 0.0, 0.5)
#: Snooker's markings (WPBSA): from the head cushion to the line, the D's radius, from the foot cushion to the black, m.
BAULK, D_RADIUS, BLACK_SPOT = 0.737, 0.292, 0.324

#: Half the width of what is seen of a first contact, in radii, and its share of the picture's height.
PILE, PILE_SHARE = 8.0, 0.45

MARKING = mix(COLOURS["cloth"], COLOURS["marking"], 0.55)
#: The cloth between the jaws lies in the cushions' shadow.
THROAT = mix(COLOURS["cloth"], COLOURS["rim"], 0.5)


class Picture(AboveView[Parameters]):
    """One shot on a table that stands still."""

    OTHER_TRACES = COLOURS["earlier"]
    STANDS_UPRIGHT = True
    SPIN_NAMES = ("left", "right")  # counter-clockwise is what a tip to the right gives

    @property
    def ball(self) -> str:
        return self.parameters.cue.ball

    @cached_property
    def bed(self) -> Point:
        """Half the length and half the width between the cushions, in m."""
        return 0.5 * self.parameters.table.length, 0.5 * self.parameters.table.width

    @cached_property
    def outer(self) -> Point:
        """Half the length and half the width of the table with its rails, in m."""
        (x, y), holes = self.bed, self.run.setup.traps
        reach = [max(abs(h.center[0]) - x, abs(h.center[1]) - y) + h.radius + ROUND_POCKETS for h in holes]
        rail = max([self.parameters.table.cushion_width + WOOD, *reach])
        return x + rail, y + rail

    @cached_property
    def plan(self) -> Plan:
        """Room, rails, cloth with its markings, pockets, cushions, sights, and the lamp over them."""
        table, setup, bed, outer = self.parameters.table, self.run.setup, self.bed, self.outer
        back = bed[0] + table.cushion_width, bed[1] + table.cushion_width
        beds, head = ((back, THROAT), (bed, COLOURS["cloth"])), PLATE_INSIDE - outer[0]
        middle = 0.55 * back[0] + 0.45 * outer[0], 0.55 * back[1] + 0.45 * outer[1]
        snooker = table.kind == "snooker"
        return (
            Room(outer, COLOURS["room"], COLOURS["room_shadow"]),
            Rails(back, outer, COLOURS["wood"], COLOURS["lip"]),
            *(Ground(around(half), colour) for half, colour in beds),
            *(_snooker_markings(*bed) if snooker else _spots(*((share * bed[0], 0.0) for share in SPOTS))),
            *(Pocket(h.center, h.radius, beds, COLOURS["leather"], COLOURS["pocket"]) for h in setup.traps),
            *cushions(setup.surfaces, back, COLOURS["cushion"]),
            *(() if snooker else sights(bed, middle, COLOURS["sight"], bool(setup.traps))),
            Line(((head, -0.5 * PLATE_LENGTH), (head, 0.5 * PLATE_LENGTH)), PLATE, COLOURS["plate"]),
            Lamp(bed, outer),
        )

    @cached_property
    def must_show(self) -> np.ndarray:
        """The table with its rails, which no ball leaves."""
        return np.array([self.outer]) * [[1], [-1]]

    @property
    def area(self) -> Area:
        """All but the frame: the scale bar is next to the table."""
        side, gap = 0.05 * self.size[0], self.sheet.gap
        return Area(side, self.sheet.top_row + gap, self.size[0] - side, self.card_row - 2 * gap)

    @property
    def story(self) -> Story | None:
        """The first ball that is potted; or the first that the struck one meets."""
        events, pockets = self.run.events, {hole.name: hole for hole in self.run.setup.traps}
        met = next((e for e in events if e.kind == "impact" and {e.ball, e.partner} <= set(self.balls)), None)
        potted = next((e for e in events if e.kind == "caught"), None)
        if met is None and potted is None:
            return None
        if potted is None:
            assert met is not None
            return Story(_around((met.x, met.y), PILE * self.radius), met.t, PILE_SHARE)
        hole = pockets[potted.partner]
        until = potted.t if met is None or potted.ball == self.ball else met.t
        return Story(_around(hole.center, hole.radius), potted.t, 0.2, [(self.ball, until), (potted.ball, potted.t)])

    # Balls

    def look_of(self, name: str) -> Look:
        return balls.look(name)

    def initial_turn(self, name: str) -> np.ndarray:
        return balls.lying(name)

    def colour_of(self, name: str) -> Colour:
        """The ball's own colour, lighter if it would be hard to see on the cloth."""
        return balls.on_cloth(balls.colour_of(name))

    def faint_of(self, name: str) -> Colour:
        return mix(self.colour_of(name), COLOURS["cloth"], 0.35 if name == self.ball else 0.55)

    # The poster

    def strobe(self, sheet: Sheet, camera: Camera) -> list[str]:
        """Rings where the balls lay, dots along the struck ball's path, the band of striped balls along theirs."""
        painter, unit = sheet.painter, self.unit
        for name in self._movers:
            at, radius = camera.pixel(*self.run.state(name, 0.0)[:2]), max(self.radius * camera.scale, self.min_radius)
            painter.ring(at, radius - 0.5 * unit, max(1.0, 1.1 * unit), COLOURS["start"], 0.75)
            if balls.striped(name):
                painter.line(self.traced(camera, self.paths[name].points), 0.9 * unit, COLOURS["ivory"])
        if self.ball not in self._movers:
            return []
        end = max(arc.t1 for arc in self.run.arcs[self.ball] if not arc.rests)  # s, when it comes to rest
        every = round_number_above(end / DOTS)
        for i in range(1, floor(end / every) + 1):
            at = camera.pixel(*self.run.state(self.ball, i * every)[:2])
            painter.disc(at, max(1.0, 1.6 * unit), COLOURS["rim"])
        return [f"a dot every {every:g} s"]

    @cached_property
    def _movers(self) -> list[str]:
        """The balls that went anywhere."""
        ways = {name: np.hypot(*np.ptp(path.points, axis=0)) for name, path in self.paths.items()}
        return [name for name, way in ways.items() if way > LEAST_WAY * self.radius]

    def notes(self, camera: Camera) -> list[str]:
        return [*super().notes(camera), *(["each path in its ball's colour"] if len(self._movers) > 1 else [])]

    def scale(self, sheet: Sheet, camera: Camera) -> None:
        """A scale bar on the floor to the table's left, and which end is which, where there is room."""
        x, y = self.outer
        (left, bottom), (right, _) = camera.pixel(-x, -y), camera.pixel(x, 0.0)
        room = left - sheet.frame.left - 4 * sheet.gap
        if room > 5 * sheet.lettering.height("small"):
            sheet.scale_bar(camera, sheet.frame.left, bottom, room)
        middle = camera.pixel(0.0, 0.0)[1]
        sheet.label("head", "small", [(left - 2 * sheet.gap, middle, "midright")], CARD["quiet"])
        sheet.label("foot", "small", [(right + 2 * sheet.gap, middle, "midleft")], CARD["quiet"])

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect:
        """At the top right where the tip meets the ball, and what is potted."""
        painter, frame, small = sheet.painter, sheet.frame, sheet.lettering.height("small")
        bottom = sheet.top_row - sheet.gap
        radius = (bottom - frame.top - small - sheet.gap) / 2
        centre = frame.right - radius, bottom - radius
        self._tip(painter, centre, radius)
        sheet.write("tip", "small", (centre[0], frame.top + small), CARD["quiet"], "midbottom")
        end = self.story_end if t is None else t
        potted = [event.ball for event in self.run.events if event.kind == "caught" and event.t <= end]
        if not potted:
            return pygame.Rect(centre[0] - radius, frame.top, 2 * radius, bottom - frame.top)
        size = max(5.0, 12 * self.unit)
        wide = max((2.25 * len(potted) + 0.75) * size, sheet.lettering.width("potted", "small"))
        rect = pygame.Rect(0, 0, round(wide), round(3 * size))
        rect.midright = round(centre[0] - radius - 4 * sheet.gap), round(centre[1])
        painter.panel(rect, CARD["background"], CARD["opacity"], rect.height / 2)
        sheet.write("potted", "small", (rect.centerx, frame.top + small), CARD["quiet"], "midbottom")
        for i, name in enumerate(potted):
            at = rect.centerx + (i - (len(potted) - 1) / 2) * 2.25 * size, rect.centery
            balls.look(name).draw(painter, at, size, np.eye(3), self.unit)
        return rect

    def _tip(self, painter: Painter, centre: tuple[float, float], radius: float) -> None:
        """The struck ball from behind, with a dot where the tip meets it."""
        (x, y), thin, ink = centre, max(1.0, self.unit), COLOURS["numeral"]
        painter.disc(centre, radius, COLOURS["ivory"])
        painter.ring(centre, radius / 2, thin, ink, 0.2)
        painter.line([(x - 0.8 * radius, y), (x + 0.8 * radius, y)], thin, ink, 0.25)
        painter.line([(x, y - 0.8 * radius), (x, y + 0.8 * radius)], thin, ink, 0.25)
        cue = self.parameters.cue
        painter.disc((x + cue.english * radius, y - cue.follow * radius), max(2.0, 0.2 * radius), COLOURS["chalk"])

    # Frames

    def progress(self, t: float) -> tuple[str, str]:
        """The last event worth reporting."""
        text, first = f"struck at {self.parameters.cue.speed:.1f} m/s", self.run.result["first_contact"]
        for event in (event for event in self.run.events if event.t <= t):
            if event.kind == "caught":
                text = f"the {event.ball} into the {event.partner}"
            elif event.kind == "impact" and {event.ball, event.partner} == {self.ball, first}:
                text, first = f"meets the {first} at {self.run.closing_speed(event):.1f} m/s", None
        return text[0].upper() + text[1:], ""

    def position(self, t: float) -> list[Entry]:
        """The number of balls that move, and of cushions that the struck one has met."""
        moving = sum(t < self.caught[name] and any(self.run.state(name, t)[2:4]) for name in self.balls)
        rails = sum(name.endswith(" cushion") for name, event in collisions_of(self.run, self.ball) if event.t <= t)
        return [("moving", str(moving)), ("cushions", str(rails))]


def _around(at: Point, reach: float) -> Box:
    return Box(at[0] - reach, at[1] - reach, at[0] + reach, at[1] + reach)


def _snooker_markings(x: float, y: float) -> Plan:
    """Baulk line, D and spots, on a bed of half sizes x and y."""
    baulk = BAULK - x
    d = arc((baulk, 0.0), D_RADIUS, 90.0, 270.0)
    spots = [(baulk, side * D_RADIUS) for side in (-1, 0, 1)] + [(0.0, 0.0), (0.5 * x, 0.0), (x - BLACK_SPOT, 0.0)]
    return (Line(((baulk, -y), (baulk, y)), LINE, MARKING), Line(d, LINE, MARKING), *_spots(*spots))


def _spots(*places: Point) -> Plan:
    return tuple(Spot(at, SPOT, MARKING) for at in places)
