"""Many runs of one scene, each with other values at some keys."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from sandbox.engine import simulate
from sandbox.engine.accuracy import resolve
from sandbox.lab.axes import Varied
from sandbox.scene import Scene

if TYPE_CHECKING:
    from sandbox.engine.run import Run


def runs(
    scene: Scene, keys: Sequence[str], points: Sequence[Sequence[Any]], finer: bool = False
) -> Iterator[Run | Exception]:
    """The run at each of the points, in order, with its result; or the exception that it ended in.

    ``finer`` runs with half the steps, to estimate errors by.
    """
    varied, module = Varied(scene, keys), scene.module
    for values in points:
        try:
            parameters = varied.parameters(values)
            accuracy = resolve(**parameters.accuracy.model_dump())
            run = simulate(module.build(parameters), accuracy.finer() if finer else accuracy)
            run.result = module.result(run, parameters)
        except Exception as error:
            yield error
        else:
            yield run


#: Shots that fly together.
BATCH = 500


def flies_in_batches(scene: Scene, keys: Sequence[str], values: Sequence[Any]) -> bool:
    return False
