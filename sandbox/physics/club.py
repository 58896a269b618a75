"""Impact of a club head and a golf ball: the ball's launch speed, angle and spin."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, inf, pi, sin
from typing import NamedTuple

#: Integration steps of each half of the contact (compression, restitution): the spin is then accurate to 0.2 %.
_STEPS = 500
_STEP = 0.5 * pi / _STEPS  # rad

#: For each step of a half, its fraction of the half's impulse. The force is a quarter of a sine wave, rising and then
#: falling.
_CLOSING = [cos(k * _STEP) - cos((k + 1) * _STEP) for k in range(_STEPS)]
_PARTING = _CLOSING[::-1]


class LaunchConditions(NamedTuple):
    """A ball just after it is struck."""

    vx: float  # m/s
    vy: float  # m/s
    spin: float  # rad/s, counter-clockwise: backspin of a ball that flies towards +x


@dataclass(frozen=True)
class Head:
    """A free club head.

    ``stiffness`` is the ratio of the contact's stiffness along the face to that across it, ``damping`` that of the
    spring along, over that at which it swings no more. ``depth`` is the distance of the head's centre of mass behind
    the face, ``inertia`` its moment of inertia about the horizontal axis through that centre, along the face; a head
    that cannot turn has an infinite one.
    """

    mass: float  # kg
    restitution: float
    friction: float
    stiffness: float
    damping: float
    depth: float = 0.0  # m
    inertia: float = inf  # kg m^2


def strike(
    head: Head, speed: float, loft: float, attack: float, height: float, ball_mass: float, radius: float
) -> LaunchConditions:
    """The launch of a solid ball at rest: the contact is a spring across the face and another along it.

    With ``speed`` V in m/s, ``loft`` L and ``attack`` A in rad (the head's path above the horizontal, negative
    downwards), ``height`` h in m of the impact point above the point opposite the head's centre of mass, masses M and
    m in kg and ``radius`` r in m. Across the face the head approaches at ``V cos(L - A)``, along it the ball slips up
    at ``u = V sin(L - A)``. The impulses P across and Q along change them by

        c_n P + c_x Q  and  c_t Q + c_x P,
        c_n = 1/M + 1/m + h^2/I,  c_t = 1/M + 7/(2 m) + d^2/I,  c_x = h d / I.

    Across, a spring is compressed and returns e: ``P = (1 + e) V cos(L - A) / c_n``, with a force that is half a sine
    wave in time (c_x Q, less than 1 % of it, is ignored there). Along, a spring of ``stiffness`` k times the other's is
    stretched by u, beside a damper of ``2 damping (k / (c_n c_t))^(1/2)``, as long as both together need no more than
    ``friction`` times the force across; otherwise the ball slides, and the two share what friction gives. At the end
    the ball has ``v_n = P / m`` across, ``v_t = Q / m`` along the face, and backspin ``(5/2) v_t / r``.

    The spring along the face may return energy: the ball then leaves with more spin than a rolling ball, 1.2 times for
    a 6-iron, which slides first; or it has swung on, and less spin is left, as for a driver, which soon grips. Without
    damping it swings so freely that a tenth more of its stiffness takes a third of a driver's spin. A very stiff spring
    gives the rigid ball of textbooks, which rolls: ``v_t = u / (m c_t)``, or slides: ``v_t = friction * v_n``.

    Left out: that the force across may act beside the ball's centre (published lofts, launches and spins leave -0.3 to
    +0.5 mm for that), the shaft, restitution that falls with speed, and sideways motion. Source of the law: Maw, Barber
    & Fawcett 1976, Wear 38:101; in this form Stronge 2000, Impact Mechanics, chapter 5; for golf Henrikson et al. 2020,
    MDPI Proc. 49(1):27 (second-hand, all three); the damper is ours. Raises ValueError where the face moves away
    from the ball.
    """
    approach, slip = speed * cos(loft - attack), speed * sin(loft - attack)
    if approach < 0.0:
        raise ValueError("the face moves away from the ball")
    across = 1.0 / head.mass + 1.0 / ball_mass + height * height / head.inertia
    along = 1.0 / head.mass + 3.5 / ball_mass + head.depth * head.depth / head.inertia
    mixed = height * head.depth / head.inertia
    squeezed = approach / across  # N s, at the end of compression
    rubbed = _impulse_along(head, squeezed, slip, across, along, mixed)
    v_n, v_t = (1.0 + head.restitution) * squeezed / ball_mass, rubbed / ball_mass
    return LaunchConditions(v_n * cos(loft) + v_t * sin(loft), v_n * sin(loft) - v_t * cos(loft), 2.5 * v_t / radius)


def _impulse_along(head: Head, squeezed: float, slip: float, across: float, along: float, mixed: float) -> float:
    """Return the impulse Q along the face in N s, for an impulse across it that is ``squeezed`` (N s) at the end of
    compression, and a ``slip`` u in m/s; ``across``, ``along`` and ``mixed`` are c_n, c_t and c_x in 1/kg."""
    stiffness = head.stiffness / across
    damper = 2.0 * head.damping * (stiffness / along) ** 0.5
    stretch = rubbed = 0.0  # m/s: stretch of the spring along, times the frequency of the one across; and N s
    for share, wave in ((1.0, _CLOSING), (head.restitution, _PARTING)):
        step = share * _STEP  # time, times the frequency of the spring across
        for part in wave if step > 0.0 else ():  # which is 0 for the smallest restitution
            push = share * squeezed * part
            force = (stiffness * (stretch + 0.5 * step * slip) + damper * slip) / (1.0 + 0.5 * step * along * damper)
            most = head.friction * push / step
            if -most <= force <= most:
                stretch += step * slip
            else:
                force = most if force > 0.0 else -most
                stretch = (step * force + damper * stretch) / (step * stiffness + damper)
            rubbed += step * force
            slip -= along * step * force + mixed * push
    return rubbed


def book_strike(
    mass: float, restitution: float, speed: float, loft: float, attack: float, ball_mass: float, radius: float
) -> LaunchConditions:
    """The launch of a solid ball that rolls on the face of a free head, as textbooks of game physics have it.

    Across the face ``v_n = (1 + e) V cos(L - A) M / (M + m)``, along it ``v_t = (2/7) V sin(L - A) M / (M + m)``, and
    backspin ``(5/7) V sin(L - A) / r``; so with A = 0 the ball goes forward with ``V M / (M + m) ((1 + e) cos^2 L +
    (2/7) sin^2 L)``. Momentum along the face asks for ``1 / (1 + 2 m / (7 M))`` in place of M / (M + m), as ``strike``
    has it with a stiff spring: for a head of 0.253 kg the book's v_t is 11 % less, and its spin 5 % more. Left out:
    slip, the springs of the contact, the depth of the head. Source: Palmer 2005, Physics for Game Programmers, chapter
    7; second-hand. Angles in rad, speeds in m/s, masses in kg, ``radius`` in m. Raises ValueError where the face moves
    away from the ball.
    """
    if cos(loft - attack) < 0.0:
        raise ValueError("the face moves away from the ball")
    share = mass / (mass + ball_mass)
    slip = speed * sin(loft - attack)
    v_n, v_t = (1.0 + restitution) * speed * cos(loft - attack) * share, 2.0 / 7.0 * slip * share
    return LaunchConditions(
        v_n * cos(loft) + v_t * sin(loft), v_n * sin(loft) - v_t * cos(loft), 5.0 / 7.0 * slip / radius
    )
