"""Text and where it goes."""

import pygame
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sandbox.picture.lettering import Labels, Lettering
from sandbox.picture.painter import blank
from sandbox.picture.sheet import Sheet, round_number_above
from sandbox.sport.amounts import converted, metres, signed
from tests.picture.legible import assert_legible

HEIGHTS = (360, 720, 1080)


@pytest.mark.parametrize("bold", [False, True])
def test_all_figures_are_equally_wide(bold):
    widths = {Lettering(360).width(100 * figure, "small", bold) for figure in "0123456789"}
    assert len(widths) == 1


@pytest.mark.parametrize("height", HEIGHTS)
def test_sizes_that_can_be_read(height):
    pixels = Lettering(height).pixels
    assert set(pixels) == {"small", "medium", "large", "huge"}
    assert 11 <= pixels["small"] < pixels["medium"] < pixels["large"] < pixels["huge"]


@pytest.mark.parametrize("height", HEIGHTS)
@pytest.mark.parametrize("anchor", ["topleft", "midbottom", "center", "topright"])
def test_ink_stays_in_the_rectangle_that_is_returned(height, anchor):
    surface = blank((600, 200))
    lettering = Lettering(height)
    rect = lettering.write(surface, "Éqj 253.6 m", "medium", (300, 100), (255, 255, 255), anchor, bold=True)
    ink = pygame.mask.from_threshold(surface, (255, 255, 255), (200, 200, 200)).get_bounding_rects()
    assert rect.inflate(2, 2).contains(ink[0].unionall(ink[1:]))
    assert getattr(rect, anchor) == (300, 100)


@given(st.text("ab /.", min_size=1, max_size=120), st.integers(20, 200))
def test_wrapped_text_keeps_its_letters_and_to_its_room(text, room):
    lettering = Lettering(720)
    lines = lettering.wrapped(text, "small", room)
    assert "".join(lines).replace(" ", "") == text.replace(" ", "")
    assert all(lettering.width(line, "small") <= room for line in lines)


def test_a_text_is_cut_where_its_room_ends():
    lettering = Lettering(720)
    assert lettering.cut("a long way", "small", 200) == "a long way"
    short = lettering.cut("a long way", "small", 60)
    assert short.endswith(" ...")
    assert lettering.width(short, "small") <= 60


rects = st.builds(pygame.Rect, st.integers(-50, 350), st.integers(-50, 250), st.integers(1, 120), st.integers(1, 40))


@given(st.lists(st.lists(rects, min_size=1, max_size=4), max_size=12))
def test_labels_never_overlap_or_leave_the_frame(wishes):
    labels = Labels(pygame.Rect(10, 10, 300, 200), gap=4)
    labels.take_path([(x, 0.5 * x) for x in range(0, 300, 5)], radius=3)
    placed = [rect for rect in map(labels.place, wishes) if rect]
    for i, rect in enumerate(placed):
        assert labels.frame.contains(rect)
        assert rect.inflate(8, 8).collidelist(placed[:i]) < 0
        assert not any(rect.collidepoint(x, 0.5 * x) for x in range(0, 300, 5))


@pytest.mark.parametrize("size", [(640, 360), (1280, 720), (1920, 1080)])
def test_numbers_in_a_card_keep_apart_and_inside(size):
    sheet = Sheet(size)
    entries = [("carry", "1450.1 m"), ("total", "1483.3 m"), ("apex", "253.9 m"), ("flight time", "135.41 s")]
    entries += [("ball speed", "340.0 m/s"), ("launch", "−35.0°"), ("backspin", "−20000 rpm"), ("landing", "−35°")]
    sheet.columns(sheet.card_row(), entries)
    assert_legible(sheet)
    assert len(sheet.written) == 2 * len(entries)


def test_a_card_that_is_too_narrow_leaves_out_the_last():
    sheet = Sheet((200, 300))
    sheet.columns(sheet.card_row(), [("carry", "253.6 m"), ("total", "277.0 m"), ("apex", "33.9 m")])
    assert_legible(sheet)
    assert [text for text, _ in sheet.written] == ["carry", "253.6 m", "total", "277.0 m"]


@pytest.mark.parametrize("size", [(640, 360), (1280, 720)])
@pytest.mark.parametrize(("start", "end"), [(100, 500), (300, 310), (35, 40), (560, 605), (500, 100)])
def test_a_dimension_stays_in_the_frame(size, start, end):
    sheet = Sheet(size)
    sheet.dimension("carry 253.6 m   277 yd", 100, start, end, (255, 255, 255))
    assert_legible(sheet)


@pytest.mark.parametrize(("start", "end"), [(20, 180), (60, 130), (20, 40), (100, 100)])
def test_a_dimension_leaves_its_text_free(start, end):
    sheet = Sheet((200, 300))
    sheet.dimension(" " * 40, 100, start, end, (255, 255, 255))
    ((_, rect),) = sheet.written
    assert pygame.surfarray.array3d(sheet.surface.subsurface(rect)).max() == 0


@pytest.mark.parametrize(
    ("value", "text"),
    [(0.42, "0.42 m"), (-8.314, "−8.31 m"), (251.36, "251.4 m"), (-0.001, "0.00 m"), (12_345.0, "12.3 km")],
)
def test_lengths_as_people_write_them(value, text):
    assert metres(value) == text


def test_yards_and_signs():
    assert converted(9.144, "m", "yd") == "10.0 yd"
    assert converted(-228.6, "m", "yd") == "−250 yd"
    assert signed("-0") == "0"


@given(st.floats(1e-6, 1e6))
def test_round_numbers(least):
    step = round_number_above(least)
    assert least * 0.99 < step <= least * 2.51
    assert f"{step:e}"[0] in "125"


@pytest.mark.parametrize("room", [110, 150, 215, 300, 2000])
@pytest.mark.parametrize(
    "text", ["205 m carry, stops 69 m short of the pin", "The 1 into the right foot corner pocket"]
)
def test_a_headline_is_said_whole_in_the_room_it_has(room, text):
    """What is too long for one line goes on in the next, after a comma where there is one."""
    sheet = Sheet((320, 180))
    sheet.headline(text, ["a ball every 1 s"], room)
    (first, rect), (second, below) = sheet.written
    assert max(rect.width, below.width) <= room
    assert rect.bottom <= below.top
    rest = text[len(first) :].lstrip(", ")
    assert text.startswith(first)
    assert "," not in first or not rest
    if room >= 150:
        assert second.startswith(rest or "a ball every 1 s")
