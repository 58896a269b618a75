"""Keeping and opening: files of shots, tasks and scenes, pictures, and the clipboard."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

import pygame

from sandbox import entries
from sandbox.picture.frames import save_png
from sandbox.window import export, replay
from sandbox.window.contest import AtTask
from sandbox.window.shots import Shot
from sandbox.window.view import View

NO_SHOTS = "no shots yet: pull back and let go"


def with_shot(view: View, action: Callable[[Shot], object]) -> None:
    """Do something with the shot that is watched, or the last one."""
    game = view.game
    shot = game.shot if game.watching.playback is not None else game.shots.paths[-1] if game.shots.paths else None
    if shot is None:
        game.messages.tell(NO_SHOTS)
    else:
        game.messages.reporting_errors(lambda: action(shot))


def save(view: View, suffix: str, write: Callable[[Path], object], about: str = "") -> None:
    """Write a new file, and say where it is."""
    stem, messages = view.game.session.title + about, view.game.messages
    messages.reporting_errors(lambda: messages.tell(f"wrote {export.new_file(stem, suffix, write)}"))


def save_scene(view: View, by: float) -> None:
    """Write a scene file with what was changed."""
    game = view.game
    game.messages.reporting_errors(lambda: game.messages.tell(f"wrote {export.scene_file(game.session)}"))


def screenshot(view: View, by: float) -> None:
    """Write a picture of the window."""
    view.draw()  # without the list that this may have been chosen from
    save(view, ".png", partial(save_png, view.screen.canvas))


def open_replay(view: View, by: float) -> None:
    """Open the newest replay that the window wrote."""
    found = sorted(export.FOLDER.glob(f"*{replay.SUFFIX}"), key=lambda path: path.stat().st_mtime)
    if found:
        view.game.opening.open(str(found[-1]))
    else:
        view.game.messages.tell(f"no replays in {export.FOLDER} yet")


def save_replay(view: View, shot: Shot) -> None:
    """Write a replay of the shot."""
    save(view, replay.SUFFIX, partial(replay.save, shot))


def animate(view: View, shot: Shot) -> None:
    """Write an animation of the shot, in the background."""
    game = view.game
    work = view.writer.submit(export.new_file, game.session.title, ".gif", partial(export.animate, shot))
    game.jobs.ask(work, lambda path: game.messages.tell(f"wrote {path}"), "writing the animation ...")


def write_page(view: View, by: float) -> None:
    """Write a page of each player's attempts at the task, each shot as a replay."""
    game, contest = view.game, view.game.referee.contest
    if not isinstance(contest, AtTask):
        game.messages.tell("a page is made of a task that is played")
        return
    if not game.referee.shots:
        game.messages.tell(NO_SHOTS)
        return
    page = entries.require("pages of tasks", "F8")
    for session in contest.sessions:
        work = view.writer.submit(export.new_file, contest.title, ".html", partial(page.save_page, session))
        game.jobs.ask(work, lambda path: game.messages.tell(f"wrote {path}"), "writing the page ...")


def copy_command(view: View, by: float) -> None:
    """Copy the command line of the shot."""
    command = view.game.session.command()
    try:
        pygame.scrap.put_text(command)
    except pygame.error:  # there is no clipboard
        view.game.messages.tell(command)
    else:
        view.game.messages.tell(f"copied: {command}")
