"""Two runs over each other, in a poster and in frames."""

import re
from math import dist

import numpy as np
import pytest
from PIL import ImageChops

from sandbox.picture.frames import to_image
from sandbox.picture.palette import scene_colours
from tests.picture.legible import assert_legible
from tests.scenes.play import run_of

PAIRS = [
    ("golf", "golf/headwind"),
    ("golf/putt", "golf"),
    ("billiards/bank", "billiards/cut"),
    ("basketball", "basketball/hook"),
    ("soccer", "soccer/dipping-free-kick"),
    ("soccer-curl", "soccer-curl/beckham-2001"),
]


def compared(pair, size=(640, 360)):
    run, other = map(run_of, pair)
    return run.scene.picture(run, size, {"the other": other})


@pytest.mark.parametrize("size", [(640, 360), (1280, 720)], ids=str)
@pytest.mark.parametrize("pair", PAIRS, ids=str)
def test_both_are_told_and_nothing_overlaps(pair, size):
    picture = compared(pair, size)
    assert picture.poster().get_size() == size
    written = [text for text, _ in picture.sheet.written]
    assert any(text.startswith("the other") for text in written)
    entries, own = (run.scene.rows(run) for run in (picture.ghosts[0].run, picture.run))
    for label, value, *_ in own[:3]:
        assert label in written
        assert value in written
    other = dict(entries)
    assert next(other[label] for label, *_ in own if label in other) in written
    assert_legible(picture.sheet)


@pytest.mark.parametrize(
    ("pair", "size"),
    [
        (("golf", "golf/headwind"), (1280, 720)),
        (("golf", "golf/moon"), (1280, 720)),
        (("golf/topped", "golf"), (640, 400)),
        (("soccer/goal-kick-in-a-gale", "soccer"), (640, 400)),
    ],
    ids=str,
)
def test_speeds_have_their_unit(pair, size):
    picture = compared(pair, size)
    picture.poster()
    written = [text for text, _ in picture.sheet.written]
    inside = [text for text, rect in picture.sheet.written if rect.bottom < picture.rows_at.base]
    assert not [text for text in inside if re.fullmatch(r"[\d., ]+", text)]
    if pair[1] == "golf/headwind":  # whose path lies where the apex is usually told
        assert "apex 32.4 m" in written


@pytest.mark.parametrize("pair", PAIRS, ids=str)
def test_frames_show_both_at_the_same_time(pair):
    """Up to the end of the longer run, and after that of the shorter."""
    run, other = map(run_of, pair)
    picture = compared(pair)
    for share in (0.0, 0.4, 1.0):
        t = share * run.duration
        assert picture.frame(t).get_size() == (640, 360)
        written = [text for text, _ in picture.sheet.written]
        assert "compared with the other" in " ".join(written)
        assert {f"{t:.2f} s", f"{min(t, other.duration):.2f} s"} <= set(written)
        assert_legible(picture.sheet)
    shown = to_image(picture.frame(0.1 * run.duration)).copy()
    picture.ghosts.clear()  # the camera stays
    hidden = to_image(picture.frame(0.1 * run.duration))
    middle = (0, 100, 640, picture.sheet.card_row(1) - 5)  # off headline and card
    assert ImageChops.difference(shown.crop(middle), hidden.crop(middle)).getbbox() is not None


@pytest.mark.parametrize("pair", PAIRS, ids=str)
def test_the_camera_shows_both_paths(pair):
    picture = compared(pair)
    run = run_of(pair[1])
    ball = picture.ball
    end = run.duration if run.caught_at(ball) is None else run.caught_at(ball)
    points = np.array([run.state(ball, t)[:2] for t in np.linspace(0.0, 0.9 * end, 50)]) + picture.ghosts[0].shift
    points = picture.camera.pixels(points)
    inside = (points >= 0).all(axis=1) & (points <= picture.size).all(axis=1)
    assert inside.mean() > 0.9


def test_without_ghosts_the_poster_is_as_ever():
    run = run_of("golf")
    alone = run.scene.picture(run, (640, 360)).poster().get_buffer().raw
    assert run.scene.picture(run, (640, 360), {}).poster().get_buffer().raw == alone


def test_other_runs_are_unlike_the_run_and_the_hall():
    picture = compared(("basketball", "basketball/hook"))
    court = scene_colours(str(run_of("basketball").scene.folder / "picture.py"))
    for colour in (court["trace"], *court["hall"]["wall"], *court["floor"]["wood"][:2]):
        assert dist(picture.ghosts[0].light, colour) > 90  # of 442 levels from black to white
    assert [ghost.colour for ghost in picture.ghosts] == list(picture.OTHER_TRACES)[:1]
