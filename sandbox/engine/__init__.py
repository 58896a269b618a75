"""The engine: exact flight, exact times of contact, impulses by pymunk. Only this package imports pymunk."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from sandbox.engine.accuracy import Accuracy
    from sandbox.engine.clusters import Asking
    from sandbox.engine.run import Run
    from sandbox.engine.setup import Setup


def simulate(setup: Setup, accuracy: Accuracy, progress: Callable[[float, float], None] | None = None) -> Run:
    """Run a setup to its end. Raises RunError with the time, the ball and the quantity if it cannot be completed.

    The plain method, which may take many steps, reports to ``progress`` the time simulated and the most that it can
    become, in s.
    """
    from sandbox.engine.simulation import alone  # here, not above: it brings pymunk

    return alone(_run(setup, accuracy, progress))


def _run(setup: Setup, accuracy: Accuracy, progress: Callable[[float, float], None] | None = None) -> Asking[Run]:
    # here, not above: they bring pymunk, which reading a scene does not need
    if accuracy.method == "plain":
        from sandbox.engine.plain import PlainSimulation

        return PlainSimulation(setup, accuracy, progress).run()
    from sandbox.engine.simulation import Simulation

    return (yield from Simulation(setup, accuracy).run())


def simulate_many(setups: Sequence[Setup], accuracy: Accuracy, at_once: int = 1) -> Iterator[Run | Exception]:
    """A run of each setup, in order, or the exception it ended with.

    Setups of one flight that differ only in numbers are computed together, with the results of ``simulate`` to
    rounding; their forces are then called with arrays of shape (n,) for time, position, velocity and spin. If there are
    others among them, or forces that cannot take arrays, all run one at a time; or so many ``at_once``, which pass
    together through their first contacts of several balls, as racks do: quicker, with other rounding and a step that
    they have in common.
    """
    from sandbox.engine.batch import together
    from sandbox.engine.simulation import side_by_side

    runs = together(setups, accuracy) if accuracy.method == "exact" else None
    if runs is not None:
        yield from runs
        return
    for first in range(0, len(setups), at_once):
        places = range(first, min(first + at_once, len(setups)))
        yield from side_by_side([_run(setups[place], accuracy) for place in places])


def flies_in_batches(setup: Setup, accuracy: Accuracy) -> bool:
    """Whether ``simulate_many`` is quicker for setups of this kind than ``simulate`` one by one."""
    return accuracy.method == "exact" and setup.is_flight
