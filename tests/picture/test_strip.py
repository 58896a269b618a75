"""Film strips."""

import numpy as np
import pytest

import sandbox
from sandbox.picture.strip import FRAMES, film_strip, strip_times
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
    told = run.scene.picture(run, (320, 180)).told
    times = strip_times(run, told)
    assert times == sorted(times)
    assert (times[0], times[-1]) == (0.0, told)
    assert len([event for event in run.events if event.kind == "impact" and event.t in times[1:-1]]) >= least


def test_a_ball_that_does_not_move_has_even_times():
    scene = sandbox.load("golf", {"launch.speed": 0.0, "launch.spin": 0.0})
    run = sandbox.simulate(scene)
    assert len(strip_times(run, run.duration)) == FRAMES


def test_frames_stand_side_by_side():
    run = run_of("billiards/bank")
    picture = run.scene.picture(run, (320, 180))
    strip = film_strip(picture, run)
    width, height = strip.get_size()
    count = len(strip_times(run, run.duration))
    assert width > count * 320
    assert height > 180
    first = picture.frame(0.0)
    left = (width - count * 320) // (count + 1)
    top = (height - 180) // 2
    assert strip.subsurface((left, top, 320, 180)).get_at((160, 90)) == first.get_at((160, 90))
