"""Graphs over time: their values, and that they can be drawn anywhere."""

import numpy as np
import pygame
import pytest

from sandbox.picture.chart import Plot
from sandbox.picture.graph import Panel, draw_panel, graph, panels_of
from sandbox.picture.sheet import Sheet
from sandbox.sport.amounts import shown_in
from tests.scenes.play import run_of


def panels(*names: str) -> dict[str, Panel]:
    return {panel.title: panel for panel in panels_of({name: run_of(name) for name in names})}


def test_newton():
    """In flight |F| = m |a|, where F is the sum of the forces, whose sizes are drawn."""
    run = run_of("throws")
    found = panels("throws")
    (acceleration,) = found["acceleration"].curves
    gravity = next(curve for curve in found["forces"].curves if curve.name == "gravity")
    drag = next(curve for curve in found["forces"].curves if curve.name == "drag")
    ball, top = run.setup.balls[0], np.argmax(found["height"].curves[0].values)
    sum_at_top = np.hypot(gravity.values[top], drag.values[top])  # there drag is level
    assert acceleration.values[top] == pytest.approx(sum_at_top / ball.mass, rel=1e-5)
    assert gravity.values[top] == pytest.approx(ball.mass * 9.81, rel=1e-3)


def test_values_are_those_of_the_path():
    run, found = run_of("golf"), panels("golf")
    (height,), (speed,), (spin,) = (found[name].curves for name in ("height", "speed", "spin"))
    assert height.values.max() == pytest.approx(run.result["apex"], abs=0.05)
    assert speed.values[0] == pytest.approx(76.4, abs=0.1)
    assert spin.values[0] == pytest.approx(2545, abs=1)
    landing = next(event.t for event in run.events if event.kind == "impact")
    here = np.flatnonzero(speed.times == landing)[0]  # a jump is upright
    assert speed.values[here - 1] > 2 * speed.values[here]
    assert speed.times[here] - speed.times[here - 1] < 1e-6


def test_several_runs_and_units():
    found = panels("golf", "golf/headwind")
    assert [curve.name for curve in found["speed"].curves] == ["golf/headwind", "golf"]  # the first is on top
    with shown_in("us"):
        assert (found["speed"].in_chosen_units.unit, found["x"].in_chosen_units.unit) == ("mph", "yd")
    assert found["speed"].in_chosen_units.unit == "m/s"


@pytest.mark.parametrize(
    ("name", "size"), [("curling", (1280, 720)), ("collisions/cradle-3", (320, 320)), ("bullet", (640, 180))]
)
def test_all_can_be_drawn(name: str, size: tuple[int, int]):
    surface = graph(run_of(name), size)
    assert surface.get_size() == size
    assert len(np.unique(pygame.surfarray.array3d(surface).reshape(-1, 3), axis=0)) > 20


def test_a_panel_can_be_drawn_anywhere():
    """With the time marked; nothing is drawn outside its rectangle but half a line's width."""
    sheet = Sheet((640, 360), on_dark=True)
    rect = pygame.Rect(100, 60, 300, 160)
    draw_panel(sheet, rect, panels("throws")["speed"], run_of("throws").duration, t=0.7, said="now 9.1")
    drawn = pygame.surfarray.array3d(sheet.surface).any(axis=2)
    assert drawn[300:400, 60:75].any()  # what is said, at the right
    drawn[98:402, 58:222] = False
    assert not drawn.any()


def test_a_plot_stands_on_its_rectangle():
    """The least value is its lower edge, the largest its upper one; time runs from left to right."""
    plot = Plot(pygame.Rect(10, 20, 200, 100), until=4.0, low=-2.0, high=8.0)
    assert [plot.row(value) for value in (-2.0, 3.0, 8.0)] == [120.0, 70.0, 20.0]
    assert [plot.column(t) for t in (0.0, 1.0, 4.0)] == [10.0, 60.0, 210.0]
