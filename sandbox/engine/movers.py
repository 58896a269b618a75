"""The balls and bodies of a run, with the surfaces and traps that each may meet."""

from __future__ import annotations

from collections.abc import Sequence

from sandbox.engine.contact.driven import DrivenPath, MovingObstacle
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.model.accuracy import Accuracy
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Surface, Trap
from sandbox.engine.motion.carried_ball import CarriedBall
from sandbox.engine.motion.forces_on_ball import refuse_unrepeatable
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.motion.moving_body import MovingBody
from sandbox.engine.motion.on_plane import OnPlane
from sandbox.engine.paths.run import Numerics
from sandbox.engine.start import starts
from sandbox.physics.integrators import State


class Surroundings:
    """The surfaces and traps of a setup, prepared for balls of each radius."""

    def __init__(self, setup: Setup, skin: float) -> None:
        self._setup, self._skin = setup, skin
        self._traps: list[tuple[Trap, Obstacle]] = [
            (each, Obstacle(Surface(each.name, each.shape, 0.0, 0.0), 0.0, skin)) for each in setup.traps
        ]
        self._driven = {id(each): DrivenPath(each) for each in setup.surfaces if each.motion is not None}
        self.obstacles: dict[float, list[Obstacle]] = {}  # by radius in m
        for ball in setup.balls:
            self.add(ball.radius)

    def add(self, radius: float) -> None:
        """Prepare the surfaces for balls of this radius in m, too."""
        if radius not in self.obstacles:
            self.obstacles[radius] = [self._obstacle(surface, radius) for surface in self._setup.surfaces]

    def _obstacle(self, surface: Surface, radius: float) -> Obstacle:
        if surface.motion is None:
            return Obstacle(surface, radius, self._skin)
        return MovingObstacle(surface, self._driven[id(surface)], radius, self._skin)

    def traps_for(self, ball: Ball) -> Sequence[Obstacle]:
        """Return the traps that take a ball."""
        return [place for trap, place in self._traps if trap.takes(ball.name)]

    def mover(self, ball: Ball, state: State, accuracy: Accuracy, numerics: Numerics) -> MovingBall:
        """Return a ball or body in this state."""
        setup, kind = self._setup, self._kind(ball)
        return kind(ball, state, self.obstacles[ball.radius], self.traps_for(ball), setup, accuracy, numerics)

    def _kind(self, ball: Ball) -> type[MovingBall]:
        if self._setup.plane is not None:
            return OnPlane
        if ball.rotates:
            return MovingBody
        return CarriedBall if self._driven else MovingBall


def movers_at_start(setup: Setup, accuracy: Accuracy, numerics: Numerics) -> list[MovingBall]:
    """Return the balls and bodies of a setup at its start. Raises RequestError if some overlap."""
    around = Surroundings(setup, accuracy.skin)
    places = starts(setup.balls, around.obstacles)
    movers = []
    for ball, (x, y) in zip(setup.balls, places, strict=True):
        state = (x, y, *map(float, setup.start_of(ball)[2:]))
        refuse_unrepeatable(ball, 0.0, state)
        movers.append(around.mover(ball, state, accuracy, numerics))
    return movers
