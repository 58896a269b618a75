"""What facts are computed from: how a ball was launched, its state at a moment, how far it went."""

from __future__ import annotations

from collections.abc import Callable
from math import atan2, degrees, hypot
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from sandbox.sport.amounts import amount
from sandbox.sport.facts import Fact, once
from sandbox.sport.flight import RPM

if TYPE_CHECKING:
    from sandbox.engine.run import Event, Run

Value = TypeVar("Value")


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
        return hypot(self.vx, self.vy)

    @property
    def descent(self) -> float:
        """Angle below the horizontal in deg, in whichever direction the ball flies."""
        return degrees(atan2(0.0 - self.vy, abs(self.vx)))


def words_of(run: Run, event: Event, several: bool = True) -> tuple[str, ...]:
    """An event for people: when, which ball if there are ``several``, what, with what, and how fast the two met."""
    speed = f"at {amount(run.closing_speed(event), 'm/s', 1)}" if event.kind == "impact" else ""
    return amount(event.t, "s"), *([event.ball] if several else []), event.kind, event.partner, speed


def at(moment: Callable[[Run, Any], Value | None], what: Callable[[Value], Any]) -> Callable[[Run, Any], Any]:
    """The function that reads a fact from a moment or whatever else was found; it gives None if nothing was."""

    def how(run: Run, parameters: Any) -> Any:
        found = moment(run, parameters)
        return None if found is None else what(found)

    return how


def before(run: Run, t: float) -> Moment:
    """The ball just before time t in s."""
    return Moment(t, *run.before("ball", t))


def passing(run: Run, x: float) -> Moment | None:
    """The ball as it first passes x (m) on its way forward."""
    return next((Moment(t, *state) for t, state in run.crossings("ball", (x, 0.0), (-1.0, 0.0))), None)


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


def _launched(what: Callable[[tuple[float, float], float], float]) -> Callable[[Run, Any], float]:
    def how(run: Run, parameters: Any) -> float:
        ball = run.setup.balls[0]  # before it touches anything, which it may do at once
        return what(ball.velocity, ball.spin)

    return how


BALL_SPEED = Fact("ball_speed", "ball speed", "m/s", _launched(lambda velocity, spin: hypot(*velocity)), "start")
LAUNCH_ANGLE = Fact(
    "launch_angle", "launch", "deg", _launched(lambda velocity, spin: degrees(atan2(velocity[1], velocity[0]))), "start"
)
LAUNCH_SPIN = Fact(
    "launch_spin", "spin", "rpm", _launched(lambda velocity, spin: spin / RPM), "start", sides=("topspin", "backspin")
)


@once
def landing(run: Run, parameters: Any) -> Moment | None:
    """The ball just before it first meets the ground."""
    return next((before(run, event.t) for event in run.events if event.partner == "ground"), None)


#: How far and how high it flew, and how it came down on the surface "ground".
DISTANCE = Fact("distance", "distance", "m", at(landing, lambda ball: ball.x), "ground", also="ft")
APEX = Fact("apex", "apex", "m", lambda run, parameters: run.highest("ball")[1][1], "ground", also="ft")
FLIGHT_TIME = Fact("flight_time", "flight time", "s", at(landing, lambda ball: ball.t), "ground")
LANDING_ANGLE = Fact("landing_angle", "comes down at", "deg", at(landing, lambda ball: ball.descent), "ground")
#: How the ball was launched, seen from the side.
LAUNCH = (BALL_SPEED, LAUNCH_ANGLE, LAUNCH_SPIN)
