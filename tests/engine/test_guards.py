"""What must never pass in silence: values that are not finite, balls outside the world, stiff forces, errors in a
user's force.
"""

import tracemalloc
from dataclasses import replace
from math import inf, isfinite, nan, pi, sin, tanh

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sandbox.engine import simulate, simulate_many
from sandbox.engine.impact import impacts
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import LEVELS, resolve
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Bounds, ContactModel, Setup
from sandbox.engine.model.surface import Bounce, Circle, Segment, Surface, Trap
from sandbox.engine.simulation import Simulation
from sandbox.errors import RequestError, RunError, SandboxError
from sandbox.physics.cloth import Cloth
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity
from sandbox.physics.integrators import INTEGRATORS

G = 9.81
PLAIN = resolve(method="plain", step=1e-3)
EXACT = [resolve(level) for level in LEVELS] + [resolve(integrator=name, step=1 / 240) for name in INTEGRATORS]


def shot(*forces, mass=0.5, velocity=(10.0, 5.0)):
    return Ball("cue", mass, 0.05, (0.0, 1.0), velocity, forces=[Gravity(G, mass), *forces])


@pytest.mark.parametrize("accuracy", [*EXACT, PLAIN], ids=lambda a: f"{a.level}-{a.method}-{a.integrator}")
@pytest.mark.parametrize("value", [nan, inf, -inf])
def test_a_force_that_is_not_finite_stops_the_run(accuracy, value):
    late = lambda t, p, v, s: (value if t > 0.3 else 0.0, 0.0)  # noqa: E731
    with pytest.raises(RunError, match=rf"t = 0\.[34]\d* s, ball 'cue'.*(not finite|<lambda> .* returned \({value},)"):
        simulate(Setup([shot(late)], duration=1.0), accuracy)


def test_so_does_one_that_is_not_finite_as_soon_as_it_flies():
    with pytest.raises(RunError, match=r"t = \S+ s, ball 'cue'.*<lambda> .* returned \(nan,"):
        simulate(Setup([shot(lambda t, p, v, s: (nan if t > 0.0 else 0.0, 0.0))], duration=1.0), resolve())


@pytest.mark.parametrize("accuracy", [*EXACT[:3], PLAIN], ids=lambda a: f"{a.level}-{a.method}")
def test_leaving_the_world_stops_the_run(accuracy):
    with pytest.raises(RunError, match=r"ball 'cue'.*(x = .* m is outside the world \(-3 to 3 m\)|outside the world)"):
        simulate(Setup([shot()], duration=1.0, bounds=Bounds(-3.0, -9.0, 3.0, 9.0)), accuracy)


@pytest.mark.parametrize("way", [(1, 0), (-1, 0), (0, 1), (0, -1)])
def test_the_world_is_100_km_wide_each_way(way: tuple[int, int]):
    assert [Bounds().hold((d * way[0], d * way[1], 0.0, 0.0, 0.0)) for d in (9.9e4, 1.01e5)] == [True, False]


@pytest.mark.parametrize("accuracy", [resolve(), PLAIN], ids=["exact", "plain"])
def test_an_error_in_a_users_force_keeps_its_traceback(accuracy):
    def broken(t, position, velocity, spin):
        return 1.0 / (position[0] - position[0]), 0.0

    with pytest.raises(ZeroDivisionError) as caught:
        simulate(Setup([shot(broken)], duration=1.0), accuracy)
    assert caught.traceback[-1].name == "broken"


@pytest.mark.parametrize("accuracy", [resolve(), PLAIN], ids=["exact", "plain"])
@pytest.mark.parametrize(
    "value", [1j, 10**400, "1", None, np.ones((2, 1)), np.ones(2)], ids=lambda value: str(type(value).__name__)
)
def test_a_force_that_is_no_number_is_named(accuracy, value):
    def wind(t, position, velocity, spin):
        return (value if t > 0.3 else 0.0), 0.0

    for simulated in (
        lambda setup: simulate(setup, accuracy),
        lambda setup: raised(next(iter(simulate_many([setup] * 30, accuracy)))),
    ):
        with pytest.raises(RunError, match=r"wind is called with \(t, position, velocity, spin\) and must return"):
            simulated(
                Setup([shot(wind)], [Surface("floor", Segment((-9.0, -9.0), (9.0, -9.0)), 0.5, 0.5)], duration=1.0)
            )


