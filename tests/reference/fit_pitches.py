"""Where the numbers of ``pitch_fit_drag``, and the active spin and tilt of the presets of baseball-pitch, come from.

``python tests/reference/fit_pitches.py STATCAST.csv`` takes a file as Statcast exports it, one pitch a row. The numbers
are from the 2,507 pitches of 3 September 2020: tests/pybaseball/data/small_request_raw.csv of jldbc/pybaseball. Every
second pitch of each pitcher and type is fitted, the others are held out. It prints the drag polar; for each type active
share and tilt, and how far off the held-out pitches are at the plate, one by one; the same with the axis of each
pitcher's own other pitches; and the mean held-out pitches as rows of scenes/baseball-pitch/published/pitch.csv.

Of each pitch the file has a fit of constant acceleration to its track. Its air is taken as 70 F at sea level.
"""

from __future__ import annotations

import csv
import sys
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from math import atan2, cos, degrees, hypot, pi, radians, sin, sqrt
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import sandbox
from sandbox.physics.coefficients import nathan_lift, pitch_fit_drag

FOOT, MPH, INCH, GRAVITY = 0.3048, 0.44704, 0.0254, 32.174  # m, m/s, m, ft/s^2
PLATE, TRACKED_FROM, RUBBER = 17.0 / 12.0, 50.0, 60.5  # ft, from the rear point of the plate
RADIUS, MASS, DENSITY = 0.03688842, 0.14529130601563, 1.1930  # m, kg, kg/m^3
PER_FOOT = 0.5 * DENSITY * pi * RADIUS**2 / MASS * FOOT

TYPES = {
    "FF": "four-seam",
    "SI": "sinker",
    "CH": "change-up",
    "CU": "curve",
    "SL": "slider",
    "FC": "cutter",
    "FS": "splitter",
}


#: A type with fewer pitches in one of the halves is left out.
FEWEST = 20

#: Active share as cameras see it, mean of the pitchers of 2025 (Statcast; second-hand).
SEEN = {"FF": 0.891, "SI": 0.855, "CH": 0.885, "CU": 0.708, "SL": 0.320, "FC": 0.465, "FS": 0.834}


@dataclass(frozen=True)
class Pitch:
    """A tracked pitch: its launch, its way to the plate, and the mean coefficients of its flight."""

    kind: str
    pitcher: str
    speed: float  # m/s, as it leaves the hand, seen from the side
    angle: float  # deg
    height: float  # m, of the hand
    spin: float  # rpm
    distance: float  # m, from the hand to the front of the plate
    fall: float  # m, height at the plate above that of the hand
    speed_there: float  # m/s
    drag: float
    lift: float  # upward; towards the pitcher's arm in ``aside``
    aside: float
    spin_ratio: float


def read(path: str) -> list[Pitch]:
    """The pitches of a Statcast file, in the order in which they were thrown."""
    with Path(path).open(newline="", encoding="utf-8-sig") as file:
        rows = [row for row in csv.DictReader(file) if row["release_spin_rate"] not in ("", "null")]
    rows.sort(key=lambda row: (row["game_pk"], int(row["at_bat_number"]), int(row["pitch_number"])))
    return [pitch(row) for row in rows]


