"""Film strips."""

from math import ceil

import numpy as np
import pygame
import pytest

import sandbox
from sandbox.picture.strip import FILM, FRAMES, NEAR, film_strip, full_rows, strip_times
from tests.scenes.play import run_of


def test_between_two_frames_the_ball_goes_equally_far():
    """Where nothing is struck."""
    run = sandbox.simulate(sandbox.load("golf", {"gravity": 0.0, "air.density": 0.0, "launch.angle": 30.0}))
    times = strip_times(run, run.duration)
    assert (times[0], times[-1], len(times)) == (0.0, run.duration, FRAMES)
    assert np.diff(times) == pytest.approx(np.full(FRAMES - 1, run.duration / (FRAMES - 1)), rel=0.02)


@pytest.mark.parametrize(("name", "least"), [("basketball/rattle", 6), ("golf", 2), ("soccer/goal-kick-in-a-gale", 4)])
def test_a_strip_shows_touches(name, least):
    """All six of ring and board in the rattle, of which it once showed none, and later two."""
    run = run_of(name)
    told = run.scene.picture(run, (320, 180)).story_end
    times = strip_times(run, told)
    assert times == sorted(times)
    assert (times[0], times[-1]) == (0.0, told)
    touches = [event.t for event in run.events if event.kind == "impact" and event.t in times[1:-1]]
    assert len(touches) >= least
    shares = way_gone(run, touches, told)
    even = np.linspace(0.0, 1.0, FRAMES)[1:-1]
    clear = [share for share in even if np.all(abs(share - shares) > NEAR / (FRAMES - 1))]
    between = way_gone(run, [t for t in times[1:-1] if t not in touches], told)
    assert between == pytest.approx(clear, abs=0.01)  # one along the way where no touch is near


def way_gone(run, times, until):
    """The share of the ball's way until ``until`` (s) that is behind it at these times."""
    fine = np.linspace(0.0, until, 4001)
    places = np.array([run.state(run.setup.balls[0].name, t)[:2] for t in fine.tolist()])
    way = np.append(0.0, np.cumsum(np.hypot(*np.diff(places, axis=0).T)))
    return np.interp(times, fine, way) / way[-1]


def test_a_ball_that_does_not_move_has_even_times():
    scene = sandbox.load("golf", {"launch.speed": 0.0, "launch.spin": 0.0})
    run = sandbox.simulate(scene)
    assert len(strip_times(run, run.duration)) == FRAMES


@pytest.mark.parametrize("name", ["billiards/bank", "bowling/straight"])
def test_frames_stand_in_rows_that_fit_a_page(name):
    """In the order in which one reads, as evenly as may be, each whole and with holes above and below."""
    run = run_of(name)
    picture = run.scene.picture(run, (320, 180))
    times, _ = full_rows(strip_times(run, picture.story_end))
    strip = film_strip(picture, run)
    width, height = strip.get_size()
    assert width < 4.5 * 320
    assert height > 180 * ceil(len(times) / 4)
    pixels = pygame.surfarray.array3d(strip)
    frames = [_found(pygame.surfarray.array3d(picture.frame(t)), pixels) for t in times]
    assert frames[0].top == height - frames[-1].bottom
    assert frames == sorted(frames, key=lambda rect: (rect.top, rect.left))
    in_rows = [len([rect for rect in frames if rect.top == top]) for top in sorted({rect.top for rect in frames})]
    assert max(in_rows) == ceil(len(times) / len(in_rows)) == ceil(width / 320) - 1
    for rect in frames:
        assert strip.get_rect().contains(rect)
        assert not [other for other in frames if other is not rect and rect.inflate(4, 20).colliderect(other)]
        for margin in (
            pixels[rect.left : rect.right, rect.top - 19 : rect.top],
            pixels[rect.left : rect.right, rect.bottom : rect.bottom + 19],
        ):
            assert 0.05 < np.all(margin == FILM["hole"], axis=-1).mean() < 0.3


def _found(frame, pixels):
    """The rectangle of a frame in a strip, found by its most varied row and the same as there in all its pixels."""
    row = int(np.any(np.diff(frame, axis=0), axis=-1).sum(axis=0).argmax())
    strip, part = pixels.swapaxes(0, 1).tobytes(), frame[:, row].tobytes()
    at = strip.find(part)
    while at >= 0:
        y, x = divmod(at // 3, len(pixels))
        rect = pygame.Rect((x, y - row), frame.shape[:2])
        if np.array_equal(pixels[rect.left : rect.right, rect.top : rect.bottom], frame):
            return rect
        at = strip.find(part, at + 1)
    raise AssertionError("a frame is not in the strip as a whole")


@pytest.mark.parametrize("count", [1, 4, 5, 7, 10, 13])
def test_no_place_in_a_strip_stays_empty(count):
    times, columns = full_rows([float(i) for i in range(count)])
    assert len(times) % columns == 0
    assert len(times) <= count + 3
    assert set(range(count)) <= set(times)
    assert times == sorted(set(times))
