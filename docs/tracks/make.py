"""Write the made-up measurements of from-your-video.md, from-your-launch-monitor.md, session.md and fit.md: runs of the
sandbox itself, with noise. Usage: ``python docs/tracks/make.py [FOLDER]``, by default next to this file.

What is behind them is stated here and in no file: a fit can be compared with it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

import sandbox

#: A tennis ball thrown gently sideways. The film has 60 frames a second and begins before the throw; a click is off by
#: 4 mm, a third of its picture elements, in each direction.
THROW = {
    "launch.speed": 1.62, "launch.angle": 24.0, "floor.restitution": 0.728, "floor.friction": 0.6,
    "air.density": 1.204, "balls[0].y": 1.31,
}  # fmt: skip
FRAMES, BEGINS, CLICK = 60.0, 0.2837, 0.004  # 1/s, s before the throw, m

#: The same film, tracked by a program that lost the ball in some frames, jumped once and has decimal commas, with a
#: stick of 1.25 m that was taken for one of 1 m.
SCALE, LOST, WITHOUT_HEIGHT, JUMPS = 0.8, (8, 9, 27), (19,), (23,)

#: Drives on a range with a headwind in thin air; what the monitor prints of the flight is off by these, in m, m and s.
RANGE = {"air.density": 1.145, "air.wind": [-2.6, 0.0]}
PRINTED = {"carry": 1.5, "apex": 0.5, "flight_time": 0.05}
SHOTS = 30

#: Clubs of an amateur: ball speed in m/s, launch angle in deg and spin in rpm; what is put into a session ten times
#: each, with standard deviations of 2 % of the speed, 1.2 deg, 7 % of the spin, 1.5 deg of direction, and 4 deg of the
#: axis, and now and then a mishit, with three quarters of the speed.
BAG = {
    "Driver": (62.0, 13.5, 2900.0), "5 Wood": (57.0, 14.5, 4100.0), "4 Hybrid": (54.0, 15.5, 4600.0),
    "6 Iron": (50.0, 17.5, 5600.0), "7 Iron": (47.5, 19.5, 6300.0), "8 Iron": (45.0, 21.5, 7000.0),
    "9 Iron": (42.0, 24.5, 7700.0), "PW": (38.5, 28.0, 8300.0),
}  # fmt: skip
EACH, MISHITS = 10, 0.05

#: The monitor's model of the ball, which is not ours.
MONITOR = {"ball.drag.model": "usga", "ball.lift.model": "usga"}

#: A month later: as many shots with each of these, the speed higher by a share, and the axis tilted by more deg.
LATER = {"Driver": (1.03, 0.0), "7 Iron": (1.0, -4.0), "PW": (1.0, 0.0)}

#: Banks across a table with these cushions, by balls that slide and balls that roll in turn; readings are off by these,
#: in deg and m.
CUSHION = {"cushion.restitution": 0.80, "cushion.friction": 0.17}
READ = {"out_angle": 0.7, "landing": 0.015}


def throw() -> str:
    """A track as Tracker exports it as text: of each second frame, from the first in which the ball is free."""
    rng = np.random.default_rng(38)
    run = sandbox.simulate(sandbox.load("collisions/bouncing-ball", THROW))
    clock = np.arange(np.ceil(BEGINS * FRAMES), (BEGINS + 1.9) * FRAMES, 2.0) / FRAMES
    places = run.states("first", clock - BEGINS)[:, :2] + rng.normal(0.0, CLICK, (len(clock), 2))
    rows = [f"{t:.6E}\t{x:.6E}\t{y:.6E}\t" for t, (x, y) in zip(clock, places.tolist(), strict=True)]
    return "\n".join(["mass A\t\t\t", "t\tx\ty\t", *rows]) + "\n"


def dirty_throw() -> str:
    """A track as Tracker exports it where numbers have decimal commas, with what goes wrong in tracking."""
    lines = throw().splitlines()
    rows = [lines[1].split("\t")[:3]]
    for place, line in enumerate(lines[2:46]):
        t, x, y = (float(cell) for cell in line.split("\t")[:3])
        x, y = SCALE * x, SCALE * y + (0.5 if place in JUMPS else 0.0)
        cells = [f"{t:.3f}", f"{x:.3f}", "" if place in WITHOUT_HEIGHT else f"{y:.3f}"]
        rows.append([cells[0], "", ""] if place in LOST else cells)
    return "\n".join([lines[0].strip(), *(";".join(row).replace(".", ",") for row in rows)]) + "\n"


def drives() -> str:
    """A table with columns and a row of units as a launch monitor writes them."""
    rng = np.random.default_rng(39)
    launch = {
        "launch.speed": rng.normal(66.0, 3.0, SHOTS),  # m/s
        "launch.angle": rng.normal(13.0, 1.8, SHOTS),  # deg
        "launch.spin": rng.normal(2700.0, 350.0, SHOTS),  # rpm
    }
    found = sandbox.simulate_many(sandbox.load("golf", RANGE), launch, facts=tuple(PRINTED))
    flight = [found[fact] + rng.normal(0.0, sd, SHOTS) for fact, sd in PRINTED.items()]
    lines = ["Club,Ball Speed,Launch Angle,Spin Rate,Carry Flat - Length,Max Height - Height,Carry Flat - Time",
             ",[mph],[deg],[rpm],[yds],[ft],[s]"]  # fmt: skip
    for speed, angle, spin, carry, apex, time in zip(*launch.values(), *flight, strict=True):
        monitor = f"{speed / 0.44704:.1f},{angle:.1f},{spin:.0f}"
        lines.append(f"Driver,{monitor},{carry / 0.9144:.1f},{apex / 0.3048:.0f},{time:.2f}")
    return "\n".join(lines) + "\n"


def bag(seed: int, clubs: dict[str, tuple[float, float]]) -> str:
    """A session with several clubs, with the columns of a launch monitor that sees where balls go sideways."""
    rng = np.random.default_rng(seed)
    names = [name for name in BAG if name in clubs for _ in range(EACH)]
    speed, angle, spin = np.array([BAG[name] for name in names]).T
    faster, tilted = np.array([clubs[name] for name in names]).T
    count = len(names)
    speed = speed * faster * rng.normal(1.0, 0.02, count) * np.where(rng.random(count) < MISHITS, 0.75, 1.0)
    launch = {
        "launch.speed": speed,
        "launch.angle": angle + rng.normal(0.0, 1.2, count),
        "launch.spin": spin * rng.normal(1.0, 0.07, count),
        "launch.direction": rng.normal(0.0, 1.5, count),
        "launch.axis": tilted + rng.normal(2.0, 4.0, count),
    }
    golf = sandbox.load("golf", MONITOR)
    found = sandbox.simulate_many(golf, launch, facts=("carry", "total", "side", "apex", "landing_angle"))
    lines = ["Club,Ball Speed,Launch Angle,Launch Direction,Spin Rate,Spin Axis,Carry Flat - Length,Total,"
             "Carry Flat - Side,Max Height - Height,Carry Flat - Land. Angle",
             ",[mph],[deg],[deg],[rpm],[deg],[yds],[yds],[yds],[ft],[deg]"]  # fmt: skip
    for place, name in enumerate(names):
        v, a, w, d, t = (float(values[place]) for values in launch.values())
        carry, total, side, apex, down = (float(found[fact][place]) for fact in found.facts)
        flown = [carry + rng.normal(0.0, 1.2), total, side + rng.normal(0.0, 0.8)]
        yards = ",".join(f"{length / 0.9144:.1f}" for length in flown)
        monitor = f"{v / 0.44704:.1f},{a:.1f},{d:.1f},{w:.0f},{t:.1f}"
        lines.append(f"{name},{monitor},{yards},{apex / 0.3048:.0f},{down:.1f}")
    return "\n".join(lines) + "\n"


def banks() -> str:
    """A table of banks off one cushion, as one is written by hand."""
    rng = np.random.default_rng(53)
    angle, speed, follow = np.linspace(12.0, 38.0, 16).round(), rng.uniform(1.2, 2.4, 16).round(1), [0.0, 0.4] * 8
    shots = {"cue.angle": 90.0 - angle, "cue.speed": speed, "cue.follow": follow}
    found = sandbox.simulate_many(sandbox.load("billiards/one-cushion", CUSHION), shots, facts=tuple(READ))
    out, landing = (found[fact] + rng.normal(0.0, sd, 16) for fact, sd in READ.items())
    rows = zip(angle, speed, follow, out, landing, strict=True)
    lines = [f"{a:.0f},{v:.1f},{tip:.1f},{b:.1f},{100.0 * way:.0f}" for a, v, tip, b, way in rows]
    return "\n".join(["in_angle (deg),speed (m/s),follow,out_angle (deg),landing (cm)", *lines]) + "\n"


#: Each file and what is in it.
FILES = {
    "thrown-ball.txt": throw,
    "dirty-film.txt": dirty_throw,
    "drives.csv": drives,
    "bag.csv": lambda: bag(52, dict.fromkeys(BAG, (1.0, 0.0))),
    "bag-later.csv": lambda: bag(53, LATER),
    "banks.csv": banks,
}

if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    for name, made in FILES.items():
        (folder / name).write_text(made(), "utf-8")
