"""Every command of the window with its keys, in one table; keys, help, lists and the bar's hints are made from it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import pygame


class Command(NamedTuple):
    """A command with its key, or two keys: the second does the opposite of the first. Without keys it is by mouse."""

    name: str
    keys: tuple[str, ...]  # as named by pygame, after "ctrl " or "alt "
    meaning: str
    group: str
    mouse: str = ""  # how the mouse does the same
    repeats: bool = False  # while the key is held
    fine: bool = False  # a tenth with Shift

    @property
    def shown(self) -> str:
        """Keys and mouse, for people."""
        words = [SHORT.get(name, name.upper() if len(name) == 1 else name) for name in map(_plain, self.keys)]
        held = self.keys[0].partition(" ")[0].capitalize() if self.keys and self.keys[0].startswith(HELD) else ""
        keys = " ".join([*filter(None, [held]), *words])
        return ", ".join(filter(None, (keys, self.mouse)))


#: Modifiers that are part of a key's name here.
HELD = ("ctrl ", "alt ")
#: Shorter names than pygame's, and keys that do the same as others.
SHORT = {"page down": "PgDn", "page up": "PgUp", "return": "Enter", "escape": "Esc", "space": "Space", "tab": "Tab",
         "backspace": "Backspace", **{f"f{number}": f"F{number}" for number in range(1, 13)}}  # fmt: skip
SAME = {"=": "+", "[+]": "+", "[-]": "-", "[0]": "0", "enter": "return", "f1": "h"}

TABLE = (
    Command("go", ("space",), "shoot; pause, resume", "Play", "pull back and let go"),
    Command("again", ("return",), "aim again; in billiards go on", "Play"),
    Command("turn", ("left", "right"), "turn the shot (Shift: finely)", "Play", repeats=True, fine=True),
    Command("push", ("up", "down"), "stronger, weaker (Shift: finely)", "Play", repeats=True, fine=True),
    Command("spin", ("e", "d"), "spin (Shift: finely)", "Play", "wheel", repeats=True, fine=True),
    Command("other_spin", ("x", "z"), "second spin, if any", "Play", "Shift wheel", repeats=True, fine=True),
    Command("handle", ("k", "i"), "take hold of the next thing; arrows move it, Esc lets go", "Play", "drag it"),
    Command("pad", ("2",), "set spin on a ball, or where the (level) cue's tip hits", "Play", "drag on it"),
    Command("restart", ("r",), "from the start", "Watch"),
    Command("step", (".", ","), "one step on, back", "Watch", repeats=True),
    Command("faster", ("+", "-"), "faster to 8, slower to 1/16", "Watch"),
    Command("next_shot", ("n", "p"), "next, previous shot", "Watch"),
    Command("shots", ("q",), "table of shots: sort, pin, delete, CSV, statistics", "See"),
    Command("find", ("/",), "find me a shot: at the ring, a pocket, the pin ...", "See"),
    Command("view", ("v",), "follow the ball", "See"),
    Command("predict", ("y",), "path while aiming: all, to the first contact, a metre, nothing", "See"),
    Command("ghosts", ("g",), "earlier shots", "See"),
    Command("fan", ("f",), "fan: 100 similar shots, how many score", "See"),
    Command("wider", ("]", "["), "a wider, narrower fan", "See"),
    Command("map", ("m",), "map: which speeds and angles score", "See"),
    Command("zoom", ("ctrl +", "ctrl -"), "larger, smaller", "See", "Ctrl wheel, pinch", repeats=True),
    Command("pan_across", ("alt left", "alt right"), "move the picture", "See", "Ctrl drag, two fingers", repeats=True),
    Command("pan_down", ("alt up", "alt down"), "", "See", repeats=True),
    Command("fit", ("ctrl 0",), "see all of the shot", "See"),
    Command("arrows", ("o",), "arrows: velocity and forces", "See"),
    Command("charts", ("w",), "charts over time", "See"),
    Command("graphs", ("alt w",), "charts over time, large, with earlier shots", "See"),
    Command("energy", ("j",), "where the energy goes", "See"),
    Command("tape", ("t",), "tape; arrows move its end, K the other", "See", "right drag"),
    Command("accuracy", ("a",), "accuracy: fast, balanced, precise", "See"),
    Command("save_scene", ("s",), "a scene file with what was changed", "Keep"),
    Command("copy", ("c",), "copy the command line of this shot", "Keep"),
    Command("screenshot", ("f12",), "picture of the window", "Keep"),
    Command("animation", ("f9",), "animation of the last shot", "Keep"),
    Command("save_replay", ("f5",), "replay file of the last shot", "Keep"),
    Command("compare", ("f6",), "compute the shot again, and compare", "Keep"),
    Command("open_replay", ("f7",), "see the newest replay; or drop one here", "Keep"),
    Command("menu", ("l",), "all scenes and presets", "More"),
    Command("next_preset", ("page down", "page up"), "next, previous preset", "More"),
    Command("panel", ("tab",), "the panel of parameters", "More"),
    Command("reset", ("backspace",), "all parameters as in the file", "More"),
    Command("undo", ("ctrl z", "ctrl y"), "undo, redo the last of 200 changes", "More", repeats=True),
    Command("rack", ("b",), "the balls back where they began", "More"),
    Command("sound", ("u",), "sound", "More"),
    Command("text_size", ("alt +", "alt -"), "larger, smaller text", "More"),
    Command("contrast", ("alt c",), "high contrast", "More"),
    Command("cost", ("f3",), "what a frame and a run cost", "More"),
    Command("fullscreen", ("f11",), "full screen", "More"),
    Command("help", ("h",), "all keys", "More"),
    Command("back", ("escape",), "close what is open, stop a run; aim again", "More"),
    Command("quit", ("ctrl q",), "exit", "More"),
    Command("row", ("ctrl down", "ctrl up"), "another row of the panel", "Panel", repeats=True),
    Command("value", ("ctrl right", "ctrl left"), "more, less of it (Shift: finely)", "Panel", repeats=True, fine=True),
    Command("group", ("ctrl page down", "ctrl page up"), "another group", "Panel"),
    Command("row_reset", ("ctrl backspace",), "as in the file", "Panel"),
)
GROUPS = ("Play", "Watch", "See", "Keep", "More", "Panel")
#: Groups with a button on the bar, which opens a list of them.
LISTED = ("See", "Keep", "More")

_BY_NAME = {command.name: command for command in TABLE}
_BY_KEY = {key: (command, by) for command in TABLE for key, by in zip(command.keys, (1, -1), strict=False)}


def _plain(key: str) -> str:
    """A key without its modifier."""
    return key.removeprefix("ctrl ").removeprefix("alt ")


def named(name: str) -> Command:
    """The command of this name."""
    return _BY_NAME[name]


def of_groups(groups: Iterable[str]) -> list[tuple[str, list[Command]]]:
    """The commands that help and lists show, by group."""
    return [(group, [command for command in TABLE if command.group == group and command.meaning]) for group in groups]


def pressed(key: int, modifiers: int) -> tuple[Command, float] | None:
    """The command of a key, and 1, or -1 for its opposite; a tenth of it with Shift if it can be done finely."""
    held = "ctrl " * bool(modifiers & pygame.KMOD_CTRL) + "alt " * bool(modifiers & pygame.KMOD_ALT)
    name = pygame.key.name(key)
    found = _BY_KEY.get(held + SAME.get(name, name))
    if found is None:
        return None
    command, by = found
    return command, 0.1 * by if command.fine and modifiers & pygame.KMOD_SHIFT else by
