"""Commands in one table: keys, the bar's buttons, its lists, the help and hints are made from it."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import pygame

from sandbox.window import actions, keeping
from sandbox.window.menu import Menu
from sandbox.window.overlay import Board, Row
from sandbox.window.prediction import Prediction
from sandbox.window.shown import LABORATORY
from sandbox.window.view import View


class _Command(NamedTuple):
    """A command with its key, or two keys: the second does the opposite of the first."""

    name: str
    keys: tuple[str, ...]  # as named by pygame, after "ctrl " or "alt "
    meaning: str
    group: str
    do: Callable[[View, float], object] | None = None  # so much of it; None: it switches its name on or off
    mouse: str = ""  # how the mouse does the same
    repeats: bool = False  # while the key is held
    fine: bool = False  # a tenth with Shift

    @property
    def keys_text(self) -> str:
        """Keys and mouse, for people."""
        held = next((held for held in _HELD if self.keys[0].startswith(held)), "")
        names = [key.removeprefix(held) for key in self.keys]
        words = [_SHORT.get(name, name.upper() if len(name) == 1 else name) for name in names]
        keys = " ".join([*filter(None, [held.strip().capitalize()]), *words])
        return ", ".join(filter(None, (keys, self.mouse)))


#: Modifiers that are part of a key's name here.
_HELD = ("ctrl ", "alt ")
#: Shorter names than pygame's, and keys that do the same as others.
_SHORT = {"page down": "PgDn", "page up": "PgUp", "return": "Enter", "escape": "Esc", "space": "Space", "tab": "Tab",
         "backspace": "Backspace", **{f"f{number}": f"F{number}" for number in range(1, 13)}}  # fmt: skip
_SAME = {"=": "+", "[+]": "+", "[-]": "-", "[0]": "0", "enter": "return", "f1": "h"}


def _name_of(key: int, modifiers: int) -> str:
    """The name of a pressed key in a command's ``keys``."""
    held = "ctrl " * bool(modifiers & pygame.KMOD_CTRL) + "alt " * bool(modifiers & pygame.KMOD_ALT)
    name = pygame.key.name(key)
    return held + _SAME.get(name, name)


def do(view: View, command: str, by: float = 1) -> None:
    """Carry out a command; "-" before its name, or a negative ``by``, means its opposite."""
    view.changed = True
    name = command.removeprefix("-")
    if name in HINTS:
        _list(view, name)
        return
    found, shown = _BY_NAME[name], view.shown
    if name in _OF_LAB and view.game.referee.contest is None and not shown.in_lab:
        view.game.memory.lab = True
        if name in shown.on:
            shown.remember()
            return
    if view.game.referee.contest is not None:
        aiming = view.game.watching.playback is None
        fixed = name in FIXED or (name in {"lab", *_OF_LAB} and not view.game.referee.contest.takes_marks)
        if fixed or (name in GIVE_AWAY and aiming):
            view.game.messages.tell("not while you play for something" if fixed else "not before the shot")
            return
    if found.do is None:
        shown.on ^= {name}
        if name in _OF_LAB:
            shown.remember()
        view.lay_out()
    elif found.group == "Panel" and not shown.has_panel:
        do(view, "panel")
    else:
        found.do(view, by if name == command else -by)


def _rows(view: View, group: str) -> list[Row]:
    """The commands of a group, each with its key."""
    meanings = {"accuracy": f"accuracy: {view.game.session.value('accuracy.level')}, and the next",
                "predict": f"path while aiming: {view.shown.ahead}, and the next"}  # fmt: skip
    return [
        Row(it.name, meanings.get(it.name, it.meaning), it.keys_text)
        for it in TABLE
        if it.meaning and it.group == group
    ]


def _list(view: View, name: str) -> None:
    """The commands of a group, above its button; several can be switched in turn."""
    rows, button = _rows(view, name.capitalize()), view.screen.bar.places[name]
    actions.toggle(view, name, lambda: Board(rows, partial(do, view), button, stays=name == "see"))


def _help(view: View, by: float) -> None:
    """All commands with their keys."""
    groups = {group: _rows(view, group) for group in GROUPS}
    actions.toggle(view, "help", lambda: Menu("Keys", groups, partial(do, view)))


