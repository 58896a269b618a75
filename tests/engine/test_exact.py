"""Cases with an exact answer; each test states its equation."""

from dataclasses import dataclass, replace
from itertools import pairwise
from math import atan, atan2, cos, cosh, degrees, log, pi, radians, sin, sqrt, tanh
from typing import Any, ClassVar

import numpy as np
import pytest

from sandbox.engine import simulate
from sandbox.engine.kernel.step_control import StepLimits, allowed
from sandbox.engine.many import batch_steps
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import DISC, HOLLOW_SPHERE, SOLID_SPHERE, Ball
from sandbox.engine.model.setup import ForceRegion, Setup
from sandbox.engine.model.surface import Bounce, Circle, Segment, Surface
from sandbox.engine.motion.forces_on_ball import acceleration_function
from sandbox.physics.air import LogWind, UniformWind
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity, Magnus, SpinDecay
from sandbox.physics.rocket import Motor

G = 9.81
FLOOR = Surface("floor", Segment((-100.0, 0.0), (100.0, 0.0)), 0.5, 0.0)
PRECISE = resolve("precise")


def fly(ball, duration, surfaces=(), level="precise", **rest):
    return simulate(Setup([ball], surfaces, duration=duration, **rest), resolve(level))


def quadratic_drag(p):
    """a = -p |v| v for a ball of 1 kg."""

    def force(t, position, velocity, spin):
        speed = (velocity[0] ** 2 + velocity[1] ** 2) ** 0.5
        return -p * speed * velocity[0], -p * speed * velocity[1]

    return force


# ------------------------------------------------------------------------------------------------------------- flight


@pytest.mark.parametrize(
    ("p", "reach", "top", "time", "angle"),
    [
        (1.0, 0.5890118001916, 0.1827635755686, 1.2047247557707, 57.2730219246),
        (0.5, 0.7320092694839, 0.2092735223245, 1.2919744235158, 52.6874712685),
    ],
)
@pytest.mark.parametrize(("level", "tolerance"), [("fast", 1e-2), ("balanced", 1e-5), ("precise", 1e-7)])
def test_quadratic_drag(p, reach, top, time, angle, level, tolerance):
    """Dimensionless flight g = v0 = 1 at 45 deg with a = -p |v| v; the numbers come from 30-digit arithmetic."""
    ball = Ball("ball", 1.0, 0.01, (0.0, 0.0), (sqrt(0.5), sqrt(0.5)), forces=[Gravity(1.0, 1.0), quadratic_drag(p)])
    run = fly(ball, 3.0, level=level)
    t, (x, y, vx, vy, _) = next(run.crossings("ball", (0.0, 0.0), (0.0, 1.0)))
    assert x == pytest.approx(reach, abs=tolerance)
    assert run.highest("ball")[1][1] == pytest.approx(top, abs=tolerance)
    assert t == pytest.approx(time, abs=tolerance)
    assert degrees(atan2(-vy, vx)) == pytest.approx(angle, abs=100 * tolerance)


def test_vacuum_range():
    """R = v^2 sin(2 a) / g."""
    a = radians(33.0)
    run = fly(Ball("ball", 0.2, 0.05, (0.0, 0.0), (20 * cos(a), 20 * sin(a)), forces=[Gravity(G, 0.2)]), 5.0)
    _, state = next(run.crossings("ball", (0.0, 0.0), (0.0, 1.0)))
    assert state[0] == pytest.approx(400.0 * sin(2 * a) / G, abs=1e-9)


def drag_of_a_falling_ball():
    mass, radius, density, cd = 0.145, 0.0366, 1.2, 0.4
    forces = [Gravity(G, mass), Drag(radius, density, Constant(cd))]
    terminal = sqrt(2 * mass * G / (density * cd * pi * radius**2))
    return mass, radius, forces, terminal


def test_fall_towards_terminal_speed():
    """v = vt tanh(g t / vt), depth = (vt^2 / g) ln cosh(g t / vt)."""
    mass, radius, forces, vt = drag_of_a_falling_ball()
    run = fly(Ball("ball", mass, radius, (0.0, 0.0), forces=forces), 6.0)
    _, y, _, vy, _ = run.state("ball", 6.0)
    assert -vy == pytest.approx(vt * tanh(G * 6.0 / vt), abs=1e-6)
    assert -y == pytest.approx(vt**2 / G * log(cosh(G * 6.0 / vt)), abs=1e-5)


