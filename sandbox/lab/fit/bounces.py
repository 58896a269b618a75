"""Bounces by their number: times at which they were heard, and heights to which the ball came after them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from sandbox import units
from sandbox.errors import RequestError
from sandbox.lab.fit.flown import flown
from sandbox.lab.fit.measured import Free, Rows
from sandbox.lab.selection import LeftOut, Selection
from sandbox.lab.table_file import Column, Table
from sandbox.physics.forces import Gravity
from sandbox.scene import Scene
from sandbox.scene.points import Points
from sandbox.scene.scene_run import SceneRun

#: Names of the columns: of the number of a bounce, its time, and the height after it; in lower case.
_NUMBERS, _TIMES = ("bounce", "bounces", "bounce number"), ("t", "time", "zeit", "temps")
_HEIGHTS = ("height", "h", "max height", "apex")

#: Times of impacts in one row, as phyphox exports those of its (in)elastic collision and of its stopwatch.
_EVENT = re.compile(r"bounce \d|start|stop( \d)?")

#: The columns by name, for --map.
BOUNCES = ("bounce", "t", "height")

#: A run lasts so many times as long as what was measured; a highest place is found in so many steps.
_LONGER, _STEPS = 2.0, 4


@dataclass(frozen=True)
class Bounces(Rows):
    """Times and heights of bounces, in the order of the file."""

    bounces: np.ndarray  # the number of each bounce, the first is 1; 0 is the start; shape (rows,)
    t: np.ndarray | None  # s, shape (rows,)
    height: np.ndarray | None  # m, the highest place after each bounce above where it bounces, shape (rows,)
    numbers: np.ndarray  # the row of each in its file, the first is 1
    longest: float  # s, a run
    free: tuple[Free, ...] = ()  # the clock, which does not start with the ball
    where: str = "track"
    left_out: tuple[LeftOut, ...] = ()
    unused: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    what = "bounce"
    runs = 1

    @property
    def names(self) -> tuple[str, ...]:
        """The quantities that were measured."""
        return tuple(name for name, column in (("t", self.t), ("height", self.height)) if column is not None)

    @property
    def units(self) -> tuple[str, ...]:
        """The units of these."""
        return tuple({"t": "s", "height": "m"}[name] for name in self.names)

    def check(self, scene: Scene) -> None:
        """Raise RequestError if the ball of the scene does not bounce."""
        run = next(iter(flown(scene, (), np.empty((1, 0)), self.longest)), None)
        if run is None or not _impacts(run):
            raise RequestError(f"{self.where}: the ball of {scene.title} does not bounce within {self.longest:.3g} s")

    def residuals(self, scene: Scene, keys: Sequence[str], values: np.ndarray, until: float) -> np.ndarray:
        """Measured minus computed times in s and heights in m, shape (candidates, bounces times quantities)."""
        found = np.full((len(values), self.count, len(self.names)), np.nan)
        for candidate, run in enumerate(flown(scene, keys, values, self.longest)):
            if run is not None:
                late = float(values[candidate, -1]) if self.free else 0.0
                times, heights = _of_run(run, int(self.bounces.max()))
                columns = [] if self.t is None else [self.t - late - times[self.bounces]]
                columns += [] if self.height is None else [self.height - heights[self.bounces]]
                found[candidate] = np.column_stack(columns)
        return found.reshape(len(values), -1)

    def points(self, scene: Scene, free: Sequence[float]) -> Points | None:
        """Return None, since there are no places."""
        return None

    def remarks(self, scene: Scene, free: Sequence[float]) -> tuple[str, ...]:
        """Sentences on how the table was read."""
        return self.notes


def _impacts(run: SceneRun) -> list[float]:
    """The times in s at which the first ball bounces."""
    ball = run.setup.balls[0].name
    return [event.t for event in run.events if event.kind == "impact" and event.ball == ball]


def _of_run(run: SceneRun, last: int) -> tuple[np.ndarray, np.ndarray]:
    """The times of the start and of all bounces up to the last one, and the highest places after them; bounces that the
    run does not have are at its end, with no height. Smooth in the parameters, as impacts are exact."""
    ball = run.setup.balls[0]
    impacts = [0.0, *_impacts(run)][: last + 1]
    times = np.array([*impacts, *[run.duration] * (last + 1 - len(impacts))])
    g = next((float(force.gravity) for force in ball.forces if isinstance(force, Gravity)), 9.81)
    low = run.state(ball.name, impacts[1]).y if len(impacts) > 1 else ball.position[1]
    t = np.array(impacts)
    ends = np.array([*_impacts(run)[: len(t)], *[run.duration] * len(t)])[: len(t)]
    t = np.nextafter(t, np.inf)
    for _ in range(_STEPS):  # the velocity upwards is lost at about g
        t = np.clip(t + run.states(ball.name, t)[:, 3] / g, np.nextafter(np.array(impacts), np.inf), ends)
    heights = np.zeros(last + 1)
    heights[: len(t)] = run.states(ball.name, t)[:, 1] - low
    return times, heights


def has_bounces(table: Table) -> bool:
    """True if the table has numbers of bounces, and their times or heights."""
    return _column(table, _NUMBERS) is not None and any(_column(table, names) for names in (_TIMES, _HEIGHTS))


def phyphox_events(table: Table) -> Table | None:
    """The table with columns bounce and t, if it has times of impacts as phyphox's acoustic stopwatch and (in)elastic
    collision export them: below one another, or next to one another in one row. Names: its own files of experiments."""
    listed = next((column for column in table.columns if column.name.lower() == "event time"), None)
    places = [one for one in table.columns if _EVENT.fullmatch(one.name.lower())]
    if listed is not None:
        cells, unit = listed.cells, listed.unit
    elif len(places) > 2 and len(table) == 1:
        cells, unit = tuple(one.cells[0] for one in places), places[0].unit
    else:
        return None
    t = Column("t", unit, cells)
    numbers = tuple(str(number) for number in range(1, len(cells) + 1))
    return replace(table, columns=(Column("bounce", "", numbers), t), broken={}, groups=())


def bounces_of(scene: Scene, table: Table, free: Sequence[str], strict: bool) -> Bounces:
    """The bounces of a table; the clock is free where it starts with a bounce. Raises RequestError."""
    numbers, t, height = (_column(table, names) for names in (_NUMBERS, _TIMES, _HEIGHTS))
    assert numbers is not None
    columns = [column for column in (numbers, t, height) if column is not None]
    selection = Selection(table, strict)
    selection.need_numbers(columns)
    selection.check_some()
    rows = selection.rows
    order = table.numbers(numbers, rows)
    for row, number in zip(rows, order.tolist(), strict=True):
        if number < 0.0 or number != int(number):
            raise RequestError(f"{table.where}: row {row + 1}, {numbers.name} = {number:g} is no number of a bounce")
    times, heights = _in(table, t, rows, "s"), _in(table, height, rows, "m")
    if any(name != "time" for name in free):
        raise RequestError(f"{table.where}: of bounces only the time can be free: --free time")
    notes, clock = [], bool(free)
    if times is not None and not clock and times[order == order.min()].min() == 0.0 and order.min() > 0:
        clock = True
        notes.append("the clock starts with a bounce, so when the ball was released is fitted, too (track.time)")
    bounces, longest = order.astype(int), _LONGER * _time_of(scene, int(order.max()) + 1)
    if times is not None:
        longest = max(longest, _LONGER * float(np.ptp(times)))
    clock_free: tuple[Free, ...] = ()
    if clock and times is not None:
        start = float(times[0]) - _time_of(scene, int(order[0]))
        clock_free = (Free("track.time", start - longest, float(times.min()), start, "s"),)
    used = {column.name.lower() for column in columns}
    where, left, unused = table.where, selection.left_out, table.others(used)
    of_rows = np.array(rows, dtype=int) + 1
    return Bounces(bounces, times, heights, of_rows, longest, clock_free, where, left, unused, tuple(notes))


def _time_of(scene: Scene, bounce: int) -> float:
    """The time in s of a bounce in the scene as it is, or about that."""
    until = 2.0
    while until < 60.0:
        run = next(iter(flown(scene, (), np.empty((1, 0)), until)), None)
        impacts = [0.0] if run is None else [0.0, *_impacts(run)]
        if len(impacts) > bounce or run is None or run.duration < until:
            return impacts[min(bounce, len(impacts) - 1)] or until
        until *= 2.0
    return until


def _column(table: Table, names: Sequence[str]) -> Column | None:
    return next((column for column in table.columns if column.name.lower() in names), None)


def _in(table: Table, column: Column | None, rows: Sequence[int], unit: str) -> np.ndarray | None:
    """The numbers of a column in this unit. Raises RequestError."""
    if column is None:
        return None
    try:
        factor = units.convert(1.0, column.unit or unit, unit)
    except ValueError as error:
        raise RequestError(f"{table.where}: {column.name} is in {column.unit}: {error}") from None
    return table.numbers(column, rows) * factor
