"""How many whole episodes of a task a program can play: ``python benchmarks/gym.py``.

Random actions, an environment by itself and many at once, in episodes for each second of processor time. Half a minute
on an idle machine. ``SECONDS=10 python benchmarks/gym.py`` measures longer.
"""

from __future__ import annotations

import os
from time import process_time

import click
import gymnasium

import sandbox.gym  # noqa: F401  # registers the tasks

#: Processor time of each measurement, in s.
SECONDS = float(os.environ.get("SECONDS", "3"))

#: What is asked of one core of an idle machine, in episodes/s.
SINGLE = {"FreeThrow": 1_000, "ClosestToThePin": None, "EightBall": 150}
MANY = {"FreeThrow": 7_000, "ClosestToThePin": None}
ENVIRONMENTS = 1_024


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


def many(name: str, **options: str) -> float:
    """Episodes for each second of a vector environment."""
    envs = gymnasium.make_vec(f"sandbox/{name}-v0", num_envs=ENVIRONMENTS, autoreset_mode="SameStep", **options)
    envs.action_space.seed(0)
    envs.reset(seed=0)
    episodes, start = 0, process_time()
    while process_time() - start < SECONDS:
        episodes += int(envs.step(envs.action_space.sample())[2].sum())
    return episodes / (process_time() - start)


def main() -> None:
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


def _said(target: int | None) -> str:
    return "" if target is None else f"{target:,}"


if __name__ == "__main__":
    main()
