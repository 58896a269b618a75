"""Rows into a CSV file as they come: what is there is whole, and an interrupted file can be gone on with."""

from __future__ import annotations

import csv
import filecmp
import json
import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from sandbox.errors import RequestError, RunError
from sandbox.files import reason
from sandbox.text import csv_text

_BLOCK = 1 << 20  # bytes


class RowFile:
    """A CSV file that grows by whole lines; use it in a ``with`` block, and call ``finish`` after the last row.

    Until then a small file beside it, with ``.resume`` at the end of its name, tells what the rows belong to. Opened
    again with the same ``fingerprint``, rows are added to those that are there (``done``, a number); a finished file
    begins anew, and the unfinished rows of another sweep raise RequestError. What a finished file held is kept beside
    it (``before``), with ``~`` at the end of its name, until the same rows stand in the new one. A line that was cut
    off by a crash is dropped. Devices such as /dev/stdout are simply written to.
    """

    def __init__(self, path: Path, fingerprint: str) -> None:
        self.path = path
        self.done = 0
        self._fingerprint = fingerprint
        self._is_device = path.exists() and not path.is_file()
        self._mark = path.with_name(path.name + ".resume")
        self._columns: list[str] = []
        self._target = path.resolve() if path.is_symlink() else path  # the file behind a link, not the link
        self.before = self._target.with_name(f"{self._target.name}~")

    def __enter__(self) -> RowFile:
        with _writing(self.path):
            if not self._is_device and self._can_go_on():
                self._file = self.path.open("a", encoding="utf-8", newline="")
                return self
            if not self._is_device:
                if self._target.is_file() and self._target.stat().st_size and not self._mark.exists():
                    self._target.replace(self.before)
                self._mark.write_text(self._fingerprint + "\n", "utf-8")
            self._file = self.path.open("w", encoding="utf-8", newline="")
        return self

    def __exit__(self, *failure: object) -> None:
        with suppress(OSError):  # of a full disk, told by append already
            self._file.close()

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
        columns = merged_columns(self._columns, records)
        with _writing(self.path):
            if columns != self._columns:
                self._widen(columns)
            writer = csv.writer(self._file, lineterminator="\n")
            writer.writerows([cell(record.get(name)) for name in columns] for record in records)
            self._file.flush()
        self.done += len(records)

    def _widen(self, columns: list[str]) -> None:
        if self.done and self._is_device:
            raise RunError(f"{self.path}: later rows have more columns than the first ones; write to a file instead")
        if not self.done:
            self._columns = columns
            csv.writer(self._file, lineterminator="\n").writerow(columns)
            return
        self._file.close()
        wider = self.path.with_name(f".{self.path.name}.{os.getpid()}.part")
        try:
            with wider.open("w", encoding="utf-8", newline="") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow(columns)
                for row in rows(self.path):
                    writer.writerow([row.get(name, "") for name in columns])
            wider.replace(self.path)
        finally:
            wider.unlink(missing_ok=True)
            self._file = self.path.open("a", encoding="utf-8", newline="")
        self._columns = columns

    def _can_go_on(self) -> bool:
        """Whether there are rows of the same sweep; if so, count them, and drop a line without an end."""
        try:
            known = self._mark.read_text("utf-8").strip()
        except (OSError, UnicodeDecodeError):
            return False
        if not self.path.is_file() or not self.path.stat().st_size:
            return False
        if known != self._fingerprint:
            raise RequestError(
                f"--out {self.path}: holds the rows of another sweep that was interrupted, or of this one with another "
                f"scene or program; name another file, or remove this one and {self._mark.name}"
            )
        lines, end, size = 0, 0, 0
        with self.path.open("rb+") as file:
            while block := file.read(_BLOCK):
                if (last := block.rfind(b"\n")) >= 0:
                    lines += block.count(b"\n")
                    end = size + last + 1
                size += len(block)
            file.truncate(end)
        if not lines:
            return False
        with self.path.open(encoding="utf-8", newline="") as file:
            self._columns = next(csv.reader(file))
        self.done = lines - 1
        return True


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
