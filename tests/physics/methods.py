"""Two more integrators, to see that one is data and nothing else needs to know of it."""

from __future__ import annotations

from sandbox.physics.integrators import INTEGRATORS, Acceleration, Integrator, Law, State, Step


def _along(state: State, dt: float, slopes: list[tuple[float, State, Acceleration]]) -> State:
    """The state after ``dt`` times the weighted slopes: (weight, state, acceleration) of each stage."""
    x, y, vx, vy, spin = state
    for weight, (_, _, ux, uy, _), (ax, ay, alpha) in slopes:
        w = dt * weight
        x, y, vx, vy, spin = x + w * ux, y + w * uy, vx + w * ax, vy + w * ay, spin + w * alpha
    return x, y, vx, vy, spin


def _bogacki_shampine(law: Law, t: float, state: State, acceleration: Acceleration, dt: float) -> Step:
    """Third order with an error by the embedded second; what it knows of the end it keeps to itself."""
    second = _along(state, dt, [(1 / 2, state, acceleration)])
    a2 = law(t + dt / 2, second)
    third = _along(state, dt, [(3 / 4, second, a2)])
    a3 = law(t + 3 * dt / 4, third)
    end = _along(state, dt, [(2 / 9, state, acceleration), (1 / 3, second, a2), (4 / 9, third, a3)])
    a4 = law(t + dt, end)
    nothing = tuple(0.0 * part for part in state)
    weights = [(-5 / 72, state, acceleration), (1 / 12, second, a2), (1 / 9, third, a3), (-1 / 8, end, a4)]
    return Step(end, None, _along(nothing, dt, weights))


def _ralston(law: Law, t: float, state: State, acceleration: Acceleration, dt: float) -> Step:
    """Second order with the least bound on its error, at a fixed step."""
    late = _along(state, dt, [(2 / 3, state, acceleration)])
    return Step(_along(state, dt, [(1 / 4, state, acceleration), (3 / 4, late, law(t + 2 * dt / 3, late))]))


MORE = {
    "bogacki-shampine": Integrator(_bogacki_shampine, 3, 4, "Bogacki & Shampine 1989, Appl. Math. Lett. 2:321", True),
    "ralston": Integrator(_ralston, 2, 2, "Ralston 1962, Math. Comp. 16:431"),
}
METHODS = {**INTEGRATORS, **MORE}
