"""Laws of force and bounce by numbers: each term is a row, which begins with the code of its kind.

What the objects of ``physics/forces.py`` and ``model/bounce_laws.py`` compute with their fields is computed here with
rows, by the same functions, in what both Python and numba take. A row of a force or torque has the places below; which
of them its kind uses is said there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import sqrt
from types import FunctionType

from sandbox.engine.model.bounce_laws import bounce_of_court, bounce_of_turf
from sandbox.physics import ballistics, coefficients
from sandbox.physics.air import log_profile
from sandbox.physics.coefficients import Laws
from sandbox.physics.elementwise import of_floats, remade
from sandbox.physics.forces import ALMOST_ZERO, drag_rate, lift_rate
from sandbox.physics.integrators import Acceleration, State
from sandbox.physics.net import net_force, net_hold

Row = Sequence[float]

#: Kinds of forces and torques. STEADY: a force of (A, B) N. DRAG and LIFT: half the density times the area, A in kg/m.
#: DECAY: of the spin, A in kg m. NET: the rate A in kg/s, and its place and size, B to E in m. BULLET: the rate A in
#: kg/m, the speed of sound B in m/s, and the place C of its shape.
STEADY, DRAG, LIFT, DECAY, NET, BULLET = range(6)

#: Places in such a row: its kind, numbers of the kind; the coefficient of a drag or lift by its code, its own number,
#: its share, and the share of the whole spin that the ball has; the wind by its kind, and its numbers.
_KIND, A, B, C, D, E, REYNOLDS, RADIUS, LAW, VALUE, _SHARE, _OF_SPIN, WIND, _WIND_X, _WIND_Y, _ROUGHNESS, _CEILING = (
    range(17)
)
FORCE_COLUMNS = _CEILING + 1

#: Kinds of wind: none, the same everywhere, the logarithmic profile.
CALM, EVEN, PROFILE = range(3)

#: Codes of coefficients that have a number of their own, VALUE; those of COEFFICIENTS have their place in it.
CONSTANT, NATHAN = -1, -2

#: Coefficients that are functions of Reynolds number and spin ratio alone, in a fixed order.
COEFFICIENTS: tuple[FunctionType, ...] = tuple(
    dict.fromkeys(
        law
        for laws in vars(coefficients).values()
        if isinstance(laws, Laws)
        for law in laws.values()
        if isinstance(law, FunctionType) and law.__module__ == coefficients.__name__  # not what a scene has added
    )
)

#: Places in the row of a ball.
MASS, BALL_RADIUS, FACTOR, INERTIA = range(4)

#: Codes of contact laws: restitution and friction as they are, grass, a court. Each has four numbers.
PLAIN, TURF, COURT = range(3)


def _by_code(first: int, count: int) -> Callable[[float, float, float], float]:
    """Return the function that computes one of so many coefficients from the ``first`` on, by its code: halving, so
    that what numba compiles is not nested deeply."""
    if count == 1:
        law = of_floats(COEFFICIENTS[first])

        def coefficient(which: float, reynolds: float, spin_ratio: float) -> float:
            return float(law(reynolds, spin_ratio))

        return coefficient
    middle = first + count // 2
    low, high = _by_code(first, count // 2), _by_code(middle, count - count // 2)

    def choose(which: float, reynolds: float, spin_ratio: float) -> float:
        return low(which, reynolds, spin_ratio) if which < middle else high(which, reynolds, spin_ratio)

    return choose


_of_code = _by_code(0, len(COEFFICIENTS))
_profile, _hold, _force_of_net = of_floats(log_profile), of_floats(net_hold), of_floats(net_force)


def _place_in(machs: Sequence[float], mach: float) -> int:
    """As ``bisect_right``."""
    low, high = 0, len(machs)
    while low < high:
        middle = (low + high) // 2
        if mach < machs[middle]:
            high = middle
        else:
            low = middle + 1
    return low


def _by_mach(shape: str) -> Callable[[float], float]:
    """Return the drag coefficient of a standard shape, by its Mach number."""
    table = ballistics.drag_table(shape)
    machs, cubics = tuple(table[0]), tuple(table[1])
    value = of_floats(remade(ballistics.of_table, {ballistics.place_in: _place_in}))

    def coefficient(mach: float) -> float:
        return float(value(machs, cubics, mach))

    return coefficient


_g1, _g7, _sphere = map(_by_mach, ballistics.SHAPES)


def _drag_by_mach(shape: float, mach: float) -> float:
    """The drag coefficient of the standard shape in this place."""
    if shape == 0.0:
        return _g1(mach)
    return _g7(mach) if shape == 1.0 else _sphere(mach)


def coefficient(row: Row, reynolds: float, spin_ratio: float) -> float:
    """The drag or lift coefficient of a row."""
    law = row[LAW]
    if law == CONSTANT:
        return row[VALUE]
    ratio = spin_ratio / row[_OF_SPIN]
    value = coefficients.nathan_drag(reynolds, ratio, row[VALUE]) if law == NATHAN else _of_code(law, reynolds, ratio)
    return row[_SHARE] * value


def _velocity_in_air(row: Row, y: float, vx: float, vy: float) -> tuple[float, float]:
    """Velocity relative to the air of a ball at a height y (m), in m/s."""
    wind = row[WIND]
    if wind == CALM:
        return vx, vy
    if wind == EVEN:
        return vx - row[_WIND_X], vy - row[_WIND_Y]
    profile = _profile(y, row[_ROUGHNESS], row[_CEILING])
    return vx - row[_WIND_X] * profile, vy - row[_WIND_Y] * profile


def acceleration(t: float, state: State, ball: Row, forces: Sequence[Row]) -> Acceleration:
    """As ``acceleration_function``: in m/s^2 and rad/s^2, of the forces and torques in these rows."""
    x, y, vx, vy, spin = state
    fx, fy, torque = 0.0, 0.0, 0.0
    for i in range(len(forces)):
        row = forces[i]
        kind = row[_KIND]
        if kind == STEADY:
            fx, fy = fx + row[A], fy + row[B]
        elif kind == NET:
            gx, gy = _force_of_net(row[A] * _hold(x, y, row[B], row[C], row[D], row[E]), vx, vy)
            fx, fy = fx + gx, fy + gy
        else:
            ux, uy = _velocity_in_air(row, y, vx, vy)
            speed = sqrt(ux * ux + uy * uy)
            if kind == DECAY:
                torque = torque - row[A] * speed * spin
            elif kind == BULLET:
                k = drag_rate(row[A], _drag_by_mach(row[C], speed / row[B]), speed)
                fx, fy = fx + k * ux, fy + k * uy
            else:
                ratio = row[RADIUS] * abs(spin) / (speed + ALMOST_ZERO)
                value = coefficient(row, row[REYNOLDS] * speed, ratio)
                if kind == DRAG:
                    k = drag_rate(row[A], value, speed)
                    fx, fy = fx + k * ux, fy + k * uy
                else:
                    k = lift_rate(row[A], value, speed, row[RADIUS], spin)
                    fx, fy = fx - k * uy, fy + k * ux
    return fx / ball[MASS], fy / ball[MASS], torque / ball[INERTIA]


def bounce(
    law: float, normal_speed: float, tangential_speed: float, a: float, b: float, c: float, d: float
) -> tuple[float, float, float, float]:
    """Restitution, friction, tilt in rad and tangential restitution of an impact, by the code of a contact law and its
    numbers."""
    if law == TURF:
        return bounce_of_turf(normal_speed, tangential_speed, a, b, c)
    if law == COURT:
        return bounce_of_court(normal_speed, tangential_speed, a, b, c, d)
    return a, b, 0.0, 0.0
