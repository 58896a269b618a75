"""What the cloth does while two balls push each other: ``python tests/reference/blow_on_cloth.py``. A few seconds.

A ball that the other's friction presses on to the cloth rubs there, during the blow (Mathavan, Jackson & Parkin 2014,
Sports Eng. 17:227; Kim 2024, New Phys.: Sae Mulli 74:621). Here the equations of both balls are integrated over the
impulse, with that friction and without it, for the shots that Mathavan filmed. The cloth's force acts through the point
about which a ball begins to roll, so it changes how fast the balls leave, and hardly how they roll on.
"""

from __future__ import annotations

import sys
from math import atan2, cos, degrees, hypot, radians, sin

import numpy as np

RADIUS, RESTITUTION, FRICTION, CLOTH = 0.02625, 0.89, 0.05, 0.212  # m; Mathavan 2014
SHOTS = ((1.539, 33.83), (1.032, 26.36), (1.364, 40.52), (1.731, 46.5))  # m/s of the rolling cue ball, cut in deg
STEPS = 10_000
UP = np.array([0.0, 0.0, 1.0])


def blow(speed: float, cut: float, cloth: float) -> tuple[np.ndarray, np.ndarray]:
    """Velocities in m/s and angular velocities in rad/s after the blow, shape (2, 3): cue ball, object ball."""
    line = np.array([cos(radians(cut)), -sin(radians(cut)), 0.0])
    velocity, spin = np.zeros((2, 2, 3))
    velocity[0, 0], spin[0, 1] = speed, speed / RADIUS
    push = 0.5 * (1.0 + RESTITUTION) * speed * line[0] / STEPS  # per mass
    for _ in range(STEPS):
        slip = velocity[0] - velocity[1] + np.cross(spin[0] + spin[1], RADIUS * line)
        slip -= (slip @ line) * line
        rub = -FRICTION * push * slip / (hypot(*slip) + 1e-12)
        for ball, sign in ((0, 1.0), (1, -1.0)):
            impulse, twist = sign * (rub - push * line), np.cross(RADIUS * line, rub)
            if impulse[2] < 0.0:  # the cloth holds it
                below = velocity[ball] - np.cross(spin[ball], RADIUS * UP)
                drag = cloth * impulse[2] * below * [1.0, 1.0, 0.0] / (hypot(*below[:2]) + 1e-12)
                impulse = impulse * [1.0, 1.0, 0.0] + drag
                twist = twist - np.cross(RADIUS * UP, drag)
            velocity[ball] += impulse
            spin[ball] += 2.5 * twist / RADIUS**2
    return velocity, spin


def rolling(velocity: np.ndarray, spin: np.ndarray) -> np.ndarray:
    """Velocities in m/s once the balls roll, shape (2, 2)."""
    return (5.0 * velocity + 2.0 * np.cross(spin, RADIUS * UP))[:, :2] / 7.0


def said(velocity: np.ndarray) -> str:
    return ", ".join(f"{hypot(x, y):.4f} m/s at {degrees(atan2(y, x)):.2f} deg" for x, y in velocity[:, :2])


if __name__ == "__main__":
    for speed, cut in SHOTS:
        for name, cloth in (("with the cloth's friction", CLOTH), ("without", 0.0)):
            velocity, spin = blow(speed, cut, cloth)
            sys.stdout.write(f"{speed} m/s, cut {cut} deg, {name}: leave with {said(velocity)};\n")
            sys.stdout.write(f"    roll with {said(rolling(velocity, spin))}\n")
