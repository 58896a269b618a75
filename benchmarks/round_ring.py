"""The side of the ring, which the basketball scene leaves out: free throws at a round ring in space, and in the scene.

A ball that is off to the side meets the ring on a slope, from which it may drop in; in the scene, which is a plane, it
misses. Here the ring is a torus, the impact that of a hollow sphere with restitution and friction (impulses as in
docs/physics.md), at fixed steps. Usage: ``python benchmarks/round_ring.py``.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np
from scipy.stats import norm, qmc

import sandbox

THROWS, STEP, LONGEST = 2048, 2e-4, 3.0  # s
#: Standard deviations of a practised player: a share of the speed, and deg.
SPEED, ANGLE, SIDE = 0.01, 1.0, 1.0


def impact(v: Any, w: Any, n: Any, touches: Any, e: float, friction: float, radius: float) -> tuple[Any, Any]:
    """Velocities and spins after an impact with what stands still, along normals n: grip, or friction."""
    approach = (v * n).sum(axis=1)
    slip = v - approach[:, None] * n + np.cross(w, -radius * n)
    normal = -(1.0 + e) * approach  # per mass
    speed = np.linalg.norm(slip, axis=1)
    along = np.minimum(friction * normal, speed / (1.0 + 1.5))  # 1 + m r^2 / I of a hollow sphere
    push = normal[:, None] * n - (along / np.maximum(speed, 1e-12))[:, None] * slip
    hit = (touches & (approach < 0.0))[:, None]
    return np.where(hit, v + push, v), np.where(hit, w + np.cross(-radius * n, push) * 1.5 / radius**2, w)


def made_in_space(p: Any, speed: Any, angle: Any, side: Any) -> Any:
    """True for each throw that goes in."""
    a, s = np.radians(angle), np.radians(side)
    v = np.column_stack([speed * np.cos(a) * np.cos(s), speed * np.sin(a), speed * np.cos(a) * np.sin(s)])
    x = np.tile([-p.hoop.distance, p.release.height - p.hoop.height, 0.0], (len(speed), 1))
    spin = p.launch.spin * np.pi / 30.0
    w = spin * np.column_stack([-np.sin(s), np.zeros(len(s)), np.cos(s)])  # backspin about the axis across
    radius, tube = p.ball.radius, p.hoop.tube_radius
    ring, board = 0.5 * p.hoop.inner_diameter + tube, 0.5 * p.hoop.inner_diameter + p.backboard.gap
    bottom, top = p.backboard.bottom - p.hoop.height, p.backboard.top - p.hoop.height
    k = 0.5 * p.air.density * np.pi * radius**2 * p.ball.drag.coefficient / p.ball.mass
    made, over = np.zeros(len(speed), bool), np.zeros(len(speed), bool)
    for _ in range(int(LONGEST / STEP)):
        before = x[:, 1]
        pull = -k * np.linalg.norm(v, axis=1)[:, None] * v - np.array([0.0, p.gravity, 0.0])
        x = x + STEP * v + 0.5 * STEP**2 * pull
        v = v + STEP * pull
        across = np.hypot(x[:, 0], x[:, 2])
        through = (before >= 0.0) & (x[:, 1] < 0.0) & (across < ring - tube) & ~over
        made |= through
        over |= through | (x[:, 1] < -1.0)
        out = np.column_stack([x[:, 0], np.zeros(len(x)), x[:, 2]]) * (ring / np.maximum(across, 1e-9))[:, None]
        n = x - out
        gap = np.linalg.norm(n, axis=1)
        v, w = impact(v, w, n / gap[:, None], gap < radius + tube, p.hoop.restitution, p.hoop.friction, radius)
        faces = (x[:, 0] > board - radius) & (x[:, 1] > bottom) & (x[:, 1] < top) & (np.abs(x[:, 2]) < 0.915)
        n = np.tile([-1.0, 0.0, 0.0], (len(x), 1))
        v, w = impact(v, w, n, faces, p.backboard.restitution, p.backboard.friction, radius)
        if over.all():
            break
    return made


def main() -> None:
    scene = sandbox.load("basketball/free-throw")
    p: Any = scene.parameters
    z = norm.ppf(qmc.Sobol(3, seed=0).random(THROWS))
    speed, angle = p.launch.speed * (1.0 + SPEED * z[:, 0]), p.launch.angle + ANGLE * z[:, 1]
    for side in (0.0, 0.5 * SIDE, SIDE):
        points = {"launch.speed": speed, "launch.angle": angle, "launch.side": side * z[:, 2]}
        plane = sandbox.simulate_many(scene, points, facts=("made",))["made"]
        space = made_in_space(p, speed, angle, side * z[:, 2])
        shares = [100.0 * some.mean() for some in (plane, space, space & ~plane, plane & ~space)]
        told = (
            "side {:.1f} deg: {:.1f} % in the scene, {:.1f} % at a round ring; only there {:.1f} %, only here {:.1f} %"
        )
        sys.stdout.write(told.format(side, *shares) + "\n")


if __name__ == "__main__":
    main()
