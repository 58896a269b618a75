"""Running a scene; and how accurate its result is: run again, finer, and from starts that differ by a nanometre."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, overload

from sandbox.engine import simulate as run_setup
from sandbox.engine.model.accuracy import Accuracy, resolve
from sandbox.engine.model.setup import ForceRegion, Setup
from sandbox.engine.paths.run import Run
from sandbox.errors import RequestError, RunError
from sandbox.scene.scene import Scene, as_scene
from sandbox.scene.scene_run import SceneRun
from sandbox.text import shortened

Progress = Callable[[float, float], None]

#: How far in m every ball is moved for a nudged run, each in its own direction, and the number of such runs. Nobody
#: places a ball to a nanometre.
NUDGE, NUDGES = 1e-9, 8

#: How far in m every ball is moved for the finer run: less than the method resolves (its contact skin), so that motion
#: known in closed form is checked as well.
_ROUNDING = 1e-11

#: Finer runs of a check, each with half the step of the one before: one alone may agree by chance. The plain method has
#: one, which takes twice as long as the run.
FINER, _FINER_PLAIN = 3, 1

#: Longest step in s of one more run, which sees forces that vary between the steps of the others; longer where these
#: would be more than so many in a run.
SHORT, _MOST_SHORT = 0.002, 5_000

#: A distance in m beyond any path.
_AWAY = 1e12

#: The error of a number over its difference to a finer run. Errors of contacts, the slowest to vanish, halve with the
#: step: the finer run still has half of them. Those of flight leave 1/32, and for them this is pessimistic.
SAFETY = 2.0

#: Rounding of a number as a share of its size, after some thousand operations.
_LAST_DIGITS = 1e-12

#: A number is chaotic where a nudge grows by this factor or more: a nanometre to a millimetre.
_CHAOTIC = 1e6

#: Angle in rad between the directions of successive nudges: the golden angle, which spreads them.
_TURN = math.pi * (3.0 - math.sqrt(5.0))


@overload
def simulate(
    setup_or_scene: Setup, accuracy: Accuracy | str | None = None, *, progress: Progress | None = None
) -> Run: ...


@overload
def simulate(
    setup_or_scene: Scene | str | Path, accuracy: Accuracy | str | None = None, *, progress: Progress | None = None
) -> SceneRun: ...


def simulate(
    setup_or_scene: Setup | Scene | str | Path,
    accuracy: Accuracy | str | None = None,
    *,
    progress: Progress | None = None,
) -> Run:
    """Run a setup or a scene to its end.

    A setup gives a ``Run``: its paths, events and pictures (``help(sandbox.Run)``). A scene, or the name of one, gives
    a ``SceneRun``, which is a ``Run`` with a ``result``.

    ``accuracy`` is the name of a level ("fast", "balanced" or "precise") or an ``Accuracy``. By default it is that of
    the scene's parameters, and "balanced" for a setup. The plain method, which may take minutes, calls ``progress``
    with the time simulated and its most, in s.

    Raises RequestError if what is asked for is wrong, RunError if the run cannot be completed.

    >>> import sandbox
    >>> from sandbox import Ball, Gravity, Setup
    >>> ball = Ball("ball", mass=1.0, radius=0.1, position=(0, 0), velocity=(3, 4), forces=[Gravity(9.81)])
    >>> run = sandbox.simulate(Setup([ball], duration=1.0), accuracy="precise")
    >>> round(run.state("ball", 1.0).y, 9)
    -0.905
    >>> sandbox.simulate("golf", accuracy="fast").scene.parameters.accuracy.level
    'fast'
    """
    if accuracy is not None and not isinstance(accuracy, Accuracy | str):
        remedy = "; parameters go into sandbox.load(scene, parameters)" if isinstance(accuracy, Mapping) else ""
        said = shortened(repr(accuracy))
        raise RequestError(f"accuracy = {said}: must be the name of a level, or an Accuracy{remedy}")
    if isinstance(setup_or_scene, Setup):
        level = accuracy if isinstance(accuracy, Accuracy) else resolve(accuracy or "balanced")
        return run_setup(setup_or_scene, level, progress)
    chosen = as_scene(setup_or_scene)
    if isinstance(accuracy, str):
        chosen = chosen.changed({"accuracy.level": accuracy}, "accuracy")
    if not isinstance(accuracy, Accuracy):
        accuracy = resolve(**chosen.parameters.accuracy.model_dump())
    return simulate_at(chosen, accuracy, progress=progress)


def simulate_at(
    scene: Scene, accuracy: Accuracy, setup: Setup | None = None, progress: Progress | None = None
) -> SceneRun:
    """Run the scene at an accuracy; ``setup`` is a variation of the scene's own, to run in its place."""
    run = run_setup(setup or scene.build(), accuracy, progress)
    return SceneRun.of(run, scene, scene.result(run))


