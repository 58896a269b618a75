"""The camera of a shot: it shows all of it, a part that the player has chosen, or near the ball that is followed."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from sandbox.picture.camera import Camera
from sandbox.picture.view import View as Picture
from sandbox.window.background import KeyedCache
from sandbox.window.game import Game
from sandbox.window.screen import Screen
from sandbox.window.shots import Shot
from sandbox.window.shown import Shown
from sandbox.window.stages import Stages

#: Largest and smallest zoom, compared with a view of the whole shot.
_NEAREST, _FARTHEST = 60.0, 0.2
#: No ball becomes larger by zooming than with this radius, as a share of the picture's height.
_LARGEST_BALL = 0.12
#: A view that follows the ball can be so many times nearer or farther.
_NEARER = 8.0
#: The ground is never higher than this, as a share of the picture's height.
_HIGHEST = 0.3


class Viewpoint:
    """Zooms, moves and holds the camera of the stages, or that which follows the ball."""

    def __init__(self, game: Game, screen: Screen, shown: Shown, stages: Stages) -> None:
        self.game, self.screen, self.shown, self.stages = game, screen, shown, stages
        self.nearer = 1.0  # where the view follows the ball
        self._holds = False  # the camera, while something is dragged
        self._once = KeyedCache()

    @property
    def camera(self) -> Camera | None:
        """The current camera; None until there is a stage."""
        shot = self.game.shot
        if not self.shown.follows or shot is None:
            return self.stages.latest.camera if self.stages.latest is not None else None
        return self.near(shot).view(self.shown.time)

    def near(self, shot: Shot) -> Picture[Any]:
        """The picture of a shot that follows its ball, as near as the player has zoomed."""
        size, look = self.screen.area.size, self.game.memory.look
        found: Picture[Any] = self._once("near", (shot, size, look), lambda: shot.run.scene.picture(shot.run, size))

        def view(t: float) -> Camera:
            """The picture's own, nearer, with the ball in the same place; on whole px."""
            camera = type(found).view(found, t)
            near = _scaled(camera, self.nearer, camera.pixel(*shot.run.state(shot.ball, t)[:2]))
            return replace(near, anchor=(round(near.anchor[0]), round(near.anchor[1])))

        vars(found)["view"] = view
        return found

    def zoom(self, factor: float, at: tuple[float, float]) -> None:
        """Zoom by ``factor`` around a place (px), or around the ball that the view follows."""
        stage = self.stages.latest
        if self.shown.follows:
            self.nearer = min(max(self.nearer * factor, 1 / _NEARER), _NEARER)
        elif stage is not None:
            camera, whole = self.stages.chosen or stage.camera, stage.whole.scale
            largest = max(ball.radius for ball in stage.shot.run.setup.balls)
            nearest = max(whole, min(_NEAREST * whole, _LARGEST_BALL * self.screen.area.height / largest))
            scale = min(max(camera.scale * factor, _FARTHEST * whole), nearest)
            self.look(_scaled(camera, scale / camera.scale, at))

    def pan(self, across: float, down: float) -> None:
        """Move the picture by so many px."""
        if self.stages.latest is not None:
            camera = self.stages.chosen or self.stages.latest.camera
            right, foot = camera.anchor
            self.look(replace(camera, anchor=(right + across, foot + down)))

    def look(self, camera: Camera | None) -> None:
        """Use another camera; None shows all of the shot. From the side the ground stays in the lower part."""
        if self.shown.follows and camera is not None:
            self.game.messages.tell("the view follows the ball; V for the whole view")
            return
        shot = self.game.shot
        if camera is not None and shot is not None and shot.upright:
            across, down = camera.anchor
            camera = replace(camera, anchor=(across, max(down, _HIGHEST * self.screen.area.height)))
        self.stages.choose(camera)
        self.nearer, self._holds = 1.0, False

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
