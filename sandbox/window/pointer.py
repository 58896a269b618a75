"""The mouse: pull, drag the time line or the tape, zoom and move the picture, press buttons."""

from __future__ import annotations

from math import dist

import numpy as np
import pygame

from sandbox.window import aim, commands
from sandbox.window.measure import Tape
from sandbox.window.view import View

Place = tuple[int, int]  # px

#: One notch of the wheel enlarges the picture by this factor.
NOTCH = 1.15


class Pointer:
    """The mouse over one window."""

    def __init__(self, view: View) -> None:
        self.view = view
        self.scrubbing = False  # the time line is dragged
        self.laying = False  # the tape is dragged
        self.panning = False  # the picture is dragged
        self.spinning = False  # the ball of spins is dragged
        self.fingers: dict[int, tuple[float, float]] = {}  # on a touch screen, px
        self.grabbed: Place = (0, 0)  # where the button was pressed on a handle
        self.pressed: Place | None = None  # where the button was pressed on a shot that is over

    @property
    def at(self) -> Place:
        return self.view.at

    @property
    def dragging(self) -> bool:
        """Whether a drag is in progress, which may leave the area where it began."""
        return self.scrubbing or self.laying or self.panning or self.spinning or self.view.game.holding

    def handle(self, event: pygame.event.Event) -> None:
        """One event of the mouse, or of fingers on a screen: one is a mouse, two zoom and move the picture."""
        if event.type in (pygame.FINGERDOWN, pygame.FINGERMOTION, pygame.FINGERUP):
            self._touched(event)
            return
        if len(self.fingers) > 1 and getattr(event, "touch", False):
            return
        match event.type:
            case pygame.MOUSEMOTION:
                self._moved(self.view.at, event.pos)
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_LEFT:
                self.view.at = event.pos
                self._pressed(event.pos)
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_RIGHT:
                self._lay(event.pos)
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_MIDDLE:
                self.view.at, self.panning = event.pos, self.view.area.collidepoint(event.pos)
            case pygame.MOUSEBUTTONUP if event.button == pygame.BUTTON_LEFT:
                self._released()
            case pygame.MOUSEBUTTONUP if event.button in (pygame.BUTTON_RIGHT, pygame.BUTTON_MIDDLE):
                self.laying = self.panning = False
            case pygame.MOUSEWHEEL:
                self._turned(event)

    def _touched(self, event: pygame.event.Event) -> None:
        """Fingers on a touch screen."""
        before = list(self.fingers.values())
        width, height = self.view.canvas.get_size()
        if event.type == pygame.FINGERUP:
            self.fingers.pop(event.finger_id, None)
        else:
            self.fingers[event.finger_id] = event.x * width, event.y * height
        now = list(self.fingers.values())
        if len(now) == 2 and event.type == pygame.FINGERDOWN:  # the first finger did not mean to pull
            self.view.game.give_up_pull()
            self._released()
        elif len(now) == len(before) == 2:
            (x0, y0), (x, y) = (np.mean(points, axis=0) for points in (before, now))
            self.view.pan(x - x0, y - y0)
            self.view.zoom(dist(*now) / max(dist(*before), 1.0), (x, y))

    def _turned(self, event: pygame.event.Event) -> None:
        """The wheel, or a trackpad: the size of the picture with Ctrl, or while a shot is watched; else spin."""
        held = pygame.key.get_mods()
        if self.view.over is not None:
            self.view.over.scroll(-event.y)
        elif held & pygame.KMOD_CTRL or self.view.game.playback is not None:
            self.view.zoom(NOTCH ** getattr(event, "precise_y", event.y), self.at)
        else:
            other = bool(held & pygame.KMOD_SHIFT) or event.x != 0
            session = self.view.game.session
            self.view.game.nudge(aim.spun(session, int(other), event.y or event.x))

    def _pressed(self, at: Place) -> None:
        view, game = self.view, self.view.game
        button = view.bar.command_at(at)
        if button is not None:
            commands.do(view, button)
        elif view.over is not None:
            over, view.over = view.over, None
            if over.pressed(at):
                view.over = over
        elif view.bar.share_at(at) is not None and game.playback is not None:
            self.scrubbing = True
            game.playback.playing = False
            self._scrub(at)
        elif view.area.collidepoint(at):
            aimed = view.aim_on_map(at)
            if "tape" in view.on:
                self._lay(at)
            elif pygame.key.get_mods() & pygame.KMOD_CTRL:
                self.panning = True
            elif aimed is not None:
                game.nudge(aim.aimed(game.session, *aimed))
            elif view.on_charts(at):
                commands.do(view, "graphs")
            elif (grip := view.handle_at(at)) is not None:
                view.hold()
                game.begin_drag(grip)
                self.grabbed = at
            elif (pad := view.pad) is not None and pad.rect.collidepoint(at):
                self.spinning = True
                game.nudge(pad.changes(at))
            elif game.playback is None:
                self._begin_pull(at)
            elif game.playback.over:
                self.pressed = at
            else:
                self.panning = True
                game.tell("Enter to aim again, Space to pause")

    def _begin_pull(self, at: Place) -> None:
        stage = self.view.stage
        stretch = stage.camera.stretch if stage is not None else 1.0
        self.view.game.begin_pull(at, self.view.area.height, stretch)

    def _scrub(self, at: Place) -> None:
        playback = self.view.game.playback
        if playback is not None:
            playback.seek(self.view.bar.share(at) * playback.duration)
            self.view.changed = True

    def _lay(self, at: Place) -> None:
        camera = self.view.camera
        if camera is not None and self.view.area.collidepoint(at):
            place = camera.world(*at)
            self.view.tape, self.laying = Tape(place, place), True

    def _moved(self, before: Place, at: Place) -> None:
        view, game = self.view, self.view.game
        camera, view.at = view.camera if self.laying else None, at
        if camera is not None and view.tape is not None:
            view.tape.end = camera.world(*at)
        elif self.scrubbing:
            self._scrub(at)
        elif self.panning:
            view.pan(at[0] - before[0], at[1] - before[1])
        elif self.pressed is not None:
            # a pull ends the watching of a shot that is over, a click does not
            if abs(at[0] - self.pressed[0]) + abs(at[1] - self.pressed[1]) >= aim.LEAST:
                game.aim_again(from_rest=True)
                self._begin_pull(self.pressed)
                self.pressed = None
                game.pull_to(at)
        elif self.spinning and (pad := view.pad) is not None:
            game.nudge(pad.changes(at))
        elif game.grip is not None:
            snap = bool(pygame.key.get_mods() & pygame.KMOD_SHIFT)
            game.drag_to(view.dragged(game.grip, self.grabbed, at), view.step_of(game.grip, snap))
        else:
            game.pull_to(at)

    def _released(self) -> None:
        self.scrubbing = self.laying = self.panning = self.spinning = False
        self.pressed = None
        self.view.game.release()
        self.view.free()
