"""Commands in one table: their keys, and what keys, the bar's buttons and its lists do."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pygame

from sandbox.engine.model.accuracy import LEVELS
from sandbox.picture.energy_chart import energy_chart
from sandbox.picture.frames import save_png
from sandbox.picture.graph import graph
from sandbox.picture.palette import palette
from sandbox.scene import listings, listings_in
from sandbox.window import aim, export, replay
from sandbox.window.contest import AtTask
from sandbox.window.find import Found, Question, find, questions, said_range
from sandbox.window.front import Entry, Front, begin
from sandbox.window.measure import Tape
from sandbox.window.menu import Menu
from sandbox.window.overlay import Board, Chart, Choice, Overlay, PictureChoice, Row
from sandbox.window.prediction import Prediction
from sandbox.window.shots import Played, Shot, write_csv
from sandbox.window.table import Table
from sandbox.window.view import View
from sandbox.window.worker import cost_and_errors, unpacked

CARD = palette("card")
#: How much larger than usual letters can be.
TEXT_SIZES = (1.0, 1.15, 1.3, 1.5)
#: Earlier shots in the graphs over time.
MOST_GRAPHS = 5
#: One step enlarges the picture by this factor, or moves it by this many px.
ZOOM, PAN = 1.25, 60.0
#: One step moves the end of the tape by this many px.
STEP = 12.0

#: The group of the menu that has a tile for each scene.
SPORTS = "sports"
NO_SHOTS = "no shots yet: pull back and let go"


class Command(NamedTuple):
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
    """The name of a pressed key in a command's ``keys``."""
    held = "ctrl " * bool(modifiers & pygame.KMOD_CTRL) + "alt " * bool(modifiers & pygame.KMOD_ALT)
    name = pygame.key.name(key)
    return held + SAME.get(name, name)


def do(view: View, command: str, by: float = 1) -> None:
    """Carry out a command; "-" before its name, or a negative ``by``, means its opposite."""
    view.changed = True
    name = command.removeprefix("-")
    if name in HINTS:
        _list(view, name)
        return
    found = _BY_NAME[name]
    if view.game.referee.contest is not None:
        aiming = view.game.watching.playback is None
        if name in FIXED or (name in GIVE_AWAY and aiming):
            view.game.messages.tell("not while you play for something" if name in FIXED else "not before the shot")
            return
    if found.do is None:
        view.shown.on ^= {name}
        view.lay_out()
    elif found.group == "Panel" and not view.shown.has_panel:
        do(view, "panel")
    else:
        found.do(view, by if name == command else -by)


# Play and watch


def _watching(view: View, action: str, *arguments: Any) -> None:
    """Call a method of the playback, if a shot is being watched."""
    if view.game.watching.playback is not None:
        getattr(view.game.watching.playback, action)(*arguments)


def _go(view: View, by: float) -> None:
    game = view.game
    playback, live = game.watching.playback, bool(game.session.controls.held)
    if playback is None or (live and playback.over):
        game.grasp.let_go()
        game.aiming.shoot()
    else:
        playback.toggle()


def _pick(view: View, by: float) -> None:
    """Take hold of the next handle by key, or of the other end of the tape."""
    if view.shown.tape is not None and "tape" in view.shown.on:
        view.shown.tape = Tape(view.shown.tape.end, view.shown.tape.start)
        return
    if not view.targets.pick(int(by)):
        watched = " while a shot is watched" * (view.game.watching.playback is not None)
        view.game.messages.tell(f"there is nothing to move{watched}")


def _move(view: View, across: float, up: float) -> bool:
    """Move the tape's end or what was picked by key; returns whether there is anything."""
    camera = view.viewpoint.camera
    if view.shown.tape is not None and "tape" in view.shown.on and camera is not None:
        x, y = camera.pixel(*view.shown.tape.end)
        view.shown.tape = Tape(view.shown.tape.start, camera.world(x + STEP * across, y - STEP * up))
        return True
    handle = view.targets.picked
    if handle is None:
        return False
    step, (x, y) = handle.step(snap=True), handle.grip.place
    to, least = (x + step * across, y + step * up), step * (abs(across) + abs(up))
    view.game.aiming.set(handle.grip.changes(to, least))
    return True


