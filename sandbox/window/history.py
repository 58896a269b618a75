"""Undo and redo: the parameters as they were, from which the paths are computed again."""

from __future__ import annotations

from typing import Any, NamedTuple

#: Number of sets of parameters that are kept.
DEPTH = 200


class Changes(NamedTuple):
    """The parameters that are aimed with: a scene file, as it was opened, and the changes over it."""

    source: str
    values: dict[str, Any]  # by key
    positions: frozenset[str] = frozenset()  # keys changed because a shot began where the one before it ended

    @property
    def start(self) -> tuple[Any, ...]:
        """Equal for shots of one file that begin from the same positions."""
        return self.source, {key: self.values.get(key) for key in self.positions}


class _Step(NamedTuple):
    """The parameters after something was done."""

    changes: Changes
    what: object  # successive steps of the same kind are one; None is like no other
    shot: int  # number of the shot that was made with them; 0 if none was


class History:
    """The parameters so far, and which of them are current."""

    def __init__(self, changes: Changes) -> None:
        self.steps = [_Step(changes, None, 0)]
        self.now = 0

    def add(self, changes: Changes, what: object = None, shot: int = 0) -> None:
        """Something was done; what was undone before cannot be done again."""
        current = self.steps[self.now]
        if changes == current.changes and not shot:
            return
        del self.steps[self.now + 1 :]
        if what is not None and what == current.what:
            self.steps.pop()
        self.steps.append(_Step(changes, what, shot))
        del self.steps[:-DEPTH]
        self.now = len(self.steps) - 1

    def replace(self, changes: Changes) -> None:
        """The current step came to these parameters instead."""
        self.steps[self.now] = self.steps[self.now]._replace(changes=changes)

    def end(self) -> None:
        """Make the next change another step, even if it is of the same kind."""
        self.steps[self.now] = self.steps[self.now]._replace(what=None)

    def cancel(self, changes: Changes) -> None:
        """Leave out the current step, if it began with ``changes``."""
        if self.now and self.steps[self.now - 1].changes == changes != self.steps[self.now].changes:
            del self.steps[self.now :]
            self.now -= 1

    def undone(self, watching: bool) -> int | None:
        """The step that undo goes to; None if there is none. A shot that is no longer watched is not undone alone."""
        if self.now and watching and self.steps[self.now].shot:
            return self.now - 1
        different = (i for i in reversed(range(self.now)) if self.steps[i].changes != self.steps[self.now].changes)
        return next(different, None)

    @property
    def redone(self) -> int | None:
        """The step that redo goes to; None if there is none."""
        return self.now + 1 if self.now + 1 < len(self.steps) else None
