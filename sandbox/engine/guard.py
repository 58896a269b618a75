"""Limits of a run: one that stalls, or takes too many steps, ends with an error that says why."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from sandbox.engine.model.event import Event
from sandbox.engine.motion.forces_on_ball import force_error
from sandbox.engine.motion.moving_ball import MovingBall
from sandbox.engine.paths.run import Numerics
from sandbox.errors import RunError

#: Most events while time advances by less than _STANDSTILL s, beyond which the run has stalled.
_MOST_EVENTS_IN_PLACE = 2_000
_STANDSTILL = 1e-6

#: Most impacts in one run, beyond which it has stalled; Galperin's billiard with mass ratio 1e8 needs 31,415.
_MOST_IMPACTS = 200_000

#: Most steps in one run, beyond which its forces are too stiff, or it lasts too long: about 5 s of computing.
MOST_STEPS = 100_000

#: Mean step in s below which forces are stiff.
_STIFF = 1e-3


@dataclass
class Guard:
    """The limits of one run."""

    moment: float = 0.0  # s, since when time stands still
    in_place: int = 0  # events since then
    start: float = 0.0  # s, from which steps and impacts count
    before: Numerics = field(default_factory=Numerics)  # the cost up to then

    def begin(self, t: float, numerics: Numerics) -> None:
        """Count steps and impacts from t in s."""
        self.start, self.before = t, replace(numerics)

    def check(self, t: float, mover: MovingBall, numerics: Numerics, events: Sequence[Event]) -> None:
        """Raise RunError if the run has stalled, or takes too many steps; its next event is one of this ball at t."""
        if t > self.moment + _STANDSTILL:
            self.moment, self.in_place = t, 0
        self.in_place += 1
        if self.in_place > _MOST_EVENTS_IN_PLACE or numerics.impacts - self.before.impacts > _MOST_IMPACTS:
            raise _stalled(t, mover, events)
        if numerics.steps - self.before.steps > MOST_STEPS:
            raise self._endless(t, mover)

    def _endless(self, t: float, mover: MovingBall) -> RunError:
        ball, wrong = mover.ball, f"{MOST_STEPS:,} steps and still not finished"
        if ball.timing.depends and t - self.start > 0.5 * MOST_STEPS * ball.timing.scale:
            remedy = f"its forces depend on time and so take steps of {ball.timing.scale:g} s: give them a time_scale"
        elif t - self.start > _STIFF * MOST_STEPS:
            remedy = "it lasts too long"
        else:
            remedy = "its forces are very stiff: raise accuracy.tolerance"
        return force_error(ball, t, mover.state, f"{wrong}; {remedy}, or shorten the duration")


def _stalled(t: float, mover: MovingBall, events: Sequence[Event]) -> RunError:
    x, y = mover.arc.state(t)[:2]
    name = mover.ball.name
    last = next((event for event in reversed(events) if name in (event.ball, event.partner)), None)
    if last is None or last.t < t - _STANDSTILL:
        what = "the velocity changes too fast for any step; look for a force that is not smooth"
    else:
        other = last.partner if last.ball == name else last.ball
        what = f"events never stop; the last was with {other!r}"
    return RunError(f"t = {t:.6g} s, ball {name!r} at ({x:.4g}, {y:.4g}) m: {what}")
