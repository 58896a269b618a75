"""The window's loop: passes events to commands and pointer, time to the game, and has the view drawn."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping
from concurrent.futures import wait as wait_for
from contextlib import contextmanager
from pathlib import Path
from time import perf_counter, sleep
from typing import Any

import pygame

from sandbox.errors import RequestError, RunError
from sandbox.scene.discovery import find, installed_folder
from sandbox.tasks import is_task
from sandbox.tasks import load as load_task
from sandbox.window import commands, replay
from sandbox.window.background import steady
from sandbox.window.best import BestList, usual_file
from sandbox.window.contest import AtMatch, AtTask, Contest, source_of
from sandbox.window.desktop import reduces_motion
from sandbox.window.front import first_task
from sandbox.window.game import Game
from sandbox.window.history import Changes
from sandbox.window.memory import Memory, usual_place
from sandbox.window.opening import limit_of
from sandbox.window.pointer import Pointer
from sandbox.window.screen import size_for
from sandbox.window.session import Session
from sandbox.window.sound import Sound
from sandbox.window.view import View
from sandbox.window.worker import checked, started
from sandbox.workers import Processes

_MODIFIED = pygame.KMOD_CTRL | pygame.KMOD_ALT

FRAMES = 60  # per second
#: How often files are checked while nothing happens, in s; an event ends the wait.
IDLE = 0.4
#: How often events are looked for then, in s, if none came for so many s; before that in every frame.
LOOKS, _QUIET = 0.05, 2.0
#: Until its first shot, but no longer than this time, in s, the window shows that it loads.
FIRST = 1.5
#: What SDL falls back to if there is no display.
_HEADLESS_DRIVERS = ("offscreen", "dummy")
#: Variables of which one names the display or the driver.
_SEEN_BY = ("DISPLAY", "WAYLAND_DISPLAY", "SDL_VIDEODRIVER")
_NO_DISPLAY = "no display to open a window on; without one use sandbox run SCENE with --poster F.png or --gif F.gif"


class App:
    """One window on a game. ``tick`` makes one frame; ``run`` makes them until the window is closed."""

    def __init__(
        self,
        game: Game,
        screen: pygame.Surface,
        sound: Sound | None = None,
        patience: float = 0.0,
    ) -> None:
        self.game, self.sound = game, sound
        self.view = View(game, screen, sound, patience, commands.hint_of)
        self.pointer = Pointer(self.view)
        self.hidden = False  # minimised
        self.last_event = perf_counter()
        self.held: set[int] = set()  # keys
        self._repeated: set[int] = set()  # keys, in this frame

    def run(self) -> None:
        """Make frames until the window is closed."""
        started, clock = perf_counter(), pygame.time.Clock()
        self.view.draw()  # that it loads
        pygame.display.flip()
        waits = self.view.shown.overlay is None  # under the tiles nothing is missed
        while self.game.running and waits and perf_counter() - started < FIRST and not self.view.stages.complete:
            self.tick(clock.tick(FRAMES) / 1000)
        self.view.changed = True
        steady()
        while self.game.running:
            if self.tick(clock.tick(FRAMES) / 1000):
                pygame.display.flip()
            if not self.busy:
                self._wait()
        self.close()

    def _wait(self) -> None:
        """Wait until something happens in the window, or it is time to check the files. pygame's own wait polls a
        thousand times a second."""
        end = perf_counter() + IDLE
        while perf_counter() < end and not pygame.event.peek():
            sleep(LOOKS if perf_counter() - self.last_event > _QUIET else 1 / FRAMES)

    def close(self) -> None:
        """End the background threads, and remember the window's size."""
        self.game.memory.size = self.view.screen.windowed
        self.game.memory.save()
        self.view.background.close()
        self.view.writer.close()

    @property
    def busy(self) -> bool:
        """True if the next frame should come soon, though nothing happens in the window."""
        moving = self.view.busy or self.view.drawing.shows_how
        return self.game.running and (self.game.busy or (moving and not self.hidden))

    def tick(self, dt: float) -> bool:
        """Handle events, advance by ``dt`` s, and draw if something changed; returns whether it did."""
        started = perf_counter()
        self._repeated.clear()
        events = pygame.event.get()
        for event in events:
            self.handle(event)
            self.last_event = started
        game, view = self.game, self.view
        start, end = game.advance(dt, hold=self.hidden or not view.stages.up_to_date)
        view.tick(dt)
        self._sound(start, end)
        if self.hidden or not view.needs_drawing(bool(events)):
            return False
        view.draw()
        view.screen.frame_cost += 0.1 * (perf_counter() - started - view.screen.frame_cost)
        return True

    def _sound(self, start: float, end: float) -> None:
        """Play the impacts of this frame, and verdicts."""
        shot, referee = self.game.shot, self.game.referee
        calls, referee.calls = referee.calls, []
        if self.sound is None or shot is None:
            return
        for good in calls:
            self.sound.verdict(good)
        if end <= start:
            return
        balls = {ball.name for ball in shot.run.setup.balls}
        impacts = [e for e in shot.run.events if e.kind == "impact" and start <= e.t < end]
        for event in sorted(impacts, key=lambda e: -e.speed)[:3]:
            self.sound.impact(event.speed, event.partner in balls)

    # Input

    def handle(self, event: pygame.event.Event) -> None:
        """One event of the window, the mouse or the keyboard."""
        view = self.view
        if self._moves(event):
            return
        if event.type == pygame.KEYDOWN:
            typing = view.shown.has_panel and view.panel.typing is not None and view.shown.overlay is None
            if not self._fresh(event, typing):
                return
            if typing:
                view.panel.type(event)
                return
        match event.type:
            case pygame.QUIT:
                self.game.running = False
            case pygame.VIDEORESIZE | pygame.WINDOWSIZECHANGED:
                view.resized()
            case pygame.WINDOWMINIMIZED | pygame.WINDOWHIDDEN:
                self.hidden = True
            case pygame.WINDOWRESTORED | pygame.WINDOWSHOWN | pygame.WINDOWEXPOSED | pygame.WINDOWMAXIMIZED:
                self.hidden, view.changed = False, True
            case pygame.WINDOWFOCUSLOST:
                self.held.clear()
            case pygame.DROPFILE:
                self.game.opening.open(event.file)
            case pygame.KEYDOWN:
                found, plain = commands.pressed(event.key, event.mod), not event.mod & _MODIFIED
                if not (plain and view.shown.key_in_overlay(event.key)) and found is not None:
                    commands.do(view, found[0].name, found[1])
            case _:
                self.pointer.handle(event)

    def _moves(self, event: pygame.event.Event) -> bool:
        """True if a key moves something in what is played live."""
        down, watching = event.type == pygame.KEYDOWN, self.game.watching
        if event.type == pygame.WINDOWFOCUSLOST and watching.live is not None:
            watching.live.let_go()
        if event.type == pygame.KEYUP:
            self.held.discard(event.key)
        if not (down or event.type == pygame.KEYUP) or (down and event.mod & _MODIFIED):
            return False
        if down and (self.view.shown.overlay is not None or self.view.panel.typing is not None):
            return False
        return watching.hold(pygame.key.name(event.key), down)

    def _fresh(self, event: pygame.event.Event, typing: bool) -> bool:
        """True if a key was pressed, or is held to type or for a command that repeats, at most once a frame: after a
        slow frame its repeats have piled up."""
        repeats = event.key in self.held
        self.held.add(event.key)
        if not repeats or typing:
            return True
        found = commands.pressed(event.key, event.mod)
        if found is None or not found[0].repeats or event.key in self._repeated:
            return False
        self._repeated.add(event.key)
        return True