@dataclass(frozen=True)
class Check:
    """The accuracy of a result, according to runs that should agree with it.

    >>> import sandbox
    >>> found = sandbox.check("golf")
    >>> found.errors["carry"] < 0.01, found.chaotic  # m
    (True, {})
    """

    finer: SceneRun
    errors: dict[str, float] = field(default_factory=dict)  # estimated, of each number in the result, in its unit
    changed: dict[str, tuple[Any, Any]] = field(
        default_factory=dict
    )  # other results that differ: in the run, in the finer one
    #: The most that each number changes if every ball starts a nanometre away, in its unit.
    spread: dict[str, float] = field(default_factory=dict)
    #: Other results that such nudges change, with the values in the runs that differ.
    changed_by_nudge: dict[str, list[Any]] = field(default_factory=dict)
    nudges: int = 0  # runs from nudged starts
    target: float = math.inf  # m, of the errors at the run's accuracy

    @property
    def beyond_target(self) -> dict[str, float]:
        """The lengths whose error in m exceeds the target error of the run's accuracy, each with that error."""
        target, units = self.target, self.finer.scene.units
        return {name: error for name, error in self.errors.items() if units[name] == "m" and error > target}

    @property
    def chaotic(self) -> dict[str, float]:
        """The numbers that a nudge of a nanometre changes by at least 1e6 times as much, and by how much."""
        return {name: spread for name, spread in self.spread.items() if spread >= _CHAOTIC * NUDGE}


def check(scene: Scene | str | Path, run: SceneRun | None = None, progress: Progress | None = None) -> Check:
    """Estimate the errors of the scene's result: run it again, ever finer and from nudged starts, and compare.

    The error of a number is twice its largest difference to a finer run, plus the largest to a nudged one.
    ``progress`` is called as by ``simulate``, in each of them.

    >>> import sandbox
    >>> sandbox.check("golf").errors["carry"] < 0.01  # m
    True
    """
    chosen = as_scene(scene)
    run = run or simulate(chosen)
    outcomes = [compare(run, finer) for finer in _finer(chosen, run, progress)]
    spread: dict[str, float] = {}
    changed_by_nudge: dict[str, list[Any]] = {}
    for result in _nudged_results(chosen, run, progress):
        apart, changed = _differences(run.result, result)
        for name, difference in apart.items():
            spread[name] = max(difference, spread.get(name, 0.0))
        for name, (_, other) in changed.items():
            changed_by_nudge.setdefault(name, []).append(other)
    errors = {
        name: max((each.errors[name] for each in outcomes if name in each.errors), default=0.0) + spread.get(name, 0.0)
        for name in run.result
        if name in spread or any(name in each.errors for each in outcomes)
    }
    changed_by_finer = {name: pair for each in reversed(outcomes) for name, pair in each.changed.items()}
    target = run.accuracy.tolerance if run.accuracy.method == "exact" else math.inf
    return Check(outcomes[0].finer, errors, changed_by_finer, spread, changed_by_nudge, NUDGES, target)