def test_thrown_up_it_returns_slower():
    """Up for (vt/g) atan(v0/vt); back with v0 / sqrt(1 + (v0/vt)^2)."""
    mass, radius, forces, vt = drag_of_a_falling_ball()
    run = fly(Ball("ball", mass, radius, (0.0, 0.0), (0.0, 30.0), forces=forces), 8.0)
    assert run.highest("ball")[0] == pytest.approx(vt / G * atan2(30.0, vt), abs=1e-5)
    _, state = next(run.crossings("ball", (0.0, 0.0), (0.0, 1.0)))
    assert -state[3] == pytest.approx(30.0 / sqrt(1 + (30.0 / vt) ** 2), abs=1e-6)


def test_constant_lift_flies_a_circle_even_with_drag():
    """Radius 2 m / (rho A Cl) at any speed: after an arc length s the direction has turned by s / radius."""
    mass, radius, density, cl, cd = 0.1, 0.05, 1.2, 0.3, 0.2
    lift, drag = Magnus(radius, density, Constant(cl)), Drag(radius, density, Constant(cd))
    run = fly(Ball("ball", mass, radius, (0.0, 0.0), (30.0, 0.0), spin=50.0, forces=[lift, drag]), 3.0)
    circle = 2 * mass / (density * pi * radius**2 * cl)
    for t in (0.5, 1.7, 3.0):
        x, y = run.state("ball", t)[:2]
        assert np.hypot(x, y - circle) == pytest.approx(circle, abs=1e-5)


def test_cycloid():
    """F = S w x v with gravity from rest: depth 2 g / W^2, period 2 pi / W, drift g / W sideways."""
    w = 3.0
    magnus = lambda t, p, v, s: (-w * v[1], w * v[0])  # noqa: E731
    run = fly(Ball("ball", 1.0, 0.01, (0.0, 0.0), forces=[Gravity(G, 1.0), magnus]), 2 * pi / w)
    deepest = min(run.state("ball", t)[1] for t in np.linspace(0.0, 2 * pi / w, 2001))
    assert -deepest == pytest.approx(2 * G / w**2, abs=1e-5)
    x, y, vx, vy, _ = run.state("ball", 2 * pi / w)
    assert (y, vx, vy) == pytest.approx((0.0, 0.0, 0.0), abs=1e-5)
    assert abs(x) == pytest.approx(G / w * 2 * pi / w, abs=1e-5)


# ------------------------------------------------------------------------------------------------------------- bounce


@pytest.mark.parametrize("restitution", [0.3, 0.7, 0.9])
def test_an_endless_series_of_bounces_ends_when_it_should(restitution):
    """Zeno: dropped from h, the bouncing is over after sqrt(2h/g) (1+e)/(1-e)."""
    floor = Surface("floor", Segment((-1.0, 0.0), (1.0, 0.0)), restitution, 0.3)
    ball = Ball("ball", 0.1, 0.05, (0.0, 1.05), forces=[Gravity(G, 0.1)])
    run = fly(ball, 60.0, [floor])
    assert run.ended == "rest"
    assert run.duration == pytest.approx(sqrt(2 / G) * (1 + restitution) / (1 - restitution), abs=1e-3)
    heights = [event.speed for event in run.events if event.kind == "impact"]
    for before, after in list(pairwise(heights))[:5]:
        assert after / before == pytest.approx(restitution, abs=1e-8)
    assert run.state("ball", run.duration)[1] == pytest.approx(0.05, abs=1e-9)


