"""The fan of the current shot, computed in both workers, and how far it is."""

from __future__ import annotations

from concurrent.futures import Future
from typing import NamedTuple

import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.palette import palette
from sandbox.window.background import HUNG, KeyedCache, LatestJob
from sandbox.window.fan import Cloud, FanShot, cloud, shots_from_end
from sandbox.window.game import Game
from sandbox.window.path import LONG
from sandbox.window.screen import Screen
from sandbox.window.shots import Shot
from sandbox.window.shown import Shown
from sandbox.window.stages import AT_REST, Stages

_CARD = palette("card")

#: Opacity (of 255) of a fan that is still that of another aim.
OUTDATED = 70


class FanKey(NamedTuple):
    """The fan that is wanted."""

    shot: Shot
    width: float  # times the usual spread
    camera: Camera
    quick: bool  # for an aim that changes
    left: int  # shots that were still to be computed


class FanOfShot:
    """Follows the shot with a fan; some of its shots are computed ``elsewhere``, where otherwise the path is."""

    def __init__(self, game: Game, screen: Screen, shown: Shown, stages: Stages) -> None:
        self.game, self.screen, self.shown, self.stages = game, screen, shown, stages
        self.job: LatestJob[Cloud] = LatestJob(game.workers.helper.abandon, HUNG)
        self.elsewhere: LatestJob[list[FanShot | None]] = LatestJob(
            game.workers.path.abandon, LONG
        )  # some of its shots
        self._once = KeyedCache()

    @property
    def next_key(self) -> FanKey | None:
        """The key of the fan that is still to be computed: a quick one while the shot changes."""
        game, stage, known = self.game, self.stages.latest, self.job
        ready = game.failure is None and self.stages.up_to_date and game.watching.live is None
        if "fan" not in self.shown.on or not ready or stage is None or game.shot is None:
            return None
        moving = game.grasp.pull is not None or game.still < AT_REST
        now = FanKey(game.shot, self.shown.fan_width, stage.camera, moving, 0)
        if known.key is None or known.key[:3] != now[:3]:
            return now
        left = known.value.left if known.value is not None else 0
        return now._replace(left=left) if left and not moving else None

    def follow(self) -> bool:
        """Begin what is wanted, and take what is there; returns whether there is something new."""
        new = self.job.take()
        self.elsewhere.take()
        wanted = self.next_key
        self.job.follow(wanted, self._ask)
        self._follow_elsewhere(wanted)
        return new

    def _ask(self, key: FanKey) -> Future[Cloud]:
        """Have a fan computed."""
        how, colours = (key.width, key.camera, key.quick), (_CARD["good"], _CARD["text"])
        submit, size = self.game.workers.helper.submit, self.screen.area.size
        return submit(cloud, key.shot.scene, *how, key.shot.early, size, colours, self._from_elsewhere(key))

    def _follow_elsewhere(self, wanted: FanKey | None) -> None:
        """Have shots of a fan that has begun computed where otherwise the path is, which must not wait for them."""
        key, worker, left = None, self.game.workers.path, wanted.left if wanted is not None else 0
        if wanted is not None and left and self.game.workers.helper is not worker:
            key = (*wanted[:2], len(self._from_elsewhere(wanted)))
        self.elsewhere.follow(key, lambda key: worker.submit(shots_from_end, key[0].scene, key[1], left))

    def _from_elsewhere(self, key: FanKey) -> list[FanShot | None]:
        """The shots of a fan that were computed elsewhere."""
        known = self.elsewhere
        return known.value if known.value is not None and not key.quick and known.key[:2] == key[:2] else []

    def of(self, shot: Shot) -> Cloud | None:
        """The fan of a shot; while the aim changes that of a moment ago."""
        there = self.job.value is not None and self.job.key.shot.place == shot.place
        return self.job.value if there else None

    def matches(self, shot: Shot) -> bool:
        """True if the fan is that of a shot, and not of a moment ago."""
        return self.job.key is not None and self.job.key.shot is shot

    def image(self, shot: Shot, camera: Camera) -> tuple[pygame.Surface, tuple[int, int]] | None:
        """The paths of the fan of a shot as a camera sees them, dim if they are of a moment ago; and where, in px."""
        found = self.of(shot)
        if found is None or not found.pixels or self.job.key.camera != camera:
            return None
        image: pygame.Surface = self._once(
            "image", found, lambda: pygame.image.frombuffer(found.pixels, found.size, "RGBA")
        )
        image.set_alpha(255 if self.matches(shot) else OUTDATED)
        return image, found.at
