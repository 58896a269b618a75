"""The window: its loop, what a mouse and a key do, and what is drawn when."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import hypot
from pathlib import Path
from threading import Thread
from time import perf_counter
from typing import TYPE_CHECKING, Any

import pygame

from sandbox.engine.accuracy import LEVELS
from sandbox.errors import SandboxError
from sandbox.picture.palette import palette
from sandbox.picture.sheet import Sheet, signed
from sandbox.scene import check, listings
from sandbox.window import aim, keep, overlay, replay
from sandbox.window.bar import HEIGHT, Bar, Shown
from sandbox.window.keys import command_for
from sandbox.window.playback import Playback
from sandbox.window.session import Session, Shot
from sandbox.window.sound import Sound
from sandbox.window.stage import Stage, headline
from sandbox.window.watch import Watch

if TYPE_CHECKING:
    from sandbox.window.panel import Panel

CARD = palette("card")

FRAMES = 60  # per second
SIZE = (1280, 720)
#: Everything is drawn at least this large; of a smaller window a part is seen.
SMALLEST = (640, 400)
#: While the mouse pulls, a run that takes longer than this, in s, is computed at the level fast.
PATIENCE = 0.006
#: How long a message stays, in s.
MESSAGE = 6.0


class App:
    """One window on a session. ``tick`` makes one frame; ``run`` makes them until the window is closed."""

    def __init__(self, session: Session, screen: pygame.Surface, sound: Sound | None = None) -> None:
        self.session, self.screen, self.sound = session, screen, sound
        self.writer: Thread | None = None  # of an animation, which takes seconds
        self.running = True
        self.shot: Shot | None = None  # as aimed, and as played
        self.stage: Stage | None = None
        self.playback: Playback | None = None  # None while aiming
        self.near: Any = None  # the picture that goes with the ball, made when first wanted
        self.follows = False
        self.ghosts, self.costs, self.helps = True, False, False
        self.menu: overlay.Menu | None = None
        self.pull: tuple[float, float] | None = None  # px, while the mouse is down
        self.pressed: tuple[int, int] | None = None
        self.scrubbing = False
        self.message: tuple[str, bool, float] | None = None  # text, whether it is bad, s left
        self.stale = True  # the shot is not that of the parameters
        self.cost = 0.0  # s, of the last run
        self.frame_cost = 0.0  # s, smoothed
        self.mouse = (-1, -1)
        self.panel: Panel | None = None
        self.has_panel = False
        self.watched = Watch(session.file)
        self.before: Shot | None = None  # the shot as it was before the scene file was saved
        self.chosen = -1  # of the shots so far, the one that is watched
        self._layout()

    # ------------------------------------------------------------------------------------------------------- the loop

    def run(self) -> None:
        """Until the window is closed."""
        clock = pygame.time.Clock()
        while self.running:
            self.tick(clock.tick(FRAMES) / 1000)
            pygame.display.flip()

    def tick(self, dt: float) -> None:
        """Take in what happened, go on by ``dt`` s, and draw."""
        started = perf_counter()
        for event in pygame.event.get():
            self.handle(event)
        self.update(dt)
        self.draw()
        self.frame_cost += 0.1 * (perf_counter() - started - self.frame_cost)

    def update(self, dt: float) -> None:
        if self.message is not None:
            text, bad, left = self.message
            self.message = (text, bad, left - dt) if left > dt else None
        if self.watched.saved(dt):
            self._reload()
        if self.stale:
            self._predict()
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

    def _layout(self) -> None:
        """Places for everything, for the window's size."""
        width, height = (max(a, b) for a, b in zip(self.screen.get_size(), SMALLEST, strict=True))
        self.canvas = pygame.Surface((width, height)) if (width, height) != self.screen.get_size() else self.screen
        tall = round(HEIGHT * height / 720)
        self.bar = Bar(pygame.Rect(0, height - tall, width, tall), height)
        wide = 0
        if self.has_panel:
            from sandbox.window.panel import (  # it brings pygame_gui, which takes its time
                FAVOURITES,
                NARROWEST,
                WIDTH,
                Panel,
            )

            wide = min(max(NARROWEST, round(WIDTH * height / 720)), width // 2)
            rect = pygame.Rect(width - wide, 0, wide, height - tall)
            group = self.panel.group if self.panel is not None else FAVOURITES
            self.panel = Panel((width, height), rect, self.session, self.change, self.reset, group)
        self.area = pygame.Rect(0, 0, width - wide, height - tall)
        self.stage, self.near = None, None

    # ------------------------------------------------------------------------------------------------------- the shot

    def _predict(self) -> None:
        """Run the scene as it stands; where that fails the last good shot stays."""
        self.stale = False
        quick = self.pull is not None and self.cost > PATIENCE
        started = perf_counter()

        def run() -> None:
            shot = self.session.predict(quick)
            _ = shot.card, shot.verdict
            self.shot = shot

        if self.trying(run):
            self.cost = perf_counter() - started
            self.near = None

    def change(self, changes: Mapping[str, Any]) -> bool:
        """Change parameters, and aim with them."""
        if not changes or not self.trying(lambda: self.session.change(changes)):
            return False
        self.back_to_aiming()
        controls = self.session.controls
        aimed = {controls.speed, controls.angle, *controls.also, *(spin.key for spin in controls.spins)}
        if not aimed.issuperset(changes):
            self.stage = None
        self.stale = True
        return True

    def back_to_aiming(self) -> None:
        if self.playback is not None:
            self.playback, self.stale, self.chosen = None, True, -1

    def shoot(self) -> None:
        """Let go: from here on the shot is watched."""
        self.pull = None
        self._predict()
        if self.shot is None:
            return
        self.session.shots.append(self.shot)
        self.watch(len(self.session.shots) - 1)

    def watch(self, index: int) -> None:
        """Play one of the shots so far from its start."""
        self.chosen = index
        self.shot = self.session.shots[index]
        rate = self.playback.rate if self.playback is not None else 1.0
        self.playback, self.near = Playback(self.shot.run.duration, rate), None

    def reset(self, key: str | None = None) -> None:
        """Take back what was changed in the window: one parameter, or all of them."""
        if self.trying(lambda: self.session.reset(key)):
            self.back_to_aiming()
            self.stage, self.stale = None, True

    def _reload(self) -> None:
        """The scene file was saved: aim by it, with the path as it was still drawn."""
        before = self.shot
        if self.trying(self.session.reload):
            self.back_to_aiming()
            self.before, self.stage, self.stale = before, None, True
            self.tell(f"read {self.watched.file} again")
        elif self.message is not None:
            self.message = (self.message[0], True, 1e9)  # until it is mended

    def open(self, source: str) -> None:
        """Play another scene or preset, or see a replay."""
        if source.endswith(replay.SUFFIX):
            self.trying(lambda: self._open_replay(Path(source)))
        elif self.trying(lambda: self.session.open(source)):
            self.back_to_aiming()
            self.shot, self.stage, self.near, self.stale, self.menu = None, None, None, True, None
            self.cost, self.before = 0.0, None
            self.watched = Watch(self.session.file)

    def _open_replay(self, path: Path) -> None:
        self.session, _ = replay.read(path)
        self.stage, self.menu, self.stale, self.before = None, None, False, None
        self.watched = Watch(self.session.file)
        if self.has_panel:
            self._layout()
        self.watch(0)
        self.tell(f"{path}: as it was recorded; F6 simulates it again")

    # ---------------------------------------------------------------------------------------------------------- input

    def handle(self, event: pygame.event.Event) -> None:
        """One event of the window, the mouse or the keyboard."""
        if self.panel is not None and self._for_panel(self.panel, event):
            return
        match event.type:
            case pygame.QUIT:
                self.running = False
            case pygame.VIDEORESIZE | pygame.WINDOWSIZECHANGED:
                self._resized()
            case pygame.DROPFILE:
                self.open(event.file)
            case pygame.KEYDOWN:
                command = command_for(event.key, event.mod)
                if command is not None:
                    self.do(command, bool(event.mod & pygame.KMOD_SHIFT))
            case pygame.MOUSEMOTION:
                self.mouse = event.pos
                self._moved(event.pos)
            case pygame.MOUSEBUTTONDOWN if event.button == pygame.BUTTON_LEFT:
                self.mouse = event.pos
                self._pressed(event.pos)
            case pygame.MOUSEBUTTONUP if event.button == pygame.BUTTON_LEFT:
                self._released()
            case pygame.MOUSEWHEEL:
                other = bool(pygame.key.get_mods() & pygame.KMOD_SHIFT) or event.x != 0
                self.change(aim.spun(self.session, int(other), event.y or event.x))

    def _for_panel(self, panel: Panel, event: pygame.event.Event) -> bool:
        """Let the panel take an event; whether it is for nobody else."""
        typing = panel.typing
        used = panel.handle(event)
        if event.type == pygame.KEYDOWN:
            return typing and event.key not in (pygame.K_ESCAPE, pygame.K_TAB)
        if event.type == pygame.MOUSEWHEEL:
            return panel.rect.collidepoint(self.mouse)
        if event.type == pygame.MOUSEMOTION and panel.rect.collidepoint(event.pos):
            self.mouse = event.pos
            return self.pull is None and not self.scrubbing
        return used or (event.type == pygame.MOUSEBUTTONDOWN and panel.rect.collidepoint(event.pos))

    def _resized(self) -> None:
        screen = pygame.display.get_surface()
        if screen is not None and self.canvas.get_size() != screen.get_size():
            self.screen = screen
            self._layout()

    def _pressed(self, at: tuple[int, int]) -> None:
        if self.menu is not None:
            name = self.menu.name_at(at)
            if name is not None:
                self.open(name)
            self.menu = None
        elif self.helps:
            self.helps = False
        elif self.bar.rect.collidepoint(at):
            command, share = self.bar.command_at(at), self.bar.share_at(at)
            if command is not None:
                self.do(command)
            elif share is not None and self.playback is not None:
                self.scrubbing = True
                self.playback.playing = False
                self.playback.seek(share * self.playback.duration)
        elif self.area.collidepoint(at):
            self.back_to_aiming()
            self.pressed, self.pull = at, (0.0, 0.0)

    def _moved(self, at: tuple[int, int]) -> None:
        if self.scrubbing and self.playback is not None:
            self.playback.seek(self.bar.share(at) * self.playback.duration)
        if self.pressed is None or self.stage is None:
            return
        self.pull = (float(at[0] - self.pressed[0]), float(at[1] - self.pressed[1]))
        stretch = self.stage.camera.stretch if self.stage.camera is not None else 1.0
        changes = aim.pulled(self.session, self.pull, self.area.height, stretch)
        if changes is not None:
            self.change(changes)

    def _released(self) -> None:
        self.scrubbing = False
        if self.pressed is None:
            return
        pull, self.pressed, self.pull = self.pull, None, None
        if pull is not None and hypot(*pull) >= aim.LEAST:
            self.shoot()

    # ------------------------------------------------------------------------------------------------------- commands

    def do(self, command: str, fine: bool = False) -> None:
        """What a key or a button asks for."""
        playback = self.playback
        match command:
            case "go" if playback is None:
                self.shoot()
            case "go" if playback is not None:
                playback.toggle()
            case "again":
                self.back_to_aiming()
            case "turn_left" | "turn_right":
                self.change(aim.nudged(self.session, turn=1 if command == "turn_left" else -1, fine=fine))
            case "stronger" | "weaker":
                self.change(aim.nudged(self.session, push=1 if command == "stronger" else -1, fine=fine))
            case "spin_up" | "spin_down" | "other_up" | "other_down":
                notches = 1 if command.endswith("up") else -1
                self.change(aim.spun(self.session, int(command.startswith("other")), notches, fine))
            case "restart" if playback is not None:
                playback.restart()
            case "step" if playback is not None:
                playback.step(1)
            case "step_back" if playback is not None:
                playback.step(-1)
            case "slower" | "faster" if playback is not None:
                playback.change_rate(1 if command == "faster" else -1)
            case "previous_shot" | "next_shot":
                self._other_shot(1 if command == "next_shot" else -1)
            case "view":
                self.follows = not self.follows
            case "ghosts":
                self.ghosts = not self.ghosts
            case "menu":
                self.menu = None if self.menu is not None else overlay.Menu(list(listings()))
            case "next_preset" | "previous_preset":
                self._other_preset(1 if command == "next_preset" else -1)
            case "reset":
                self.reset()
            case "panel":
                self.panel, self.has_panel = None, not self.has_panel
                self._layout()
            case "accuracy":
                self._next_accuracy()
            case "cost":
                self.costs = not self.costs
            case "save_scene":
                self._keep(lambda: keep.scene_file(self.session))
            case "copy":
                self._copy()
            case "screenshot":
                self._keep(lambda: keep.screenshot(self.canvas, self.session.title))
            case "animation":
                self._with_shot(self._animate)
            case "save_replay":
                self._with_shot(lambda shot: self._keep(lambda: self._save_replay(shot)))
            case "compare":
                self._with_shot(lambda shot: self.tell(replay.compared(shot)))
            case "sound" if self.sound is not None:
                self.sound.on = not self.sound.on
                self.tell("sound on" if self.sound.on else "sound off")
            case "fullscreen":
                pygame.display.toggle_fullscreen()
                self._resized()
            case "help":
                self.helps = not self.helps
            case "back":
                self._back()
            case "quit":
                self.running = False

    def _back(self) -> None:
        """Close what is open, or stop what is going on."""
        if self.menu is not None:
            self.menu = None
        elif self.helps:
            self.helps = False
        elif self.pull is not None:
            self.pull = self.pressed = None
        else:
            self.back_to_aiming()

    def _keep(self, write: Callable[[], Path]) -> None:
        """Write a file, and say where it is."""
        self.trying(lambda: self.tell(f"wrote {write()}"))

    def _with_shot(self, action: Callable[[Shot], object]) -> None:
        """Do something with the shot that is watched, or the last."""
        shots = self.session.shots
        if shots:
            self.trying(lambda: action(shots[self.chosen]))
        else:
            self.tell("no shots yet: pull back from the ball and let go")

    def _save_replay(self, shot: Shot) -> Path:
        path = keep.free(self.session.title, replay.SUFFIX)
        replay.save(shot, self.session.source, path)
        return path

    def _animate(self, shot: Shot) -> None:
        if self.writer is not None and self.writer.is_alive():
            self.tell("the animation before is still being written")
            return
        self.tell("writing the animation ...")

        def write() -> None:
            self._keep(lambda: keep.animation(shot, self.session.title))

        self.writer = Thread(target=write, daemon=True)
        self.writer.start()

    def _copy(self) -> None:
        command = self.session.command()
        try:
            pygame.scrap.put_text(command)
        except pygame.error:  # there is no clipboard
            self.tell(command)
        else:
            self.tell(f"copied: {command}")

    def _next_accuracy(self) -> None:
        """The next level, with what it costs and how far its result is off."""
        levels = list(LEVELS)
        level = levels[(levels.index(self.session.value("accuracy.level")) + 1) % len(levels)]
        if not self.change({"accuracy.level": level}):
            return
        self._predict()
        if self.shot is None:
            return
        checked = check(self.shot.scene, self.shot.run)
        errors = [f"{name} ± {error:.1g}" for name, error in checked.errors.items() if error > 0][:4]
        changed = [f"{name} would be {finer}" for name, (_, finer) in checked.changed.items()]
        told = ", ".join(changed or errors) or "no difference to a finer run"
        self.tell(f"accuracy {level}: {1e3 * self.shot.run.numerics.wall_s:.1f} ms a run; {told}")

    def _other_shot(self, by: int) -> None:
        shots = self.session.shots
        if not shots:
            self.tell("no shots yet: pull back from the ball and let go")
            return
        now = self.chosen if self.playback is not None else len(shots)
        self.watch(min(max(now + by, 0), len(shots) - 1))

    def _other_preset(self, by: int) -> None:
        names = [listing.name for listing in listings()]
        now = names.index(self.session.title) if self.session.title in names else 0
        self.open(names[(now + by) % len(names)])

    # -------------------------------------------------------------------------------------------------------- drawing

    def draw(self) -> None:
        """The whole window."""
        try:
            sheet = self._picture()
        except Exception as error:  # a scene's own code
            sheet = Sheet(self.area.size)
            sheet.surface.fill(CARD["background"])
            overlay.draw_message(sheet, f"{self.session.title} cannot be drawn: {type(error).__name__}: {error}", True)
        self.canvas.blit(sheet.surface, self.area.topleft)
        playback = self.playback
        duration = playback.duration if playback is not None else self.shot.run.duration if self.shot else 0.0
        ticks = tuple(e.t for e in self.shot.run.events if e.kind == "impact")[:200] if self.shot else ()
        view = "near" if self.follows else "whole"
        shown = Shown(
            self.session.title + (" *" if self.session.changes else ""),
            playback is not None and playback.playing,
            playback.t if playback is not None else None,
            duration,
            ticks,
            playback.rate if playback is not None else 1.0,
            view,
            ("view", "panel", "help"),
            frozenset(name for name, on in (("help", self.helps), ("panel", self.panel is not None)) if on),
        )
        if self.panel is not None:
            self.panel.draw(self.canvas)
        self.bar.draw(self.canvas, shown, self.mouse)
        if self.canvas is not self.screen:
            self.screen.blit(self.canvas, (0, 0))

    def _picture(self) -> Sheet:
        """Everything above the bar."""
        if self.shot is None:
            sheet = Sheet(self.area.size)
            sheet.surface.fill(CARD["background"])
        else:
            if self.stage is None or (self.playback is None and not self.stage.holds(self.shot)):
                self.trying(self._compose)
            sheet = self._aiming() if self.playback is None else self._playing(self.playback)
        if self.costs:
            text = f"frame {1e3 * self.frame_cost:.1f} ms   run {1e3 * self.cost:.1f} ms"
            rect = sheet.lettering.rect(text, "small", sheet.frame.topright, "topright").inflate(16, 8)
            sheet.painter.panel(rect, CARD["background"], 0.85, 5)
            sheet.lettering.write(sheet.surface, text, "small", rect.center, CARD["accent"], "center")
        if self.menu is not None:
            self.menu.draw(sheet, self.session.title, self.mouse)
        if self.helps:
            overlay.draw_help(sheet)
        if self.message is not None:
            overlay.draw_message(sheet, self.message[0], self.message[1])
        return sheet

    def _compose(self) -> None:
        assert self.shot is not None
        self.stage = Stage(self.shot, self.area.size)

    def _aiming(self) -> Sheet:
        """The shot as it would be."""
        shot, stage = self.shot, self.stage
        if shot is None or stage is None:
            sheet = Sheet(self.area.size)
            sheet.surface.fill(CARD["background"])
            return sheet
        sheet = stage.sheet()
        if stage.camera is None:
            return sheet
        if self.ghosts:
            earlier = [*self.session.shots, *([self.before] if self.before is not None else [])]
            stage.draw_ghosts(sheet, earlier)
        stage.draw_path(sheet, shot)
        stage.draw_balls(sheet, 0.0)
        colour = CARD["good"] if shot.scored else CARD["text"]
        headline(sheet, shot.verdict, self._note(), colour)
        if self.pull is not None and hypot(*self.pull) >= aim.LEAST:
            longest = aim.FULL * self.area.height
            scale = min(1.0, longest / hypot(*self.pull))
            pull = self.pull[0] * scale, self.pull[1] * scale
            stage.draw_pull(sheet, stage.ball_at(shot), pull, shot.card[0][1] if shot.card else "")
        sheet.columns(sheet.frame.bottom - sheet.card_height(), shot.card)
        return sheet

    def _note(self) -> str:
        if self.pull is not None:
            return "let go to shoot, Esc to leave it"
        return "pull back from the ball and let go, or press Space"

    def _playing(self, playback: Playback) -> Sheet:
        """The shot at a time of the play."""
        shot, stage = self.shot, self.stage
        assert shot is not None
        if self.near is None:
            self.near = shot.scene.picture(shot.run, self.area.size)
        if self.follows or stage is None or stage.camera is None:
            sheet = Sheet(self.area.size)
            sheet.surface.blit(self.near.frame(playback.t), (0, 0))
            return sheet
        sheet = stage.sheet()
        if self.ghosts:
            stage.draw_ghosts(sheet, self.session.shots[: self.chosen])
        stage.draw_path(sheet, shot, playback.t)
        stage.draw_balls(sheet, playback.t, self.near)
        x, y, vx, vy, spin = shot.run.state(shot.ball, playback.t)
        if playback.over:
            colour = CARD["good"] if shot.scored else CARD["text"]
            headline(sheet, shot.verdict, "Enter to aim again, R to see it again", colour)
            sheet.columns(sheet.frame.bottom - sheet.card_height(), shot.card)
        else:
            headline(sheet, f"{playback.t:.2f} s", f"shot {self.chosen + 1}", CARD["text"])
            numbers = [
                ("speed", f"{hypot(vx, vy):.2f} m/s"),
                ("x", signed(f"{x:.2f}") + " m"),
                ("y", signed(f"{y:.2f}") + " m"),
                ("vx", signed(f"{vx:.2f}") + " m/s"),
                ("vy", signed(f"{vy:.2f}") + " m/s"),
                ("spin", signed(f"{spin * 9.549296585513721:.0f}") + " rpm"),
            ]
            sheet.columns(sheet.frame.bottom - sheet.card_height(), numbers)
        return sheet


def play(source: str, changes: Mapping[str, Any] | None = None) -> None:
    """Open the window on a scene, until it is closed. Raises RequestError where there is no display."""
    from sandbox.window.display import opened

    recorded = source.endswith(replay.SUFFIX)
    session = replay.read(Path(source))[0] if recorded else Session(source, changes)
    with opened(SIZE, f"Sports sandbox: {session.title}") as screen:
        app = App(session, screen, Sound())
        if recorded:
            app.watch(0)
        app.run()