def pitch(row: dict[str, str]) -> Pitch:
    """One row, by the equations of constant acceleration (Kagan & Nathan 2014)."""
    start = np.array([float(row[key]) for key in ("vx0", "vy0", "vz0")])
    rate = np.array([float(row[key]) for key in ("ax", "ay", "az")])
    hand = RUBBER - float(row["release_extension"])
    left, there = (
        (-start[1] - sqrt(start[1] ** 2 - 2.0 * rate[1] * (TRACKED_FROM - y))) / rate[1] for y in (hand, PLATE)
    )
    flight, first, last = there - left, start + rate * left, start + rate * there
    mean = 0.5 * (first + last)
    speed, air = float(np.linalg.norm(mean)), rate + np.array([0.0, 0.0, GRAVITY])
    along = -float(air @ mean) / speed
    across = air + along * mean / speed
    scale = float(np.linalg.norm(across)) / hypot(across[0], across[2]) / (PER_FOOT * speed**2)
    arm = 1.0 if row["p_throws"] == "L" else -1.0
    spin = float(row["release_spin_rate"])
    return Pitch(
        row["pitch_type"],
        row["pitcher"],
        hypot(first[1], first[2]) * FOOT,
        degrees(atan2(first[2], -first[1])),
        float(row["release_pos_z"]) * FOOT,
        spin,
        (hand - PLATE) * FOOT,
        (0.5 * (first[2] + last[2]) * flight) * FOOT,
        hypot(last[1], last[2]) * FOOT,
        along / (PER_FOOT * speed**2),
        across[2] * scale,
        across[0] * scale * arm,
        RADIUS * spin * pi / 30.0 / (speed * FOOT),
    )


def halves(pitches: Sequence[Pitch]) -> tuple[list[Pitch], list[Pitch]]:
    """Every second one of each pitcher and type, and the others."""
    own = defaultdict(list)
    for each in pitches:
        own[each.pitcher, each.kind].append(each)
    numbered = zip(count(), (each for key in sorted(own) for each in own[key]))
    parts: tuple[list[Pitch], list[Pitch]] = [], []
    for number, each in numbered:
        parts[number % 2].append(each)
    return parts


def mean(pitches: Sequence[Pitch], what: str) -> float:
    return float(np.mean([getattr(each, what) for each in pitches]))


def polar(pitches: Sequence[Pitch]) -> tuple[float, float, float]:
    """a and b of ``Cd = a + b Cl^2``, and the scatter of single pitches about it."""
    lift = np.array([hypot(each.lift, each.aside) for each in pitches])
    drag = np.array([each.drag for each in pitches])
    (b, a) = np.polyfit(lift**2, drag, 1)
    return float(a), float(b), float(np.std(drag - a - b * lift**2))


def inverse(lift: float) -> float:
    """The spin ratio with that coefficient by nathan_lift."""
    return float(brentq(lambda ratio: nathan_lift(0.0, ratio) - lift, 0.0, 5.0))


def axis(upward: float, aside: float, spin_ratio: float) -> tuple[float, float]:
    """The active share and the tilt in deg that give these lift coefficients; beyond 90 deg the spin is topspin."""
    return inverse(hypot(upward, aside)) / spin_ratio, degrees(atan2(aside, upward))


def fitted_axis(pitches: Sequence[Pitch]) -> tuple[float, float]:
    """The axis with which these pitches are at the plate, on average, as high as they were; aside, as they moved."""
    aside, ratio = mean(pitches, "aside"), mean(pitches, "spin_ratio")

    def off(upward: float) -> float:
        return float(np.mean(errors(pitches, *axis(upward, aside, ratio))[0]))

    return axis(brentq(off, -0.35, 0.35, xtol=1e-4), aside, ratio)


def errors(pitches: Sequence[Pitch], active: float, *tilts: float) -> tuple[np.ndarray, np.ndarray]:
    """By how much baseball-pitch has them too high at the plate, in m, and too fast there, in m/s; with the same
    tilt for all, or one for each."""
    each_tilt = tilts * len(pitches) if len(tilts) == 1 else tilts
    points = {
        "launch.speed": [each.speed for each in pitches],
        "launch.angle": [each.angle for each in pitches],
        "launch.spin": [
            each.spin if abs(tilt) <= 90.0 else -each.spin for each, tilt in zip(pitches, each_tilt, strict=True)
        ],
        "launch.tilt": [level(tilt) for tilt in each_tilt],
        "release.height": [5.0] * len(pitches),  # none of them reaches the ground
        "plate.distance": [each.distance for each in pitches],
    }
    scene = sandbox.load("baseball-pitch", {"launch.active": min(active, 1.0)})
    found = sandbox.simulate_many(scene, points, facts=("plate_height", "plate_speed")).facts
    fall, speed = (np.array([getattr(each, what) for each in pitches]) for what in ("fall", "speed_there"))
    return np.array(found["plate_height"]) - 5.0 - fall, np.array(found["plate_speed"]) - speed


