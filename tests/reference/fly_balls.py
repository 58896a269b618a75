"""How far tracked fly balls fell from where baseball has them, one by one: ``python tests/reference/fly_balls.py``.

fly_balls.csv has the 85 of 20 to 40 deg and 85 mph or more that were hit fair on 3 September 2020 in eight parks, and
off one pitcher in July 2019 (Statcast): exit speed, launch angle, spray angle (to the right positive; of where the ball
was met, not of its launch), the batter's side, projected distance. Spin is not tracked: it is the average of balls of
such a launch (Nathan, trajectory calculator), with backspin -763 + 120 per degree of launch + 21 per degree of spray to
the opposite field, sidespin 849 + 94 per degree of spray that way, all in rpm. Nothing is fitted. The air is the
scene's.

A table without spray gets the sidespin, printed here, with which these balls fly as far as they would on average if
their spray scattered by 25 deg, as it does (``usual`` in scenes/baseball/scene.py).

It prints the errors, what they are for who does not know the spray (the spin of a ball straight away) and without
sidespin, and the means of groups of some eight balls as rows of
scenes/baseball/published/fly.csv.
"""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from statistics import mean, stdev

from numpy.polynomial.hermite_e import hermegauss
from scipy.optimize import brentq

import sandbox

FOOT = 0.3048  # m

#: Standard deviation of the spray of these balls, in deg.
SCATTER = 25.0

#: Balls of less than this launch angle in deg are told apart from the others.
HIGH = 30


@dataclass(frozen=True)
class FlyBall:
    """A fly ball, and the spin that an average ball of its launch has."""

    speed: float  # mph
    angle: float  # deg
    opposite: float  # deg to the opposite field from straight away
    distance: float  # ft
    season: str

    @property
    def backspin(self) -> float:
        """In rpm."""
        return -763.0 + 120.0 * self.angle + 21.0 * self.opposite

    @property
    def sidespin(self) -> float:
        """In rpm, to either side."""
        return abs(849.0 + 94.0 * self.opposite)


def read() -> list[FlyBall]:
    with Path(__file__).with_suffix(".csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    return [
        FlyBall(
            float(row["exit_speed_mph"]),
            float(row["launch_angle_deg"]),
            float(row["spray_deg"]) * (1.0 if row["bats"] == "R" else -1.0),
            float(row["distance_ft"]),
            row["season"],
        )
        for row in rows
    ]


def errors(balls: Sequence[FlyBall], sidespin: float = 1.0) -> list[float]:
    """By how many ft the scene has them too far, with that share of their sidespin."""
    points = {
        "launch.speed": [f"{ball.speed} mph" for ball in balls],
        "launch.angle": [ball.angle for ball in balls],
        "launch.spin": [ball.backspin for ball in balls],
        "launch.sidespin": [sidespin * ball.sidespin for ball in balls],
    }
    found = sandbox.simulate_many(sandbox.load("baseball"), points, facts=("distance",)).facts["distance"]
    return [float(far) / FOOT - ball.distance for far, ball in zip(found, balls, strict=True)]


def straight_away(balls: Sequence[FlyBall]) -> list[FlyBall]:
    """The same balls with the spin of one that is hit straight away."""
    return [replace(ball, opposite=0.0) for ball in balls]


def usual_sidespin(balls: Sequence[FlyBall]) -> float:
    """The sidespin in rpm that takes as much of the distance as that of a normal spray does on average."""
    places, weights = hermegauss(9)

    def far(opposite: float) -> float:
        return mean(errors([replace(ball, opposite=opposite) for ball in balls]))

    usually = float(sum(weights * [far(SCATTER * place) for place in places]) / sum(weights))
    return 849.0 + 94.0 * brentq(lambda opposite: far(opposite) - usually, 0.0, 40.0, xtol=0.1)


def groups(balls: Sequence[FlyBall]) -> list[list[FlyBall]]:
    """Some eight balls each, of like launch angle and speed."""
    found = []
    for part in ([b for b in balls if b.angle < HIGH], [b for b in balls if b.angle >= HIGH]):
        ordered, number = sorted(part, key=lambda ball: ball.speed), round(len(part) / 8)
        found += [ordered[len(part) * k // number : len(part) * (k + 1) // number] for k in range(number)]
    return found


def described(name: str, off: Sequence[float]) -> str:
    return f"{name:24} {len(off):3} balls: {mean(off):+6.1f} ft, sd {stdev(off):.1f} ft"


def main() -> None:
    balls = read()
    print(f"usual sidespin: {usual_sidespin(balls):.0f} rpm")
    for season in ("2019", "2020"):
        print(described(season, errors([ball for ball in balls if ball.season == season])))
    ways = (("", balls, 1.0), (", spray unknown", straight_away(balls), 1.0), (", no sidespin", balls, 0.0))
    for words, thrown, share in ways:
        off = errors(thrown, share)
        print(described(f"all{words}", off))
        print(
            described(f"below {HIGH} deg{words}", [e for e, ball in zip(off, balls, strict=True) if ball.angle < HIGH])
        )
        print(described(f"above{words}", [e for e, ball in zip(off, balls, strict=True) if ball.angle >= HIGH]))
    print("balls,exit_speed_mph,launch_angle_deg,spin_rpm,sidespin_rpm,distance_ft")
    for group in groups(balls):
        columns = zip(*((b.speed, b.angle, b.backspin, b.sidespin, b.distance) for b in group), strict=True)
        speed, angle, spin, sidespin, distance = map(mean, columns)
        print(f"{len(group)},{speed:.1f},{angle:.1f},{spin:.0f},{sidespin:.0f},{distance:.0f}")


if __name__ == "__main__":
    main()
