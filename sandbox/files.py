"""Files that are read, and output files: checked before the work begins, written completely or not at all, never in
place of a file that the same command reads; what they replace is kept with ``~``. And values in JSON's types."""

from __future__ import annotations

import operator
import os
import signal
import threading
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from dataclasses import fields, is_dataclass
from importlib.util import find_spec
from math import isfinite
from pathlib import Path
from typing import Any, TextIO

from sandbox.errors import RequestError, RunError
from sandbox.text import encodable, shortened
from sandbox.tracebacks import of_user_code

#: Smallest and largest pictures, in px.
SMALLEST, LARGEST = (320, 180), (7680, 4320)

#: The process's own streams, which may be named as outputs, with their descriptors.
_STREAMS = {"/dev/stdout": 1, "/dev/stderr": 2}

#: The beginnings of trajectories and tables of impacts, the last column of a sweep, and the beginning of a fit.
_TABLES, _SWEEP, _FIT = (b"t,ball,x,y,vx,vy,spin", b"t,ball,mass,vx_before"), b",error", b"# Fitted: "

#: The files read so far by the command that runs, by their real paths; None outside of commands.
_inputs: ContextVar[set[str] | None] = ContextVar("inputs", default=None)

#: Names that Windows keeps for devices, with any ending.
_OF_WINDOWS = {"CON", "PRN", "AUX", "NUL", *(f"{port}{number}" for port in ("COM", "LPT") for number in range(10))}


def reason(error: OSError) -> str:
    """The system's message: ``"permission denied"``."""
    return (error.strerror or str(error)).lower()


def from_here(path: Path) -> str:
    """A path, relative to the current folder if it is in there."""
    try:
        return str(path.resolve().relative_to(Path.cwd()))
    except (ValueError, OSError):
        return str(path)


def check_file(option: str, path: Path, suffix: str) -> None:
    """Raise RequestError if the file for ``option`` could not be written, before any work is done for it."""
    if path == Path():
        raise RequestError(f'{option}: "" and "." are not files; name one, such as out{suffix}')
    if is_stream(path):
        return
    check_name(option, path)
    if path.is_dir():
        raise RequestError(f"{option} {path}: is a folder; name a file in it, such as {path / ('out' + suffix)}")
    if path.suffix.lower() != suffix:
        raise RequestError(f"{option} {path}: its name must end in {suffix}")
    check_replaced(option, path)
    check_writable(option, path.parent)
    if path.exists() and not os.access(path, os.W_OK):
        raise RequestError(f"{option} {path}: cannot be written: permission denied")


def check_folder(option: str, path: Path) -> None:
    """Raise RequestError if the folder for ``option`` could not be made or written into."""
    check_name(option, path)
    if path.exists() and not path.is_dir():
        raise RequestError(f"{option} {path}: is a file; a folder is needed")
    check_writable(option, next(folder for folder in (path, *path.absolute().parents) if folder.exists()))


def check_size(named: str, size: tuple[int, int]) -> None:
    """Raise RequestError if a picture of this size in px, ``named`` like that, would be too small or too large."""
    bounds = " and ".join(f"{across}x{up}" for across, up in (SMALLEST, LARGEST))
    try:
        width, height = map(operator.index, size)
    except (TypeError, ValueError):  # such as one number, or 500.5
        raise RequestError(f"{named}: must be two whole numbers, between {bounds} px") from None
    if not all(least <= side <= most for least, side, most in zip(SMALLEST, (width, height), LARGEST, strict=True)):
        raise RequestError(f"{named}: must be between {bounds} px")


def check_installed(option: str, package: str) -> None:
    """Raise RequestError with installation instructions if a package is missing; "" is none."""
    if package and find_spec(package.replace("-", "_")) is None:
        raise RequestError(f"{option} needs {package}, which is not installed: pip install {package}")


def check_distinct(outputs: Mapping[str, Path | None]) -> None:
    """Raise RequestError if two options name the same file; a stream may be named twice."""
    first: dict[str, str] = {}
    for option, path in outputs.items():
        if path is not None and not is_stream(path):
            other = first.setdefault(os.path.realpath(path), option)
            if other != option:
                raise RequestError(f"{option} {path}: is also the file of {other}; name another")


def check_name(option: str, path: Path) -> None:
    """Raise RequestError for a name that no file can have, here or on Windows, where others may have to read it."""
    if path.name and (wrong := forbidden(path.name)):
        raise RequestError(f"{option} {shortened(str(path))}: {wrong}: Windows has no such names; choose another")
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        pass  # a new file; a missing folder is reported by check_writable
    except (OSError, ValueError) as error:
        why = reason(error) if isinstance(error, OSError) else str(error)
        raise RequestError(f"{option} {shortened(str(path))}: {why}") from None


def forbidden(name: str) -> str:
    """Return what in the name of a file Windows forbids; "" if nothing."""
    letter = next((letter for letter in name if letter in '<>:"|?*\\' or ord(letter) < 32), "")
    if letter:
        return f"{letter!r} in its name"
    if name.endswith((".", " ")) and name.strip(". "):
        return f"{name[-1]!r} at the end of its name"
    stem = name.partition(".")[0].rstrip().upper()
    return f"{stem} as its name" if stem in _OF_WINDOWS else ""