def raised(run):
    if isinstance(run, Exception):
        raise run


@pytest.mark.parametrize(
    "make",
    [
        lambda three: Ball("cue", 1.0, 0.1, three),
        lambda three: Ball("cue", 1.0, 0.1, (0.0, 0.0), three),
        lambda three: Segment(three, (0.0, 1.0)),
        lambda three: Circle(three, 1.0),
        lambda three: Trap("pocket", three, 1.0),
    ],
)
def test_a_point_has_two_numbers(make):
    with pytest.raises(ValueError, match=r"\(1.0, 2.0, 3.0\) must be two finite numbers, \(x, y\)"):
        make((1.0, 2.0, 3.0))


def bullet_in_water(velocity=(300.0, 0.0)):
    """1 g, 1 cm across, drag coefficient 0.5 at 1,000 kg/m^3: the drag's own time is 8 microseconds at first."""
    return Ball(
        "bullet", 1e-3, 0.005, (0.0, 0.0), velocity, forces=[Gravity(G, 1e-3), Drag(0.005, 1000.0, Constant(0.5))]
    )


@pytest.mark.parametrize("accuracy", EXACT, ids=lambda a: f"{a.level}-{a.integrator}")
def test_stiff_drag_is_stable_and_never_turns_the_motion_round(accuracy):
    run = simulate(Setup([bullet_in_water()], duration=3.0), accuracy)
    path = run.trajectory("bullet", every=1 / 2000)
    k = 0.5 * 1000.0 * 0.5 * pi * 0.005**2 / 1e-3  # 1/m
    terminal = (G / k) ** 0.5
    assert np.diff(path[:, 1]).min() >= -1e-10
    assert path[:, 3].min() >= -1e-7  # of 300 m/s
    assert np.hypot(path[:, 3], path[:, 4]).max() <= 300.0 + 1e-9
    assert path[-1, 4] == pytest.approx(-terminal * tanh(3.0 / (terminal / G)), rel=0.02)
    x_without_gravity = np.log(1 + k * 300.0 * 0.01) / k
    rough = INTEGRATORS[accuracy.integrator].order == 1
    assert run.state("bullet", 0.01)[0] == pytest.approx(x_without_gravity, rel=0.3 if rough else 0.02)


def test_stiff_drag_shortens_fixed_steps_where_it_must():
    run = simulate(Setup([bullet_in_water()], duration=0.5), resolve(integrator="rk4", step=1 / 60))
    assert run.numerics.refined_steps > 5
    calm = simulate(Setup([shot(Drag(0.05, 1.2, Constant(0.5)))], duration=0.5), resolve(integrator="rk4", step=1 / 60))
    assert calm.numerics.refined_steps == 0


@pytest.mark.parametrize("velocity", [(300.0, 0.0), (0.0, 300.0), (-200.0, 200.0)])
def test_plain_drag_slows_and_does_not_reverse(velocity: tuple[float, float]):
    """At steps 2,000 times as long as the drag's own time at first; in the end it sinks at its terminal speed."""
    bullet = replace(bullet_in_water(), velocity=velocity)
    run = simulate(Setup([bullet], duration=1.0), resolve(method="plain", step=1 / 60))
    speeds = np.array([run.state("bullet", t)[2:4] for t in np.arange(1, 60) / 60])
    assert (speeds[:, 0] * np.sign(velocity[0]) >= 0.0).all()
    assert np.hypot(*speeds.T).max() < 20.0
    terminal = (G * 1e-3 / (0.5 * 1000.0 * 0.5 * pi * 0.005**2)) ** 0.5
    assert speeds[-1, 1] == pytest.approx(-terminal, rel=0.02)


