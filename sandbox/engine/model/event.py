"""An event of a ball: its time, kind, partner and speed."""

from __future__ import annotations

from typing import NamedTuple


class Event(NamedTuple):
    """Something that happened to a ball at one instant.

    ``kind`` is ``"impact"`` (``speed`` is the normal approach speed in m/s), ``"contact"`` (it starts to slide or
    roll on the surface), ``"leave"`` (it leaves the surface), ``"rest"``, ``"caught"`` (by a trap) or ``"over"`` (it
    is too fast for the trap that its centre enters; with both, ``speed`` is its speed).

    >>> import sandbox
    >>> event = sandbox.simulate("basketball").events[0]
    >>> event.kind, event.ball, event.speed > 0.0
    ('impact', 'ball', True)
    """

    t: float  # s
    kind: str
    ball: str
    partner: str  # name of the surface or of the other ball; "" if none
    speed: float  # m/s
    x: float  # m, the ball's centre
    y: float  # m
