"""What a scene passes to the engine: balls, surfaces, and when the run ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import hypot, inf, isfinite
from typing import TYPE_CHECKING, Any, ClassVar, Literal, NamedTuple, Protocol

from sandbox.engine.nearest import Pose, nearest
from sandbox.engine.setup_errors import asked
from sandbox.engine.shapes import Shape, Vector, disc
from sandbox.physics.checks import check
from sandbox.physics.elementwise import least, most
from sandbox.physics.hertz import PHENOLIC

if TYPE_CHECKING:
    from sandbox.engine.event import Event
    from sandbox.physics.forces import MassLoss
    from sandbox.physics.integrators import State
    from sandbox.physics.plane import Plane

_ORIGIN = Pose(0.0, 0.0, 0.0)

#: Moment of inertia over m r^2.
SOLID_SPHERE = 2 / 5
HOLLOW_SPHERE = 2 / 3
DISC = 1 / 2


class Force(Protocol):
    """Force on a ball in N, as (fx, fy). Time (s), components of position (m) and velocity (m/s), and the spin (rad/s,
    counter-clockwise) are floats, or arrays of shape (n,) when many shots fly at once. It must depend on nothing
    else, since steps may be repeated."""

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]: ...


class Torque(Protocol):
    """Torque on a ball in N m, counter-clockwise; arguments as for Force."""

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> Any: ...


@dataclass(frozen=True)
class Ball:
    """A ball, its state at the start, and the forces on it. Lengths in m, kg, s, rad; spin counter-clockwise."""

    name: str
    mass: float  # kg
    radius: float  # m
    position: Vector  # m
    velocity: Vector = (0.0, 0.0)  # m/s
    spin: float = 0.0  # rad/s, about the axis that points out of the picture
    rolling_spin: Vector = (0.0, 0.0)  # rad/s, about x and y: only for a ball that rolls on a plane seen from above
    inertia_factor: float = SOLID_SPHERE  # moment of inertia over m r^2
    forces: Sequence[Force] = ()
    torques: Sequence[Torque] = ()
    loss: MassLoss | None = None  # ``mass`` is that at the start
    inertia: float = field(init=False, repr=False)  # kg m^2, at the start
    turns: ClassVar[bool] = False  # its angle matters, and is a part of its state

    @property
    def turned(self) -> tuple[float, ...]:
        """The angle in rad at the start, of what turns."""
        return ()

    def left(self, t: Any) -> Any:
        """Share of its mass that it still has at time t in s."""
        return 1.0 if self.loss is None else 1.0 - self.loss.lost(t) / self.mass

    def __post_init__(self) -> None:
        positive, points = ("mass", "radius", "inertia_factor"), ("position", "velocity", "rolling_spin")
        check(f"ball {self.name!r}", self, positive=positive, points=points, finite=["spin"])
        object.__setattr__(self, "inertia", self.inertia_factor * self.mass * self.radius * self.radius)


@dataclass(frozen=True, kw_only=True)
class Body(Ball):
    """Anything convex that moves and turns: ``Body("crate", position=(0.0, 1.0), shape=box(0.4, 0.3), mass=2.0)``.

    Mass and moment of inertia follow from the outline and its ``density``, mass per area, or are given; ``center`` is
    the centre of mass where it is not that of the outline. ``position`` is that of the centre of mass, ``angle`` says
    how far the outline is turned at the start. A force on a body may read ``position.angle``.
    """

    turns: ClassVar[bool] = True
    shape: Shape
    mass: float = 0.0  # kg
    density: float = 0.0  # kg/m^2, in place of the mass
    moment: float | None = None  # kg m^2, about the centre of mass; default: that of a plate of even thickness
    center: Vector | None = None  # m, in the outline's coordinates
    angle: float = 0.0  # rad, counter-clockwise
    outline: Shape = field(init=False, repr=False)  # about the centre of mass
    radius: float = field(init=False, repr=False)  # m, from the centre of mass to the farthest point
    inertia_factor: float = field(init=False, repr=False)

    @property
    def turned(self) -> tuple[float, ...]:
        return (self.angle,)

    def __post_init__(self) -> None:
        area, center, moment = self.shape.mass_properties()
        if area <= 0.0:
            raise ValueError(f"body {self.name!r}: {self.shape} has no area: give it a radius")
        if (self.mass > 0.0) == (self.density > 0.0):
            raise ValueError(f"body {self.name!r}: give either mass or density, and more than 0")
        mass = self.mass or self.density * area
        x, y = center if self.center is None else self.center
        outline = self.shape.moved(-x, -y)
        if self.center is not None and nearest(disc(1e-9 * outline.reach), _ORIGIN, outline, _ORIGIN).gap > 0.0:
            raise ValueError(f"body {self.name!r}: center = {self.center} m must be inside its shape")
        check(f"body {self.name!r}", self, finite=["angle"])
        if self.rolling_spin != (0.0, 0.0):
            raise ValueError(f"body {self.name!r}: rolling_spin = {self.rolling_spin} rad/s is only for balls")
        about = mass * (moment / area + (center[0] - x) ** 2 + (center[1] - y) ** 2)
        about = about if self.moment is None else self.moment
        given = {"mass": mass, "density": 0.0, "outline": outline, "radius": outline.reach}
        for name, value in {**given, "inertia_factor": about / (mass * outline.reach**2)}.items():
            object.__setattr__(self, name, value)
        super().__post_init__()


def outline_of(ball: Ball) -> Shape:
    """The outline of a ball or body about its centre."""
    return ball.outline if isinstance(ball, Body) else disc(ball.radius)


def kinetic(ball: Ball, state: State, t: float = 0.0) -> float:
    """Kinetic energy in J, including rotation, of a ball in this state at time t in s."""
    _, _, vx, vy, *spins = state[:5] if ball.turns else state
    energy = 0.5 * ball.mass * (vx * vx + vy * vy) + 0.5 * ball.inertia * sum(spin * spin for spin in spins)
    return energy * float(ball.left(t))


def _check_shape(shape: Segment | Circle, *points: str) -> None:
    """Raise ValueError for an invalid shape; convert its points to tuples."""
    check(type(shape).__name__.lower(), shape, points=points, not_negative=["radius"])
    for name in points:
        object.__setattr__(shape, name, tuple(getattr(shape, name)))


@dataclass(frozen=True)
class Segment:
    """A straight line from a to b with half thickness ``radius`` and rounded ends; can be touched from either side."""

    a: Vector  # m
    b: Vector  # m
    radius: float = 0.0  # m

    def __post_init__(self) -> None:
        _check_shape(self, "a", "b")

    @property
    def length(self) -> float:
        return hypot(self.b[0] - self.a[0], self.b[1] - self.a[1])


@dataclass(frozen=True)
class Circle:
    """A fixed disc."""

    center: Vector  # m
    radius: float  # m

    def __post_init__(self) -> None:
        _check_shape(self, "center")


class Bounce(NamedTuple):
    """How a surface responds to one impact."""

    restitution: float
    friction: float
    tilt: float = 0.0  # rad; the surface deforms and its normal tilts against the ball's motion along it
    tangential: float = 0.0  # restitution along it: share of the slip that a single contact reverses


@dataclass(frozen=True)
class Surface:
    """A fixed shape and its response: restitution and friction are those of the pair of ball and surface.

    ``rolling_resistance`` c is the deceleration of a rolling ball divided by the normal force per mass: a = c N / m.
    ``lowest_bounce`` is the height in m below which the surface absorbs a bounce and the ball rolls, as on grass.
    ``law`` replaces restitution and friction at an impact by a function of the normal and the tangential speed (m/s).
    ``nose_height`` is for balls seen from above: the height in m above their plane at which a cushion touches them.
    """

    name: str
    shape: Segment | Circle
    restitution: float
    friction: float
    rolling_resistance: float = 0.0
    lowest_bounce: float = 0.0  # m
    law: Callable[[float, float], Bounce] | None = None
    nose_height: float | None = None  # m

    def __post_init__(self) -> None:
        numbers = ("friction", "rolling_resistance", "lowest_bounce")
        check(f"surface {self.name!r}", self, shares=["restitution"], not_negative=numbers)


@dataclass(frozen=True)
class Catch:
    """A place that removes a ball once its centre is closer than ``radius``: a pocket; or a gutter, from ``center`` to
    ``end``. It removes those named in ``only``, if any are."""

    name: str
    center: Vector  # m
    radius: float  # m
    end: Vector | None = None  # m
    only: Sequence[str] = ()

    def __post_init__(self) -> None:
        check(f"catch {self.name!r}", self, points=["center"])

    @property
    def shape(self) -> Segment | Circle:
        return Circle(self.center, self.radius) if self.end is None else Segment(self.center, self.end, self.radius)

    def takes(self, ball: str) -> bool:
        """Whether it removes the ball of this name."""
        return not self.only or ball in self.only


class Patch(NamedTuple):
    """A region at whose border a force begins, ends or has a kink, such as a net: steps end there, and none through it
    is longer than ``step``, so that none skips it."""

    left: float  # m
    bottom: float  # m
    right: float  # m
    top: float  # m
    step: float  # s

    def crossed(self, x: tuple[Any, ...], y: tuple[Any, ...]) -> Any:
        """Whether a path inside the hull of these points could cross the region; coordinates in m."""
        beside = (least(*x) > self.right) | (most(*x) < self.left)
        return (beside | (least(*y) > self.top) | (most(*y) < self.bottom)) ^ True

    def holds(self, x: Any, y: Any) -> Any:
        """Whether a place in m is inside."""
        return (self.left < x) & (x < self.right) & (self.bottom < y) & (y < self.top)


@dataclass(frozen=True)
class Always:
    """The same bounce at any speed."""

    bounce: Bounce

    def __call__(self, normal_speed: float, slip_speed: float) -> Bounce:
        return self.bounce


#: Elastic and frictionless: the default between two balls.
ELASTIC = Always(Bounce(1.0, 0.0))


class Bounds(NamedTuple):
    """The world's edges in m: a ball outside them is an error."""

    left: float = -1e5
    bottom: float = -1e5
    right: float = 1e5
    top: float = 1e5

    def hold(self, state: State) -> Any:
        """Whether a ball in this state is inside, and all its numbers are finite."""
        x, y, vx, vy, spin = state[:5]
        inside = (self.left <= x) & (x <= self.right) & (self.bottom <= y) & (y <= self.top)
        motion = vx + vy + spin
        return inside & (motion - motion == 0.0)

    def broken_by(self, state: State) -> str:
        """What is wrong with a ball in a state that they do not hold."""
        x, y, vx, vy, spin = state[:5]
        wrong = (
            f"is outside the world ({self.left:g} to {self.right:g} m, {self.bottom:g} to {self.top:g} m); shorten the "
            "duration, or widen the scene's bounds"
            if all(map(isfinite, state))
            else "is not finite; check the forces, or lower accuracy.step or accuracy.tolerance"
        )
        return f"position ({x:.6g}, {y:.6g}) m, velocity ({vx:.6g}, {vy:.6g}) m/s, spin {spin:.6g} rad/s {wrong}"


