"""Rows written to a CSV file as they are computed: the file holds whole rows, and an interrupted one can be resumed."""

from __future__ import annotations

import csv
import filecmp
import hashlib
import io
import json
import re
import shutil
from collections.abc import Iterable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from types import NoneType
from typing import TYPE_CHECKING, Any

from sandbox.errors import RequestError
from sandbox.files import backup_of, check_replaced, is_stream, json_ready, keep, open_stream, writing
from sandbox.text import csv_text

if TYPE_CHECKING:
    from sandbox.lab.plan import Plan, Rows

#: A value as JSON, on one line.
_as_json = json.JSONEncoder(ensure_ascii=False, default=str).encode


class RowFile:
    """A CSV file written in whole lines; use it in a ``with`` block, and call ``finish`` after the last row.

    Until then a small marker file, with ``.resume`` added to the name, identifies the sweep. A hidden file next to it
    is locked, so that no other process writes to the same file. If the file is opened again for the same points, rows
    are added to the existing ones (``done``, their number); unfinished rows of another sweep raise RequestError.
    Existing rows are kept only if they are byte for byte what was written for these points: an incomplete last line is
    dropped, and rows from the first damaged one (``damaged``, its number) are computed again.

    The old content of a finished or damaged file is kept under its name with ``~`` added (``before``) until the same
    rows are in the new file. A finished file of the same sweep is complete: a small hidden file next to it has a digest
    of both. /dev/stdout and /dev/stderr are simply written to.
    """

    def __init__(self, path: Path, plan: Plan) -> None:
        self.path = path
        self.done = 0
        self.damaged: int | None = None
        self._plan = plan
        self._first_line = _line(map(csv_text, plan.columns))
        self._is_stream = is_stream(path)
        self._file_path = path if self._is_stream else path.resolve()  # the target of a link, not the link
        self._mark_path = self._file_path.with_name(f"{self._file_path.name}.resume")
        self._lock_path = self._file_path.with_name(f".{self._file_path.name}.lock")
        self._seal_path = self._file_path.with_name(f".{self._file_path.name}.complete")
        self.before = backup_of(self._file_path)
        self._open = ExitStack()

    def __enter__(self) -> RowFile:
        with writing("--out", self.path), self._open:
            if self._is_stream:
                self._file = open_stream(self.path)
            else:
                self._open.enter_context(self._alone())
                self._begin()
                self._file = self._file_path.open("a", encoding="utf-8", newline="")
            self._open = self._open.pop_all()
        return self

    def __exit__(self, *failure: object) -> None:
        with suppress(OSError):  # a full disk, which append has already reported
            self._file.close()
        self._open.close()

    def finish(self) -> None:
        """Mark the file as complete."""
        if not self._is_stream:
            with suppress(OSError):  # a full disk: the same sweep would be computed again
                self._seal_path.write_text(self._seal(), encoding="utf-8", newline="\n")
            self._mark_path.unlink(missing_ok=True)
            if self.before.is_file() and filecmp.cmp(self._file_path, self.before, shallow=False):
                self.before.unlink()

    def append(self, rows: Rows) -> None:
        """Add rows; they have been passed to the operating system on return.

        Raises RunError if writing fails, for example on a full disk; earlier rows are kept.
        """
        with writing("--out", self.path):
            if not self.done:
                self._file.write(self._first_line)
            columns = [_texts(rows.column(name)) for name in self._plan.columns]
            self._file.write("".join(f"{','.join(cells)}\n" for cells in zip(*columns, strict=True)))
            self.done += len(rows)
            self._file.flush()

    # Before the first row

    @contextmanager
    def _alone(self) -> Iterator[None]:
        """Hold the lock. Raises RequestError if another process has it."""
        from filelock import FileLock, Timeout

        lock = FileLock(self._lock_path, thread_local=False)
        while True:
            try:
                lock.acquire(timeout=0)
            except Timeout:
                said = "another sweep is writing to this file; choose another name"
                raise RequestError(f"--out {self.path}: {said}") from None
            if self._lock_path.exists():
                break
            lock.release()  # its holder has finished and removed it just now: begin again
        try:
            yield
        finally:
            with suppress(OSError):  # Windows removes it when it is released
                self._lock_path.unlink()
            lock.release()

    def _begin(self) -> None:
        """Leave only the rows that are kept in the file."""
        known = ""
        if self._mark_path.is_file():
            with self._mark_path.open(encoding="utf-8", errors="replace") as mark:
                known = mark.read(100).strip()
        if known and not re.fullmatch("[0-9a-f]{64}", known):
            raise RequestError(f"--out {self.path}: {self._mark_path.name} is a file of yours; choose another name")
        there = self._file_path.is_file() and self._file_path.stat().st_size > 0
        if known and there:
            if known != self._plan.fingerprint:
                raise RequestError(
                    f"--out {self.path}: contains rows of another interrupted sweep, or of this one with another scene "
                    f"or program version; choose another name, or remove this file and {self._mark_path.name}"
                )
            self._keep_rows()
            return
        if there and self._is_complete():
            self.done = self._plan.size
        elif there:
            check_replaced("--out", self.path)
            keep(self._file_path)
        try:
            self._mark_path.write_text(self._plan.fingerprint + "\n", encoding="utf-8", newline="\n")
        except OSError:  # a full disk: all is left as it was
            self._mark_path.unlink(missing_ok=True)
            if there and not self.done:
                self.before.replace(self._file_path)
            raise

    def _seal(self) -> str:
        """A digest of the sweep and of the file's content."""
        with self._file_path.open("rb") as file:
            return f"{self._plan.fingerprint} {hashlib.file_digest(file, 'sha256').hexdigest()}\n"

    def _is_complete(self) -> bool:
        """True if the file is just as this sweep left it when it was finished."""
        try:
            return self._seal_path.read_text("utf-8") == self._seal()
        except (OSError, UnicodeDecodeError):
            return False

    def _keep_rows(self) -> None:
        """Count the intact rows and cut off the rest; without any, the first line too."""
        with self._file_path.open("rb+") as file:
            header = file.readline()
            if header.endswith(b"\n") and header != self._first_line.encode():
                raise RequestError(
                    f"--out {self.path}: its first line is not what this sweep wrote; repair it, or remove the "
                    f"file and {self._mark_path.name} to start again"
                )
            width, keys = len(self._plan.columns), len(self._plan.keys)
            end = 0
            for point in self._plan.points(0, self._plan.size):
                cells = _cells(file.readline())
                if cells is None or len(cells) != width or cells[:keys] != [cell(part) for part in point]:
                    break
                self.done, end = self.done + 1, file.tell()
            file.seek(end or len(header))
            rest = file.readline()
            if rest.endswith(b"\n") or b"\0" in rest:  # not just the line that was being written
                check_replaced("--out", self.path)
                shutil.copyfile(self._file_path, self.before)
                self.damaged = self.done + 1
            file.truncate(end)