# fmt: off
#: Every command; keys, help, lists and the hints of the bar are made from it.
TABLE: tuple[_Command, ...] = (
    _Command("go", ("space",), "shoot; pause, resume", "Play", actions.go, mouse="pull back (Shift: finely), let go"),
    _Command("again", ("return",), "aim again (billiards: next shot)", "Play",
            lambda view, by: view.game.aiming.again(from_rest=True)),
    _Command("turn", ("left", "right"), "turn the shot (Shift: finely)", "Play",
            actions.turn, repeats=True, fine=True),
    _Command("push", ("up", "down"), "stronger, weaker (Shift: finely)", "Play",
            actions.push, repeats=True, fine=True),
    _Command("spin", ("e", "d"), "spin (Shift: finely)", "Play",
            lambda view, by: actions.spin(view, 0, by), mouse="wheel", repeats=True, fine=True),
    _Command("other_spin", ("x", "z"), "second spin, if any", "Play",
            lambda view, by: actions.spin(view, 1, by), mouse="Shift wheel", repeats=True, fine=True),
    _Command("handle", ("k", "i"), "select the next handle; arrows move it, Esc lets go", "Play",
            actions.pick, mouse="drag it"),
    _Command("pad", ("2",), "set spin on a ball, or where the (level) cue's tip hits", "Play", mouse="drag on it"),
    _Command("restart", ("r",), "from the start", "Watch", lambda view, by: actions.with_playback(view, "restart")),
    _Command("step", (".", ","), "one step on, back", "Watch",
            lambda view, by: actions.with_playback(view, "step", int(by)), repeats=True),
    _Command("faster", ("+", "-"), "faster to 8, slower to 1/16", "Watch",
            lambda view, by: actions.with_playback(view, "change_rate", int(by))),
    _Command("next_shot", ("n", "p"), "next, previous shot", "Watch",
            lambda view, by: view.game.watching.watch_other(int(by))),
    _Command("shots", ("q",), "table of shots: sort, pin, delete, CSV, statistics", "See", actions.open_shots),
    _Command("find", ("/",), "find a shot: at the rim, a pocket, the pin ...", "See", actions.find_shots),
    _Command("view", ("v",), "the camera goes with the shot", "See", actions.switch_camera),
    _Command("predict", ("y",), "path while aiming: all, to the first contact, a metre, nothing", "See",
            actions.show_ahead),
    _Command("ghosts", ("g",), "earlier shots", "See"),
    _Command("fan", ("f",), "fan: 100 similar shots, how many score", "See"),
    _Command("wider", ("]", "["), "a wider, narrower fan", "See", actions.widen_fan),
    _Command("map", ("m",), "map: which speeds and angles score", "See"),
    _Command("zoom", ("ctrl +", "ctrl -"), "larger, smaller", "See", actions.zoom,
            mouse="Ctrl wheel, pinch", repeats=True),
    _Command("pan_across", ("alt left", "alt right"), "move the picture", "See",
            lambda view, by: view.viewpoint.pan(actions.PAN * by, 0), mouse="Ctrl drag, two fingers", repeats=True),
    _Command("pan_down", ("alt up", "alt down"), "", "See",
            lambda view, by: view.viewpoint.pan(0, actions.PAN * by), repeats=True),
    _Command("fit", ("ctrl 0",), "see all of the shot", "See", lambda view, by: view.viewpoint.look(None)),
    _Command("lab", ("4",), "laboratory: clock, forces, arrows, charts, tape", "See",
            lambda view, by: view.shown.switch_lab()),
    _Command("arrows", ("o",), "arrows: velocity and forces", "See"),
    _Command("charts", ("w",), "charts over time", "See"),
    _Command("graphs", ("alt w",), "charts over time, large, with earlier shots", "See", actions.open_graphs),
    _Command("energy", ("j",), "where the energy goes", "See", actions.open_energy),
    _Command("tape", ("t",), "tape; arrows move its end, K the other", "See", actions.lay_tape, mouse="right drag"),
    _Command("accuracy", ("a",), "accuracy: fast, balanced, precise", "See",
            lambda view, by: view.game.messages.reporting_errors(lambda: actions.next_accuracy(view, by))),
    _Command("save_scene", ("s",), "a scene file with what was changed", "Keep",
            keeping.save_scene),
    _Command("copy", ("c",), "copy the command line of this shot", "Keep", keeping.copy_command),
    _Command("screenshot", ("f12",), "picture of the window", "Keep", keeping.screenshot),
    _Command("animation", ("f9",), "animation of the last shot", "Keep",
            lambda view, by: keeping.with_shot(view, partial(keeping.animate, view))),
    _Command("page", ("f8",), "page of the task, each shot as a replay", "Keep", keeping.write_page),
    _Command("save_replay", ("f5",), "replay file of the last shot", "Keep",
            lambda view, by: keeping.with_shot(view, partial(keeping.save_replay, view))),
    _Command("compare", ("f6",), "compute the shot again, and compare", "Keep",
            lambda view, by: keeping.with_shot(view, view.game.watching.compare)),
    _Command("open_replay", ("f7",), "open the latest replay; or drop one here", "Keep", keeping.open_replay),
    _Command("front", ("1",), "first screen: tasks, games for two", "Play", actions.open_front),
    _Command("mark", ("3",), "predict first: mark where it lands, then see", "Play",
            lambda view, by: view.game.referee.begin(Prediction(view.game.session.scene))),
    _Command("menu", ("l",), "all scenes and presets", "More", actions.open_menu),
    _Command("next_preset", ("page down", "page up"), "next, previous preset; next task", "More", actions.other_preset),
    _Command("panel", ("tab",), "the panel of parameters", "More"),
    _Command("reset", ("backspace",), "all parameters as in the file", "More",
            lambda view, by: view.game.aiming.reset()),
    _Command("undo", ("ctrl z", "ctrl y"), "undo, redo the last of 200 changes", "More",
            lambda view, by: view.game.aiming.undo() if by > 0 else view.game.aiming.redo(), repeats=True),
    _Command("rack", ("b",), "put the balls back", "More", lambda view, by: view.game.aiming.begin_again()),
    _Command("sound", ("u",), "sound", "More", actions.switch_sound),
    _Command("text_size", ("alt +", "alt -"), "larger, smaller text", "More", actions.change_text_size),
    _Command("contrast", ("alt c",), "high contrast", "More",
            lambda view, by: view.set_look(view.game.memory.look[0], not view.game.memory.look[1])),
    _Command("calm", ("5",), "confetti and nets that bulge, or neither", "More", actions.switch_confetti),
    _Command("cost", ("f3",), "what a frame and a run cost", "More"),
    _Command("fullscreen", ("f11",), "full screen", "More", lambda view, by: view.toggle_full_screen()),
    _Command("help", ("h",), "all keys", "More", _help),
    _Command("back", ("escape",), "close what is open, stop a run; aim again", "More", actions.back),
    _Command("quit", ("ctrl q",), "exit", "More", lambda view, by: setattr(view.game, "running", False)),
    _Command("row", ("ctrl down", "ctrl up"), "next, previous row", "Panel",
            lambda view, by: view.panel.step(int(by)), repeats=True),
    _Command("value", ("ctrl right", "ctrl left"), "increase, decrease (Shift: finely)", "Panel",
            lambda view, by: view.panel.nudge(by), repeats=True, fine=True),
    _Command("group", ("ctrl page down", "ctrl page up"), "another group", "Panel",
            lambda view, by: view.panel.turn(int(by))),
    _Command("row_reset", ("ctrl backspace",), "as in the file", "Panel", lambda view, by: view.panel.reset_row()),
)
# fmt: on
#: What would tell how a shot comes out before it is made: not while a contest is aimed; and what changes
#: the contest, or would write only a part of it.
GIVE_AWAY = frozenset(("predict", "fan", "wider", "map", "charts", "graphs", "energy", "compare"))
#: What belongs to the laboratory, and opens it.
_OF_LAB = frozenset((*LABORATORY, "graphs", "energy"))
FIXED = frozenset(("find", "accuracy", "reset", "rack", "undo", "save_scene", "copy"))
GROUPS: tuple[str, ...] = tuple(dict.fromkeys(command.group for command in TABLE))
#: What the bar's buttons say that open a list of a group of commands; its others say what the help does.
HINTS = {
    "see": "what is shown: fan, map, arrows, charts, tape, accuracy",
    "keep": "pictures, replays, scene files",
    "more": "scenes, sound, full screen",
}
_BY_NAME = {command.name: command for command in TABLE}
_BY_KEY = {key: (command, by) for command in TABLE for key, by in zip(command.keys, (1, -1), strict=False)}


def pressed(key: int, modifiers: int) -> tuple[_Command, float] | None:
    """The command of a key, and 1, or -1 for its opposite; a tenth of it with Shift if it can be done finely."""
    command, by = _BY_KEY.get(_name_of(key, modifiers), (None, 0.0))
    if command is None:
        return None
    return command, 0.1 * by if command.fine and modifiers & pygame.KMOD_SHIFT else by


def hint_of(button: str) -> str:
    """The meaning of a button of the bar, and its key; one with a minus does the opposite of its command."""
    if button in HINTS:
        return HINTS[button]
    command = _BY_NAME[button.removeprefix("-")]
    return f"{command.meaning} ({command.keys_text})"
