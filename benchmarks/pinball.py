"""Games of pinball with random keys: whether one ends with an error, passes through something, or gains energy.

Run ``python benchmarks/pinball.py``, with ``--count N``, ``--seed N``, ``--quick`` or ``--json F``. A world is stepped
at 60 frames a second; in each frame either key may be pressed or let go. Every other game tries to hit the ball. The
overlap is the deepest of the ball with any surface where that is at the time, at 480 times a second, as a share of its
radius.
"""

from __future__ import annotations

from random import Random
from typing import Any, NamedTuple

import numpy as np
from measured import command_line, keep, say, show, timed
from numpy.typing import NDArray

import sandbox
from sandbox.engine.ledger import ledger
from sandbox.engine.model.surface import Circle, Segment
from sandbox.engine.paths.run import Run
from sandbox.errors import SandboxError
from sandbox.scene.world import World

FRAME, LONGEST, PER_S = 1.0 / 60.0, 120.0, 480
#: Flippers reach no higher, in m.
REACH = 0.3
#: A key is pressed, and let go, with these chances in each frame.
PRESSED, LET_GO = 0.05, 0.25


class Game(NamedTuple):
    """One game and what its frames cost in s of processor time."""

    world: World
    frames: list[float]
    error: str = ""


class Keys:
    """The two keys and when each was held."""

    def __init__(self, seed: int) -> None:
        self.chance, self.tries = Random(seed), seed % 2 == 1
        self.held: dict[str, list[list[float]]] = {"flippers.left": [], "flippers.right": []}
        self.down = dict.fromkeys(self.held, False)

    def turn(self, world: World) -> None:
        """Press keys and let them go, in this frame."""
        ball = world.state["ball"]
        for key, sign in (("flippers.left", -1.0), ("flippers.right", 1.0)):
            down, times = self.down[key], self.held[key]
            if self.tries:
                press = ball.y < 0.165 and ball.vy < 0.3 and 0.0 <= sign * ball.x < 0.075
            else:
                press = down ^ (self.chance.random() < (LET_GO if down else PRESSED))
            if press != down:
                if press:
                    times.append([world.t, 600.0])
                else:
                    times[-1][1] = world.t
                self.down[key] = press
                world.apply({key: times})


def frame(world: World, keys: Keys) -> None:
    """Keys, and a step."""
    keys.turn(world)
    world.step(FRAME)


def play(seed: int, longest: float = LONGEST) -> Game:
    """A game until the ball is lost, at most so many s."""
    keys = Keys(seed)
    world = World(sandbox.load("pinball", {"launch.speed": keys.chance.uniform(1.2, 3.8), **keys.held}))
    frames: list[float] = []
    try:
        while world.state and world.t < longest:
            frames.append(timed(frame, world, keys)[0])
    except SandboxError as error:
        return Game(world, frames, str(error))
    return Game(world, frames)


def far(shape: Segment | Circle, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """The distances in m of points to a shape."""
    (ax, ay), (bx, by) = (shape.center, shape.center) if isinstance(shape, Circle) else (shape.a, shape.b)
    length = max((bx - ax) ** 2 + (by - ay) ** 2, 1e-99)
    along = np.clip(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length, 0.0, 1.0)
    return np.asarray(np.hypot(x - ax - along * (bx - ax), y - ay - along * (by - ay)) - shape.radius)


def overlap(run: Run) -> float:
    """The deepest overlap with any surface, as a share of the radius."""
    radius = run.setup.balls[0].radius
    times = np.linspace(0.0, run.duration, int(PER_S * run.duration) + 1)
    x, y, *_ = run.states("ball", times).T
    nearest = min(float(far(each.shape, x, y).min()) for each in run.setup.surfaces if each.motion is None)
    for surface in (each for each in run.setup.surfaces if each.motion is not None):
        for i in np.flatnonzero(y < REACH).tolist():
            nearest = min(nearest, float(far(surface.at(times[i]).shape, x[i : i + 1], y[i : i + 1])[0]))
    return max(0.0, radius - nearest) / radius


def measure(seed: int, longest: float = LONGEST) -> dict[str, Any]:
    """What a game came to."""
    world, frames, error = play(seed, longest)
    if error:
        return {"seed": seed, "error": error}
    run = world.run()
    book = ledger(run)
    causes = [*book.work.values(), *book.impacts.values(), *book.contacts.values()]
    return {
        "seed": seed,
        "error": "",
        "score": run.result["score"],
        "flips": run.result["flips"],
        "time_s": run.duration,
        "overlap": overlap(run),
        "created_j": max(book.jumped, abs(book.residue), abs(book.start + sum(causes) + book.residue - book.end)),
        "moved_j": sum(abs(each) for each in causes),
        "median_frame_s": float(np.median(frames)),
        "worst_frame_s": max(frames),
    }


def main() -> None:
    options = {"--count": {"type": int, "default": 200}, "--seed": {"type": int, "default": 0}}
    asked = command_line(__doc__, options=options)
    count, longest = (2, 2.0) if asked.quick else (asked.count, LONGEST)
    found = [measure(seed, longest) for seed in range(asked.seed, asked.seed + count)]
    good = [each for each in found if not each["error"]]
    total = {
        "games": len(found),
        "errors": len(found) - len(good),
        "played": sum(each["time_s"] for each in good),
        "flips": sum(each["flips"] for each in good),
        "overlap": max(each["overlap"] for each in good),
        "created": max(each["created_j"] / each["moved_j"] for each in good),
        "median": float(np.median([each["median_frame_s"] for each in good])),
        "worst": max(each["worst_frame_s"] for each in good),
    }
    columns = {"games": "{games}", "errors": "{errors}", "played": "{played:.0f} s", "struck by flippers": "{flips}",
               "overlap": "{overlap:.1e}", "energy from nowhere": "{created:.1e}", "a frame": "{median:.2f ms}",
               "worst": "{worst:.1f ms}"}  # fmt: skip
    show("Pinball with random keys", [total], columns)
    for each in found:
        if each["error"]:
            say(f"seed {each['seed']}: {each['error']}")
    keep(asked.json, found)


if __name__ == "__main__":
    main()
