"""Baseball from the side: a ball off the bat, over the fence or not.

Models: gravity; drag that grows with spin and Magnus lift, as fitted to tracked fly balls; spin about an upright axis,
too, which costs distance; loss of spin; the air by weather and height above the sea; a bat that recoils, and that the
ball grips.
Leaves out: what the bend of the path by sidespin takes of the distance (1 ft of an average ball's, 6 ft with 2,500
rpm); foul balls; the sidespin that a bat gives; fielders; the fence as a thing to hit, for the distance is that to
where the ball would come down.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import replace
from math import inf
from typing import Any, Literal

from sandbox.kit import (
    APEX,
    BALL_SPEED,
    DISTANCE,
    ENDED,
    FLIGHT_TIME,
    LANDING_ANGLE,
    LAUNCH_ANGLE,
    LAUNCH_SPIN,
    RPM,
    SOLID_SPHERE,
    Air,
    Ball,
    Coefficient,
    Controls,
    Fact,
    Flight,
    Group,
    Handle,
    Release,
    Run,
    SceneRun,
    Setup,
    Sphere,
    Spin,
    Surface,
    Touches,
    Weather,
    choice,
    fact_from,
    group,
    level,
    passing_at,
    quantity,
    roughly,
    where,
)
from sandbox.physics.coefficients import BASEBALL_DRAG, BASEBALL_LIFT, NathanDrag
from sandbox.sport.air import Model
from sandbox.sport.readings import landing
from sandbox.sport.sideways import Crosswind, GroundPlace, SidewaysLaunch, ground_track, side
from sandbox.sport.swing import Bat, struck_by


class BaseballDrag(Model):
    """Drag that grows with the spin."""

    LAWS = BASEBALL_DRAG

    def coefficient_in(self, air: Air, ball: Sphere) -> Coefficient:
        law = self.LAWS[self.model]
        if isinstance(law, NathanDrag):
            return NathanDrag(air.viscosity / (2.0 * ball.radius**2 * air.density * RPM))
        return law


class Baseball(Sphere, drag=BaseballDrag, lift=BASEBALL_LIFT):
    """The ball."""

    INERTIA = SOLID_SPHERE
    spin_decay: float = quantity(..., "", 0, 0.01, "k of dw/dt = -k |u| w / r")

    def decay_in(self, air: Air) -> float:
        return self.spin_decay


class BaseballAir(Weather, Air):
    """The air that a baseball flies through."""


class BaseballFlight(Flight):
    """Parameters of a baseball in the air; x = 0 is the plate of a hit, and the hand of a pitch."""

    release: Release = group(..., "where the ball leaves bat or hand")
    air: BaseballAir = group(..., "the air")
    ball: Baseball = group(..., "the ball")


class BattedBall(SidewaysLaunch):
    """The ball as it leaves the bat."""

    sidespin: float = quantity(..., "rpm", -20000, 20000, "about an upright axis, to the right; not if axis is given")
    spray: float | None = quantity(
        None, "deg", -80, 80, "off straight away to the opposite field, in place of sidespin: that of an average ball"
    )

    @property
    def side(self) -> float:
        """The sidespin in rpm, of an average ball if the spray is given (Nathan 2016, trajectory calculator)."""
        return self.sidespin if self.spray is None else 849.0 + 94.0 * self.spray

    @property
    def active_spin(self) -> float:
        """The spin in rpm of both, with the sign of the backspin."""
        if self.axis is not None:
            return self.spin
        both = (self.spin * self.spin + self.side * self.side) ** 0.5
        return where(self.spin < 0.0, -both, both)

    @property
    def lift_share(self) -> float:
        """The share of the backspin in both."""
        tilted = super().lift_share
        return abs(self.spin) / (abs(self.active_spin) + 1e-30) if tilted is None else tilted

    @property
    def spin_share(self) -> None:
        """The ball is simulated with its whole spin, for its flight is all there is."""
        return None

    @property
    def side_share(self) -> float:
        if self.axis is not None:
            return super().side_share
        both = self.active_spin
        return self.side / where(both == 0.0, inf, both)

    def square_to(self, ball: Ball) -> complex:
        return super().square_to(ball) if self.axis is not None else 1.0 + 0.0j


class Fence(Group):
    """The outfield fence."""

    distance: float = quantity(..., "m", 10, 300, "from the plate")
    height: float = quantity(..., "m", 0, 30, "height")


class FieldAir(Crosswind, BaseballAir):
    """The air over the field."""


class Parameters(BaseballFlight):
    """All parameters of a fly ball."""

    start: Literal["launch", "bat"] = choice(..., "begin with the ball's launch, or with the bat")
    launch: BattedBall = group(..., "the ball as it leaves the bat")
    air: FieldAir = group(..., "the air")
    bat: Bat = group(..., "the bat and the pitch")
    fence: Fence = group(..., "the fence")


CONTROLS = Controls(
    full_pull_speed=55.0,
    spins=(Spin("launch.spin", 100.0), Spin("launch.sidespin", 100.0)),
    set_on_pull={"start": "launch"},
    sliders=("fence.distance", "fence.height", "air.elevation", "air.temperature", "air.wind"),
    handles=(Handle("fence.distance", "fence.height", goal=True), Handle("release.place", "release.height")),
    scores="home_run",
)


def as_hit(parameters: Parameters) -> Parameters:
    """The parameters of the ball as it flies: a bat gives no sidespin."""
    if parameters.start == "launch":
        return parameters
    return parameters.model_copy(
        update={"launch": parameters.launch.model_copy(update={"sidespin": 0.0, "spray": None})}
    )


#: Sidespin in rpm with which a ball flies as far as balls do on average whose spray scatters by 25 deg, as that of fly
#: balls does: tests/reference/fly_balls.py.
USUAL_SIDESPIN = 2190.0


def usual(given: Mapping[str, Any], known: Collection[str]) -> Mapping[str, Any]:
    """The spin of average balls in a table that has only speed and angle, by those (Nathan 2016), in rpm.

    Without it they would all be hit straight away, and come down 17 ft too far.
    """
    found = {} if {"launch.axis", "launch.spray"} & {*known} else {"launch.sidespin": USUAL_SIDESPIN}
    return found if "launch.angle" not in given else found | {"launch.spin": -763.0 + 120.0 * given["launch.angle"]}


def build(parameters: Parameters) -> Setup:
    """The ball over level ground."""
    ball, bat, parameters = parameters.ball, parameters.bat, as_hit(parameters)
    hit = parameters.launched(parameters.release.of(ball))
    if parameters.start == "bat":
        hit = struck_by(bat, "bat", bat.rebound(ball.mass, ball.inertia_factor), hit)
    return Setup([hit], [Surface("ground", level(), 0.5, 0.5)], 60.0, Touches("ground"))


#: Gap in m between the ball and the top of the fence as it passes; negative if it would hit it.
over_fence = fact_from(
    passing_at(lambda it: it.fence.distance), lambda ball, it: ball.y - it.ball.radius - it.fence.height
)


def track(run: Run, parameters: Parameters) -> list[GroundPlace]:
    """The track of the ball over the field, if its axis or direction, or a wind across, is given."""
    return ground_track(run, as_hit(parameters), landing(run, parameters))


def backspin(run: Run, parameters: Parameters) -> float:
    """The backspin in rpm, without the sidespin."""
    return parameters.launch.spin if parameters.start == "launch" else LAUNCH_SPIN.compute(run, parameters)


FACTS = (
    replace(DISTANCE, label="projected distance"),  # to the ground, as if there were no fence
    Fact("over_fence", "over the fence", "m", over_fence, final_when="ground", also="ft"),
    side(track, "ground"),
    APEX,
    replace(FLIGHT_TIME, key="hang_time", label="hang time"),
    LANDING_ANGLE,
    BALL_SPEED,
    LAUNCH_ANGLE,
    replace(LAUNCH_SPIN, compute=backspin),
    Fact("home_run", "", "", lambda run, parameters: (over_fence(run, parameters) or -1.0) > 0.0, final_when="ground"),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    distance, gap = run.result["distance"], run.result["over_fence"]
    if distance is None:
        return "Did not come down"
    if run.result["home_run"]:
        return f"Home run, {roughly(distance)}"
    if gap is not None:
        return f"Off the fence, {roughly(-gap)} below its top"
    return f"{roughly(abs(distance))}, {roughly(parameters.fence.distance - distance)} short of the fence"
