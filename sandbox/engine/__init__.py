"""The engine: fly exactly, touch exactly, let pymunk push. The only room that imports pymunk."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sandbox.engine.accuracy import Accuracy
    from sandbox.engine.run import Run
    from sandbox.engine.setup import Setup


def simulate(setup: Setup, accuracy: Accuracy) -> Run:
    """Run a setup to its end. Raises RunError where that cannot be done, with the time, the ball and the quantity."""
    # here, not above: they bring pymunk, which reading a scene does not need
    if accuracy.method == "plain":
        from sandbox.engine.plain import PlainSimulation

        return PlainSimulation(setup, accuracy).run()
    from sandbox.engine.simulation import Simulation

    return Simulation(setup, accuracy).run()
