"""Integrators: one entry per method, with its order and its cost.

The state of a ball is ``(x, y, vx, vy, spin)`` in m, m/s, rad/s; an acceleration is ``(ax, ay, alpha)`` in m/s^2 and
rad/s^2. Components are floats, or arrays of shape (n,) when many shots fly at once; ``dt`` may be an array then too.
The acceleration at the start of a step is passed in, since interpolation between steps needs it anyway.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

State = tuple[Any, ...]
Acceleration = tuple[Any, Any, Any]
Law = Callable[[Any, State], Acceleration]


class Step(NamedTuple):
    """The state after one step, and by-products of the method."""

    state: State
    acceleration: Acceleration | None = None  # at the new state, where the method evaluates it
    error: State | None = None  # estimated local error, for an embedded pair


class Integrator(NamedTuple):
    """A method as data: ``step(law, t, state, acceleration, dt) -> Step``."""

    step: Callable[[Law, Any, State, Acceleration, Any], Step]
    order: int  # global error is O(dt**order) for smooth forces
    evaluations: int  # of the acceleration per step, including the one passed in: the unit of work
    source: str
    controls_error: bool = False  # chooses its step from its error estimate

    def step_turning(
        self, law: Law, t: float, state: State, acceleration: Acceleration, dt: float, radius: float
    ) -> Step:
        """A step of a body, whose angle (rad) is a sixth component of its state.

        A method is linear in what it adds up, so a complex number goes through it as two real ones: the turn, as the
        way of a point at this radius (m), is the imaginary part of x. The errors of both are added.
        """
        angle = state[5]

        def beside(found: Acceleration) -> Acceleration:
            return complex(found[0], radius * found[2]), *found[1:]

        def both(at: Any, now: State) -> Acceleration:
            x, y, vx, vy, spin = now
            return beside(law(at, (x.real, y, vx.real, vy, spin, angle + x.imag / radius)))

        x, y, vx, vy, spin, _ = state
        start = complex(x, 0.0), y, complex(vx, radius * spin), vy, spin
        (x, y, vx, vy, spin), last, error = self.step(both, t, start, beside(acceleration), dt)
        return Step(
            (x.real, y, vx.real, vy, spin, angle + x.imag / radius),
            None if last is None else (last[0].real, *last[1:]),
            None if error is None else (*(abs(part.real) + abs(part.imag) for part in error),),
        )


def _explicit_euler(law: Law, t: Any, state: State, acceleration: Acceleration, dt: Any) -> Step:
    x, y, vx, vy, spin = state
    ax, ay, alpha = acceleration
    return Step((x + dt * vx, y + dt * vy, vx + dt * ax, vy + dt * ay, spin + dt * alpha))


def _semi_implicit_euler(law: Law, t: Any, state: State, acceleration: Acceleration, dt: Any) -> Step:
    x, y, vx, vy, spin = state
    ax, ay, alpha = acceleration
    vx = vx + dt * ax
    vy = vy + dt * ay
    return Step((x + dt * vx, y + dt * vy, vx, vy, spin + dt * alpha))


def _heun(law: Law, t: Any, state: State, acceleration: Acceleration, dt: Any) -> Step:
    x, y, vx, vy, spin = state
    ax, ay, alpha = acceleration
    ux = vx + dt * ax
    uy = vy + dt * ay
    bx, by, beta = law(t + dt, (x + dt * vx, y + dt * vy, ux, uy, spin + dt * alpha))
    half = 0.5 * dt
    return Step(
        (
            x + half * (vx + ux),
            y + half * (vy + uy),
            vx + half * (ax + bx),
            vy + half * (ay + by),
            spin + half * (alpha + beta),
        )
    )


def _velocity_verlet(law: Law, t: Any, state: State, acceleration: Acceleration, dt: Any) -> Step:
    """Positions by a parabola; velocities by the mean acceleration of both ends, the end at a predicted velocity."""
    x, y, vx, vy, spin = state
    ax, ay, alpha = acceleration
    half = 0.5 * dt
    x = x + dt * (vx + half * ax)
    y = y + dt * (vy + half * ay)
    bx, by, beta = law(t + dt, (x, y, vx + dt * ax, vy + dt * ay, spin + dt * alpha))
    return Step((x, y, vx + half * (ax + bx), vy + half * (ay + by), spin + half * (alpha + beta)))


def _rk4(law: Law, t: Any, state: State, acceleration: Acceleration, dt: Any) -> Step:
    x, y, vx, vy, spin = state
    ax1, ay1, al1 = acceleration
    half = 0.5 * dt
    vx2 = vx + half * ax1
    vy2 = vy + half * ay1
    ax2, ay2, al2 = law(t + half, (x + half * vx, y + half * vy, vx2, vy2, spin + half * al1))
    vx3 = vx + half * ax2
    vy3 = vy + half * ay2
    ax3, ay3, al3 = law(t + half, (x + half * vx2, y + half * vy2, vx3, vy3, spin + half * al2))
    vx4 = vx + dt * ax3
    vy4 = vy + dt * ay3
    ax4, ay4, al4 = law(t + dt, (x + dt * vx3, y + dt * vy3, vx4, vy4, spin + dt * al3))
    sixth = dt / 6.0
    return Step(
        (
            x + sixth * (vx + 2.0 * (vx2 + vx3) + vx4),
            y + sixth * (vy + 2.0 * (vy2 + vy3) + vy4),
            vx + sixth * (ax1 + 2.0 * (ax2 + ax3) + ax4),
            vy + sixth * (ay1 + 2.0 * (ay2 + ay3) + ay4),
            spin + sixth * (al1 + 2.0 * (al2 + al3) + al4),
        )
    )


#: The pair of Dormand & Prince, RK5(4)7M: the weights of each further stage, of which the last is the fifth order, and
#: those of its difference from the fourth.
DORMAND_PRINCE = (
    (1 / 5,),
    (3 / 40, 9 / 40),
    (44 / 45, -56 / 15, 32 / 9),
    (19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729),
    (9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656),
    (35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84),
)
DORMAND_PRINCE_ERROR = (71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40)

(_A21,), (_A31, _A32), (_A41, _A42, _A43), (_A51, _A52, _A53, _A54), (_A61, _A62, _A63, _A64, _A65), _LAST = (
    DORMAND_PRINCE
)
_A71, _, _A73, _A74, _A75, _A76 = _LAST
_E1, _, _E3, _E4, _E5, _E6, _E7 = DORMAND_PRINCE_ERROR


def _dormand_prince(law: Law, t: Any, state: State, acceleration: Acceleration, dt: Any) -> Step:
    """Seven stages, the last of which is the first of the next step; error from the embedded fourth-order method."""
    x, y, vx, vy, w = state
    ax1, ay1, al1 = acceleration

    h = dt * _A21
    vx2 = vx + h * ax1
    vy2 = vy + h * ay1
    ax2, ay2, al2 = law(t + h, (x + h * vx, y + h * vy, vx2, vy2, w + h * al1))

    p, q = dt * _A31, dt * _A32
    vx3 = vx + p * ax1 + q * ax2
    vy3 = vy + p * ay1 + q * ay2
    ax3, ay3, al3 = law(
        t + dt * (3 / 10), (x + p * vx + q * vx2, y + p * vy + q * vy2, vx3, vy3, w + p * al1 + q * al2)
    )

    p, q, r = dt * _A41, dt * _A42, dt * _A43
    vx4 = vx + p * ax1 + q * ax2 + r * ax3
    vy4 = vy + p * ay1 + q * ay2 + r * ay3
    ax4, ay4, al4 = law(
        t + dt * (4 / 5),
        (
            x + p * vx + q * vx2 + r * vx3,
            y + p * vy + q * vy2 + r * vy3,
            vx4,
            vy4,
            w + p * al1 + q * al2 + r * al3,
        ),
    )

    p, q, r, s = dt * _A51, dt * _A52, dt * _A53, dt * _A54
    vx5 = vx + p * ax1 + q * ax2 + r * ax3 + s * ax4
    vy5 = vy + p * ay1 + q * ay2 + r * ay3 + s * ay4
    ax5, ay5, al5 = law(
        t + dt * (8 / 9),
        (
            x + p * vx + q * vx2 + r * vx3 + s * vx4,
            y + p * vy + q * vy2 + r * vy3 + s * vy4,
            vx5,
            vy5,
            w + p * al1 + q * al2 + r * al3 + s * al4,
        ),
    )

    p, q, r, s, z = dt * _A61, dt * _A62, dt * _A63, dt * _A64, dt * _A65
    vx6 = vx + p * ax1 + q * ax2 + r * ax3 + s * ax4 + z * ax5
    vy6 = vy + p * ay1 + q * ay2 + r * ay3 + s * ay4 + z * ay5
    ax6, ay6, al6 = law(
        t + dt,
        (
            x + p * vx + q * vx2 + r * vx3 + s * vx4 + z * vx5,
            y + p * vy + q * vy2 + r * vy3 + s * vy4 + z * vy5,
            vx6,
            vy6,
            w + p * al1 + q * al2 + r * al3 + s * al4 + z * al5,
        ),
    )

    p, r, s, z, o = dt * _A71, dt * _A73, dt * _A74, dt * _A75, dt * _A76
    vx7 = vx + p * ax1 + r * ax3 + s * ax4 + z * ax5 + o * ax6
    vy7 = vy + p * ay1 + r * ay3 + s * ay4 + z * ay5 + o * ay6
    after = (
        x + p * vx + r * vx3 + s * vx4 + z * vx5 + o * vx6,
        y + p * vy + r * vy3 + s * vy4 + z * vy5 + o * vy6,
        vx7,
        vy7,
        w + p * al1 + r * al3 + s * al4 + z * al5 + o * al6,
    )
    last = law(t + dt, after)

    p, r, s, z, o, f = dt * _E1, dt * _E3, dt * _E4, dt * _E5, dt * _E6, dt * _E7
    error = (
        p * vx + r * vx3 + s * vx4 + z * vx5 + o * vx6 + f * vx7,
        p * vy + r * vy3 + s * vy4 + z * vy5 + o * vy6 + f * vy7,
        p * ax1 + r * ax3 + s * ax4 + z * ax5 + o * ax6 + f * last[0],
        p * ay1 + r * ay3 + s * ay4 + z * ay5 + o * ay6 + f * last[1],
        p * al1 + r * al3 + s * al4 + z * al5 + o * al6 + f * last[2],
    )
    return Step(after, last, error)


INTEGRATORS = {
    "explicit-euler": Integrator(_explicit_euler, 1, 1, "Euler 1768"),
    "semi-implicit-euler": Integrator(
        _semi_implicit_euler, 1, 1, "Hairer, Lubich & Wanner, Geometric Numerical Integration, I.1.2"
    ),
    "heun": Integrator(_heun, 2, 2, "Heun 1900; Hairer, Norsett & Wanner, Solving ODEs I, II.1"),
    "velocity-verlet": Integrator(_velocity_verlet, 2, 2, "Swope et al. 1982, J. Chem. Phys. 76:637"),
    "rk4": Integrator(_rk4, 4, 4, "Kutta 1901; Hairer, Norsett & Wanner, Solving ODEs I, II.1"),
    "dormand-prince": Integrator(
        _dormand_prince, 5, 6, "Dormand & Prince 1980, J. Comput. Appl. Math. 6:19, RK5(4)7M", True
    ),
}
