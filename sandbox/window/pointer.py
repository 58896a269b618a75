"""What the mouse does: pull the ball back, drag the time line, lay the tape, press buttons."""

from __future__ import annotations

from math import hypot
from typing import TYPE_CHECKING, Any

import pygame

from sandbox.window import aim, commands
from sandbox.window.measure import Tape

if TYPE_CHECKING:
    from sandbox.window.app import App

Place = tuple[int, int]  # px


class Pointer:
    """The mouse over one window."""

    def __init__(self, app: App) -> None:
        self.app = app
        self.at: Place = (-1, -1)
        self.start: Place | None = None  # where the button went down for a pull
        self.before: dict[str, Any] = {}  # what was changed until then
        self.pull: tuple[float, float] | None = None  # px, while it is down
        self.scrubbing = False  # the time line is dragged
        self.tape: Tape | None = None
        self.laying = False  # the tape is dragged

    @property
    def pulling(self) -> bool:
        """Whether the pull is long enough for a shot."""
        return self.pull is not None and hypot(*self.pull) >= aim.LEAST

    def let_go(self) -> None:
        """Leave what was begun."""
        self.start, self.pull, self.scrubbing, self.laying = None, None, False, False

    def give_up(self) -> None:
        """Leave a pull: the aim is what it was before."""
        self.let_go()
        self.app.restore(self.before)

    def handle(self, event: pygame.event.Event) -> None:
        """One event of the mouse."""
        match event.type:
            case pygame.MOUSEMOTION:
                self.at = event.pos
                self._moved(event.pos)
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_LEFT:
                self.at = event.pos
                self._pressed(event.pos)
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_RIGHT:
                self._lay(event.pos)
            case pygame.MOUSEBUTTONUP if event.button == pygame.BUTTON_LEFT:
                self._released()
            case pygame.MOUSEBUTTONUP if event.button == pygame.BUTTON_RIGHT:
                self.laying = False
            case pygame.MOUSEWHEEL:
                other = bool(pygame.key.get_mods() & pygame.KMOD_SHIFT) or event.x != 0
                self.app.change(aim.spun(self.app.session, int(other), event.y or event.x))

    def _pressed(self, at: Place) -> None:
        app, view = self.app, self.app.view
        on_bar = app.bar.command_at(at)
        if view.menu is not None:
            name = view.menu.name_at(at)
            view.menu = None
            if name is not None:
                app.open(name)
        elif view.choices is not None and on_bar != view.choices.group:
            command = view.choices.command_at(at)
            if command is None or not view.choices.stays:
                view.choices = None
            if command is not None:
                commands.do(app, command)
        elif "help" in view.on or view.energy is not None:
            view.on.discard("help")
            view.energy = None
        elif app.bar.rect.collidepoint(at):
            share = app.bar.share_at(at)
            if on_bar is not None:
                commands.do(app, on_bar)
            elif share is not None and app.playback is not None:
                self.scrubbing = True
                app.playback.playing = False
                app.playback.seek(share * app.playback.duration)
        elif app.area.collidepoint(at):
            if "tape" in view.on:
                self._lay(at)
            else:
                app.back_to_aiming(goes_on=True)
                self.start, self.pull, self.before = at, (0.0, 0.0), dict(app.session.changes)

    def _lay(self, at: Place) -> None:
        camera = self.app.view.camera
        if camera is not None and self.app.area.collidepoint(at):
            place = camera.world(*at)
            self.tape, self.laying = Tape(place, place), True

    def _moved(self, at: Place) -> None:
        app = self.app
        camera = app.view.camera
        if self.laying and self.tape is not None and camera is not None:
            self.tape.end = camera.world(*at)
        elif self.scrubbing and app.playback is not None:
            app.playback.seek(app.bar.share(at) * app.playback.duration)
        elif self.start is not None and app.stage is not None:
            self.pull = (float(at[0] - self.start[0]), float(at[1] - self.start[1]))
            stretch = app.stage.camera.stretch if app.stage.camera is not None else 1.0
            changes = aim.pulled(app.session, self.pull, app.area.height, stretch)
            if changes is not None:
                app.change(changes)

    def _released(self) -> None:
        shoots = self.start is not None and self.pulling
        self.let_go()
        if shoots:
            self.app.shoot()
