"""Touching: nothing tunnels, corners and grazes are handled, and every kind of start is."""

from dataclasses import replace
from math import atan2, cos, hypot, inf, nextafter, pi, sin

import numpy as np
import pymunk
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sandbox.engine import simulate
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.model.accuracy import LEVELS, resolve
from sandbox.engine.model.ball import DISC, HOLLOW_SPHERE, SOLID_SPHERE, Ball, kinetic
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.surface import Bounce, Circle, ConstantBounce, Segment, Surface
from sandbox.engine.paths.arc import hermite_arc
from sandbox.errors import RequestError
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity

G = 9.81


def ball(position, velocity=(0.0, 0.0), spin=0.0, radius=0.05, mass=0.3, gravity=G, name="ball"):
    forces = [Gravity(gravity, mass)] if gravity else []
    return Ball(name, mass, radius, position, velocity, spin, forces=forces)


def box(half, restitution=0.8, friction=0.3, thickness=1e-4):
    """A closed box around the origin with walls as thin as 0.2 mm."""
    corners = [(-half, -half), (half, -half), (half, half), (-half, half)]
    return [
        Surface(f"wall {k}", Segment(a, b, thickness), restitution, friction)
        for k, (a, b) in enumerate(zip(corners, corners[1:] + corners[:1], strict=True))
    ]


def inside(run, half, radius):
    path = run.trajectory("ball", every=1 / 500)
    return np.abs(path[:, 1:3]).max() <= half - radius + 1e-6


# --------------------------------------------------------------------------------------------------------- tunnelling


@settings(deadline=None, max_examples=60)
@given(
    speed=st.floats(0.0, 340.0),
    direction=st.floats(0.0, 2 * pi),
    spin=st.floats(-2000.0, 2000.0),
    radius=st.floats(0.001, 0.2),
    density=st.sampled_from([0.0, 1.2, 1000.0]),
    level=st.sampled_from(["fast", "balanced", "precise"]),
)
def test_nothing_leaves_a_box_with_thin_walls(speed, direction, spin, radius, density, level):
    forces = [Gravity(G, 0.3)]
    if density:
        forces.append(Drag(radius, density, Constant(0.4)))
    shot = Ball("ball", 0.3, radius, (0.1, -0.2), (speed * cos(direction), speed * sin(direction)), spin, forces=forces)
    run = simulate(Setup([shot], box(0.5), duration=0.3), resolve(level))
    assert inside(run, 0.5, radius)


@pytest.mark.parametrize("integrator", ["explicit-euler", "semi-implicit-euler", "heun", "velocity-verlet", "rk4"])
@pytest.mark.parametrize("step", [0.5, 1 / 60, 1e-3])
def test_nothing_leaves_the_box_at_any_fixed_step(integrator, step):
    shot = ball((0.1, -0.2), (200.0, 130.0))
    run = simulate(Setup([shot], box(0.5), duration=0.2), resolve(integrator=integrator, step=step))
    assert inside(run, 0.5, 0.05)
    assert run.numerics.impacts > 10


def test_two_fast_balls_meet_head_on():
    """300 m/s each, 2 cm across, 600 m apart: a step of 1/60 s would carry each 5 m past."""
    balls = [
        ball((-300.0, 0.0), (300.0, 0.0), radius=0.01, gravity=0, name="left"),
        ball((300.0, 0.0), (-300.0, 0.0), radius=0.01, gravity=0, name="right"),
    ]
    run = simulate(Setup(balls, duration=2.0), resolve())
    (event,) = run.events
    assert event.t == pytest.approx((600.0 - 0.02) / 600.0, abs=1e-10)
    assert run.state("left", 2.0)[0] < run.state("right", 2.0)[0]


# -------------------------------------------------------------------------------------------------- corners and grazes


