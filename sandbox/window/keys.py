"""What a command is, and what its keys are called."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import pygame


class Command(NamedTuple):
    """A command with its key, or two keys: the second does the opposite of the first."""

    name: str
    keys: tuple[str, ...]  # as named by pygame, after "ctrl " or "alt "
    meaning: str
    group: str
    do: Callable[[Any, float], object] | None = None  # to a view, so much of it; None: it switches its name on or off
    mouse: str = ""  # how the mouse does the same
    repeats: bool = False  # while the key is held
    fine: bool = False  # a tenth with Shift

    @property
    def shown(self) -> str:
        """Keys and mouse, for people."""
        held = next((held for held in HELD if self.keys[0].startswith(held)), "")
        names = [key.removeprefix(held) for key in self.keys]
        words = [SHORT.get(name, name.upper() if len(name) == 1 else name) for name in names]
        keys = " ".join([*filter(None, [held.strip().capitalize()]), *words])
        return ", ".join(filter(None, (keys, self.mouse)))


#: Modifiers that are part of a key's name here.
HELD = ("ctrl ", "alt ")
#: Shorter names than pygame's, and keys that do the same as others.
SHORT = {"page down": "PgDn", "page up": "PgUp", "return": "Enter", "escape": "Esc", "space": "Space", "tab": "Tab",
         "backspace": "Backspace", **{f"f{number}": f"F{number}" for number in range(1, 13)}}  # fmt: skip
SAME = {"=": "+", "[+]": "+", "[-]": "-", "[0]": "0", "enter": "return", "f1": "h"}


def name_of(key: int, modifiers: int) -> str:
    """What a key that is pressed is called in a command's ``keys``."""
    held = "ctrl " * bool(modifiers & pygame.KMOD_CTRL) + "alt " * bool(modifiers & pygame.KMOD_ALT)
    name = pygame.key.name(key)
    return held + SAME.get(name, name)
