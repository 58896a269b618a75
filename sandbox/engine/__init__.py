"""The engine: exact flight, exact times of contact, impulses by pymunk. Only this package imports pymunk.

What simulates is imported when it is first used: it brings pymunk, which reading a scene does not need.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from sandbox.engine.many.flown import Flown
    from sandbox.engine.model.accuracy import Accuracy
    from sandbox.engine.model.setup import Setup
    from sandbox.engine.paths.run import Run


def simulate(setup: Setup, accuracy: Accuracy, progress: Callable[[float, float], None] | None = None) -> Run:
    """Run a setup to its end. Raises RunError with the time, the ball and the quantity if it cannot be completed.

    The plain method, which may take many steps, reports to ``progress`` the time simulated and the most that it can
    become, in s.
    """
    from sandbox.engine.model.setup_errors import setup_errors_named

    with setup_errors_named():
        if accuracy.method == "plain":
            from sandbox.engine.plain import PlainSimulation

            return PlainSimulation(setup, accuracy, progress).run()
        from sandbox.engine.live import LiveSimulation

        return LiveSimulation(setup, accuracy).run()


def simulate_many(setups: Sequence[Setup], accuracy: Accuracy) -> Iterator[Run | Exception]:
    """Return an iterator over the run of each setup, in order, or the exception it ended with.

    Setups of one ball in flight that differ only in numbers are computed together, with the results of ``simulate`` to
    rounding; their forces are then called with arrays of shape (n,) for time, position, velocity and spin. If there are
    others among them, or forces that cannot take arrays, all run one at a time.
    """
    together = simulate_together(setups, accuracy)
    return (_run_or_error(setup, accuracy) for setup in setups) if together is None else iter(together)


def simulate_together(setups: Sequence[Setup], accuracy: Accuracy) -> Flown | None:
    """Return the runs of many setups as rows; None if they cannot fly together."""
    from sandbox.engine.many.batch import simulate_batch

    return simulate_batch(setups, accuracy) if accuracy.method == "exact" else None


def _run_or_error(setup: Setup, accuracy: Accuracy) -> Run | Exception:
    try:
        return simulate(setup, accuracy)
    except Exception as error:
        return error


def can_batch(setup: Setup, accuracy: Accuracy) -> bool:
    """True if ``simulate_many`` is quicker for setups of this kind than ``simulate`` one by one."""
    return accuracy.method == "exact" and setup.is_single_ball
