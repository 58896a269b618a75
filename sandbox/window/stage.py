"""The standing view: the place seen whole, with the path of the shot, its contacts, earlier shots and the balls."""

from __future__ import annotations

from itertools import pairwise
from math import hypot
from typing import Any

import numpy as np
import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.ghosts import colours_beside
from sandbox.picture.painter import blank
from sandbox.picture.palette import Colour, palette
from sandbox.window.canvas import Canvas
from sandbox.window.path import few
from sandbox.window.session import Shot

CARD, TRACE = palette("card"), palette("trace")

#: So much of the stage, on every side, a path may use before the view is composed anew.
EDGE = 0.02
#: Where a line bends by more than this, in rad, it has a round joint.
JOINT = 0.2
#: So far from its edge, in px, the second smooth line of a line lies, and its filling, whose edge is rough, ends.
INSIDE, FILLED = 1.2, 0.9
#: Up to this width, in px, the smooth lines fill a line between them.
NARROW = 3.0
#: Pieces of a line lie over each other by so much, in px, or a gap would show where they meet.
OVERLAP = 0.35
#: Contacts nearer to each other than this, in px, are marked once; and at most so many.
NEAR, MOST_CONTACTS = 14, 24


class Stage:
    """Shows shots of ``size`` px from where the picture of one of them, the composed one, stands."""

    def __init__(self, shot: Shot, size: tuple[int, int], before: Stage | None = None) -> None:
        """``before`` is the stage of the same place so far: its backdrop is kept where the camera is the same."""
        self.shot, self.size = shot, size
        self.picture: Any = shot.scene.picture(shot.run, size)
        #: None for a scene whose picture offers no stage: then its poster is shown, and nothing over it.
        self.camera: Camera | None = None
        if all(hasattr(self.picture, name) for name in ("stage", "camera", "draw_balls")):
            self.camera = self.picture.camera
            same = before is not None and before.camera == self.camera
            self.backdrop: pygame.Surface = before.backdrop if before is not None and same else self.picture.stage()
        else:
            self.backdrop = self.picture.poster()
        self._ghosts: tuple[Any, pygame.Surface] | None = None
        self._lines: dict[str, tuple[Shot, np.ndarray]] = {}  # whole lines drawn last, by ball, in px

    def holds(self, shot: Shot) -> bool:
        """Whether the path of another shot stays in sight."""
        if self.camera is None or shot is self.shot:
            return shot is self.shot
        pixels = self.camera.pixels(shot.track(shot.ball)[:, 1:])
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        width, height = self.size
        return bool(
            low[0] >= EDGE * width
            and low[1] >= EDGE * height
            and high[0] <= (1 - EDGE) * width
            and high[1] <= (1 - EDGE) * height
        )

    def ball_at(self, shot: Shot, t: float = 0.0) -> tuple[float, float]:
        """Where the ball that is played is, in px."""
        if self.camera is None:
            return self.size[0] / 2, self.size[1] / 2
        return self.camera.pixel(*shot.run.state(shot.ball, t)[:2])

    def sheet(self, surface: pygame.Surface) -> Canvas:
        """A sheet on a surface, with the place on it."""
        sheet = Canvas(surface)
        sheet.surface.blit(self.backdrop, (0, 0))
        return sheet

    def draw_ghosts(self, sheet: Canvas, ghosts: list[Shot]) -> None:
        """Earlier shots, faintly; the last five."""
        if self.camera is None or not ghosts:
            return
        shown = ghosts[-5:]
        kept = tuple(id(shot) for shot in shown)
        if self._ghosts is None or self._ghosts[0] != kept:
            layer = blank(self.size, transparent=True)
            colours = colours_beside(type(self.picture))
            for index, shot in enumerate(shown):
                colour = colours[index % len(colours)]
                draw_line(layer, self._line(shot, shot.ball), 2, colour)
            layer.set_alpha(round(255 * (TRACE["earlier"] + 0.15)))
            self._ghosts = kept, layer
        sheet.surface.blit(self._ghosts[1], (0, 0))

    def draw_path(self, sheet: Canvas, shot: Shot, until: float | None = None) -> None:
        """The path of every ball that moves, that of the played one last and strongest, and where they touch."""
        if self.camera is None:
            return
        thin = max(1, round(1.4 * sheet.unit))
        for ball in shot.movers[:-1]:
            draw_line(sheet.surface, self._line(shot, ball, until), thin, CARD["text"])
        width, line = max(3, round(3.6 * sheet.unit)), self._line(shot, shot.ball, until)
        draw_line(sheet.surface, line, width + 2, TRACE["rim"])
        draw_line(sheet.surface, line, width, TRACE["colours"][0])
        self._contacts(sheet, shot, until)

    def draw_balls(self, sheet: Canvas, t: float, picture: Any = None) -> None:
        """The balls at time t in s, by the ``picture`` of another shot or by the composed one's."""
        if self.camera is not None:
            (picture or self.picture).draw_balls(sheet.painter, self.camera, t)

    def _line(self, shot: Shot, ball: str, until: float | None = None) -> np.ndarray:
        """Points of a ball's path in px, shape (n, 2); up to the time ``until`` (s), or all of it."""
        assert self.camera is not None
        kept = self._lines.get(ball)
        if until is None and kept is not None and kept[0] is shot:
            return kept[1]
        track = shot.track(ball)
        if until is not None:
            track = track[track[:, 0] <= until]
            track = np.vstack([track, (until, *shot.run.state(ball, until)[:2])])
        line = few(np.clip(self.camera.pixels(track[:, 1:]), -4000, 8000))
        if until is None:
            self._lines[ball] = shot, line
        return line

    def _contacts(self, sheet: Canvas, shot: Shot, until: float | None) -> None:
        assert self.camera is not None
        marked: list[tuple[float, float]] = []
        for event in shot.run.events:
            if event.kind != "impact" or event.ball != shot.ball or (until is not None and event.t > until):
                continue
            at = self.camera.pixel(event.x, event.y)
            if all(hypot(at[0] - x, at[1] - y) >= NEAR * sheet.unit for x, y in marked):
                marked.append(at)
        for at in marked[:MOST_CONTACTS]:
            sheet.painter.disc(at, 5.0 * sheet.unit, TRACE["rim"], 0.7)
            sheet.painter.disc(at, 3.6 * sheet.unit, CARD["accent"])

    def draw_pull(self, sheet: Canvas, ball: tuple[float, float], pull: tuple[float, float], text: str) -> None:
        """The rubber band from the ball to the hand, and what it will do."""
        hand = ball[0] + pull[0], ball[1] + pull[1]
        length = hypot(*pull)
        if length < 1:
            return
        across = -pull[1] / length * 6 * sheet.unit, pull[0] / length * 6 * sheet.unit
        for side in (-1, 1):
            start = ball[0] + side * across[0], ball[1] + side * across[1]
            pygame.draw.aaline(sheet.surface, CARD["shadow"], start, hand, max(3, round(4.5 * sheet.unit)))
            pygame.draw.aaline(sheet.surface, CARD["accent"], start, hand, max(2, round(2.5 * sheet.unit)))
        sheet.painter.disc(hand, 8.5 * sheet.unit, CARD["shadow"], 0.8)
        sheet.painter.disc(hand, 6.5 * sheet.unit, CARD["accent"])
        below = pull[1] >= 0
        text = sheet.ended(text, "small", sheet.frame.width - 4 * sheet.gap)
        rect = sheet.lettering.rect(
            text, "small", (hand[0], hand[1] + (20 if below else -20) * sheet.unit), "midtop" if below else "midbottom"
        )
        room = sheet.frame.copy()
        room.height -= sheet.card_height() + sheet.gap
        rect = rect.inflate(4 * sheet.gap, 2 * sheet.gap).clamp(room)
        sheet.painter.panel(rect, CARD["background"], 0.85, 6 * sheet.unit)
        sheet.lettering.write(sheet.surface, text, "small", rect.center, CARD["text"], "center")


