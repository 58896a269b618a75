"""Measure how honest the intervals of ``sandbox fit`` are where the model is off: sessions of a launch monitor.

Each session has shots with five clubs, whose measured launches have errors of their own and of the session's
calibration. They fly with a drag that is 3 % larger than the model's, and by another 1 % (standard deviation) from
session to session. Fitted is the density of the air, of each session by itself: how many of the 95 % intervals hold
the value that all sessions have in common, with and without the error of the drag, and how many would if errors were
taken as independent. ``python benchmarks/fit_sessions.py``: two minutes of processor time; ``--sessions N``, ``--shots
N``, ``--seed S``.
"""

from __future__ import annotations

from collections.abc import Mapping
from time import process_time
from typing import Any

import click
import numpy as np

import sandbox

#: Speed (m/s), angle (deg) and spin (rpm) of each club.
CLUBS = np.array([[75, 11, 2600], [62, 13, 4300], [55, 16, 5800], [50, 20, 7500], [42, 28, 9300]], dtype=float)
KEYS = ("launch.speed", "launch.angle", "launch.spin")

#: What a session differs by from others, a shot from others of its club, and a measured launch from the true one, of
#: the session and of the shot; shares.
SESSION, SHOT = np.array([0.03, 0.06, 0.06]), np.array([0.03, 0.10, 0.08])
CALIBRATION, READING = np.array([0.003, 0.008, 0.010]), np.array([0.004, 0.012, 0.030])

#: Standard deviations of the measured results, in their units.
RESULTS = {"carry": 1.5, "apex": 0.5, "flight_time": 0.04, "landing_angle": 0.6, "landing_speed": 0.35}

#: The drag coefficient of the model, the air in kg/m^3, and by what share the drag is off, and differs by session.
DRAG, AIR, OFF, BY_SESSION = 0.25, 1.2, 0.03, 0.01

FIXED = {"ball.drag.model": "constant", "ball.drag.coefficient": DRAG}


def session(rng: np.random.Generator, shots: int, off: float, by_session: float) -> Mapping[str, Any]:
    """The table of a session."""
    club = np.repeat(np.arange(len(CLUBS)), shots // len(CLUBS))
    size = (len(club), 3)
    true = CLUBS[club] * (1.0 + SESSION * rng.normal(size=3)) * (1.0 + SHOT * rng.normal(size=size))
    read = true * (1.0 + CALIBRATION * rng.normal(size=3)) * (1.0 + READING * rng.normal(size=size))
    drag = DRAG * (1.0 + off + by_session * rng.normal())
    scene = sandbox.load("golf", {**FIXED, "ball.drag.coefficient": drag, "air.density": AIR})
    flown = sandbox.simulate_many(scene, dict(zip(KEYS, true.T, strict=True)), facts=tuple(RESULTS))
    table = {key: values.tolist() for key, values in zip(KEYS, read.T, strict=True)}
    table |= {name: (flown[name] + sd * rng.normal(size=len(club))).tolist() for name, sd in RESULTS.items()}
    return {"Club": [f"club {number}" for number in club.tolist()], **table}


def measure(title: str, sessions: int, shots: int, seed: int, off: float, by_session: float) -> None:
    """Fit the sessions, and say how many intervals hold their common value."""
    columns = {key: key for key in (*KEYS, *RESULTS)}
    values, halves, normal, seconds = [], [], [], []
    for number in range(sessions):
        table = session(np.random.default_rng([seed, number]), shots, off, by_session)
        began = process_time()
        found = sandbox.fit(sandbox.load("golf", FIXED), table, {"air.density": (0.9, 1.5)}, columns=columns)
        seconds.append(process_time() - began)
        value = found.values["air.density"]
        values.append(value.value)
        halves.append(value.half or 0.0)
        normal.append(found.normal_half_widths["air.density"])
    apart = np.abs(np.array(values) - np.mean(values))
    click.echo(
        f"{title:34s} {(apart <= halves).sum():4d} of {sessions} {100 * (apart <= halves).mean():6.1f} %"
        f"   ± {np.mean(halves):.4f} kg/m^3   independent: {100 * (apart <= normal).mean():5.1f} %"
        f"   scatter {np.std(values, ddof=1):.4f}   {np.median(seconds):.1f} s"
    )


@click.command()
@click.option("--sessions", default=20, show_default=True)
@click.option("--shots", default=40, show_default=True, help="Of a session.")
@click.option("--seed", default=0, show_default=True)
def main(sessions: int, shots: int, seed: int) -> None:
    click.echo("95 % intervals of the air's density that hold the value all sessions have in common")
    measure("drag 3 % off, 1 % by session", sessions, shots, seed, OFF, BY_SESSION)
    measure("drag as the model has it", sessions, shots, seed, 0.0, 0.0)


if __name__ == "__main__":
    main()
