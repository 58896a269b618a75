"""Integrators as data: the weights of each method, with its order and its source.

The state of a ball is ``(x, y, vx, vy, spin)`` in m, m/s, rad/s; that of a body has its angle in rad, too. An
acceleration is ``(ax, ay, alpha)`` in m/s^2 and rad/s^2. Components are floats; or rows of an array, shape (5, n) and
(3, n), when many shots fly at once, and ``dt`` has shape (n,) then. The acceleration at the start of a step is passed
in, since interpolation between steps needs it anyway.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cache
from typing import Any, NamedTuple

from sandbox.physics.straight import straight

State = tuple[Any, ...]
Acceleration = tuple[Any, Any, Any]
Law = Callable[[Any, State], Acceleration]


#: The state after one step, the acceleration there, and an embedded pair's estimate of the local error.
Step = tuple[State, Acceleration, State | None]

#: ``method(t, state, acceleration, dt)`` makes one step.
Method = Callable[[Any, State, Acceleration, Any], Step]


class Written(NamedTuple):
    """A law as lines of Python, which a step repeats in each of its stages: no stage calls a function to call others.

    The lines make ``ax{n}, ay{n}, alpha{n}`` at the time ``at`` from ``{state}``, that is ``x{n}, y{n}, vx{n}, ...``
    """

    given: str  # names of what the law needs, as the parameters of what makes its step
    before: tuple[str, ...]  # what is known of all stages
    lines: tuple[str, ...]
    otherwise: tuple[str, ...] = ()  # what follows if they, below a ``try:``, do not succeed
    turning: bool = True  # whether it changes the spin
    placed: bool = True  # whether it may differ from place to place


#: Any law.
CALLED = Written("law", (), ("ax{n}, ay{n}, alpha{n} = law(at, ({state}))",))


class Stage(NamedTuple):
    """A state at t + ``time`` dt from the velocities v_j and accelerations a_j at the start and in the stages before:

        v = v_1 + dt (w_1 a_1 + w_2 a_2 + ...),    x = x_1 + dt (w_1 v_1 + w_2 v_2 + ...)

    with the ``weights`` w; for x with others, where they are given, which may include the stage's own v.
    """

    time: float
    weights: tuple[float, ...]
    of_velocities: tuple[float, ...] = ()


class Integrator(NamedTuple):
    """An explicit method of Runge and Kutta: its stages after the start, the last of which is the end of the step."""

    stages: tuple[Stage, ...]
    order: int  # global error is O(dt**order) for smooth forces
    source: str
    error: tuple[float, ...] = ()  # its weights, from the start to the last stage or the end, for an embedded pair

    @property
    def evaluations(self) -> int:
        """Of the acceleration per step, including the one passed in: the unit of work."""
        return len(self.stages)

    @property
    def controls_error(self) -> bool:
        """Whether it chooses its step from its error estimate."""
        return len(self.error) > 0

    def step_of(self, law: Law, turns: bool = False) -> Method:
        """One step of a ball under a law; or of a body, which ``turns``."""
        method: Method = self.written(CALLED, turns)(law)
        return method

    def step_of_many(self, law: Law) -> Method:
        """One step of many balls at once, whose states are an array. A ball's step does not depend on the others."""
        import numpy as np  # here, not above: single runs do not need it

        stages = [(each.time, np.array(each.weights), np.array(each.of_velocities)) for each in self.stages]
        off = np.array(self.error)

        def step(t: Any, state: Any, acceleration: Any, dt: Any) -> Any:
            rates = np.empty((len(stages) + 1, *state.shape))  # vx, vy, ax, ay and alpha in each stage
            rates[0, :2], rates[0, 2:] = state[2:4], acceleration

            def grown(weights: Any, components: int) -> Any:
                return dt * np.einsum("s,scn->cn", weights, rates[: len(weights), :components])

            for number, (time, weights, of_velocities) in enumerate(stages, 1):
                end = state + grown(weights, 5)
                rates[number, :2] = end[2:4]
                if len(of_velocities):
                    end[:2] = state[:2] + grown(of_velocities, 2)
                rates[number, 2:] = law(t + time * dt, end)
            return end, rates[-1, 2:], grown(off, 5) if len(off) else None

        return step

    def written(self, law: Written, turns: bool = False) -> Callable[..., Method]:
        """What makes one step under a law that is written out, from what the law needs."""
        return _written_out(self.stages, self.error, COMPONENTS[turns], law)


