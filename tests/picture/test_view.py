"""What the pictures of all scenes share, and each states only once: balls at even times, marks, comparisons, notes."""

from __future__ import annotations

import re
from dataclasses import replace
from math import dist, hypot
from types import SimpleNamespace

import numpy as np
import pygame
import pytest

import sandbox
from sandbox.picture import marks
from sandbox.picture.ball import Look
from sandbox.picture.painter import Painter
from sandbox.picture.places import Landscape, Person, Stands, Stripes
from sandbox.picture.view import View
from tests.scenes.play import run_of

SIDE = ["golf", "golf/golf-game", "golf/putt", "soccer", "soccer/goal-kick-in-a-gale", "basketball/rattle"]


def picture_of(name: str, size=(1280, 720), **others: str) -> View:
    run = run_of(name)
    return run.scene.picture(run, size, {label: run_of(other) for label, other in others.items()})


def written(picture: View) -> str:
    return " ".join(text for text, _ in picture.sheet.written)


@pytest.mark.parametrize("name", SIDE)
def test_a_ball_or_a_bead_is_drawn_at_every_even_time(name: str, monkeypatch: pytest.MonkeyPatch):
    picture = picture_of(name)
    drawn: list[tuple[float, float]] = []
    monkeypatch.setattr(Look, "draw", lambda self, painter, centre, *_: drawn.append(tuple(centre)))
    disc = Painter.disc

    def note(self, centre, radius, *rest):
        drawn.append(tuple(centre))
        disc(self, centre, radius, *rest)

    monkeypatch.setattr(Painter, "disc", note)
    picture.poster()
    every = float(re.findall(r"a ball every (\S+) s", written(picture))[0])
    moments = np.arange(0.0, picture.story_end * (1.0 - 1e-9), every)
    assert len(moments) > 4
    for t in moments:
        at = picture.spots(picture.camera, np.array([picture.run.state(picture.ball, t)[:2]]), 0.0)[0]
        assert min(dist(at, place) for place in drawn) < 4.0, f"no ball at {t:g} s"


@pytest.mark.parametrize(
    ("name", "said"),
    [("golf/driver", True), ("soccer/dipping-free-kick", False), ("tennis/clay", False)],  # behind the last ball
)
def test_beads_are_said_where_they_are_seen(name: str, said: bool):
    picture = picture_of(name)
    picture.poster()
    assert ("a bead where balls would overlap" in written(picture)) == said


@pytest.mark.parametrize("name", ["billiards/stop", "soccer/goal-kick-in-a-gale", "golf/putt"])
def test_an_impact_is_marked_unless_the_last_ball_covers_it(name: str, monkeypatch: pytest.MonkeyPatch):
    drawn: list[tuple[float, float]] = []
    monkeypatch.setattr(marks, "draw_mark", lambda sheet, at: drawn.append(at))
    picture = picture_of(name)
    picture.poster()
    under = False
    for camera in (picture.camera, *(near.camera for near in getattr(picture, "closeups", ()))):
        at, radius = picture.last(camera)
        places = [camera.pixel(*mark.at) for mark in picture.impacts(camera)]
        assert [place for place in places if place in drawn] == [p for p in places if dist(p, at) > radius - 1.0]
        under |= any(dist(place, at) < radius + 1.0 for place in places)
    assert under


@pytest.mark.parametrize("name", ["golf", "golf/topped", "soccer", "basketball"])
def test_a_mark_shows_the_whole_speed_of_the_ball(name: str):
    """As the card does: 26.8 m/s at landing, not the 17.7 m/s of it that are across the ground."""
    picture, run = picture_of(name), run_of(name)
    for mark in picture.path.marks():
        vx, vy = run.before(picture.path.name, mark.t)[2:4]
        assert mark.speed == pytest.approx(hypot(vx, vy))
        assert mark.hardness <= mark.speed + 1e-9


