"""How many whole episodes of a task a program can play: ``python benchmarks/gym.py``.

Random actions, an environment by itself, many at once, and many as Gymnasium itself has them, one after another
(``SyncVectorEnv``), in episodes for each second of processor time. A minute on an idle machine. ``SECONDS=10 python
benchmarks/gym.py`` measures longer; ``ALL=1 python benchmarks/gym.py`` compares every task at once with one by one.
"""

from __future__ import annotations

import os
from time import process_time
from typing import Any

import click
import gymnasium
from gymnasium.vector import AutoresetMode

import sandbox.gym  # noqa: F401  # registers the tasks

#: Processor time of each measurement, in s.
SECONDS = float(os.environ.get("SECONDS", "3"))

#: What is asked of one core of an idle machine, in episodes/s.
SINGLE = {"FreeThrow": 1_000, "ClosestToThePin": None, "EightBall": 150}
MANY = {"FreeThrow": 7_000, "ClosestToThePin": None}
ENVIRONMENTS = 1_024
#: Environments of a comparison with Gymnasium's own.
FEWER = 64


def single(name: str, **options: str) -> tuple[float, float]:
    """Episodes for each second of one environment, and its steps for each episode."""
    env = gymnasium.make(f"sandbox/{name}-v0", disable_env_checker=True, **options)
    env.action_space.seed(0)
    env.reset(seed=0)
    episodes = steps = 0
    start = process_time()
    while process_time() - start < SECONDS:
        over = False
        while not over:
            over = env.step(env.action_space.sample())[2]
            steps += 1
        env.reset()
        episodes += 1
    return episodes / (process_time() - start), steps / episodes


def many(name: str, count: int = ENVIRONMENTS, sync: bool = False, **options: str) -> float:
    """Episodes for each second of a vector environment, or of Gymnasium's own if ``sync``."""
    same = {"autoreset_mode": AutoresetMode.SAME_STEP}
    how: dict[str, Any] = {"vectorization_mode": "sync", "vector_kwargs": same} if sync else same
    envs = gymnasium.make_vec(f"sandbox/{name}-v0", num_envs=count, **how, **options)
    envs.action_space.seed(0)
    envs.reset(seed=0)
    episodes, start = 0, process_time()
    while process_time() - start < SECONDS:
        episodes += int(envs.step(envs.action_space.sample())[2].sum())
    return episodes / (process_time() - start)


def every_task() -> None:
    """Each task by itself, and at once."""
    click.echo(f"{'episodes/s and core':<36}{'alone':>10}{f'{FEWER} at once':>14}{'ratio':>8}")
    for path in sorted(gymnasium.registry):
        if path.startswith("sandbox/"):
            name = path.removeprefix("sandbox/").removesuffix("-v0")
            alone, at_once = single(name)[0], many(name, FEWER)
            click.echo(f"  {name:<34}{alone:>10,.0f}{at_once:>14,.0f}{at_once / alone:>8.2f}")


def main() -> None:
    if os.environ.get("ALL"):
        every_task()
        return
    click.echo(f"{'episodes/s and core':<44}{'measured':>10}{'target':>10}{'steps':>8}")
    for name, target in SINGLE.items():
        rate, steps = single(name)
        click.echo(f"  {name + ', one environment':<42}{rate:>10,.0f}{_said(target):>10}{steps:>8.2f}")
    rate, steps = single("FreeThrow", accuracy="fast")
    click.echo(f"  {'FreeThrow, one environment, accuracy fast':<42}{rate:>10,.0f}{'':>10}{steps:>8.2f}")
    for name, target in MANY.items():
        click.echo(f"  {name + f', {ENVIRONMENTS:,} at once':<42}{many(name):>10,.0f}{_said(target):>10}")
    fast = many("FreeThrow", accuracy="fast")
    click.echo(f"  {f'FreeThrow, {ENVIRONMENTS:,} at once, accuracy fast':<42}{fast:>10,.0f}")
    for how, sync in (("at once", False), ("by SyncVectorEnv", True)):
        click.echo(f"  {f'FreeThrow, {FEWER} {how}':<42}{many('FreeThrow', FEWER, sync):>10,.0f}")


def _said(target: int | None) -> str:
    return "" if target is None else f"{target:,}"


if __name__ == "__main__":
    main()
