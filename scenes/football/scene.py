"""American football from the side: kicks, and the bounce that nobody can predict. Not validated.

Models: gravity; drag by the ball's angle to the wind; an ellipse of 28.6 x 17.3 cm that turns end over end or, as a
spiral, keeps its nose in its path; bounces, rolling and sliding of the ellipse on the grass; the bar.
Leaves out: everything sideways; lift, and the torque of the air, which makes a bad spiral wobble; that ball and grass
deform; how it rolls once it has stopped bouncing, where the run ends. No measured kick with its launch, and no number
of the force on a tumbling ball, could be read; three filmed punts came down 24 to 33 % short of a vacuum, where a
spiral here is 17 to 24 % short at 22 to 28 m/s.
"""

from __future__ import annotations

from dataclasses import replace
from math import cos, degrees, hypot, pi, radians, sin
from statistics import NormalDist, pstdev
from typing import Any, Literal

from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS
from sandbox.kit import (
    DEGREE,
    ENDED,
    LAUNCH,
    RPM,
    AirByDensity,
    Body,
    Circle,
    Controls,
    Directed,
    Ellipse,
    Event,
    Fact,
    Gravity,
    Group,
    Handle,
    Passes,
    Run,
    SceneParameters,
    SceneRun,
    Setup,
    Solid,
    Spin,
    Spread,
    Surface,
    apex,
    choice,
    fact_from,
    group,
    level,
    maximum,
    passing,
    quantity,
    switch,
    wind_in,
)
from sandbox.physics.spheroid import DragByAngle, Follows
from sandbox.sport.readings import landing

LONGEST, YARD = 15.0, 0.9144  # s, after which a run is ended; m

#: No kick is higher than this, in m.
HIGHEST = 1_000.0
#: Bounces lower than this, in m, are lost in the grass; assumed.
LOWEST_BOUNCE = 0.01


class PlaceKick(Directed):
    """The ball as it leaves the foot."""

    speed: float = quantity(..., "m/s", 0, 60, "ball speed")
    angle: float = quantity(..., "deg", -90, 180, "direction above the horizontal")
    spin: float = quantity(..., "rpm", -1200, 1200, "end over end, backward positive; none as a spiral")
    height: float = quantity(..., "m", 0, 3, "of the ball's centre above the grass")
    nose: float = quantity(..., "deg", -180, 180, "of the long axis above the horizontal, at the start")
    turns: Literal["end-over-end", "spiral"] = choice(..., "how it turns; a spiral keeps its nose in its path")


class Football(Group):
    """The ball, a prolate spheroid: in the plane of the picture an ellipse."""

    mass: float = quantity(..., "kg", 0.1, 2, "mass")
    length: float = quantity(..., "m", 0.05, 1, "long axis")
    width: float = quantity(..., "m", 0.05, 1, "short axis")
    nose_drag: float = quantity(..., "", 0, 2, "drag coefficient, nose first, on the round cross-section")
    side_drag: float = quantity(..., "", 0, 2, "drag coefficient, side on, on the same cross-section")

    def reach(self, angle: float) -> float:
        """From its centre up and down, in m, with its long axis at an angle in rad."""
        return 0.5 * hypot(self.length * sin(angle), self.width * cos(angle))


class Goal(Group):
    """Bar and uprights; the bar's middle is in the plane of play."""

    present: bool = switch(..., "whether there is a goal")
    distance: float = quantity(..., "m", 1, 150, "from the kick to the bar")
    height: float = quantity(..., "m", 0.5, 10, "of the bar's upper edge")
    restitution: float = quantity(..., "", 0, 1, "of the ball off the bar")


class Parameters(SceneParameters):
    """All parameters of a kick."""

    launch: PlaceKick = group(..., "the ball just after the kick")
    gravity: float = quantity(..., "m/s^2", 0, 100, "gravity")
    air: AirByDensity = group(..., "the air")
    ball: Football = group(..., "the ball")
    ground: Solid = group(..., "the grass")
    goal: Goal = group(..., "the goal")


CONTROLS = Controls(
    full_pull_speed=40.0,
    spins=(Spin("launch.spin", 20.0),),
    sliders=("launch.speed", "launch.angle", "launch.spin", "launch.nose", "goal.distance", "air.wind"),
    handles=(Handle("goal.distance", "goal.height", where="goal.present", goal=True),),
    scores="good",
    # assumed:
    spread=(Spread("launch.speed", 0.01), Spread("launch.angle", minimum=0.5), Spread("launch.nose", minimum=3.0)),
    fan_fact="bounce",
    fan_shots=200,
)

BAR = 0.08  # m, half the bar's thickness; assumed

#: Landings whose bounces are compared, and how accurately each is computed: to a tenth of what they differ by.
LANDINGS, ROUGH = 12, replace(LEVELS["fast"], tolerance=1.0)


