"""Arrows at the ball: forces by cause, and what a surface does."""

from functools import cache
from math import hypot

import pytest

import sandbox
from sandbox.engine.motion.forces_on_ball import cause
from sandbox.picture.sheet import Sheet
from sandbox.picture.vectors import Vectors, colour_of
from sandbox.sport.amounts import amount


@cache
def vectors(name: str) -> Vectors:
    run = sandbox.simulate(sandbox.load(name))
    return Vectors(run, run.setup.balls[0].name)


def test_forces_in_flight_make_up_the_acceleration():
    drive = vectors("golf")
    forces = drive.forces(2.0)
    assert list(forces) == ["gravity", "drag", "lift"]
    before, after = (drive.run.state("ball", t)[2:4] for t in (2.0 - 1e-4, 2.0 + 1e-4))
    for axis in (0, 1):
        total = sum(force[axis] for force in forces.values())
        assert total == pytest.approx(drive.ball.mass * (after[axis] - before[axis]) / 2e-4, rel=1e-4)


def test_drag_is_against_the_way_and_lift_across_it():
    drive = vectors("golf")
    vx, vy = drive.run.state("ball", 1.0)[2:4]
    forces = drive.forces(1.0)
    along = {name: (fx * vx + fy * vy) / hypot(vx, vy) / hypot(fx, fy) for name, (fx, fy) in forces.items()}
    assert along["drag"] == pytest.approx(-1.0)
    assert along["lift"] == pytest.approx(0.0, abs=1e-12)


def test_the_turf_carries_a_putt_and_slows_it():
    putt = vectors("golf/putt")
    forces = putt.forces(1.5)
    weight = putt.ball.mass * 9.81
    assert forces["gravity"] == pytest.approx((0.0, -weight), rel=1e-3)
    assert forces["contact"][1] == pytest.approx(weight, rel=1e-2)
    assert -0.2 * weight < forces["contact"][0] < 0.0


@pytest.mark.parametrize("name", ["golf", "soccer"])
def test_the_ground_carries_a_ball_at_rest(name):
    forces = vectors(name).forces(vectors(name).run.duration)
    assert forces["gravity"][1] < 0.0
    assert forces["contact"] == pytest.approx((0.0, -forces["gravity"][1]))


def test_cloth_slows_a_sliding_ball_by_its_friction():
    draw = vectors("billiards/draw")
    cloth = draw.run.setup.plane
    forces = draw.forces(0.05)
    assert list(forces) == ["cloth"]
    assert hypot(*forces["cloth"]) == pytest.approx(cloth.sliding * draw.ball.mass * cloth.gravity, rel=1e-6)
    later = draw.forces(3.0)["cloth"]  # rolling by then
    assert hypot(*later) == pytest.approx(cloth.rolling * draw.ball.mass * cloth.gravity, rel=1e-6)


def test_causes_have_names_and_colours():
    class SideWind:
        pass

    def fan_of_mine():
        pass

    assert (cause(SideWind()), cause(fan_of_mine)) == ("side wind", "fan of mine")
    assert colour_of("drag") != colour_of("lift") != colour_of("side wind")
    assert colour_of("side wind") == colour_of("side wind")


@pytest.mark.parametrize(
    ("force", "text"),
    [(0.0, "0 mN"), (0.0123, "12 mN"), (0.0999, "0.10 N"), (0.45, "0.45 N"), (12.34, "12.3 N"), (43210.0, "43.2 kN")],
)
def test_newtons(force, text):
    assert amount(force, "N") == text


def test_arrows_are_drawn_where_they_should():
    drive = vectors("golf")
    sheet = Sheet((640, 360))
    sheet.surface.fill((0, 0, 0))
    drive.draw(sheet, (320.0, 180.0), 8.0, 0.5)
    pixels = {
        (x, y) for x in range(0, 640, 2) for y in range(0, 360, 2) if sheet.surface.get_at((x, y))[:3] != (0, 0, 0)
    }
    right, left = max(x for x, _ in pixels) - 320, 320 - min(x for x, _ in pixels)
    assert right > left > 8  # the velocity ahead is longer than the drag behind
    assert max(y for _, y in pixels) > 180 + 16  # weight


def test_a_ball_without_motion_or_force_has_no_arrows():
    run = sandbox.simulate(sandbox.load("billiards/bank"))
    sheet = Sheet((320, 180))
    before = sheet.surface.get_buffer().raw
    Vectors(run, "1").draw(sheet, (160.0, 90.0), 5.0, 0.05)
    assert sheet.surface.get_buffer().raw == before
