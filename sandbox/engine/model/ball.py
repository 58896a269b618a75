"""Balls and bodies: what moves, its state at the start, and the forces on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from sandbox.engine.model.nearest import Pose, nearest
from sandbox.engine.model.shapes import Shape, Vector, disc
from sandbox.engine.model.tolerances import ROUNDING
from sandbox.physics.checks import check, short, with_fields_named
from sandbox.physics.of_ball import on_ball
from sandbox.physics.timing import Timing, timing_of

if TYPE_CHECKING:
    from sandbox.physics.forces import MassLoss
    from sandbox.physics.integrators import State

_ORIGIN = Pose(0.0, 0.0, 0.0)

#: Moment of inertia over m r^2.
SOLID_SPHERE = 2 / 5
HOLLOW_SPHERE = 2 / 3
DISC = 1 / 2


class Force(Protocol):
    """Force on a ball in N, as (fx, fy). Time (s), components of position (m) and velocity (m/s), and the spin (rad/s,
    counter-clockwise) are floats, or arrays of shape (n,) when many shots fly at once. It must depend on nothing
    else, since steps may be repeated: another ``Ball`` that it reads is where it started, and the world that steps it
    may not be read. If it depends on time it may have ``time_scale`` and ``discontinuities`` (``physics/timing.py``).

    >>> from sandbox import Ball
    >>> def fan(t, position, velocity, spin):
    ...     return 0.0, 4.0 / (1.0 + (position[0] - 6.0) ** 2)
    >>> ball = Ball("ball", mass=0.1, radius=0.1, position=(0, 0), forces=[fan])
    """

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> tuple[Any, Any]: ...


class Torque(Protocol):
    """Torque on a ball in N m, counter-clockwise; arguments as for Force.

    >>> from sandbox import Ball
    >>> def friction(t, position, velocity, spin):
    ...     return -1e-4 * spin
    >>> ball = Ball("ball", mass=0.1, radius=0.1, position=(0, 0), torques=[friction])
    """

    def __call__(self, t: Any, position: Any, velocity: Any, spin: Any) -> Any: ...


@with_fields_named
@dataclass(frozen=True)
class Ball:
    """A ball, its state at the start, and the forces on it. Lengths in m, kg, s, rad; spin counter-clockwise.

    >>> from sandbox import HOLLOW_SPHERE, Ball, Drag, Gravity
    >>> ball = Ball("ball", mass=0.62, radius=0.12, position=(0, 2), velocity=(5, 6), inertia_factor=HOLLOW_SPHERE,
    ...             forces=[Gravity(9.81), Drag()])
    >>> round(ball.inertia, 6)  # kg m^2
    0.005952
    """

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
    timing: Timing = field(init=False, repr=False, compare=False)  # of its forces and torques
    rotates: ClassVar[bool] = False  # its angle matters, and is a part of its state

    @property
    def initial_angle(self) -> tuple[float, ...]:
        """The angle in rad at the start, of what turns."""
        return ()

    def mass_fraction(self, t: Any) -> Any:
        """Share of its mass that it still has at time t in s."""
        return 1.0 if self.loss is None else 1.0 - self.loss.lost(t) / self.mass

    def __post_init__(self) -> None:
        positive, points = ("mass", "radius", "inertia_factor"), ("position", "velocity", "rolling_spin")
        lists = ["forces", "torques"]
        check("ball", self, names=["name"])
        if self.loss is not None and not (hasattr(self.loss, "lost") and hasattr(self.loss, "rate")):
            raise ValueError(
                f"ball {self.name!r}: loss = {short(self.loss)} must have lost(t) in kg and rate(t) in kg/s"
            )
        check(f"ball {self.name!r}", self, positive=positive, points=points, finite=["spin"], lists=lists)
        object.__setattr__(self, "inertia", self.inertia_factor * self.mass * self.radius * self.radius)
        for name in lists:
            terms = getattr(self, name)
            object.__setattr__(self, name, type(terms)(on_ball(term, self) for term in terms))
        object.__setattr__(self, "timing", timing_of((*self.forces, *self.torques, self.loss)))


@with_fields_named
@dataclass(frozen=True, kw_only=True)
class Body(Ball):
    """Anything convex that moves and turns: ``Body("crate", position=(0.0, 1.0), shape=box(0.4, 0.3), mass=2.0)``.

    Mass and moment of inertia follow from the outline and its ``density``, mass per area, or are given; ``center`` is
    the centre of mass where it is not that of the outline. ``position`` is that of the centre of mass, ``angle`` says
    how far the outline is turned at the start. A force on a body may read ``position.angle``.

    >>> from sandbox import Body, Gravity, box
    >>> crate = Body("crate", position=(0.0, 1.0), shape=box(0.4, 0.3), mass=2.0, angle=0.3, forces=[Gravity(9.81)])
    >>> round(crate.inertia, 6)  # kg m^2, m (a^2 + b^2) / 12
    0.041667
    """

    rotates: ClassVar[bool] = True
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
    def initial_angle(self) -> tuple[float, ...]:
        return (self.angle,)

    def __post_init__(self) -> None:
        what = f"body {self.name!r}"
        if not isinstance(self.shape, Shape):
            raise ValueError(f"{what}: shape = {short(self.shape)} must be a Polygon or Ellipse, such as box(0.4, 0.3)")
        area, center, moment = self.shape.mass_properties()
        if area <= 0.0:
            raise ValueError(f"{what}: {self.shape} has no area: give it a radius")
        check(what, self, not_negative=["mass", "density"], finite=["angle"])
        if (self.mass > 0.0) == (self.density > 0.0):
            raise ValueError(f"{what}: give either mass or density, and more than 0")
        if self.moment is not None:
            check(what, self, positive=["moment"])
        if self.center is not None:
            check(what, self, points=["center"])
        mass = self.mass or self.density * area
        x, y = center if self.center is None else self.center
        outline = self.shape.moved(-x, -y)
        if self.center is not None and nearest(disc(ROUNDING * outline.reach), _ORIGIN, outline, _ORIGIN).gap > 0.0:
            raise ValueError(f"{what}: center = {self.center} m must be inside its shape")
        if self.rolling_spin != (0.0, 0.0):
            raise ValueError(f"{what}: rolling_spin = {self.rolling_spin} rad/s is only for balls")
        about = mass * (moment / area + (center[0] - x) ** 2 + (center[1] - y) ** 2)
        about = about if self.moment is None else self.moment
        given = {"mass": mass, "density": 0.0, "outline": outline, "radius": outline.reach}
        for name, value in {**given, "inertia_factor": about / (mass * outline.reach**2)}.items():
            object.__setattr__(self, name, value)
        super().__post_init__()


def outline_of(ball: Ball) -> Shape:
    """The outline of a ball or body about its centre."""
    return ball.outline if isinstance(ball, Body) else disc(ball.radius)


def thickness(ball: Ball) -> float:
    """Return the size of a ball or body across its long side, in m."""
    return outline_of(ball).mass_properties().area / (2.0 * ball.radius)


def kinetic(ball: Ball, state: State, t: float = 0.0) -> float:
    """Kinetic energy in J, including rotation, of a ball in this state at time t in s."""
    _, _, vx, vy, *spins = state[:5] if ball.rotates else state
    energy = 0.5 * ball.mass * (vx * vx + vy * vy) + 0.5 * ball.inertia * sum(spin * spin for spin in spins)
    return energy * float(ball.mass_fraction(t))
