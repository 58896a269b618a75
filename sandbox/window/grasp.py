"""The mouse's hold: a pull, or a handle that is dragged."""

from __future__ import annotations

from sandbox.window.aim import Pull, speeds
from sandbox.window.aiming import Aiming
from sandbox.window.handles import Grip


class Grasp:
    """Holds the pull, or the handle, and the parameters from before it."""

    def __init__(self, aiming: Aiming) -> None:
        self.aiming = aiming
        self.pull: Pull | None = None
        self.grip: Grip | None = None  # what is dragged, as it was before
        self.before = aiming.session.changes

    @property
    def holds(self) -> bool:
        """True if the mouse pulls or drags."""
        return self.pull is not None or self.grip is not None

    def begin_pull(self, at: tuple[int, int], window: tuple[int, int], height: float, stretch: float) -> None:
        """The mouse begins a pull at a place of a ``window`` of this size (px), on a stage of ``height`` px."""
        self._begin()
        self.pull = Pull(at, speeds(self.aiming.session), window, height, stretch)

    def pull_to(self, at: tuple[int, int], fine: bool = False) -> None:
        """The mouse pulls on to a place (px), or ``fine`` a tenth of the way."""
        if self.pull is None:
            return
        self.pull.move(at, fine)
        values = self.pull.changes(self.aiming.session)
        if values is not None:
            self.aiming.change(values)

    def begin_drag(self, grip: Grip) -> None:
        """The mouse takes hold of something in the picture."""
        self._begin()
        self.grip = grip

    def _begin(self) -> None:
        self.aiming.history.end()
        self.before = self.aiming.session.changes

    def drag_to(self, place: tuple[float, float], step: float) -> None:
        """Move what is held to a place, in steps of so many m or m/s, as far as that is possible."""
        if self.grip is not None:
            self.aiming.set(self.grip.changes(place, step))

    def release(self) -> None:
        """The mouse lets go: a pull that is long enough is a shot."""
        pull = self.pull
        self.let_go()
        self.aiming.history.end()
        if pull is not None and pull.shoots:
            self.aiming.shoot()

    def let_go(self) -> None:
        """Hold nothing, with the parameters as they are."""
        self.pull = self.grip = None

    def cancel(self) -> None:
        """Aim as before the pull or the drag."""
        if self.holds:
            self.let_go()
            self.aiming.restore(self.before)
            self.aiming.history.cancel(self.before)
