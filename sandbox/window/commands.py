"""What each command does: those of the keys, of the bar's buttons and of its lists."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any

import pygame

from sandbox.engine.accuracy import LEVELS
from sandbox.scene import check, listings
from sandbox.window import aim, fan, keep, overlay, replay
from sandbox.window.keys import LISTED
from sandbox.window.session import Shot

if TYPE_CHECKING:
    from sandbox.window.app import App

#: What is shown or not: each is switched by the command of its name.
SWITCHES = ("view", "ghosts", "fan", "arrows", "charts", "cost", "help", "tape")


def do(app: App, command: str, fine: bool = False) -> None:
    """What a key or a button asks for; ``fine`` with Shift."""
    if command in SWITCHES:
        app.view.on ^= {command}
    elif command in FINE:
        app.change(FINE[command](app, fine))
    elif command in PANEL:
        if app.panel is None:
            app.open_panel(True)
        elif not app.trying(lambda: PANEL[command](app.panel, fine)):
            app.panel.refresh(everything=True)
    else:
        COMMANDS[command](app)


def _watching(app: App, action: str, *arguments: Any) -> None:
    """Something that only a shot that is being watched can do."""
    if app.playback is not None:
        getattr(app.playback, action)(*arguments)


def _go(app: App) -> None:
    if app.playback is None:
        app.shoot()
    else:
        app.playback.toggle()


def _other_shot(app: App, by: int) -> None:
    if not app.session.shots:
        app.tell("no shots yet: pull back from the ball and let go")
        return
    now = app.chosen if app.playback is not None else len(app.session.shots)
    app.watch(min(max(now + by, 0), len(app.session.shots) - 1))


def _other_preset(app: App, by: int) -> None:
    names = [listing.name for listing in listings()]
    now = names.index(app.session.title) if app.session.title in names else 0
    app.open(names[(now + by) % len(names)])


def _open_list(app: App, group: str) -> None:
    opened = app.view.choices
    app.view.choices = None if opened is not None and opened.group == group.lower() else overlay.Choices(group)


def _menu(app: App) -> None:
    app.view.menu = None if app.view.menu is not None else overlay.Menu(list(listings()))


def _spread(app: App, factor: float) -> None:
    """Make the fan wider, and show it."""
    app.fan_width = min(max(app.fan_width * factor, 1 / fan.WIDEST), fan.WIDEST)
    app.view.on.add("fan")


def _accuracy(app: App) -> None:
    """The next level, with what it costs and how far its result is off."""
    levels = list(LEVELS)
    level = levels[(levels.index(app.session.value("accuracy.level")) + 1) % len(levels)]
    if not app.change({"accuracy.level": level}):
        return
    app.settle()
    if app.shot is None:
        return
    checked = check(app.shot.scene, app.shot.run)
    units = app.shot.scene.units
    errors = [f"{name} ± {error:.1g} {units.get(name, '')}" for name, error in checked.errors.items() if error > 0]
    changed = [f"{name} would be {finer}" for name, (_, finer) in checked.changed.items()]
    changed += [f"{name} is chaotic" for name in (*checked.chaotic, *checked.unsettled)]
    told = ", ".join(text.strip() for text in changed or errors[:4]) or "no difference to a finer run"
    told = told.replace("_", " ")
    app.tell(f"accuracy {level}: {1e3 * app.shot.run.numerics.wall_s:.1f} ms a run; {told}")


def _energy(app: App) -> None:
    """The energy of the shot that is shown, over the picture; or not any more."""
    from sandbox.picture.energy import energy_chart

    view, shot = app.view, app.shot
    if view.energy is not None or shot is None:
        view.energy = None
    else:
        view.energy = shot, energy_chart(shot.run, app.area.size)


def _back(app: App) -> None:
    """Close what is open, or stop what is going on."""
    view = app.view
    if view.menu is not None or view.choices is not None:
        view.menu = view.choices = None
    elif "help" in view.on or view.energy is not None:
        view.on.discard("help")
        view.energy = None
    elif app.pointer.pull is not None:
        app.pointer.give_up()
    elif app.pointer.tape is not None:
        view.on.discard("tape")
        app.pointer.tape = None
    else:
        app.back_to_aiming()


def _rack(app: App) -> None:
    if app.session.laid:
        app.begin_again()
    else:
        app.tell("the balls are where they began")


def _sound(app: App) -> None:
    if app.sound is not None:
        app.sound.on = not app.sound.on
        app.tell("sound on" if app.sound.on else "sound off")


def _full_screen(app: App) -> None:
    """The whole display, or the window again as it was."""
    if pygame.display.is_fullscreen():
        pygame.display.set_mode(app.windowed, pygame.RESIZABLE)
    else:
        app.windowed = app.laid_out
        pygame.display.set_mode((0, 0), pygame.FULLSCREEN)
    app.resized()


def _keep(app: App, write: Callable[[], Path]) -> None:
    """Write a file, and say where it is."""
    app.trying(lambda: app.tell(f"wrote {write()}"))


def _with_shot(app: App, action: Callable[[Shot], object]) -> None:
    """Do something with the shot that is watched, or the last."""
    shots = app.session.shots
    if shots:
        app.trying(lambda: action(shots[app.chosen]))
    else:
        app.tell("no shots yet: pull back from the ball and let go")


def _save_replay(app: App, shot: Shot) -> Path:
    path = keep.free(app.session.title, replay.SUFFIX)
    replay.save(shot, app.session.source, path)
    return path


def _open_replay(app: App) -> None:
    """The newest file of those that the window wrote."""
    found = sorted(keep.FOLDER.glob(f"*{replay.SUFFIX}"), key=lambda path: path.stat().st_mtime)
    if found:
        app.open(str(found[-1]))
    else:
        app.tell(f"no replays in {keep.FOLDER} yet")


def _animate(app: App, shot: Shot) -> None:
    if app.writer is not None and app.writer.is_alive():
        app.tell("the animation before is still being written")
        return
    app.tell("writing the animation ...")
    title = app.session.title
    app.writer = Thread(target=lambda: _keep(app, lambda: keep.animation(shot, title)), daemon=True)
    app.writer.start()


def _copy(app: App) -> None:
    command = app.session.command()
    try:
        pygame.scrap.put_text(command)
    except pygame.error:  # there is no clipboard
        app.tell(command)
    else:
        app.tell(f"copied: {command}")


def _quit(app: App) -> None:
    app.running = False


#: Commands for the panel, which is opened first.
PANEL: dict[str, Callable[[Any, bool], object]] = {
    "row_down": lambda panel, fine: panel.choose(1),
    "row_up": lambda panel, fine: panel.choose(-1),
    "row_more": lambda panel, fine: panel.nudge(1, fine),
    "row_less": lambda panel, fine: panel.nudge(-1, fine),
    "row_reset": lambda panel, fine: panel.reset_row(),
    "group_down": lambda panel, fine: panel.turn(1),
    "group_up": lambda panel, fine: panel.turn(-1),
}

#: Commands that change the shot, finely with Shift: from the window to the changes.
FINE: dict[str, Callable[[App, bool], dict[str, Any]]] = {
    "turn_left": lambda app, fine: aim.nudged(app.session, turn=1, fine=fine),
    "turn_right": lambda app, fine: aim.nudged(app.session, turn=-1, fine=fine),
    "stronger": lambda app, fine: aim.nudged(app.session, push=1, fine=fine),
    "weaker": lambda app, fine: aim.nudged(app.session, push=-1, fine=fine),
    "spin_up": lambda app, fine: aim.spun(app.session, 0, 1, fine),
    "spin_down": lambda app, fine: aim.spun(app.session, 0, -1, fine),
    "other_up": lambda app, fine: aim.spun(app.session, 1, 1, fine),
    "other_down": lambda app, fine: aim.spun(app.session, 1, -1, fine),
}

COMMANDS: dict[str, Callable[[App], object]] = {
    "go": _go,
    "again": lambda app: app.back_to_aiming(goes_on=True),
    "restart": lambda app: _watching(app, "restart"),
    "step": lambda app: _watching(app, "step", 1),
    "step_back": lambda app: _watching(app, "step", -1),
    "slower": lambda app: _watching(app, "change_rate", -1),
    "faster": lambda app: _watching(app, "change_rate", 1),
    "previous_shot": lambda app: _other_shot(app, -1),
    "next_shot": lambda app: _other_shot(app, 1),
    "wider": lambda app: _spread(app, 2.0),
    "narrower": lambda app: _spread(app, 0.5),
    "energy": lambda app: app.trying(lambda: _energy(app)),
    "accuracy": lambda app: app.trying(lambda: _accuracy(app)),
    "save_scene": lambda app: _keep(app, lambda: keep.scene_file(app.session)),
    "copy": _copy,
    "screenshot": lambda app: _keep(app, lambda: keep.screenshot(app.canvas, app.session.title)),
    "animation": lambda app: _with_shot(app, lambda shot: _animate(app, shot)),
    "save_replay": lambda app: _with_shot(app, lambda shot: _keep(app, lambda: _save_replay(app, shot))),
    "compare": lambda app: _with_shot(app, lambda shot: app.tell(replay.compared(shot))),
    "open_replay": _open_replay,
    "menu": _menu,
    "next_preset": lambda app: _other_preset(app, 1),
    "previous_preset": lambda app: _other_preset(app, -1),
    "panel": lambda app: app.open_panel(not app.has_panel),
    "reset": lambda app: app.reset(),
    "rack": _rack,
    "sound": _sound,
    "fullscreen": _full_screen,
    "back": _back,
    "quit": _quit,
    **{group.lower(): partial(_open_list, group=group) for group in LISTED},
}
