"""Pictures of every scene that are tall or as small as may be: the story is told whole, and the shot has its room."""

from __future__ import annotations

import numpy as np
import pytest

from sandbox.picture.sheet import Sheet, rows_of
from sandbox.scene import listings
from tests.picture.legible import assert_legible
from tests.scenes.play import run_of

SIZES = [(320, 180), (600, 1200)]
SCENES = [listing.name for listing in listings() if "/" not in listing.name]
NAMES = [*SCENES, "golf/pond", "billiards/bank", "soccer/goal-kick-in-a-gale", "bullet/cannon-ball", "tennis/lob"]


def poster_of(name: str, size):
    picture = run_of(name).scene.picture(run_of(name), size)
    assert picture.poster().get_size() == size
    return picture


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", NAMES)
def test_a_poster_and_a_frame_of_any_size_are_legible(name, size):
    picture = poster_of(name, size)
    assert_legible(picture.sheet)
    texts, rows = [text for text, _ in picture.sheet.written], picture.run.scene.rows(picture.run)
    # a long headline goes on in smaller letters after its comma
    assert picture.run.scene.verdict(picture.run).replace(", ", " ") in " ".join(texts).replace(", ", " ")
    assert sum(label in texts for label, *_ in rows) >= min(len(rows), 3 if size[0] < 400 else 5)
    assert np.ptp(picture.trace, axis=0).max() > 0.08 * size[0]
    assert picture.frame(0.6 * picture.run.duration).get_size() == size
    assert_legible(picture.sheet)


@pytest.mark.parametrize("size", SIZES, ids=str)
def test_a_poster_says_its_scale_at_any_size(size):
    texts = [text for text, _ in poster_of("golf", size).sheet.written]
    assert "ball drawn" in " ".join(texts)
    assert "0 m" in texts


def test_the_smallest_poster_gives_the_shot_its_width():
    picture = poster_of("golf", (320, 180))
    assert np.ptp(picture.trace[:, 0]) > 0.7 * 320


@pytest.mark.parametrize(
    ("size", "rows"), [((1280, 720), 720), ((640, 480), 480), ((640, 400), 400), ((720, 1280), 540), ((600, 600), 450)]
)
def test_letters_go_with_what_both_sides_allow(size, rows):
    assert rows_of(size) == rows
    assert Sheet(size).unit == rows / 720
