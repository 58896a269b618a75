"""Accuracy levels: the method, its step and its tolerances."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import inf

from sandbox.engine.model.tolerances import SKIN
from sandbox.errors import RequestError
from sandbox.physics.integrators import INTEGRATORS

METHODS = ("exact", "plain")

#: Lowest hop in m that is simulated where a plane presses a sliding ball against another ball or a cushion.
_LOWEST_HOP = 1e-6


@dataclass(frozen=True)
class Accuracy:
    """The accuracy of a run.

    ``method`` is "exact" (flight by an integrator to the exact time of impact, impulses by pymunk) or "plain" (stock
    pymunk at a fixed step). ``tolerance`` is the target error in m: an integrator with error control chooses its
    steps from it, one without uses ``step``. ``settle`` is the height in m below which a bounce counts as lasting
    contact, ``hop`` the minimum height of a hop where a plane presses a ball against something, and ``skin`` the
    overlap in m at which two shapes count as touching.

    >>> import sandbox
    >>> sandbox.simulate("golf", accuracy="fast").accuracy.tolerance  # m
    0.1
    >>> sandbox.simulate("golf").accuracy.finer().step < 1 / 240
    True
    """

    level: str
    method: str
    integrator: str
    tolerance: float  # m
    step: float  # s
    settle: float  # m
    hop: float = _LOWEST_HOP  # m
    skin: float = SKIN  # m

    @property
    def contact_step(self) -> float:
        """The step through a contact of several balls, as a fraction of the shortest possible contact: 0.14, 0.07 and
        0.035 at the three levels."""
        return float(0.07 * (self.tolerance / 1e-3) ** 0.15)

    @property
    def steps(self) -> str:
        """The choice of steps, in words: the integrator, and the step length if it is fixed."""
        fixed = f"steps of {1e3 * self.step:.3g} ms"
        if self.method == "plain":
            return fixed
        return self.integrator if INTEGRATORS[self.integrator].controls_error else f"{self.integrator}, {fixed}"

    def finer(self) -> Accuracy:
        """The same with half the step, or a tolerance that gives about half the step. What does not depend on the step
        is reduced too: the lowest bounce, the lowest hop, and the overlap at a contact."""
        share = 0.5 ** INTEGRATORS[self.integrator].order
        return replace(
            self,
            step=self.step / 2,
            tolerance=self.tolerance * share,
            settle=self.settle * share * share,
            hop=self.hop / 4,
            skin=self.skin / 4,
        )


#: Chosen by measurement (``sandbox trade``): the error after several impacts stays below the level's tolerance.
LEVELS = {
    "fast": Accuracy("fast", "exact", "dormand-prince", tolerance=1e-1, step=1 / 60, settle=1e-4, hop=1e-4),
    "balanced": Accuracy("balanced", "exact", "dormand-prince", tolerance=1e-3, step=1 / 240, settle=1e-8),
    "precise": Accuracy("precise", "exact", "dormand-prince", tolerance=1e-5, step=1 / 960, settle=1e-12),
}


def settle_for(tolerance: float) -> float:
    """The height in m below which a bounce may be ignored, for a final error of ``tolerance`` (m).

    Ignored bounces of height h would have lasted for a time proportional to sqrt(h), during which the ball now rolls
    and is slowed: the error grows as sqrt(h). Measured for a ball that bounces and then rolls: 0.3 mm for 1e-8 m.
    """
    return min(1e-4, max(1e-14, 1e-2 * tolerance * tolerance))


def resolve(
    level: str = "balanced",
    tolerance: float | None = None,
    method: str | None = None,
    integrator: str | None = None,
    step: float | None = None,
) -> Accuracy:
    """The accuracy that a level means, with individual settings replaced. Raises RequestError for an unknown
    name and for a value that is not positive."""
    choices = {"level": (level, LEVELS), "method": (method, METHODS), "integrator": (integrator, INTEGRATORS)}
    for what, (name, known) in choices.items():
        if name is not None and name not in known:
            raise RequestError(f"accuracy.{what}: {name!r} is not one of {', '.join(known)}")
    for what, value, unit in (("tolerance", tolerance, "m"), ("step", step, "s")):
        if value is not None and not 0.0 < value < inf:
            raise RequestError(f"accuracy.{what}: {value} {unit} must be positive")
    if step is not None and integrator is None:
        integrator = "rk4"  # a user's own step needs an integrator with a fixed step
    settle = None if tolerance is None else settle_for(tolerance)
    wanted = {"tolerance": tolerance, "settle": settle, "method": method, "integrator": integrator, "step": step}
    return replace(LEVELS[level], **{what: value for what, value in wanted.items() if value is not None})  # type: ignore[arg-type]
