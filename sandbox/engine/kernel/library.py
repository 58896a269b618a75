"""The compiled kernel: found in the user's cache, where ``sandbox compile`` has put it, loaded once, and called."""

from __future__ import annotations

import ctypes
import hashlib
import os
import platform
import sys
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from sandbox.engine.kernel.leg import ARC_COLUMNS, EVENT_COLUMNS, EVENTS, SHOT_COLUMNS
from sandbox.engine.kernel.leg import ARCS as ARCS_SO_FAR
from sandbox.engine.kernel.rows import Tables
from sandbox.files import cache_folder

#: Set to anything in the environment, the compiled kernel is ignored: what ``--no-compiled`` does.
IGNORED = "SANDBOX_NO_COMPILED"

#: Rows of arcs and of events for which there is room, for each shot and at most: 6 kB and 125 MB, where they are used.
_ARCS, _EVENTS, _MOST = 80, 20, 400_000

#: How ``fly_all`` is compiled; a part of the library's key.
OPTIONS = {"error_model": "numpy"}

#: Packages whose files the kernel is made of: all of them, so that no change is missed.
_SOURCES = ("physics", "engine/contact", "engine/kernel", "engine/model", "engine/paths")

FlyAll = Callable[..., int]


class Legs(NamedTuple):
    """Legs that have been flown: the shots' rows after them; rows of arcs and events, of one shot after another."""

    shots: np.ndarray
    arcs: np.ndarray
    events: np.ndarray


def place() -> Path:
    """The library's file, whether it is there or not, named after the sources, the options and the platform."""
    package, digest = Path(__file__).parents[2], hashlib.sha256()
    for folder in _SOURCES:
        for file in sorted((package / folder).glob("*.py")):
            digest.update(file.read_bytes())
    digest.update(repr((sorted(OPTIONS.items()), platform.machine(), platform.libc_ver(), sys.platform)).encode())
    return cache_folder() / f"kernel-{digest.hexdigest()[:16]}.so"


@cache
def compiled() -> FlyAll | None:
    """``fly_all`` of the compiled library; None if there is none, or it is to be ignored."""
    if os.environ.get(IGNORED):
        return None
    file = place()
    return load(file) if file.is_file() else None


def load(file: Path) -> FlyAll | None:
    """``fly_all`` of a library; None if it cannot be loaded."""
    try:
        entry = ctypes.CDLL(str(file)).fly_all
    except (OSError, AttributeError):
        return None
    entry.restype = ctypes.c_int64

    def fly_all(first: int, *arrays: np.ndarray) -> int:
        arguments: list[Any] = [ctypes.c_int64(first)]
        for array in arrays:
            arguments += [ctypes.c_void_p(array.ctypes.data), *map(ctypes.c_int64, array.shape)]
        return int(entry(*arguments))

    return fly_all


def fly_together(fly_all: FlyAll, shots: np.ndarray, tables: Tables, counted: np.ndarray) -> Legs:
    """Fly shots, whose rows have shape (shots, 7), each to the end of its leg. ``counted`` has for each the impacts so
    far that its rules are about; they are counted on."""
    count, first, found = len(shots), 0, np.empty((len(shots), SHOT_COLUMNS))
    room, most = _ARCS * (count + 9), _EVENTS * (count + 9)
    arcs, events = np.empty((min(room, _MOST), ARC_COLUMNS)), np.empty((most, EVENT_COLUMNS))
    parts, so_far = list[tuple[np.ndarray, np.ndarray]](), (0, 0)
    before = counted.copy()
    while first < count:
        done = fly_all(first, shots, *tables[:5], counted, tables.limits, arcs, events, found)
        if done > first:
            used = found[done - 1, [ARCS_SO_FAR, EVENTS]].astype(int).tolist()
            new = arcs[: used[0]], events[: used[1]]
            parts.append(new if done == count else (new[0].copy(), new[1].copy()))
            found[first:done, ARCS_SO_FAR] += so_far[0]
            found[first:done, EVENTS] += so_far[1]
            so_far = so_far[0] + used[0], so_far[1] + used[1]
        else:  # more room for a single shot
            arcs, events = np.empty((2 * len(arcs), ARC_COLUMNS)), np.empty((2 * len(events), EVENT_COLUMNS))
        if done < count:
            counted[done] = before[done]
        first = done
    if len(parts) == 1:
        return Legs(found, *parts[0])
    return Legs(found, *(np.concatenate([part[i] for part in parts]) for i in (0, 1)))
