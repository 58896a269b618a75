"""The texts of a contest over the picture: its goal, scores and the last shot's result; a success that glows; and at
the end the stars, the best scores and what can be done next."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, modf, pi, sin

import pygame

from sandbox.picture.palette import Colour, mix, palette
from sandbox.text import title_of
from sandbox.window.best import Best, BestList
from sandbox.window.canvas import Canvas
from sandbox.window.contest import AtTask, Contest
from sandbox.window.layout import Form
from sandbox.window.referee import GLOW, Referee

_CARD = palette("card")

#: Places of buttons in px, by command.
_Buttons = dict[str, pygame.Rect]
#: Radius of a star on the card at the end, and of a small one in a list; px on 720 rows.
_STAR, SMALL_STAR = 30.0, 8.0
#: Radius of a glow at its end, in px on 720 rows, and how many rays it has.
_RADIUS, _RAYS = 110.0, 12
#: The number of pieces of confetti, their colours, and how they fall, in px/s^2 on 720 rows.
_FLAKES, _PAPER, _FALLS = 42, (_CARD["accent"], _CARD["good"], _CARD["text"], *palette("trace")["colours"][:4]), 520.0

#: What can be done at the end, by the command that does it: its key and what it is called.
CHOICES = {
    "again": ("Enter", "play again"),
    "next_preset": ("PgDn", "next: "),
    "page": ("F8", "share"),
    "save_replay": ("F5", "share"),
    "front": ("1", "all tasks and games"),
}


def headline_of(referee: Referee, contest: Contest) -> tuple[str, list[str], Colour]:
    """The headline while a contest is aimed, or once its shot was counted; a line of notes; and the colour."""
    if referee.watching.playback is None:
        where = "elsewhere" if contest.in_hand else "anywhere"
        how = "set the sliders and press Space" if contest.aimed_by_panel else f"pull back {where} and let go"
        if referee.computers_turn:
            return contest.headline, ["it looks for a shot ..."], _CARD["text"]
        notes = [contest.stand] if contest.takes_marks else [contest.stand, how]
        return contest.headline, notes, _CARD["text"]
    if contest.over:
        return referee.outcome, ["the best shots, the best last"] if referee.again == "best" else [], _CARD["text"]
    notes = [contest.counts] if contest.counts else []
    notes += ["Enter or click: the next shot", "R: see it again"]
    return referee.outcome, notes, _CARD["good" if contest.good else "text"]


def star(sheet: Canvas, centre: tuple[float, float], radius: float, lit: bool) -> None:
    """A star with five points, gold or as a dark shape."""
    x, y = centre
    points = [
        (x + (radius if i % 2 == 0 else 0.42 * radius) * sin(i * pi / 5),
         y - (radius if i % 2 == 0 else 0.42 * radius) * cos(i * pi / 5))
        for i in range(10)
    ]  # fmt: skip
    sheet.painter.polygon(points, _CARD["accent"] if lit else mix(_CARD["background"], _CARD["quiet"], 0.5))


def stars(sheet: Canvas, at: tuple[float, float], radius: float, lit: int) -> None:
    """Three stars in a row, of which so many are lit; ``at`` is the middle of the first."""
    for place in range(3):
        star(sheet, (at[0] + 2.4 * radius * place, at[1]), radius, place < lit)


def draw_glow(sheet: Canvas, at: tuple[float, float], left: float) -> None:
    """The light of a success around a place in px, ``left`` s before it is gone."""
    share = 1.0 - left / GLOW
    far = _RADIUS * sheet.unit * (0.25 + 0.75 * share**0.5)
    fade = max(0.0, 1.0 - share)
    sheet.painter.disc(at, 0.8 * far, _CARD["accent"], 0.22 * fade)
    sheet.painter.ring(at, far, 5 * sheet.unit, _CARD["accent"], 0.9 * fade)
    for ray in range(_RAYS):
        turn = 2.0 * pi * (ray + 0.5) / _RAYS
        ends = [(at[0] + length * far * cos(turn), at[1] - length * far * sin(turn)) for length in (0.55, 0.85)]
        sheet.painter.line(ends, 4 * sheet.unit, _CARD["accent"], 0.9 * fade)


def draw_confetti(sheet: Canvas, at: tuple[float, float], left: float) -> None:
    """Paper that flies up from a success at a place in px and falls, ``left`` s before it is gone."""
    t, unit, fade = GLOW - left, sheet.unit, min(1.0, 3.0 * left / GLOW)
    for flake in range(_FLAKES):
        turn, fast, spin = (modf(flake * golden)[0] for golden in (0.618034, 0.754878, 0.569840))
        way, speed = pi * (0.2 + 0.6 * turn), (160.0 + 260.0 * fast) * unit
        x = at[0] + speed * cos(way) * t
        y = at[1] - speed * sin(way) * t + 0.5 * _FALLS * unit * t * t
        angle, wide = 2.0 * pi * (spin + (1.0 + spin) * t), 5.0 * unit
        tall = 2.5 * unit * abs(cos(3.0 * angle)) + 1.0  # it tumbles
        along, across = (wide * cos(angle), wide * sin(angle)), (-tall * sin(angle), tall * cos(angle))
        corners = [(x + a * along[0] + b * across[0], y + a * along[1] + b * across[1])
                   for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))]  # fmt: skip
        sheet.painter.polygon(corners, _PAPER[flake % len(_PAPER)], fade)


def draw_mark(sheet: Canvas, spots: Sequence[tuple[float, float]], upright: bool) -> None:
    """The player's mark, a flag from the side and a cross from above, and a line from it to where the ball landed; the
    places in px."""
    unit, (x, y) = sheet.unit, spots[0]
    for other in spots[1:]:
        sheet.painter.line([(x, y), other], 3 * unit, _CARD["accent"], 0.9)
        sheet.painter.ring(other, 9 * unit, 3 * unit, _CARD["accent"])
    for colour, wider in ((_CARD["background"], 3.0), (_CARD["accent"], 0.0)):
        if upright:
            sheet.painter.line([(x, y), (x, y - 44 * unit)], (3 + wider) * unit, colour)
            flag = [(x, y - 44 * unit), (x + 22 * unit, y - 36 * unit), (x, y - 28 * unit)]
            sheet.painter.polygon(flag, _CARD["accent"])
            continue
        for across in (-1, 1):
            ends = [(x - 9 * unit, y - across * 9 * unit), (x + 9 * unit, y + across * 9 * unit)]
            sheet.painter.line(ends, (4 + wider) * unit, colour)


def end_forms(
    sheet: Canvas, contest: Contest, best: BestList, place: int, mouse: tuple[int, int], found: _Buttons
) -> list[Form]:
    """The card at the end of a contest: its choices side by side, or one below the other, and as much of the best list
    as there is room for. ``place`` is that in the best list, 0 for none; the places of its buttons, by command, go into
    ``found`` once it is drawn."""
    offered = {name: f"{key}  {what}{title_of(contest.following) if name == 'next_preset' else ''}"
               for name, (key, what) in CHOICES.items()}  # fmt: skip
    without = {"next_preset"} if not contest.following else set()
    without |= {"save_replay"} if isinstance(contest, AtTask) else {"page"}
    choices = {name: text for name, text in offered.items() if name not in without}
    rows = best.of(contest.name) if contest.kept is not None else []
    shown = [rows, rows[:1], []] if rows else [[]]
    return [
        _EndCard(sheet, contest, some, place, choices, mouse, found, across).form
        for some in shown for across in (True, False)
    ]  # fmt: skip


class _EndCard:
    """The card at the end: stars, result, best list, and choices side by side if ``across``."""

    def __init__(
        self,
        sheet: Canvas,
        contest: Contest,
        rows: Sequence[Best],
        place: int,
        choices: Mapping[str, str],
        mouse: tuple[int, int],
        found: _Buttons,
        across: bool,
    ) -> None:
        self.sheet, self.contest, self.rows, self.place = sheet, contest, rows, place
        self.choices, self.mouse, self.found, self.across = choices, mouse, found, across
        letters, gap, self.radius = sheet.lettering, sheet.gap, _STAR * sheet.unit
        self.row = letters.height("small") + 2 * gap
        self.widths = {name: letters.width(text, "small") + 4 * gap for name, text in choices.items()}
        count, widths = len(choices), self.widths.values()
        self.side = sum(widths) + (count - 1) * gap if across else max(widths)
        self.head = round(2.6 * self.radius) if contest.stars is not None else 0
        self.lines = [(line, "medium" if i == 0 else "small") for i, line in enumerate(contest.outcome)]
        texts = max(letters.width(text, size, bold=size == "medium") for text, size in self.lines)
        self.scores = [contest.score_text(row.score) for row in rows]
        self.listed = max((letters.width(text, "small", True) for text in self.scores), default=0) + round(
            3 * self.row + 10 * SMALL_STAR * sheet.unit + letters.width("2000-00-00", "small")
        )
        wide = min(max(texts, self.side, round(7.5 * self.radius), self.listed) + 4 * gap, sheet.frame.width)
        tall = self.head + sum(letters.height(size) + gap for _, size in self.lines) + 5 * gap
        tall += (self._tall_row * len(rows) + gap) * bool(rows)
        tall += self.row if across else count * (self.row + gap) - gap
        self.form = Form((wide, tall), self._draw)

    @property
    def _tall_row(self) -> int:
        """The height of a row of the best list, in px."""
        return self.sheet.lettering.height("small") + self.sheet.gap

    def _draw(self, rect: pygame.Rect) -> None:
        sheet, gap, letters = self.sheet, self.sheet.gap, self.sheet.lettering
        sheet.painter.panel(rect, _CARD["background"], 0.94, 12 * sheet.unit)
        if self.contest.stars is not None:
            at = rect.centerx - 2.4 * self.radius, rect.top + 2 * gap + 1.2 * self.radius
            stars(sheet, at, self.radius, self.contest.stars)
        y = rect.top + 2 * gap + self.head
        for text, size in self.lines:
            text = letters.cut(text, size, rect.width - 4 * gap, size == "medium")
            colour = _CARD["text" if size == "medium" else "quiet"]
            sheet.write(text, size, (rect.centerx, y), colour, "midtop", bold=size == "medium")
            y += letters.height(size) + gap
        left, wide = rect.centerx - self.listed // 2, self.listed
        for number, (row, score) in enumerate(zip(self.rows, self.scores, strict=True), 1):
            self._draw_row(pygame.Rect(left, y, wide, self._tall_row), number, row, score)
            y += self._tall_row
        left, y = rect.centerx - self.side // 2, y + gap * (1 + bool(self.rows))
        for name, text in self.choices.items():
            button = self.found[name] = pygame.Rect(left, y, self.widths[name] if self.across else self.side, self.row)
            shade = 0.35 if button.collidepoint(self.mouse) else 0.16
            sheet.item(button, text, _CARD["accent"], shade, left=button.left + 2 * gap, right=button.right)
            left, y = (left + self.widths[name] + gap, y) if self.across else (left, y + self.row + gap)

    def _draw_row(self, rect: pygame.Rect, number: int, row: Best, score: str) -> None:
        """A row of the best list: its place, stars, score and day; that of this time is lit."""
        sheet, gap, mine = self.sheet, self.sheet.gap, number == self.place
        colour = _CARD["accent" if mine else "text"]
        if mine:
            sheet.painter.panel(rect, _CARD["accent"], 0.14, 5 * sheet.unit)
        sheet.write(str(number), "small", (rect.left + gap, rect.centery), colour, "midleft", bold=mine)
        left = rect.left + self.row
        if self.contest.stars is not None:
            stars(sheet, (left + SMALL_STAR * sheet.unit, rect.centery), SMALL_STAR * sheet.unit, row.stars)
            left += round(8 * SMALL_STAR * sheet.unit)
        sheet.write(score, "small", (left, rect.centery), colour, "midleft", bold=mine)
        sheet.write(row.day, "small", (rect.right - gap, rect.centery), _CARD["quiet"], "midright")
