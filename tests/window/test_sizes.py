"""Windows of any size and shape: nothing of the bar overlaps, and what is written has room."""

from __future__ import annotations

from concurrent.futures import Future
from itertools import combinations
from types import SimpleNamespace

import pygame
import pytest

from sandbox.picture.lettering import Lettering
from sandbox.picture.sheet import rows_of
from sandbox.scene import listings
from sandbox.window import commands
from sandbox.window.app import opened
from sandbox.window.bar import HEIGHT, ICONS, LEAST, WORDS, Bar
from sandbox.window.canvas import Canvas
from sandbox.window.commands import TABLE
from sandbox.window.shots import Playback

#: From half as wide as high to three times as wide.
SIZES = [
    (width, round(width / shape))
    for width in (480, 500, 640, 800, 960, 1280, 1366, 1920, 2560, 3840)
    for shape in (0.5, 0.75, 0.89, 1.0, 1.25, 4 / 3, 16 / 10, 16 / 9, 21 / 9, 3.0)
    if width / shape >= 400
]
TITLES = ("golf", "billiards/three-rail-carom *", "soccer-curl/roberto-carlos-1997 *")
PUTT = "golf/putt"


@pytest.mark.parametrize(
    ("desktop", "window"),
    [
        ((800, 480), (784, 400)),
        ((1024, 600), (1008, 520)),
        ((1366, 768), (1280, 688)),
        ((1920, 1080), (1280, 720)),
        ((3840, 2160), (2560, 1440)),
        ((1080, 1920), (1064, 1280)),
    ],
)
def test_a_new_window_fits_its_desktop(desktop, window, monkeypatch):
    monkeypatch.setattr(pygame.display, "get_desktop_sizes", lambda: [(5000, 3000), desktop])
    with opened("golf") as screen:
        assert screen.get_size() == window


def bar_of(size: tuple[int, int], title: str, duration: float, t: float | None = None) -> Bar:
    """The bar of such a window, drawn."""
    tall = round(HEIGHT * rows_of(size) / 720)
    bar = Bar(pygame.Rect(0, size[1] - tall, size[0], tall), rows_of(size))
    events = [SimpleNamespace(kind="impact", t=0.5), SimpleNamespace(kind="impact", t=1.0)]
    shot = SimpleNamespace(run=SimpleNamespace(duration=duration, events=events))
    playback = Playback(shot, 1 / 16)
    playback.t = t
    bar.draw(Canvas(pygame.Surface(size)), title, shot, playback if t else None, (), (-1, -1))
    return bar


class TestTheBar:
    @pytest.mark.parametrize("title", TITLES)
    def test_nothing_overlaps_and_the_time_line_is_long_enough(self, title):
        assert len(SIZES) > 70
        for size in SIZES:
            bar = bar_of(size, title, 15.86)
            for (name, rect), (other, beside) in combinations(bar.places.items(), 2):
                assert not rect.colliderect(beside), (size, name, other)
            assert all(bar.rect.contains(rect) for rect in bar.places.values()), size
            assert bar.line.width >= LEAST * bar.unit - 1, size
            assert {"menu", "restart", "go", "see", "keep", "more"} <= set(bar.buttons), size

    def test_where_there_is_room_it_has_everything(self):
        bar = bar_of((1280, 720), TITLES[1], 15.86)
        assert set(bar.buttons) == {*ICONS, *WORDS, "menu", "go"} - {"play", "pause"}
        assert bar.title == TITLES[1]

    def test_what_is_written_has_room(self):
        for size in ((480, 400), (640, 400), (960, 1080), (1280, 720)):
            for duration in (0.4, 15.86, 120.0):
                bar = bar_of(size, TITLES[1], duration)
                assert bar.lettering.width(bar.title, "small", bold=True) < bar.places["menu"].width
                assert bar.lettering.width(f"{duration:.2f} s", "small") <= bar.places["time"].width
                if "rate" in bar.places:
                    assert bar.lettering.width("×1/16", "small") <= bar.places["rate"].width

    def test_it_stays_as_it_is_while_a_shot_is_watched(self):
        for size in ((500, 800), (1280, 720)):
            assert bar_of(size, "golf", 15.86).places == bar_of(size, "golf", 15.86, 3.0).places