def play(
    source: str | None,
    changes: Mapping[str, Any] | None = None,
    scene: str | None = None,
    game: str | None = None,
    players: int = 1,
) -> None:
    """Open the window until it is closed: on a scene, a replay or a task, or without any on the first screen.

    ``scene`` is that of the replay, ``game`` one for two in the scene; ``players`` play the task. Raises RequestError
    if there is no display.
    """
    recorded = source is not None and source.endswith(replay.SUFFIX)
    if scene is not None and not recorded:
        raise RequestError(f"--scene {scene}: says which scene a replay is of, and {source} is not a replay")
    contest = _contest(source, changes or {}, game, players)
    below = contest.scene if contest is not None else first_task().scene if source is None else None
    shown, changes = (source or "", changes or {}) if below is None else (source_of(below), {})
    worker, helper = Processes(1), Processes(1)
    try:
        if not recorded:
            _load_there(worker, shown, changes)
        first = replay.read(Path(shown), scene).changes if recorded else Changes(shown, dict(changes))
        session = Session(first.source, first.values)
        played = Game(
            session, worker, helper=helper, memory=Memory(usual_place(), reduces_motion()), best=BestList(usual_file())
        )
        with opened(f"{session.title} – Sports sandbox", played.memory.size) as screen:
            if recorded:
                played.opening.open_replay(Path(shown), scene)
            app = App(played, screen, Sound())
            if contest is not None:
                played.referee.begin(contest)
            elif source is None:
                commands.do(app.view, "front")
            if not played.memory.still:
                app.view.shown.on.add("view")
            if played.memory.look != (1.0, False):
                app.view.set_look(*played.memory.look)
            app.run()
    finally:
        worker.close(abandon=True)
        helper.close(abandon=True)