def build(it: Parameters) -> Setup:
    """The ball as an ellipse, the grass and, if there is a goal, its bar."""
    ball, launch, spiral = it.ball, it.launch, it.launch.turns == "spiral"
    half, round_half, angle = ball.length / 2, ball.width / 2, DEGREE * (launch.angle if spiral else launch.nose)
    inertia = ball.mass * (half**2 + round_half**2) / 3.0  # about, of a thin shell: 5/3 of the solid's; assumed
    forces: list[Any] = [Gravity(it.gravity)] if it.gravity else []
    if it.air.density:
        area = pi * round_half**2
        forces.append(DragByAngle(it.air.density, area, ball.nose_drag, ball.side_drag, wind_in(it.air), spiral))
    kicked = Body(
        "ball",
        position=(0.0, maximum(launch.height, ball.reach(angle))),  # no lower than where it lies on the grass
        velocity=launch.velocity,
        spin=0.0 if spiral else launch.spin * RPM,
        angle=angle,
        shape=Ellipse(half, round_half),
        mass=ball.mass,
        moment=inertia,
        forces=forces,
        torques=[Follows(inertia)] if spiral else [],
    )
    surfaces = [it.ground.surface("ground", level(reach=1e3), lowest_bounce=LOWEST_BOUNCE)]
    if it.goal.present:
        bar = Circle((it.goal.distance, it.goal.height - BAR), BAR)
        surfaces.append(Surface("crossbar", bar, it.goal.restitution, 0.3))
    return Setup([kicked], surfaces, LONGEST, until=bounces_no_more)


def bounces_no_more(event: Event) -> bool:
    """True if the ball lies: from here on it would rock and roll."""
    return event.kind == "contact" and event.partner == "ground"


def over(run: Run, parameters: Parameters) -> float | None:
    """The height in m at which the ball's centre passes over the bar, before it has come down; None without a goal."""
    if not parameters.goal.present:
        return None
    passed, down = passing(run, parameters.goal.distance), landing(run, parameters)
    if passed is None or (down is not None and down.t < passed.t):
        return None
    return passed.y - parameters.goal.height


def past_goal(parameters: Parameters) -> Passes:
    """The condition at which it is known how high over the bar a kick is: it is past the goal, or has come down."""
    distance = parameters.goal.distance
    return Passes("ground", 1, (distance, -1.0), (distance, HIGHEST))


def _nose(run: Run, parameters: Parameters) -> float | None:
    """Angle in deg of the long axis above the horizontal as the ball lands, from -90 to 90."""
    down = landing(run, parameters)
    return None if down is None else (degrees(run.angle("ball", down.t)) + 90.0) % 180.0 - 90.0


def _bounced(run: Run, parameters: Parameters) -> float | None:
    down = landing(run, parameters)
    return None if down is None else run.state("ball", run.duration)[0] - down.x


def _spread(run: Run, parameters: Parameters) -> float | None:
    """The standard deviation in m of the bounces of a kick without a goal: of landings that differ in
    the angle of the nose alone. End over end no kicker controls it; a spiral's is his to a few degrees."""
    down = landing(run, parameters)
    if down is None or parameters.goal.present:
        return None
    ball, sigma = run.setup.balls[0], radians(CONTROLS.spread[2].minimum)
    assert isinstance(ball, Body)
    noses = [pi * (k + 0.5) / LANDINGS for k in range(LANDINGS)]
    if parameters.launch.turns == "spiral":
        nose = run.angle("ball", down.t)
        noses = [nose + sigma * NormalDist().inv_cdf((k + 0.5) / LANDINGS) for k in range(LANDINGS)]
    ways = []
    for nose in noses:
        place, velocity = (down.x, parameters.ball.reach(nose)), (down.vx, down.vy)
        start = replace(ball, position=place, velocity=velocity, spin=down.spin, angle=nose)
        bounces = simulate(replace(run.setup, balls=[start]), ROUGH)
        ways.append(bounces.state("ball", bounces.duration).x)
    return pstdev(ways)


FACTS = (
    Fact("distance", "distance", "m", fact_from(landing, "x"), final_when="ground", also="yd"),
    Fact("hang_time", "hang time", "s", fact_from(landing, "t"), final_when="ground"),
    Fact("apex", "apex", "m", apex),
    Fact("bounce", "bounces", "m", _bounced, also="yd"),
    Fact("bounce_spread", "bounce spread", "m", _spread),
    Fact("over", "over the bar", "m", over, past_goal),
    Fact("good", "", "", lambda run, it: (over(run, it) or -1.0) > 0.0 if it.goal.present else None, past_goal),
    Fact("landing_angle", "lands at", "deg", fact_from(landing, "descent"), final_when="ground"),
    Fact("nose", "nose at landing", "deg", _nose),
    *LAUNCH,
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    said, spread = run.result, run.result["bounce_spread"]
    if said["good"]:
        return f"Good, from {parameters.goal.distance / YARD:.0f} yd, {said['over']:.1f} m over the bar"
    if said["good"] is not None:
        return "No good: short" if said["over"] is None else "No good: under the bar"
    if said["distance"] is None:
        return "Did not come down"
    bounce, way = said["bounce"] / YARD, "on" if said["bounce"] >= 0.0 else "back"
    far = f"{said['distance'] / YARD:.0f} yd in {said['hang_time']:.1f} s"
    return f"{far}, then {abs(bounce):.0f} ± {spread / YARD:.0f} yd {way}"
