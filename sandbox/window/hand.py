"""Things held by hand: the rubber band of a pull, and the handles of what can be dragged."""

from __future__ import annotations

from collections.abc import Sequence
from math import dist, hypot
from typing import NamedTuple

import pygame

from sandbox.picture.camera import Camera
from sandbox.picture.painter import Point
from sandbox.picture.palette import Colour, palette
from sandbox.sport.amounts import round_number_above
from sandbox.window.canvas import Canvas
from sandbox.window.handles import Grip
from sandbox.window.layout import Layout
from sandbox.window.stage import Stage

_CARD, _FORCE = palette("card"), palette("force")

#: The mouse takes hold of a handle from this distance, and sees those of a list from the second; px on 720 rows.
_NEAR, _SEEN = 13.0, 70.0
#: A handle on the ball that is played lies so far to its lower left: a pull begins on the ball, unless it is in hand.
#: Px on 720 rows.
_ASIDE = 26.0
#: The wind's handle is this far from its foot, in px on 720 rows per m/s; and its foot from the upper right corner.
_WIND, _FOOT = 4.0, (42.0, 13.0)

#: A demonstration of a pull: when the hand begins to pull, for how long, when it lets go, and when it begins again, in
#: s; and how far it pulls, in px on 720 rows.
_HOLDS, _PULLS, _LETS_GO, _BEAT, _REACH = 0.5, 0.9, 1.7, 2.5, 120.0

#: A drag that snaps goes in steps of at least so many px, and otherwise in steps of about so many.
_SNAPS, _FINE = 12.0, 0.25


class ShownGrip(NamedTuple):
    """A handle in the picture."""

    grip: Grip
    at: Point  # px
    camera: Camera  # that shows its place
    unit: float  # px on 720 rows
    in_hand: bool = False  # the ball itself is dragged, at the place of the handle

    def step(self, snap: bool) -> float:
        """The size of the steps in which it is dragged, in m or m/s."""
        return round_number_above((_SNAPS * self.unit if snap else _FINE) / self.camera.scale)

    def dragged(self, before: Point, to: Point) -> Point:
        """The place that it is dragged to, in m or m/s, by a drag between two places in px."""
        (x0, y0), (x, y) = self.camera.world(*before), self.camera.world(*to)
        return self.grip.place[0] + x - x0, self.grip.place[1] + y - y0


def visible_grips(grips: Sequence[Grip], stage: Stage, sheet: Canvas, in_hand: bool = False) -> list[ShownGrip]:
    """The places of the handles; that of the wind has a camera of its own. If the ball that is played is ``in_hand``, a
    drag of it moves it."""
    ball, aside, unit = stage.ball_at(stage.shot), _ASIDE * sheet.unit, sheet.unit
    foot = sheet.frame.right - _FOOT[0] * unit, sheet.frame.top + _FOOT[1] * unit
    found = []
    for grip in grips:
        camera = Camera((0.0, 0.0), foot, _WIND * unit) if grip.is_wind else stage.camera
        x, y = camera.pixel(*grip.place)
        on_ball = dist((x, y), ball) < _NEAR * unit and not grip.is_wind
        if on_ball and not in_hand:
            x, y = x - aside, y + aside
        found.append(ShownGrip(grip, (x, y), camera, unit, on_ball and in_hand))
    return found


def nearest(found: Sequence[ShownGrip], at: Point) -> ShownGrip | None:
    """The handle at a place in px."""
    near = min(found, key=lambda shown: dist(shown.at, at), default=None)
    return near if near is not None and dist(near.at, at) <= _NEAR * near.unit else None


def draw_handles(
    sheet: Canvas, layout: Layout, found: Sequence[ShownGrip], mouse: Point | None, held: Grip | None, text: str
) -> None:
    """The handles, those in a list only near the mouse, if it is there; the one that is held, or that the mouse is on,
    with its numbers."""
    unit = sheet.unit
    for grip, at, _, _, in_hand in found:
        seen = in_hand or (mouse is not None and (not grip.in_list or dist(at, mouse) < _SEEN * unit))
        if seen and (held is None or grip.keys != held.keys):
            radius = _NEAR if in_hand else 5.0
            sheet.painter.ring(at, (radius + 1) * unit, 4 * unit, _CARD["background"], 0.8)
            sheet.painter.ring(at, radius * unit, 2.2 * unit, _CARD["text"])
    for grip, at, camera, _, in_hand in found:
        if held is not None and grip.keys == held.keys:
            if grip.is_wind and dist(camera.anchor, at) > 2:
                sheet.painter.arrow(camera.anchor, at, 3.6 * unit, _FORCE["wind"])
            radius = _NEAR if in_hand else 8.0
            sheet.painter.ring(at, (radius + 1) * unit, 5 * unit, _CARD["background"], 0.8)
            sheet.painter.ring(at, radius * unit, 2.2 * unit, _CARD["accent"])
            _label(
                sheet, layout, text, at, below=at[1] > camera.pixel(*grip.place)[1]
            )  # beside a ball, which stays in sight