@dataclass(frozen=True)
class ContactModel:
    """How impacts of several balls at once are computed.

    ``name`` is "rigid" (one impact after another; balls that touch act as one), "hertz" (every impact of balls by
    contact mechanics) or "auto" (contact mechanics only if a third body can be reached during the contact).
    ``stiffness`` is that of a pair in N/m^1.5; None means phenolic resin. ``wall_stiffness`` is that of a ball and a
    wall; 0 for walls, such as cushions, that are so much softer than balls that they push back after the balls have
    separated.
    """

    name: Literal["auto", "rigid", "hertz"] = "auto"
    stiffness: float | None = None
    wall_stiffness: float = 0.0

    def between(self, radius: float, other: float) -> float:
        """Stiffness in N/m^1.5 of two balls with these radii in m."""
        return PHENOLIC.between(radius, other) if self.stiffness is None else self.stiffness


class Until:
    """A condition for the end of a run that needs more than the latest event."""

    def over(self, events: Sequence[Event]) -> bool:
        """Whether the run ends with the last of these events."""
        raise NotImplementedError

    def passed(self, start: State, end: State) -> Any:
        """Whether the run ends with a step between these states, without an event; floats, or arrays for many shots."""
        return False


def is_over(until: Callable[[Event], bool] | Until | None, events: Sequence[Event]) -> bool:
    """Whether a run with this condition ends with the last of these events."""
    if isinstance(until, Until):
        return until.over(events)
    return until is not None and asked(until, "until is called as until(event)", events[-1])


