"""Rows written to a CSV file as they are computed: the file holds whole rows, and an interrupted one can be resumed."""

from __future__ import annotations

import csv
import filecmp
import io
import json
import math
import os
import re
import shutil
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, Protocol, TextIO

from sandbox.errors import RequestError, RunError
from sandbox.files import reason
from sandbox.text import csv_text

#: The last column of a sweep, and all columns of a path that ``run --trajectory`` writes.
_LAST, _TRAJECTORY = "error", b"t,ball,x,y,vx,vy,spin"


class Points(Protocol):
    """The points of a sweep, in order: a Plan."""

    @property
    def fingerprint(self) -> str: ...
    @property
    def keys(self) -> list[str]: ...
    @property
    def size(self) -> int: ...
    def points(self, start: int, stop: int) -> Iterator[tuple[Any, ...]]: ...


class RowFile:
    """A CSV file written in whole lines; use it in a ``with`` block, and call ``finish`` after the last row.

    Until then a small marker file, with ``.resume`` added to the name, identifies the sweep. It is locked while this
    process lives, so that no other process writes to the same file. If the file is opened again for the same points,
    rows are added to the existing ones (``done``, their number); unfinished rows of another sweep raise RequestError.
    Existing rows are kept only if they are byte for byte what was written for these points: an incomplete last line is
    dropped, and rows from the first damaged one (``damaged``, its number) are computed again.

    The old content of a finished or damaged file is kept under its name with ``~`` added (``before``) until the same
    rows are in the new file. Devices such as /dev/stdout are simply written to.
    """

    def __init__(self, path: Path, plan: Points) -> None:
        self.path = path
        self.done = 0
        self.damaged: int | None = None
        self._plan = plan
        self._is_device = path.exists() and not path.is_file()
        self._lock: TextIO | None = None
        self._columns: list[str] = []
        self._target = path.resolve() if path.is_symlink() else path  # the target of a link, not the link
        self._mark = self._target.with_name(f"{self._target.name}.resume")
        self.before = self._target.with_name(f"{self._target.name}~")

    def __enter__(self) -> RowFile:
        with _writing(self.path):
            if self._is_device:
                self._file = self.path.open("w", encoding="utf-8", newline="")
                return self
            self._lock = self._locked()
            try:
                self._begin(self._lock)
            except BaseException:
                self._lock.close()
                raise
        return self

    def __exit__(self, *failure: object) -> None:
        with suppress(OSError):  # a full disk, which append has already reported
            self._file.close()
        if self._lock is not None:
            self._lock.close()

    def finish(self) -> None:
        """Mark the file as complete."""
        if not self._is_device:
            self._mark.unlink(missing_ok=True)
            if self.before.is_file() and filecmp.cmp(self.path, self.before, shallow=False):
                self.before.unlink()

    def append(self, records: Sequence[Mapping[str, Any]]) -> None:
        """Add rows; they have been passed to the operating system on return. New columns are empty in earlier rows.

        Raises RunError if writing fails, for example on a full disk; earlier rows are kept.
        """
        named = [{csv_text(name): value for name, value in record.items()} for record in records]
        columns = merged_columns(self._columns, named)
        with _writing(self.path):
            if columns != self._columns:
                self._widen(columns)
            for record in named:
                self._file.write(_line([cell(record.get(name)) for name in columns]))
                self.done += 1
            self._file.flush()

    def _widen(self, columns: list[str]) -> None:
        if self.done and self._is_device:
            raise RunError(f"{self.path}: later rows have more columns than the first ones; write to a file instead")
        if not self.done:
            self._columns = columns
            self._file.write(_line(columns))
            return
        self._file.close()
        wider = self._target.with_name(f".{self._target.name}.{os.getpid()}.part")
        try:
            with wider.open("w", encoding="utf-8", newline="") as file:
                file.write(_line(columns))
                for row in rows(self.path):
                    file.write(_line([row.get(name, "") for name in columns]))
            wider.replace(self._target)
        finally:
            wider.unlink(missing_ok=True)
            self._file = self.path.open("a", encoding="utf-8", newline="")
        self._columns = columns

    # Before the first row

    def _locked(self) -> TextIO:
        """The marker file, locked by this process. Raises RequestError if another process holds it."""
        while True:
            mark = self._mark.open("a+", encoding="utf-8", errors="replace")
            try:
                if not _lock(mark):
                    raise RequestError(f"--out {self.path}: another sweep is writing to this file; choose another name")
                if self._mark.exists() and os.path.samestat(os.fstat(mark.fileno()), self._mark.stat()):
                    return mark
            except BaseException:
                mark.close()
                raise
            mark.close()  # the other process has just finished and removed its marker

    def _begin(self, mark: TextIO) -> None:
        """Open the file after the rows that are kept."""
        mark.seek(0)
        known = mark.read(100).strip()
        if known and not re.fullmatch("[0-9a-f]{64}", known):
            raise RequestError(f"--out {self.path}: {self._mark.name} is a file of yours; choose another name")
        there = self._target.is_file() and self._target.stat().st_size > 0
        if known and there:
            if known != self._plan.fingerprint:
                raise RequestError(
                    f"--out {self.path}: contains rows of another interrupted sweep, or of this one with "
                    f"another scene or program version; choose another name, or remove this file and {self._mark.name}"
                )
            if self._keep_rows():
                self._file = self.path.open("a", encoding="utf-8", newline="")
                return
        elif there:
            try:
                self._check_before()
            except RequestError:
                self._mark.unlink()
                raise
            self._target.replace(self.before)
        mark.truncate(0)
        mark.write(self._plan.fingerprint + "\n")
        mark.flush()
        self._file = self.path.open("w", encoding="utf-8", newline="")

    def _keep_rows(self) -> bool:
        """Count the intact rows and cut off the rest. Returns whether there are any."""
        with self.path.open("rb+") as file:
            header = file.readline()
            if not header.endswith(b"\n"):
                return False
            columns = _cells(header)
            keys = [csv_text(key) for key in self._plan.keys]
            if not columns or columns[: len(keys)] != keys or columns[-1] != _LAST or len({*columns}) < len(columns):
                raise RequestError(
                    f"--out {self.path}: its first line is not what this sweep wrote; repair it, or remove the "
                    f"file and {self._mark.name} to start again"
                )
            end, done = file.tell(), 0
            for point in self._plan.points(0, self._plan.size):
                line = file.readline()
                cells = _cells(line)
                if cells is None or len(cells) != len(columns) or cells[: len(keys)] != [cell(part) for part in point]:
                    break
                end, done = file.tell(), done + 1
            file.seek(end)
            rest = file.readline()
            if rest.endswith(b"\n") or b"\0" in rest:  # not just the line that was being written
                self._check_before()
                shutil.copyfile(self.path, self.before)
                self.damaged = done + 1
            file.truncate(end)
        self._columns, self.done = columns, done
        return True

    def _check_before(self) -> None:
        """Raise RequestError if a file of the user's is in the way of the backup."""
        if self.before.exists() and not is_of_a_sweep(self.before):
            raise RequestError(
                f"--out {self.path}: its content would be kept as {self.before}, but that is a file of yours; "
                "choose another name"
            )