def level(tilt: float) -> float:
    """The lean of the axis from the level in deg, for backspin or topspin."""
    return degrees(atan2(sin(radians(tilt)), abs(cos(radians(tilt)))))


def report(kind: str, fit: Sequence[Pitch], held: Sequence[Pitch]) -> tuple[float, float]:
    """Print and return the axis of a type."""
    active, tilt = fitted_axis(fit)
    off, fast = errors(held, active, tilt)
    own = []
    for pitcher in sorted({each.pitcher for each in held}):
        theirs, his = ([each for each in part if each.pitcher == pitcher] for part in (fit, held))
        if len(theirs) >= 3:
            turned = axis(mean(theirs, "lift"), mean(theirs, "aside"), mean(theirs, "spin_ratio"))
            own.extend(errors(his, *turned)[0])
    seen = errors(held, SEEN[kind], *(degrees(atan2(each.aside, each.lift)) for each in held))[0]
    print(
        f"{TYPES[kind]:10} {len(fit):4} fitted: active {active:.3f}, tilt {tilt:6.1f} deg; {len(held):4} held out: "
        f"{np.mean(off) / INCH:+.2f} +- {np.std(off) / sqrt(len(off)) / INCH:.2f} in, sd {np.std(off) / INCH:.1f}, "
        f"{np.mean(fast) / MPH:+.2f} mph; with each pitcher's own axis {np.mean(own) / INCH:+.2f} in, "
        f"sd {np.std(own) / INCH:.1f} ({len(own)}); with the active spin that cameras see "
        f"{np.mean(seen) / INCH:+.2f} in"
    )
    return active, tilt


def row(name: str, pitches: Sequence[Pitch], active: float, tilt: float) -> str:
    """The mean of these pitches as a row of the table."""
    numbers = [mean(pitches, what) for what in ("speed", "angle", "spin", "height", "distance", "fall", "speed_there")]
    speed, angle, spin, height, distance, fall, there = numbers
    turn = spin if abs(tilt) <= 90.0 else -spin
    return (
        f"{name},{len(pitches)},{speed / MPH:.2f},{angle:.3f},{turn:.0f},{active:.3f},{level(tilt):.1f},"
        f"{height / FOOT:.3f},{distance / FOOT:.3f},{(height + fall) / FOOT * 12.0:.2f},{there / MPH:.2f}"
    )


def main(path: str) -> None:
    fit, held = halves(read(path))
    print("drag: Cd = {:.4f} + {:.3f} Cl^2, single pitches within {:.3f} of it".format(*polar(fit)))
    more = [each.drag - pitch_fit_drag(0.0, inverse(hypot(each.lift, each.aside))) for each in [*fit, *held]]
    print(f"drag of all over pitch_fit_drag: {np.mean(more):+.3f}")
    rows = []
    for kind, name in TYPES.items():
        theirs, others = ([each for each in part if each.kind == kind] for part in (fit, held))
        if min(len(theirs), len(others)) < FEWEST:
            continue
        turned = report(kind, theirs, others)
        rows.append(row(name, others, *turned))
        if kind == "FF":
            for what, words in (("speed", ("slow", "fast")), ("spin", ("little spin", "much spin"))):
                ordered = sorted(others, key=lambda each: float(getattr(each, what)))
                quarter = len(others) // 4
                for word, part in zip(words, (ordered[:quarter], ordered[-quarter:]), strict=True):
                    rows.append(row(f"{name}; {word}", part, *turned))
    print("\n".join(rows))


if __name__ == "__main__":
    main(sys.argv[1])
