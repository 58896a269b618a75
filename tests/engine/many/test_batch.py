"""Many shots at once go the way that each goes alone."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import chain
from time import perf_counter
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import sandbox
from sandbox.engine import simulate, simulate_many
from sandbox.engine.contact.touch import Obstacle
from sandbox.engine.impact.impulses import DiscOnGround, ImpactContact, after_contacts_at_once
from sandbox.engine.many import batch
from sandbox.engine.many.arc_rows import ArcRows, Paths
from sandbox.engine.many.continuation import BatchExit, Continuation, ExitReason
from sandbox.engine.many.outlines import BatchSurfaces
from sandbox.engine.many.stacking import NotStackable, Stack, selector, stacked
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.event import Event
from sandbox.engine.model.setup import Bounds, ForceRegion, Setup
from sandbox.engine.model.shapes import box
from sandbox.engine.model.surface import Bounce, Circle, Segment, Surface
from sandbox.engine.model.tolerances import TOUCHING_GAP
from sandbox.engine.paths.arc import Arc, hermite_arc
from sandbox.engine.paths.path import Above, Path, climb
from sandbox.engine.paths.run import Run
from sandbox.errors import ExitCalled, RunError
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity
from sandbox.physics.impulse import after_impulse, exchange
from sandbox.scene import listings, load

#: Positions and times before the first impact, in m and s.
EQUAL = 1e-9

FLOOR = Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.7, 0.4)
POST = Surface("post", Circle((3.0, 1.0), 0.1), 0.6, 0.3)


def thrown(speed: float = 5.0, angle: float = 0.6, extra: Any = None, **others: Any) -> Setup:
    forces = [Gravity(9.81, 0.6), Drag(0.12, 1.2, Constant(0.5)), *([] if extra is None else [extra])]
    velocity = (speed * math.cos(angle), speed * math.sin(angle))
    ball = Ball("ball", 0.6, 0.12, (0.0, 2.0), velocity, -5.0, forces=forces)
    return Setup([ball], [FLOOR, POST], **{"duration": 4.0, **others})


@pytest.fixture(autouse=True)
def small_batches(monkeypatch: pytest.MonkeyPatch) -> None:
    """Batches of ten: what is left in one goes on alone at the same share as in one of thirty."""
    monkeypatch.setattr(batch, "FEWEST", 8)


@pytest.fixture
def left(monkeypatch: pytest.MonkeyPatch) -> list[ExitReason]:
    """Why each shot that was continued alone had left its batch."""
    reasons: list[ExitReason] = []
    resume = Continuation.resume

    def noted(self: Continuation, left: BatchExit, events: list[Event]) -> Run:
        reasons.append(left.reason)
        return resume(self, left, events)

    monkeypatch.setattr(Continuation, "resume", noted)
    return reasons


@pytest.fixture
def flown(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """How many shots flew in each batch that came to its end."""
    sizes: list[int] = []
    fly = batch.Batch.fly

    def counted(self: batch.Batch) -> None:
        fly(self)
        sizes.append(len(self.setups))

    monkeypatch.setattr(batch.Batch, "fly", counted)
    return sizes


def assert_same(together: Run | Exception, alone: Run) -> None:
    assert isinstance(together, Run), together
    assert together.ended == alone.ended
    assert [(e.kind, e.partner) for e in together.events] == [(e.kind, e.partner) for e in alone.events]
    first = next((e.t for e in alone.events if e.kind == "impact"), alone.duration)
    name = alone.setup.balls[0].name
    for t in np.linspace(0.0, 0.999 * first, 7):
        assert together.state(name, t)[:2] == pytest.approx(alone.state(name, t)[:2], abs=EQUAL)
    for mine, theirs in zip(together.events, alone.events, strict=True):
        assert (mine.t, mine.x, mine.y, mine.speed) == pytest.approx(
            (theirs.t, theirs.x, theirs.y, theirs.speed), abs=1e-5
        )
    ends = [tuple(run.state(name, run.duration)) for run in (together, alone)]
    assert ends[0] == pytest.approx(ends[1], abs=1e-4)
    modes = [
        [getattr(arc.contact, "mode", "") for arc in run.arcs[name] if arc.t1 > arc.t0] for run in (together, alone)
    ]
    assert modes[0] == modes[1]
    counted = ("steps", "refined_steps", "impacts")
    assert [getattr(together.numerics, c) for c in counted] == [getattr(alone.numerics, c) for c in counted]
    assert together.numerics.queries >= alone.numerics.queries  # which asks nothing beyond the first touch it finds


def or_error(setup: Setup) -> Run | Exception:
    try:
        return simulate(setup, resolve())
    except Exception as error:
        return error


SHOTS = {
    "golf": {"launch.speed": (20.0, 76.0), "launch.angle": (5.0, 50.0), "launch.spin": (0.0, 6000.0)},
    "basketball": {"launch.speed": (6.0, 9.0), "launch.angle": (35.0, 75.0), "hoop.distance": (4.0, 4.6)},
    "soccer": {"launch.speed": (15.0, 35.0), "launch.angle": (5.0, 50.0)},
}


@pytest.mark.parametrize("name", SHOTS)
def test_scenes_agree_with_the_engine_one_by_one(name: str, flown: list[int]):
    rng = np.random.default_rng(1)
    scenes = [load(name, {key: rng.uniform(*span) for key, span in SHOTS[name].items()}) for _ in range(12)]
    accuracy = resolve()
    setups = [scene.build() for scene in scenes]
    for scene, setup, together in zip(scenes, setups, simulate_many(setups, accuracy), strict=True):
        alone = simulate(setup, accuracy)
        assert_same(together, alone)
        assert isinstance(together, Run)
        numbers = scene.result(alone)
        for key, value in scene.result(together).items():
            assert value == (pytest.approx(numbers[key], abs=1e-5) if isinstance(value, float) else numbers[key]), key
    assert flown == [12]


def test_different_kinds_run_one_at_a_time(flown: list[int]):
    setups = [thrown(4.0 + 0.1 * i, extra=Gravity(1.0, 0.1) if i == 12 else None) for i in range(0, 30, 3)]
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert_same(run, simulate(setup, resolve()))
    assert flown == []


def test_radius_mass_and_shapes_may_differ():
    setups = []
    for i in range(0, 30, 3):
        ball = Ball("ball", 0.1 + 0.02 * i, 0.05 + 0.003 * i, (0.0, 2.0), (4.0, 1.0), forces=[Gravity(9.81, 1.0)])
        hill = Surface("hill", Segment((1.0, 0.0), (3.0, 0.01 * i), 0.02), 0.6, 0.1 + 0.01 * i, lowest_bounce=0.01)
        setups.append(Setup([ball], [FLOOR, hill], duration=3.0))
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert_same(run, simulate(setup, resolve()))


def test_a_passage_just_where_an_arc_ends_is_found_once():
    setups = [thrown(4.0 + 0.1 * i) for i in range(0, 30, 3)]
    for setup, together in zip(setups, simulate_many(setups, resolve()), strict=True):
        alone = simulate(setup, resolve())
        point = together.arcs["ball"][1].end[:2]
        passed = [[t for t, _ in run.crossings("ball", point, (-1.0, 0.0))] for run in (together, alone)]
        assert passed[0] == pytest.approx(passed[1])
        assert len(passed[0]) == 1


@dataclass(frozen=True)
class Growing:
    """A force and a torque that grow with time."""

    x: float = 0.0  # N/s
    y: float = 0.0
    torque: float = 0.0  # N m/s

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return self.x * t, self.y * t

    def turning(self, t: Any, position: Any, velocity: Any, spin: Any) -> Any:
        return self.torque * t


def rolled(i: int, rise: float, slope: dict[str, float], wall: dict[str, float], growing: Growing | None) -> Setup:
    """On a slope, to a wall, with another spin and speed each."""
    forces: list[Any] = [Gravity(9.81, 0.4), Drag(0.1, 1.2, Constant(0.5))]
    torques: list[Any] = []
    if growing is not None:
        forces, torques = [*forces, growing], [growing.turning]
    start, velocity = (-2.0, 0.12 - 0.04 * rise), (0.15 * i, 0.0)
    ball = Ball("ball", 0.4, 0.1, start, velocity, 20.0 - 2.0 * i, forces=forces, torques=torques)
    line = Segment((-5.0, -0.1 * rise), (5.0, 0.1 * rise))
    on = {"friction": 0.05 + 0.02 * i, "rolling_resistance": 0.03, **slope}
    ends = Segment((3.0, -2.0), (3.0, 2.0))
    against = {"restitution": 0.5, "friction": 0.2, **wall}
    return Setup([ball], [Surface("slope", line, 0.3, **on), Surface("wall", ends, **against)], 6.0)


@pytest.mark.parametrize(
    ("rise", "slope", "wall", "growing", "reasons"),
    [
        (0.0, {}, {}, None, set()),
        (1.0, {}, {}, None, set()),  # back down again
        (1.0, {"friction": 0.015}, {}, None, {ExitReason.IN_FLIGHT}),  # with little grip, off the slope
        (-1.0, {"rolling_resistance": 0.0}, {}, None, set()),
        (0.0, {"lowest_bounce": 0.05}, {}, None, set()),
        (0.0, {}, {"restitution": 0.0}, None, {ExitReason.AFTER_IMPACT}),  # stays at the wall
        (
            -1.0,
            {"friction": 0.0},
            {"friction": 0.5},
            None,
            {ExitReason.BEFORE_IMPACT},
        ),  # with backspin, pressed down by the wall
        (0.0, {}, {}, Growing(torque=0.05), {ExitReason.IN_FLIGHT}),  # loses its grip
        (
            0.0,
            {},
            {},
            Growing(y=2.0),
            {ExitReason.IN_FLIGHT, ExitReason.CONTACT_CHANGE},
        ),  # is lifted off, some from rest
    ],
)
def test_sliding_and_rolling_agree_with_the_engine_one_by_one(
    monkeypatch: pytest.MonkeyPatch,
    left: list[ExitReason],
    rise: float,
    slope: dict[str, float],
    wall: dict[str, float],
    growing: Growing | None,
    reasons: set[ExitReason],
):
    monkeypatch.setattr(batch, "FEWEST", 1)
    setups = [rolled(i, rise, slope, wall, growing) for i in range(0, 30, 3)]
    for setup, together in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert_same(together, simulate(setup, resolve()))
    assert set(left) == reasons


def test_a_patch_is_stepped_through_as_alone():
    def kick(t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return 50.0 * np.exp(-(((position[0] - 2.0) / 0.02) ** 2)), 0.0

    force_regions = [ForceRegion(1.9, -1.0, 2.1, 9.0, 0.002)]
    setups = [thrown(4.0 + 0.1 * i, extra=kick, force_regions=force_regions) for i in range(0, 30, 3)]
    runs = list(simulate_many(setups, resolve()))
    for setup, run in zip(setups, runs, strict=True):
        assert_same(run, simulate(setup, resolve()))
    without = simulate(thrown(4.0, extra=kick), resolve())
    assert isinstance(runs[0], Run)
    assert abs(without.state("ball", 0.8)[2] - runs[0].state("ball", 0.8)[2]) > 0.01  # it was leapt over


@pytest.mark.parametrize("level", ["fast", "precise"])
def test_other_levels(level: str):
    setups = [thrown(5.0 + 0.1 * i) for i in range(0, 30, 3)]
    for setup, run in zip(setups, simulate_many(setups, resolve(level)), strict=True):
        assert_same(run, simulate(setup, resolve(level)))


def test_until_is_asked_after_each_impact():
    setups = [thrown(4.0 + 0.05 * i, until=lambda event: event.partner == "floor") for i in range(0, 30, 3)]
    for run in simulate_many(setups, resolve()):
        assert isinstance(run, Run)
        assert run.ended == "until"
        assert run.events[-1].partner == "floor"
        assert run.duration == run.events[-1].t


def _is_partner(name: str, event: Event) -> bool:
    return event.partner == name


def test_a_ball_that_is_to_stay_is_asked_for_its_last_event():
    """Dropped flat on dead ground after a bounce off a lively ledge: the second impact ends the run, and is lasting."""
    ledge = Surface("ledge", Segment((-1.0, 1.0), (0.3, 1.0)), 0.9, 0.0)
    dead = Surface("dead", Segment((-9.0, 0.0), (9.0, 0.0)), 0.0, 0.5)
    drops = [
        Ball("ball", 0.6, 0.12, (0.0, 1.5 + 0.01 * i), (1.0, 0.0), forces=[Gravity(9.81, 0.6)]) for i in range(0, 30, 3)
    ]
    for ends in ("dead", "ledge"):
        setups = [
            Setup([ball], [ledge, dead], duration=3.0, until=lambda event, ends=ends: event.partner == ends)
            for ball in drops
        ]
        for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
            assert_same(run, simulate(setup, resolve()))
            assert run.ended == "until"


def test_a_spin_that_changes_fast_asks_for_short_steps():
    def swinging(t: Any, position: Any, velocity: Any, spin: Any) -> Any:
        return np.sin(60.0 * t)

    balls = [Ball("ball", 1.0, 0.1, (0.0, 1.0 + 0.1 * i), torques=[swinging]) for i in range(0, 30, 3)]
    setups = [Setup([ball], [FLOOR], duration=1.0) for ball in balls]
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert_same(run, simulate(setup, resolve()))


def test_a_touch_in_the_last_instant():
    falling = Ball("ball", 1.0, 0.5, (0.0, 1.5), (0.0, -1.0))
    moment = simulate(Setup([falling], [FLOOR], duration=2.0), resolve()).events[0].t
    setups = [Setup([falling], [FLOOR], duration=moment + i * 2.3e-16) for i in range(-15, 15)]
    runs = list(simulate_many(setups, resolve()))
    assert any(run.events[-1].t == run.duration for run in runs if isinstance(run, Run) and run.events)
    for touched in ([len(run.events) for run in runs], [len(simulate(setup, resolve()).events) for setup in setups]):
        assert touched == sorted(touched)
        assert touched[0] == 0 < touched[-1] == 1


def test_leaving_the_world_is_an_error_as_alone():
    setups = [thrown(1.0 + 0.3 * i, bounds=Bounds(-5.0, -5.0, 6.0, 9.0)) for i in range(0, 40, 4)]
    runs = list(simulate_many(setups, resolve()))
    assert 1 < sum(isinstance(run, RunError) for run in runs) < 9
    for setup, run in zip(setups, runs, strict=True):
        alone = or_error(setup)
        if isinstance(alone, Run):
            assert_same(run, alone)
        else:
            assert str(run) == str(alone)


# --------------------------------------------------------------------------------------------- what arrays are not for


def of_floats_only(t: float, position: Any, velocity: Any, spin: float) -> tuple[float, float]:
    return 0.3 * math.sin(position[0]), 0.0


def mixes_shots_up(t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
    return 0.0 * spin, -0.01 * np.max(velocity[0])


def changes_what_it_is_given(t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
    vx, vy = velocity
    vx -= 1.0  # wind
    return -0.1 * vx, -0.1 * vy


def has_another_shape(t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
    return np.reshape(velocity[0], (1, -1)), 0.0


def of_arrays_only(t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
    return velocity[0].clip(0.0, 1.0), 0.0


def not_at_the_start(t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
    return 0.1 / t, 0.0


FORCES = [of_floats_only, mixes_shots_up, changes_what_it_is_given, has_another_shape, of_arrays_only, not_at_the_start]


@pytest.mark.parametrize("force", FORCES)
def test_a_force_that_cannot_take_arrays_is_called_with_floats(force: Any, flown: list[int]):
    setups = [thrown(4.0 + 0.1 * i, extra=force) for i in range(0, 30, 3)]
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        alone = or_error(setup)
        if isinstance(alone, Run):
            assert_same(run, alone)
        else:
            assert repr(run) == repr(alone)
    assert flown == []


def test_a_force_of_a_scene_may_have_a_wind_of_any_kind(flown: list[int]):
    class Sail:
        @property
        def wind(self) -> float:
            raise ValueError("not set")

        def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
            return 0.1 * position[1], 0.0

    sail = Sail()
    setups = [thrown(4.0 + 0.1 * i, extra=sail) for i in range(0, 30, 3)]
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert_same(run, simulate(setup, resolve()))
    assert flown == [10]


def test_forces_that_mix_shots_up_only_later_are_found_out(flown: list[int]):
    def drag(t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        speed = np.linalg.norm(velocity)  # of one ball: of many it is the norm of all
        return -0.01 * speed * velocity[0], -0.01 * speed * velocity[1]

    drops = [Ball("ball", 0.6, 0.12, (0.0, 1.0 + 0.1 * i), forces=[Gravity(9.81, 0.6), drag]) for i in range(0, 30, 3)]
    setups = [Setup([ball], [FLOOR], duration=1.0) for ball in drops]
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert_same(run, simulate(setup, resolve()))
    assert flown == []


def test_whole_numbers_are_numbers():
    balls = [Ball("ball", 1 + i, 1, (0, 5), (5, 3), 0, forces=[Gravity(9.81, 1.0 + i)]) for i in range(0, 30, 3)]
    setups = [Setup([ball], [FLOOR], duration=2) for ball in balls]
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert_same(run, simulate(setup, resolve()))


def test_an_end_that_counts_is_asked_once_about_each_event():
    def at_impact(last: int) -> Callable[[Event], bool]:
        met: list[Event] = []

        def until(event: Event) -> bool:
            met.append(event)
            return len(met) == last

        return until

    setups = [thrown(4.0 + 0.1 * i, duration=20.0, until=at_impact(9 if i % 2 else 3)) for i in range(0, 30, 3)]
    for i, run in zip(range(0, 30, 3), simulate_many(setups, resolve()), strict=True):
        assert isinstance(run, Run)
        assert (run.ended, len(run.events)) == ("until", 9 if i % 2 else 3)


def test_a_batch_without_end_goes_on_one_at_a_time(monkeypatch: pytest.MonkeyPatch, left: list[ExitReason]):
    setups = [thrown(4.0 + 0.1 * i, duration=1.0) for i in range(0, 30, 3)]
    monkeypatch.setattr(batch, "MOST_PIECES", 33)
    monkeypatch.setattr(batch, "compiled", lambda: None)  # in which shots end all at once
    began = perf_counter()
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert 0.0 < run.numerics.wall_s < perf_counter() - began
        assert_same(run, simulate(setup, resolve()))
    assert len(left) == 10


def test_the_plain_method_runs_one_at_a_time(flown: list[int]):
    accuracy = resolve(method="plain", step=5e-3)
    setups = [thrown(4.0 + 0.1 * i, duration=0.3) for i in range(0, 25, 3)]
    for setup, run in zip(setups, simulate_many(setups, accuracy), strict=True):
        assert isinstance(run, Run)
        assert run.state("ball", 0.3) == simulate(setup, accuracy).state("ball", 0.3)
    assert flown == []


def test_a_shot_that_fails_is_an_error_in_its_place():
    def hole(t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return np.where(np.asarray(position[0]) > 6.0, np.nan, 0.0), 0.0

    setups = [thrown(1.0 + 0.3 * i, angle=1.0, extra=hole) for i in range(0, 40, 4)]
    runs = list(simulate_many(setups, resolve()))
    failed = [isinstance(run, RunError) for run in runs]
    assert any(failed)
    assert not all(failed)
    for setup, run in zip(setups, runs, strict=True):
        if isinstance(run, RunError):
            with pytest.raises(RunError) as alone:
                simulate(setup, resolve())
            assert str(run).split(":")[0] == str(alone.value).split(":")[0]  # the time and the ball
            assert "nan" in str(run) or "not finite" in str(run)  # which of them depends on rounding
        else:
            assert_same(run, simulate(setup, resolve()))


def turf(normal_speed: float, tangential_speed: float) -> Bounce:
    """Gives way more at a steep impact, and tilts against the ball."""
    return Bounce(0.7 / (1.0 + 0.1 * normal_speed), 0.3 + 0.01 * tangential_speed, 0.02 * tangential_speed)


@pytest.mark.parametrize("rise", [-20.0, 0.0, 20.0])
def test_a_law_is_asked_for_both_speeds_on_a_slope(flown: list[int], rise: float):
    slope = Surface("turf", Segment((-50.0, -rise), (50.0, rise)), 0.5, 0.5, law=turf)
    setups = [replace(thrown(4.0 + 0.1 * i, 0.9), surfaces=[slope], duration=2.5) for i in range(0, 30, 3)]
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        alone = simulate(setup, resolve())
        assert alone.numerics.impacts >= 1
        assert_same(run, alone)
    assert flown == [10]


def test_what_a_scene_gets_wrong_is_an_error_of_its_shot():
    def law(normal_speed: float, tangential_speed: float) -> Bounce:
        return Bounce(1.0 / (normal_speed > 5.5), 0.1)

    def until(event: Any) -> bool:
        return 1 / int(10.0 * event.x) < 0.0  # nothing is at x = 0

    rough = Surface("rough", Segment((-50.0, 0.0), (50.0, 0.0)), 0.7, 0.4, law=law)
    drops = [Ball("ball", 0.6, 0.12, (0.1 * i, 1.0 + 0.05 * i), forces=[Gravity(9.81, 0.6)]) for i in range(0, 30, 3)]
    for surface, ending in ((rough, None), (FLOOR, until)):
        setups = [Setup([ball], [surface], duration=1.0, until=ending) for ball in drops]
        runs = list(simulate_many(setups, resolve()))
        failed = [isinstance(run, ZeroDivisionError) for run in runs]
        assert any(failed)
        assert not all(failed)
        for setup, run in zip(setups, runs, strict=True):
            if isinstance(run, ZeroDivisionError):
                with pytest.raises(ZeroDivisionError):
                    simulate(setup, resolve())
            else:
                assert_same(run, simulate(setup, resolve()))


class OwnExit(BaseException):
    """Neither an Exception nor Ctrl-C."""


@pytest.mark.parametrize("raised", [GeneratorExit, OwnExit])
@pytest.mark.parametrize("part", ["force", "law", "until"])
def test_what_is_no_exception_fails_its_shot_too(part: str, raised: type[BaseException]):
    def fail(*_: Any) -> Any:
        raise raised

    surfaces = [replace(FLOOR, law=fail) if part == "law" else FLOOR]
    changes = {"surfaces": surfaces, "until": fail if part == "until" else None}
    setups = [thrown(1.0 + 0.1 * i, -1.0, extra=fail if part == "force" else None) for i in range(0, 40, 4)]
    setups = [replace(setup, **changes) for setup in setups]
    assert {type(run) for run in simulate_many(setups, resolve())} == {ExitCalled}


def test_starts_in_touch_and_in_overlap():
    def start(height: float, up: float) -> Setup:
        ball = Ball("ball", 0.6, 0.12, (0.0, height), (1.0, up), forces=[Gravity(9.81, 0.6)])
        return Setup([ball], [FLOOR, POST], duration=1.0)

    setups = [start(0.12, 0.1 * i) for i in range(10)] + [start(0.12, -0.1 * i) for i in range(10)]
    setups += [start(0.119, 1.0), start(0.05, 1.0), *(start(0.12 + 1e-12 * i, 0.5) for i in range(10))]
    for number, (setup, run) in enumerate(zip(setups, simulate_many(setups, resolve()), strict=True)):
        if number == 21:
            assert "overlaps 'floor' at the start" in str(run)
        else:
            assert_same(run, simulate(setup, resolve()))


# ------------------------------------------------------------------------------------------------ the parts

speeds = st.floats(-30.0, 30.0)


@given(st.lists(st.tuples(speeds, st.floats(-30.0, -0.01), st.floats(-200.0, 200.0)), min_size=1, max_size=70))
def test_an_impact_is_the_same_in_any_lane_and_place(motions: list[tuple[float, float, float]]):
    radius, (along, away, spin) = 0.11, np.array(motions).T
    rng = np.random.default_rng(len(motions))
    answers = rng.uniform((0.0, 0.0, 0.3), (1.0, 1.5, 1.0), (len(motions), 3))
    slips, disc = along + radius * spin, DiscOnGround()
    together = np.array(exchange(-away, slips, answers[:, 2], answers[:, 0], answers[:, 1]))
    for i, (restitution, friction, factor) in enumerate(answers.tolist()):
        size = abs(along[i]) + abs(away[i]) + radius * abs(spin[i])
        push, rub = disc.exchange(-away[i], slips[i], factor, restitution, friction)
        assert together[:, i] == pytest.approx((push, rub), abs=1e-12 * size)
        ball = Ball("ball", 0.43, radius, (0.0, 0.0), inertia_factor=factor)
        nx, ny = math.cos(i), math.sin(i)
        before = (5.0, 3.0, away[i] * nx + along[i] * ny, away[i] * ny - along[i] * nx, spin[i])
        bounce = Bounce(restitution, friction)
        contact = ImpactContact(
            (0,),
            "floor",
            nx,
            ny,
            0.0,
            bounce,
            -away[i],
            (-away[i], slips[i], 0.0),
            (5.0 - ball.radius * nx, 3.0 - ball.radius * ny),
        )
        placed, (impulse,), _ = after_contacts_at_once([ball], {0: before}, [contact], [bounce])
        alone = after_impulse(before[2:], nx, ny, radius, factor, (push, rub, 0.0))
        assert (*alone[:2], radius * alone[2]) == pytest.approx(
            (*placed[0][2:4], radius * placed[0][4]), abs=1e-9 * size
        )
        assert impulse == pytest.approx(0.43 * push, abs=1e-9 * size)


def test_first_touches_are_those_of_single_obstacles():
    rng = np.random.default_rng(7)
    surfaces = [
        FLOOR,
        POST,
        Surface("slope", Segment((1.0, 0.2), (2.0, 1.0), 0.05), 0.5, 0.5),
        Surface("roof", Segment((-1.0, 2.0), (1.0, 2.0)), 0.5, 0.5),
    ]
    count = 400
    setup = Setup([Ball("ball", 0.6, 0.12, (0.0, 1.0))], surfaces)
    starts = np.vstack((rng.uniform((-2, 0.12), (4, 3), (count, 2)).T, rng.uniform(-8, 8, (2, count)), np.zeros(count)))
    starts[1, :100] = 0.12  # on the floor
    arcs = []
    for start in starts.T.tolist():
        x, y, u, v, _ = start
        h = 0.4
        end = (x + u * h, y + v * h - 4.9 * h * h, u, v - 9.8 * h, 0.0)
        arcs.append(hermite_arc(0.0, h, tuple(start), (0.0, -9.8, 0.0), end, (0.0, -9.8, 0.0)))
    coefficients = [np.array([getattr(arc, c) for arc in arcs]).T for c in "xy"]
    outlines = BatchSurfaces(Stack(setup, count))
    found, _ = outlines.first_touch(np.arange(count), *coefficients, lambda i: arcs[i])
    obstacles = [Obstacle(surface, 0.12) for surface in surfaces]
    touches = 0
    for arc, u in zip(arcs, found.tolist(), strict=True):
        each = [obstacle.first_touch(arc) for obstacle in obstacles]
        expected = min((e for e in each if e is not None), default=math.inf)
        assert u == pytest.approx(expected, abs=1e-13)
        touches += expected < math.inf
    assert 100 < touches < count
    _, _, near = outlines.near(np.arange(count), starts[0], starts[1])
    for i, (x, y) in enumerate(starts[:2].T.tolist()):
        each = [obstacle.near(x, y) for obstacle in obstacles]
        touching = (near for near in each if near.gap <= TOUCHING_GAP)
        nearest = next(touching, min(each, key=lambda touching: touching.gap))
        assert (near.gap[i], near.nx[i], near.ny[i], near.curvature[i]) == pytest.approx(nearest[:4], abs=1e-12)


def test_a_side_first_passed_beyond_its_end_is_still_touched():
    count = 1000
    rng = np.random.default_rng(3)
    x, y = rng.uniform(-2.0, 4.0, (6, count)), rng.uniform(-0.5, 3.0, (6, count))  # through the line and back again
    slope = Surface("slope", Segment((1.0, 0.2), (2.0, 1.0), 0.05), 0.5, 0.5)
    setup = Setup([Ball("ball", 0.6, 0.12, (0.0, 1.0))], [slope])
    arcs = []
    for xs, ys in zip(x.T.tolist(), y.T.tolist(), strict=True):
        arcs.append(Arc(0.0, 1.0, (xs[0], ys[0], 0.0, 0.0, 0.0), (xs, ys, [0.0] * 5, [0.0] * 5, [0.0] * 4)))
    found, _ = BatchSurfaces(Stack(setup, count)).first_touch(np.arange(count), x, y, lambda i: arcs[i])
    obstacle = Obstacle(slope, 0.12)
    for arc, u in zip(arcs, found.tolist(), strict=True):
        expected = obstacle.first_touch(arc)
        assert u == pytest.approx(math.inf if expected is None else expected, abs=1e-12)


@dataclass(frozen=True)
class Spring:
    stiffness: float
    law: Any
    far: tuple[float, float]

    def __call__(self, x: Any) -> Any:
        return self.stiffness * self.law(x) + self.far[1]


@dataclass(frozen=True)
class Power:
    factor: float
    squared: float = field(init=False)

    def __post_init__(self) -> None:
        if not self.factor >= 0.0:
            raise ValueError(self.factor)
        object.__setattr__(self, "squared", self.factor**2)

    def __call__(self, x: Any) -> Any:
        return self.squared * x


def test_data_is_stacked_field_by_field_and_unstacked_again():
    springs = [Spring(1.0 + i, Power(2.0 * i), (1.0, 0.1 * i)) for i in range(5)]
    stack = stacked(springs)
    x = np.array([0.5, 0.7])
    some = selector(stack)(np.array([3, 1]))
    assert some(x).tolist() == [springs[3](0.5), springs[1](0.7)]
    assert stack.far[0] == 1.0  # the same everywhere: a number still
    for place, spring in enumerate(springs):
        assert selector(stack, single=True)(place) == spring


def test_what_does_not_differ_is_not_copied():
    one = Spring(1.0, Power(2.0), (1.0, 3.0))
    assert stacked([one, Spring(1.0, one.law, (1.0, 3.0))]).law is one.law
    assert stacked([one, one]) is one
    assert selector(one)(np.array([0])) is one


class Pull:
    def __init__(self, stiffness: float) -> None:
        self.stiffness = stiffness


def test_what_is_no_data_is_alike_only_if_it_is_equal():
    for make in (Pull, lambda k: partial(pow, k), lambda k: lambda x: k * x, lambda k: {"k": k}, lambda k: {k}):
        one, other = make(1.0), make(2.0)
        assert stacked([(one, 1.0), (one, 1.0)]) == (one, 1.0)
        with pytest.raises(NotStackable):
            stacked([(one, 1.0), (other, 1.0)])


def test_what_is_built_otherwise_is_not_alike():
    spring = Spring(1.0, Power(1.0), (1.0, 3.0))
    for other in (Spring(1.0, abs, (1.0, 3.0)), replace(spring, far=(1.0, 3.0, 2.0)), replace(spring, stiffness="1.0")):
        with pytest.raises(NotStackable):
            stacked([spring, other])
    with pytest.raises(NotStackable):
        stacked([(True, "a"), (False, "a")])
    assert [part.tolist() for part in stacked([(1, 2.0), (2, 3)])] == [[1.0, 2.0], [2.0, 3.0]]  # whole ones are numbers


def test_bodies_fly_one_at_a_time(flown: list[int]):
    crates = [
        Body("crate", position=(0.0, 1.0 + 0.01 * i), velocity=(0.0, -9.0), shape=box(0.4, 0.3), mass=2.0)
        for i in range(0, 30, 3)
    ]
    setups = [Setup([crate], [FLOOR], duration=0.2) for crate in crates]
    for setup, run in zip(setups, simulate_many(setups, resolve()), strict=True):
        assert isinstance(run, Run)
        assert run.state("crate", 0.2) == simulate(setup, resolve()).state("crate", 0.2)
    assert flown == []


def test_setups_whose_parts_cannot_be_compared_run_one_at_a_time(flown: list[int]):
    setups = [replace(thrown(), balls=[replace(thrown().balls[0], forces=[Table(np.arange(3.0))])]) for _ in range(10)]
    assert all(isinstance(run, Run) for run in simulate_many(setups, resolve()))
    assert flown == []


@dataclass(frozen=True)
class Table:
    values: np.ndarray

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return 0.0 * t, -self.values[2]


@pytest.mark.parametrize("name", [listing.name for listing in listings()])
def test_setups_of_all_scenes_are_data(name: str):
    """They can be pickled, compared and stacked."""
    setup = load(name).build()
    again = load(name).build()
    assert pickle.loads(pickle.dumps(setup)) == setup == again
    assert stacked([setup, again]) == setup


def test_rows_are_the_arcs_they_were_made_from():
    run = simulate(thrown(), resolve())
    arcs = run.arcs["ball"]
    flights = [arc for arc in arcs if len(arc.x) == 6]
    numbers = [[a.t0, a.t1, *a.start, *chain(*a.curves), *a.state(a.t1)] for a in flights]
    count = len(flights)
    paths = Paths(np.array([*numbers, *numbers]), [count, 2 * count])
    rows, _ = paths[0], paths[1].passages(climb)
    assert len(rows) == len(flights) > 5
    for kept, arc in zip([*rows, rows[1], rows[-1]], [*flights, flights[1], flights[-1]], strict=True):
        assert isinstance(kept, Arc)
        middle = 0.5 * (arc.t0 + arc.t1)
        assert kept.state(middle) == arc.state(middle)
        assert kept.state(arc.t1) == arc.state(arc.t1)
    assert [(t0, t1, list(x), list(y)) for t0, t1, x, y in rows.pieces()] == [
        (t0, t1, list(x), list(y)) for t0, t1, x, y in Path(flights).pieces()
    ]
    by_rows = Run(run.setup, run.accuracy, {"ball": rows}, run.events, run.numerics, run.duration, run.ended)
    by_list = Run(run.setup, run.accuracy, {"ball": Path(flights)}, run.events, run.numerics, run.duration, run.ended)
    for point, normal in (((0.0, 0.5), (0.0, 1.0)), ((1.5, 0.0), (-0.6, 0.8)), ((0.0, 0.5), (0.0, -1.0))):
        crossings = list(by_list.crossings("ball", point, normal))
        assert crossings
        for path in (rows, paths[1], rows):  # the second one that is asked computes them all
            for (t, state), (at, there) in zip(path.passages(Above(*point, *normal)), crossings, strict=True):
                assert t == pytest.approx(at, abs=1e-13)
                assert state == pytest.approx(there, abs=1e-11)
    for moment in (0.5, 2.0, math.inf):
        t, state = by_list.highest("ball", moment)
        assert by_rows.highest("ball", moment)[0] == pytest.approx(t, abs=1e-13)
        assert by_rows.highest("ball", moment)[1] == pytest.approx(state, abs=1e-11)
    for t in (0.0, 1.0, by_list.events[0].t, by_list.duration):
        assert by_rows.before("ball", t) == by_list.before("ball", t)
        assert by_rows.state("ball", t) == by_list.state("ball", t)


def test_python_may_fly_many_too():
    swept = sandbox.sweep("basketball", {"launch.angle": np.linspace(45.0, 60.0, 40)})
    assert swept["made"].shape == (40,)


def test_the_highest_point_may_be_the_end_or_the_start():
    """Balls that still rise at the end, have fallen from the start, or turn between: each as when it flies alone."""
    forces = [Gravity(9.81), lambda t, position, velocity, spin: (0.0, 9.0 * np.sin(40.0 * t))]  # in several arcs
    floor = Surface("floor", Segment((-50.0, -50.0), (50.0, -50.0)), restitution=0.5, friction=0.2)
    speeds = np.linspace(-4.0, 8.0, 10).tolist()
    setups = [
        Setup([Ball("ball", 1.0, 0.1, (0.0, 5.0), (1.0, speed), forces=forces)], [floor], duration=0.5)
        for speed in speeds
    ]
    together = list(simulate_many(setups, resolve("balanced")))
    found = [run.highest("ball") for run in together if isinstance(run, Run)]
    alone = [simulate(setup, resolve("balanced")).highest("ball") for setup in setups]
    assert all(
        isinstance(run.arcs["ball"], ArcRows) and len(run.arcs["ball"]) > 3 for run in together if isinstance(run, Run)
    )
    assert [t for t, _ in found] == pytest.approx([t for t, _ in alone], abs=1e-9)
    assert [state[1] for _, state in found] == pytest.approx([state[1] for _, state in alone], abs=1e-9)
    assert {t for t, _ in found} >= {0.0, 0.5}
