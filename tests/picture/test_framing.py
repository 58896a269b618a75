"""The ball, and the thing that decides a run, are large at that moment: in all scenes, presets and tasks."""

import re

import pytest

from docs.framing import LEAST, LEAST_BALL, PAGE, SIZE, framing
from sandbox.scene import listings
from tests.scenes.play import run_of

SCENES = [listing.name for listing in listings() if "/" not in listing.name]
#: Scenes for which no moment decides, or the whole does.
STILL = {"bullet", "bullet-water", "collisions", "pinball"}


@pytest.mark.parametrize("name", SCENES)
def test_what_decides_a_scene_is_large(name: str):
    found = framing(run_of(name).scene.picture(run_of(name), SIZE))
    assert (found.decides is None) == (name in STILL)
    assert found.decides is None or found.decides >= LEAST - 0.5
    assert found.ball >= LEAST_BALL or name == "collisions"


def test_the_table_has_every_scene_and_each_row_is_large():
    rows = re.findall(r"^\| (\S.*?) \| (\S+) \| (\d+) \|.*\|( small)?$", PAGE.read_text("utf-8"), re.MULTILINE)
    assert {name for name, *_ in rows} >= {listing.name for listing in listings()}
    assert [row for row in rows if row[3]] == []


def test_a_small_one_would_be_noticed():
    view = run_of("soccer-curl").scene.picture(run_of("soccer-curl"), SIZE)
    view.still = True
    found = framing(view)
    assert found.decides is not None
    assert found.decides < LEAST
    assert not found.large