@dataclass(frozen=True)
class Touches(Until):
    """Ends a run when something is touched for the ``times``-th time: ``until=Touches("floor", 2)`` is the second
    bounce.

    ``what`` is the name of a surface, a ball or a catch.
    """

    what: str
    times: int = 1

    def over(self, events: Sequence[Event]) -> bool:
        return self._counts(events[-1]) and sum(map(self._counts, events)) >= self.times

    def _counts(self, event: Event) -> bool:
        return event.kind not in ("leave", "rest") and self.what in (event.ball, event.partner)


@dataclass(frozen=True)
class Setup:
    """The initial state of a run. It ends when all balls rest, when ``until`` is met, or after ``duration`` s.

    It is data: made of dataclasses, tuples and module functions, so it can be pickled, compared and stacked.
    ``until`` is a function of the latest event, or an ``Until`` such as ``Touches``.
    ``between_balls(normal_speed, slip_speed)`` returns the Bounce of two balls; ``pairs`` gives a law for two by name:
    ``("ball", "keeper", law)``. With a ``plane`` the balls are seen from above, sliding and rolling on it by its law of
    motion, or that in ``planes`` under a ball's name: ``("ball", law)``; their own forces are then ignored.
    """

    balls: Sequence[Ball]
    surfaces: Sequence[Surface] = ()
    duration: float = 60.0  # s
    until: Callable[[Event], bool] | Until | None = None
    between_balls: Callable[[float, float], Bounce] = ELASTIC
    plane: Plane | None = None
    catches: Sequence[Catch] = ()
    bounds: Bounds = Bounds()
    patches: Sequence[Patch] = ()
    contact: ContactModel = ContactModel()
    pairs: Sequence[tuple[str, str, Callable[[float, float], Bounce]]] = ()
    planes: Sequence[tuple[str, Plane]] = ()
    breaks: Sequence[float] = ()  # s, growing: when forces may jump or bend; no step goes across

    def __post_init__(self) -> None:
        names = [ball.name for ball in self.balls]
        if not names:
            raise ValueError("a setup needs at least one ball")
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"two balls are named {name!r}: names must be unique")
        if self.planes and self.plane is None:
            raise ValueError("a setup with planes for some balls needs a plane for all others")
        if any(ball.turns for ball in self.balls):
            if self.plane is not None:
                raise ValueError("bodies cannot move on a plane seen from above: only balls can")
            if self.contact.name == "hertz":
                raise ValueError('contact model "hertz" is for balls: bodies meet as rigid ones')
            if cushion := next((surface.name for surface in self.surfaces if surface.nose_height is not None), None):
                raise ValueError(f"surface {cushion!r} has a nose_height: only balls can meet it, no bodies")
        if len(names) > 1 and (losing := next((ball.name for ball in self.balls if ball.loss is not None), None)):
            raise ValueError(f"ball {losing!r} loses mass, so it must be the only ball")
        if not 0.0 < self.duration < inf:
            raise ValueError(f"duration = {self.duration} s must be positive and finite")
        if isinstance(self.until, Touches) and self.until.what not in self.names:
            raise ValueError(f"until = {self.until}: there are {', '.join(self.names)}")

    @property
    def names(self) -> list[str]:
        """Of all that can be touched."""
        touched: list[Ball | Surface | Catch] = [*self.balls, *self.surfaces, *self.catches]
        return list(dict.fromkeys(each.name for each in touched))

    @property
    def is_flight(self) -> bool:
        """Whether it is of one ball among surfaces, and no more: many of these can be computed together."""
        alone = len(self.balls) == 1 and not self.balls[0].turns
        return alone and len(self.surfaces) > 0 and self.plane is None and not self.catches

    def between(self, one: str, other: str) -> Callable[[float, float], Bounce]:
        """The law for impacts of two balls."""
        return next((law for *pair, law in self.pairs if {*pair} == {one, other}), self.between_balls)

    def plane_of(self, ball: str) -> Plane:
        """What a ball slides and rolls on, seen from above."""
        assert self.plane is not None
        return dict(self.planes).get(ball, self.plane)

    def start_of(self, ball: Ball) -> State:
        """The state of a ball at the start."""
        rolls = self.plane is not None and self.plane_of(ball.name).rolls
        return (*ball.position, *ball.velocity, ball.spin, *(ball.rolling_spin if rolls else ball.turned))

    def ends_with(self, events: Sequence[Event]) -> bool:
        """Whether the run is over with the last of these events."""
        return is_over(self.until, events)
