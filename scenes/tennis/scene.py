"""Tennis from the side: serves, drives, slices and lobs, over the net, and what the court makes of them.

Models: gravity; drag and Magnus lift; the strings of the racket; the net as a thing to hit; a bounce in which the ball
slides, or grips and springs back along the court; hard, clay and grass by their pace rating and bounce. Table tennis is
the same game, on a table.
Leaves out: everything sideways but the drift of a tilted spin axis; the sag of the net; how the contact point moves
under a ball; the loss of spin in air.
"""

from __future__ import annotations

from typing import Literal

from sandbox.kit import (
    ENDED,
    LAUNCH,
    TENNIS_DRAG,
    TENNIS_LIFT,
    Air,
    Controls,
    Fact,
    Handle,
    Release,
    Run,
    SceneRun,
    Segment,
    Setup,
    Sphere,
    Spin,
    Spread,
    Surface,
    choice,
    group,
    level,
    quantity,
)
from sandbox.physics.court import court_pace, is_pace_test, pace_category
from sandbox.physics.swing import RUBBER, STRINGS
from sandbox.sport import net_game
from sandbox.sport.sideways import Crosswind, GroundPlace, SidewaysLaunch, ground_track, side
from sandbox.sport.swing import Swing, struck_by


class TennisBall(Sphere, drag=TENNIS_DRAG, lift=TENNIS_LIFT):
    """The ball."""

    inertia: float = quantity(..., "", 0.1, 1, "moment of inertia over m r^2")

    @property
    def inertia_factor(self) -> float:
        return self.inertia


class Racket(Swing):
    """The racket, and the ball that it meets."""

    face_of: Literal["strings", "rubber"] = choice(..., "strings of tennis, rubber of table tennis")


class TennisCourt(net_game.HardCourt):
    """The court, or the table."""

    surface: Literal["hard", "clay", "grass"] = choice(..., "what it looks like; how it plays is said by the numbers")
    service: float = quantity(..., "m", 0, 50, "from the net to the line before which a serve must land; 0 for none")
    table: float = quantity(..., "m", 0, 2, "height of the table above the floor; 0 for a court")


class CourtAir(Crosswind, Air):
    """The air over the court."""


class Parameters(net_game.NetGame):
    """All parameters of a shot."""

    launch: SidewaysLaunch = group(..., "the ball as it is launched")
    air: CourtAir = group(..., "the air")

    start: Literal["launch", "racket"] = choice(..., "begin with the ball's launch, or with the racket")
    shot: Literal["serve", "rally"] = choice(..., "a serve must land before the service line")
    racket: Racket = group(..., "the racket and the incoming ball")
    release: Release = group(..., "where the ball is struck")
    ball: TennisBall = group(..., "the ball")
    court: TennisCourt = group(..., "the court")

    @property
    def limit(self) -> tuple[float, str]:
        if self.shot == "serve" and self.court.service > 0.0:
            return self.middle + self.court.service, "service line"
        return self.court.length, "end of the table" if self.court.table > 0.0 else "baseline"


CONTROLS = Controls(
    full_pull_speed=60.0,
    spins=(Spin("launch.spin", 100.0),),
    set_on_pull={"start": "launch"},
    sliders=("release.place", "release.height", "court.restitution", "court.friction", "net.height", "air.wind"),
    handles=(Handle("release.place", "release.height"), *net_game.HANDLES),
    scores="in",
    spread=(Spread("launch.speed", 0.03), Spread("launch.angle", minimum=0.8), Spread("launch.spin", 0.1)),  # assumed
)


def build(parameters: Parameters) -> Setup:
    """Ball, net, and court, or table and floor."""
    court, ball, racket = parameters.court, parameters.ball, parameters.racket
    played = parameters.launched(parameters.release.of(ball))
    if parameters.start == "racket":
        struck = struck_by(racket, "racket", RUBBER if racket.face_of == "rubber" else STRINGS, played)
        played = parameters.launch.tilted(struck)
    bounce = court.bounce
    top = Segment((0.0, 0.0), (court.length, 0.0)) if court.table > 0.0 else level()
    surfaces = [Surface("court", top, bounce(1.0, 0.0).restitution, court.friction, law=bounce)]
    surfaces.append(net_game.net_of(parameters))
    if court.table > 0.0:
        surfaces.append(Surface("floor", level(-court.table), 0.7, court.friction))
    return Setup([played], surfaces, 20.0, net_game.Bounces(2))


def pace_rating(run: Run, parameters: Parameters) -> float | None:
    """The ITF's pace rating of the court, if the ball arrives at it as in that test; otherwise None."""
    down, up = net_game.landing(run, parameters), net_game.rebound(run, parameters)
    if down is None or up is None or not is_pace_test(down.speed, down.descent, down.rpm / 60.0):
        return None
    return court_pace((down.vx, down.vy), (up.vx, up.vy))


def track(run: Run, parameters: Parameters) -> list[GroundPlace]:
    """The track over the court of a ball that leaves the plane, until it comes down."""
    return ground_track(run, parameters, net_game.landing(run, parameters))


FACTS = (
    *net_game.FACTS,
    side(track, net_game.is_down),
    Fact("pace_rating", "court pace", "", pace_rating, net_game.is_down),
    *net_game.BOUNCE_FACTS,
    *LAUNCH,
    ENDED,
)


def verdict(run: SceneRun, parameters: Parameters) -> str:
    """Return the outcome in a sentence."""
    text, pace = net_game.verdict(run, parameters), run.result["pace_rating"]
    if parameters.shot == "serve" and not run.result["in"]:
        text = f"Fault: {text[0].lower()}{text[1:]}"
    return text if pace is None else f"{text}; court pace {pace:.0f}, {pace_category(pace)}"
