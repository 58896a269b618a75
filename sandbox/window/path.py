"""The path of the shot that is aimed: computed by a worker process whenever the parameters change."""

from __future__ import annotations

from typing import Any

from sandbox.errors import RequestError, RunError
from sandbox.window.background import LatestJob, Workers
from sandbox.window.session import Session
from sandbox.window.shots import Shot
from sandbox.window.worker import Packed, computed, unpacked

#: A run that takes longer than this, in s, can be stopped; it is stopped if its parameters have changed since.
LONG = 2.0
#: From this time on, in s, the path from before is no longer shown as if it were the one that is computed.
LATE = 0.5


class AimedPath:
    """Holds the last shot that could be computed for the parameters of a session, and the run that is under way."""

    def __init__(self, session: Session, workers: Workers) -> None:
        self.session, self.workers = session, workers
        self.runs: LatestJob[tuple[Packed, float]] = LatestJob(workers.path.abandon, LONG)  # of worker.computed
        self.shot: Shot | None = None  # of the last run that did not fail
        self.before_save: Shot | None = None  # the shot as it was before the scene file was saved
        self.cost = 0.0  # s, of the last run

    @property
    def next_key(self) -> tuple[Any, ...]:
        """The run that is wanted: the key of its run, from which the shot is made."""
        return self.session.scene, self.session.changes

    @property
    def settled(self) -> bool:
        """True if the shot is that of the current parameters, or is known to have failed."""
        return self.runs.work is None and self.runs.key == self.next_key

    @property
    def is_quick(self) -> bool:
        """True if a frame can wait for the path."""
        return self.cost <= self.workers.patience and self.shot is not None

    def follow(self) -> None:
        """Begin the run of the current parameters, unless it was made or another has not ended yet."""
        self.runs.follow(self.next_key, lambda key: self.workers.path.submit(computed, key[0]))

    def take(self, patience: float | None) -> bool:
        """Make a shot of the run that has ended within ``patience`` s (None: wait); returns whether one has, which may
        have failed."""
        runs = self.runs
        if not runs.take(patience):
            return False
        scene, changes = runs.key
        if changes.source != self.session.source:  # of the scene before
            runs.forget()
            return False
        if runs.value is not None:
            packed, self.cost = runs.value
            try:
                self.shot = Shot(scene, unpacked(scene, packed), changes)
            except Exception as error:
                runs.error = error
        before = self.before_save
        if runs.error is None and before is not None and self.shot and before.run.result == self.shot.run.result:
            self.before_save = None  # saving changed nothing
        return True

    @property
    def refusal(self) -> RequestError | None:
        """The reason why the scene cannot be built from the current parameters, such as balls that overlap, if it could
        be from those of the shot."""
        good, error = self.shot, self.runs.error
        if good is None or good.changes.source != self.session.source or not self.settled:
            return None
        return error if isinstance(error, RequestError) else None

    def is_refused(self) -> None:
        """Take the current parameters, which are those of the shot again, as computed; the reason is known."""
        if self.shot is not None and self.session.scene == self.shot.scene:  # and no file was saved since
            self.runs.key, self.runs.error = self.next_key, None

    def stop(self) -> bool:
        """Stop a long run; returns whether there was one."""
        if self.runs.takes < LONG:
            return False
        self.runs.give_up(RunError("run cancelled: change a parameter to rerun"))
        return True

    def give_way(self) -> None:
        """End a long run that keeps the worker from what is wanted now."""
        if self.runs.takes > LONG:
            self.runs.give_up(None)

    def forget(self) -> None:
        """Drop what is of the scene before."""
        self.before_save = None
        self.runs.forget()
