"""The game without its drawing: its parts, and how time passes in them.

While aiming, ``shot`` is the path for the current parameters, computed by the worker as they change; otherwise a shot
is watched, paused, or replayed from a recording. ``advance`` passes time and never waits for a run.
"""

from __future__ import annotations

from contextlib import suppress
from typing import Any

from sandbox.errors import RequestError
from sandbox.scene import Scene
from sandbox.window.aiming import Aiming
from sandbox.window.background import PATIENCE, Workers
from sandbox.window.banner import Banner
from sandbox.window.best import BestList
from sandbox.window.contest import AtTask, Contest
from sandbox.window.grasp import Grasp
from sandbox.window.jobs import Jobs
from sandbox.window.memory import Memory
from sandbox.window.messages import Messages, reason
from sandbox.window.opening import Opening
from sandbox.window.path import LATE, LONG, AimedPath
from sandbox.window.referee import Referee
from sandbox.window.session import Session
from sandbox.window.shots import SHOWN, Shot, Shots
from sandbox.window.watching import Watching
from sandbox.window.worker import Packed, computed, unpacked, warm_up
from sandbox.workers import Processes


class Game:
    """A session that is played. Each part has one subject, and knows only those made before it."""

    def __init__(
        self,
        session: Session,
        worker: Processes,
        patience: float = PATIENCE,
        helper: Processes | None = None,
        memory: Memory | None = None,
        best: BestList | None = None,
    ) -> None:
        """A frame waits for the path after a change if that takes no longer than ``patience`` s. ``helper`` computes
        what takes longer than a path, by default the worker itself."""
        self.session = session
        self.workers = Workers(worker, helper or worker, patience)
        self.memory, self.best = memory or Memory(), best or BestList()
        self.messages = Messages()
        self.jobs = Jobs(self.workers, self.messages)
        self.shots = Shots()
        self.watching = Watching(self.shots, self.workers, self.jobs, self.messages)
        self.path = AimedPath(session, self.workers)
        self.aiming = Aiming(session, self.path, self.watching, self.messages, self._opened)
        self.grasp = Grasp(self.aiming)
        self.opening = Opening(self.aiming, self.workers, self.messages, self._opened)
        self.referee = Referee(self.aiming, self.workers, self.messages)
        self.referee.ended = self._contest_ended
        self.banner = Banner(self.referee)
        self.record: Shot | None = None  # the player's best shot at the task that is played, from earlier sessions
        self._recorded: Contest | None = None  # the contest that it is of
        self.place = 0  # of the last score at a task in the best list; 0 for none
        self.running = True
        self.still = 0.0  # s since the shot changed
        self._last: Shot | None = None  # the shot in the frame before
        self.memory.opened(session.source)
        if self.workers.helper is not worker:
            self.workers.helper.submit(warm_up, session.source)
        self.path.follow()
        self._tell_problem()

    @property
    def shot(self) -> Shot | None:
        """The shot as it is watched, or as it is aimed."""
        playback = self.watching.playback
        return playback.shot if playback is not None else self.path.shot

    @property
    def failure(self) -> str | None:
        """The reason why there is no shot that is aimed; until the next good run, or one that takes long."""
        error = self.path.runs.error if self.watching.playback is None and not self.late else None
        return reason(error) if error is not None else None

    @property
    def late(self) -> bool:
        """True if the path that is aimed is long in coming."""
        return self.watching.playback is None and self.path.runs.takes >= LATE

    @property
    def busy(self) -> bool:
        """True if something is being computed, or a shot is playing."""
        playback = self.watching.playback
        playing = playback is not None and playback.playing
        computing = not self.path.settled or bool(self.jobs.waiting)
        return playing or computing or self.referee.busy or self.banner.left > 0.0 or self.opening.loading is not None

    @property
    def ghosts(self) -> list[Shot]:
        """The earlier shots that are drawn with the one that is watched or aimed."""
        shots, playback, before = self.shots, self.watching.playback, self.path.before_save
        if self.session.controls.held:
            return []  # each crosses the whole place
        if self.referee.contest is not None:
            if playback is None and self.referee.contest.takes_marks:
                return []  # they would tell
            place = self.session.place if playback is None else playback.shot.place
            found = [shot for shot in self.referee.shots if shot is not self.shot and shot.place == place][-SHOWN:]
            return [*found, *([self.record] if playback is not None and self.record is not None else [])]
        if playback is not None:
            return shots.earlier(playback.shot.start, but=playback.shot)
        earlier = shots.earlier((self.session.base.folder, *self.session.changes.start))
        return [*([before] if before is not None else []), *earlier]

    @property
    def visible_state(self) -> tuple[Any, ...]:
        """All that can be seen of the game and changes without an event of the window."""
        playback = self.watching.playback
        clock = (playback.t, playback.playing, playback.rate) if playback is not None else None
        shown = self.shot, clock, self.session.changes, self.path.before_save, self.late
        return (
            *shown,
            *self.referee.visible_state,
            self.banner.shows,
            self.failure,
            self.notices,
            len(self.jobs.waiting),
            self.shots.count,
        )

    @property
    def notices(self) -> list[tuple[str, bool]]:
        """The current messages for the player: each text, and whether it is bad. An error stays while it is true."""
        messages, loading, takes = self.messages, self.opening.loading, self.path.runs.takes
        found = [(text, True) for text in (self.failure, messages.unreadable) if text is not None]
        found += [(job.said, False) for job in self.jobs.waiting if job.said]
        if loading is not None and loading.takes >= LATE:
            found.append((f"{loading.said} ...; Esc stops it", False))
        if self.watching.playback is None and takes >= LONG:
            found.append((f"still computing after {takes:.0f} s; Esc stops it", False))
        message = messages.message
        if message is not None and message.text not in (self.failure, messages.unreadable):
            found.append((message.text, message.bad))
        return found

    def advance(self, dt: float, hold: bool = False) -> tuple[float, float]:
        """Pass ``dt`` s; ``hold`` stops the clock of the shot that is watched, while it cannot be seen. Returns the
        times in s between which the shot was played."""
        self.messages.advance(dt)
        files = self.session.watch.saved(dt)
        if files:
            self.opening.reload(files)
        self.opening.take(0.0)
        self._compute(self.workers.patience)
        self._recall()
        self.jobs.advance()
        self.still, self._last = self.still + dt if self.shot is self._last else 0.0, self.shot
        played = (0.0, 0.0) if hold else self.watching.advance(dt)
        self.aiming.end_live()
        self.banner.advance(dt, *played)  # before the shot is counted
        self.referee.advance(dt)
        return played

    def settle(self) -> None:
        """Wait until the shot is that of the parameters: for tests and programs, never in a window."""
        self.opening.take(None)
        while not self.path.settled:
            self._compute(None)

    def _compute(self, patience: float | None) -> None:
        """Run the scene with the current parameters, and take the path that this frame shows. While a scene is loaded,
        the worker has no time for it."""
        self.aiming.take_path(0.0)
        if self.opening.loading is None:
            self.path.follow()
        if patience is None or self.path.is_quick:
            self.aiming.take_path(patience)

    def _recall(self) -> None:
        """Have the best shot at a task computed again once the task begins."""
        contest = self.referee.contest
        if contest is self._recorded:
            return
        self._recorded, self.record = contest, None
        if not isinstance(contest, AtTask):
            return
        best = next(iter(self.best.of(contest.name)), None)
        if best is None or not best.flight:
            return
        with suppress(RequestError):  # the task has changed since
            scene = contest.task.scene.changed(best.flight)
            work = self.workers.helper.submit(computed, scene)
            self.jobs.ask(work, lambda found: self._take_record(contest, scene, found[0]))

    def _take_record(self, contest: Contest, scene: Scene, packed: Packed) -> None:
        if contest is self._recorded:
            self.record = Shot(scene, unpacked(scene, packed), called="your best")

    def stop(self) -> bool:
        """Stop loading a scene or a long run; returns whether there was one."""
        if self.opening.stop():
            return True
        stopped = self.path.stop()
        if stopped:
            self.watching.awaited = False
        return stopped

    def _contest_ended(self, contest: Contest) -> None:
        """Keep the score."""
        kept = contest.kept
        self.place = self.best.add(contest.name, *kept) if kept is not None else 0
        self._tell_problem()

    def _tell_problem(self) -> None:
        """Say once what is wrong with the best list."""
        if self.best.problem:
            self.messages.tell(self.best.problem, bad=True)
            self.best.problem = ""

    def _opened(self) -> None:
        """Start on another scene: only the shots of the one before are kept."""
        self.referee.leave()
        self.watching.stop()
        self.grasp.let_go()
        self.path.forget()
        self.messages.unreadable = None
        self.memory.opened(self.session.source)
