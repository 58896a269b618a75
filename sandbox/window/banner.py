"""The banner: the verdict of a shot in large letters, for a moment when it is decided."""

from __future__ import annotations

from sandbox.window.referee import Referee, known_at
from sandbox.window.shots import Shot

#: How long it stays, in s of the window's clock, however slowly the shot is watched.
LASTS = 1.0


class Banner:
    """Holds the verdict that is shown, as long as it is."""

    def __init__(self, referee: Referee) -> None:
        self.referee, self.watching, self.messages = referee, referee.watching, referee.messages
        self.call: tuple[str, bool | None] = "", None  # the verdict, and whether it is good, where that was the task
        self.left = 0.0  # s that it stays
        self._shot: Shot | None = None  # the one that was watched last
        self._at = 0.0  # s: when its verdict is known

    @property
    def shows(self) -> bool:
        """True if it is shown: not where the end of a contest says all."""
        referee = self.referee
        return self.left > 0.0 and not (referee.is_over and referee.tells and referee.again != "slow")

    def advance(self, dt: float, start: float, end: float) -> None:
        """``dt`` s have passed, in which the shot was played from ``start`` to ``end``, in s of its own clock."""
        self.left = max(0.0, self.left - dt)
        playback = self.watching.playback
        if playback is None or playback.shot is not self._shot:
            self.left = 0.0
        if playback is None or end <= start or self.watching.live is not None:
            return
        shot = playback.shot
        if shot is not self._shot:
            self._shot, self._at = shot, shot.run.duration
            self.messages.reporting_errors(lambda: self._find(shot))
        if start < self._at <= end:
            self.messages.reporting_errors(lambda: self._show(shot))

    def _find(self, shot: Shot) -> None:
        """Find out when the verdict of a shot is known."""
        contest = self.referee.contest
        known = contest.decided_at(shot.run) if contest is not None else None
        self._at = known_at(shot) if known is None else known

    def _show(self, shot: Shot) -> None:
        """Show the verdict of a shot: in a contest of the one that counts, else of any in a scene where shots can
        score. Outside a contest one that does not score, such as a drive, is no miss."""
        contest = self.referee.contest
        if contest is None and shot.scene.controls.scores:
            self.call, self.left = (shot.verdict, shot.scored or None), LASTS
        elif contest is not None and self.referee.pending is shot:
            self.call, self.left = contest.call(shot.run), LASTS
