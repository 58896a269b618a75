"""A ball that is played over a net: the net and court in its way, its landing, and the outcome.

x = 0 is the player's own end line, the net stands in the middle, and y = 0 is the court.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from sandbox.engine.model.bounce_laws import CourtBounce
from sandbox.engine.model.setup import Rule, Until
from sandbox.engine.model.surface import Segment, Surface
from sandbox.engine.paths.run import Event, Run
from sandbox.parameters import Group, group, quantity
from sandbox.sport.amounts import roughly
from sandbox.sport.controls import Handle
from sandbox.sport.facts import Fact, cached_per_run
from sandbox.sport.flight import Flight
from sandbox.sport.readings import Moment, apex, before, fact_from, passing_at
from sandbox.sport.solids import Solid


class Net(Solid):
    """The net across the middle of the court."""

    height: float = quantity(..., "m", 0.05, 10, "of its upper edge above the court")
    depth: float = quantity(..., "m", 0.05, 5, "from its upper to its lower edge")


class Court(Group):
    """The court and its ground."""

    length: float = quantity(..., "m", 1, 200, "from end line to end line")
    restitution: float = quantity(..., "", 0, 1, "of ball and court")
    friction: float = quantity(..., "", 0, 10, "of ball and court")


class NetGame(Flight):
    """Parameters of a ball that is played over a net; a sport adds its own."""

    net: Net = group(..., "the net")
    court: Court = group(..., "the court")

    @property
    def middle(self) -> float:
        """The position of the net, in m."""
        return 0.5 * self.court.length

    @property
    def limit(self) -> tuple[float, str]:
        """The distances from the player's own end line within which the ball may land, in m, and what is there."""
        return self.court.length, "end line"


class HardCourt(Court):
    """Ground as hard as a tennis court; ``restitution`` is for a ball that arrives at 16 deg."""

    slope: float = quantity(..., "", 0, 0.01, "restitution less for each degree that the ball arrives at steeper")
    tangential: float = quantity(..., "", 0, 1, "share of the slip that is reversed if the ball grips")

    @property
    def bounce(self) -> CourtBounce:
        """The response of the court to an impact."""
        return CourtBounce(self.restitution, self.friction, self.slope, self.tangential)


#: The parts of net and court that can be dragged.
HANDLES = (
    Handle(y="net.height", at=lambda parameters: (parameters.middle, parameters.net.height)),
    Handle("court.length", goal=True),
)


def net_of(parameters: NetGame) -> Surface:
    """The net, as a thing to hit."""
    net, middle = parameters.net, parameters.middle
    return net.surface("net", Segment((middle, max(0.0, net.height - net.depth)), (middle, net.height), 0.01))


def _bounces(events: Sequence[Event]) -> list[Event]:
    """Impacts on anything but the net."""
    return [event for event in events if event.kind == "impact" and event.partner != "net"]


@dataclass(frozen=True)
class Bounces(Until):
    """Over when the ball has bounced so many times."""

    times: int = 1

    def rules(self) -> Sequence[Rule]:
        return [Rule(times=self.times, but=("net",), bounces=True)]


def is_down(parameters: Any) -> Until:
    """The condition at which the facts of the flight are final: the ball has come down."""
    return Bounces()


@cached_per_run
def landing(run: Run, parameters: Any) -> Moment | None:
    """The ball just before it comes down."""
    return next((before(run, event.t) for event in _bounces(run.events)), None)


def rebound(run: Run, parameters: Any) -> Moment | None:
    """The ball just after it came down."""
    return next((Moment(event.t, *run.state("ball", event.t)) for event in _bounces(run.events)), None)


#: The ball as it passes the far end line; as it passes the net; and the gap in m between the two there, negative if it
#: passes below the upper edge.
_at_baseline, _at_net = passing_at(lambda it: it.court.length), passing_at(lambda it: it.middle)
_net_clearance = fact_from(_at_net, lambda ball, it: ball.y - it.ball.radius - it.net.height)


def received_at(run: Run, parameters: Any) -> float:
    """The time in s at which the other player receives the ball: a little beyond the end line; the run's end if it does
    not get there, or only comes down beyond it."""
    passed, landed = _at_baseline(run, parameters), landing(run, parameters)
    if passed is None or landed is None or landed.t > passed.t:
        return run.duration
    return min(run.duration, passed.t + 0.15)


def outcome(run: Run, parameters: Any) -> str:
    """The outcome in a word: in; long, beyond the limit; net, into or under it; short, on the player's own side; gone,
    never down."""
    landed, gap = landing(run, parameters), _net_clearance(run, parameters)
    if landed is None:
        return "gone"
    if landed.x < parameters.middle:
        return "net" if any(event.partner == "net" and event.t < landed.t for event in run.events) else "short"
    if gap is None or gap < -parameters.ball.radius:
        return "net"
    return "in" if landed.x <= parameters.limit[0] else "long"


#: The outcome, and the flight until then.
FACTS = (
    Fact("in", "", "", lambda run, parameters: outcome(run, parameters) == "in", is_down),
    Fact("verdict", "", "", outcome, is_down),
    Fact("net_clearance", "over the net", "m", _net_clearance, is_down),
    Fact("landing", "landing", "m", fact_from(landing, "x"), is_down),
    Fact("landing_speed", "landing speed", "m/s", fact_from(landing, "speed"), is_down, also="km/h"),
    Fact("apex", "apex", "m", apex, is_down),
    Fact("flight_time", "flight time", "s", fact_from(landing, "t"), is_down),
)


def _speed_kept(run: Run, parameters: Any) -> float | None:
    """Speed along the court after the bounce over that before it."""
    down, up = landing(run, parameters), rebound(run, parameters)
    return up.vx / down.vx if down is not None and up is not None and down.vx else None


#: The ball after the bounce, in a game in which it is played after that.
BOUNCE_FACTS = (
    Fact("landing_angle", "", "deg", fact_from(landing, "descent"), is_down),
    Fact("bounce_speed", "after the bounce", "m/s", fact_from(rebound, "speed"), is_down),
    Fact("bounce_angle", "rises at", "deg", fact_from(rebound, lambda ball, _: -ball.descent), is_down),
    Fact("bounce_spin", "", "rpm", fact_from(rebound, "rpm"), is_down),
    Fact("speed_kept", "", "", _speed_kept, is_down),
    Fact("baseline_speed", "", "m/s", fact_from(_at_baseline, "speed")),
)


def verdict(run: Run, parameters: Any) -> str:
    """Return the outcome in a sentence."""
    word, landed, (limit, line) = outcome(run, parameters), landing(run, parameters), parameters.limit
    if landed is None:
        return "Did not come down"
    if word == "in":
        return f"In, {roughly(limit - landed.x)} before the {line}"
    if word == "long":
        return f"Out, {roughly(landed.x - limit)} beyond the {line}"
    if word == "short":
        return f"Comes down on its own side, {roughly(abs(parameters.middle - landed.x))} from the net"
    return "Into the net"
