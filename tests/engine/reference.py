"""An independent reference for the engine: scipy's DOP853 at 1e-12 with located events, and the closed-form impulse.

It shares no code with sandbox/: distances by hypot, impulses by the formula for an oblique bounce, flight by scipy.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp


@dataclass(frozen=True)
class Disc:
    """A fixed circle."""

    name: str
    x: float
    y: float
    radius: float
    restitution: float
    friction: float

    def gap(self, x, y, ball_radius):
        return np.hypot(x - self.x, y - self.y) - self.radius - ball_radius

    def normal(self, x, y):
        d = np.hypot(x - self.x, y - self.y)
        return (x - self.x) / d, (y - self.y) / d


@dataclass(frozen=True)
class Bar:
    """A fixed segment with round ends."""

    name: str
    ax: float
    ay: float
    bx: float
    by: float
    radius: float
    restitution: float
    friction: float

    def _nearest(self, x, y):
        dx, dy = self.bx - self.ax, self.by - self.ay
        s = np.clip(((x - self.ax) * dx + (y - self.ay) * dy) / (dx * dx + dy * dy), 0.0, 1.0)
        return self.ax + s * dx, self.ay + s * dy

    def gap(self, x, y, ball_radius):
        px, py = self._nearest(x, y)
        return np.hypot(x - px, y - py) - self.radius - ball_radius

    def normal(self, x, y):
        px, py = self._nearest(x, y)
        d = np.hypot(x - px, y - py)
        return (x - px) / d, (y - py) / d


def bounce(vx, vy, spin, nx, ny, restitution, friction, factor, radius):
    """Oblique bounce of a ball with moment of inertia factor * m r^2 off a fixed surface with Coulomb friction."""
    vn = vx * nx + vy * ny
    tx, ty = ny, -nx
    slip = vx * tx + vy * ty + radius * spin
    push = -(1.0 + restitution) * vn  # normal impulse over mass
    grip = -slip / (1.0 + 1.0 / factor)  # tangential impulse over mass that stops the slip
    drag = max(-friction * push, min(friction * push, grip))
    return vx + push * nx + drag * tx, vy + push * ny + drag * ty, spin + drag / (factor * radius)


def shoot(acceleration, state, surfaces, radius, factor, duration, most=40):
    """Impacts as (t, name, normal speed, x, y), and the state at ``duration``. ``state`` is x, y, vx, vy, spin."""
    t, state, impacts = 0.0, np.array(state, dtype=float), []

    def law(time, s):
        ax, ay, alpha = acceleration(time, s)
        return [s[2], s[3], ax, ay, alpha]

    def event(surface):
        def gap(time, s):
            return surface.gap(s[0], s[1], radius)

        gap.terminal, gap.direction = True, -1
        return gap

    while t < duration and len(impacts) < most:
        # leave the surface just touched: a bounce is over when the gap has opened
        solution = solve_ivp(
            law,
            (t, duration),
            state,
            "DOP853",
            events=[event(s) for s in surfaces],
            rtol=1e-13,
            atol=1e-13,
            max_step=0.004,
        )
        t, state = solution.t[-1], solution.y[:, -1].copy()
        if solution.status != 1:
            break
        surface = surfaces[next(i for i, found in enumerate(solution.t_events) if len(found))]
        nx, ny = surface.normal(state[0], state[1])
        impacts.append((t, surface.name, -(state[2] * nx + state[3] * ny), state[0], state[1]))
        state[2:5] = bounce(*state[2:5], nx, ny, surface.restitution, surface.friction, factor, radius)
        deepest = surface.gap(state[0], state[1], radius)
        if deepest < 0.0:  # put it back outside, so that the next gap starts from above zero
            state[0] -= 2 * deepest * nx
            state[1] -= 2 * deepest * ny
    return impacts, state
