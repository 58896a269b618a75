"""The picture above the bar: the shot on its stage, what the hand holds, and messages.

Until the stage of the current shot is ready, the last picture stays: a path is never drawn on the stage of another
place.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pygame

from sandbox.picture.palette import palette
from sandbox.picture.sheet import Entry
from sandbox.picture.vectors import Vectors
from sandbox.window import hand, scoreboard
from sandbox.window.background import KeyedCache
from sandbox.window.canvas import Canvas
from sandbox.window.cards import Cards, banner_forms
from sandbox.window.fan_of_shot import FanOfShot
from sandbox.window.game import Game
from sandbox.window.layout import Form, Layout
from sandbox.window.menu import tile_of
from sandbox.window.messages import reason
from sandbox.window.pad import Pad
from sandbox.window.referee import deciding_ball
from sandbox.window.screen import Screen
from sandbox.window.shots import Shot
from sandbox.window.shown import Shown
from sandbox.window.stage import Stage
from sandbox.window.stages import Stages
from sandbox.window.targets import Targets
from sandbox.window.viewpoint import Viewpoint

_CARD = palette("card")

#: Opacity (of 255) of what dims a picture without a path.
_DIMMED = 150
#: That of what dims the small picture of a scene, enlarged, until its place is there.
_LOADING = 190
#: The shot's direction is taken so far along its path, in px on 720 rows.
_AHEAD = 20.0


class Drawing:
    """Draws the picture; ``layout`` has the places of what was drawn last."""

    def __init__(
        self,
        game: Game,
        screen: Screen,
        shown: Shown,
        stages: Stages,
        viewpoint: Viewpoint,
        fan: FanOfShot,
        targets: Targets,
        cards: Cards,
    ) -> None:
        self.game, self.screen, self.shown, self.stages, self.viewpoint = game, screen, shown, stages, viewpoint
        self.fan, self.targets, self.cards = fan, targets, cards
        self.layout = Layout(screen.area, 0)
        self._banner_at = (0, 0)  # the middle of its upper edge, in px
        self._last: pygame.Surface | None = None  # the last picture of a shot
        self._once = KeyedCache()

    def draw(self) -> None:
        """Everything above the bar."""
        try:
            self._draw()
        except Exception as error:  # a scene's own code
            sheet = self.screen.sheet
            sheet.surface.fill(_CARD["background"])
            text = f"{self.game.session.title} cannot be drawn: {reason(error)}"
            sheet.messages(self._layout(sheet), [(text, True)])

    def _draw(self) -> None:
        game, shot, sheet, stage = self.game, self.game.shot, self.screen.sheet, self._stage()
        self.targets.clear()
        if stage is not None and shot is not None and not self._no_path:
            self._draw_all(sheet, stage, shot)
            return
        self.layout = self._layout(sheet)
        if stage is not None:
            self._draw_no_path(sheet, stage)
        else:
            self._draw_last(sheet)
        self._draw_messages(sheet)
        if game.failure is None:
            self._draw_hand(sheet, shot)

    @property
    def _no_path(self) -> bool:
        """True if the current parameters have no path, or none yet."""
        return self.game.failure is not None or self.game.late

    def _stage(self) -> Stage | None:
        """The stage to draw on; None while the last picture stays."""
        game, shot = self.game, self.game.shot
        if shot is None or self.stages.undrawable is not None:
            return None
        same = game.watching.playback is not None or shot.place == game.session.place
        stage = self.stages.of(shot) if same or self._no_path else None
        return stage if stage is None else self.viewpoint.framed(stage)

    def _draw_all(self, sheet: Canvas, stage: Stage, shot: Shot) -> None:
        """The shot, and what lies over it."""
        self.layout = self._layout(sheet, stage, shot)
        forces = self._draw_shot(sheet, stage, shot)
        self.cards.draw_words(sheet, self.layout, stage, shot, forces)
        self._keep(sheet)
        self._draw_messages(sheet)
        self._draw_hand(sheet, shot)
        self.cards.draw_readings(sheet, self.layout, stage, shot)
        self.cards.draw_cards(sheet, self.layout, stage, shot)
        self._draw_banner(sheet, shot)
        self._draw_contest(sheet, stage, shot)
        if self.shows_how:
            self._show_how(sheet, stage, shot)
        if "ghosts" in self.shown.on and self.game.grasp.pull is None:
            stage.label_ghosts(sheet, self.game.ghosts, shot, self.layout)

    def _draw_banner(self, sheet: Canvas, shot: Shot) -> None:
        """The verdict at the moment of it, in the upper half."""
        banner = self.game.banner
        if not banner.shows:
            self._banner_at = sheet.size[0] // 2, sheet.frame.top + (0 if shot.upright else sheet.size[1] // 6)
        else:
            rect = self.layout.put("banner", banner_forms(sheet, *banner.call), self._banner_at, "midtop")
            self._banner_at = rect.midtop if rect is not None else self._banner_at  # it stays where it is

    def _draw_contest(self, sheet: Canvas, stage: Stage, shot: Shot) -> None:
        """The light of a success, and the card at the end of a contest."""
        referee, contest = self.game.referee, self.game.referee.contest
        if contest is not None and contest.mark is not None:
            landed = contest.landed if referee.tells else None
            spots = [contest.mark, *([landed] if landed is not None else [])]
            scoreboard.draw_mark(sheet, stage.pixels(np.array(spots)).tolist(), shot.upright)
        if referee.glow:
            at = stage.ball_at(shot, min(self.shown.time, referee.decided), deciding_ball(shot, referee.decided))
            scoreboard.draw_glow(sheet, at, referee.glow)
            if not self.game.memory.calm:
                scoreboard.draw_confetti(sheet, at, referee.glow)
        if contest is not None and referee.is_over and referee.tells and referee.again != "slow":
            best, place, mouse = self.game.best, self.game.place, self.targets.mouse
            forms = scoreboard.end_forms(sheet, contest, best, place, mouse, self.targets.cards)
            at = sheet.size[0] // 2, sheet.top_row + 2 * sheet.gap
            if self.layout.put("end", forms, at, "midtop") is None:  # over all else
                rect = pygame.Rect((0, 0), forms[0].size)
                rect.midtop = at
                forms[0].draw(rect)

    @property
    def shows_how(self) -> bool:
        """True if a hand shows a new player how to shoot: until the first shot, while nothing else is done."""
        game, contest = self.game, self.game.referee.contest
        idle = game.watching.playback is None and not game.grasp.holds and self.shown.overlay is None
        pulled = contest is None or not (contest.aimed_by_panel or contest.missing)
        busy = game.referee.work is not None or game.referee.computers_turn
        return "shoot" in game.memory.hints and idle and pulled and not busy

    def _show_how(self, sheet: Canvas, stage: Stage, shot: Shot) -> None:
        """A hand that pulls back from the ball, away from where it will go, and lets go."""
        line = stage.line(shot)
        far = np.hypot(*(line - line[0]).T)
        ahead = line[int(np.argmax(far > _AHEAD * sheet.unit))] - line[0]
        if np.any(ahead):
            hand.draw_demonstration(sheet, tuple(line[0]), tuple(-ahead / np.hypot(*ahead)), self.game.still)

    def _draw_no_path(self, sheet: Canvas, stage: Stage) -> None:
        """The place, dark and without a path."""
        sheet.surface.blit(stage.backdrop, (0, 0))
        sheet.dim(_DIMMED)
        if self.game.failure is not None:
            head, note, colour = "No path", "the run failed with these parameters", _CARD["bad"]
        else:
            head, note, colour = "Computing ...", "the run of these parameters takes long", _CARD["text"]
        self.cards.draw_head(sheet, self.layout, head, [note], colour)
        self._keep(sheet)

    def _keep(self, sheet: Canvas) -> None:
        """Keep what is drawn until there is another picture."""
        if self._last is None or self._last.get_size() != sheet.size:
            self._last = pygame.Surface(sheet.size)
        self._last.blit(sheet.surface, (0, 0))

    def _draw_last(self, sheet: Canvas) -> None:
        """The last picture, or at first that the scene is loaded; dark if no other will come."""
        sheet.surface.fill(_CARD["background"])
        if self._last is not None:
            larger = max(px / before for px, before in zip(sheet.size, self._last.get_size(), strict=True))
            sheet.surface.blit(pygame.transform.smoothscale_by(self._last, larger), (0, 0))
        elif not self.stages.complete:
            tile = tile_of(self.game.session.base.folder, sheet.size)
            if tile is not None:
                sheet.surface.blit(tile, (0, 0))
                sheet.dim(_LOADING)
            middle = sheet.surface.get_rect().center
            sheet.write(f"loading {self.game.session.title} ...", "large", middle, _CARD["text"], "center")
        if self.stages.undrawable is not None or self._no_path:
            sheet.dim(_DIMMED)

    def _draw_messages(self, sheet: Canvas) -> None:
        """All that the player is told."""
        undrawable = self.stages.undrawable
        sheet.messages(self.layout, [*([(undrawable, True)] if undrawable is not None else []), *self.game.notices])

    def _layout(self, sheet: Canvas, stage: Stage | None = None, shot: Shot | None = None) -> Layout:
        """The room between the top and the numbers, and what of it a stage and a shot need for themselves."""
        frame, unit, overlay, t = sheet.frame, sheet.unit, self.shown.overlay, self.shown.time
        room = pygame.Rect(frame.left, frame.top, frame.width, sheet.card_row() - sheet.gap - frame.top)
        if overlay is not None and stage is not None and shot is not None:
            overlay.kept = stage.clear_of(shot, t)
        kept = [] if overlay is None else [overlay.place(self.screen.whole)]
        if stage is None or shot is None:
            return Layout(room, sheet.gap, kept)
        if self.shown.follows and stage.camerawork is not None:  # the camera moves, and what is written stays
            return Layout(room, sheet.gap, kept)
        handles = [pygame.Rect(round(x - 9 * unit), round(y - 9 * unit), round(18 * unit), round(18 * unit))
                   for grip, (x, y), *_ in self.targets.visible_grips if not grip.in_list]  # fmt: skip
        path = [] if self.shown.hides_path else stage.along(shot)
        return Layout(room, sheet.gap, [*kept, *handles, *stage.kept_clear(shot, t)], path)

    def _draw_hand(self, sheet: Canvas, shot: Shot | None) -> None:
        """The rubber band, the handles, and the ball to set spin on."""
        game, targets, pull = self.game, self.targets, self.game.grasp.pull
        if pull is not None and pull.shoots and shot is not None:
            hand.draw_pull(sheet, self.layout, pull.start, pull.drawn, shot.aimed)
        if self.shown.overlay is not None:
            return
        shown, held = targets.visible_grips, targets.held
        if shown:
            mouse = targets.mouse if targets.on_picture and game.grasp.grip is None else None
            said = held.value_text(game.session) if held is not None else ""
            hand.draw_handles(sheet, self.layout, shown, mouse, held, said)
        spins = game.session.controls.spins
        off = not spins or ("pad" in self.shown.on) == (len(spins) > 1)
        off = off or not game.session.may_change([spin.key for spin in spins])
        if shot is None or game.watching.playback is not None or pull is not None or off:
            return
        pads = [Pad(game.session, shot.upright, sheet, share) for share in (1.0, 0.7, 0.45)]
        at = sheet.frame.left, self.cards.head.bottom + 2 * sheet.gap
        rect = self.layout.put("pad", [Form(pad.rect.size, pad.draw) for pad in pads], at, "topleft")
        targets.pad = next((pad for pad in pads if rect is not None and pad.rect == rect), None)

    def _draw_shot(self, sheet: Canvas, stage: Stage, shot: Shot) -> Sequence[Entry]:
        """The shot with what is drawn around it, as it is aimed, or at the time to which it has been watched; returns
        the forces on the ball if their arrows are drawn."""
        shown, t = self.shown, self.shown.time
        sheet.surface.blit(stage.backdrop, (0, 0))
        sheet.surface.set_clip(stage.picture.opening)
        if "ghosts" in shown.on:
            stage.draw_ghosts(sheet, self.game.ghosts)
        fan = self.fan.image(shot, stage.camera) if "fan" in shown.on and not shown.hides_path else None
        if fan is not None:
            sheet.surface.blit(*fan)
        stage.draw_path(sheet, shot, shown.until(shot))
        sheet.surface.set_clip(None)
        stage.draw_measured(sheet)
        stage.draw_balls(sheet, shot, t, shown.until(shot), shown.answering)
        if not shown.sees("arrows"):
            return ()
        vectors: Vectors = self._once("vectors", shot, lambda: Vectors(shot.run, shot.ball))
        vectors.draw(sheet, stage.ball_at(shot, t), 9 * sheet.unit, t)
        return vectors.entries(t)