def test_a_force_that_jumps_is_no_error():
    """An updraft with a sharp edge in space: the steps get short there, and go on."""
    edge = lambda t, p, v, s: (0.0, 8.0) if p[0] > 2.0 else (0.0, 0.0)  # noqa: E731
    ends = [simulate(Setup([shot(edge)], duration=1.0), accuracy).state("cue", 1.0)[1] for accuracy in EXACT]
    # 0.8 s under 8 N on 0.5 kg
    exact = 1.0 + 5.0 - 0.5 * G + 0.5 * 16.0 * 0.8**2
    assert ends[0] == pytest.approx(exact, abs=1e-2)
    assert ends[1] == pytest.approx(exact, abs=1e-4)
    assert ends[2] == pytest.approx(exact, abs=1e-5)


def test_a_users_own_force_of_position_and_time_beside_ours():
    """An updraft over one stretch of ground that comes and goes: met by every integrator alike."""

    def updraft(t, position, velocity, spin):
        return 0.0, 4.0 * np.exp(-((position[0] - 4.0) ** 2)) * (1.0 + sin(3.0 * t))

    drag = Drag(0.05, 1.2, Constant(0.5))
    floor = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.6, 0.3)
    with_it, without = (
        simulate(Setup([shot(*forces)], [floor], duration=2.0), resolve("precise")).state("cue", 2.0)
        for forces in ((drag, updraft), (drag,))
    )
    assert abs(with_it[1] - without[1]) + abs(with_it[0] - without[0]) > 0.5
    for name in ("heun", "rk4"):
        other = simulate(Setup([shot(drag, updraft)], [floor], duration=2.0), resolve(integrator=name, step=1 / 2000))
        assert other.state("cue", 2.0)[:2] == pytest.approx(with_it[:2], abs=1e-4)


def test_a_tolerance_of_ones_own_settles_as_that_of_a_level_does():
    for level, accuracy in LEVELS.items():
        assert resolve(level, tolerance=accuracy.tolerance).settle == pytest.approx(accuracy.settle)
    assert resolve(tolerance=1e-5).settle < resolve().settle


def test_unknown_choices_are_named():
    with pytest.raises(RequestError, match=r"accuracy\.level: 'best' is not one of fast, balanced, precise"):
        resolve("best")
    with pytest.raises(RequestError, match=r"accuracy\.integrator: 'rk5'"):
        resolve(integrator="rk5")
    with pytest.raises(RequestError, match=r"accuracy\.method: 'magic'"):
        resolve(method="magic")


@pytest.mark.parametrize("restitution", [0.0, 0.5, 1.0])
@pytest.mark.parametrize("friction", [0.0, 0.3, 10.0])
@pytest.mark.parametrize("level", LEVELS)
def test_no_energy_from_nowhere(restitution, friction, level):
    """With gravity alone, kinetic and potential energy together never grow, beyond what the level's tolerance
    allows.
    """
    floor = Surface("floor", Segment((-90.0, 0.0), (90.0, 0.0)), restitution, friction)
    walls = [Surface(f"wall {x}", Segment((x, -1.0), (x, 40.0), 0.01), restitution, friction) for x in (-3.0, 3.0)]
    start = Ball("ball", 0.5, 0.05, (0.0, 1.0), (7.0, 4.0), 300.0, forces=[Gravity(G, 0.5)])
    run = simulate(Setup([start], [floor, *walls], duration=4.0), resolve(level))
    path = run.trajectory("ball", every=1 / 300)
    energy = (
        0.5 * 0.5 * (path[:, 3] ** 2 + path[:, 4] ** 2) + 0.5 * start.inertia * path[:, 5] ** 2 + 0.5 * G * path[:, 2]
    )
    assert np.diff(energy).max() <= 1e-6 * energy[0]
    book = ledger(run)
    assert abs(book.residue) <= 1e-6 * book.start
    assert all(change <= 1e-9 for change in book.impacts.values())


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"mass": -1.0}, "ball 'cue': mass = -1.0 must be positive"),
        ({"radius": 0.0}, "ball 'cue': radius = 0.0 must be positive"),
        ({"inertia_factor": nan}, "ball 'cue': inertia_factor = nan must be positive"),
        ({"velocity": (inf, 0.0)}, "ball 'cue': velocity"),
        ({"rolling_spin": (nan, 0.0)}, "ball 'cue': rolling_spin"),
    ],
)
def test_a_ball_that_cannot_be_is_refused_in_plain_words(change, words):
    with pytest.raises(ValueError, match=words):
        Ball(**{"name": "cue", "mass": 1.0, "radius": 0.1, "position": (0.0, 0.0)} | change)


