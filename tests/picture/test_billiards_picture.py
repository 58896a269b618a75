"""Billiards pictures of very different shots: composed, legible, the balls in sight and turning as they roll."""

from math import dist, hypot, pi

import numpy as np
import pytest

from sandbox.picture.painter import Painter
from sandbox.picture.sheet import Sheet
from scenes.billiards import balls
from tests.picture.legible import assert_legible
from tests.scenes.play import run_of

SIZES = [(640, 360), (960, 672)]
ONE_BALL = {"rack": "none", "balls": [{"name": "cue", "x": -0.5, "y": 0.0}]}
SHOTS = {
    "break": ("billiards", {}),
    "bank": ("billiards/bank", {}),
    "draw": ("billiards/draw", {}),
    "snooker": ("billiards/snooker-break", {}),
    "carom": ("billiards/three-rail-carom", {}),
    "one ball": ("billiards", {**ONE_BALL, "cue.english": 0.4}),
    "not struck": ("billiards", {**ONE_BALL, "cue.speed": 0.0}),
    "straight in": ("billiards", {**ONE_BALL, "balls": [{"name": "cue"}], "cue.angle": 90.0, "cue.speed": 2.0}),
    "small and square": (
        "billiards",
        {**ONE_BALL, "balls": [{"name": "cue"}], "table.length": 1.0, "table.width": 1.0, "cue.angle": 20.0},
    ),
    "odd names": (
        "billiards",
        {
            "rack": "none",
            "balls": [{"name": name, "x": 0.2 * i, "y": 0.0} for i, name in enumerate(("cue", "zoë", "99"))],
        },
    ),
}


def picture_of(name: str, size=(640, 360)):
    run = run_of(*SHOTS[name])
    return run.scene.picture(run, size)


@pytest.mark.parametrize("size", SIZES, ids=str)
@pytest.mark.parametrize("name", SHOTS)
def test_the_table_is_whole_legible_and_its_balls_large_enough(name, size):
    picture = picture_of(name, size)
    assert picture.poster().get_size() == size
    assert_legible(picture.sheet)
    drawn = max(picture.radius * picture.camera.scale, picture.min_radius)
    assert 2 * drawn >= 7  # px
    said = any("balls drawn" in text for text, _ in picture.sheet.written)
    assert said == (drawn > 1.001 * picture.radius * picture.camera.scale)

    table = picture.parameters.table
    (left, top), (right, bottom) = (
        picture.camera.pixel(side * 0.5 * table.length, -side * 0.5 * table.width) for side in (-1, 1)
    )
    assert 0.04 * size[0] < left < right < 0.96 * size[0]
    assert picture.sheet.top_row < top < bottom < picture.card_row

    for share in (0.0, 0.1, 1.0):
        assert picture.frame(share * picture.run.duration).get_size() == size
        assert_legible(picture.sheet)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("bank", "The 1 into the left side pocket"),
        ("carom", "Point, after 3 cushions"),
        ("snooker", "nothing potted"),
        ("one ball", "Hits no ball"),
        ("straight in", "Scratch in the"),
    ],
)
def test_the_verdict_says_what_happened(name, words):
    run = picture_of(name).run
    assert words in run.scene.verdict(run)


def test_a_caught_ball_leaves_the_table_and_lies_in_the_row():
    picture = picture_of("bank")
    at = picture.run.caught_at("1")
    assert "1" in picture.present(at - 0.01)
    assert "1" not in picture.present(at)
    picture.frame(at - 0.01)
    assert "potted" not in [text for text, _ in picture.sheet.written]
    picture.frame(at)
    assert "potted" in [text for text, _ in picture.sheet.written]


def test_a_ball_turns_by_its_way_over_its_radius():
    """Rolling without english, its own axes turn about the axis across its way, by way / radius."""
    picture = picture_of("bank")
    run = picture.run
    t0, t1 = 4.0, 4.03  # s, rolling by now
    (x0, y0, *_, spin), (x1, y1, *_) = run.state("cue", t0), run.state("cue", t1)
    assert abs(spin) < 1e-9
    turn = picture.turn("cue", t1) @ picture.turn("cue", t0).T
    angle = np.arccos((np.trace(turn) - 1) / 2)
    way = hypot(x1 - x0, y1 - y0) / picture.radius
    assert 0.1 < way < pi
    assert angle == pytest.approx(way, rel=1e-6)
    axis = np.array([turn[2, 1] - turn[1, 2], turn[0, 2] - turn[2, 0]])
    assert axis / np.hypot(*axis) == pytest.approx(np.array([y0 - y1, x1 - x0]) / (way * picture.radius), abs=1e-6)


