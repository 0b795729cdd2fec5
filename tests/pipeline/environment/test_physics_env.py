"""Environments over live physics: the reward is the hold test, and the shipped table repeats it."""

import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
import yaml
from gymnasium.utils.env_checker import check_env, data_equivalence
from holdfast.errors import InputError
from holdfast.pipeline.choice import DrawRanges, load_dataset, shipped_dataset, try_under
from holdfast.pipeline.env import make_grasp_choice, make_grasp_choice_sequential
from holdfast.pipeline.environment import ChoiceEnv, NothingToChoose, Physics
from holdfast.pipeline.environment.stored import StoredSituations

BOX = {
    "name": "box",
    "box": {"half_extents": [0.02, 0.03, 0.01]},
    "mass": 0.1,
    "friction": 0.6,
    "regions": {
        "front": {
            "bezier": [[[-0.01, -0.01, 0.01], [-0.01, 0.01, 0.01]], [[0.01, -0.01, 0.01], [0.01, 0.01, 0.01]]]
        },
        "back": {
            "bezier": [
                [[-0.01, -0.01, -0.01], [0.01, -0.01, -0.01]],
                [[-0.01, 0.01, -0.01], [0.01, 0.01, -0.01]],
            ]
        },
    },
}


@pytest.fixture(scope="module")
def replay() -> Physics:
    return Physics()


@pytest.fixture(scope="module")
def task_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("own")
    (folder / "box.yaml").write_text(yaml.safe_dump(BOX), "utf-8")
    pairs = [{"hand": "index/tip", "object": "front"}, {"hand": "thumb/tip", "object": "back"}]
    task = {"name": "pinch", "hand": "sa", "object": "box.yaml", "contacts": pairs}
    (folder / "pinch.yaml").write_text(yaml.safe_dump(task), "utf-8")
    return folder / "pinch.yaml"


def first_steps(env: Any, seeds: range) -> list[Any]:
    return [(env.reset(seed=seed), env.step(np.int64(1))) for seed in seeds]


@pytest.mark.slow
def test_gymnasium_has_no_complaints(replay: Physics) -> None:
    check_env(ChoiceEnv(replay, render_mode="rgb_array"), skip_render_check=True)


def test_equal_seeds_make_equal_episodes(replay: Physics) -> None:
    seen = first_steps(ChoiceEnv(replay), range(2))
    assert data_equivalence(seen, first_steps(make_grasp_choice(backend="physics"), range(2)))
    assert len({step[1] for _, step in first_steps(ChoiceEnv(replay), range(6))}) == 2  # held, and not


def test_the_table_says_what_physics_finds() -> None:
    """Each outcome of the shipped data is that of its candidate, put to the test again."""
    data, stored = load_dataset(), StoredSituations(shipped_dataset() / "situations.zip")
    rng = np.random.default_rng(0)
    for row in rng.choice(len(data), 4, replace=False):
        group, _, name = str(data.candidate_ids[row]).partition("/")
        pool = stored.pool(group)
        (k,) = [k for k, one in enumerate(pool.candidates) if one.solution.id == name]
        draw = int(rng.integers(data.held.shape[1]))
        found = try_under(pool.grasp(k), data.conditions[data.group[row], draw], data.loads, pool.settings)
        assert [one.held for one in found] == data.held[row, draw].tolist()
        assert [one.margin for one in found] == pytest.approx(data.margin[row, draw], abs=1e-3)


def test_features_are_those_of_the_table(replay: Physics) -> None:
    data = load_dataset()
    assert replay.features == data.feature_specs and replay.object_features == data.object_specs
    observation, info = ChoiceEnv(replay).reset(seed=0)
    of_object = data.object_ids[data.object_index] == info["object"]
    rows = data.features[of_object & (data.hand == info["hand"])]
    for features in observation["candidates"][observation["mask"] == 1]:
        assert (rows == features).all(axis=1).any()


def test_what_is_hidden_decides() -> None:
    """Without anything hidden the same candidate fares the same; with nine times the mass it is lost."""
    nothing = DrawRanges((1.0, 1.0), (1.0, 1.0), 0.0, 0.0, 0.0)
    env = make_grasp_choice_sequential(backend="physics", ranges=nothing, tries=2)
    same = [(env.reset(seed=4), env.step(np.int64(0)))[1][4]["margin"] for _ in range(2)]
    assert same[0] == same[1]
    heavy = DrawRanges((9.0, 9.0), (0.3, 0.3), 0.0, 0.0, 0.0)
    env = make_grasp_choice(backend="physics", ranges=heavy)
    assert not any((env.reset(seed=seed), env.step(np.int64(0)))[1][1] for seed in range(4))


