"""Tennis from the side: the court under the lamps, or a table in a hall."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import cached_property

import numpy as np

from sandbox.kit import (
    COURT_WIDTH,
    Box,
    Camera,
    Eye,
    Ground,
    Hall,
    Look,
    NetView,
    Person,
    Place,
    Planks,
    Stands,
    net_across,
    scene_colours,
    seams,
    standing_table,
    tennis_court,
)
from sandbox.picture.places.things import pose_of
from sandbox.sport.net_game import received_at
from sandbox.sport.sideways import GroundPlace

from .scene import Parameters, track

COLOURS = scene_colours(__file__)
COURT, TABLE = COLOURS["court"], COLOURS["table"]
TABLE_WIDTH, TALL = 1.525, 1.85  # m: the table (ITTF law 2.1), and people
STROKES = (("stroking", "serving"), ("looping", "smashing"))  # on a court and on a table, the usual one first
LOOKS = [Look(ball["colour"], seams(ball["seam"])) for ball in (COURT["ball"], TABLE["ball"])]


class Picture(NetView[Parameters]):
    TRACE, OTHER_TRACES = COLOURS["trace"], COLOURS["earlier"]
    LENGTH_ROWS, SECOND_UNIT, MEASURED_FROM = 0, "ft", "from the racket"

    @property
    def track(self) -> Sequence[GroundPlace]:
        return track(self.run, self.parameters)

    @property
    def aims(self) -> list[Box]:
        """The net, and the ground beyond it."""
        middle, high = 0.5 * self.parameters.court.length, self.parameters.net.height
        return [Box(middle - 0.1, 0.0, middle + 0.1, high), Box(middle, -0.05, 2.0 * middle, 0.05)]

    @property
    def preferred_view(self) -> Box:
        end, left = self.parameters.court.length, self.parameters.release.place - 0.7
        right = max(0.3 + 1.1 * end, float(self.path.points[-1, 0]) + 0.6 * TALL)
        return Box(min(-0.3 - 0.04 * end, left), 0.0, right, 2.0 - self.parameters.court.table)

    @property
    def caveat(self) -> str:
        return "not validated: strokes" if self.parameters.court.table else ""

    def look_of(self, name: str) -> Look:
        return LOOKS[self.parameters.court.table > 0.0]

    def ground(self, x: np.ndarray) -> np.ndarray:
        return np.zeros_like(x) - self.parameters.court.table

    def eye(self, camera: Camera) -> Eye:
        eye = super().eye(camera)
        return replace(eye, level=eye.level - self.parameters.court.table * camera.scale)  # sees the table from above

    @cached_property
    def story_end(self) -> float:
        return received_at(self.run, self.parameters)

    @cached_property
    def place(self) -> Place:
        court, net, release = self.parameters.court, self.parameters.net, self.parameters.release
        end, high, on_table = court.length, release.height + court.table, court.table > 0.0
        strokes = STROKES[on_table]
        stroke = min(strokes, key=lambda name: abs(high - pose_of(name).holds[1] * TALL))
        player = Person.holding((release.place, high), stroke, COLOURS["player"], TALL, 1.6)
        awaits = max(1.1 * end + 0.5, float(self.path.points[-1, 0]) + pose_of(strokes[0]).holds[0] * TALL)
        other = Person(awaits, TALL, COLOURS["opponent"], strokes[0], facing=-1)
        hung = 0.5 * end, net.height - net.depth, net.height
        if on_table:
            ground = Ground(Planks(TABLE["wood"]), TABLE["soil"], edges=[(TABLE["edge"], 4)], far=0.5)
            across = net_across(*hung, TABLE_WIDTH, 0.015, **TABLE["net"])
            top = standing_table(end, TABLE_WIDTH, court.table, **TABLE["top"])
            return Place(Hall(**TABLE["hall"]), ground, [other, *top, *across, player])
        across = net_across(*hung, COURT_WIDTH, 0.06, **COURT["net"])
        ground = tennis_court(end, court.service, **COURT["ground"], **COURT[court.surface])
        return Place(Stands(**COURT["stands"]), ground, [other, *across, player])
