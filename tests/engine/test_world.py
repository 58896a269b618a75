"""Worlds: a simulation from frame to frame, changed, saved and restored."""

import json
import pickle
import random
import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

import sandbox
from sandbox import (
    Ball,
    Bounds,
    InTurn,
    Moving,
    RequestError,
    RunError,
    Segment,
    Setup,
    Surface,
    Touches,
    Turning,
    World,
)
from sandbox.engine.model.accuracy import resolve
from sandbox.scene.discovery import listings
from tests.engine.test_fork import FLOOR, SCENES, ball, heap_of_three

ROOT = Path(__file__).parents[2]


def frames(name):
    """Durations of frames in s: even, or random from 0 to 0.2."""
    draw = random.Random(7)
    while True:
        yield 1 / name if isinstance(name, int) else draw.random() ** 3 * 0.2


def stepped(world, until, rate):
    """Step a world at a rate up to a time in s; returns its events."""
    events = []
    for dt in frames(rate):
        world.step(min(dt, until - world.t))
        events += world.events
        if world.t >= until or world.ended in ("until", "duration"):
            return events
    return events


@pytest.mark.parametrize(
    "name",
    ["basketball/rattle", "billiards/nine-ball-break", "collisions/bowl", "golf", "minigolf", "hockey/glove-save"],
)
@pytest.mark.parametrize("rate", [60, "random"])
def test_frames_change_nothing(name, rate):
    """The events are those of a run, to the last bit."""
    scene = sandbox.load(name, SCENES.get(name, {}))
    run, world = sandbox.simulate(scene), World(scene)
    assert stepped(world, run.duration, rate) == run.events
    for each in world.state:
        assert world.state[each] == run.state(each, run.duration)
    assert world.run().arcs.keys() == run.arcs.keys()


def played(rate):
    """A ball that is struck at two times, one of them where it touches the floor."""
    world, events = World(Setup([ball(velocity=(1.0, 0.0))], [FLOOR], duration=30.0)), []
    for until, change in ((1.0, {"velocity": (0.0, 4.0)}), (2.5, {"impulse": (0.6, 0.6), "spin": 9.0}), (4.0, {})):
        events += stepped(world, until, rate)
        world.apply(**change)
    return events, world.run()


def test_a_game_is_the_same_at_all_rates():
    known, run = played(60)
    assert len(known) == 3
    for rate in (144, "random"):
        events, other = played(rate)
        assert [event.t for event in events] == pytest.approx([event.t for event in known], abs=1e-9)
        assert other.state("ball", 3.9) == pytest.approx(run.state("ball", 3.9), abs=1e-9)


def test_a_world_is_the_run_that_is_forked():
    run = sandbox.simulate(Setup([ball(velocity=(1.0, 0.0))], [FLOOR], duration=4.0))
    forked = run.fork(1.0, velocity=(0.0, 4.0)).fork(2.5, impulse=(0.6, 0.6), spin=9.0)
    events, so_far = played(60)
    assert events == [event for event in forked.events if event.t <= 4.0]
    assert so_far.state("ball", 3.3) == forked.state("ball", 3.3)
    assert so_far.fork(2.5).state("ball", 3.3) == forked.state("ball", 3.3)


RESTORED = """
import json, pickle, sys
from sandbox import World
found = []
for saved, until in pickle.load(open(sys.argv[1], "rb")):
    world = World.restore(saved)
    events = []
    while world.t < until and world.ended not in ("until", "duration"):
        world.step(until - world.t)
        events += world.events
    found.append([world.t, events, world.state])
print(json.dumps(found, default=dict))
"""


