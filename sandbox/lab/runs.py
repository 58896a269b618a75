"""Many runs of one scene with different parameter values."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from sandbox.engine import flies_in_batches, simulate_many
from sandbox.engine.accuracy import Accuracy, resolve
from sandbox.engine.setup import Setup, Until
from sandbox.lab.axes import Varied
from sandbox.scene import Scene

if TYPE_CHECKING:
    from sandbox.engine.event import Event
    from sandbox.engine.run import Run


def runs(
    scene: Scene, keys: Sequence[str], points: Sequence[Sequence[Any]], finer: bool = False, asked: Sequence[str] = ()
) -> Iterator[Run | Exception]:
    """The run at each of the points, in order, with its result; or the exception it ended with.

    Similar shots are computed together. ``finer`` halves the steps, to estimate errors. If only some facts are
    ``asked`` for, each run ends when these are settled, and its result contains only these.
    """
    varied = Varied(scene, keys)
    built: list[tuple[Scene, Accuracy, Setup] | Exception] = []
    for values in points:
        try:
            point = varied.scene(values)
            accuracy = resolve(**point.parameters.accuracy.model_dump())
            built.append((point, accuracy.finer() if finer else accuracy, _ended(point, asked)))
        except Exception as error:
            built.append(error)
    setups: dict[Accuracy, list[Setup]] = {}
    for made in built:
        if not isinstance(made, Exception):
            setups.setdefault(made[1], []).append(made[2])
    found = {accuracy: simulate_many(alike, accuracy) for accuracy, alike in setups.items()}
    for made in built:
        yield made if isinstance(made, Exception) else _finished(next(found[made[1]]), made[0], asked)


def _ended(scene: Scene, asked: Sequence[str]) -> Setup:
    """The setup of a scene, which ends as soon as the requested facts are settled."""
    setup = scene.build()
    settled = scene.settles(asked) if asked else None
    if settled is None:
        return setup
    return replace(setup, until=_Settled(settled, setup))


@dataclass(frozen=True)
class _Settled(Until):
    """Ends a run when the requested facts are settled, or when the setup's own condition is met."""

    settled: Callable[[Event], bool]
    setup: Setup

    def over(self, events: Sequence[Event]) -> bool:
        return self.settled(events[-1]) or self.setup.ends_with(events)


def _finished(run: Run | Exception, scene: Scene, asked: Sequence[str]) -> Run | Exception:
    if isinstance(run, Exception):
        return run
    try:
        run.result = scene.result(run, asked)
    except Exception as error:
        return error
    return run


def fly_together(scene: Scene, keys: Sequence[str], values: Sequence[Any]) -> bool:
    """Whether the engine computes many runs of this kind at once, judged by the one with these values."""
    try:
        point = Varied(scene, keys).scene(values)
        return flies_in_batches(point.build(), resolve(**point.parameters.accuracy.model_dump()))
    except Exception:
        return False  # its row reports the error
