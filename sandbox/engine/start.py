"""Start positions: balls are moved out of slight overlaps."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import dist

from sandbox.engine.contact.manifold import meeting, surfaces_met
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.tolerances import NEGLIGIBLE_OVERLAP, TOUCHING_GAP
from sandbox.errors import RequestError
from sandbox.physics.integrators import State

#: Deepest overlap that is corrected, as a fraction of the radius; deeper is an error in the scene. And the most
#: attempts, as one correction may cause another overlap.
SLIGHT, _MOST_PUSHES = 0.02, 200


def starts(balls: Sequence[Ball], obstacles: Mapping[float, Sequence[Obstacle]]) -> list[list[float]]:
    """The position of each ball at the start, in m; ``obstacles`` are those for balls of a radius.

    Balls that overlap slightly are pushed apart, and out of surfaces. Raises RequestError for a deep overlap, naming
    both, and for a ball that does not fit.
    """
    places = [[float(x) for x in ball.position] for ball in balls]
    for _ in range(_MOST_PUSHES):
        name = ""
        for i, j, what, reach, depth, nx, ny in _overlaps(balls, places, obstacles):
            ball = name = balls[i].name
            if depth > SLIGHT * reach:
                x, y = places[i]
                raise RequestError(
                    f"ball {ball!r} at ({x:.4g}, {y:.4g}) m overlaps {what!r} at the start by {depth:.3g} m: "
                    "move one of them"
                )
            for index, push in ((i, depth),) if j is None else ((i, 0.5 * depth), (j, -0.5 * depth)):
                places[index][0] += push * nx
                places[index][1] += push * ny
        if not name:
            return places
    raise RequestError(f"ball {name!r} does not fit where it starts: several things overlap it")


def _overlaps(
    balls: Sequence[Ball], places: Sequence[Sequence[float]], obstacles: Mapping[float, Sequence[Obstacle]]
) -> Iterator[tuple[int, int | None, str, float, float, float, float]]:
    """Each overlap of two balls, all from the same places, then of balls and surfaces, from the places when it is
    yielded: the balls, the name of what the first overlaps, the sum of the radii and the depth in m, and the normal to
    the first."""
    states = [_state_at(*each) for each in zip(balls, places, strict=True)]
    overlapping = [
        (i, j, found)
        for i, ball in enumerate(balls)
        for j, other in enumerate(balls[:i])
        if dist(states[i][:2], states[j][:2]) < ball.radius + other.radius
        and (found := meeting(ball, states[i], other, states[j])).gap < -TOUCHING_GAP
    ]
    for i, j, found in overlapping:
        yield i, j, balls[j].name, balls[i].radius + balls[j].radius, -found.gap, *found.normal
    for i, ball in enumerate(balls):
        for obstacle, met in surfaces_met(
            ball, [o.at(0.0) for o in obstacles[ball.radius]], _state_at(ball, places[i]), -NEGLIGIBLE_OVERLAP
        ):
            yield i, None, obstacle.surface.name, ball.radius, -met.gap, *met.normal


def _state_at(ball: Ball, place: Sequence[float]) -> State:
    """The state of a ball or body there; its motion does not matter."""
    return (*place, 0.0, 0.0, 0.0, *ball.initial_angle)
