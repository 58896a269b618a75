"""Bowling from above: the whole lane, wider than it is, and the pins from near by."""

from __future__ import annotations

from functools import cached_property
from itertools import pairwise
from math import cos, inf, sin

import numpy as np

from sandbox.kit import (
    Box,
    Camera,
    Colour,
    Fall,
    LongView,
    Look,
    Mark,
    Painter,
    Shape,
    Story,
    near,
    palette,
    plan,
    scene_colours,
)
from sandbox.picture.painter import Point

from .scene import HEAD, KICKBACK, LANE, PIT, ROW, SPOTS, Parameters

CARD, COLOURS = palette("card"), scene_colours(__file__)
BOARD, ARROWS = 2 * LANE / 39, 4.6  # m: width of a board; where the arrows are
SWIRL = near(np.array([(0.6, 0.5, 0.62), (-0.7, -0.3, 0.65), (0.1, -0.8, -0.6), (-0.3, 0.6, -0.74)]), 0.5)
HOLES = near(np.array([(0.1, 0.24, 0.966), (-0.12, 0.22, 0.968), (0.0, -0.1, 0.995)]), 0.1)
BALL = Look(COLOURS["ball"], Mark(COLOURS["swirl"], SWIRL), Mark(COLOURS["holes"], HOLES, 7.0), gloss=0.9)
NECK = Mark(COLOURS["neck"], lambda at: (abs(np.hypot(at[..., 0], at[..., 1]) - 0.52) < 0.09).astype(float))
PIN = Look(COLOURS["pin"], NECK)

#: A pin from the side (USBC): heights over the lane and diameters, and where its bands are; all in inches.
PROFILE = (
    (0.0, 2.03), (0.75, 2.83), (2.25, 3.91), (3.375, 4.51), (4.5, 4.766), (5.875, 4.563), (7.25, 3.703), (8.625, 2.472),
    (9.375, 1.965), (10.0, 1.797), (10.875, 1.87), (11.75, 2.094), (12.625, 2.406), (13.5, 2.547), (14.3, 2.1),
    (14.8, 1.2), (15.0, 0.3)
)  # fmt: skip
BANDS, CENTRE, WIDEST = ((8.4, 9.2), (10.3, 11.1)), 5.73, 4.766
FALLS = 0.3  # s that a pin takes to fall, as it is drawn


def _side(low: float, high: float) -> np.ndarray:
    """A pin's outline between two heights (in), in radii around its centre of mass, its head to the right."""
    heights, widths = np.array(PROFILE).T
    along = np.unique([low, *heights[(heights > low) & (heights < high)], high])
    half = np.interp(along, heights, widths) / 2
    upper = np.column_stack([along - CENTRE, half])
    return np.concatenate([upper, (upper * (1.0, -1.0))[::-1]]) / (WIDEST / 2)


SIDE, RINGS = _side(0.0, 15.0), [_side(*band) for band in BANDS]
LYING = ((SIDE, COLOURS["pin"]), *((ring, COLOURS["neck"]) for ring in RINGS))