def check_writable(option: str, folder: Path) -> None:
    """Raise RequestError if there is no such folder, or nothing can be written into it."""
    if not folder.is_dir():
        raise RequestError(f"{option}: there is no folder {folder}; make it first")
    trial = folder / f".sandbox-{os.getpid()}.part"
    try:
        trial.touch()
        trial.unlink()
    except OSError as error:
        raise RequestError(f"{option}: cannot write into {folder}: {reason(error)}") from None


def json_ready(value: Any, digits: int | None = None) -> Any:
    """The value in JSON's types, a dataclass as a table, numbers with at most so many ``digits`` after the point; NaN
    and infinities become null."""
    if isinstance(value, float):
        return None if not isfinite(value) else float(value if digits is None else round(value, digits))
    if value is None or isinstance(value, str | int):
        return value
    if isinstance(value, list | tuple):
        if digits is not None and all(type(item) is float for item in value) and isfinite(sum(value)):
            return [round(item, digits) for item in value]  # most of a run: coefficients
        return [json_ready(item, digits) for item in value]
    if is_dataclass(value):
        value = {field.name: getattr(value, field.name) for field in fields(value)}
    if isinstance(value, Mapping):
        return {str(key): json_ready(item, digits) for key, item in value.items()}
    return json_ready(value.tolist(), digits) if hasattr(value, "tolist") else value  # numpy's numbers and arrays


def json_text(value: Any) -> str:
    """JSON of numbers, words and lists; NaN and infinities are null. Raises TypeError for other values."""
    import json

    return encodable(json.dumps(json_ready(value), allow_nan=False, ensure_ascii=False))


def state_folder() -> Path:
    """The folder in which the program keeps what it remembers from one time to the next; it need not be there yet."""
    return _own_folder("XDG_STATE_HOME", ".local/state")


def data_folder() -> Path:
    """The folder in which the program keeps what is the user's; it need not be there yet."""
    return _own_folder("XDG_DATA_HOME", ".local/share")


def cache_folder() -> Path:
    """The folder in which the program keeps what it can make again; it need not be there yet."""
    return _own_folder("XDG_CACHE_HOME", ".cache")


def _own_folder(variable: str, usual: str) -> Path:
    home = os.environ.get(variable) or os.environ.get("LOCALAPPDATA") or Path.home() / usual
    return Path(home) / "sports-sandbox"


@contextmanager
def inputs_are_kept() -> Iterator[None]:
    """While a command runs inside, no output replaces a file that it has read."""
    token = _inputs.set(set())
    try:
        yield
    finally:
        _inputs.reset(token)


def is_given(path: Path) -> bool:
    """True if there is a file of that name, which is an input from here on. Raises RequestError for a folder, and for a
    pipe or a device, from which a reader might wait for ever: it is not passed over."""
    if not path.exists():
        return False
    if not path.is_file():
        raise RequestError(f"{path}: is {'a folder' if path.is_dir() else 'a pipe or a device'}; a file is needed")
    inputs = _inputs.get()
    if inputs is not None:
        inputs.add(os.path.realpath(path))
    return True


def read_given(path: Path, most: int) -> bytes:
    """The contents of a file that a user names. Raises RequestError if it cannot be read, is no file but a pipe or a
    device, which may never end, or has more than ``most`` bytes."""
    try:
        is_given(path)
        size = path.stat().st_size
        if size > most:
            raise RequestError(f"{path}: has {size / 1e6:.3g} MB; such a file has at most {most / 1e6:.3g} MB")
        return path.read_bytes()
    except OSError as error:
        raise RequestError(f"{path}: cannot be read: {reason(error)}") from None


def is_stream(path: Path) -> bool:
    """True for /dev/stdout and /dev/stderr, which an output may be named."""
    return path.as_posix() in _STREAMS


def open_stream(path: Path) -> TextIO:
    """The stream of that name for writing, at the place that it has reached; to close it leaves the process's open."""
    return os.fdopen(os.dup(_STREAMS[path.as_posix()]), "w", encoding="utf-8", newline="")


def backup_of(path: Path) -> Path:
    """The name under which the content of a file is kept that an output replaces."""
    return path.with_name(f"{path.name}~")


def check_replaced(option: str, path: Path) -> None:
    """Raise RequestError if an output of this name would replace something that is no plain file, that the command
    reads, or that could not be kept: the last also if a table or scene file of the user's has the backup's name."""
    target = Path(os.path.realpath(path))
    named = f"{option} {path}".strip()
    if not target.exists():
        return
    if not target.is_file():
        raise RequestError(f"{named}: is no plain file; name another")
    if _is_input(target):
        raise RequestError(f"{named}: this command reads that file, which would be lost; name another")
    backup = backup_of(target)
    try:
        backup.stat()
    except FileNotFoundError:
        return
    except OSError as error:
        why = f"its content could not be kept under this name with ~: {reason(error)}"
        raise RequestError(f"{shortened(named)}: {why}; name another") from None
    if not backup.is_file():
        raise RequestError(f"{named}: {backup} is no plain file; name another")
    if _is_input(backup) or not _is_ours(backup):
        raise RequestError(f"{named}: its content would be kept as {backup}, but that is a file of yours; name another")