def test_an_impossible_setup_is_refused_with_its_reason():
    with pytest.raises(ValueError, match="two balls are named 'cue'"):
        Setup([shot(), shot()])
    with pytest.raises(ValueError, match="at least one ball"):
        Setup([])
    with pytest.raises(ValueError, match=r"surface 'wall': restitution = 1\.2"):
        Surface("wall", Segment((0.0, 0.0), (1.0, 0.0)), 1.2, 0.5)
    with pytest.raises(ValueError, match=r"segment: a = .* must be two finite numbers"):
        Segment((0.0, nan), (1.0, 0.0))


@pytest.mark.parametrize("accuracy", [resolve(), PLAIN], ids=["exact", "plain"])
@pytest.mark.parametrize(
    "force",
    [lambda t, p, v, s: None, lambda t, p, v, s: 1.0, lambda t, p: (0.0, 0.0), Gravity, Circle((0.0, 0.0), 1.0), 3],
)
def test_a_force_of_the_wrong_form_is_said_in_plain_words(accuracy, force):
    with pytest.raises(
        RunError, match=r"(<lambda>|Gravity|Circle|int) is called with .* and must return \(fx, fy\) in N"
    ):
        simulate(Setup([shot(force)], duration=1.0), accuracy)


def test_a_force_with_a_pole_is_a_named_error():
    pole = lambda t, p, v, s: (0.0, -1.0 / p[1] ** 3)  # noqa: E731
    with pytest.raises(RunError, match=r"changes too fast for any step|is not finite|outside the world"):
        simulate(Setup([shot(pole, velocity=(0.0, 0.0))], duration=5.0), resolve())


@pytest.mark.parametrize(
    ("bounce", "words"),
    [
        (Bounce(nan, 0.1), "restitution nan: must be from 0 to 1"),
        (Bounce(-0.1, 0.1), "restitution -0.1: must be from 0 to 1"),
        (Bounce(1.2, 0.1), "restitution 1.2: must be from 0 to 1"),
        (Bounce(0.5, inf), "friction inf: must be finite, and not negative"),
        (Bounce(0.5, -0.1), "friction -0.1: must be finite, and not negative"),
        (Bounce(0.5, 0.1, nan), "tilt nan: must be finite"),
        (Bounce(0.5, 0.1, 0.0, 1.5), "tangential 1.5: must be from 0 to 1"),
    ],
)
def test_a_law_of_bouncing_that_cannot_be_is_a_named_error(bounce, words):
    ground = Surface("ground", Segment((-50.0, 0.0), (50.0, 0.0)), 0.5, 0.5, law=lambda normal, along: bounce)
    setup = Setup([shot()], [ground], duration=3.0)
    said = f"the scene's law for 'ground' returned {words}"
    for accuracy in (resolve(), PLAIN):
        with pytest.raises(RunError, match=said):
            simulate(setup, accuracy)
    many = {str(error) for error in simulate_many([setup] * 30, resolve())}
    assert {error.partition(" (")[0] for error in many} == {said}  # and where the law stands
    pair = [Ball("a", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0)), Ball("b", 1.0, 0.1, (1.0, 0.0))]
    with pytest.raises(RunError, match=rf"the scene's law for '[ab]' returned {words}"):
        simulate(Setup(pair, between_balls=lambda normal, slip: bounce), resolve())


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"duration": None}, "duration = None s must be positive and finite"),
        ({"duration": "3"}, "duration = 3 s must be positive and finite"),
        ({"surfaces": [1]}, "surfaces: 1 is no Surface"),
        ({"traps": [1]}, "traps: 1 is no Trap"),
        ({"bounds": (-1, -1, 1, 1)}, r"bounds = \(-1, -1, 1, 1\) must be a Bounds"),
        ({"contact": "hertz"}, "contact = 'hertz' must be a ContactModel"),
        ({"plane": 3.0}, "3.0 is no plane, such as a Cloth"),
    ],
)
def test_what_is_of_another_kind_is_refused_where_it_is_given(fields, said):
    with pytest.raises(ValueError, match=said):
        Setup(**{"balls": [Ball("ball", 1.0, 0.1, (0.0, 0.0))], **fields})


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"name": None}, "ball: name = None must be text"),
        ({"position": (0.0, [1])}, "position = .* must be two finite numbers"),
        ({"position": (0.0, 1j)}, "position = .* must be two finite numbers"),
        ({"spin": [1]}, "spin = .* must be finite"),
    ],
)
def test_what_is_no_number_of_a_ball_is_refused(fields, said):
    with pytest.raises(ValueError, match=said):
        Ball(**{"name": "ball", "mass": 1.0, "radius": 0.1, "position": (0.0, 0.0), **fields})


