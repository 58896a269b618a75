"""Ten frames of bowling (USBC, chapter 2): a strike counts ten and the next two balls, a spare ten and the next one.

The players bowl a frame in turn. In the tenth a strike or a spare gives the balls that it counts. Leaves out: fouls at
the line.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from sandbox.tasks.match import Match, Outcome

FRAMES, PINS = 10, 10
ALL = " ".join(str(pin) for pin in range(1, PINS + 1))
Frames = tuple[tuple[int, ...], ...]  # the pins of each ball, by frame


def closed(balls: Sequence[int], last: bool) -> bool:
    """True if no ball is left in a frame; the ``last`` one has three after a strike or a spare."""
    if not last:
        return len(balls) == 2 or sum(balls) == PINS
    return len(balls) == 3 or (len(balls) == 2 and sum(balls) < PINS)


def at_rack(balls: Sequence[int]) -> list[int]:
    """The last balls of a frame, those at the pins that stand now: none at a full rack that is new."""
    rack: list[int] = []
    for pins in balls:
        rack = [] if sum(rack) + pins == PINS else [*rack, pins]
    return rack


def total(frames: Frames) -> int:
    """The score so far: a ball that a strike or spare waits for counts once it is bowled."""
    points = 0
    for number, balls in enumerate(frames[:FRAMES]):
        points += sum(balls)
        if number < FRAMES - 1 and sum(balls) == PINS:
            after = [pins for later in frames[number + 1 :] for pins in later]
            points += sum(after[: 3 - len(balls)])
    return points


@dataclass(frozen=True)
class TenFrames(Match):
    """Ten frames each, with strikes, spares and the balls that they count."""

    title = "Ten frames"
    goal = "Ten frames each, in turn: strikes and spares count the balls after them, too"
    facts = ("pins", "leaves")

    frames: tuple[Frames, Frames] = ((), ())  # of each player
    standing: str = ALL  # pins at the next ball

    def after(self, outcome: Outcome) -> TenFrames:
        own, pins, leaves = self.frames[self.turn], int(outcome["pins"]), list(outcome["leaves"])
        fresh = not own or closed(own[-1], len(own) == FRAMES)
        balls = (pins,) if fresh else (*own[-1], pins)
        own = (*(own if fresh else own[:-1]), balls)
        last, at_all = len(own) == FRAMES, not at_rack(balls[:-1])
        what = f"{pins or 'no pin'} down" if leaves else "strike" if at_all else "spare"
        both = (own, self.frames[1]) if self.turn == 0 else (self.frames[0], own)
        said, done = f"{self.player}: {what}", closed(balls, last)
        if done and last and self.turn == 1:
            first, second = map(total, both)
            return self.won_by(None if first == second else int(second > first), said, frames=both)
        standing = ALL if done or not leaves else " ".join(leaves)
        return self.going_on(said, 1 - self.turn if done else self.turn, frames=both, standing=standing)

    @property
    def scores(self) -> tuple[str, str]:
        first, second = (str(total(frames)) for frames in self.frames)
        return first, second

    @property
    def start(self) -> Mapping[str, Any]:
        return {"pin.standing": self.standing, "launch.angle": 0.0}  # deg: hooks into the gutter


GAME = TenFrames
