"""The places of all that lies over the picture: nothing covers the ball, what is aimed at, or another text.

What lies over the picture comes in forms, the largest first. The order in which it is placed says what goes first where
there is little room: the headline, messages, what the hand holds, what the mouse reads, the ball to set spin on, the
fan, the map, the charts, the cost, hints, and the labels of earlier shots. Each takes the first form that says all and
finds room off the path, then the first that finds room at all, then those that leave something out, in the same way; if
none does, it is left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from itertools import product
from typing import NamedTuple

import numpy as np
import pygame


class Form(NamedTuple):
    """One form of a card: its size in px, and what draws it in a rectangle of that size."""

    size: tuple[int, int]
    draw: Callable[[pygame.Rect], object]
    whole: bool = True  # it says all


class Layout:
    """Finds places in ``room``, ``gap`` px from what is ``kept`` clear and from each other; if it can, off a path."""

    def __init__(
        self, room: pygame.Rect, gap: int, kept: Iterable[pygame.Rect] = (), path: Sequence[pygame.Rect] = ()
    ) -> None:
        self.room, self.gap, self.kept, self.path = room, gap, list(kept), path
        self.placed: dict[str, pygame.Rect] = {}

    @property
    def occupied(self) -> list[pygame.Rect]:
        """The rectangles that nothing else may cover."""
        return [*self.kept, *self.placed.values()]

    def put(self, name: str, forms: Sequence[Form], at: tuple[float, float], anchor: str) -> pygame.Rect | None:
        """Draw the first form with room, its side or corner ``anchor`` (named as by pygame.Rect) as near as it can be
        to a place in px; returns where it is, or None if there is no room."""
        for whole, path in product((True, False), (self.path, ())):
            for form in forms:
                rect = self.find(form.size, at, anchor, [*self.occupied, *path]) if form.whole == whole else None
                if rect is not None:
                    self.placed[name] = rect
                    form.draw(rect)
                    return rect
        return None

    def find(
        self, size: tuple[int, int], at: tuple[float, float], anchor: str, off: Sequence[pygame.Rect]
    ) -> pygame.Rect | None:
        """The nearest place for a rectangle that is off all these; None if there is none."""
        wanted = pygame.Rect((0, 0), size)
        setattr(wanted, anchor, (round(at[0]), round(at[1])))
        if wanted.width > self.room.width or wanted.height > self.room.height:
            return None
        wanted.clamp_ip(self.room)
        if wanted.inflate(2 * self.gap, 2 * self.gap).collidelist(list(off)) < 0:
            return wanted
        edges = np.array([(r.left, r.top, r.right, r.bottom) for r in off], dtype=float)
        starts, clear = [], []
        for axis, side in enumerate(size):
            low, high = edges[:, axis] - self.gap, edges[:, axis + 2] + self.gap
            first, last = self.room.topleft[axis], self.room.bottomright[axis] - side
            start = np.concatenate([[wanted.topleft[axis], first, last], low - side, high])
            start = np.unique(start[(start >= first) & (start <= last)])
            starts.append(start)
            clear.append((start[:, None] < high) & (start[:, None] + side > low))
        free = clear[0].astype(np.float32) @ clear[1].astype(np.float32).T == 0
        if not free.any():
            return None
        away = [(start - here) ** 2 for start, here in zip(starts, wanted.topleft, strict=True)]
        column, row = divmod(int(np.where(free, away[0][:, None] + away[1], np.inf).argmin()), free.shape[1])
        return pygame.Rect(round(starts[0][column]), round(starts[1][row]), *size)
