"""The same rifle bullet here and in py-ballisticcalc: its path to 1,000 yd, and the time of zeroing and of the path.

Run ``python benchmarks/bullet_ballisticcalc.py [--repeats N]``, after ``pip install "py-ballisticcalc[exts]"``, which
is no requirement of this project. Ten seconds.

Both get a .308 bullet of 168 gr with a G7 coefficient of 0.223 lb/in^2, 2,750 ft/s, sights 2 in above the barrel, the
standard atmosphere at sea level and a zero at 100 yd. py-ballisticcalc runs in Python (``rk4_engine``) and compiled
(``cythonized_rk4_engine``), with its own settings; it interpolates the same table of drag in another way.

``ours, many`` is a path of a thousand at once, up to a tenth of the angle apart, height and speed read of all: in the
compiled kernel if ``sandbox compile`` has been run.

Times are processor times, the least of interleaved repeats: of the search for the zero, and of the path alone.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from math import atan2, degrees
from typing import Any, NamedTuple

from measured import command_line, show, timed

import sandbox
from sandbox.engine import simulate
from sandbox.engine.kernel.library import compiled
from sandbox.engine.model.accuracy import resolve

#: Paths of one measurement, since one is short.
PATHS = 5

#: Paths that are computed at once, of shots that differ a little.
MANY = 1_000


class Way(NamedTuple):
    """One program: how it zeroes the rifle, and how it computes a path then, to (height in m, speed in m/s) there."""

    name: str
    zero: Callable[[], Any]
    path: Callable[[Any], tuple[float, float]]
    paths: int = 1  # that it computes at once


def ours(level: str) -> Way:
    """This program at a level of accuracy."""
    scene = sandbox.load("bullet", {"accuracy.level": level})

    def path(setup: Any) -> tuple[float, float]:
        run = simulate(setup, resolve(level))
        there = scene.result(run, ["height", "speed"])
        return there["height"], there["speed"]

    return Way(f"ours, {level}", scene.build, path)


def ours_of_many() -> Way:
    """This program, many paths at once; their times are a path's."""
    scene = sandbox.load("bullet", {"zero.distance": 0.0})
    how = "compiled" if compiled() else "numpy"

    def path(setup: Any) -> tuple[float, float]:
        vx, vy = setup.balls[0].velocity
        angles = [degrees(atan2(vy, vx)) * (1.0 + 0.1 * place / MANY) for place in range(MANY)]
        found = sandbox.simulate_many(scene, {"launch.angle": angles}, facts=("height", "speed"))
        return float(found["height"][0]), float(found["speed"][0])

    return Way(f"ours, many, {how}", sandbox.load("bullet").build, path, MANY)


def theirs(name: str, engine: str) -> Way:
    """py-ballisticcalc with one of its engines."""
    peer: Any = import_module("py_ballisticcalc")
    yard = peer.Distance.Yard
    shape = peer.Weight.Grain(168), peer.Distance.Inch(0.308), peer.Distance.Inch(1.2)
    ammo = peer.Ammo(peer.DragModel(0.223, peer.TableG7, *shape), peer.Velocity.FPS(2750))
    calculator = peer.Calculator(engine=engine)

    def zero() -> Any:
        rifle, air = peer.Weapon(sight_height=peer.Distance.Inch(2)), peer.Atmo.icao(peer.Distance.Foot(0))
        shot = peer.Shot(ammo=ammo, weapon=rifle, atmo=air)
        calculator.set_weapon_zero(shot, yard(100))
        return shot

    def path(shot: Any) -> tuple[float, float]:
        there = calculator.fire(shot, yard(1000), yard(100)).records[-1]
        return there.height >> peer.Distance.Meter, there.velocity >> peer.Velocity.MPS

    return Way(name, zero, path)


def measured(ways: list[Way], repeats: int) -> list[dict[str, Any]]:
    """A row for each way, measured in turns."""
    rows: list[dict[str, Any]] = [{"way": way.name, "zero_s": 1e9, "path_s": 1e9} for way in ways]
    for _ in range(repeats + 1):  # the first time compiles and imports
        for way, row in zip(ways, rows, strict=True):
            spent, aimed = timed(way.zero)
            row["zero_s"] = min(row["zero_s"], spent)
            spent, there = timed(lambda of=way, shot=aimed: [of.path(shot) for _ in range(PATHS)][-1])
            row["path_s"] = min(row["path_s"], spent / (PATHS * way.paths))
            row["height_m"], row["speed"] = there
    return rows


def main() -> None:
    arguments = command_line(__doc__, repeats=20)
    ways = [ours("fast"), ours("balanced"), ours("precise"), ours_of_many()]
    try:
        ways += [
            theirs("py-ballisticcalc, Python", "rk4_engine"),
            theirs("py-ballisticcalc, compiled", "cythonized_rk4_engine"),
        ]
    except ImportError:
        raise SystemExit('there is nothing to compare with: pip install "py-ballisticcalc[exts]"') from None
    columns = {"": "{way}", "zero": "{zero_s:.2f ms}", "path": "{path_s:.3f ms}"}
    columns |= {"at 1,000 yd": "{height_m:.3f} m", "speed there": "{speed:.2f} m/s"}
    show("a bullet over 1,000 yd, zeroed at 100 yd", measured(ways, arguments.repeats), columns)


if __name__ == "__main__":
    main()
