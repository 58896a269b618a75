"""Tasks as Gymnasium environments: spaces, rewards, seeds, many at once."""

from __future__ import annotations

import importlib.util
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers import vector as wrapped

import sandbox.gym
from sandbox.errors import RequestError
from sandbox.gym import TaskEnv, environment_id, register
from sandbox.tasks import tasks
from tests.tasks.test_task import DIAGONAL, direction

ROOT = Path(__file__).resolve().parents[2]
IN = {"launch.speed": 7.4, "launch.angle": 52.0}


@pytest.fixture
def diagonal(tmp_path: Path) -> TaskEnv:
    """Two shots: the 1 into a corner, the 8 into the opposite one."""
    file = tmp_path / "diagonal.toml"
    file.write_text(DIAGONAL)
    return TaskEnv(str(file))


@pytest.mark.parametrize("name", ["FreeThrow", "EightBall"])
def test_an_environment_follows_gymnasiums_rules(name: str):
    """With all its warnings: pytest makes them errors."""
    check_env(gymnasium.make(f"sandbox/{name}-v0", render_mode="rgb_array", size=(320, 180)).unwrapped)


def test_every_task_is_registered():
    assert environment_id("free-throw") == "sandbox/FreeThrow-v0"
    assert {environment_id(name) for name in tasks()} <= gymnasium.registry.keys()


def test_a_file_of_ones_own_is_registered(tmp_path: Path):
    file = tmp_path / "my_corner-shot.toml"
    file.write_text(DIAGONAL)
    env = gymnasium.make(register(file))
    assert env.spec is not None
    assert env.spec.id == "sandbox/MyCornerShot-v0"
    assert env.reset(seed=1)[0].shape == (9,)
    with pytest.raises(RequestError, match=r"nowhere\.toml: cannot be read"):
        register(tmp_path / "nowhere.toml")


def test_reward_and_info_are_those_of_the_shot():
    env = TaskEnv("free-throw", noise=False)
    observation, _ = env.reset(options={"start": {"release.height": 2.1336}})
    assert observation == pytest.approx([2.1336])
    _, reward, terminated, truncated, info = env.step(env.course.action_of({"launch.speed": 7.44, "launch.angle": 52}))
    assert (reward, terminated, truncated, info["is_success"], info["verdict"]) == (1.0, True, False, True, "swish")
    assert info["controls"] == pytest.approx({"launch.speed": 7.44, "launch.angle": 52.0}, abs=1e-5)
    with pytest.raises(ResetNeeded, match="over"):
        env.step(env.action_space.low)
    env.reset()
    _, reward, _, _, info = env.step(env.action_space.low)
    assert (reward, info["made"], info["controls"]["launch.angle"]) == (0.0, False, 30.0)


def test_a_seed_gives_the_same_start_and_aim():
    def played(seed: int) -> list[float]:
        env = TaskEnv("free-throw")
        first = env.reset(seed=seed)[0]
        speed = env.step(env.course.action_of(IN))[4]["controls"]["launch.speed"]
        return [*first, speed, *env.reset()[0]]

    assert played(5) == played(5)
    assert not set(played(5)) & set(played(6))


def test_the_nearest_is_rewarded_by_minus_its_distance():
    env = TaskEnv("closest-to-the-pin")
    env.reset(seed=0)
    _, reward, _, _, info = env.step(env.action_space.sample())
    assert reward == -min(info["distance_to_pin"], 50.0)


def test_an_attempt_of_several_shots_has_several_steps(diagonal: TaskEnv):
    observation, _ = diagonal.reset(seed=0)
    assert observation == pytest.approx([0.7, 0.35, 1, 1.1, 0.55, 1, -1.1, -0.55, 1])
    action = diagonal.course.action_of({"cue.angle": direction(observation[:2], observation[3:5])})
    observation, reward, terminated, _, info = diagonal.step(action)
    assert (reward, terminated, info["potted"], observation[5], observation[8]) == (1.0, False, ["1"], 0.0, 1.0)
    assert observation[3:5].tolist() == [0.0, 0.0]  # where the potted ball was
    assert observation in diagonal.observation_space
    aim = {"cue.angle": direction(observation[:2], observation[6:8]), "cue.speed": 1.2, "cue.follow": -0.1}
    _, reward, terminated, _, info = diagonal.step(diagonal.course.action_of(aim))
    assert (reward, terminated, info["potted"]) == (1.0, True, ["8"])


