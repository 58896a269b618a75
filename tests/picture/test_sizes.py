"""Posters that are tall, nearly square or as small as may be: the story is told whole, and the shot has its room."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import sandbox
from sandbox.picture.sheet import Sheet, rows_of
from tests.picture.legible import assert_legible

SIZES = [(320, 180), (640, 400), (600, 1200), (720, 1280)]
NAMES = ["golf", "golf/pond", "basketball", "billiards/bank", "soccer", "soccer/goal-kick-in-a-gale", "soccer-curl"]


@cache
def run_of(name: str):
    return sandbox.simulate(sandbox.load(name))


def poster_of(name: str, size):
    picture = run_of(name).scene.picture(run_of(name), size)
    assert picture.poster().get_size() == size
    return picture


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", NAMES)
def test_a_poster_of_any_size_is_legible(name, size):
    picture = poster_of(name, size)
    assert_legible(picture.sheet)
    texts = [text for text, _ in picture.sheet.written]
    assert picture.run.scene.verdict(picture.run) in texts
    assert sum(label in texts for label, *_ in picture.run.scene.rows(picture.run)) >= (3 if size[0] < 400 else 6)
    if hasattr(picture, "trace"):
        assert np.ptp(picture.trace, axis=0).max() > 0.15 * size[0]


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
