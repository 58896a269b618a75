"""The track of a ball over the ground, seen from above, beside a picture from the side."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pygame

from sandbox.picture.camera import Area, Box, Camera
from sandbox.picture.palette import Colour
from sandbox.picture.sheet import CARD, Sheet
from sandbox.sport.amounts import metres
from sandbox.sport.sideways import GroundPlace

#: Width of its card, and greatest height of what is drawn in it, as shares of the picture's width and rows.
WIDTH, HEIGHT = 0.27, 0.16


def draw_track(sheet: Sheet, track: Sequence[GroundPlace], target: float, colour: Colour) -> pygame.Rect:
    """Draw a card with the track in the upper right corner, to scale, x to the right and the launch's right below; the
    line to a target at x (m) is dashed. Return where it is, in px."""
    painter, unit, inset = sheet.painter, sheet.unit, 2.0 * sheet.gap
    points = np.array([(x, -side) for x, side in track])  # m; what is to the right is drawn below
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    left, bottom, right, top = min(left, target), min(bottom, 0.0), max(right, target), max(top, 0.0)
    aside = track[-1].side
    words = f"from above: {metres(abs(aside))} {'right' if aside > 0.0 else 'left'}"
    wide = max(WIDTH * sheet.size[0] - 2 * inset, sheet.lettering.width(words, "small", bold=True))
    small = sheet.lettering.height("small")
    scale = min(wide / max(right - left, 1e-9), HEIGHT * sheet.rows / max(top - bottom, 1e-9))
    high = (top - bottom) * scale + 8 * unit
    rect = pygame.Rect(0, 0, round(wide + 2 * inset), round(high + small + 2.5 * inset))
    rect.topright = sheet.frame.topright
    painter.panel(rect, CARD["background"], CARD["opacity"], 8 * unit)
    x, y = rect.left + inset, rect.top + small + 1.5 * inset
    camera = Camera.fit(Box(left, bottom, right, top), Area(x, y, x + wide, y + high - 4 * unit))
    painter.dashes([camera.pixel(0.0, 0.0), camera.pixel(right, 0.0)], 1.2 * unit, CARD["quiet"], 5 * unit, 4 * unit)
    painter.trace(camera.pixels(points), max(2.0, 2.0 * unit), colour, CARD["shadow"], 0.0)
    painter.disc(camera.pixel(*points[-1]), max(2.5, 4 * unit), CARD["accent"])
    sheet.write(words, "small", (rect.left + inset, rect.top + inset), CARD["text"], bold=True)
    return rect
