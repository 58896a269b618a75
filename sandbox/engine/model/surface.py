"""Surfaces that balls bounce off, slide and roll on, at rest or moving as given; and places that remove balls."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from math import hypot
from typing import NamedTuple

from sandbox.engine.model.motion import Motion, moved
from sandbox.engine.model.shapes import Vector
from sandbox.physics.checks import check, short, with_fields_named
from sandbox.physics.elementwise import everywhere


def _check_shape(shape: Segment | Circle, *points: str) -> None:
    """Raise ValueError for an invalid shape; convert its points to tuples."""
    check(type(shape).__name__.lower(), shape, points=points, not_negative=["radius"])
    for name in points:
        object.__setattr__(shape, name, tuple(getattr(shape, name)))


@dataclass(frozen=True)
class Segment:
    """A straight line from a to b with half thickness ``radius`` and rounded ends; can be touched from either side.

    >>> from sandbox import Segment
    >>> Segment((0, 0), (3, 4)).length  # m
    5.0
    """

    a: Vector  # m
    b: Vector  # m
    radius: float = 0.0  # m

    def __post_init__(self) -> None:
        _check_shape(self, "a", "b")
        if not everywhere((self.a[0] != self.b[0]) | (self.a[1] != self.b[1])):
            raise ValueError(f"segment: a = b = {short(self.a)} has no length: a dot is Circle(center, radius)")

    @property
    def ends(self) -> tuple[Vector, Vector]:
        """Its two ends, in m."""
        return self.a, self.b

    @property
    def length(self) -> float:
        return hypot(self.b[0] - self.a[0], self.b[1] - self.a[1])


@dataclass(frozen=True)
class Circle:
    """A fixed disc.

    >>> from sandbox import Circle, Surface
    >>> rim = Surface("rim front", Circle((4.0, 3.05), 0.008), restitution=0.7, friction=0.4)
    """

    center: Vector  # m
    radius: float  # m

    def __post_init__(self) -> None:
        _check_shape(self, "center")

    @property
    def ends(self) -> tuple[Vector, Vector]:
        """Its centre twice: a segment without length, in m."""
        return self.center, self.center


class Bounce(NamedTuple):
    """The response of a surface to one impact.

    >>> from sandbox import Bounce, Segment, Surface
    >>> def clay(normal_speed, slip_speed):
    ...     return Bounce(restitution=max(0.5, 0.85 - 0.01 * normal_speed), friction=0.6)
    >>> court = Surface("court", Segment((-12, 0), (12, 0)), restitution=0.85, friction=0.6, law=clay)
    """

    restitution: float
    friction: float
    tilt: float = 0.0  # rad; the surface deforms and its normal tilts against the ball's motion along it
    tangential: float = 0.0  # restitution along it: share of the slip that a single contact reverses


#: A contact law: returns the bounce of one impact, at a normal and a tangential speed in m/s, both not negative.
BounceLaw = Callable[[float, float], Bounce]


@with_fields_named
@dataclass(frozen=True)
class Surface:
    """A shape and its response: restitution and friction are those of the pair of ball and surface.

    ``rolling_resistance`` c is the deceleration of a rolling ball divided by the normal force per mass: a = c N / m.
    ``lowest_bounce`` is the height in m below which the surface absorbs a bounce and the ball rolls, as on grass.
    ``law`` replaces restitution and friction at an impact by a function of the normal and the tangential speed (m/s).
    ``nose_height`` is for balls seen from above: the height in m above their plane at which a cushion touches them.
    ``motion`` moves it, whatever meets it; ``shape`` is then where it would be without.
    ``kick`` is the impulse in N s that it adds along its normal to what hits it, as the bumper of a pinball table does;
    it acts in impacts, not on what slides, rolls or lies on it, nor where balls are pressed together.

    >>> from sandbox import Segment, Surface
    >>> floor = Surface("floor", Segment((-10, 0), (30, 0)), restitution=0.8, friction=0.4)
    >>> green = Surface("green", Segment((-10, 0), (30, 0)), restitution=0.4, friction=0.4, rolling_resistance=0.1)
    """

    name: str
    shape: Segment | Circle
    restitution: float
    friction: float
    rolling_resistance: float = 0.0
    lowest_bounce: float = 0.0  # m
    law: BounceLaw | None = None
    nose_height: float | None = None  # m
    motion: Motion | None = None
    kick: float = 0.0  # N s

    def __post_init__(self) -> None:
        numbers = ("friction", "rolling_resistance", "lowest_bounce", "kick")
        check("surface", self, names=["name"])
        what = f"surface {self.name!r}"
        if not isinstance(self.shape, Segment | Circle):
            raise ValueError(f"{what}: shape = {short(self.shape)} must be a Segment or a Circle: one to a surface")
        check(what, self, fractions=["restitution"], not_negative=numbers)
        if self.law is not None:
            check(what, self, laws=["law"])
        if self.nose_height is not None:
            check(what, self, not_negative=["nose_height"])
        if self.motion is not None and (isinstance(self.motion, type) or not isinstance(self.motion, Motion)):
            raise ValueError(f"{what}: motion = {self.motion!r:.80} must have about, place and rates")

    def at(self, t: float) -> Surface:
        """The surface where it is at time t in s, standing still."""
        if self.motion is None:
            return self
        shape = self.shape
        if isinstance(shape, Circle):
            there: Segment | Circle = Circle(moved(shape.center, self.motion, t), shape.radius)
        else:
            there = Segment(moved(shape.a, self.motion, t), moved(shape.b, self.motion, t), shape.radius)
        return replace(self, shape=there, motion=None)


def Moving(surface: Surface, motion: Motion) -> Surface:  # noqa: N802, it reads as what it makes
    """A surface that moves as given, with infinite mass: stands wherever a surface stands.

    A motion is a ``Sliding``, ``Swinging``, ``Turning``, one ``Given`` by functions, or several ``InTurn``.

    >>> from sandbox import Ball, Moving, Segment, Setup, Sliding, Surface
    >>> import sandbox
    >>> bat = Moving(Surface("bat", Segment((-1, -1), (-1, 1)), restitution=1.0, friction=0.0), Sliding((20.0, 0.0)))
    >>> ball = Ball("ball", mass=0.15, radius=0.1, position=(0, 0))
    >>> run = sandbox.simulate(Setup([ball], [bat], duration=0.1))
    >>> round(run.events[0].t, 6), round(run.state("ball", 0.1).vx, 6)  # s, m/s
    (0.045, 40.0)
    """
    if not isinstance(surface, Surface) or motion is None:
        raise ValueError(f"Moving({short(surface)}, {short(motion)}): must be a Surface and a motion")
    return replace(surface, motion=motion)


@dataclass(frozen=True)
class ConstantBounce:
    """The contact law with the same bounce at any speed.

    >>> from sandbox import Ball, Bounce, ConstantBounce, Setup
    >>> balls = [Ball(name, mass=0.17, radius=0.0286, position=(x, 0)) for name, x in (("cue", 0.0), ("nine", 0.5))]
    >>> setup = Setup(balls, between_balls=ConstantBounce(Bounce(restitution=0.95, friction=0.06)))
    """

    bounce: Bounce

    def __post_init__(self) -> None:
        if not isinstance(self.bounce, Bounce):
            raise ValueError(f"bounce law: bounce = {short(self.bounce)} must be a Bounce")
        fractions = ["restitution", "tangential"]
        check("bounce law", self.bounce, fractions=fractions, not_negative=["friction"], finite=["tilt"])

    def __call__(self, normal_speed: float, slip_speed: float) -> Bounce:
        return self.bounce


#: Elastic and frictionless: the default between two balls.
ELASTIC = ConstantBounce(Bounce(1.0, 0.0))


@dataclass(frozen=True)
class Trap:
    """A place that removes a ball once its centre is closer than ``radius``: a pocket; or a gutter, from ``center`` to
    ``end``. It removes those named in ``only``, if any are.

    A hole lets a ball run over it that is faster than ``fastest`` on its way over the middle, or so that
    ``v > fastest (1 - (d / radius)^2)`` on a straight way that passes the middle at the distance d: the limit of a golf
    ball on a level green, with 1.63 m/s (Holmes 1991, Am. J. Phys. 59:129; Penner 2002, Can. J. Phys. 80:83;
    second-hand). It is judged where the ball enters; the ball then keeps its motion, until it hits something.

    >>> from sandbox import Ball, Setup, Trap
    >>> ball = Ball("ball", mass=0.17, radius=0.0286, position=(0, 0), velocity=(1, 0))
    >>> setup = Setup([ball], traps=[Trap("pocket", center=(1, 0), radius=0.06)], duration=2.0)
    >>> import sandbox
    >>> round(sandbox.simulate(setup).caught_at("ball"), 6)  # s
    0.94
    """

    name: str
    center: Vector  # m
    radius: float  # m
    end: Vector | None = None  # m
    only: Sequence[str] = ()
    fastest: float | None = None  # m/s

    def __post_init__(self) -> None:
        check("trap", self, names=["name"])
        check(f"trap {self.name!r}", self, points=["center"], positive=["radius"], lists=["only"])
        if self.end is not None:
            check(f"trap {self.name!r}", self, points=["end"])
            if tuple(self.end) == tuple(self.center):
                raise ValueError(f"trap {self.name!r}: end = center = {short(self.center)}: leave out end")
        if self.fastest is not None:
            check(f"trap {self.name!r}", self, positive=["fastest"])

    @property
    def shape(self) -> Segment | Circle:
        return Circle(self.center, self.radius) if self.end is None else Segment(self.center, self.end, self.radius)

    def takes(self, ball: str) -> bool:
        """Return True if it removes the ball of this name."""
        return not self.only or ball in self.only

    def holds(self, state: Sequence[float]) -> bool:
        """Return True if a ball that enters it in this state, (x, y, vx, vy, ...), is slow enough for it."""
        x, y, vx, vy = state[:4]
        speed = hypot(vx, vy)
        if self.fastest is None or speed == 0.0:
            return True
        aside = ((x - self.center[0]) * vy - (y - self.center[1]) * vx) / speed
        return speed <= self.fastest * (1.0 - (aside / self.radius) ** 2)