def test_each_scene_goes_on_exactly_in_another_process(tmp_path):
    """From five times, for a tenth of a second."""
    saves, expected = [], []
    for name in SCENES:
        world, run = World(sandbox.load(name, SCENES[name])), sandbox.simulate(sandbox.load(name, SCENES[name]))
        for share in (0.0, 0.2, 0.45, 0.7, 0.9):
            world.step(max(0.0, share * run.duration - world.t))
            saved = world.save()
            until = min(world.t + (0.02 if name == "collisions/dominoes" else 0.1), run.duration)
            events = stepped(world, until, 60)
            saves.append((saved, until))
            expected.append([world.t, events, dict(world.state)])
            world = World.restore(saved)
    file = tmp_path / "saves"
    file.write_bytes(pickle.dumps(saves))
    done = subprocess.run([sys.executable, "-c", RESTORED, str(file)], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert len(found) == 5 * len({each.name for each in listings() if "/" not in each.name} | SCENES.keys())
    assert found == json.loads(json.dumps(expected))


def test_a_changed_world_is_restored_with_its_changes():
    world = World(Setup([ball()], [FLOOR], duration=30.0))
    world.step(0.5)
    world.apply(velocity=(1.0, 3.0))
    world.apply(add=ball("two", (5.0, 3.0)))
    world.step(0.2)
    saved = world.save()
    events = stepped(world, 2.0, 60)
    other = World.restore(saved)
    assert (other.t, other.state.keys()) == (0.7, {"ball", "two"})
    assert stepped(other, 2.0, 144) == events
    assert other.state == world.state


def test_what_rests_can_be_set_in_motion_again():
    world = World(Setup([ball(position=(0.0, 0.12))], [FLOOR], duration=30.0))
    world.step(1.0)
    assert (world.ended, world.t) == ("rest", 1.0)
    world.apply(velocity=(0.0, 2.0))
    world.step(0.1)
    assert world.ended == ""
    assert world.state["ball"].y == pytest.approx(0.12 + 0.2 - 0.5 * 9.81 * 0.01, abs=1e-9)


def test_it_ends_as_its_setup_says():
    world = World(Setup([ball()], [FLOOR], duration=30.0, until=Touches("floor")))
    world.step(1.0)
    assert (world.ended, world.t) == ("until", world.events[-1].t)
    world.step(1.0)
    assert (world.t, world.events) == (world.run().duration, [])
    short = World(Setup([ball()], [FLOOR], duration=0.5))
    short.step(1.0)
    assert (short.ended, short.t) == ("duration", 0.5)


def test_events_of_a_contact_come_in_their_frame():
    """Those of a cluster are known at its start."""
    scene = sandbox.load("billiards/nine-ball-break")
    run, world = sandbox.simulate(scene), World(scene)
    hits = sorted({event.t for event in run.events if event.kind == "impact"})[:12]
    for before, after in pairwise(hits):
        world.step(0.5 * (before + after) - world.t)
        assert [event.t for event in world.events] == [before] * len(world.events)
        assert world.events
        assert world.state["cue"] == run.state("cue", world.t)


def test_caught_and_removed_balls_are_gone():
    world = World(heap_of_three().setup)
    world.step(0.3)
    world.apply(remove=["left"])
    assert world.state.keys() == {"right", "top"}
    world.step(0.1)
    assert [event.kind for event in world.events if event.ball == "left"] == ["removed"]


@pytest.mark.parametrize("dt", [-0.1, float("nan"), float("inf"), "1"])
def test_a_step_must_be_a_time(dt):
    with pytest.raises(RequestError, match="must be a finite number, and not negative"):
        World(Setup([ball()], [FLOOR])).step(dt)


def test_an_invalid_change_changes_nothing():
    world, other = World(Setup([ball()], [FLOOR])), World(Setup([ball()], [FLOOR]))
    for each in (world, other):
        each.step(0.3)
    with pytest.raises(RequestError, match="would overlap 'floor'"):
        world.apply(velocity=(1.0, 1.0), position=(0.0, 0.0))
    for each in (world, other):
        each.step(1.0)
    assert (world.state, world.events) == (other.state, other.events)


def runaway():
    """A ball that leaves its bounds after 1 s."""
    return Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0), (10.0, 0.0))], bounds=Bounds(right=10.0), duration=60.0)


