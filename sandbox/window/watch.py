"""Notices when a file is saved."""

from __future__ import annotations

from pathlib import Path

EVERY = 0.2  # s, between looks


class Watch:
    """Looks at a file's time and size now and then; a file that is away for a moment is an editor at work."""

    def __init__(self, file: Path | None) -> None:
        self.file = file
        self.seen = self._look()
        self.waited = 0.0

    def _look(self) -> tuple[int, int] | None:
        try:
            found = self.file.stat() if self.file is not None else None
        except OSError:
            return None
        return (found.st_mtime_ns, found.st_size) if found is not None else None

    def saved(self, dt: float) -> bool:
        """Whether the file changed since the last time that this was asked; ``dt`` s have passed since."""
        self.waited += dt
        if self.waited < EVERY:
            return False
        self.waited = 0.0
        now = self._look()
        if now is None or now == self.seen:
            return False
        self.seen = now
        return True