def test_a_topped_drive_loses_speed_from_bounce_to_bounce():
    speeds = [mark.speed for mark in picture_of("golf/topped").path.marks()]
    assert speeds == sorted(speeds, reverse=True)


@pytest.mark.parametrize(
    ("name", "other", "words"),
    [
        ("basketball", "basketball/bank-shot", "aligned at the ring"),
        ("golf/7-iron", "golf/driver", "aligned at the pin"),
        ("soccer", "soccer/goal-kick-in-a-gale", "aligned at the goal"),
    ],
)
def test_shots_of_other_distances_are_aligned_at_their_target(name: str, other: str, words: str):
    picture = picture_of(name, other=other)
    ghost = picture.ghosts[0]
    (x, _), _ = picture.datum
    (there, _), _ = picture_of(other).datum
    assert there != x
    assert ghost.points - ghost.view.path.points == pytest.approx(np.full(ghost.points.shape, (x - there, 0.0)))
    picture.poster()
    assert words in written(picture)
    picture.frame(0.1)
    assert words in written(picture)


def test_shots_at_rings_of_other_heights_are_not_aligned():
    low = sandbox.simulate(sandbox.load("basketball", {"hoop.height": 2.6, "backboard.bottom": 2.4}))
    run = run_of("basketball")
    with pytest.raises(sandbox.RequestError, match=r"low: the ring is at 2.6 m, and here at 3.05 m"):
        run.scene.picture(run, (640, 360), {"low": low})


def test_what_is_stretched_is_said_to_the_window_too():
    """A view tells it of the camera that it is asked about."""
    picture = picture_of("golf")
    assert picture.camera.stretch == 2.0
    assert "heights drawn 2 times as large as lengths" in picture.notes(picture.camera)
    assert not any("heights" in note for note in picture.notes(replace(picture.camera, stretch=1.0)))


@pytest.mark.parametrize("name", ["soccer/goal-kick-in-a-gale", "golf/golf-game", "golf/topped", "basketball/rattle"])
def test_a_speed_stands_at_its_mark_or_has_a_line_to_it(name: str, monkeypatch: pytest.MonkeyPatch):
    picture = picture_of(name)
    lines: list[tuple[float, float]] = []
    line = Painter.line

    def note(self, points, *rest):
        lines.extend(tuple(point) for point in points)
        line(self, points, *rest)

    monkeypatch.setattr(Painter, "line", note)
    picture.poster()
    inset = picture.inset(picture.sheet, picture.camera, None)
    marks = [picture.camera.pixel(*mark.at) for mark in picture.impacts(picture.camera)]
    labels = [rect for text, rect in picture.sheet.written if text.endswith(" m/s") and rect.bottom < picture.card_row]
    labels = [rect for rect in labels if inset is None or not inset.colliderect(rect)]
    speeds = [rect for rect in labels if not rect.colliderect((0, 0, 1280, picture.sheet.top_row))]
    assert speeds
    for rect in speeds:
        away = min(dist(mark, _nearest(rect, mark)) for mark in marks)
        led = min((dist(point, _nearest(rect, point)) for point in lines), default=99.0)
        assert away < 30.0 or led < 10.0


def _nearest(rect, point):
    return min(max(point[0], rect.left), rect.right), min(max(point[1], rect.top), rect.bottom)


def test_no_trees_grow_on_the_moon():
    """Trees are the last layer, where there are any."""
    moon, earth = (Landscape(**picture_of(name).colours["landscape"]) for name in ("golf/moon", "golf"))
    assert len(earth.layers((320, 180), 100)) == len(moon.layers((320, 180), 100)) + 1


@pytest.mark.parametrize("name", ["golf", "soccer", "basketball"])
def test_a_place_is_data(name: str):
    """Two pictures of one scene have equal colours, which are drawn once for both."""
    one, other = (picture_of(name) for _ in range(2))
    assert one is not other
    if name == "golf":
        assert Landscape(**one.colours["landscape"]) == Landscape(**other.colours["landscape"])
    else:
        assert one.place.scenery == other.place.scenery
        assert hash(one.place.scenery) == hash(other.place.scenery)
        assert isinstance(one.place.scenery, Stands) == (name == "soccer")
        assert isinstance(one.place.ground.surface, Stripes) == (name == "soccer")


