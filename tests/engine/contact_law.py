"""The equations of contact mechanics in docs/physics.md, integrated by scipy: what clusters are compared with."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations
from math import hypot, log, pi, sqrt

import numpy as np
from scipy.integrate import solve_ivp

from sandbox.engine.impact.cluster_parts import ClusterBall


def by_contact_law(
    bodies: Sequence[ClusterBall],
    times: Sequence[float],
    stiffness: float,
    restitution: float = 1.0,
    friction: Callable[[np.ndarray], np.ndarray] | float = 0.0,
    creep: float = 1e-3,
    accuracy: float = 1e-8,
) -> np.ndarray:
    """x, y, vx, vy, vz, wx, wy, wz of bodies (m, s, rad) at these times in s from the start, shape (times, bodies, 8).

    Coulomb's ``mu max(N, 0)`` against the slip s is taken as ``s / hypot(s, creep)`` of that, with ``creep`` in m/s.
    Overlaps at the start store no energy.
    """
    mass, radius, inertia = np.array([body[:3] for body in bodies]).T
    start = np.array([(*body.position, *body.velocity, 0.0, *body.spin) for body in bodies])
    push = np.array([body.acceleration for body in bodies])
    i, j = np.array(list(combinations(range(len(bodies)), 2))).T
    fading = log(restitution)
    reduced = mass[i] * mass[j] / (mass[i] + mass[j])
    damping = -sqrt(5) * fading / hypot(fading, pi) * np.sqrt(reduced * stiffness)
    reach = np.minimum(radius[i] + radius[j], np.hypot(*(start[i, :2] - start[j, :2]).T))

    def rates(t: float, flat: np.ndarray) -> np.ndarray:
        state = flat.reshape(-1, 8)
        rate = np.zeros_like(state)
        rate[:, :2], rate[:, 2:4] = state[:, 2:4], push
        apart = state[i, :2] - state[j, :2]
        near = np.flatnonzero(np.hypot(*apart.T) < reach)
        a, b, apart = i[near], j[near], apart[near]
        distance = np.hypot(*apart.T)
        normal = np.column_stack([apart / distance[:, None], np.zeros(len(near))])
        depth = reach[near] - distance
        spins = radius[a, None] * state[a, 5:] + radius[b, None] * state[b, 5:]
        speed = state[a, 2:5] - state[b, 2:5] - _cross(spins, normal)
        opening = (speed * normal).sum(axis=1)
        push_back = stiffness * depth**1.5 - damping[near] * depth**0.25 * opening
        slip = speed - opening[:, None] * normal
        size = np.sqrt((slip**2).sum(axis=1))
        mu = friction(size) if callable(friction) else friction
        rub = mu * np.maximum(push_back, 0.0) / np.hypot(size, creep)
        force = push_back[:, None] * normal - rub[:, None] * slip
        for k, sign in ((a, 1.0), (b, -1.0)):
            np.add.at(rate[:, 2:5], k, sign * force / mass[k, None])
            np.add.at(rate[:, 5:], k, _cross(force, normal) * (radius / inertia)[k, None])
        return rate.ravel()

    span = (0.0, float(times[-1]))
    found = solve_ivp(
        rates, span, start.ravel(), "DOP853", times, rtol=accuracy, atol=1e-12, max_step=max(times[-1], 1e-9) / 30
    )
    return found.y.T.reshape(-1, len(bodies), 8)


def _cross(a: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """The vector product with vectors in the plane."""
    (x, y, z), (nx, ny, _) = a.T, normal.T
    return np.column_stack([-z * ny, z * nx, x * ny - y * nx])


def by_springs(
    bodies: Sequence[ClusterBall],
    end: float,
    stiffness: float,
    restitution: float,
    friction: float,
    along: float,
    deepest: float,
    steps: int = 1000,
    springs: int = 10,
) -> np.ndarray:
    """x, y, vx, vy, vz, wx, wy, wz of bodies (m, s, rad) after ``end`` s, shape (bodies, 8), where contacts give way
    along them, too: rows of equal springs up to the depth ``deepest`` (m), in small steps of first order."""
    mass, radius, inertia = np.array([body[:3] for body in bodies]).T
    state = np.array([(*body.position, *body.velocity, 0.0, *body.spin) for body in bodies])
    i, j = np.array(list(combinations(range(len(bodies)), 2))).T
    fading, reduced = log(restitution), mass[i] * mass[j] / (mass[i] + mass[j])
    damping = -sqrt(5) * fading / hypot(fading, pi) * np.sqrt(reduced * stiffness)
    reach = np.minimum(radius[i] + radius[j], np.hypot(*(state[i, :2] - state[j, :2]).T))
    places = (np.arange(springs) + 0.5) / springs  # from the middle of the contact, over the largest radius
    stiff = along * 1.5 * stiffness * sqrt(deepest) / springs  # N/m
    stretch, h = np.zeros((len(i), springs, 3)), end / steps
    for _ in range(steps):
        apart = state[i, :2] - state[j, :2]
        distance = np.hypot(*apart.T)
        normal = np.column_stack([apart / distance[:, None], np.zeros(len(i))])
        depth = np.maximum(reach - distance, 0.0)
        spins = radius[i, None] * state[i, 5:] + radius[j, None] * state[j, 5:]
        speed = state[i, 2:5] - state[j, 2:5] - _cross(spins, normal)
        opening = (speed * normal).sum(axis=1)
        push = np.maximum(stiffness * depth**1.5 - damping * depth**0.25 * opening, 0.0) * (depth > 0.0)
        share = np.maximum(depth[:, None] - deepest * places**2, 0.0)
        stretch += h * (speed - opening[:, None] * normal)[:, None]
        stretch -= (stretch * normal[:, None]).sum(axis=2)[..., None] * normal[:, None]
        most = friction * push[:, None] * share / np.maximum(share.sum(axis=1), 1e-30)[:, None] / stiff
        size = np.sqrt((stretch**2).sum(axis=2))
        stretch *= np.minimum(1.0, most / np.maximum(size, 1e-30))[..., None]
        force = push[:, None] * normal - stiff * stretch.sum(axis=1)
        for k, sign in ((i, 1.0), (j, -1.0)):
            np.add.at(state[:, 2:5], k, h * sign * force / mass[k, None])
            np.add.at(state[:, 5:], k, h * _cross(force, normal) * (radius / inertia)[k, None])
        state[:, :2] += h * state[:, 2:4]
    return state
