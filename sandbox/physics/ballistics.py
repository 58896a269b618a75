"""Bullets: drag that depends on the Mach number, by the standard shapes G1, G7 and the sphere."""

from __future__ import annotations

import csv
from bisect import bisect_right
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cache
from itertools import pairwise
from math import pi
from pathlib import Path
from typing import Any, ClassVar

from sandbox.physics.elementwise import clip, sqrt
from sandbox.physics.forces import IN_WIND, Parts, Wind, drag_rate, in_wind

#: kg/m^2 of a ballistic coefficient of 1 lb/in^2.
POUND_PER_INCH = 703.0696

#: The standard shapes.
SHAPES = "G1", "G7", "GS"


@cache
def drag_table(shape: str) -> tuple[list[float], list[tuple[float, float, float, float]]]:
    """Mach numbers of a standard shape's table, drag_by_mach.csv, and from each to the next a cubic in the distance.

    The curve has no overshoot and no kink: its slope at a point is the weighted harmonic mean of those to either side,
    and 0 where they differ in sign. Source: Fritsch & Butland 1984, SIAM J. Sci. Stat. Comput. 5:300.
    """
    with (Path(__file__).parent / "drag_by_mach.csv").open(newline="", encoding="utf-8") as file:
        rows = [(float(row["mach"]), float(row["cd"])) for row in csv.DictReader(file) if row["shape"] == shape]
    machs, drags = map(list, zip(*rows, strict=True))
    wide = [after - before for before, after in pairwise(machs)]
    steep = [(after - before) / width for (before, after), width in zip(pairwise(drags), wide, strict=True)]
    slopes = [steep[0]]
    for (w, v), (p, q) in zip(pairwise(wide), pairwise(steep), strict=True):
        slopes.append(3.0 * (w + v) / ((2.0 * v + w) / p + (v + 2.0 * w) / q) if p * q > 0.0 else 0.0)
    slopes.append(steep[-1])
    cubics = []
    for drag, width, rise, (s, e) in zip(drags, wide, steep, pairwise(slopes), strict=False):
        cubics.append((drag, s, (3.0 * rise - 2.0 * s - e) / width, (s + e - 2.0 * rise) / width**2))
    return [*machs], cubics


def drag_by_mach(shape: str, mach: Any) -> Any:
    """Drag coefficient of a standard shape: a smooth curve through the points of its table, and flat beyond its end.

    G1 is a bullet with a flat base, G7 one with a long ogive and a boat tail, GS a smooth sphere of 9/16 in. Measured
    up to Mach 5, the sphere up to 4. Source: the public tables of the Ballistic Research Laboratory, as programs of
    exterior ballistics have them (py-ballisticcalc).
    """
    machs, cubics = drag_table(shape)
    if isinstance(mach, float):
        return of_table(machs, cubics, mach)
    import numpy as np

    mach = clip(mach, 0.0, machs[-1])
    i = np.minimum(np.searchsorted(machs, mach, side="right"), len(cubics)) - 1
    return of_cubic(np.array(cubics)[i].T, mach - np.array(machs)[i])


def of_table(machs: Sequence[float], cubics: Sequence[Sequence[float]], mach: float) -> float:
    """Drag coefficient at one Mach number, by what ``drag_table`` returns."""
    mach = clip(mach, 0.0, machs[-1])
    i = min(place_in(machs, mach), len(cubics)) - 1
    return float(of_cubic(cubics[i], mach - machs[i]))


def place_in(machs: Sequence[float], mach: float) -> int:
    """The number of Mach numbers up to one."""
    return bisect_right(machs, mach)


def of_cubic(cubic: Any, x: Any) -> Any:
    """Value of a cubic at x, from its lowest coefficient on."""
    a, b, c, d = cubic
    return a + x * (b + x * (c + x * d))


def speed_of_sound(temperature: float) -> float:
    """In m/s, in dry air at a temperature in K: ``(1.4 * 287.053 T)^(1/2)``. U.S. Standard Atmosphere 1976."""
    return (1.4 * 287.053 * temperature) ** 0.5


@dataclass(frozen=True)
class BulletDrag:
    """Drag of a bullet that flies nose first, ``F = -m (pi / 8) rho Cd(M) |u| u / BC`` with ``u = v - wind``.

    ``coefficient`` BC in lb/in^2 compares it with the standard shape, whose Cd depends on the Mach number M. Valid
    up to the table's end; the yaw of a bullet that loses its stability near Mach 1 is left out.
    Source: McCoy 1999, Modern Exterior Ballistics, chapter 6; second-hand.
    """

    timed: ClassVar = ("wind",)
    mass: float  # kg
    shape: str
    coefficient: float  # lb/in^2
    density: float  # kg/m^3, of the air
    sound: float  # m/s, speed of sound
    wind: Wind | None = None
    PARTS: ClassVar[Parts] = IN_WIND
    _k: float = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_k", self.mass * pi / 8.0 * self.density / (self.coefficient * POUND_PER_INCH))

    @property
    def row(self) -> tuple[float, float, int]:
        """The rate in kg/m, the speed of sound in m/s, and the place of the standard shape."""
        return self._k, self.sound, SHAPES.index(self.shape)

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        ux, uy = velocity if self.wind is None else in_wind(self.wind, t, position, velocity)
        speed = sqrt(ux * ux + uy * uy)
        k = drag_rate(self._k, drag_by_mach(self.shape, speed / self.sound), speed)
        return k * ux, k * uy
