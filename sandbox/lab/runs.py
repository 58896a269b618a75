"""Many runs of one scene with different parameter values: what sweeps, searches and fans compute."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import product, repeat
from math import isclose, isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from sandbox import parameters as declared
from sandbox.engine import can_batch, simulate_many, simulate_together
from sandbox.engine.many.flown import COUNTS, AllRuns, Flown
from sandbox.engine.many.stacking import FEWEST, Stack, agree
from sandbox.engine.model.accuracy import Accuracy, resolve
from sandbox.engine.model.setup import Rule, Setup, Touches, Until, is_over
from sandbox.engine.model.shapes import Vector
from sandbox.engine.paths.run import Run
from sandbox.errors import sys_exit_as_error
from sandbox.lab.axes import Varied
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun

if TYPE_CHECKING:
    from sandbox.engine.model.event import Event
    from sandbox.parameters import SceneParameters
    from sandbox.physics.integrators import State

    Build = Callable[[SceneParameters], Setup]
    Read = Callable[[Run, SceneParameters], dict[str, Any]]

#: Runs that are done, and all of them.
Progress = Callable[[int, int], None]


def no_progress(done: int, total: int) -> None:
    """Show no progress."""


class Outcome(NamedTuple):
    """A run at one of many points, and the facts that were asked for."""

    run_at: Callable[[int], Run]
    result: dict[str, Any]
    parameters_at: Callable[[int], SceneParameters]
    place: int

    @property
    def run(self) -> Run:
        return self.run_at(self.place)

    def of(self, scene: Scene) -> SceneRun:
        """The whole run of this scene, with its parameters at this point."""
        return SceneRun.of(self.run, replace(scene, parameters=self.parameters_at(self.place)), self.result)


class Columns(NamedTuple):
    """Columns of the facts of runs at many points, in order."""

    facts: dict[str, list[Any]]  # in their units; None for what did not happen, or could not be computed
    errors: dict[int, Exception]  # by the place of the point
    ended: list[str]
    counts: np.ndarray  # what each run cost, shape (points, those of COUNTS)

    @classmethod
    def empty(cls, facts: Sequence[str], count: int) -> Columns:
        """Columns of so many points, to be filled."""
        return cls({fact: [None] * count for fact in facts}, {}, [""] * count, np.zeros((count, len(COUNTS)), int))

    def put(self, places: Sequence[int], part: Columns) -> None:
        """Fill the rows at these places."""
        for fact, column in part.facts.items():
            for place, value in zip(places, column, strict=True):
                self.facts[fact][place] = value
        for place, ended in zip(places, part.ended, strict=True):
            self.ended[place] = ended
        self.counts[places] = part.counts
        self.errors.update((places[place], error) for place, error in part.errors.items())

    def results(self) -> list[dict[str, Any] | None]:
        """The facts of each point; None for one that could not be computed."""
        rows = zip(*self.facts.values(), strict=True) if self.facts else repeat((), len(self.ended))
        found: list[dict[str, Any] | None] = [dict(zip(self.facts, row, strict=True)) for row in rows]
        for place in self.errors:
            found[place] = None
        return found


def columns_at(
    scene: Scene,
    keys: Sequence[str],
    points: Sequence[Sequence[Any]],
    finer: bool = False,
    asked: Sequence[str] = (),
    progress: Progress = no_progress,
) -> Columns:
    """The facts at each of the points, as ``outcomes`` computes them, without its runs. Where these are computed one by
    one, ``progress`` is called with the number that is done."""
    facts = [key for key in scene.facts if not asked or key in asked]
    build, varied, done = builder(scene, asked), _varied(scene, keys), 0
    found = Columns.empty(facts, len(points))

    def one_more() -> None:
        nonlocal done
        done += 1
        progress(done, len(points))

    for places, many in varied.together(points):
        part = _Together(build, many, _Each(varied, points, places)).columns(scene, facts, finer, one_more)
        if len(places) == len(points):
            return part
        found.put(places, part)
    return found


def runs(
    scene: Scene,
    keys: Sequence[str],
    points: Sequence[Sequence[Any]],
    finer: bool = False,
    asked: Sequence[str] = (),
    until: float | None = None,
) -> Iterator[SceneRun | Exception]:
    """The whole run at each of the points, in order, as ``outcomes`` computes it."""
    for found in outcomes(scene, keys, points, finer, asked, until):
        yield found if isinstance(found, Exception) else found.of(scene)


def outcomes(
    scene: Scene,
    keys: Sequence[str],
    points: Sequence[Sequence[Any]],
    finer: bool = False,
    asked: Sequence[str] = (),
    until: float | None = None,
) -> Iterator[Outcome | Exception]:
    """The outcome at each of the points, in order; or the exception with which its run ended.

    Similar shots are computed together. ``finer`` halves the steps, to estimate errors. If only some facts are
    ``asked`` for, each run ends when these are final, and its result contains only these. If only paths ``until`` a
    time in s are, each run ends then, also where the scene would end it earlier, and its result is empty.
    """
    build, varied = builder(scene, asked) if until is None else _until(scene, until), _varied(scene, keys)
    facts = [key for key in scene.facts if until is None and (not asked or key in asked)]
    found: dict[int, Iterator[Outcome | Exception]] = {}
    for places, many in varied.together(points):
        together = _Together(build, many, _Each(varied, points, places))
        found |= dict.fromkeys(places, together.outcomes(scene, facts, finer))
    for place in range(len(points)):
        yield next(found[place])


#: What varied last: a search asks for the same again and again, and checking a whole scene takes as long as a flight.
_last: list[tuple[Scene, list[str], Varied]] = []


def _varied(scene: Scene, keys: Sequence[str]) -> Varied:
    for known, of, varied in _last:
        if known is scene and of == [*keys]:
            return varied
    varied = Varied(scene, keys)
    _last[:] = [(scene, [*keys], varied)]
    return varied


class _Each(Sequence[Any]):
    """The parameters at some of many points, made when they are asked for."""

    def __init__(self, varied: Varied, points: Sequence[Sequence[Any]], places: Sequence[int]) -> None:
        self._varied, self._points, self._places = varied, points, places

    def __len__(self) -> int:
        return len(self._places)

    def __getitem__(self, place: Any) -> Any:
        return self._varied.parameters(self._points[self._places[place]])


class _Together(NamedTuple):
    """Points that differ only in numbers: ``many`` has the parameters of all in one, or is the error that explains why
    there are none."""

    build: Build
    many: SceneParameters | Exception
    each: Sequence[SceneParameters]

    def outcomes(self, scene: Scene, facts: Sequence[str], finer: bool) -> Iterator[Outcome | Exception]:
        """The outcome at each of them, with these facts."""
        flown, values = self._computed(scene, facts, finer)
        if isinstance(flown, Exception):
            yield from repeat(flown, len(self.each))
        elif isinstance(flown, Flown) and len(values) == len(facts):  # no run is made that is not asked for
            for place, row in enumerate(zip(*values.values(), strict=True) if facts else repeat((), len(flown))):
                made = Outcome(flown.__getitem__, dict(zip(facts, row, strict=True)), self.each.__getitem__, place)
                yield flown.failures.get(place, made)
        else:
            read = scene.reader([fact for fact in facts if fact not in values])
            for place, run in enumerate(flown):
                yield run if isinstance(run, Exception) else self._outcome(run, place, facts, values, read)

    def columns(self, scene: Scene, facts: Sequence[str], finer: bool, done: Callable[[], None]) -> Columns:
        """The same as columns; ``done`` is called after each that is computed alone."""
        flown, values = self._computed(scene, facts, finer)
        if isinstance(flown, Flown) and len(values) == len(facts):
            found = Columns({fact: values[fact] for fact in facts}, flown.failures, flown.ended, flown.counts)
            for place, column in product(flown.failures, found.facts.values()):
                column[place] = None
            return found
        count = len(self.each)
        found, read = Columns.empty(facts, count), scene.reader([fact for fact in facts if fact not in values])
        for place, run in enumerate(repeat(flown, count) if isinstance(flown, Exception) else flown):
            outcome = run if isinstance(run, Exception) else self._outcome(run, place, facts, values, read)
            if isinstance(outcome, Exception):
                found.errors[place] = outcome
            elif not isinstance(run, Exception):
                for fact, value in outcome.result.items():
                    found.facts[fact][place] = value
                found.ended[place] = run.ended
                found.counts[place] = [getattr(run.numerics, name) for name in COUNTS]
            done()
        return found

    def _computed(
        self, scene: Scene, facts: Sequence[str], finer: bool
    ) -> tuple[Flown | Iterable[Run | Exception] | Exception, dict[str, list[Any]]]:
        """The runs, or why there is none; and those of these facts that are computed for all of them at once."""
        try:
            if isinstance(self.many, Exception):
                raise self.many
            accuracy = _resolved(self.many.accuracy, finer)
        except Exception as error:
            return error, {}
        stack = built_at_once(self.build, self.many, self.each)
        flown = None if stack is None else simulate_together(stack, accuracy)
        if flown is None:
            return self._alone(accuracy), {}
        return flown, facts_at_once(scene, facts, flown, self.many, self.each)

    def _alone(self, accuracy: Accuracy) -> Iterator[Run | Exception]:
        """The runs of what was built for each point."""
        setups = [_or_error(self.build, parameters) for parameters in self.each]
        found = simulate_many([setup for setup in setups if not isinstance(setup, Exception)], accuracy)
        return (setup if isinstance(setup, Exception) else next(found) for setup in setups)

    def _outcome(
        self, run: Run, place: int, facts: Sequence[str], values: Mapping[str, Sequence[Any]], read: Read
    ) -> Outcome | Exception:
        """The outcome of a run, with the values known of all, and facts that are ``read`` from it, or what they
        raise."""
        try:
            own = read(run, self.each[place])
        except Exception as error:
            return error
        result = {fact: values[fact][place] if fact in values else own[fact] for fact in facts}
        return Outcome(lambda _: run, result, self.each.__getitem__, place)


def facts_at_once(
    scene: Scene, facts: Sequence[str], flown: Flown, many: SceneParameters, each: Sequence[SceneParameters]
) -> dict[str, list[Any]]:
    """The values, for all runs, of those facts that can be computed from arrays.

    What a function decides by comparing numbers it cannot decide for an array, which is an error; what it decides by
    None, for what did not happen, is the same for all runs that lack the same, and so is a value that is no array. So a
    fact is compared with that of one run of each such kind, and of the first, middle and last one.
    """
    together: Any = AllRuns(flown)  # in place of a Run
    computed, count = dict[str, Any](), len(each)
    for key in facts:
        try:
            with np.errstate(all="ignore"), sys_exit_as_error():
                computed[key] = scene.facts[key].compute(together, many)
        except Exception:
            continue  # it needs one run after another
    if not computed:
        return {}
    lacking = np.array([np.zeros(count, bool), *together.missing])
    _, firsts, kinds = np.unique(lacking, axis=1, return_index=True, return_inverse=True)
    some = {place: flown[place] for place in (*firsts.tolist(), 0, count // 2, count - 1)}
    alone: dict[str, dict[int, Any]] = {key: {} for key in computed}
    for place, run in some.items():
        for key in computed:
            try:
                alone[key][place] = scene.reader([key])(run, each[place])[key]
            except Exception:
                continue
    found = {}
    for key, values in computed.items():
        try:
            column = _column(values, [alone[key][first] for first in firsts.tolist()], kinds.ravel(), count)
        except Exception:
            continue
        if len(alone[key]) == len(some) and all(_alike(column[place], value) for place, value in alone[key].items()):
            found[key] = column
    return found


def _column(values: Any, of_kinds: Sequence[Any], kinds: np.ndarray, count: int) -> list[Any]:
    """The values of all runs: of an array, or those ``of_kinds`` of run. Raises TypeError for others."""
    if isinstance(values, np.ndarray):
        if values.shape != (count,) or values.dtype.kind not in "fibUO":
            raise TypeError
        listed: list[Any] = values.tolist()
        return [*map(_known, listed)] if values.dtype.kind == "f" and not np.isfinite(values).all() else listed
    if values is not None and not isinstance(values, float | int | str):
        raise TypeError
    return [of_kinds[kind] for kind in kinds.tolist()]


def _known(value: Any) -> Any:
    return None if isinstance(value, float) and not isfinite(value) else value


def _alike(one: Any, other: Any) -> bool:
    """True if two values of a fact are the same, apart from rounding."""
    return type(one) is type(other) and (one == other or (isinstance(one, float) and isclose(one, other, abs_tol=1e-9)))


def _or_error(build: Build, values: SceneParameters) -> Setup | Exception:
    try:
        return build(values)
    except Exception as error:
        return error


def builder(scene: Scene, asked: Sequence[str]) -> Build:
    """The scene's ``build``, whose runs end as soon as the requested facts are final."""
    conditions = scene.final_when(asked) if asked else None

    def build(parameters: SceneParameters) -> Setup:
        setup = replace(scene, parameters=parameters).build()
        if conditions is None:
            return setup
        untils = tuple(Touches(by) if isinstance(by, str) else by(parameters) for by in conditions)
        return replace(setup, until=_AllFinal(untils, setup.until))

    return build


