"""Golf pictures of very different shots: composed, legible, the ball always in sight."""

import subprocess
import sys
from functools import cache

import numpy as np
import pytest

import sandbox
from sandbox.picture.ball import Look
from tests.picture.legible import assert_legible

SIZES = [(640, 360), (1920, 1080)]
SHOTS = {
    "drive": {},
    "putt": {"launch.speed": 2.05, "launch.angle": 0.0, "launch.spin": 0.0, "pin.distance": 3.0},
    "moon": {"gravity": 1.62, "air.density": 0.0, "launch.speed": 50.0, "launch.angle": 35.0, "pin.distance": 1500.0},
    "topped": {"launch.speed": 30.0, "launch.angle": -8.0, "launch.spin": -2000.0, "pin.distance": 150.0},
    "backwards": {"launch.speed": 30.0, "launch.angle": 100.0, "launch.spin": 3000.0, "air.wind": [-3.0, 0.0]},
    "fast": {"launch.speed": 340.0, "launch.angle": 12.0, "pin.distance": 250.0},
    "straight up": {"launch.speed": 60.0, "launch.angle": 90.0, "launch.spin": 0.0, "air.wind": [0.0, 4.0]},
    "not struck": {"launch.speed": 0.0, "launch.spin": 0.0},
    "no gravity": {"gravity": 0.0, "air.density": 0.0, "launch.angle": 30.0},
    "hills": {
        "launch.speed": 62.0,
        "launch.angle": 15.0,
        "launch.spin": 6000.0,
        "pin.distance": 185.0,
        "ground.heights": [[0, 0], [40, 0], [60, -6], [110, -4], [150, 4], [170, 8], [200, 8], [260, 4]],
        "ground.strips": [
            {"kind": "tee", "start": -10, "end": 10},
            {"kind": "rough", "start": 30, "end": 90},
            {"kind": "bunker", "start": 207, "end": 215},
        ],
    },
    "into the water": {
        "launch.speed": 50.0,
        "launch.angle": 16.0,
        "pin.distance": 200.0,
        "ground.strips": [{"kind": "water", "start": 100, "end": 180}],
    },
}


@cache
def run_of(name: str):
    """A shot's scene and its run."""
    scene = sandbox.load("golf", SHOTS[name])
    return scene, sandbox.simulate(scene)


@pytest.fixture(scope="module", params=[(name, size) for name in SHOTS for size in SIZES], ids=str)
def picture(request):
    """The picture of a shot, without its backdrop, which takes time and has nothing to do with what is tested."""
    name, size = request.param
    scene, run = run_of(name)
    picture = scene.picture_module().Picture(run, scene.parameters, size)
    picture.course.draw = lambda *_: None
    return picture


class TestEveryShot:
    def test_the_poster_is_composed(self, picture):
        assert picture.poster().get_size() == picture.size
        assert_legible(picture.sheet)
        for text, rect in picture.sheet.written:
            assert not any(rect.collidepoint(point) for point in picture.trace), f"{text} is on the trace"
        (left, top), (right, bottom) = picture.trace.min(axis=0), picture.trace.max(axis=0)
        width, height = picture.size
        assert 0.04 * width <= left <= right <= 0.96 * width
        assert 0.04 * height <= top <= bottom <= 0.96 * height

    def test_frames_are_legible(self, picture):
        for share in (0.0, 0.03, 0.3, 1.0):
            assert picture.frame(share * picture.run.duration).get_size() == picture.size
            assert_legible(picture.sheet)

    def test_the_ball_can_always_be_seen(self, picture, monkeypatch):
        drawn = []

        def note(self, painter, centre, radius, angle, unit, enlarged=False):
            drawn.append((centre, radius, enlarged))

        monkeypatch.setattr(Look, "draw", note)
        picture.poster()
        for share in np.linspace(0, 1, 9):
            picture.frame(share * picture.run.duration)
        (*along, rest), frames = drawn[:-9], drawn[-9:]
        assert all(2 * radius >= 7 for _, radius, _ in along)
        width, height = picture.size
        for (x, y), radius, _ in (rest, *frames):
            assert 2 * radius >= 7
            assert 0.04 * width <= x <= 0.96 * width
            assert 0.04 * height <= y <= 0.96 * height
        true = picture.run.setup.balls[0].radius * picture.camera.scale
        assert rest[2] == (rest[1] > true * 1.05)  # the ring says that it is drawn too large


def notes(picture) -> str:
    return " ".join(text for text, _ in picture.sheet.written)


def drawn(overrides, size=(640, 360)):
    scene = sandbox.load("golf", overrides)
    return scene.picture_module().Picture(sandbox.simulate(scene), scene.parameters, size)


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
        (SHOTS["into the water"], "into the water"),
        (SHOTS["no gravity"], "Did not come down"),
        (SHOTS["topped"], "Rolls"),
        (SHOTS["backwards"], "backwards"),
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
    scene = sandbox.load(name)
    picture = scene.picture(sandbox.simulate(scene), (640, 360))
    picture.poster()
    assert ("at launch height" in notes(picture)) == said


def test_the_ball_turns():
    picture = drawn({"launch.speed": 2.0, "launch.angle": 0.0, "launch.spin": 0.0}, (1280, 720))
    pictures = [picture.frame(t) for t in (0.5, 0.6)]
    assert pictures[0].get_buffer().raw != pictures[1].get_buffer().raw


def test_frames_can_be_drawn_in_any_order():
    picture = drawn({})
    first = picture.frame(1.0).get_buffer().raw
    picture.frame(4.0)
    picture.poster()
    assert picture.frame(1.0).get_buffer().raw == first


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
        golden.check("golf-hills", drawn(SHOTS["hills"], self.size).poster())
