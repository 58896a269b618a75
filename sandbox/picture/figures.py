"""Plain people: flat, without faces. From the side they are strokes, which are data: assets/figures.toml."""

from __future__ import annotations

import tomllib
from functools import cache
from typing import Any, NamedTuple

from sandbox.picture.painter import Point
from sandbox.picture.palette import ASSETS


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