@pytest.mark.parametrize("radius", [2e-4, 0.05, 0.9])
def test_two_walls_at_once(radius):
    """Into a right-angled corner along the diagonal, e = 1, no friction: straight back."""
    walls = [
        Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 1.0, 0.0),
        Surface("wall", Segment((0.0, -5.0), (0.0, 5.0)), 1.0, 0.0),
    ]
    run = simulate(Setup([ball((1.0, 1.0), (-2.0, -2.0), radius=radius, gravity=0)], walls, duration=1.0), resolve())
    assert {event.partner for event in run.events} == {"floor", "wall"}
    assert len({event.t for event in run.events}) == 1
    assert run.state("ball", 1.0)[2:4] == pytest.approx((2.0, 2.0), abs=1e-9)


def test_convex_corner_turns_the_ball_about_its_point():
    """A ball that meets the end of a segment bounces along the line from that point to its centre."""
    wall = Surface("wall", Segment((0.0, 0.0), (0.0, -5.0)), 1.0, 0.0)
    run = simulate(Setup([ball((-0.03, 1.0), (0.0, -2.0), gravity=0)], [wall], duration=1.0), resolve())
    n = np.array([-0.03, (0.05**2 - 0.03**2) ** 0.5]) / 0.05
    v = np.array([0.0, -2.0])
    assert run.state("ball", 1.0)[2:4] == pytest.approx(v - 2 * (v @ n) * n, abs=1e-7)


def test_a_graze_is_ignored_only_within_rounding():
    post = Surface("post", Circle((0.0, 0.0), 0.1), 1.0, 0.0)
    shots = {
        above: simulate(Setup([ball((-1.0, 0.15 + above), (3.0, 0.0), gravity=0)], [post], duration=1.0), resolve())
        for above in (1e-9, -1e-6)
    }
    assert shots[1e-9].events == []
    (event,) = shots[-1e-6].events
    assert event.speed < 0.02
    x, y = event.x, event.y
    assert hypot(x, y) == pytest.approx(0.15, abs=1e-9)


@pytest.mark.parametrize("inside", [0.0, 1e-12, 1e-9, 1e-6])
def test_a_slight_overlap_is_an_impact_only_when_closing(inside):
    floor, y = Obstacle(Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 0.5, 0.9), 0.05), 0.05 - inside
    for vy, met in ((0.0, False), (1e-3, False), (1.0, False), (-1e-3, True)):
        still = (0.0, 0.0, 0.0)
        path = hermite_arc(0.0, 0.1, (0.0, y, 1.0, vy, 0.0), still, (0.1, y + 0.1 * vy, 1.0, vy, 0.0), still)
        assert (floor.first_touch(path) is not None) is met


def test_flush_surfaces_are_rolled_over_without_a_bump():
    floor = [Surface(f"{k}", Segment((k - 5.0, 0.0), (k - 4.0, 0.0)), 0.5, 0.9) for k in range(10)]
    run = simulate(Setup([ball((-4.5, 0.05), (3.0, 0.0), spin=-60.0)], floor, duration=2.0), resolve())
    assert [event.kind for event in run.events if event.kind == "impact"] == []
    assert run.state("ball", 2.0)[:3] == pytest.approx((1.5, 0.05, 3.0), abs=1e-6)


@pytest.mark.parametrize("angle", [0.3, 1.2])
def test_flush_slopes_are_rolled_over_without_a_bump(angle):
    c, s = cos(angle), -sin(angle)
    floor = [Surface(f"{k}", Segment((k * c, k * s), ((k + 1) * c, (k + 1) * s)), 0.5, 5.0) for k in range(10)]
    start = (0.5 * c + 0.05 * sin(angle), 0.5 * s + 0.05 * c)
    run = simulate(Setup([ball(start)], floor, duration=0.9), resolve())
    assert [event.kind for event in run.events if event.kind == "impact"] == []
    assert hypot(*run.state("ball", 0.9)[2:4]) == pytest.approx(5 / 7 * G * sin(angle) * 0.9, abs=1e-6)


