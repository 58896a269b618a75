"""Pictures of kicks and throws of every kind: composed, legible, the ball always in sight and never too small."""

from dataclasses import replace

import numpy as np
import pygame
import pytest

from sandbox.picture.ball import SMALLEST, Look, Mark, near, turned
from sandbox.picture.painter import Painter, blank
from sandbox.picture.palette import scene_colours
from tests.picture.legible import assert_legible
from tests.scenes.play import run_of

GOLF = {
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
SHOTS = {
    **{f"golf, {name}": ("golf", overrides) for name, overrides in GOLF.items()},
    "soccer": ("soccer", {}),
    "soccer, dipping": ("soccer/dipping-free-kick", {}),
    "soccer, in a gale": ("soccer/goal-kick-in-a-gale", {}),
    "soccer, straight up": ("soccer", {"launch.speed": 20.0, "launch.angle": 90.0, "launch.spin": 0.0}),
    "soccer, backwards": ("soccer", {"launch.angle": 140.0, "air.wind": [3.0, 0.0]}),
    "soccer, along the ground": ("soccer", {"launch.speed": 12.0, "launch.angle": 0.0, "launch.spin": 0.0}),
    "soccer, on the Moon": ("soccer", {"gravity": 1.62, "air.density": 0.0, "launch.angle": 45.0}),
    "soccer, not struck": ("soccer", {"launch.speed": 0.0, "launch.spin": 0.0}),
    "curl": ("soccer-curl", {}),
    "curl, 1997": ("soccer-curl/roberto-carlos-1997", {}),
    "curl, 2001": ("soccer-curl/beckham-2001", {}),
    "curl, into the wall": ("soccer-curl", {"launch.angle": 0.0, "launch.spin": 0.0, "air.wind": [0.0, 4.0]}),
    "curl, aside": ("soccer-curl", {"launch.angle": 85.0}),
    "curl, not struck": ("soccer-curl", {"launch.speed": 0.0, "launch.spin": 0.0}),
    "basketball": ("basketball", {}),
    "basketball, bank": ("basketball/bank-shot", {}),
    "basketball, brick": ("basketball/brick", {}),
    "basketball, three": ("basketball/three-pointer", {"air.wind": [-2.0, 0.0]}),
    "basketball, backwards": ("basketball", {"launch.angle": 120.0}),
    "basketball, high": ("basketball", {"launch.speed": 20.0, "launch.angle": 80.0}),
    "basketball, dropped": ("basketball", {"launch.speed": 0.0, "launch.spin": 0.0}),
}


def picture_of(name: str, size=(640, 360)):
    run = run_of(*SHOTS[name])
    return run.scene.picture(run, size)


def texts(picture) -> str:
    return " ".join(text for text, _ in picture.sheet.written)


@pytest.fixture
def drawn(monkeypatch):
    """Centre and radius in px, and whether a ring says that it is enlarged, of every ball drawn."""
    balls: list[tuple[tuple[float, float], float, bool]] = []
    draw = Look.draw

    def note(self, painter, centre, radius, angle, unit, enlarged=False):
        balls.append((centre, radius, enlarged))
        draw(self, painter, centre, radius, angle, unit, enlarged)

    monkeypatch.setattr(Look, "draw", note)
    return balls


#: Every shot small, where there is the least room; the usual one of each sport in the usual size.
SIZED = [
    *((name, (640, 360)) for name in SHOTS),
    *((name, (1280, 720)) for name in ("golf, drive", "soccer", "curl", "basketball")),
]


@pytest.mark.parametrize(("name", "size"), SIZED, ids=str)
def test_posters_and_frames_are_composed_and_show_the_ball(name, size, drawn):
    picture = picture_of(name, size)
    low, high = 0.04 * np.array(size), 0.96 * np.array(size)
    smallest = SMALLEST * max(1.0, size[1] / 360)
    assert picture.poster().get_size() == size
    assert_legible(picture.sheet)
    for text, rect in picture.sheet.written:
        assert not any(rect.collidepoint(point) for point in picture.trace), f"{text} is on the trace"
    assert np.all((low <= picture.trace) & (picture.trace <= high))

    lens = getattr(picture, "lens", None)  # in which the ball is larger by a factor that is said there
    *along, (_, last, ring) = [ball for ball in drawn if lens is None or not lens.collidepoint(ball[0])]
    assert 2 * last >= smallest
    assert ring == ("ball drawn" in texts(picture)) == (last > 1.05 * picture.radius * picture.camera.scale)
    assert all(2 * radius >= SMALLEST for _, radius, _ in along)
    for share in (0.0, 0.4, 1.0):
        drawn.clear()
        assert picture.frame(share * picture.run.duration).get_size() == size
        assert_legible(picture.sheet)
        centre, radius, ring = drawn[0]
        assert 2 * radius >= smallest
        assert np.all((low <= centre) & (centre <= high))
        assert ring == ("ball drawn larger" in texts(picture))


@pytest.mark.parametrize("name", ["golf, drive", "soccer, in a gale", "curl, 1997", "basketball", "basketball, brick"])
def test_frames_can_be_drawn_in_any_order(name):
    picture = picture_of(name)
    end = picture.run.duration
    first = picture.frame(0.3 * end).get_buffer().raw
    for share in (0.9, 0.0, 1.0):
        picture.frame(share * end)
    picture.poster()
    assert picture.frame(0.3 * end).get_buffer().raw == first


@pytest.mark.parametrize("name", ["golf, putt", "soccer", "curl", "basketball"])
def test_the_ball_turns(name):
    picture = picture_of(name, (1280, 720))
    end = 0.5 * (picture.run.result["flight_time"] or picture.run.duration)
    still = picture.run.angle("ball", end)
    before = picture.frame(end).get_buffer().raw
    picture.run.angle = lambda ball, t: still + 0.5  # everything but its turning stays
    try:
        assert picture.frame(end).get_buffer().raw != before
    finally:
        del picture.run.angle


def test_a_ball_turns_counter_clockwise():
    right = Look((255, 255, 255), Mark((255, 0, 0), near(np.array([[1.0, 0.0, 0.0]]), 0.3)))
    for angle, side in ((0.0, (1, 0)), (np.pi / 2, (0, -1)), (np.pi, (-1, 0))):
        painter = Painter(blank((80, 60)))
        right.draw(painter, (40, 30), 20.0, turned((0.0, 0.0, angle)), 1.0)
        red, green, _ = np.moveaxis(pygame.surfarray.array3d(painter.surface).astype(int), -1, 0)
        x, y = np.argwhere(red > green + 60).mean(axis=0) + 0.5
        assert (x - 40, y - 30) == pytest.approx((18.5 * side[0], 18.5 * side[1]), abs=1.0)


def test_a_note_says_how_far_away_is_what_is_not_in_sight():
    for name, away in (("soccer, not struck", True), ("soccer", False)):
        picture = picture_of(name)
        picture.poster()
        assert ("the goal is 22 m away" in texts(picture)) == away
    run = run_of("baseball", {})
    picture = run.scene.picture(run, (640, 360))
    camera = replace(picture.camera, anchor=(-50.0, 300.0))
    assert picture.remarks(camera) == []  # the start is where all is measured from


def test_the_lens_is_on_the_poster_and_frames_go_in_instead():
    picture = picture_of("basketball, brick", (1280, 720))
    corner = picture.lens.left + 20, picture.lens.bottom - 20
    lens = scene_colours(str(picture.run.scene.folder / "picture.py"))["lens"]
    assert picture.poster().get_at(corner) == (*lens, 255)
    assert picture.frame(picture.camerawork.decided).get_at(corner) != (*lens, 255)
