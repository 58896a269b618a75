"""A shooting range from the side, with the line of sight dashed, and how far below it the bullet is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from math import ceil, inf, pi
from typing import ClassVar

import numpy as np

from sandbox.kit import (
    Box,
    Camera,
    Entry,
    Eye,
    Landscape,
    Look,
    Painter,
    Place,
    Post,
    Sheet,
    SideView,
    Thing,
    amount,
    scene_colours,
    turf,
)
from sandbox.picture.places.things import pose_of
from sandbox.picture.sheet import ROWS_FOR_LENGTHS, YARD

from .scene import Parameters, table

COLOURS = scene_colours(__file__)
GROUND, PEOPLE = COLOURS["ground"], COLOURS["people"]
#: Sizes of shooter and half the target, in px on 720 rows; what fires balls that are larger, in m, is a gun.
FIGURE, FACE, CANNON = 46.0, 22.0, 0.02
GRASS, DASH = 0.25, 0.012  # room below, as a share of the heights that are seen; a dash, as a share of the range


@dataclass(frozen=True)
class Shooter:
    """The shooter on a stand, or a gun: a picture of one, for it would be too small to see."""

    muzzle: tuple[float, float]  # m
    calibre: float  # m
    near: ClassVar[bool] = False

    @property
    def corners(self) -> list[tuple[float, float, float]]:
        return [(*self.muzzle, 0.0)]

    def draw(self, painter: Painter, eye: Eye) -> None:
        ((x, y),), unit = eye.points(np.array([(*self.muzzle, 0.0)])).tolist(), eye.unit
        tall, ahead, up = FIGURE * unit, *pose_of("prone").holds
        left, foot = x - ahead * tall, y + up * tall
        for start, end in ((0.1, 0.18), (0.95, 0.87)):  # the legs of the stand
            legs = [(left + start * tall, foot), (left + (2.0 * start - end) * tall, eye.base)]
            painter.line(legs, 3.5 * unit, PEOPLE["stand"])
        painter.line(
            [(left - 0.02 * tall, foot + 2 * unit), (left + 1.14 * tall, foot + 2 * unit)], 5 * unit, PEOPLE["stand"]
        )
        if self.calibre < CANNON:
            for part, width, points in pose_of("prone").strokes:
                drawn = [(left + along * tall, foot - high * tall) for along, high in points]
                painter.line(drawn, width * tall, PEOPLE[part])
            return
        breech, thick = x - 0.95 * tall, 0.09 * tall
        barrel = [(breech, y - 1.5 * thick), (x, y - thick), (x, y + thick), (breech, y + 1.5 * thick)]
        painter.polygon(barrel, PEOPLE["rifle"])
        painter.disc((breech, y), 1.5 * thick, PEOPLE["rifle"])
        painter.ring((x - 0.5 * tall, foot - 0.1 * tall), 0.2 * tall, 0.06 * tall, PEOPLE["shorts"])
        painter.disc((x - 0.5 * tall, foot - 0.1 * tall), 0.05 * tall, PEOPLE["shorts"])


@dataclass(frozen=True)
class Target:
    """A round target on a post, its middle on the line of sight; a picture of one, from aslant."""

    at: tuple[float, float]  # m
    foot: float  # m
    near: ClassVar[bool] = False

    @property
    def corners(self) -> list[tuple[float, float, float]]:
        return [(*self.at, 0.0)]

    def draw(self, painter: Painter, eye: Eye) -> None:
        (x, y), (_, foot) = eye.points(np.array([(*self.at, 0.0), (self.at[0], self.foot, 0.0)])).tolist()
        painter.line([(x, y), (x, foot)], 3.5 * eye.unit, PEOPLE["stand"])
        turns = np.linspace(0.0, 2.0 * pi, 49)
        for share, colour in ((1.08, "stand"), (1.0, "face"), (0.72, "ring"), (0.48, "face"), (0.26, "middle")):
            reach = share * FACE * eye.unit
            painter.polygon(
                np.column_stack([x + 0.42 * reach * np.cos(turns), y + reach * np.sin(turns)]), PEOPLE[colour]
            )


class Picture(SideView[Parameters]):
    LOOK, THING = Look(COLOURS["ball"], gloss=0.45), "bullet"
    TRACE, OTHER_TRACES, ON_DARK = COLOURS["trace"], COLOURS["earlier"], False
    LENGTH_ROWS, HEADROOM, MEASURED_FROM = 0, 92, "from the muzzle"
    EYE_HEIGHT, MIN_PATH_SHARE, MAX_STRETCH = 60, 0.0, inf

    @property
    def aims(self) -> list[Box]:
        far, rise = self.parameters.range.distance, 0.06 * (self.preferred_view.top - self.preferred_view.bottom)
        return [Box(0.985 * far, -rise, 1.015 * far, rise)]

    @cached_property
    def preferred_view(self) -> Box:
        far, heights = self.parameters.range.distance, [*self.points[:, 1], 0.0, -0.02]
        low, high = float(min(heights)), float(max(heights))
        return Box(-0.03 * far, low - GRASS * (high - low), 1.02 * far, high)

    def ground(self, x: np.ndarray) -> np.ndarray:
        return np.zeros_like(x) + self.preferred_view.bottom

    def position(self, t: float) -> list[Entry]:
        return [("over sight line", amount(self.run.state(self.ball, t)[1], "m"))]

    @cached_property
    def place(self) -> Place:
        far = self.parameters.range.distance
        starts = far * np.arange(-0.05, 1.0, 2.0 * DASH)
        sight = [Post([(x, 0.0, 0.0), (x + DASH * far, 0.0, 0.0)], 0.0, GROUND["sight"]) for x in starts]
        x, y = self.path.points[0].tolist()
        ends: list[Thing] = [Shooter((x, y), self.radius), Target((far, 0.0), self.preferred_view.bottom)]
        return Place(Landscape(**COLOURS["landscape"]), turf(GROUND, 60.0), [*sight, *ends])

    def remarks(self, camera: Camera) -> list[str]:
        return ["shooter and target not to scale"]

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """The line of sight's name and height and speed every hundred yards, or so often as there is room."""
        if sheet.rows < ROWS_FOR_LENGTHS:
            return
        tall, top = sheet.lettering.height("small"), round(self.area.top - 2.0 * sheet.gap)
        line = camera.pixel(0.0, 0.0)[1]
        room = sheet.lettering.width("−000.0 cm", "small", bold=True) + 2.0 * sheet.gap
        every = ceil(room / (100.0 * YARD * camera.scale))
        for row in table(self.run, self.parameters)[every::every]:
            (x, at), drop = camera.pixel(row["range"], row["height"]), amount(row["height"], "m")
            sheet.painter.line([(x, top), (x, max(at, line))], sheet.unit, sheet.quiet_ink, 0.5)
            sheet.write(f"{row['range'] / YARD:.0f} yd", "small", (x, top - 2 * tall), sheet.quiet_ink, "midbottom")
            sheet.write(drop, "small", (x, top - tall), sheet.ink, "midbottom", bold=True)
            sheet.write(f"{row['speed']:.0f} m/s", "small", (x, top), sheet.quiet_ink, "midbottom")
        (start, _), (end, _) = (camera.pixel(x, 0.0) for x in (0.0, self.parameters.range.distance))
        ends = (start + 4 * sheet.gap, "left"), (end - 6 * sheet.gap, "right")
        lifts = [(way * far * sheet.gap, up) for far in (2, 4, 6) for way, up in ((-1, "bottom"), (1, "top"))]
        spots = [(x, line + lift, up + side) for lift, up in lifts for x, side in ends]
        sheet.label("sight line", "small", spots, sheet.ink)
