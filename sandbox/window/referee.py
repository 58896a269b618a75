"""The referee of a contest: puts up each shot, has it computed with the noise of the player's aim, counts it once it is
over, shows what decided it again, and at the end the best of all."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

from sandbox.errors import SandboxError
from sandbox.scene import Scene, deciding
from sandbox.window.aiming import Aiming
from sandbox.window.background import Workers
from sandbox.window.contest import AtMatch, Contest, source_of
from sandbox.window.history import History
from sandbox.window.messages import Messages
from sandbox.window.opponent import Opponent
from sandbox.window.shots import STEP, Shot
from sandbox.window.worker import computed, unpacked

#: What decided a shot is shown again from so long before it, in s, this much slower, until so long after it.
_BEFORE, _SLOWER, AFTER = 0.5, 0.25, 0.2
#: How long a success glows, in s, and how long the end of each of the best shots stays.
GLOW, _PAUSE = 1.6, 1.2
#: What a player is told who would shoot for the computer.
COMPUTER = "the computer has this shot"


class Referee:
    """Holds the contest, its shots, and the one that is on its way."""

    def __init__(self, aiming: Aiming, workers: Workers, messages: Messages) -> None:
        self.aiming, self.workers, self.messages = aiming, workers, messages
        self.session, self.path, self.watching = aiming.session, aiming.path, aiming.watching
        self.contest: Contest | None = None
        self.ended: Callable[[Contest], object] = lambda contest: None  # called once at the end of each contest
        self.shots: list[Shot] = []
        self.work: Future[Any] | None = None  # that computes the shot
        self.pending: Shot | None = None  # it is watched, and not counted yet
        self.decided = 0.0  # s: when what is watched is decided
        self.again = ""  # what is shown again: nothing; "slow", then "still", what decided a success; one of the "best"
        self.opponent: Opponent | None = None  # that looks for its shot
        self.glow = 0.0  # s that a success goes on glowing
        self.calls: list[bool] = []  # verdicts that were not heard yet: whether each is a success
        self._cheered, self._scores = False, False  # whether the verdict was heard, and is a success
        self._scene: Any = None  # that of the shot on its way
        self._before: int | None = None  # how many shots there were before it; None: there is none
        self._rested = 0.0  # s since the end of what is shown again
        self._next_best = 0
        aiming.makes_shot, aiming.puts_up_next = self.shoot, self.put_up_next

    @property
    def busy(self) -> bool:
        """True if something goes on by itself."""
        return (
            self.work is not None
            or self.opponent is not None
            or self.pending is not None
            or bool(self.again)
            or self.glow > 0.0
        )

    @property
    def visible_state(self) -> tuple[Any, ...]:
        """All that can be seen of it."""
        marked = (self.contest.mark, self.contest.landed) if self.contest is not None else None
        return self.contest, len(self.shots), self.pending, self.again, self.glow, marked

    @property
    def is_over(self) -> bool:
        """True if all shots are played and counted."""
        return self.contest is not None and self.contest.over

    @property
    def outcome(self) -> str:
        """The result of the shot that is watched: of the last one in the words of the contest."""
        playback = self.watching.playback
        if playback is None or self.contest is None or playback.shot in self.shots[-1:]:
            return self.contest.said if self.contest is not None else ""
        return playback.shot.verdict

    @property
    def tells(self) -> bool:
        """True if goal and scores are shown, or how a shot came out: not while it is on its way."""
        playback = self.watching.playback
        return playback is None or (self.pending is None and (playback.over or bool(self.again)))

    def begin(self, contest: Contest) -> None:
        """Play for something from here on. Raises RequestError for a start that is invalid; then nothing changes."""
        scene = contest.scene
        self.leave()
        self.contest = contest
        self._put_up(scene)

    def leave(self) -> None:
        """Play for nothing."""
        if self.work is not None:
            self.workers.path.abandon(self.work)
        self._dismiss()
        self.contest, self.work, self.pending, self.again, self.glow = None, None, None, "", 0.0
        self._before = None
        self.session.limits, self.shots = None, []

    @property
    def computers_turn(self) -> bool:
        """True if an opponent at the computer has the next shot."""
        return isinstance(self.contest, AtMatch) and self.contest.match.by_computer

    def _dismiss(self) -> None:
        """The opponent looks no longer for a shot."""
        if self.opponent is not None and self.opponent.work is not None:
            self.workers.helper.abandon(self.opponent.work)
        self.opponent = None

    def _let_computer_play(self) -> None:
        """Have the opponent at the computer look for its shot, and then make it."""
        contest, aimed = self.contest, self.path.shot
        if not isinstance(contest, AtMatch) or aimed is None or not self.path.settled:
            return
        if self.opponent is None:
            seed = int(contest.random.integers(2**31))
            self.opponent = Opponent(self.session, contest.match, contest.width, aimed.upright, self.workers, seed)
        self.opponent.advance()
        if self.opponent.values is not None:
            self.aiming.set(self.opponent.values)
            self.opponent = None
            self._submit()

    def _put_up(self, scene: Scene) -> None:
        """Show the next shot, to be aimed."""
        assert self.contest is not None
        self.watching.stop()
        self.path.forget()
        self.again, self.glow = "", 0.0
        self.session.show(scene, source_of(scene), self.contest.limits)
        self.aiming.history = History(self.session.changes)

    def put_up_next(self) -> bool:
        """Go on after a shot; returns whether there is a contest. After its end it begins anew."""
        if self.contest is None:
            return False
        self._count()
        contest = self.contest
        if contest is not None:
            going_on = not contest.over
            self._or_leave(lambda: self._go_on(contest) if going_on else self.begin(contest.anew()))
        return True

    def _go_on(self, contest: Contest) -> None:
        """Put up the next shot of a contest."""
        contest.go_on()
        self._put_up(contest.scene)

    def _or_leave(self, action: Callable[[], object]) -> bool:
        """Do something with the contest, whose rules may be a user's own; one that fails is reported, and ends it."""
        if self.messages.reporting_errors(action):
            return True
        self.leave()
        return False

    def shoot(self) -> bool:
        """Have the shot that is aimed computed, or play it live; returns whether there is a contest."""
        contest = self.contest
        if contest is None:
            return False
        if self.work is not None or self.watching.playback is not None or contest.over:
            return True
        if self.computers_turn or contest.missing:
            self.messages.tell(COMPUTER if self.computers_turn else contest.missing)
            return True
        self._submit()
        return True

    def _submit(self) -> None:
        """Have the shot that is aimed computed, or play it live."""
        contest = self.contest
        assert contest is not None
        self._scene, self._before = contest.aimed(self.session.scene), self.watching.shots.count
        if self.session.controls.held:
            scene, changes = self._scene, self.session.changes
            self.messages.reporting_errors(lambda: self.watching.play(scene, changes))
        else:
            self.work = self.workers.path.submit(computed, self._scene)

    def advance(self, dt: float) -> None:
        """``dt`` s have passed."""
        self.glow = max(0.0, self.glow - dt)
        if self.work is not None and self.work.done():
            self._take()
        playback = self.watching.playback
        if self.computers_turn and playback is None and self.work is None:
            self._or_leave(self._let_computer_play)
        if self.contest is None or playback is None:
            return
        if self._before is not None and playback.shot.number > self._before and self.watching.live is None:
            self._accept(playback.shot)
        if self.pending is not None and playback.t >= self.decided and not self._cheered:
            self._cheer()
        if self.pending is not None and playback.over and not (self._scores and playback.moves_on):
            self._count()  # a success once the camera has seen all of it
        elif self.again == "slow" and playback.t >= min(self.decided + AFTER, playback.duration):
            playback.playing, self.again, self.glow = False, "still", GLOW
        if self.is_over and self.pending is None and self.again != "slow":
            self._show_best(dt)

    def _take(self) -> None:
        """Watch the shot that was computed."""
        work, scene, self.work = self.work, self._scene, None
        assert work is not None
        try:
            run = unpacked(scene, work.result()[0])
        except SandboxError as error:
            self.messages.tell_error(error)
            return
        self.aiming.keep(Shot(scene, run, self.session.changes))

    def _accept(self, shot: Shot) -> None:
        """A shot of the contest is watched for the first time."""
        self.shots.append(shot)
        known = self.contest.decided_at(shot.run) if self.contest is not None else None
        self.decided = decided_at(shot) if known is None else known
        self._before, self.pending, self._cheered, self._scores = None, shot, False, False

    def _cheer(self) -> None:
        """A verdict is heard, and a success glows."""
        assert self.pending is not None
        self._cheered = True
        contest, run = self.contest, self.pending.run
        found: list[bool] = []
        if contest is not None and self._or_leave(lambda: found.append(contest.would_score(run))):
            self.calls += found
            self._scores = found[0]
            self.glow = GLOW if self._scores else 0.0

    def _count(self) -> None:
        """Count the shot, and show what decided it again if it is a success."""
        shot, self.pending, playback = self.pending, None, self.watching.playback
        contest = self.contest
        if shot is None or contest is None or not self._or_leave(lambda: contest.record(shot.run)):
            return
        if contest.good and playback is not None and playback.shot is shot and self.watching.live is None:
            self.again = "slow"
            playback.seek(self.decided - _BEFORE)
            playback.rate, playback.playing = _SLOWER * min(1.0, playback.rate), True
        if contest.over:
            self._rested, self._next_best = 0.0, 0
            self.ended(contest)

    def _show_best(self, dt: float) -> None:
        """At the end: show the best shots again, one after the other, the best last."""
        assert self.contest is not None
        playback, best = self.watching.playback, self.contest.best_shots
        if playback is None or playback.playing or self._next_best >= len(best):
            return
        self._rested += dt
        if self._rested >= _PAUSE:
            self._rested = 0.0
            self.watching.watch(self.shots[best[::-1][self._next_best]])
            self._next_best, self.again = self._next_best + 1, "best"


def deciding_ball(shot: Shot, decided: float) -> str:
    """The ball that decides a shot at a time in s: one that a trap takes then, or else the one that is played."""
    return next((e.ball for e in shot.run.events if e.kind == "caught" and abs(e.t - decided) < STEP), shot.ball)


def decided_at(shot: Shot) -> float:
    """The time in s at which a shot is decided."""
    return deciding.decided_at(shot.run, shot.ball)


def known_at(shot: Shot) -> float:
    """The time in s at which the verdict on a shot is known, which may be at its end."""
    known = deciding.known_before_end(shot.run, shot.ball)
    return shot.run.duration if known is None else known
