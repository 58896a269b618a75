"""Many runs of one scene, each with other values at some keys."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from sandbox.engine import flies_in_batches, simulate_many
from sandbox.engine.accuracy import Accuracy, resolve
from sandbox.lab.axes import Varied
from sandbox.scene import Scene

if TYPE_CHECKING:
    from sandbox.engine.run import Run
    from sandbox.engine.setup import Setup


def runs(
    scene: Scene, keys: Sequence[str], points: Sequence[Sequence[Any]], finer: bool = False
) -> Iterator[Run | Exception]:
    """The run at each of the points, in order, with its result; or the exception that it ended in.

    Shots that are alike fly together. ``finer`` runs with half the steps, to estimate errors by.
    """
    varied, module = Varied(scene, keys), scene.module
    built: list[tuple[Any, Accuracy, Setup] | Exception] = []
    for values in points:
        try:
            parameters = varied.parameters(values)
            accuracy = resolve(**parameters.accuracy.model_dump())
            built.append((parameters, accuracy.finer() if finer else accuracy, module.build(parameters)))
        except Exception as error:
            built.append(error)
    setups: dict[Accuracy, list[Setup]] = {}
    for made in built:
        if not isinstance(made, Exception):
            setups.setdefault(made[1], []).append(made[2])
    found = {accuracy: simulate_many(alike, accuracy) for accuracy, alike in setups.items()}
    for made in built:
        yield made if isinstance(made, Exception) else _finished(next(found[made[1]]), module, made[0])


def _finished(run: Run | Exception, module: Any, parameters: Any) -> Run | Exception:
    if isinstance(run, Exception):
        return run
    try:
        run.result = module.result(run, parameters)
    except Exception as error:
        return error
    return run


def fly_together(scene: Scene, keys: Sequence[str], values: Sequence[Any]) -> bool:
    """Whether the engine takes many runs of this kind at once, judged by the one with these values."""
    try:
        parameters = Varied(scene, keys).parameters(values)
        setup = scene.module.build(parameters)
        return flies_in_batches(setup, resolve(**parameters.accuracy.model_dump()))
    except Exception:
        return False  # its row will say why