def _with_shot(view: View, action: Callable[[Shot], object]) -> None:
    """Do something with the shot that is watched, or the last one."""
    game = view.game
    shot = game.shot if game.watching.playback is not None else game.shots.paths[-1] if game.shots.paths else None
    if shot is None:
        game.messages.tell(NO_SHOTS)
    else:
        game.messages.reporting_errors(lambda: action(shot))


# See


def _open(view: View, name: str, make: Callable[[], Overlay]) -> None:
    """Open an overlay, or close it if it is open."""
    view.shown.open(None if view.shown.overlay is not None and view.shown.overlay.name == name else make())
    if view.shown.overlay is not None:
        view.shown.overlay.name = name


def _rows(view: View, group: str) -> list[Row]:
    """The commands of a group, each with its key."""
    meanings = {"accuracy": f"accuracy: {view.game.session.value('accuracy.level')}, and the next",
                "predict": f"path while aiming: {view.shown.ahead}, and the next"}  # fmt: skip
    return [
        Row(it.name, meanings.get(it.name, it.meaning), it.shown) for it in TABLE if it.meaning and it.group == group
    ]


def _list(view: View, name: str) -> None:
    """The commands of a group, above its button; several can be switched in turn."""
    rows, button = _rows(view, name.capitalize()), view.screen.bar.places[name]
    _open(view, name, lambda: Board(rows, partial(do, view), button, stays=name == "see"))


def _shots(view: View, by: float) -> None:
    """The table of the shots of this scene."""
    game, stage = view.game, view.stages.latest

    def played() -> list[Played]:
        return [row for row in game.shots.rows if row.start[:2] == (game.session.base.folder, game.session.source)]

    if not played():
        game.messages.tell(NO_SHOTS)
    elif stage is not None:
        _open(view, "shots", lambda: Table(played, partial(_with_row, view, played), stage.colour_of))


def _with_row(view: View, played: Callable[[], list[Played]], action: str, row: Played) -> None:
    """An action of the table of shots."""
    game = view.game
    match action:
        case "aim as it":
            game.aiming.aim_as(row)
        case "pin":
            game.watching.pin(row)
        case "delete":
            game.shots.rows.remove(row)
        case "csv":
            _export(view, ".csv", partial(write_csv, played()), "-shots")


def _find(view: View, by: float) -> None:
    """Find shots: at what, if there is a choice, and then which."""
    game, shot = view.game, view.game.shot
    game.aiming.again()
    asked = questions(game.session, shot is None or shot.upright)
    if not asked:
        game.messages.tell("this scene defines no scoring")
    elif len(asked) == 1:
        _find_one(view, asked[0])
    else:
        names = {question.name: question for question in asked}

        def marks() -> list[PictureChoice]:
            stage, places = view.stages.latest, [(q.name, q.at) for q in asked if q.at is not None]
            if stage is None:
                return []
            return [PictureChoice(name, np.array([stage.camera.pixel(*at)]), "", CARD["text"]) for name, at in places]

        rows = [Row(name, name) for name in names]
        foot = view.screen.bar.places["see"]
        _open(view, "find", lambda: Choice("aim at ...", rows, lambda name: _find_one(view, names[name]), foot, marks))


def _find_one(view: View, question: Question) -> None:
    """Look for shots at something, and offer them."""
    game, changes = view.game, view.game.session.changes
    ranges = said_range(question, game.session)

    def then(found: list[Found]) -> None:
        if changes.source != game.session.source:
            return
        if not found:
            game.messages.tell(f"no shot at {question.name} was found with {ranges}")
            return
        shots = [Shot(each.scene, unpacked(each.scene, each.run), number=i) for i, each in enumerate(found, 1)]

        def marks() -> list[PictureChoice]:
            stage = view.stages.latest
            return [] if stage is None else [
                PictureChoice(str(shot.number), stage.line(shot), str(shot.number), stage.colour_of(shot.number))
                for shot in shots]  # fmt: skip

        def choose(number: str) -> None:
            game.aiming.change(found[int(number) - 1].values)

        rows = [Row(str(i), f"{i}   {each.said}") for i, each in enumerate(found, 1)]
        foot, title = view.screen.bar.places["see"], f"shots at {question.name}, the most forgiving first"
        if game.session.controls.scores:
            view.shown.on.add("map")
        _open(view, "found", lambda: Choice(title, rows, choose, foot, marks))

    work = game.workers.helper.submit(find, game.session.scene, question.goals)
    game.jobs.ask(work, then, f"looking for shots at {question.name} with {ranges} ...; Esc stops it")


