"""Arrays of a data set come back as they were written, and what doesn't fit is named."""

import json
import zipfile
from dataclasses import fields, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from holdfast.errors import InputError, UnknownName
from holdfast.pipeline.choice import (
    ARRAYS_FILE,
    DATASET_FILE,
    SCHEMA_VERSION,
    ChoiceData,
    load_dataset,
    write_arrays,
)

from .synthetic import make_choice_data


def write_folder(folder: Path, data: ChoiceData, **changes: Any) -> Path:
    head = {
        "schema_version": SCHEMA_VERSION,
        "loads": list(data.loads),
        "features": [feature.as_record() for feature in data.feature_specs],
        "object_features": [feature.as_record() for feature in data.object_specs],
        "conditions": [{"name": name} for name in data.condition_names],
    }
    (folder / DATASET_FILE).write_text(json.dumps(head | changes), "utf-8")
    write_arrays(folder / ARRAYS_FILE, data)
    return folder


def test_what_is_written_is_read(tmp_path: Path) -> None:
    data = make_choice_data(groups=7)
    again = load_dataset(write_folder(tmp_path, data))
    for field in fields(ChoiceData):
        old, new = getattr(data, field.name), getattr(again, field.name)
        if field.name == "splits":
            assert old.keys() == new.keys()
            assert all(np.array_equal(old[name], new[name]) for name in old)
        elif isinstance(old, np.ndarray):
            assert np.array_equal(old, new) and old.dtype == new.dtype
        else:
            assert old == new


def test_the_same_data_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a", "b"):
        write_arrays(tmp_path / name, make_choice_data(groups=3))
    assert (tmp_path / "a").read_bytes() == (tmp_path / "b").read_bytes()


def test_parts_keep_groups_together() -> None:
    data = make_choice_data(groups=20, candidates=4)
    train, test = data.part("train"), data.part("test")
    assert len(train) + len(test) + len(data.part("valid")) == len(data)
    assert set(train.object_index).isdisjoint(test.object_index)
    for part in (train, test):
        assert part.sizes.tolist() == [4] * part.group_count
        for rows in part.groups():
            assert len(set(part.object_index[rows])) == 1
        # The conditions of a group are still those of its object.
        first = part.object_index[part.starts[:-1]]
        assert np.array_equal(part.conditions, data.conditions[first])


def test_an_unknown_hand_is_not_in_the_train_part() -> None:
    data = make_choice_data()
    assert data.part("test", by="hand").hands == ("shadow",)
    assert data.part("train", by="hand").hands == ("sa",)


@pytest.mark.parametrize("name", ["testing", "Train"])
def test_an_unknown_part_is_named(name: str) -> None:
    with pytest.raises(UnknownName, match="part"):
        make_choice_data(groups=2).part(name)
    with pytest.raises(UnknownName, match="split"):
        make_choice_data(groups=2).part("train", by="colour")  # type: ignore[arg-type]


def test_a_load_that_was_not_tried_is_named() -> None:
    data = make_choice_data(groups=2)
    assert data.load_index(2.0) == 1
    with pytest.raises(InputError, match=r"must be one of 1\.0, 2\.0"):
        data.load_index(3.0)


@pytest.mark.parametrize(
    ("changes", "field"),
    [
        (lambda d: {"features": d.features[:, :-1]}, "features"),
        (lambda d: {"features": np.full_like(d.features, np.nan)}, "features"),
        (lambda d: {"held": d.held[:, :, :1]}, "held"),
        (lambda d: {"group": d.group[::-1].copy()}, "group"),
        (lambda d: {"hand": d.hand[:-1]}, "hand"),
        (lambda d: {"object_index": d.object_index + 100}, "object_index"),
        (lambda d: {"conditions": d.conditions[:-1]}, "conditions"),
        (lambda d: {"splits": d.splits | {"object": np.full(len(d), "all")}}, "split_object"),
        (lambda d: {"held": d.held.astype(np.float32)}, "held"),
    ],
)
def test_arrays_that_do_not_fit_are_named(tmp_path: Path, changes: Any, field: str) -> None:
    data = make_choice_data(groups=4)
    write_folder(tmp_path, replace(data, **changes(data)))
    with pytest.raises(InputError) as caught:
        load_dataset(tmp_path)
    assert caught.value.field == field


def test_what_is_no_data_set_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="is no data set"):
        load_dataset(tmp_path)
    write_folder(tmp_path, make_choice_data(groups=2), schema_version=0)
    with pytest.raises(InputError, match="schema_version"):
        load_dataset(tmp_path)


@pytest.mark.parametrize("damage", ["cut", "empty", "pickle", "lacks"])
def test_damaged_arrays_are_refused(tmp_path: Path, damage: str) -> None:
    write_folder(tmp_path, make_choice_data(groups=2))
    path = tmp_path / ARRAYS_FILE
    if damage == "cut":
        path.write_bytes(path.read_bytes()[:200])
    elif damage == "empty":
        path.write_bytes(b"")
    elif damage == "lacks":
        with zipfile.ZipFile(path, "w"):
            pass
    else:
        with zipfile.ZipFile(path, "w") as archive, archive.open("features.npy", "w") as entry:
            np.lib.format.write_array(entry, np.array([[object()]]), allow_pickle=True)
    with pytest.raises(InputError):
        load_dataset(tmp_path)