def test_after_an_error_it_stands_and_refuses_to_go_on():
    world = World(runaway())
    with pytest.raises(RunError, match="outside the world") as first:
        stepped(world, 60.0, 10)
    stands, t = world.state["ball"], world.t
    assert stands.x == pytest.approx(10.0 * t)
    assert stands.x <= 10.0
    with pytest.raises(RunError, match=re.escape(str(first.value)) + r"; this world goes on when something is changed"):
        world.step(0.1)
    assert (world.t, world.state["ball"], world.run().duration) == (t, stands, t)
    restored = World.restore(world.save())
    for each in (world, restored):
        with pytest.raises(RunError, match="goes on when"):
            each.step(0.1)
        each.apply(velocity=(-10.0, 0.0))
        each.step(0.5)
        assert each.state["ball"].x == pytest.approx(stands.x - 5.0)


def test_a_change_that_fails_changes_nothing():
    """With a force that fails at once: the world is as before, and goes on."""
    world = World(Setup([ball()], [FLOOR]))
    world.step(0.3)
    before = world.state["ball"]
    with pytest.raises(RunError, match="must return"):
        world.apply(forces=[lambda t, position, velocity, spin: ("much", 0.0)])
    assert world.state["ball"] == before
    world.step(0.1)
    unchanged = sandbox.simulate(Setup([ball()], [FLOOR])).state("ball", 0.4)
    assert world.state["ball"] == pytest.approx(unchanged, abs=1e-12)


def test_a_force_must_not_read_the_world_that_steps_it():
    worlds = []

    def drawn(t, position, velocity, spin):
        return (worlds[0].state["two"].x if worlds else 0.0), 0.0

    worlds.append(World(Setup([ball(), ball("two", (5.0, 3.0))], [FLOOR])))
    with pytest.raises(RunError, match="reads it while it is stepped"):
        worlds[0].apply(forces={"ball": [drawn]})


def test_a_world_goes_on_from_a_run():
    run = sandbox.simulate("golf")
    world = World(run, t=2.0)
    world.apply({"air.wind": [-15.0, 0.0]})
    world.step(1.0)
    assert world.state["ball"] == run.fork(2.0, {"air.wind": [-15.0, 0.0]}).state("ball", 3.0)
    ended = World(run)
    assert (ended.t, ended.ended, ended.events) == (run.duration, run.ended, [])
    ended.apply(velocity=(0.0, 10.0))
    ended.step(0.5)
    assert ended.state["ball"].y > 4.0 * ended.run().state("ball", run.duration).y
    with pytest.raises(RequestError, match="the run is from 0 to"):
        World(run, t=1e3)
    plain = sandbox.simulate(Setup([ball()], duration=0.1), resolve(method="plain"))
    with pytest.raises(RequestError, match="cannot go on"):
        World(plain)


def test_a_save_without_history_does_not_grow():
    floor = Surface("floor", Segment((-99.0, 0.0), (99.0, 0.0)), 1.0, 0.1)
    world, sizes = World(Setup([ball()], [floor], duration=600.0)), []
    for _ in range(4):
        for _ in range(50):
            world.step(0.2)
        sizes.append(len(world.save(history=False)))
    assert max(sizes) < 1.1 * sizes[1]
    assert len(world.save()) > 2 * len(world.save(history=False))
    restored = World.restore(world.save(history=False))
    for each in (world, restored):
        each.step(3.0)
    assert (restored.state, restored.events) == (world.state, world.events)
    assert restored.run().state("ball", world.t) == pytest.approx(world.state["ball"], abs=1e-12)


def test_a_save_without_history_keeps_what_until_counts():
    ends = Setup([ball()], [Surface("floor", Segment((-9.0, 0.0), (9.0, 0.0)), 1.0, 0.0)], until=Touches("floor", 40))
    world = World(ends)
    while len(world.run().events) < 30:
        world.step(0.5)
    restored = World.restore(world.save(history=False))
    for each in (world, restored):
        each.step(60.0)
    assert (restored.ended, restored.t) == (world.ended, world.t)
    assert world.ended == "until"


