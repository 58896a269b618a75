"""The kinds of events that a run is made of: what the event queue predicts for a ball."""

from __future__ import annotations

from enum import Enum, auto


class EventKind(Enum):
    """Kinds of events of a ball or body: why its arc ends, or what it meets on it."""

    ARC_END = auto()
    """Its arc ends because a step ends: it moves on as before."""

    SPIN_END = auto()
    """On a plane seen from above its spin ends, before its predicted path does: only the spin changes."""

    MOTION_END = auto()
    """In sustained contact its slip falls to zero, so that it rolls, or its speed, so that it rests."""

    LIFT_OFF = auto()
    """Nothing presses it on its surface any more."""

    GRIP_LOSS = auto()
    """It rolls and friction cannot keep it rolling: it slides from now on."""

    WAKE = auto()
    """It has rested, and its forces, which depend on time, move it from now on."""

    EDGE = auto()
    """It reaches the end of what it slides or rolls on."""

    TOUCH = auto()
    """It touches a surface or another ball."""

    TRAP = auto()
    """Its centre enters a trap, such as a pocket, which removes it."""

    CLUSTER_END = auto()
    """The simulated contact with several others is over."""

    HEAP_STEP = auto()
    """A step of the heap in which it lies is over."""
