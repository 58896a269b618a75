"""Surfaces that move in pictures: drawn where they are, on posters with a trace of their sweep; and what pages get."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

import sandbox
from sandbox import Ball, Cloth, Moving, SceneRun, Segment, Setup, Sliding, Surface, Turning
from sandbox.page.playing import _driven
from sandbox.picture.energy_chart import bands_of, held_at_the_end
from sandbox.picture.palette import palette
from sandbox.picture.plain import Picture
from sandbox.scene.setup_scene import with_scene
from tests.scenes.play import run_of

SIZE = (640, 360)
COLOUR = palette("plain")["surface"]


@pytest.fixture(scope="module")
def run() -> SceneRun:
    """A gate that slides from x = 0 at 0.2 m/s, and a blade that strikes a ball."""
    gate = Moving(Surface("gate", Segment((0.0, -0.3), (0.0, 0.3), 0.02), 0.5, 0.2), Sliding((0.2, 0.0)))
    blade = Moving(Surface("blade", Segment((-1.0, 0.0), (-0.4, 0.0), 0.02), 0.5, 0.2), Turning((-1.0, 0.0), 1.0))
    ball = Ball("ball", 0.1, 0.1, (-0.8, 0.3))
    return with_scene(sandbox.simulate(Setup([ball], [gate, blade], duration=2.0, plane=Cloth())))


def painted(surface: pygame.Surface, picture: Picture, x: float, y: float) -> bool:
    """True if a place in m has the colour of surfaces."""
    at = picture.camera.pixel(x, y)
    return np.abs(np.array(surface.get_at((round(at[0]), round(at[1])))[:3]) - np.array(COLOUR[:3])).max() < 12


def picture_of(run: SceneRun) -> Picture:
    return run.scene.picture(run, SIZE)


@pytest.mark.parametrize("t", [0.0, 0.5, 1.0])
def test_a_frame_has_them_where_they_are(run, t: float):
    picture = picture_of(run)
    frame = picture.frame(t)
    assert painted(frame, picture, 0.2 * t, 0.2)
    assert not painted(frame, picture, 0.2 * t + 0.15, 0.2)


def test_the_poster_has_them_when_the_last_is_met(run):
    last = [event.t for event in run.events if event.kind == "impact"][-1]
    picture = picture_of(run)
    assert picture.driven_moment == last
    poster = picture.poster()
    assert painted(poster, picture, 0.2 * last, 0.2)
    assert not painted(poster, picture, 0.0, 0.2)


def test_an_impact_is_marked_where_the_surface_is_then(run):
    first = picture_of(run).paths["ball"].marks()
    mark = next(iter(first))
    angle = mark.t  # of the blade, at 1 rad/s
    assert (mark.at[0] + 1.0) * np.sin(angle) - mark.at[1] * np.cos(angle) == pytest.approx(-0.02, abs=1e-6)


def test_all_of_their_way_is_in_the_picture(run):
    low, high = picture_of(run).surroundings
    assert high[0] >= 0.2 * run.duration
    assert low[1] <= -0.3


def test_a_page_gets_their_places(run):
    driven = _driven(picture_of(run), run)
    gate, blade = driven["surfaces"]
    for i in (0, 60, len(gate["ends"]) - 1):
        assert gate["ends"][i] == pytest.approx(
            [0.2 * i * driven["step"], -0.3, 0.2 * i * driven["step"], 0.3], abs=1e-6
        )
        angle = i * driven["step"]
        assert blade["ends"][i] == pytest.approx([-1.0, 0.0, -1.0 + 0.6 * np.cos(angle), 0.6 * np.sin(angle)], abs=1e-6)


def test_the_energy_chart_names_what_drives():
    _, put_in = bands_of(held_at_the_end(run_of("minigolf/blocked", {"ball.x": -0.2, "launch.speed": 0.0})))
    assert [band.name for band in put_in] == ["driven by blade"]