def test_a_shot_that_cannot_be_played_ends_the_attempt(tmp_path: Path):
    file = tmp_path / "spun.toml"
    file.write_text(DIAGONAL + '[[controls]]\nkey = "cue.english"\nlow = -0.5\nhigh = 0.5\n')
    env = TaskEnv(str(file))
    env.reset(seed=0)
    _, reward, terminated, _, info = env.step(np.array([0.0, 0.0, -1.0, 1.0], np.float32))
    assert (reward, terminated, info["is_success"]) == (0.0, True, False)
    assert "it slips off" in info["error"]


def test_a_frame_shows_the_start_and_then_the_shot():
    env = TaskEnv("free-throw", render_mode="rgb_array", size=(320, 180))
    env.reset(seed=2)
    before = env.render()
    env.step(env.course.action_of(IN))
    after = env.render()
    assert before.shape == after.shape == (180, 320, 3)
    assert before.dtype == np.uint8
    assert (before != after).any()


def test_many_at_once_play_what_each_plays_alone():
    options = {"noise": False, "facts": ("entry_angle",), "autoreset_mode": "SameStep"}
    envs = gymnasium.make_vec("sandbox/FreeThrow-v0", 40, "vector_entry_point", **options)
    assert envs.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    observations, _ = envs.reset(seed=3)
    envs.action_space.seed(3)
    actions = envs.action_space.sample()
    actions[:9] = TaskEnv("free-throw").course.action_of(IN)
    following, rewards, terminations, truncations, infos = envs.step(actions)
    alone = TaskEnv("free-throw", noise=False)
    for place, action in enumerate(actions):
        alone.reset(options={"start": {"release.height": float(observations[place, 0])}})
        _, reward, _, _, info = alone.step(action)
        assert rewards[place] == reward
        angle = np.nan if info["entry_angle"] is None else info["entry_angle"]
        assert infos["final_info"]["entry_angle"][place] == pytest.approx(angle, abs=1e-4, nan_ok=True)
    assert 0 < rewards.sum() < 20
    assert (terminations.all(), truncations.any()) == (True, False)
    assert np.stack(infos["final_obs"]).tolist() == observations.tolist()
    assert not (following == observations).any()


@pytest.mark.parametrize("name", ["FreeThrow", "ParTwo"])
def test_the_same_seeds_are_the_same_attempts_as_alone(name: str):
    """With start, noise and reward, also in those that begin anew."""
    envs = gymnasium.make_vec(f"sandbox/{name}-v0", 3, "vector_entry_point", autoreset_mode="SameStep")
    alone = [gymnasium.make(f"sandbox/{name}-v0") for _ in range(3)]
    envs.action_space.seed(0)
    observations = envs.reset(seed=7)[0]
    assert observations.tolist() == [env.reset(seed=7 + place)[0].tolist() for place, env in enumerate(alone)]
    over = 0
    for _ in range(4):
        actions = envs.action_space.sample()
        observations, rewards, terminations, _, _ = envs.step(actions)
        for place, env in enumerate(alone):
            observation, reward, terminated, _, _ = env.step(actions[place])
            over += terminated
            if terminated:
                observation = env.reset()[0]
            assert (rewards[place], terminations[place]) == (pytest.approx(reward), terminated)
            assert observations[place] == pytest.approx(observation)
    assert over >= 3
    assert envs.reset(seed=[9, 8, 7])[0][2].tolist() == alone[0].reset(seed=7)[0].tolist()


