"""Sideways: how far a ball in flight leaves the scene's plane, because its spin axis is tilted, the wind blows across,
or it is launched to one side.

The plane is upright, through the launch and its direction; z is the distance from it to the right, w the velocity
there. An axis that is tilted by ``a`` keeps its direction in space, so that the lift is ``cos a`` of the whole in the
plane, and ``sin a`` times the share of the velocity along ``d``, to which the axis is square, to the side. Along the
path in the plane, w and what it changes of the velocity there, q, obey linear equations (u: velocity relative to the
air, with q and d as complex numbers; D u and L u: drag and whole lift over mass; c: wind across):

    dw/dt = L sin a ((u + q) . d) - D (w - c)
    dq/dt = (i L cos a - D) q - L sin a (w - c) d

Left out: the change of D and L by w, which is small since lift does not change the speed; and all that comes after the
landing. docs/physics.md has the errors. The equations are ours.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

from sandbox.engine.model.ball import Ball
from sandbox.engine.paths.run import Run
from sandbox.parameters import Group, quantity
from sandbox.physics.coefficients import Scaled
from sandbox.physics.elementwise import anywhere, cos, hypot, sin, where
from sandbox.physics.forces import Drag, Magnus
from sandbox.sport.air import Air, wind_in
from sandbox.sport.facts import Fact, FinalWhen
from sandbox.sport.flight import DEGREE, Flight, Launch
from sandbox.sport.readings import Moment

if TYPE_CHECKING:
    import numpy as np


class Crosswind(Group):
    """The air of a ball that may leave the plane."""

    crosswind: float | None = quantity(None, "m/s", -100, 100, "wind across, from left to right")


class SidewaysLaunch(Launch):
    """The ball as it leaves hand, foot or club, seen from the side, and what takes it out of that plane."""

    axis: float | None = quantity(
        None, "deg", -80, 80, "tilt of the spin's axis; positive bends the flight to the right"
    )
    direction: float | None = quantity(None, "deg", -80, 80, "of the launch, to the right of the x axis")

    @property
    def lift_share(self) -> float | None:
        return None if self.axis is None else cos(self.axis * DEGREE)

    @property
    def spin_share(self) -> float | None:
        return self.lift_share

    @property
    def side_share(self) -> float:
        """The share of the lift that acts to the right on a ball that flies as it was launched."""
        return 0.0 if self.axis is None else sin(self.axis * DEGREE)

    def tilted(self, ball: Ball) -> Ball:
        """A ball that was struck with its whole spin about a level axis, as it is simulated."""
        return ball if self.spin_share is None else replace(ball, spin=ball.spin * self.spin_share)

    def square_to(self, ball: Ball) -> complex:
        """The direction in the plane to which the tilted axis is square: that of the launch, which is assumed."""
        (vx, vy), speed = ball.velocity, hypot(*ball.velocity)
        return (vx + 1j * vy) / where(speed == 0.0, 1.0, speed)

    def in_plane(self, air: Air) -> Air:
        across = _across(air)
        if self.direction is None or not anywhere((across != 0.0) | (air.wind[0] != 0.0) | (air.wind[1] != 0.0)):
            return air
        (along, up), c, s = air.wind, cos(self.direction * DEGREE), sin(self.direction * DEGREE)
        return air.model_copy(update={"wind": (along * c + across * s, up), "crosswind": across * c - along * s})


def _across(air: Air) -> float:
    """The wind across in m/s, from left to right."""
    given: float | None = getattr(air, "crosswind", None)
    return 0.0 if given is None else given


def _may_leave_plane(parameters: Flight) -> bool:
    """True if an axis, a direction or a wind across is given, if only as zero."""
    launch, air = parameters.launch, parameters.air
    given = (getattr(launch, "axis", None), getattr(launch, "direction", None), getattr(air, "crosswind", None))
    return any(value is not None for value in given)


class GroundPlace(NamedTuple):
    """A place on the ground, from above, in m."""

    x: float
    side: float  # to the right


class _Rates(NamedTuple):
    """Coefficients of the equations at one time."""

    drag: Any  # 1/s
    lift: Any  # 1/s, of the whole spin
    through: Any  # m/s, u for the lift, which may be over the ground
    wind: Any  # m/s, across
    lift_wind: Any  # m/s, the same as the lift feels it


#: w, q, z, and the integral of q, in m/s and m.
Sideways = tuple[Any, Any, Any, Any]


def ground_track(run: Run, parameters: Flight, end: Moment | None, forward: bool = False) -> list[GroundPlace]:
    """The track of the ball ``"ball"`` over the ground, from above, until it comes as low as ``end`` has it in the
    plane; or, with ``forward``, as far. [] where nothing takes it out of the plane, or without an end. Of many shots at
    once the places are arrays."""
    if end is None or not _may_leave_plane(parameters):
        return []
    launch: Any = parameters.launch
    square_to = launch.square_to(run.setup.balls[0])
    in_plane, to_side = 1.0 if launch.lift_share is None else launch.lift_share, launch.side_share

    def slope(rates: _Rates, at: Sideways) -> Sideways:
        w, q, _, _ = at
        pull, lifted = rates.lift * to_side, w - rates.lift_wind
        along = ((rates.through + q) * square_to.conjugate()).real
        into_plane = (1j * rates.lift * in_plane - rates.drag) * q - pull * lifted * square_to
        return pull * along - rates.drag * (w - rates.wind), into_plane, w, q

    at: Sideways = (0.0, 0j, 0.0, 0j)
    durations, found = run.steps("ball", end.t)
    arcs = (durations.tolist(), found[1, :, 2].tolist()) if durations.ndim == 1 else (durations, found[1, :, 2])
    track = [GroundPlace(run.setup.balls[0].position[0], 0.0)]
    for h, x, (first, middle, last) in zip(*arcs, _rates(run, parameters, found), strict=True):
        k1 = slope(first, at)
        k2 = slope(middle, _ahead(at, 0.5 * h, k1))
        k3 = slope(middle, _ahead(at, 0.5 * h, k2))
        k4 = slope(last, _ahead(at, h, k3))
        for part, k in ((1, k1), (2, k2), (2, k3), (1, k4)):
            at = _ahead(at, part * h / 6.0, k)
        track.append(GroundPlace(x + at[3].real, at[2]))
    w, q, z, back = at
    vx, vy = end.vx + q.real, end.vy + q.imag
    behind, speed = (back.real, vx) if forward else (back.imag, vy)
    late = where(speed == 0.0, 0.0, -behind / where(speed == 0.0, 1.0, speed))  # s
    track[-1] = GroundPlace(end.x + back.real + late * vx, z + late * w)
    turned = 0.0 if launch.direction is None else launch.direction * DEGREE
    c, s = cos(turned), sin(turned)
    return [GroundPlace(x * c - side * s, x * s + side * c) for x, side in track]


def _ahead(at: Sideways, h: float, rate: Sideways) -> Sideways:
    """The values after h s at this rate of each."""
    (w, q, z, p), (dw, dq, dz, dp) = at, rate
    return w + h * dw, q + h * dq, z + h * dz, p + h * dp


def _rates(run: Run, parameters: Flight, states: np.ndarray) -> Iterator[list[_Rates]]:
    """The coefficients at start, middle and end of each arc, from times and states of shape (6, arcs, 3) or (6, arcs,
    3, shots): all at once, since a force takes as long for one of them."""
    import numpy as np

    t, x, y, vx, vy, spin = states
    ball, air = run.setup.balls[0], parameters.launch.in_plane(parameters.air.air)
    mean = {"wind": (_across(air), 0.0), "gusts": 0.0}
    across = wind_in(air.model_copy(update={key: value for key, value in mean.items() if hasattr(air, key)}))
    drag = next((force for force in ball.forces if isinstance(force, Drag)), None)
    lift = next((force for force in ball.forces if isinstance(force, Magnus)), None)
    if lift is not None and isinstance(lift.coefficient, Scaled):
        lift = replace(lift, coefficient=lift.coefficient.coefficient)
    velocity = vx + 1j * vy

    def through(force: Drag | Magnus | None) -> np.ndarray:
        wind = None if force is None or getattr(force, "along_ground", False) else force.wind
        return velocity if wind is None else velocity - (1j * wind(t, (x, y))[1] + wind(t, (x, y))[0])

    def rate(force: Drag | Magnus | None) -> np.ndarray:
        if force is None:
            return np.zeros(t.shape, complex)
        try:
            fx, fy = force(t, (x, y), (vx, vy), spin)
        except (TypeError, ValueError):  # a law of an author's own, for numbers only
            each = (force(at, (x, y), (vx, vy), spin) for at, x, y, vx, vy, spin in states.reshape(6, -1).T)
            fx, fy = (values.reshape(t.shape) for values in np.array(list(each)).T)
        u = through(force)
        return np.where(u == 0.0, 0.0, fx + 1j * fy) / np.where(u == 0.0, 1.0, u) / ball.mass

    wind = np.zeros(t.shape) if across is None else np.broadcast_to(across(t, (x, y))[0], t.shape)
    lift_wind = np.zeros(t.shape) if lift is not None and lift.along_ground else wind
    columns = (-rate(drag).real, rate(lift).imag, through(lift), wind, lift_wind)
    of_one = t.ndim == 2
    for arc in zip(*(column.tolist() if of_one else column for column in columns), strict=True):
        yield [_Rates(*at) for at in zip(*arc, strict=True)]


def side(track: Callable[[Run, Any], Sequence[GroundPlace]], final_when: FinalWhen = "end") -> Fact:
    """The fact of how far the ball is to the right at the end of its track; None where it has none."""

    def compute(run: Run, parameters: Any) -> float | None:
        places = track(run, parameters)
        return places[-1].side if places else None

    return Fact("side", "side", "m", compute, final_when, sides=("left", "right"))