def _menu(view: View, by: float) -> None:
    """All scenes as tiles; each with its presets, after those opened last and the user's own."""
    game = view.game
    groups: dict[str, list[Row]] = {}
    for item in listings():
        groups.setdefault(item.name.partition("/")[0], []).append(Row(item.name, item.name, "", item.about))
    known = {row.action: row for rows in groups.values() for row in rows}
    own = [Row(item.name, item.name, "", item.about) for item in listings_in(Path())]
    opened = [known.get(source, Row(source, Path(source).name, "", source)) for source in game.memory.recent]
    sports = [Row(name, name, "", rows[0].about) for name, rows in groups.items()]
    firsts = {SPORTS: sports, "recent": opened, "in this folder": own}
    groups = {**{name: rows for name, rows in firsts.items() if rows}, **groups}

    now = game.session.source.partition("/")[0]
    _open(view, "menu", lambda: Menu("Choose a scene", groups, game.opening.open, now, view.thumbnails.of, SPORTS))


def _front(view: View, by: float) -> None:
    """The tiles of all sports, each with its tasks and games."""
    _open(view, "front", lambda: Front(partial(begin, view.game), view.game.best))


def _chart(view: View, name: str, draw: Callable[[Shot, tuple[int, int]], pygame.Surface]) -> None:
    """A chart of the current shot over picture and panel, drawn in the background."""
    shot, size = view.game.shot, (view.screen.canvas.get_width(), view.screen.area.height)
    if shot is not None:
        _open(view, name, lambda: Chart(view.background.submit(draw, shot, size)))


def _graphs(view: View, by: float) -> None:
    """The graphs of the current shot with the earlier ones that began from the same place."""
    shot = view.game.shot
    earlier = view.game.shots.earlier(shot.start, but=shot) if shot is not None else []
    others = {f"shot {other.number}": other.run for other in earlier[::-1][:MOST_GRAPHS] if other.number}
    _chart(view, "graphs", lambda shot, size: graph(shot.run, size, others))


def _zoom(view: View, by: float) -> None:
    """Zoom around the mouse, or the middle of the picture."""
    view.viewpoint.zoom(ZOOM**by, view.targets.mouse if view.targets.on_picture else view.screen.area.center)


def _wider(view: View, by: float) -> None:
    view.shown.widen_fan(2.0**by)


def _predict(view: View, by: float) -> None:
    """Show more or less of the path while aiming."""
    view.shown.show_more_ahead()
    view.game.messages.tell(f"path while aiming: {view.shown.ahead}")


def _tape(view: View, by: float) -> None:
    """Lay the tape from the ball, to be dragged or moved by key; or put it away."""
    shot, camera, playback = view.game.shot, view.viewpoint.camera, view.game.watching.playback
    view.shown.on ^= {"tape"}
    view.shown.tape = None
    if "tape" in view.shown.on and shot is not None and camera is not None:
        x, y, *_ = shot.run.state(shot.ball, playback.t if playback is not None else 0.0)
        view.shown.tape = Tape((x, y), camera.world(*view.screen.area.center))


def _accuracy(view: View, by: float) -> None:
    """Go to the next level, and report its cost and errors."""
    game, levels = view.game, list(LEVELS)
    level = levels[(levels.index(game.session.value("accuracy.level")) + 1) % len(levels)]
    if game.aiming.change({"accuracy.level": level}):
        game.messages.tell(f"accuracy {level} ...")
        result = game.workers.helper.submit(cost_and_errors, game.session.scene)
        game.jobs.ask(result, lambda said: game.messages.tell(f"accuracy {level}: {said}"))