def test_a_ball_between_two_slopes_comes_to_rest_touching_both():
    valley = [
        Surface("left", Segment((-5.0, 5.0), (0.0, 0.0)), 0.6, 0.5, 0.01),
        Surface("right", Segment((0.0, 0.0), (5.0, 5.0)), 0.6, 0.5, 0.01),
    ]
    run = simulate(Setup([ball((-1.0, 2.0), spin=30.0)], valley, duration=60.0), resolve())
    assert run.ended == "rest"
    x, y = run.state("ball", run.duration)[:2]
    assert (x, y) == pytest.approx((0.0, 0.05 * 2**0.5), abs=1e-6)


@pytest.mark.parametrize("level", LEVELS)
@pytest.mark.parametrize("lowest_bounce", [0.0, 0.005])
@pytest.mark.parametrize("slope", [1e-5, 1e-3, 0.02])
def test_a_rolling_ball_goes_up_where_a_slope_begins(slope, lowest_bounce, level):
    """It rolls on as far as its speed takes it, less the little that the meeting costs: v^2 / (10/7 g) upward."""
    ground = [
        Surface("flat", Segment((-9.0, 0.0), (0.0, 0.0)), 0.3, 0.4, lowest_bounce=lowest_bounce),
        Surface("slope", Segment((0.0, 0.0), (2e5, 2e5 * slope)), 0.3, 0.4, lowest_bounce=lowest_bounce),
    ]
    run = simulate(Setup([ball((-1.0, 0.05), (1.0, 0.0), -20.0)], ground, duration=2.0), resolve(level))
    t = run.duration - next(event.t for event in run.events if event.partner == "slope")
    assert run.state("ball", run.duration)[0] == pytest.approx(t - 0.5 * 5 / 7 * G * slope * t**2, abs=0.03)


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("restitution", [0.0, 0.7])
def test_a_valley_with_one_soft_side_holds_the_ball(restitution, turned):
    """The bounce that the soft side swallows must not become a push into the other."""
    valley = [
        Surface("soft", Segment((-2.0, 0.3), (0.0, 0.0)), restitution, 0.2, lowest_bounce=0.005),
        Surface("hard", Segment((0.0, 0.0), (2.0, 0.3)), 0.3, 0.0),
    ]
    setup = Setup([ball((-1.0, 0.4), radius=0.02)], valley[::-1] if turned else valley, duration=20.0)
    run = simulate(setup, resolve())
    assert run.ended == "rest"
    assert run.state("ball", run.duration)[:2] == pytest.approx((0.0, 0.02 * hypot(1.0, 0.15)), abs=1e-5)
    times = np.linspace(0.0, run.duration, 2000)
    gaps = [Obstacle(s, 0.02).near(*run.state("ball", t)[:2]).gap for s in valley for t in times]
    assert min(gaps) > -1e-9


def test_spin_of_a_wedged_ball_dies():
    """In a V of 45 deg both sides carry m g / sqrt 2, so the spin slows by mu 2 (g / sqrt 2) r m / I."""
    valley = [
        Surface("left", Segment((-5.0, 5.0), (0.0, 0.0)), 0.0, 0.2),
        Surface("right", Segment((0.0, 0.0), (5.0, 5.0)), 0.0, 0.2),
    ]
    run = simulate(Setup([ball((0.0, 0.05 * 2**0.5), spin=0.5)], valley, duration=60.0), resolve())
    assert run.ended == "rest"
    rate = 0.2 * 2 * G / 2**0.5 / (0.4 * 0.05)
    assert run.duration == pytest.approx(0.5 / rate, rel=1e-6)


def test_rolling_into_a_kerb_and_stopping_there():
    """A slope that ends at a wall: bounces get smaller, then the ball leans on both."""
    a = 0.2
    slope = Surface("slope", Segment((-10 * cos(a), 10 * sin(a)), (0.0, 0.0)), 0.4, 0.8, 0.02)
    wall = Surface("wall", Segment((0.0, -1.0), (0.0, 3.0)), 0.4, 0.3)
    run = simulate(Setup([ball((-2.0, 2.0))], [slope, wall], duration=60.0), resolve())
    assert run.ended == "rest"
    assert Obstacle(wall, 0.05).near(*run.state("ball", run.duration)[:2]).gap == pytest.approx(0.0, abs=1e-6)


