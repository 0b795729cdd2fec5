"""The environment: Gymnasium's own check, seeds, masks, rewards, and what an action means."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import gymnasium
import holdfast.pipeline.environment.known_task_env as module
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence
from holdfast.errors import InputError, UnknownName
from holdfast.mjcf import HoldSettings, hold_test
from holdfast.pipeline.choice.candidate_pool import load_pool
from holdfast.pipeline.choice.features import LIMIT, feature_names
from holdfast.pipeline.env import ENV_ID, FRICTIONS, WEIGHTS, GraspChoiceEnv

SMALL = {"task": "upholding", "candidates": 4, "pool": 8}


@pytest.fixture(scope="module")
def cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("pools")


def make(cache: Path, **changes: Any) -> gymnasium.Env[Any, Any]:
    return gymnasium.make(ENV_ID, cache=cache, **{**SMALL, **changes})


def rollout(env: gymnasium.Env[Any, Any], seed: int, episodes: int) -> list[Any]:
    env.action_space.seed(seed)
    seen: list[Any] = [env.reset(seed=seed)]
    for _ in range(episodes):
        seen.append(env.step(env.action_space.sample()))
        seen.append(env.reset())
    return seen


def test_gymnasium_has_no_complaints(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_PICTURE", (60, 80))  # rays are slow
    check_env(make(cache, render_mode="rgb_array").unwrapped)


def test_two_rollouts_of_one_seed_are_equal(cache: Path) -> None:
    assert data_equivalence(rollout(make(cache), 7, 6), rollout(make(cache), 7, 6))


def test_seeds_differ(cache: Path) -> None:
    env = make(cache)
    infos = [env.reset(seed=seed)[1] for seed in range(20)]
    assert len({tuple(info["candidates"]) for info in infos}) > 10
    assert {info["friction_factor"] for info in infos} == set(FRICTIONS)
    assert {info["weight_factor"] for info in infos} == set(WEIGHTS)
    assert len({tuple(info["gravity_direction"]) for info in infos}) > 3


def test_observations_are_what_they_say(cache: Path) -> None:
    env = make(cache)
    assert isinstance(env.unwrapped, GraspChoiceEnv)
    task, pool = env.unwrapped.task, {candidate.id: candidate for candidate in env.unwrapped.pool}
    names = feature_names(task)
    for seed in range(10):
        observation, info = env.reset(seed=seed)
        assert env.observation_space.contains(observation)
        assert observation["candidates"].shape == (4, len(names))
        assert np.array_equal(env.unwrapped.action_masks(), observation["mask"].astype(bool))
        assert observation["conditions"][0] == pytest.approx(info["friction_factor"])
        assert np.linalg.norm(observation["conditions"][2:]) == 1.0
        for row, valid, name in zip(
            observation["candidates"], observation["mask"], info["candidates"], strict=True
        ):
            assert bool(valid) == pool[name].is_valid
            assert np.array_equal(row, pool[name].features)
            assert np.abs(row[: len(task.hand.independent)]).max() <= 1.0 + 1e-6
            normals = [row[[names.index(f"contact_{i}_normal_{a}") for a in "xyz"]] for i in range(2)]
            assert np.linalg.norm(normals, axis=1) == pytest.approx(1.0, abs=1e-6)
        assert len(set(info["candidates"])) == 4
        assert observation["mask"].sum() > 0 and 4 - observation["mask"].sum() <= 1


def test_the_reward_is_the_hold_test(cache: Path) -> None:
    env = make(cache)
    assert isinstance(env.unwrapped, GraspChoiceEnv)
    pool = {candidate.id: candidate for candidate in env.unwrapped.pool}
    rewards = []
    for seed in range(24):
        observation, info = env.reset(seed=seed)
        action = int(np.flatnonzero(observation["mask"])[0])
        _, reward, terminated, truncated, end = env.step(action)
        grasp = pool[info["candidates"][action]].grasp
        conditions = replace(
            HoldSettings(),
            friction=info["friction_factor"] * HoldSettings().sliding_friction(env.unwrapped.task.object),
            directions=(tuple(info["gravity_direction"]),),
        )
        expected = hold_test(grasp, settings=conditions, load=info["weight_factor"])
        assert (terminated, truncated) == (True, False)
        assert reward == float(expected.held) and end["slip"] == expected.slip_m
        assert end["outcome"] == expected.directions[0].outcome.value
        rewards.append(reward)
    assert set(rewards) == {0.0, 1.0}  # neither always nor never


def test_an_invalid_action_is_worth_nothing(cache: Path) -> None:
    env = make(cache, candidates=10)  # more than the pool has
    for seed in range(20):
        observation, info = env.reset(seed=seed)
        for action in np.flatnonzero(observation["mask"] == 0):
            env.reset(seed=seed)
            _, reward, terminated, _, end = env.step(int(action))
            assert (reward, terminated, end["outcome"]) == (0.0, True, "invalid")
            assert "slip" not in end
        assert observation["mask"].min() == 0
        for row, name in zip(observation["candidates"], info["candidates"], strict=True):
            assert name or not row.any()


@pytest.mark.parametrize("action", [-1, 4, 1.5])
def test_an_action_that_does_not_exist_is_an_error(action: float, cache: Path) -> None:
    env = make(cache).unwrapped
    env.reset(seed=0)
    with pytest.raises(gymnasium.error.InvalidAction):
        env.step(action)


def test_an_episode_is_one_step_long(cache: Path) -> None:
    env = make(cache).unwrapped
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(0)
    env.reset(seed=0)
    env.step(0)
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(0)


def test_the_picture_shows_the_chosen_grasp(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_PICTURE", (60, 80))
    env = make(cache, render_mode="rgb_array")
    _, info = env.reset(seed=0)
    before = env.render()
    assert isinstance(before, np.ndarray) and before.shape == (60, 80, 3) and before.dtype == np.uint8
    env.step(3)
    assert info["candidates"][3] != info["candidates"][0]
    assert not np.array_equal(env.render(), before)


def test_the_pool_is_made_once(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    first = make(cache).reset(seed=1)
    monkeypatch.setattr("holdfast.pipeline.choice.candidate_pool.solve", None)
    assert data_equivalence(make(cache).reset(seed=1), first)
    with pytest.raises(TypeError):
        make(cache, pool=3).reset(seed=1)


def test_a_damaged_cache_is_made_again(tmp_path: Path) -> None:
    task = GraspChoiceEnv("upholding").task
    pool = load_pool(task, size=2, seed=0, settings=HoldSettings(), folder=tmp_path)
    (file,) = tmp_path.glob("*.json")
    whole = file.read_text("utf-8")
    file.write_text(whole[: len(whole) // 2], "utf-8")
    again = load_pool(task, size=2, seed=0, settings=HoldSettings(), folder=tmp_path)
    assert file.read_text("utf-8") == whole
    assert [c.id for c in again] == [c.id for c in pool]


def test_features_stay_within_the_limits(cache: Path) -> None:
    env = make(cache).unwrapped
    assert isinstance(env, GraspChoiceEnv)
    for candidate in env.pool:
        assert np.isfinite(candidate.features).all() and np.abs(candidate.features).max() <= LIMIT


def test_misuse_is_named() -> None:
    with pytest.raises(UnknownName, match="did you mean 'upholding'"):
        gymnasium.make(ENV_ID, task="upholdin")
    with pytest.raises(InputError, match="at least 1"):
        GraspChoiceEnv(candidates=0)
    with pytest.raises(InputError, match="rgb_array"):
        GraspChoiceEnv(render_mode="human")
    # What only the other environment has is not passed over in silence.
    for options, match in (
        ({"cost": 0.5}, "cost: can't be given together with a task"),
        ({"backend": "physics"}, "backend: can't be given"),
        ({"pol": 3}, "did you mean 'pool'"),
        ({"pool": 2.5}, "pool: must be a whole number"),
        ({"cache": 3}, "cache: must be a path"),
    ):
        with pytest.raises(InputError, match=match):
            gymnasium.make(ENV_ID, task="upholding", **options)


def test_vector_environments(cache: Path) -> None:
    """One-step episodes lose every other step unless they are reset in the same step."""
    env = gymnasium.vector.SyncVectorEnv(
        [lambda: make(cache)] * 2, autoreset_mode=gymnasium.vector.AutoresetMode.SAME_STEP
    )
    observation, _ = env.reset(seed=3)
    for _ in range(3):
        actions = observation["mask"].argmax(axis=1)
        observation, rewards, terminated, _, _ = env.step(actions)
        assert terminated.all() and set(rewards) <= {0.0, 1.0}
    env.close()