def test_what_cannot_be_saved_or_restored_is_said():
    world = World(Setup([ball()], [FLOOR], until=lambda event: False))
    with pytest.raises(RequestError, match=r"this world cannot be saved: .*lambda"):
        world.save()
    with pytest.raises(RequestError, match="this is no save of a world"):
        World.restore(b"a game")
    with pytest.raises(RequestError, match="this is no save of a world"):
        World.restore(pickle.dumps(3))
    with pytest.raises(RequestError, match=r'a world needs accuracy\.method = "exact"'):
        World(sandbox.load("golf", {"accuracy.method": "plain"}))


def test_a_state_has_names():
    crate = sandbox.Body("crate", position=(0.0, 3.0), shape=sandbox.box(0.4, 0.3), mass=2.0, spin=1.0, angle=0.5)
    world = World(Setup([crate], duration=1.0), accuracy="precise")
    world.step(0.25)
    assert world.state["crate"]._asdict() == pytest.approx({"x": 0.0, "y": 3.0, "vx": 0.0, "vy": 0.0, "spin": 1.0})
    assert world.angle("crate") == pytest.approx(0.75)
    assert repr(world) == "<World of a setup: t = 0.25 s, going on>"
    with pytest.raises(RequestError, match="there is no body 'box' now"):
        world.angle("box")


BLOCKS = re.findall(r"```python\n(.*?)```", (ROOT / "docs" / "world.md").read_text("utf-8"), re.DOTALL)


def test_what_the_docs_show_works(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    said = []
    for block in BLOCKS:
        exec(compile(block, "docs/world.md", "exec"), {})
        said.append(capsys.readouterr().out)
    _, _, dribble, rally, juggler = said
    assert re.match(r"\d+ bounces, \d+ pushes", dribble)
    assert len(rally.splitlines()) == 6
    assert "[]" in juggler
    assert min(map(int, re.findall(r": (\d+)", juggler))) >= 8
    assert (tmp_path / "dribble.png").is_file()


def test_a_world_of_a_scene_takes_parameters():
    """A gust from 1 s on, as a fork has it; a world of a setup has no parameters."""
    world = World("golf")
    world.step(1.0)
    world.apply({"air.wind": [-15.0, 0.0]})
    world.step(1.0)
    assert world.state["ball"] == sandbox.simulate("golf").fork(1.0, {"air.wind": [-15.0, 0.0]}).state("ball", 2.0)
    restored = World.restore(world.save())
    for each in (world, restored):
        each.step(0.5)
    assert restored.run().scene.parameters.air.wind == (-15.0, 0.0)  # type: ignore[attr-defined]
    assert world.state == restored.state
    with pytest.raises(RequestError, match="of a setup: only one of a scene has parameters"):
        World(Setup([ball()], [FLOOR])).apply({"air.wind": [0.0, 0.0]})


def test_surfaces_that_move_are_where_they_are_when_they_change():
    """A blade that has turned away from where it is drawn, and goes on otherwise: the ball there is not in it."""
    blade = Surface("blade", Segment((0.0, 0.0), (1.0, 0.0)), 0.5, 0.3)
    turns, stops = Turning((0.0, 0.0), 1.0, 0.3), Turning((0.0, 0.0), 0.0, 0.9)
    world = World(Setup([Ball("ball", 0.5, 0.05, (0.5, -0.03), (0.0, 0.06))], [Moving(blade, turns)], duration=9.0))
    world.step(0.5)
    world.apply(surfaces=[Moving(blade, InTurn([(0.0, turns), (0.6, stops)]))])
    world.step(0.5)
    assert world.state["ball"].y == pytest.approx(0.03, abs=1e-9)
