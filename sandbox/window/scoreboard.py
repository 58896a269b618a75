"""What a contest says over the picture: its goal, scores and what came of the last shot; a success that glows; and at
the end the stars, the best scores and what can be done next."""

from __future__ import annotations

from collections.abc import Sequence
from math import cos, pi, sin

import pygame

from sandbox.picture.palette import Colour, mix, palette
from sandbox.window.best import BestList
from sandbox.window.canvas import Canvas
from sandbox.window.contest import AtTask, Contest
from sandbox.window.referee import GLOW, Referee

CARD = palette("card")

#: Radius of a star on the card at the end, and of a small one in a list; px on 720 rows.
STAR, SMALL_STAR = 30.0, 8.0
#: Radius of a glow at its end, in px on 720 rows, and how many rays it has.
RADIUS, RAYS = 110.0, 12

#: What can be done at the end, with its key.
CHOICES = (("Enter", "play again"), ("1", "other tasks and games"), ("N, P", "see the shots"))


def headline_of(referee: Referee, contest: Contest) -> tuple[str, list[str], Colour]:
    """The headline while a contest is aimed, or once its shot was counted; a line of notes; and the colour."""
    if referee.watching.playback is None:
        how = "set the sliders and press Space" if contest.aimed_by_panel else "pull back anywhere and let go"
        notes = [contest.stand] if contest.takes_marks else [contest.stand, how]
        return contest.headline, notes, CARD["text"]
    if contest.over:
        return referee.said, ["the best shots, the best last"] if referee.again == "best" else [], CARD["text"]
    return referee.said, ["Enter or click: the next shot", "R: see it again"], CARD["good" if contest.good else "text"]


def star(sheet: Canvas, centre: tuple[float, float], radius: float, lit: bool) -> None:
    """A star with five points, gold or as a dark shape."""
    x, y = centre
    points = [
        (x + (radius if i % 2 == 0 else 0.42 * radius) * sin(i * pi / 5),
         y - (radius if i % 2 == 0 else 0.42 * radius) * cos(i * pi / 5))
        for i in range(10)
    ]  # fmt: skip
    sheet.painter.polygon(points, CARD["accent"] if lit else mix(CARD["background"], CARD["quiet"], 0.3))


def stars(sheet: Canvas, at: tuple[float, float], radius: float, lit: int) -> None:
    """Three stars in a row, of which so many are lit; ``at`` is the middle of the first."""
    for place in range(3):
        star(sheet, (at[0] + 2.4 * radius * place, at[1]), radius, place < lit)


def draw_glow(sheet: Canvas, at: tuple[float, float], left: float) -> None:
    """The light of a success around a place in px, ``left`` s before it is gone."""
    share = 1.0 - left / GLOW
    far = RADIUS * sheet.unit * (0.25 + 0.75 * share**0.5)
    fade = max(0.0, 1.0 - share)
    sheet.painter.disc(at, 0.8 * far, CARD["accent"], 0.22 * fade)
    sheet.painter.ring(at, far, 5 * sheet.unit, CARD["accent"], 0.9 * fade)
    for ray in range(RAYS):
        turn = 2.0 * pi * (ray + 0.5) / RAYS
        ends = [(at[0] + length * far * cos(turn), at[1] - length * far * sin(turn)) for length in (0.55, 0.85)]
        sheet.painter.line(ends, 4 * sheet.unit, CARD["accent"], 0.9 * fade)


def draw_mark(sheet: Canvas, spots: Sequence[tuple[float, float]], upright: bool) -> None:
    """The player's mark, a flag from the side and a cross from above, and a line from it to where the ball landed; the
    places in px."""
    unit, (x, y) = sheet.unit, spots[0]
    for other in spots[1:]:
        sheet.painter.line([(x, y), other], 3 * unit, CARD["accent"], 0.9)
        sheet.painter.ring(other, 9 * unit, 3 * unit, CARD["accent"])
    for colour, wider in ((CARD["background"], 3.0), (CARD["accent"], 0.0)):
        if upright:
            sheet.painter.line([(x, y), (x, y - 44 * unit)], (3 + wider) * unit, colour)
            flag = [(x, y - 44 * unit), (x + 22 * unit, y - 36 * unit), (x, y - 28 * unit)]
            sheet.painter.polygon(flag, CARD["accent"])
            continue
        for across in (-1, 1):
            ends = [(x - 9 * unit, y - across * 9 * unit), (x + 9 * unit, y + across * 9 * unit)]
            sheet.painter.line(ends, (4 + wider) * unit, colour)


def draw_end(sheet: Canvas, contest: Contest, best: BestList, place: int) -> pygame.Rect:
    """The card at the end of a contest, in the upper half; ``place`` is that in the best list, 0 for none. Returns
    where it is."""
    letters, gap, unit = sheet.lettering, sheet.gap, sheet.unit
    lines = [(line, "medium" if i == 0 else "small", "text" if i == 0 else "quiet")
             for i, line in enumerate(contest.outcome)]  # fmt: skip
    lines += [(line, "small", "quiet") for line in _best_lines(contest, best, place)]
    choices = "     ".join(f"{key}: {what}" for key, what in CHOICES)
    lines.append((choices, "small", "accent"))
    head = round(2.6 * STAR * unit) if contest.stars is not None else 0
    wide = max(letters.width(text, size, bold=size == "medium") for text, size, _ in lines) + 8 * gap
    tall = head + sum(letters.height(size) + gap for _, size, _ in lines) + 4 * gap
    rect = pygame.Rect(0, 0, min(max(wide, round(12 * STAR * unit)), sheet.frame.width), tall)
    rect.midtop = sheet.size[0] // 2, sheet.top_row + 2 * gap
    sheet.painter.panel(rect, CARD["background"], 0.94, 12 * unit)
    if contest.stars is not None:
        middle = rect.top + 2 * gap + 1.2 * STAR * unit
        stars(sheet, (rect.centerx - 2.4 * STAR * unit, middle), STAR * unit, contest.stars)
    y = rect.top + 2 * gap + head
    for text, size, colour in lines:
        text = letters.cut(text, size, rect.width - 4 * gap, size == "medium")
        sheet.write(text, size, (rect.centerx, y), CARD[colour], "midtop", bold=size == "medium")
        y += letters.height(size) + gap
    return rect


def _best_lines(contest: Contest, best: BestList, place: int) -> list[str]:
    """The best scores at a task, with the place of this one."""
    if not isinstance(contest, AtTask) or contest.players > 1:
        return []
    scores = ", ".join(contest.written(each.score) for each in best.of(contest.name))
    mine = "" if place == 0 or len(best.of(contest.name)) == 1 else f", of which this is number {place}"
    return [f"your best: {scores}{mine}"] if scores else []