def _finer(scene: Scene, run: SceneRun, progress: Progress | None) -> Iterator[SceneRun]:
    """Runs with half, a quarter and an eighth of the step, from starts within rounding, and one with short steps
    everywhere. Only the first must succeed."""
    accuracy, exact = run.accuracy, run.accuracy.method == "exact"
    for turn in range(FINER if exact else _FINER_PLAIN):
        accuracy = accuracy.finer()
        try:
            yield simulate_at(scene, accuracy, nudged(scene.build(), _ROUNDING, turn), progress)
        except RunError:  # its steps are too many
            if turn == 0:
                raise
            break
    if exact:
        setup = nudged(scene.build(), _ROUNDING, FINER)
        everywhere = ForceRegion(-_AWAY, -_AWAY, _AWAY, _AWAY, max(SHORT, run.duration / _MOST_SHORT))
        short = replace(setup, force_regions=[*setup.force_regions, everywhere])
        with suppress(RunError):
            yield simulate_at(scene, run.accuracy.finer(), short, progress)


def compare(run: SceneRun, finer: SceneRun) -> Check:
    """The estimated errors of a run's result, compared with a finer run of the same scene."""
    return Check(finer, *errors_of(run.result, finer.result))


def errors_of(
    result: Mapping[str, Any], finer: Mapping[str, Any]
) -> tuple[dict[str, float], dict[str, tuple[Any, Any]]]:
    """The estimated error of each number of a result, from that of a finer run, and what else the two have of each name
    where they differ.

    An error is twice the difference, and what rounding makes of such a number. A count is off by what it differs.
    """
    apart, changed = _differences(result, finer)
    errors = {}
    for name, difference in apart.items():
        value = result[name]
        size = max(map(abs, _taken_apart(value)[1]), default=0.0)
        errors[name] = difference if isinstance(value, int) else SAFETY * difference + _LAST_DIGITS * size
    return errors, changed


def nudged(setup: Setup, distance: float, turn: int) -> Setup:
    """The setup with every ball moved by ``distance`` (m), each in its own direction, which ``turn`` chooses."""
    balls = []
    for place, ball in enumerate(setup.balls):
        angle = _TURN * (turn * len(setup.balls) + place + 1)
        x, y = ball.position
        position = (x + distance * math.cos(angle), y + distance * math.sin(angle))
        balls.append(replace(ball, position=position))
    return replace(setup, balls=balls)


def _nudged_results(scene: Scene, run: SceneRun, progress: Progress | None) -> Iterator[Mapping[str, Any]]:
    """The results from nudged starts; for a run that fails, its error in place of each result."""
    for turn in range(NUDGES):
        try:
            yield simulate_at(scene, run.accuracy, nudged(scene.build(), NUDGE, turn), progress).result
        except RunError as error:
            yield dict.fromkeys(run.result, f"no result: {error}")


def _differences(
    result: Mapping[str, Any], other: Mapping[str, Any]
) -> tuple[dict[str, float], dict[str, tuple[Any, Any]]]:
    """The differences between the numbers of two results, and what else differs."""
    apart: dict[str, float] = {}
    changed: dict[str, tuple[Any, Any]] = {}
    for name, value in result.items():
        form, numbers = _taken_apart(value)
        other_form, other_numbers = _taken_apart(other.get(name))
        if form != other_form:
            changed[name] = value, other.get(name)
        elif numbers:
            apart[name] = max(abs(a - b) for a, b in zip(numbers, other_numbers, strict=True))
    return apart, changed


def _taken_apart(value: Any) -> tuple[Any, list[float]]:
    """The form of a value with its numbers left out, and those numbers in order."""
    if isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value):
        return float, [float(value)]
    if isinstance(value, Mapping):
        items, forms = list(value.values()), list(value)
    elif isinstance(value, list | tuple):
        items, forms = list(value), []
    else:
        return value if value == value else None, []  # NaN counts as no result
    parts = [_taken_apart(item) for item in items]
    return [*forms, *(form for form, _ in parts)], [number for _, numbers in parts for number in numbers]
