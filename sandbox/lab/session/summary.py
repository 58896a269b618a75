"""A session in numbers: groups, mishits set aside, where shots come down, the model, other air, another session."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import hypot
from pathlib import Path
from typing import Any, ClassVar

import numpy as np

from sandbox import units
from sandbox.display import Reported
from sandbox.errors import RequestError
from sandbox.lab import against
from sandbox.lab.formats import ColumnMap, recognized
from sandbox.lab.mapped import Choices, choices_of, mapped
from sandbox.lab.misfit import Compared, Misfit, misfit
from sandbox.lab.runs import Progress, no_progress
from sandbox.lab.session.shots import FEWEST, NARROW, SHARES, SIDE, Measure, Shots, read_session
from sandbox.lab.statistics import Ellipse, Numbers, Share, student

#: A shot is a mishit if its modified z-score is beyond this, ``0.6745 (x - median) / (c MAD)``: the recommendation of
#: Iglewicz and Hoaglin 1993, How to Detect and Handle Outliers. Median and MAD, the median of the deviations from it,
#: are those of its group, which the mishits themselves hardly move. With c, by which small groups have too small a MAD
#: (Croux and Rousseeuw 1992, Computational Statistics 1:411), 5 % of groups that scatter normally, whatever their size,
#: have a shot that is so low.
_MISHIT = 3.5
_SMALL = {6: 1.200, 7: 1.140, 8: 1.129, 9: 1.107}

#: Where half of a normal distribution, and the mean deviation of one, are in standard deviations.
_MEDIAN_DEVIATION, _MEAN_DEVIATION = 0.6745, 0.7979


@dataclass(frozen=True)
class _SetAside:
    """A shot that is counted as a mishit."""

    row: int  # of the file, the first is 1
    group: str
    why: str


@dataclass(frozen=True)
class Model:
    """The same launches by the model: against the monitor, and in other air."""

    results: Misfit | None  # None if the file lacks launch or results, which ``why`` says
    why: str = ""
    changes: Mapping[str, Any] = field(default_factory=dict)
    changed: Mapping[str, Compared] = field(default_factory=dict)  # by result: in this air, and in the changed one


@dataclass(frozen=True)
class Part:
    """The shots of one file, without its mishits."""

    shots: Shots
    set_aside: tuple[_SetAside, ...]
    groups: Mapping[str, np.ndarray]  # true for each shot that counts

    def summary(self, group: str, measure: Measure) -> Numbers | Share | None:
        """A column in a group; None where no shot has it."""
        values = measure.of(self.groups[group])
        if not len(values):
            return None
        return Share(int(values.sum()), len(values)) if measure.is_share else Numbers(values)

    def ellipses(self, group: str) -> tuple[Ellipse, ...]:
        """Those that hold the ``SHARES`` of the shots, in the unit of the table; none for fewer than three."""
        if self.shots.places is None:
            return ()
        across, along = self.shots.places
        both = np.column_stack([across.values, along.values])[self.groups[group]]
        both = both[np.isfinite(both).all(axis=1)]
        return tuple(Ellipse(both, share) for share in SHARES) if len(both) >= 3 else ()


@dataclass(frozen=True)
class Difference:
    """A mean or a share of the second session minus that of the first, with its 95 % interval."""

    value: float
    low: float | None
    high: float | None


@dataclass(frozen=True)
class Session(Reported):
    """One session, or two that are compared.

    >>> import pathlib, sandbox, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp(), "shots.csv")
    >>> _ = file.write_text("Club,Carry [yd]\\nDriver,251\\nDriver,246\\n7-iron,165\\n7-iron,162\\n")
    >>> type(sandbox.session(file, scene="golf", columns={"carry": "Carry [yd]"})).__name__
    'Session'
    """

    REPORTED_BY: ClassVar = "sandbox.lab.session.report"

    first: Part
    second: Part | None
    mishit: float | None  # the modified z-score beyond which shots are set aside; None if none are
    model: Model

    def changed_by_group(self) -> dict[str, dict[str, Compared]]:
        """The launches of each group in the air of the session and in the changed one, by result."""
        found: dict[str, dict[str, Compared]] = {}
        for name, inside in self.first.groups.items():
            rows = self.first.shots.rows[inside]
            by = {key: one.of(np.isin(one.rows, rows)) for key, one in self.model.changed.items()}
            found[name] = {key: one for key, one in by.items() if len(one.rows)}
        return {name: by for name, by in found.items() if by}

    def differences(self, group: str) -> dict[str, Difference]:
        """The second session minus the first, by column that both have; {} where one lacks the group."""
        if self.second is None or group not in self.first.groups or group not in self.second.groups:
            return {}
        found = {}
        for key, one in self.first.shots.measures.items():
            other = self.second.shots.measures.get(key)
            if other is not None:
                pair = self.first.summary(group, one), self.second.summary(group, _in_unit(other, one.unit))
                if (difference := _difference(*pair)) is not None:
                    found[key] = difference
        return found


def session(
    path: str | Path,
    second: str | Path | None = None,
    *,
    scene: str | None = None,
    by: str | None = None,
    columns: Mapping[str, str] | None = None,
    of: Sequence[str] = (),
    where: Mapping[str, str] | Sequence[str] = (),
    without: Sequence[str] = (),
    strict: bool = False,
    changes: Mapping[str, Any] | None = None,
    was: Mapping[str, Any] | None = None,
    mishit: float | None = _MISHIT,
) -> Session:
    """Summarize the shots of a file by the words of its column ``by``, without mishits: those with a modified z-score
    beyond ``mishit`` in speed, distance or side; None keeps all.

    ``columns`` says what they are, ``{"carry": "Distance [yd]"}``, where the file is of no known device, and ``of``
    names more columns of numbers. ``changes`` are for the same launches today, and ``was`` describes the air of the
    session itself. A ``second`` file is compared. Raises RequestError.

    >>> import pathlib, sandbox, tempfile
    >>> file = pathlib.Path(tempfile.mkdtemp(), "shots.csv")
    >>> _ = file.write_text("Club,Carry [yd]\\nDriver,251\\nDriver,246\\n7-iron,165\\n7-iron,162\\n")
    >>> [*sandbox.session(file, scene="golf", columns={"carry": "Carry [yd]"}).first.groups]
    ['Driver', '7-iron']
    """
    paths = Path(path), None if second is None else Path(second)
    return summarized(*paths, scene, by, of, choices_of(columns, where, without, strict), changes, was, mishit)


def summarized(
    path: Path,
    second: Path | None,
    scene: str | None,
    by: str | None,
    of: Sequence[str],
    choices: Choices,
    changes: Mapping[str, Any] | None = None,
    was: Mapping[str, Any] | None = None,
    mishit: float | None = _MISHIT,
    progress: Progress = no_progress,
) -> Session:
    """Like ``session``, with choices already parsed."""
    first = read_session(path, scene, by, of, choices)
    other = None if second is None else read_session(second, scene or first.scene.name, by, of, choices)
    if other is not None:  # "7 Iron" and "7-iron" are one club
        names = {_spelled(name): name for name in first.groups}
        other = replace(other, groups={names.get(_spelled(name), name): own for name, own in other.groups.items()})
    return Session(
        _without_mishits(first, mishit),
        None if other is None else _without_mishits(other, mishit),
        mishit,
        _modelled(first, mishit, changes or {}, was or {}, progress),
    )


def _spelled(name: str) -> str:
    """The name of a group without what programs write in different ways."""
    return re.sub(r"[\s_-]", "", name.casefold())


# --------------------------------------------------------------------------------------------------------------- groups


def _without_mishits(shots: Shots, mishit: float | None) -> Part:
    """The shots with the mishits of each group set aside."""
    found: dict[int, _SetAside] = {}
    for measure in _judged(shots) if mishit is not None else ():
        size = _in_unit(shots.distance, measure.unit) if measure.key == SIDE and shots.distance else measure
        for name, inside in shots.groups.items():
            some = size.of(inside)
            least = NARROW * float(np.median(some)) if len(some) else 0.0
            for place, score in _scores(measure.values, inside, least).items():
                off = abs(score) if measure.key == SIDE else -score
                if mishit is not None and off > mishit and place not in found:
                    value = f"{measure.label} {measure.values[place]:.4g} {measure.unit}".rstrip()
                    found[place] = _SetAside(int(shots.rows[place]), name, f"{value}: {score:+.1f}".replace("-", "−"))
    counts = ~np.isin(np.arange(len(shots.rows)), list(found))
    kept = {name: inside & counts for name, inside in shots.groups.items()}
    return Part(shots, tuple(found[place] for place in sorted(found)), kept)


def _judged(shots: Shots) -> list[Measure]:
    """The columns by which a shot is a mishit, where the file has its distance: too slow, too short, too far aside."""
    every = [shots.measures.get("launch.speed"), shots.distance, shots.measures.get(SIDE)]
    return [one for one in every if one is not None] if shots.distance is not None else []


def _scores(values: np.ndarray, inside: np.ndarray, least: float = 0.0) -> dict[int, float]:
    """The modified z-score by place of each shot of a group, {} for one that is too small or does not scatter. Where
    more than half of the shots are alike, the mean deviation stands for the median one (Iglewicz and Hoaglin). The
    standard deviation is ``least`` or more."""
    places = np.flatnonzero(inside & np.isfinite(values))
    if len(places) < FEWEST:
        return {}
    off = values[places] - np.median(values[places])
    median, mean = float(np.median(np.abs(off))), float(np.abs(off).mean())
    if mean == 0.0:
        return {}
    small = _SMALL.get(len(places), len(places) / (len(places) - 0.8))
    sd = small * median / _MEDIAN_DEVIATION if median > 0.0 else mean / _MEAN_DEVIATION
    scores = off / max(sd, least)
    return dict(zip(places.tolist(), scores.tolist(), strict=True))


# -------------------------------------------------------------------------------------------------------- two sessions


def _in_unit(measure: Measure, unit: str) -> Measure:
    """The column in another unit of its kind."""
    if measure.unit == unit:
        return measure
    values = [units.convert(value, measure.unit, unit) for value in measure.values.tolist()]
    return replace(measure, unit=unit, values=np.array(values))


def _difference(first: Numbers | Share | None, second: Numbers | Share | None) -> Difference | None:
    """The second minus the first: of means by Welch 1947 (Biometrika 34:28), of shares by Newcombe 1998 (Stat. Med.
    17:873, method 10). None where one has no shots; without an interval for means of a single shot."""
    if isinstance(first, Share) and isinstance(second, Share):
        value = second.value - first.value
        (a, b), (c, d) = first.interval, second.interval
        low = value - hypot(second.value - c, b - first.value)
        return Difference(value, low, value + hypot(d - second.value, first.value - a))
    if not isinstance(first, Numbers) or not isinstance(second, Numbers):
        return None
    value = second.mean - first.mean
    if min(first.count, second.count) < 2:
        return Difference(value, None, None)
    parts = [one.sd**2 / one.count for one in (first, second)]
    total = sum(parts)
    if total == 0.0:
        return Difference(value, value, value)
    freedom = total**2 / sum(p**2 / (one.count - 1) for p, one in zip(parts, (first, second), strict=True))
    half = student(freedom) * total**0.5
    return Difference(value, value - half, value + half)


# --------------------------------------------------------------------------------------------------------------- model


def _modelled(
    shots: Shots, mishit: float | None, changes: Mapping[str, Any], was: Mapping[str, Any], progress: Progress
) -> Model:
    """The launches by the model, grouped as the session is and without its mishits; in other air if there are
    ``changes``. A file without launches or results has none, unless that air was asked for: then RequestError."""
    try:
        found = mapped(shots.scene, shots.table, _compared_columns(shots), replace(shots.choices, strict=False))
        found.check_both()
        if missing := [key for key in ("launch.speed", "launch.angle") if key not in found.given]:
            raise RequestError(f"the file has no {missing[0]}")
        flown = against.Shots(shots.scene, shots.path, found)
        here = misfit(flown, was, progress=progress)
        there = misfit(flown, {**was, **changes}, progress=progress) if changes else None
    except RequestError as error:
        if changes or was:
            raise
        return Model(None, str(error).removeprefix(f"{shots.table.where}: "))
    kept = _without_mishits(shots, mishit)
    groups = {name: set(shots.rows[inside].tolist()) for name, inside in kept.groups.items()}
    rows = here.results[0].rows
    counts = np.isin(rows, list(set().union(*groups.values())))
    results = tuple(one.of(counts) for one in here.results)
    by = {name: np.isin(rows[counts], list(members)) for name, members in groups.items()}
    here = replace(
        here, results=results, by=shots.by, groups={name: inside for name, inside in by.items() if inside.any()}
    )
    changed = {}
    for one in there.results if there is not None else ():
        same = next(result for result in results if result.result == one.result)
        both, here_in, there_in = np.intersect1d(same.rows, one.rows, return_indices=True)
        changed[one.result] = Compared(one.result, one.unit, both, same.computed[here_in], one.computed[there_in])
    return Model(here, "", changes, changed)


def _compared_columns(shots: Shots) -> ColumnMap:
    """The columns of launches and of results that a fit would use: of a known device not those of its own, such as the
    roll, unless they are named."""
    known = recognized(shots.table, shots.scene)
    keys = set(shots.measures) if known is None else {source.key for source in known.sources}
    keys |= {entry.key for entry in shots.choices.entries}
    sources = (source for source in shots.column_map.sources if source.key in keys and source.key in shots.measures)
    return replace(shots.column_map, sources=tuple(sources))
