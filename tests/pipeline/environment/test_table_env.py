"""Environments over a table: what they show, what a try is worth, and equal episodes for equal seeds."""

import copy
import multiprocessing
import pickle
from pathlib import Path
from typing import Any

import gymnasium
import holdfast  # noqa: F401 - whoever makes an environment by name imports it
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env, data_equivalence
from holdfast.errors import InputError, UnknownName
from holdfast.pipeline.choice import ChoiceData
from holdfast.pipeline.env import make_grasp_choice, make_grasp_choice_sequential
from holdfast.pipeline.environment import ChoiceEnv, Table

from ..choice.synthetic import make_choice_data

NAMES = ("Holdfast/GraspChoice-v0", "Holdfast/GraspChoiceSequential-v0")


@pytest.fixture(scope="module")
def data() -> ChoiceData:
    return make_choice_data(groups=30, candidates=6)


def rollout(env: gymnasium.Env[Any, Any], seed: int, steps: int = 20) -> list[Any]:
    env.action_space.seed(seed)
    seen: list[Any] = [env.reset(seed=seed)]
    for _ in range(steps):
        seen.append(env.step(env.action_space.sample()))
        if seen[-1][2]:
            seen.append(env.reset())
    return seen


@pytest.mark.parametrize("name", NAMES)
def test_gymnasium_has_no_complaints(name: str, data: ChoiceData) -> None:
    check_env(gymnasium.make(name, dataset=data).unwrapped)


def test_stable_baselines_has_no_complaints(data: ChoiceData) -> None:
    checker = pytest.importorskip("stable_baselines3.common.env_checker")
    # It advises to flatten what has two axes, as the features of K candidates do.
    checker.check_env(make_grasp_choice(dataset=data), warn=False)


@pytest.mark.parametrize("make", [make_grasp_choice, make_grasp_choice_sequential])
def test_equal_seeds_make_equal_episodes(make: Any, data: ChoiceData) -> None:
    assert data_equivalence(rollout(make(dataset=data), 5), rollout(make(dataset=data), 5))
    assert not data_equivalence(rollout(make(dataset=data), 5), rollout(make(dataset=data), 6))


@pytest.mark.parametrize("copied", [copy.deepcopy, lambda env: pickle.loads(pickle.dumps(env))])
def test_a_copy_goes_on_as_the_original_does(copied: Any, data: ChoiceData) -> None:
    env = make_grasp_choice_sequential(dataset=data)
    for seed in range(20):
        env.reset(seed=seed)
        if not env.step(np.int64(0))[2]:
            break
    other = copied(env)
    assert data_equivalence(env.step(np.int64(1)), other.step(np.int64(1)))
    assert data_equivalence(env.reset(), other.reset())


def test_an_episode_is_a_group_and_a_draw_of_it(data: ChoiceData) -> None:
    env = make_grasp_choice(dataset=data, candidates=4)
    assert isinstance(env, ChoiceEnv)
    rows = {name: k for k, name in enumerate(data.candidate_ids.tolist())}
    groups, places = set(), set()
    for seed in range(60):
        observation, info = env.reset(seed=seed)
        assert env.observation_space.contains(observation)
        chosen = [rows[name] for name in info["candidates"]]
        assert len(set(chosen)) == 4 and len(set(data.group[chosen].tolist())) == 1
        assert np.array_equal(observation["candidates"], data.features[chosen])
        assert np.array_equal(observation["object"], data.object_features[data.object_index[chosen[0]]])
        _, reward, terminated, truncated, end = env.step(np.int64(2))
        conditions = np.array(list(end["conditions"].values()), dtype=np.float32)
        group = data.group[chosen[0]]
        (draw,) = np.flatnonzero((data.conditions[group] == conditions).all(axis=1))
        assert reward == float(data.held[chosen[2], draw, 0]) and (terminated, truncated) == (True, False)
        assert end["margin"] == pytest.approx(data.margin[chosen[2], draw, 0])
        groups.add(int(group))
        places.add(chosen[2] - data.starts[group])
    assert len(groups) > 15 and places == set(range(6))  # all groups, and no place is a candidate's own


def test_bounds_hold_over_many_resets(data: ChoiceData) -> None:
    env = make_grasp_choice(dataset=data)
    env.reset(seed=0)
    assert all(env.observation_space.contains(env.reset()[0]) for _ in range(10_000))


def test_rows_without_a_candidate_are_masked(data: ChoiceData) -> None:
    env = make_grasp_choice(dataset=data, candidates=9)
    observation, _ = env.reset(seed=0)
    assert observation["mask"].tolist() == [1] * 6 + [0] * 3
    assert not observation["candidates"][6:].any()
    assert np.array_equal(env.action_masks(), observation["mask"].astype(bool))
    _, reward, terminated, _, info = env.step(np.int64(8))
    assert (reward, terminated, info["outcome"]) == (0.0, True, "invalid")


def test_the_load_decides(data: ChoiceData) -> None:
    held = {}
    for load in data.loads:
        env = make_grasp_choice(dataset=data, load=load)
        env.reset(seed=0)
        held[load] = [env.step(np.int64(0))[1] for _ in range(300) if env.reset()]
    assert np.mean(held[1.0]) == pytest.approx(data.held[..., 0].mean(), abs=0.1)
    assert np.mean(held[2.0]) == pytest.approx(data.held[..., 1].mean(), abs=0.1)
    assert all(a >= b for a, b in zip(held[1.0], held[2.0], strict=True))


