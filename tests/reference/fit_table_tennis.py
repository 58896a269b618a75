"""Where drag, friction and restitution of table tennis, tennis/table-tennis, come from.

table_tennis.csv has one row for each tracked flight of the data of Gossard et al. 2023 (arXiv 2303.03879,
cogsys-tuebingen/spindoe, data/trajectories): the mean speed until it bounces, the spin ratio by the spin across the
flight, Cd and Cl in the middle of it, and of the bounce the restitution, the speed across and the slip, both in m/s,
and the tangential impulse over the normal one. ``python tests/reference/fit_table_tennis.py FOLDER`` writes it from
``index.csv`` and the tracks there; without a folder the script reads it, fits the even flights and prints the odd ones
by class of speed, of spin ratio and of slip.

Of the spin's components, y has the other sign here than in index.csv: so slip and friction are along one line (the
cosine is 0.99 at the median, with it as given 0.91).
"""

from __future__ import annotations

import csv
import sys
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

TABLE = Path(__file__).with_name("table_tennis.csv")
COLUMNS = ("flight", "speed", "spin_ratio", "drag", "lift", "restitution", "normal", "slip", "friction")
MASS, RADIUS, DENSITY, GRAVITY = 0.0027, 0.020, 1.204, 9.81  # kg, m, kg/m^3, m/s^2
PER_METRE = 0.5 * DENSITY * np.pi * RADIUS**2 / MASS

#: Fewest samples of an arc, and how far in m they may be from its polynomial, rms.
FEWEST, ROUGH = 14, 0.006

#: No arc of fewer s: its curvature would be known to no more than 10 %.
SHORTEST = 0.12


def bounce_at(x: np.ndarray) -> int | None:
    """The number of the sample at which a track, shape (samples, 3), bounces off the table; None if it does not."""
    z = x[:, 2]
    for i in range(4, len(z) - 4):
        if z[i] <= z[i - 3 : i + 4].min() and z[i] < 0.06 and min(z[i - 3], z[i + 3]) - z[i] > 0.008:
            return i
    return None


def arc(t: np.ndarray, x: np.ndarray, at: float, degree: int) -> tuple[np.ndarray, float]:
    """Coefficients of the polynomial through a track about the time ``at``, highest first, and the rms distance in m
    from it; samples that were taken for something else are left out."""
    kept = np.isfinite(x).all(axis=1)
    for _ in range(3):
        found = np.polyfit(t[kept] - at, x[kept], degree)
        off = np.linalg.norm(x - sum(c * (t[:, None] - at) ** (degree - k) for k, c in enumerate(found)), axis=1)
        kept = off < np.maximum(4.0 * np.median(off[kept]), 0.004)
    return found, float(np.sqrt(np.mean(off[kept] ** 2)))


def flight(t: np.ndarray, x: np.ndarray, spin: np.ndarray) -> list[float] | None:
    """Speed, spin ratio, Cd and Cl in the middle of an arc; None if it is too rough or short."""
    if len(t) < FEWEST or t[-1] - t[0] < SHORTEST:
        return None
    (_, half, velocity, _), rough = arc(t, x, 0.5 * (t[0] + t[-1]), 3)
    if rough > ROUGH:
        return None
    speed, across = float(np.linalg.norm(velocity)), np.cross(spin, velocity)
    pull = (2.0 * half + [0.0, 0.0, GRAVITY]) / (PER_METRE * speed**2)
    ratio = RADIUS * float(np.linalg.norm(across)) / speed**2
    return [speed, ratio, -float(pull @ velocity) / speed, float(pull @ across) / float(np.linalg.norm(across))]


