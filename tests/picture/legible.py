"""What all pictures are held to."""

from __future__ import annotations

from typing import Any


def assert_legible(sheet: Any) -> None:
    """Texts are inside the frame, and none is on another."""
    assert sheet.written
    for i, (text, rect) in enumerate(sheet.written):
        assert sheet.frame.contains(rect), f"{text} leaves the frame"
        for other_text, other in sheet.written[:i]:
            assert not rect.colliderect(other), f"{text} overlaps {other_text}"
