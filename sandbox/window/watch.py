"""Notices when one of some files is saved."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

EVERY = 0.2  # s, between checks


class Watch:
    """Checks the time and size of files at intervals; a file that is missing for a moment is being saved."""

    def __init__(self, files: Sequence[Path]) -> None:
        self.seen = {file: _state(file) for file in files}
        self.waited = 0.0

    def saved(self, dt: float) -> list[Path]:
        """The files that changed since the last call, ``dt`` s ago."""
        self.waited += dt
        if self.waited < EVERY:
            return []
        self.waited = 0.0
        changed = []
        for file, before in self.seen.items():
            now = _state(file)
            if now is not None and now != before:
                self.seen[file] = now
                changed.append(file)
        return changed


def _state(file: Path) -> tuple[int, int] | None:
    try:
        found = file.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size
