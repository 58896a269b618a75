"""The engine: exact flight, exact times of contact, impulses by pymunk. Only this package imports pymunk."""

from __future__ import annotations

from typing import TYPE_CHECKING

from sandbox.engine.setup_errors import setup_errors_named

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from sandbox.engine.accuracy import Accuracy
    from sandbox.engine.run import Run
    from sandbox.engine.setup import Setup


def simulate(setup: Setup, accuracy: Accuracy, progress: Callable[[float, float], None] | None = None) -> Run:
    """Run a setup to its end. Raises RunError with the time, the ball and the quantity if it cannot be completed.

    The plain method, which may take many steps, reports to ``progress`` the time simulated and the most that it can
    become, in s.
    """
    # here, not above: they bring pymunk, which reading a scene does not need
    with setup_errors_named(setup):
        if accuracy.method == "plain":
            from sandbox.engine.plain import PlainSimulation

            return PlainSimulation(setup, accuracy, progress).run()
        from sandbox.engine.simulation import Simulation

        return Simulation(setup, accuracy).run()


def simulate_many(setups: Sequence[Setup], accuracy: Accuracy) -> Iterator[Run | Exception]:
    """A run of each setup, in order, or the exception it ended with; similar setups are computed together."""
    from sandbox.engine.batch import simulate_many as together

    return together(setups, accuracy)


def flies_in_batches(setup: Setup, accuracy: Accuracy) -> bool:
    """Whether ``simulate_many`` is quicker for setups of this kind than ``simulate`` one by one."""
    one_at_a_time = setup.plane is not None or setup.catches or len(setup.balls) > 1 or not setup.surfaces
    return accuracy.method == "exact" and not one_at_a_time