# -------------------------------------------------------------------------------------------------------------- starts


def test_starts_in_contact():
    floor = Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 0.5, 0.5, 0.01)
    run = simulate(Setup([ball((0.0, 0.05))], [floor], duration=1.0), resolve())
    assert (run.ended, run.duration) == ("rest", 0.0)
    assert run.trajectory("ball").shape == (1, 6)


def test_a_launch_from_the_ground_is_no_impact():
    floor = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.5, 0.5, 0.01)
    run = simulate(Setup([ball((0.0, 0.05), (3.0, 3.0))], [floor], duration=0.3), resolve())
    assert run.events == []


def test_slight_overlap_is_pushed_out_and_a_deep_one_refused():
    floor = Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 0.5, 0.5)
    run = simulate(Setup([ball((0.0, 0.0495))], [floor], duration=0.5), resolve())
    assert run.state("ball", 0.0)[1] == pytest.approx(0.05, abs=1e-12)
    with pytest.raises(RequestError, match=r"'ball'.*overlaps 'floor'.*0\.02 m"):
        simulate(Setup([ball((0.0, 0.03))], [floor], duration=0.5), resolve())
    with pytest.raises(RequestError, match=r"ball 'b' at .* overlaps 'a' at the start"):
        simulate(Setup([ball((0.0, 0.0), name="a"), ball((0.05, 0.0), name="b")], duration=0.5), resolve())
    with pytest.raises(RequestError, match=r"ball 'b' at .* overlaps 'a' at the start"):
        simulate(Setup([ball((1.0, 2.0), name="a"), ball((1.0, 2.0), name="b")], duration=0.5), resolve())


def test_two_balls_are_pushed_apart_by_the_same_distance():
    pair = [ball((k * 0.0996, 0.0), gravity=0.0, name=f"{k}") for k in range(2)]
    run = simulate(Setup(pair, duration=0.1), resolve())
    assert [run.state(b.name, 0.0)[0] for b in pair] == pytest.approx([-0.0002, 0.0998], abs=1e-12)


@pytest.mark.parametrize("overlap", [1e-9, 1e-6, 5e-4])
def test_slight_overlaps_are_resolved_at_the_start(overlap):
    wall = Surface("wall", Segment((-0.05, -1.0), (-0.05, 1.0)), 0.5, 0.5)
    row = [ball((k * (0.1 - overlap), 0.0), gravity=0.0, name=f"{k}") for k in range(4)]
    run = simulate(Setup(row, [wall], duration=0.1), resolve())
    for t in (0.0, 0.1):
        places = [run.state(b.name, t)[0] for b in row]
        assert places[0] >= -1e-9
        assert np.diff(places).min() >= 0.1 - 1e-9


def test_no_room_between_surfaces_is_an_error():
    walls = [Surface(f"{s}", Segment((s * 0.0497, -1.0), (s * 0.0497, 1.0)), 0.5, 0.5) for s in (-1, 1)]
    with pytest.raises(RequestError, match="does not fit"):
        simulate(Setup([ball((0.0, 0.0))], walls, duration=0.5), resolve())


def test_a_lively_ball_settles_after_any_number_of_bounces():
    floor = Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 0.997, 0.5)
    run = simulate(Setup([ball((0.0, 0.0501))], [floor], duration=60.0), resolve("precise"))
    assert run.ended == "rest"
    assert sum(event.speed < 1e-4 for event in run.events) > 1000


def test_a_touch_in_the_last_instant_of_a_run():
    floor = Surface("floor", Segment((-5.0, 0.0), (5.0, 0.0)), 0.5, 0.5)
    falling = Ball("ball", 1.0, 0.5, (0.0, 1.5), (0.0, -1.0))
    moment = simulate(Setup([falling], [floor], duration=2.0), resolve()).events[0].t
    met = []
    for _ in range(5):
        moment = nextafter(moment, 2.0)
        run = simulate(Setup([falling], [floor], duration=moment), resolve())
        assert run.duration == moment
        met.append(run.events[0].t == moment)
    assert any(met)


