"""Readings of a run, from which facts are computed: the launch, a ball's state at a moment, its distance."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf, pi
from typing import TYPE_CHECKING, Any, NamedTuple

from sandbox.engine.model.setup import Touches, passes
from sandbox.engine.model.shapes import Vector
from sandbox.engine.motion.forces_on_ball import cause
from sandbox.physics.elementwise import atan2, degrees, hypot, minimum, rounded, where
from sandbox.sport.amounts import amount
from sandbox.sport.facts import Fact, cached_per_run
from sandbox.sport.flight import RPM

if TYPE_CHECKING:
    from sandbox.engine.paths.run import Event, Run
    from sandbox.physics.integrators import State


class Moment(NamedTuple):
    """A ball at one time, in s, m, m/s and rad/s."""

    t: float
    x: float
    y: float
    vx: float
    vy: float
    spin: float

    @property
    def speed(self) -> float:
        """In m/s."""
        found: float = hypot(self.vx, self.vy)
        return found

    @property
    def rpm(self) -> float:
        """Its spin."""
        return self.spin / RPM

    @property
    def direction(self) -> float:
        """Angle in deg of its velocity, counter-clockwise from +x."""
        found: float = degrees(atan2(self.vy, self.vx))
        return found

    @property
    def descent(self) -> float:
        """Angle below the horizontal in deg, in whichever direction the ball flies."""
        found: float = degrees(atan2(0.0 - self.vy, abs(self.vx)))
        return found


#: The names of everything that can be read from a moment.
MOMENT = (*Moment._fields, *(name for name, what in vars(Moment).items() if isinstance(what, property)))


def coefficient_at_start(force: str) -> Callable[[Run, Any], float | None]:
    """A fact: the coefficient of a force by its cause, such as "drag", as the first ball starts; None without air."""

    def coefficient(run: Run, parameters: Any) -> float | None:
        ball, air = run.setup.balls[0], parameters.air.air
        ux, uy = (v - wind for v, wind in zip(ball.velocity, air.wind, strict=True))
        pressure = 0.5 * air.density * pi * ball.radius**2 * (ux * ux + uy * uy)
        pulls = [each(0.0, ball.position, ball.velocity, ball.spin) for each in ball.forces if cause(each) == force]
        return sum(hypot(*pull) for pull in pulls) / pressure if pressure else None

    return coefficient


def words_of(run: Run, event: Event, several: bool = True) -> tuple[str, ...]:
    """An event for people: when, which ball if there are ``several``, what, with what, and how fast the two met; of two
    that move, the part of that speed along the normal too, if they met aslant."""
    speed = ""
    if event.kind == "impact":
        closing, normal = (amount(speed, "m/s", 1) for speed in (run.closing_speed(event), event.speed))
        speed = f"at {closing}" + (f", normal {normal}" if event.partner in run.arcs and normal != closing else "")
    return amount(event.t, "s"), *([event.ball] if several else []), event.kind, event.partner, speed


def fact_from(moment: Callable[[Run, Any], Any], what: str | Callable[[Any, Any], Any]) -> Callable[[Run, Any], Any]:
    """Return a function that reads a fact from what ``moment`` finds, None if that finds nothing: ``fact_from(landing,
    "speed")`` of a Moment, or ``fact_from(landing, lambda ball, parameters: ...)`` of anything."""
    if isinstance(what, str) and not hasattr(Moment, what):
        raise ValueError(f'fact_from(..., "{what}"): a Moment has {", ".join(MOMENT)}')

    def compute(run: Run, parameters: Any) -> Any:
        found = moment(run, parameters)
        if found is None:
            return None
        return getattr(found, what) if isinstance(what, str) else what(found, parameters)

    return compute


def before(run: Run, t: float, ball: str = "ball") -> Moment:
    """A ball just before time t in s."""
    return Moment(t, *run.before(ball, t))


def first_time(passages: Iterable[tuple[Any, State]], holds: Callable[[Any, State], Any]) -> Any:
    """The time in s of the first of these that ``holds(t, state)``; inf without one. Of many shots, arrays."""
    first: Any = inf
    for t, state in passages:
        first = minimum(where(holds(t, state), t, inf), first)
    return first


def of_each(found: Any, compute: Callable[[Any], Any]) -> Any:
    """``compute(found)`` of what a run has, such as a list; of an array of it for many shots, an array."""
    if not hasattr(found, "tolist"):
        return compute(found)
    import numpy as np

    return np.array([*map(compute, found.tolist())])


def down_to(run: Run, place: Vector, until: float = inf) -> Moment | None:
    """The ball as it first falls to the height of a place (m), or just before it touches something, if that is
    earlier; None if neither happens ``until`` a time in s."""
    falls = _moment(run.first_crossing("ball", place, (0.0, 1.0), until))
    return earlier(falls, _moment(run.before_meeting(before=until)))


def earlier(one: Moment | None, other: Moment | None) -> Moment | None:
    """The earlier of two moments, the first of equal ones; None if there is none."""
    if one is None or other is None:
        return other if one is None else one
    first = (one.t <= other.t) | (other.t != other.t)  # not a number: of many shots, one without that moment
    return Moment(*(where(first, a, b) for a, b in zip(one, other, strict=True)))


def _moment(found: tuple[float, State] | None) -> Moment | None:
    return None if found is None else Moment(found[0], *found[1])


def passing(run: Run, x: float, ball: str = "ball") -> Moment | None:
    """A ball as it first passes x (m) on its way forward."""
    return _moment(run.first_crossing(ball, (x, 0.0), (-1.0, 0.0)))


def passing_at(place: Callable[[Any], float]) -> Callable[[Run, Any], Moment | None]:
    """Return a function that finds the ball as it first passes the x (m) that the parameters say."""
    return cached_per_run(lambda run, parameters: passing(run, place(parameters)))


@dataclass(frozen=True)
class Passes(Touches):
    """Ends a run when the ball passes the line from ``a`` to ``b`` (m) to its right, or when ``what`` is touched."""

    a: Vector = (0.0, 0.0)
    b: Vector = (0.0, 0.0)

    def passed(self, start: State, end: State) -> Any:
        (x0, y0, *_), (x1, y1, *_) = start, end
        return passes(x0, y0, x1, y1, *self.a, *self.b)

    def line(self) -> tuple[Vector, Vector]:
        return self.a, self.b


def first_touch(run: Run) -> Event | None:
    """The first event in which the ball meets something."""
    return next((e for e in run.events if e.kind != "leave" and "ball" in (e.ball, e.partner)), None)


#: Gauss-Legendre: nodes and weights on an arc from 0 to 1.
_NODES = ((0.5 - 0.15**0.5, 5 / 18), (0.5, 8 / 18), (0.5 + 0.15**0.5, 5 / 18))


def travelled(run: Run, ball: str) -> float:
    """Length in m of a ball's path, from start to end."""
    return sum(
        (arc.t1 - arc.t0) * weight * hypot(*arc.state(arc.t0 + place * (arc.t1 - arc.t0))[2:4])
        for arc in run.arcs[ball]
        for place, weight in _NODES
    )


