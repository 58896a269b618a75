"""Nets that are pulled out and rings that shake when they are hit: drawn only, nothing gives way in the physics.

The rates and lengths are assumed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import cos, exp, hypot, pi, sin

import numpy as np

from sandbox.engine.model.event import Event
from sandbox.engine.model.surface import Segment
from sandbox.engine.paths.run import Run
from sandbox.picture.camera import Camera, Eye
from sandbox.picture.painter import Painter, Point
from sandbox.picture.palette import Colour
from sandbox.picture.places.things import MESH, MESH_WIDTH, unit_of

#: What is hit has given way after so many s, swings back at a rate (rad/s), settles at another (1/s), and then rests.
_YIELDS, _SWINGS, _SETTLES, _LASTS = 0.09, 7.0, 2.2, 2.5
#: A net is pulled out by so many m for each m/s, and at most so far, in a pocket of this radius, drawn out to so far;
#: not by a ball that is slower than the last, in m/s.
_GIVES, _DEEPEST, _POCKET, _AROUND, _LEAST = 0.022, 0.55, 0.38, 1.0, 2.0


def yielding(since: float, swings: float = _SWINGS, settles: float = _SETTLES) -> float:
    """The share to which something that was hit so many s ago has given way: at once, then it swings until it rests."""
    if not 0.0 < since < _LASTS:
        return 0.0
    if since < _YIELDS:
        return sin(0.5 * pi * since / _YIELDS)
    return exp(-settles * (since - _YIELDS)) * cos(swings * (since - _YIELDS))


@dataclass(frozen=True)
class Pulled:
    """A net that a ball hits ``t`` s into a run with a ``speed`` in m/s, at a point of the plane of play (m), along a
    ``normal`` to it; the net goes on so far (m) to the left and to the right of that. It is drawn over the net, which
    stays."""

    t: float
    at: Point
    normal: Point
    reach: tuple[float, float]
    speed: float
    above: bool  # the plane of play is the ground
    colour: Colour = MESH

    def draw(self, painter: Painter, eye: Camera | Eye, t: float) -> None:
        """Draw it as the eye sees it at a time in s of the run."""
        share, thin = yielding(t - self.t), max(0.6, 0.8 * unit_of(painter))
        if share == 0.0:
            return
        aside, out = (
            np.linspace(low, high, max(3, round(2 * (high - low) / MESH_WIDTH) + 1))
            for low, high in ((-min(self.reach[0], _AROUND), min(self.reach[1], _AROUND)), (0.0, _AROUND))
        )
        u, w = np.meshgrid(aside, out, indexing="ij")
        deep = share * min(_DEEPEST, _GIVES * self.speed) * np.exp(-(u**2 + w**2) / (2 * _POCKET**2))
        x = self.at[0] + deep * self.normal[0] + u * self.normal[1]
        y = self.at[1] + deep * self.normal[1] - u * self.normal[0]
        points = np.stack([x, w, y] if self.above else [x, y, w], axis=-1)
        mesh, seen = eye.points(points.reshape(-1, 3)).reshape(*u.shape, 2), min(1.0, 3.0 * abs(share))
        painter.lines([*mesh[::2], *mesh.swapaxes(0, 1)[::2]], thin, self.colour, 0.55 * seen)
        painter.line(mesh[:, 0], 2.0 * thin, self.colour, 0.9 * seen)


def pulled_nets(run: Run, ball: str, above: bool) -> list[Pulled]:
    """The surfaces called ``net`` that a ball hits."""
    shapes = [surface.shape for surface in run.setup.surfaces if surface.name == "net"]
    nets = [shape for shape in shapes if isinstance(shape, Segment)]
    hits = [e for e in run.events if e.kind == "impact" and e.ball == ball and e.partner == "net" and e.speed > _LEAST]
    return [_pulled(run, hit, nets, above) for hit in hits if nets]


def _pulled(run: Run, hit: Event, nets: Sequence[Segment], above: bool) -> Pulled:
    """The nearest net to a hit, pulled to the side to which the ball flies."""

    def frame_of(net: Segment) -> tuple[float, float, float, float, float]:
        """The direction of a net, how far along it and to its right the ball is, and its length, in m."""
        (ax, ay), (bx, by) = net.a, net.b
        length = hypot(bx - ax, by - ay)
        x, y = (bx - ax) / length, (by - ay) / length
        return x, y, (hit.x - ax) * x + (hit.y - ay) * y, (hit.x - ax) * y - (hit.y - ay) * x, length

    def away(net: Segment) -> float:
        *_, along, aside, length = frame_of(net)
        return hypot(aside, max(-along, 0.0, along - length))

    x, y, along, aside, length = frame_of(min(nets, key=away))
    at, (vx, vy) = (hit.x - aside * y, hit.y + aside * x), run.before(hit.ball, hit.t)[2:4]
    if vy * x - vx * y >= 0.0:  # to the left
        return Pulled(hit.t, at, (-y, x), (along, length - along), hit.speed, above)
    return Pulled(hit.t, at, (y, -x), (length - along, along), hit.speed, above)
