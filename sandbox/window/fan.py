"""A fan: the same shot varied at random as a player would, how many such shots score, and a cloud of their paths."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import islice
from math import log1p
from time import process_time
from typing import Any, NamedTuple

import numpy as np

from sandbox import parameters as declared
from sandbox.lab.runs import fly_together, runs
from sandbox.lab.scatter import players_spread
from sandbox.lab.statistics import Numbers, Share
from sandbox.picture.camera import Camera
from sandbox.picture.palette import Colour
from sandbox.picture.path import points
from sandbox.scene import Scene
from sandbox.sport.amounts import amount, significant
from sandbox.window.fan_card import Bars, bars_of
from sandbox.window.shots import Shot

SHOTS = 100
#: So many more are computed at least before a fan is shown, and no more after this time in s; and after this one by a
#: process that may have to compute the path at once.
FEWEST, QUICK, _BRIEF = 8, 0.3, 0.05
#: Opacity of one path; and how far from the picture, in px, a path is still followed.
_FAINT, _FAR = 0.3, 2000
#: Size in px of the mark at the end of a path.
_END = 3
#: A point has so many parts: their sums are exact, in whatever order paths are added.
_PARTS = 1 << 16


#: Parameters that differ, and their standard deviations.
_Spread = Mapping[str, tuple[declared.Parameter, float]]


class FanShot(NamedTuple):
    """A shot of a fan: its path, whether it scores, and its result."""

    path: np.ndarray  # m, shape (points, 2)
    scored: bool
    result: Mapping[str, Any]  # the facts that were asked for


class Cloud(NamedTuple):
    """A fan of shots: a picture of the paths, and what is said of them."""

    at: tuple[int, int]  # px
    size: tuple[int, int]  # px; (0, 0) for none
    pixels: bytes  # RGBA
    said: tuple[str, str]  # how many score, and by how much the shots differ
    shots: int
    scored: int
    left: int  # shots that are still to be computed, to their end and at the scene's accuracy
    bars: Bars | None = None  # the histogram of the number that is shown


def within(parameter: declared.Parameter, values: np.ndarray) -> np.ndarray:
    """Values of a parameter, moved inside its bounds."""
    return np.clip(values, parameter.low, parameter.high)


class _Fan:
    """The shots of a fan, computed a few at a time; ``backwards`` from the last to the first. While the aim changes,
    and where they are computed one by one, as balls on a table are, they have the accuracy of pictures."""

    def __init__(self, scene: Scene, spread: _Spread, asked: Sequence[str], quick: bool, backwards: bool) -> None:
        self._of = scene.folder, scene.parameters, spread, asked, quick
        self.left = scene.controls.fan_shots or SHOTS
        draws = np.random.default_rng(1).standard_normal((self.left, len(spread)))
        columns = [within(p, p.value + sigma * draw) for (p, sigma), draw in zip(spread.values(), draws.T, strict=True)]
        points = np.column_stack(columns).tolist()
        self.together = not quick and fly_together(scene, list(spread), points[0])
        if not self.together:
            scene = scene.changed({"accuracy.level": "fast"})
        self.flown: list[FanShot | None] = []  # None where it could not be computed
        self._drawn: tuple[Any, list[int], np.ndarray] = None, [0, 0], np.empty(0)  # how, how many, and their densities
        self._scene = scene
        self._first: Shot | None = None  # whose picture says where points of a path are drawn
        self._runs = runs(scene, list(spread), points[::-1] if backwards else points, asked=asked)

    def is_of(self, scene: Scene, *how: Any) -> bool:
        """True if it is the fan of this scene with this spread and these facts."""
        return self._of == (scene.folder, scene.parameters, *how)

    def go_on(self, most: int, fewest: int, seconds: float) -> None:
        """Compute more shots, no more than ``most``, and no more after so many seconds than ``fewest``."""
        started, shots = process_time(), list[Shot | None]()
        for run in islice(self._runs, max(0, most)):
            shots.append(None if isinstance(run, Exception) else Shot(self._scene, run))
            if len(shots) >= fewest and process_time() - started > seconds:
                break
        self.left -= len(shots)
        self._first = self._first or next(filter(None, shots), None)
        paths = iter(points([(shot.run, shot.ball) for shot in shots if shot]) if any(shots) else ())
        self.flown += [FanShot(next(paths)[:, 1:], shot.scored, shot.run.result) if shot else None for shot in shots]

    def densities(self, others: Sequence[FanShot | None], camera: Camera, size: tuple[int, int]) -> np.ndarray:
        """Return the number of paths of shots that score, and of the rest, through each pixel, shape (2, height,
        width); with those of ``others``. Those that are in this picture already are only added to."""
        how, counts, sums = self._drawn
        if how != (camera, size) or len(others) < counts[1]:
            counts, sums = [0, 0], np.zeros((2, *size[::-1]))
            self._drawn = (camera, size), counts, sums
        if self._first is None:
            return sums
        picture = self._first.run.scene.picture(self._first.run, size)
        for source, shots in enumerate((self.flown, others)):
            new = [shot for shot in shots[counts[source] :] if shot is not None]
            counts[source] = len(shots)
            for rest in (False, True):
                paths = [picture.spots(camera, shot.path, 0.0) for shot in new if shot.scored != rest]
                if paths:
                    sums[int(rest)] += density([np.clip(path, -_FAR, max(size) + _FAR) for path in paths], size)
        return sums


#: The fans that this process has begun, forwards and backwards.
_begun: dict[bool, _Fan] = {}


def _fan(scene: Scene, spread: _Spread, asked: Sequence[str], quick: bool = False, backwards: bool = False) -> _Fan:
    """The fan of a scene, with the shots that this process has computed so far."""
    if backwards not in _begun or not _begun[backwards].is_of(scene, spread, asked, quick):
        _begun[backwards] = _Fan(scene, spread, asked, quick, backwards)
    return _begun[backwards]


def _fan_facts(scene: Scene) -> list[str]:
    """The facts that a fan shows: whether a shot scores, and a number, by default the first that is known as soon."""
    controls, facts = scene.controls, scene.facts
    number = controls.fan_fact
    if not number and controls.scores:
        by = facts[controls.scores].final_when
        number = next((key for key, it in facts.items() if it.label and it.unit and it.final_when == by), "")
    return [fact for fact in (controls.scores, number) if fact]


def shots_from_end(scene: Scene, width: float, left: int) -> list[FanShot | None]:
    """The shots that another process has computed so far, from the end of the fan, of which so many were ``left`` when
    it was asked for more; none of a fan that is computed together."""
    fan = _fan(scene, players_spread(scene, width), _fan_facts(scene), backwards=True)
    if not fan.together:
        fan.go_on(left, 1, _BRIEF)
    return fan.flown


def cloud(
    scene: Scene,
    width: float,
    camera: Camera,
    quick: bool,
    early: str,
    size: tuple[int, int],
    colours: tuple[Colour, Colour],
    elsewhere: Sequence[FanShot | None] = (),
) -> Cloud:
    """The fan of a scene as a camera sees it, in the colours of shots that score and that do not; asked again, it has
    more shots. Those of its end may have been computed ``elsewhere``.

    A ``quick`` one, for an aim that changes, ends where the fact ``early`` is known, such as at the landing, if it is
    known only at the end which shots score.
    """
    spread = players_spread(scene, width)
    if not spread:
        return Cloud((0, 0), (0, 0), b"", ("no fan: this shot does not start from the player's controls", ""), 0, 0, 0)
    asked = _fan_facts(scene)
    if quick and early and scene.final_when(asked) is None:
        asked = [early]
    fan = _fan(scene, spread, asked, quick)
    fan.go_on(fan.left - len(elsewhere), FEWEST, QUICK)
    elsewhere = elsewhere[: fan.left]
    shots = [shot for shot in (*fan.flown, *reversed(elsewhere)) if shot is not None]
    good, rest = fan.densities(elsewhere, camera, size)
    said = _summary(scene, asked, shots), _by(spread)
    scored, left = sum(shot.scored for shot in shots), max(0, fan.left - len(elsewhere))
    left = SHOTS if quick else left
    return Cloud(*_drawn(good, rest, colours), said, len(shots), scored, left, _bars(scene, asked, shots))


class _FanShots(NamedTuple):
    """The shots of a fan, and what is said of them."""

    shots: Sequence[FanShot]
    said: str  # how many score
    by: str  # by how much the shots differ
    bars: Bars | None


def fan_of(scene: Scene, seconds: float) -> _FanShots | None:
    """The fan of a scene, as many of its shots as are computed in so many s; None for a shot without spread."""
    spread, asked = players_spread(scene), _fan_facts(scene)
    if not spread:
        return None
    fan = _Fan(scene, spread, asked, quick=False, backwards=False)
    fan.go_on(fan.left, FEWEST, seconds)
    shots = [shot for shot in fan.flown if shot is not None]
    return _FanShots(shots, _summary(scene, asked, shots), _by(spread), _bars(scene, asked, shots))


def _by(spread: _Spread) -> str:
    """Text: by how much the shots differ."""
    sigmas = [f"{key.rpartition('.')[2]} ± {short(sigma)} {p.unit or ''}" for key, (p, sigma) in spread.items()]
    return ", ".join(map(str.rstrip, sigmas))


def _summary(scene: Scene, asked: Sequence[str], shots: Sequence[FanShot]) -> str:
    """Text: how many score, with the 95 % interval of Wilson; else the mean and sd of the number that was asked for."""
    count = len(shots)
    text = f"{count} shots" if count else "no such shot could be computed"
    if any(shot.result.get(scene.controls.scores) is not None for shot in shots):
        scored = sum(shot.scored for shot in shots)
        low, high = Share(scored, count).interval
        text = f"{scored} of {count} score: {100 * low:.0f} to {100 * high:.0f} %"
    elif (found := _numbers(asked, shots))[0]:
        fact, numbers = scene.facts[asked[-1]], Numbers(np.array(found[0]))
        text += f"; {fact.label} {amount(numbers.mean, fact.unit, fact.digits)} ± {significant(numbers.sd)} {fact.unit}"
    return text.rstrip()


def _numbers(asked: Sequence[str], shots: Sequence[FanShot]) -> tuple[list[float], list[bool]]:
    """The values of the last fact that was asked for, of the shots that have it as a number; and whether they score."""
    rows = [(shot.result.get(asked[-1]), shot.scored) for shot in shots] if asked else []
    known = [
        (float(value), scored)
        for value, scored in rows
        if isinstance(value, float | int) and not isinstance(value, bool)
    ]
    return [value for value, _ in known], [scored for _, scored in known]


def _bars(scene: Scene, asked: Sequence[str], shots: Sequence[FanShot]) -> Bars | None:
    """The histogram of the last fact that was asked for, if it is a number."""
    values, scored = _numbers(asked, shots)
    return bars_of(scene.facts[asked[-1]], values, scored) if values else None


def short(sigma: float) -> str:
    """To two digits, but whole from 100 on: ``0.087``, ``370``."""
    return f"{float(f'{sigma:.2g}'):.0f}" if sigma >= 99.5 else f"{sigma:.2g}"


def density(lines: Sequence[np.ndarray], size: tuple[int, int]) -> np.ndarray:
    """The number of lines (px, shape (n, 2)) through each pixel of a picture, shape (height, width): smooth, since each
    of their points, 1 px apart, is shared out among the four nearest pixels."""
    width, height = size
    if not lines:
        return np.zeros((height, width))
    square = np.mgrid[:_END, :_END].reshape(2, -1).T - _END // 2  # around each end
    x, y = np.concatenate([part for line in lines for part in (_evenly(line), line[-1] + square)]).T - 0.5
    inside = (x >= 0) & (x < width - 1) & (y >= 0) & (y < height - 1)
    x, y = x[inside], y[inside]
    column, row = x.astype(int), y.astype(int)
    right, down = x - column, y - row
    at = row * width + column
    pixels = np.concatenate([at, at + 1, at + width, at + width + 1])
    shares = np.concatenate([(1 - right) * (1 - down), right * (1 - down), (1 - right) * down, right * down])
    return np.bincount(pixels, np.rint(_PARTS * shares), width * height).reshape(height, width) / _PARTS


def _evenly(line: np.ndarray) -> np.ndarray:
    """Points along a line (px), 1 px apart."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(line, axis=0).T))])
    every = np.arange(0.0, along[-1], 1.0)
    return np.column_stack([np.interp(every, along, places) for places in line.T])


def _drawn(
    good: np.ndarray, others: np.ndarray, colours: tuple[Colour, Colour]
) -> tuple[tuple[int, int], tuple[int, int], bytes]:
    """Return place and size in px of the part where the densities are not zero, and its pixels."""
    total = good + others
    rows, columns = np.flatnonzero(total.any(axis=1)), np.flatnonzero(total.any(axis=0))
    if not len(rows):
        return (0, 0), (0, 0), b""
    box = slice(rows[0], rows[-1] + 1), slice(columns[0], columns[-1] + 1)
    good, total = good[box], total[box]
    on = total > 0
    share = (good[on] / total[on])[:, None]
    pixels = np.zeros((*total.shape, 4), np.uint8)
    pixels[on, :3] = np.round(share * colours[0] + (1 - share) * colours[1])
    pixels[on, 3] = np.round(-255 * np.expm1(log1p(-_FAINT) * total[on]))
    return (int(columns[0]), int(rows[0])), (total.shape[1], total.shape[0]), pixels.tobytes()
