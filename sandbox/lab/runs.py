"""Many runs of one scene with different parameter values: what sweeps, searches and fans compute."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from itertools import repeat
from typing import TYPE_CHECKING, Any

import numpy as np

from sandbox import parameters as declared
from sandbox.engine import can_batch, simulate_many
from sandbox.engine.many.stacking import FEWEST, Stack, agree
from sandbox.engine.model.accuracy import Accuracy, resolve
from sandbox.engine.model.setup import Setup, Touches, Until, is_over
from sandbox.lab.axes import Varied
from sandbox.scene import Scene
from sandbox.scene.scene_run import SceneRun

if TYPE_CHECKING:
    from sandbox.engine.model.event import Event
    from sandbox.engine.paths.run import Run
    from sandbox.parameters import SceneParameters
    from sandbox.physics.integrators import State

    Build = Callable[[SceneParameters], Setup]

#: Runs that are done, and all of them.
Progress = Callable[[int, int], None]


def no_progress(done: int, total: int) -> None:
    """Show no progress."""


def runs(
    scene: Scene,
    keys: Sequence[str],
    points: Sequence[Sequence[Any]],
    finer: bool = False,
    asked: Sequence[str] = (),
    until: float | None = None,
) -> Iterator[SceneRun | Exception]:
    """The run at each of the points, in order, with its result; or the exception it ended with.

    Similar shots are computed together. ``finer`` halves the steps, to estimate errors. If only some facts are
    ``asked`` for, each run ends when these are final, and its result contains only these. If only paths ``until`` a
    time in s are, each run ends then, also where the scene would end it earlier, and its result is empty.
    """
    build, varied = builder(scene, asked) if until is None else _until(scene, until), Varied(scene, keys)
    read = scene.reader(asked) if until is None else _nothing
    parameters: dict[int, SceneParameters] = {}
    found: dict[int, Iterator[Run | Exception]] = {}
    for places, many in varied.together(points):
        each = [] if isinstance(many, Exception) else [varied.parameters(points[place]) for place in places]
        parameters |= zip(places, each, strict=False)
        found |= dict.fromkeys(places, _outcomes(build, many, each, finer))
    for place in range(len(points)):
        run = next(found[place])
        yield run if isinstance(run, Exception) else _of_scene(run, replace(scene, parameters=parameters[place]), read)


def _of_scene(run: Run, scene: Scene, read: Callable[[Run, Any], dict[str, Any]]) -> SceneRun | Exception:
    """The run of a scene with the facts that are ``read`` from it, or what they raise."""
    try:
        return SceneRun.of(run, scene, read(run, scene.parameters))
    except Exception as error:
        return error


def _outcomes(
    build: Build, many: SceneParameters | Exception, each: Sequence[SceneParameters], finer: bool
) -> Iterator[Run | Exception]:
    """The outcomes of runs that differ only in numbers: ``many`` has the parameters of all in one, or is the error that
    explains why there are none."""
    try:
        if isinstance(many, Exception):
            raise many
        accuracy = _resolved(many.accuracy, finer)
    except Exception as error:
        return repeat(error)
    stack = built_at_once(build, many, each)
    if stack is not None:
        return simulate_many(stack, accuracy)
    setups = [_or_error(build, parameters) for parameters in each]
    found = simulate_many([setup for setup in setups if not isinstance(setup, Exception)], accuracy)
    return (setup if isinstance(setup, Exception) else next(found) for setup in setups)


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


def _nothing(run: Run, parameters: Any) -> dict[str, Any]:
    return {}


def built_at_once(build: Build, many: SceneParameters, each: Sequence[SceneParameters]) -> Stack | None:
    """The setups of many points, built once with arrays for the numbers that differ; None if the scene can be built
    only with single numbers. Some are compared with what is built for them alone."""
    if len(each) < FEWEST:
        return None
    try:
        with np.errstate(all="ignore"):
            stack = Stack.split(build(many), len(each))
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
        parameters = Varied(scene, keys).parameters(values)
        return can_batch(replace(scene, parameters=parameters).build(), _resolved(parameters.accuracy, False))
    except Exception:
        return False  # its row reports the error
