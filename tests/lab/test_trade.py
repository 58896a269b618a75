"""Error against cost: the reference is converged, the table says what is so, the parts of a model are found."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from sandbox.cli import main
from sandbox.cli.new import new_scene
from sandbox.engine import simulate
from sandbox.engine.model.accuracy import LEVELS
from sandbox.engine.model.ball import Ball
from sandbox.engine.model.setup import Setup
from sandbox.engine.model.setup_errors import MethodFailed
from sandbox.engine.model.surface import Segment, Surface
from sandbox.errors import RunError
from sandbox.lab import reference as references
from sandbox.lab import timing, verdicts
from sandbox.lab import trade as lab
from sandbox.lab.ablation import Ablated, ablation, variants
from sandbox.lab.chart import draw
from sandbox.lab.reference import DIVERGED, REFERENCE, Reference, converge
from sandbox.lab.report import as_text
from sandbox.lab.tables import length_or_below
from sandbox.lab.verdicts import VerdictChanges, Verdicts, shot_map, verdict
from sandbox.physics.coefficients import Constant
from sandbox.physics.forces import Drag, Gravity
from sandbox.scene import load
from sandbox.scene.setup_scene import scene_of
from sandbox.sport.amounts import significant
from tests.own_scene import DROP

#: A free throw that rattles in the ring: every impact on the round tube multiplies errors.
RATTLE = "basketball/rattle"


@pytest.fixture(scope="module", autouse=True)
def fewer_settings() -> Iterator[None]:
    """A table of a few rows is enough to see whether they are right."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(lab, "RATES", (2, 60, 240))
        patch.setattr(lab, "TOLERANCES", (1e-1, 1e-3, 1e-6))
        patch.setattr(timing, "REPEATS", 2)
        patch.setattr(verdicts, "PATIENCE", 0.01)
        patch.setattr(verdicts, "FEWEST", 3)
        patch.setattr(references, "_CHECK_STEP", 1 / 500)  # s: its errors are below 2 um
        for module, longest in ((lab, "LONGEST"), (verdicts, "TOO_LONG")):
            patch.setattr(module, longest, 1e9)  # s; this machine may be busy
        yield


@pytest.fixture(scope="module")
def rattle() -> Reference:
    return converge(load(RATTLE))


@pytest.fixture(scope="module")
def basketball(fewer_settings: None) -> lab.Trade:
    return lab.trade(load("basketball"))


# Timing --------------------------------------------------------------------------------------------------------------


def test_equal_runs_take_equal_time_whichever_is_first(monkeypatch: pytest.MonkeyPatch):
    """The first run of a setup is slow, and so is the first one after the garbage is collected."""
    clock, seen, collected = [0.0], set(), [False]

    def run(setup: Setup, accuracy: object) -> None:
        clock[0] += 1.0 + 100.0 * (id(setup) not in seen) + 10.0 * collected[0]
        seen.add(id(setup))
        collected[0] = False

    monkeypatch.setattr(timing, "simulate", run)
    monkeypatch.setattr(timing, "perf_counter", lambda: clock[0])
    monkeypatch.setattr(timing.gc, "collect", lambda: collected.__setitem__(0, True))
    trials = [
        timing.Timed(Setup([Ball("ball", 1.0, 0.1, (0.0, 0.0))]), LEVELS["balanced"], lambda run: None)
        for _ in range(3)
    ]
    timing.repeat(trials)
    assert [trial.wall for trial in trials] == [1.0, 1.0, 1.0]
    assert [len(trial.warm) for trial in trials] == [2, 2, 2]


def test_a_saving_below_its_noise_is_a_dash():
    def saved(saves: float | None, noise: float) -> str:
        return Ablated("lift", "left out", ("", ""), saves=saves, saves_noise=noise).cells()[-1]

    assert saved(0.12, 0.02) == "12 %"
    assert saved(-0.12, 0.02) == "-12 %"
    assert saved(0.44, 0.3) == saved(-1.6, 0.9) == saved(0.005, 0.0) == "-"
    assert saved(None, 0.0) == ""


# The reference -------------------------------------------------------------------------------------------------------


def test_the_reference_is_better_than_the_finest_level(rattle: Reference):
    precise = rattle.error_of(simulate(rattle.setup(), LEVELS["precise"]))
    assert rattle.error < 1e-5
    assert precise < 1e-3


