"""The playback clock of a shot that is being watched."""

from __future__ import annotations

from sandbox.window.shots import Shot

RATES = (1 / 16, 1 / 8, 1 / 4, 1 / 2, 1.0, 2.0, 4.0, 8.0)
STEP = 1 / 60  # s of the shot, for one step by hand
#: Longest time in s that one frame moves the clock at rate 1: a late frame slows the shot down instead of skipping.
LONGEST_FRAME = 1 / 30


class Playback:
    """The current time in a shot."""

    def __init__(self, shot: Shot, rate: float) -> None:
        self.shot, self.duration, self.rate = shot, shot.run.duration, rate
        self.t, self.playing = 0.0, True

    @property
    def over(self) -> bool:
        return self.t >= self.duration

    def advance(self, dt: float) -> None:
        """``dt`` s of real time have passed."""
        if self.playing:
            self.seek(self.t + min(dt, LONGEST_FRAME) * self.rate)
            self.playing = not self.over

    def toggle(self) -> None:
        """Pause, resume, or start again at the end."""
        if self.over:
            self.restart()
        else:
            self.playing = not self.playing

    def step(self, steps: int) -> None:
        self.playing = False
        self.seek(self.t + steps * STEP)

    def restart(self) -> None:
        self.t, self.playing = 0.0, True

    def seek(self, t: float) -> None:
        self.t = min(max(t, 0.0), self.duration)

    def change_rate(self, by: int) -> None:
        index = RATES.index(self.rate) + by
        self.rate = RATES[min(max(index, 0), len(RATES) - 1)]