class Picture(LongView[Parameters]):
    TRACE, ROOM_COLOUR, OTHER_TRACES, WIDTH_SCALE = COLOURS["trace"], COLOURS["hall"], COLOURS["earlier"], 2.0
    MIN_IMPACT_SHARE, CAVEAT = 0.65, "what the pins do is not validated"
    whole = Box(-0.7, -KICKBACK - 0.05, HEAD + PIT + 0.28, KICKBACK + 0.05)
    datum = (HEAD, 0.0), "the head pin"

    @property
    def near(self) -> Box:
        """The pins, and from where the ball is in the gutter."""
        ball = float(self.path.points[-1, 0])
        return Box(min(HEAD - 0.6, ball - 0.5), -LANE - 0.22, HEAD + PIT + 0.28, LANE + 0.22)

    @property
    def story(self) -> Story:
        """The pins, as the ball comes to them."""
        among = (event.t for event in self.run.events if event.ball == self.ball and event.x > HEAD - 2 * ROW)
        return Story(Box(HEAD - 0.15, -LANE, HEAD + PIT, LANE), next(among, self.decided), 0.0)

    @property
    def lines(self) -> dict[str, float]:
        return {"arrows": ARROWS, "oil ends": max([0.0, *(oil.end for oil in self.parameters.oil)]), "head pin": HEAD}

    @cached_property
    def plan(self) -> plan.Plan:
        """Kickbacks, gutters, boards, oil, foul line, arrows, the deck and its spots, the pit, the light."""
        end, dry = HEAD + PIT, self.parameters.dry or 1.0
        lane = Box(-0.7, -LANE, end, LANE)
        arrows = [(ARROWS - 0.12 * abs(i), -5 * i * BOARD) for i in range(-3, 4)]
        oils = sorted((oil.end, oil.friction) for oil in self.parameters.oil)
        ends = [0.0, *(end for end, _ in oils)]
        oiled = [((a, -LANE), (b, -LANE), (b, LANE), (a, LANE)) for a, b in pairwise(ends)]
        slick = [max(0.0, 0.42 * (1.0 - friction / dry)) for _, friction in oils]
        return (
            plan.Ground(Box(-0.7, -KICKBACK - 0.1, end + 1.0, KICKBACK + 0.1), COLOURS["kickback"]),
            plan.Ground(Box(-0.7, -KICKBACK, end, KICKBACK), COLOURS["gutter"]),
            plan.Stripes(lane, COLOURS["lane"], BOARD, -LANE, along=True),
            plan.Stripes(lane._replace(left=HEAD - 0.3), COLOURS["deck"], BOARD, -LANE, along=True),
            *(Shape(part, COLOURS["oil"], dim) for part, dim in zip(oiled, slick, strict=True)),
            *(plan.Worn((x, 0.2 * LANE), 1.6, 0.5 * LANE, COLOURS["lamp"], 0.3) for x in (1.5, 5.5, 9.5, 13.5)),
            plan.Worn((HEAD + ROW, 0.0), 0.7, 0.45, COLOURS["lamp"], 0.35),
            plan.Ground(Box(end, -KICKBACK, end + 1.0, KICKBACK), COLOURS["pit"]),
            plan.Line(((0.0, -LANE), (0.0, LANE)), 0.03, COLOURS["mark"]),
            *(Shape(((x, y - 0.02), (x + 0.15, y), (x, y + 0.02)), COLOURS["mark"]) for x, y in arrows),
            *(plan.Spot(spot, 0.028, COLOURS["spot"]) for spot in SPOTS.values()),
        )

    @cached_property
    def falls(self) -> dict[str, tuple[float, float]]:
        """The time in s at which each pin that does not stand in the end begins to fall, and its direction in rad."""
        found, tips = {}, self.parameters.pin.tips
        for name in (name for name in self.balls if name != self.ball and name not in self.run.result["leaves"]):
            away = self.paths[name].points - SPOTS[name]
            tipped = int(np.argmax(np.hypot(*away.T) > tips))
            found[name] = float(self.paths[name].samples[tipped, 0]), float(np.arctan2(*away[tipped][::-1]))
        return found

    def fall_of(self, name: str) -> Fall | None:
        return Fall(*self.falls[name], FALLS, LYING) if name in self.falls else None

    def draw_ball(self, painter: Painter, camera: Camera, name: str, t: float, at: Point, radius: float) -> None:
        """A pin that has fallen lies, its head where it was pushed to."""
        start, way = self.falls.get(name, (inf, 0.0))
        if t < start:
            super().draw_ball(painter, camera, name, t, at, radius)
            return
        lies = 1.0 if t >= self.story_end else min(1.0, 0.2 + (t - start) / FALLS)
        turn = way + self.run.angle(name, min(t, self.caught[name])) - self.run.angle(name, start)
        along, across = np.array([cos(turn), -sin(turn)]) * radius * lies, np.array([sin(turn), cos(turn)]) * radius

        def put(outline: np.ndarray, down: float = 0.0) -> np.ndarray:
            return np.array(at) + down + outline[:, :1] * along + outline[:, 1:] * across

        painter.polygon(put(SIDE, 0.35 * radius), CARD["shadow"], 0.35)
        outline = put(SIDE)
        painter.line([*outline, outline[0]], 2 * max(0.7, 0.8 * self.unit), CARD["shadow"], 0.65)
        for shape, colour in LYING:
            painter.polygon(put(shape), colour)

    def look_of(self, name: str) -> Look:
        return BALL if name == "ball" else PIN

    def colour_of(self, name: str) -> Colour:
        return self.TRACE if name == "ball" else COLOURS["way"]
