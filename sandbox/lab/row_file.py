"""Rows into a CSV file as they come: what is there is whole, and an interrupted file can be resumed."""

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
    """What a sweep runs, in order: a Plan."""

    @property
    def fingerprint(self) -> str: ...
    @property
    def keys(self) -> list[str]: ...
    @property
    def size(self) -> int: ...
    def points(self, start: int, stop: int) -> Iterator[tuple[Any, ...]]: ...


class RowFile:
    """A CSV file that grows by whole lines; use it in a ``with`` block, and call ``finish`` after the last row.

    Until then a small file with ``.resume`` at the end of its name tells what the rows belong to; it is locked as long
    as this process lives, so that no other writes into the same file. Opened again for the same points, rows are added
    to those that are there (``done``, a number); the unfinished rows of another sweep raise RequestError. Rows are
    kept as far as they are, to the byte, what was written for these points: a line that was cut off is dropped, and
    from the first damaged one on (``damaged``, its number) they are to be computed again.

    What a finished or a damaged file held is kept (``before``), with ``~`` at the end of its name, until the same rows
    stand in the new one. Devices such as /dev/stdout are simply written to.
    """

    def __init__(self, path: Path, plan: Points) -> None:
        self.path = path
        self.done = 0
        self.damaged: int | None = None
        self._plan = plan
        self._is_device = path.exists() and not path.is_file()
        self._mark = path.with_name(path.name + ".resume")
        self._lock: TextIO | None = None
        self._columns: list[str] = []
        self._target = path.resolve() if path.is_symlink() else path  # the file behind a link, not the link
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
        with suppress(OSError):  # of a full disk, told by append already
            self._file.close()
        if self._lock is not None:
            self._lock.close()

    def finish(self) -> None:
        """All rows are there."""
        if not self._is_device:
            self._mark.unlink(missing_ok=True)
            if self.before.is_file() and filecmp.cmp(self.path, self.before, shallow=False):
                self.before.unlink()

    def append(self, records: Sequence[Mapping[str, Any]]) -> None:
        """Add rows; they are in the system's hands when this returns. New columns are blank in earlier rows.

        Raises RunError where the disk is full or the like; the rows before these are kept.
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
        """The mark, held by this process alone. Raises RequestError where another one holds it."""
        while True:
            mark = self._mark.open("a+", encoding="utf-8", errors="replace")
            try:
                if not _lock(mark):
                    raise RequestError(f"--out {self.path}: another sweep is writing this file; name another")
                if self._mark.exists() and os.path.samestat(os.fstat(mark.fileno()), self._mark.stat()):
                    return mark
            except BaseException:
                mark.close()
                raise
            mark.close()  # the other one has just finished, and taken its mark away

    def _begin(self, mark: TextIO) -> None:
        """Open the file after the rows that can be kept."""
        mark.seek(0)
        known = mark.read(100).strip()
        if known and not re.fullmatch("[0-9a-f]{64}", known):
            raise RequestError(
                f"--out {self.path}: it needs {self._mark.name}, and that is a file of yours; name another"
            )
        there = self._target.is_file() and self._target.stat().st_size > 0
        if known and there:
            if known != self._plan.fingerprint:
                raise RequestError(
                    f"--out {self.path}: holds the rows of another sweep that was interrupted, or of this one with "
                    f"another scene or program; name another file, or remove this one and {self._mark.name}"
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
        """Count the rows that are as they were written, and cut off what follows them; whether there are any."""
        with self.path.open("rb+") as file:
            header = file.readline()
            if not header.endswith(b"\n"):
                return False
            columns = _cells(header)
            keys = [csv_text(key) for key in self._plan.keys]
            if not columns or columns[: len(keys)] != keys or columns[-1] != _LAST or len({*columns}) < len(columns):
                raise RequestError(
                    f"--out {self.path}: its first line is not the one that this sweep wrote; mend it, or remove the "
                    f"file and {self._mark.name} to begin anew"
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
            if rest.endswith(b"\n") or b"\0" in rest:  # not merely the line that was being written
                self._check_before()
                shutil.copyfile(self.path, self.before)
                self.damaged = done + 1
            file.truncate(end)
        self._columns, self.done = columns, done
        return True

    def _check_before(self) -> None:
        """Raise RequestError where a file of the user's own is in the place of what is kept."""
        if self.before.exists() and not is_of_a_sweep(self.before):
            raise RequestError(
                f"--out {self.path}: what it holds would be kept as {self.before}, and that is a file of yours; "
                "name another"
            )


def _lock(file: TextIO) -> bool:
    """Lock a file for this process, until it is closed or the process ends however it does."""
    try:
        import fcntl
    except ImportError:  # not a POSIX system: two sweeps into one file are not noticed
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
    """The cells of a line; None where it is not, to the byte, one that is written here."""
    try:
        text = line.decode()
        cells = next(csv.reader([text], strict=True), [])
    except (UnicodeDecodeError, csv.Error):
        return None
    return cells if _line(cells) == text and "\0" not in text else None


def is_of_a_sweep(path: Path) -> bool:
    """Whether a file holds a table that this program wrote: the rows of a sweep, or a path."""
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
    """The columns with those that the records add, in the records' order; the last stays last."""
    known = dict.fromkeys(columns)
    new = {name: None for record in records for name in record if name not in known}
    if not new:
        return columns
    last = columns[-1:] or list(next(iter(records)))[-1:]
    return [name for name in (known | new) if name not in last] + last


def cell(value: Any) -> str:
    """A value in CSV: empty for None and NaN, true and false, numbers to the last digit, lists as JSON; one line."""
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
