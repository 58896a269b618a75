"""Integrators as data: the weights of each method, with its order and its source.

The state of a ball is ``(x, y, vx, vy, spin)`` in m, m/s, rad/s; that of a body has its angle in rad, too, that of a
ball that rolls on a plane its spins about x and y. An acceleration is ``(ax, ay, alpha)`` in m/s^2 and rad/s^2, and has
the rates of those spins, too. Components are floats; or rows of an array, shape (5, n) and
(3, n), when many shots fly at once, and ``dt`` has shape (n,) then. The acceleration at the start of a step is passed
in, since interpolation between steps needs it anyway.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from operator import mul
from typing import Any, NamedTuple

from sandbox.physics import dormand_prince as pair

State = tuple[Any, ...]
Acceleration = tuple[Any, ...]

#: The acceleration at a time in s in a state.
AccelerationFunction = Callable[[Any, State], Acceleration]


#: The state after one step, the acceleration there, and an embedded pair's estimate of the local error.
Step = tuple[State, Acceleration, State | None]

#: ``method(t, state, acceleration, dt)`` makes one step.
Method = Callable[[Any, State, Acceleration, Any], Step]


class Stage(NamedTuple):
    """A state at t + ``time`` dt from the velocities v_j and accelerations a_j at the start and in the stages before:

        v = v_1 + dt (w_1 a_1 + w_2 a_2 + ...),    x = x_1 + dt (w_1 v_1 + w_2 v_2 + ...)

    with the ``weights`` w; for x with others, where they are given, which may include the stage's own v.
    """

    time: float
    weights: tuple[float, ...]
    of_velocities: tuple[float, ...] = ()


class Integrator(NamedTuple):
    """An explicit Runge-Kutta method: its stages after the start, the last of which is the end of the step."""

    stages: tuple[Stage, ...]
    order: int  # global error is O(dt**order) for smooth forces
    source: str
    error: tuple[float, ...] = ()  # its weights, from the start to the last stage or the end, for an embedded pair
    #: The same as ``step_of``, written out for speed.
    by_hand: Callable[[AccelerationFunction, bool], Method] | None = None

    @property
    def evaluations(self) -> int:
        """Evaluations of the acceleration per step, including the one passed in: the unit of work."""
        return len(self.stages)

    @property
    def controls_error(self) -> bool:
        """True if it chooses its step from its error estimate."""
        return len(self.error) > 0

    def step_of(self, acceleration_at: AccelerationFunction, rotates: bool = False, rolls: bool = False) -> Method:
        """Return the step of a ball; of a body if it ``rotates``, or of a ball that ``rolls`` on a plane: their states
        have more."""
        if self.by_hand is not None and not rolls:
            return self.by_hand(acceleration_at, rotates)
        coordinates = (0, 1, 5) if rotates else (0, 1)

        def step(t: Any, state: State, acceleration: Acceleration, dt: Any) -> Step:
            rates = [[*state[2:4], *acceleration, state[4]]]  # of all in the state, the angle last, in each stage
            for time, weights, of_velocities in self.stages:
                end = [now + change for now, change in zip(state, _changes(dt, weights, rates), strict=False)]
                rates.append([*end[2:4], *(0.0 for _ in acceleration), end[4]])
                if of_velocities:
                    changes = _changes(dt, of_velocities, rates)
                    for place in coordinates:
                        end[place] = state[place] + changes[place]
                acceleration = acceleration_at(t + time * dt, tuple(end))
                rates[-1][2:-1] = acceleration
            error = tuple(_changes(dt, self.error, rates)[: len(state)]) if self.error else None
            return tuple(end), acceleration, error

        return step

    def step_of_many(self, acceleration_at: Callable[[Any, Any], Any]) -> Method:
        """Return the same step of many balls at once, whose states are an array, each independent of the others."""
        import numpy as np  # here, not above: single runs do not need it

        one = self.step_of(lambda t, state: acceleration_at(t, np.array(state)))

        def step(t: Any, state: Any, acceleration: Any, dt: Any) -> Any:
            end, last, error = one(t, state, acceleration, dt)
            return np.array(end), np.array(last), None if error is None else np.array(error)

        return step


def _changes(dt: float, weights: Sequence[float], rates: Sequence[Sequence[float]]) -> list[float]:
    """Return the change of each component in dt at the weighted sum of its rates in the stages."""
    return [dt * sum(map(mul, weights, rates_of_one)) for rates_of_one in zip(*rates, strict=True)]


_HALF = Stage(1 / 2, (1 / 2,))

_DORMAND_PRINCE = Integrator(
    (
        Stage(pair.C2, (pair.A21,)),
        Stage(pair.C3, (pair.A31, pair.A32)),
        Stage(pair.C4, (pair.A41, pair.A42, pair.A43)),
        Stage(pair.C5, (pair.A51, pair.A52, pair.A53, pair.A54)),
        Stage(1.0, (pair.A61, pair.A62, pair.A63, pair.A64, pair.A65)),
        Stage(
            1.0,
            (pair.A71, 0.0, pair.A73, pair.A74, pair.A75, pair.A76),
        ),
    ),
    5,
    "Dormand & Prince 1980, J. Comput. Appl. Math. 6:19, RK5(4)7M",
    (
        pair.E1,
        0.0,
        pair.E3,
        pair.E4,
        pair.E5,
        pair.E6,
        pair.E7,
    ),
    pair.step_of,
)

INTEGRATORS = {
    "explicit-euler": Integrator((Stage(1.0, (1.0,)),), 1, "Euler 1768"),
    "semi-implicit-euler": Integrator(
        (Stage(1.0, (1.0,), (0.0, 1.0)),), 1, "Hairer, Lubich & Wanner, Geometric Numerical Integration, I.1.2"
    ),
    "heun": Integrator(
        (Stage(1.0, (1.0,)), Stage(1.0, (1 / 2, 1 / 2))),
        2,
        "Heun 1900; Hairer, Norsett & Wanner, Solving ODEs I, II.1",
    ),
    # positions by a parabola; velocities by the mean acceleration of both ends, the end at a predicted velocity
    "velocity-verlet": Integrator(
        (Stage(1.0, (1.0,), (1 / 2, 1 / 2)), Stage(1.0, (1 / 2, 1 / 2))), 2, "Swope et al. 1982, J. Chem. Phys. 76:637"
    ),
    "rk4": Integrator(
        (_HALF, Stage(1 / 2, (0.0, 1 / 2)), Stage(1.0, (0.0, 0.0, 1.0)), Stage(1.0, (1 / 6, 1 / 3, 1 / 3, 1 / 6))),
        4,
        "Kutta 1901; Hairer, Norsett & Wanner, Solving ODEs I, II.1",
    ),
    "dormand-prince": _DORMAND_PRINCE,
}
