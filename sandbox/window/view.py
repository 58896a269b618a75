"""A game drawn: the layout of the window, and what is switched on.

The picture shows a shot on the stage that was composed for its parameters. Until the stage of the current shot is
ready, the last picture stays: a path is never drawn on the stage of another place.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np
import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.lettering import Lettering
from sandbox.picture.palette import Colour, palette, set_contrast
from sandbox.picture.sheet import Entry, rows_of
from sandbox.picture.vectors import Vectors
from sandbox.picture.view import View as Picture
from sandbox.sport.amounts import metres
from sandbox.window import hand
from sandbox.window.background import Background, KeyedCache, LatestJob
from sandbox.window.bar import HEIGHT, Bar
from sandbox.window.canvas import Canvas
from sandbox.window.charts import Charts
from sandbox.window.fan import Cloud, FanShot, cloud, shots_from_end
from sandbox.window.game import Game
from sandbox.window.handles import Grip, grips
from sandbox.window.layout import Form, Layout
from sandbox.window.measure import NEAR, Tape, draw_reading, reading
from sandbox.window.messages import reason
from sandbox.window.overlay import Overlay
from sandbox.window.pad import Pad
from sandbox.window.panel import Panel
from sandbox.window.path import LONG
from sandbox.window.score_map import FINER, QUICK, ScoreMap, map_forms, score_map
from sandbox.window.shots import Shot
from sandbox.window.stage import Stage, headline

if TYPE_CHECKING:
    from sandbox.window.sound import Sound

CARD = palette("card")

SIZE = (1280, 720)
#: Everything is drawn at least this large, and shrunk for a smaller window.
SMALLEST = (480, 400)
#: While an aim changes, the stage is composed anew at most this often, in s: the place must not jitter.
STEADY = 0.3
#: An aim that has not changed for this time, in s, gets a stage and a map of its own.
AT_REST = 0.15
#: A fan that takes longer than this, in s, is taken for one that never ends once the aim has changed.
HUNG = 10.0
#: Largest and smallest zoom, compared with a view of the whole shot.
NEAREST, FARTHEST = 60.0, 0.2
#: No ball becomes larger by zooming than with this radius, as a share of the picture's height.
LARGEST_BALL = 0.12
#: How much of the path is shown while aiming.
AHEAD = ("all", "to the first contact", "the first metre", "nothing")
#: A view that follows the ball can be so many times nearer or farther.
NEARER = 8.0
#: Opacity (of 255) of a fan that is still that of another aim.
OUTDATED = 70
#: The ground is never higher than this, as a share of the picture's height.
HIGHEST = 0.3


class View:
    """Draws a game on a screen; ``tick`` passes time, ``draw`` makes the current picture."""

    def __init__(
        self,
        game: Game,
        screen: pygame.Surface,
        sound: Sound | None = None,
        patience: float = 0.0,
        hint_of: Callable[[str], str] = str,
    ) -> None:
        """A frame waits up to ``patience`` s for a stage; in a window, where the last picture stays until then, it does
        not wait. ``hint_of`` says what a button of the bar does."""
        self.patience, self.hint_of = patience, hint_of
        self.game, self.screen, self.sound = game, screen, sound
        self.background, self.writer = Background(), Background()  # for what is seen, and for files
        self.on = {"ghosts"}  # commands that are switched on
        self.at = (-1, -1)  # px, the mouse
        self.over: Overlay | None = None
        self.ahead = AHEAD[0]
        self.fan_width = 1.0  # times the usual spread
        self.tape: Tape | None = None
        self.panel = Panel(game, self.open)
        self.area = pygame.Rect(0, 0, 0, 0)  # of the picture
        self.stages: LatestJob[Stage] = LatestJob()
        self.stage: Stage | None = None  # the last one that could be composed
        self.composed = 0.0  # s since then
        self.chosen: Camera | None = None  # by zooming; None shows all of the shot
        self.nearer = 1.0  # where the view follows the ball
        self.holds = False  # the camera, while something is dragged
        self.picked_keys: tuple[str, str] | None = None  # the keys of the handle that was picked by key
        self.clouds: LatestJob[Cloud] = LatestJob(game.workers.helper.abandon, HUNG)  # the fan
        self.elsewhere: LatestJob[list[FanShot | None]] = LatestJob(game.workers.path.abandon, LONG)  # shots of the fan
        self.maps: LatestJob[ScoreMap] = LatestJob(game.workers.helper.abandon, HUNG)
        self.cards: dict[str, pygame.Rect] = {}  # those that can be clicked: the map's cells and the charts
        self.head = pygame.Rect(0, 0, 0, 0)  # where the headline is
        self.layout = Layout(self.head, 0)  # of what was drawn last
        self.pad: Pad | None = None  # where spin is set by hand: for a cue unless it is switched off, else switched on
        self.frame_cost = 0.0  # s, smoothed
        self.changed = True  # something other than the game
        self.thumbnails: dict[str, Future[bytes]] = {}  # of the menu
        self.windowed = SIZE  # its size before full screen
        self.caption = ""
        self._seen: Any = None  # what was drawn last
        self._picture: pygame.Surface | None = None  # what was drawn last above the bar
        self._once = KeyedCache()
        self.lay_out()

    # ------------------------------------------------------------------------------------------------------- places

    def lay_out(self) -> None:
        """Places for everything, for the window's size and what is switched on."""
        self.laid_out, self.changed = self.screen.get_size(), True
        self.shrunk = max(1.0, *(least / px for least, px in zip(SMALLEST, self.laid_out, strict=True)))
        width, height = (round(self.shrunk * px) for px in self.laid_out)
        self.canvas: pygame.Surface = self.screen if self.shrunk == 1.0 else pygame.Surface((width, height))
        rows = rows_of((width, height))
        tall = round(HEIGHT * rows / 720)
        self.bar = Bar(pygame.Rect(0, height - tall, width, tall), rows)
        self.panel.lay_out(Canvas(self.canvas), self.bar.rect.top)
        area = pygame.Rect(0, 0, self.panel.rect.left if self.has_panel else width, self.bar.rect.top)
        if area != self.area:
            self.area, self.chosen = area, None

    @property
    def has_panel(self) -> bool:
        """True if the panel is open."""
        return "panel" in self.on

    def on_panel(self, at: tuple[int, int]) -> bool:
        """True if a place (px) is on the panel."""
        return self.has_panel and self.panel.rect.collidepoint(at)

    def set_look(self, larger: float, contrast: bool) -> None:
        """Draw everything anew with other letters or colours, now and next time."""
        Lettering.larger = larger
        set_contrast(contrast)
        self.game.memory.look = larger, contrast
        self.game.memory.save()
        self.stages.forget()
        self.stage, self._once = None, KeyedCache()
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

    def open(self, over: Overlay | None) -> None:
        """Show something over the picture, in place of what is there."""
        self.over, self.changed = over, True

    @property
    def switched(self) -> set[str]:
        """The commands whose switches are on, and the scene that is played."""
        sound = {"sound"} if self.sound is not None and self.sound.on else set()
        return self.on | sound | {self.game.session.source}

    # ------------------------------------------------------------------------------------------------------- cameras

    @property
    def follows(self) -> bool:
        """True if the view follows the ball."""
        return self.game.watching.playback is not None and "view" in self.on

    @property
    def camera(self) -> Camera | None:
        """The current camera; None until there is a stage."""
        playback, shot = self.game.watching.playback, self.game.shot
        if not self.follows or playback is None or shot is None:
            return self.stage.camera if self.stage is not None else None
        return self.near(shot).view(playback.t)

    def near(self, shot: Shot) -> Picture[Any]:
        """The picture of a shot that follows its ball, as near as the player has zoomed."""
        found: Picture[Any] = self._once(
            "near", (shot, self.area.size), lambda: shot.run.scene.picture(shot.run, self.area.size)
        )

        def view(t: float) -> Camera:
            """The picture's own, nearer, with the ball in the same place; on whole px."""
            camera = type(found).view(found, t)
            near = _scaled(camera, self.nearer, camera.pixel(*shot.run.state(shot.ball, t)[:2]))
            return replace(near, anchor=(round(near.anchor[0]), round(near.anchor[1])))

        vars(found)["view"] = view
        return found

    def zoom(self, factor: float, at: tuple[float, float]) -> None:
        """Zoom by ``factor`` around a place (px), or around the ball that the view follows."""
        stage = self.stage
        if self.follows:
            self.nearer = min(max(self.nearer * factor, 1 / NEARER), NEARER)
            self.changed = True
        elif stage is not None:
            camera, whole = self.chosen or stage.camera, stage.whole.scale
            largest = max(ball.radius for ball in stage.shot.run.setup.balls)
            nearest = max(whole, min(NEAREST * whole, LARGEST_BALL * self.area.height / largest))
            scale = min(max(camera.scale * factor, FARTHEST * whole), nearest)
            self.look(_scaled(camera, scale / camera.scale, at))

    def pan(self, across: float, down: float) -> None:
        """Move the picture by so many px."""
        if self.stage is not None:
            camera = self.chosen or self.stage.camera
            right, foot = camera.anchor
            self.look(replace(camera, anchor=(right + across, foot + down)))

    def look(self, camera: Camera | None) -> None:
        """Use another camera; None shows all of the shot. From the side the ground stays in the lower part."""
        if self.follows and camera is not None:
            self.game.messages.tell("the view follows the ball; V for the whole view")
            return
        shot = self.game.shot
        if camera is not None and shot is not None and shot.upright:
            across, down = camera.anchor
            camera = replace(camera, anchor=(across, max(down, HIGHEST * self.area.height)))
        self.chosen, self.nearer, self.holds, self.changed = camera, 1.0, False, True

    # ------------------------------------------------------------------------------------------------------- handles

    @property
    def spots(self) -> list[hand.Spot]:
        """The handles that can be dragged now, with their places in px."""
        game, stage = self.game, self.stage
        if (
            game.watching.playback is not None
            or game.grasp.pull is not None
            or stage is None
            or stage.size != self.area.size
        ):
            return []
        found: list[Grip] = self._once("grips", game.session.scene, lambda: grips(game.session))
        return hand.spots(found, stage, self._sheet())

    def _sheet(self) -> Canvas:
        return Canvas(self.canvas.subsurface(self.area))

    def spot_at(self, at: tuple[int, int]) -> hand.Spot | None:
        """The handle at a place in px."""
        return hand.nearest(self.spots, at)

    @property
    def picked(self) -> hand.Spot | None:
        """The handle that was picked by key."""
        return next((spot for spot in self.spots if spot.grip.keys == self.picked_keys), None)

    def _held(self) -> Grip | None:
        """The handle that is dragged, that the mouse is on, or that was picked by key."""
        spot = (self.spot_at(self.at) if self.area.collidepoint(self.at) else None) or self.picked
        return self.game.grasp.grip or (spot.grip if spot is not None else None)

    def hold(self) -> None:
        """Keep the camera as it is: what is dragged stays under the mouse."""
        if self.chosen is None and self.stage is not None:
            self.chosen, self.holds = self.stage.camera, True

    def free(self) -> None:
        """Let the camera go."""
        if self.holds:
            self.chosen, self.holds, self.changed = None, False, True

    # ------------------------------------------------------------------------------------------------------- time

    @property
    def up_to_date(self) -> bool:
        """True if the stage belongs to the shot, so that the current picture is drawn."""
        return self.game.shot is None or self._may_draw(self.game.shot)

    @property
    def complete(self) -> bool:
        """True if the shot is drawn, or cannot be."""
        failed = self.game.failure is not None or self.undrawable is not None
        return failed or (self.game.shot is not None and self.up_to_date)

    @property
    def busy(self) -> bool:
        """True if something is being prepared that will have to be drawn."""
        over = self.over is not None and self.over.made < len(self.over.pictures)
        coming = any(latest.work is not None for latest in (self.stages, self.clouds, self.maps))
        return bool(over or coming or self._stage_wanted() or self._cloud_wanted() or self._map_wanted())

    def _may_draw(self, shot: Shot) -> bool:
        """True if a shot may be drawn on the stage: when watched only on its own, when aimed on one of its place."""
        stage = self.stage
        if stage is None or stage.size != self.area.size:
            return False
        return stage.shows(shot, stage.chosen) or (self.game.watching.playback is None and stage.is_place_of(shot))

    def tick(self, dt: float) -> None:
        """``dt`` s have passed."""
        game = self.game
        self.composed += dt
        if self.over is None or self.over.name != "menu":  # nobody waits for what it shows
            self.thumbnails = {source: work for source, work in self.thumbnails.items() if not work.cancel()}
        followed = {
            "shoot": game.shots.count,
            "drag": game.grasp.grip,
            "menu": self.over and self.over.name == "menu",
        }
        for hint, done in followed.items():
            if done:
                game.memory.follow(hint)
        self._follow_stage()
        self.changed |= self.clouds.take()
        self.elsewhere.take()
        wanted = self._cloud_wanted()
        self.clouds.follow(wanted, self._ask_cloud)
        self._follow_elsewhere(wanted)
        self.changed |= self.maps.take()
        self.maps.follow(self._map_wanted(), lambda key: game.workers.helper.submit(score_map, *key[1:]))

    # What follows the shot, computed elsewhere

    def _stage_key(self) -> tuple[Any, ...]:
        """The key of the stage of the shot."""
        return self.game.shot, self.area.size, self.chosen

    @property
    def undrawable(self) -> str | None:
        """The reason why there is no stage for the shot; None if there is one."""
        if self.stages.error is None or self.stages.key != self._stage_key():
            return None
        return f"{self.game.session.title} cannot be drawn: {reason(self.stages.error)}"

    def _stage_wanted(self) -> bool:
        """True if the shot needs another stage than the last one that was tried."""
        shot, stage = self.game.shot, self.stage
        if shot is None or self.stages.key == self._stage_key():
            return False
        return stage is None or stage.size != self.area.size or not stage.shows(shot, self.chosen)

    def _take_stage(self) -> None:
        """Switch to a stage that was composed."""
        if self.stages.take(self.patience):
            self.composed, self.changed = 0.0, True
            self.stage = self.stages.value or self.stage

    def _follow_stage(self) -> None:
        """Compose a stage for the shot, if this one does not show it."""
        self._take_stage()
        game, stage, shot = self.game, self.stage, self.game.shot
        if shot is None or not self._stage_wanted():
            return
        if (
            stage is not None
            and game.watching.playback is None
            and self._may_draw(shot)
            and stage.chosen == self.chosen
        ):
            moving = game.grasp.pull is not None or not game.path.settled or game.still < AT_REST
            if moving and game.grasp.grip is None and (stage.holds(shot) or self.composed < STEADY):
                return
        self.stages.follow(self._stage_key(), lambda key: self.background.submit(Stage, *key, stage))
        self._take_stage()

    def _cloud_wanted(self) -> tuple[Any, ...] | None:
        """The key of the fan that is still to be computed: the shot; a quick one while it changes. Last, how many are
        left."""
        game, stage, known = self.game, self.stage, self.clouds
        shown = game.failure is None and self.up_to_date
        if "fan" not in self.on or not shown or stage is None or game.shot is None:
            return None
        now = game.shot, self.fan_width, stage.camera
        moving = game.grasp.pull is not None or game.still < AT_REST
        if known.key is None or known.key[:3] != now:
            return (*now, moving, 0)
        return (*now, False, known.value.left) if known.value is not None and known.value.left and not moving else None

    def _ask_cloud(self, key: tuple[Any, ...]) -> Future[Cloud]:
        """Have a fan computed."""
        (shot, *how, _), colours = key, (CARD["good"], CARD["text"])
        known = self._from_elsewhere(key)
        return self.game.workers.helper.submit(cloud, shot.scene, *how, shot.early, self.area.size, colours, known)

    def _follow_elsewhere(self, wanted: tuple[Any, ...] | None) -> None:
        """Have shots of a fan that has begun computed where otherwise the path is, which must not wait for them."""
        key, worker = None, self.game.workers.path
        if wanted is not None and wanted[4] and self.game.workers.helper is not worker:
            key = (*wanted[:2], len(self._from_elsewhere(wanted)))
            left = wanted[4]
        self.elsewhere.follow(key, lambda key: worker.submit(shots_from_end, key[0].scene, key[1], left))

    def _from_elsewhere(self, key: tuple[Any, ...]) -> list[FanShot | None]:
        """The shots of a fan that were."""
        known = self.elsewhere
        return known.value if known.value is not None and not key[3] and known.key[:2] == key[:2] else []

    def _map_wanted(self) -> tuple[Any, ...] | None:
        """The key of the map that is still to be computed: the scene apart from the aim, which stays in its
        middle for as long as it is on the map; a coarse one first."""
        game, shot, known = self.game, self.game.shot, self.maps.value
        if "map" not in self.on or shot is None or game.failure is not None or game.still < AT_REST:
            return None
        same = self.maps.key is not None and self.maps.key[0] == shot.scene_without_aim
        if same and (known is None or known.holds(*shot.aim)):
            finer = known is not None and self.maps.key[2] == 1 and known.seconds < QUICK
            return (*self.maps.key[:2], FINER) if finer else None
        return shot.scene_without_aim, shot.scene, 1

    # ------------------------------------------------------------------------------------------------------- drawing

    def needs_drawing(self, happened: bool) -> bool:
        """True if what would be drawn differs from what was drawn last."""
        over = self.over
        seen = self.game.seen, over, over and over.made, self.tape, frozenset(self.on)
        needed = happened or self.changed or seen != self._seen
        self._seen, self.changed = seen, False
        return needed

    def draw(self) -> None:
        """The whole window."""
        try:
            self._draw_picture()
        except Exception as error:  # a scene's own code
            sheet = self._sheet()
            sheet.surface.fill(CARD["background"])
            text = f"{self.game.session.title} cannot be drawn: {reason(error)}"
            sheet.messages(self._layout(sheet), [(text, True)])
        whole = Canvas(self.canvas)
        if self.has_panel:
            self.panel.draw(whole, self.at if self.over is None else (-1, -1))
        self._draw_bar(whole)
        if self.over is not None:
            self.over.draw(self._whole(), self.at, self.switched)
        if self.canvas is not self.screen:
            self.screen.blit(pygame.transform.smoothscale(self.canvas, self.laid_out), (0, 0))
        if self.caption != self.game.session.title:
            self.caption = self.game.session.title
            pygame.display.set_caption(f"{self.caption} – Sports sandbox")

    def _draw_bar(self, sheet: Canvas) -> None:
        """The bar, with a hint at the button under the mouse."""
        game, on = self.game, {*self.on, *([self.over.name] if self.over is not None else [])}
        title = game.session.title + " *" * bool(game.session.changes.values)
        known = not (self.hidden or game.failure or game.late)
        self.bar.draw(sheet, title, game.shot if known else None, game.watching.playback, on, self.at)
        button = self.bar.command_at(self.at)
        if button is not None and button not in on:
            at = self.bar.places[button].centerx, self.bar.rect.top - sheet.gap
            sheet.card([(self.hint_of(button), CARD["text"])], "midbottom", at)

    def _draw_picture(self) -> None:
        """Everything above the bar."""
        game, shot, stage, sheet = self.game, self.game.shot, self.stage, self._sheet()
        no_path = game.failure is not None or game.late
        drawn = shot is not None and self.undrawable is None and self._may_draw(shot)
        self.layout, self.pad = self._layout(sheet), None
        if drawn and no_path:
            self._draw_no_path(sheet)
        elif drawn and shot and stage and (game.watching.playback is not None or shot.place == game.session.place):
            self.layout = self._layout(sheet, stage, shot)
            forces = self._draw_shot(sheet, stage, shot)
            if not self.follows:
                self._draw_words(sheet, stage, shot, forces)
        else:
            drawn = False
        if drawn:
            if self._picture is None or self._picture.get_size() != self.area.size:
                self._picture = pygame.Surface(self.area.size)
            self._picture.blit(sheet.surface, (0, 0))
        else:
            sheet.surface.fill(CARD["background"])
            if self._picture is not None:
                larger = max(px / before for px, before in zip(sheet.size, self._picture.size, strict=True))
                sheet.surface.blit(pygame.transform.smoothscale_by(self._picture, larger), (0, 0))
            elif not self.complete:
                middle = sheet.surface.get_rect().center
                sheet.write(f"loading {game.session.title} ...", "large", middle, CARD["quiet"], "center")
            if self.undrawable is not None or no_path:
                sheet.veil(150)
        undrawable = [(self.undrawable, True)] if self.undrawable is not None else []
        sheet.messages(self.layout, [*undrawable, *game.notices])
        self.cards.clear()
        if drawn and not no_path and shot is not None and stage is not None:
            self._draw_hand(sheet, shot)
            self._draw_read(sheet, stage, shot)
            self._draw_cards(sheet, stage, shot)
            if "ghosts" in self.on and game.grasp.pull is None and not self.follows:
                stage.label_ghosts(sheet, self.game.ghosts, shot, self.layout)
        elif game.failure is None:
            self._draw_hand(sheet, shot)

    def _layout(self, sheet: Canvas, stage: Stage | None = None, shot: Shot | None = None) -> Layout:
        """The room between the top and the numbers, and what of it a stage and a shot need for themselves."""
        frame = sheet.frame
        room = pygame.Rect(frame.left, frame.top, frame.width, sheet.card_row() - sheet.gap - frame.top)
        if self.over is not None and stage is not None and shot is not None and not self.follows:
            playback = self.game.watching.playback
            self.over.kept = stage.clear_of(shot, playback.t if playback is not None else 0.0)
        over = [] if self.over is None else [self.over.place(self._whole())]
        if stage is None or shot is None:
            return Layout(room, sheet.gap, over)
        t = self.game.watching.playback.t if self.game.watching.playback is not None else 0.0
        if self.follows:
            picture = self.near(shot)
            return Layout(
                room, sheet.gap, [*over, *picture.kept_clear(picture.view(t), t), *picture.sheet.labels.taken]
            )
        unit = sheet.unit
        handles = [pygame.Rect(round(x - 9 * unit), round(y - 9 * unit), round(18 * unit), round(18 * unit))
                   for grip, (x, y), *_ in self.spots if not grip.in_list]  # fmt: skip
        path = [] if self.hidden else stage.along(shot)
        return Layout(room, sheet.gap, [*over, *handles, *stage.kept_clear(shot, t)], path)

    def _whole(self) -> Canvas:
        """All of the window above the bar, over which lists and menus lie."""
        return Canvas(self.canvas.subsurface((0, 0), (self.canvas.get_width(), self.area.height)))

    def _draw_hand(self, sheet: Canvas, shot: Shot | None) -> None:
        """The rubber band, the handles, and the ball to set spin on."""
        game, spots, held = self.game, self.spots, self._held()
        if game.grasp.pull is not None and game.grasp.pull.shoots and shot is not None and not self.follows:
            hand.draw_pull(sheet, self.layout, game.grasp.pull.start, game.grasp.pull.drawn, shot.aimed)
        if self.over is not None:
            return
        if spots:
            mouse = self.at if self.area.collidepoint(self.at) and game.grasp.grip is None else None
            said = held.said(game.session) if held is not None else ""
            hand.draw_handles(sheet, self.layout, spots, mouse, held, said)
        spins = game.session.controls.spins
        off = not spins or ("pad" in self.on) == (len(spins) > 1)
        if shot is None or game.watching.playback is not None or game.grasp.pull is not None or off:
            return
        pads = [Pad(game.session, shot.upright, sheet, share) for share in (1.0, 0.7, 0.45)]
        at = sheet.frame.left, self.head.bottom + 2 * sheet.gap
        rect = self.layout.put("pad", [Form(pad.rect.size, pad.draw) for pad in pads], at, "topleft")
        self.pad = next((pad for pad in pads if rect is not None and pad.rect == rect), None)

    def _draw_no_path(self, sheet: Canvas) -> None:
        """The place, dark and without a path: the current parameters have none, or none yet."""
        assert self.stage is not None
        sheet.surface.blit(self.stage.backdrop, (0, 0))
        sheet.veil(150)
        if self.game.failure is not None:
            self._draw_head(sheet, "No path", ["the run failed with these parameters"], CARD["bad"])
        else:
            self._draw_head(sheet, "Computing ...", ["the run of these parameters takes long"], CARD["text"])

    def _draw_head(self, sheet: Canvas, text: str, notes: Sequence[str], colour: Colour) -> None:
        """The headline at the upper left, or where there is room."""
        rect = self.layout.put("headline", headline(sheet, text, notes, colour), sheet.frame.topleft, "topleft")
        self.head = rect or pygame.Rect(*sheet.frame.topleft, 0, 0)

    def _draw_shot(self, sheet: Canvas, stage: Stage, shot: Shot) -> Sequence[Entry]:
        """The shot with what is drawn around it, as it is aimed, or at the time to which it has been watched; returns
        the forces on the ball if their arrows are drawn."""
        playback = self.game.watching.playback
        t = playback.t if playback is not None else None
        if t is not None and self.follows:
            sheet.surface.blit(self.near(shot).frame(t), (0, 0))
            return ()
        sheet.surface.blit(stage.backdrop, (0, 0))
        if "ghosts" in self.on:
            stage.draw_ghosts(sheet, self.game.ghosts)
        found = self._cloud_of(shot) if "fan" in self.on and not self.hidden else None
        if found is not None and found.pixels and self.clouds.key[2] == stage.camera:
            image = self._once("cloud", found, lambda: pygame.image.frombuffer(found.pixels, found.size, "RGBA"))
            image.set_alpha(255 if self.clouds.key[0] is shot else OUTDATED)
            sheet.surface.blit(image, found.at)
        stage.draw_path(sheet, shot, self.until(shot))
        stage.draw_balls(sheet, shot, t or 0.0, self.until(shot))
        if "arrows" in self.on:
            vectors: Vectors = self._once("vectors", shot, lambda: Vectors(shot.run, shot.ball))
            vectors.draw(sheet, stage.ball_at(shot, t or 0.0), 9 * sheet.unit, t or 0.0)
            return vectors.entries(t or 0.0)
        return ()

    @property
    def hidden(self) -> bool:
        """True if the player has to predict what happens."""
        return self.game.watching.playback is None and self.ahead != AHEAD[0]

    def until(self, shot: Shot) -> float | None:
        """The time until which the path is shown, in s; None for all of it."""
        if self.game.watching.playback is not None:
            return self.game.watching.playback.t
        if self.ahead == "to the first contact":
            return next((e.t for e in shot.run.events if e.kind == "impact" and e.ball == shot.ball and e.t > 0), None)
        if self.ahead == "the first metre":
            track = shot.track(shot.ball)
            way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(track[:, 1:], axis=0).T))])
            return float(np.interp(1.0, way, track[:, 0]))
        return 0.0 if self.ahead == "nothing" else None

    def _draw_words(self, sheet: Canvas, stage: Stage, shot: Shot, forces: Sequence[Entry]) -> None:
        """The headline, and the numbers along the bottom."""
        game, playback = self.game, self.game.watching.playback
        text, colour = shot.verdict, CARD["good"] if shot.scored else CARD["text"]
        entries: Sequence[Entry] = shot.card
        if self.hidden:
            text, colour, entries = "Where will it go?", CARD["text"], [("aimed", shot.aimed)]
        if game.grasp.pull is not None:
            notes = ["let go to shoot, Esc to cancel"]
        elif game.grasp.grip is not None:
            notes = ["Shift goes in steps, Esc to cancel"]
        elif playback is None:
            notes = ["pull back anywhere and let go, or press Space"]
        else:
            notes = [f"{'replay' if shot.recorded else 'shot'} {shot.number}"]
            if playback.slowed:
                notes.append(f"slow motion, {round(1 / playback.rate)} times slower (+ for faster)")
            if playback.over:
                again = "continue" if game.session.controls.next_start is not None else "aim again"
                notes.append(f"Enter to {again}, R to see it again")
            else:
                text, colour, entries = f"{playback.t:.2f} s", CARD["text"], stage.picture.live(playback.t)
                forces = ()  # they are among them
        self._draw_head(sheet, text, [*notes, *stage.notes], colour)
        numbers = pygame.Rect(0, sheet.card_row(), *sheet.size)
        if self.over is None or not self.over.place(self._whole()).colliderect(numbers):
            sheet.numbers([*entries, *forces])

    def _cloud_of(self, shot: Shot) -> Cloud | None:
        """The fan of a shot; during a pull that of a moment ago."""
        there = self.clouds.value is not None and self.clouds.key[0].place == shot.place
        return self.clouds.value if there else None

    def _draw_cards(self, sheet: Canvas, stage: Stage, shot: Shot) -> None:
        """Cards at the right: fan, map, charts, cost, hints."""
        game, layout, corner = self.game, self.layout, sheet.frame.topright

        def note(name: str, *lines: tuple[str, Colour]) -> None:
            layout.put(name, sheet.notes(lines), corner, "topright")

        if "fan" in self.on and not self.hidden:
            found = self._cloud_of(shot)
            share, spread = found.said if found is not None else (self._why(self.clouds, "the fan"), "")
            matches = found is not None and self.clouds.key[0] is shot
            note("fan", (share, CARD["text" if matches else "quiet"]), *[(spread, CARD["quiet"])] * bool(spread))
        if "map" in self.on and not self.hidden:
            known = self.maps.value
            if known is None or self.maps.key[0] != shot.scene_without_aim:
                note("map", (self._why(self.maps, "the map"), CARD["text"]))
            else:
                forms = map_forms(sheet, known, shot.aim, lambda cells: self.cards.update({"map": cells}))
                layout.put("map", forms, corner, "topright")
        if "charts" in self.on and not self.hidden:
            charts: Charts = self._once("charts", shot, lambda: Charts(shot, stage.picture))
            t = game.watching.playback.t if game.watching.playback is not None else None
            left = sheet.frame.left, layout.room.bottom
            at, anchor = (corner, "topright") if shot.upright else (left, "bottomleft")
            rect = layout.put("charts", charts.forms(sheet, t), at, anchor)
            self.cards |= {"charts": rect} if rect is not None else {}
        if "cost" in self.on:
            level = game.session.value("accuracy.level")
            text = f"frame {1e3 * self.frame_cost:.1f} ms; run {1e3 * game.path.cost:.1f} ms, {level}"
            note("cost", (text, CARD["accent"]))
        hints = [(text, CARD["accent"]) for text in game.memory.hints.values()]
        if hints and game.grasp.pull is None:
            note("hints", *hints)

    def _draw_read(self, sheet: Canvas, stage: Stage, shot: Shot) -> None:
        """The tape, and what the mouse reads."""
        game, camera = self.game, self.camera
        if camera is None or self.hidden:
            return
        if self.tape is not None:
            self.tape.draw(sheet, self.layout, camera, shot.upright)
        if self.follows or self.over is not None or game.grasp.holds:
            return
        if self.area.collidepoint(self.at) and not pygame.mouse.get_pressed()[2]:
            read = reading(shot, camera, self.at, NEAR * sheet.unit, self.until(shot))
            if read is not None:
                picture, (x, y, *_) = stage.picture, shot.run.state(read.ball, read.t)
                others = [("x", metres(x)), ("y", metres(y)), *picture.moving(read.ball, read.t)]
                entries = picture.live(read.t) if read.ball == shot.ball else others
                draw_reading(sheet, self.layout, shot, read, entries)

    def _why(self, latest: LatestJob[Any], what: str) -> str:
        """The reason why there is no such value."""
        return f"{what} ..." if latest.error is None else reason(latest.error)


def _scaled(camera: Camera, factor: float, at: tuple[float, float]) -> Camera:
    """A camera that is nearer by a factor, with what is at a place (px) still there."""
    across, down = (to + (px - to) * factor for to, px in zip(at, camera.anchor, strict=True))
    return replace(camera, anchor=(across, down), scale=camera.scale * factor)
