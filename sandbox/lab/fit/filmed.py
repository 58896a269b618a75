"""Places of balls that were measured on a film or a photograph, in its own axes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from sandbox.errors import RequestError
from sandbox.lab.fit.flown import flown
from sandbox.lab.fit.frame import Frame
from sandbox.lab.fit.measured import Free, Rows
from sandbox.lab.selection import LeftOut
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun


@dataclass(frozen=True)
class Filmed(Rows):
    """Measured places of balls, in the order of the file."""

    positions: np.ndarray  # m, shape (points, 2): x, y, in the axes of the film
    balls: tuple[str, ...]  # the ball of each point; "" if the file names none
    numbers: np.ndarray  # the row of each point in its file, the first is 1; shape (points,)
    frame: Frame
    where: str  # as messages begin
    left_out: tuple[LeftOut, ...] = field(default=(), kw_only=True)
    unused: tuple[str, ...] = field(default=(), kw_only=True)  # columns of the tables
    notes: tuple[str, ...] = field(default=(), kw_only=True)  # on how the tables were read

    what = "point"
    runs = 1

    def __len__(self) -> int:
        return len(self.positions)

    @property
    def free(self) -> tuple[Free, ...]:
        """The numbers of the film's clock and axes that are fitted."""
        return self.frame.free

    def named(self, scene: Scene) -> tuple[str, ...]:
        """The ball of each point; the scene's first where none is named."""
        first = scene.build().balls[0].name
        return tuple(ball or first for ball in self.balls)

    def check(self, scene: Scene) -> None:
        """Raise RequestError if it is of a ball that the scene does not have."""
        names = [ball.name for ball in scene.build().balls]
        unknown = next((ball for ball in self.balls if ball and ball not in names), None)
        if unknown is not None:
            hint = f'; say which one it is, as --ball "{unknown}={names[0]}"'
            several = len({*self.balls}) > len(names)
            hint += ", and the others are left out" if several else ""
            raise RequestError(f"{self.where}: no ball {unknown!r} in {scene.title}; it has {', '.join(names)}{hint}")

    def flights(
        self, scene: Scene, keys: Sequence[str], values: np.ndarray, until: float
    ) -> Iterator[tuple[int, SceneRun, str, np.ndarray, np.ndarray]]:
        """Each candidate's number and its run up to a time in s, with the name of each ball that was measured, the
        places of that ball's points in the data, and their positions in the scene in m; nothing of a run that failed.
        """
        balls = np.array(self.balls)
        of_ball = {ball: np.flatnonzero(balls == ball) for ball in dict.fromkeys(self.balls)}
        for candidate, run in enumerate(flown(scene, keys, values, until)):
            if run is not None:
                measured = self.frame.places(self.positions, values[candidate, len(keys) :].tolist())
                for ball, points in of_ball.items():
                    yield candidate, run, ball or run.setup.balls[0].name, points, measured[points]
