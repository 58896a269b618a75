"""Volleyball from the side: court, net and players in a hall."""

from __future__ import annotations

from functools import cached_property

from sandbox.kit import (
    Box,
    Hall,
    Look,
    NetView,
    Person,
    Place,
    boards,
    net_across,
    scene_colours,
    seams,
)

from .scene import Parameters

COLOURS = scene_colours(__file__)
FLOOR = COLOURS["floor"]
WIDE, ATTACK = 9.0, 3.0  # m: the court's width, and the attack line from the net (FIVB, rule 1)
PLAYERS = (
    (1.4, 2.0),
    (2.9, 4.5),
    (4.6, 7.0),
)  # m, beyond the net, where balls are over their heads, and behind the plane


class Picture(NetView[Parameters]):
    LOOK = Look(COLOURS["ball"]["colour"], seams(COLOURS["ball"]["seam"]))
    TRACE, FAINT_TRACE, OTHER_TRACES = COLOURS["trace"], COLOURS["trace"], COLOURS["earlier"]
    LENGTH_ROWS, SECOND_UNIT = 0, "ft"

    @property
    def aims(self) -> list[Box]:
        """The net, and the ground beyond it."""
        middle, high = 0.5 * self.parameters.court.length, self.parameters.net.height
        return [Box(middle - 0.1, 0.0, middle + 0.1, high), Box(middle, -0.05, 2.0 * middle, 0.05)]

    @property
    def preferred_view(self) -> Box:
        return Box(-1.0, 0.0, self.parameters.court.length + 1.0, 1.4 * self.parameters.net.height)

    @cached_property
    def place(self) -> Place:
        """The place: parts in m, x along the court, z across it, the farthest first."""
        court, launch, top = self.parameters.court, self.parameters.launch, self.parameters.net.height
        end, net, low = court.length, 0.5 * court.length, top - self.parameters.net.depth
        lines = [[(x, 0.0), (x, WIDE)] for x in (0.0, net - ATTACK, net, net + ATTACK, end)]
        inside = [(0.0, 0.0), (end, 0.0), (end, WIDE), (0.0, WIDE)]
        ground = boards(FLOOR, areas=[(inside, FLOOR["court"])], lines=[*lines, inside[2:]])
        across = net_across(net, low, top, WIDE, 0.07, **COLOURS["net"])
        players = [Person(net + x, 1.9, COLOURS["players"], z=z, facing=-1) for x, z in reversed(PLAYERS)]
        striker = Person.holding((launch.place, launch.height), "reaching", COLOURS["players"])
        return Place(Hall(**COLOURS["hall"]), ground, [*across, *players, striker])
