"""The path of a ball as pictures show it, as numbers: its points, the ball at even times, where it struck something."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from math import ceil, floor, inf, log2

import numpy as np

from sandbox.engine.contact.manifold import fixed_outline
from sandbox.engine.many.bernstein_many import evaluate
from sandbox.engine.model.ball import outline_of
from sandbox.engine.model.event import Event
from sandbox.engine.model.nearest import Pose, meeting_points, nearest
from sandbox.engine.model.shapes import Shape
from sandbox.engine.paths.run import Run

#: The path is sampled this often in s; of a long run, in so many pieces.
_SAMPLING, MOST_SAMPLES = 1 / 120, 5000
#: Points of a trace are this far apart, in px.
FINEST = 1.5
#: Points on each arc of a path. The arcs of a drive are seconds long, and its line must still look smooth.
_POINTS = 9
#: A drawn line has no points nearer to each other than this, none farther, in px, and bends by no more at one, in rad.
_CLOSEST, _LONGEST, _BEND = 3.0, 60.0, 0.12

#: A run is in slow motion if what matters of it, until the first impact but at least this share of the whole, is over
#: sooner than this in s; it then lasts at least so long, but is no more than so many times slower.
_STORIES, _BRIEF, _SEEN, _SLOWEST = 0.4, 0.55, 1.0, 16
#: Values that jump at an impact are sampled so many s before it, too; at most at so many impacts.
_BEFORE, _JUMPS = 1e-9, 200


def hardest(
    run: Run, names: Collection[str] = (), most: int = 12, share: float = 0.15, until: float = inf
) -> list[Event]:
    """The impacts of the balls with these ``names`` or of all, the hardest first: at most so many, and none at less
    than a share of the hardest; only those before the time ``until`` in s."""
    impacts = (event for event in run.events if event.kind == "impact" and _BEFORE < event.t < until)
    own = (event for event in impacts if not names or event.ball in names or event.partner in names)
    hits = sorted(own, key=lambda event: -event.speed)[:most]
    return [event for event in hits if event.speed >= share * hits[0].speed]


def instants(run: Run, pieces: int, names: Collection[str] = ()) -> np.ndarray:
    """Times in s at which to sample a run: evenly spread over so many pieces and, so that what jumps at an impact does,
    just before and at the hardest impacts, of the balls with these ``names`` or of all."""
    hits = (event.t for event in hardest(run, names, _JUMPS, 0.0))
    return np.union1d(np.linspace(0.0, run.duration, pieces + 1), [t for hit in hits for t in (hit - _BEFORE, hit)])


def first_impact(run: Run, ball: str) -> float | None:
    """The time in s at which a ball first hits something, or is hit; None if it never does."""
    impacts = (event.t for event in run.events if event.kind == "impact" and ball in (event.ball, event.partner))
    return next((t for t in impacts if t > _BEFORE), None)


def slow_motion(run: Run, ball: str) -> int:
    """The factor by which a run is slowed down at first: 1, or a power of two for one that is over too soon to be seen,
    such as a pitch, a spike, or a serve up to its bounce."""
    first = first_impact(run, ball)
    lasts = max(run.duration if first is None else first, _STORIES * run.duration)
    if not 0.0 < lasts < _BRIEF:
        return 1
    return min(_SLOWEST, 2 ** ceil(log2(_SEEN / lasts)))


@dataclass(frozen=True)
class ImpactMark:
    """One impact of a ball: where it was touched, in m, and which way from its middle.

    ``speed`` is how fast the two came together, whatever the direction, ``hardness`` the part of it that was towards
    each other; in m/s.
    """

    t: float
    partner: str
    at: tuple[float, float]
    towards: tuple[float, float]
    speed: float
    hardness: float


class DrawnPath:
    """The path of one ball of a run from its start to the time ``until`` in s."""

    def __init__(self, run: Run, name: str = "ball", until: float | None = None):
        self.run, self.name = run, name
        self.until = run.duration if until is None else until
        every, found = max(_SAMPLING, run.duration / MOST_SAMPLES), list[tuple[float, float, float]]()  # t, x, y
        for arc in (arc for arc in run.arcs[name] if arc.t0 < min(arc.t1, self.until)):
            between = range(floor(arc.t0 / every) + 1, 0 if arc.rests else ceil(min(arc.t1, self.until) / every))
            found += [(t, *arc.position(t)) for t in (arc.t0, *(i * every for i in between))]
        self.samples = np.array([*found, (self.until, *run.state(name, self.until)[:2])])
        self.points = self.samples[:, 1:]

    def marks(self) -> Iterator[ImpactMark]:
        """The impacts along the path."""
        for event in self.run.events:
            if event.kind == "impact" and self.name in (event.ball, event.partner) and event.t <= self.until + 1e-9:
                other = event.partner if event.ball == self.name else event.ball
                yield self._mark(event, other)

    def _mark(self, event: Event, other: str) -> ImpactMark:
        surfaces = [s.at(event.t).shape for s in self.run.setup.surfaces if s.name == other]
        others = [(fixed_outline(shape).shape, Pose(0.0, 0.0, 0.0)) for shape in surfaces] or [
            self._outline(other, event.t)
        ]
        own, here = self._outline(self.name, event.t)
        found, it, there = min(((nearest(own, here, *it), *it) for it in others), key=lambda near: near[0].gap)
        at = meeting_points(own, here, it, there, (found.nx, found.ny), 0.0)[0]
        return ImpactMark(event.t, other, at, (-found.nx, -found.ny), self.run.closing_speed(event), event.speed)

    def _outline(self, name: str, t: float) -> tuple[Shape, Pose]:
        """The outline of a ball or body, and where it is at time t in s."""
        ball = next(ball for ball in self.run.setup.balls if ball.name == name)
        angle = self.run.angle(name, t) if ball.rotates else 0.0
        return outline_of(ball), Pose(*self.run.state(name, t)[:2], angle)


def apart(points: np.ndarray, least: float) -> np.ndarray:
    """Indices of points (px, shape (n, 2)) that are ``least`` px from each other along a line, and of the last."""
    return _firsts(np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))]) / least)


def simplify(pixels: np.ndarray) -> np.ndarray:
    """As few of the points (px, shape (n, 2)) as give the same visible line: more where it bends, and each corner.

    Joints would show between short pieces of a smooth line.
    """
    pixels = pixels[apart(pixels, _CLOSEST)]
    steps = np.diff(pixels, axis=0)
    heading = np.arctan2(steps[:, 1], steps[:, 0])
    turn = np.abs((np.diff(heading) + np.pi) % (2 * np.pi) - np.pi)
    along = np.hypot(*steps.T) / _LONGEST
    along[1:] += turn / _BEND
    return pixels[_firsts(np.cumsum(np.append(along, 0.0)))]


def _firsts(growing: np.ndarray) -> np.ndarray:
    """Indices of the first value, of those that pass a whole number, and of the last."""
    return np.unique(np.concatenate([[0], np.flatnonzero(np.diff(np.floor(growing))) + 1, [len(growing) - 1]]))


def points(paths: Sequence[tuple[Run, str]]) -> list[np.ndarray]:
    """Points along the paths of balls of runs, each of shape (n, 3): t in s, x and y in m, in order of time."""
    pieces = [[*run.arcs[ball].pieces()] for run, ball in paths]
    starts, stops, *both = (list(part) for part in zip(*chain(*pieces), strict=True))
    counts = [len(each) for each in pieces]
    out = np.empty((len(starts), _POINTS, 3))
    u = np.linspace(0.0, 1.0, _POINTS)
    first, last = np.array(starts), np.minimum(stops, np.repeat([run.duration for run, _ in paths], counts))
    out[:, :, 0] = first[:, None] + (last - first)[:, None] * u
    for column, curves in enumerate(both, 1):
        lengths = np.array([len(curve) for curve in curves])
        for terms in set(lengths.tolist()):
            rows = np.flatnonzero(lengths == terms)
            out[rows, :, column] = evaluate(np.array([curves[row] for row in rows]).T[:, :, None], u)
    return np.split(out.reshape(-1, 3), _POINTS * np.cumsum(counts)[:-1])


def time_after(way: float, track: np.ndarray) -> float:
    """The time in s at which a ball has gone ``way`` m along the points of its path, shape (n, 3): t, x and y."""
    gone = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(track[:, 1:], axis=0).T))])
    return float(np.interp(way, gone, track[:, 0]))


def moves(run: Run, ball: str) -> bool:
    """True if a ball moves at all."""
    return any(len(arc.x) > 1 or len(arc.y) > 1 for arc in run.arcs[ball])
