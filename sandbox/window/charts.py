"""Strip charts: speed, height and spin of the ball that is played, over the time of the shot."""

from __future__ import annotations

from typing import Any

import numpy as np
import pygame

from sandbox.picture.chart import Curve
from sandbox.picture.graph import Panel, draw_panel, motion
from sandbox.picture.palette import palette
from sandbox.picture.path import hardest
from sandbox.picture.view import View
from sandbox.sport.amounts import amount
from sandbox.window.canvas import Canvas
from sandbox.window.layout import Form
from sandbox.window.shots import Shot

_CARD = palette("card")

#: What is shown of what there is.
_SHOWN = ("speed", "height", "distance", "spin")
#: The card's share of the picture's width from the side and from above, unless its text is wider; height of a curve, px
#: on 720 rows.
_SHARE, _CURVE = (0.24, 0.15), 46
#: Before the largest value of all, of either sign.
_PEAK = "peak "


class Charts:
    """The strips of one shot."""

    def __init__(self, shot: Shot, picture: View[Any]) -> None:
        self.shot = shot
        self.hits = [event.t for event in hardest(shot.run, [shot.ball])]
        times, moves = motion(shot.run, picture)
        self.strips = [
            Panel(name, unit, [Curve("", times, values, _CARD["accent"])])
            for name, (unit, values) in moves.items() if name in _SHOWN
        ]  # fmt: skip

    def forms(self, sheet: Canvas, t: float | None) -> list[Form]:
        """A card of all strips with a mark at ``t`` in s, a lower one, and ever fewer strips."""
        shares = [(share, len(self.strips)) for share in (1.0, 0.7)]
        return [
            self._form(sheet, t, *how) for how in (*shares, *((0.7, n) for n in range(len(self.strips) - 1, 0, -1)))
        ]

    def _form(self, sheet: Canvas, t: float | None, share: float, count: int) -> Form:
        """The first strips, their curves a share as high as usual."""
        unit, gap, letters, strips = sheet.unit, sheet.gap, sheet.lettering, self.strips[:count]
        row = letters.height("small")
        tall = round(max(share * _CURVE * unit, 2.2 * row)) + 2 * row + 4 * gap
        longest = [f"{strip.title} ({strip.in_chosen_units.unit})  {_value_text(strip, None)}" for strip in self.strips]
        written = max(letters.width(text, "small", bold=True) for text in longest) + 4 * gap
        wide = max(round(_SHARE[not self.shot.upright] * sheet.size[0]), written)
        until = max(self.shot.run.duration, 1e-9)

        def draw(rect: pygame.Rect) -> None:
            sheet.painter.panel(rect, _CARD["background"], 0.85, 10 * unit)
            for i, strip in enumerate(strips):
                place = pygame.Rect(rect.left + 2 * gap, rect.top + 2 * gap + i * tall, rect.width - 4 * gap, tall)
                draw_panel(sheet, place, strip, until, t, self.hits, _value_text(strip, t))

        return Form((wide, len(strips) * tall + 2 * gap), draw, whole=count == len(self.strips))


def _value_text(strip: Panel, t: float | None) -> str:
    """The value at time t in s, or the largest of all, of either sign."""
    curve = strip.curves[0]
    if t is not None:
        return amount(float(np.interp(t, curve.times, curve.values)), strip.unit)
    return _PEAK + amount(float(curve.values[np.abs(curve.values).argmax()]), strip.unit)