def test_the_net_moves_with_a_swish_in_frames_and_in_the_window():
    picture = picture_of("basketball")
    inside = picture.net.entered + 0.5 * (picture.net.left - picture.net.entered)
    eye, lines = picture.eye(picture.camera), []
    painter = SimpleNamespace(lines=lambda found, *look: lines.append(found))
    for t in (0.0, 0.1, inside):
        picture.net.draw(painter, eye, True, t)
    rest, early, now = lines
    assert np.array_equal(rest, early)
    assert np.abs(rest - now).max() > 2.0  # px
    box = picture.camera.pixel(*picture.ring)
    seen = []
    for t in (inside, picture.run.duration):
        stage = picture.stage()
        picture.draw_balls(Painter(stage), picture.camera, t)
        seen.append([stage.get_at((round(box[0]) + x, round(box[1]) + 25))[:3] for x in range(-30, 30)])
    assert seen[0] != seen[1]


def test_a_lens_shows_the_path_of_a_ball_that_is_aimed():
    picture = picture_of("bowling")
    seen = []
    for ahead in (0.0, picture.run.duration):
        stage = picture.stage()
        picture.draw_balls(Painter(stage), picture.camera, 0.0, ahead)
        seen.append(pygame.surfarray.array3d(stage.subsurface(picture.lens)).astype(int))
    assert (np.abs(seen[0] - seen[1]).max(axis=2) > 40).sum() > 1000


def test_a_frame_notes_that_only_the_smaller_ball_is_enlarged():
    picture = picture_of("collisions/heavy-on-light", (480, 270))
    assert picture.radius * picture.camera.scale > picture.min_radius
    picture.frame(0.0)
    assert "balls drawn larger than they are" in written(picture)


@pytest.mark.parametrize("name", ["hockey/air-hockey", "hockey", "bowling", "bowling/gutter-ball"])
def test_the_ball_that_is_played_is_seen_where_it_was_caught(name: str):
    """Air hockey once had no puck at the end."""
    run = run_of(name)
    picture = run.scene.picture(run, (1280, 720))
    assert picture.caught[picture.ball] <= run.duration
    (at, radius) = picture._ball_places(picture.camera, picture.story_end)[picture.ball]
    assert radius >= 3.5
    assert all(0.04 * side <= place <= 0.96 * side for place, side in zip(at, picture.size, strict=True))


def test_labels_keep_off_what_stands_there():
    """Baseball's was once on the fence, the shot put's on the mark."""
    for name, text in (("baseball", "2.60 m over the fence"), ("throws", "15.4 m/s")):
        picture = picture_of(name)
        picture.poster()
        label = next(rect for said, rect in picture.sheet.written if said == text)
        eye = picture.eye(picture.camera)
        thing = picture.place.things[0]  # fence, flag
        points = eye.points(np.array(thing.corners))
        low, high = points.min(axis=0), points.max(axis=0)
        assert not label.colliderect((low[0], low[1], high[0] - low[0] + 1, high[1] - low[1] + 1)), name


@pytest.mark.parametrize("name", ["volleyball", "volleyball/spike", "volleyball/jump-serve", "tennis", "tennis/clay"])
def test_a_ball_crosses_nobody(name: str):
    picture = picture_of(name)
    eye = picture.eye(picture.camera)
    path = picture.camera.pixels(picture.path.points)
    people = [thing for thing in picture.place.things if isinstance(thing, Person) and thing.facing < 0]
    assert people
    for person in people:
        points = eye.points(np.array(person.corners))
        (left, top), (right, bottom) = points.min(axis=0), points.max(axis=0)
        inside = (path > (left, top)) & (path < (right, bottom))
        assert not inside.all(axis=1).any()
