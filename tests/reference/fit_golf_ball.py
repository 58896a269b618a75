"""Where the numbers of ``monitor-fit`` and ``tour-fit``, drag and lift of a golf ball, come from.

``python tests/reference/fit_golf_ball.py`` fits both again, each to what its docstring says, and prints their numbers
with their uncertainty and the errors: on what was fitted, on what was held out, and of tour-fit on each average when it
is left out of the fit. Five minutes.
"""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
from scipy.optimize import least_squares

from sandbox import resources
from sandbox.physics.coefficients import GOLF_DRAG, GOLF_LIFT, Coefficient
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
from sandbox.physics.integrators import INTEGRATORS

MASS, RADIUS, GRAVITY = 0.04593, 0.021335, 9.81  # kg, m, m/s^2
INERTIA = 0.4 * MASS * RADIUS**2  # kg m^2
SPIN_DECAY, OF_DENSITY = 2e-5, 1.204  # kg/m^3
MPH, YARD, FOOT, RPM = 0.44704, 0.9144, 0.3048, np.pi / 30.0
STEP, STEPS = 0.05, 240  # s; 12 s is longer than any of these flights

#: Results of a flight: carry in yd, apex in yd, landing angle in deg and speed in mph, time in s.
Numbers = np.ndarray


class Shots(NamedTuple):
    """Launches, shape (3, shots) in m/s, rad and rad/s; what became of them, shape (5, shots) with NaN where
    that is not published; the density of the air in kg/m^3; and what counts as one unit of error in each result."""

    launches: np.ndarray
    results: Numbers
    density: float
    units: Sequence[float] = (1.0,) * 5

    def only(self, wanted: np.ndarray, units: Sequence[float]) -> Shots:
        return self._replace(launches=self.launches[:, wanted], results=self.results[:, wanted], units=units)


class Form(NamedTuple):
    """The form of a drag and a lift coefficient with some numbers in it."""

    numbers: Sequence[str]
    first_guess: Sequence[float]
    of: Callable[[Sequence[float]], tuple[Coefficient, Coefficient]]


def _tour_form(numbers: Sequence[float]) -> tuple[Coefficient, Coefficient]:
    critical, induced, greatest, scale = numbers

    def lift(re, s):
        return greatest * (1.0 - np.exp(-s / scale))

    def drag(re, s):
        return 0.20 + 0.30 / (1.0 + (re / (1e5 * critical)) ** 8) + induced * lift(re, s) ** 2

    return drag, lift


def _monitor_form(numbers: Sequence[float]) -> tuple[Coefficient, Coefficient]:
    critical, least, induced, greatest, scale, power = numbers

    def lift(re, s):
        return greatest * (1.0 - np.exp(-s / scale)) * (np.clip(re, 0.3e5, 3e5) / 1.2e5) ** power

    def drag(re, s):
        return least + (0.5 - least) / (1.0 + (re / (1e5 * critical)) ** 8) + induced * lift(re, s) ** 2

    return drag, lift


FORMS = {
    "tour-fit": Form(("critical Re / 1e5", "induced drag", "greatest Cl", "S"), (0.70, 1.0, 0.32, 0.13), _tour_form),
    "monitor-fit": Form(
        ("critical Re / 1e5", "least Cd", "induced drag", "Cl at 1.2e5", "S", "power of Re"),
        (0.58, 0.18, 1.4, 0.37, 0.17, 0.25),
        _monitor_form,
    ),
}


def _rows(name: str) -> list[dict[str, str]]:
    with (resources.folder("scenes") / "golf" / "published" / name).open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def _shots(
    rows: Sequence[dict[str, str]], launch: Sequence[str], results: dict[int, tuple[str, float]], density: float
) -> Shots:
    launches = np.array([[float(row[column]) for row in rows] for column in launch])
    launches *= [[MPH], [np.pi / 180.0], [RPM]]
    found = np.full((5, len(rows)), np.nan)
    for place, (column, scale) in results.items():
        found[place] = [scale * float(row[column]) for row in rows]
    return Shots(launches, found, density)


def tour(name: str) -> Shots:
    """The averages of a tour; the air is taken to be at 25 C."""
    rows = [row for row in _rows("tour.csv") if row["tour"] == name]
    results = {0: ("carry_yd", 1.0), 1: ("max_height_yd", 1.0), 2: ("land_deg", 1.0)}
    return _shots(rows, ("ball_speed_mph", "launch_deg", "spin_rpm"), results, 1.1839)


def monitor(kind: str) -> Shots:
    """Straight drives of a launch monitor, means of like ones; the air is taken to be at 20 C."""
    rows = [row for row in _rows("monitor.csv") if row["kind"] == kind]
    columns = ("carry_yd", "apex_ft", "landing_angle_deg", "landing_speed_mph", "time_s")
    results = {place: (column, 1.0 / 3.0 if place == 1 else 1.0) for place, column in enumerate(columns)}
    return _shots(rows, ("ball_speed_mph", "launch_angle_deg", "spin_rpm"), results, 1.204)


