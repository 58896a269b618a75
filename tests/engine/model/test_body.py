"""Bodies as they are described: mass, moment of inertia, and what is refused."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from sandbox.engine.model.ball import Body
from sandbox.engine.model.setup import ContactModel, Setup
from sandbox.engine.model.shapes import Ellipse, Polygon, Shape, box, disc, regular
from sandbox.engine.model.surface import Surface
from sandbox.physics.ice import Glide
from tests.engine.bodies import LEVEL


@pytest.mark.parametrize(
    ("shape", "factor"),
    [
        (box(0.4, 0.3), (0.16 + 0.09) / 12),
        (disc(0.2), 0.04 / 2),
        (Ellipse(0.3, 0.12), (0.09 + 0.0144) / 4),
        (regular(3, 0.3), 0.09 / 4),
    ],
)
def test_moments_of_inertia_are_those_of_the_textbook(shape: Shape, factor: float):
    assert Body("body", position=(0.0, 0.0), shape=shape, mass=3.0).inertia == pytest.approx(3.0 * factor, rel=1e-14)


def test_mass_from_density_with_given_center_and_moment():
    given = Body("body", position=(0.0, 0.0), shape=box(0.4, 0.3), density=5.0, center=(0.1, 0.0))
    assert given.mass == pytest.approx(0.6)
    assert given.inertia == pytest.approx(0.6 * (0.25 / 12 + 0.01))
    assert replace(given, angle=1.0).outline == given.outline
    elsewhere = Body("body", position=(0.0, 0.0), shape=Ellipse(0.4, 0.3, (0.5, 0.2)), mass=1.0)
    assert elsewhere.outline == Ellipse(0.4, 0.3)
    assert Body("body", position=(0.0, 0.0), shape=box(0.4, 0.3), mass=1.0, moment=0.7).inertia == pytest.approx(0.7)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"shape": box(1.0, 1.0)}, "either mass or density"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "density": 1.0}, "either mass or density"),
        ({"shape": Polygon(((0.0, 0.0), (1.0, 0.0))), "mass": 1.0}, "no area"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "center": (0.6, 0.0)}, "inside"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "angle": math.nan}, "finite"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "moment": -1.0}, "positive"),
        ({"shape": box(1.0, 1.0), "mass": 1.0, "rolling_spin": (1.0, 0.0)}, "rolling_spin"),
    ],
)
def test_a_wrong_body_is_refused_with_its_reason(wrong: dict[str, Any], said: str):
    with pytest.raises(ValueError, match=said):
        Body("body", position=(0.0, 0.0), **wrong)


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"contact": ContactModel("hertz")}, "hertz.*bodies"),
        ({"surfaces": [Surface("cushion", LEVEL, 0.5, 0.1, nose_height=0.1)]}, "'cushion'.*bodies"),
        ({"plane": Glide(0.1)}, "bodies cannot move on a plane"),
    ],
)
def test_what_bodies_do_not_know_is_refused(more: dict[str, Any], said: str):
    with pytest.raises(ValueError, match=said):
        Setup([Body("body", position=(0.0, 0.0), shape=box(1.0, 1.0), mass=1.0)], **more)
