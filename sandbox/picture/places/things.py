"""Things that stand on the ground: nets, posts, people, a goal. Each says what of it is before the ball."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import dist
from typing import Protocol

import numpy as np

from sandbox.picture.depth import Eye
from sandbox.picture.figures import draw_figure
from sandbox.picture.painter import Painter
from sandbox.picture.palette import Colour, palette

PERSON, SHADOW = palette("person"), palette("card")["shadow"]

#: The least that is drawn of a net's mesh and of a post's width, px on 720 rows.
LEAST_MESH, LEAST_POST = 4.0, 1.8

#: A point in m: along the plane of play, up, and behind it.
Point3 = tuple[float, float, float]


class Thing(Protocol):
    """Draws what of it is before the ball (``near``), or what is not."""

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None: ...


@dataclass(frozen=True)
class Net:
    """Flat nets, each from a corner along two edges (m), with meshes ``mesh`` m wide."""

    planes: Sequence[tuple[Point3, Point3, Point3]]
    colour: Colour
    opacity: float
    mesh: float = 0.12
    near: bool = False

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None:
        if near != self.near:
            return
        threads = []
        for plane in self.planes:
            corner, one, other = (np.array(vector, float) for vector in plane)
            for along, across in ((one, other), (other, one)):
                most = dist(*eye.points(np.array([corner, corner + across]))) / (LEAST_MESH * eye.unit)
                count = 1 + max(1, round(min(most, float(np.linalg.norm(across)) / self.mesh)))
                starts = [corner + share * across for share in np.linspace(0, 1, count)]
                threads += [(start, start + along) for start in starts]
        lines = eye.points(np.reshape(threads, (-1, 3))).reshape(-1, 2, 2)
        painter.lines(lines, max(0.6, 0.8 * eye.unit), self.colour, self.opacity)


@dataclass(frozen=True)
class Post:
    """A round bar along the points (m)."""

    points: Sequence[Point3]
    radius: float
    colour: Colour
    near: bool = False

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None:
        if near == self.near:
            share = float(np.mean([eye.share(z) for *_, z in self.points]))
            width = max(LEAST_POST * eye.unit, 2 * self.radius * eye.camera.scale * share)
            painter.line(eye.points(np.array(self.points)), width, self.colour)


@dataclass(frozen=True)
class Shape:
    """A flat shape with corners in m."""

    corners: Sequence[Point3]
    colour: Colour
    opacity: float = 1.0
    near: bool = False

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None:
        if near == self.near:
            painter.polygon(eye.points(np.array(self.corners)), self.colour, self.opacity)


@dataclass(frozen=True)
class Person:
    """Somebody ``tall`` m high, whose feet are ``up`` m over the ground, x m along the plane of play, z m behind it."""

    x: float
    tall: float
    colours: Mapping[str, Colour] = field(default_factory=PERSON.copy)
    pose: str = "standing"  # of assets/figures.toml
    z: float = 0.0
    up: float = 0.0
    facing: int = 1

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None:
        if near:
            return
        tall, ground = self.tall * eye.camera.scale * eye.share(self.z), eye.camera.at[1]
        painter.shadow(eye.point(self.x, ground, self.z), 0.24 * tall, 0.05 * tall, SHADOW, 0.42)
        draw_figure(painter, eye.point(self.x, ground + self.up, self.z), tall, self.pose, self.colours, self.facing)


@dataclass(frozen=True)
class Group:
    """Things that stand at x (m), and are drawn larger where ``height`` m of them would be less than ``least`` px."""

    x: float
    things: Sequence[Thing]
    height: float
    least: float

    def enlarged(self, eye: Eye) -> float:
        """How many times their size they are drawn."""
        return max(1.0, self.least * eye.unit / (self.height * eye.camera.scale))

    def eye(self, eye: Eye) -> Eye:
        """Sees them so large."""
        return eye.enlarged(self.x, self.enlarged(eye))

    def draw(self, painter: Painter, eye: Eye, near: bool) -> None:
        for thing in self.things:
            thing.draw(painter, self.eye(eye), near)


def goal(
    front: float, depth: float, height: float, width: float, radius: float, post: Colour, shade: Colour, net: Colour
) -> list[Thing]:
    """A goal whose near post stands in the plane of play, seen from aside: its mouth at x = ``front``, lengths in m."""
    bar, far, back = height + radius, width + 2 * radius, front + depth
    behind = [
        ((back, 0.0, 0.0), (0.0, bar, 0.0), (0.0, 0.0, far)),
        ((front, bar, 0.0), (depth, 0.0, 0.0), (0.0, 0.0, far)),
        ((front, 0.0, far), (depth, 0.0, 0.0), (0.0, bar, 0.0)),
    ]
    before = [((front, 0.0, 0.0), (depth, 0.0, 0.0), (0.0, bar, 0.0))]
    return [
        Net(behind, net, 0.20),
        Post([(front, 0.0, far), (front, bar, far)], radius, shade),
        Post([(front, bar, far), (front, bar, 0.0)], radius, shade),
        Net(before, net, 0.42, near=True),
        Post([(front, bar, 0.0), (front, 0.0, 0.0)], radius, post, near=True),
    ]


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
