"""Golf pictures of very different shots: composed, legible, the ball always in sight."""

import subprocess
import sys

import numpy as np
import pytest

from tests.picture.test_ball_pictures import GOLF
from tests.scenes.play import run_of


def notes(picture) -> str:
    return " ".join(text for text, _ in picture.sheet.written)


def drawn(overrides, size=(640, 360), name="golf"):
    run = run_of(name, overrides)
    return run.scene.picture(run, size)


def test_a_poster_says_what_it_does_not_show_as_it_is():
    picture = drawn({})
    picture.poster()
    assert "times its size" in notes(picture)
    assert ("heights drawn 2 times" in notes(picture)) == (picture.camera.stretch == 2)


def test_wind_is_drawn_only_when_there_is_some():
    still, windy = drawn({}), drawn({"air.wind": [-3.0, 0.0]})
    for picture in (still, windy):
        picture.poster()
    assert "wind" not in notes(still)
    assert "wind 3.0 m/s" in notes(windy)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (GOLF["into the water"], "into the water"),
        (GOLF["no gravity"], "Did not come down"),
        (GOLF["topped"], "Rolls"),
        (GOLF["backwards"], "backwards"),
        ({"pin.distance": 400.0}, "short of the pin"),
        ({"pin.distance": 200.0}, "past the pin"),
    ],
)
def test_the_verdict_says_what_happened(overrides, words):
    picture = drawn(overrides)
    assert words in picture.run.scene.verdict(picture.run)
    picture.frame(picture.run.duration)
    assert words in notes(picture)


def test_a_far_pin_does_not_make_the_path_too_small_to_see():
    picture = drawn({"launch.speed": 4.0, "pin.distance": 280.0})
    picture.poster()
    assert np.ptp(picture.trace[:, 0]) > 0.7 * 640


@pytest.mark.parametrize(("name", "said"), [("golf/pond", True), ("golf", False), ("golf/moon", False)])
def test_where_carry_ends_above_the_ground_a_poster_says_why(name, said):
    picture = drawn({}, name=name)
    picture.poster()
    assert ("at launch height" in notes(picture)) == said


def test_no_window_and_no_display_are_needed():
    code = (
        "import sandbox; scene = sandbox.load('golf');"
        "scene.picture_module().Picture(sandbox.simulate(scene), scene.parameters).poster();"
        "import pygame; assert not pygame.display.get_init()"
    )
    environment = {"SDL_VIDEODRIVER": "no such driver", "PATH": "/usr/bin:/bin"}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stdout == ""  # pygame's greeting would spoil --json


class TestGolden:
    size = (480, 270)  # less than 60 kB

    def test_wind(self, golden):
        golden.check("golf-wind", drawn({"air.wind": [2.0, 0.0]}, self.size).poster())

    def test_frame(self, golden):
        golden.check("golf-frame", drawn({}, self.size).frame(2.0))

    def test_hills(self, golden):
        golden.check("golf-hills", drawn(GOLF["hills"], self.size).poster())
