"""The axes of a sweep and its points: read from text or Python, in order, and the same at random."""

from __future__ import annotations

import numpy as np
import pytest

import sandbox
from sandbox.errors import RequestError
from sandbox.lab.axes import Normal, Span, Values, as_axis, parse_axis, points_in
from sandbox.lab.plan import Plan
from sandbox.lab.row_file import cell
from sandbox.scene import load
from tests.lab.sweeping import grid
from tests.own_scene import DROP


def test_axes_are_read(falling):
    assert parse_axis(falling, "--over", "launch.height=1:2:3") == Values("launch.height", (1.0, 1.5, 2.0))
    assert parse_axis(falling, "--over", "launch.height = 10 cm:2 ft:2") == Values("launch.height", (0.1, 0.6096))
    assert parse_axis(falling, "--over", "launch.height=1:2") == Span("launch.height", 1.0, 2.0)
    assert parse_axis(falling, "--over", "launch.height=3,1,2 m") == Values("launch.height", (3.0, 1.0, 2.0))
    assert parse_axis(falling, "--over", "floor.present=true,false") == Values("floor.present", (True, False))
    assert parse_axis(falling, "--over", "ball.drag.model=none,constant") == Values(
        "ball.drag.model", ("none", "constant")
    )
    assert parse_axis(falling, "--over", "air.wind[0]=-1:1:2") == Values("air.wind[0]", (-1.0, 1.0))
    assert parse_axis(falling, "--over", "air.wind=[1,2],[3,4]") == Values("air.wind", ((1.0, 2.0), (3.0, 4.0)))


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("launch.height", "write it as KEY=LO:HI:N"),
        ("launch.hight=1:2:3", "did you mean launch.height?"),
        ("launch.height=1:200:3", "must be from"),
        ("launch.height=1 kg:2:3", "kg is a unit of mass"),
        ("launch.height=2:1:3:4", "a range has two or three"),
        ("launch.height=1:2:none", "not a number of points"),
        ("launch.height=1:2:0", "not a number of points"),
        ("launch.height=2:1", "write the lower end first"),
        ("floor.present=false:true:2", "only numbers can have a range"),
        ("launch=1:2:3", "group of keys"),
        ("air.wind[7]=1:2:3", "there is no [7]; the list has 2"),
        ("launch.height[0]=1:2:3", "is not a list"),
        ("air..wind=1:2:3", "a key is written like"),
    ],
)
def test_what_cannot_be_swept_over_is_told(falling, text, told):
    with pytest.raises(RequestError) as refused:
        parse_axis(falling, "--over", text)
    assert told in str(refused.value)
    assert str(refused.value).startswith("--over ")


def test_axes_from_python(falling):
    assert as_axis(falling, "launch.height", np.array([1.0, 2.0, 3.0])) == Values("launch.height", (1.0, 2.0, 3.0))
    assert as_axis(falling, "launch.height", (1.0, "2 m")) == Span("launch.height", 1.0, 2.0)
    assert as_axis(falling, "floor.present", (True, False)) == Values("floor.present", (True, False))
    with pytest.raises(RequestError, match="must be from"):
        as_axis(falling, "launch.height", [1.0, 2.0, -3.0])


def test_a_grid_runs_through_its_last_axis_first(falling):
    plan = grid(falling, "launch.height=1:2:2", "launch.speed=3,4,5")
    assert list(plan.points(0, 6)) == [(1.0, 3.0), (1.0, 4.0), (1.0, 5.0), (2.0, 3.0), (2.0, 4.0), (2.0, 5.0)]
    assert list(plan.points(2, 4)) == [(1.0, 5.0), (2.0, 3.0)]


def test_random_points_are_the_same_however_they_are_taken(falling):
    axes = (Span("launch.height", 1.0, 2.0), Values("floor.present", (True, False)))
    plan = Plan(falling, axes, samples=3000, seed=7)
    points = list(plan.points(0, 3000))
    assert [*plan.points(0, 1000), *plan.points(1000, 1025), *plan.points(1025, 3000)] == points
    assert list(Plan(falling, axes, samples=3000, seed=8).points(0, 9)) != points[:9]
    heights = np.array([height for height, _ in points])
    assert heights.min() >= 1.0
    assert heights.max() <= 2.0
    assert np.histogram(heights, 4, (1.0, 2.0))[0] == pytest.approx(750, abs=100)
    assert sum(present for _, present in points) == pytest.approx(1500, abs=150)


@pytest.mark.parametrize(
    ("texts", "more", "told"),
    [
        ((), {}, "nothing to sweep over"),
        (("launch.height=1:2",), {}, "--over launch.height=1:2: a grid needs the number of points, 1:2:N"),
        (("launch.height=1:2:2", "launch.height=3,4"), {}, "swept over twice"),
        (("launch.height=1:2",), {"samples": -1}, "samples = -1, seed = 0: must not be less than 0"),
        (("launch.height=1:2",), {"samples": 3, "seed": -1}, "samples = 3, seed = -1: must not be less than 0"),
        (("launch.height=1:2:1000000", "launch.speed=1:2:1000000"), {}, "too many"),
    ],
)
def test_plans_that_make_no_sense_are_told(falling, texts, more, told):
    with pytest.raises(RequestError) as refused:
        grid(falling, *texts, **more)
    assert told in str(refused.value)


