"""Each benchmark runs with its smallest settings and writes the numbers it promises; no time is asserted."""

from __future__ import annotations

import importlib.util
import json
import math
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from sandbox.cli import main

ROOT = Path(__file__).resolve().parent.parent
FOLDER = ROOT / "benchmarks"

Run = Callable[..., Any]


@pytest.fixture
def opened(monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[str], ModuleType]]:
    """A script as a module; it and what it imports from its folder are forgotten afterwards."""
    monkeypatch.syspath_prepend(str(FOLDER))

    def load(name: str) -> ModuleType:
        spec = importlib.util.spec_from_file_location(name, FOLDER / f"{name}.py")
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        sys.modules[name] = module
        spec.loader.exec_module(module)
        return module

    yield load
    for name in [path.stem for path in FOLDER.glob("*.py")]:
        sys.modules.pop(name, None)


@pytest.fixture
def run(opened: Callable[[str], ModuleType], monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Run:
    """Runs a script in this process, with other values of some of its constants, and returns its JSON."""

    def run(name: str, *options: str, **constants: Any) -> Any:
        module, out = opened(name), tmp_path / "out.json"
        for constant, value in constants.items():
            assert hasattr(module, constant)
            setattr(module, constant, value)
        monkeypatch.setattr(sys, "argv", [name, "--json", str(out), *options])
        module.main()
        return json.loads(out.read_text("utf-8"))

    return run


def check(rows: Iterable[dict[str, Any]], *keys: str) -> None:
    """Each row has a number, finite and above 0, for each of these keys."""
    found = list(rows)
    assert found
    for row in found:
        for key in keys:
            assert math.isfinite(row[key])
            assert row[key] > 0, f"{key} of {row}"


@pytest.mark.parametrize("seed", [0, 1, 2, 18, 26, 28, 33, 50, 54, 59, 85, 90, 93, 299])
def test_random_heaps_gain_no_energy_and_do_not_overlap(opened: Callable[[str], ModuleType], seed: int):
    heaps = opened("heaps")
    found = heaps.measure(heaps.heap(seed), seed)
    assert not found.error
    assert found.gain < 1e-3
    assert found.overlap < 0.02


def test_nothing_passes_through_what_moves(run: Run):
    found = run("moving", "--quick")
    assert not any(each["error"] for each in found)
    assert sum(each["hits"] for each in found) > 4
    assert max(each["overlap"] for each in found) < 1e-6


def test_games_of_pinball_end_without_an_error(opened: Callable[[str], ModuleType]):
    """One with random keys, one that tries to hit the ball: nothing passes through, no energy is from nowhere."""
    pinball = opened("pinball")
    for seed in (0, 1):
        found = pinball.measure(seed, longest=3.0)
        assert not found["error"]
        assert found["overlap"] < 1e-9
        assert found["created_j"] < 1e-9 * found["moved_j"]


def test_intervals_of_fits_are_counted(opened: Callable[[str], ModuleType]):
    fit = opened("fit")
    (case,) = (case for case in fit.CASES if case.scene == "soccer")
    found = fit.measure(case, 3, 0, fit.OUTLIERS, True)
    assert (found.values, found.failed, len(found.seconds)) == (9, 0, 3)
    assert 6 <= found.held <= 9
    assert "9 " in fit.row("soccer", [found])


def test_what_passes_through_is_noticed(opened: Callable[[str], ModuleType]):
    """The same case with the surface out of the way, measured as if it were there."""
    moving = opened("moving")
    case = next(case for seed in range(40) if moving.measure(seed).hits for case in [moving.case(seed)])
    through = moving.simulate(replace(case.setup, surfaces=[]), moving.resolve("balanced"))
    assert moving.overlapped(through, case)[0] > 0.1


def test_error_against_time(run: Run):
    cases = run("engine", "--quick")
    reached = {"rim shot, 2.5 s": 1e-6, "golf flight to landing": 0.05}  # m, by scipy as it is asked there
    assert list(cases) == list(reached)
    for case, rows in cases.items():
        check(rows, "error_m", "time_s", "evaluations", "limit_evaluations", "limit_s", "time_over_limit")
        error = {row["method"].split()[0]: row["error_m"] for row in rows}
        assert list(error) == ["exact,", "scipy", "bare", "plain,"]
        assert {row["method"]: row["error_m"] for row in rows}["exact, balanced"] < 1e-6
        assert error["scipy"] < reached[case]


@pytest.mark.parametrize("name", ["rim_shot", "golf_flight"])
def test_the_law_written_out_is_that_of_the_setup(opened: Callable[[str], ModuleType], name: str):
    """What the peers fly by is what the engine flies by."""
    shot = getattr(opened("shots"), name)()
    ball = shot.setup.balls[0]
    for scale in (1.0, 0.7, 0.2):
        vx, vy = (scale * v for v in ball.velocity)
        now = (0.0, ball.position, (vx, vy), ball.spin)
        expected = [sum(force(*now)[axis] for force in ball.forces) / ball.mass for axis in (0, 1)]
        expected.append(sum(torque(*now) for torque in ball.torques) / ball.inertia)
        assert shot.law(vx, vy, ball.spin) == pytest.approx(expected, rel=1e-12)


def test_forces(run: Run):
    rows = run("forces", "--quick")["forces"]
    check(rows, "balls", "steps", "us_per_step", "us_per_second", "step_over_limit", "second_over_limit")
    errors = {row["method"]: row["error_m"] for row in rows if row["balls"] == 2}
    assert errors.pop("bare pymunk") is None  # it has no drag
    assert errors["exact"] < 1e-6
    assert errors["exact, many"] < 1e-6
    assert errors["batch and numpy"] == pytest.approx(errors["velocity_func"], rel=0.01)
    assert errors["plain"] < 0.01 * errors["velocity_func"]  # of second order


def test_bodies(run: Run):
    for told in run("bodies", "--quick").values():
        assert told["impacts"] >= 8
        check(told["rows"], "error_m", "time_s")
        for row in told["rows"]:
            assert row["error_m"] < 1e-3 if row["method"].startswith("exact") else row["error_m"] > 1e-2


def within(code: str, words: Iterable[str] = (), clock: Callable[[], float] | None = None) -> float:
    """The time in s of a program, called in this process: what it is given is tested, and not how it starts."""
    began = time.perf_counter()
    assert "main()" not in code or main(list(words)) == 0
    return time.perf_counter() - began


def test_sweep(run: Run):
    told = run("sweep", "--quick", process=within)
    check(told["map"]["rows"], "s_per_shot", "shots_per_s", "map_s", "over_limit")
    check(told["map"]["bare_pymunk"], "time_s", "error_m", "steps_per_s")
    check(told["shots"], "shots", "time_s", "ms_per_shot")
    check(told["balls"], "balls", "time_s", "ms_per_ball")
    check(told["commands"], "processor_s", "target_s")
    check(told["window"], "processor_s", "first_s", "target_s")
    check([told["steps"]], *told["steps"])


def test_start(run: Run):
    told = run("start", "--quick")
    check(told["starts"], "clock_s", "processor_s", "limit_clock_s", "limit_processor_s", "over_limit")
    check(told["imports"].values(), "standard library", "the sandbox and its scenes")
    assert "pymunk" in told["imports"]["sandbox run golf --json"]
    assert "pygame" in told["imports"]["window's first frame"]


def test_frames(run: Run):
    rows = run("frames", "--scenes", "soccer", MOST_FRAMES=2, ROUNDS=1)["frames"]
    check(rows, "drawing_ms", "pillow_ms", "packing_ms", "cpu_ms", "limit_frames_per_s", "whole_over_limit")


def test_worlds(run: Run):
    check(run("worlds", "--quick"), "frames", "mean_s", "worst_s")


def test_scaling(run: Run):
    found = run("scaling", "--quick", "--only", "balls,surfaces,pile,rows")
    for name, table in found.items():
        assert math.isfinite(table["exponent"])
        check(table["rows"], "time_s", "memory_mb" if name == "rows" else "events")


def test_window(tmp_path: Path):
    """In a process of its own: it chooses the display's driver."""
    out = tmp_path / "out.json"
    command = [sys.executable, FOLDER / "window.py", "soccer-curl", "--frames", "3", "--json", out]
    subprocess.run(command, check=True, capture_output=True)
    rows = json.loads(out.read_text("utf-8"))["soccer-curl"]
    check(rows.values(), "median_ms", "p95_ms", "processor_ms")


def test_our_half_of_billiards(opened: Callable[[str], ModuleType]):
    """pooltool does not live here: what is compared with it."""
    billiards = opened("billiards_pooltool")
    check([billiards.ours_cold()], "import_s", "first_s")
    cut = next(shot for shot in billiards.shots() if shot.name.startswith("cut 30"))
    answer = billiards.our_answer(billiards.our_setup(cut))
    check([answer], "seconds", "impacts", "lasts")
    assert list(answer["ends"]) == ["cue", "1"]
    assert 0.0 < billiards.seconds_of_an_impact() < answer["seconds"]


def test_the_page_has_a_place_for_each(opened: Callable[[str], ModuleType]):
    page = opened("page")
    text = page.PAGE.read_text("utf-8")
    for block in (*page.SCRIPTS, "machine"):
        filled = page.filled(text, block, ["new", "lines"])
        assert f"<!-- {block} -->\nnew\nlines\n<!-- end -->\n" in filled
        assert filled.count("<!-- end -->") == text.count("<!-- end -->") == len(page.SCRIPTS) + 1
    with pytest.raises(SystemExit, match="0 blocks 'nothing'"):
        page.filled(text, "nothing", [])
    run = {command.split()[0] for command in page.SCRIPTS.values()}
    scripts = {f"benchmarks/{path.name}" for path in FOLDER.glob("*.py") if "[--json F]" in path.read_text("utf-8")}
    assert run == scripts - {"benchmarks/window.py"}  # a line for each scene and preset: too long for the page


def test_the_page_is_written_once_when_all_have_run(
    opened: Callable[[str], ModuleType], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    """A script that fails leaves the page as it was: its numbers are all of one program on one machine."""
    page = opened("page")
    copy, before = tmp_path / "page.md", page.PAGE.read_text("utf-8")
    copy.write_text(before, "utf-8")
    for name, value in (
        ("PAGE", copy),
        ("JSON", tmp_path),
        ("PEER", copy),
        ("output_of", lambda name: [f"ran {name}"]),
    ):
        monkeypatch.setattr(page, name, value)
    monkeypatch.setattr(sys, "argv", ["page"])
    with monkeypatch.context() as failing:
        failing.setattr(page, "output_of", lambda name: [] if name != "start" else sys.exit("start failed"))
        with pytest.raises(SystemExit, match="start failed"):
            page.main()
    assert copy.read_text("utf-8") == before
    page.main()
    for name in page.SCRIPTS:
        assert f"```console\n$ python {page.SCRIPTS[name]}\nran {name}\n```\n" in copy.read_text("utf-8")
    monkeypatch.setattr(page, "PEER", tmp_path / "nowhere")
    with pytest.raises(SystemExit, match="no pooltool"):
        page.main()


def test_the_page_names_the_machine(opened: Callable[[str], ModuleType]):
    lines = opened("page").machine(0.04)
    assert f"{os.cpu_count()} cores" in lines[0]
    assert "pymunk 7" in lines[1]
    assert lines[2].endswith("0.0.")


@pytest.mark.parametrize(
    ("part", "first"), [("scenes", 3), ("setups", 0), ("bodies", 5), ("faulty", 5), ("replays", 0)]
)
def test_the_soak_tries_each_part(opened: Callable[[str], ModuleType], part: str, first: int):
    soak = opened("soak")
    found = soak.cases(part, 1, first, first + 3)
    assert {outcome for outcome, _ in found} <= set(soak.GOOD), found
    assert found == soak.cases(part, 1, first, first + 3)


def test_the_soak_notices_what_is_not_named(opened: Callable[[str], ModuleType], monkeypatch: pytest.MonkeyPatch):
    soak = opened("soak")
    monkeypatch.setitem(soak.CASES, "setups", lambda draw: 1 / 0)
    ((outcome, details),) = soak.cases("setups", 1, 7, 8)
    assert outcome == "a raw exception"
    assert details.startswith("--only setups:7: ")
    assert "ZeroDivisionError" in details
    assert outcome not in soak.GOOD


def test_the_soak_kills_sweeps(opened: Callable[[str], ModuleType]):
    soak, noted = opened("soak"), []
    kills = soak.Kills(4, 2, time.monotonic() + 600.0, lambda part, outcome: noted.append(outcome))
    kills.run()
    assert kills.done == 2
    assert {outcome for outcome, _ in noted} <= set(soak.GOOD), noted
