"""The window: its loop, and what happens to the shot. ``pointer`` and ``commands`` tell it what a player does."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from concurrent.futures.process import BrokenProcessPool
from pathlib import Path
from threading import Thread
from time import perf_counter
from typing import TYPE_CHECKING, Any, NamedTuple

import pygame

from sandbox.errors import RunError, SandboxError
from sandbox.picture.palette import palette
from sandbox.picture.sheet import rows_of
from sandbox.window import commands, overlay, replay
from sandbox.window.ahead import PATIENCE, Ahead, ready, steady
from sandbox.window.bar import HEIGHT, Bar, Shown
from sandbox.window.beside import predicted, warmed
from sandbox.window.canvas import Canvas
from sandbox.window.fan import Fan
from sandbox.window.keys import command_for
from sandbox.window.playback import Playback
from sandbox.window.pointer import Pointer
from sandbox.window.recorded import run_of
from sandbox.window.session import Session, Shot
from sandbox.window.sound import Sound
from sandbox.window.view import View
from sandbox.window.watch import Watch
from sandbox.workers import Processes

if TYPE_CHECKING:
    from sandbox.scene import Scene
    from sandbox.window.panel import Panel
    from sandbox.window.stage import Stage

CARD = palette("card")
#: Columns and rows that each goes on.
ARROWS = {pygame.K_LEFT: (-1, 0), pygame.K_RIGHT: (1, 0), pygame.K_UP: (0, -1), pygame.K_DOWN: (0, 1)}

FRAMES = 60  # per second
SIZE = (1280, 720)
#: Everything is drawn at least this large; of a smaller window a part is seen.
SMALLEST = (480, 400)
#: How long a message stays, in s.
MESSAGE = 6.0
#: A fan is begun when the shot has not changed for so long, in s.
STILL = 0.1


class Awaited(NamedTuple):
    """A shot that is computed."""

    scene: Scene
    changes: dict[str, Any]
    result: Future[tuple[dict[str, Any], float]]  # of beside.predicted


class App:
    """One window on a session. ``tick`` makes one frame; ``run`` makes them until the window is closed.

    Scenes run in a process beside this one, of ``runs``. A frame waits for the path of what was changed where that
    takes no longer than ``patience`` s; else it shows the path there is.
    """

    def __init__(
        self,
        session: Session,
        screen: pygame.Surface,
        runs: Processes,
        sound: Sound | None = None,
        patience: float = PATIENCE,
    ) -> None:
        self.session: Session = session
        self.screen, self.runs, self.sound, self.patience = screen, runs, sound, patience
        self.running = True
        self.ahead = Ahead()
        self.awaited: Awaited | None = None  # the shot as it was aimed last
        self.stale = True  # the shot is not that of the parameters, nor is one awaited
        self.shot: Shot | None = None  # as aimed, and as played
        self.still = 0.0  # s since it changed
        self.fan: Fan | None = None
        self.fan_width = 1.0
        self.playback: Playback | None = None  # None while aiming
        self.chosen = -1  # of the shots so far, the one that is watched
        self.before: Shot | None = None  # the shot as it was before the scene file was saved
        self.watched = Watch(session.file)
        self.writer: Thread | None = None  # of an animation, which takes seconds
        self.message: tuple[str, bool, float] | None = None  # text, whether it is bad, s left
        self.cost = 0.0  # s, of the last run
        self.frame_cost = 0.0  # s, smoothed
        self.panel: Panel | None = None
        self.has_panel: bool = False
        self.windowed = SIZE  # while it fills the display, its size before
        self.view, self.pointer = View(self), Pointer(self)
        self._layout()

    # ------------------------------------------------------------------------------------------------------- the loop

    def run(self) -> None:
        """Until the window is closed."""
        self.tick(0.0)
        pygame.display.flip()
        self.runs.submit(warmed, self.session.source)  # the process starts while the first frame is looked at
        steady()
        clock = pygame.time.Clock()
        while self.running:
            self.tick(clock.tick(FRAMES) / 1000)
            pygame.display.flip()
        self.ahead.close()

    def tick(self, dt: float) -> None:
        """Take in what happened, go on by ``dt`` s, and draw."""
        started = perf_counter()
        for event in pygame.event.get():
            self.handle(event)
        self.update(dt)
        self.draw()
        self.view.follow()
        if self.fan is not None and not self.stale and self.awaited is None:
            self.fan.go_on(self.runs)
        self.frame_cost += 0.1 * (perf_counter() - started - self.frame_cost)

    def update(self, dt: float) -> None:
        if self.message is not None:
            text, bad, left = self.message
            self.message = (text, bad, left - dt) if left > dt else None
        if self.watched.saved(dt):
            self._reload()
        self.still += dt
        self.view.pass_time(dt)
        self._predict()
        self._spread()
        if self.panel is not None:
            self.panel.update(dt)
        if self.playback is not None:
            before = self.playback.t
            self.playback.advance(dt)
            self._sound(before, self.playback.t)

    def _sound(self, start: float, end: float) -> None:
        """The impacts of this frame."""
        if self.sound is None or self.shot is None or end <= start:
            return
        balls = {ball.name for ball in self.shot.run.setup.balls}
        impacts = [e for e in self.shot.run.events if e.kind == "impact" and start <= e.t < end]
        for event in sorted(impacts, key=lambda e: -e.speed)[:3]:
            self.sound.impact(event.speed, event.partner in balls)

    def tell(self, text: str, bad: bool = False) -> None:
        self.message = (text, bad, MESSAGE)

    def trying(self, action: Callable[[], object]) -> bool:
        """Do something that may fail because of what was asked for; the window says so and goes on."""
        try:
            action()
        except SandboxError as error:
            self.tell(str(error), bad=True)
            return False
        except Exception as error:  # a scene's own code
            self.tell(f"{type(error).__name__}: {error}", bad=True)
            return False
        return True

    # ---------------------------------------------------------------------------------------------------------- places

    def _layout(self) -> None:
        """Places for everything, for the window's size."""
        self.laid_out = self.screen.get_size()
        width, height = (max(a, b) for a, b in zip(self.laid_out, SMALLEST, strict=True))
        fits = (width, height) == self.laid_out
        self.canvas: pygame.Surface = self.screen if fits else pygame.Surface((width, height))
        rows = rows_of((width, height))
        unit, tall = rows / 720, round(HEIGHT * rows / 720)
        self.bar = Bar(pygame.Rect(0, height - tall, width, tall), rows)
        wide = 0
        if self.has_panel:
            from sandbox.window.panel import (  # it brings pygame_gui, which takes its time
                FAVOURITES,
                NARROWEST,
                WIDTH,
                Panel,
            )

            wide = min(max(NARROWEST, round(WIDTH * unit)), width // 2)
            rect = pygame.Rect(width - wide, 0, wide, height - tall)
            group = self.panel.group if self.panel is not None else FAVOURITES
            self.panel = Panel((width, height), rect, self.session, self.change, self.reset, group)
        self.area = pygame.Rect(0, 0, width - wide, height - tall)
        self.view.clear()

    def open_panel(self, wanted: bool) -> None:
        """Show the panel of parameters, or close it."""
        self.panel, self.has_panel = None, wanted
        self._layout()
        steady()

    def resized(self) -> None:
        """The window may have another size."""
        screen = pygame.display.get_surface()
        if screen is not None and self.laid_out != screen.get_size():  # it may be the same surface, now larger
            self.screen = screen
            self._layout()

    @property
    def surface(self) -> pygame.Surface:
        """Where the view is drawn."""
        return self.canvas.subsurface(self.area)

    @property
    def stage(self) -> Stage | None:
        return self.view.stage

    # ------------------------------------------------------------------------------------------------------- the shot

    def _predict(self) -> None:
        """Have the scene run as it stands, and take the path that this frame shows."""
        if self.shot is None:
            self.settle()
            return
        self._take(0.0)
        if self._begin_run() and self.cost <= self.patience:
            self._take(self.patience)

    def _begin_run(self) -> bool:
        """Have the scene run as it stands, once the run before has ended; whether there is one to wait for."""
        if self.stale and self.awaited is None:
            self.stale, scene = False, self.session.scene
            # The first shot is waited for, and the process beside may still be starting.
            workers = self.runs if self.shot is not None else self.ahead
            self.awaited = Awaited(scene, dict(self.session.changes), workers.submit(predicted, scene))
        return self.awaited is not None

    def _take(self, patience: float | None) -> None:
        """Show what has been run; where that failed the last good shot stays."""
        if self.awaited is None or not ready(self.awaited.result, patience):
            return
        (scene, changes, result), self.awaited = self.awaited, None

        def take() -> None:
            try:
                record, cost = result.result()
            except BrokenProcessPool:
                raise RunError("the process that ran it was killed: out of memory?") from None
            if self.playback is None:
                self.shot, self.cost, self.still = Shot(scene, run_of(scene, record), changes), cost, 0.0

        self.trying(take)

    def settle(self) -> None:
        """Wait until the shot is that of the parameters."""
        while self.stale or self.awaited is not None:
            self._begin_run()
            self._take(None)

    def _spread(self) -> None:
        """The fan of the shot that is shown, once it stands still."""
        if "fan" not in self.view.on or self.shot is None:
            self.fan = None
            return
        if self.fan is not None and (self.fan.shot is not self.shot or self.fan.width != self.fan_width):
            self.fan = None
        if self.fan is None and self.still >= STILL and self.awaited is None:
            self.fan = Fan(self.shot, self.fan_width)

    def change(self, changes: Mapping[str, Any]) -> bool:
        """Change parameters, and aim with them."""
        if not changes:
            return False
        self.back_to_aiming(goes_on=True)
        if not self.trying(lambda: self.session.change(changes)):
            return False
        controls = self.session.controls
        aimed = {controls.speed, controls.angle, *controls.also, *(spin.key for spin in controls.spins)}
        if not aimed.issuperset(changes):
            self.view.clear()
        self.stale = True
        return True

    def back_to_aiming(self, goes_on: bool = False) -> None:
        """Leave the shot that is watched; after its end the next may go on from there, where the scene knows how."""
        playback, shot = self.playback, self.shot
        if playback is None:
            return
        self.playback, self.stale, self.chosen = None, True, -1
        if goes_on and playback.over and shot is not None and self.session.controls.goes_on is not None:
            if self.trying(lambda: self.session.go_on(shot)):
                self.tell("from where the balls rest; B puts them back where they began")
            self.view.clear()
            self.settle()  # a shot of another place must not be drawn on this one

    def restore(self, changes: dict[str, Any]) -> None:
        """Aim as it was with these changes."""
        if changes != self.session.changes and self.trying(lambda: self.session.restore(changes)):
            self.stale = True

    def begin_again(self) -> None:
        """The balls back where they were before any shot went on from another."""
        if self.trying(self.session.begin_again):
            self.back_to_aiming()
            self.view.clear()
            self.stale = True

    def shoot(self) -> None:
        """Let go: from here on the shot is watched."""
        self.pointer.let_go()
        self.settle()
        if self.shot is None or self.shot.scene is not self.session.scene:  # it could not be run, and that is told
            return
        self.session.shots.append(self.shot)
        self.watch(len(self.session.shots) - 1)

    def watch(self, index: int) -> None:
        """Play one of the shots so far from its start."""
        self.chosen = index
        self.shot, self.still = self.session.shots[index], 0.0
        self.stale, self.awaited = False, None
        rate = self.playback.rate if self.playback is not None else 1.0
        self.playback = Playback(self.shot.run.duration, rate)

    def reset(self, key: str | None = None) -> None:
        """Take back what was changed in the window: one parameter, or all of them."""
        if self.trying(lambda: self.session.reset(key)):
            self.back_to_aiming()
            self.view.clear()
            self.stale = True

    def _reload(self) -> None:
        """The scene file was saved: aim by it, with the path as it was still drawn."""
        before, folder = self.shot, self.session.base.folder
        if self.trying(self.session.reload):
            if self.session.base.folder != folder:
                self._aim_anew()
            else:
                self.back_to_aiming()
                self.view.clear()
                self.before, self.stale = before, True
            self.tell(f"read {self.watched.file} again")
        elif self.message is not None:
            self.message = (self.message[0], True, 1e9)  # until it is mended

    def open(self, source: str) -> None:
        """Play another scene or preset, or see a replay."""
        if source.endswith(replay.SUFFIX):
            self.trying(lambda: self._open_replay(Path(source)))
        elif self.trying(lambda: self.session.open(source)):
            self._aim_anew()

    def _aim_anew(self) -> None:
        """The session is on another scene: aim in that."""
        self.back_to_aiming()
        self._begin()
        self.shot, self.awaited, self.stale = None, None, True

    def _open_replay(self, path: Path) -> None:
        self.session, _ = replay.read(path)
        self._begin()
        if self.has_panel:
            self._layout()
        self.watch(0)
        self.tell(f"{path}: as it was recorded; F6 simulates it again")

    def _begin(self) -> None:
        """Nothing of the scene before is left."""
        steady()
        self.view.clear()
        self.pointer.let_go()
        self.view.menu = self.before = self.pointer.tape = None
        self.watched = Watch(self.session.file)

    # ---------------------------------------------------------------------------------------------------------- input

    def handle(self, event: pygame.event.Event) -> None:
        """One event of the window, the mouse or the keyboard."""
        if self.panel is not None and not self.view.covered and self._for_panel(self.panel, event):
            return
        match event.type:
            case pygame.QUIT:
                self.running = False
            case pygame.VIDEORESIZE | pygame.WINDOWSIZECHANGED:
                self.resized()
            case pygame.DROPFILE:
                self.open(event.file)
            case pygame.KEYDOWN:
                command = command_for(event.key, event.mod)
                if self.view.menu is not None and event.key in (*ARROWS, pygame.K_RETURN):
                    self._choose(self.view.menu, event.key)
                elif command is not None:
                    commands.do(self, command, bool(event.mod & pygame.KMOD_SHIFT))
            case _:
                self.pointer.handle(event)

    def _choose(self, menu: overlay.Menu, key: int) -> None:
        """A key while the scenes are listed."""
        if key in ARROWS:
            menu.move(*ARROWS[key], self.session.title)
        elif menu.chosen:
            self.view.menu = None
            self.open(menu.chosen)

    def _for_panel(self, panel: Panel, event: pygame.event.Event) -> bool:
        """Let the panel take an event; whether it is for nobody else."""
        typing, pointer = panel.typing, self.pointer
        used = panel.handle(event)
        if event.type == pygame.KEYDOWN:
            return typing and event.key not in (pygame.K_ESCAPE, pygame.K_TAB)
        if event.type == pygame.MOUSEWHEEL:
            return panel.rect.collidepoint(pointer.at)
        if event.type == pygame.MOUSEMOTION and panel.rect.collidepoint(event.pos):
            pointer.at = event.pos
            return pointer.pull is None and not pointer.scrubbing
        return used or (event.type == pygame.MOUSEBUTTONDOWN and panel.rect.collidepoint(event.pos))

    # -------------------------------------------------------------------------------------------------------- drawing

    def draw(self) -> None:
        """The whole window."""
        try:
            self.view.draw()
        except Exception as error:  # a scene's own code
            sheet = Canvas(self.surface)
            sheet.surface.fill(CARD["background"])
            overlay.draw_message(sheet, f"{self.session.title} cannot be drawn: {type(error).__name__}: {error}", True)
        if self.panel is not None:
            self.panel.draw(self.canvas)
        self.bar.draw(self.canvas, self._shown(), self.pointer.at)
        self.view.draw_over(self.canvas, self.area.height)
        if self.canvas is not self.screen:
            self.screen.blit(self.canvas, (0, 0))

    def _shown(self) -> Shown:
        """What the bar tells."""
        playback, shot, view = self.playback, self.shot, self.view
        opened = {"help": "help" in view.on, "panel": self.panel is not None}
        if view.choices is not None:
            opened[view.choices.group] = True
        return Shown(
            title=self.session.title + (" *" if self.session.changes else ""),
            playing=playback is not None and playback.playing,
            t=playback.t if playback is not None else None,
            duration=playback.duration if playback is not None else shot.run.duration if shot else 0.0,
            ticks=tuple(e.t for e in shot.run.events if e.kind == "impact")[:200] if shot else (),
            rate=playback.rate if playback is not None else 1.0,
            texts=("see", "keep", "more", "panel", "help"),
            on=frozenset(name for name, on in opened.items() if on),
        )


def play(source: str, changes: Mapping[str, Any] | None = None) -> None:
    """Open the window on a scene, until it is closed. Raises RequestError where there is no display."""
    from sandbox.window.display import opened

    recorded, runs = source.endswith(replay.SUFFIX), Processes(1)
    try:
        session = replay.read(Path(source))[0] if recorded else Session(source, changes)
        with opened(SIZE, f"Sports sandbox: {session.title}") as screen:
            app = App(session, screen, runs, Sound())
            if recorded:
                app.watch(0)
            app.run()
    finally:
        runs.close(abandon=True)