def _is_input(path: Path) -> bool:
    """True if the command has read this file, by whatever name."""
    return any(read.exists() and read.samefile(path) for read in map(Path, _inputs.get() or ()))


def is_our_table(path: Path) -> bool:
    """True for rows of a sweep, a trajectory or impacts that this program wrote, and for a file that is still empty."""
    first = _first_line(path)
    return first is not None and (not first or first.startswith(_TABLES) or first.endswith(_SWEEP))


def _is_ours(path: Path) -> bool:
    """True for the backup of a table, of a fit or of its points that this program wrote, and for other types."""
    if path.suffix.lower() not in (".csv~", ".toml~") or is_our_table(path):
        return True
    return (_first_line(path.with_suffix(".toml~")) or b"").startswith(_FIT)


def _first_line(path: Path) -> bytes | None:
    """The first line of a file; None if it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.readline(1 << 16).rstrip(b"\r\n")
    except OSError:
        return None


def keep(path: Path) -> None:
    """Give a file its backup's name, and take that of the backup before."""
    path.replace(backup_of(path))


def _put(part: Path, target: Path, kept: bool) -> None:
    """Give a finished file its name; other content that has it is ``kept``, or else replaced."""
    import filecmp  # here, as others below: no start of the program needs it

    if not kept or not target.exists() or filecmp.cmp(part, target, shallow=False):
        part.replace(target)
        return
    check_replaced("", target)
    with _interrupts_wait():
        keep(target)
        part.replace(target)


@contextmanager
def atomic_write(path: Path, kept: bool = True) -> Iterator[TextIO]:
    """A text file that appears under its name only when complete; what it replaces is ``kept`` with ``~``. /dev/stdout
    and /dev/stderr are written directly."""
    if is_stream(path):
        with open_stream(path) as file:
            yield file
        return
    target = Path(os.path.realpath(path))  # the file behind a link, not the link
    part = target.with_name(f".{target.name[:40]}.{os.getpid()}.part")  # a name may be as long as the system allows
    try:
        with part.open("w", encoding="utf-8", newline="") as file:
            yield file
        _put(part, target, kept)
    finally:
        part.unlink(missing_ok=True)


def put_output(part: Path, path: Path) -> None:
    """Give a finished output that is in another place its name; what it replaces is kept with ``~``."""
    _put(part, Path(os.path.realpath(path)), kept=True)


def write_together(contents: Mapping[Path, bytes], kept: bool = False) -> None:
    """Write several files, all or none: an interrupt waits until the last has its name; what they replace is ``kept``
    with ``~`` on request.

    Only a process that is killed between two renames leaves some; each of those is complete.
    """
    targets = {path: Path(os.path.realpath(path)) for path in contents}
    parts = {path: target.with_name(f".{target.name[:40]}.{os.getpid()}.part") for path, target in targets.items()}
    try:
        for path, data in contents.items():
            targets[path].parent.mkdir(parents=True, exist_ok=True)
            parts[path].write_bytes(data)
            if kept:
                check_replaced("", path)
        with _interrupts_wait():
            for path, part in parts.items():
                _put(part, targets[path], kept)
    finally:
        for part in parts.values():
            part.unlink(missing_ok=True)


@contextmanager
def _interrupts_wait() -> Iterator[None]:
    """Hold Ctrl-C and SIGTERM back for a moment: in the main thread, which alone gets them."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    received: list[int] = []
    handlers = {number: signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM)}
    for number in handlers:
        signal.signal(number, lambda number, frame: received.append(number))
    try:
        yield
    finally:
        for number, handler in handlers.items():
            signal.signal(number, handler or signal.SIG_DFL)
        for held in received[:1]:
            signal.raise_signal(held)


@contextmanager
def folder_of_parts(folder: Path, name: str) -> Iterator[Path]:
    """A folder in this one for what is not finished; in the end it is removed, even if that is interrupted."""
    import shutil
    import tempfile

    part = Path(tempfile.mkdtemp(prefix=f".{name}-", dir=folder))
    try:
        yield part
    finally:
        try:
            shutil.rmtree(part, ignore_errors=True)
        except KeyboardInterrupt:
            shutil.rmtree(part, ignore_errors=True)
            raise


@contextmanager
def writing(option: str, path: Path) -> Iterator[None]:
    """Report a full disk, or a folder that was removed, in one line; without an ``option`` it names only the file."""
    try:
        yield
    except OSError as error:
        if of_user_code(error) is not None:
            raise
        raise RunError(f"{option} {path}: cannot be written: {reason(error)}".lstrip()) from None


@contextmanager
def no_empty_folder(path: Path) -> Iterator[None]:
    """Remove the empty folders that the work inside made on the way to ``path``, if it fails."""
    missing = [folder for folder in (path, *path.parents) if not folder.exists()]
    try:
        yield
    except BaseException:
        for folder in missing:
            with suppress(OSError):
                folder.rmdir()
        raise
