"""Film strips."""

from functools import cache

import numpy as np
import pytest

import sandbox
from sandbox.picture.strip import FRAMES, film_strip, strip_times


@cache
def run_of(name: str):
    return sandbox.simulate(sandbox.load(name))


@pytest.mark.parametrize("name", ["golf", "billiards/bank"])
def test_between_two_frames_the_balls_go_equally_far(name):
    run = run_of(name)
    times = strip_times(run)
    assert (times[0], times[-1], len(times)) == (0.0, run.duration, FRAMES)
    fine = np.linspace(0.0, run.duration, 4001)
    way = np.zeros(len(fine))
    for ball in run.setup.balls:
        places = np.array([run.state(ball.name, t)[:2] for t in fine])
        way[1:] += np.cumsum(np.hypot(*np.diff(places, axis=0).T))
    assert np.diff(np.interp(times, fine, way)) == pytest.approx(np.full(FRAMES - 1, way[-1] / (FRAMES - 1)), rel=0.02)


def test_a_ball_that_does_not_move_has_even_times():
    scene = sandbox.load("golf", {"launch.speed": 0.0, "launch.spin": 0.0})
    run = sandbox.simulate(scene)
    assert len(strip_times(run)) == FRAMES


def test_frames_stand_side_by_side():
    run = run_of("billiards/bank")
    picture = run.scene.picture(run, (320, 180))
    strip = film_strip(picture, run)
    width, height = strip.get_size()
    assert width > FRAMES * 320
    assert height > 180
    first = picture.frame(0.0)
    left = (width - FRAMES * 320) // (FRAMES + 1)
    top = (height - 180) // 2
    assert strip.subsurface((left, top, 320, 180)).get_at((160, 90)) == first.get_at((160, 90))
