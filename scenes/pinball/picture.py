"""A pinball table from above: cabinet, field, lanes and lamps; bumpers and slings light up when they are hit."""

from __future__ import annotations

from functools import cached_property
from math import cos, radians, sin

import numpy as np
import pygame

from sandbox.kit import (
    AboveView,
    Area,
    Box,
    Camera,
    Entry,
    Look,
    Mark,
    Painter,
    Shape,
    Sheet,
    near,
    plan,
    scene_colours,
)

from .scene import (
    ARCH,
    BAT,
    DEFLECTOR,
    HALF,
    LANE,
    OUTER,
    PIVOT,
    PLUNGER,
    TARGET,
    TARGETS,
    WALL,
    Parameters,
    arch,
    inlane,
    mirrored,
    same,
    score,
    sling,
)

COLOURS = scene_colours(__file__)
#: Width in m of the cabinet around the field; where the field ends below; s for which a lamp stays lit.
FRAME, FOOT, LIT = 0.022, 0.0, 0.15
#: Rays painted on the field, in deg from the place between the flippers.
RAYS = (72.0, 81.0, 90.0, 99.0, 108.0)


def outline(wider: float) -> tuple[tuple[float, float], ...]:
    """The field's edge, ``wider`` in m."""
    bent = [(x + wider * (x - 0.022) / 0.257, y + wider * max(0.0, y - ARCH) / 0.26) for x, y in arch()]
    return ((OUTER + wider, FOOT - wider), *bent, (-HALF - wider, FOOT - wider))


