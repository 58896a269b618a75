"""A club head meets a golf ball: how fast, how high and with what spin it leaves."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, pi, sin
from typing import NamedTuple

#: Steps in which each half of the contact (compression, restitution) is followed: the spin is then right to 0.2 %.
_STEPS = 500
_STEP = 0.5 * pi / _STEPS  # rad

#: Of each step of a half its share of the half's impulse, and the force at its end: a quarter of a wave that rises, and
#: one that falls.
_CLOSING = [(cos(k * _STEP) - cos((k + 1) * _STEP), sin((k + 1) * _STEP)) for k in range(_STEPS)]
_PARTING = [(sin((k + 1) * _STEP) - sin(k * _STEP), cos((k + 1) * _STEP)) for k in range(_STEPS)]


class Launch(NamedTuple):
    """A ball just after it is struck."""

    vx: float  # m/s
    vy: float  # m/s
    spin: float  # rad/s, counter-clockwise: backspin of a ball that flies towards +x


@dataclass(frozen=True)
class Head:
    """A free club head.

    ``stiffness`` is that of the contact along the face over that across it. ``depth`` is how far the head's centre of
    mass lies behind the face, ``inertia`` its moment of inertia about the horizontal axis through that centre, along
    the face; a head that cannot turn has an infinite one.
    """

    mass: float  # kg
    restitution: float
    friction: float
    stiffness: float
    depth: float = 0.0  # m
    inertia: float = inf  # kg m^2


def strike(
    head: Head, speed: float, loft: float, attack: float, height: float, ball_mass: float, radius: float
) -> Launch:
    """What a head gives a solid ball at rest: both are springs along the face and across it while they touch.

    With ``speed`` V in m/s, ``loft`` L and ``attack`` A in rad (the head's way above the horizontal, negative
    downwards), ``height`` h in m of the place that is hit above the one opposite the head's centre of mass, masses M
    and m in kg and ``radius`` r in m. Across the face the head closes in at ``V cos(L - A)``, along it the ball slips
    up at ``u = V sin(L - A)``. The impulses P across and Q along change them by

        c_n P + c_x Q  and  c_t Q + c_x P,
        c_n = 1/M + 1/m + h^2/I,  c_t = 1/M + 7/(2 m) + d^2/I,  c_x = h d / I.

    Across, a spring is compressed and gives back e: ``P = (1 + e) V cos(L - A) / c_n``, its force half a wave of time
    (c_x Q, below 1 % of it, is left out there). Along, a spring of ``stiffness`` times the other's is stretched by u,
    as long as its force is less than ``friction`` times the force across; where it is not, the ball slides. In the
    end the ball has ``v_n = P / m`` across, ``v_t = Q / m`` along the face, and backspin ``(5/2) v_t / r``.

    A spring along the face may throw the surface back: the ball then leaves with more spin than one that rolls, by 1.2
    for a 6-iron; or it has swung to and fro by then, and less is left, 0.7 for a driver. A very stiff spring is the
    rigid ball of textbooks, which rolls: ``v_t = u / (m c_t)``, or slides: ``v_t = friction * v_n``.

    Left out: the ball's flattening, the shaft, restitution that falls with speed, and everything sideways. Source of
    the law: Maw, Barber & Fawcett 1976, Wear 38:101; in this form Stronge 2000, Impact Mechanics, chapter 5; for golf
    Henrikson et al. 2020, MDPI Proc. 49(1):27 (second-hand, all three). Raises ValueError where the face moves away
    from the ball.
    """
    approach, slip = speed * cos(loft - attack), speed * sin(loft - attack)
    if approach < 0.0:
        raise ValueError("the face moves away from the ball")
    across = 1.0 / head.mass + 1.0 / ball_mass + height * height / head.inertia
    along = 1.0 / head.mass + 3.5 / ball_mass + head.depth * head.depth / head.inertia
    mixed = height * head.depth / head.inertia
    squeezed = approach / across  # N s, when the head no longer closes in
    stiffness = head.stiffness / across
    stretch = rubbed = 0.0  # m/s: stretch of the spring along, times the frequency of the one across; and N s
    for share, wave in ((1.0, _CLOSING), (head.restitution, _PARTING)):
        step = share * _STEP  # time, times the frequency of the spring across
        for part, end in wave if step > 0.0 else ():  # which of the smallest restitution is 0
            push = share * squeezed * part
            force = stiffness * (stretch + 0.5 * step * slip)
            most = head.friction * push / step
            if -most <= force <= most:
                stretch += step * slip
            else:
                force = most if force > 0.0 else -most
                stretch = (head.friction if force > 0.0 else -head.friction) * squeezed * end / stiffness
            rubbed += step * force
            slip -= along * step * force + mixed * push
    v_n, v_t = (1.0 + head.restitution) * squeezed / ball_mass, rubbed / ball_mass
    return Launch(v_n * cos(loft) + v_t * sin(loft), v_n * sin(loft) - v_t * cos(loft), 2.5 * v_t / radius)
