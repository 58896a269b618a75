"""Whatever parameters the bounds allow: a run ends, with finite numbers and soon, or says by name why it does not."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import suppress
from math import isfinite
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import sandbox
from sandbox.errors import SandboxError
from sandbox.scene import listings, parameters_of
from tests.lab.parameter_space import Overrides, everything, overrides

SCENES = [listing.name for listing in listings() if "/" not in listing.name]

#: Computing time in s of one run, on a slow machine.
LONGEST = 10.0

quickly = settings(max_examples=15, deadline=None, database=None, suppress_health_check=list(HealthCheck))


def numbers(value: Any) -> Iterator[float]:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list | tuple):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, float):
        yield value


def check(scene: str, changes: Overrides) -> None:
    """Run, and look at every number; a named error is an answer too."""
    started = time.process_time()
    run = None
    with suppress(SandboxError):
        run = sandbox.simulate(sandbox.load(scene, changes))
    if run is not None:
        assert all(map(isfinite, numbers(run.result))), changes
        for ball, arcs in run.arcs.items():
            assert all(isfinite(x) for arc in arcs for x in arc.state(arc.t1)), (ball, changes)
    assert time.process_time() - started < LONGEST, changes


@pytest.mark.parametrize("scene", SCENES)
def test_a_few_changes(scene: str):
    @quickly
    @given(changes=overrides(parameters_of(scene)[1]))
    def runs(changes: Overrides) -> None:
        check(scene, changes)

    runs()


@pytest.mark.parametrize("scene", SCENES)
def test_everything_changed(scene: str):
    @quickly
    @given(changes=everything(parameters_of(scene)[1]))
    def runs(changes: Overrides) -> None:
        check(scene, changes)

    runs()


@pytest.mark.parametrize("scene", SCENES)
def test_the_plain_method(scene: str):
    """It may tunnel; it must not hang, crash or give NaN. Steps shorter than 1 ms only take long."""
    plain = {"accuracy.method": st.just("plain"), "accuracy.step": st.floats(1e-2, 0.1)}

    @settings(quickly, max_examples=5)
    @given(changes=overrides(parameters_of(scene)[1], most=3), method=st.fixed_dictionaries(plain))
    def runs(changes: Overrides, method: Overrides) -> None:
        check(scene, changes | method)

    runs()