def start(run: Run, parameters: Any) -> Moment:
    """The first ball before it touches anything, which it may do at once."""
    ball = run.setup.balls[0]
    return Moment(0.0, *ball.position, *ball.velocity, ball.spin)


def first_contact_with(name: str) -> Callable[[Run, Any], Moment | None]:
    """Return a function that finds the ball just before it first touches the surface of that name."""

    return cached_per_run(lambda run, parameters: _moment(run.before_meeting(name)))


def apex(run: Run, parameters: Any) -> float:
    """Greatest height in m of the ball's centre."""
    return run.highest("ball")[1][1]


def _launch_value(what: str) -> Callable[[Run, Any], Any]:
    """Return a function that reads a value of the launch, as it was given: -28.8 deg, though its sine and cosine have
    lost the last digit of that."""
    return fact_from(start, lambda ball, parameters: rounded(getattr(ball, what), _DIGITS))


def whole_rpm(ball: Moment, parameters: Any) -> float:
    """Its spin, that out of the scene's plane included if the spin's axis is tilted."""
    return ball.rpm / (getattr(getattr(parameters, "launch", None), "spin_share", None) or 1.0)


#: Digits after the point that are left of a value that was converted to a velocity or rad/s and back.
_DIGITS = 10

BALL_SPEED = Fact("ball_speed", "ball speed", "m/s", _launch_value("speed"), "start")
LAUNCH_ANGLE = Fact("launch_angle", "launch", "deg", _launch_value("direction"), "start")
LAUNCH_SPIN = Fact(
    "launch_spin", "spin", "rpm", fact_from(start, lambda ball, it: round(whole_rpm(ball, it), _DIGITS)), "start",
    sides=("topspin", "backspin"),
)  # fmt: skip
#: The launch of the ball, seen from the side.
LAUNCH = (BALL_SPEED, LAUNCH_ANGLE, LAUNCH_SPIN)

landing = first_contact_with("ground")
#: Its distance, height and time of flight, and its landing on the surface "ground".
DISTANCE = Fact("distance", "distance", "m", fact_from(landing, "x"), "ground", also="ft")
APEX = Fact("apex", "apex", "m", apex, "ground", also="ft")
FLIGHT_TIME = Fact("flight_time", "flight time", "s", fact_from(landing, "t"), "ground")
LANDING_ANGLE = Fact("landing_angle", "comes down at", "deg", fact_from(landing, "descent"), "ground")
