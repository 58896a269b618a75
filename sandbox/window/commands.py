"""What each command of the keys, the bar's buttons and its lists does."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from threading import Thread
from typing import Any

import pygame

from sandbox.engine.accuracy import LEVELS
from sandbox.scene import listings
from sandbox.window import aim, export, overlay, replay
from sandbox.window.game import Game
from sandbox.window.keys import LISTED
from sandbox.window.shot import Shot
from sandbox.window.view import View
from sandbox.window.worker import cost_and_errors

#: What can be shown or hidden: the command of the same name switches it.
SWITCHES = ("view", "ghosts", "arrows", "charts", "cost", "help", "tape")
#: One step enlarges the picture by this factor, or moves it by this many px.
ZOOM, PAN = 1.25, 60.0

NO_SHOTS = "no shots yet: pull back and let go"


def do(view: View, command: str, fine: bool = False) -> None:
    """Carry out the command of a key or a button; ``fine`` with Shift."""
    view.changed = True
    if command in NUDGES:
        view.game.nudge(NUDGES[command](view.game, fine))
    elif command in PANEL:
        if view.panel is None:
            view.open_panel(True)
        elif not view.game.trying(lambda: PANEL[command](view.panel, fine)):
            view.panel.refresh(everything=True)
    elif command in SWITCHES:
        if command == "help" and "help" not in view.on:
            view.close_overlays()
        view.on ^= {command}
    else:
        COMMANDS[command](view)


def _watching(view: View, action: str, *arguments: Any) -> None:
    """Call a method of the playback, if a shot is being watched."""
    if view.game.playback is not None:
        getattr(view.game.playback, action)(*arguments)


def _go(view: View) -> None:
    if view.game.playback is None:
        view.game.shoot()
    else:
        view.game.playback.toggle()


def _other_preset(view: View, by: int) -> None:
    names = [listing.name for listing in listings()]
    source = view.game.session.source
    now = names.index(source) if source in names else 0
    view.game.open(names[(now + by) % len(names)])


def _open_list(view: View, group: str) -> None:
    again = view.choices is not None and view.choices.group == group.lower()
    view.close_overlays()
    view.choices = None if again else overlay.Choices(group)


def _menu(view: View) -> None:
    again = view.menu is not None
    view.close_overlays()
    view.menu = None if again else overlay.Menu(list(listings()), view.game.opened)


def _fan(view: View) -> None:
    view.game.fan_wanted = not view.game.fan_wanted


def _accuracy(view: View) -> None:
    """Go to the next level, and report its cost and errors."""
    game, levels = view.game, list(LEVELS)
    level = levels[(levels.index(game.session.value("accuracy.level")) + 1) % len(levels)]
    if game.change({"accuracy.level": level}):
        game.tell(f"accuracy {level} ...")
        result = game.worker.submit(cost_and_errors, game.session.scene)
        game.ask(result, lambda said: game.tell(f"accuracy {level}: {said}"))


def _energy(view: View) -> None:
    """Show the energy chart of the current shot over the picture, or hide it."""
    shot, again = view.game.shot, view.energy is not None
    view.close_overlays()
    if shot is not None and not again:
        view.energy = shot, view.background.submit(_energy_chart, shot, view.area.size)


def _energy_chart(shot: Shot, size: tuple[int, int]) -> pygame.Surface:
    from sandbox.picture.energy import energy_chart

    return energy_chart(shot.run, size)


def _back(view: View) -> None:
    """Close what is open, or stop what is going on."""
    game = view.game
    if view.close_overlays() or (view.panel is not None and view.panel.close_lists()):
        return
    if game.pull is not None:
        game.give_up_pull()
    elif view.tape is not None or "tape" in view.on:
        view.on.discard("tape")
        view.tape = None
    elif not game.stop():
        game.aim_again()


def _sound(view: View) -> None:
    if view.sound is None or not view.sound.there:
        view.game.tell("no sound: there is no sound device")
    else:
        view.sound.on = not view.sound.on
        view.game.tell("sound on" if view.sound.on else "sound off")


def _export(view: View, write: Callable[[], Path]) -> None:
    """Write a file, and say where it is."""
    view.game.trying(lambda: view.game.tell(f"wrote {write()}"))


def _with_shot(view: View, action: Callable[[Shot], object]) -> None:
    """Do something with the shot that is watched, or the last one."""
    game = view.game
    shot = game.shot if game.playback is not None else game.shots[-1] if game.shots else None
    if shot is None:
        game.tell(NO_SHOTS)
    else:
        game.trying(lambda: action(shot))


def _save_replay(view: View, shot: Shot) -> Path:
    path = export.free(view.game.session.title, replay.SUFFIX)
    replay.save(shot, path)
    return path


def _open_replay(view: View) -> None:
    """The newest file of those that the window wrote."""
    found = sorted(export.FOLDER.glob(f"*{replay.SUFFIX}"), key=lambda path: path.stat().st_mtime)
    if found:
        view.game.open(str(found[-1]))
    else:
        view.game.tell(f"no replays in {export.FOLDER} yet")


def _animate(view: View, shot: Shot) -> None:
    if view.exporter is not None and view.exporter.is_alive():
        view.game.tell("the previous animation is still being written")
        return
    view.game.tell("writing the animation ...")
    title = view.game.session.title
    view.exporter = Thread(target=lambda: _export(view, lambda: export.animation(shot, title)), daemon=True)
    view.exporter.start()


def _copy(view: View) -> None:
    command = view.game.session.command()
    try:
        pygame.scrap.put_text(command)
    except pygame.error:  # there is no clipboard
        view.game.tell(command)
    else:
        view.game.tell(f"copied: {command}")


def _zoom(view: View, factor: float) -> None:
    view.zoom(factor, view.at if view.area.collidepoint(view.at) else view.area.center)


def _quit(view: View) -> None:
    view.game.running = False


#: Commands for the panel, which they open if it is closed.
PANEL: dict[str, Callable[[Any, bool], object]] = {
    "row_down": lambda panel, fine: panel.choose(1),
    "row_up": lambda panel, fine: panel.choose(-1),
    "row_more": lambda panel, fine: panel.nudge(1, fine),
    "row_less": lambda panel, fine: panel.nudge(-1, fine),
    "row_reset": lambda panel, fine: panel.reset_row(),
    "group_down": lambda panel, fine: panel.turn(1),
    "group_up": lambda panel, fine: panel.turn(-1),
}

#: Commands that change the aim, finely with Shift: functions from the game to the changes.
NUDGES: dict[str, Callable[[Game, bool], dict[str, Any]]] = {
    "turn_left": lambda game, fine: aim.nudged(game.session, turn=1, fine=fine),
    "turn_right": lambda game, fine: aim.nudged(game.session, turn=-1, fine=fine),
    "stronger": lambda game, fine: aim.nudged(game.session, push=1, fine=fine),
    "weaker": lambda game, fine: aim.nudged(game.session, push=-1, fine=fine),
    "spin_up": lambda game, fine: aim.spun(game.session, 0, 1, fine),
    "spin_down": lambda game, fine: aim.spun(game.session, 0, -1, fine),
    "other_up": lambda game, fine: aim.spun(game.session, 1, 1, fine),
    "other_down": lambda game, fine: aim.spun(game.session, 1, -1, fine),
}

COMMANDS: dict[str, Callable[[View], object]] = {
    "go": _go,
    "again": lambda view: view.game.aim_again(from_rest=True),
    "restart": lambda view: _watching(view, "restart"),
    "step": lambda view: _watching(view, "step", 1),
    "step_back": lambda view: _watching(view, "step", -1),
    "slower": lambda view: _watching(view, "change_rate", -1),
    "faster": lambda view: _watching(view, "change_rate", 1),
    "previous_shot": lambda view: view.game.watch_other(-1),
    "next_shot": lambda view: view.game.watch_other(1),
    "fan": _fan,
    "wider": lambda view: view.game.widen_fan(2.0),
    "narrower": lambda view: view.game.widen_fan(0.5),
    "energy": _energy,
    "accuracy": lambda view: view.game.trying(lambda: _accuracy(view)),
    "zoom_in": lambda view: _zoom(view, ZOOM),
    "zoom_out": lambda view: _zoom(view, 1 / ZOOM),
    "pan_left": lambda view: view.pan(PAN, 0),
    "pan_right": lambda view: view.pan(-PAN, 0),
    "pan_up": lambda view: view.pan(0, PAN),
    "pan_down": lambda view: view.pan(0, -PAN),
    "fit": lambda view: view.look(None),
    "save_scene": lambda view: _export(view, lambda: export.scene_file(view.game.session)),
    "copy": _copy,
    "screenshot": lambda view: _export(view, lambda: export.screenshot(view.canvas, view.game.session.title)),
    "animation": lambda view: _with_shot(view, lambda shot: _animate(view, shot)),
    "save_replay": lambda view: _with_shot(view, lambda shot: _export(view, lambda: _save_replay(view, shot))),
    "compare": lambda view: _with_shot(view, view.game.compare),
    "open_replay": _open_replay,
    "menu": _menu,
    "next_preset": lambda view: _other_preset(view, 1),
    "previous_preset": lambda view: _other_preset(view, -1),
    "panel": lambda view: view.open_panel(not view.panel_wanted),
    "reset": lambda view: view.game.reset(),
    "undo": lambda view: view.game.undo(),
    "rack": lambda view: view.game.begin_again(),
    "sound": _sound,
    "fullscreen": lambda view: view.toggle_full_screen(),
    "back": _back,
    "quit": _quit,
    **{group.lower(): partial(_open_list, group=group) for group in LISTED},
}
