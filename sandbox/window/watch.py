"""Notices when one of some files is saved."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

EVERY = 0.2  # s, between looks


class Watch:
    """Looks at the time and size of files now and then; a file that is away for a moment is an editor at work."""

    def __init__(self, files: Sequence[Path]) -> None:
        self.seen = {file: _state(file) for file in files}
        self.waited = 0.0

    def saved(self, dt: float) -> list[Path]:
        """The files that changed since this was last asked; ``dt`` s have passed since."""
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
