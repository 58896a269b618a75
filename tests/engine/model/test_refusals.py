"""What no setup can be made of is refused where it is given, in one line that names it."""

from __future__ import annotations

import math
from collections.abc import Callable
from decimal import Decimal
from typing import Any

import pytest

from sandbox.engine.model.ball import Ball, Body
from sandbox.engine.model.setup import Bounds, ContactModel, ForceRegion, Setup, Touches
from sandbox.engine.model.shapes import Ellipse, Polygon, box, capsule, disc, regular
from sandbox.engine.model.surface import Bounce, Circle, ConstantBounce, Segment, Surface, Trap

LINE = Segment((-9.0, 0.0), (9.0, 0.0))
LAW = ConstantBounce(Bounce(1.0, 0.0))


def ball(**given: Any) -> Ball:
    return Ball(**{"name": "b", "mass": 1.0, "radius": 0.1, "position": (0.0, 2.0), **given})


def body(**given: Any) -> Body:
    return Body(**{"name": "crate", "position": (0.0, 2.0), "shape": box(1.0, 1.0), "mass": 1.0, **given})


def surface(**given: Any) -> Surface:
    return Surface(**{"name": "floor", "shape": LINE, "restitution": 0.5, "friction": 0.1, **given})


def trap(**given: Any) -> Trap:
    return Trap(**{"name": "pit", "center": (5.0, 0.0), "radius": 0.1, **given})


def setup(**given: Any) -> Setup:
    return Setup(**{"balls": [ball(), ball(name="other", position=(1.0, 2.0))], "surfaces": [surface()], **given})


