"""Many environments over a table at once: the law of one holds in each, in every mode of autoreset."""

from typing import Any

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import data_equivalence
from gymnasium.vector import AutoresetMode
from holdfast.errors import InputError, UnknownName
from holdfast.pipeline.choice import ChoiceData
from holdfast.pipeline.env import make_grasp_choice_sequential_vector, make_grasp_choice_vector
from holdfast.pipeline.environment import TableVectorEnv

from ..choice.synthetic import make_choice_data

NAME = "Holdfast/GraspChoice-v0"
COUNT = 16


@pytest.fixture(scope="module")
def data() -> ChoiceData:
    return make_choice_data(groups=30, candidates=6)


def make(data: ChoiceData, mode: str, **options: Any) -> TableVectorEnv:
    return make_grasp_choice_vector(COUNT, dataset=data, autoreset_mode=mode, **options)


def row_of(data: ChoiceData, features: np.ndarray) -> int:
    (row,) = np.flatnonzero((data.features == features).all(axis=1))
    return int(row)


@pytest.mark.parametrize("mode", list(AutoresetMode))
def test_it_is_made_by_name_and_says_its_mode(mode: AutoresetMode, data: ChoiceData) -> None:
    envs = gymnasium.make_vec(NAME, num_envs=3, dataset=data, autoreset_mode=mode.value)
    assert isinstance(envs.unwrapped, TableVectorEnv) and envs.metadata["autoreset_mode"] is mode
    observation, _ = envs.reset(seed=0)
    assert envs.observation_space.contains(observation)


def test_equal_seeds_make_equal_episodes(data: ChoiceData) -> None:
    seen = []
    for _ in range(2):
        envs = make(data, "SameStep")
        seen.append([envs.reset(seed=4), *(envs.step(np.full(COUNT, k)) for k in range(4))])
    assert data_equivalence(seen[0], seen[1])


def test_each_is_a_group_whose_candidates_come_in_any_order(data: ChoiceData) -> None:
    envs = make(data, "SameStep", candidates=4)
    places = set()
    observation, _ = envs.reset(seed=0)
    for _ in range(10):
        for k in range(COUNT):
            rows = [row_of(data, features) for features in observation["candidates"][k]]
            assert len(set(rows)) == 4 and len(set(data.group[rows].tolist())) == 1
            assert np.array_equal(observation["object"][k], data.object_features[data.object_index[rows[0]]])
            places.add(rows[0] - data.starts[data.group[rows[0]]])
        observation, *_ = envs.step(np.zeros(COUNT, dtype=np.int64))
    assert places == set(range(6))


def test_rewards_are_those_of_the_table(data: ChoiceData) -> None:
    envs = make(data, "SameStep")
    observation, _ = envs.reset(seed=0)
    mean = []
    for _ in range(40):
        rows = [row_of(data, observation["candidates"][k, 1]) for k in range(COUNT)]
        observation, rewards, terminated, truncated, infos = envs.step(np.ones(COUNT, dtype=np.int64))
        assert terminated.all() and not truncated.any()
        for row, reward, margin in zip(rows, rewards, infos["margin"], strict=True):
            assert margin in data.margin[row, :, 0] and reward in data.held[row, :, 0].astype(float)
        mean.append(rewards.mean())
    assert np.mean(mean) == pytest.approx(data.held[..., 0].mean(), abs=0.1)


def test_next_step_resets_in_the_step_after_the_end(data: ChoiceData) -> None:
    envs = make(data, "NextStep")
    first, _ = envs.reset(seed=0)
    last, _, terminated, _, _ = envs.step(np.zeros(COUNT, dtype=np.int64))
    assert terminated.all() and data_equivalence(first, last)  # what was seen last is what was chosen from
    new, rewards, terminated, _, _ = envs.step(np.zeros(COUNT, dtype=np.int64))
    assert not terminated.any() and not rewards.any() and not data_equivalence(new, last)


