"""Forces and torques on a ball, individually and summed, for one shot or for many at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import is_dataclass
from math import isfinite
from types import FunctionType, MethodType
from typing import Any, NamedTuple

from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup_errors import failed, is_from_inside
from sandbox.errors import RunError
from sandbox.physics.elementwise import of_floats
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay, Wind, in_wind, through_air
from sandbox.physics.integrators import Acceleration, AccelerationFunction, State
from sandbox.tracebacks import defined_at

#: Everyday names of causes.
_CALLED = {"magnus": "lift", "bullet drag": "drag"}


class Turned(tuple[Any, Any]):
    """The position of a body, (x, y) in m, with its orientation."""

    angle: float  # rad


def _position(state: State) -> tuple[Any, Any]:
    """Return the position in m, as forces take it: that of a body has its angle."""
    if len(state) == 5:
        return state[0], state[1]
    position = Turned(state[:2])
    position.angle = state[5]
    return position


def acceleration_function(ball: Ball, floats: bool = True) -> AccelerationFunction:
    """Return the acceleration of a ball in flight from its forces and torques, in m/s^2 and rad/s^2, by time and state:
    of ``floats``, or of arrays for many shots.

    It raises RunError if one of them returns anything but real numbers, or arrays for many shots.
    """
    mass, inertia = ball.mass, ball.inertia
    rotates, loses_mass = ball.rotates, ball.loss is not None
    together, wind = _in_one_wind(ball)
    drag, lift = (None if term is None else term.row for term in together[:2])
    decay = None if together.decay is None else together.decay.row
    constant_x = constant_y = 0.0
    forces, torques = [], [_called(torque, floats) for torque in ball.torques if torque is not together.decay]
    for force in ball.forces:
        if _is_constant(force):
            gx, gy = force(0.0, (0.0, 0.0), (0.0, 0.0), 0.0)
            constant_x, constant_y = constant_x + gx, constant_y + gy
        elif force is not together.drag and force is not together.lift:
            forces.append(_called(force, floats))
    in_air, in_this_air = drag is not None or lift is not None or decay is not None, through_air
    if floats:
        in_this_air = of_floats(through_air)
        drag, lift = (None if row is None else row._replace(law=of_floats(row.law)) for row in (drag, lift))
        wind = None if wind is None else _called(wind, floats)

    def acceleration(t: Any, state: State) -> Acceleration:
        try:
            x, y, vx, vy, spin = state[:5] if rotates else state
            if not in_air:
                fx, fy, torque = constant_x, constant_y, 0.0
            elif wind is None:
                fx, fy, torque = in_this_air(drag, lift, decay, vx, vy, spin, constant_x, constant_y)
            else:
                ux, uy = in_wind(wind, t, (x, y), (vx, vy))
                fx, fy, torque = in_this_air(drag, lift, decay, ux, uy, spin, constant_x, constant_y)
            if forces or torques:
                position, velocity = _position(state) if rotates else (x, y), (vx, vy)
                for force in forces:
                    gx, gy = force(t, position, velocity, spin)
                    fx, fy = fx + gx, fy + gy
                for turning in torques:
                    torque = torque + turning(t, position, velocity, spin)
            if not isinstance(fx + fy + torque, float) and isinstance(spin, float):
                raise force_error(ball, t, state)
            if loses_mass:
                left = ball.mass_fraction(t)
                return fx / (mass * left), fy / (mass * left), torque / (inertia * left)
            return fx / mass, fy / mass, torque / inertia
        except (TypeError, ValueError, OverflowError) as error:
            if is_from_inside(error):
                raise
            raise force_error(ball, t, state) from None

    return acceleration


class _Together(NamedTuple):
    """Drag, lift and spin decay in one wind."""

    drag: Drag | None
    lift: Magnus | None
    decay: SpinDecay | None


def _in_one_wind(ball: Ball) -> tuple[_Together, Wind | None]:
    """The drag, lift and spin decay of a ball that are in one wind, and so are computed together; and the wind. They
    come first of all that is not constant, in this order: the sum of all is the same, to its last digit."""
    drag = lift = decay = None
    winds: list[Wind | None] = []
    forces: list[Any] = [] if ball.rotates else [force for force in ball.forces if not _is_constant(force)]
    torques: list[Any] = [] if ball.rotates else [*ball.torques]
    if forces and type(forces[0]) is Drag:
        winds.append(forces[0].wind)
        drag = forces.pop(0)
    if forces and type(forces[0]) is Magnus:
        wind = None if forces[0].along_ground else forces[0].wind
        if not winds or winds[0] is wind:
            lift = forces[0]
            winds.append(wind)
    if torques and type(torques[0]) is SpinDecay and (not winds or winds[0] is torques[0].wind):
        winds.append(torques[0].wind)
        decay = torques[0]
    return _Together(drag, lift, decay), winds[0] if winds else None


def _called(term: Any, floats: bool) -> Any:
    """Return a force, torque or wind as Python calls it fastest: the ``__call__`` of one that is data, bound to it, for
    ``floats`` or also for arrays."""
    if not callable(term) or not is_dataclass(type(term)):
        return term
    called = type(term).__call__
    return MethodType(of_floats(called), term) if floats and isinstance(called, FunctionType) else term.__call__


def _is_constant(force: Any) -> bool:
    """True for plain gravity, which is evaluated once; a scene's own kind of Gravity may not be constant."""
    return type(force) is Gravity and force.is_constant


