"""The state of the game, without drawing: a scene file and its changes, the resulting shot, the shots so far.

While aiming, ``shot`` is the path for the current parameters, computed by the worker as they change; otherwise a shot
is watched, paused, or replayed from a recording. ``advance`` passes time and never waits for a run.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from pathlib import Path
from typing import Any, NamedTuple

from sandbox.errors import RequestError, RunError
from sandbox.scene.modules import forget
from sandbox.tracebacks import one_line_error
from sandbox.window import replay
from sandbox.window.aim import Pull, strongest
from sandbox.window.background import PATIENCE, Latest
from sandbox.window.handles import Grip
from sandbox.window.history import Changes, History
from sandbox.window.memory import Memory
from sandbox.window.session import Session
from sandbox.window.shots import Playback, Played, Shot, Shots
from sandbox.window.worker import Packed, computed, unpacked, warm_up
from sandbox.workers import Processes, WorkerLost

#: How long a message stays, in s.
MESSAGE = 6.0
#: A run that takes longer than this, in s, can be stopped; it is stopped if its parameters have changed since.
LONG = 2.0
#: From this time on, in s, the path from before is no longer shown as if it were the one that is computed.
LATE = 0.5
#: The fan can be made this many times wider or narrower.
WIDEST = 16.0
#: So many earlier shots are drawn, apart from those that are pinned.
SHOWN = 5


class Message(NamedTuple):
    """A line for the player."""

    text: str
    bad: bool
    left: float  # s that it stays


class Game:
    """A session that is played."""

    def __init__(
        self,
        session: Session,
        worker: Processes,
        patience: float = PATIENCE,
        helper: Processes | None = None,
        memory: Memory | None = None,
    ) -> None:
        """A frame waits for the path after a change if that takes no longer than ``patience`` s. ``helper`` computes
        what takes longer than a path, by default the worker itself."""
        self.session, self.worker, self.patience, self.helper = session, worker, patience, helper or worker
        self.running = True
        self.history = History(session.changes)
        self.runs: Latest[tuple[Packed, float]] = Latest(worker.abandon, LONG)  # of worker.computed
        self.aimed: Shot | None = None  # of the last run that did not fail
        self.shooting = False  # the shot is watched as soon as it is computed
        self.playback: Playback | None = None  # of the shot that is watched; None while aiming
        self.table = Shots()  # all shots
        self.before_save: Shot | None = None  # the shot as it was before the scene file was saved
        self.pull: Pull | None = None
        self.grip: Grip | None = None  # what is dragged, as it was before
        self.before = session.changes  # pull and drag
        self.fan_width = 1.0
        self.still = 0.0  # s since the shot changed
        self.cost = 0.0  # s, of the last run
        self.message: Message | None = None
        self.unreadable: str | None = None  # what is wrong with the files as last saved
        self.memory = memory or Memory()
        self.memory.opened(session.source)
        self.jobs: list[tuple[Future[Any], Callable[[Any], object], str]] = []  # and what they are
        if self.helper is not worker:
            self.helper.submit(warm_up, session.source)
        self._follow()

    # ---------------------------------------------------------------------------------------------------------- state

    @property
    def shot(self) -> Shot | None:
        """The shot as it is watched, or as it is aimed."""
        return self.playback.shot if self.playback is not None else self.aimed

    @property
    def wanted(self) -> tuple[Any, ...]:
        """What is to be run: the key of its run, from which the shot is made."""
        return self.session.scene, self.session.changes

    @property
    def settled(self) -> bool:
        """Whether the shot is that of the current parameters, or is known to have failed."""
        return self.runs.work is None and self.runs.key == self.wanted

    @property
    def failure(self) -> str | None:
        """Why there is no shot that is aimed; until the next good run, or one that takes long."""
        error = self.runs.error if self.playback is None and not self.late else None
        return self.reason(error) if error is not None else None

    @property
    def busy(self) -> bool:
        """Whether something is being computed, or a shot is playing."""
        playing = self.playback is not None and self.playback.playing
        return playing or not self.settled or bool(self.jobs)

    @property
    def holding(self) -> bool:
        """Whether the mouse pulls or drags."""
        return self.pull is not None or self.grip is not None

    @property
    def late(self) -> bool:
        """Whether the path that is aimed is long in coming."""
        return self.playback is None and self.runs.takes >= LATE

    @property
    def recent(self) -> list[Shot]:
        """The shots that are drawn with the one that is aimed."""
        return self.earlier((self.session.base.folder, *self.session.changes.start))

    @property
    def shots(self) -> list[Shot]:
        """Those whose paths are kept, in order."""
        return self.table.paths

    def earlier(self, start: tuple[Any, ...], but: Shot | None = None) -> list[Shot]:
        """The last shots of a scene file that began from the same place, and those that are pinned."""
        alike = [shot for shot in self.shots if shot.start[:2] == start[:2] and shot is not but]
        pinned = [shot for shot in alike if self.table.pinned(shot)]
        return pinned + [shot for shot in alike if shot.start == start and shot not in pinned][-SHOWN:]

    @property
    def seen(self) -> tuple[Any, ...]:
        """All that can be seen of the game and changes without an event of the window."""
        playback = self.playback
        clock = (playback.t, playback.playing, playback.rate) if playback is not None else None
        shown = self.shot, clock, self.session.changes, self.before_save, self.late
        return (*shown, self.failure, self.notices, len(self.jobs), self.table.count)

    @property
    def notices(self) -> list[tuple[str, bool]]:
        """The current messages for the player: each text, and whether it is bad. An error stays while it is true."""
        found = [(text, True) for text in (self.failure, self.unreadable) if text is not None]
        found += [(said, False) for _, _, said in self.jobs if said]
        if self.playback is None and self.runs.takes >= LONG:
            found.append((f"still computing after {self.runs.takes:.0f} s; Esc stops it", False))
        if self.message is not None and self.message.text not in (self.failure, self.unreadable):
            found.append((self.message.text, self.message.bad))
        return found

    def tell(self, text: str, bad: bool = False) -> None:
        """Say something for a while."""
        self.message = Message(text, bad, MESSAGE)

    def trying(self, action: Callable[[], object]) -> bool:
        """Do something that may fail because of the input; a failure is reported and the game continues."""
        try:
            action()
        except Exception as error:
            self.tell(self.reason(error), bad=True)
            return False
        return True

    def reason(self, error: BaseException) -> str:
        """An error in a line or two."""
        if isinstance(error, WorkerLost):
            return "the process that ran it was killed: out of memory?"
        return one_line_error(error)

    # ----------------------------------------------------------------------------------------------------- time passes

    def advance(self, dt: float, hold: bool = False) -> tuple[float, float]:
        """Pass ``dt`` s; ``hold`` stops the clock of the shot that is watched, while it cannot be seen. Returns the
        times in s between which the shot was played."""
        if self.message is not None:
            text, bad, left = self.message
            self.message = Message(text, bad, left - dt) if left > dt else None
        files = self.session.watch.saved(dt)
        if files:
            self._reload(files)
        self.still += dt
        self._compute(self.patience)
        self._finish_jobs()
        if self.playback is None or hold:
            return 0.0, 0.0
        start = self.playback.t
        self.playback.advance(dt)
        return start, self.playback.t

    def settle(self) -> None:
        """Wait until the shot is that of the parameters: for tests and programs, never in a window."""
        while not self.settled:
            self._compute(None)

    def ask(self, result: Future[Any], then: Callable[[Any], object], said: str = "") -> None:
        """Do something with a result once it is there; until then the player is told what is being done."""
        self.jobs.append((result, then, said))

    def stop_jobs(self) -> bool:
        """Stop what the player is told is being done; returns whether there was anything."""
        stopped = [job for job in self.jobs if job[2]]
        for job in stopped:
            self.jobs.remove(job)
            self.helper.abandon(job[0])
        return bool(stopped)

    def _finish_jobs(self) -> None:
        for job in [job for job in self.jobs if job[0].done()]:
            self.jobs.remove(job)
            result, then, _ = job
            if not result.cancelled():
                self.trying(lambda result=result, then=then: then(result.result()))  # type: ignore[misc]

    # ------------------------------------------------------------------------------------------------------- the shot

    def _compute(self, patience: float | None) -> None:
        """Run the scene with the current parameters, and take the path that this frame shows."""
        self._take_run(0.0)
        self._follow()
        if patience is None or (self.cost <= patience and self.aimed is not None):
            self._take_run(patience)

    def _follow(self) -> None:
        """Begin the run of the current parameters."""
        self.runs.follow(self.wanted, lambda key: self.worker.submit(computed, key[0]))

    def _take_run(self, patience: float | None) -> None:
        """Make a shot of the run that has ended."""
        if not self.runs.take(patience):
            return
        if self.runs.key[1].source != self.session.source:  # of the scene before
            self.runs.forget()
            return
        if self.runs.value is not None:
            scene, changes = self.runs.key
            packed, self.cost = self.runs.value
            try:
                self.aimed = shot = Shot(scene, unpacked(scene, packed), changes)
            except Exception as error:
                self.runs.error = error
        if self.runs.error is not None:
            self.shooting = False
            if isinstance(self.runs.error, RequestError):
                self._refuse(self.runs.error)
            return
        self.still = 0.0
        if self.before_save is not None and self.before_save.run.result == shot.run.result:
            self.before_save = None  # saving changed nothing
        if self.shooting and self.settled:
            self._keep(shot)

    def _refuse(self, why: RequestError) -> None:
        """Aim as in the last run if the scene cannot be built from these parameters, such as with balls that
        overlap."""
        good = self.aimed
        if good is None or good.changes.source != self.session.source or not self.settled:
            return
        self.history.replace(good.changes)
        if self._restore(good.changes):
            self.tell(self.reason(why), bad=True)
            if self.session.scene == good.scene:  # and no file was saved since
                self.runs.key, self.runs.error = self.wanted, None

    def stop(self) -> bool:
        """Stop a long run; returns whether there was one."""
        if self.runs.takes < LONG:
            return False
        self.runs.give_up(RunError("stopped: this run did not end; change something to compute it again"))
        self.shooting = False
        return True

    def change(self, values: Mapping[str, Any]) -> bool:
        """Change parameters, and aim with them; returns whether they are valid."""
        if not values:
            return False
        self.aim_again(from_rest=True)
        return self._changing(lambda: self.session.change(values), frozenset(values))

    def _changing(self, action: Callable[[], object], what: object = None, again: bool = False) -> bool:
        """Do something that changes the parameters, of a kind ``what``, or does so ``again``, as undo does; returns
        whether they are valid."""
        base = self.session.base
        if not self.trying(action):
            return False
        if not again:
            self.history.add(self.session.changes, what)
        self.shooting = False
        if self.message is not None and self.message.bad:  # what was refused on the way
            self.message = None
        if self.session.base is not base:
            self._opened()
        return True

    def _restore(self, changes: Changes, again: bool = True) -> bool:
        """Aim with these parameters, maybe of another scene file; returns whether they are valid."""
        return self._changing(lambda: self.session.restore(changes), again=again)

    def reset(self, key: str | None = None) -> None:
        """Take back what was changed in the window: one parameter, or all of them."""
        self.aim_again()
        if self._changing(lambda: self.session.reset(key)) and key is None:
            self.tell("all parameters as in the file; Ctrl Z to undo")

    def undo(self) -> None:
        """Take back the last change, or the shot that is watched."""
        self._go_to(self.history.undone(self.playback is not None), "nothing to undo")

    def redo(self) -> None:
        """Do again what was undone."""
        self._go_to(self.history.redone, "nothing to redo")

    def _go_to(self, place: int | None, nothing: str) -> None:
        """Aim, or shoot, with the parameters of another step of the history."""
        self.aim_again()
        if place is None:
            self.tell(nothing)
            return
        step, again = self.history.steps[place], place > self.history.now
        if self._restore(step.changes):
            self.history.now = place
            shot = next((shot for shot in self.shots if shot.number == step.shot), None)
            if again and shot is not None:
                self.watch(shot)

    def begin_again(self) -> None:
        """Put the balls back where the first of the continued shots began."""
        if not self.session.changes.positions:
            self.tell("the balls are already where they began")
            return
        self.aim_again()
        if self._changing(self.session.begin_again):
            self.tell("the balls are back where they began; Ctrl Z to undo")

    # Aiming by hand

    def begin_pull(self, at: tuple[int, int], height: float, stretch: float) -> None:
        """The mouse begins a pull at a place (px) on a stage of ``height`` px."""
        self._take_hold()
        self.pull = Pull(at, strongest(self.session), height, stretch)

    def pull_to(self, at: tuple[int, int]) -> None:
        """The mouse pulls as far as a place (px)."""
        if self.pull is None:
            return
        self.pull.vector = float(at[0] - self.pull.start[0]), float(at[1] - self.pull.start[1])
        values = self.pull.changes(self.session)
        if values is not None:
            self.change(values)

    def begin_drag(self, grip: Grip) -> None:
        """The mouse takes hold of something in the picture."""
        self._take_hold()
        self.grip = grip

    def _take_hold(self) -> None:
        self.history.end()
        self.before = self.session.changes

    def drag_to(self, place: tuple[float, float], step: float, grip: Grip | None = None) -> None:
        """Move what is held, or ``grip``, to a place, as far as that is possible."""
        grip = grip or self.grip
        if grip is not None:
            values = grip.changes(place, step)
            self._changing(lambda: self.session.change(values), frozenset(values))

    def release(self) -> None:
        """The mouse lets go: a pull that is long enough is a shot."""
        pull, self.pull, self.grip = self.pull, None, None
        self.history.end()
        if pull is not None and pull.shoots:
            self.shoot()

    def give_up_pull(self) -> None:
        """Aim as before the pull or the drag."""
        if self.holding:
            self.pull = self.grip = None
            self._restore(self.before)
            self.history.cancel(self.before)

    # Shooting and watching

    def shoot(self) -> None:
        """Let go: the shot is watched, as soon as it is computed."""
        self.pull, self.grip, self.shooting = None, None, True
        if self.settled:
            self.shooting = False
            if self.aimed is not None and self.failure is None:
                self._keep(self.aimed)

    def _keep(self, shot: Shot) -> None:
        """Count a shot, and watch it."""
        shot = self.table.add(shot, self.session.title)
        self.history.add(self.session.changes, shot=shot.number)
        self.watch(shot)

    def watch(self, shot: Shot) -> None:
        """Play one of the shots so far from its start."""
        self.still, self.shooting = 0.0, False
        self.playback = Playback(shot, self.playback.rate if self.playback is not None else 1.0)

    def watch_other(self, by: int) -> None:
        """Play the shot ``by`` places after the one that is watched."""
        if not self.shots:
            self.tell("no shots yet: pull back and let go")
            return
        now = self.shots.index(self.shot) if self.shot in self.shots else len(self.shots)
        self.watch(self.shots[min(max(now + by, 0), len(self.shots) - 1)])

    def aim_as(self, row: Played) -> None:
        """Aim with the parameters of an earlier shot."""
        self.aim_again()
        if self._restore(row.changes, again=False):
            self.tell(f"aimed as shot {row.number}: {row.verdict}")

    def pin(self, row: Played) -> None:
        """Keep the path of a shot, which is computed again if it was dropped; or keep it no longer."""

        def then(result: tuple[Packed, float]) -> None:
            row.shot = Shot(row.scene, unpacked(row.scene, result[0]), row.changes, row.number)

        self.table.pin(row)
        if row.pinned and row.shot is None:
            self.ask(self.helper.submit(computed, row.scene), then)

    def aim_again(self, from_rest: bool = False) -> None:
        """Stop watching a shot; with ``from_rest``, if it is over, the next begins where the balls came to rest."""
        playback, self.playback = self.playback, None
        if playback is None:
            return
        self.still = 0.0
        ours = playback.shot.changes.source == self.session.source
        goes_on = from_rest and playback.over and ours and self.session.controls.next_start is not None
        if goes_on and self._changing(lambda: self.session.start_from(playback.shot)):
            self.tell("from where the balls rest; B puts them back where they began")

    # ----------------------------------------------------------------------------------------------------- scene files

    def open(self, source: str) -> None:
        """Play another scene or preset, or watch a replay."""
        if source.endswith(replay.SUFFIX):
            self.trying(lambda: self.open_replay(Path(source)))
        else:
            self._changing(lambda: self.session.open(source))

    def open_replay(self, path: Path, scene: str | None = None) -> None:
        """Watch a recorded shot, of ``scene`` if that is given. Raises RequestError."""
        self.session, shot = replay.read(path, scene, self.session.base.folder)
        self._opened()
        self._keep(shot)
        self.tell(f"{path}: as it was recorded; F6 computes it again")

    def _opened(self) -> None:
        """Start on another scene: only the shots of the one before are kept."""
        self.playback = self.pull = self.grip = self.before_save = self.unreadable = None
        self.shooting = False
        self.runs.forget()
        self.memory.opened(self.session.source)

    def _reload(self, files: list[Path]) -> None:
        """Files were saved: aim with them, with the path from before still drawn."""
        before, folder = self.shot, self.session.base.folder
        code = any(file.suffix == ".py" for file in files)
        try:
            self.session.reload(code)
        except Exception as error:
            self.unreadable, self.message = self.reason(error), None
            return
        if code:
            for processes in {self.worker, self.helper}:
                processes.submit(forget, folder)
        self.unreadable = None
        if self.session.base.folder != folder:
            self._opened()
            self.history.add(self.session.changes)
        else:
            self.aim_again()
            self.before_save = before if not self.settled else None
        self.tell(f"read {', '.join(str(file) for file in files)} again")

    def compare(self, shot: Shot) -> None:
        """Compute a shot again, and report how far apart the two are."""

        def then(result: tuple[Packed, float]) -> None:
            self.tell(replay.compared(shot.run, unpacked(shot.scene, result[0])))

        self.ask(self.helper.submit(computed, shot.scene), then)

    def nudge(self, values: Mapping[str, Any]) -> bool:
        """Change what a player aims with, by key or wheel; not while a shot is watched."""
        if self.playback is not None:
            self.tell("Enter to aim again")
            return False
        return self.change(values)
