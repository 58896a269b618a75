"""For those who see less, or other colours, or use no mouse."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pygame
import pytest

from sandbox.picture.palette import mix, palette, set_contrast
from sandbox.window.commands import TABLE
from sandbox.window.memory import Memory

CARD, TRACE = palette("card"), palette("trace")["colours"]

#: How colours are seen without one kind of cone: linear RGB (Machado, Oliveira & Fernandes 2009, severity 1.0).
SEEN = {
    "protan": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deutan": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritan": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
#: Colours of sRGB under D65.
XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])
WHITE = XYZ.sum(axis=1)


def linear(colour) -> np.ndarray:
    values = np.array(colour) / 255
    return np.where(values <= 0.04045, values / 12.92, ((values + 0.055) / 1.055) ** 2.4)


def lab(light: np.ndarray) -> np.ndarray:
    """CIE L*a*b* of linear RGB."""
    x, y, z = np.cbrt(XYZ @ np.clip(light, 0, 1) / WHITE)
    return np.array([116 * y - 16, 500 * (x - y), 200 * (y - z)])


def contrast(a, b) -> float:
    """The contrast of two colours by WCAG 2."""
    low, high = sorted(float(XYZ[1] @ linear(colour)) for colour in (a, b))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("high", [False, True])
@pytest.mark.parametrize("kind", SEEN)
def test_colours_that_mean_something_differ_for_everyone(kind, high):
    set_contrast(high)
    missed = mix(CARD["background"], CARD["quiet"], 0.3)
    pairs = [*combinations([CARD["good"], CARD["bad"], missed], 2), (CARD["good"], CARD["text"])]
    pairs += [(CARD["accent"], CARD["text"]), *combinations(TRACE, 2)]
    for a, b in pairs:
        seen = [lab(np.array(SEEN[kind]) @ linear(colour)) for colour in (a, b)]
        assert np.linalg.norm(seen[0] - seen[1]) > 15, (a, b)


def test_text_stands_out_and_more_so_with_high_contrast():
    for high, least in ((False, 4.5), (True, 7.0)):
        set_contrast(high)
        for name in ("text", "quiet", "accent", "good", "bad"):
            if high or name != "bad":  # a stripe, no text
                assert contrast(CARD[name], CARD["background"]) > least, name


def test_letters_and_contrast_are_changed_by_key_and_remembered(player, tmp_path):
    player = player("golf/putt", (1000, 600))
    player.game.memory = Memory(tmp_path / "window.json")
    player.key(pygame.K_TAB)
    before = player.sheet.lettering.pixels["small"]
    line = player.view.panel.places[0][0].height
    for _ in range(2):
        player.press_named("alt +")
    player.press_named("alt c")
    player.settle()
    assert player.sheet.lettering.pixels["small"] == pytest.approx(1.3 * before, abs=1)
    assert CARD["background"] == (0, 0, 0)
    assert player.view.panel.places[0][0].height > line
    assert Memory(player.game.memory.file).look == (1.3, True)
    player.press_named("alt c")
    player.settle()
    assert CARD["background"] != (0, 0, 0)


def test_every_command_has_a_key():
    assert all(command.keys for command in TABLE)