class Picture(AboveView[Parameters]):
    LOOK = Look(COLOURS["ball"], Mark(COLOURS["shine"], near(np.array([(0.0, 0.7, 0.7)]), 0.3)), gloss=0.8)
    TRACE, OTHER_TRACES, DRIVEN = COLOURS["trace"], COLOURS["earlier"], COLOURS["driven"]
    TRAIL, MIN_STROBE_SHARE, MIN_IMPACT, CAVEAT = 0.25, 0.0, 2.0, "coils and rubber not validated"

    @property
    def min_radius(self) -> float:
        return 6.0 * self.unit

    @cached_property
    def must_show(self) -> np.ndarray:
        return np.array([(-HALF - FRAME, FOOT - FRAME), (OUTER + FRAME, ARCH + 0.26 + FRAME)])

    def strobe(self, sheet: Sheet, camera: Camera) -> list[str]:
        """No balls along the path: it crosses itself again and again."""
        return []

    @property
    def area(self) -> Area:
        """As high as the picture: headline and notes stand beside the table."""
        return super().area._replace(top=10 * self.unit, bottom=self.card_row - 10 * self.unit)

    def inset(self, sheet: Sheet, camera: Camera, t: float | None) -> pygame.Rect:
        """The table itself: what is written stands beside it."""
        (left, bottom), (right, top) = self.must_show.tolist()
        return plan.on_pixels(camera, Box(left, bottom, right, top))

    @property
    def aims(self) -> list[Box]:
        """The table: nothing in the window covers it, but its arch where there is little room beside it."""
        (left, bottom), (right, top) = self.must_show.tolist()
        beside = self.camera.pixel(left, bottom)[0] > 0.3 * self.size[0]
        return [Box(left, bottom, right, top if beside else ARCH)]

    @cached_property
    def plan(self) -> plan.Plan:
        """The parts of the table, the lowest first."""
        it, c = self.parameters, COLOURS
        rest = radians(it.flippers.rest)
        below, tip, above = sling(rest)
        lane = ((HALF, FOOT), (OUTER, FOOT), (OUTER, ARCH), (HALF, ARCH))
        parts: list[object] = [
            plan.Ground(Box(-9.0, -9.0, 9.0, 9.0), c["room"][1]),
            plan.Worn((0.022, 0.5), 1.3, 0.95, c["room"][0], 0.9),
            plan.Worn((0.03, 0.46), 0.5, 0.72, c["shadow"], 0.7),
            Shape(outline(FRAME), c["cabinet"]),
            Shape(outline(0.4 * FRAME), c["edge"]),
            Shape(outline(0.0), c["field"]),
        ]
        for ray in RAYS:
            ends = [(r * cos(radians(ray + w)), 0.02 + r * sin(radians(ray + w))) for r, w in
                    ((0.22, -1.2), (0.5, -2.4), (0.5, 2.4), (0.22, 1.2))]  # fmt: skip
            parts.append(Shape(tuple(ends), c["light"]))
        parts += [plan.Spot((spot.x, spot.y), spot.radius + 0.02, c["light"]) for spot in it.bumpers]
        parts += [Shape(lane, c["lane"]), plan.Line(((HALF, FOOT), (HALF, ARCH)), 2 * WALL, c["wall"])]
        parts.append(plan.Line(((OUTER, FOOT), *arch(), (-HALF, FOOT)), 2 * WALL, c["wall"]))
        for side in (same, mirrored):
            guide, corners = [side(p) for p in inlane(rest)], [side(p) for p in (below, tip, above)]
            parts.append(plan.Line(tuple(guide), 2 * WALL, c["wall"]))
            parts.append(Shape(tuple(corners), c["light"]))
            parts.append(plan.Line((corners[2], corners[0], corners[1]), 2 * WALL, c["rubber"]))
            parts.append(plan.Line((corners[1], corners[2]), 2 * WALL, c["sling"]))
        parts += [Shape(DEFLECTOR, c["light"]), plan.Line(DEFLECTOR, 2 * WALL, c["wall"])]
        parts += [plan.Line(((x, y - TARGET), (x, y + TARGET)), 2 * WALL, c["target"]) for x, y in TARGETS]
        for spot in it.bumpers:
            parts += [plan.Spot((spot.x, spot.y), share * spot.radius, c[colour]) for share, colour in
                      ((1.0, "rubber"), (0.86, "bumper"), (0.45, "cap"))]  # fmt: skip
        top = PLUNGER - 0.004
        parts.append(plan.Line(((HALF + 0.006, top), (OUTER - 0.006, top)), 0.008, c["plunger"]))
        parts.append(plan.Line(((LANE, FOOT), (LANE, PLUNGER - 0.008)), 0.008, c["plunger"]))
        return tuple(parts)

    def behind(self, painter: Painter, camera: Camera, t: float) -> None:
        """The lamps of what was hit just before."""
        for event in self.run.events:
            if t - LIT < event.t <= t and event.kind == "impact" and event.partner in ("bumper", "sling", "target"):
                self._light(painter, camera, (event.x, event.y), event.partner, 1.0 - (t - event.t) / LIT)

    def _light(self, painter: Painter, camera: Camera, at: tuple[float, float], what: str, share: float) -> None:
        spots = [((spot.x, spot.y), spot.radius) for spot in self.parameters.bumpers] if what == "bumper" else []
        spot, radius = min(spots, key=lambda each: np.hypot(*np.subtract(each[0], at)), default=(at, 0.02))
        centre, wide = camera.pixel(*spot), radius * camera.scale
        painter.shadow(centre, 1.9 * wide, 1.9 * wide, COLOURS["lit"], 0.55 * share)
        if spots:
            painter.disc(centre, 0.86 * wide, COLOURS["lit"], 0.8 * share)

    def before(self, painter: Painter, camera: Camera, t: float) -> None:
        """The caps of the flippers' pivots."""
        for x, y in (PIVOT, mirrored(PIVOT)):
            painter.disc(camera.pixel(x, y), 0.6 * BAT * camera.scale, COLOURS["pivot"])

    def progress(self, t: float) -> tuple[str, str]:
        return f"{self._score_at(t):,}", self.clock(t)

    def position(self, t: float) -> list[Entry]:
        return [("score", f"{self._score_at(t):,}")]

    def _score_at(self, t: float) -> int:
        return score([event for event in self.run.events if event.t <= t], self.parameters)
