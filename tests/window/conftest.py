"""A window without a display: SDL's dummy driver, real events."""

from __future__ import annotations

import os
import time
from typing import Any

os.environ.setdefault("SDL_VIDEODRIVER", "dummy")
os.environ.setdefault("SDL_AUDIODRIVER", "dummy")

import pygame
import pytest

from sandbox.picture.lettering import Lettering
from sandbox.picture.palette import set_contrast
from sandbox.scene import simulate
from sandbox.window.app import App
from sandbox.window.canvas import Canvas
from sandbox.window.game import Game
from sandbox.window.session import Session
from sandbox.window.shots import Shot
from sandbox.workers import Processes
from tests.own_scene import HANG

FRAME = 1 / 60  # s


class Clock:
    """The window's clock, in s: it stands unless a test lets time pass, so that what is computed may take long."""

    def __init__(self) -> None:
        self.now, self.stands = 1000.0, True

    def __call__(self) -> float:
        return self.now if self.stands else time.perf_counter()


@pytest.fixture(autouse=True)
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    stands = Clock()
    for module in ("background", "opening"):
        monkeypatch.setattr(f"sandbox.window.{module}.perf_counter", stands)
    return stands


class Player:
    """A person at a window: every call is one event, and one frame."""

    def __init__(self, worker: Processes, source: str, size: tuple[int, int] = (1280, 720)) -> None:
        pygame.display.init()
        self.screen = pygame.display.set_mode(size, pygame.RESIZABLE)
        pygame.event.clear()
        self.game = Game(Session(source), worker, patience=HANG)  # this machine may be busy
        self.app = App(self.game, self.screen, patience=HANG)
        self.view, self.pointer = self.app.view, self.app.pointer
        self.settle()

    def frames(self, count: int = 1, dt: float = FRAME) -> None:
        """So many frames, of which the last is looked at."""
        for _ in range(count - 1):
            self.view.changed |= self.wait(dt)
        self.app.tick(dt)

    def wait(self, dt: float = FRAME) -> bool:
        """One frame that nobody looks at: it is not drawn, but where a list draws what it waits for; returns whether it
        should have been."""
        with pytest.MonkeyPatch.context() as patch:
            if self.view.shown.overlay is None:
                patch.setattr(self.view, "draw", lambda: None)
            return self.app.tick(dt)

    def settle(self) -> None:
        """Frames until there is nothing left to compute or compose; the last one is drawn."""
        end, busy = time.monotonic() + HANG, True
        while busy:
            assert time.monotonic() < end
            self.game.settle()
            self.wait()
            busy = self.view.busy or self.game.watching.awaited or bool(self.game.jobs.waiting)
            time.sleep(0.001 * busy)
        self.view.changed = True
        self.frames(1)

    def send(self, kind: int, **values: object) -> None:
        pygame.event.post(pygame.event.Event(kind, **values))
        self.frames()

    def key(self, key: int, modifiers: int = 0) -> None:
        """Press and release a key within one frame."""
        pressed = {"key": key, "mod": modifiers, "unicode": "", "scancode": 0}
        pygame.event.post(pygame.event.Event(pygame.KEYDOWN, **pressed))
        self.send(pygame.KEYUP, **pressed)

    def press_named(self, name: str) -> None:
        """Press and release a key that is named as in the table of commands."""
        held, _, plain = name.partition(" ") if name.startswith(("ctrl ", "alt ")) else ("", "", name)
        self.key(pygame.key.key_code(plain), {"": 0, "ctrl": pygame.KMOD_CTRL, "alt": pygame.KMOD_ALT}[held])

    def move(self, at: tuple[int, int]) -> None:
        self.send(pygame.MOUSEMOTION, pos=at, rel=(0, 0), buttons=(0, 0, 0), touch=False)

    def press(self, at: tuple[int, int]) -> None:
        self.send(pygame.MOUSEBUTTONDOWN, pos=at, button=1, touch=False)

    def release(self, at: tuple[int, int]) -> None:
        self.send(pygame.MOUSEBUTTONUP, pos=at, button=1, touch=False)

    def click(self, at: tuple[int, int]) -> None:
        self.move(at)
        self.press(at)
        self.release(at)

    def pull(self, by: tuple[int, int], let_go: bool = True) -> None:
        """Pull the ball back by so many px."""
        x, y = (round(value) for value in self.view.stages.latest.ball_at(self.game.shot))
        self.press((x, y))
        for part in (0.3, 0.6, 1.0):
            self.move((round(x + part * by[0]), round(y + part * by[1])))
        if let_go:
            self.release((x + by[0], y + by[1]))

    @property
    def sheet(self) -> Canvas:
        """The surface that the picture is drawn on."""
        return Canvas(self.view.screen.canvas.subsurface(self.view.screen.area))

    def button(self, command: str) -> None:
        self.click(self.view.screen.bar.buttons[command].center)


@pytest.fixture(scope="session")
def shot_of():
    """Gives the shot of a session as it stands."""
    return lambda session: Shot(session.scene, simulate(session.scene), session.changes)


@pytest.fixture(scope="session")
def worker():
    one = Processes(1)
    yield one
    one.close(abandon=True)


@pytest.fixture
def written(monkeypatch: pytest.MonkeyPatch) -> list[tuple[str, pygame.Rect]]:
    """Every text from here on, with where it is written."""
    texts: list[tuple[str, pygame.Rect]] = []
    write = Lettering.write

    def noted(self: Lettering, surface: pygame.Surface, text: str, *arguments: Any, **named: Any) -> pygame.Rect:
        texts.append((text, write(self, surface, text, *arguments, **named)))
        return texts[-1][1]

    monkeypatch.setattr(Lettering, "write", noted)
    return texts


@pytest.fixture(autouse=True)
def usual_look():
    """Colours and size of letters are those of all pictures in a process: what a test sets is put back."""
    yield
    set_contrast(False)
    Lettering.larger = 1.0


@pytest.fixture
def player(worker):
    opened: list[Player] = []

    def open_one(*arguments: Any) -> Player:
        opened.append(Player(worker, *arguments))
        return opened[-1]

    yield open_one
    for one in opened:
        one.app.close()
    pygame.display.quit()
