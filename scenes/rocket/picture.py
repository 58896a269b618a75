"""Rockets from the side: a meadow, the rail or whoever holds the tube, and the rocket with its flame."""

from __future__ import annotations

from functools import cached_property
from math import atan2, cos, radians, sin

import numpy as np

from sandbox.kit import (
    Box,
    Camera,
    Entry,
    Ground,
    Landscape,
    Length,
    Painter,
    Person,
    Place,
    Post,
    Sheet,
    SideView,
    Silhouette,
    Story,
    Stripes,
    amount,
    metres,
    scene_colours,
    turned,
)

from .scene import Parameters, burnout, motor_of

COLOURS = scene_colours(__file__)
BODY, GROUND = COLOURS["body"], COLOURS["ground"]
HULL = [(2.2, 0.0), (1.3, 0.5), (-2.2, 0.5), (-2.2, -0.5), (1.3, -0.5)]  # in half widths of the ball in its place
NOSE = [(2.6, 0.0), (2.0, 0.32), (1.3, 0.5), (1.3, -0.5), (2.0, -0.32)]
FINS = [(-1.2, 0.5), (-2.5, 1.3), (-2.2, 0.5), (-2.2, -0.5), (-2.5, -1.3), (-1.2, -0.5)]
FLAMES = [[(-2.2, 0.42), (-4.6, 0.0), (-2.2, -0.42)], [(-2.2, 0.22), (-3.4, 0.0), (-2.2, -0.22)]]


ROCKET = Silhouette(BODY["hull"], (FINS, BODY["fins"]), (HULL, BODY["hull"]), (NOSE, BODY["fins"]))
FLAME = Silhouette(BODY["hull"], *zip(FLAMES, BODY["flame"], strict=True))


class Picture(SideView[Parameters]):
    LOOK, THING = ROCKET, "rocket"
    TRACE, OTHER_TRACES, ON_DARK = COLOURS["trace"], COLOURS["earlier"], False
    LENGTH_ROWS, SECOND_UNIT, EYE_HEIGHT, EYE_COLUMN, HEADROOM, MAX_STRETCH = 1, "ft", 70, 0.4, 44, 5.0

    @property
    def must_be_visible(self) -> Box:
        return Box(-1.0, 0.0, 1.0, self.parameters.launch.rail + 0.5)

    @property
    def story(self) -> Story:
        """The place where it comes down."""
        return self.meeting(share=0.3, spot=4.0)

    @cached_property
    def strobe_end(self) -> float:
        return self.run.duration

    @cached_property
    def place(self) -> Place:
        launch, ground = self.parameters.launch, Ground(Stripes(GROUND["grass"], 9.0), GROUND["soil"])
        way = cos(radians(launch.angle)), sin(radians(launch.angle))
        ends = [(along * way[0], launch.height + along * way[1], 0.0) for along in (-launch.height, launch.rail)]
        held = Person(-0.35, max(1.0, launch.height / 0.85))
        thing = Post(ends, 0.03, COLOURS["steel"]) if launch.speed == 0.0 else held
        return Place(Landscape(**COLOURS["landscape"]), ground, [thing])

    def turn(self, name: str, t: float) -> np.ndarray:
        """The rocket points where it goes, and along the rail while it stands."""
        _, _, vx, vy, _ = self.run.before(name, t)
        angle = radians(self.parameters.launch.angle) if vx * vx + vy * vy < 1.0 else atan2(vy, vx)
        return turned((0.0, 0.0, angle))

    def draw_ball(
        self, painter: Painter, camera: Camera, name: str, t: float, at: tuple[float, float], radius: float
    ) -> None:
        if motor_of(self.parameters).thrust(t) > 0.0:
            FLAME.draw(painter, at, radius, self.turn(name, t), self.unit)
        super().draw_ball(painter, camera, name, t, at, radius)

    def position(self, t: float) -> list[Entry]:
        return [("height", self.progress(t)[0])]  # as the apex, of its middle

    def progress(self, t: float) -> tuple[str, str]:
        return metres(self.run.state(self.ball, t)[1]), "above the ground"

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """Mark where the motor has burnt out, and how high the rocket came."""
        (t, top), over = self.run.highest(self.ball), burnout(self.run, self.parameters)
        if over is not None:
            self.point_out(sheet, camera, (over.x, over.y), f"burnout {amount(over.speed, 'm/s')}")
        if 0.0 < t < self.run.duration:
            self.point_out(sheet, camera, top[:2], f"apex {metres(top[1])}")

    def lengths(self) -> list[Length]:
        far = self.run.result["distance"]
        return [Length(metres(abs(far)), 0.0, far)]
