"""A ball on which spin is set by hand: where the tip of the cue hits it, or how fast it turns, and about which axis."""

from __future__ import annotations

from math import atan2, cos, hypot, pi, sin
from typing import Any

import pygame

from sandbox.parameters import Parameter
from sandbox.picture.palette import palette
from sandbox.sport.amounts import amount
from sandbox.window.canvas import Canvas
from sandbox.window.session import Session

_CARD = palette("card")

#: Radius of the ball in px on 720 rows.
_RADIUS = 36.0
#: A spin that has a unit reaches so many times its value in the file, or so many notches of the wheel.
_TIMES, _NOTCHES = 2.0, 20


class Pad:
    """The spins of a session: one along the width of a ball, or two across it, in ``rect`` of the picture."""

    def __init__(self, session: Session, upright: bool, sheet: Canvas, share: float = 1.0) -> None:
        """``share`` is that of its usual size."""
        self.session, self.upright, self.unit, self.sheet = session, upright, sheet.unit, sheet
        spins = session.controls.spins[:2]
        self.spins = [p for spin in spins if (p := session.parameters.get(spin.key)) is not None]
        self.reaches = [self._reach(p, spin.step) for p, spin in zip(self.spins, spins, strict=False)]
        #: The tip of a cue: both in radii of the ball, so it slips off beyond a circle.
        self.is_tip = len(self.spins) == 2 and all(p.unit == "" for p in self.spins)
        self.radius, row = share * _RADIUS * self.unit, sheet.lettering.height("small")
        self.texts = self._texts()
        width = max(2 * self.radius, *(sheet.lettering.width(text, "small") for text in self.texts))
        tall = 2 * self.radius + len(self.texts) * row + 4 * sheet.gap
        self.rect = pygame.Rect(0, 0, round(width) + 4 * sheet.gap, round(tall))

    @property
    def centre(self) -> tuple[float, float]:
        """The middle of the ball, in px."""
        inset = 2 * self.sheet.gap + self.radius
        return self.rect.left + inset, self.rect.top + inset

    def _reach(self, parameter: Parameter, step: float) -> float:
        """The value at the edge of the ball."""
        if parameter.unit == "":
            return 1.0
        base = self.session.base_value(parameter.key)
        return max(_TIMES * abs(base if isinstance(base, float) else 0.0), _NOTCHES * step)

    def _texts(self) -> list[str]:
        if self.is_tip:
            up, right = (p.value for p in self.spins)
            sides = "up" if up >= 0 else "down", "right" if right >= 0 else "left"
            return [f"{abs(up):.2f} {sides[0]}", f"{abs(right):.2f} {sides[1]}", "level cue"]
        names = [p.key.rpartition(".")[2] for p in self.spins]
        texts = [f"{name} {amount(p.value, p.unit or '')}" for name, p in zip(names, self.spins, strict=True)]
        return texts if len(texts) == 2 else [*texts, "about the axis across the picture" if self.upright else
                                              "about the upright axis"]  # fmt: skip

    @property
    def most(self) -> float:
        """The largest distance of the tip from the middle, in radii."""
        return min((p.high or 1.0) for p in self.spins) if self.is_tip else 1.0

    def changes(self, at: tuple[float, float]) -> dict[str, Any]:
        """The changes that a place in px makes."""
        across, up = (at[0] - self.centre[0]) / self.radius, (self.centre[1] - at[1]) / self.radius
        far = hypot(across, up)
        if self.is_tip and far > self.most:
            across, up = across * self.most / far, up * self.most / far
        shares = (up, across) if self.is_tip else (across, up)
        found = dict(self.session.controls.set_on_pull)
        for parameter, share, reach in zip(self.spins, shares, self.reaches, strict=False):
            value = parameter.within(reach * min(max(share, -1.0), 1.0))
            found[parameter.key] = int(100 * value) / 100 if self.is_tip else float(f"{value:.3g}")
        return found

    def draw(self, rect: pygame.Rect) -> None:
        """On a card: the ball, the circle of the tip, or how far it turns in a moment."""
        self.rect, sheet = rect, self.sheet
        unit, (x, y), radius = self.unit, self.centre, self.radius
        sheet.painter.panel(self.rect, _CARD["background"], 0.85, 8 * unit)
        sheet.painter.disc((x, y), radius, _CARD["text"], 0.92)
        shares = [p.value / reach for p, reach in zip(self.spins, self.reaches, strict=True)]
        across, up = (shares[1], shares[0]) if self.is_tip else (shares[0], shares[1] if len(shares) > 1 else 0.0)
        across, up = (min(max(share, -1.0), 1.0) for share in (across, up))
        for dx, dy in ((1, 0), (0, 1)):
            ends = [(x - dx * radius, y - dy * radius), (x + dx * radius, y + dy * radius)]
            sheet.painter.line(ends, unit, _CARD["quiet"], 0.7)
        if self.is_tip:
            sheet.painter.ring((x, y), self.most * radius, 1.5 * unit, _CARD["bad"])
        elif across:  # an arc around the ball, from the top to where a point of it gets; counter-clockwise
            turn = across * pi
            arc = [(x - 0.8 * radius * sin(a), y - 0.8 * radius * cos(a)) for a in
                   (turn * i / 24 for i in range(25))]  # fmt: skip
            sheet.painter.line(arc, 3 * unit, _CARD["accent"])
            way = atan2(arc[-1][1] - arc[-2][1], arc[-1][0] - arc[-2][0])
            tip = arc[-1][0] + 6 * unit * cos(way), arc[-1][1] + 6 * unit * sin(way)
            sheet.painter.arrow(arc[-2], tip, 3 * unit, _CARD["accent"])
        at = x + across * radius, y - up * radius
        sheet.painter.disc(at, 6.5 * unit, _CARD["background"])
        sheet.painter.disc(at, 5 * unit, _CARD["accent"])
        row = sheet.lettering.height("small")
        for number, text in enumerate(self.texts):
            place = self.rect.left + 2 * sheet.gap, y + radius + sheet.gap + number * row
            colour = _CARD["text"] if number == 0 else _CARD["quiet"]
            sheet.lettering.write(sheet.surface, text, "small", place, colour)
