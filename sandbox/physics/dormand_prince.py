"""One step of the pair RK5(4)7M by Dormand and Prince, written by hand: most shots spend most of their time in it.

The weights are those of the Butcher tableau: A43 is that of the third stage in the fourth, C4 the fourth stage's time,
E3 the third stage's weight in the error estimate. The last stage is the end of the step, of fifth order.

Source: Dormand & Prince 1980, J. Comput. Appl. Math. 6:19, table 2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sandbox.physics.integrators import Acceleration, AccelerationFunction, Method, State, Step

C2, C3, C4, C5 = 1 / 5, 3 / 10, 4 / 5, 8 / 9
A21 = 1 / 5
A31, A32 = 3 / 40, 9 / 40
A41, A42, A43 = 44 / 45, -56 / 15, 32 / 9
A51, A52, A53, A54 = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
A61, A62, A63, A64, A65 = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
A71, A73, A74, A75, A76 = 35 / 384, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
E1, E3, E4, E5, E6, E7 = 71 / 57600, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40


def step_of(acceleration_at: AccelerationFunction, rotates: bool) -> Method:
    """Return the step of a ball, whose state is (x, y, vx, vy, spin); of a body if it ``rotates``: its state has the
    angle, too. Components and dt are floats, or arrays; ``of`` is whatever else the acceleration is a function of."""

    def step(t: Any, state: State, acceleration: Acceleration, dt: Any, *of: Any) -> Step:
        x1, y1, vx1, vy1, spin1 = state[:5]
        angle1 = state[5] if rotates else 0.0
        ax1, ay1, alpha1 = acceleration

        h1 = dt * A21
        x2 = x1 + h1 * vx1
        y2 = y1 + h1 * vy1
        vx2 = vx1 + h1 * ax1
        vy2 = vy1 + h1 * ay1
        spin2 = spin1 + h1 * alpha1
        state = x2, y2, vx2, vy2, spin2
        if rotates:
            state += (angle1 + h1 * spin1,)
        ax2, ay2, alpha2 = acceleration_at(t + dt * C2, state, *of)

        h1, h2 = dt * A31, dt * A32
        x3 = x1 + h1 * vx1 + h2 * vx2
        y3 = y1 + h1 * vy1 + h2 * vy2
        vx3 = vx1 + h1 * ax1 + h2 * ax2
        vy3 = vy1 + h1 * ay1 + h2 * ay2
        spin3 = spin1 + h1 * alpha1 + h2 * alpha2
        state = x3, y3, vx3, vy3, spin3
        if rotates:
            state += (angle1 + h1 * spin1 + h2 * spin2,)
        ax3, ay3, alpha3 = acceleration_at(t + dt * C3, state, *of)

        h1, h2, h3 = dt * A41, dt * A42, dt * A43
        x4 = x1 + h1 * vx1 + h2 * vx2 + h3 * vx3
        y4 = y1 + h1 * vy1 + h2 * vy2 + h3 * vy3
        vx4 = vx1 + h1 * ax1 + h2 * ax2 + h3 * ax3
        vy4 = vy1 + h1 * ay1 + h2 * ay2 + h3 * ay3
        spin4 = spin1 + h1 * alpha1 + h2 * alpha2 + h3 * alpha3
        state = x4, y4, vx4, vy4, spin4
        if rotates:
            state += (angle1 + h1 * spin1 + h2 * spin2 + h3 * spin3,)
        ax4, ay4, alpha4 = acceleration_at(t + dt * C4, state, *of)

        h1, h2, h3, h4 = dt * A51, dt * A52, dt * A53, dt * A54
        x5 = x1 + h1 * vx1 + h2 * vx2 + h3 * vx3 + h4 * vx4
        y5 = y1 + h1 * vy1 + h2 * vy2 + h3 * vy3 + h4 * vy4
        vx5 = vx1 + h1 * ax1 + h2 * ax2 + h3 * ax3 + h4 * ax4
        vy5 = vy1 + h1 * ay1 + h2 * ay2 + h3 * ay3 + h4 * ay4
        spin5 = spin1 + h1 * alpha1 + h2 * alpha2 + h3 * alpha3 + h4 * alpha4
        state = x5, y5, vx5, vy5, spin5
        if rotates:
            state += (angle1 + h1 * spin1 + h2 * spin2 + h3 * spin3 + h4 * spin4,)
        ax5, ay5, alpha5 = acceleration_at(t + dt * C5, state, *of)

        h1, h2, h3, h4, h5 = dt * A61, dt * A62, dt * A63, dt * A64, dt * A65
        x6 = x1 + h1 * vx1 + h2 * vx2 + h3 * vx3 + h4 * vx4 + h5 * vx5
        y6 = y1 + h1 * vy1 + h2 * vy2 + h3 * vy3 + h4 * vy4 + h5 * vy5
        vx6 = vx1 + h1 * ax1 + h2 * ax2 + h3 * ax3 + h4 * ax4 + h5 * ax5
        vy6 = vy1 + h1 * ay1 + h2 * ay2 + h3 * ay3 + h4 * ay4 + h5 * ay5
        spin6 = spin1 + h1 * alpha1 + h2 * alpha2 + h3 * alpha3 + h4 * alpha4 + h5 * alpha5
        state = x6, y6, vx6, vy6, spin6
        if rotates:
            state += (angle1 + h1 * spin1 + h2 * spin2 + h3 * spin3 + h4 * spin4 + h5 * spin5,)
        ax6, ay6, alpha6 = acceleration_at(t + dt, state, *of)

        h1, h3, h4, h5, h6 = dt * A71, dt * A73, dt * A74, dt * A75, dt * A76
        x7 = x1 + h1 * vx1 + h3 * vx3 + h4 * vx4 + h5 * vx5 + h6 * vx6
        y7 = y1 + h1 * vy1 + h3 * vy3 + h4 * vy4 + h5 * vy5 + h6 * vy6
        vx7 = vx1 + h1 * ax1 + h3 * ax3 + h4 * ax4 + h5 * ax5 + h6 * ax6
        vy7 = vy1 + h1 * ay1 + h3 * ay3 + h4 * ay4 + h5 * ay5 + h6 * ay6
        spin7 = spin1 + h1 * alpha1 + h3 * alpha3 + h4 * alpha4 + h5 * alpha5 + h6 * alpha6
        end: State = x7, y7, vx7, vy7, spin7
        if rotates:
            end += (angle1 + h1 * spin1 + h3 * spin3 + h4 * spin4 + h5 * spin5 + h6 * spin6,)
        ax7, ay7, alpha7 = last = acceleration_at(t + dt, end, *of)

        h1, h3, h4, h5, h6, h7 = dt * E1, dt * E3, dt * E4, dt * E5, dt * E6, dt * E7
        error: State = (
            h1 * vx1 + h3 * vx3 + h4 * vx4 + h5 * vx5 + h6 * vx6 + h7 * vx7,
            h1 * vy1 + h3 * vy3 + h4 * vy4 + h5 * vy5 + h6 * vy6 + h7 * vy7,
            h1 * ax1 + h3 * ax3 + h4 * ax4 + h5 * ax5 + h6 * ax6 + h7 * ax7,
            h1 * ay1 + h3 * ay3 + h4 * ay4 + h5 * ay5 + h6 * ay6 + h7 * ay7,
            h1 * alpha1 + h3 * alpha3 + h4 * alpha4 + h5 * alpha5 + h6 * alpha6 + h7 * alpha7,
        )
        if rotates:
            error += (h1 * spin1 + h3 * spin3 + h4 * spin4 + h5 * spin5 + h6 * spin6 + h7 * spin7,)
        return end, last, error

    return step