# ------------------------------------------------------------------------------------------------- distance, by pymunk


@given(st.floats(-3.0, 3.0), st.floats(-3.0, 3.0), st.floats(0.0, 0.5))
def test_distances_agree_with_pymunks_point_query(x, y, radius):
    space = pymunk.Space()
    for surface in (
        Surface("s", Segment((-1.0, -0.5), (1.5, 0.7), radius), 0.5, 0.5),
        Surface("c", Circle((0.3, 0.2), radius + 0.1), 0.5, 0.5),
    ):
        shape = surface.shape
        theirs = (
            pymunk.Circle(space.static_body, shape.radius, shape.center)
            if isinstance(shape, Circle)
            else pymunk.Segment(space.static_body, shape.a, shape.b, shape.radius)
        )
        space.add(theirs)
        ours = Obstacle(surface, 0.05).near(x, y)
        query = theirs.point_query((x, y))
        assert ours.gap + 0.05 == pytest.approx(query.distance, abs=1e-12)
        if query.distance > 1e-6:
            assert (ours.nx, ours.ny) == pytest.approx(tuple(query.gradient), abs=1e-6)


@settings(deadline=None, max_examples=40)
@given(st.floats(0.0, 2 * pi), st.floats(0.5, 300.0), st.floats(0.0, 0.999))
def test_time_of_impact_on_a_circle(direction, speed, offset):
    """Straight flight at a circle: t = (d - sqrt(R^2 - b^2)) / v for the offset b."""
    reach, b = 0.3, offset * 0.3
    u, n = np.array([cos(direction), sin(direction)]), np.array([-sin(direction), cos(direction)])
    start = -5.0 * u + b * n
    post = Surface("post", Circle((0.0, 0.0), 0.25), 1.0, 0.0)
    shot = ball(tuple(start), tuple(speed * u), gravity=0)
    run = simulate(Setup([shot], [post], duration=20.0, until=lambda e: True), resolve())
    assert run.events[0].t == pytest.approx((5.0 - (reach**2 - b**2) ** 0.5) / speed, rel=1e-7)
    assert atan2(run.events[0].y, run.events[0].x) != inf


def test_a_ball_touching_at_the_start_and_closing_bounces():
    floor = Surface("floor", Segment((-100.0, 0.0), (100.0, 0.0)), 1.0, 0.0)
    run = simulate(Setup([ball((0.0, 0.05), (3.0, -4.0))], [floor], duration=0.5), resolve())
    assert (run.events[0].kind, run.events[0].t, run.events[0].speed) == ("impact", 0.0, 4.0)
    assert run.state("ball", 0.0)[2:4] == pytest.approx((3.0, 4.0))


@pytest.mark.parametrize("resistance", [0.1, 0.5, 0.8, 2.0])
def test_friction_limits_rolling_resistance(resistance):
    """Rolls at -min(c, mu) g: with mu = 0.5 a resistance above that changes nothing."""
    floor = Surface("floor", Segment((-5.0, 0.0), (100.0, 0.0)), 0.5, 0.5, resistance)
    run = simulate(Setup([ball((0.0, 0.05), (2.0, 0.0), spin=-40.0)], [floor], duration=60.0), resolve())
    assert run.duration == pytest.approx(2.0 / (min(resistance, 0.5) * G), rel=1e-6)


