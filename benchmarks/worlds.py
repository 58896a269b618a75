"""Worlds at 60 frames a second: what a frame costs while things topple, lie on one another, and are struck.

Run ``python benchmarks/worlds.py``, with ``--only dominoes,pyramid``, ``--levels fast,balanced``, ``--repeats N``,
``--quick`` or ``--json F``. A frame is one ``World.step(1 / 60)``; its time is processor time, of repeats the shortest.
In real time a frame may take 17 ms in the mean, and 33 ms at worst.
"""

from __future__ import annotations

from collections.abc import Callable
from statistics import mean
from typing import Any

from measured import command_line, keep, show, timed

import sandbox
from sandbox import Ball, Body, Circle, Gravity, Segment, Setup, Surface, World, box
from sandbox.engine.model.surface import Bounce, ConstantBounce

FRAME, LONGEST = 1.0 / 60.0, 4.0  # s
G = Gravity(9.81)
FLOOR = Surface("floor", Segment((-20.0, 0.0), (20.0, 0.0)), restitution=0.3, friction=0.5)


def setup(bodies: list[Ball], *surfaces: Surface, restitution: float, friction: float) -> Setup:
    between = ConstantBounce(Bounce(restitution, friction))
    return Setup(bodies, [FLOOR, *surfaces], duration=60.0, between_balls=between)


def dominoes() -> Setup:
    """Twelve of 48 x 7.5 mm, 3 cm apart, felled by a marble."""
    stones = [
        Body(f"{k}", mass=0.01, shape=box(0.0075, 0.048), position=(0.03 * k, 0.024), forces=[G]) for k in range(12)
    ]
    marble = Ball("marble", 0.02, 0.008, (-0.06, 0.04), (0.89, 0.16), forces=[G])
    return setup([*stones, marble], restitution=0.4, friction=0.2)


def pyramid() -> Setup:
    """Fifteen boxes in five rows, struck by a ball."""
    boxes = [
        Body(
            f"{row} {k}", mass=0.5, shape=box(0.2, 0.1), position=(0.21 * k + 0.105 * row, 0.05 + 0.1 * row), forces=[G]
        )
        for row in range(5)
        for k in range(5 - row)
    ]
    ball = Ball("ball", 1.0, 0.06, (-1.0, 0.3), (5.0, 0.5), forces=[G])
    return setup([*boxes, ball], restitution=0.2, friction=0.5)


def see_saw() -> Setup:
    """A plank on a round post with a crate on its low end; a ball falls on the high one."""
    plank = Body("plank", mass=2.0, shape=box(2.0, 0.04), position=(0.0, 0.32), forces=[G])
    crate = Body("crate", mass=0.4, shape=box(0.2, 0.2), position=(-0.85, 0.441), forces=[G])
    ball = Ball("ball", 1.5, 0.08, (0.85, 1.5), forces=[G])
    post = Surface("post", Circle((0.0, 0.2), 0.1), restitution=0.2, friction=0.8)
    return setup([plank, crate, ball], post, restitution=0.2, friction=0.5)


def pinball() -> Any:
    """A game in which both flippers are held now and then."""
    held = {"flippers.left": [[0.7 * k, 0.7 * k + 0.2] for k in range(1, 40)]}
    return sandbox.load("pinball", {"launch.speed": 3.0, **held, "flippers.right": held["flippers.left"]})


CASES: dict[str, Callable[[], Any]] = {
    "dominoes": dominoes, "pyramid": pyramid, "see-saw": see_saw, "pinball": pinball}  # fmt: skip


def frames(case: str, level: str, longest: float) -> list[float]:
    """The processor times in s of a world's frames."""
    world = World(CASES[case](), level)
    spent = []
    while world.t < longest and not world.ended:
        spent.append(timed(world.step, FRAME)[0])
    return spent


def measure(case: str, level: str, longest: float, repeats: int) -> dict[str, Any]:
    """What the frames of a case take, each the shortest of its repeats."""
    shortest = [min(each) for each in zip(*(frames(case, level, longest) for _ in range(repeats)), strict=True)]
    return {
        "case": case,
        "level": level,
        "frames": len(shortest),
        "mean_s": mean(shortest),
        "worst_s": max(shortest),
        "worst_at_s": FRAME * (1 + shortest.index(max(shortest))),
        "late": sum(each > 2.0 * FRAME for each in shortest),
    }


def main() -> None:
    options = {
        "--only": {"help": f"of {', '.join(CASES)}", "default": ",".join(CASES)},
        "--levels": {"help": "of accuracy", "default": "balanced,fast"},
    }
    arguments = command_line(__doc__, repeats=3, options=options)
    longest = 2 * FRAME if arguments.quick else LONGEST
    found = [
        measure(case, level, longest, arguments.repeats)
        for case in arguments.only.split(",")
        for level in arguments.levels.split(",")
    ]
    columns = {"world": "{case}", "accuracy": "{level}", "frames": "{frames}", "mean": "{mean_s:.1f ms}",
               "worst": "{worst_s:.1f ms}", "at": "{worst_at_s:.2f} s", "over 33 ms": "{late}"}  # fmt: skip
    show("Worlds at 60 frames a second", found, columns)
    keep(arguments.json, found)


if __name__ == "__main__":
    main()
