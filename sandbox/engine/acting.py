"""What acts on a ball: its forces and torques, individually and summed, for one shot or for many at once."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import is_dataclass
from functools import cache
from math import isfinite
from typing import Any

from sandbox.engine.setup import Ball
from sandbox.engine.setup_errors import failed, is_from_inside
from sandbox.errors import RunError
from sandbox.physics.integrators import Acceleration, Law, State
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


#: A law as straight Python.
_LAW = """
  mass, inertia = ball.mass, ball.inertia
  def law(t, state):
    {place}
    try:
      {terms}
      fx, fy, turning = {sums}
    except (TypeError, ValueError, OverflowError) as error:
      if is_from_inside(error):
        raise
      raise refused(ball, t, state) from None
    if not isinstance(fx + fy + turning, float) and isinstance(spin, float):
      raise refused(ball, t, state)
    return fx / (mass{left}), fy / (mass{left}), turning / (inertia{left})
  return law
"""


def law_of(ball: Ball) -> Law:
    """The acceleration of a ball in flight from its forces and torques, in m/s^2 and rad/s^2, by time and state.

    It raises RunError if one of them returns anything but real numbers, or arrays for many shots.
    """
    written = _written_out(len(ball.forces), len(ball.torques), ball.turns, ball.loss is not None)
    law: Law = written(ball, *map(_quick, (*ball.forces, *ball.torques)))
    return law


@cache
def _written_out(forces: int, torques: int, turns: bool, loses: bool) -> Any:
    """What makes the law of a ball with so many forces and torques, which ``turns`` or ``loses`` mass."""
    on_the_way = "x, y, vx, vy, spin = state; position, velocity = (x, y), (vx, vy)"
    parts = {"fx": forces, "fy": forces, "turning": torques}
    terms = [f"fx{n}, fy{n} = force{n}(t, position, velocity, spin)" for n in range(forces)]
    terms += [f"turning{n} = torque{n}(t, position, velocity, spin)" for n in range(torques)]
    law = _LAW.format(
        place="position, velocity, spin = place(state), state[2:4], state[4]" if turns else on_the_way,
        terms="; ".join(terms) or "pass",
        sums=", ".join(" + ".join(["0.0", *(f"{part}{n}" for n in range(count))]) for part, count in parts.items()),
        left=" * ball.left(t)" if loses else "",
    )
    names = [*(f"force{n}" for n in range(forces)), *(f"torque{n}" for n in range(torques))]
    used = {"is_from_inside": is_from_inside, "place": _place, "refused": refused}
    return straight(f"law_of(ball, {', '.join(names)})", law.splitlines(), __file__, used)


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