def test_a_task_of_ones_own(task_file: Path, tmp_path: Path) -> None:
    options = {
        "backend": "physics",
        "objects": [str(task_file)],
        "pool": 3,
        "cache": tmp_path,
        "candidates": 3,
    }
    env = make_grasp_choice(**options)
    observation, info = env.reset(seed=0)
    assert (info["hand"], info["object"]) == ("sa", str(task_file)) and observation["mask"].sum() >= 2
    expected = env.step(np.int64(0))
    (file,) = tmp_path.glob("*.json")
    again = make_grasp_choice(**options)
    again.reset(seed=0)
    assert data_equivalence(again.step(np.int64(0)), expected)
    # A damaged pool is made again, and so is that of an object that is no longer the same.
    whole = file.read_text("utf-8")
    file.write_text(whole[:100], "utf-8")
    make_grasp_choice(**options).reset(seed=0)
    assert file.read_text("utf-8") == whole
    changed = {**BOX, "mass": 0.2}
    (task_file.parent / "box.yaml").write_text(yaml.safe_dump(changed), "utf-8")
    other, _ = make_grasp_choice(**options).reset(seed=0)
    assert other["object"][0] == pytest.approx(0.2)


@pytest.mark.slow
def test_a_mesh_and_another_hand(tmp_path: Path) -> None:
    trimesh.creation.box((0.03, 0.05, 0.08)).export(tmp_path / "block.stl")
    env = make_grasp_choice(
        backend="physics", objects=[str(tmp_path / "block.stl")], hands=["shadow"], pool=2, cache=tmp_path
    )
    observation, info = env.reset(seed=0)
    assert info["hand"] == "shadow" and env.observation_space.contains(observation)
    assert env.step(np.int64(0))[4]["outcome"]


def test_a_copy_goes_on_as_the_original_does(replay: Physics) -> None:
    env = ChoiceEnv(replay, tries=2)
    env.reset(seed=0)
    other = pickle.loads(pickle.dumps(env))
    assert data_equivalence(env.step(np.int64(0)), other.step(np.int64(0)))


def test_pictures_show_the_candidate(replay: Physics, capsys: pytest.CaptureFixture[str]) -> None:
    env = ChoiceEnv(replay, render_mode="rgb_array")
    env.reset(seed=0)
    picture = env.render()
    assert picture is not None and picture.shape == (240, 320, 3) and len(np.unique(picture)) > 10
    env.step(np.int64(2))
    assert not np.array_equal(env.render(), picture)
    env.close()


def test_a_window_is_told_of_where_there_is_none(
    replay: Physics, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("DISPLAY", raising=False)
    env = ChoiceEnv(replay, render_mode="human")
    env.reset(seed=0)
    env.step(np.int64(0))
    assert env.render() is None
    assert capsys.readouterr().err == "no display: the pictures of render_mode 'human' are not shown\n"


def test_misuse_is_named(tmp_path: Path) -> None:
    for options, match in (
        ({"objects": []}, "objects: must be a list of at least one name"),
        ({"objects": "family:mug:1"}, "objects: must be a list"),
        ({"objects": [3]}, r"objects\[0\]: must be a path"),
        ({"objects": ["family:mug:1"], "hands": "sa"}, "hands: must be a list"),
        ({"objects": ["family:mug:1"], "hands": []}, "hands: must be a list"),
        ({"hands": ["sa"]}, "hands: can be given where objects are"),
        ({"ranges": 3}, "ranges: must be DrawRanges"),
        ({"cache": 3}, "cache: must be a path"),
        ({"split": "test"}, "split: goes with backend='table'"),
        ({"objects": ["family:mgu:1"]}, "did you mean 'mug'"),
        ({"objects": ["family:mgu"]}, "did you mean 'mug'"),
        ({"objects": ["teapto"]}, "did you mean 'teapot'"),
        ({"objects": ["family:mug:1"], "hands": ["shadwo"]}, "did you mean 'shadow'"),
        ({"objects": ["family:mug:1"], "dataset": tmp_path}, "where no objects are"),
        ({"load": 0.0}, "load"),
        ({"pool": 0}, "pool"),
        ({"dataset": tmp_path}, "is no data set"),
    ):
        with pytest.raises(InputError, match=match):
            make_grasp_choice(backend="physics", **options)


@pytest.mark.slow
def test_objects_that_can_not_be_held_are_an_error(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("holdfast.pipeline.choice.situation._MOST_TRIES", 1)
    trimesh.creation.box((1.0, 1.0, 1.0)).export(tmp_path / "wall.stl")
    env = make_grasp_choice(backend="physics", objects=[str(tmp_path / "wall.stl")], pool=1, cache=tmp_path)
    with pytest.raises(NothingToChoose, match=r"wall\.stl"):
        env.reset(seed=0)
