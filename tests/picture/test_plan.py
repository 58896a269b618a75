"""Places seen from above: their parts, and that what is drawn once is drawn as it is seen."""

import numpy as np
import pygame
import pytest

import sandbox
from sandbox.picture.camera import Box, Camera
from sandbox.picture.painter import Painter, blank
from sandbox.picture.places import Shape, goal, plan
from sandbox.picture.places.table import cushions

SIZE = (320, 180)
GROUND, GREY, WHITE, BLACK, RED = (60, 110, 70), (90, 90, 90), (255, 255, 255), (0, 0, 0), (200, 30, 30)
KIT = plan.Kit(RED, RED, BLACK, WHITE, WHITE)

PLACE: plan.Plan = (
    plan.Ground(Box(-50, -50, 50, 50), GREY),
    plan.Stripes(Box(-9, -4, 9, 4), (GROUND, GREY, WHITE, RED), 1.3, 0.2),
    plan.Stripes(Box(-9, 4, 9, 5), (BLACK, RED), 1.0, along=True),
    plan.Line(((-8.0, -3.0), (-8.0, 3.0)), 0.1, BLACK),
    plan.Line(plan.arc((2.0, 1.0), 2.5, 20, 300), 0.1, BLACK),
    plan.Spot((5.0, -2.0), 0.4, BLACK),
    plan.Spot((5.0, -2.0), 1.4, BLACK, ring=0.1),
    Shape(((0.0, 0.0), (3.0, 0.5), (1.0, 3.0)), RED),
    plan.Worn((-3.0, -1.0), 2.0, 1.0, BLACK, 0.5),
    *goal(6.0, 2.0, 2.4, 5.88, 0.06, WHITE, WHITE, WHITE, side=-3.0),
    plan.Person((-5.0, 2.0), 200.0, KIT, behind=0.5, arms=0.7),
)


def pixels(surface: pygame.Surface) -> np.ndarray:
    return pygame.surfarray.array3d(surface).astype(int)


def on(part, scale: float = 20.0) -> np.ndarray:
    """How much a part changes the middle of a picture."""
    surface = blank(SIZE)
    surface.fill(GROUND)
    part.draw(Painter(surface), Camera((0.0, 0.0), (160.0, 90.0), scale))
    return pixels(surface) - np.array(GROUND)


@pytest.mark.parametrize("part", PLACE, ids=lambda part: type(part).__name__)
@pytest.mark.parametrize("scale", [2.0, 20.0])
def test_every_part_is_seen_however_small(part, scale):
    assert on(part, scale).any()


@pytest.mark.parametrize("scale", [0.05, 0.4, 3.0, 40.0])
def test_stripes_fill_their_ground_and_are_never_too_narrow(scale):
    seen = on(plan.Stripes(Box(-9000, -9000, 9000, 9000), (WHITE, RED), 1.3, 0.7), scale)
    assert seen.any(axis=2).all()
    edges = np.flatnonzero((np.diff(seen[:, 90], axis=0) != 0).any(axis=1))
    assert len(edges) < 2 or np.diff(edges).min() >= plan.LEAST_STRIPE * 180 / 720 - 1


def test_a_line_has_its_width():
    across = on(plan.Line(((-9.0, 0.0), (9.0, 0.0)), 0.5, WHITE))[160].any(axis=1)
    assert across.sum() == 10


@pytest.mark.parametrize(("start", "end"), [(0, 360), (90, 270), (-30, 30)])
def test_an_arc_keeps_its_distance(start, end):
    points = np.array(plan.arc((3.0, -2.0), 1.5, start, end)) - (3.0, -2.0)
    assert np.hypot(*points.T) == pytest.approx(1.5)
    assert points[0] == pytest.approx(1.5 * np.array([np.cos(np.radians(start)), np.sin(np.radians(start))]))
    assert np.hypot(*np.diff(points, axis=0).T).max() < 0.06


def test_people_have_a_minimum_size_and_true_arm_reach():
    narrow, broad = (on(plan.Person((0.0, 0.0), 0.0, KIT), scale).any(axis=(0, 2)).sum() for scale in (1.0, 60.0))
    assert narrow >= plan.LEAST_PERSON * 180 / 720
    assert broad > 25
    reaching = np.flatnonzero(on(plan.Person((0.0, 0.0), 0.0, KIT, arms=1.0), 60.0).any(axis=(0, 2)))
    assert 115 <= np.ptp(reaching) <= 130


@pytest.mark.parametrize(("source", "jaws"), [("billiards", 2), ("billiards/three-rail-carom", 0)])
def test_cushions_lie_between_their_jaws(source, jaws):
    scene = sandbox.load(source)
    table, setup = scene.parameters.table, scene.build()
    back = 0.5 * table.length + table.cushion_width, 0.5 * table.width + table.cushion_width
    found = cushions(setup.surfaces, back, (WHITE, RED))
    assert len(found) == (6 if jaws else 4)
    assert all(sum(jaw is not None for jaw in cushion.jaws) == jaws for cushion in found)


def test_a_table_is_drawn_once_for_all_pictures_of_it():
    runs, size = [sandbox.simulate(sandbox.load("billiards", {"cue.speed": 0.0})) for _ in range(2)], (320, 180)
    plans = [run.scene.picture(run).plan for run in runs]
    camera = Camera((0.0, 0.0), (160.0, 90.0), 90.0)
    assert plan.drawn(plans[0], camera, size) is plan.drawn(plans[1], camera, size)