@pytest.mark.parametrize(("reward", "cost"), [("held", 0.0), ("held", 0.2), ("margin", 0.0), ("margin", 0.3)])
def test_what_a_try_is_worth(reward: str, cost: float, data: ChoiceData) -> None:
    env = make_grasp_choice(dataset=data, reward=reward, cost=cost)
    for seed in range(20):
        env.reset(seed=seed)
        _, worth, _, _, info = env.step(np.int64(1))
        assert worth == pytest.approx((float(info["held"]) if reward == "held" else info["margin"]) - cost)


def test_tries_go_on_until_one_is_held(data: ChoiceData) -> None:
    env = make_grasp_choice_sequential(dataset=data, tries=3, cost=0.1)
    lengths = []
    for seed in range(80):
        observation, _ = env.reset(seed=seed)
        for number in range(1, 4):
            action = np.int64(observation["mask"].argmax())
            observation, reward, terminated, _, info = env.step(action)
            assert reward == pytest.approx(float(info["held"]) - 0.1)
            assert observation["tried"].sum() == number and observation["mask"][action] == 0
            assert observation["margin"][action] == np.float32(info["margin"])
            assert ("conditions" in info) == terminated
            assert terminated == (info["held"] or number == 3)
            if terminated:
                lengths.append(number)
                break
    assert set(lengths) == {1, 2, 3}


def test_what_was_tried_before_is_worth_nothing(data: ChoiceData) -> None:
    env = make_grasp_choice_sequential(dataset=data, tries=3)
    for seed in range(40):
        env.reset(seed=seed)
        if env.step(np.int64(0))[4]["held"]:
            continue
        _, reward, terminated, _, info = env.step(np.int64(0))
        assert (reward, terminated, info["outcome"]) == (0.0, False, "invalid")
        return
    pytest.fail("every candidate was held")


def test_what_is_seen_is_not_changed_later(data: ChoiceData) -> None:
    env = make_grasp_choice_sequential(dataset=data)
    first, _ = env.reset(seed=0)
    kept = copy.deepcopy(first)
    env.step(np.int64(0))
    env.reset()
    assert data_equivalence(first, kept)


@pytest.mark.parametrize("action", [-1, 8, 1.5])
def test_an_action_that_does_not_exist_is_an_error(action: float, data: ChoiceData) -> None:
    env = make_grasp_choice(dataset=data)
    env.reset(seed=0)
    with pytest.raises(gymnasium.error.InvalidAction):
        env.step(action)  # type: ignore[arg-type]


def test_steps_need_a_reset(data: ChoiceData) -> None:
    env = make_grasp_choice(dataset=data)
    for use in (lambda: env.step(np.int64(0)), env.action_masks):
        with pytest.raises(gymnasium.error.ResetNeeded):
            use()
    env.reset(seed=0)
    env.step(np.int64(0))
    with pytest.raises(gymnasium.error.ResetNeeded):
        env.step(np.int64(0))


def test_a_part_of_a_split_has_its_objects_alone(data: ChoiceData) -> None:
    table = Table(data, split="test")
    env = ChoiceEnv(table)
    objects = {env.reset(seed=seed)[1]["object"] for seed in range(100)}
    test_objects = data.object_ids[data.object_index[data.split == "test"]]
    assert objects == set(test_objects.tolist())
    hands = {ChoiceEnv(Table(data, split="test", by="hand")).reset(seed=s)[1]["hand"] for s in range(20)}
    assert hands == {"shadow"}


def test_misuse_is_named(data: ChoiceData, tmp_path: Path) -> None:
    for options, match in (
        ({"backend": "tabel"}, "did you mean 'table'"),
        ({"datset": data}, "did you mean 'dataset'"),
        ({"candiates": 3}, "did you mean 'candidates'"),
        ({"candidates": 10**9}, "candidates: must be at most"),
        ({"dataset": 3}, "dataset: must be a path"),
        ({"objects": ["teapot"]}, "objects: goes with backend='physics'"),
        ({"dataset": data, "split": "testing"}, "did you mean 'test'"),
        ({"dataset": data, "load": 3.0}, r"one of 1\.0, 2\.0"),
        ({"dataset": data, "reward": "hold"}, "did you mean 'held'"),
        ({"dataset": data, "cost": -1.0}, "cost"),
        ({"dataset": data, "candidates": 0}, "candidates"),
        ({"dataset": data, "render_mode": "ansi"}, "render mode"),
        ({"dataset": tmp_path}, "is no data set"),
    ):
        with pytest.raises(InputError, match=match):
            make_grasp_choice(**options)
    with pytest.raises(InputError, match="tries"):
        make_grasp_choice_sequential(dataset=data, tries=1)
    with pytest.raises(UnknownName):
        gymnasium.make(NAMES[0], dataset=data, back_end="table")


@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_equal_seeds_make_equal_episodes_in_other_processes(method: str) -> None:
    expected = rollout(gymnasium.make(NAMES[1]), 11)
    envs = gymnasium.make_vec(
        NAMES[1],
        num_envs=2,
        vectorization_mode="async",
        vector_kwargs={"context": method, "autoreset_mode": gymnasium.vector.AutoresetMode.SAME_STEP},
    )
    try:
        observation, _ = envs.reset(seed=11)  # 11 and 12
        assert data_equivalence({name: values[0] for name, values in observation.items()}, expected[0][0])
        alone = gymnasium.make(NAMES[1])
        alone.reset(seed=11)
        for action in (0, 1):
            _, rewards, terminated, _, _ = envs.step(np.array([action, action]))
            _, reward, ended, _, _ = alone.step(np.int64(action))
            assert rewards[0] == reward and terminated[0] == ended
            if ended:
                break
    finally:
        envs.close()
        for child in multiprocessing.active_children():
            child.join(10.0)
