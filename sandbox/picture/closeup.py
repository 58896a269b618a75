"""Close-ups: what decides a run, enlarged where a picture has room for it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import pygame

from sandbox.picture.camera import Box, Camera

#: A close-up is so many times as large as the picture at least and at most, and at least so high, in px on 720 rows.
LEAST_FACTOR, LARGEST_FACTOR, _LEAST_HEIGHT = 1.7, 5.0, 96.0
#: The widest of them, width over height.
_WIDEST = 3.0
#: Between two of them, px on 720 rows.
_GAP = 16.0


@dataclass(frozen=True)
class CloseUp:
    """A part of the world and where it is drawn: the camera shows it in ``rect`` (px)."""

    rect: pygame.Rect
    camera: Camera

    @property
    def box(self) -> Box:
        """The part of the world that it shows, in m."""
        (left, bottom), (right, top) = self.camera.world(*self.rect.bottomleft), self.camera.world(*self.rect.topright)
        return Box(left, bottom, right, top)

    def shows(self, place: tuple[float, float]) -> bool:
        """True if a place in m is in it."""
        return bool(self.rect.collidepoint(self.camera.pixel(*place)))


def arranged(boxes: Sequence[Box], free: pygame.Rect, camera: Camera, unit: float) -> list[CloseUp]:
    """Close-ups of parts of the world (m), side by side in a free part of the picture (px), all at one scale and each
    over what it shows as nearly as there is room; none where they would hardly be larger than in the picture."""
    boxes = sorted(boxes)
    gap, high = round(_GAP * unit), free.height
    if not boxes or high < _LEAST_HEIGHT * unit:
        return []
    room = (free.width - gap * (len(boxes) - 1)) / len(boxes)
    wide = min(room, _WIDEST * high)
    scale = min(min(wide / (box.right - box.left), high / (box.top - box.bottom)) for box in boxes)
    if scale < LEAST_FACTOR * camera.scale:
        return []
    scale = min(scale, LARGEST_FACTOR * camera.scale)
    lefts = [camera.pixel((box.left + box.right) / 2, 0.0)[0] - wide / 2 for box in boxes]
    for i in range(len(lefts)):
        lefts[i] = max(lefts[i], lefts[i - 1] + wide + gap if i else free.left)
    for i in reversed(range(len(lefts))):
        lefts[i] = min(lefts[i], lefts[i + 1] - wide - gap if i + 1 < len(lefts) else free.right - wide)
    found = []
    for box, left in zip(boxes, lefts, strict=True):
        rect = pygame.Rect(round(left), free.top, round(wide), high)
        (x, y), ground = ((box.left + box.right) / 2, (box.bottom + box.top) / 2), camera.at[1]
        found.append(CloseUp(rect, Camera((x, ground), (rect.centerx, rect.centery + (y - ground) * scale), scale)))
    return found
