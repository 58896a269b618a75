"""Write the made-up measurements of docs/from-your-video.md and docs/from-your-launch-monitor.md: runs of the sandbox
itself, with noise. Usage: ``python docs/tracks/make.py [FOLDER]``, by default next to this file.

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

#: Drives on a range with a headwind in thin air; what the monitor prints of the flight is off by these, in m, m and s.
RANGE = {"air.density": 1.145, "air.wind": [-2.6, 0.0]}
PRINTED = {"carry": 1.5, "apex": 0.5, "flight_time": 0.05}
SHOTS = 30


def throw() -> str:
    """A track as Tracker exports it as text: of each second frame, from the first in which the ball is free."""
    rng = np.random.default_rng(38)
    run = sandbox.simulate(sandbox.load("collisions/bouncing-ball", THROW))
    clock = np.arange(np.ceil(BEGINS * FRAMES), (BEGINS + 1.9) * FRAMES, 2.0) / FRAMES
    places = run.states("first", clock - BEGINS)[:, :2] + rng.normal(0.0, CLICK, (len(clock), 2))
    rows = [f"{t:.6E}\t{x:.6E}\t{y:.6E}\t" for t, (x, y) in zip(clock, places.tolist(), strict=True)]
    return "\n".join(["mass A\t\t\t", "t\tx\ty\t", *rows]) + "\n"


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


#: Each file and what is in it.
FILES = {"thrown-ball.txt": throw, "drives.csv": drives}

if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent
    for name, made in FILES.items():
        (folder / name).write_text(made(), "utf-8")
