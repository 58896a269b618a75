"""The common part of the games of pool: legal shots, fouls, the cue ball in hand, and spotting of balls.

By the rules of play of the WPA. Leaves out: calling ball and pocket, so that luck counts; the push out; balls off the
table and frozen balls; the choice after an illegal break, whose next player always breaks anew; that with the cue ball
in hand behind the head string the first ball met must lie beyond it.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from math import atan2, degrees, dist, hypot
from typing import Any, ClassVar, TypeVar

from sandbox.kit import Vector
from sandbox.tasks.match import Match, Outcome, named

#: The table (9 ft, between the noses) and the balls, in m; the balls that must reach a cushion in a break.
LENGTH, WIDTH, RADIUS, DRIVEN = 2.54, 1.27, 0.028575, 4
#: Of a stroke after the break, before the player aims, in m/s.
SPEED = 2.5
CUE = "cue"
Same = TypeVar("Same", bound="Pool")


def free_place(taken: Collection[Vector], candidates: Iterable[Vector]) -> Vector:
    """The first of some places (m) at which a ball touches no other."""
    return next(at for at in candidates if all(hypot(at[0] - x, at[1] - y) > 2.0 * RADIUS for x, y in taken))


def on_long_string(taken: Collection[Vector]) -> Vector:
    """Return the place where a ball is spotted: the foot spot, or as near to it as is free on the line towards the foot
    rail; or then on the line towards the head."""
    foot, room = 0.25 * LENGTH, 0.5 * LENGTH - RADIUS - 1e-3
    steps = [0.001 * step for step in range(round(1000 * (room - foot)))]
    back = [0.001 * step for step in range(round(1000 * (foot + room)))]
    return free_place(taken, [*((foot + step, 0.0) for step in steps), *((foot - step, 0.0) for step in back)])


def behind_head_string(taken: Collection[Vector]) -> Vector:
    """A place for the cue ball in hand: at the head spot, or beside it."""
    steps = sorted((0.02 * step for step in range(-25, 26)), key=abs)
    return free_place(taken, [(-0.25 * LENGTH, step) for step in steps])


@dataclass(frozen=True)
class Pool(Match):
    """A game of pool; ``balls`` are on the table, None before the break."""

    rack: ClassVar[str] = ""
    shown: ClassVar[str] = "first contact"
    behind_after_break: ClassVar[bool] = False  # after a foul in it
    facts: ClassVar[tuple[str, ...]] = (
        *("first_contact", "potted", "scratch", "rails", "touches", "driven", "positions"),
    )

    balls: Mapping[str, Vector] | None = None  # m
    in_hand: bool = True  # the player may place the cue ball
    behind: bool = True  # but only behind the head string
    fouls: tuple[int, int] = (0, 0)  # of each, one after the other without a legal shot between

    @property
    def breaks(self) -> bool:
        """True if the next shot is the break."""
        return self.balls is None

    @property
    def targets(self) -> Sequence[str]:
        """The balls of which one must be met first."""
        raise NotImplementedError

    def allows(self, wanted: Mapping[str, Any]) -> bool:
        """A ball may be potted that may be met first."""
        return wanted.get("pockets") in self.targets

    def fault(self, outcome: Outcome) -> str:
        """The first foul in a shot, in words; "" if there is none."""
        first = outcome["first_contact"]
        if outcome["scratch"]:
            return "scratch"
        if first is None:
            return "no ball hit"
        if not self.breaks and first not in self.targets:
            return f"meets the {first} first"
        if not outcome["potted"] and not self.breaks and not _cushions_after(outcome):
            return "no ball reaches a cushion"
        return ""

    def table_after(self, outcome: Outcome, spotted: Collection[str] = ()) -> dict[str, Vector]:
        """The balls after a shot, in m, the cue ball first; of those potted some are spotted."""
        balls = {name: (x, y) for name, (x, y) in outcome["positions"].items()}
        for name in spotted:
            balls[name] = on_long_string(balls.values())
        others = {name: place for name, place in balls.items() if name != CUE}
        return {CUE: balls.get(CUE) or behind_head_string(others.values())} | others

    def next_shot(self: Same, outcome: Outcome, foul: str, goes_on: bool, **changes: Any) -> Same:
        """The match after a shot that does not end it; after a foul the other has the cue ball in hand."""
        fouls = list(self.fouls)
        fouls[self.turn] = fouls[self.turn] + 1 if foul else 0
        potted = [name for name in outcome["potted"] if name != CUE]
        what = [f"pots {named(potted)}"] if potted else ["pots nothing"] if not foul else []
        text = f"{self.player} {' and '.join(what)}" if what else self.player
        text += f"{', but' if what else ':'} {foul}, a foul" if foul else ""
        turn = self.turn if goes_on and not foul else 1 - self.turn
        changes.setdefault("balls", self.table_after(outcome))
        changes |= {"foul": foul, "fouls": (fouls[0], fouls[1]), "in_hand": bool(foul)}
        return self.going_on(text, turn, behind=self.breaks and self.behind_after_break, **changes)

    def illegal_break(self: Same, outcome: Outcome) -> Same | None:
        """The match after a break with too few balls driven to a cushion, and none potted; None for a legal one."""
        if not self.breaks or outcome["potted"] or outcome["driven"] >= DRIVEN:
            return None
        text = f"{self.player} breaks with {outcome['driven']} balls to a cushion, not {DRIVEN}"
        return self.going_on(text, 1 - self.turn, foul="illegal break")

    @property
    def start(self) -> Mapping[str, Any]:
        if self.balls is None:
            return {"rack": self.rack, "balls": [{"name": CUE, "x": -0.25 * LENGTH, "y": 0.2}], "cue.ball": CUE}
        spots = [{"name": name, "x": x, "y": y} for name, (x, y) in self.balls.items()]
        x0, y0 = self.balls[CUE]
        near = min((self.balls[name] for name in self.targets if name in self.balls), key=lambda at: dist(at, (x0, y0)))
        way = degrees(atan2(near[1] - y0, near[0] - x0))  # at first at the nearest ball that may be met
        return {"rack": "none", "balls": spots, "cue.ball": CUE, "cue.angle": way, "cue.speed": SPEED}

    @property
    def free(self) -> tuple[str, ...]:
        return ("balls[0].x", "balls[0].y") if self.in_hand else ()

    @property
    def placement_area(self) -> tuple[float, float, float, float] | None:
        return (-0.5 * LENGTH, -0.5 * WIDTH, -0.25 * LENGTH, 0.5 * WIDTH) if self.behind else None

    @property
    def placing(self) -> str:
        where = " behind the head string" if self.behind else ""
        return f"ball in hand: drag the cue ball{where}" if self.in_hand else ""


def _cushions_after(outcome: Outcome) -> int:
    """Count how often balls met a cushion after the cue ball met the first of them; before that only it moves."""
    before = 0
    for name in outcome["touches"]:
        if name == outcome["first_contact"]:
            break
        before += name.endswith(" cushion")
    return int(outcome["rails"]) - before
