"""Three more integrators, to see that one is data and nothing else needs to know of it."""

from __future__ import annotations

from sandbox.physics.integrators import INTEGRATORS, Integrator, Stage

MORE = {
    # third order, with an error by the embedded second
    "bogacki-shampine": Integrator(
        (Stage(1 / 2, (1 / 2,)), Stage(3 / 4, (0.0, 3 / 4)), Stage(1.0, (2 / 9, 1 / 3, 4 / 9))),
        3,
        "Bogacki & Shampine 1989, Appl. Math. Lett. 2:321",
        (-5 / 72, 1 / 12, 1 / 9, -1 / 8),
    ),
    # third order with an embedded second, too, but the end of a step is not evaluated for that
    "shu-osher": Integrator(
        (Stage(1.0, (1.0,)), Stage(1 / 2, (1 / 4, 1 / 4)), Stage(1.0, (1 / 6, 1 / 6, 2 / 3))),
        3,
        "Shu & Osher 1988, J. Comput. Phys. 77:439",
        (-1 / 3, -1 / 3, 2 / 3),
    ),
    # second order, with the least bound on its error
    "ralston": Integrator((Stage(2 / 3, (2 / 3,)), Stage(1.0, (1 / 4, 3 / 4))), 2, "Ralston 1962, Math. Comp. 16:431"),
}
METHODS = {**INTEGRATORS, **MORE}