def test_an_environment_can_be_pickled(diagonal: TaskEnv):
    diagonal.reset(seed=4)
    copy = pickle.loads(pickle.dumps(diagonal))
    action = np.array([0.1, 0.2, 0.3], np.float32)
    assert [value.tolist() for value in (copy.step(action)[0], copy.reset()[0])] == [
        value.tolist() for value in (diagonal.step(action)[0], diagonal.reset()[0])
    ]


def test_a_start_can_be_set_for_all_at_once():
    envs = sandbox.gym.TaskVectorEnv(3, "free-throw")
    observations, _ = envs.reset(seed=0, options={"start": {"release.height": 2.1}})
    assert observations == pytest.approx(np.full((3, 1), 2.1))


@pytest.mark.parametrize(
    ("action", "said"),
    [
        (
            [0.0],
            r"action: has shape \(1,\), must have \(2,\): a number from -1 to 1 for each of launch.speed, launch.ang",
        ),
        ([0.0, np.nan], "action: has nan, must have a number from -1 to 1"),
        (["hard", "high"], r"action: has shape \(\), must have \(2,\)"),
    ],
)
def test_what_is_no_action_is_refused(action: list[object], said: str):
    env, envs = TaskEnv("free-throw"), sandbox.gym.TaskVectorEnv(2, "free-throw")
    for each in (env, envs):
        with pytest.raises(ResetNeeded):
            each.step(each.action_space.sample())
        each.reset(seed=0)
    with pytest.raises(RequestError, match=said):
        env.step(action)  # type: ignore[arg-type]
    with pytest.raises(RequestError, match=r"^action: has "):
        envs.step([action, action])


@pytest.mark.parametrize(
    ("start", "said"),
    [
        ({"release.height": 9.0}, "release.height = 9.0: must be between 1.95 and 2.3 m"),
        ({"release.height": "two"}, "release.height = 'two': must be between 1.95 and 2.3 m"),
        ({"hoop.height": 3.0}, "hoop.height is not drawn; choose from release.height"),
    ],
)
def test_a_start_that_is_not_drawn_is_refused(start: dict[str, object], said: str):
    for env in (TaskEnv("free-throw"), sandbox.gym.TaskVectorEnv(2, "free-throw")):
        with pytest.raises(RequestError, match=said):
            env.reset(options={"start": start})


def test_attempts_of_several_shots_go_on_side_by_side(tmp_path: Path):
    file = tmp_path / "diagonal.toml"
    file.write_text(DIAGONAL)
    envs = sandbox.gym.TaskVectorEnv(2, str(file), autoreset_mode="SameStep")
    observations, _ = envs.reset(seed=0)
    action = envs.course.action_of({"cue.angle": direction(observations[0, :2], observations[0, 3:5])})
    miss = envs.course.action_of({"cue.angle": 90.0})
    observations, rewards, terminations, _, infos = envs.step(np.array([action, miss]))
    assert (rewards.tolist(), terminations.tolist()) == ([1.0, 0.0], [False, True])
    assert (observations[:, 5].tolist(), infos["potted"][0]) == ([0.0, 1.0], ["1"])
    assert (infos["_potted"].tolist(), infos["_final_info"].tolist()) == ([True, False], [False, True])
    aim = {"cue.angle": direction(observations[0, :2], observations[0, 6:8]), "cue.speed": 1.2, "cue.follow": -0.1}
    observations, rewards, terminations, _, infos = envs.step(np.array([envs.course.action_of(aim), action]))
    assert (rewards.tolist(), terminations.tolist()) == ([1.0, 1.0], [True, False])
    assert (infos["final_obs"][0][5], observations[0, 5]) == (0.0, 1.0)
    _, rewards, terminations, _, _ = envs.step(np.array([action, miss]))  # the first has begun anew
    assert (rewards.tolist(), terminations.tolist()) == ([1.0, 0.0], [False, True])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"task": "free-thro"}, "unknown task free-thro; did you mean free-throw?"),
        ({"task": "free-throw", "render_mode": "human"}, 'must be "rgb_array", or None'),
        ({"task": "free-throw", "accuracy": "fats"}, 'accuracy accuracy.level = "fats": must be "fast"'),
        ({"task": "free-throw", "facts": ("apexx",)}, "basketball has no apexx; choose from made, verdict"),
        ({"task": "free-throw", "size": (640.5, 360)}, "size = (640.5, 360): must be two whole numbers"),
    ],
)
def test_a_wrong_request_is_refused_in_a_line(arguments: dict[str, object], said: str):
    with pytest.raises(RequestError) as refused:
        TaskEnv(**arguments)  # type: ignore[arg-type]
    assert said in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [({"num_envs": 0}, "num_envs = 0: "), ({"num_envs": 2, "autoreset_mode": "Never"}, "autoreset_mode = 'Never': ")],
)
def test_wrong_arguments_for_many_are_refused(arguments: dict[str, Any], said: str):
    with pytest.raises(RequestError, match=f"^{said}must be "):
        sandbox.gym.TaskVectorEnv(task="free-throw", **arguments)


