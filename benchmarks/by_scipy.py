"""A shot with scipy's ``solve_ivp``, as a careful user would write it.

A flight ends when a gap closes (a terminal event per surface), the ball bounces by the textbook's oblique impact with
Coulomb friction, and a new flight starts. ``solve_ivp`` checks the gaps only at the ends of its steps, so that a touch
shorter than a step is missed: ``longest`` keeps steps short for rims, and the gap to the ground is signed.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise
from math import hypot
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp
from shots import Law, Shot

from sandbox.engine.model.surface import Circle, Segment, Surface
from sandbox.engine.paths.run import Run

#: Most bounces of a shot.
MOST_BOUNCES = 100

#: A level surface longer than this in m is ground, and its gap a height: the ball does not fly beyond its ends.
GROUND = 10.0


class Flown(NamedTuple):
    """Final position of a shot in m, and its number of evaluations."""

    x: float
    y: float
    evaluations: int


def shoot(shot: Shot, method: str, tolerance: float, longest: float = np.inf) -> Flown:
    """Flights and bounces up to the setup's duration, or to the first impact if that ends it.

    ``tolerance`` is rtol and atol (m, m/s, rad/s), ``longest`` the longest step in s.
    """
    setup, ball = shot.setup, shot.setup.balls[0]
    events = [_gap(surface, ball.radius) for surface in setup.surfaces]
    t, state, evaluations = 0.0, np.array([*ball.position, *ball.velocity, ball.spin]), 0
    for _ in range(MOST_BOUNCES):
        flight = solve_ivp(
            _derivative(shot.law), (t, setup.duration), state, method, events=events,
            rtol=tolerance, atol=tolerance, max_step=longest,
        )  # fmt: skip
        t, state, evaluations = flight.t[-1], flight.y[:, -1], evaluations + flight.nfev
        if flight.status != 1 or setup.until is not None:
            break
        surface = setup.surfaces[next(i for i, times in enumerate(flight.t_events) if len(times))]
        state = _bounced(state, surface, ball.radius, ball.inertia_factor)
    return Flown(float(state[0]), float(state[1]), evaluations)


def flight_alone(shot: Shot, run: Run, method: str, tolerance: float) -> tuple[float, int]:
    """Error in m and evaluations of a run's flights, given the time and state after each impact.

    A method that must find the impacts needs at least as many. The error is that of all flights together.
    """
    ball = shot.setup.balls[0].name
    impacts = [0.0, *(event.t for event in run.events), run.duration]
    error, evaluations = 0.0, 0
    for start, end in pairwise(impacts):
        if end > start:
            flight = solve_ivp(
                _derivative(shot.law), (start, end), run.state(ball, start), method, rtol=tolerance, atol=tolerance
            )
            x, y = run.before(ball, end)[:2]
            error += hypot(flight.y[0, -1] - x, flight.y[1, -1] - y)
            evaluations += flight.nfev
    return error, evaluations


def _derivative(law: Law) -> Callable[[float, np.ndarray], tuple[float, ...]]:
    def derivative(t: float, state: np.ndarray) -> tuple[float, ...]:
        _, _, vx, vy, spin = state.tolist()  # floats: five times as fast as numpy's scalars
        return vx, vy, *law(vx, vy, spin)

    return derivative


def _gap(surface: Surface, radius: float) -> Callable[[float, Sequence[float]], float]:
    """Distance in m between ball and surface, as a terminal event."""
    shape = surface.shape
    thickness, nearest = radius + shape.radius, _nearest(shape)
    ground = isinstance(shape, Segment) and shape.a[1] == shape.b[1] and shape.length > GROUND

    def gap(t: float, state: Sequence[float]) -> float:
        x, y = float(state[0]), float(state[1])
        u, v = nearest(x, y)
        return (y - v if ground else hypot(x - u, y - v)) - thickness

    gap.terminal, gap.direction = True, -1.0  # type: ignore[attr-defined]
    return gap


def _nearest(shape: Circle | Segment) -> Callable[[float, float], tuple[float, float]]:
    """The point of a shape's centre line that is nearest to (x, y)."""
    if isinstance(shape, Circle):
        center = shape.center
        return lambda x, y: center
    (ax, ay), (bx, by) = shape.a, shape.b
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy

    def nearest(x: float, y: float) -> tuple[float, float]:
        s = min(1.0, max(0.0, ((x - ax) * dx + (y - ay) * dy) / square))
        return ax + s * dx, ay + s * dy

    return nearest


def _bounced(state: np.ndarray, surface: Surface, radius: float, factor: float) -> np.ndarray:
    """The state after an oblique bounce; the moment of inertia is factor m r^2."""
    x, y, vx, vy, spin = state.tolist()
    u, v = _nearest(surface.shape)(x, y)
    distance = hypot(x - u, y - v)
    nx, ny = (x - u) / distance, (y - v) / distance
    push = -(1.0 + surface.restitution) * (vx * nx + vy * ny)
    slip = vx * ny - vy * nx + radius * spin
    hold = surface.friction * push
    along = max(-hold, min(hold, -slip / (1.0 + 1.0 / factor)))
    inside = max(0.0, radius + surface.shape.radius - distance)  # moved outside, so that the next gap starts open
    return np.array(
        [
            x + 2.0 * inside * nx,
            y + 2.0 * inside * ny,
            vx + push * nx + along * ny,
            vy + push * ny - along * nx,
            spin + along / (factor * radius),
        ]
    )
