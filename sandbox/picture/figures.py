"""Plain people: flat, without faces. From the side they are strokes, which are data: assets/figures.toml."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from math import cos, sin
from typing import Any, NamedTuple

from sandbox.picture.painter import Painter, Point
from sandbox.picture.palette import ASSETS, Colour, palette

SHADOW = palette("card")["shadow"]


class Pose(NamedTuple):
    """A person from the side, in units of its height: the colour's name, width and points of each stroke, and where the
    middle of what is held is."""

    strokes: list[tuple[str, float, list[Point]]]
    holds: Point


@cache
def _figures() -> dict[str, Any]:
    return tomllib.loads((ASSETS / "figures.toml").read_text("utf-8"))


@cache
def pose(name: str) -> Pose:
    """One of the poses."""
    found, strokes = _figures()["poses"][name], _figures()["strokes"]
    drawn = [(part, width, points) for group in found["strokes"] for part, width, *points in strokes[group]]
    return Pose(drawn, tuple(found.get("holds", (0.0, 0.0))))


def draw_figure(
    painter: Painter, foot: Point, height: float, name: str, colours: Mapping[str, Colour], facing: int = 1
) -> None:
    """A person ``height`` px tall in a pose who stands at a point and looks to the right (1) or to the left (-1)."""
    for part, width, points in pose(name).strokes:
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
