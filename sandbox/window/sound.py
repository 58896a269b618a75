"""Synthesised sound: a short knock at every impact, louder with speed; three notes that rise for a success, and two
that fall, softly, for a miss. Without a sound device there is none."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import numpy as np
import pygame

_RATE = 44100  # samples per second
_LONGEST = 0.16  # s
#: Speed in m/s of the loudest knock, and one so slow that it is not heard.
_LOUD, _QUIET = 20.0, 0.15
#: Pitch in Hz of a knock against a fixed thing, and against a ball.
DULL, _BRIGHT = 210.0, 1250.0
#: The notes of a success in Hz (C, E and G) and of a miss (E flat and C), how far apart they begin, in s, and how long
#: they sound; and how loud a miss is.
_GOOD, _BAD, _APART, _CHIME = (523.25, 659.25, 783.99), (155.56, 130.81), 0.09, 0.9
_SOFTLY = 0.5


def knock(pitch: float) -> np.ndarray:
    """A struck body: two partials that die away under a click of noise; 16 bit, shape (samples, 2)."""
    t = np.arange(round(_RATE * _LONGEST)) / _RATE
    noise = np.random.default_rng(1).standard_normal(len(t))
    wave = np.sin(2 * np.pi * pitch * t) * np.exp(-t * 38) + 0.5 * np.sin(2 * np.pi * 2.76 * pitch * t) * np.exp(
        -t * 70
    )
    wave += 0.35 * noise * np.exp(-t * 260)
    wave *= 1 - np.exp(-t * 4000)  # starts without a click
    samples = np.round(wave / np.abs(wave).max() * 0.7 * 32767).astype(np.int16)
    return np.ascontiguousarray(np.column_stack([samples, samples]))


def _chime(notes: Sequence[float]) -> np.ndarray:
    """Notes (Hz), one after the other, each a bell that dies away; 16 bit, shape (samples, 2)."""
    t = np.arange(round(_RATE * _CHIME)) / _RATE
    wave = np.zeros_like(t)
    for number, pitch in enumerate(notes):
        after = np.maximum(t - number * _APART, 0.0)
        note = np.sin(2 * np.pi * pitch * after) + 0.3 * np.sin(4 * np.pi * pitch * after)
        wave += note * np.exp(-after * 6) * (1 - np.exp(-after * 800))
    samples = np.round(wave / np.abs(wave).max() * 0.5 * 32767).astype(np.int16)
    return np.ascontiguousarray(np.column_stack([samples, samples]))


@contextmanager
def _no_stderr() -> Iterator[None]:
    """Hide what libraries write to stderr: ALSA reports each device that it does not find."""
    try:
        saved, nothing = os.dup(2), os.open(os.devnull, os.O_WRONLY)
    except OSError:  # stderr is closed
        yield
        return
    try:
        os.dup2(nothing, 2)
        yield
    finally:
        os.dup2(saved, 2)
        os.close(saved)
        os.close(nothing)


class Sound:
    """The loudspeaker, if there is one."""

    def __init__(self) -> None:
        self.knocks: list[pygame.mixer.Sound] = []
        self.chimes: list[pygame.mixer.Sound] = []  # of a miss, and of a success
        try:
            with _no_stderr():
                pygame.mixer.init(_RATE, -16, 2, 512)
            self.knocks = [pygame.sndarray.make_sound(knock(pitch)) for pitch in (DULL, _BRIGHT)]
            self.chimes = [pygame.sndarray.make_sound(_chime(notes)) for notes in (_BAD, _GOOD)]
            self.chimes[False].set_volume(_SOFTLY)
        except (pygame.error, NotImplementedError, ImportError):
            pass
        self.there = bool(self.knocks)  # whether there is a device
        self.on = self.there

    def impact(self, speed: float, of_balls: bool) -> None:
        """An impact at a normal speed in m/s."""
        if not self.on or not self.knocks or speed < _QUIET:
            return
        knock = self.knocks[of_balls]
        knock.set_volume(min(1.0, (speed / _LOUD) ** 0.7))
        knock.play()

    def verdict(self, good: bool) -> None:
        """A shot that a contest counts as a success, or as none."""
        if self.on and self.chimes:
            self.chimes[good].play()