def draw_line(surface: pygame.Surface, points: np.ndarray, width: float, colour: Colour) -> None:
    """A line through points (px, shape (n, 2)), as wide in every direction, and smooth: quicker than the painter's.

    pygame's own smooth lines are as wide as ``width`` only where they run straight along or down.
    """
    if width < 2.5:
        for a, b in pairwise(points):
            pygame.draw.aaline(surface, colour, a, b, round(width))
        return
    steps = np.diff(points, axis=0)
    lengths = np.maximum(np.hypot(*steps.T), 1e-9)
    ahead = steps / lengths[:, None]
    across = np.column_stack([-ahead[:, 1], ahead[:, 0]])
    bends = np.hypot(*np.diff(across, axis=0).T) > JOINT
    for point in points[1:-1][bends]:
        pygame.draw.aacircle(surface, colour, point, width / 2)
    sides = np.array([width / 2 - 0.5, width / 2 - INSIDE, INSIDE - width / 2, 0.5 - width / 2])[:, None, None]
    starts, ends = points[:-1] - OVERLAP * ahead, points[1:] + OVERLAP * ahead
    if width > NARROW:
        half = (width / 2 - FILLED) * across
        begin, end = starts + 0.5, ends + 0.5  # pygame cuts the corners of a polygon off to whole px
        for quad in np.stack([begin + half, end + half, end - half, begin - half], axis=1).tolist():
            pygame.draw.polygon(surface, colour, quad)
    for one, other in zip((starts + sides * across).tolist(), (ends + sides * across).tolist(), strict=True):
        for a, b in zip(one, other, strict=True):
            pygame.draw.aaline(surface, colour, a, b)


def headline(sheet: Canvas, text: str, note: str, colour: Colour) -> pygame.Rect:
    """What happens, large on a dark card at the top left, and a line below it; returns where it is."""
    letters, inset = sheet.lettering, 2 * sheet.gap
    room = sheet.frame.width - 2 * inset
    rooms = {"large": round(0.66 * sheet.size[0]), "medium": room}
    size = next((size for size in rooms if letters.width(text, size, bold=True) <= rooms[size]), "small")
    text, note = letters.cut(text, size, room, bold=True), letters.cut(note, "small", room)
    width = max(letters.width(text, size, bold=True), letters.width(note, "small"))
    height = letters.height(size) + (letters.height("small") + sheet.gap if note else 0)
    rect = pygame.Rect(sheet.frame.left, sheet.frame.top, width + 2 * inset, height + inset)
    sheet.painter.panel(rect, CARD["background"], CARD["opacity"], 10 * sheet.unit)
    at = sheet.write(text, size, (rect.left + inset, rect.top + sheet.gap), colour, bold=True)
    if note:
        sheet.write(note, "small", (at.left, at.bottom + sheet.gap), CARD["quiet"])
    return rect