def _label(sheet: Canvas, layout: Layout, text: str, at: tuple[float, float], below: bool) -> None:
    """A text on a card above or below a place in px."""
    room = sheet.frame.width - 4 * sheet.gap
    forms = [sheet.text([(sheet.shortened(text, "small", share * room), _CARD["text"])]) for share in (1.0, 0.5, 0.3)]
    away, anchor = (20 * sheet.unit, "midtop") if below else (-20 * sheet.unit, "midbottom")
    layout.put("hand", forms, (at[0], at[1] + away), anchor)


def draw_pull(sheet: Canvas, layout: Layout, start: tuple[float, float], pull: tuple[float, float], text: str) -> None:
    """The rubber band from where the pull began to the hand, and the speed and angle that it gives."""
    hand = start[0] + pull[0], start[1] + pull[1]
    length = hypot(*pull)
    if length < 1:
        return
    across = -pull[1] / length * 6 * sheet.unit, pull[0] / length * 6 * sheet.unit
    for side in (-1, 1):
        foot = start[0] + side * across[0], start[1] + side * across[1]
        pygame.draw.aaline(sheet.surface, _CARD["shadow"], foot, hand, max(3, round(4.5 * sheet.unit)))
        pygame.draw.aaline(sheet.surface, _CARD["accent"], foot, hand, max(2, round(2.5 * sheet.unit)))
    sheet.painter.disc(hand, 8.5 * sheet.unit, _CARD["shadow"], 0.8)
    sheet.painter.disc(hand, 6.5 * sheet.unit, _CARD["accent"])
    _label(sheet, layout, text, hand, below=pull[1] >= 0)


def draw_demonstration(sheet: Canvas, ball: Point, away: Point, t: float) -> None:
    """A hand that takes hold of the ball at a place in px, pulls it ``away`` (a direction), and lets go, over and over;
    at the time t in s."""
    unit, beat = sheet.unit, t % _BEAT
    pulled = min(max((beat - _HOLDS) / _PULLS, 0.0), 1.0)
    pulled = pulled * pulled * (3.0 - 2.0 * pulled)
    held, fade = beat < _LETS_GO, min(1.0, beat / 0.25, (_BEAT - beat) / 0.35)
    room = sheet.frame.inflate(-40 * unit, -40 * unit)
    x = min(max(ball[0] + _REACH * unit * pulled * away[0], room.left), room.right)
    y = min(max(ball[1] + _REACH * unit * pulled * away[1], room.top), room.bottom)
    if held and pulled > 0.0:
        sheet.painter.line([ball, (x, y)], 3.0 * unit, _CARD["accent"], 0.9 * fade)
    if held:
        sheet.painter.ring((x, y), 13 * unit, 2.2 * unit, _CARD["accent"], fade)
    for wider, colour in ((2.6 * unit, _CARD["shadow"]), (0.0, _CARD["text"])):
        _pointing(sheet, (x, y), unit, wider, colour, fade, held)


def _pointing(sheet: Canvas, tip: Point, unit: float, wider: float, colour: Colour, fade: float, held: bool) -> None:
    """A hand whose finger points to a place in px; open if nothing is ``held``."""
    x, y = tip[0], tip[1] + (0.0 if held else -6.0 * unit)
    bones = [((1, 2), (7, 24), 7.0), ((8, 20), (12, 26), 8.0), ((13, 21), (17, 27), 8.0), ((18, 23), (21, 29), 7.0),
             ((-2, 24), (4, 33), 7.0), ((8, 30), (17, 34), 17.0)]  # fmt: skip
    for (x0, y0), (x1, y1), width in bones:
        ends = [(x + x0 * unit, y + y0 * unit), (x + x1 * unit, y + y1 * unit)]
        sheet.painter.line(ends, width * unit + 2 * wider, colour, fade)
        for end in ends:
            sheet.painter.disc(end, 0.5 * width * unit + wider, colour, fade)
