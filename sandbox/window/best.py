"""The best list: the best scores at each task, kept in a plain file from one session to the next."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from datetime import date
from math import isfinite
from pathlib import Path
from typing import Any, NamedTuple

from sandbox.files import atomic_write, data_folder, reason

_FORMAT, _VERSION = "sandbox best list", 1
#: So many scores are kept of each task.
MOST = 5
#: How long another window is waited for, in s.
PATIENCE = 3.0


def usual_file() -> Path:
    """The file in the folder in which programs keep a user's data."""
    return data_folder() / "best.json"


class Best(NamedTuple):
    """One score: of how many stars, and when (ISO)."""

    score: float
    stars: int
    day: str
    flight: Mapping[str, Any] | None = None  # the changes of the task's scene that make its best shot


class BestList:
    """The best scores by task. A file that is damaged, or of another version, is set aside under another name; what is
    wrong is in ``problem``, a line for the player, until he was told. What cannot be written is written with the next
    score that can."""

    def __init__(self, file: Path | None = None) -> None:
        """Without a file it lasts as long as the window."""
        self.file = file
        self.problem = ""
        self._saved: dict[str, list[Best]] = {}  # in the file, as far as known
        self._unsaved: list[tuple[str, Best, bool]] = []  # of a task; whether lower is better
        self._read()
        self.tasks = dict(self._saved)

    def of(self, task: str) -> list[Best]:
        """The best scores at a task, the best first."""
        return self.tasks.get(task, [])

    def stars(self, task: str) -> int:
        """The most stars for a task."""
        return max((best.stars for best in self.of(task)), default=0)

    def add(
        self, task: str, score: float, stars: int, lower_is_better: bool, flight: Mapping[str, Any] | None = None
    ) -> int:
        """Add a score, and write the list; returns its place from 1, or 0 if it is not among the best."""
        self._unsaved.append((task, Best(score, stars, date.today().isoformat(), flight), lower_is_better))
        with self._alone():
            self._read()  # another window may have written meanwhile
            self.tasks = dict(self._saved)
            place = 0
            for each in self._unsaved:
                place = self._put(*each)
            self._write()
        return place

    def _put(self, task: str, new: Best, lower_is_better: bool) -> int:
        """Put a score where it belongs among those of its task; returns its place."""
        sign = -1.0 if lower_is_better else 1.0
        before = [best for best in self.of(task) if sign * best.score >= sign * new.score]
        self.tasks[task] = [*before, new, *self.of(task)[len(before) :]][:MOST]
        return len(before) + 1 if len(before) < MOST else 0

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Hold off other windows between reading and writing, as far as the system can."""
        from filelock import FileLock  # here, not above: it is needed only when a score is kept

        if self.file is None:
            yield
            return
        with ExitStack() as opened:
            with suppress(OSError):  # writing reports it
                self.file.parent.mkdir(parents=True, exist_ok=True)
                opened.enter_context(FileLock(self.file.with_suffix(".lock"), timeout=PATIENCE, poll_interval=0.005))
            yield

    def _read(self) -> None:
        """Read the file, if there is one."""
        if self.file is None:
            return
        try:
            text = self.file.read_text("utf-8")
        except FileNotFoundError:
            return
        except OSError as error:
            self._keep_out(f"{self.file}: cannot be read: {reason(error)}; scores last until the window is closed")
            return
        except UnicodeDecodeError:
            self._set_aside()
            return
        try:
            self._saved = _tasks_in(json.loads(text))
        except (ValueError, TypeError, KeyError, AttributeError, RecursionError, OverflowError):
            self._set_aside()

    def _set_aside(self) -> None:
        """Give a damaged file another name, that of no other file."""
        assert self.file is not None
        names = (self.file.with_name(f"{self.file.stem}.damaged-{n}{self.file.suffix}") for n in range(1, 1000))
        aside = next((name for name in names if not name.exists()), None)
        try:
            if aside is None:
                raise FileExistsError(17, "too many damaged files there")
            self.file.rename(aside)
        except OSError as error:
            self._keep_out(f"{self.file}: damaged, and cannot be set aside: {reason(error)}; it is left as it is")
        else:
            self.problem = f"the best list was damaged: it is kept as {aside}, and a new one begins"

    def _keep_out(self, problem: str) -> None:
        """Leave the file alone from here on."""
        self.file, self.problem = None, problem

    def _write(self) -> None:
        if self.file is None:
            return
        tasks = {name: [best._asdict() for best in scores] for name, scores in sorted(self.tasks.items())}
        try:
            self.file.parent.mkdir(parents=True, exist_ok=True)
            with atomic_write(self.file, kept=False) as file:
                json.dump({"format": _FORMAT, "version": _VERSION, "tasks": tasks}, file, indent=1)
        except OSError as error:
            self.problem = f"{self.file}: the best list cannot be written: {reason(error)}"
        else:
            self._saved, self._unsaved = self.tasks, []


def _tasks_in(kept: Any) -> dict[str, list[Best]]:
    """The scores in what was read. Raises ValueError, TypeError, KeyError or AttributeError if it is no best list."""
    if kept["format"] != _FORMAT or kept["version"] != _VERSION:
        raise ValueError("another format")
    found = {}
    for name, scores in kept["tasks"].items():
        found[name] = [
            Best(float(each["score"]), int(each["stars"]), str(each["day"]), _flight_in(each.get("flight")))
            for each in scores
        ]
        if not all(isfinite(best.score) and 0 <= best.stars <= 3 for best in found[name]):
            raise ValueError("a score that is none")
    return found


def _flight_in(kept: Any) -> Mapping[str, Any] | None:
    if kept is not None and not isinstance(kept, dict):
        raise ValueError("a shot that is none")
    return kept
