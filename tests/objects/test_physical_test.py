"""The field `test` of a task file: what it makes, and how malformed ones are refused."""

import copy
import re
from pathlib import Path

import numpy as np
import pytest
import yaml
from holdfast.base.files.file_model import FileModel
from holdfast.errors import InputError
from holdfast.objects import LiftTest, PressTest, TurnTest, load_task
from holdfast.objects.physical_test_file import PhysicalTestSpec

NAN, INF = float("nan"), float("inf")
LIFT = {"kind": "lift", "parts": ["handle"], "gravity": {"axis": [2, 0, 0], "cone_deg": 30}}
TURN = {
    "kind": "turn",
    "parts": ["blade"],
    "hinge": {"point": [0, -0.03, 0], "axis": [0, 3, 0]},
    "friction_torque": 0.03,
    "angle_deg": 90,
}
PRESS = {"kind": "press", "force": 3.0, "contacts": [1]}
KINDS = {"lift": LIFT, "turn": TURN, "press": PRESS}


def write(folder, test):
    data = {
        "name": "pick",
        "hand": "sa",
        "object": "scalpel",
        "contacts": [
            {"hand": "index/tip", "object": "index_grip"},
            {"hand": "thumb/tip", "object": "thumb_grip"},
        ],
    }
    if test is not ...:
        data["test"] = test
    path = folder / "pick.yaml"
    path.write_text(yaml.safe_dump(data))
    return path


def names(parts):
    return [part.name for part in parts]


def test_without_a_test_the_whole_object_is_lifted_in_six_directions(tmp_path):
    task = load_task(write(tmp_path, ...))
    assert task.test == LiftTest()
    assert names(task.carried) == ["handle", "blade"]
    assert task.obstacles == ()
    directions = np.array(task.test.directions)
    assert len(directions) == 6
    assert np.allclose(directions.T @ directions, 2 * np.eye(3))
    assert np.allclose(directions.sum(axis=0), 0)


def test_lift_of_some_parts_within_a_cone(tmp_path):
    task = load_task(write(tmp_path, LIFT))
    assert isinstance(task.test, LiftTest)
    assert names(task.carried) == ["handle"]
    assert names(task.obstacles) == ["blade"]
    axis, *rim = np.array(task.test.directions)
    assert axis == pytest.approx([1, 0, 0])
    assert len(rim) == 6
    assert np.linalg.norm(rim, axis=1) == pytest.approx(1)
    assert np.array(rim) @ axis == pytest.approx(np.cos(np.deg2rad(30)))
    # Evenly spread: the middle of the rim lies on the axis.
    assert np.mean(rim, axis=0) == pytest.approx(np.cos(np.deg2rad(30)) * axis, abs=1e-12)


def test_lift_all_over_the_sphere(tmp_path):
    directions = np.array(load_task(write(tmp_path, {"kind": "lift", "gravity": "sphere"})).test.directions)
    assert np.linalg.norm(directions, axis=1) == pytest.approx(1)
    anywhere = np.random.default_rng(0).normal(size=(2000, 3))
    anywhere /= np.linalg.norm(anywhere, axis=1, keepdims=True)
    nearest = np.arccos((anywhere @ directions.T).max(axis=1))
    assert np.rad2deg(nearest.max()) < 30


def test_lift_in_listed_directions(tmp_path):
    test = load_task(write(tmp_path, {"kind": "lift", "gravity": [[0, 0, -2], [3, 4, 0]]})).test
    assert test.directions == ((0, 0, -1), pytest.approx((0.6, 0.8, 0)))


def test_turn(tmp_path):
    task = load_task(write(tmp_path, TURN))
    assert isinstance(task.test, TurnTest)
    assert names(task.carried) == ["blade"]
    assert names(task.obstacles) == ["handle"]
    assert task.test.hinge_axis == (0, 1, 0)
    assert task.test.angle_rad == pytest.approx(np.pi / 2)
    assert task.test.friction_torque_Nm == 0.03
    everything = load_task(write(tmp_path, {**TURN, "parts": None}))
    assert names(everything.carried) == ["handle", "blade"]
    assert everything.obstacles == ()


def test_press(tmp_path):
    task = load_task(write(tmp_path, PRESS))
    assert task.test == PressTest((1,), 3.0)
    assert task.carried == ()
    assert names(task.obstacles) == ["handle", "blade"]
    every = load_task(write(tmp_path, {"kind": "press", "force": 3.0})).test
    assert every.contacts == (0, 1)