def test_the_reference_error_counts_bounces_left_out(tmp_path: Path):
    """A ball that bounces until it rolls, and is slowed as it rolls: its place depends on the lowest bounce."""
    new_scene(tmp_path / "beachvolley")
    scene = tmp_path / "beachvolley" / "scene.py"
    rolling = scene.read_text("utf-8").replace(', until=Touches("floor", 4)', "")
    scene.write_text(rolling.replace("level())", "level(), rolling_resistance=0.1)"), "utf-8")
    reference = converge(load(tmp_path / "beachvolley"))
    higher = simulate(reference.setup(), replace(REFERENCE, settle=16.0 * REFERENCE.settle))  # four times as wrong
    assert 1e-8 < reference.error < reference.error_of(higher) < 10.0 * reference.error


def test_errors_grow_on_the_round_ring(rattle: Reference):
    plain_flight = converge(load("basketball"))
    assert plain_flight.growth < 100.0 < rattle.growth


def test_without_air_the_reference_is_the_parabola():
    reference = converge(load("golf", {"air.density": 0.0, "launch.speed": 20.0}))
    (x, y), (vx, vy) = (ball := reference.setup().balls[0]).position, ball.velocity
    t = reference.first_touch
    touch = simulate(reference.setup(), REFERENCE).before("ball", t)[:2]
    assert touch == pytest.approx((x + vx * t, y + vy * t - 0.5 * 9.81 * t * t), abs=1e-10)


def test_a_break_is_looked_at_before_it_diverges():
    reference = converge(load("billiards/eight-ball-break"))
    assert reference.diverges_at is not None
    assert 0.0 < reference.time < reference.diverges_at
    assert reference.error < DIVERGED


# The table -----------------------------------------------------------------------------------------------------------


def test_every_method_has_its_points_and_finer_ones_are_better(basketball: lab.Trade):
    assert {"plain", "rk4", "dormand-prince", "heun"} <= {point.method for point in basketball.points}
    for method in ("plain", "heun", "rk4", "dormand-prince"):
        points = [point for point in basketball.points if point.method == method]
        errors = [point.error_m for point in points if point.error_m is not None]
        assert errors[-1] < 0.1 * errors[0]
        assert len(errors) == len(points)
    fast, balanced, precise = (basketball.levels[name].error_m for name in ("fast", "balanced", "precise"))
    assert fast > balanced > precise
    assert set(basketball.levels) == set(LEVELS)
    assert max(map(len, as_text(lab.report_of(basketball)))) <= 80


