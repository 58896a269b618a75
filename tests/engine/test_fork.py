"""Forks: a run goes on from any time as it was, or with what is given changed."""

import pickle
from dataclasses import asdict
from math import nan

import pytest

import sandbox
from sandbox.engine import simulate, simulate_many
from sandbox.engine.ledger import ledger
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.motion import Swinging
from sandbox.engine.model.setup import Setup, Touches
from sandbox.engine.model.shapes import box
from sandbox.engine.model.surface import Moving, Segment, Surface
from sandbox.engine.paths.phase import InCluster, Phase
from sandbox.engine.simulation import Simulation
from sandbox.errors import RequestError, RunError
from sandbox.physics.forces import Gravity
from sandbox.scene.discovery import listings

G = 9.81
FLOOR = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), restitution=0.8, friction=0.4)

#: Scenes with what their defaults have not: clusters, heaps of balls and of bodies, many balls; and what makes them
#: short.
MORE = {
    "billiards/nine-ball-break": {},
    "collisions/cradle-5": {"duration": 1.0},
    "collisions/bowl": {"duration": 0.45},
    "collisions/dominoes": {"duration": 0.1},
    "basketball/rattle": {},
    "hockey/glove-save": {},
    "minigolf/back-down": {"felt.ramp_rise": 0.2},
}
SCENES = {**{each.name: {} for each in listings() if "/" not in each.name}, **MORE}


def ball(name="ball", position=(0.0, 2.0), velocity=(0.0, 0.0), mass=0.6, **more):
    return Ball(name, mass, 0.12, position, velocity, forces=[Gravity(G)], **more)


def run_of(*balls, surfaces=(FLOOR,), duration=3.0, **more):
    return simulate(Setup(balls, surfaces, duration=duration, **more), resolve())


def push(t, position, velocity, spin):
    """Newtons."""
    return 1.2, 0.0


def assert_same(run, other):
    for name, path in run.arcs.items():
        pieces = [[(arc.t0, arc.t1, *arc.start) for arc in each] for each in (path, other.arcs[name])]
        assert pieces[0] == pieces[1], name
    assert (other.events, other.duration, other.ended) == (run.events, run.duration, run.ended)
    assert {**asdict(other.numerics), "wall_s": 0.0} == {**asdict(run.numerics), "wall_s": 0.0}


