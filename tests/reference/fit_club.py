"""Where the stiffness and damping of club on ball come from: fits them to irons again, and predicts the other clubs.

``python tests/reference/fit_club.py`` fits the spins of the eight irons of the PGA Tour averages to 2018, kind "fitted"
in scenes/golf/published/club.csv, and prints the errors of all groups of that table, with irons and drivers apart;
what a driver's face and a tenth more stiffness change; and how far beside the ball's centre the force across the face
would have to act for the rows whose loft was published. A few seconds.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from math import atan2, cos, degrees, hypot, inf, pi, radians, sin

import numpy as np
from scipy.optimize import least_squares

from sandbox import resources
from sandbox.lab.published import COUNTED
from sandbox.physics.club import Head, LaunchConditions, strike

MASS, RADIUS, MPH, RPM = 0.04593, 0.021335, 0.44704, pi / 30.0  # kg, m, m/s, rad/s
FRICTION, INERTIA = 0.4, 2.843e-4  # of face and ball; kg m^2, of a driver
CHOSEN = 0.78, 0.24

#: How much softer than on a rigid face the impact with a driver is: its face stores, and returns, what the ball then
#: does not lose, so that their restitution is 0.83 in place of 0.78.
DRIVER = (1.0 - 0.78**2) / (1.0 - 0.83**2)

Row = dict[str, str]


def read() -> list[Row]:
    with (resources.folder("scenes") / "golf" / "published" / "club.csv").open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def launch(row: Row, stiffness: float, damping: float, face: float = DRIVER) -> LaunchConditions:
    """The ball of a row, with these numbers of the contact on a rigid face; ``face`` is what a driver's makes of it."""
    stiffness = face * stiffness if row["club"] == "driver" else stiffness
    depth = 1e-3 * float(row["depth_mm"])
    restitution, mass = float(row["restitution"]), 1e-3 * float(row["head_g"])
    head = Head(mass, restitution, FRICTION, stiffness, damping, depth, INERTIA if depth else inf)
    angles = radians(float(row["loft_deg"])), radians(float(row["attack_deg"]))
    return strike(head, float(row["club_speed_mph"]) * MPH, *angles, 0.0, MASS, RADIUS)


def errors(rows: Sequence[Row], stiffness: float, damping: float, face: float = DRIVER) -> np.ndarray:
    """Shape (3, rows): of spin and ball speed, as shares, and of the launch angle, in deg."""
    found = []
    for row in rows:
        ball = launch(row, stiffness, damping, face)
        found.append(
            (
                ball.spin / RPM / float(row["spin_rpm"]) - 1.0,
                hypot(ball.vx, ball.vy) / MPH / float(row["ball_speed_mph"]) - 1.0,
                degrees(atan2(ball.vy, ball.vx)) - float(row["launch_deg"]),
            )
        )
    return np.array(found).T


def offset(row: Row) -> float:
    """How far up the face from the middle of the force the ball's centre was, in m, if what is published is exact."""
    lean, speed = radians(float(row["loft_deg"]) - float(row["launch_deg"])), float(row["ball_speed_mph"]) * MPH
    turning = 0.4 * RADIUS**2 * float(row["spin_rpm"]) * RPM
    return (turning - RADIUS * speed * sin(lean)) / (speed * cos(lean))


def described(name: str, rows: Sequence[Row]) -> str:
    spin, speed, angle = errors(rows, *CHOSEN)
    worst = int(np.argmax(np.abs(spin)))
    return (
        f"{name:30} {len(rows):2}: spin {100.0 * rms(spin):4.1f} % rms ({100.0 * np.mean(spin):+5.1f} % mean, "
        f"{rows[worst]['club']} {100.0 * spin[worst]:+.0f} %), ball speed {100.0 * rms(speed):.1f} %, "
        f"launch {rms(angle):.1f} deg"
    )


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def main() -> None:
    rows = read()
    irons = [row for row in rows if row["group"] == "PGA to 2018" and row["kind"] == "fitted"]
    fit = least_squares(lambda numbers: errors(irons, *numbers)[0], CHOSEN, diff_step=1e-3)
    print("fitted to {} irons: stiffness {:.3f}, damping {:.3f}; chosen {}, {}".format(len(irons), *fit.x, *CHOSEN))
    print(described("fitted", irons))
    for group in dict.fromkeys(row["group"] for row in rows):
        print(described(group, [row for row in rows if row["group"] == group]))
    held = [row for row in rows if row["kind"] in COUNTED]
    print(described("all held out", held))
    print(described("drivers of them", [row for row in held if row["club"] == "driver"]))
    print(described("amateurs' drivers", [row for row in rows if row["kind"] == "measured"]))
    print(described("irons of them", [row for row in held if row["club"][-1] in "iW"]))
    print(described("drivers of the optimizers", [r for r in rows if r["kind"] == "model" and r["club"] == "driver"]))
    drivers = [row for row in rows if row["club"] == "driver"]
    for row, spin, rigid in zip(drivers, errors(drivers, *CHOSEN)[0], errors(drivers, *CHOSEN, 1.0)[0], strict=True):
        print(f"{row['group']} driver: spin {100.0 * spin:+.0f} %, with a rigid face {100.0 * rigid:+.0f} %")
    stiffer = [launch(row, 1.1 * CHOSEN[0], CHOSEN[1]).spin / launch(row, *CHOSEN).spin - 1.0 for row in held]
    print(f"a tenth more stiffness: {100.0 * min(stiffer):+.0f} to {100.0 * max(stiffer):+.0f} % of spin")
    for row in rows:
        if row["group"] not in ("PGA", "LPGA", "PGA to 2018"):
            print(f"{row['group']} {row['club']}: force {1e3 * offset(row):+.2f} mm below the centre")


if __name__ == "__main__":
    main()
