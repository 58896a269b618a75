"""The window's memory from one time to the next: files opened last, and which hints were followed."""

from __future__ import annotations

import json
from contextlib import suppress
from pathlib import Path

from sandbox.errors import RequestError
from sandbox.files import atomic_write, is_given, state_folder

#: What a first user may try, by the name under which it is remembered.
HINTS = {
    "shoot": "Pull back anywhere and let go: a shot",
    "drag": "Drag a ring: the thing under it moves",
    "menu": "L, or the name below: other scenes",
}
#: What moves less, unless the player has chosen otherwise than the desktop; only such a choice is kept.
_MOTION = ("still", "calm")
#: So many files are remembered.
MOST = 8


def usual_place() -> Path:
    """The file in which it is kept."""
    return state_folder() / "window.json"


class Memory:
    """Kept in a file, or only until the window is closed. A file that cannot be read or written is no matter."""

    def __init__(self, file: Path | None = None, less_motion: bool = False) -> None:
        """Without a file there are no hints. With ``less_motion`` the camera stands still and nothing celebrates,
        unless the player has chosen otherwise."""
        self.file, self.less_motion = file, less_motion
        self.recent: list[str] = []
        self.followed: list[str] = []
        self.lab = False  # whether the values of a laboratory are shown: clock, forces, arrows, charts, tape
        self.in_lab: list[str] = []  # what else is switched on there
        self.calm = less_motion  # whether nothing celebrates a success
        self.size: tuple[int, int] | None = None  # of the window, in px
        self.look = 1.0, False  # how much larger letters are, and whether the contrast is high
        self.still = less_motion  # the camera stands still
        with suppress(OSError, ValueError, TypeError, AttributeError, RequestError):
            kept = json.loads(file.read_text("utf-8")) if file is not None and is_given(file) else {}
            self.recent = [source for source in kept.get("recent", []) if isinstance(source, str)][:MOST]
            larger, contrast = kept.get("look", self.look)
            self.look = min(max(float(larger), 1.0), 2.0), bool(contrast)
            self.still, self.calm = (bool(kept.get(name, less_motion)) for name in _MOTION)
            self.followed = [hint for hint in kept.get("followed", []) if isinstance(hint, str)]
            self.lab = bool(kept.get("lab", False))
            self.in_lab = [name for name in kept.get("in_lab", self.in_lab) if isinstance(name, str)]
            width, height = kept.get("size") or (0, 0)  # an older file has none
            self.size = (int(width), int(height)) if width and height else None

    def opened(self, source: str) -> None:
        """A scene was opened; a file is remembered by its whole path."""
        path = Path(source)
        source = str(path.resolve()) if path.exists() else source
        if source not in self.recent[:1]:
            self.recent = [source, *(each for each in self.recent if each != source)][:MOST]
            self.save()

    @property
    def hints(self) -> dict[str, str]:
        """Those that were not followed yet."""
        return {name: text for name, text in HINTS.items() if name not in self.followed and self.file is not None}

    def follow(self, hint: str) -> None:
        """A hint was followed, and is not shown again."""
        if hint not in self.followed:
            self.followed.append(hint)
            self.save()

    def save(self) -> None:
        """Write it, if it has a file."""
        if self.file is not None:
            with suppress(OSError):
                self.file.parent.mkdir(parents=True, exist_ok=True)
                with atomic_write(self.file, kept=False) as file:
                    kept = ("recent", "followed", "look", "lab", "in_lab", "size")
                    chosen = (name for name in _MOTION if getattr(self, name) != self.less_motion)
                    json.dump({name: getattr(self, name) for name in (*kept, *chosen)}, file)
