"""Basketball from the side: the shot's arc in a quiet hall, to the ring and down to the floor."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from sandbox.picture.palette import mix, palette, scene_colours
from sandbox.picture.places import Hall, Person, Size, boards
from sandbox.picture.views import Box, Camera, Entry, Length, Look, Painter, Place, Sheet, seams
from sandbox.sport.amounts import metres, roughly, times

from . import court
from .hoop import HangingNet, hoop, stand
from .lens import LensView

CARD, COLOURS = palette("card"), scene_colours(__file__)
BALL, FLOOR = COLOURS["ball"], COLOURS["floor"]

#: How far behind the board the stand reaches, and before the release the thrower, in m.
STAND, THROWER = 2.5, 0.7
#: Board, ring and stand are drawn larger where they would be less tall than this, px on 720 rows.
LEAST_HEIGHT = 80


class Picture(LensView):
    """One shot."""

    LOOK = Look(BALL["colour"], seams(BALL["seam"]))
    TRACE, EARLIER = COLOURS["trace"], COLOURS["earlier"]
    FAINT = mix(TRACE, COLOURS["hall"]["wall"][1], 0.45)
    LENGTHS = 1
    SECOND_UNIT = "ft"
    LEVEL, ASIDE = 128, 0.25

    @cached_property
    def told(self) -> float:
        """When the ball is on the floor."""
        return next((event.t for event in self.run.events if event.partner == "floor"), self.run.duration)

    @cached_property
    def span(self) -> float:
        """Most of the way to the floor, whether the ring is touched or not: balls are as close in all shots."""
        return 0.8 * self.told

    @property
    def moment(self) -> float:
        return self.net.fullest

    def progress(self, t: float) -> tuple[str, str]:
        return metres(self.run.state(self.ball, t)[1]), "above the floor"

    def position(self, t: float) -> list[Entry]:
        return [("to the ring", metres(self.ring[0] - self.run.state(self.ball, t)[0]))]

    # The place

    @property
    def ring(self) -> tuple[float, float]:
        """The middle of the ring, in m."""
        return self.parameters.hoop.middle

    @cached_property
    def net(self) -> HangingNet:
        return HangingNet(self.run, self.parameters)

    @property
    def hoop_size(self) -> Size:
        """Of ring, board and stand."""
        return Size(self.ring[0], max(self.ring[1], self.parameters.backboard.top), LEAST_HEIGHT)

    @property
    def thrower(self) -> list[Person]:
        """The thrower, if a person can have thrown from there."""
        height = self.parameters.release.height
        if not 1.6 <= height <= 3.1 or abs(self.parameters.launch.angle - 45) > 50:
            return []
        pose = "shooting" if height <= 2.2 else "reaching"
        return [Person.holding((0.0, height), pose, COLOURS["thrower"], 2.05)]

    @cached_property
    def place(self) -> Place:
        face = self.parameters.board[0]
        lines = court.lines(face, self.ring[0])
        ground = boards(FLOOR, areas=[(court.key(face), FLOOR["key"])], lines=lines)
        goal = self.hoop_size.of(*stand(self.parameters), *hoop(self.parameters))
        return Place(Hall(**COLOURS["hall"]), ground, [*goal, *self.thrower])

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        self.net.draw(painter, self.hoop_size.eye(self.eye(camera)), False, t)

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        self.net.draw(painter, self.hoop_size.eye(self.eye(camera)), True, t)
        super().before(painter, camera, t)

    def remarks(self, camera: Camera) -> list[str]:
        distance, factor = self.ring[0], self.hoop_size.factor(self.eye(camera))
        if not 0 < camera.pixel(distance, 0)[0] < self.size[0]:
            return [f"the ring is {roughly(distance)} away"]
        return [f"ring and board drawn {times(factor)} their size"] if factor > 1 else []

    @property
    def company(self) -> Box:
        return Box(-THROWER if self.thrower else 0.0, 0.0, 0.0, 0.0)

    @property
    def target(self) -> Box:
        face, _, back, top = self.parameters.board
        return Box(face, 0.0, back + STAND, top)

    def lengths(self) -> list[Length]:
        """From the release to the ring."""
        distance, height = self.ring
        return [Length(f"{metres(distance)} to the ring, {metres(height)} up", 0.0, distance)]

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The path of the ball after the floor, fading."""
        moments = np.linspace(self.told, min(self.run.duration, self.told + 0.45), 30)
        points = camera.pixels(np.array([self.run.state(self.ball, t)[:2] for t in moments]))
        if np.ptp(points, axis=0).max() > 2:
            sheet.painter.fading(points[::-1], 4 * self.unit, self.TRACE, 0.6)
        if self.has_lens:
            sheet.labels.take(self.lens)
