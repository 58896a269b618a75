"""The camera that goes with the story: it never goes out before the decision, and is close when it comes."""

from itertools import pairwise

import numpy as np
import pytest

import sandbox
from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.story import Camerawork, Story

AREA, HEIGHT = Area(100.0, 100.0, 1100.0, 600.0), 720.0


@pytest.fixture(scope="module")
def penalty():
    run = sandbox.simulate("soccer-curl/dive")
    return run.scene.picture(run, (1280, 720))


def work(run, story, slower=1, **options) -> Camerawork:
    """From a camera that shows 50 m."""
    first = Camera((20.0, 0.0), (600.0, 350.0), 20.0)
    return Camerawork(run, story, "ball", AREA, HEIGHT, first, slower, **options)


def seen_every(work: Camerawork, fps: float = 60.0) -> list[tuple[float, Camera]]:
    return [(t, work.camera(t)) for t in work.film(fps)]


class TestPenalty:
    def test_it_goes_in_from_the_kick_to_the_save_and_never_out(self, penalty):
        work = penalty.camerawork
        scales = [camera.scale for t, camera in seen_every(work) if t <= work.decided]
        assert scales[0] == penalty.camera.scale
        assert all(after >= before * (1 - 1e-6) for before, after in pairwise(scales))
        assert scales[-1] > 4 * scales[0]

    def test_keeper_and_ball_are_large_when_it_is_decided(self, penalty):
        close = penalty.view(penalty.camerawork.decided)
        assert penalty.story.side * close.scale >= 720 / 6
        assert 2 * penalty.radius * close.scale >= 12
        assert penalty.area.left <= close.pixel(*penalty.run.state("ball", penalty.camerawork.decided)[:2])[0]

    def test_the_ball_stays_in_sight_until_then(self, penalty):
        for t, camera in seen_every(penalty.camerawork, 20.0):
            if t <= penalty.camerawork.decided:
                x, y = camera.pixel(*penalty.run.state("ball", t)[:2])
                assert 0 <= x <= 1280
                assert 0 <= y <= 720

    def test_time_slows_for_that_and_only_then(self, penalty):
        work = penalty.camerawork
        assert work.slower(work.decided) == work.slowest > 1
        assert work.slower(0.0) == work.slower(penalty.run.duration) == 1.0

    def test_it_moves_evenly(self, penalty):
        """No faster than 6 octaves/s, and without jerks: its speed changes by little from one frame to the next."""
        frames = [camera for _, camera in seen_every(penalty.camerawork)]
        speed = 60 * np.diff(np.log2([camera.scale for camera in frames]))
        assert np.abs(speed).max() < 6.0
        assert np.abs(np.diff(speed)).max() < 1.0

    def test_it_comes_back_after_the_verdict(self, penalty):
        """As far as the ball has gone by then."""
        *_, (_, last) = seen_every(penalty.camerawork)
        end = penalty.run.state("ball", penalty.run.duration)[:2]
        for place in ((0.0, 0.0), end):
            x, y = last.pixel(*place)
            assert 0 <= x <= 1280
            assert 0 <= y <= 720

    def test_it_stands_still_where_motion_is_reduced(self, penalty):
        still = type(penalty)(penalty.run, penalty.parameters, penalty.size)
        still.still = True
        assert {still.view(t) for t in (0.0, 0.5, 0.87, 2.0)} == {still.camera}
        assert still.film(10) == pytest.approx([*np.arange(0, penalty.run.duration, 0.1), penalty.run.duration])


def test_any_time_in_any_order(penalty):
    later, before = penalty.view(0.8), penalty.view(0.2)
    assert (penalty.view(0.2), penalty.view(0.8)) == (before, later)


@pytest.mark.parametrize("name", ["basketball", "hockey", "soccer-curl"])
def test_a_small_picture_begins_near_enough(name):
    """Where the path has no room under the headline it is seen behind that, and not from far away."""
    run = sandbox.simulate(name)
    wide, small = (run.scene.picture(run, size).view(0.0) for size in ((1280, 720), (240, 135)))
    assert 240 / small.scale < 2.0 * 1280 / wide.scale  # m


def test_a_fast_ball_is_slowed_more_but_not_without_end():
    run = sandbox.simulate("basketball")
    slow, fast = (work(run, Story(Box(4.0, 2.6, 4.6, 3.1), run.duration / 4, share)) for share in (0.05, 0.5))
    assert slow.slowest <= fast.slowest <= 16


def test_nothing_below_the_floor_comes_into_the_area():
    run = sandbox.simulate(sandbox.load("golf", {"launch.speed": 20.0}))
    on_ground = work(run, Story(Box(9.0, 0.0, 11.0, 0.1), run.duration), floor=0.0)
    assert on_ground.camera(run.duration).pixel(0.0, 0.0)[1] == pytest.approx(AREA.bottom, abs=1)


def test_it_stays_where_it_is_if_it_goes_in_by_nothing():
    run = sandbox.simulate("bowling")
    lane = run.scene.picture(run, (640, 360))
    assert {camera for _, camera in seen_every(lane.camerawork, 5.0)} == {lane.camera}
    assert lane.camerawork.slower(lane.story.at) > 1


def test_it_comes_back_to_another_camera():
    run = sandbox.simulate("basketball")
    last = Camera((2.0, 0.0), (600.0, 600.0), 90.0)
    *_, (_, camera) = seen_every(work(run, Story(Box(4.0, 2.6, 4.6, 3.1), 1.0), last=last))
    assert camera == last
