"""The mouse: pull, drag handles, sliders, the time line or the tape, zoom and move the picture, press buttons."""

from __future__ import annotations

from collections.abc import Callable
from math import dist

import numpy as np
import pygame

from sandbox.window import aim, commands
from sandbox.window.hand import ShownGrip
from sandbox.window.measure import Tape
from sandbox.window.referee import COMPUTER
from sandbox.window.scoreboard import CHOICES
from sandbox.window.view import View

_Pixel = tuple[int, int]  # px

#: One notch of the wheel enlarges the picture by this factor.
NOTCH = 1.15


class Pointer:
    """The mouse over one window."""

    def __init__(self, view: View) -> None:
        self.view = view
        self.drag: Callable[[_Pixel], object] | None = None  # what the next place of a drag does
        self.fingers: dict[int, tuple[float, float]] = {}  # on a touch screen, px

    def handle(self, event: pygame.event.Event) -> None:
        """One event of the mouse, or of fingers on a screen: one is a mouse, two zoom and move the picture."""
        view = self.view
        if event.type in (pygame.FINGERDOWN, pygame.FINGERMOTION, pygame.FINGERUP):
            self._touched(event)
            return
        if len(self.fingers) > 1 and getattr(event, "touch", False):
            return
        at = view.screen.from_window(getattr(event, "pos", (0, 0)))
        match event.type:
            case pygame.MOUSEMOTION:
                if self.drag is not None:
                    self.drag(at)
                view.targets.mouse = at
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_LEFT:
                view.targets.mouse = at
                self.drag = self._pressed(at)
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_RIGHT:
                self.drag = self._lay(at)
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_MIDDLE:
                view.targets.mouse = at
                self.drag = self._pan if view.screen.area.collidepoint(at) else None
            case pygame.MOUSEBUTTONUP if event.button == pygame.BUTTON_LEFT:
                self._released()
            case pygame.MOUSEBUTTONUP if event.button in (pygame.BUTTON_RIGHT, pygame.BUTTON_MIDDLE):
                self.drag = None
            case pygame.MOUSEWHEEL:
                self._turned(event)

    def _touched(self, event: pygame.event.Event) -> None:
        """Fingers on a touch screen."""
        before = list(self.fingers.values())
        width, height = self.view.screen.canvas.get_size()
        if event.type == pygame.FINGERUP:
            self.fingers.pop(event.finger_id, None)
        else:
            self.fingers[event.finger_id] = event.x * width, event.y * height
        now = list(self.fingers.values())
        if len(now) == 2 and event.type == pygame.FINGERDOWN:  # the first finger did not mean to pull
            self.view.game.grasp.cancel()
            self._released()
        elif len(now) == len(before) == 2:
            (x0, y0), (x, y) = (np.mean(points, axis=0) for points in (before, now))
            self.view.viewpoint.pan(x - x0, y - y0)
            self.view.viewpoint.zoom(dist(*now) / max(dist(*before), 1.0), (x, y))

    def _turned(self, event: pygame.event.Event) -> None:
        """The wheel, or a trackpad: the size of the picture with Ctrl, or while a shot is watched; else spin."""
        held, view = pygame.key.get_mods(), self.view
        if view.shown.overlay is not None:
            view.shown.overlay.scroll(-event.y)
        elif view.on_panel(view.targets.mouse):
            view.panel.scroll(-event.y)
        elif held & pygame.KMOD_CTRL or view.game.watching.playback is not None:
            view.viewpoint.zoom(NOTCH ** getattr(event, "precise_y", event.y), view.targets.mouse)
        else:
            other = bool(held & pygame.KMOD_SHIFT) or event.x != 0
            view.game.aiming.nudge(aim.spun(view.game.session, int(other), event.y or event.x))

    def _pressed(self, at: _Pixel) -> Callable[[_Pixel], object] | None:
        """Do what a press does; returns what dragging from there does."""
        view, game = self.view, self.view.game
        button = view.screen.bar.command_at(at)
        view.panel.enter()
        if button is not None:
            commands.do(view, button)
        elif view.shown.overlay is not None:
            view.shown.click_overlay(at)
        elif view.screen.bar.on_line(at) and game.watching.playback is not None:
            game.watching.playback.playing = False
            return self._begun(self._scrub, at)
        elif view.on_panel(at):
            drag = view.panel.press(at)
            return self._begun(drag, at) if drag is not None else None
        elif view.screen.area.collidepoint(at):
            return self._on_picture(at)
        return None

    def _on_picture(self, at: _Pixel) -> Callable[[_Pixel], object] | None:
        view, game = self.view, self.view.game
        if not view.stages.ready:
            game.messages.tell("the scene is still loading")
            return None
        if view.shown.sees("tape"):
            return self._lay(at)
        if pygame.key.get_mods() & pygame.KMOD_CTRL:
            return self._pan
        card = view.targets.card_at(at)
        if card == "map":
            return self._begun(self._aim_on_map, at)
        if card in CHOICES:
            commands.do(view, card)
            return None
        if card == "charts":
            commands.do(view, "graphs")
        elif (shown := view.targets.grip_at(at)) is not None:
            view.viewpoint.hold()
            game.grasp.begin_drag(shown.grip)
            return lambda to: self._drag_handle(shown, at, to)
        elif (pad := view.targets.pad) is not None and pad.rect.collidepoint(at):
            return self._begun(lambda to: game.aiming.nudge(pad.changes(to)), at)
        elif game.watching.playback is None and game.referee.computers_turn:
            game.messages.tell(COMPUTER)
        elif game.watching.playback is None:
            return self._pull(at)
        elif game.referee.contest is not None and game.referee.tells and not game.referee.is_over:
            game.aiming.again()  # the next shot
            return self._pull(at)
        elif game.watching.playback.over:
            return lambda to: self._perhaps_pull(at, to)
        elif game.referee.contest is not None:  # a pull that comes too early would move the picture for the next shot
            game.messages.tell("Enter for the next shot, Space to pause")
        else:
            game.messages.tell("Enter to aim again, Space to pause")
            return self._pan
        return None

    @staticmethod
    def _begun(drag: Callable[[_Pixel], object], at: _Pixel) -> Callable[[_Pixel], object]:
        """A drag that does something at once."""
        drag(at)
        return drag

    def _aim_on_map(self, to: _Pixel) -> None:
        """Aim with the speed and the angle at a place of the map."""
        view, known = self.view, self.view.map.job.value
        rect = view.targets.cards.get("map")
        if known is not None and rect is not None:
            shares = (to[0] - rect.left) / rect.width, (rect.bottom - to[1]) / rect.height
            across, up = (min(max(share, 0.0), 1.0) for share in shares)
            view.game.aiming.nudge(aim.aimed(view.game.session, *known.aim(across, up)))

    def _pan(self, to: _Pixel) -> None:
        self.view.viewpoint.pan(to[0] - self.view.targets.mouse[0], to[1] - self.view.targets.mouse[1])

    def _scrub(self, to: _Pixel) -> None:
        playback = self.view.game.watching.playback
        if playback is not None:
            playback.seek(self.view.screen.bar.share(to) * playback.duration)
            self.view.changed = True

    def _drag_handle(self, shown: ShownGrip, start: _Pixel, to: _Pixel) -> None:
        if self.view.game.grasp.grip is not None:
            step = shown.step(snap=bool(pygame.key.get_mods() & pygame.KMOD_SHIFT))
            self.view.game.grasp.drag_to(shown.dragged(start, to), step)

    def _pull(self, at: _Pixel) -> Callable[[_Pixel], object]:
        view = self.view
        stretch = view.stages.latest.camera.stretch if view.stages.latest is not None else 1.0
        view.game.grasp.begin_pull(at, view.screen.canvas.get_size(), view.screen.area.height, stretch)
        return lambda to: view.game.grasp.pull_to(to, fine=bool(pygame.key.get_mods() & pygame.KMOD_SHIFT))

    def _perhaps_pull(self, start: _Pixel, to: _Pixel) -> None:
        """A pull ends the watching of a shot that is over; a click does not."""
        if abs(to[0] - start[0]) + abs(to[1] - start[1]) >= aim.LEAST:
            self.view.game.aiming.again(from_rest=True)
            self.drag = self._pull(start)
            self.drag(to)

    def _lay(self, at: _Pixel) -> Callable[[_Pixel], object] | None:
        view = self.view
        if view.viewpoint.camera is None or not view.screen.area.collidepoint(at):
            return None
        start = view.viewpoint.camera.world(*at)

        def lay(to: _Pixel) -> None:
            if view.viewpoint.camera is not None:
                view.shown.tape = Tape(start, view.viewpoint.camera.world(*to))

        return self._begun(lay, at)

    def _released(self) -> None:
        self.drag = None
        self._mark()
        self.view.game.grasp.release()
        self.view.viewpoint.release()

    def _mark(self) -> None:
        """A click, and no pull, marks a place where a contest asks for one."""
        game, camera = self.view.game, self.view.viewpoint.camera
        contest, pull = game.referee.contest, game.grasp.pull
        if contest is not None and contest.takes_marks and pull is not None and not pull.shoots and camera is not None:
            contest.put(camera.world(*pull.start))
