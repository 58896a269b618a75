"""What is shown above the bar: the shot as it would be, or at a time of its play, and what is switched on beside it."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import TYPE_CHECKING, Any

import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.palette import palette
from sandbox.picture.vectors import Vectors
from sandbox.window import aim, overlay
from sandbox.window.ahead import ready
from sandbox.window.canvas import Canvas
from sandbox.window.charts import Charts
from sandbox.window.measure import NEAR, draw_reading, reading, state_entries
from sandbox.window.playback import Playback
from sandbox.window.session import Shot
from sandbox.window.stage import Stage, headline

if TYPE_CHECKING:
    from sandbox.window.app import App

CARD = palette("card")

#: While the mouse pulls, the view is composed anew no sooner than after so many s: the place must not dance.
STEADY = 0.3
#: While the mouse pulls, words and numbers stay for so many s: quicker ones cannot be read.
LEGIBLE = 0.05


class View:
    """The picture of one window."""

    def __init__(self, app: App) -> None:
        self.app = app
        self.on = {"ghosts"}  # which of commands.SWITCHES
        self.menu: overlay.Menu | None = None
        self.choices: overlay.Choices | None = None
        self.energy: tuple[Shot, pygame.Surface] | None = None
        self.stage: Stage | None = None
        self.composed = 0.0  # s since then
        self.composing: Future[Stage] | None = None  # the next one
        self.head = pygame.Rect(0, 0, 0, 0)  # where the headline is
        self._told: Shot | None = None
        self.told_for = 0.0  # s since its words were chosen
        self._near: tuple[Shot, Any] | None = None
        self._vectors: tuple[Shot, Vectors] | None = None
        self._charts: tuple[Shot, Charts] | None = None

    def clear(self) -> None:
        """Forget what was composed: the place, or its size, is another."""
        self.stage = self.composing = self._near = None

    def pass_time(self, dt: float) -> None:
        """``dt`` s have passed."""
        self.composed += dt
        self.told_for += dt

    @property
    def near(self) -> Any:
        """The picture of the shot that is shown, which goes with its ball."""
        shot = self.app.shot
        assert shot is not None
        if self._near is None or self._near[0] is not shot:
            self._near = shot, shot.scene.picture(shot.run, self.app.area.size)
        return self._near[1]

    @property
    def follows(self) -> bool:
        """Whether the view goes with the ball."""
        stage = self.stage
        return self.app.playback is not None and ("view" in self.on or stage is None or stage.camera is None)

    @property
    def camera(self) -> Camera | None:
        """Of what is shown; None where the scene does not tell."""
        if not self.follows:
            return self.stage.camera if self.stage is not None else None
        view: Callable[[float], Camera] | None = getattr(self.near, "view", None)
        return view(self.app.playback.t) if view is not None and self.app.playback is not None else None

    def draw(self) -> None:
        """Everything above the bar."""
        app = self.app
        if app.shot is None:
            sheet = self._empty()
        else:
            self._take_stage(app.shot)
            sheet = self._aiming(app.shot) if app.playback is None else self._playing(app.shot, app.playback)
            self._beside(sheet, app.shot)
        if self.energy is not None and self.energy[0] is app.shot:
            surface = self.energy[1]
            sheet.surface.blit(surface, surface.get_rect(center=sheet.surface.get_rect().center))
        else:
            self.energy = None
        if app.message is not None:
            overlay.draw_message(sheet, app.message[0], app.message[1])

    def draw_over(self, canvas: pygame.Surface, height: int) -> None:
        """What lies over all but the bar, the panel too: the keys, the scenes, the lists of commands."""
        if "help" not in self.on and self.menu is None and self.choices is None:
            return
        app, size = self.app, (canvas.get_width(), height)
        sheet = Canvas(canvas.subsurface((0, 0), size))
        if self.menu is not None:
            self.menu.draw(sheet, app.session.title, app.pointer.at)
        if "help" in self.on:
            overlay.draw_help(sheet)
        if self.choices is not None:
            button = app.bar.places[self.choices.group]  # these three are never left out
            words = {"accuracy": f"accuracy: {app.session.value('accuracy.level')}, and the next"}
            self.choices.draw(sheet, button, self.switched, words, app.pointer.at)

    def _empty(self) -> Canvas:
        sheet = Canvas(self.app.surface)
        sheet.surface.fill(CARD["background"])
        return sheet

    def _take_stage(self, shot: Shot) -> None:
        """Go over to a stage that was composed; the first one is waited for."""
        if self.stage is None:
            self._compose(shot)
        if self.composing is None or not ready(self.composing, self.app.patience if self.stage is not None else None):
            return
        composing, self.composing, self.composed = self.composing, None, 0.0

        def take() -> None:
            self.stage = composing.result()

        self.app.trying(take)

    def follow(self) -> None:
        """Have a stage composed that shows the shot, if this one does not; it comes with a later frame."""
        app, stage = self.app, self.stage
        if app.shot is None or stage is None or self.composing is not None or app.playback is not None:
            return
        if (self.composed >= STEADY or not app.pointer.pulling) and not stage.holds(app.shot):
            self._compose(app.shot)

    def _compose(self, shot: Shot) -> None:
        size, before = self.app.area.size, self.stage
        self.composing = self.app.ahead.submit(Stage, shot, size, before)

    # The two states

    def _aiming(self, shot: Shot) -> Canvas:
        """The shot as it would be."""
        app, stage = self.app, self.stage
        if stage is None:
            return self._empty()
        sheet = stage.sheet(app.surface)
        if stage.camera is None:
            return sheet
        if "ghosts" in self.on:
            stage.draw_ghosts(sheet, [*app.session.recent, *([app.before] if app.before is not None else [])])
        self._cloud(sheet, stage)
        stage.draw_path(sheet, shot)
        stage.draw_balls(sheet, 0.0)
        self._arrows(sheet, shot, stage.ball_at(shot), 0.0)
        words = self._words(shot)
        self.head = headline(sheet, words.verdict, self._note(), CARD["good"] if words.scored else CARD["text"])
        pull = app.pointer.pull
        if pull is not None and app.pointer.pulling:
            longest = aim.FULL * app.area.height
            scale = min(1.0, longest / (pull[0] ** 2 + pull[1] ** 2) ** 0.5)
            stage.draw_pull(
                sheet,
                stage.ball_at(shot),
                (pull[0] * scale, pull[1] * scale),
                words.card[0][1] if words.card else "",
            )
        entries = [*words.card, *(self._forces(shot).entries(0.0) if "arrows" in self.on else [])]
        sheet.numbers(entries)
        return sheet

    def _words(self, shot: Shot) -> Shot:
        """The shot whose words and numbers are shown: during a pull they wait a moment, to be read."""
        if self._told is None or not self.app.pointer.pulling or self.told_for >= LEGIBLE:
            self._told, self.told_for = shot, 0.0
        return self._told

    def _note(self) -> str:
        if self.app.pointer.pull is not None:
            return "let go to shoot, Esc to leave it"
        return "pull back from the ball and let go, or press Space"

    def _playing(self, shot: Shot, playback: Playback) -> Canvas:
        """The shot at a time of its play."""
        app, stage, t = self.app, self.stage, playback.t
        if self.follows or stage is None:
            sheet = Canvas(app.surface)
            sheet.surface.blit(self.near.frame(t), (0, 0))
            return sheet
        sheet = stage.sheet(app.surface)
        if "ghosts" in self.on:
            stage.draw_ghosts(sheet, [earlier for earlier in app.session.recent if earlier is not shot])
        self._cloud(sheet, stage)
        stage.draw_path(sheet, shot, t)
        stage.draw_balls(sheet, t, self.near)
        self._arrows(sheet, shot, stage.ball_at(shot, t), t)
        forces = self._forces(shot).entries(t) if "arrows" in self.on else []
        if playback.over:
            colour = CARD["good"] if shot.scored else CARD["text"]
            again = "go on" if app.session.controls.goes_on is not None else "aim again"
            self.head = headline(sheet, shot.verdict, f"Enter to {again}, R to see it again", colour)
            entries = [*shot.card, *forces]
        else:
            self.head = headline(sheet, f"{t:.2f} s", f"shot {app.chosen + 1}", CARD["text"])
            entries = [*state_entries(shot, shot.ball, t), *forces]
        sheet.numbers(entries)
        return sheet

    # Beside the shot

    def _cloud(self, sheet: Canvas, stage: Stage) -> None:
        if self.app.fan is not None and stage.camera is not None:
            self.app.fan.draw(sheet, stage.camera)

    def _forces(self, shot: Shot) -> Vectors:
        if self._vectors is None or self._vectors[0] is not shot:
            self._vectors = shot, Vectors(shot.run, shot.ball)
        return self._vectors[1]

    def _arrows(self, sheet: Canvas, shot: Shot, at: tuple[float, float], t: float) -> None:
        if "arrows" in self.on:
            self._forces(shot).draw(sheet, at, 9 * sheet.unit, t)

    def _beside(self, sheet: Canvas, shot: Shot) -> None:
        """Cards down the right side, what the mouse reads, the tape."""
        app, top = self.app, float(sheet.frame.top)
        if "cost" in self.on:
            text = (
                f"frame {1e3 * app.frame_cost:.1f} ms; run {1e3 * app.cost:.1f} ms, "
                f"{app.session.value('accuracy.level')}"
            )
            top = overlay.draw_note(sheet, [(text, CARD["accent"])], top, self.head)
        if app.fan is not None:
            share, spread = app.fan.told()
            top = overlay.draw_note(sheet, [(share, CARD["text"]), (spread, CARD["quiet"])], top, self.head)
        if "charts" in self.on:
            if self._charts is None or self._charts[0] is not shot:
                self._charts = shot, Charts(shot)
            t = app.playback.t if app.playback is not None else None
            self._charts[1].draw(sheet, top, t, self.head)
        camera, pointer = self.camera, app.pointer
        if camera is not None and pointer.tape is not None:
            pointer.tape.draw(sheet, camera, shot.upright)
        if camera is None or self.follows or self.covered or pointer.pull is not None or pointer.laying:
            return
        if app.area.collidepoint(pointer.at):
            until = app.playback.t if app.playback is not None else None
            read = reading(shot, camera, pointer.at, NEAR * sheet.unit, until)
            if read is not None:
                draw_reading(sheet, shot, read)

    @property
    def switched(self) -> set[str]:
        """The commands whose switches are on."""
        app = self.app
        others = {"panel": app.has_panel, "sound": app.sound is not None and app.sound.on}
        return self.on | {command for command, on in others.items() if on}

    @property
    def covered(self) -> bool:
        """Whether something lies over the picture."""
        return self.menu is not None or self.choices is not None or "help" in self.on or self.energy is not None
