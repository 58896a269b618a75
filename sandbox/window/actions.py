"""Actions: what keys, the bar's buttons and its lists do, by subject. Their table is in ``commands.py``."""

from __future__ import annotations

from collections.abc import Callable
from datetime import date
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pygame

from sandbox.engine.model.accuracy import LEVELS
from sandbox.picture.energy_chart import energy_chart
from sandbox.picture.graph import graph
from sandbox.picture.palette import palette
from sandbox.scene import Listing, listings, listings_in
from sandbox.tasks.sports import sports
from sandbox.window import aim, keeping
from sandbox.window.find import Found, Question, find, questions, range_text
from sandbox.window.front import Entry, Front, begin
from sandbox.window.measure import Tape
from sandbox.window.menu import Menu
from sandbox.window.overlay import Chart, Choice, Overlay, PictureChoice, Row
from sandbox.window.shots import Played, Shot, write_csv
from sandbox.window.table import Table
from sandbox.window.view import View
from sandbox.window.worker import cost_and_errors, unpacked

_CARD = palette("card")
#: How much larger than usual letters can be.
_TEXT_SIZES = (1.0, 1.15, 1.3, 1.5)
#: Earlier shots in the graphs over time.
_MOST_GRAPHS = 5
#: One step enlarges the picture by this factor, or moves it by this many px.
_ZOOM, PAN = 1.25, 60.0
#: One step moves the end of the tape by this many px.
STEP = 12.0

#: The group of the menu that has a tile for each scene.
_SPORTS = "sports"


# Play and watch


def with_playback(view: View, action: str, *arguments: Any) -> None:
    """Call a method of the playback, if a shot is being watched."""
    if view.game.watching.playback is not None:
        getattr(view.game.watching.playback, action)(*arguments)


def go(view: View, by: float) -> None:
    """Shoot; or pause the shot that is watched, or let it go on."""
    game = view.game
    playback, live = game.watching.playback, bool(game.session.controls.held)
    if playback is None or (live and playback.over):
        game.grasp.let_go()
        game.aiming.shoot()
    else:
        playback.toggle()


def pick(view: View, by: float) -> None:
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


def turn(view: View, by: float) -> None:
    """Turn the shot; or move what was picked to the side."""
    if not _move(view, -by, 0):
        view.game.aiming.nudge(aim.nudged(view.game.session, turn=by))


def push(view: View, by: float) -> None:
    """Make the shot stronger; or move what was picked up."""
    if not _move(view, 0, by):
        view.game.aiming.nudge(aim.nudged(view.game.session, push=by))


def spin(view: View, place: int, by: float) -> None:
    """Change one of the shot's spins."""
    view.game.aiming.nudge(aim.spun(view.game.session, place, by))


# See


def toggle(view: View, name: str, make: Callable[[], Overlay]) -> None:
    """Open an overlay, or close it if it is open."""
    view.shown.open(None if view.shown.overlay is not None and view.shown.overlay.name == name else make())
    if view.shown.overlay is not None:
        view.shown.overlay.name = name


def open_shots(view: View, by: float) -> None:
    """The table of the shots of this scene."""
    game, stage = view.game, view.stages.latest

    def played() -> list[Played]:
        return [row for row in game.shots.rows if row.start[:2] == (game.session.base.folder, game.session.source)]

    if not played():
        game.messages.tell(keeping.NO_SHOTS)
    elif stage is not None:
        toggle(view, "shots", lambda: Table(played, partial(_with_row, view, played), stage.colour_of))


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
            keeping.save(view, ".csv", partial(write_csv, played()), "-shots")


def find_shots(view: View, by: float) -> None:
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
            return [PictureChoice(name, np.array([stage.camera.pixel(*at)]), "", _CARD["text"]) for name, at in places]

        rows = [Row(name, name) for name in names]
        foot = view.screen.bar.places["see"]
        toggle(view, "find", lambda: Choice("aim at ...", rows, lambda name: _find_one(view, names[name]), foot, marks))


def _find_one(view: View, question: Question) -> None:
    """Look for shots at something, and offer them."""
    game, changes = view.game, view.game.session.changes
    ranges = range_text(question, game.session)

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
        toggle(view, "found", lambda: Choice(title, rows, choose, foot, marks))

    work = game.workers.helper.submit(find, game.session.scene, question.goals)
    game.jobs.ask(work, then, f"looking for shots at {question.name} with {ranges} ...; Esc stops it")


def _in_order() -> Callable[[Listing], int]:
    """A key that sorts scenes, each with its presets, as their tiles are."""
    places = {sport.name: place for place, sport in enumerate(sports())}
    return lambda listing: places[listing.name.partition("/")[0]]


def open_menu(view: View, by: float, group: str = "") -> None:
    """All scenes as tiles; each with its presets, after those opened last and the user's own: a ``group`` of them first
    if one is named."""
    game = view.game
    groups: dict[str, list[Row]] = {}
    for item in sorted(listings(), key=_in_order()):
        groups.setdefault(item.name.partition("/")[0], []).append(Row(item.name, item.name, "", item.about))
    known = {row.action: row for rows in groups.values() for row in rows}
    own = [Row(item.name, item.name, "", item.about) for item in listings_in(Path())]
    opened = [known.get(source, Row(source, Path(source).name, "", source)) for source in game.memory.recent]
    sports = [Row(name, name, "", rows[0].about) for name, rows in groups.items()]
    firsts = {_SPORTS: sports, "recent": opened, "in this folder": own}
    groups = {**{name: rows for name, rows in firsts.items() if rows}, **groups}

    now = game.session.source.partition("/")[0]

    def made() -> Menu:
        menu = Menu("Choose a scene", groups, game.opening.open, now, view.thumbnails.of, _SPORTS)
        if group in groups:
            menu.turn_to(group)
        return menu

    toggle(view, "menu", made)