@pytest.mark.parametrize("make", [lambda: Gravity("3"), lambda: Drag(coefficient=None), lambda: Drag(viscosity=0.0)])
def test_what_is_no_number_of_a_force_is_refused(make):
    with pytest.raises(ValueError, match=r"^(Gravity|Drag): .* must be (finite|positive)$"):
        make()


def test_an_invalid_bounce_is_said_with_time_and_ball():
    ground = Surface("ground", Segment((-1.0, 0.0), (1.0, 0.0)), 0.5, 0.5, law=lambda normal, along: None)
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.2), forces=[Gravity(9.81)])
    with pytest.raises(RunError, match=r"^t = 0.142784 s, ball 'ball': a ball hit 'ground'"):
        simulate(Setup([ball], [ground]), resolve())


def test_a_run_without_end_is_refused():
    with pytest.raises(ValueError, match="duration = inf s"):
        Setup([shot()], duration=inf)


@pytest.mark.parametrize("what", ["sliding", "rolling", "spinning", "gravity"])
@pytest.mark.parametrize("value", [-0.1, nan, inf])
def test_cloth_does_not_push(what, value):
    with pytest.raises(ValueError, match=f"cloth: {what} = "):
        Cloth(**{what: value})


@pytest.mark.parametrize("what", ["tolerance", "step"])
@pytest.mark.parametrize("value", [0.0, -1.0, nan])
def test_sizes_of_errors_and_steps_are_positive(what, value):
    with pytest.raises(RequestError, match=f"accuracy.{what}: {value} .* must be positive"):
        resolve(**{what: value})


@pytest.mark.parametrize("accuracy", [resolve("balanced"), PLAIN], ids=["exact", "plain"])
@pytest.mark.parametrize(
    ("mass", "radius", "place"), [(1e-10, 1e-200, 1.0), (1e-320, 0.03, 1.0), (0.1, 1e-170, 1.0), (0.1, 0.03, 1e300)]
)
def test_numbers_that_no_float_holds_are_a_named_error(accuracy, mass, radius, place):
    """The moment of inertia of the first is 0, squares of the last are infinite."""

    def run():
        floor = Surface("floor", Segment((-9.0, 0.0), (9.0, 0.0)), 0.5, 0.5)
        ball = Ball("ball", mass, radius, (place, 2.0), (1.0, 0.0), forces=(Gravity(G, mass),))
        other = Ball("other", mass, radius, (-place, 2.0), (1e160, 0.0))
        simulate(Setup((ball, other), (floor,), 1.0), accuracy)

    with pytest.raises((RequestError, RunError)):
        run()


EXTREME = st.sampled_from([1e-320, 1e-300, 1e-160, 1e-20, 0.1, 1.0, 1e20, 1e150, 1e300])