def test_same_step_keeps_what_was_seen_last(data: ChoiceData) -> None:
    envs = make(data, "SameStep")
    first, _ = envs.reset(seed=0)
    new, _, terminated, _, infos = envs.step(np.zeros(COUNT, dtype=np.int64))
    assert terminated.all() and infos["_final_obs"].all()
    for k in range(COUNT):
        assert data_equivalence(infos["final_obs"][k], {name: values[k] for name, values in first.items()})
    assert not data_equivalence(first, new)


def test_disabled_waits_for_a_reset_of_those_that_ended(data: ChoiceData) -> None:
    envs = make_grasp_choice_sequential_vector(COUNT, dataset=data, tries=3, autoreset_mode="Disabled")
    envs.reset(seed=0)
    before, _, ended, _, _ = envs.step(np.zeros(COUNT, dtype=np.int64))
    assert 0 < ended.sum() < COUNT
    with pytest.raises(gymnasium.error.ResetNeeded):
        envs.step(np.zeros(COUNT, dtype=np.int64))
    after, _ = envs.reset(options={"reset_mask": ended})
    for name, values in after.items():
        assert np.array_equal(values[~ended], before[name][~ended])
    assert not after["tried"][ended].any() and after["tried"][~ended].any()
    envs.step(np.ones(COUNT, dtype=np.int64))


@pytest.mark.parametrize("mask", [np.zeros(COUNT, bool), np.ones(3, bool), np.ones(COUNT)])
def test_a_mask_that_can_not_be_used_is_named(mask: Any, data: ChoiceData) -> None:
    envs = make(data, "Disabled")
    envs.reset(seed=0)
    with pytest.raises(InputError, match="reset_mask"):
        envs.reset(options={"reset_mask": mask})


def test_tries_are_those_of_a_single_environment(data: ChoiceData) -> None:
    """Each environment follows the law: tries end with the first that is held, or with the last."""
    envs = make_grasp_choice_sequential_vector(
        COUNT, dataset=data, tries=3, cost=0.1, autoreset_mode="SameStep"
    )
    observation, _ = envs.reset(seed=1)
    tried = np.zeros(COUNT, dtype=int)
    for _ in range(12):
        actions = observation["mask"].argmax(axis=1)
        assert np.array_equal(envs.action_masks(), observation["mask"].astype(bool))
        observation, rewards, ended, _, infos = envs.step(actions)
        tried += 1
        assert np.allclose(rewards, infos["held"] - 0.1)
        assert np.array_equal(ended, infos["held"] | (tried == 3))
        for k in np.flatnonzero(ended):
            assert infos["final_obs"][k]["tried"].sum() == tried[k]
        tried[ended] = 0
        assert np.array_equal(observation["tried"].sum(axis=1), tried)


def test_what_was_tried_before_is_worth_nothing(data: ChoiceData) -> None:
    envs = make_grasp_choice_sequential_vector(COUNT, dataset=data, tries=3, autoreset_mode="Disabled")
    envs.reset(seed=0)
    ended = envs.step(np.zeros(COUNT, dtype=np.int64))[2]
    envs.reset(options={"reset_mask": ended})
    tried = envs.action_masks()[:, 0] == 0
    _, rewards, _, _, infos = envs.step(np.zeros(COUNT, dtype=np.int64))
    assert not rewards[tried].any() and not infos["held"][tried].any() and infos["held"][~tried].any()


def test_misuse_is_named(data: ChoiceData) -> None:
    with pytest.raises(UnknownName, match="did you mean 'SameStep'"):
        make(data, "samestep")
    with pytest.raises(InputError, match="num_envs"):
        make_grasp_choice_vector(0, dataset=data)
    with pytest.raises(InputError, match="physics"):
        make_grasp_choice_vector(2, backend="physics")
    envs = make(data, "SameStep")
    with pytest.raises(gymnasium.error.ResetNeeded):
        envs.step(np.zeros(COUNT, dtype=np.int64))
    envs.reset(seed=0)
    for actions in (np.full(COUNT, 9), np.full(COUNT, 0.5), np.zeros(COUNT - 1, dtype=np.int64)):
        with pytest.raises(gymnasium.error.InvalidAction):
            envs.step(actions)
