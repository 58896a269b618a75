"""A ball that is played over a net, from the side."""

from __future__ import annotations

from sandbox.picture.camera import Camera
from sandbox.picture.sheet import Sheet
from sandbox.picture.side import SideView
from sandbox.picture.view import P


class NetView(SideView[P]):
    """Of a game whose facts are ``sandbox.sport.net_game.FACTS``."""

    def annotate(self, sheet: Sheet, camera: Camera) -> None:
        """How far over the net the ball is as it passes."""
        gap, place = self.run.result["net_clearance"], self.parameters
        if gap is not None and gap > 0.0:
            middle, high = 0.5 * place.court.length, place.net.height  # type: ignore[attr-defined]
            self.gap(sheet, camera, middle, high, high + gap, "over the net")