def _lock(file: TextIO) -> bool:
    """Lock a file for this process, until it is closed or the process ends for any reason."""
    try:
        import fcntl
    except ImportError:  # not a POSIX system: two sweeps writing to one file are not detected
        return True
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    return True


def _line(cells: Iterable[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue()


def _cells(line: bytes) -> list[str] | None:
    """The cells of a line; None if it differs by a byte from what this module writes."""
    try:
        text = line.decode()
        cells = next(csv.reader([text], strict=True), [])
    except (UnicodeDecodeError, csv.Error):
        return None
    return cells if _line(cells) == text and "\0" not in text else None


def is_of_a_sweep(path: Path) -> bool:
    """Whether a file is a table written by this program: rows of a sweep, or a trajectory."""
    try:
        with path.open("rb") as file:
            first = file.readline(1 << 16).rstrip(b"\r\n")
    except OSError:
        return False
    return first.endswith(f",{_LAST}".encode()) or first == _TRAJECTORY


@contextmanager
def _writing(path: Path) -> Iterator[None]:
    try:
        yield
    except OSError as error:
        raise RunError(f"--out {path}: cannot be written: {reason(error)}") from None


def merged_columns(columns: list[str], records: Iterable[Mapping[str, Any]]) -> list[str]:
    """The columns plus those that the records add, in the records' order; the last stays last."""
    known = dict.fromkeys(columns)
    new = {name: None for record in records for name in record if name not in known}
    if not new:
        return columns
    last = columns[-1:] or list(next(iter(records)))[-1:]
    return [name for name in (known | new) if name not in last] + last


def cell(value: Any) -> str:
    """A value in CSV: empty for None and NaN, true and false, numbers in full precision, lists as JSON; one line."""
    if value is None:
        return ""
    if hasattr(value, "tolist"):
        value = value.tolist()  # numpy's numbers and arrays
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return "" if math.isnan(value) else repr(value)
    if isinstance(value, str):
        return csv_text(value)
    if isinstance(value, list | tuple | dict):
        return json.dumps(value, ensure_ascii=False, default=str)
    return str(value)


def rows(path: Path) -> Iterator[dict[str, str]]:
    """The rows of a finished or growing file as text."""
    with path.open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)