# what is wrong: (kind, changed fields, field that the message names, words of the remedy)
BAD = {
    "no kind": ("lift", {"kind": ...}, "test", "lift, turn or press"),
    "kind unknown": ("lift", {"kind": "lfit"}, "test", "lift, turn or press"),
    "kind a list": ("lift", {"kind": ["lift"]}, "test", "lift, turn or press"),
    "unknown field of a lift": ("lift", {"gravty": "six"}, "test.gravty", "did you mean 'gravity'"),
    "unknown field of a turn": ("turn", {"angel_deg": 5}, "test.angel_deg", "did you mean 'angle_deg'"),
    "unknown field of a press": ("press", {"froce": 3}, "test.froce", "did you mean 'force'"),
    "unknown field of a cone": ("lift", {"gravity.cone": 5}, "test.gravity.cone", "did you mean 'cone_deg'"),
    "unknown field of a hinge": ("turn", {"hinge.pint": 5}, "test.hinge.pint", "did you mean 'point'"),
    "a field of another kind": ("lift", {"force": 3}, "test.force", "unknown field"),
    "part unknown": ("lift", {"parts": ["blde"]}, "test.parts.0", "did you mean 'blade'"),
    "part twice": ("lift", {"parts": ["blade", "blade"]}, "test.parts.1", "twice"),
    "no part": ("lift", {"parts": []}, "test.parts", "at least 1"),
    "parts a text": ("turn", {"parts": "blade"}, "test.parts", "list"),
    "gravity unknown": ("lift", {"gravity": "seven"}, "test.gravity", "'six' or 'sphere'"),
    "gravity a number": ("lift", {"gravity": 9.81}, "test.gravity", "six, sphere, a cone"),
    "gravity empty": ("lift", {"gravity": []}, "test.gravity", "at least 1"),
    "gravity of zero": ("lift", {"gravity": [[0, 0, 0]]}, "test.gravity.0", "zero vector"),
    "gravity not three numbers": ("lift", {"gravity": [[0, 1]]}, "test.gravity.0.2", "required"),
    "gravity NaN": ("lift", {"gravity": [[0, NAN, 1]]}, "test.gravity.0.1", "finite"),
    "too many directions": (
        "lift",
        {"gravity": [[0, 0, 1] for _ in range(101)]},
        "test.gravity",
        "at most 100",
    ),
    "cone about nothing": ("lift", {"gravity.axis": [0, 0, 0]}, "test.gravity.axis", "zero vector"),
    "cone without an angle": ("lift", {"gravity.cone_deg": ...}, "test.gravity.cone_deg", "required"),
    "cone of 0 deg": ("lift", {"gravity.cone_deg": 0}, "test.gravity.cone_deg", "greater than 0"),
    "cone of 200 deg": ("lift", {"gravity.cone_deg": 200}, "test.gravity.cone_deg", "180"),
    "no hinge": ("turn", {"hinge": ...}, "test.hinge", "required"),
    "hinge a list": ("turn", {"hinge": [0, 0, 1]}, "test.hinge", "dictionary"),
    "hinge in mm": ("turn", {"hinge.point": [0, -30, 0]}, "test.hinge.point", "metres"),
    "hinge of no direction": ("turn", {"hinge.axis": [0, 0, 0]}, "test.hinge.axis", "zero vector"),
    "torque zero": ("turn", {"friction_torque": 0}, "test.friction_torque", "greater than 0"),
    "torque infinite": ("turn", {"friction_torque": INF}, "test.friction_torque", "finite"),
    "torque huge": ("turn", {"friction_torque": 300.0}, "test.friction_torque", "100"),
    "torque a text": ("turn", {"friction_torque": "0.03 Nm"}, "test.friction_torque", "number"),
    "angle negative": ("turn", {"angle_deg": -5}, "test.angle_deg", "greater than 0"),
    "angle above a turn": ("turn", {"angle_deg": 400}, "test.angle_deg", "360"),
    "force missing": ("press", {"force": ...}, "test.force", "required"),
    "force negative": ("press", {"force": -1}, "test.force", "greater than 0"),
    "force true": ("press", {"force": True}, "test.force", "number"),
    "contact unknown": ("press", {"contacts": [2]}, "test.contacts.0", "0 to 1"),
    "contact negative": ("press", {"contacts": [-1]}, "test.contacts.0", "greater than or equal to 0"),
    "contact a fraction": ("press", {"contacts": [0.5]}, "test.contacts.0", "integer"),
    "contact twice": ("press", {"contacts": [1, 1]}, "test.contacts.1", "twice"),
    "no contact": ("press", {"contacts": []}, "test.contacts", "at least 1"),
}


@pytest.mark.parametrize(("kind", "changes", "field", "words"), BAD.values(), ids=BAD.keys())
def test_bad_tests_are_refused(tmp_path, kind, changes, field, words):
    data = copy.deepcopy(KINDS[kind])
    for path, value in changes.items():
        *where, last = path.split(".")
        target = data
        for part in where:
            target = target[part]
        if value is ...:
            del target[last]
        else:
            target[last] = value
    path = write(tmp_path, data)
    with pytest.raises(InputError, match=words) as caught:
        load_task(path)
    assert caught.value.source == str(path)
    assert caught.value.field == field
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600


@pytest.mark.parametrize(
    "test", [None, "lift", 3, [], ["lift"]], ids=["null", "text", "number", "list", "texts"]
)
def test_a_test_is_a_mapping(tmp_path, test):
    path = write(tmp_path, test)
    if test is None:  # as if it were not there
        assert load_task(path).test == LiftTest()
        return
    with pytest.raises(InputError, match="lift, turn or press") as caught:
        load_task(path)
    assert caught.value.field == "test"


def test_the_documented_tests_are_read():
    text = (Path(__file__).resolve().parents[2] / "docs" / "files.md").read_text("utf-8")
    shown = [yaml.safe_load(line) for line in re.findall(r"^ *test: .*$", text, re.M)]
    assert {data["test"]["kind"] for data in shown} == {"lift", "turn", "press"}

    class Shown(FileModel):
        test: PhysicalTestSpec

    for data in shown:
        assert Shown.model_validate(data).test.kind == data["test"]["kind"]