#: The components of a state, and the rate of each.
_RATES = {"x": "vx", "y": "vy", "vx": "ax", "vy": "ay", "spin": "alpha", "angle": "spin"}
#: The components of the state by whether something turns: of a ball, and of a body.
COMPONENTS = {False: tuple(_RATES)[:-1], True: tuple(_RATES)}


@cache
def _written_out(
    stages: Sequence[Stage], error: Sequence[float], names: Sequence[str], law: Written
) -> Callable[..., Method]:
    """What makes the step of a state with these components as straight Python; loops over the weights take seven times
    as long.

    A stage of Heun's method becomes ``vx2 = vx1 + dt * (ax1)``, ``x2 = x1 + dt * (vx1)``, the same for the others, and
    the lines of the law; other numbers than 1 are multiplied by dt once.
    """
    used = {*error, *(w for time, *of_both in stages for w in (time, *sum(of_both, ())))} - {0.0, 1.0}
    h = {number: f"h{place}" for place, number in enumerate(sorted(used))}
    rates = "ax", "ay", "alpha"
    coordinates = [name for name in names if _RATES[name] not in rates]
    lines = [f"{_at(1, names)} = state", f"{_at(1, rates)} = acceleration"]
    lines += [f"{name} = dt * {number!r}" for number, name in h.items()]
    h[1.0] = "dt"
    staged: list[str] = []
    for number, stage in enumerate(stages, 2):
        made = dict.fromkeys(sorted(names, key=coordinates.__contains__), stage.weights)  # which may need the rest
        if stage.of_velocities:
            made |= dict.fromkeys(coordinates, stage.of_velocities)
        for name, weights in made.items():
            if name in coordinates and number <= len(stages) and not law.placed:
                continue  # only the end has a place
            grows = f" + {_sum(h, weights, name)}" if name != "spin" or law.turning else ""
            staged.append(f"{name}{number} = {name}1{grows}")
        staged.append(f"at = t + {h[stage.time]}")
        staged += [line.format(n=number, state=_at(number, names)) for line in law.lines]
    off = [_sum(h, error, name) if name != "spin" or law.turning else "0.0" for name in names]
    errors = f"({', '.join(off)})" if error else "None"
    ends = [f"return ({_at(number, names)}), ({_at(number, rates)}), {errors}"]
    if law.otherwise:
        staged = ["try:", *(f"  {line}" for line in staged), *law.otherwise]
    body = [f"  {line}" for line in (*lines, *staged, *ends)]
    step = [*law.before, "def step(t, state, acceleration, dt):", *body, "return step"]
    makes: Callable[..., Method] = straight(f"step_of({law.given})", step, __file__)
    return makes


def _at(number: int, names: Iterable[str]) -> str:
    """These at the start, in a stage or at the end, by number."""
    return ", ".join(f"{name}{number}" for name in names)


def _sum(h: Mapping[float, str], weights: Sequence[float], name: str) -> str:
    """The weighted sum of the rates of a component."""
    rates = {weight: "" for weight in weights if weight}
    for number, weight in enumerate(weights, 1):
        if weight:
            rates[weight] += f" + {_RATES[name]}{number}"
    return " + ".join(f"{h[weight]} * ({rate[3:]})" for weight, rate in rates.items())


_HALF = Stage(1 / 2, (1 / 2,))

#: The pair RK5(4)7M; its end has the fifth order.
DORMAND_PRINCE = Integrator(
    (
        Stage(1 / 5, (1 / 5,)),
        Stage(3 / 10, (3 / 40, 9 / 40)),
        Stage(4 / 5, (44 / 45, -56 / 15, 32 / 9)),
        Stage(8 / 9, (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729)),
        Stage(1.0, (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656)),
        Stage(1.0, (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84)),
    ),
    5,
    "Dormand & Prince 1980, J. Comput. Appl. Math. 6:19, RK5(4)7M",
    (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40),
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
    "dormand-prince": DORMAND_PRINCE,
}
