"""What is hit answers, apart from the physics: nets, rings and flags."""

from __future__ import annotations

import numpy as np
import pygame
import pytest

import sandbox
from sandbox.picture.answer import yielding
from sandbox.picture.painter import Painter, blank

SIZE = (320, 180)


def view_of(name, **changes):
    run = sandbox.simulate(sandbox.load(name, {key.replace("__", "."): value for key, value in changes.items()}))
    return run.scene.picture(run, SIZE)


def drawn(view, t, answering):
    """What moves, drawn on black by the camera where it is nearest."""
    surface = blank(SIZE)
    view.draw_balls(Painter(surface), view.closest, t, 0.0, answering)
    return pygame.surfarray.array3d(surface)


def test_what_is_hit_gives_way_swings_and_rests():
    shares = [yielding(since) for since in np.linspace(0.0, 3.0, 301)]
    assert shares[0] == shares[-1] == 0.0
    assert max(shares) == pytest.approx(1.0) == shares[9]
    assert min(shares) < -0.2


@pytest.mark.parametrize("name", ["soccer", "soccer-curl", "hockey"])
def test_a_goal_pulls_the_back_of_the_net_out_for_a_moment(name):
    view = view_of(name)
    (net,) = view.pulled
    back = view.aims[0].right
    assert (net.at[0], net.normal[0]) == (pytest.approx(back), 1.0)
    t = min(net.t + 0.1, view.run.duration)
    still = drawn(view, t, None)
    assert (drawn(view, t, net.t + 0.1) != still).any()
    if name != "hockey":  # where the puck lies in the net then
        assert np.array_equal(drawn(view, t, net.t + 5.0), still)


def test_a_net_between_courts_is_pulled_the_way_of_the_ball():
    (net,) = view_of("volleyball", launch__angle=2.0).pulled
    assert (net.at[0], net.normal) == (9.0, (1.0, -0.0))
    assert sum(net.reach) == pytest.approx(1.0)  # m: the net's depth


def test_a_puck_in_the_goal_lies_in_the_net_as_that_answers():
    view = view_of("hockey")
    line = view.parameters.rink.line
    assert view.position_of("puck", view.run.duration)[0] == pytest.approx(line, abs=0.1)
    view.answering = view.run.duration
    assert view.position_of("puck", view.run.duration)[0] == pytest.approx(line + 1.0, abs=0.05)


def test_ring_and_board_shake_where_the_ball_hits_them():
    from scenes.basketball.hoop import shaken

    run, clean = view_of("basketball/rattle").run, view_of("basketball").run
    t = next(e.t for e in run.events if e.partner.startswith("rim"))
    assert 0.001 < max(abs(shaken(run, t + since)) for since in (0.02, 0.05, 0.1)) <= 0.03  # m
    assert shaken(run, t - 0.01) == shaken(clean, clean.duration) == 0.0


def test_an_air_ball_is_seen_as_it_falls_past_the_ring():
    view = view_of("basketball", launch__speed=6.9)
    assert view.run.result["touches"] == ["floor"]
    assert view.story.place == view.aims[0]
    assert view.run.state("ball", view.story.at)[1] == pytest.approx(view.parameters.hoop.height)
