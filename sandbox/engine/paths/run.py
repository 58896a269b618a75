"""The result of a run: the path of each ball, the events, and the cost."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import dist, inf
from typing import TYPE_CHECKING, NamedTuple

from sandbox.engine.model.event import Event
from sandbox.engine.paths.path import Above, Path
from sandbox.errors import RequestError
from sandbox.physics.integrators import State

if TYPE_CHECKING:
    import numpy as np

    from sandbox.engine.model.accuracy import Accuracy
    from sandbox.engine.model.setup import Setup
    from sandbox.engine.model.shapes import Vector


@dataclass(slots=True)
class Numerics:
    """The cost of a run."""

    force_evaluations: int = 0
    steps: int = 0  # pieces of path
    refined_steps: int = 0  # steps repeated with a shorter step
    impacts: int = 0
    pymunk_steps: int = 0
    queries: int = 0  # pairs of ball path and shape checked for contact
    wall_s: float = 0.0  # without imports; of a run computed together with others until its end, with theirs
    clusters: int = 0  # impacts of several balls at once, simulated through the contact


class Motion(NamedTuple):
    """The state of a ball."""

    x: float  # m
    y: float  # m
    vx: float  # m/s
    vy: float  # m/s
    spin: float  # rad/s, counter-clockwise


@dataclass
class Run:
    """One simulated run, from ``t = 0`` to ``duration``."""

    setup: Setup
    accuracy: Accuracy
    arcs: Mapping[str, Path]  # by ball
    events: list[Event]
    numerics: Numerics
    duration: float  # s
    ended: str  # "rest", "until" or "duration"

    def __repr__(self) -> str:
        return f"<Run: {self.duration:.2f} s, {len(self.events)} events, ended by {self.ended}>"

    def state(self, ball: str, t: float) -> Motion:
        """x, y, vx, vy and spin of a ball at time t, constant after the end; m, m/s, rad/s.

        At an impact it is the state just after.
        """
        return Motion(*self._path(ball).at(t).state(t)[:5])

    def states(self, times: Sequence[float], ball: str = "ball") -> np.ndarray:
        """The states of a ball at these times in s, shape (times, 5): x, y, vx, vy, spin in m, m/s, rad/s."""
        import numpy as np

        return np.array([self.state(ball, float(t)) for t in times]).reshape(-1, 5)

    # ------------------------------------------------------------------ along the paths

    def _path(self, ball: str) -> Path:
        """The arcs of a ball. Raises RequestError if there is no such ball."""
        try:
            return self.arcs[ball]
        except (KeyError, TypeError):
            raise RequestError(f"there is no ball {ball!r}; there are {', '.join(map(repr, self.arcs))}") from None

    def rolling_spin(self, ball: str, t: float) -> tuple[float, float]:
        """Spin about x and about y of a ball that rolls on a plane, in rad/s; none of one that slides as a disc."""
        wx, wy = self._path(ball).at(t).state(t)[5:] or (0.0, 0.0)
        return wx, wy

    def caught_at(self, ball: str) -> float | None:
        """The time in s at which a ball was caught, or None."""
        return next((event.t for event in self.events if event.kind == "caught" and event.ball == ball), None)

    def before(self, ball: str, t: float) -> State:
        """The state of a ball just before time t; differs from ``state`` if there is an impact at t."""
        return self._path(ball).before(t).state(t)[:5]

    def closing_speed(self, event: Event) -> float:
        """Speed in m/s at which the two of an impact came together, along the surface included.

        ``event.speed`` is only its part towards each other.
        """
        velocity, other = (
            (self.before(name, event.t)[2:4] if name in self.arcs else (0.0, 0.0))
            for name in (event.ball, event.partner)
        )
        return dist(velocity, other)

    def angle(self, ball: str, t: float) -> float:
        """Angle in rad that a ball has turned since the start, or at which a body is, counter-clockwise."""
        state = self._path(ball).at(t).state(t)
        if len(state) == 6:
            return float(state[5])
        turned = 0.0
        for arc in self._path(ball):
            if arc.t0 >= t:
                break
            part = arc.until(t)
            spin = part.curves[4]
            turned += (part.t1 - part.t0) * sum(spin) / len(spin)
        return turned

    def trajectory(self, ball: str = "ball", every: float = 1 / 120, ends: bool = False) -> np.ndarray:
        """Samples of a ball's path, shape (samples, 6): t, x, y, vx, vy, spin in s, m, m/s, rad/s.

        One every ``every`` seconds from the start to the end. ``ends`` adds the ends of all arcs, which include every
        impact, and the run's end; the rows are then unevenly spaced.
        """
        import numpy as np

        path = self._path(ball)
        if not 0.0 < every < inf:
            raise RequestError(f"every = {every}: must be more than 0 s, and finite")
        count = int(self.duration / every * (1.0 + 1e-12)) + 1
        times = {min(i * every, self.duration) for i in range(count)}
        if ends:
            times |= {0.0, self.duration, *path.starts}
        return np.array([(t, *self.state(ball, t)) for t in sorted(times)])

    def crossings(self, ball: str, point: Vector, normal: Vector) -> Iterator[tuple[float, State]]:
        """Each time and state at which a ball's centre passes the line through ``point`` (m) against ``normal``.

        As exact as the path itself, for any step: roots of its polynomials.
        """
        return iter(self._path(ball).passages(Above(*point, *normal)))

    def highest(self, ball: str, until: float = inf) -> tuple[float, State]:
        """Time and state at which a ball's centre is highest, up to a time at which it is not."""
        return self._path(ball).highest(until)

    def ends(self, ball: str) -> Iterator[tuple[float, State]]:
        """Time and state at the end of each arc of a ball's path."""
        return iter(self._path(ball).ends())