def force_error(
    ball: Ball, t: float, state: State, otherwise: str = "the sum of its forces and torques is not a real number"
) -> RunError:
    """Return an error that names the force or torque that does not return finite numbers in this state; or, if all do,
    says what is wrong ``otherwise``."""
    return failed(t, ball.name, wrong_term(ball, t, state) or otherwise)


def refuse_unrepeatable(ball: Ball, t: float, state: State) -> None:
    """Raise RunError for a force or torque of a scene's own that returns something else when it is called again."""
    for term in (*ball.forces, *ball.torques):
        if not type(term).__module__.startswith("sandbox."):
            try:
                wrong = _differing(term, t, _position(state), state[2:4], state[4])
            except Exception:  # which the run meets, and reports
                continue
            if wrong is not None:
                raise failed(t, ball.name, wrong)


def _differing(term: Any, *arguments: Any) -> str | None:
    """Describe a force or torque that returns something else when it is called again; None if it does not."""
    first, again = (" ".join(repr(term(*arguments)).split()) for _ in range(2))
    if first == again:
        return None
    rule = "it must depend on nothing but (t, position, velocity, spin)"
    return f"{_name(term)}, called twice with the same, returned {first:.40} and {again:.40}: {rule}{defined_at(term)}"


def by_cause(terms: Sequence[Any], t: float, state: State) -> Iterator[tuple[str, Any]]:
    """The name and value of each force or torque: (fx, fy) in N, or N m."""
    arguments = _position(state), state[2:4], state[4]
    for term in terms:
        yield cause(term), term(t, *arguments)


def cause(term: object) -> str:
    """Display name of a force or torque: ``SpinDecay`` is "spin decay"; a function keeps its own name."""
    words = "".join(f" {c.lower()}" if c.isupper() else c for c in _name(term)).replace("_", " ").strip()
    return _CALLED.get(words, words)


def wrong_term(ball: Ball, t: float, state: State) -> str | None:
    """Describe the force or torque on a ball that does not return finite numbers, the same ones; None if all do."""
    arguments = _position(state), state[2:4], state[4]
    for term, parts in (*((force, 2) for force in ball.forces), *((torque, 0) for torque in ball.torques)):
        try:
            found: Any = term(t, *arguments)
            several = isinstance(found, tuple | list) or getattr(found, "shape", ()) != ()
            right = all(map(_is_finite, found if several else (found,))) and parts == (several and len(found))
        except (TypeError, ValueError, OverflowError) as error:
            return f"{_rule(term)}: {error}{defined_at(term)}"
        if not right:
            return f"{_rule(term)}, and returned {' '.join(repr(found).split()):.60}{defined_at(term)}"
        if (wrong := _differing(term, t, *arguments)) is not None:
            return wrong
    return None


def _is_finite(part: Any) -> bool:
    part = part.item() if getattr(part, "shape", None) == () else part
    return isinstance(part, int | float) and isfinite(part)


def _name(term: object) -> str:
    return str(getattr(term, "__name__", type(term).__name__))


def _rule(term: object) -> str:
    """Say how a force or torque is called and what it must return, as part of an error message."""
    return (
        f"{_name(term)} is called with (t, position, velocity, spin) and must return (fx, fy) in N, a torque one "
        "number in N m"
    )
