"""The camera of a shot: it goes with its story, or shows all of it, or a part that the player has chosen."""

from __future__ import annotations

from dataclasses import replace

from sandbox.picture.camera import Camera
from sandbox.window.game import Game
from sandbox.window.screen import Screen
from sandbox.window.shown import Shown
from sandbox.window.stage import Stage
from sandbox.window.stages import Stages

#: Largest and smallest zoom, compared with a view of the whole shot.
_NEAREST, _FARTHEST = 60.0, 0.2
#: No ball becomes larger by zooming than with this radius, as a share of the picture's height.
_LARGEST_BALL = 0.12
#: The ground is never higher than this, as a share of the picture's height.
_HIGHEST = 0.3


class Viewpoint:
    """Zooms, moves and holds the camera of the stages, and has it go with the story of what is watched."""

    def __init__(self, game: Game, screen: Screen, shown: Shown, stages: Stages) -> None:
        self.game, self.screen, self.shown, self.stages = game, screen, shown, stages
        self._holds = False  # the camera, while something is dragged

    def framed(self, stage: Stage) -> Stage:
        """A stage as the camera sees it now: where a shot is watched it goes with its story."""
        playback = self.game.watching.playback
        return stage.at(playback.camera_time) if playback is not None and playback.story is not None else stage

    @property
    def camera(self) -> Camera | None:
        """The current camera; None until there is a stage."""
        stage = self.stages.latest
        return None if stage is None else self.framed(stage).camera

    def follow(self) -> None:
        """Give the shot that is watched the pace of its story, or none if the camera stands still."""
        playback, stage, story = self.game.watching.playback, self.stages.latest, None
        if self.shown.follows and playback is not None and stage is not None and stage.shot.run is playback.shot.run:
            story = stage.camerawork
        if playback is not None:
            playback.story = story

    def zoom(self, factor: float, at: tuple[float, float]) -> None:
        """Zoom by ``factor`` around a place (px)."""
        stage = self.stages.latest
        if stage is not None:
            camera, whole = self.stages.chosen or self.framed(stage).camera, stage.whole.scale
            largest = max(ball.radius for ball in stage.shot.run.setup.balls)
            nearest = max(whole, min(_NEAREST * whole, _LARGEST_BALL * self.screen.area.height / largest))
            scale = min(max(camera.scale * factor, _FARTHEST * whole), nearest)
            self.look(_scaled(camera, scale / camera.scale, at))

    def pan(self, across: float, down: float) -> None:
        """Move the picture by so many px."""
        if self.stages.latest is not None:
            camera = self.stages.chosen or self.framed(self.stages.latest).camera
            right, foot = camera.anchor
            self.look(replace(camera, anchor=(right + across, foot + down)))

    def look(self, camera: Camera | None) -> None:
        """Use another camera; None shows all of the shot. From the side the ground stays in the lower part."""
        shot = self.game.shot
        if camera is not None and shot is not None and shot.upright:
            across, down = camera.anchor
            camera = replace(camera, anchor=(across, max(down, _HIGHEST * self.screen.area.height)))
        self.stages.choose(camera)
        self._holds = False

    def hold(self) -> None:
        """Keep the camera as it is: what is dragged stays under the mouse."""
        if self.stages.chosen is None and self.stages.latest is not None:
            self.stages.choose(self.stages.latest.camera)
            self._holds = True

    def release(self) -> None:
        """Let the camera go that was held."""
        if self._holds:
            self.stages.choose(None)
            self._holds = False


def _scaled(camera: Camera, factor: float, at: tuple[float, float]) -> Camera:
    """A camera that is nearer by a factor, with what is at a place (px) still there."""
    across, down = (to + (px - to) * factor for to, px in zip(at, camera.anchor, strict=True))
    return replace(camera, anchor=(across, down), scale=camera.scale * factor)
