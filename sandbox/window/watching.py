"""Watching: the clock of the shot that is watched, and which of the shots so far that is."""

from __future__ import annotations

from sandbox.scene import Scene
from sandbox.window.background import Workers
from sandbox.window.history import Changes
from sandbox.window.jobs import Jobs
from sandbox.window.live import Live
from sandbox.window.messages import Messages
from sandbox.window.replay import compared
from sandbox.window.shots import Playback, Played, Shot, Shots
from sandbox.window.worker import Packed, computed, unpacked


class Watching:
    """Holds the playback of the shot that is watched."""

    def __init__(self, shots: Shots, workers: Workers, jobs: Jobs, messages: Messages) -> None:
        self.shots, self.workers, self.jobs, self.messages = shots, workers, jobs, messages
        self.playback: Playback | None = None  # None while aiming
        self.awaited = False  # the aimed shot is watched as soon as it is computed

    def watch(self, shot: Shot) -> None:
        """Play one of the shots so far from its start."""
        self.awaited = False
        self.playback = Playback(shot, self.playback.chosen if self.playback is not None else None)

    @property
    def live(self) -> Live | None:
        """The shot that is played live, if one is."""
        return self.playback if isinstance(self.playback, Live) else None

    def play(self, scene: Scene, changes: Changes) -> None:
        """Begin to play a shot live."""
        self.awaited, self.playback = False, Live(scene, changes)

    def hold(self, key: str, down: bool) -> bool:
        """The player presses a key, or lets it go; returns whether it moves something in what is played live."""
        return self.live is not None and self.live.hold(key, down)

    def watch_other(self, by: int) -> None:
        """Play the shot ``by`` places after the one that is watched; after the last one if none is."""
        paths = self.shots.paths
        if not paths:
            self.messages.tell("no shots yet: pull back and let go")
            return
        watched = self.playback.shot if self.playback is not None else None
        now = paths.index(watched) if watched in paths else len(paths)
        self.watch(paths[min(max(now + by, 0), len(paths) - 1)])

    def stop(self) -> None:
        """Watch no shot, and wait for none."""
        self.playback, self.awaited = None, False

    def pin(self, row: Played) -> None:
        """Keep the path of a shot, which is computed again if it was dropped; or keep it no longer."""

        def then(result: tuple[Packed, float]) -> None:
            row.shot = Shot(row.scene, unpacked(row.scene, result[0]), row.changes, row.number)

        self.shots.pin(row)
        if row.pinned and row.shot is None:
            self.jobs.ask(self.workers.helper.submit(computed, row.scene), then)

    def compare(self, shot: Shot) -> None:
        """Compute a shot again, and report how far apart the two are."""

        def then(result: tuple[Packed, float]) -> None:
            self.messages.tell(compared(shot.run, unpacked(shot.scene, result[0])))

        self.jobs.ask(self.workers.helper.submit(computed, shot.scene), then)

    def advance(self, dt: float) -> tuple[float, float]:
        """Pass ``dt`` s; returns the times in s between which the shot was played."""
        if self.playback is None:
            return 0.0, 0.0
        start = self.playback.t
        self.playback.advance(dt)
        return start, self.playback.t
