"""A bullet in water from the side: a lake cut open, with its depth, and where the bullet is harmless."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from math import cos, radians, sin

from sandbox.kit import (
    Box,
    Camera,
    Entry,
    Eye,
    Ground,
    Landscape,
    Look,
    Place,
    Post,
    Sheet,
    SideView,
    Stripes,
    amount,
    metres,
    round_number_above,
    scene_colours,
)

from .scene import Parameters, closing, entry, halving, harmless

COLOURS = scene_colours(__file__)
WATER = COLOURS["water"]
BARREL = 0.3  # m
MARKS = 4  # depths and halvings that are marked, at most or so


class Picture(SideView[Parameters]):
    LOOK, THING = Look(COLOURS["ball"], gloss=0.45), "bullet"
    TRACE, OTHER_TRACES, ON_DARK = COLOURS["trace"], COLOURS["earlier"], False
    LENGTH_ROWS, SECOND_UNIT, MEASURED_FROM, EYE_HEIGHT, HEADROOM = 0, "ft", "from the muzzle", 40, 60

    @cached_property
    def subject(self) -> Box:
        seen, deepest = super().subject, float(self.points[:, 1].min())
        side = 0.3 * (seen.top - deepest)
        return Box(seen.left - side, deepest - 0.05, seen.right + side, seen.top + 0.2)

    def eye(self, camera: Camera) -> Eye:
        """Level with the water's surface, which is not the picture's lowest place."""
        at = camera.at[0], 0.0
        return super().eye(replace(camera, at=at, anchor=camera.pixel(*at)))

    def position(self, t: float) -> list[Entry]:
        return [("height" if (y := self.run.state(self.ball, t)[1]) > 0.0 else "depth", metres(abs(y)))]

    @cached_property
    def place(self) -> Place:
        launch = self.parameters.launch
        way = cos(radians(launch.angle)), sin(radians(launch.angle))
        ends = [(-along * way[0], launch.height - along * way[1], 0.0) for along in (BARREL, 0.0)]
        lake = Ground(Stripes(WATER["surface"], 2.0), WATER["body"], edges=[(WATER["edge"], 3)])
        return Place(Landscape(**COLOURS["landscape"]), lake, [Post(ends, 0.012, COLOURS["barrel"])])

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """Mark depths, where a speed has halved, and where the bullet is harmless."""
        deepest = -float(self.points[:, 1].min())
        if deepest > 0.0:
            step = round_number_above(deepest / MARKS)
            for i in range(1, int(deepest / step) + 1):
                x, y, text = sheet.frame.left, camera.pixel(0.0, -i * step)[1], f"{metres(i * step)} deep"
                sheet.painter.dashes([(x, y), (sheet.frame.right, y)], self.unit, WATER["mark"], 6, 8, 0.35)
                sheet.label(text, "small", [(x, y - 0.4 * sheet.gap, "bottomleft")], WATER["mark"])
        start, end = entry(self.run, self.parameters), harmless(self.run, self.parameters)
        if start is None or end is None:
            return
        if self.parameters.launch.height > 0.0:
            self.point_out(sheet, camera, (start.x, start.y), f"{start.speed:.0f} m/s into the water")
        if closes := closing(self.run, self.parameters):
            self.point_out(sheet, camera, (closes.x, closes.y), "cavity closes")
        self.point_out(sheet, camera, (end.x, end.y), f"harmless, {amount(end.speed, 'm/s')}")

    def remarks(self, camera: Camera) -> list[str]:
        return [f"its speed halves every {metres(halving(self.parameters))}", "not validated"]