def _contest(source: str | None, changes: Mapping[str, Any], game: str | None, players: int) -> Contest | None:
    """The contest that is asked for, if any. Raises RequestError."""
    contest: Contest | None = None
    if game is not None:
        if source is None:
            raise RequestError(f"--game {game}: name its scene, too")
        folder = find(source).folder
        contest = AtMatch(folder, game)
    elif source is not None and installed_folder(source) is None and is_task(source):
        contest = AtTask(load_task(source), players)
    if contest is None and players > 1:
        raise RequestError("--two: requires a task; a game of a scene for two is --game NAME")
    if contest is not None and changes:
        raise RequestError(f"--set: does not go with {contest.name}, which says itself what it begins with")
    return contest


def _load_there(worker: Processes, source: str, changes: Mapping[str, Any]) -> None:
    """Have the worker load a scene before this process does, in which what is wrong with it is reported. Raises
    RunError if that takes too long: its code may never end."""
    folder = find(source).folder
    limit = limit_of(folder)
    worker.submit(started).result()  # which takes a while on a busy machine
    if not wait_for([worker.submit(checked, source, changes, folder)], limit).done:
        raise RunError(f"loading {source}: given up after {limit:.0f} s: does its code ever end?")


@contextmanager
def opened(title: str, before: tuple[int, int] | None = None) -> Iterator[pygame.Surface]:
    """A window that can be resized, as large as suits the desktop, or as it was ``before``, in px. Raises RequestError
    if there is no display."""
    os.environ.setdefault("SDL_WINDOWS_DPI_AWARENESS", "permonitorv2")  # no scaling on high-resolution displays
    if sys.platform == "linux" and not any(os.environ.get(name) for name in _SEEN_BY):
        raise RequestError(_NO_DISPLAY)
    try:
        try:
            pygame.display.init()
            if "SDL_VIDEODRIVER" not in os.environ and pygame.display.get_driver() in _HEADLESS_DRIVERS:
                raise RequestError(_NO_DISPLAY)
            desktop = min(pygame.display.get_desktop_sizes())  # of several the smallest: it may be moved there
            screen = pygame.display.set_mode(size_for(desktop, before), pygame.RESIZABLE)
        except pygame.error:
            raise RequestError(_NO_DISPLAY) from None
        pygame.display.set_caption(title)
        pygame.key.set_repeat(350, 40)
        yield screen
    finally:
        pygame.display.quit()  # but not the fonts, which the next window uses again
