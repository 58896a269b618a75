"""Learns free throws with a small policy gradient in numpy: ``python docs/learn_free_throws.py``, under a minute.

REINFORCE (Williams 1992, Machine Learning 8:229): actions are normally distributed around a mean that is linear in the
observation, and mean and standard deviation follow the gradient of the log-likelihood, weighted by the advantage of
each throw over the mean of its batch. Nothing is known of the physics but the reward: 1 for a throw that goes in.
The policy is compared with random throws, and with an oracle: for each height of release the speed that ``sandbox.aim``
finds to go in with the most room.
"""

from __future__ import annotations

from time import process_time
from typing import Any

import click
import gymnasium
import numpy as np

import sandbox
from sandbox.gym import TaskVectorEnv

#: Throws of one update, updates, and step of the gradient for the mean and for the logarithm of the deviation.
BATCH, UPDATES, MEAN_STEP, SPREAD_STEP = 1_024, 100, 0.15, 0.08
#: Standard deviation of an action at first, and the least.
FIRST, LEAST = 0.5, 0.02
#: The angle of the oracle's throws, in deg: that of the best free throw (Tran & Silverberg 2008).
ANGLE = 52.0
#: Throws for each share that is printed.
THROWS = 4_096


class Policy:
    """Actions ~ N(weights · (1, x), deviation), x the observation scaled to -1 ... 1."""

    def __init__(self, envs: TaskVectorEnv) -> None:
        space = envs.single_observation_space
        self.low, self.high = space.low, space.high
        self.weights = np.zeros((space.shape[0] + 1, envs.single_action_space.shape[0]))
        self.log_sd = np.full(self.weights.shape[1], np.log(FIRST))

    def features(self, observations: Any) -> np.ndarray:
        """Rows of (1, x), shape (throws, observations + 1)."""
        x = 2.0 * (observations - self.low) / (self.high - self.low) - 1.0
        return np.hstack([np.ones((len(x), 1)), x])

    def mean(self, observations: Any) -> np.ndarray:
        """The best action for each observation, shape (throws, controls)."""
        return np.asarray(self.features(observations) @ self.weights)

    def learn(self, observations: Any, actions: Any, rewards: Any) -> None:
        """One step along the gradient, by what was done and what it gave; natural in the mean, whose step is in units
        of the deviation."""
        sd = np.exp(self.log_sd)
        advantage = (rewards - rewards.mean()) / (rewards.std() + 1e-6)
        z = (actions - self.mean(observations)) / sd
        self.weights += MEAN_STEP * sd * (self.features(observations).T @ (advantage[:, None] * z)) / len(rewards)
        self.log_sd += SPREAD_STEP * np.mean(advantage[:, None] * (z * z - 1.0), axis=0)
        self.log_sd = np.clip(self.log_sd, np.log(LEAST), np.log(FIRST))


def oracle(envs: TaskVectorEnv, heights: int = 6) -> np.ndarray:
    """Actions at evenly spaced heights of release, by ``sandbox.aim``: the middle of the widest interval of speeds that
    go in at 52 degrees; with the heights in the first column, shape (heights, 1 + controls)."""
    task = envs.course.task
    start, speed, rows = task.start[0], task.controls[0], []
    for height in np.linspace(start.low, start.high, heights):
        scene = task.scene.changed({start.key: float(height), "launch.angle": ANGLE})
        best = sandbox.aim(scene, {speed.key: (speed.low, speed.high)}, {"made": True}).solutions[0]
        rows.append([height, *envs.course.action_of({**best.values, "launch.angle": ANGLE})])
    return np.array(rows)


def share(envs: TaskVectorEnv, act: Any) -> float:
    """The share of throws that go in, with the noise of the task's aim."""
    observations, _ = envs.reset(seed=99)
    made = 0.0
    for _ in range(THROWS // BATCH):
        observations, rewards, *_ = envs.step(act(observations))
        made += rewards.sum()
    return made / (THROWS // BATCH * BATCH)


def main() -> None:
    envs: Any = gymnasium.make_vec("sandbox/FreeThrow-v0", BATCH, autoreset_mode="SameStep")
    envs.action_space.seed(0)
    random = np.random.default_rng(0)
    by_chance = share(envs, lambda observations: envs.action_space.sample())
    policy, start = Policy(envs), process_time()
    observations, _ = envs.reset(seed=0)
    for update in range(UPDATES):
        mean = policy.mean(observations)
        actions = random.normal(mean, np.exp(policy.log_sd))
        following, rewards, *_ = envs.step(actions.astype(np.float32))
        policy.learn(observations, np.clip(actions, -1.0, 1.0), rewards)
        observations = following
        if update % 20 == 19:
            click.echo(f"{(update + 1) * BATCH:>7,} throws  {100 * rewards.mean():4.0f} % in while learning")
    spent = process_time() - start
    learned = share(envs, lambda observations: policy.mean(observations).astype(np.float32))
    known = oracle(envs)

    def by_aim(observations: Any) -> np.ndarray:
        columns = [np.interp(observations[:, 0], known[:, 0], column) for column in known[:, 1:].T]
        return np.stack(columns, axis=1).astype(np.float32)

    click.echo(
        f"random policy {100 * by_chance:.1f} %, learned {100 * learned:.0f} % in {spent:.0f} s of processor time"
    )
    click.echo(f"oracle, by sandbox aim at 52 deg: {100 * share(envs, by_aim):.0f} %")


if __name__ == "__main__":
    main()