def test_a_slow_machine_measures_all_levels_and_coarse_methods(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(lab, "LONGEST", 0.0)  # s
    monkeypatch.setattr(lab, "ablation", lambda reference: [])
    monkeypatch.setattr(lab, "shot_map", lambda scene: None)
    found = lab.trade(load("soccer-curl"))
    assert set(found.levels) == set(LEVELS)
    assert [point.setting for point in found.points if point.method == "rk4"] == ["1/2 s"]


def test_the_best_is_the_cheapest_that_is_good_enough(basketball: lab.Trade):
    for target in lab.TARGETS:
        best = basketball.best(target)
        assert best is not None
        good = [point for point in basketball.points if point.error_m is not None and point.error_m <= target]
        assert best.wall_s <= 1.1 * min(point.wall_s for point in good)
    assert basketball.best(0.0) is None


def test_a_failed_run_has_a_word_in_the_table(basketball: lab.Trade):
    tunnelled, diverged = (
        replace(basketball.points[0], error_m=None, problem=said)
        for said in ("tunnelled: t = 1 s, ball 'ball': went through 'floor'", "t = 1 s, ball 'ball': diverged")
    )
    assert (tunnelled.failure, diverged.failure) == ("tunnelled", "failed")
    found = replace(basketball, points=[tunnelled, *basketball.points[1:]])
    text = "\n".join(as_text(lab.report_of(found), everything=True))
    assert re.search(r"plain +1/2 s +tunnelled", text)


def test_the_answer_is_ten_lines(basketball: lab.Trade):
    """The cheapest setting for each error, that of pymunk alone, and the ratio of their times."""
    brief = as_text(lab.report_of(basketball))
    assert len([line for line in brief if line]) <= 12
    assert max(map(len, brief)) <= 80
    best, plain = basketball.best(0.01), basketball.best(0.01, "plain")
    row = next(line for line in brief if line.startswith("  1 cm"))
    assert plain.setting in row
    assert row.split()[-1] == significant(plain.wall_s / best.wall_s)


def test_on_ice_integrators_take_part_and_on_cloth_none():
    ice = converge(load("curling", {"stones": []}))
    cloth = converge(load("billiards", {"rack": "none", "balls": [{"name": "cue"}], "cue.speed": 0.5}))
    on_ice, on_cloth = ({method for method, _, _ in lab.settings(reference)} for reference in (ice, cloth))
    assert {"plain", "rk4", "dormand-prince"} <= on_ice
    assert on_cloth == {"plain", "closed form", "level"}


@pytest.mark.parametrize("scene", ["golf", "soccer", "soccer-curl", "basketball"])
def test_the_levels_are_on_or_near_the_front(scene: str, monkeypatch: pytest.MonkeyPatch):
    """By force evaluations, which repeat: no method and setting as accurate needs less than half of them."""
    monkeypatch.setattr(lab, "RATES", (2, 5, 10, 20, 60))
    monkeypatch.setattr(lab, "TOLERANCES", (1.0, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6))
    monkeypatch.setattr(lab, "repeat", lambda *arguments: None)
    monkeypatch.setattr(lab, "ablation", lambda reference: [])
    monkeypatch.setattr(lab, "shot_map", lambda scene: None)
    found = lab.trade(load(scene))
    assert set(found.levels) == set(LEVELS)
    for level in found.levels.values():
        exact = [point for point in found.points if point.method != "plain"]
        as_good = [point.force_evaluations for point in exact if point.error_m <= level.error_m]
        assert level.force_evaluations <= 2 * min(as_good), level
        assert level.error_m <= level.accuracy.tolerance


# What each part is worth ---------------------------------------------------------------------------------------------


def parts(rows: list[Ablated]) -> dict[str, Ablated]:
    return {row.part: row for row in rows}


def test_the_parts_of_a_golf_shot():
    rows = parts(ablation(converge(load("golf"))))
    assert {"gravity", "drag", "lift", "spin decay", "drag coefficient", "deformation of the ground"} <= set(rows)
    assert rows["drag"].flight_m > 50.0
    assert rows["drag"].results["carry"][1] > 1.5 * rows["drag"].results["carry"][0]
    assert rows["rolling resistance"].flight_m == 0.0  # it has not touched the ground yet
    assert rows["rolling resistance"].shift_m > 1.0


def test_a_part_that_does_nothing_is_said_to():
    """Lift without spin, on a ball that touches nothing before the net."""
    rows = parts(
        ablation(converge(load("soccer-curl", {"launch.spin": 0.0, "launch.angle": 8.0, "wall.present": False})))
    )
    assert rows["lift"].is_nothing
    assert rows["lift"].effect == "nothing"
    assert not rows["drag"].is_nothing


def test_a_changed_verdict_shows_what_is_not_in_both():
    turned = "potted 6, first_contact 1, rest", "first_contact 1, scratch, duration"
    row = Ablated("lift", "left out", turned, 1.0, 1.0)
    assert row.effect == "potted 6, rest -> scratch, duration"


def test_numbers_that_read_the_same_are_no_change():
    results = {"apex": (3.5e-18, 0.0), "total": (4.03301, 4.03304), "carry": (1.0, -8.9e-16), "height": (1.0, 1.2)}
    row = Ablated("wind", "added", ("stops", "stops"), 1.0, 1.0, results)
    assert row.effect == "carry 1 -> 0, height 1 -> 1.2"


def test_what_is_seen_on_the_way_is_not_nothing():
    """The ball ends in the same corner of the net, but 1 cm higher it flew."""
    row = parts(ablation(converge(load("soccer/dipping-free-kick"))))["spin decay"]
    assert row.shift_m < 1e-4 < row.flight_m
    assert not row.is_nothing


def test_surface_parts_that_nothing_touches_are_idle():
    rows = parts(ablation(converge(load("soccer-curl"))))
    assert rows["friction of surfaces"].effect == "nothing: no contact"


def test_what_a_scene_leaves_out_is_put_in():
    rows = parts(ablation(converge(load("basketball", {"ball.lift.model": "none", "launch.speed": 7.465}))))
    assert rows["lift"].change.startswith("added")
    assert 0.0 < abs(rows["lift"].results["entry_offset"][1] - rows["lift"].results["entry_offset"][0]) < 0.3
    assert rows["wind"].change == "added, 1 m/s headwind"


def test_a_coefficient_as_at_the_start_is_that_of_the_start():
    setup = load("golf").build()
    change = next(variant for variant in variants(setup) if variant.part == "drag coefficient")
    ball, steady = setup.balls[0], change.setup.balls[0]
    drag = next(force for force in ball.forces if isinstance(force, Drag))
    same = next(force for force in steady.forces if isinstance(force, Drag))
    start = (0.0, ball.position, ball.velocity, ball.spin)
    assert same(*start) == pytest.approx(drag(*start))


def test_what_a_scene_has_is_left_out_and_not_put_in():
    (windy, burning) = (list(variants(load(name).build())) for name in ("golf/headwind", "rocket"))
    assert [v.change for v in windy if v.part in ("wind", "spin decay")] == ["left out", "left out"]
    assert "loss of mass" in [v.part for v in burning]


@dataclass(frozen=True)
class Gust:
    """A force of a user's own, with a field of a name that forces of the sandbox have."""

    wind: Callable[[float], float] | None

    def __call__(self, t: float, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]:
        return self.wind(t), 0.0


class DeclaredGust(Gust):
    PARTS = {"wind": None}


def blows(t: float) -> float:
    return 0.3


def blown(*forces: Gust) -> Setup:
    ball = Ball("ball", 0.5, 0.1, (0.0, 1.0), (3.0, 4.0), forces=[Gravity(9.81), Drag(coefficient=0.4), *forces])
    return Setup([ball], [Surface("floor", Segment((-50.0, 0.0), (50.0, 0.0)), 0.8, 0.4)], duration=0.5)


def test_own_forces_are_changed_only_where_they_declare_it():
    own, declared = (list(variants(blown(kind(blows)))) for kind in (Gust, DeclaredGust))
    assert all(Gust(blows) in v.setup.balls[0].forces for v in own if v.part != "gust")
    assert [v.change for v in own if v.part == "wind"] == ["added, 1 m/s headwind"]  # to the drag alone
    (without,) = (v for v in declared if v.part == "wind")
    assert (without.change, without.setup.balls[0].forces[-1]) == ("left out", DeclaredGust(None))


def test_a_part_that_fails_does_not_cost_the_table():
    rows = parts(ablation(converge(scene_of(blown(DeclaredGust(blows))))))
    assert "'NoneType' object is not callable (lab/test_trade.py, line" in rows["wind"].effect
    assert rows["declared gust"].flight_m > 0.01


@pytest.mark.parametrize(("saves", "said"), [(0.25, "25 %"), (-0.25, "-25 %"), (-4.36, "-"), (-103.73, "-")])
def test_a_run_that_became_another_saves_nothing(saves: float, said: str):
    assert Ablated("lift", "left out", ("in", "in"), 1.0, 1.0, saves=saves).cells()[-1] == said


def test_throw_and_cloth_on_a_table():
    names = {variant.part for variant in variants(load("billiards").build())}
    assert {"friction of balls (throw)", "rolling friction of the cloth"} <= names
    assert not {"lift", "wind", "spin decay", "bounce law"} & names


def test_a_setup_of_nothing_has_no_parts_but_what_it_lacks():
    ball = Ball("ball", 1.0, 0.1, (0.0, 0.0), (1.0, 0.0))
    assert list(variants(Setup((ball,), ()))) == []
    drag = Drag(0.1, 1.2, Constant(0.5))
    assert [v.part for v in variants(Setup((replace(ball, forces=(drag,)),)))] == ["drag", "wind", "lift"]


def test_throw_by_speed_is_tried_as_one_number():
    changes = [variant.change for variant in variants(load("billiards/cut").build())]
    assert "at any speed as at 1 m/s" in changes
    assert "at any speed as at 1 m/s" not in [
        v.change for v in variants(load("billiards/cut", {"ball.friction": 0.05}).build())
    ]


@pytest.mark.parametrize(
    ("metres", "least", "said"), [(2e-9, 1e-8, "< 10 nm"), (2e-8, 1e-8, "20 nm"), (0.0, 0.0, "0 nm")]
)
def test_what_the_reference_cannot_tell_is_less_than_its_error(metres: float, least: float, said: str):
    assert length_or_below(metres, least) == said


def test_changes_replace_a_model_whole():
    scene = load("golf").changed({"ball.drag.model": "constant", "ball.drag.coefficient": 0.3})
    assert scene.parameters.ball.drag.coefficient == 0.3


# Verdicts ------------------------------------------------------------------------------------------------------------


def test_levels_agree_on_nearly_every_verdict(basketball: lab.Trade):
    found = basketball.verdicts
    assert found is not None
    assert shot_map(load(DROP)) is None  # without speed there is nothing to vary
    assert found.over == ("launch.speed", "launch.angle")
    assert found.methods["precise"] == Verdicts(found.shots, 0, 0)
    assert found.methods["balanced"].same >= found.methods["plain 1/60 s"].same


def test_same_other_and_failed_verdicts_are_counted_apart(monkeypatch: pytest.MonkeyPatch):
    """Shots that fail by the finest run too are the same."""
    lost = RunError("t = 1 s: outside the world")
    fell = MethodFailed("tunnelled: t = 1 s, ball 'ball': went through 'floor'")
    truth, found = ["goal", "goal", "wide", lost, "wide"], ["goal", "wide", fell, lost, lost]
    assert verdicts.compared(truth, found) == Verdicts(same=2, other=1, failed=2)
    assert [verdicts.failure(each) for each in (fell, lost)] == ["tunnelled", "RunError"]
    table = VerdictChanges(("a", "b"), 5, {"plain": Verdicts(2, 1, 2)}, {"plain": {"tunnelled": 1, "RunError": 1}})
    assert table.table().cells == [["plain", "2", "1", "2", "tunnelled 1, RunError 1"]]


@pytest.mark.parametrize(
    ("scene", "result", "said"),
    [
        ("basketball", {"verdict": "swish", "made": True, "entry_angle": 43.0}, "swish"),
        ("golf", {"holed": True, "ended": "cup", "carry": 3.0}, "holed, cup"),
        (
            "billiards",
            {"potted": ["3", "cue"], "scratch": True, "touches": ["1"], "positions": {}},
            "potted 3 cue, scratch",
        ),
        ("billiards", {"first_contact": "1", "ended": "rest", "potted": []}, "first_contact 1, rest"),
        ("golf", {"carry": 3.0}, ""),
    ],
)
def test_a_result_in_words(scene: str, result: dict[str, object], said: str):
    assert verdict(load(scene), result) == said


# The command ---------------------------------------------------------------------------------------------------------


def test_the_command_prints_json_and_draws(capsys: pytest.CaptureFixture[str], tmp_path: Path):
    chart = tmp_path / "trade.png"
    assert main(["trade", str(DROP), "--set", "launch.speed=3", "--json", "--plot", str(chart)]) == 0
    found = json.loads(capsys.readouterr().out)
    assert {"points", "levels", "ablation", "verdicts", "best", "reference"} <= set(found)
    assert set(found["levels"]) == {"fast", "balanced", "precise"}
    point = found["points"][0]
    assert {"method", "setting", "error_m", "wall_s", "force_evaluations", "times_real_time", "stable"} <= set(point)
    with Image.open(chart) as picture:
        assert min(picture.size) > 600


def test_names_of_levels_hide_no_point(basketball: lab.Trade, monkeypatch: pytest.MonkeyPatch, tmp_path: Path):
    """Also where the levels have one error, that of the reference, and stand in a row among points."""
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation

    drawn: list[Figure] = []
    monkeypatch.setattr(Figure, "savefig", lambda figure, *_, **__: drawn.append(figure))
    points = [replace(basketball.points[-1], times_real_time=float(speed), error_m=0.0) for speed in range(1, 9)]
    levels = {name: replace(points[place], method="level") for place, name in ((1, "precise"), (4, "balanced"))}
    draw(lab.report_of(replace(basketball, points=points, levels=levels)), tmp_path / "trade.png")
    (axes,) = drawn[0].axes
    drawn[0].draw_without_rendering()
    names = [text for text in axes.texts if isinstance(text, Annotation) and text.get_text() in levels]
    places = [axes.transData.transform(line.get_xydata()) for line in axes.lines if line.get_marker() in ("o", "D")]
    assert len(names) == 2
    for name in names:
        box = name.get_window_extent()
        assert not any(box.contains(*place) for line in places for place in line)


def test_the_command_prints_tables(
    basketball: lab.Trade, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr(lab, "trade", lambda scene, progress: basketball)
    assert main(["trade", "basketball", "--all"]) == 0
    out = capsys.readouterr().out
    for heading in (
        "levels",
        "pymunk alone",
        "effect of each part of the model",
        "dormand-prince",
        "verdicts, compared",
    ):
        assert heading in out
    without = as_text(lab.report_of(replace(basketball, verdicts=None)))
    assert "verdicts" not in "".join(without).replace("the verdicts", "")


def test_a_picture_of_another_kind_is_refused_before_any_work(capsys: pytest.CaptureFixture[str]):
    assert main(["trade", "golf", "--plot", "chart.jpg"]) == 2
    assert "must end in .png" in capsys.readouterr().err


def test_without_matplotlib_the_command_says_how_to_get_it(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
):
    import sys

    monkeypatch.setitem(sys.modules, "matplotlib", None)
    assert main(["trade", "golf", "--plot", str(tmp_path / "chart.png")]) == 2
    assert "pip install matplotlib" in capsys.readouterr().err