def open_front(view: View, by: float) -> None:
    """The tiles of all sports, each with its tasks and games."""

    def chosen(entry: Entry) -> None:
        if entry.kind == "presets":
            open_menu(view, 1, entry.source)
        else:
            begin(view.game, entry)

    toggle(view, "front", lambda: Front(chosen, view.game.best, date.today()))


def _open_chart(view: View, name: str, draw: Callable[[Shot, tuple[int, int]], pygame.Surface]) -> None:
    """A chart of the current shot over picture and panel, drawn in the background."""
    shot, size = view.game.shot, (view.screen.canvas.get_width(), view.screen.area.height)
    if shot is not None:
        toggle(view, name, lambda: Chart(view.background.submit(draw, shot, size)))


def open_energy(view: View, by: float) -> None:
    """The energy of the current shot by cause, over time."""
    _open_chart(view, "energy", lambda shot, size: energy_chart(shot.run, size))


def open_graphs(view: View, by: float) -> None:
    """The graphs of the current shot with the earlier ones that began from the same place."""
    shot = view.game.shot
    earlier = view.game.shots.earlier(shot.start, but=shot) if shot is not None else []
    others = {f"shot {other.number}": other.run for other in earlier[::-1][:_MOST_GRAPHS] if other.number}
    _open_chart(view, "graphs", lambda shot, size: graph(shot.run, size, others))


def zoom(view: View, by: float) -> None:
    """Zoom around the mouse, or the middle of the picture."""
    view.viewpoint.zoom(_ZOOM**by, view.targets.mouse if view.targets.on_picture else view.screen.area.center)


def widen_fan(view: View, by: float) -> None:
    """Scatter the shots of the fan more, or less."""
    view.shown.widen_fan(2.0**by)


def show_ahead(view: View, by: float) -> None:
    """Show more or less of the path while aiming."""
    view.shown.show_more_ahead()
    view.game.messages.tell(f"path while aiming: {view.shown.ahead}")


def lay_tape(view: View, by: float) -> None:
    """Lay the tape from the ball, to be dragged or moved by key; or put it away."""
    shot, camera, playback = view.game.shot, view.viewpoint.camera, view.game.watching.playback
    view.shown.on ^= {"tape"}
    view.shown.tape = None
    if "tape" in view.shown.on and shot is not None and camera is not None:
        x, y, *_ = shot.run.state(shot.ball, playback.t if playback is not None else 0.0)
        view.shown.tape = Tape((x, y), camera.world(*view.screen.area.center))


def next_accuracy(view: View, by: float) -> None:
    """Go to the next level, and report its cost and errors."""
    game, levels = view.game, list(LEVELS)
    level = levels[(levels.index(game.session.value("accuracy.level")) + 1) % len(levels)]
    if game.aiming.change({"accuracy.level": level}):
        game.messages.tell(f"accuracy {level} ...")
        result = game.workers.helper.submit(cost_and_errors, game.session.scene)
        game.jobs.ask(result, lambda said: game.messages.tell(f"accuracy {level}: {said}"))


def back(view: View, by: float) -> None:
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
            open_front(view, 1)
        else:
            game.aiming.again()


def switch_camera(view: View, by: float) -> None:
    """Have the camera go with the shots that are watched, or stand still; now and next time."""
    view.shown.on ^= {"view"}
    view.game.memory.still = "view" not in view.shown.on
    view.game.memory.save()


def switch_sound(view: View, by: float) -> None:
    """Switch sound on or off."""
    if view.sound is None or not view.sound.there:
        view.game.messages.tell("no sound: there is no sound device")
    else:
        view.sound.on = not view.sound.on
        view.game.messages.tell("sound on" if view.sound.on else "sound off")


def switch_confetti(view: View, by: float) -> None:
    """Celebrate a success, or do not, now and next time."""
    memory = view.game.memory
    memory.calm = not memory.calm
    memory.save()
    view.game.messages.tell("no confetti, nets stand still" if memory.calm else "confetti after a success, nets bulge")


# More


def other_preset(view: View, by: float) -> None:
    """Open the next preset; or the task that follows the one that was played."""
    contest = view.game.referee.contest
    if contest is not None and contest.following and by > 0:
        begin(view.game, Entry("task", contest.following))
        return
    names = [listing.name for listing in listings()]
    source = view.game.session.source
    now = names.index(source) if source in names else 0
    view.game.opening.open(names[(now + int(by)) % len(names)])


def change_text_size(view: View, by: float) -> None:
    """Make letters larger, or smaller."""
    larger, contrast = view.game.memory.look
    place = min(range(len(_TEXT_SIZES)), key=lambda i: abs(_TEXT_SIZES[i] - larger)) + int(by)
    view.set_look(_TEXT_SIZES[min(max(place, 0), len(_TEXT_SIZES) - 1)], contrast)
