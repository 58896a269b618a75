"""The kernel of many shots: interpreted it gives what arrays give; compiled, the bits of the interpreted one."""

from __future__ import annotations

import random
from dataclasses import replace
from math import inf
from pathlib import Path

import numpy as np
import pytest

import sandbox
from sandbox.engine.kernel import building, library
from sandbox.engine.kernel.checking import check, interpreted
from sandbox.engine.kernel.rows import tables
from sandbox.engine.many import batch
from sandbox.engine.many.stacking import FEWEST
from sandbox.engine.model.accuracy import resolve
from sandbox.engine.paths import bernstein, quintic
from sandbox.errors import RequestError

#: Shots of a scene that are compared, by the ranges of speed and angle: with rims, grass, courts, wind, rolling.
SCENES = {
    "basketball": ((6.5, 8.3), (40.0, 70.0)),
    "golf": ((20.0, 60.0), (8.0, 50.0)),
    "golf/slide-3": ((20.0, 60.0), (8.0, 50.0)),
    "tennis": ((20.0, 40.0), (0.0, 12.0)),
    "soccer": ((15.0, 30.0), (5.0, 35.0)),
    "baseball": ((20.0, 45.0), (10.0, 60.0)),
    "volleyball": ((8.0, 25.0), (0.0, 40.0)),
}


def _facts(name: str) -> tuple[dict[str, np.ndarray], tuple[str, ...]]:
    (slow, fast), (low, high) = SCENES[name]
    numbers = random.Random(3)
    points = {
        "launch.speed": [numbers.uniform(slow, fast) for _ in range(30)],
        "launch.angle": [numbers.uniform(low, high) for _ in range(30)],
    }
    found = sandbox.simulate_many(name, points)
    assert not found.errors
    return {**found.facts}, tuple(found.facts)


@pytest.mark.parametrize("name", SCENES)
def test_legs_give_the_facts_of_arrays(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    legs = 0

    def counting(first: int, *arrays: np.ndarray) -> int:
        nonlocal legs
        legs += 1
        return interpreted(first, *arrays)

    monkeypatch.setattr(batch, "compiled", lambda: None)
    before, keys = _facts(name)
    monkeypatch.setattr(batch, "compiled", lambda: counting)
    after, _ = _facts(name)
    assert legs > 0
    for key in keys:
        one, other = before[key], after[key]
        if one.dtype == float:
            np.testing.assert_allclose(other, one, rtol=1e-9, atol=1e-9, err_msg=key)
        else:
            assert one.tolist() == other.tolist(), key


def test_bullets_of_the_kernel_are_those_of_runs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not those of arrays: at a kink of the Mach table rounding decides whether a step is accepted."""
    monkeypatch.setattr(batch, "compiled", lambda: interpreted)
    speeds = np.linspace(300.0, 900.0, 2 * FEWEST).tolist()
    found = sandbox.simulate_many("bullet", {"launch.speed": speeds}).facts["height"]
    alone = [sandbox.simulate(sandbox.load("bullet", {"launch.speed": speed})).result["height"] for speed in speeds[:3]]
    assert found[:3].tolist() == pytest.approx(alone, abs=1e-12)


def test_legs_end_with_the_line_that_ends_their_run(monkeypatch: pytest.MonkeyPatch) -> None:
    points = {"launch.speed": np.linspace(6.5, 8.3, FEWEST).tolist()}
    steps = []
    for fly_all in (None, interpreted):
        monkeypatch.setattr(batch, "compiled", lambda fly_all=fly_all: fly_all)
        runs = sandbox.simulate_many("basketball", points, facts=["made"]).runs
        steps.append([run.numerics.steps for run in runs])
    assert steps[0] == steps[1]


@pytest.mark.skipif(library.compiled() is None, reason="sandbox compile has not been run")
def test_compiled_bits_are_those_of_python() -> None:
    fly_all = library.compiled()
    assert fly_all is not None
    check(fly_all, 100)


def test_own_force_is_not_flown_in_the_kernel() -> None:
    setup = sandbox.load("golf").build()
    ball = setup.balls[0]
    assert tables(setup, resolve(), 1) is not None
    forces = [*ball.forces, lambda t, position, velocity, spin: (0.0, 0.0)]
    assert tables(replace(setup, balls=[replace(ball, forces=forces)]), resolve(), 1) is None
    assert tables(setup, resolve(integrator="rk4"), 1) is None


def test_compile_without_numba_says_what_is_missing(monkeypatch: pytest.MonkeyPatch) -> None:
    def no_module(name: str) -> object:
        raise ImportError(name)

    monkeypatch.setattr(building, "import_module", no_module)
    with pytest.raises(RequestError, match=r"needs numba: pip install"):
        building.install()
    monkeypatch.setenv("CC", "no-such-compiler")
    with pytest.raises(RequestError, match="needs a C compiler"):
        building.install()


def test_a_cache_without_room_is_named_before_anything_is_built(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    with pytest.raises(RequestError, match=r"sports-sandbox: the library cannot be put there: not a directory"):
        building.install()


def test_quintics_are_those_of_any_degree() -> None:
    numbers = random.Random(5)
    crossing = bernstein.of_quintics(bernstein.crossing)
    for _ in range(400):
        x, y = (tuple(numbers.uniform(-1.0, 1.0) for _ in range(6)) for _ in range(2))
        u = numbers.random()
        assert quintic.evaluate(x, u) == pytest.approx(bernstein.evaluate(x, u), abs=1e-14)
        assert [*quintic.as_squared(x)] == pytest.approx([*bernstein.elevate(x, 10)], abs=1e-14)
        assert [*quintic.across(x, y, u, 0.3)] == bernstein.across(x, y, u, 0.3)
        assert [*quintic.moved(x, u)] == bernstein.moved(x, u)
        b = quintic.plus(quintic.squared_length(x, y), -0.5)
        assert [*b] == bernstein.plus(bernstein.squared_length(x, y), -0.5)
        assert [*quintic.times(b, u)] == bernstein.times(b, u)
        assert [*quintic.halves(b)] == [tuple(half) for half in bernstein.halves(b)]
        assert [*quintic.derivative(b)] == bernstein.derivative(b)
        assert [*quintic.without_root_at_start(b)] == pytest.approx([*bernstein.without_root_at_start(b)], abs=1e-14)
        roots, found = [*bernstein.downward_crossings(b)], [crossing(b, -1.0)]
        while found[-1] < inf:
            found.append(crossing(b, found[-1]))
        assert found[:-1] == roots