def test_the_policy_of_the_page_follows_the_reward():
    """Its mean goes to the actions that are rewarded, each by its own observation, and its deviation falls."""
    found = importlib.util.spec_from_file_location("learn", ROOT / "docs" / "learn_free_throws.py")
    learn = importlib.util.module_from_spec(found)
    found.loader.exec_module(learn)
    policy = learn.Policy(sandbox.gym.TaskVectorEnv(2, "free-throw"))
    random, low, high = np.random.default_rng(0), policy.low, policy.high
    for _ in range(60):
        observations = random.uniform(low, high, (500, 1))
        actions = random.normal(policy.mean(observations), np.exp(policy.log_sd))
        wanted = 0.3 * policy.features(observations)[:, 1:]
        policy.learn(observations, actions, (np.abs(actions - wanted).max(axis=1) < 0.2).astype(float))
    ends = policy.mean(np.array([low, high]))
    assert ends == pytest.approx(np.array([[-0.3, -0.3], [0.3, 0.3]]), abs=0.15)
    assert np.exp(policy.log_sd).max() < 0.25


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled", None])
@pytest.mark.parametrize("name", ["FreeThrow", "ParTwo"])
def test_each_autoreset_mode_is_that_of_gymnasium(name: str, mode: str | None):
    """Shot for shot what ``SyncVectorEnv`` does with single environments: observations, rewards, ends and facts."""
    chosen = {} if mode is None else {"autoreset_mode": mode}  # NextStep is the default, as in Gymnasium
    ours = gymnasium.make_vec(f"sandbox/{name}-v0", 4, **chosen)
    sync = {} if mode is None else {"vector_kwargs": chosen}
    theirs = gymnasium.make_vec(f"sandbox/{name}-v0", 4, "sync", **sync)
    assert ours.metadata["autoreset_mode"] is theirs.metadata["autoreset_mode"]
    assert (ours.reset(seed=5)[0] == theirs.reset(seed=5)[0]).all()
    ours.action_space.seed(1)
    for _ in range(5):
        actions = ours.action_space.sample()
        found, expected = ours.step(actions), theirs.step(actions)
        for one, other in zip(found[:4], expected[:4], strict=True):
            assert one == pytest.approx(other)
        for infos, others in (
            (found[4], expected[4]),
            *[(each[4].get("final_info", {}) for each in (found, expected))],
        ):
            assert infos.get("is_success", np.zeros(4)).tolist() == others.get("is_success", np.zeros(4)).tolist()
            assert infos.get("_controls", np.zeros(4)).tolist() == others.get("_controls", np.zeros(4)).tolist()
        over = found[2] | found[3]
        if mode == "Disabled" and over.any():
            with pytest.raises(ResetNeeded, match=r"attempts [0-9, ]+ are over: .*reset_mask"):
                ours.step(actions)
            began = [envs.reset(options={"reset_mask": over.copy()})[0] for envs in (ours, theirs)]
            assert began[0] == pytest.approx(began[1])