REFUSED: list[tuple[Callable[[], Any], str]] = [
    (lambda: ball(mass="1"), "ball 'b': mass = '1' must be positive"),
    (lambda: ball(mass=Decimal(1)), r"ball 'b': mass = Decimal\('1'\) must be positive"),
    (lambda: ball(position={0.0, 1.0}), "ball 'b': position = {0.0, 1.0} must be two finite numbers"),
    (lambda: ball(loss=3.0), r"ball 'b': loss = 3.0 must have lost\(t\) in kg and rate\(t\)"),
    (lambda: body(shape=LINE), "body 'crate': shape = Segment.* must be a Polygon or Ellipse, such as box"),
    (lambda: body(shape="box"), "body 'crate': shape = 'box' must be a Polygon"),
    (lambda: body(mass="1"), "body 'crate': mass = '1'"),
    (lambda: body(mass=0.0, density="1"), "body 'crate': density = '1'"),
    (lambda: body(mass=-1.0), "body 'crate': mass = -1.0"),
    (lambda: body(moment="1"), "body 'crate': moment = '1' must be positive"),
    (lambda: body(center=1.0), "body 'crate': center = 1.0 must be two finite numbers"),
    (lambda: box("1", 1.0), "box: width = '1' must be positive"),
    (lambda: box(1.0, 0.0), "box: height = 0.0 must be positive"),
    (lambda: box(1.0, math.nan), "box: height = nan must be positive"),
    (lambda: capsule("1", 0.1), "capsule: length = '1' must be positive"),
    (lambda: disc("1"), "polygon: radius = '1' must not be negative"),
    (lambda: regular(2.5, 1.0), "regular polygon: count = 2.5 must be a whole number, 3 or more"),
    (lambda: Polygon([1.0, 2.0, 3.0]), r"polygon: corners = \[1.0, 2.0, 3.0\] must be points in m"),
    (lambda: Polygon([(0.0, 0.0), (math.inf, 0.0)]), "polygon: corners = .* and finite"),
    (lambda: Ellipse(1.0, "1"), "ellipse: b = '1' must be positive"),
    (lambda: Ellipse(1.0, 1.0, 3.0), "ellipse: center = 3.0 must be two finite numbers"),
    (lambda: Segment((1.0, 2.0), (1.0, 2.0)), r"segment: a = b = \(1.0, 2.0\) has no length: a dot is Circle"),
    (lambda: surface(shape=box(1.0, 1.0)), "surface 'floor': shape = Polygon.* must be a Segment or a Circle"),
    (lambda: surface(shape=[LINE, Circle((0.0, 0.0), 1.0)]), r"surface 'floor': shape = \[Segment.* one to a surface"),
    (lambda: surface(law=0.5), "surface 'floor': law = 0.5 must be a function of the normal and the tangential speed"),
    (lambda: surface(nose_height="1"), "surface 'floor': nose_height = '1' must not be negative"),
    (lambda: ConstantBounce(0.5), "bounce law: bounce = 0.5 must be a Bounce"),
    (lambda: ConstantBounce(Bounce(-0.5, 0.1)), "bounce law: restitution = -0.5 must be from 0 to 1"),
    (lambda: ConstantBounce(Bounce(0.5, -0.1)), "bounce law: friction = -0.1 must not be negative"),
    (lambda: trap(radius=-1.0), "trap 'pit': radius = -1.0 must be positive"),
    (lambda: trap(end=3.0), "trap 'pit': end = 3.0 must be two finite numbers"),
    (lambda: trap(end=(5.0, 0.0)), r"trap 'pit': end = center = \(5.0, 0.0\): leave out end"),
    (lambda: trap(only="b"), r"trap 'pit': only = 'b' must be a list"),
    (lambda: ContactModel("soft"), "contact model: name = 'soft' must be \"auto\""),
    (lambda: ContactModel("hertz", stiffness=-1.0), "contact model: stiffness = -1.0 must be positive"),
    (lambda: Touches("floor", 0), "Touches: times = 0 must be a whole number"),
    (lambda: setup(pairs=[("b", "other", None)]), "setup: pairs: None is no law"),
    (lambda: setup(pairs=[("b", "other")]), r"setup: pairs: \('b', 'other'\) must be \(ball, ball, law\)"),
    (lambda: setup(pairs=[("b", "floor", LAW)]), "setup: pairs: there is no ball 'floor'; there are 'b', 'other'"),
    (lambda: setup(planes=[("b",)]), r"setup: planes: \('b',\) must be \(ball, law\)"),
    (lambda: setup(planes=[("b", None)]), "setup: None is no plane"),
    (lambda: setup(traps=[trap(only=["white"])]), "setup: traps: there is no ball 'white'; there are 'b', 'other'"),
    (lambda: setup(between_balls=Bounce(1.0, 0.0)), "setup: between_balls = Bounce.* must be a function"),
    (lambda: setup(until="floor"), "setup: until = 'floor' must be a function of an event, or such as Touches"),
    (lambda: setup(bounds=Bounds(left=1.0, right=-1.0)), "setup: bounds = Bounds.* must be numbers in m, left < right"),
    (lambda: setup(bounds=Bounds(top="1")), "setup: bounds = Bounds.* must be numbers in m"),
    (lambda: setup(force_regions=[ForceRegion(0.0, 0.0, 1.0, 1.0, 0.0)]), "force region: step = 0.0 must be positive"),
    (lambda: setup(discontinuities=[2.0, 1.0]), r"setup: discontinuities = \[2.0, 1.0\] must be finite times in s"),
    (lambda: setup(discontinuities=["1"]), r"setup: discontinuities = \['1'\] must be finite times"),
]


@pytest.mark.parametrize(("make", "said"), REFUSED, ids=[said[:40] for _, said in REFUSED])
def test_a_wrong_field_is_named_with_its_value(make: Callable[[], Any], said: str):
    with pytest.raises(ValueError, match=f"^{said}") as caught:
        make()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("make", [ball, body, surface, setup])
def test_an_unknown_field_is_named_with_those_there_are(make: Callable[..., Any]):
    with pytest.raises(TypeError, match=r"unexpected keyword argument 'gravity'; it takes .*\w+, \w+"):
        make(gravity=9.81)


def test_an_end_without_bounds_and_a_fixed_cushion_are_fine():
    made = setup(bounds=Bounds(-math.inf, -math.inf, math.inf, math.inf), until=Touches("floor", 2))
    assert made.bounds.hold((1e9, 0.0, 0.0, 0.0, 0.0))