@pytest.mark.parametrize("factor", [SOLID_SPHERE, HOLLOW_SPHERE, DISC])
@pytest.mark.parametrize(("mu", "grips"), [(10.0, True), (0.1, False)])
def test_oblique_bounce(factor, mu, grips):
    """Grips: vx' = vx - a/(1+a)... with a = I/(m r^2): vx' = vx - (vx + r w)/(1 + 1/a); slides: vx' = vx - mu (1+e)
    vn.
    """
    e, r, vx, vy, w = 0.6, 0.1, 5.0, -3.0, 4.0
    floor = Surface("floor", Segment((-9.0, 0.0), (9.0, 0.0)), e, mu)
    run = fly(Ball("ball", 0.5, r, (0.0, r + 0.3), (vx, vy), w, inertia_factor=factor), 0.2, [floor])
    _, _, ux, uy, spin = run.state("ball", 0.2)
    loss = (vx + r * w) / (1 + 1 / factor) if grips else mu * (1 + e) * -vy
    assert uy == pytest.approx(-e * vy, abs=1e-12)
    assert ux == pytest.approx(vx - loss, abs=1e-12)
    assert spin == pytest.approx(w - loss / (factor * r), abs=1e-10)


def test_slope_turns_a_bounce_as_a_mirror_does():
    """e = 1, no friction, slope of 30 deg: a ball falling straight down leaves at 30 deg to the horizontal's left."""
    s = radians(30.0)
    slope = Surface("slope", Segment((-9 * cos(s), -9 * sin(s)), (9 * cos(s), 9 * sin(s))), 1.0, 0.0)
    run = fly(Ball("ball", 0.5, 0.1, (0.0, 1.0), (0.0, -4.0)), 0.5, [slope])
    _, _, vx, vy, _ = run.state("ball", 0.5)
    assert (vx, vy) == pytest.approx((-4 * sin(2 * s), 4 * cos(2 * s)), abs=1e-12)


@pytest.mark.parametrize(("m1", "m2", "e"), [(1.0, 1.0, 1.0), (1.0, 3.0, 0.8), (5.0, 0.01, 0.5)])
def test_unequal_masses(m1, m2, e):
    """v1' = ((m1 - e m2) v1 + (1+e) m2 v2) / (m1 + m2), and the same with 1 and 2 exchanged. They grip: no slip is left
    of r1 w1 + r2 w2, and m1 r1 w1 changes as m2 r2 w2 does.
    """
    balls = [Ball("a", m1, 0.1, (0.0, 0.0), (2.0, 0.0), 7.0), Ball("b", m2, 0.2, (1.0, 0.0), (-1.0, 0.0), 4.0)]
    run = simulate(Setup(balls, duration=1.0, between_balls=lambda n, s: Bounce(e, 50.0)), PRECISE)
    (_, _, v1, u1, w1), (_, _, v2, u2, w2) = (run.state(name, 1.0) for name in "ab")
    assert v1 == pytest.approx(((m1 - e * m2) * 2.0 - (1 + e) * m2) / (m1 + m2), abs=1e-9)
    assert v2 == pytest.approx(((1 + e) * m1 * 2.0 - (m2 - e * m1)) / (m1 + m2), abs=1e-9)
    assert u1 + 0.1 * w1 == pytest.approx(u2 - 0.2 * w2, abs=1e-9)
    assert m1 * 0.1 * (w1 - 7.0) == pytest.approx(m2 * 0.2 * (w2 - 4.0), abs=1e-9)
    assert m1 * u1 == pytest.approx(-m2 * u2, abs=1e-9)


@pytest.mark.parametrize(("ratio", "count"), [(1, 3), (16, 12), (100, 31), (10_000, 314)])
def test_colliding_blocks_count_pi(ratio, count):
    """Galperin: a heavy ball drives a light one against a wall; the collisions count the digits of pi."""
    wall = Surface("wall", Segment((0.0, -1.0), (0.0, 1.0)), 1.0, 0.0)
    balls = [Ball("light", 1.0, 0.1, (1.0, 0.0)), Ball("heavy", float(ratio), 0.1, (3.0, 0.0), (-1.0, 0.0))]
    run = simulate(Setup(balls, [wall], duration=2000.0), PRECISE)
    assert run.numerics.impacts == count


def test_newtons_cradle_passes_one_ball_on():
    """Equal balls with gaps that a contact does not reach over, e = 1: the last leaves as fast as the first came."""
    balls = [Ball(f"{k}", 0.2, 0.05, (0.102 * k, 0.0)) for k in range(5)]
    balls[0] = Ball("0", 0.2, 0.05, (-1.0, 0.0), (1.5, 0.0))
    run = simulate(Setup(balls, duration=2.0), PRECISE)
    speeds = [run.state(ball.name, 2.0)[2] for ball in balls]
    assert speeds == pytest.approx([0.0, 0.0, 0.0, 0.0, 1.5], abs=1e-9)