@pytest.mark.parametrize("push", [1.0, 3.0, 10.0, 100.0])
@pytest.mark.parametrize("resistance", [0.0, 0.3])
def test_a_steady_push_rolls_or_slides_and_never_stalls(push, resistance):
    """Rolls while a push F needs no more grip than mu N: F (1 - 1/(1 + 2/5)) <= mu m g; slides at F/m - mu g beyond."""
    floor = Surface("floor", Segment((-9e3, 0.0), (9e3, 0.0)), 0.5, 0.5, resistance)
    shot = ball((0.0, 0.05), (2.0, 0.0))
    pushed = replace(shot, forces=(*shot.forces, lambda t, p, v, s: (-push, 0.0)))
    runs = [simulate(Setup([pushed], [floor], duration=t), resolve()) for t in (2.0, 2.5)]
    early, late = (run.state("ball", run.duration)[2] for run in runs)
    a = (early - late) / 0.5
    if push * (1 - 5 / 7) > 0.5 * 0.3 * G:
        assert a == pytest.approx(push / 0.3 - 0.5 * G, rel=1e-6)
    elif resistance == 0.0:
        assert a == pytest.approx(5 / 7 * push / 0.3, rel=1e-6)
    else:
        assert 0.0 <= a < 5 / 7 * push / 0.3


@pytest.mark.parametrize("rate", [2.0, 3.0, 7.0])
def test_a_growing_push_makes_a_rolling_ball_slide(rate):
    """F = k t: a = 5/7 F/m while F (1 - 5/7) <= mu m g, F/m - mu g from then on."""
    m, mu = 0.3, 0.5
    floor = Surface("floor", Segment((-9e3, 0.0), (9e3, 0.0)), 0.5, mu)
    shot = ball((0.0, 0.05), (2.0, 0.0), spin=-40.0)
    pushed = replace(shot, forces=(*shot.forces, lambda t, p, v, s: (-rate * t, 0.0)))
    end, slips = 4.0, 3.5 * mu * m * G / rate
    run = simulate(Setup([pushed], [floor], duration=end), resolve())
    speed = 2.0 - 5 / 14 * rate / m * slips**2 - 0.5 * rate / m * (end**2 - slips**2) + mu * G * (end - slips)
    assert run.state("ball", end)[2] == pytest.approx(speed, rel=1e-6)


@pytest.mark.parametrize("restitution", [0.0, 0.05, 0.4])
@pytest.mark.parametrize("speed", [1.2, 1.3, 1.35, 1.5, 1.9])
def test_a_ball_rolls_over_a_hole_or_comes_to_rest_in_it(restitution, speed):
    """A golf ball and its cup: an edge to roll about, walls to rattle between, corners to lie in."""
    radius, mass = 0.021335, 0.04593
    walls = [((0.146, 0.0), (0.146, -0.1)), ((0.146, -0.1), (0.254, -0.1)), ((0.254, -0.1), (0.254, 0.0))]
    cup = [Surface("cup", Segment(a, b), restitution, 0.4, 0.1) for a, b in walls]
    green = [
        Surface("green", Segment(a, b), 0.5, 0.4, 0.056, lowest_bounce=0.005)
        for a, b in (((-9.0, 0.0), (0.146, 0.0)), ((0.254, 0.0), (99.0, 0.0)))
    ]
    putt = ball((0.0, radius), (speed, 0.0), -speed / radius, radius, mass)
    run = simulate(Setup([putt], cup + green, duration=60.0), resolve())
    assert run.ended == "rest"
    x, y = run.state("ball", run.duration)[:2]
    holed = y < 0.0
    assert holed == (0.146 < x < 0.254)
    assert y == pytest.approx(radius - 0.1 if holed else radius, abs=1e-6)


def test_where_friction_must_give_way_some_of_it_is_left():
    """Kane's paradox in a groove: full friction would gain energy, a sixteenth of it does not, and turns the ball."""
    e, mu, low, high, radius = 0.98, 0.666, 0.4261686, 1.1427027, 0.1
    left = Surface("left", Segment((0.0, 0.0), (-3.0 * cos(low), 3.0 * sin(low))), e, mu)
    right = Surface("right", Segment((0.0, 0.0), (3.0 * cos(high), 3.0 * sin(high))), e, mu)
    half, middle = 0.5 * (pi - low - high), 0.5 * (pi - low + high)
    way = radius / sin(half)
    shot = Ball("ball", 1.0, radius, (way * cos(middle), way * sin(middle)), (2.8667, -3.4285), -11.967)
    before, after = (
        kinetic(shot, state) for state in ((0.0, 0.0, *shot.velocity, shot.spin), _after(shot, left, right))
    )
    assert after <= before
    assert _after(shot, left, right)[4] == pytest.approx(-16.1, abs=0.1)


