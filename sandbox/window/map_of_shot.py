"""The map of the current shot, computed by the helper: a coarse one first, then a finer one."""

from __future__ import annotations

from typing import Any, NamedTuple

from sandbox.scene import Scene
from sandbox.window.background import HUNG, LatestJob
from sandbox.window.game import Game
from sandbox.window.score_map import FINER, QUICK, ScoreMap, score_map
from sandbox.window.shots import Shot
from sandbox.window.shown import Shown
from sandbox.window.stages import AT_REST


class MapKey(NamedTuple):
    """The map that is wanted."""

    around: tuple[Any, ...]  # the scene apart from the aim
    scene: Scene  # its aim is the map's middle
    finer: int


class MapOfShot:
    """Follows the shot with a map, in whose middle the aim stays for as long as it is on the map."""

    def __init__(self, game: Game, shown: Shown) -> None:
        self.game, self.shown = game, shown
        self.job: LatestJob[ScoreMap] = LatestJob(game.workers.helper.abandon, HUNG)

    @property
    def next_key(self) -> MapKey | None:
        """The key of the map that is still to be computed."""
        game, shot, known, last = self.game, self.game.shot, self.job.value, self.job.key
        if "map" not in self.shown.on or shot is None or game.failure is not None or game.still < AT_REST:
            return None
        same = last is not None and last.around == shot.scene_without_aim
        if not same or (known is not None and not known.holds(*shot.aim)):
            return MapKey(shot.scene_without_aim, shot.scene, 1)
        finer = known is not None and last.finer == 1 and known.seconds < QUICK
        return last._replace(finer=FINER) if finer else None

    def follow(self) -> bool:
        """Begin what is wanted, and take what is there; returns whether there is something new."""
        new = self.job.take()
        self.job.follow(self.next_key, lambda key: self.game.workers.helper.submit(score_map, key.scene, key.finer))
        return new

    def of(self, shot: Shot) -> ScoreMap | None:
        """The map around a shot."""
        known = self.job.value
        return known if known is not None and self.job.key.around == shot.scene_without_aim else None