def middles(run, kind):
    """Five times in the middle of arcs with this phase."""
    times = sorted({0.5 * (arc.t0 + arc.t1) for path in run.arcs.values() for arc in path if arc.phase is kind})
    return times[:: max(1, len(times) // 5)]


# ---------------------------------------------------------------------- without a change


@pytest.mark.parametrize("name", SCENES)
def test_without_a_change_it_is_the_same_run(name):
    """To the last bit, in every scene, from five times."""
    run = sandbox.simulate(sandbox.load(name, SCENES[name]))
    for share in (0.0, 0.21, 0.5, 0.83, 1.0):
        assert_same(run, run.fork(share * run.duration))


@pytest.mark.parametrize(
    ("name", "phase"),
    [
        ("billiards/nine-ball-break", Phase.CLUSTER),
        ("collisions/dominoes", Phase.HEAP),
        ("golf", Phase.ROLLING),
    ],
)
def test_it_is_the_same_from_times_in_a_contact(name, phase):
    run = sandbox.simulate(sandbox.load(name, SCENES.get(name, {})))
    times = middles(run, phase)
    assert times
    for t in times[1::2][:3]:
        assert_same(run, run.fork(t))


@pytest.mark.parametrize("shift", [(0.0, 0.05), (0.1, 0.0)], ids=["lift", "tray"])
def test_a_ball_that_is_carried_goes_on_as_it_was(shift):
    """It rests on what goes up and down, and rolls on what goes to and fro."""
    carried = Moving(Surface("lift", FLOOR.shape, 0.3, 0.4), Swinging((0.0, 0.0), 0.0, 1.0, shift=shift))
    run = run_of(ball(position=(0.0, 0.3)), surfaces=[carried])
    there = pickle.loads(pickle.dumps(run))
    phases = {arc.phase for arc in run.arcs["ball"]}
    assert phases & {Phase.RESTING, Phase.ROLLING}
    for phase in phases:
        for t in middles(run, phase):
            assert_same(run, run.fork(t))
    assert_same(run, there.fork(2.3))
    kicked = run.fork(2.0, velocity=(0.0, 3.0))
    assert next(event.t for event in kicked.events if event.t > 2.1) > 2.4


def test_only_the_rest_is_computed(monkeypatch):
    """And a few events before it."""
    run = sandbox.simulate(sandbox.load("billiards"))
    resolve_event, count = Simulation._resolve, []
    monkeypatch.setattr(Simulation, "_resolve", lambda self, event: (count.append(event.t), resolve_event(self, event)))
    t = 0.8 * run.duration
    run.fork(t)
    again = [at for at in count if at <= t]
    assert 0 < len(again) <= 4 * len(run.arcs)
    assert min(count) > 0.4 * t


def test_a_run_of_a_batch_or_of_a_pickle_can_be_forked():
    shots = [Setup([ball(velocity=(speed, 1.0))], [FLOOR], duration=2.0) for speed in (1.0, 2.0, 3.0)]
    for run in simulate_many(shots, resolve()):
        assert run.fork(1.0).state("ball", 2.0) == pytest.approx(run.state("ball", 2.0), abs=1e-9)
    changed = run.fork(0.5, velocity=(0.0, 4.0)).fork(1.0, spin=2.0)
    there = pickle.loads(pickle.dumps(changed))
    assert_same(changed, there.fork(1.5))
    assert_same(changed, there.fork(0.7).fork(1.0, spin=2.0))


# ---------------------------------------------------------------------- changes


def test_a_gust_pushes_from_its_time_on():
    """x = v t, then + a s^2 / 2 with a = F / m."""
    run = run_of(ball(position=(0.0, 20.0), velocity=(3.0, 0.0)), duration=1.5)
    gust = run.fork(0.5, forces=[Gravity(G), push])
    for t in (0.0, 0.3, 0.5):
        assert gust.state("ball", t) == run.state("ball", t)
    for t in (0.9, 1.5):
        s = t - 0.5
        assert gust.state("ball", t).x == pytest.approx(3.0 * t + 0.5 * 2.0 * s * s, abs=1e-9)
        assert gust.state("ball", t).y == pytest.approx(20.0 - 0.5 * G * t * t, abs=1e-9)
    energy = ledger(gust)
    assert energy.work["push"] == pytest.approx(1.2 * (gust.state("ball", 1.5).x - 1.5), abs=1e-9)
    assert abs(energy.residue) < 1e-9


def test_what_is_set_by_hand_is_in_the_ledger_by_that_name():
    """m (u^2 - v^2) / 2, and J^2 / 2 m + J v for an impulse J."""
    run = run_of(ball(position=(0.0, 30.0), velocity=(2.0, 0.0)), duration=1.0)
    struck = run.fork(0.5, impulse=(1.8, 0.0)).fork(0.7, velocity=(0.0, 1.0), spin=50.0)
    assert struck.state("ball", 0.6).vx == pytest.approx(5.0)
    assert struck.state("ball", 0.7)[2:] == (0.0, 1.0, 50.0)
    energy, fall = ledger(struck), 0.5 * 0.6 * (G * 0.7) ** 2
    inertia = run.setup.balls[0].inertia
    by_hand = 0.5 * 0.6 * (25.0 - 4.0) + 0.5 * 0.6 * (1.0 - 25.0) - fall + 0.5 * inertia * 50.0**2
    assert energy.work["set by hand"] == pytest.approx(by_hand, rel=1e-9)
    assert abs(energy.residue) < 1e-9
    total = energy.start + sum(energy.work.values()) + sum(energy.impacts.values()) + energy.residue
    assert total == pytest.approx(energy.end, rel=1e-12)


def test_a_ball_thrown_down_where_it_rests_bounces():
    run = run_of(ball(position=(0.0, 0.12)), duration=2.0)
    thrown = run.fork(run.duration, velocity=(0.0, -3.0))
    assert next(event.t for event in thrown.events if event.kind == "impact") == run.duration
    assert thrown.state("ball", run.duration).vy == pytest.approx(0.8 * 3.0)
    energy = ledger(thrown)
    assert energy.work["set by hand"] == pytest.approx(0.5 * 0.6 * 9.0)
    assert abs(energy.residue) < 1e-9


def test_a_ball_that_comes_in_is_met_at_the_exact_time():
    """Two that fall alike meet as without gravity: a gap of 2 - 2 R at 4 m/s."""
    run = run_of(ball(position=(0.0, 50.0)), duration=2.0)
    both = run.fork(0.5, add=ball("two", (2.0, run.state("ball", 0.5).y), (-4.0, run.state("ball", 0.5).vy)))
    assert both.events[0].t == pytest.approx(0.5 + 1.76 / 4.0, abs=1e-9)
    assert (both.events[0].kind, {both.events[0].ball, both.events[0].partner}) == ("impact", {"ball", "two"})
    assert both.arcs["two"][0].t0 == 0.5
    alone = both.fork(0.7, remove="two")
    assert alone.state("ball", 2.0) == pytest.approx(run.state("ball", 2.0), abs=1e-9)
    assert [(event.kind, event.ball, event.t) for event in alone.events] == [("removed", "two", 0.7)]
    assert_same(alone, alone.fork(1.3))


def test_a_floor_that_is_gone_lets_all_fall():
    still, rolling = ball("still", (0.0, 0.12)), ball("rolling", (3.0, 0.12), (2.0, 0.0), spin=-2.0 / 0.12)
    run = run_of(still, rolling, duration=2.0)
    assert {run.arcs[name].at(1.0).phase for name in run.arcs} == {Phase.RESTING, Phase.ROLLING}
    falling = run.fork(1.0, surfaces=[])
    for name, x in (("still", 0.0), ("rolling", 7.0)):
        state = falling.state(name, 2.0)
        assert (state.x, state.y) == pytest.approx((x, 0.12 - 0.5 * G), abs=1e-9)


def heap_of_three():
    """Two on the floor between posts, one on them."""
    walls = [Surface(f"wall {x}", Segment((x, 0.0), (x, 2.0)), 0.5, 0.5) for x in (-0.25, 0.25)]
    balls = [ball("left", (-0.13, 0.12)), ball("right", (0.13, 0.12)), ball("top", (0.0, 0.36))]
    return run_of(*balls, surfaces=[FLOOR, *walls], duration=0.8)


def test_a_heap_falls_in_when_one_below_is_taken_out():
    run = heap_of_three()
    assert run.arcs["top"][-1].phase is Phase.HEAP
    fallen = run.fork(0.35, remove="left", duration=0.85)
    assert fallen.state("top", 0.85).y < run.state("top", 0.35).y - 0.05
    assert fallen.caught_at("left") == 0.35
    assert_same(fallen, fallen.fork(0.4))


def test_a_ball_of_a_heap_can_be_struck():
    run = heap_of_three()
    kicked = run.fork(0.35, impulse={"top": (0.0, 1.2)})
    assert kicked.state("top", 0.55).y == pytest.approx(run.state("top", 0.35).y + 0.2 * 2.0 - 0.5 * G * 0.04, abs=1e-4)
    assert kicked.state("left", 0.35)[:2] == pytest.approx(run.state("left", 0.35)[:2], abs=1e-12)


def test_a_body_goes_on_turning_when_pushed():
    crate = Body("crate", position=(0.0, 5.0), shape=box(0.4, 0.3), mass=2.0, spin=1.0, forces=[Gravity(G)])
    run = run_of(crate, duration=0.8)
    pushed = run.fork(0.3, impulse=(2.0, 0.0))
    assert pushed.angle("crate", 0.8) == pytest.approx(0.8, abs=1e-9)
    assert pushed.state("crate", 0.8).x == pytest.approx(0.5, abs=1e-9)


def test_a_change_in_a_contact_of_several_comes_after_it():
    run = sandbox.simulate("billiards/nine-ball-break")
    name, arc = next((name, arc) for name in run.arcs for arc in run.arcs[name] if isinstance(arc.contact, InCluster))
    start, end = arc.contact_span
    still = run.fork(0.5 * (start + end), velocity={name: (0.0, 0.0)})
    assert still.before(name, end)[2:4] == pytest.approx(run.before(name, end)[2:4], abs=1e-12)
    assert still.state(name, end)[2:4] == (0.0, 0.0)


def test_a_scene_goes_on_with_other_parameters():
    run = sandbox.simulate("golf")
    gust = run.fork(2.0, {"air.wind": [-15.0, 0.0]})
    assert gust.state("ball", 2.0) == run.state("ball", 2.0)
    assert gust.result["carry"] < run.result["carry"] - 5.0
    assert tuple(gust.scene.parameters.air.wind) == (-15.0, 0.0)
    with pytest.raises(RequestError, match="start, which is over"):
        run.fork(2.0, {"launch.speed": 40.0})


def test_the_end_of_a_run_can_be_put_off():
    run = run_of(ball(), until=Touches("floor"))
    assert run.ended == "until"
    on = run.fork(run.duration, until=Touches("floor", 3))
    assert [event.partner for event in on.events] == ["floor"] * 3
    assert on.fork(on.duration - 1e-3).duration == on.duration
    with pytest.raises(RequestError, match="the run is over"):
        run.fork(run.duration, velocity=(0.0, 1.0))


# ---------------------------------------------------------------------- invalid


@pytest.mark.parametrize(
    ("t", "changes", "said"),
    [
        (-0.1, {}, "fork at t = -0.1 s: the run is from 0 to 3 s"),
        (3.1, {}, "the run is from 0 to 3 s"),
        (nan, {}, "fork at t = nan s"),
        ("soon", {}, "fork at t = soon s"),
        (1.0, {"velocty": (1.0, 0.0)}, "unknown change 'velocty': choose from forces, "),
        (1.0, {"velocity": {"bal": (1.0, 0.0)}}, "velocity: there is no ball 'bal' at that time; there are 'ball'"),
        (1.0, {"velocity": (1.0, nan)}, "velocity of ball 'ball' = (1.0, nan): must be two finite numbers"),
        (1.0, {"impulse": 2.0}, "impulse of ball 'ball' = 2.0: must be two finite numbers"),
        (1.0, {"spin": nan}, "spin of ball 'ball' = nan: must be a finite number"),
        (1.0, {"forces": 3.0}, "forces = 3.0 must be a list"),
        (1.0, {"add": ball()}, "there is, or was, a ball 'ball' already"),
        (1.0, {"add": [ball("a", (5.0, 1.0)), ball("a", (6.0, 1.0))]}, "a ball 'a' already"),
        (1.0, {"add": 3}, "add = 3: must be a Ball or a Body"),
        (1.0, {"add": ball("low", (5.0, 0.1))}, "ball 'low' at (5, 0.1) m: it would overlap 'floor' by 0.02 m"),
        (1.0, {"add": [ball("a", (5.0, 1.0)), ball("b", (5.1, 1.0))]}, "it would overlap 'b' by 0.14 m"),
        (1.0, {"position": (0.0, 0.0)}, "it would overlap 'floor' by 0.12 m"),
        (1.0, {"remove": "bat"}, "remove: there is no ball 'bat'"),
        (1.0, {"remove": "ball", "spin": 1.0}, "remove: ball 'ball' is changed at the same time"),
        (1.0, {"duration": 0.5}, "the run lasts 0.5 s: change something before that"),
        (1.0, {"surfaces": 3}, "surfaces = 3 must be a list"),
        (3.0, {"spin": 1.0}, "t = 3 s: the run lasts 3 s"),
    ],
)
def test_what_cannot_be_changed_is_refused_in_a_line(t, changes, said):
    run = run_of(ball())
    with pytest.raises(RequestError) as error:
        run.fork(t, **changes)
    assert said in str(error.value)
    assert "\n" not in str(error.value)


def test_with_several_balls_a_change_needs_a_name():
    run = run_of(ball(), ball("other", (5.0, 1.0)))
    with pytest.raises(RequestError, match=r'velocity: there are 2 balls: give it by name, as \{"ball": ...\}'):
        run.fork(1.0, velocity=(0.0, 0.0))


def test_a_wrong_force_is_named():
    with pytest.raises(RunError, match="int is called with"):
        run_of(ball()).fork(1.0, forces=[3])


def test_a_run_of_the_plain_method_cannot_be_forked():
    run = simulate(Setup([ball()], [FLOOR], duration=0.1), resolve(method="plain"))
    with pytest.raises(RequestError, match="cannot be forked"):
        run.fork(0.05)