def _after(shot: Ball, *surfaces: Surface) -> tuple[float, ...]:
    return simulate(Setup([shot], surfaces, duration=0.01), resolve()).state("ball", 0.01)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_turf_leans_against_the_motion_whichever_way_it_goes(way: float):
    """Smooth ground that tilts by 0.2 rad turns a ball by twice that, upwards, without restitution lost."""
    turf = Surface("turf", Segment((-9.0, 0.0), (9.0, 0.0)), 1.0, 0.0, law=lambda normal, along: Bounce(1.0, 0.0, 0.2))
    shot = Ball("ball", 1.0, 0.1, (0.0, 0.2), (way * 5.0, -2.0))
    vx, vy = simulate(Setup([shot], [turf], duration=0.2), resolve()).state("ball", 0.2)[2:4]
    down = atan2(2.0, 5.0)
    assert (way * vx, vy) == pytest.approx((29**0.5 * cos(down + 0.4), 29**0.5 * sin(down + 0.4)), rel=1e-6)


@pytest.mark.parametrize(("factor", "body"), [(SOLID_SPHERE, 2 / 5), (HOLLOW_SPHERE, 2 / 3), (DISC, 1 / 2)])
def test_sliding_ends_in_rolling_at_the_speed_of_its_inertia(factor: float, body: float):
    """Angular momentum about the point of contact stays: v = v0 / (1 + I / m r^2)."""
    floor = Surface("floor", Segment((-9.0, 0.0), (90.0, 0.0)), 0.5, 0.5)
    slid = Ball("ball", 1.0, 0.1, (0.0, 0.1), (3.0, 0.0), inertia_factor=factor, forces=[Gravity(9.81, 1.0)])
    assert slid.inertia == pytest.approx(body * 1.0 * 0.1**2)
    assert simulate(Setup([slid], [floor], duration=2.0), resolve()).state("ball", 2.0)[2] == pytest.approx(
        3.0 / (1.0 + body), rel=1e-6
    )


@pytest.mark.parametrize("speed", [0.05, 0.5, 5.0])
def test_a_law_is_asked_about_slow_impacts_too(speed: float):
    lively = Surface("lively", Segment((-9.0, 0.0), (9.0, 0.0)), 0.0, 0.0, law=lambda normal, along: Bounce(0.8, 0.0))
    shot = Ball("ball", 1.0, 0.1, (0.0, 0.1001), (0.0, -speed))
    run = simulate(Setup([shot], [lively], duration=1.0), resolve())
    assert run.state("ball", 1.0)[3] == pytest.approx(0.8 * speed)


@pytest.mark.parametrize("way", [1.0, -1.0])
@pytest.mark.parametrize("resistance", [0.05, 0.2])
def test_a_rolling_ball_stops_where_its_resistance_says(resistance: float, way: float):
    """a = c g: it stops after v^2 / (2 c g), whether it starts rolling or slides first."""
    floor = Surface("floor", Segment((-90.0, 0.0), (90.0, 0.0)), 0.5, 0.5, resistance)
    rolls = Ball("ball", 0.2, 0.05, (0.0, 0.05), (way * 2.0, 0.0), -way * 2.0 / 0.05, forces=[Gravity(9.81, 0.2)])
    run = simulate(Setup([rolls], [floor], duration=20.0), resolve())
    assert run.ended == "rest"
    assert way * run.state("ball", run.duration)[0] == pytest.approx(2.0**2 / (2.0 * resistance * 9.81), rel=1e-6)