def _back(view: View, by: float) -> None:
    """Close what is open, or stop what is going on."""
    game = view.game
    if view.shown.overlay is not None:
        view.shown.open(None)
    elif game.grasp.holds:
        game.grasp.cancel()
        view.viewpoint.release()
    elif view.targets.picked_keys is not None:
        view.targets.picked_keys = None
    elif view.shown.tape is not None or "tape" in view.shown.on:
        view.shown.put_tape_away()
    elif not game.jobs.stop() and not game.stop():
        if game.referee.contest is not None and game.watching.playback is None:
            _front(view, 1)
        else:
            game.aiming.again()


def _sound(view: View, by: float) -> None:
    if view.sound is None or not view.sound.there:
        view.game.messages.tell("no sound: there is no sound device")
    else:
        view.sound.on = not view.sound.on
        view.game.messages.tell("sound on" if view.sound.on else "sound off")


# Keep


def _export(view: View, suffix: str, write: Callable[[Path], object], about: str = "") -> None:
    """Write a new file, and say where it is."""
    stem, messages = view.game.session.title + about, view.game.messages
    messages.reporting_errors(lambda: messages.tell(f"wrote {export.new_file(stem, suffix, write)}"))


def _save_scene(view: View) -> None:
    game = view.game
    game.messages.reporting_errors(lambda: game.messages.tell(f"wrote {export.scene_file(game.session)}"))


def _screenshot(view: View, by: float) -> None:
    view.draw()  # without the list that this may have been chosen from
    _export(view, ".png", partial(save_png, view.screen.canvas))


def _open_replay(view: View, by: float) -> None:
    """The newest file of those that the window wrote."""
    found = sorted(export.FOLDER.glob(f"*{replay.SUFFIX}"), key=lambda path: path.stat().st_mtime)
    if found:
        view.game.opening.open(str(found[-1]))
    else:
        view.game.messages.tell(f"no replays in {export.FOLDER} yet")


def _animate(view: View, shot: Shot) -> None:
    game = view.game
    work = view.writer.submit(export.new_file, game.session.title, ".gif", partial(export.animate, shot))
    game.jobs.ask(work, lambda path: game.messages.tell(f"wrote {path}"), "writing the animation ...")


def _page(view: View, by: float) -> None:
    """A page of each player's attempts at the task, each shot as a replay."""
    game, contest, page_of = view.game, view.game.referee.contest, view.page_of
    if not isinstance(contest, AtTask) or page_of is None:
        game.messages.tell("a page is made of a task that is played")
        return
    if not game.referee.shots:
        game.messages.tell(NO_SHOTS)
        return
    for session in contest.sessions:
        work = view.writer.submit(export.new_file, contest.title, ".html", partial(export.page, page_of, session))
        game.jobs.ask(work, lambda path: game.messages.tell(f"wrote {path}"), "writing the page ...")


def _copy(view: View, by: float) -> None:
    command = view.game.session.command()
    try:
        pygame.scrap.put_text(command)
    except pygame.error:  # there is no clipboard
        view.game.messages.tell(command)
    else:
        view.game.messages.tell(f"copied: {command}")


# More


def _other_preset(view: View, by: float) -> None:
    contest = view.game.referee.contest
    if contest is not None and contest.following and by > 0:
        begin(view.game, Entry("task", contest.following))
        return
    names = [listing.name for listing in listings()]
    source = view.game.session.source
    now = names.index(source) if source in names else 0
    view.game.opening.open(names[(now + int(by)) % len(names)])


def _text_size(view: View, by: float) -> None:
    larger, contrast = view.game.memory.look
    place = min(range(len(TEXT_SIZES)), key=lambda i: abs(TEXT_SIZES[i] - larger)) + int(by)
    view.set_look(TEXT_SIZES[min(max(place, 0), len(TEXT_SIZES) - 1)], contrast)


