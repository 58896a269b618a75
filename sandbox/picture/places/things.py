"""Things that stand on the ground: nets, posts, people, a goal. Each is described once and seen by an ``_Eye``: from
the side, or from above."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from math import dist
from typing import Any, NamedTuple, Protocol

import numpy as np

from sandbox.picture.camera import Camera
from sandbox.picture.camera import Eye as SideEye
from sandbox.picture.painter import Painter, Point
from sandbox.picture.palette import ASSETS, Colour, palette
from sandbox.picture.sheet import rows_of

_PERSON, SHADOW = palette("person"), palette("card")["shadow"]
#: Of posts and nets of a scene that has no colours of its own.
_POST, MESH = palette("plain")["surface"], (236, 240, 244)
#: Width of the mesh of a net, in m, unless it says otherwise.
MESH_WIDTH = 0.12

#: The least that is drawn of a net's mesh, of a post's width and of a person's height, px on 720 rows.
_LEAST_MESH, _LEAST_POST, _LEAST_PERSON = 4.0, 1.8, 30.0
#: Darkening of things behind a net, as a share of its opacity.
_SHADED = 0.3

#: A point in m: along the plane of play, up, and behind it or, from above, to the left; two numbers are on the ground.
_Point3 = tuple[float, ...]
#: Sees such points: from the side, or from above.
_Eye = SideEye | Camera


class Thing(Protocol):
    """A frozen dataclass, so that what was drawn can be kept."""

    @property
    def near(self) -> bool:
        """True if it is before the ball, from the side."""

    @property
    def corners(self) -> Sequence[_Point3]:
        """Points in m around what it hides."""

    def draw(self, painter: Painter, eye: Any) -> None:
        """As the eye sees it."""


def unit_of(painter: Painter) -> float:
    """The size of 1 px on a picture of 720 rows, in px."""
    return rows_of(painter.surface.get_size()) / 720


@dataclass(frozen=True)
class Net:
    """Flat nets, each from a corner along two edges (m), with meshes ``mesh`` m wide."""

    planes: Sequence[tuple[_Point3, _Point3, _Point3]]
    colour: Colour = MESH
    opacity: float = 0.5
    mesh: float = MESH_WIDTH
    near: bool = False

    @property
    def corners(self) -> Sequence[_Point3]:
        return ()  # one sees through it

    def draw(self, painter: Painter, eye: _Eye) -> None:
        threads, edges, thin = [], [], max(0.6, 0.8 * unit_of(painter))
        for plane in self.planes:
            corner, one, other = (np.array(vector, float) for vector in plane)
            corners = eye.points(np.array([corner, corner + one, corner + one + other, corner + other]))
            painter.polygon(corners, SHADOW, 0.0 if self.near else _SHADED * self.opacity)
            edges.append(corners[[0, 1, 2, 3, 0]])
            for along, across in ((one, other), (other, one)):
                most = dist(*eye.points(np.array([corner, corner + across]))) / (_LEAST_MESH * unit_of(painter))
                count = 1 + max(1, round(min(most, float(np.linalg.norm(across)) / self.mesh)))
                starts = [corner + share * across for share in np.linspace(0, 1, count)]
                threads += [(start, start + along) for start in starts]
        lines = eye.points(np.reshape(threads, (-1, 3))).reshape(-1, 2, 2)
        painter.lines(lines, thin, self.colour, self.opacity)
        painter.lines(edges, 1.6 * thin, self.colour, min(1.0, 1.6 * self.opacity))


@dataclass(frozen=True)
class Post:
    """A round bar along the points (m)."""

    points: Sequence[_Point3]
    radius: float
    colour: Colour = _POST
    near: bool = False

    @property
    def corners(self) -> Sequence[_Point3]:
        return self.points

    def draw(self, painter: Painter, eye: _Eye) -> None:
        points = np.array(self.points)
        width = max(_LEAST_POST * unit_of(painter), 2 * self.radius * eye.scale_at(points))
        painter.line(eye.points(points), width, self.colour)


@dataclass(frozen=True)
class Shape:
    """A flat shape with corners in m."""

    corners: Sequence[_Point3]
    colour: Colour
    opacity: float = 1.0
    near: bool = False

    def draw(self, painter: Painter, eye: _Eye) -> None:
        painter.polygon(eye.points(np.array(self.corners)), self.colour, self.opacity)


class _Pose(NamedTuple):
    """A plain person from the side, flat and without a face, in units of its height: the colour's name, width and
    points of each stroke, and where the middle of what is held is."""

    strokes: list[tuple[str, float, list[Point]]]
    holds: Point


@cache
def _figures() -> dict[str, Any]:
    return tomllib.loads((ASSETS / "figures.toml").read_text("utf-8"))


def poses() -> list[str]:
    """The names of all poses."""
    return list(_figures()["poses"])


@cache
def pose_of(name: str) -> _Pose:
    """The pose of this name. Raises ValueError for an unknown one."""
    poses, strokes = _figures()["poses"], _figures()["strokes"]
    if name not in poses:
        raise ValueError(f"pose = {name!r}: there is no such pose; the poses are {', '.join(poses)}")
    found = poses[name]
    drawn = [(part, width, points) for group in found["strokes"] for part, width, *points in strokes[group]]
    return _Pose(drawn, tuple(found.get("holds", (0.0, 0.0))))


@dataclass(frozen=True)
class Person:
    """Somebody ``tall`` m high, whose feet are ``up`` m over the ground, x m along the plane of play, z m behind it."""

    x: float
    tall: float = 1.8
    colours: Mapping[str, Colour] = field(default_factory=_PERSON.copy)
    pose: str = "standing"  # of assets/figures.toml
    z: float = 0.0
    up: float = 0.0
    facing: int = 1
    near: bool = False

    @property
    def corners(self) -> Sequence[_Point3]:
        half = 0.2 * self.tall
        return [(self.x + side * half, self.up + high, self.z) for side in (-1, 1) for high in (0.0, self.tall)]

    def __post_init__(self) -> None:
        parts = dict.fromkeys(part for part, *_ in pose_of(self.pose).strokes)
        missing = [part for part in parts if part not in self.colours]
        if missing:
            needed = ", ".join(parts)
            raise ValueError(f"pose = {self.pose!r}: colours lacks {', '.join(missing)}; this pose needs {needed}")

    @classmethod
    def holding(
        cls, at: Point, pose: str, colours: Mapping[str, Colour], tallest: float = 2.0, shortest: float = 0.0
    ) -> Person:
        """Somebody who holds something at (x, height), all in m: as tall as that takes, and in the air if need be."""
        (x, high), (ahead, up) = at, pose_of(pose).holds
        tall = min(tallest, max(shortest, high / up))
        return cls(x - ahead * tall, tall, colours, pose, up=max(0.0, high - up * tall))

    def draw(self, painter: Painter, eye: SideEye) -> None:
        tall = max(self.tall * eye.camera.scale, _LEAST_PERSON * eye.unit) * eye.share(self.z)
        place = np.array([(self.x, eye.camera.at[1] + up, self.z) for up in (0.0, self.up)])
        ground, (x, foot) = eye.points(place).tolist()
        painter.shadow(ground, 0.24 * tall, 0.05 * tall, SHADOW, 0.42)
        for part, width, points in pose_of(self.pose).strokes:
            drawn = [(x + self.facing * ahead * tall, foot - up * tall) for ahead, up in points]
            painter.line(drawn, width * tall, self.colours[part])


def goal(
    front: float,
    depth: float,
    height: float,
    width: float,
    radius: float,
    post: Colour,
    shade: Colour,
    net: Colour,
    side: float = 0.0,
    opacity: float = 0.20,
) -> tuple[Thing, ...]:
    """A goal with its mouth at x = ``front``, from z = ``side`` on, where its near post stands; lengths in m."""
    bar, near, far, back = height + radius, side, side + width + 2 * radius, front + depth
    along, up, across = (depth, 0.0, 0.0), (0.0, bar, 0.0), (0.0, 0.0, far - near)
    behind = ((back, 0.0, near), up, across), ((front, bar, near), along, across), ((front, 0.0, far), along, up)
    return (
        Net(behind, net, opacity),
        Post(((front, 0.0, far), (front, bar, far)), radius, shade),
        Post(((front, bar, far), (front, bar, near)), radius, shade),
        Net((((front, 0.0, near), along, up),), net, 0.42, near=True),
        Post(((front, bar, near), (front, 0.0, near)), radius, post, near=True),
    )


def net_across(
    x: float, low: float, top: float, width: float, band: float, post: Colour, mesh: Colour, tape: Colour
) -> list[Thing]:
    """A net across the plane of play at x, from height ``low`` to ``top``, with tape along its edge; lengths in m."""
    edge = [(x, top - down, z) for down, z in ((0.0, 0.0), (band, 0.0), (band, width), (0.0, width))]
    posts = [Post([(x, 0.0, z), (x, 1.04 * top, z)], 0.02 * top, post, near=z == 0.0) for z in (width, 0.0)]
    woven = Net([((x, low, 0.0), (0.0, top - low, 0.0), (0.0, 0.0, width))], mesh, 0.6, mesh=1.6 * band)
    return [posts[0], woven, Shape(edge, tape), posts[1]]


def standing_table(
    length: float, width: float, height: float, top: Colour, side: Colour, leg: Colour, line: Colour
) -> list[Thing]:
    """A table with its top at y = 0, from x = 0 on, and its near edge in the plane of play; lengths in m."""
    legs = [
        Post([(x, -height, z), (x, 0.0, z)], 0.02, leg)
        for z in (0.9 * width, 0.1 * width)
        for x in (0.12 * length, 0.88 * length)
    ]
    corners = [(0.0, 0.0, 0.0), (length, 0.0, 0.0), (length, 0.0, width), (0.0, 0.0, width)]
    front = [*corners[:2], (length, -0.03 * length, 0.0), (0.0, -0.03 * length, 0.0)]
    lines = [Post([(0.0, 0.0, z), (length, 0.0, z)], 0.008, line) for z in (width, 0.5 * width)]
    ends = [Post([(x, 0.0, 0.0), (x, 0.0, width)], 0.008, line) for x in (0.0, length)]
    return [*legs, Shape(corners, top), *lines, *ends, Shape(front, side)]
