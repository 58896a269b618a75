"""How a game is drawn: the layout of the window, and what is switched on.

The picture shows a shot on the stage that was composed for its parameters. Until the stage of the current shot is
ready, the last picture stays: a path is never drawn on the stage of another place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import replace
from threading import Thread
from typing import TYPE_CHECKING, Any

import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.palette import palette
from sandbox.picture.sheet import Entry, rows_of
from sandbox.picture.vectors import Vectors
from sandbox.window import overlay
from sandbox.window.background import Background, ready
from sandbox.window.bar import HEIGHT, Bar, Shown
from sandbox.window.canvas import Canvas
from sandbox.window.charts import Charts
from sandbox.window.fan_layer import FanLayer
from sandbox.window.game import Game
from sandbox.window.measure import NEAR, Tape, draw_reading, reading, state_entries
from sandbox.window.playback import Playback
from sandbox.window.shot import Shot
from sandbox.window.stage import Stage, headline

if TYPE_CHECKING:
    from sandbox.window.panel import Panel
    from sandbox.window.sound import Sound

CARD = palette("card")

SIZE = (1280, 720)
#: Everything is drawn at least this large; a smaller window shows a part of it.
SMALLEST = (480, 400)
#: While an aim changes, the stage is composed anew at most this often, in s: the place must not jitter.
STEADY = 0.3
#: An aim that has not changed for this time, in s, gets a stage of its own.
AT_REST = 0.15
#: While the mouse pulls, words and numbers stay for at least this time, in s, to be readable.
LEGIBLE = 0.05
#: The panel, for its tooltips and blinking cursor, is drawn in every frame until the first time, in s, after an event;
#: later at intervals of the second while somebody types.
LIVELY, BLINK = 1.5, 0.25
#: Largest and smallest zoom, compared with a view of the whole shot.
NEAREST, FARTHEST = 60.0, 0.2


class View:
    """Draws a game on a screen; ``tick`` passes time, ``draw`` makes the current picture."""

    def __init__(self, game: Game, screen: pygame.Surface, sound: Sound | None = None, patience: float = 0.0) -> None:
        """A frame waits up to ``patience`` s for a stage or the panel; in a window, where the last picture stays until
        then, it does not wait."""
        self.patience = patience
        self.game, self.screen, self.sound = game, screen, sound
        self.background = Background()
        self.on = {"ghosts"}  # which of commands.SWITCHES
        self.at = (-1, -1)  # px, the mouse
        self.menu: overlay.Menu | None = None
        self.choices: overlay.Choices | None = None
        self.tape: Tape | None = None
        self.energy: tuple[Shot, Future[pygame.Surface]] | None = None
        self.panel: Panel | None = None
        self.panel_wanted = False
        self.building: Future[Panel] | None = None  # the panel
        self.stage: Stage | None = None
        self.composing: Future[Stage] | None = None  # the next one
        self.composed = 0.0  # s since the last one
        self.composed_for: Shot | None = None  # the shot of the last one
        self.undrawable: str | None = None  # why there is none
        self.chosen: Camera | None = None  # by zooming; None shows all of the shot
        self.head = pygame.Rect(0, 0, 0, 0)  # where the headline is
        self.frame_cost = 0.0  # s, smoothed
        self.changed = True  # something other than the game
        self.exporter: Thread | None = None  # writes an animation, which takes seconds
        self.windowed = SIZE  # its size before full screen
        self.caption = ""
        self._seen: Any = None  # what was drawn last
        self._lively = 0.0  # s since the last event
        self._picture: pygame.Surface | None = None  # what was drawn last above the bar
        self._worded: Shot | None = None
        self._worded_for = 0.0  # s since its words were chosen
        self._near: tuple[Shot, Any] | None = None
        self._vectors: tuple[Shot, Vectors] | None = None
        self._charts: tuple[Shot, Charts] | None = None
        self._fan: FanLayer | None = None
        self.lay_out()

    # ------------------------------------------------------------------------------------------------------- places

    def lay_out(self) -> None:
        """Places for everything, for the window's size."""
        self.laid_out = self.screen.get_size()
        width, height = (max(a, b) for a, b in zip(self.laid_out, SMALLEST, strict=True))
        fits = (width, height) == self.laid_out
        self.canvas: pygame.Surface = self.screen if fits else pygame.Surface((width, height))
        rows = rows_of((width, height))
        tall = round(HEIGHT * rows / 720)
        self.bar = Bar(pygame.Rect(0, height - tall, width, tall), rows)
        group = self.panel.group if self.panel is not None else ""
        self.building = None
        if self.panel_wanted:
            self.building = self.background.submit(_panel, self.game, (width, height), height - tall, group)
        self._make_room(None)

    def _make_room(self, panel: Panel | None) -> None:
        """Give the picture the width that the panel leaves."""
        self.panel = panel
        wide = panel.rect.width if panel is not None else 0
        self.area = pygame.Rect(0, 0, self.canvas.get_width() - wide, self.bar.rect.top)
        self.chosen = self._picture = None
        self.changed = True

    def _take_panel(self) -> None:
        """Show the panel once it is built."""
        if self.building is None or not ready(self.building, self.patience):
            return
        building, self.building = self.building, None
        self.panel_wanted = self.game.trying(lambda: self._make_room(building.result()))

    def open_panel(self, wanted: bool) -> None:
        """Show the panel of parameters, or close it."""
        self.panel_wanted = wanted
        self.lay_out()

    def resized(self) -> None:
        """Lay out again if the window's size has changed."""
        screen = pygame.display.get_surface()
        if screen is not None and self.laid_out != screen.get_size():  # it may be the same surface, now larger
            self.screen = screen
            self.lay_out()

    def toggle_full_screen(self) -> None:
        """Switch between full screen and the window."""
        if pygame.display.is_fullscreen():
            pygame.display.set_mode(self.windowed, pygame.RESIZABLE)
        else:
            self.windowed = self.laid_out
            pygame.display.set_mode((0, 0), pygame.FULLSCREEN)
        self.resized()

    def close_overlays(self) -> bool:
        """Close what covers the picture; returns whether there was anything."""
        was = self.covered
        self.menu = self.choices = self.energy = None
        self.on.discard("help")
        self.changed |= was
        return was

    @property
    def covered(self) -> bool:
        """Whether something covers the picture."""
        return self.menu is not None or self.choices is not None or "help" in self.on or self.energy is not None

    @property
    def switched(self) -> set[str]:
        """The commands whose switches are on."""
        sound = self.sound is not None and self.sound.on
        others = {"panel": self.panel_wanted, "sound": sound, "fan": self.game.fan_wanted}
        return self.on | {command for command, on in others.items() if on}

    # ------------------------------------------------------------------------------------------------------- cameras

    @property
    def follows(self) -> bool:
        """Whether the view follows the ball."""
        stage = self.stage
        return self.game.playback is not None and ("view" in self.on or stage is None or stage.camera is None)

    @property
    def camera(self) -> Camera | None:
        """The current camera; None if the scene has none."""
        playback, shot = self.game.playback, self.game.shot
        if not self.follows or playback is None or shot is None:
            return self.stage.camera if self.stage is not None else None
        view: Callable[[float], Camera] | None = getattr(self.near(shot), "view", None)
        return view(playback.t) if view is not None else None

    def near(self, shot: Shot) -> Any:
        """The picture of a shot that follows its ball."""
        if self.stage is not None and self.stage.shot.run is shot.run and self.stage.chosen is None:
            return self.stage.picture
        if self._near is None or self._near[0] is not shot:
            self._near = shot, shot.scene.picture(shot.run, self.area.size)
        return self._near[1]

    def zoom(self, factor: float, at: tuple[float, float]) -> None:
        """Zoom by ``factor`` around a place (px); in a view from the side the ground stays where it is."""
        camera, shot = self._standing_camera(), self.game.shot
        whole = self.stage.whole if self.stage is not None else None
        if camera is None or whole is None or shot is None:
            return
        scale = min(max(camera.scale * factor, FARTHEST * whole.scale), NEAREST * whole.scale)
        x, y = camera.world(*at)
        anchor = (at[0], camera.pixel(x, camera.at[1])[1]) if shot.upright else at
        self.look(replace(camera, at=(x, camera.at[1] if shot.upright else y), anchor=anchor, scale=scale))

    def pan(self, across: float, down: float) -> None:
        """Move the picture by so many px."""
        camera, shot = self._standing_camera(), self.game.shot
        if camera is not None and shot is not None:
            right, foot = camera.anchor
            self.look(replace(camera, anchor=(right + across, foot if shot.upright else foot + down)))

    def look(self, camera: Camera | None) -> None:
        """Use another camera; None shows all of the shot."""
        if self.stage is not None and not self.stage.turns:
            self.game.tell("the picture of this scene always shows all of it")
            return
        if self.follows:
            self.game.tell("the view follows the ball; V for the whole view")
            return
        self.chosen = camera
        self.changed = True

    def _standing_camera(self) -> Camera | None:
        return self.chosen or (self.stage.camera if self.stage is not None else None)

    # ------------------------------------------------------------------------------------------------------- time

    @property
    def up_to_date(self) -> bool:
        """Whether the stage belongs to the shot, so that the current picture is drawn."""
        shot, stage = self.game.shot, self.stage
        return shot is None or (stage is not None and self._may_draw(stage, shot))

    @property
    def complete(self) -> bool:
        """Whether the shot is drawn, or cannot be."""
        game = self.game
        if game.failure is not None or self.undrawable is not None:
            return True
        return game.shot is not None and self.stage is not None and self.up_to_date

    @property
    def busy(self) -> bool:
        """Whether something is being prepared that will have to be drawn."""
        energy = self.energy is not None and not self.energy[1].done()
        fan = self._fan is not None and not self._fan.complete
        lively = self.panel is not None and (self._lively < LIVELY or not self.panel.complete)
        exporting = self.exporter is not None and self.exporter.is_alive()
        coming = self.composing is not None or self.building is not None or self._words_late
        return coming or self._stage_wanted() or energy or fan or lively or exporting

    def _may_draw(self, stage: Stage, shot: Shot) -> bool:
        """Whether a shot may be drawn on a stage: when watched only on its own, when aimed on one of the same place."""
        if stage.size != self.area.size:
            return False
        if stage.shows(shot, self.game.code, stage.chosen):
            return True
        return self.game.playback is None and stage.is_place_of(shot, self.game.code)

    def _stage_wanted(self) -> bool:
        """Whether the shot needs another stage, and one can be composed."""
        shot, stage = self.game.shot, self.stage
        if shot is None or (self.undrawable is not None and self.composed_for is shot):
            return False
        return stage is None or stage.size != self.area.size or not stage.shows(shot, self.game.code, self.chosen)

    def tick(self, dt: float, happened: bool) -> None:
        """``dt`` s have passed, and something may have happened in the window."""
        self._lively = 0.0 if happened else self._lively + dt
        self.composed += dt
        self._worded_for += dt
        self._take_panel()
        self._take_stage()
        self._follow()
        if self.panel is not None:
            self.panel.update(dt)
        if self.energy is not None and self.energy[0] is not self.game.shot:
            self.energy, self.changed = None, True

    def _take_stage(self) -> None:
        """Switch to a stage that was composed."""
        if self.composing is None or not ready(self.composing, self.patience):
            return
        composing, self.composing, self.composed, self.changed = self.composing, None, 0.0, True
        try:
            self.stage, self.undrawable = composing.result(), None
        except Exception as error:
            self.undrawable = f"{self.game.session.title} cannot be drawn: {self.game.reason(error)}"

    def _follow(self) -> None:
        """Start composing a stage for the shot, if this one does not show it."""
        game, stage = self.game, self.stage
        if self.composing is not None or not self._stage_wanted():
            return
        shot = game.shot
        assert shot is not None
        if stage is not None and game.playback is None and self._may_draw(stage, shot) and stage.chosen == self.chosen:
            moving = game.pull is not None or not game.settled or game.still < AT_REST
            if moving and (stage.holds(shot) or self.composed < STEADY):
                return
        self.composed_for = shot
        self.composing = self.background.submit(Stage, shot, self.area.size, game.code, self.chosen, stage)
        self._take_stage()

    # ------------------------------------------------------------------------------------------------------- drawing

    def needs_drawing(self, happened: bool) -> bool:
        """Whether what would be drawn differs from what was drawn last."""
        fan = self._fan is not None and not self._fan.complete
        lively = self.panel is not None and (self._lively < LIVELY or not self.panel.complete)
        blink = self._lively // BLINK if self.panel is not None and self.panel.typing else 0
        energy = self.energy is not None and self.energy[1].done()
        playback = self.game.playback
        clock = (playback.t, playback.playing, playback.rate) if playback is not None else None
        over = (self.menu, self.choices, self.tape, frozenset(self.on), energy)
        seen = (self.game.revision, self.game.failure, clock, over, self.panel, blink)
        needed = happened or self.changed or fan or lively or self._words_late or seen != self._seen
        self._seen, self.changed = seen, False
        return needed

    def draw(self) -> None:
        """The whole window."""
        try:
            self._draw_picture()
        except Exception as error:  # a scene's own code
            sheet = Canvas(self.canvas.subsurface(self.area))
            sheet.surface.fill(CARD["background"])
            text = f"{self.game.session.title} cannot be drawn: {self.game.reason(error)}"
            overlay.draw_messages(sheet, [(text, True)])
        if self.panel is not None:
            self.panel.draw(self.canvas)
        self.bar.draw(self.canvas, self._bar_shown(), self.at)
        self._draw_over()
        if self.canvas is not self.screen:
            self.screen.blit(self.canvas, (0, 0))
        if self.caption != self.game.session.title:
            self.caption = self.game.session.title
            pygame.display.set_caption(f"{self.caption} – Sports sandbox")

    def _draw_picture(self) -> None:
        """Everything above the bar."""
        game, shot, stage = self.game, self.game.shot, self.stage
        sheet = Canvas(self.canvas.subsurface(self.area))
        drawn = False
        if shot is not None and stage is not None and self.undrawable is None and self._may_draw(stage, shot):
            if game.failure is not None:
                self._draw_failure(sheet, stage)
                drawn = True
            elif game.playback is not None:
                self._draw_playing(sheet, stage, shot, game.playback)
                drawn = True
            elif game.same_place:
                self._draw_aiming(sheet, stage, shot)
                drawn = True
        if drawn:
            assert shot is not None
            if game.failure is None:
                self._draw_cards(sheet, shot)
            if self._picture is None:
                self._picture = pygame.Surface(self.area.size)
            self._picture.blit(sheet.surface, (0, 0))
        elif self._picture is not None:
            sheet.surface.blit(self._picture, (0, 0))
            if self.undrawable is not None or game.failure is not None:
                _darken(sheet.surface)
        else:
            sheet.surface.fill(CARD["background"])
        if self.energy is not None and self.energy[1].done():
            surface = self.energy[1].result()
            sheet.surface.blit(surface, surface.get_rect(center=sheet.surface.get_rect().center))
        undrawable = [(self.undrawable, True)] if self.undrawable is not None else []
        overlay.draw_messages(sheet, [*undrawable, *game.notices])

    def _draw_over(self) -> None:
        """What covers everything except the bar: the keys, the scenes, the lists of commands."""
        if "help" not in self.on and self.menu is None and self.choices is None:
            return
        sheet = Canvas(self.canvas.subsurface((0, 0), (self.canvas.get_width(), self.area.height)))
        if self.menu is not None:
            self.menu.draw(sheet, self.game.session.source, self.at)
        if "help" in self.on:
            overlay.draw_help(sheet)
        if self.choices is not None:
            button = self.bar.places[self.choices.group]  # these three are never left out
            words = {"accuracy": f"accuracy: {self.game.session.value('accuracy.level')}, and the next"}
            self.choices.draw(sheet, button, self.switched, words, self.at)

    def _draw_failure(self, sheet: Canvas, stage: Stage) -> None:
        """The place, dark and without a path: the current parameters have none."""
        sheet.surface.blit(stage.backdrop, (0, 0))
        _darken(sheet.surface)
        self.head = headline(sheet, "No path", ["the run of these parameters failed"], CARD["bad"])

    def _draw_aiming(self, sheet: Canvas, stage: Stage, shot: Shot) -> None:
        """The shot while it is aimed."""
        game = self.game
        sheet.surface.blit(stage.backdrop, (0, 0))
        if stage.camera is None:
            return
        if "ghosts" in self.on:
            before = [game.before_save] if game.before_save is not None else []
            stage.draw_ghosts(sheet, [*before, *game.recent], shot if game.pull is None else None)
        self._draw_fan(sheet, stage)
        stage.draw_path(sheet, shot)
        stage.draw_balls(sheet, 0.0)
        self._draw_arrows(sheet, shot, stage.ball_at(shot), 0.0)
        words = self._words(shot)
        notes = [self._hint(), *stage.notes]
        self.head = headline(sheet, words.verdict, notes, CARD["good"] if words.scored else CARD["text"])
        sheet.numbers([*words.card, *(self._forces(shot).entries(0.0) if "arrows" in self.on else [])])
        pull = game.pull
        if pull is not None and pull.shoots:
            vector = pull.drawn
            stage.draw_pull(sheet, pull.start, vector, words.aimed)

    def _words(self, shot: Shot) -> Shot:
        """The shot whose words and numbers are shown: during a pull they change less often, to be readable."""
        pulling = self.game.pull is not None and self.game.pull.shoots
        if self._worded is None or not pulling or self._worded_for >= LEGIBLE or self._worded.place != shot.place:
            self._worded, self._worded_for = shot, 0.0
        return self._worded

    @property
    def _words_late(self) -> bool:
        """Whether the words that are shown are those of an earlier aim."""
        game = self.game
        aiming = game.playback is None and game.failure is None and self.up_to_date
        return aiming and self._worded is not None and self._worded is not game.shot

    def _hint(self) -> str:
        if self.game.pull is not None:
            return "let go to shoot, Esc to cancel"
        return "pull back anywhere and let go, or press Space"

    def _draw_playing(self, sheet: Canvas, stage: Stage, shot: Shot, playback: Playback) -> None:
        """The shot during playback."""
        game, t = self.game, playback.t
        if self.follows:
            sheet.surface.blit(self.near(shot).frame(t), (0, 0))
            return
        sheet.surface.blit(stage.backdrop, (0, 0))
        if "ghosts" in self.on:
            others = [e for e in game.shots if e is not shot and (e.source, e.start) == (shot.source, shot.start)]
            stage.draw_ghosts(sheet, others, shot)
        self._draw_fan(sheet, stage)
        stage.draw_path(sheet, shot, t)
        stage.draw_balls(sheet, t)
        self._draw_arrows(sheet, shot, stage.ball_at(shot, t), t)
        forces = self._forces(shot).entries(t) if "arrows" in self.on else []
        name = f"{'replay' if shot.recorded else 'shot'} {shot.number}"
        if playback.over:
            colour = CARD["good"] if shot.scored else CARD["text"]
            again = "continue" if game.session.controls.next_start is not None else "aim again"
            notes = [name, f"Enter to {again}, R to see it again", *stage.notes]
            self.head = headline(sheet, shot.verdict, notes, colour)
            sheet.numbers([*shot.card, *forces])
        else:
            self.head = headline(sheet, f"{t:.2f} s", [name, *stage.notes], CARD["text"])
            sheet.numbers([*self._state(stage, shot, t), *forces])

    @staticmethod
    def _state(stage: Stage, shot: Shot, t: float) -> Sequence[Entry]:
        """The state of the ball at a time: as in the picture's own frames, if it has them."""
        live: Callable[[float], Sequence[Entry]] | None = getattr(stage.picture, "live", None)
        return live(t) if live is not None else state_entries(shot, shot.ball, t)

    # Around the shot

    def _draw_fan(self, sheet: Canvas, stage: Stage) -> None:
        fan = self.game.fan
        if fan is None or stage.camera is None:
            self._fan = None
            return
        if self._fan is None or (self._fan.fan, self._fan.camera) != (fan, stage.camera):
            self._fan = FanLayer(fan, stage.camera, sheet.size)
        self._fan.draw(sheet)

    def _forces(self, shot: Shot) -> Vectors:
        if self._vectors is None or self._vectors[0] is not shot:
            self._vectors = shot, Vectors(shot.run, shot.ball)
        return self._vectors[1]

    def _draw_arrows(self, sheet: Canvas, shot: Shot, at: tuple[float, float], t: float) -> None:
        if "arrows" in self.on:
            self._forces(shot).draw(sheet, at, 9 * sheet.unit, t)

    def _draw_cards(self, sheet: Canvas, shot: Shot) -> None:
        """Cards down the right side, what the mouse reads, the tape."""
        game, top = self.game, float(sheet.frame.top)
        if not self.follows and self.stage is not None:
            top = max(top, float(self.stage.foot_of_wind))
        if "cost" in self.on:
            level = game.session.value("accuracy.level")
            text = f"frame {1e3 * self.frame_cost:.1f} ms; run {1e3 * game.cost:.1f} ms, {level}"
            top = overlay.draw_note(sheet, [(text, CARD["accent"])], top, self.head)
        if game.fan is not None:
            share, spread = game.fan.summary()
            top = overlay.draw_note(sheet, [(share, CARD["text"]), (spread, CARD["quiet"])], top, self.head)
        if "charts" in self.on:
            if self._charts is None or self._charts[0] is not shot:
                self._charts = shot, Charts(shot, self.stage.picture if self.stage is not None else None)
            t = game.playback.t if game.playback is not None else None
            self._charts[1].draw(sheet, top, t, self.head)
        camera = self.camera
        if camera is not None and self.tape is not None:
            self.tape.draw(sheet, camera, shot.upright)
        if camera is None or self.follows or self.covered or game.pull is not None:
            return
        if self.area.collidepoint(self.at) and not pygame.mouse.get_pressed()[2]:
            until = game.playback.t if game.playback is not None else None
            read = reading(shot, camera, self.at, NEAR * sheet.unit, until)
            if read is not None and self.stage is not None:
                own = read.ball == shot.ball
                entries = self._state(self.stage, shot, read.t) if own else state_entries(shot, read.ball, read.t)
                draw_reading(sheet, shot, read, entries)

    def _bar_shown(self) -> Shown:
        """The contents of the bar."""
        game, playback, shot = self.game, self.game.playback, self.game.shot
        opened = {"help": "help" in self.on, "panel": self.panel is not None}
        if self.choices is not None:
            opened[self.choices.group] = True
        return Shown(
            title=game.session.title + (" *" if game.session.changes.values else ""),
            playing=playback is not None and playback.playing,
            t=playback.t if playback is not None else None,
            duration=playback.duration if playback is not None else shot.run.duration if shot else 0.0,
            ticks=tuple(e.t for e in shot.run.events if e.kind == "impact")[:200] if shot else (),
            rate=playback.rate if playback is not None else 1.0,
            texts=("see", "keep", "more", "panel", "help"),
            on=frozenset(name for name, on in opened.items() if on),
        )


def _panel(game: Game, size: tuple[int, int], height: int, group: str) -> Panel:
    """The panel of a window of ``size`` px."""
    from sandbox.window.panel import FAVOURITES, NARROWEST, WIDTH, Panel  # imports pygame_gui, which is slow

    wide = min(max(NARROWEST, round(WIDTH * rows_of(size) / 720)), size[0] // 2)
    rect = pygame.Rect(size[0] - wide, 0, wide, height)
    return Panel(size, rect, lambda: game.session, game.change, game.reset, group or FAVOURITES, game.patience)


def _darken(surface: pygame.Surface) -> None:
    """Dim what is drawn."""
    veil = pygame.Surface(surface.get_size(), pygame.SRCALPHA)
    veil.fill((*CARD["background"], 150))
    surface.blit(veil, (0, 0))
