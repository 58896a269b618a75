"""Contact force of two balls: Hertz's law, with damping that gives the pair's restitution.

Balls that overlap by d push each other apart with

    N = k d^(3/2) + a sqrt(m k) d^(1/4) dd/dt,

where m is the reduced mass and k = 4/3 E sqrt(R), with 1/E = (1 - nu1^2)/E1 + (1 - nu2^2)/E2 and 1/R = 1/r1 + 1/r2
(Hertz 1882; Johnson, Contact Mechanics, section 4.2). With the damping of Tsuji et al. 1992, Powder Technology 71:239,
restitution does not depend on speed, and a follows from it in closed form: a = -sqrt(5) ln e / sqrt(ln^2 e + pi^2)
(Antypov & Elliott 2011, EPL 94:50004).

Valid for elastic balls with a contact that is small compared with their radius and lasts longer than sound takes to
cross them. Left out: plastic flow, waves inside the balls, and adhesion (near the end of a damped contact the law is
slightly attractive, as in the paper).
"""

from __future__ import annotations

from math import gamma, inf, log, pi, sqrt
from typing import Any, NamedTuple

#: Lowest restitution: with none a contact would never end, and with less two balls stay together for seconds.
_LEAST_RESTITUTION = 1e-3


class _Material(NamedTuple):
    """Elastic properties of a ball."""

    modulus: float  # Pa, Young's
    poisson: float

    def between(self, radius: float, other: float = inf) -> float:
        """k in N/m^1.5 of two bodies of this material with radii in m (infinite for a plane)."""
        curved = 1.0 / (1.0 / radius + 1.0 / other)
        return 4.0 / 3.0 * self.modulus / (2.0 * (1.0 - self.poisson**2)) * sqrt(curved)

    @property
    def along(self) -> float:
        """Stiffness along a contact over that across it, before anything slides (Mindlin 1949)."""
        return 2.0 * (1.0 - self.poisson) / (2.0 - self.poisson)


#: Billiard balls; a maker's figures (dbkcues.ru). They touch for 390 us at 1 m/s; 250 to 300 us are measured (Kim
#: 2024; Marlow 1995), which would need a resin twice as stiff.
PHENOLIC = _Material(5.84e9, 0.34)


def damping(restitution: float) -> float:
    """a of the damping for a restitution from 0 to 1; LEAST_RESTITUTION in place of less."""
    fading = log(max(restitution, _LEAST_RESTITUTION))
    return -sqrt(5.0) * fading / sqrt(fading**2 + pi**2)


def contact_time(mass: Any, stiffness: Any, speed: Any) -> Any:
    """Seconds for which two balls of reduced ``mass`` (kg) that meet at ``speed`` (m/s) touch, without damping.

    T = 3.218 (m^2 / (k^2 v))^(1/5); the number is (5/4)^(2/5) 2 sqrt(pi) gamma(2/5) / (5/2 gamma(9/10)).
    """
    return _SHAPE * (mass**2 / (stiffness**2 * speed)) ** 0.2


def largest_overlap(mass: Any, stiffness: Any, speed: Any) -> Any:
    """Overlap in m of two balls of reduced ``mass`` (kg) that meet at ``speed`` (m/s), at its largest, without damping.

    D = (5/4 m v^2 / k)^(2/5).
    """
    return (1.25 * mass * speed**2 / stiffness) ** 0.4


_SHAPE = 1.25**0.4 * 2.0 * sqrt(pi) * gamma(0.4) / (2.5 * gamma(0.9))