@pytest.mark.parametrize("mode", ["NextStep", "Disabled", None])
def test_gymnasiums_own_vector_wrappers_take_the_environment(mode: str | None):
    chosen = {} if mode is None else {"autoreset_mode": mode}
    low, high = np.zeros(1, np.float32), np.ones(1, np.float32)
    wrappers = [
        wrapped.FlattenObservation,
        lambda envs: wrapped.RescaleObservation(envs, low, high),
        *([] if mode == "Disabled" else [wrapped.NormalizeObservation]),  # it takes NextStep alone
    ]
    for wrap in wrappers:
        envs = wrap(gymnasium.make_vec("sandbox/FreeThrow-v0", 8, **chosen))
        observations = [envs.reset(seed=0)[0]]
        for _ in range(3):
            observations.append(envs.step(envs.action_space.sample())[0])
            if mode == "Disabled":
                envs.reset(options={"reset_mask": np.ones(8, bool)})
        assert np.array(observations).shape == (4, 8, 1)
        assert np.isfinite(observations).all()
        assert envs.observation_space.contains(observations[-1])


def test_a_mask_begins_only_the_attempts_it_names():
    envs = sandbox.gym.TaskVectorEnv(3, "free-throw")
    before = envs.reset(seed=2)[0]
    options = {"reset_mask": np.array([False, True, False]), "start": {"release.height": 2.1}}
    after = envs.reset(seed=[1, 2, 3], options=options)[0]
    assert (after == before)[:, 0].tolist() == [True, False, True]
    assert after[1] == pytest.approx([2.1])
    assert set(options) == {"reset_mask", "start"}  # as it was given
    for mask in ([True, False], [1, 0, 1], np.zeros(3, bool), "all"):
        with pytest.raises(RequestError, match=r"reset_mask = .*: must be an array of 3 booleans, one at least True"):
            envs.reset(options={"reset_mask": mask})


@pytest.mark.parametrize("make", [lambda: TaskEnv("free-throw"), lambda: sandbox.gym.TaskVectorEnv(2, "free-throw")])
def test_a_seed_is_any_whole_number(make: Callable[[], Any]):
    env = make()
    first = env.reset(seed=4)[0]
    assert (env.reset(seed=np.int64(4))[0] == first).all()
    assert (env.reset(seed=np.uint8(4))[0] == first).all()
    for wrong in (-1, 4.0, "4"):
        with pytest.raises(RequestError, match=f"^seed = {wrong!r}: must be a whole number, not negative"):
            env.reset(seed=wrong)
    with pytest.raises(RequestError, match="options: there is no 'begin'"):
        env.reset(options={"begin": 1})


def test_seeds_of_all_may_be_an_array():
    envs = sandbox.gym.TaskVectorEnv(2, "free-throw")
    one = envs.reset(seed=np.array([4, 5]))[0]
    assert (envs.reset(seed=4)[0] == one).all()
    with pytest.raises(RequestError, match="seed: 3 seeds for 2 attempts"):
        envs.reset(seed=np.arange(3))


def test_a_reset_that_is_refused_is_none():
    envs = sandbox.gym.TaskVectorEnv(2, "free-throw")
    with pytest.raises(RequestError):
        envs.reset(options={"start": {"release.height": 9.0}})
    with pytest.raises(ResetNeeded):
        envs.step(envs.action_space.sample())


def test_a_last_shot_that_is_missed_costs_one_more():
    """Where the fewest shots count: three at most, of which each costs one."""
    env, envs = TaskEnv("par-two", noise=False), sandbox.gym.TaskVectorEnv(1, "par-two", noise=False)
    env.reset(seed=1)
    envs.reset(seed=1)
    away = env.course.action_of({"launch.speed": 0.3, "launch.angle": -90.0})
    steps = [env.step(away) for _ in range(3)]
    assert [(reward, terminated) for _, reward, terminated, *_ in steps] == [(-1.0, False), (-1.0, False), (-2.0, True)]
    assert [envs.step(away[np.newaxis])[1][0] for _ in range(3)] == [-1.0, -1.0, -2.0]
