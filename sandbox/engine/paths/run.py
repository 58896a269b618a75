"""The result of a run: the path of each ball, the events, and the cost."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from math import dist, inf, nan
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Protocol, Unpack

from sandbox.display import Drawable
from sandbox.engine.model.event import Event
from sandbox.engine.paths.path import Above, Path
from sandbox.errors import RequestError

if TYPE_CHECKING:
    import numpy as np

    from sandbox.engine.model.accuracy import Accuracy
    from sandbox.engine.model.ball import Ball
    from sandbox.engine.model.change import Changes
    from sandbox.engine.model.setup import Setup
    from sandbox.engine.model.shapes import Vector


@dataclass(slots=True)
class Numerics:
    """The cost of a run.

    >>> import sandbox
    >>> sandbox.simulate("golf").numerics.force_evaluations > 100
    True
    """

    force_evaluations: int = 0
    steps: int = 0  # pieces of path
    refined_steps: int = 0  # steps repeated with a shorter step
    impacts: int = 0
    pymunk_steps: int = 0
    queries: int = 0  # pairs of ball path and shape checked for contact
    wall_s: float = 0.0  # without imports; of a run computed together with others until its end, with theirs
    clusters: int = 0  # impacts of several balls at once, simulated through the contact


#: What is done about a time before the start or after the end of a run: an error, or NaN in place of numbers.
_Outside = Literal["error", "nan"]

#: A time may be so much of the duration outside a run, which is rounding: 3 * 0.1 is more than 0.3.
ROUNDING_OF_TIME = 1e-12


class State(NamedTuple):
    """The state of a ball or body at one time.

    >>> import sandbox
    >>> run = sandbox.simulate("golf")
    >>> state = run.state("ball", 0.0)
    >>> x, y, vx, vy, spin = state
    >>> state.x == x, state.vx > 0.0
    (True, True)
    """

    x: float  # m
    y: float  # m
    vx: float  # m/s
    vy: float  # m/s
    spin: float  # rad/s, counter-clockwise


def is_meeting(event: Event, partner: str | None, ball: str) -> bool:
    """True of an event with this partner, or with None of one in which the ball meets anything."""
    if partner is None:
        return event.kind != "leave" and ball in (event.ball, event.partner)
    return event.partner == partner


def meeting_time(events: Sequence[Event], partner: str | None, ball: str = "") -> float:
    """Time in s of the first such event; inf without one."""
    return next((event.t for event in events if is_meeting(event, partner, ball)), inf)


def touched_until(events: Sequence[Event], until: float) -> list[str]:
    """The partners of impacts and contacts up to a time in s, in order."""
    return [event.partner for event in events if event.kind in ("impact", "contact") and event.t <= until]


class _Resumable(Protocol):
    """The record of how a run came about, from which it can be computed again from any time on."""

    def fork(self, t: float, changes: Mapping[str, Any]) -> Run:
        """Return the run that goes on from t in s with what is given changed."""


@dataclass
class Run(Drawable):
    """One simulated run, from ``t = 0`` to ``duration``: paths, events, and what they cost.

    >>> import sandbox
    >>> from sandbox import Ball, Gravity, Segment, Setup, Surface
    >>> ball = Ball("ball", mass=0.62, radius=0.12, position=(0, 2), velocity=(5, 6), forces=[Gravity(9.81)])
    >>> floor = Surface("floor", Segment((-10, 0), (30, 0)), restitution=0.8, friction=0.4)
    >>> run = sandbox.simulate(Setup([ball], [floor], duration=3.0))
    >>> run.events[0].partner, round(run.events[0].t, 4), run.duration
    ('floor', 1.4819, 3.0)
    >>> round(run.state("ball", 1.0).x, 6)  # m
    5.0
    >>> run.states("ball", [0.0, 0.5, 1.0]).shape
    (3, 5)
    """

    setup: Setup
    accuracy: Accuracy
    arcs: Mapping[str, Path]  # by ball
    events: list[Event]
    numerics: Numerics
    duration: float  # s
    ended: str  # "rest", "until" or "duration"
    #: The setups of a run that was changed on its way, each with the time in s from which it was valid; ``setup`` is
    #: the last.
    eras: Sequence[tuple[float, Setup]] = field(default=(), kw_only=True)
    record: _Resumable | None = field(default=None, kw_only=True, compare=False, repr=False)

    def __repr__(self) -> str:
        return f"<Run: {self.duration:.2f} s, {len(self.events)} events, ended by {self.ended}>"

    def state(self, ball: str, t: float, outside: _Outside = "error") -> State:
        """Return x, y (m), vx, vy (m/s) and spin (rad/s) of a ball or body at time t in s.

        At an impact it is the state just after. A time before the start or after the end of the run raises
        RequestError, or gives NaN with ``outside="nan"``.
        """
        path = self._path(ball)
        if not self._within(path, ball, t, outside):
            return State(nan, nan, nan, nan, nan)
        return State(*path.at(t).state(t)[:5])

    def states(self, ball: str, times: Sequence[float] | np.ndarray, outside: _Outside = "error") -> np.ndarray:
        """Return the states of a ball at these n times in s, in any order, as an array of shape (n, 5): x, y in m, vx,
        vy in m/s, spin in rad/s. That of a body has shape (n, 6): its angle in rad comes last.

        ``outside`` is as for ``state``.
        """
        import numpy as np

        path = self._path(ball)
        columns = 6 if self._ball(ball).rotates else 5
        missing = (nan,) * columns
        try:
            asked = np.asarray(times, dtype=float).ravel().tolist()
        except (TypeError, ValueError):
            raise RequestError(f"times = {times!r:.60}: must be numbers, in s") from None
        rows = [path.at(t).state(t)[:columns] if self._within(path, ball, t, outside) else missing for t in asked]
        return np.array(rows, dtype=float).reshape(-1, columns)

    def _within(self, path: Path, ball: str, t: float, outside: _Outside) -> bool:
        """Return True if the run has the time t, apart from rounding. Raises RequestError if not, unless NaN may do."""
        start, rounding = path[0].t0, ROUNDING_OF_TIME * self.duration
        if not isinstance(t, int | float) and getattr(t, "ndim", None) != 0:
            raise RequestError(f"ball {ball!r}, t = {t!r:.60}: must be a number, in s; times go into run.states")
        if start - rounding <= t <= self.duration + rounding:
            return True
        if outside == "nan":
            return False
        if outside != "error":
            raise RequestError(f'outside = {outside!r}: must be "error" or "nan"')
        span = f"from {start:.12g} to {self.duration:.12g} s"
        raise RequestError(f'ball {ball!r}, t = {t:.12g} s: the run is {span}; outside="nan" gives NaN')

    def fork(self, t: float, **changes: Unpack[Changes]) -> Run:
        """Return the run that goes on from time t in s with what is given changed, and is the same before.

        What is not given continues as it was, contacts included: without any change it is this run again, to the last
        bit. What is given of balls is a mapping by name, or the value itself where there is only one ball:

        - ``forces``, ``torques``: in place of the ball's own;
        - ``velocity`` (m/s), ``spin`` (rad/s), ``position`` (m), ``impulse`` (N s);
        - ``add``: balls or bodies that come in, as they are at this time; ``remove``: names of those taken out;
        - ``duration``, ``until``, ``surfaces`` and the other fields of the setup.

        >>> import sandbox
        >>> run = sandbox.simulate("golf")
        >>> struck = run.fork(1.5, velocity=(20.0, 5.0))
        >>> struck.state("ball", 1.0) == run.state("ball", 1.0)
        True

        Only what comes after t is computed, and some events before it: a few dozen, or all since a heap began. Balls
        that are then in a simulated contact with others (some 0.1 ms) go through it first. Raises RequestError for a
        time outside the run, or what cannot be changed so.
        """
        if self.record is None:
            raise RequestError("this run cannot be forked: it was read from a file, or computed by the plain method")
        if not (isinstance(t, int | float) and 0.0 <= t <= self.duration):
            raise RequestError(f"fork at t = {t} s: the run is from 0 to {self.duration:.12g} s")
        return self.record.fork(t, changes)

    # ------------------------------------------------------------------ along the paths

    def _ball(self, name: str) -> Ball:
        """The ball or body of this name."""
        return next(ball for ball in self.setup.balls if ball.name == name)

    def _path(self, ball: str) -> Path:
        """The arcs of a ball. Raises RequestError if there is no such ball."""
        try:
            return self.arcs[ball]
        except (KeyError, TypeError):
            raise RequestError(f"there is no ball {ball!r}; there are {', '.join(map(repr, self.arcs))}") from None

    def rolling_spin(self, ball: str, t: float) -> tuple[float, float]:
        """Spin about x and about y of a ball that rolls on a plane, in rad/s; none of one that slides as a disc."""
        path = self._path(ball)
        self._within(path, ball, t, "error")
        wx, wy = path.at(t).spins(t)[1:] or (0.0, 0.0)
        return wx, wy

    def caught_at(self, ball: str) -> float | None:
        """The time in s at which a ball was caught or taken out, or None."""
        gone = ("caught", "removed")
        return next((event.t for event in self.events if event.kind in gone and event.ball == ball), None)

    def before(self, ball: str, t: float) -> State:
        """The state of a ball just before time t; differs from ``state`` if there is an impact at t."""
        path = self._path(ball)
        self._within(path, ball, t, "error")
        return State(*path.state_before(t))

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
        path = self._path(ball)
        self._within(path, ball, t, "error")
        state = path.at(t).state(t)
        if len(state) == 6:
            return float(state[5])
        turned = 0.0
        for arc in path:
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
        if not (isinstance(every, int | float) and 0.0 < every < inf):
            raise RequestError(f"every = {every}: must be more than 0 s, and finite")
        count = int(self.duration / every * (1.0 + 1e-12)) + 1
        times = {min(i * every, self.duration) for i in range(count)}
        if ends:
            times |= {0.0, self.duration, *path.starts}
        return np.array([(t, *self.state(ball, t)) for t in sorted(times)])

    def crossings(self, ball: str, point: Vector, normal: Vector) -> Iterator[tuple[float, State]]:
        """Each time (s) and State at which a ball's centre passes the line through ``point`` (m) against ``normal``.

        With a normal of (0, 1) that is on its way down, with (-1, 0) on its way forward. As exact as the path itself,
        for any step: roots of its polynomials.
        """
        return ((t, State(*state)) for t, state in self._path(ball).passages(Above.line(point, normal)))

    def first_crossing(
        self, ball: str, point: Vector, normal: Vector, before: float = inf
    ) -> tuple[float, State] | None:
        """The first time (s) and State at which it does so; None if it does not ``before`` a time in s."""
        return next((found for found in self.crossings(ball, point, normal) if found[0] < before), None)

    def before_meeting(
        self, partner: str | None = None, ball: str = "ball", before: float = inf
    ) -> tuple[float, State] | None:
        """Time (s) of the first event with this partner, or in which the ball meets anything, and State of the ball
        just before; None without one ``before`` a time in s."""
        t = meeting_time(self.events, partner, ball)
        return (t, self.before(ball, t)) if t < before else None

    def until_meeting(self, partner: str) -> float:
        """Time (s) of the first event with this partner, or of the end of the run."""
        return min(meeting_time(self.events, partner), self.duration)

    def highest(self, ball: str, until: float = inf) -> tuple[float, State]:
        """Time (s) and State at which a ball's centre is highest, up to a time at which it is not."""
        t, state = self._path(ball).highest(until)
        return t, State(*state)

    def starts(self, ball: str) -> Iterator[tuple[float, State]]:
        """Time (s) and State at the start of each arc of a ball's path."""
        return ((arc.t0, State(*arc.start)) for arc in self._path(ball))

    def steps(self, ball: str, until: float) -> tuple[np.ndarray, np.ndarray]:
        """Each arc of a ball's path up to a time in s: its duration in s, shape (arcs,), and time and state at its
        start, middle and end, shape (6, arcs, 3): t, x, y, vx, vy, spin."""
        import numpy as np

        arcs = [(arc, min(arc.t1, until) - arc.t0) for arc in self._path(ball) if arc.t0 < until]
        times = [(arc, arc.t0 + part * h) for arc, h in arcs for part in (0.0, 0.5, 1.0)]
        states = np.array([(t, *arc.state(t)[:5]) for arc, t in times]).reshape(-1, 3, 6)
        return np.array([h for _, h in arcs]), np.moveaxis(states, 2, 0)

    def first_start(self, ball: str, holds: Callable[[State], bool], among: bool = True) -> float:
        """Time (s) of the start of the first arc of a ball's path at which something ``holds``; inf without one, or for
        a run that is not ``among`` those in question."""
        starts = self.starts(ball) if among else iter(())
        return next((t for t, state in starts if holds(state)), inf)

    def first_event(self, partner: str) -> Event | None:
        """The first event with this partner; None if there is none."""
        return next((event for event in self.events if event.partner == partner), None)

    def touched(self, until: float) -> list[str]:
        """The partners of impacts and contacts up to a time in s, in order."""
        return touched_until(self.events, until)

    def ends(self, ball: str) -> Iterator[tuple[float, State]]:
        """Time (s) and State at the end of each arc of a ball's path."""
        return ((t, State(*state)) for t, state in self._path(ball).ends())
