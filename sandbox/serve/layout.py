"""The size of a picture that is made for a browser, from the room that its page has for it."""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

from sandbox.picture.above import AboveView
from sandbox.scene import Scene

#: A picture has so many px for each of the page, at most, and about so many in all.
_FINEST, _PIXELS = 2.0, 1_400_000
#: Letters on it are as on a picture of 720 rows that is shown so many times as large.
_LETTERS = (0.74, 1.1)
#: From the side it is at least this wide, as a share of its height: more sky would be empty.
_TALLEST = 1.0


class Layout(NamedTuple):
    """A picture: its size in px before it is turned, how much larger its letters are, and if the page shows it turned,
    by a quarter to the left."""

    size: tuple[int, int]
    density: float
    turned: bool


def layout_of(scene: Scene, room: tuple[int, int]) -> Layout:
    """The layout of a scene's picture in a room of so many px of the page, across and down."""
    wide, tall = room
    view = scene.picture_module().Picture
    above = isinstance(view, type) and issubclass(view, AboveView)
    turned = above and view.STANDS_UPRIGHT and tall > wide
    if turned:
        wide, tall = tall, wide
    elif not above:
        tall = min(tall, round(wide / _TALLEST))
    finer = max(1.0, min(_FINEST, sqrt(_PIXELS / (wide * tall))))
    size = round(finer * wide), round(finer * tall)
    rows = min(tall, wide * 3 / 4)
    letters = min(max(rows / 720, _LETTERS[0]), _LETTERS[1])
    return Layout(size, letters * 720 / rows, turned)
