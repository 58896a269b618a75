"""Film strips."""

from functools import cache

import numpy as np
import pytest

import sandbox
from sandbox.picture.strip import FRAMES, film_strip, strip_times


@cache
def run_of(name: str):
    return sandbox.simulate(sandbox.load(name))


def test_between_two_frames_the_ball_goes_equally_far():
    """Where nothing is struck."""
    run = sandbox.simulate(sandbox.load("golf", {"gravity": 0.0, "air.density": 0.0, "launch.angle": 30.0}))
    times = strip_times(run)
    assert (times[0], times[-1], len(times)) == (0.0, run.duration, FRAMES)
    assert np.diff(times) == pytest.approx(np.full(FRAMES - 1, run.duration / (FRAMES - 1)), rel=0.02)


@pytest.mark.parametrize(("name", "touched", "least"), [("basketball/rattle", "rim back", 2), ("golf", "fairway", 1)])
def test_a_strip_shows_touches(name, touched, least):
    """The rattle's six touches of ring and board, of which it showed none."""
    run = run_of(name)
    times = strip_times(run)
    assert times == sorted(times)
    assert len([e for e in run.events if e.kind == "impact" and e.partner == touched and e.t in times]) >= least


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
