"""The difference between a picture and a golden one: what counts as a change.

A pixel has changed if a channel is more than ROUNDING_LEVELS away from every level that its golden level can stand for,
since golden pictures store 6 bits. So a colour that is off by 6 levels or more is noticed wherever more than
STRAY_PIXELS of its pixels are close together, in a gradient from 4 levels on, and a single pixel from STRAY_LEVELS on;
a level or two everywhere, as another machine's rounding gives, is not. A line that stands out by less than 30 levels
from what is around it may be half a pixel thicker. Pixelmatch was tried instead: it ignores what it takes for
anti-aliasing, so it misses a small white ball on a pale sky that is a pixel larger all around (it counts 0 pixels, this
comparison 44), and it takes 0.8 s for 640x360.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from PIL import Image

#: Size of the golden picture of a run, in px: its PNG takes less than 60 kB.
SIZE = (480, 270)
#: Bits per colour channel in a golden picture; a stored level stands for the levels from LOWEST to HIGHEST around it.
_COLOUR_BITS = 6
LOWEST, _HIGHEST = -(1 << (7 - _COLOUR_BITS)), (1 << (7 - _COLOUR_BITS)) - 1
#: Levels, of 255, by which another machine's rounding may move a pixel; a ball moved by a quarter of a pixel moves it
#: by 20 and more.
ROUNDING_LEVELS = 2
#: Most changed pixels allowed within NEIGHBOURHOOD px of each other, and the most levels by which they may have
#: changed: an edge pixel or two rounded the other way, by a quarter of a pixel, as shapes are drawn four times larger
#: and scaled down. A ball of 7 px that is moved by half a pixel changes a dozen.
_STRAY_PIXELS, _STRAY_LEVELS = 3, 64
NEIGHBOURHOOD = 9
#: Largest share of pixels that may have changed, spread over the picture.
_STRAY_SHARE = 0.0005


@dataclass(frozen=True)
class _Difference:
    """The difference between a picture and the golden one."""

    share: float  # of the pixels that have changed, 0 to 1
    largest: int  # levels, 0 to 255
    together: int  # most changed pixels within NEIGHBOURHOOD px
    at: tuple[int, int]  # middle of that neighbourhood, px

    @property
    def matters(self) -> bool:
        """True if it is more than another machine's rounding."""
        return self.together > _STRAY_PIXELS or self.largest > _STRAY_LEVELS or self.share > _STRAY_SHARE

    def __str__(self) -> str:
        return (
            f"{self.share:.2%} of the pixels changed, the most by {self.largest} of 255 levels; "
            f"{self.together} together near x = {self.at[0]}, y = {self.at[1]}"
        )


def compare(expected: Image.Image, actual: Image.Image) -> _Difference:
    """Return the difference between two pictures of the same size. Raises ValueError if their sizes differ."""
    import numpy as np

    if expected.size != actual.size:
        raise ValueError(f"it is {actual.width}x{actual.height}, the golden one {expected.width}x{expected.height}")
    difference = _difference(expected, actual)
    changed = _changed(difference)
    # Sums over squares, from the sums over everything above and to the left.
    reach = NEIGHBOURHOOD // 2
    sums = np.pad(np.pad(changed, reach).cumsum(0).cumsum(1), ((1, 0), (1, 0)))
    near = sums[NEIGHBOURHOOD:, NEIGHBOURHOOD:] - sums[:-NEIGHBOURHOOD, NEIGHBOURHOOD:]
    near = near - sums[NEIGHBOURHOOD:, :-NEIGHBOURHOOD] + sums[:-NEIGHBOURHOOD, :-NEIGHBOURHOOD]
    row, column = np.unravel_index(int(near.argmax()), near.shape)
    largest = int(np.abs(difference).max())
    return _Difference(float(changed.mean()), largest, int(near.max()), (int(column), int(row)))


def _difference(expected: Image.Image, actual: Image.Image) -> np.ndarray:
    """Return the levels by which each channel is above the expected one, shape (height, width, 3)."""
    import numpy as np

    a, b = (np.asarray(image.convert("RGB")).astype(np.int16) for image in (expected, actual))
    return b - a


def _changed(difference: np.ndarray) -> np.ndarray:
    """Return True for the pixels that have changed by more than rounding, shape (height, width)."""
    import numpy as np

    higher, lower = difference > _HIGHEST + ROUNDING_LEVELS, difference < LOWEST - ROUNDING_LEVELS
    return np.any(higher | lower, axis=2)


def what_changed(expected: Image.Image, actual: Image.Image) -> Image.Image:
    """The changed pixels red on a pale copy of a picture of the same size."""
    import numpy as np
    from PIL import Image

    pale = 170 + np.asarray(expected.convert("L"))[:, :, None] // 3 * np.ones(3, np.uint8)
    pale[_changed(_difference(expected, actual))] = (220, 20, 20)
    return Image.fromarray(pale.astype(np.uint8))


def side_by_side(expected: Image.Image, actual: Image.Image) -> Image.Image:
    """Expected, actual, and the difference."""
    from PIL import Image

    images = [expected.convert("RGB"), actual.convert("RGB")]
    if expected.size == actual.size:
        images.append(what_changed(expected, actual))
    sheet = Image.new(
        "RGB", (sum(i.width for i in images) + 8 * (len(images) - 1), max(i.height for i in images)), "white"
    )
    left = 0
    for image in images:
        sheet.paste(image, (left, 0))
        left += image.width + 8
    return sheet


def as_png(image: Image.Image) -> bytes:
    """The bytes of a PNG file."""
    data = io.BytesIO()
    image.save(data, "PNG", optimize=True)
    return data.getvalue()


def coarser(image: Image.Image) -> Image.Image:
    """Return it with COLOUR_BITS per channel, which saves a third of the bytes; no level changes by more than 2."""
    import numpy as np
    from PIL import Image

    lost = 8 - _COLOUR_BITS
    return Image.fromarray(np.asarray(image) >> lost << lost | 1 << (lost - 1))