@pytest.mark.parametrize("pull", [False, True])
def test_long_numbers_end_where_their_room_does(player, written, pull):
    player = player("soccer-curl", (480, 400))
    player.settle()
    written.clear()
    player.key(pygame.K_TAB)
    if pull:
        player.pull((-60, 40), let_go=False)
    player.settle()
    shot = player.game.shot
    said = [text for _, text in shot.card] + [shot.aimed]
    numbers = [
        (text, rect)
        for text, rect in written
        if any(each.startswith(text.removesuffix(" ...")) for each in said)
        and not player.view.panel.rect.contains(rect)
    ]
    assert len(numbers) >= 1 + pull
    for _, rect in numbers:
        assert player.view.screen.area.contains(rect)


@pytest.mark.parametrize("size", [(480, 400), (480, 920), (1200, 400)])  # small, narrow, low
@pytest.mark.parametrize("name", ["menu", "help"])
def test_every_scene_and_every_key_can_be_seen(player, size, written, name):
    player = player(PUTT, size)
    commands.do(player.view, name)
    player.frames(1)
    over, area, said = player.view.shown.overlay, pygame.Rect(0, 0, size[0], player.view.screen.area.height), set()
    if name == "menu":
        every, over.picture_of = {listing.name for listing in listings()}, lambda source: Future()
    else:
        every = {command.name for command in TABLE if command.meaning}
    for group in over.groups:
        over.turn_to(group)
        for _ in range(0, len(over.rows), over.seen):
            written.clear()
            over.draw(player.sheet, (0, 0), ())
            said |= {what.action for _, what in over.places if not isinstance(what, str)}
            assert all(area.contains(place) for place, _ in over.places)
            assert not any(a.colliderect(b) for (a, _), (b, _) in combinations(over.places, 2))
            assert not any(a.colliderect(b) for (_, a), (_, b) in combinations(written, 2))
            if name == "help":
                assert not any(text.endswith("...") for text, _ in written if not text.endswith("pin ..."))
            over.scroll(over.seen)
    assert said >= every


@pytest.mark.parametrize("size", [(480, 400), (960, 1080), (1280, 720)])
def test_nothing_of_the_panel_overlaps_and_texts_have_room(player, size, written):
    player = player("golf", size)
    player.key(pygame.K_TAB)
    panel = player.view.panel
    for group in panel.groups:
        panel.turn_to(group)
        written.clear()
        panel.draw(Canvas(player.view.screen.canvas), (-1, -1))
        places = [rect for rect, _ in panel.places]
        assert all(panel.rect.contains(rect) for rect in places)
        for rects in (places, [rect for _, rect in written]):
            assert not any(a.colliderect(b) for a, b in combinations(rects, 2))
        assert all(panel.rect.contains(rect) for _, rect in written)


@pytest.mark.parametrize("size", [(640, 400), (1280, 720)])
def test_cards_leave_room_for_each_other_and_the_numbers(player, size):
    player = player("basketball", size)
    for key in (pygame.K_f, pygame.K_m, pygame.K_w):
        player.key(key)
    player.frames(2, dt=0.2)
    player.settle()
    cards, sheet = player.view.targets.cards, player.sheet
    assert set(cards) == {"map", "charts"}
    assert not cards["map"].colliderect(cards["charts"])
    assert all(
        card.bottom < sheet.card_row() and not card.colliderect(player.view.cards.head) for card in cards.values()
    )


def test_a_list_that_does_not_fit_is_scrolled_by_key_and_wheel(player, monkeypatch):
    monkeypatch.setattr(Lettering, "larger", 1.5)
    player = player(PUTT, (480, 400))
    commands.do(player.view, "see")
    player.frames(1)
    over, area = player.view.shown.overlay, pygame.Rect(0, 0, 480, player.view.screen.area.height)
    assert over.seen < len(over.rows)
    for row in over.rows:
        player.key(pygame.K_DOWN)
        assert over.chosen == row
        assert row in [what for _, what in over.places]
        assert all(area.contains(place) for place, _ in over.places)
    player.key(pygame.K_DOWN)
    assert over.first == 0, "after the last comes the first"
    player.send(pygame.MOUSEWHEEL, x=0, y=-1, flipped=False)
    assert over.places[0][1] == over.rows[1]