@pytest.mark.parametrize("method", ["exact", "plain"])
@pytest.mark.parametrize("mirror", [1.0, -1.0])
def test_some_of_the_slip_of_a_ball_that_grips_is_reversed(method: str, mirror: float):
    """v' = v - (1 + t) a / (1 + a) (v + r w), limited by friction: mu (1 + e) v_n is all that it can take."""
    for friction, share, speed, spin in ((5.0, 0.1, 10.0, 0.0), (5.0, 0.5, 10.0, -600.0), (0.1, 0.5, 10.0, 0.0)):
        ball = Ball("ball", 0.05, 0.03, (0.0, 1.0), (mirror * speed, -5.0), mirror * spin, inertia_factor=0.55)
        law = ConstantBounce(Bounce(0.8, friction, 0.0, share))
        floor = Surface("floor", Segment((-9.0, 0.0), (9.0, 0.0)), 0.8, friction, law=law)
        run = simulate(Setup([ball], [floor], 0.3), replace(LEVELS["precise"], method=method))
        _, _, vx, _, after = run.state("ball", 0.3)
        slip = (1.0 + share) * (speed + 0.03 * spin) / 1.55
        lost = max(-friction * 9.0, min(0.55 * slip, friction * 9.0))
        assert mirror * vx == pytest.approx(speed - lost, abs=1e-9)
        assert mirror * after == pytest.approx(spin - lost / 0.55 / 0.03, abs=1e-6)


@pytest.mark.parametrize(
    ("angle", "speed", "spin", "first"),
    [(1.8, 1.0, 20.0, "green"), (1.0, 2.0, -30.0, "green"), (0.6, 2.0, 40.0, "cup"), (-0.8, 1.5, 0.0, "cup")],
)
def test_a_lip_belongs_to_the_surface_more_nearly_below(angle, speed, spin, first):
    """Straight at the corner, from ``angle`` above the level: below 45 degrees it is the wall's."""
    green, wall = Segment((-5.0, 0.0), (0.0, 0.0)), Segment((0.0, 0.0), (0.0, -0.1))
    pieces = [Surface("green", green, 0.3, 0.5), Surface("cup", wall, 0.7, 0.1)]
    (x, y), flying = (0.3 * cos(angle), 0.3 * sin(angle)), (-speed * cos(angle), -speed * sin(angle))
    setup = Setup([ball((x, y), flying, spin, gravity=0.0)], pieces, duration=0.6)
    one, other = (simulate(replace(setup, surfaces=each), resolve()) for each in (pieces, pieces[::-1]))
    assert [event.partner for event in one.events] == [event.partner for event in other.events] == [first]
    assert one.state("ball", 0.6) == other.state("ball", 0.6)


def test_a_ball_that_rolls_over_a_lip_does_so_alike_in_any_order():
    green, wall = Segment((-5.0, 0.0), (0.0, 0.0)), Segment((0.0, 0.0), (0.0, -0.1))
    pieces = [Surface("cup", wall, 0.0, 0.9), Surface("green", green, 0.0, 0.05)]
    setup = Setup([ball((-0.1, 0.05), (0.2, 0.0))], pieces, duration=1.0)
    one, other = (simulate(replace(setup, surfaces=each), resolve()) for each in (pieces, pieces[::-1]))
    assert one.state("ball", 1.0) == pytest.approx(other.state("ball", 1.0), abs=1e-12)


def test_a_rack_that_overlaps_is_pushed_apart_alike_in_any_order():
    spots = [(0.0866 * row, 0.0999 * (k - 0.5 * row)) for row in range(4) for k in range(row + 1)]
    rack = [ball(spot, gravity=0.0, name=str(k)) for k, spot in enumerate(spots)]
    one, other = (simulate(Setup(balls, duration=0.01), resolve()) for balls in (rack, rack[::-1]))
    for each in rack:
        assert one.state(each.name, 0.0) == pytest.approx(other.state(each.name, 0.0), abs=1e-15)