# ---------------------------------------------------------------------------------------------------- lasting contact


def sloping(angle, friction, resistance=0.0):
    a = radians(angle)
    return Surface("slope", Segment((0.0, 0.0), (200 * cos(a), -200 * sin(a))), 0.3, friction, resistance)


def on_slope(angle, factor=SOLID_SPHERE, radius=0.05):
    a = radians(angle)
    return Ball("ball", 0.3, radius, (cos(a) + radius * sin(a), -sin(a) + radius * cos(a)), inertia_factor=factor,
                forces=[Gravity(G, 0.3)])  # fmt: skip


def steepest(mu, factor):
    """Angle in deg of the steepest slope on which friction keeps a ball rolling: tan = mu (1 + 1/factor)."""
    return degrees(atan(mu * (1 + 1 / factor)))


@pytest.mark.parametrize("factor", [SOLID_SPHERE, HOLLOW_SPHERE, DISC])
def test_rolls_down_a_slope(factor):
    """a = g sin(angle) / (1 + I/(m r^2)): 5/7 g sin for a solid ball."""
    assert steepest(0.13, factor) > 18.0
    run = fly(on_slope(18.0, factor), 3.0, [sloping(18.0, 0.13)])
    _, _, vx, vy, spin = run.state("ball", 3.0)
    expected = G * sin(radians(18.0)) / (1 + factor) * 3.0
    assert np.hypot(vx, vy) == pytest.approx(expected, abs=1e-8)
    assert spin == pytest.approx(-expected / 0.05, abs=1e-6)


@pytest.mark.parametrize("too_steep", [0.5, 5.0, 30.0])
def test_slides_down_a_slope_too_steep_to_grip(too_steep):
    """tan(angle) > mu (1 + 1/factor): a = g (sin - mu cos), and the spin grows by mu g cos r m / I."""
    mu = 0.1
    angle = steepest(mu, SOLID_SPHERE) + too_steep
    run = fly(on_slope(angle), 2.0, [sloping(angle, mu)])
    _, _, vx, vy, spin = run.state("ball", 2.0)
    a = radians(angle)
    assert np.hypot(vx, vy) == pytest.approx(G * (sin(a) - mu * cos(a)) * 2.0, abs=1e-8)
    assert spin == pytest.approx(-mu * G * cos(a) / (0.4 * 0.05) * 2.0, abs=1e-6)


def test_sliding_turns_into_rolling():
    """Set down without spin at v: rolls at 5/7 v from t = 2 v / (7 mu g) on."""
    mu, v = 0.2, 2.0
    floor = Surface("floor", Segment((-1.0, 0.0), (100.0, 0.0)), 0.3, mu)
    run = fly(Ball("ball", 0.3, 0.05, (0.0, 0.05), (v, 0.0), forces=[Gravity(G, 0.3)]), 2.0, [floor])
    t = 2 * v / (7 * mu * G)
    assert run.state("ball", t)[0] == pytest.approx(v * t - 0.5 * mu * G * t * t, abs=1e-9)
    assert run.state("ball", 2.0)[2] == pytest.approx(5 / 7 * v, abs=1e-9)


def test_rolling_resistance_brings_it_to_rest_for_good():
    """A rolling ball goes v^2 / (2 c g) and stays there."""
    floor = Surface("floor", Segment((-1.0, 0.0), (100.0, 0.0)), 0.3, 0.9, 0.05)
    ball = Ball("ball", 0.3, 0.05, (0.0, 0.05), (2.0, 0.0), spin=-40.0, forces=[Gravity(G, 0.3)])
    run = fly(ball, 60.0, [floor])
    assert run.ended == "rest"
    assert run.duration == pytest.approx(2.0 / (0.05 * G), abs=1e-8)
    assert run.state("ball", run.duration)[0] == pytest.approx(4.0 / (2 * 0.05 * G), abs=1e-8)


@pytest.mark.parametrize(("angle", "rests"), [(2.0, True), (5.0, False)])
def test_rolling_resistance_holds_a_ball_on_a_gentle_slope(angle, rests):
    """It holds where g sin / (1 + 2/5) < c g cos, so up to tan = 7/5 c: 4.0 deg for c = 0.05."""
    run = fly(on_slope(angle), 2.0, [sloping(angle, 0.9, 0.05)])
    assert (run.ended == "rest") is rests


