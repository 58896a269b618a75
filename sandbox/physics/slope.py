"""A ball on a slope of cloth, seen from above: a ramp as a field of force.

Gravity pulls with an acceleration p along the plane, downhill. While the ball **slides**, with the velocity u of its
lowest point over the cloth,

    dv/dt = p - mu_s g u/|u|,  du/dt = p - (1 + 1/k) mu_s g u/|u|,

where k m r^2 is its moment of inertia; while it **rolls**,

    dv/dt = p / (1 + k) - mu_r g v/|v|.

Straight up or down the slope that is exact. Elsewhere the friction turns with the motion: phases are so short that it
turns by 0.01 rad in each at most, and has the direction that it has in their middle: 0.1 mm off after 2 s. The
last micrometres a second of a slip, or of a motion that ends or turns back, are straight.

Valid where the ball can roll: p below (1 + 1/k) mu_s g. Left out: that a slope is seen shorter from above (2 % at 1 in
5) and presses less on the ball (the same), and the edge where it begins: no ball jumps.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot, inf

from sandbox.physics.checks import check
from sandbox.physics.cloth import Cloth
from sandbox.physics.plane import STILL, PlaneMode, PlanePhase, PlaneState

#: How far friction turns in a phase, in rad; by how much of its size what it slows changes in a phase, if not straight;
#: speed in m/s below which that is straight; the sine of an angle that counts as none.
_TURN, _CHANGE, _CREEPING, _STRAIGHT = 0.01, 0.05, 1e-6, 1e-12


@dataclass(frozen=True)
class Slope(Cloth):
    """Cloth on a slope, on which gravity pulls by ``pull_x`` and ``pull_y`` (m/s^2): g times the height lost per metre.

    >>> import sandbox
    >>> from sandbox import Ball, Setup, Slope
    >>> ball = Ball("ball", mass=0.046, radius=0.021, position=(0, 0), velocity=(1, 0), rolling_spin=(0, 1 / 0.021))
    >>> run = sandbox.simulate(Setup([ball], plane=Slope(rolling=0.0, pull_x=-0.7), duration=4.0))
    >>> round(run.state("ball", 2.0).x, 9), round(run.state("ball", 4.0).x, 9)  # m: up 1 m, and back
    (1.0, 0.0)
    """

    pull_x: float = 0.0  # m/s^2
    pull_y: float = 0.0

    def __post_init__(self) -> None:
        super().__post_init__()
        check(self.name, self, finite=["pull_x", "pull_y"])
        steepest = (1.0 + 1.0 / self.inertia) * self.strongest
        if not hypot(self.pull_x, self.pull_y) < steepest:
            pull = hypot(self.pull_x, self.pull_y)
            raise ValueError(
                f"{self.name}: a slope that pulls by {pull:.3g} m/s^2 must pull by less than {steepest:.3g} m/s^2: "
                "no ball would roll"
            )

    def phase(self, state: PlaneState, radius: float) -> PlanePhase:
        """The phase that starts at ``state`` for a ball of ``radius`` m: it slides, rolls, or rests."""
        turn = 1.0 / self.inertia
        _, _, vx, vy, _, wx, wy = state
        pull, spinning = (self.pull_x, self.pull_y), turn * self.spinning * self.gravity / radius
        slip = vx - radius * wy, vy + radius * wx
        if hypot(*slip) > STILL:
            time, ends, (fx, fy) = _slowed(slip, (1.0 + turn) * self.strongest, pull)
            fx, fy = fx / (1.0 + turn), fy / (1.0 + turn)
            mode, stop = PlaneMode.SLIDING, (time, pull[0] + fx, pull[1] + fy)
            alphas = turn * fy / radius, -turn * fx / radius
        else:
            rolls = pull[0] / (1.0 + self.inertia), pull[1] / (1.0 + self.inertia)
            slowing = self.rolling * self.gravity
            if hypot(vx, vy) <= STILL and hypot(*rolls) <= slowing:
                return PlanePhase.slowed(PlaneMode.RESTING, state, (inf, 0.0, 0.0), spinning, (0.0, 0.0), radius)
            time, ends, (fx, fy) = _slowed((vx, vy), slowing, rolls)
            mode, stop = PlaneMode.ROLLING, (time, rolls[0] + fx, rolls[1] + fy)
            alphas = -stop[2] / radius, stop[1] / radius
        phase = PlanePhase.slowed(mode, state, stop, spinning, alphas, radius)
        return phase if ends else phase._replace(ends_motion=False, moves_for=0.0)


def _slowed(
    velocity: tuple[float, float], friction: float, pull: tuple[float, float]
) -> tuple[float, bool, tuple[float, float]]:
    """For how long (s) friction (m/s^2) against a velocity (m/s) that is also pulled keeps its direction, whether the
    velocity ends then, and the friction's components."""
    speed, strength = hypot(*velocity), hypot(*pull)
    if speed <= STILL:  # it begins to move, downhill
        return inf, False, (-friction * pull[0] / strength, -friction * pull[1] / strength)
    x, y = velocity[0] / speed, velocity[1] / speed
    along, across = pull[0] * x + pull[1] * y, pull[1] * x - pull[0] * y
    if speed < _CREEPING:
        slowing = friction + (strength if strength > friction else 0.0)
        return speed / slowing, True, (-slowing * x - pull[0], -slowing * y - pull[1])
    if abs(across) <= _STRAIGHT * strength or friction == 0.0:
        slowing = friction - along
        ends = slowing > 0.0 and friction > 0.0
        return (speed / slowing if ends else inf), ends, (-friction * x, -friction * y)
    time = min(_TURN * speed / abs(across), _CHANGE * speed / hypot(along - friction, across))
    middle = velocity[0] + 0.5 * time * (pull[0] - friction * x), velocity[1] + 0.5 * time * (pull[1] - friction * y)
    return time, False, (-friction * middle[0] / hypot(*middle), -friction * middle[1] / hypot(*middle))