# fmt: off
#: Every command; keys, help, lists and the hints of the bar are made from it.
TABLE: tuple[Command, ...] = (
    Command("go", ("space",), "shoot; pause, resume", "Play", _go, mouse="pull back (Shift: finely), let go"),
    Command("again", ("return",), "aim again (billiards: next shot)", "Play",
            lambda view, by: view.game.aiming.again(from_rest=True)),
    Command("turn", ("left", "right"), "turn the shot (Shift: finely)", "Play",
            lambda view, by: _move(view, -by, 0) or view.game.aiming.nudge(aim.nudged(view.game.session, turn=by)),
            repeats=True, fine=True),
    Command("push", ("up", "down"), "stronger, weaker (Shift: finely)", "Play",
            lambda view, by: _move(view, 0, by) or view.game.aiming.nudge(aim.nudged(view.game.session, push=by)),
            repeats=True, fine=True),
    Command("spin", ("e", "d"), "spin (Shift: finely)", "Play",
            lambda view, by: view.game.aiming.nudge(aim.spun(view.game.session, 0, by)),
            mouse="wheel", repeats=True, fine=True),
    Command("other_spin", ("x", "z"), "second spin, if any", "Play",
            lambda view, by: view.game.aiming.nudge(aim.spun(view.game.session, 1, by)),
            mouse="Shift wheel", repeats=True, fine=True),
    Command("handle", ("k", "i"), "select the next handle; arrows move it, Esc lets go", "Play",
            _pick, mouse="drag it"),
    Command("pad", ("2",), "set spin on a ball, or where the (level) cue's tip hits", "Play", mouse="drag on it"),
    Command("restart", ("r",), "from the start", "Watch", lambda view, by: _watching(view, "restart")),
    Command("step", (".", ","), "one step on, back", "Watch",
            lambda view, by: _watching(view, "step", int(by)), repeats=True),
    Command("faster", ("+", "-"), "faster to 8, slower to 1/16", "Watch",
            lambda view, by: _watching(view, "change_rate", int(by))),
    Command("next_shot", ("n", "p"), "next, previous shot", "Watch",
            lambda view, by: view.game.watching.watch_other(int(by))),
    Command("shots", ("q",), "table of shots: sort, pin, delete, CSV, statistics", "See", _shots),
    Command("find", ("/",), "find a shot: at the rim, a pocket, the pin ...", "See", _find),
    Command("view", ("v",), "follow the ball", "See"),
    Command("predict", ("y",), "path while aiming: all, to the first contact, a metre, nothing", "See", _predict),
    Command("ghosts", ("g",), "earlier shots", "See"),
    Command("fan", ("f",), "fan: 100 similar shots, how many score", "See"),
    Command("wider", ("]", "["), "a wider, narrower fan", "See", _wider),
    Command("map", ("m",), "map: which speeds and angles score", "See"),
    Command("zoom", ("ctrl +", "ctrl -"), "larger, smaller", "See",
            _zoom,
            mouse="Ctrl wheel, pinch", repeats=True),
    Command("pan_across", ("alt left", "alt right"), "move the picture", "See",
            lambda view, by: view.viewpoint.pan(PAN * by, 0), mouse="Ctrl drag, two fingers", repeats=True),
    Command("pan_down", ("alt up", "alt down"), "", "See",
            lambda view, by: view.viewpoint.pan(0, PAN * by), repeats=True),
    Command("fit", ("ctrl 0",), "see all of the shot", "See", lambda view, by: view.viewpoint.look(None)),
    Command("arrows", ("o",), "arrows: velocity and forces", "See"),
    Command("charts", ("w",), "charts over time", "See"),
    Command("graphs", ("alt w",), "charts over time, large, with earlier shots", "See", _graphs),
    Command("energy", ("j",), "where the energy goes", "See",
            lambda view, by: _chart(view, "energy", lambda shot, size: energy_chart(shot.run, size))),
    Command("tape", ("t",), "tape; arrows move its end, K the other", "See", _tape, mouse="right drag"),
    Command("accuracy", ("a",), "accuracy: fast, balanced, precise", "See",
            lambda view, by: view.game.messages.reporting_errors(lambda: _accuracy(view, by))),
    Command("save_scene", ("s",), "a scene file with what was changed", "Keep",
            lambda view, by: _save_scene(view)),
    Command("copy", ("c",), "copy the command line of this shot", "Keep", _copy),
    Command("screenshot", ("f12",), "picture of the window", "Keep", _screenshot),
    Command("animation", ("f9",), "animation of the last shot", "Keep",
            lambda view, by: _with_shot(view, lambda shot: _animate(view, shot))),
    Command("page", ("f8",), "page of the task, each shot as a replay", "Keep", _page),
    Command("save_replay", ("f5",), "replay file of the last shot", "Keep",
            lambda view, by: _with_shot(view, lambda shot: _export(view, replay.SUFFIX, partial(replay.save, shot)))),
    Command("compare", ("f6",), "compute the shot again, and compare", "Keep",
            lambda view, by: _with_shot(view, view.game.watching.compare)),
    Command("open_replay", ("f7",), "open the latest replay; or drop one here", "Keep", _open_replay),
    Command("front", ("1",), "first screen: tasks, games for two", "Play", _front),
    Command("mark", ("3",), "predict first: mark where it lands, then see", "Play",
            lambda view, by: view.game.referee.begin(Prediction(view.game.session.scene))),
    Command("menu", ("l",), "all scenes and presets", "More", _menu),
    Command("next_preset", ("page down", "page up"), "next, previous preset; next task", "More", _other_preset),
    Command("panel", ("tab",), "the panel of parameters", "More"),
    Command("reset", ("backspace",), "all parameters as in the file", "More",
            lambda view, by: view.game.aiming.reset()),
    Command("undo", ("ctrl z", "ctrl y"), "undo, redo the last of 200 changes", "More",
            lambda view, by: view.game.aiming.undo() if by > 0 else view.game.aiming.redo(), repeats=True),
    Command("rack", ("b",), "put the balls back", "More", lambda view, by: view.game.aiming.begin_again()),
    Command("sound", ("u",), "sound", "More", _sound),
    Command("text_size", ("alt +", "alt -"), "larger, smaller text", "More", _text_size),
    Command("contrast", ("alt c",), "high contrast", "More",
            lambda view, by: view.set_look(view.game.memory.look[0], not view.game.memory.look[1])),
    Command("cost", ("f3",), "what a frame and a run cost", "More"),
    Command("fullscreen", ("f11",), "full screen", "More", lambda view, by: view.toggle_full_screen()),
    Command("help", ("h",), "all keys", "More",
            lambda view, by: _open(view, "help", lambda: Menu("Keys", {group: _rows(view, group) for group in GROUPS},
                                                              partial(do, view)))),
    Command("back", ("escape",), "close what is open, stop a run; aim again", "More", _back),
    Command("quit", ("ctrl q",), "exit", "More", lambda view, by: setattr(view.game, "running", False)),
    Command("row", ("ctrl down", "ctrl up"), "next, previous row", "Panel",
            lambda view, by: view.panel.step(int(by)), repeats=True),
    Command("value", ("ctrl right", "ctrl left"), "increase, decrease (Shift: finely)", "Panel",
            lambda view, by: view.panel.nudge(by), repeats=True, fine=True),
    Command("group", ("ctrl page down", "ctrl page up"), "another group", "Panel",
            lambda view, by: view.panel.turn(int(by))),
    Command("row_reset", ("ctrl backspace",), "as in the file", "Panel", lambda view, by: view.panel.reset_row()),
)
# fmt: on
#: What would tell how a shot comes out before it is made: not while a contest is aimed; and what changes
#: the contest, or would write only a part of it.
GIVE_AWAY = frozenset(("predict", "fan", "wider", "map", "charts", "graphs", "energy", "compare"))
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


def pressed(key: int, modifiers: int) -> tuple[Command, float] | None:
    """The command of a key, and 1, or -1 for its opposite; a tenth of it with Shift if it can be done finely."""
    command, by = _BY_KEY.get(name_of(key, modifiers), (None, 0.0))
    if command is None:
        return None
    return command, 0.1 * by if command.fine and modifiers & pygame.KMOD_SHIFT else by


def hint_of(button: str) -> str:
    """The meaning of a button of the bar, and its key; one with a minus does the opposite of its command."""
    if button in HINTS:
        return HINTS[button]
    command = _BY_NAME[button.removeprefix("-")]
    return f"{command.meaning} ({command.shown})"
