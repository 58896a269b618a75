"""Opening scenes, presets and replays, and reading saved files again: first in a worker process, with a time limit,
since a scene's code may never end."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import wait as wait_for
from pathlib import Path
from time import perf_counter
from typing import NamedTuple

from sandbox.errors import RunError
from sandbox.scene.discovery import folder_of, is_installed
from sandbox.scene.modules import forget
from sandbox.window import replay
from sandbox.window.aiming import Aiming
from sandbox.window.background import Workers
from sandbox.window.messages import Messages
from sandbox.window.worker import checked, checked_replay

#: Loading a scene that takes longer than this, in s, is given up; one that came with the sandbox ends, and is slow only
#: where the machine is.
LOADING, _LOADING_INSTALLED = 10.0, 120.0


def limit_of(folder: Path | None) -> float:
    """The time in s after which loading a scene is given up."""
    return _LOADING_INSTALLED if folder is not None and is_installed(folder) else LOADING


class _Loading(NamedTuple):
    """A scene on its way: the worker loads and builds it first."""

    work: Future[None]
    then: Callable[[], object]  # what the window does with it
    failed: Callable[[BaseException], object]
    said: str
    began: float  # perf_counter, in s
    limit: float  # in s, after which it is given up
    again: bool  # the same scene, whose files were saved

    @property
    def takes(self) -> float:
        """For how long it has been going on, in s."""
        return perf_counter() - self.began


class Opening:
    """Holds the scene that is being loaded."""

    def __init__(self, aiming: Aiming, workers: Workers, messages: Messages, opened: Callable[[], object]) -> None:
        """``opened`` is called when a replay has been opened."""
        self.aiming, self.workers, self.messages, self.opened = aiming, workers, messages, opened
        self.session, self.path, self.watching = aiming.session, aiming.path, aiming.watching
        self.loading: _Loading | None = None

    def open(self, source: str) -> None:
        """Play another scene or preset, or watch a replay."""

        def open_scene() -> None:
            self.aiming.changing(lambda: self.session.open(source))

        def open_replay() -> None:
            self.messages.reporting_errors(lambda: self.open_replay(Path(source)))

        if source.endswith(replay.SUFFIX):
            path, running = Path(source).absolute(), self.session.base.folder
            work, then = self.workers.path.submit(checked_replay, path, None, running), open_replay
        else:
            work, then = self.workers.path.submit(checked, source, {}), open_scene
        self._load(work, then, self.messages.tell_error, source, limit_of(folder_of(source)))

    def open_replay(self, path: Path, scene: str | None = None) -> None:
        """Watch a recorded shot, of ``scene`` if that is given. Raises RequestError."""
        shot = replay.read(path, scene, self.session.base.folder)
        self.session.open(shot.changes.source, shot.changes.values)
        self.opened()
        self.aiming.keep(shot)
        self.messages.tell(f"{path}: as it was recorded; F6 computes it again")

    def reload(self, files: list[Path]) -> None:
        """Files were saved: aim with them, with the path from before still drawn."""
        code = any(file.suffix == ".py" for file in files)
        names, changes = ", ".join(str(file) for file in files), self.session.changes
        work = self.workers.path.submit(checked, changes.source, changes.values, self.session.base.folder, code)
        self._load(work, lambda: self._read_again(names, code), self.messages.files_are_bad, names, LOADING, again=True)

    def _read_again(self, names: str, code: bool) -> None:
        """Read saved files in the window, too."""
        playback, folder = self.watching.playback, self.session.base.folder
        before = playback.shot if playback is not None else self.path.shot
        try:
            self.session.reload(code)
        except Exception as error:
            self.messages.files_are_bad(error)
            return
        if code and self.workers.helper is not self.workers.path:
            self.workers.helper.submit(forget, folder)
        self.messages.unreadable = None
        self.messages.forget_error()
        if self.session.base.folder != folder:
            self.opened()
            self.aiming.history.add(self.session.changes)
        else:
            self.aiming.again()
            self.path.before_save = before if not self.path.settled else None
        self.messages.tell(f"read {names} again")

    def _load(
        self,
        work: Future[None],
        then: Callable[[], object],
        failed: Callable[[BaseException], object],
        what: str,
        limit: float,
        again: bool = False,
    ) -> None:
        """Do something with a scene once the worker has loaded it; or say why it could not be."""
        if self.loading is not None:  # of what is no longer wanted
            self.workers.path.abandon(self.loading.work)
        self.loading = _Loading(work, then, failed, f"loading {what}", perf_counter(), limit, again)
        self.take(self.workers.patience)

    def take(self, patience: float | None) -> None:
        """Go on with the scene if it is loaded within ``patience`` s (None: wait), or give it up if that takes too
        long."""
        loading = self.loading
        if loading is None:
            return
        self.path.give_way()
        if not wait_for([loading.work], loading.limit if patience is None else patience).done:
            if loading.takes > loading.limit:
                self._give_up(f"given up after {loading.limit:.0f} s: does its code ever end?")
            return
        self.loading, error = None, loading.work.exception()
        if error is None:
            loading.then()
        else:
            loading.failed(error)

    def stop(self) -> bool:
        """Stop loading; returns whether anything was being loaded."""
        there = self.loading is not None
        if there:
            self._give_up("stopped")
        return there

    def _give_up(self, why: str) -> None:
        assert self.loading is not None
        loading, self.loading = self.loading, None
        self.workers.path.abandon(loading.work)
        loading.failed(RunError(f"{loading.said}: {why}"))
