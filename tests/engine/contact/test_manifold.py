"""Where two outlines touch: a point, or the ends of a side that they share."""

from __future__ import annotations

import numpy as np
import pytest

from sandbox.engine.contact.manifold import meeting
from sandbox.engine.model.ball import Body
from sandbox.engine.model.shapes import box


@pytest.mark.parametrize("turn", [0.0, 0.9, -2.0])
def test_stacked_boxes_touch_at_the_ends_of_the_shared_side(turn: float):
    way, up = np.exp(1j * turn), 1j * np.exp(1j * turn)
    large, small = (Body("box", position=(0.0, 0.0), shape=box(width, 0.2), mass=1.0) for width in (2.0, 0.4))
    for along, ends in ((0.3, (0.1, 0.5)), (-0.9, (-1.0, -0.7))):
        place = along * way + 0.2 * up
        met = meeting(small, (place.real, place.imag, 0.0, 0.0, 0.0, turn), large, (0.0, 0.0, 0.0, 0.0, 0.0, turn))
        found = sorted((complex(*point) / way for point in met.points), key=lambda point: point.real)
        assert found == pytest.approx([complex(end, 0.1) for end in ends])
        assert (met.gap, *met.normal) == pytest.approx((0.0, up.real, up.imag), abs=1e-12)
