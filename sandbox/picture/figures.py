"""Plain people: flat, without faces, made of a few rounded strokes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, hypot, sin, tau
from typing import NamedTuple

from sandbox.picture.painter import Painter, Point
from sandbox.picture.palette import Colour, palette

SHADOW = palette("card")["shadow"]


class Stroke(NamedTuple):
    """A part of a body, seen from the side: a line in units of its height, ahead and up from between the feet."""

    part: str  # names its colour: "body", "shirt", "shorts", "far" (what is behind)
    points: Sequence[Point]
    width: float


#: Poses, seen from the side and looking ahead; what is farther away is drawn first.
SHOOTING = (
    Stroke("far", [(-0.005, 0.50), (0.015, 0.27), (-0.05, 0.03), (0.03, 0.014)], 0.055),
    Stroke("far", [(0.01, 0.80), (0.12, 0.84), (0.15, 0.98)], 0.046),
    Stroke("body", [(0.0, 0.50), (0.045, 0.27), (0.0, 0.03), (0.085, 0.014)], 0.062),
    Stroke("shorts", [(0.0, 0.52), (0.025, 0.38)], 0.105),
    Stroke("shirt", [(0.0, 0.54), (0.005, 0.66), (0.0, 0.78)], 0.125),
    Stroke("body", [(0.005, 0.84), (0.022, 0.885)], 0.05),
    Stroke("body", [(0.025, 0.925), (0.028, 0.945)], 0.108),
    Stroke("body", [(0.0, 0.795), (0.105, 0.83), (0.135, 0.965), (0.15, 1.0)], 0.05),
)
REACHING = (
    Stroke("far", [(-0.01, 0.50), (0.0, 0.27), (-0.09, 0.07), (-0.04, 0.02)], 0.055),
    Stroke("far", [(0.01, 0.80), (0.12, 0.78), (0.17, 0.90)], 0.046),
    Stroke("body", [(0.0, 0.50), (0.03, 0.27), (-0.03, 0.04), (0.045, 0.0)], 0.062),
    Stroke("shorts", [(0.0, 0.52), (0.015, 0.38)], 0.105),
    Stroke("shirt", [(0.0, 0.54), (0.01, 0.66), (0.015, 0.78)], 0.125),
    Stroke("body", [(0.02, 0.84), (0.035, 0.885)], 0.05),
    Stroke("body", [(0.04, 0.925), (0.045, 0.945)], 0.108),
    Stroke("body", [(0.015, 0.80), (0.09, 0.98), (0.14, 1.14), (0.165, 1.20)], 0.05),
)
STANDING = (
    Stroke("far", [(0.0, 0.50), (-0.025, 0.27), (-0.045, 0.03), (0.02, 0.014)], 0.055),
    Stroke("body", [(0.0, 0.50), (0.02, 0.27), (0.0, 0.03), (0.07, 0.014)], 0.062),
    Stroke("shorts", [(0.0, 0.52), (0.012, 0.38)], 0.110),
    Stroke("shirt", [(0.0, 0.54), (0.0, 0.66), (-0.005, 0.78)], 0.130),
    Stroke("body", [(0.0, 0.84), (0.012, 0.885)], 0.05),
    Stroke("body", [(0.014, 0.925), (0.016, 0.945)], 0.108),
    Stroke("shirt", [(-0.01, 0.79), (-0.005, 0.69)], 0.058),
    Stroke("body", [(-0.005, 0.66), (0.03, 0.58), (0.085, 0.52)], 0.044),
)

KICKING = (
    Stroke("far", [(0.02, 0.79), (0.13, 0.70), (0.19, 0.76)], 0.046),
    Stroke("body", [(-0.03, 0.50), (-0.02, 0.27), (-0.06, 0.03), (0.015, 0.014)], 0.062),
    Stroke("body", [(-0.02, 0.50), (0.14, 0.36), (0.29, 0.22), (0.35, 0.27)], 0.060),
    Stroke("shorts", [(-0.02, 0.51), (0.085, 0.41)], 0.105),
    Stroke("shorts", [(-0.03, 0.51), (-0.025, 0.38)], 0.100),
    Stroke("shirt", [(-0.03, 0.54), (-0.05, 0.66), (-0.06, 0.77)], 0.125),
    Stroke("body", [(-0.055, 0.84), (-0.04, 0.88)], 0.05),
    Stroke("body", [(-0.03, 0.915), (-0.025, 0.935)], 0.108),
    Stroke("shirt", [(-0.07, 0.785), (-0.14, 0.70)], 0.055),
    Stroke("body", [(-0.14, 0.70), (-0.23, 0.66)], 0.044),
)


def _racket(hand: Point, head: Point, size: float) -> tuple[Stroke, ...]:
    """A racket from the hand to the middle of its head."""
    (x, y), reach = hand, hypot(head[0] - hand[0], head[1] - hand[1])
    ahead, up = (head[0] - x) / reach, (head[1] - y) / reach
    turns = [tau * i / 16 for i in range(17)]
    rim = [(1.25 * size * cos(turn), size * sin(turn)) for turn in turns]
    oval = [(head[0] + a * ahead - b * up, head[1] + a * up + b * ahead) for a, b in rim]
    neck = head[0] - 1.2 * size * ahead, head[1] - 1.2 * size * up
    return Stroke("racket", [hand, neck], 0.02), Stroke("racket", oval, 0.014)


_STROKE = (
    Stroke("far", [(0.0, 0.50), (-0.06, 0.27), (-0.13, 0.03), (-0.06, 0.014)], 0.055),
    Stroke("far", [(0.02, 0.79), (-0.07, 0.66), (-0.02, 0.58)], 0.046),
    Stroke("body", [(0.0, 0.50), (0.08, 0.28), (0.09, 0.03), (0.165, 0.014)], 0.062),
    Stroke("shorts", [(0.0, 0.52), (0.03, 0.38)], 0.110),
    Stroke("shirt", [(0.0, 0.54), (0.02, 0.66), (0.03, 0.77)], 0.128),
    Stroke("body", [(0.04, 0.83), (0.055, 0.875)], 0.05),
    Stroke("body", [(0.065, 0.915), (0.07, 0.935)], 0.108),
    Stroke("body", [(0.03, 0.78), (0.09, 0.66), (0.19, 0.60)], 0.048),
)
#: With a racket or a bat, the middle of which is ...
SERVING, SERVED_AT = (*_racket((0.165, 1.20), (0.225, 1.38), 0.062), *REACHING), (0.225, 1.38)
STROKING, STROKED_AT = (*_racket((0.19, 0.60), (0.40, 0.58), 0.066), *_STROKE), (0.40, 0.58)
_BAT = Stroke("racket", [(0.19, 0.60), (0.24, 0.592)], 0.022), Stroke("racket", [(0.265, 0.575), (0.275, 0.605)], 0.05)
LOOPING, LOOPED_AT = (*_BAT, *_STROKE), (0.295, 0.59)
_ARM = Stroke("body", [(0.03, 0.78), (0.13, 0.79), (0.235, 0.81)], 0.048)
_RAISED = (Stroke(part, [(x + 0.045, y + 0.21) for x, y in points], width) for part, points, width in _BAT)
SMASHING, SMASHED_AT = (*_RAISED, *_STROKE[:-1], _ARM), (0.34, 0.80)
#: On a court and on a table, the usual one first.
STROKES = (((STROKING, STROKED_AT), (SERVING, SERVED_AT)), ((LOOPING, LOOPED_AT), (SMASHING, SMASHED_AT)))

BATTING = (
    Stroke("racket", [(0.10, 0.66), (0.30, 0.62), (0.46, 0.585)], 0.030),
    Stroke("far", [(0.02, 0.50), (0.12, 0.28), (0.16, 0.03), (0.235, 0.014)], 0.060),
    Stroke("body", [(-0.02, 0.50), (-0.07, 0.27), (-0.14, 0.04), (-0.07, 0.014)], 0.062),
    Stroke("shorts", [(-0.01, 0.53), (-0.06, 0.30)], 0.095),
    Stroke("shorts", [(0.01, 0.52), (0.11, 0.30)], 0.090),
    Stroke("shirt", [(0.0, 0.54), (0.0, 0.66), (0.0, 0.78)], 0.128),
    Stroke("body", [(0.005, 0.84), (0.02, 0.885)], 0.05),
    Stroke("body", [(0.03, 0.92), (0.035, 0.94)], 0.108),
    Stroke("body", [(0.0, 0.78), (0.06, 0.69), (0.12, 0.66)], 0.048),
)

PITCHING, PITCHED_AT = (
    (
        Stroke("far", [(-0.02, 0.47), (-0.16, 0.27), (-0.30, 0.10), (-0.25, 0.03)], 0.058),
        Stroke("far", [(0.10, 0.76), (0.06, 0.62), (0.15, 0.58)], 0.046),
        Stroke("body", [(0.0, 0.47), (0.16, 0.31), (0.20, 0.03), (0.28, 0.014)], 0.062),
        Stroke("shorts", [(-0.01, 0.48), (-0.13, 0.31)], 0.085),
        Stroke("shorts", [(0.0, 0.48), (0.13, 0.33)], 0.095),
        Stroke("shirt", [(0.0, 0.50), (0.06, 0.62), (0.11, 0.74)], 0.128),
        Stroke("body", [(0.13, 0.80), (0.15, 0.84)], 0.05),
        Stroke("body", [(0.165, 0.88), (0.17, 0.90)], 0.108),
        Stroke("body", [(0.10, 0.76), (0.20, 0.90), (0.31, 0.965)], 0.05),
    ),
    (0.335, 0.975),
)
CROUCHING = (
    Stroke("far", [(-0.03, 0.17), (0.12, 0.24), (0.06, 0.03), (0.12, 0.014)], 0.06),
    Stroke("body", [(-0.03, 0.17), (0.14, 0.22), (0.05, 0.03), (0.125, 0.014)], 0.062),
    Stroke("shorts", [(-0.04, 0.18), (0.10, 0.23)], 0.095),
    Stroke("shirt", [(-0.04, 0.20), (0.0, 0.32), (0.04, 0.43)], 0.128),
    Stroke("body", [(0.06, 0.49), (0.075, 0.52)], 0.05),
    Stroke("body", [(0.085, 0.56), (0.09, 0.58)], 0.108),
    Stroke("body", [(0.04, 0.43), (0.11, 0.36), (0.17, 0.40)], 0.048),
    Stroke("racket", [(0.18, 0.39), (0.19, 0.43)], 0.085),
)


def draw_figure(
    painter: Painter,
    foot: Point,
    height: float,
    pose: Sequence[Stroke],
    colours: Mapping[str, Colour],
    facing: int = 1,
) -> None:
    """A person ``height`` px tall who stands at a point and looks to the right (1) or to the left (-1)."""
    for part, points, width in pose:
        drawn = [(foot[0] + facing * ahead * height, foot[1] - up * height) for ahead, up in points]
        painter.line(drawn, width * height, colours[part])


def draw_from_above(
    painter: Painter, centre: Point, breadth: float, facing: float, colours: Mapping[str, Colour], arms: float = 0.0
) -> None:
    """A person seen from above, ``breadth`` px from shoulder to shoulder, who looks in the direction ``facing``.

    In rad, counter-clockwise from the right. The hands are before the body, or with ``arms`` so many px to either side.
    """
    ahead, side = (cos(facing), -sin(facing)), (-sin(facing), -cos(facing))  # y of the picture points down

    def at(forward: float, aside: float) -> Point:
        return centre[0] + forward * ahead[0] + aside * side[0], centre[1] + forward * ahead[1] + aside * side[1]

    painter.shadow((centre[0] + 0.16 * breadth, centre[1] + 0.2 * breadth), 0.5 * breadth, 0.34 * breadth, SHADOW, 0.5)
    for hand in (-1, 1):
        shoulder = at(0.0, hand * 0.36 * breadth)
        if arms > 0.0:
            elbow, wrist = at(0.14 * breadth, hand * 0.6 * arms), at(0.10 * breadth, hand * (arms - 0.09 * breadth))
        else:
            elbow, wrist = at(0.22 * breadth, hand * 0.38 * breadth), at(0.36 * breadth, hand * 0.08 * breadth)
        painter.line([shoulder, elbow, wrist], 0.15 * breadth, colours["body"])
        if arms > 0.0:
            painter.disc(wrist, 0.13 * breadth, colours["gloves"])
    painter.line([at(0.0, -0.34 * breadth), at(0.0, 0.34 * breadth)], 0.32 * breadth, colours["shirt"])
    painter.disc(at(0.03 * breadth, 0.0), 0.19 * breadth, colours["far"])
    painter.disc(at(-0.01 * breadth, 0.0), 0.18 * breadth, colours["hair"])