def fly(shots: Shots, drag: Coefficient, lift: Coefficient) -> Numbers:
    """The results of these launches, shape (5, shots)."""
    density, (speed, angle, spin) = shots.density, shots.launches
    forces = Gravity(GRAVITY, MASS), Drag(RADIUS, density, drag), Magnus(RADIUS, density, lift)
    decay = SpinDecay(INERTIA, RADIUS, SPIN_DECAY * density / OF_DENSITY)

    def law(t, state):
        position, velocity, spin = state[:2], state[2:4], state[4]
        pushes = [force(t, position, velocity, spin) for force in forces]
        torque = decay(t, position, velocity, spin)
        return sum(fx for fx, _ in pushes) / MASS, sum(fy for _, fy in pushes) / MASS, torque / INERTIA

    zero = np.zeros_like(speed)
    states = [(zero, zero, speed * np.cos(angle), speed * np.sin(angle), spin)]
    for number in range(STEPS):
        t = number * STEP
        states.append(INTEGRATORS["rk4"].step_of(law)(t, states[-1], law(t, states[-1]), STEP)[0])
        if (states[-1][1] < 0.0).all():
            break
    x, y, vx, vy, _ = np.array(states).transpose(1, 0, 2)  # each (times, shots)
    shot = np.arange(len(speed))
    last = np.argmax(y[1:] < 0.0, axis=0)  # the step in which it comes down
    v0, v1 = vy[last, shot], vy[last + 1, shot]
    fall = (v1 - v0) / STEP
    after = (-v0 - np.sqrt(v0**2 - 2.0 * fall * y[last, shot])) / fall  # s, at even acceleration
    land_vx = vx[last, shot] + after / STEP * (vx[last + 1, shot] - vx[last, shot])
    land_vy = v0 + after * fall
    carry = x[last, shot] + after * 0.5 * (vx[last, shot] + land_vx)
    down, fast = np.degrees(np.arctan2(-land_vy, land_vx)), np.hypot(land_vx, land_vy) / MPH
    return np.array([carry / YARD, y.max(axis=0) / YARD, down, fast, last * STEP + after])


def errors(shots: Shots, laws: tuple[Coefficient, Coefficient]) -> Numbers:
    """Shape (5, shots); NaN where nothing is published."""
    return fly(shots, *laws) - shots.results


def fit(form: Form, sets: Sequence[Shots]) -> tuple[np.ndarray, np.ndarray]:
    """The numbers of a form and their standard errors; each set has the same weight."""

    def off(numbers: np.ndarray) -> np.ndarray:
        parts = []
        for shots in sets:
            apart = errors(shots, form.of(numbers)) / np.reshape(shots.units, (5, 1)) / np.sqrt(shots.results.shape[1])
            parts.append(apart[np.isfinite(apart)])
        return np.concatenate(parts)

    found = least_squares(off, form.first_guess, x_scale=form.first_guess, diff_step=1e-4)
    variance = 2.0 * found.cost / (found.fun.size - found.x.size)
    return found.x, np.sqrt(variance * np.diag(np.linalg.inv(found.jac.T @ found.jac)))


def described(name: str, off: Numbers) -> str:
    """Root mean square and mean of errors, as a line."""
    units = ("carry {} yd", "apex {} yd", "landing {} deg", "at {} mph", "time {} s")
    parts = [
        unit.format(f"{np.sqrt(np.mean(row**2)):.2f} ({np.mean(row):+.2f})")
        for unit, row in zip(units, off, strict=True)
        if np.isfinite(row).all()
    ]
    return f"  {name:28} {', '.join(parts)}"


def print_fit(name: str, sets: Sequence[Shots]) -> None:
    print(name)
    for number, value, error in zip(FORMS[name].numbers, *fit(FORMS[name], sets), strict=True):
        print(f"  {number:18} {value:.4f} +- {error:.4f}")
    laws = GOLF_DRAG[name], GOLF_LIFT[name]
    print("  rms errors (and their means) of the law in coefficients.py:")
    kept = {"PGA": tour("PGA"), "LPGA": tour("LPGA"), "drives fitted": monitor("fitted"),
            "drives left out": monitor("model")}  # fmt: skip
    for what, shots in kept.items():
        print(described(what, errors(shots, laws)))


def main() -> None:
    pga = tour("PGA")
    nothing = np.inf
    of_tour = pga._replace(units=(3.5, 2.9, 3.0, nothing, nothing))
    print_fit("tour-fit", [of_tour])
    left_out = []
    clubs = np.arange(pga.results.shape[1])
    for club in clubs:
        numbers, _ = fit(FORMS["tour-fit"], [of_tour.only(clubs != club, of_tour.units)])
        left_out.append(errors(pga.only(clubs == club, of_tour.units), _tour_form(numbers)))
    print(described("PGA, each left out", np.hstack(left_out)))
    drives = monitor("fitted")._replace(units=(2.7, 1.0, 0.9, 0.9, 0.15))
    print_fit("monitor-fit", [drives, pga._replace(units=(4.0, 2.4, 2.5, nothing, nothing))])


if __name__ == "__main__":
    main()
