"""A game drawn: the parts of the window put together, and passed time to."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import pygame

from sandbox.picture.lettering import Lettering
from sandbox.picture.palette import palette, set_contrast
from sandbox.window.background import Background
from sandbox.window.canvas import Canvas
from sandbox.window.cards import Cards
from sandbox.window.drawing import Drawing
from sandbox.window.fan_of_shot import FanOfShot
from sandbox.window.game import Game
from sandbox.window.map_of_shot import MapOfShot
from sandbox.window.menu import Thumbnails
from sandbox.window.panel import Panel
from sandbox.window.screen import Screen
from sandbox.window.shown import Shown
from sandbox.window.stages import Stages
from sandbox.window.targets import Targets
from sandbox.window.viewpoint import Viewpoint

if TYPE_CHECKING:
    from sandbox.window.sound import Sound

CARD = palette("card")


class View:
    """Draws a game on a surface; ``tick`` passes time, ``draw`` makes the current picture. Each part has one subject,
    and knows only those made before it."""

    def __init__(
        self,
        game: Game,
        surface: pygame.Surface,
        sound: Sound | None = None,
        patience: float = 0.0,
        hint_of: Callable[[str], str] = str,
    ) -> None:
        """A frame waits up to ``patience`` s for a stage. ``hint_of`` says what a button of the bar does."""
        self.game, self.sound, self.hint_of = game, sound, hint_of
        self.background, self.writer = Background(), Background()  # for what is seen, and for files
        self.thumbnails = Thumbnails(game.workers.helper)
        self.shown = Shown(game)
        self.panel = Panel(game, self.shown.open)
        self.screen = Screen(surface)
        self.stages = Stages(game, self.screen, self.background, patience)
        self.viewpoint = Viewpoint(game, self.screen, self.shown, self.stages)
        self.targets = Targets(game, self.screen, self.stages)
        self.fan = FanOfShot(game, self.screen, self.shown, self.stages)
        self.map = MapOfShot(game, self.shown)
        self.cards = Cards(game, self.screen, self.shown, self.viewpoint, self.fan, self.map, self.targets)
        self.drawing = Drawing(
            game, self.screen, self.shown, self.stages, self.viewpoint, self.fan, self.targets, self.cards
        )
        self.changed = True  # something that is not ``seen``
        self._contest: Any = None  # of the last frame
        self._drawn: Any = None  # what was seen in the picture drawn last

    def lay_out(self) -> None:
        """Places for everything, for the window's size and what is switched on."""
        before, self.changed = self.screen.area, True
        self.screen.lay_out(self.panel if self.shown.has_panel else None)
        if self.screen.area != before:
            self.stages.choose(None)

    def resized(self) -> None:
        """Lay out again if the window's size has changed."""
        if self.screen.resized():
            self.lay_out()

    def toggle_full_screen(self) -> None:
        """Switch between full screen and the window."""
        self.screen.toggle_full_screen()
        self.resized()

    def set_look(self, larger: float, contrast: bool) -> None:
        """Draw everything anew with other letters or colours, now and next time."""
        Lettering.larger = larger
        set_contrast(contrast)
        self.game.memory.look = larger, contrast
        self.game.memory.save()
        self.stages.forget()
        self.lay_out()

    def on_panel(self, at: tuple[int, int]) -> bool:
        """True if a place (px) is on the panel."""
        return self.shown.has_panel and bool(self.panel.rect.collidepoint(at))

    @property
    def switched(self) -> set[str]:
        """The commands whose switches are on, and the scene that is played."""
        sound = {"sound"} if self.sound is not None and self.sound.on else set()
        lab = {"lab"} if self.shown.in_lab else set()
        return {name for name in self.shown.on if self.shown.sees(name)} | sound | lab | {self.game.session.source}

    # Time

    @property
    def busy(self) -> bool:
        """True if something is being prepared that will have to be drawn."""
        overlay = self.shown.overlay
        pictures = overlay is not None and overlay.picture_count < len(overlay.pictures)
        playback = self.game.watching.playback
        moves = playback is not None and playback.moves_on
        coming = any(job.work is not None for job in (self.stages.job, self.fan.job, self.map.job))
        return pictures or coming or moves or self.stages.needs_stage or bool(self.fan.next_key or self.map.next_key)

    def tick(self, dt: float) -> None:
        """``dt`` s have passed."""
        game, overlay = self.game, self.shown.overlay
        in_menu = overlay is not None and overlay.name == "menu"
        if not in_menu:
            self.thumbnails.cancel()
        for hint, done in {"shoot": game.shots.count, "drag": game.grasp.grip, "menu": in_menu}.items():
            if done:
                game.memory.follow(hint)
        self._open_panel()
        self.changed |= self.stages.follow(dt)
        self.viewpoint.follow()
        self.changed |= self.fan.follow()
        self.changed |= self.map.follow()

    def _open_panel(self) -> None:
        """Open the panel for a contest in which something is set there."""
        contest = self.game.referee.contest
        if contest is not self._contest:
            self._contest = contest
            if contest is not None and contest.aimed_by_panel and not self.shown.has_panel:
                self.shown.on.add("panel")
                self.lay_out()

    # Drawing

    def needs_drawing(self, happened: bool) -> bool:
        """True if what would be drawn differs from what was drawn last."""
        seen = self.game.visible_state, self.shown.visible_state, self.stages.chosen, self.viewpoint.camera
        needed = happened or self.changed or seen != self._drawn or self.drawing.shows_how
        self._drawn, self.changed = seen, False
        return needed

    def draw(self) -> None:
        """The whole window."""
        screen, shown, mouse = self.screen, self.shown, self.targets.mouse
        self.drawing.draw()
        whole = Canvas(screen.canvas)
        if shown.has_panel:
            self.panel.draw(whole, mouse if shown.overlay is None else (-1, -1))
        self._draw_bar(whole)
        if shown.overlay is not None:
            shown.overlay.draw(screen.whole, mouse, self.switched)
        screen.present(self.game.session.title)

    def _draw_bar(self, sheet: Canvas) -> None:
        """The bar, with a hint at the button under the mouse."""
        game, shown, bar, mouse = self.game, self.shown, self.screen.bar, self.targets.mouse
        on = {*shown.on, *([shown.overlay.name] if shown.overlay is not None else [])}
        contest = game.referee.contest
        title = contest.title if contest is not None else game.session.title
        title += " *" * bool(game.session.changes.values and contest is None)
        known = not (shown.hides_path or game.failure or game.late)
        bar.draw(sheet, title, game.shot if known else None, game.watching.playback, on, mouse)
        button = bar.command_at(mouse)
        if button is not None and button not in on:
            at = bar.places[button].centerx, bar.rect.top - sheet.gap
            sheet.card([(self.hint_of(button), CARD["text"])], "midbottom", at)
