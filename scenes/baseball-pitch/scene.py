"""A pitch from the side: from the hand to the plate, through the strike zone or not.

Models: gravity; drag as fitted to tracked pitches, and Magnus lift, by the active share of the spin and the tilt of its
axis; loss of spin; the air by weather.
Leaves out: everything sideways: what the tilt of the spin axis takes from the lift pushes a pitch aside until the
plate, a four-seam by 8 in, a sinker by 16 in, a change-up by 14 in, a slider by 6 in, a curve by 8 in; the wake of the
seams, except as far as it is in the active share; that gyro spin becomes active as the ball falls, which pushes it
aside; bounces before the plate.
"""

from __future__ import annotations

from dataclasses import replace

from sandbox.kit import (
    BALL_SPEED,
    DEGREE,
    ENDED,
    LAUNCH_ANGLE,
    LAUNCH_SPIN,
    Controls,
    EndsBy,
    Fact,
    Group,
    Handle,
    Rule,
    Run,
    SceneRun,
    Segment,
    Setup,
    Spin,
    Surface,
    cos,
    fact_from,
    group,
    level,
    passing_at,
    quantity,
    roughly,
)
from sandbox.sport import flight

from ..baseball.scene import BaseballFlight

MITT = 1.2  # m, behind the front of the plate


class PitchedBall(flight.Launch):
    """The ball as it leaves the hand."""

    spin: float = quantity(..., "rpm", -20000, 20000, "all of it; backspin positive, topspin negative")
    active: float = quantity(
        ..., "", 0, 1, "share of the spin across the flight; the rest is that of a bullet (gyro spin)"
    )
    tilt: float = quantity(..., "deg", -90, 90, "lean of the spin's axis from the level; its cosine lifts the ball")

    @property
    def active_spin(self) -> float:
        return self.active * self.spin

    @property
    def lift_share(self) -> float:
        """The cosine of its tilt."""
        return cos(self.tilt * DEGREE)


class Plate(Group):
    """Home plate, and the strike zone over its front."""

    distance: float = quantity(..., "m", 5, 30, "of its front from where the ball leaves the hand")
    bottom: float = quantity(..., "m", 0, 1, "of the strike zone above the ground")
    top: float = quantity(..., "m", 0.3, 2, "of the strike zone above the ground")


class Parameters(BaseballFlight):
    """All parameters of a pitch."""

    launch: PitchedBall = group(..., "the ball as it leaves the hand")
    plate: Plate = group(..., "the plate")


CONTROLS = Controls(
    full_pull_speed=45.0,
    spins=(Spin("launch.spin", 100.0), Spin("launch.tilt", 5.0)),
    sliders=("launch.active", "release.height", "plate.distance", "plate.bottom", "plate.top", "air.elevation"),
    handles=(
        Handle("release.place", "release.height"),
        Handle("plate.distance", "plate.top", goal=True),
        Handle(y="plate.bottom", at=lambda parameters: (parameters.plate.distance, parameters.plate.bottom)),
    ),
    scores="strike",
)


#: The pitch is over when it is caught, or on the ground.
OVER = (Rule(("mitt", "ground")),)


def build(parameters: Parameters) -> Setup:
    """The ball, the ground, and the mitt in which it ends."""
    back = parameters.plate.distance + MITT
    mitt = Segment((back, 0.0), (back, 1e3))  # wild pitches end there, too
    surfaces = [Surface("ground", level(), 0.5, 0.5), Surface("mitt", mitt, 0.0, 0.5)]
    return Setup([parameters.launched(parameters.release.of(parameters.ball))], surfaces, 20.0, EndsBy(OVER))


at_plate = passing_at(lambda it: it.plate.distance)  # the ball as it passes the front of the plate


def is_strike(run: Run, parameters: Parameters) -> bool:
    """True if any part of the ball is in the zone."""
    passed, plate, radius = at_plate(run, parameters), parameters.plate, parameters.ball.radius
    return passed is not None and plate.bottom - radius <= passed.y <= plate.top + radius


def rise(run: Run, parameters: Parameters) -> float | None:
    """The height in m by which the ball is above its place at that time under gravity alone."""
    passed, start = at_plate(run, parameters), run.setup.balls[0]
    if passed is None:
        return None
    return passed.y - start.position[1] - start.velocity[1] * passed.t + 0.5 * parameters.gravity * passed.t**2


FACTS = (
    Fact("plate_height", "at the plate", "m", fact_from(at_plate, "y"), final_when="mitt"),
    Fact("plate_speed", "speed there", "m/s", fact_from(at_plate, "speed"), final_when="mitt", also="mph"),
    Fact("plate_angle", "falls at", "deg", fact_from(at_plate, "descent"), final_when="mitt"),
    Fact("break", "break", "m", rise, final_when="mitt", also="in", sides=("down", "up")),
    Fact("flight_time", "flight time", "s", fact_from(at_plate, "t"), final_when="mitt"),
    BALL_SPEED,
    LAUNCH_ANGLE,
    replace(LAUNCH_SPIN, compute=lambda run, parameters: parameters.launch.spin),
    Fact("strike", "", "", is_strike, final_when="mitt"),
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    height, plate = run.result["plate_height"], parameters.plate
    if height is None:
        return "Ball, in the dirt"
    if run.result["strike"]:
        return f"Strike, {roughly(height)} over the plate"
    off, way = (height - plate.top, "high") if height > plate.top else (plate.bottom - height, "low")
    return f"Ball, {roughly(off)} too {way}"
