"""Where the numbers of ``tour_fit_drag`` and ``tour_fit_lift`` come from: fits them to the PGA Tour averages again.

``python tests/reference/fit_golf_ball.py`` prints the four free numbers with their uncertainty, and the errors: on the
averages fitted to, on each of them when it is left out of the fit, and on those of the LPGA Tour. About a minute.
"""

from __future__ import annotations

import csv

import numpy as np
from scipy.optimize import least_squares

from sandbox import resources
from sandbox.physics.coefficients import Coefficient
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
from sandbox.physics.integrators import INTEGRATORS

MASS, RADIUS, GRAVITY, DENSITY = 0.04593, 0.021335, 9.81, 1.1839  # kg, m, m/s^2, kg/m^3
INERTIA = 0.4 * MASS * RADIUS**2  # kg m^2
SPIN_DECAY = 2e-5 * DENSITY / 1.204
MPH, YARD, RPM = 0.44704, 0.9144, np.pi / 30.0
STEP, STEPS = 0.04, 300  # s; 12 s is longer than any of these flights

#: What counts as one unit of error in height, landing angle and carry: yd, deg, yd.
UNITS = np.array([[2.9], [3.0], [3.5]])

#: Critical Re in 1e5, induced drag, greatest lift, and the S at which lift has 63 % of that.
FIRST_GUESS = (0.70, 1.0, 0.32, 0.13)


def read(tour: str) -> np.ndarray:
    """Shape (6, clubs): speed in m/s, launch angle in rad, spin in rad/s; height in yd, landing in deg, carry in yd."""
    with (resources.folder("scenes") / "golf" / "published" / "tour.csv").open(newline="", encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["tour"] == tour]
    columns = ("ball_speed_mph", "launch_deg", "spin_rpm", "max_height_yd", "land_deg", "carry_yd")
    table = np.array([[float(row[column]) for row in rows] for column in columns])
    table[:3] *= [[MPH], [np.pi / 180.0], [RPM]]
    return table


def model(numbers: np.ndarray) -> tuple[Coefficient, Coefficient]:
    """Drag and lift coefficient of the form of tour_fit with these four numbers."""
    critical, induced, greatest, scale = numbers

    def lift(re, s):
        return greatest * (1.0 - np.exp(-s / scale))

    def drag(re, s):
        return 0.20 + 0.30 / (1.0 + (re / (1e5 * critical)) ** 8) + induced * lift(re, s) ** 2

    return drag, lift


def fly(shots: np.ndarray, drag: Coefficient, lift: Coefficient) -> np.ndarray:
    """Shape (3, shots): height in yd, landing angle in deg, carry in yd."""
    forces = Gravity(GRAVITY, MASS), Drag(RADIUS, DENSITY, drag), Magnus(RADIUS, DENSITY, lift)
    decay = SpinDecay(INERTIA, RADIUS, SPIN_DECAY)

    def law(t, state):
        position, velocity, spin = state[:2], state[2:4], state[4]
        pushes = [force(t, position, velocity, spin) for force in forces]
        torque = decay(t, position, velocity, spin)
        return sum(fx for fx, _ in pushes) / MASS, sum(fy for _, fy in pushes) / MASS, torque / INERTIA

    speed, angle, spin = shots
    zero = np.zeros_like(speed)
    states = [(zero, zero, speed * np.cos(angle), speed * np.sin(angle), spin)]
    for number in range(STEPS):
        t = number * STEP
        states.append(INTEGRATORS["rk4"].step_of(law)(t, states[-1], law(t, states[-1]), STEP)[0])
    x, y, vx, vy, _ = np.array(states).transpose(1, 0, 2)  # each (times, shots)
    shot = np.arange(len(speed))
    last = np.argmax(y[1:] < 0.0, axis=0)  # the step in which it comes down
    v0, v1 = vy[last, shot], vy[last + 1, shot]
    fall = (v1 - v0) / STEP
    after = (-v0 - np.sqrt(v0**2 - 2.0 * fall * y[last, shot])) / fall  # s, at even acceleration
    share = after / STEP
    land_vx = vx[last, shot] + share * (vx[last + 1, shot] - vx[last, shot])
    carry = x[last, shot] + after * 0.5 * (vx[last, shot] + land_vx)
    return np.array([y.max(axis=0) / YARD, np.degrees(np.arctan2(-(v0 + after * fall), land_vx)), carry / YARD])


def errors(table: np.ndarray, numbers: np.ndarray) -> np.ndarray:
    """Shape (3, clubs), in yd, deg, yd."""
    return fly(table[:3], *model(numbers)) - table[3:]


def fit(table: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The four numbers and their standard errors."""
    found = least_squares(
        lambda numbers: (errors(table, numbers) / UNITS).ravel(), FIRST_GUESS, x_scale=FIRST_GUESS, diff_step=1e-4
    )
    variance = 2.0 * found.cost / (found.fun.size - found.x.size)
    return found.x, np.sqrt(variance * np.diag(np.linalg.inv(found.jac.T @ found.jac)))


def rms(values: np.ndarray) -> str:
    height, landing, carry = np.sqrt(np.mean(values**2, axis=1))
    return f"height {height:.2f} yd, landing {landing:.2f} deg, carry {carry:.2f} yd"


def main() -> None:
    pga, lpga = read("PGA"), read("LPGA")
    numbers, uncertain = fit(pga)
    for name, value, error in zip(
        ("critical Re / 1e5", "induced drag", "greatest Cl", "S"), numbers, uncertain, strict=True
    ):
        print(f"{name:18} {value:.4f} +- {error:.4f}")
    print(f"fitted to         {rms(errors(pga, numbers))}")
    print(f"LPGA              {rms(errors(lpga, numbers))}")
    left_out = []
    for club in range(pga.shape[1]):
        others = np.delete(pga, club, axis=1)
        left_out.append(errors(pga[:, [club]], fit(others)[0]))
    print(f"each left out     {rms(np.hstack(left_out))}")
    print(f"as in the model   {rms(errors(pga, np.array([0.68, 1.10, 0.324, 0.126])))}")


if __name__ == "__main__":
    main()