def _until(scene: Scene, time: float) -> Build:
    """The scene's ``build``, whose runs end at this time in s, or at rest."""

    def build(parameters: SceneParameters) -> Setup:
        return replace(replace(scene, parameters=parameters).build(), until=None, duration=time)

    return build


def built_at_once(build: Build, many: SceneParameters, each: Sequence[SceneParameters]) -> Stack | None:
    """The setups of many points, built once with arrays for the numbers that differ; None if the scene can be built
    only with single numbers. Some are compared with what is built for them alone."""
    if len(each) < FEWEST:
        return None
    try:
        with np.errstate(all="ignore"):
            stack = Stack(build(many), len(each))
        some = (0, len(each) // 2, len(each) - 1)
        return stack if all(agree(stack[place], build(each[place])) for place in some) else None
    except Exception:
        return None


@dataclass(frozen=True)
class _AllFinal(Until):
    """Ends a run when all these conditions have been met, or its own."""

    conditions: tuple[Until, ...]
    until: Callable[[Event], bool] | Until | None

    def over(self, events: Sequence[Event]) -> bool:
        if is_over(self.until, events):
            return True
        others = [condition for condition in self.conditions if not condition.over(events)]
        if len(others) == len(self.conditions):
            return False
        before = [events[:count] for count in range(len(events) - 1, 0, -1)] if others else []
        return all(any(map(condition.over, before)) for condition in others)

    def rules(self) -> Sequence[Rule] | None:
        parts = (*self.conditions, *(() if self.until is None else (self.until,)))
        known = [part.rules() if isinstance(part, Until) else None for part in parts]
        if len(self.conditions) != 1 or None in known:
            return None
        return [rule for rules in known if rules is not None for rule in rules]

    def line(self) -> tuple[Vector, Vector] | None:
        return self.conditions[0].line() if len(self.conditions) == 1 else None

    def passed(self, start: State, end: State) -> Any:
        own = self.until.passed(start, end) if isinstance(self.until, Until) else False
        return self.conditions[0].passed(start, end) | own if len(self.conditions) == 1 else own


@lru_cache
def _resolved(accuracy: declared.Accuracy, finer: bool) -> Accuracy:
    found = resolve(**accuracy.model_dump())
    return found.finer() if finer else found


def fly_together(scene: Scene, keys: Sequence[str], values: Sequence[Any]) -> bool:
    """True if the engine computes many runs of this kind at once, judged by the one with these values."""
    try:
        parameters = _varied(scene, keys).parameters(values)
        return can_batch(replace(scene, parameters=parameters).build(), _resolved(parameters.accuracy, False))
    except Exception:
        return False  # its row reports the error
