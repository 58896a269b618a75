"""Metres to pixels and back."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.chase import Follow

metres = st.floats(-1e4, 1e4)
cameras = st.builds(
    Camera,
    at=st.tuples(metres, metres),
    anchor=st.tuples(st.floats(0, 2000), st.floats(0, 2000)),
    scale=st.floats(1e-2, 1e3),
    stretch=st.sampled_from([1.0, 2.0]),
)


@given(camera=cameras, x=metres, y=metres)
def test_there_and_back(camera, x, y):
    assert camera.world(*camera.pixel(x, y)) == pytest.approx((x, y), rel=1e-9, abs=1e-6)


@given(camera=cameras, x=metres, y=metres)
def test_one_point_and_many_agree(camera, x, y):
    assert camera.pixels(np.array([(x, y)]))[0] == pytest.approx(camera.pixel(x, y))


@given(camera=cameras, x=metres, y=metres, up=st.floats(0.1, 100))
def test_up_in_the_world_is_up_on_the_picture(camera, x, y, up):
    assert camera.pixel(x, y + up)[1] < camera.pixel(x, y)[1]
    assert camera.pixel(x + up, y)[0] > camera.pixel(x, y)[0]


@given(
    left=metres, bottom=metres, width=st.floats(0.1, 1e4), height=st.floats(0, 1e4), stretch=st.sampled_from([1.0, 2.0])
)
def test_a_fitted_box_is_inside_and_stands_on_the_floor(left, bottom, width, height, stretch):
    area = Area(40, 30, 600, 300)
    box = Box(left, bottom, left + width, bottom + height)
    camera = Camera.fit(box, area, stretch)
    (x0, y0), (x1, y1) = camera.pixel(box.left, box.bottom), camera.pixel(box.right, box.top)
    slack = 1e-6 * camera.scale * max(1.0, abs(left), abs(bottom)) + 1e-6
    assert area.left - slack <= x0 < x1 <= area.right + slack
    assert area.top - slack <= y1 <= y0
    assert y0 == pytest.approx(area.bottom, abs=slack)
    assert x1 - x0 > 559 or y0 - y1 > 269  # and touches two opposite sides


def test_heights_are_stretched_and_lengths_are_not():
    camera = Camera((0, 0), (0, 0), scale=10, stretch=2)
    assert camera.pixel(3, 0) == (30, 0)
    assert camera.pixel(0, 3) == (0, -60)


class TestFollow:
    times = np.linspace(0, 4, 241)
    corner = np.column_stack([np.where(times < 2, times, 2.0), np.zeros_like(times)])  # stops dead after 2 s

    def follow(self, settle: float = 0.25) -> Follow:
        return Follow(self.times, self.corner, np.where(self.times < 2, 10.0, 40.0), (320.0, 200.0), settle)

    def test_goes_along_and_rounds_the_corner(self):
        follow = self.follow()
        assert follow.camera(1.0).at[0] == pytest.approx(1.0, abs=1e-3)
        assert follow.camera(3.5).at[0] == pytest.approx(2.0, abs=1e-3)
        positions = np.array([follow.camera(t).at[0] for t in self.times])
        jerk = np.abs(np.diff(positions, 2)).max()
        assert jerk < 0.1 * np.abs(np.diff(self.corner[:, 0], 2)).max()

    def test_zooms_evenly_in_the_logarithm(self):
        assert self.follow().camera(2.0).scale == pytest.approx(20.0, rel=0.02)  # half way from 10 to 40

    def test_any_time_in_any_order(self):
        follow = self.follow()
        later, before = follow.camera(2.5), follow.camera(0.5)
        assert (follow.camera(0.5), follow.camera(2.5)) == (before, later)

    def test_a_run_of_no_length(self):
        camera = Follow(np.zeros(2), np.zeros((2, 2)), np.full(2, 5.0), (0.0, 0.0)).camera(0.0)
        assert camera.scale == pytest.approx(5.0)
