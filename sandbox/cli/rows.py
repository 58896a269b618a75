"""The tables of a run as CSV: its path, with more columns on request, and momentum and energy in each impact."""

from __future__ import annotations

import csv
from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from math import nan
from pathlib import Path
from typing import TYPE_CHECKING, Any

from sandbox.engine.model.ball import kinetic
from sandbox.engine.motion.forces_on_ball import by_cause
from sandbox.engine.paths.phase import Phase
from sandbox.errors import RequestError
from sandbox.files import atomic_write
from sandbox.sport.amounts import signed, significant
from sandbox.text import csv_text

if TYPE_CHECKING:
    from sandbox.engine.model.ball import Ball
    from sandbox.scene.scene_run import SceneRun

#: Columns of a trajectory, in s, m, m/s and rad/s; and the interval in s at which it is sampled.
_STATE, EVERY = ("x", "y", "vx", "vy", "spin"), 1 / 120

#: More columns of a trajectory, on request.
MORE = ("acceleration", "forces", "energy")

#: Most rows of a trajectory for each ball: more is taken as a mistake.
_MOST_ROWS = 10_000_000

#: Most rows of the table of impacts.
_MOST_IMPACTS = 12

#: The columns of the table of impacts, with their units in the names of those that people see.
_IMPACTS = ("t", "ball", "mass", "vx_before", "vy_before", "vx_after", "vy_after", "px_before", "py_before", "px_after",
           "py_after", "energy_before", "energy_after", "angular_before", "angular_after", "spin_before",
           "spin_after")  # fmt: skip
#: Those that are of one ball alone, and have no sum.
_OWN = ("vx_before", "vy_before", "vx_after", "vy_after", "spin_before", "spin_after")

#: A row of all balls of an impact together.
_TOTAL = "total"


def write_trajectory(
    run: SceneRun,
    path: Path,
    others: Mapping[str, SceneRun] = {},
    every: float = EVERY,
    more: Sequence[str] = (),
) -> None:
    """Write the path of every ball as CSV: ``t,ball,x,y,vx,vy,spin`` in s, m, m/s and rad/s, every so many s; with
    other runs by name the name of the run is a last column.

    ``more`` adds ``ax, ay`` in m/s^2 (``acceleration``), the components of each force in N (``forces``), and energy in
    J by motion, spin and height above y = 0 (``energy``). A cell is empty where something has no value.
    """
    runs = {run.scene.title: run, **others}
    for each in runs.values():
        if each.duration / every > _MOST_ROWS:
            raise RequestError(f"--every {every:g}: more than {_MOST_ROWS:,} rows for {each.duration:g} s")
    names = [name for each in runs.values() for name in _columns(each, more)]
    columns = list(dict.fromkeys(names))
    with atomic_write(path) as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow(("t", "ball", *_STATE, *columns, *(["run"] if others else [])))
        for title, each in runs.items():
            last = [csv_text(title)] if others else []
            for ball in each.setup.balls:
                name = csv_text(ball.name)
                for t, *state in each.trajectory(ball.name, every).tolist():
                    found = _more(each, ball, t, state, more) if more else {}
                    rows.writerow((t, name, *state, *(found.get(column, "") for column in columns), *last))


def _columns(run: SceneRun, more: Sequence[str]) -> Iterator[str]:
    """The names of the added columns, in order."""
    for ball in run.setup.balls:
        start = run.state(ball.name, 0.0)
        yield from _more(run, ball, 0.0, list(start[:5]), more)


def _more(run: SceneRun, ball: Ball, t: float, state: Sequence[float], more: Sequence[str]) -> dict[str, float]:
    """The added columns of a ball at time t in s."""
    found: dict[str, float] = {}
    arc = run.arcs[ball.name].at(t)
    mass = ball.mass * float(ball.mass_fraction(t))
    if "acceleration" in more:
        exact = arc.t1 > arc.t0 and arc.phase is not Phase.CLUSTER
        found |= zip(("ax", "ay"), arc.acceleration(t) if exact else (nan, nan), strict=True)
    if "forces" in more:
        angle = (run.angle(ball.name, t),) if ball.rotates else ()
        for cause, (fx, fy) in by_cause(ball.forces, t, (*state, *angle)):
            for axis, force in (("x", fx), ("y", fy)):
                key = f"{cause.replace(' ', '_')}_{axis}"
                found[key] = found.get(key, 0.0) + float(force)
    if "energy" in more:
        x, y, vx, vy, spin = state
        found["energy_speed"] = 0.5 * mass * (vx * vx + vy * vy)
        found["energy_spin"] = kinetic(ball, (x, y, 0.0, 0.0, spin), t)
        found["energy_height"] = mass * _gravity(ball) * y
    return {key: value for key, value in found.items() if value == value}


