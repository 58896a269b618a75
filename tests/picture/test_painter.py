"""Shapes: as large as they should be, where they should be, and harmless off the surface."""

import numpy as np
import pygame
import pytest

from sandbox.picture.painter import Painter, _disc, _shadow, blank, from_colours
from sandbox.picture.palette import mix, palette

WHITE = (255, 255, 255)


def drawn(draw, size=(80, 60)) -> np.ndarray:
    """Brightness from 0 to 1, shape (width, height), of a white shape on black."""
    surface = blank(size)
    draw(Painter(surface))
    return pygame.surfarray.array3d(surface)[:, :, 0] / 255.0


def middle(light: np.ndarray) -> tuple[float, float]:
    """Centre of gravity; pixel i covers i to i + 1."""
    x, y = np.meshgrid(*(np.arange(n) + 0.5 for n in light.shape), indexing="ij")
    return float((x * light).sum() / light.sum()), float((y * light).sum() / light.sum())


@pytest.mark.parametrize("radius", [1.5, 3.5, 7.0, 20.0])
@pytest.mark.parametrize("centre", [(40.0, 30.0), (40.5, 30.25), (39.875, 29.625)])
def test_a_disc_covers_pi_r_squared_around_its_centre(radius, centre):
    light = drawn(lambda p: p.disc(centre, radius, WHITE))
    assert light.sum() == pytest.approx(np.pi * radius**2, rel=0.02, abs=0.35)
    assert middle(light) == pytest.approx(centre, abs=0.06)


def test_a_ring_covers_its_circumference():
    light = drawn(lambda p: p.ring((40, 30), 15, 2, WHITE))
    assert light.sum() == pytest.approx(2 * np.pi * 15 * 2, rel=0.02)


def test_a_line_is_as_long_and_as_wide_as_asked_with_round_ends():
    light = drawn(lambda p: p.line([(20, 20), (60, 40)], 4, WHITE))
    assert light.sum() == pytest.approx(np.hypot(40, 20) * 4 + np.pi * 4, rel=0.07)
    assert middle(light) == pytest.approx((40, 30), abs=0.2)


def test_dashes_leave_gaps():
    light = drawn(lambda p: p.dashes([(10, 30), (70, 30)], 2, WHITE, dash=6, gap=6))[:, 30]
    assert np.count_nonzero(np.diff((light > 0.5).astype(int)) == 1) == 5


def test_an_arrow_points_where_it_goes():
    light = drawn(lambda p: p.arrow((15, 30), (65, 30), 4, WHITE))
    assert light[60].sum() < light[54].sum() > light[30].sum()


def test_a_trail_grows_towards_its_end():
    light = drawn(lambda p: p.fading([(x, 30.0) for x in range(5, 76, 5)], 8, WHITE, 1.0))
    assert light[15].sum() < light[40].sum() < light[70].sum()


def test_a_panel_has_round_corners():
    light = drawn(lambda p: p.panel(pygame.Rect(10, 10, 60, 40), WHITE, 1.0, 8))
    assert light[10, 10] == 0
    assert light[40, 10] == 1
    assert light.sum() == pytest.approx(60 * 40 - (4 - np.pi) * 64, rel=0.005)


def test_a_shadow_fades_outwards():
    light = drawn(lambda p: p.shadow((40, 30), 20, 6, WHITE, 1.0))[:, 30]
    assert np.all(np.diff(light[40:]) <= 0)
    assert light[40] > 0.9


@pytest.mark.parametrize("far", [(-500.0, 30.0), (40.0, 9000.0)])
def test_nothing_happens_off_the_surface(far):
    def draw(painter: Painter) -> None:
        painter.disc(far, 5, WHITE)
        painter.line([far, (far[0] + 10, far[1])], 3, WHITE)
        painter.polygon([far, (far[0] + 9, far[1]), (far[0], far[1] + 9)], WHITE)
        painter.arrow(far, far, 3, WHITE)
        painter.fading([far], 3, WHITE, 1.0)

    assert drawn(draw).sum() == 0


def test_a_shape_may_reach_far_beyond_the_surface():
    light = drawn(lambda p: p.line([(-1e5, 30), (1e5, 30)], 4, WHITE))
    assert light.sum() == pytest.approx(80 * 4, rel=0.07)


@pytest.mark.parametrize(("kept", "draw"), [(_disc, Painter.disc), (_shadow, Painter.shadow)], ids=["disc", "shadow"])
def test_large_shapes_of_a_camera_that_zooms_are_not_kept(kept, draw):
    """Each is of another size: they used to fill the memory, by a gigabyte in a film."""
    before = kept.cache_info().currsize
    for half in range(150, 160):
        more = (half, WHITE, 0.5) if draw is Painter.shadow else (WHITE,)
        assert drawn(lambda p, half=half, more=more: draw(p, (40.0, 30.0), half, *more)).max() > 0.4
    assert kept.cache_info().currsize == before


def test_colours():
    assert palette("trace")["colours"][0] == (0xD5, 0x5E, 0x00)
    assert mix((0, 0, 0), (100, 200, 50), 0.5) == (50, 100, 25)
    surface = from_colours(np.full((4, 3, 3), (10.4, 300.0, -5.0)))
    assert surface.get_size() == (4, 3)
    assert surface.get_at((2, 2))[:3] == (10, 255, 0)


@pytest.mark.parametrize(("width", "rows"), [(0.4, 1), (1.0, 1), (2.0, 2), (3.4, 3)])
def test_a_thread_is_of_whole_pixels_and_at_least_one(width, rows):
    light = drawn(lambda p: p.thread([(5, 10), (20, 10), (35, 10)], width, WHITE))
    assert (light[12] > 0.5).sum() == rows


@pytest.mark.parametrize("width", [1, 3])
def test_a_thread_of_one_point_is_nothing(width):
    assert not drawn(lambda p: p.thread([(4, 4)], width, WHITE)).any()


def test_shapes_that_differ_by_rounding_alone_look_the_same():
    """Either may be kept for the other; an edge just below a whole px used to be drawn one subpixel short."""
    square = np.array([(20.0, 20.0), (60.0, 20.0), (60.0, 40.0), (20.0, 40.0)])
    looks = []
    for points, white in (
        (square, WHITE),
        (square - 1e-9, (255, 255, 254)),
    ):  # another colour, so that it is drawn anew
        looks.append(drawn(lambda p, points=points, white=white: p.polygon(points + 0.5, white)))
    assert np.array_equal(*looks)
