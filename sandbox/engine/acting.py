"""What acts on a ball: its forces and torques, individually and summed, for one shot or for many at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import is_dataclass
from math import isfinite
from typing import Any

from sandbox.engine.setup import Ball
from sandbox.engine.setup_errors import is_from_inside
from sandbox.errors import RunError
from sandbox.physics.integrators import Acceleration, Law, State

#: Everyday names of causes.
CALLED = {"magnus": "lift", "bullet drag": "drag"}


class Turned(tuple[Any, Any]):
    """The position of a body, (x, y) in m, which also says how far it is turned."""

    angle: float  # rad


def _place(state: State) -> tuple[Any, ...]:
    """The position, as forces take it."""
    if len(state) == 5:
        return state[:2]
    position = Turned(state[:2])
    position.angle = state[5]
    return position


def law_of(ball: Ball) -> Law:
    """The acceleration of a ball in flight from its forces and torques, in m/s^2 and rad/s^2, by time and state.

    It raises RunError if one of them returns anything but real numbers, or arrays for many shots.
    """
    forces, torques = (list(map(_quick, terms)) for terms in (ball.forces, ball.torques))
    mass, inertia, loss = ball.mass, ball.inertia, ball.loss

    def law(t: Any, state: State) -> Acceleration:
        position: tuple[Any, ...]
        if len(state) == 5:  # as _place does, where it must be fast
            x, y, vx, vy, spin = state
            position, velocity = (x, y), (vx, vy)
        else:
            position, velocity, spin = _place(state), state[2:4], state[4]
        fx = fy = torque = 0.0
        term: Any = None
        try:
            for term in forces:
                px, py = term(t, position, velocity, spin)
                fx = fx + px
                fy = fy + py
            for term in torques:
                torque = torque + term(t, position, velocity, spin)
        except (TypeError, ValueError, OverflowError) as error:
            if is_from_inside(error):
                raise
            raise RunError(f"{_rule(term)}: {error}") from None
        if not isinstance(fx + fy + torque, float) and isinstance(spin, float):
            wrong = wrong_term(ball, t, state) or "the sum of its forces and torques is not a real number"
            raise RunError(f"t = {t:.6g} s, ball {ball.name!r}: {wrong}")
        if loss is None:
            return fx / mass, fy / mass, torque / inertia
        left = ball.left(t)
        return fx / (mass * left), fy / (mass * left), torque / (inertia * left)

    return law


def _quick(term: Any) -> Any:
    """A force or torque as what Python calls with the least effort: its ``__call__``, bound, if it is data."""
    return term.__call__ if is_dataclass(type(term)) and callable(term) else term


def acceleration(ball: Ball, t: Any, state: State) -> Acceleration:
    """The same at one time, in one state."""
    return law_of(ball)(t, state)


def by_cause(terms: Sequence[Any], t: float, state: State) -> Iterator[tuple[str, Any]]:
    """The name and value of each force or torque: (fx, fy) in N, or N m."""
    arguments = _place(state), state[2:4], state[4]
    for term in terms:
        yield cause(term), term(t, *arguments)


def cause(term: object) -> str:
    """Display name of a force or torque: ``SpinDecay`` is "spin decay"; a function keeps its own name."""
    words = "".join(f" {c.lower()}" if c.isupper() else c for c in _name(term)).replace("_", " ").strip()
    return CALLED.get(words, words)


def wrong_term(ball: Ball, t: float, state: State) -> str | None:
    """What a force or torque on a ball returns in place of finite numbers; None if all return those."""
    arguments = _place(state), state[2:4], state[4]
    for term in (*ball.forces, *ball.torques):
        found = term(t, *arguments)
        several = isinstance(found, tuple | list) or getattr(found, "shape", ()) != ()
        if not all(map(_is_finite, found if several else (found,))):
            return f"{_rule(term)}, and returned {' '.join(repr(found).split()):.60}"
    return None


def _is_finite(part: Any) -> bool:
    part = part.item() if getattr(part, "shape", None) == () else part
    return isinstance(part, int | float) and isfinite(part)


def _name(term: Any) -> str:
    if getattr(term, "__name__", "") == "__call__":
        term = term.__self__
    return str(getattr(term, "__name__", type(term).__name__))


def _rule(term: object) -> str:
    """How a force or torque is called and what it must return, as part of an error message."""
    return (
        f"{_name(term)} is called with (t, position, velocity, spin) and must return (fx, fy) in N, a torque one "
        "number in N m"
    )
