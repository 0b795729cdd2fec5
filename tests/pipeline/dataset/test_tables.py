"""The tables say what the arrays say, and what describes them is true."""

import hashlib
import json
from pathlib import Path

import numpy as np
import pytest
from holdfast.pipeline.choice import ChoiceData, load_dataset, shipped_dataset

pq = pytest.importorskip("pyarrow.parquet")


@pytest.fixture(scope="module")
def data() -> ChoiceData:
    return load_dataset()


def test_candidates_are_those_of_the_arrays(data: ChoiceData) -> None:
    rows = pq.read_table(shipped_dataset() / "candidates.parquet").to_pydict()
    assert rows["candidate_id"] == data.candidate_ids.tolist()
    assert rows["group_id"] == data.group.tolist() and rows["hand"] == data.hand.tolist()
    assert rows["object_id"] == data.object_ids[data.object_index].tolist()
    for k, feature in enumerate(data.feature_specs):
        assert np.array_equal(np.array(rows[feature.name], dtype=np.float32), data.features[:, k])
    for name, parts in data.splits.items():
        assert rows[f"split_{name}"] == parts.tolist()
    quaternions = np.array([rows[f"quaternion_{axis}"] for axis in "wxyz"])
    assert np.linalg.norm(quaternions, axis=0) == pytest.approx(1.0)
    joints = dict(rows["joints"][0])
    assert set(joints) > {"index_abduction", "thumb_base"} and all(np.isfinite(list(joints.values())))


def test_objects_are_those_of_the_arrays(data: ChoiceData) -> None:
    rows = pq.read_table(shipped_dataset() / "objects.parquet").to_pydict()
    assert rows["object_id"] == data.object_ids.tolist() and set(rows["kind"]) == {"family"}
    for k, feature in enumerate(data.object_specs):
        assert np.array_equal(np.array(rows[feature.name], dtype=np.float32), data.object_features[:, k])


def test_outcomes_are_those_of_the_arrays(data: ChoiceData) -> None:
    rows = pq.read_table(shipped_dataset() / "outcomes.parquet").to_pydict()
    shape = data.held.shape
    assert np.array_equal(np.array(rows["held"]).reshape(shape), data.held)
    assert np.array_equal(np.array(rows["margin"], dtype=np.float32).reshape(shape), data.margin)
    mass = np.array(rows["mass_factor"], dtype=np.float32).reshape(shape)[:, :, 0]
    assert np.array_equal(mass, data.conditions[data.group, :, 0])
    assert ((np.array(rows["outcome"]) == "held") == np.array(rows["held"])).all()


def test_an_object_is_in_one_part_alone(data: ChoiceData) -> None:
    for index in range(len(data.object_ids)):
        assert len(set(data.split[data.object_index == index].tolist())) == 1
    assert set(data.split.tolist()) == {"train", "valid", "test"}
    assert set(data.hand[data.splits["hand"] == "test"].tolist()) == {data.hands[-1]}
    held_out = set(data.task[data.splits["task"] == "test"].tolist())
    assert held_out and held_out.isdisjoint(data.task[data.splits["task"] != "test"].tolist())


def test_every_column_says_what_it_is() -> None:
    for name in ("objects", "candidates", "outcomes"):
        schema = pq.read_schema(shipped_dataset() / f"{name}.parquet")
        assert all(field.metadata and field.metadata[b"description"] for field in schema)


def test_croissant_names_the_files_as_they_are() -> None:
    record = json.loads((shipped_dataset() / "croissant.json").read_text("utf-8"))
    for entry in record["distribution"]:
        content = (shipped_dataset() / entry["contentUrl"]).read_bytes()
        assert entry["sha256"] == hashlib.sha256(content).hexdigest()
        assert entry["contentSize"] == f"{len(content)} B"
    fields = {field["@id"] for records in record["recordSet"] for field in records["field"]}
    assert {"candidates/hand", "outcomes/held", "objects/o_mass"} < fields
    assert "candidates/joints" not in fields  # a map, which Croissant can't describe


@pytest.mark.filterwarnings("ignore::DeprecationWarning")  # of the libraries that the validator uses
def test_croissant_is_valid() -> None:
    croissant = pytest.importorskip("mlcroissant")
    dataset = croissant.Dataset(jsonld=str(shipped_dataset() / "croissant.json"))
    assert not dataset.metadata.ctx.issues.errors and not dataset.metadata.ctx.issues.warnings
    data = load_dataset()
    counts = {"objects": len(data.object_ids), "candidates": len(data), "outcomes": data.held.size}
    for name, count in counts.items():
        assert len(list(dataset.records(name))) == count


def test_the_shipped_data_is_small() -> None:
    assert sum(path.stat().st_size for path in shipped_dataset().iterdir()) < 1_000_000


def test_the_card_says_what_is_in_it(data: ChoiceData) -> None:
    text = (shipped_dataset() / "README.md").read_text("utf-8")
    assert f"{len(data)} grasps in {data.group_count} situations" in " ".join(text.split())
    assert "Apache-2.0" in text and "holdfast dataset --families" in text


def test_minari_takes_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    minari = pytest.importorskip("minari")
    monkeypatch.setenv("MINARI_DATASETS_PATH", str(tmp_path))
    from holdfast.pipeline.dataset.minari import to_minari

    data = load_dataset().part("valid")
    to_minari(data, "mine/choice-v0", "Apache-2.0")
    found = minari.load_dataset("mine/choice-v0")
    assert found.total_episodes == data.held[:, :, 0].size
    rewards = [float(episode.rewards.sum()) for episode in found.iterate_episodes()]
    assert np.mean(rewards) == pytest.approx(data.held[:, :, 0].mean())
