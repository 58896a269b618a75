"""Pictures besides posters stay as they are: strips, graphs, energy, comparisons, frames on the way."""

from __future__ import annotations

import pytest

from sandbox.picture.energy_chart import energy_charts
from sandbox.picture.graph import graph
from sandbox.picture.strip import film_strip
from tests.scenes.play import run_of

SIZE, SMALL, SMALLEST = (640, 360), (480, 270), (240, 135)


@pytest.mark.parametrize("name", ["basketball/rattle", "bowling/straight"])
def test_a_strip(golden, name: str):
    run = run_of(name)
    golden.check(f"strip-{name.replace('/', '-')}", film_strip(run.scene.picture(run, SMALLEST), run))


def test_graphs(golden):
    run, other = run_of("golf"), run_of("golf/headwind")
    golden.check("graph-golf", graph(run, SIZE, {"headwind": other}))


def test_where_energy_goes(golden):
    golden.check("energy-basketball", energy_charts([run_of("basketball/rattle"), run_of("basketball")], SIZE))


#: Another shot to compare with, of scenes seen from the side and from above.
OTHERS = {"soccer": "soccer/dipping-free-kick", "soccer-curl": "soccer-curl/beckham-2001", "curling": "curling/guard"}


@pytest.mark.parametrize("name", OTHERS)
def test_a_comparison(golden, name: str):
    run = run_of(name)
    golden.check(f"compare-{name}", run.scene.picture(run, SMALL, {"other": run_of(OTHERS[name])}).poster())


#: Scenes with a time in s at which much is to be seen.
ON_THE_WAY = {"basketball": 0.6, "billiards/bank": 0.9, "bowling": 2.2, "tennis": 0.3, "rocket": 2.0, "bullet": 0.1,
              "soccer-curl": 0.7, "volleyball": 0.5, "throws": 0.8, "hockey": 0.2, "baseball": 1.5, "collisions": 0.5,
              "football": 1.5, "curling": 8.0, "soccer": 0.6, "baseball-pitch": 0.2, "bullet-water": 0.01}  # fmt: skip


@pytest.mark.parametrize("name", ON_THE_WAY)
def test_a_frame_on_the_way(golden, name: str):
    run = run_of(name)
    golden.check(f"frame-{name.replace('/', '-')}", run.scene.picture(run, SIZE).frame(ON_THE_WAY[name]))