@pytest.mark.parametrize(
    ("friction", "factor", "cosine"),
    [(0.0, SOLID_SPHERE, 2 / 3), (1e6, SOLID_SPHERE, 10 / 17), (1e6, HOLLOW_SPHERE, 6 / 11)],
)
def test_leaves_a_round_top_where_the_normal_force_ends(friction, factor, cosine):
    """From the top of a fixed circle, nudged: cos = 2/3 sliding without friction, 2 / (3 + I/(m r^2)) rolling."""
    top = Surface("top", Circle((0.0, 0.0), 1.0), 0.0, friction)
    ball = Ball("ball", 0.3, 0.1, (0.0, 1.1), (1e-4, 0.0), spin=-1e-3 if friction else 0.0, inertia_factor=factor,
                forces=[Gravity(G, 0.3)])  # fmt: skip
    run = fly(ball, 20.0, [top], until=lambda event: event.kind == "leave")
    x, y = run.state("ball", run.duration)[:2]
    assert run.ended == "until"
    assert y / np.hypot(x, y) == pytest.approx(cosine, abs=1e-5)


def test_rolls_over_the_end_of_a_ledge_and_falls():
    """Fast enough (v^2 > g r) it leaves the edge at once: a parabola from there."""
    ledge = Surface("ledge", Segment((-5.0, 0.0), (0.0, 0.0)), 0.3, 0.9)
    ball = Ball("ball", 0.3, 0.05, (-1.0, 0.05), (2.0, 0.0), spin=-40.0, forces=[Gravity(G, 0.3)])
    run = fly(ball, 1.0, [ledge])
    assert [(event.kind, event.speed) for event in run.events] == [("contact", 0.0), ("leave", 0.0)]
    x, y, vx, vy, _ = run.state("ball", 1.0)
    assert (x, vx) == pytest.approx((1.0, 2.0), abs=1e-7)
    assert (y, vy) == pytest.approx((0.05 - 0.5 * G * 0.25, -0.5 * G), abs=1e-6)


@pytest.mark.parametrize("speed", [0.1, 0.5, 1.0, 1.83, 2.0, 3.3, 7.0])
@pytest.mark.parametrize("resistance", [0.01, 0.0560, 0.3])
@pytest.mark.parametrize("level", ["fast", "balanced", "precise"])
def test_a_roll_ends_where_it_should_at_any_speed(speed, resistance, level):
    """v^2 / (2 c g), whatever the length of the last arc."""
    floor = Surface("floor", Segment((-1.0, 0.0), (900.0, 0.0)), 0.3, 0.9, resistance)
    ball = Ball("ball", 0.3, 0.02, (0.0, 0.02), (speed, 0.0), spin=-speed / 0.02, forces=[Gravity(G, 0.3)])
    run = fly(ball, 200.0, [floor], level)
    assert run.ended == "rest"
    assert run.state("ball", run.duration)[0] == pytest.approx(speed**2 / (2 * resistance * G), rel=1e-9)


@pytest.mark.parametrize("speed", np.linspace(0.05, 3.0, 24))
@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_coming_off_a_round_top_never_stalls(speed, friction):
    """Wherever the normal force ends, the ball flies on from there."""
    top = Surface("top", Segment((0.0, -2.0), (0.0, 0.0), 0.01), 0.3, friction, 0.02)
    ball = Ball(
        "ball", 0.28, 0.105, (-0.01, 0.1145), (speed, 0.0), inertia_factor=HOLLOW_SPHERE, forces=[Gravity(G, 0.28)]
    )
    run = fly(ball, 0.8, [top], "balanced")
    assert run.state("ball", 0.8)[1] < 0.2


