"""Every scene, and presets that show what it can do: what happens in them, and how it looks, stays as it is."""

from __future__ import annotations

import pytest

import sandbox
from sandbox.record import first_change, record
from sandbox.scene import listings
from tests.scenes.play import run_of

#: Scenes and presets, and until when (s) rounding has no say in them; None where it never has.
RUNS = {
    "basketball": None,
    "basketball/bank-shot": None,
    "basketball/brick": None,
    "soccer": None,
    "soccer/goal-kick-in-a-gale": None,
    "soccer-curl": None,
    "soccer-curl/roberto-carlos-1997": None,
    "soccer-curl/wrong-footed": None,
    "billiards": 0.3,  # into the rack, where in the end a bit decides who goes left
    "billiards/bank": None,
    "billiards/nine-ball-break": 2.1,
    "billiards/snooker-break": None,
    "billiards/three-rail-carom": None,
    "volleyball": None,
    "collisions": None,
    "collisions/bowl": 0.3,  # until they lie on one another
    "collisions/beach-balls": None,
    "collisions/overlapping": None,
    "tennis": None,
    "bullet": None,
    "bullet-water": None,
    "rocket": None,
    "rocket/grenade": None,
    "throws": None,
    "hockey": None,
    "hockey/rim": None,
    "hockey/air-hockey": None,
    "hockey/glove-save": None,
    "bowling": None,
    "bowling/straight": None,
    "curling": None,
    "minigolf": None,
    "minigolf/blocked": None,
    "minigolf/gate": None,
    "minigolf/back-down": None,
    "pinball": 5.5,  # then it depends on rounding
    "pinball/cradle": 5.5,
    "curling/double": None,
    "baseball": None,
    "baseball-pitch": None,
    "baseball/green-monster": None,
    "tennis/topspin-forehand": None,
    "tennis/table-tennis": None,
    "golf": None,
    "football": 4.0,  # until it bounces: what comes then depends on rounding
    "golf/blow-up": None,
    "golf/golf-game": None,
    "golf/moon": None,
    "golf/putt": None,
    "golf/slice": None,
}


@pytest.mark.parametrize("name", RUNS)
def test_run(golden, name: str):
    golden.check(name.replace("/", "-"), run_of(name), until=RUNS[name])


#: A kick that clips the keeper: in no preset does the ball meet him.
OFF_THE_KEEPER = {"keeper.offset": -1.67}


def test_off_the_keeper(golden):
    golden.check("soccer-curl-off-the-keeper", sandbox.simulate(sandbox.load("soccer-curl", OFF_THE_KEEPER)))


@pytest.mark.parametrize("key", ["restitution", "friction", "mass", "radius"])
def test_a_thousandth_more_of_the_keeper_is_noticed(key: str):
    before = sandbox.load("soccer-curl", OFF_THE_KEEPER)
    more = 1.001 * getattr(before.parameters.keeper, key)
    after = sandbox.load("soccer-curl", {**OFF_THE_KEEPER, f"keeper.{key}": more})
    assert first_change(record(sandbox.simulate(before)), record(sandbox.simulate(after))) is not None


def test_every_scene_is_here():
    scenes = {listing.name for listing in listings() if "/" not in listing.name}
    assert scenes <= set(RUNS)
