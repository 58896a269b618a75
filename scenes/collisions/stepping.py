"""Two discs moved at a fixed step, which find that they overlap after the fact: three rules of what is done then.

Between two looks both go straight on. The impulse is that of the exact run, (1 + e) times the reduced mass times the
speed of approach along the line of centres: equal elastic masses exchange their velocities along it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sandbox.kit import Ball

#: Speeds of approach in m/s up to this are rounding of zero.
STILL = 1e-12


class Rule(NamedTuple):
    """A response to an overlap that is found at a step."""

    label: str
    push: bool  # apart first, until they touch, the lighter farther
    closing: bool  # exchange only if they approach


RULES = {
    "naive": Rule("exchange at each overlap", push=False, closing=False),
    "approach": Rule("exchange if they approach", push=False, closing=True),
    "push": Rule("push apart, exchange if they approach", push=True, closing=True),
}


@dataclass(frozen=True)
class Stepped:
    """The two at each look: times in s, shape (n,); places in m, shape (n, 2, 2), by time, ball and axis; and the
    indices of the looks at which they exchanged impulses."""

    times: np.ndarray
    places: np.ndarray
    exchanges: list[int]

    def at(self, t: float) -> np.ndarray:
        """The places in m at the last look up to t in s, shape (2, 2)."""
        place: np.ndarray = self.places[max(0, int(np.searchsorted(self.times, t, "right")) - 1)]
        return place


def step_through(
    balls: tuple[Ball, Ball], restitution: float, rule: Rule, step: float, first: float, duration: float
) -> Stepped:
    """Two balls moved until ``duration``; the first step is ``first`` long, all others ``step``; all in s."""
    later = int(max(0.0, duration - first) / step + 1e-9)
    times = np.array([0.0, *(first + step * i for i in range(later + 1))])
    place = np.array([ball.position for ball in balls], dtype=float)
    velocity = np.array([ball.velocity for ball in balls], dtype=float)
    lightness = np.array([1.0 / ball.mass for ball in balls])  # 1/kg
    share = lightness / lightness.sum()
    reach = balls[0].radius + balls[1].radius
    places, exchanges = [place.copy()], list[int]()
    for look, passed in enumerate(np.diff(times), start=1):
        place += passed * velocity
        apart = place[1] - place[0]
        distance = float(np.hypot(*apart))
        if distance < reach:
            normal = apart / distance if distance else np.array([1.0, 0.0])
            ways = np.outer((-share[0], share[1]), normal)
            if rule.push:
                place += (reach - distance) * ways
            closing = float((velocity[0] - velocity[1]) @ normal)
            if closing > STILL or not rule.closing:
                velocity += (1.0 + restitution) * closing * ways
                exchanges.append(look)
        places.append(place.copy())
    return Stepped(times, np.array(places), exchanges)