@pytest.mark.parametrize("loss", [None, Motor((0.0, 2.0), (1.0, 1.0), 1.0)], ids=["whole", "burning"])
@pytest.mark.parametrize("forces", range(4))
@pytest.mark.parametrize("torques", range(3))
def test_the_sum_of_forces_and_torques_accelerates_a_ball(forces, torques, loss):
    """F_n = (n v_x, x + t), T_n = n + w; a burning ball of 2 kg has 1.5 kg left at 1 s."""
    pushes = [lambda t, p, v, w, n=n: (n * v[0], p[0] + t) for n in range(forces)]
    twists = [lambda t, p, v, w, n=n: n + w for n in range(torques)]
    ball = Ball("cue", 2.0, 0.5, (0.0, 0.0), forces=pushes, torques=twists, loss=loss)
    share = 0.75 if loss else 1.0
    total = sum(range(forces)) * 7.0 / (2.0 * share), forces * 4.0 / (2.0 * share), sum(n + 9.0 for n in range(torques))
    expected = (*total[:2], total[2] / (0.2 * share))
    assert acceleration_function(ball)(1.0, (3.0, 5.0, 7.0, 8.0, 9.0)) == pytest.approx(expected, rel=1e-15)


class Gusty(UniformWind):
    """A scene's own kind of wind, which grows with height."""

    def __call__(self, t, position):
        return self.x * position[1], self.y


class Thick(Drag):
    """A scene's own kind of drag, which grows with height."""

    def __call__(self, t, position, velocity, spin):
        fx, fy = super().__call__(t, position, velocity, spin)
        return fx * position[1], fy * position[1]


@dataclass(frozen=True)
class Called:
    """A force of a scene's own that calls another."""

    timed: ClassVar = ("term",)
    term: Any

    def __call__(self, *state):
        return self.term(*state)


@pytest.mark.parametrize(
    ("kind", "wind"),
    [
        (Drag, None),
        (Drag, UniformWind(-3.0, 0.5)),
        (Drag, LogWind((5.0, 0.0), 10.0, 0.03)),
        (Drag, Gusty(-0.2, 0.5)),
        (Thick, None),
    ],
)
def test_declaring_forces_independent_of_place_changes_nothing(kind, wind):
    """Of a function the engine cannot know it, and makes the place in each stage of a step; nor of a scene's own kind
    of force or wind."""
    air = 0.02, 1.2, Constant(0.3), wind
    forces, torques = [Gravity(G, 0.05), kind(*air), Magnus(*air)], [SpinDecay(8e-6, 0.02, 2e-5, wind)]
    known = Ball("ball", 0.05, 0.02, (0.0, 1.0), (40.0, 30.0), 200.0, forces=forces, torques=torques)
    called = [[Called(term) for term in terms] for terms in (forces, torques)]
    asked = replace(known, forces=called[0], torques=called[1])
    assert fly(known, 2.0).state("ball", 2.0) == fly(asked, 2.0).state("ball", 2.0)


def test_a_step_ends_at_a_border_reached_only_by_falling():
    """From rest a ball falls h in t = (2 h / g)^(1/2), alone and among others."""
    net = ForceRegion(-1.0, 0.0, 1.0, 1.0, 0.01)
    ball = Ball("ball", 1.0, 0.1, (0.0, 2.0), forces=[Gravity(G)])
    setup = Setup([ball], duration=1.0, force_regions=[net])
    fallen = sqrt(2.0 * 1.0 / G)
    limits, start = StepLimits.of(setup, ball), (0.0, 2.0, 0.0, 0.0, 0.0)
    assert allowed(limits, 0.0, 0.5, start, (0.0, -G, 0.0)) == pytest.approx(fallen, rel=1e-12)
    state, acceleration = np.zeros((5, 2)), np.zeros((3, 2))
    state[1], acceleration[1] = (2.0, 9.0), -G
    steps = batch_steps.allowed(limits, np.zeros(2), np.full(2, 0.5), state, acceleration)
    assert steps.tolist() == pytest.approx([fallen, 0.5], rel=1e-12)


def test_a_kind_of_gravity_that_changes_is_asked_anew():
    """Weight that sets in at 1 s: s = g t^2 / 2 from there on."""

    class Later(Gravity):
        def __call__(self, t, position, velocity, spin):
            return super().__call__(t, position, velocity, spin) if t > 1.0 else (0.0, 0.0)

    run = fly(Ball("ball", 2.0, 0.1, (0.0, 0.0), forces=[Later(2.0, G)]), 3.0, discontinuities=[1.0])
    assert run.state("ball", 3.0)[1:4:2] == pytest.approx((-2.0 * G, -2.0 * G), rel=1e-6)