def bounce(t: np.ndarray, x: np.ndarray, low: int, spin: np.ndarray) -> list[float] | None:
    """Restitution, normal speed, slip, and tangential over normal impulse; None if either side is too rough."""
    before, after = slice(max(0, low - 20), low - 1), slice(low + 1, low + 20)
    if min(len(t[before]), len(t[after])) < 10:
        return None
    found = []
    for at in np.linspace(t[low - 2], t[low + 2], 41):  # where the heights of both arcs agree
        arcs = [arc(t[side], x[side], at, 2) for side in (before, after)]
        apart = arcs[0][0][2] - arcs[1][0][2]
        found.append((abs(apart[2]), max(arcs[0][1], arcs[1][1], 0.5 * float(np.linalg.norm(apart))), arcs))
    _, rough, arcs = min(found, key=lambda one: one[0])
    down, up = (one[0][1] for one in arcs)
    restitution = -up[2] / down[2]
    if rough > ROUGH or not 0.75 < restitution < 1.05:
        return None
    slip = np.array([down[0] - RADIUS * spin[1], down[1] + RADIUS * spin[0]])
    size = float(np.linalg.norm(slip))
    return [restitution, -down[2], size, -float((up - down)[:2] @ slip) / size / (up[2] - down[2])]


def reduce(folder: Path) -> None:
    """Write the table from the tracks."""
    with (folder / "index.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        print(",".join(COLUMNS), file=file)
        for row in rows:
            number = int(float(row["traj_file"]))
            track = np.genfromtxt(folder / f"{number:03d}.csv", delimiter=";")
            t, x = track[:, 0], track[:, 1:4]
            spin = np.array([float(row["x_spin"]), -float(row["y_spin"]), float(row["z_spin"])])
            low = bounce_at(x)
            flown = flight(t[: low and low - 1], x[: low and low - 1], spin)
            bounced = bounce(t, x, low, spin) if low else None
            if flown or bounced:
                cells = [*(flown or [None] * 4), *(bounced or [None] * 4)]
                print(",".join([str(number), *("" if c is None else f"{c:.3f}" for c in cells)]), file=file)


def read() -> dict[str, np.ndarray]:
    """The columns of the table, NaN where there is nothing."""
    with TABLE.open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name] or "nan") for row in rows]) for name in COLUMNS}


def middle(values: np.ndarray) -> tuple[float, float]:
    """Median and its standard error, from the quartiles."""
    low, median, high = np.quantile(values, (0.25, 0.5, 0.75))
    return float(median), float(1.25 * (high - low) / 1.35 / np.sqrt(len(values)))


def print_classes(columns: dict[str, np.ndarray], by: str, of: Sequence[str], bounds: Sequence[float]) -> None:
    """The medians of some columns in classes of another one."""
    for low, high in pairwise(bounds):
        within = (columns[by] >= low) & (columns[by] < high)
        if within.sum() > 2:
            medians = {name: middle(columns[name][within]) for name in of}
            parts = (f"{name} {median:.3f} +- {error:.3f}" for name, (median, error) in medians.items())
            print(f"  {by} {low:g} to {high:g}, {within.sum():3}: {', '.join(parts)}")


def main() -> None:
    if len(sys.argv) > 1:
        reduce(Path(sys.argv[1]))
    columns = read()
    flown = np.isfinite(columns["drag"]) & (columns["speed"] >= 5.0)
    slid = np.isfinite(columns["friction"]) & (columns["slip"] > 5.0)
    for words, half in (("even, fitted", 0.0), ("odd, held out", 1.0)):
        mine = columns["flight"] % 2.0 == half
        print(words)
        bounced = np.isfinite(columns["restitution"])
        for name, kept in (("drag", flown), ("friction", slid), ("restitution", bounced)):
            median, error = middle(columns[name][kept & mine])
            print(f"  {name}: {median:.3f} +- {error:.3f} ({(kept & mine).sum()})")
        each = {name: values[mine] for name, values in columns.items()}
        some = {name: values[mine & flown] for name, values in columns.items()}
        print_classes(some, "speed", ("drag", "spin_ratio"), (5.0, 7.0, 9.0, 16.0))
        print_classes(some, "spin_ratio", ("drag", "lift"), (0.0, 0.25, 0.4, 0.6, 1.0, 2.0))
        print_classes(each, "slip", ("friction", "normal", "slip"), (0.0, 2.0, 4.0, 6.0, 9.0, 20.0))
        print_classes(each, "normal", ("restitution",), (0.0, 2.0, 2.5, 4.0))


if __name__ == "__main__":
    main()
