"""Forces and torques that take from the ball in whose list they are what they are not given."""

from __future__ import annotations

from typing import Any, NoReturn


class OfBall:
    """A force or torque that takes what it is not given, such as a mass, from the ball in whose list it is."""

    def on(self, ball: Any) -> Any:
        """Return the same with what it needs of this ball or body."""
        raise NotImplementedError

    def __getattr__(self, name: str) -> NoReturn:
        """Raise ValueError where it is called in no ball's list, without what it needs; nothing else comes here."""
        if name in getattr(type(self), "__dataclass_fields__", ()):
            what = type(self).__name__
            raise ValueError(
                f"{what} is in no ball's list of forces or torques: give it the mass or radius that it needs"
            )
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")


def on_ball(term: Any, ball: Any) -> Any:
    """Return a force or torque as it acts on this ball or body."""
    return term.on(ball) if isinstance(term, OfBall) else term