def test_elements_of_lists_can_be_swept_over():
    scene = load(DROP, {"marks": [{"x": 1.0}, {"x": 2.0}]})
    plan = grid(scene, "marks[1].x=3,4", "air.wind[1]=5,6")
    from sandbox.lab.axes import Varied

    parameters = Varied(scene, plan.keys).parameters((4.0, 6.0))
    assert [mark.x for mark in parameters.marks] == [1.0, 4.0]
    assert parameters.air.wind == (0.0, 6.0)


def test_the_values_of_a_range_have_no_digits_of_rounding():
    """-28.8, not -28.799999999999997; what has no short form keeps all its digits."""
    axis = parse_axis(sandbox.load("golf"), "--over", "launch.angle=-72:72:11")
    assert [cell(value) for value in axis.values[:5]] == ["-72.0", "-57.6", "-43.2", "-28.8", "-14.4"]
    assert axis.values[5] == 0.0
    thirds = parse_axis(sandbox.load("golf"), "--over", "launch.angle=7:8:4")
    assert thirds.values == tuple(np.linspace(7.0, 8.0, 4))


def test_a_normal_distribution_is_read_and_drawn(falling):
    axis = parse_axis(falling, "--over", "launch.height=2 m~10 cm")
    assert axis == Normal("launch.height", 2.0, 0.1, axis.bounds)
    assert as_axis(falling, "launch.height", "2~0.1") == axis
    plan = Plan(falling, (axis, Span("launch.speed", 1.0, 2.0)), samples=3000, seed=7)
    heights = np.array([height for height, _ in plan.points(0, 3000)])
    assert heights[1020:1030].tolist() == [height for height, _ in plan.points(1020, 1030)]
    within = [float((np.abs(heights - 2.0) < n * 0.1).mean()) for n in (1, 2, 3)]
    assert within == pytest.approx([0.683, 0.954, 0.997], abs=0.02)
    assert heights.mean() == pytest.approx(2.0, abs=0.006)


def test_a_normal_distribution_ends_at_the_bounds(falling):
    (low, high) = parse_axis(falling, "--over", "launch.height=2~1").bounds
    drawn = Normal("launch.height", low, 1.0, (low, high))
    values = [drawn.value(share) for share in (0.0, 0.25, 0.5, 0.75, 1.0 - 2**-53)]
    assert values[0] == low
    assert values == sorted(values)
    assert values[2] == pytest.approx(low + 0.6745, abs=1e-3)  # half of the upper half of the distribution


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("launch.height=2~", 'the standard deviation "" is not a number with a unit'),
        ("launch.height=2~1 kg", 'the standard deviation "1 kg"'),
        ("launch.height=2~0", "must be more than 0, and finite"),
        ("launch.height=2~-1", "must be more than 0, and finite"),
        ("launch.height=2~nan", "must be more than 0, and finite"),
        ("launch.height=~1", "launch.height"),
        ("launch.hight=2~1", "did you mean launch.height?"),
        ("floor.present=true~1", "only numbers can be normally distributed"),
    ],
)
def test_a_wrong_normal_distribution_is_told(falling, text, told):
    with pytest.raises(RequestError) as refused:
        parse_axis(falling, "--over", text)
    assert told in str(refused.value)
    assert "\n" not in str(refused.value)


def test_a_distribution_needs_samples(falling):
    with pytest.raises(RequestError, match=r"launch.height=2~0.1: a distribution needs --samples"):
        grid(falling, "launch.height=2~0.1")


def test_points_are_read_from_a_table(falling, tmp_path):
    table = tmp_path / "points.csv"
    table.write_text("launch.height, ball.drag.model ,floor.present\n1.5,none,true\n20 cm,constant,false\n\n")
    assert points_in(falling, "--points", table) == (
        Values("launch.height", (1.5, 0.2)),
        Values("ball.drag.model", ("none", "constant")),
        Values("floor.present", (True, False)),
    )
    plan = Plan(falling, points_in(falling, "--points", table), listed=True)
    assert list(plan.points(0, 2)) == [(1.5, "none", True), (0.2, "constant", False)]
    assert (plan.shape, plan.size, list(plan.points(1, 2))) == ((2,), 2, [(0.2, "constant", False)])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("", "no points"),
        ("launch.height\n", "no points"),
        ("launch.height,launch.speed\n1,2\n1\n", "point 1 has 1 values, but there are 2 keys"),
        ("launch.hight\n1\n", "did you mean launch.height?"),
        ("launch.height\n1\n2\n-3\n", "point 2, launch.height = -3: must be from"),
        ("launch.height\n1\nnan\n3\n", "point 1, launch.height = nan: must be a finite number"),
        ("launch.height,launch.height\n1,2\n", "launch.height is swept over twice"),
    ],
)
def test_a_wrong_table_of_points_is_told(falling, tmp_path, text, told):
    table = tmp_path / "points.csv"
    table.write_text(text)
    with pytest.raises(RequestError) as refused:
        Plan(falling, points_in(falling, "--points", table), listed=True)
    assert told in str(refused.value)
    with pytest.raises(RequestError, match="cannot be read: no such file"):
        points_in(falling, "--points", tmp_path / "none.csv")
