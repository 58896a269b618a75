"""The stage of the current shot, composed in the background whenever the shot, the size or the camera changes."""

from __future__ import annotations

from typing import Any

from sandbox.picture.camera import Camera
from sandbox.window.background import Background, LatestJob
from sandbox.window.game import Game
from sandbox.window.messages import reason
from sandbox.window.screen import Screen
from sandbox.window.shots import Shot
from sandbox.window.stage import Stage

#: While an aim changes, the stage is composed anew at most this often, in s: the place must not jitter.
_STEADY = 0.3
#: An aim that has not changed for this time, in s, gets a stage and a map of its own.
AT_REST = 0.15


class Stages:
    """Holds the last stage that could be composed, which stays until the next is ready, and the camera to use."""

    def __init__(self, game: Game, screen: Screen, background: Background, patience: float) -> None:
        """A frame waits up to ``patience`` s for a stage; in a window, where the last picture stays until then, it does
        not wait."""
        self.game, self.screen, self.background, self.patience = game, screen, background, patience
        self.job: LatestJob[Stage] = LatestJob()
        self.latest: Stage | None = None
        self.chosen: Camera | None = None  # None shows all of the shot
        self._age = 0.0  # s since the latest was composed

    def choose(self, camera: Camera | None) -> None:
        """Compose with another camera; None shows all of the shot."""
        self.chosen = camera

    def forget(self) -> None:
        """Compose all anew: colours or letters are others now."""
        self.job.forget()
        self.latest = None

    @property
    def fitting(self) -> Stage | None:
        """The latest stage, if it has the size of the picture."""
        stage = self.latest
        return stage if stage is not None and stage.size == self.screen.area.size else None

    def of(self, shot: Shot) -> Stage | None:
        """The stage on which a shot may be drawn: when watched only its own, when aimed one of its place."""
        stage, watched = self.fitting, self._watched
        if stage is None or not (stage.shows(shot, stage.chosen) or (not watched and stage.is_place_of(shot))):
            return None
        return stage

    @property
    def _watched(self) -> bool:
        """True if a shot is watched that has happened."""
        return self.game.watching.playback is not None and self.game.watching.live is None

    @property
    def up_to_date(self) -> bool:
        """True if the stage belongs to the shot, so that the current picture is drawn."""
        return self.game.shot is None or self.of(self.game.shot) is not None

    @property
    def complete(self) -> bool:
        """True if the shot is drawn, or cannot be."""
        failed = self.game.failure is not None or self.undrawable is not None
        return failed or (self.game.shot is not None and self.up_to_date)

    @property
    def ready(self) -> bool:
        """True once the scene that is played is seen, or cannot be drawn, and no other is on its way."""
        loading, latest, scene = self.game.opening.loading, self.latest, self.game.session.base
        seen = latest is not None and latest.shot.scene.folder == scene.folder
        return (loading is None or loading.again) and (seen or self.game.failure is not None or bool(self.undrawable))

    @property
    def undrawable(self) -> str | None:
        """The reason why there is no stage for the shot; None if there is one."""
        if self.job.error is None or self.job.key != self._key:
            return None
        return f"{self.game.session.title} cannot be drawn: {reason(self.job.error)}"

    @property
    def _key(self) -> tuple[Any, ...]:
        """The key of the stage of the shot."""
        return self.game.shot, self.screen.area.size, self.chosen

    @property
    def needs_stage(self) -> bool:
        """True if the shot needs another stage than the last one that was tried."""
        shot, stage = self.game.shot, self.fitting
        if shot is None or self.job.key == self._key:
            return False
        return stage is None or not stage.shows(shot, self.chosen)

    def follow(self, dt: float) -> bool:
        """``dt`` s have passed: compose a stage for the shot if this one does not show it; returns whether there is a
        new one."""
        self._age += dt
        new = self._take()
        if not self.needs_stage or self._may_wait():
            return new
        before = self.latest
        self.job.follow(self._key, lambda key: self.background.submit(Stage, *key, before))
        return self._take() or new

    def _may_wait(self) -> bool:
        """True if the shot can be drawn on the latest stage, and its aim still changes."""
        game, shot = self.game, self.game.shot
        stage = self.of(shot) if shot is not None and not self._watched else None
        if stage is None or shot is None or stage.chosen != self.chosen or game.grasp.grip is not None:
            return False
        if game.watching.live is not None:
            return True
        moving = game.grasp.pull is not None or not game.path.settled or game.still < AT_REST
        return moving and (stage.holds(shot) or self._age < _STEADY)

    def _take(self) -> bool:
        """Switch to a stage that was composed; returns whether there is one."""
        if not self.job.take(self.patience):
            return False
        self._age, self.latest = 0.0, self.job.value or self.latest
        return True
