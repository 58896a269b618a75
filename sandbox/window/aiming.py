"""Aiming: the player changes parameters and shoots; both can be undone."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from sandbox.window.history import Changes, History
from sandbox.window.messages import Messages, reason
from sandbox.window.path import AimedPath
from sandbox.window.session import Session
from sandbox.window.shots import Played, Shot
from sandbox.window.watching import Watching


class Aiming:
    """Holds what was done so far, each change and each shot, in a ``History``."""

    def __init__(
        self,
        session: Session,
        path: AimedPath,
        watching: Watching,
        messages: Messages,
        opened: Callable[[], object],
    ) -> None:
        """``opened`` is called when another scene file has been opened."""
        self.session, self.path, self.watching, self.messages, self.opened = session, path, watching, messages, opened
        self.history = History(session.changes)
        #: By what a contest takes over: whether it makes the shot itself, and puts up the next one.
        self.makes_shot: Callable[[], bool] = lambda: False
        self.puts_up_next: Callable[[], bool] = lambda: False

    # Changing

    def change(self, values: Mapping[str, Any]) -> bool:
        """Change parameters, and aim with them; returns whether they are valid."""
        if not values:
            return False
        self.again(from_rest=True)
        return self.set(values)

    def set(self, values: Mapping[str, Any]) -> bool:
        """Change parameters of the shot that is aimed; returns whether they are valid."""
        if not self.session.may_change(values):
            self.messages.tell("that is fixed here")
            return False
        return self.changing(lambda: self.session.change(values), frozenset(values))

    def nudge(self, values: Mapping[str, Any]) -> bool:
        """Change what a player aims with, by key or wheel; not while a shot is watched."""
        if self.watching.playback is not None:
            self.messages.tell("Enter to aim again")
            return False
        return self.change(values)

    def changing(self, action: Callable[[], object], what: object = None, again: bool = False) -> bool:
        """Do something that changes the parameters, of a kind ``what``, or does so ``again``, as undo does; returns
        whether they are valid."""
        base = self.session.base
        if not self.messages.reporting_errors(action):
            return False
        if not again:
            self.history.add(self.session.changes, what)
        self.watching.awaited = False
        self.messages.forget_error()  # what was refused on the way
        if self.session.base is not base:
            self.opened()
        return True

    def restore(self, changes: Changes, again: bool = True) -> bool:
        """Aim with these parameters, maybe of another scene file; returns whether they are valid."""
        return self.changing(lambda: self.session.restore(changes), again=again)

    def reset(self, key: str | None = None) -> None:
        """Take back what was changed in the window: one parameter, or all of them."""
        self.again()
        if self.changing(lambda: self.session.reset(key)) and key is None:
            self.messages.tell("all parameters as in the file; Ctrl Z to undo")

    def begin_again(self) -> None:
        """Put the balls back where the first of the continued shots began."""
        if not self.session.changes.positions:
            self.messages.tell("the balls are already where they began")
            return
        self.again()
        if self.changing(self.session.begin_again):
            self.messages.tell("the balls are back where they began; Ctrl Z to undo")

    def aim_as(self, row: Played) -> None:
        """Aim with the parameters of an earlier shot."""
        self.again()
        if self.restore(row.changes, again=False):
            self.messages.tell(f"aimed as shot {row.number}: {row.verdict}")

    def again(self, from_rest: bool = False) -> None:
        """Stop watching a shot; with ``from_rest``, if it is over, the next begins where the balls came to rest."""
        playback, self.watching.playback = self.watching.playback, None
        if playback is None or self.puts_up_next():
            return
        ours = playback.shot.changes.source == self.session.source
        goes_on = from_rest and playback.over and ours and self.session.controls.next_start is not None
        if goes_on and self.changing(lambda: self.session.start_from(playback.shot)):
            self.messages.tell("continuing from where the balls stopped; B puts them back where they began")

    # Undo

    def undo(self) -> None:
        """Take back the last change, or the shot that is watched."""
        self._go_to(self.history.undone(self.watching.playback is not None), "nothing to undo")

    def redo(self) -> None:
        """Do again what was undone."""
        self._go_to(self.history.redone, "nothing to redo")

    def _go_to(self, place: int | None, nothing: str) -> None:
        """Aim, or shoot, with the parameters of another step of the history."""
        self.again()
        if place is None:
            self.messages.tell(nothing)
            return
        step, again = self.history.steps[place], place > self.history.now
        if self.restore(step.changes):
            self.history.now = place
            shot = next((shot for shot in self.watching.shots.paths if shot.number == step.shot), None)
            if again and shot is not None:
                self.watching.watch(shot)

    # Shooting

    def shoot(self) -> None:
        """Let go: the shot is watched, as soon as it is computed; or it is played live."""
        if self.makes_shot():
            return
        if self.session.controls.held:
            scene, changes = self.session.scene, self.session.changes
            self.messages.reporting_errors(lambda: self.watching.play(scene, changes))
            return
        self.watching.awaited = True
        if self.path.settled:
            self.watching.awaited = False
            if self.path.shot is not None and (self.path.runs.error is None or self.watching.playback is not None):
                self.keep(self.path.shot)

    def end_live(self) -> None:
        """Count a shot that was played live, once it is over; it can be watched again."""
        live = self.watching.live
        if live is None or not live.over:
            return
        if live.error is not None:
            self.messages.tell(reason(live.error), bad=True)
        self.keep(live.whole)
        if self.watching.playback is not None:
            self.watching.playback.seek(live.duration)

    def keep(self, shot: Shot) -> None:
        """Count a shot, and watch it."""
        shot = self.watching.shots.add(shot, self.session.title)
        self.history.add(self.session.changes, shot=shot.number)
        self.watching.watch(shot)

    def take_path(self, patience: float | None) -> None:
        """Take the path that was computed, if one was within ``patience`` s (None: wait): watch it if the player has
        let go. If the scene cannot be built from the parameters, aim as before."""
        path = self.path
        if not path.take(patience):
            return
        if path.runs.error is not None:
            self.watching.awaited = False
            refusal = path.refusal
            if refusal is not None and path.shot is not None:
                self.history.replace(path.shot.changes)
                if self.restore(path.shot.changes):
                    self.messages.tell(reason(refusal), bad=True)
                    path.is_refused()
        elif self.watching.awaited and path.settled and path.shot is not None:
            self.keep(path.shot)
