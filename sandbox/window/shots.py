"""The table of shots: what each came to, paths only of the last ones and those that are pinned, and statistics."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import cached_property
from math import sqrt
from typing import NamedTuple, TextIO

import numpy as np

from sandbox.window.shot import Shot

#: So many paths are kept, apart from those that are pinned; and so many shots without their paths.
PATHS, MOST = 20, 5000
#: Of a standard normal: 95 % lie within.
Z = 1.96


class Played:
    """A shot that was made, with its path for as long as that is kept."""

    def __init__(self, shot: Shot, title: str) -> None:
        """``title`` is that of its scene file."""
        self.shot: Shot | None = shot
        self.scene, self.changes, self.start, self.number = shot.scene, shot.changes, shot.start, shot.number
        self.title, self.verdict, self.aim, self.result = title, shot.verdict, shot.aim, shot.run.result
        self.scored = shot.scored if shot.scene.controls.scores else None  # None for a scene that does not score
        self.pinned = False

    @cached_property
    def numbers(self) -> dict[str, float]:
        """What can be compared: speed and angle, then the facts that are numbers, by their keys."""
        controls, found = self.scene.controls, {}
        for key, fact in self.scene.facts.items():
            value = self.result.get(key)
            again = fact.settled == "start" and value in self.aim  # speed or angle
            if fact.label and isinstance(value, int | float) and not isinstance(value, bool) and not again:
                found[key] = value
        return {controls.speed: self.aim[0], controls.angle: self.aim[1], **found}


class Share(NamedTuple):
    """How many of some shots score, and the interval in which their true share lies with 95 % (Wilson 1927)."""

    scored: int
    total: int

    @property
    def interval(self) -> tuple[float, float]:
        """Lower and upper end."""
        n, p = self.total, self.scored / self.total
        middle, half = p + Z**2 / (2 * n), Z * sqrt(p * (1 - p) / n + Z**2 / (4 * n**2))
        low, high = ((middle + sign * half) / (1 + Z**2 / n) for sign in (-1, 1))
        return max(0.0, low), min(1.0, high)


class Shots:
    """All shots so far, in order."""

    def __init__(self) -> None:
        self.rows: list[Played] = []
        self.count = 0

    def add(self, shot: Shot, title: str) -> Shot:
        """Number a shot and keep it."""
        self.count += 1
        shot = replace(shot, number=self.count)
        self.rows.append(Played(shot, title))
        del self.rows[:-MOST]
        self._drop_paths()
        return shot

    def _drop_paths(self) -> None:
        for row in [row for row in self.rows if row.shot is not None and not row.pinned][:-PATHS]:
            row.shot = None

    @property
    def paths(self) -> list[Shot]:
        """The shots whose paths are kept."""
        return [row.shot for row in self.rows if row.shot is not None]

    def pinned(self, shot: Shot) -> bool:
        """Whether the path of a shot stays."""
        return any(row.pinned for row in self.rows if row.number == shot.number)

    def pin(self, row: Played, computed: Callable[[Played], None]) -> None:
        """Keep the path of a shot, or keep it no longer; one that was dropped must be ``computed``."""
        row.pinned = not row.pinned
        if row.pinned and row.shot is None:
            computed(row)
        self._drop_paths()


def share_of(rows: Sequence[Played]) -> Share | None:
    """How many score; None if that cannot be said of them."""
    known = [row.scored for row in rows if row.scored is not None]
    return Share(sum(known), len(known)) if known else None


def values_of(rows: Sequence[Played], key: str) -> np.ndarray:
    """The numbers of one kind, of the shots that have it."""
    return np.array([row.numbers[key] for row in rows if key in row.numbers])


def write_csv(rows: Sequence[Played], file: TextIO) -> None:
    """A row for each shot: what was changed in its scene file, speed and angle, and its results."""
    changed = list(dict.fromkeys(key for row in rows for key in row.changes.values))
    numbers = list(dict.fromkeys(key for row in rows for key in row.numbers if key not in changed))
    writer = csv.writer(file, lineterminator="\n")
    writer.writerow(["shot", "scene", *changed, *numbers, "scored", "verdict"])
    for row in rows:
        values = [row.changes.values.get(key, "") for key in changed]
        values += [row.numbers.get(key, "") for key in numbers]
        scored = "" if row.scored is None else str(row.scored).lower()
        writer.writerow([row.number, row.title, *values, scored, row.verdict])
