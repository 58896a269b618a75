"""What acts on a ball: its forces and torques, individually and summed, for one shot or for many at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import is_dataclass
from functools import cache
from itertools import chain
from math import isfinite
from types import NoneType
from typing import Any

from sandbox.engine.setup import Ball
from sandbox.engine.setup_errors import failed, is_from_inside
from sandbox.errors import RunError
from sandbox.physics.air import UniformWind
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
from sandbox.physics.integrators import COMPONENTS, Acceleration, Integrator, Law, Method, State, Written
from sandbox.physics.straight import straight

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
    law: Law = _law(*_kind(ball))(*_given(ball))
    return law


def step_of(ball: Ball, integrator: Integrator) -> Method:
    """One step of a ball in flight under that law."""
    return integrator.written(_written(*_kind(ball)), ball.turns)(*_given(ball))


def _kind(ball: Ball) -> tuple[tuple[bool, ...], int, bool, bool, bool]:
    """What its law, as written, depends on."""
    placed = ball.turns or not all(map(_is_uniform, (*ball.forces, *ball.torques)))
    return tuple(map(_is_steady, ball.forces)), len(ball.torques), ball.turns, ball.loss is not None, placed


def _is_steady(force: Any) -> bool:
    """Whether it is the same always, and is asked for once; a kind of Gravity of a scene's own may not be."""
    return type(force) is Gravity and force.loss is None


def _is_uniform(term: Any) -> bool:
    """Whether it is known to be the same at any place."""
    ours = type(term) in (Gravity, Drag, Magnus, SpinDecay)  # first: a scene's own may have any ``wind``
    return ours and type(getattr(term, "wind", None)) in (NoneType, UniformWind)


def _given(ball: Ball) -> Iterator[Any]:
    return chain((ball, is_from_inside, _place, refused), map(_quick, ball.forces), map(_quick, ball.torques))


@cache
def _law(*kind: Any) -> Any:
    """What makes the law of such a ball."""
    law, names = _written(*kind), ", ".join(COMPONENTS[kind[2]])
    lines = [line.format(n="", state=names) for line in law.lines]
    body = [f"{names} = state", "try:", *(f"  {line}" for line in lines), *law.otherwise, "return ax, ay, alpha"]
    makes = [*law.before, "def law(at, state):", *(f"  {line}" for line in body), "return law"]
    return straight(f"law_of({law.given})", makes, __file__)


@cache
def _written(steady: Sequence[bool], torques: int, turns: bool, loses: bool, placed: bool) -> Written:
    """The law of a ball with forces that are ``steady`` or not, and so many torques, which ``turns`` or ``loses``
    mass; if they are the same at any place, they are called with the state at the start in place of a position."""
    forces = [(f"fx{n}, fy{n}", f"force{n}") for n in range(len(steady))]
    turns_by = [(f"turning{n}", f"torque{n}") for n in range(torques)]
    once = [force for force, same in zip(forces, steady, strict=True) if same]
    anew = [force for force in (*forces, *turns_by) if force not in once]
    parts = {"fx": len(forces), "fy": len(forces)} | ({"turning": torques} if torques else {})
    sums = [" + ".join(["0.0", *(f"{part}{n}" for n in range(count))]) for part, count in parts.items()]
    place = "place(({state}))" if turns else "(x{n}, y{n})" if placed else "state"
    now = "(*position, *velocity, spin, position.angle)" if turns else "(*position[:2], *velocity, spin)"
    left = " * ball.left(at)" if loses else ""
    return Written(
        ", ".join(("ball", "is_from_inside", "place", "refused", *(name for _, name in (*forces, *turns_by)))),
        (
            "mass, inertia = ball.mass, ball.inertia",
            *(f"{made} = {name}(0.0, (0.0, 0.0), (0.0, 0.0), 0.0)" for made, name in once),
        ),
        (
            f"position, velocity, spin = {place}, (vx{{n}}, vy{{n}}), spin{{n}}",
            *(f"{made} = {name}(at, position, velocity, spin)" for made, name in anew),
            f"{', '.join(parts)} = {', '.join(sums)}",
            f"if not isinstance({' + '.join(parts)}, float) and isinstance(spin, float):",
            f"  raise refused(ball, at, {now})",
            f"ax{{n}}, ay{{n}} = fx / (mass{left}), fy / (mass{left})",
            f"alpha{{n}} = {f'turning / (inertia{left})' if torques else '0.0'}",
        ),
        (
            "except (TypeError, ValueError, OverflowError) as error:",
            "  if is_from_inside(error):",
            "    raise",
            f"  raise refused(ball, at, {now}) from None",
        ),
        turning=torques > 0,
        placed=placed,
    )


def _quick(term: Any) -> Any:
    """A force or torque in the form that Python calls fastest: its bound ``__call__`` if it is data."""
    return term.__call__ if is_dataclass(type(term)) and callable(term) else term


def refused(
    ball: Ball, t: float, state: State, otherwise: str = "the sum of its forces and torques is not a real number"
) -> RunError:
    """An error that names the force or torque that does not return finite numbers in this state; or, if all do, says
    what is wrong ``otherwise``."""
    return failed(t, ball.name, _wrong_term(ball, t, state) or otherwise)


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


def _wrong_term(ball: Ball, t: float, state: State) -> str | None:
    """What a force or torque on a ball returns in place of finite numbers; None if all return those."""
    arguments = _place(state), state[2:4], state[4]
    for term, parts in (*((force, 2) for force in ball.forces), *((torque, 0) for torque in ball.torques)):
        try:
            found: Any = term(t, *arguments)
            several = isinstance(found, tuple | list) or getattr(found, "shape", ()) != ()
            right = all(map(_is_finite, found if several else (found,))) and parts == (several and len(found))
        except (TypeError, ValueError, OverflowError) as error:
            return f"{_rule(term)}: {error}"
        if not right:
            return f"{_rule(term)}, and returned {' '.join(repr(found).split()):.60}"
    return None


def _is_finite(part: Any) -> bool:
    part = part.item() if getattr(part, "shape", None) == () else part
    return isinstance(part, int | float) and isfinite(part)


def _name(term: object) -> str:
    return str(getattr(term, "__name__", type(term).__name__))


def _rule(term: object) -> str:
    """How a force or torque is called and what it must return, as part of an error message."""
    return (
        f"{_name(term)} is called with (t, position, velocity, spin) and must return (fx, fy) in N, a torque one "
        "number in N m"
    )
