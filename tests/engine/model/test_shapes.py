"""Outlines: their mass properties, their rims, and rounding them."""

from __future__ import annotations

import math

import numpy as np
import pytest

from sandbox.engine.model.nearest import Pose
from sandbox.engine.model.shapes import Polygon
from tests.engine.bodies import OUTLINES, height, widest


@pytest.mark.parametrize("name", OUTLINES)
def test_mass_properties_are_those_of_a_fine_polygon(name: str):
    area, center, moment = OUTLINES[name].mass_properties()
    fine = Polygon(OUTLINES[name].rim(1e-6)).mass_properties()
    assert (area, *center, moment) == pytest.approx((fine.area, *fine.center, fine.moment), rel=3e-5, abs=1e-6)


@pytest.mark.parametrize(
    "corners",
    [(), ((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)), ((0, 0), (2, 0), (1, 0.1), (0, 2)), ((0, 0), (1, 1), (1, 0), (0, 1))],
)
def test_what_is_not_convex_is_refused(corners: tuple[tuple[float, float], ...]):
    with pytest.raises(ValueError, match=r"convex|corners"):
        Polygon(corners)


@pytest.mark.parametrize("name", OUTLINES)
def test_a_rim_is_within_its_tolerance_without_double_points(name: str):
    shape, turns = OUTLINES[name], np.linspace(-np.pi, np.pi, 361)
    for within in (1e-2, 1e-4):
        rim = shape.rim(within)
        left_out = height(shape, Pose(0.0, 0.0, 0.0), turns) - widest(np.array(rim), turns)
        assert -1e-12 < left_out.min() <= left_out.max() < within
        assert min(map(math.dist, rim, [*rim[1:], rim[0]])) > 1e-6


@pytest.mark.parametrize("name", ["box", "triangle", "rounded triangle", "heptagon"])
def test_rounding_keeps_the_sides_and_cuts_the_corners(name: str):
    x, y = OUTLINES[name].mass_properties().center
    shape, here = OUTLINES[name].moved(-x, -y), Pose(0.0, 0.0, 0.0)
    assert isinstance(shape, Polygon)
    rounder, normals, turns = shape.rounded(0.02), np.array(shape.normals), np.linspace(-np.pi, np.pi, 97)
    assert shape.radius < rounder.radius <= shape.radius + 0.02
    assert height(rounder, here, normals) == pytest.approx(height(shape, here, normals))
    cut = height(shape, here, turns) - height(rounder, here, turns)
    assert -1e-12 < cut.min() < 1e-6 < cut.max() < 0.02