def _gravity(ball: Ball) -> float:
    """Return the gravity that acts on a ball, in m/s^2; 0 without its weight."""
    return float(sum(getattr(force, "gravity", 0.0) for force in ball.forces))


# ---------------------------------------------------------------------------------------------------------------------
# Impacts
# ---------------------------------------------------------------------------------------------------------------------


def impacts(run: SceneRun) -> Iterator[dict[str, Any]]:
    """A row for each ball of each impact, and one of all of them together: mass in kg, velocities in m/s, momenta in
    kg m/s, kinetic energies in J, including rotation, angular momenta about the scene's origin in kg m^2/s, ``m (x vy -
    y vx) + I w``, and spins w in rad/s, before and after."""
    balls = {ball.name: ball for ball in run.setup.balls}
    hits = [event for event in run.events if event.kind == "impact"]
    for t, events in groupby(hits, key=lambda event: event.t):
        names = dict.fromkeys(name for event in events for name in (event.ball, event.partner) if name in balls)
        rows = [_impact(run, balls[name], t) for name in names]
        yield from rows
        if len(rows) > 1:
            sums = {key: "" if key in _OWN else sum(row[key] for row in rows) for key in _IMPACTS[2:]}
            yield {"t": t, "ball": _TOTAL, **sums}


def _impact(run: SceneRun, ball: Ball, t: float) -> dict[str, Any]:
    mass = ball.mass * float(ball.mass_fraction(t))
    row: dict[str, Any] = {"t": t, "ball": ball.name, "mass": mass}
    for when, state in (("before", run.before(ball.name, t)), ("after", run.state(ball.name, t))):
        row |= {f"v{axis}_{when}": state[2 + place] for place, axis in enumerate("xy")}
        row |= {f"p{axis}_{when}": mass * state[2 + place] for place, axis in enumerate("xy")}
        row[f"energy_{when}"] = kinetic(ball, state, t)
        x, y, vx, vy, spin = state[:5]
        row |= {
            f"spin_{when}": spin,
            f"angular_{when}": mass * (x * vy - y * vx) + ball.inertia * mass / ball.mass * spin,
        }
    return {key: row[key] for key in _IMPACTS}


def write_impacts(run: SceneRun, path: Path, others: Mapping[str, SceneRun] = {}) -> None:
    """Write the table of impacts as CSV; with other runs by name the name of the run is a last column."""
    with atomic_write(path) as file:
        rows = csv.writer(file, lineterminator="\n")
        rows.writerow((*_IMPACTS, *(["run"] if others else [])))
        for title, each in {run.scene.title: run, **others}.items():
            for row in impacts(each):
                cells = {**row, "ball": csv_text(row["ball"])}
                rows.writerow((*(cells[key] for key in _IMPACTS), *([csv_text(title)] if others else [])))


def impact_lines(run: SceneRun) -> list[str]:
    """The table of impacts for people: of the first ones, if there are many."""
    from sandbox.lab.tables import table

    rows = list(impacts(run))
    if not rows:
        return ["  no impacts"]
    heads = ("", "mass", "v before", "v after", "p before", "p after", "E before", "E after")
    spins = ("", "L before", "L after", "spin before", "spin after")
    lines = [
        "  mass in kg, velocity v in m/s, momentum p in kg m/s (x, y), kinetic energy E in J,",
        "  angular momentum L about the origin in kg m^2/s, spin in rad/s, counter-clockwise",
    ]
    for t, group in groupby(rows[:_MOST_IMPACTS], key=lambda row: row["t"]):
        texts = [
            (row["ball"], significant(row["mass"], 3),
             *(_vector(row, f"{kind}{{}}_{when}") for kind in "vp" for when in ("before", "after")),
             f"{row['energy_before']:.3g}", f"{row['energy_after']:.3g}")
            for row in group
        ]  # fmt: skip
        turning = [
            (
                row["ball"],
                *(_number(row[f"{kind}_{when}"]) for kind in ("angular", "spin") for when in ("before", "after")),
            )
            for row in rows[:_MOST_IMPACTS]
            if row["t"] == t
        ]
        lines += [f"  at {t:.3f} s", *table(heads, texts, "lrrrrrrr"), *table(spins, turning, "lrrrr")]
    return [*lines, *([f"  ... {len(rows) - _MOST_IMPACTS} more rows"] if len(rows) > _MOST_IMPACTS else [])]


def _vector(row: Mapping[str, Any], key: str) -> str:
    both = [row[key.format(axis)] for axis in "xy"]
    return "" if "" in both else ", ".join(map(_number, both))


def _number(value: Any) -> str:
    """Three digits; nothing where there is none."""
    return "" if value == "" else signed(f"{0.0 if abs(value) < 1e-12 else value:.3g}")
