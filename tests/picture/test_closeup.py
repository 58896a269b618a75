"""What is enlarged on a poster, and where."""

from itertools import pairwise

import pygame
import pytest

from sandbox.picture.camera import Box, Camera
from sandbox.picture.closeup import LARGEST_FACTOR, LEAST_FACTOR, arranged
from tests.scenes.play import run_of

CAMERA = Camera((0.0, 0.0), (100.0, 500.0), 40.0)
FREE = pygame.Rect(60, 120, 1160, 240)


def picture_of(name, size=(1280, 720)):
    run = run_of(name)
    return run.scene.picture(run, size)


@pytest.mark.parametrize("places", [(3.0,), (3.0, 4.0), (24.0, 25.0), (0.0, 28.0)])
def test_closeups_stand_side_by_side_in_the_free_part(places):
    boxes = [Box(x - 0.5, 0.0, x + 0.5, 1.0) for x in places]
    found = arranged(boxes, FREE, CAMERA, 1.0)
    assert len(found) == len(boxes)
    assert len({near.camera.scale for near in found}) == 1
    assert all(FREE.contains(near.rect) for near in found)
    assert not any(a.rect.inflate(8, 8).colliderect(b.rect) for a, b in pairwise(found))
    for near, box in zip(found, boxes, strict=True):
        assert near.box.left <= box.left < box.right <= near.box.right
        assert near.shows((box.left, box.top))
        assert LEAST_FACTOR <= near.camera.scale / CAMERA.scale <= LARGEST_FACTOR


def test_no_closeup_without_room_or_hardly_larger():
    assert arranged([Box(0.0, 0.0, 5.0, 5.0)], FREE, CAMERA, 1.0) == []
    assert arranged([Box(0.0, 0.0, 1.0, 1.0)], pygame.Rect(60, 120, 1160, 60), CAMERA, 1.0) == []
    assert arranged([], FREE, CAMERA, 1.0) == []


@pytest.mark.parametrize("name", ["tennis", "tennis/slice", "volleyball", "baseball-pitch", "golf/putt"])
def test_a_low_flight_has_its_decision_enlarged_in_the_sky(name):
    """Nothing of the path lies under a close-up, and each says how much larger it is."""
    picture = picture_of(name)
    picture.poster()
    assert picture.closeups
    path = picture.camera.pixels(picture.path.points)
    for near in picture.closeups:
        assert not any(near.rect.collidepoint(point) for point in path)
        texts = [text for text, rect in picture.sheet.written if near.rect.contains(rect)]
        assert f"{near.camera.scale / picture.camera.scale:.1f}×" in texts


def test_a_high_flight_has_none():
    assert picture_of("tennis/lob").closeups == []


def test_an_impact_is_labelled_once():
    picture = picture_of("tennis")
    picture.poster()
    assert sum(text == "38.5 m/s" for text, rect in picture.sheet.written if rect.bottom < picture.card_row) == 1


@pytest.mark.parametrize(("name", "speeds"), [("basketball/bank-shot", ["4.7 m/s"]), ("basketball/brick", ["5.7 m/s"])])
def test_the_lens_at_the_ring_has_its_speeds(name, speeds):
    picture = picture_of(name)
    picture.poster()
    assert [
        text for text, rect in picture.sheet.written if text.endswith(" m/s") and picture.lens.contains(rect)
    ] == speeds