@settings(max_examples=60, deadline=None)
@given(
    mass=EXTREME,
    radius=EXTREME,
    speed=EXTREME,
    gravity=EXTREME,
    size=EXTREME,
    accuracy=st.sampled_from([resolve(), resolve(integrator="rk4", step=0.01), resolve(method="plain", step=0.01)]),
    cloth=st.booleans(),
)
def test_sizes_beyond_arithmetic_are_named_errors(mass, radius, speed, gravity, size, accuracy, cloth):
    """From the smallest to the largest numbers: a run, or an error that says what is wrong."""
    try:
        shot = Ball("ball", mass, radius, (0.0, 1.0), (speed, -speed), speed, forces=[Gravity(gravity, mass)])
        post = Surface("post", Circle((size, 0.0), size), 0.5, 0.5)
        floor = Surface("floor", Segment((-size, 0.0), (size, 0.0)), 0.5, 0.5, 0.1)
        setup = Setup([shot], [floor, post], duration=0.1, plane=Cloth(gravity=gravity) if cloth else None)
        run = simulate(setup, accuracy)
    except (ValueError, SandboxError):
        return  # named
    assert all(map(isfinite, run.state("ball", run.duration)))


def test_a_force_that_divides_by_nothing_is_the_scenes_own_error():
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.0), forces=[lambda t, position, velocity, spin: (1.0 / position[0], 0.0)])
    with pytest.raises(ZeroDivisionError):
        simulate(Setup([ball], duration=1.0), resolve())


def test_a_force_that_overflows_in_a_trial_step_shortens_it():
    """A float's ``**`` raises where its ``*`` is inf: both make the same run."""
    powers = lambda t, p, v, s: (-1e6 * v[0] ** 3, 0.0)  # noqa: E731
    products = lambda t, p, v, s: (-1e6 * (v[0] * v[0] * v[0]), 0.0)  # noqa: E731
    made = [
        simulate(Setup([shot(force, velocity=(1e3, 0.0))], duration=0.01), resolve()) for force in (powers, products)
    ]
    assert made[0].state("cue", 0.01)[:4] == pytest.approx(made[1].state("cue", 0.01)[:4], rel=1e-4)


def test_a_force_that_always_overflows_keeps_its_traceback():
    with pytest.raises(OverflowError, match="out of range"):
        simulate(Setup([shot(lambda t, p, v, s: (1e300 ** (2.0 if t > 0.0 else 1.0), 0.0))], duration=1.0), resolve())


def test_points_may_be_given_as_lists_and_arrays():
    post = Surface("post", Circle([2.0, 0.0], 0.1), 0.5, 0.5)
    floor = Surface("floor", Segment(np.array([-9.0, -1.0]), [9.0, -1.0]), 0.5, 0.5)
    run = simulate(Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0))], [post, floor], duration=3.0), resolve())
    assert run.events[0].partner == "post"


def test_memory_grows_linearly_with_the_number_of_balls():
    def needed(count):
        balls = [Ball(f"ball {i}", 1.0, 0.1, (0.3 * i, 0.0)) for i in range(count)]
        tracemalloc.start()
        simulation = Simulation(Setup(balls, duration=0.1), resolve())
        memory, _ = tracemalloc.get_traced_memory()
        tracemalloc.stop()
        del simulation
        return memory

    needed(2)  # what is made once
    assert needed(400) < 6 * needed(100)


def test_an_impact_creating_energy_is_an_error_naming_bodies(monkeypatch):
    """Here pymunk's impulses leave three balls twice as fast as they should."""
    exchange = impacts.after_contacts_at_once

    def too_fast(*given):
        after, *others = exchange(*given)
        return {i: (*state[:2], *(2.0 * speed for speed in state[2:])) for i, state in after.items()}, *others

    monkeypatch.setattr(impacts, "after_contacts_at_once", too_fast)
    balls = [
        Ball("a", 1.0, 0.1, (0.0, 0.1)),
        Ball("b", 1.0, 0.1, (0.0, -0.1)),
        Ball("c", 1.0, 0.1, (0.5, 0.0), (-2.0, 0.0)),
    ]
    with pytest.raises(
        RunError, match=r"^t = 0\.\d+ s: .* J appeared from nothing in the impact of 'a', 'b', 'c', whose .* 2 J"
    ) as said:
        simulate(Setup(balls, duration=2.0, contact=ContactModel("rigid")), resolve())
    assert "\n" not in str(said.value)