def _line(cells: Iterable[str]) -> str:
    text = io.StringIO()
    csv.writer(text, lineterminator="\n").writerow(cells)
    return text.getvalue()


def _texts(values: Sequence[Any]) -> list[str]:
    """The values of a column as they stand in the file; words and lists of words, of which few differ, once each."""
    kinds = {*map(type, values)}
    if kinds <= {float, NoneType}:  # by far the most common
        return ["" if value is None or value != value else repr(value) for value in values]
    if kinds == {int}:
        return [*map(repr, values)]
    known: dict[Any, str] = {}
    texts = []
    for value in values:
        words = tuple(value) if type(value) is list else (value,)
        if {*map(type, words)} <= {str}:
            name = type(value), words
            text = known[name] if name in known else known.setdefault(name, _text(value))
        else:
            text = _text(value)
        texts.append(text)
    return texts


def _text(value: Any) -> str:
    """A value as it stands in a line with others: in quotes where it has to be."""
    return _line((cell(value), ""))[:-2]


def _cells(line: bytes) -> list[str] | None:
    """The cells of a line; None if it differs by a byte from what this module writes."""
    try:
        text = line.decode()
        cells = next(csv.reader([text], strict=True), [])
    except (UnicodeDecodeError, csv.Error):
        return None
    return cells if _line(cells) == text and "\0" not in text else None


def cell(value: Any) -> str:
    """A value in CSV: empty for None and NaN, true and false, numbers in full precision, lists as JSON; one line."""
    kind = type(value)
    if kind is float:  # by far the most common
        return "" if value != value else repr(value)
    if kind is int:
        return repr(value)
    if kind is str:
        return csv_text(value)
    if value is None:
        return ""
    if isinstance(value, bool):
        return "true" if value else "false"
    if hasattr(value, "tolist"):
        return cell(value.tolist())  # numpy's numbers and arrays
    if isinstance(value, list | tuple | dict):
        value = _as_json(json_ready(value))
    return csv_text(value) if isinstance(value, str) else str(value)


def rows(path: Path) -> Iterator[dict[str, str]]:
    """The rows of a finished or growing file as text."""
    with path.open(encoding="utf-8", newline="") as file:
        yield from csv.DictReader(file)
