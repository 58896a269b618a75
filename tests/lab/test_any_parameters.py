"""Whatever parameters the bounds allow: a run ends, with finite numbers, or says by name why it does not.

That it ends soon is for the guard (tests/engine/test_guards.py): it counts steps and impacts, whatever the clock says.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from math import isfinite
from operator import or_
from typing import Any

import pytest
from hypothesis import HealthCheck, Phase, given, settings
from hypothesis import strategies as st

import sandbox
from sandbox.errors import RequestError, RunError
from sandbox.parameters import Group
from sandbox.scene import listings, parameters_of
from tests.lab.parameter_space import Overrides, everything, nearby, overrides

SCENES = [listing.name for listing in listings() if "/" not in listing.name]

#: A failing example is shown as it is: shrinking it would run many more of its kind.
quickly = settings(
    deadline=None, database=None, derandomize=True, phases=[Phase.generate], suppress_health_check=list(HealthCheck)
)


@pytest.fixture(autouse=True)
def fewer_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """What is far too stiff is refused after a tenth of the steps."""
    monkeypatch.setattr("sandbox.engine.guard.MOST_STEPS", 10_000)


def numbers(value: Any) -> Iterator[float]:
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list | tuple):
        for item in value:
            yield from numbers(item)
    elif isinstance(value, float):
        yield value


def ran(scene: str, changes: Overrides) -> bool:
    """Run, look at every number, and say whether it came to an end; a named error is an answer too."""
    run, problem = None, "t = "
    try:
        run = sandbox.simulate(sandbox.load(scene, changes))
    except RequestError:
        pass
    except RunError as error:
        problem = str(error)
    assert "t = " in problem, (problem, changes)
    if run is None:
        return False
    assert all(map(isfinite, numbers(run.result))), changes
    assert run.result.get("ended", run.ended) in ("rest", "down", "until", "duration", "cup", "water"), changes
    for ball, arcs in run.arcs.items():
        assert all(isfinite(x) for arc in arcs for x in arc.state(arc.t1)), (ball, changes)
    return True


PLAIN = st.fixed_dictionaries({"accuracy.method": st.just("plain"), "accuracy.step": st.floats(1e-2, 0.1)})


@pytest.mark.parametrize("scene", SCENES)
@pytest.mark.parametrize(
    ("space", "examples", "share"),
    [
        (lambda usual: overrides(type(usual)), 10, 0.6),
        # Every number somewhat changed. A quarter at least: a rink that is a fifth shorter has its goalie outside.
        (nearby, 8, 0.25),
        # Everything changed. Most of such scenes are refused, as what is in them overlaps; the others are odd.
        (lambda usual: everything(type(usual)), 4, 0.0),
        # The plain method may tunnel; it must not hang, crash or give NaN. Steps shorter than 10 ms only take long.
        (lambda usual: st.builds(or_, overrides(type(usual), most=3), PLAIN), 2, 0.0),
    ],
    ids=["a few changes", "nearby", "everything", "plain"],
)
def test_parameters_within_their_bounds(
    scene: str, space: Callable[[Group], st.SearchStrategy[Overrides]], examples: int, share: float
):
    """Of so many examples at least a ``share`` comes to its end; all others are refused by name."""
    ends = []

    @settings(quickly, max_examples=examples)
    @given(changes=space(parameters_of(scene)[1]))
    def runs(changes: Overrides) -> None:
        ends.append(ran(scene, changes))

    runs()
    assert sum(ends) >= share * len(ends)