def test_the_marks_move_with_the_ball():
    """A ball's top goes the way the ball goes."""
    picture = picture_of("bank")
    run = picture.run
    t = run.duration - 1.0
    x, y, vx, vy, _ = run.state("cue", t)
    before, after = (picture.turn("cue", at) for at in (t, t + 0.001))
    top = before.T @ (0, 0, 1)  # in the ball's own axes
    assert (after @ top)[:2] == pytest.approx(np.array([vx, vy]) * 0.001 / picture.radius, rel=1e-2)


def test_where_a_ball_has_been_stays_in_sight():
    """And where it will be does not show yet."""
    picture = picture_of("bank")
    picture.still = True
    empty = picture.stage()
    x, y = map(int, picture.camera.pixel(*picture.run.state("cue", 2.0)[:2]))
    here = [(x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    for t, seen in ((1.0, False), (picture.run.duration, True)):
        frame = picture.frame(t)
        assert any(frame.get_at(at) != empty.get_at(at) for at in here) == seen


def test_a_path_has_its_balls_colour_and_contrasts_with_cloth():
    """Of the pool balls, only a solid and its striped twin share one; and the struck ball's is its own too."""
    cloth = balls.COLOURS["cloth"]
    colours = {name: balls.on_cloth(balls.colour_of(name)) for name in ("cue", *map(str, range(1, 16)))}
    assert len(set(colours.values())) == 1 + 8
    for name, colour in colours.items():
        assert dist(colour, cloth) > balls.LEAST_CONTRAST
        own = balls.colour_of(name)
        assert max(range(3), key=own.__getitem__) == max(range(3), key=colour.__getitem__)
    assert picture_of("carom").colour_of("yellow") == balls.colour_of("yellow")


@pytest.mark.parametrize("size", [(1280, 720), (640, 360)], ids=str)
def test_head_and_foot_are_named_beside_the_table(size):
    picture = picture_of("break", size)
    picture.poster()
    places = {text: rect for text, rect in picture.sheet.written if text in ("head", "foot")}
    assert places["head"].right < picture.camera.pixel(-1.27, 0.0)[0]
    assert places["foot"].left > picture.camera.pixel(1.27, 0.0)[0]


def test_dots_stand_closer_as_the_ball_slows(monkeypatch):
    """None is left out, so that a rolling ball does not seem to keep its speed."""
    picture = picture_of("one ball", (1280, 720))
    dots: list[tuple[float, float]] = []

    def note(self, at, radius, colour, *_, **__):
        if colour == balls.COLOURS["rim"]:
            dots.append(at)

    monkeypatch.setattr(Painter, "disc", note)
    (said,) = picture.strobe(Sheet(picture.size), picture.camera)
    every = float(said.split()[-2])
    assert len(dots) >= 8
    expected = [picture.camera.pixel(*picture.run.state("cue", (i + 1) * every)[:2]) for i in range(len(dots))]
    assert np.array(dots) == pytest.approx(np.array(expected))
    assert picture.run.duration - len(dots) * every < every


def test_frames_can_be_drawn_in_any_order():
    picture = picture_of("break")
    first = picture.frame(0.4).get_buffer().raw
    picture.frame(2.0)
    picture.poster()
    assert picture.frame(0.4).get_buffer().raw == first


def test_what_a_window_asks_for():
    picture = picture_of("bank", (960, 672))
    stage = picture.stage()
    assert stage.get_size() == (960, 672)
    before = stage.get_buffer().raw
    picture.draw_balls(Painter(stage), picture.camera, 1.0)
    assert stage.get_buffer().raw != before
    assert picture.stage().get_buffer().raw == before  # the window's own copy
    assert picture.view(0.0) == picture.camera


def test_a_ball_that_was_potted_has_no_speed_any_more():
    picture = picture_of("straight in")
    run = picture.run
    said = [{label: value for label, value, *_ in picture.live(t)} for t in (0.1, run.duration)]
    assert run.result["scratch"]
    assert "m/s" in said[0]["speed"]
    assert {said[1][label] for label in ("speed", "direction", "side spin")} == {"–"}


def test_any_ball_says_how_it_moves():
    picture = picture_of("carom")
    event = next(e for e in picture.run.events if e.kind == "impact" and {e.ball, e.partner} <= {*picture.balls})
    (hit,), t = {event.ball, event.partner} - {picture.ball}, event.t
    still, rolling = (dict(picture.moving(hit, moment)) for moment in (0.0, t + 0.01))
    assert still == {"speed": "0.00 m/s", "direction": "–", "side spin": "none"}
    assert rolling["speed"] != still["speed"]
    assert rolling["direction"].endswith("°")
