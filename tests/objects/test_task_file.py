"""Task files: what they make, and how malformed ones are refused."""

import copy

import numpy as np
import pytest
import yaml
from holdfast.errors import InputError
from holdfast.geometry import Cap, PointRegion
from holdfast.hands import load_hand
from holdfast.objects import load_object, load_task

NAN, INF = float("nan"), float("inf")
CAP = {"centre": [0.0253, 0, 0], "radius": 0.013, "axis": [0.6, 0, 0.8], "half_angle_deg": 30}
POINT = {"point": [-0.0024, -0.02065, -0.008605], "normal": [-0.3, 0, -0.95]}
GOOD = {
    "name": "pick",
    "hand": "sa",
    "object": "scalpel",
    "contacts": [
        {"hand": "index/tip", "object": "index_grip"},
        {"hand": {"link": "thumb_distal", "cap": CAP}, "object": POINT},
    ],
    "joint_limits": {"index_abduction": [-0.1, 0.2]},
}


class WrittenOut(yaml.SafeDumper):
    """Repeats what stands twice in a tree, as a person would."""

    def ignore_aliases(self, data):
        return True


def write(folder, changes=None):
    data = copy.deepcopy(GOOD)
    for path, value in (changes or {}).items():
        *where, last = [int(part) if part.isdigit() else part for part in path.split(".")]
        target = data
        for part in where:
            target = target[part]
        if value is ...:
            del target[last]
        else:
            target[last] = value
    path = folder / "pick.yaml"
    path.write_text(yaml.dump(data, Dumper=WrittenOut))
    return path


def test_a_task_from_a_file(tmp_path):
    task = load_task(write(tmp_path))
    assert task.hand is load_hand("sa")
    assert task.object is load_object("scalpel")
    named, inline = task.contacts
    assert named.hand is task.hand.regions["index/tip"]
    assert named.object.region is task.object.regions["index_grip"]
    assert task.hand.links[inline.hand.link].name == "thumb_distal"
    assert isinstance(inline.hand.region, Cap)
    assert isinstance(inline.object.region, PointRegion)
    i = task.hand.independent_names.index("index_abduction")
    assert task.limits[i] == pytest.approx([-0.1, 0.2])
    others = np.arange(len(task.limits)) != i
    assert np.array_equal(task.limits[others], task.hand.limits[others])


def test_limits_may_be_typed_with_few_decimals(tmp_path):
    task = load_task(write(tmp_path, {"joint_limits.index_abduction": [-0.2617994, 0.2617994]}))
    assert np.all(task.limits[:, 0] >= task.hand.limits[:, 0])
    assert np.all(task.limits[:, 1] <= task.hand.limits[:, 1])


def test_hand_and_object_beside_the_task(tmp_path):
    (tmp_path / "ball.yaml").write_text(
        "{name: ball, sphere: {radius: 0.03}, mass: 0.1, friction: 1, "
        "regions: {top: {point: [0, 0, 0.03], normal: [0, 0, 1]}}}"
    )
    contacts = [{"hand": "index/tip", "object": "top"}]
    task = load_task(write(tmp_path, {"object": "ball.yaml", "contacts": contacts}))
    assert task.object.name == "ball"


def test_what_has_no_name_is_called_as_its_file(tmp_path):
    (tmp_path / "-my ball.yaml").write_text(
        "{sphere: {radius: 0.03}, mass: 0.1, friction: 1, "
        "regions: {top: {point: [0, 0, 0.03], normal: [0, 0, 1]}}}"
    )
    contacts = [{"hand": "index/tip", "object": "top"}]
    task = load_task(write(tmp_path, {"name": ..., "object": "-my ball.yaml", "contacts": contacts}))
    assert (task.name, task.object.name) == ("pick", "my_ball")
    assert [part.name for part in task.object.parts] == ["my_ball"]


def test_one_region_may_touch_two(tmp_path):
    contacts = [{"hand": "index/tip", "object": "index_grip"}, {"hand": "index/tip", "object": "thumb_grip"}]
    assert len(load_task(write(tmp_path, {"contacts": contacts})).contacts) == 2


def test_inline_regions_may_stand_twice(tmp_path):
    contacts = [{"hand": {"link": "thumb_distal", "cap": CAP}, "object": POINT}] * 2
    assert len(load_task(write(tmp_path, {"contacts": contacts})).contacts) == 2


# what is wrong: (changed fields, field that the message names, words of the remedy)
BAD = {
    "name with slash": ({"name": "a/b"}, "name", "letters, digits"),
    "name climbing": ({"name": ".."}, "name", "letters, digits"),
    "name with newline": ({"name": "a\nb"}, "name", "letters, digits"),
    "unknown field": ({"conatcts": []}, "conatcts", "did you mean 'contacts'?"),
    "unknown field of a contact": ({"contacts.0.hnad": "x"}, "contacts.0.hnad", "did you mean 'hand'?"),
    "unknown field of a cap": ({"contacts.1.hand.cap.raduis": 1}, "contacts.1.hand.cap.raduis", "'radius'"),
    "unknown field of an inline region": ({"contacts.1.hand.lnik": 1}, "contacts.1.hand.lnik", "'link'"),
    "no hand": ({"hand": ...}, "hand", "required"),
    "hand unknown": ({"hand": "sb"}, "hand", "did you mean 'sa'?"),
    "hand a mapping": ({"hand": {"name": "sa"}}, "hand", "string"),
    "hand file missing": ({"hand": "hand.yaml"}, "", "no such file"),
    "hand path absolute": ({"hand": "/etc/hand.yaml"}, "hand", "below the folder"),
    "hand path climbing": ({"hand": "../hand.yaml"}, "hand", "below the folder"),
    "object unknown": ({"object": "scalpal"}, "object", "did you mean 'scalpel'?"),
    "object file missing": ({"object": "mug.yaml"}, "", "no such file"),
    "object path climbing": ({"object": "a/../../mug.yml"}, "object", "below the folder"),
    "no contacts": ({"contacts": ...}, "contacts", "required"),
    "contacts empty": ({"contacts": []}, "contacts", "at least 1"),
    "contacts a mapping": ({"contacts": {"hand": "index/tip"}}, "contacts", "list"),
    "contacts too many": ({"contacts": [GOOD["contacts"][1]] * 65}, "contacts", "at most 64"),
    "contact null": ({"contacts.0": None}, "contacts.0", "dictionary"),
    "contact without object": ({"contacts.0.object": ...}, "contacts.0.object", "required"),
    "contact twice": (
        {"contacts.1": GOOD["contacts"][0]},
        "contacts.1",
        "same pair of regions as contacts.0",
    ),
    "hand region unknown": ({"contacts.0.hand": "index/tpi"}, "contacts.0.hand", "did you mean 'index/tip'?"),
    "object region unknown": ({"contacts.0.object": "indx_grip"}, "contacts.0.object", "'index_grip'"),
    "hand region a number": ({"contacts.0.hand": 5}, "contacts.0.hand", "dictionary"),
    "inline link unknown": ({"contacts.1.hand.link": "thumb"}, "contacts.1.hand.link", "did you mean 'thumb"),
    "inline region without link": ({"contacts.1.hand.link": ...}, "contacts.1.hand.link", "required"),
    "link on the object's side": ({"contacts.1.object.link": "x"}, "contacts.1.object.link", "unknown field"),
    "cap axis zero": ({"contacts.1.hand.cap.axis": [0, 0, 0]}, "contacts.1.hand.cap.axis", "zero vector"),
    "cap radius NaN": ({"contacts.1.hand.cap.radius": NAN}, "contacts.1.hand.cap.radius", "finite"),
    "cap half angle 200": ({"contacts.1.hand.cap.half_angle_deg": 200}, "half_angle_deg", "180"),
    "cap in mm": ({"contacts.1.hand.cap.centre": [200, 0, 0]}, "centre.0", "metres"),
    "point infinite": ({"contacts.1.object.point": [INF, 0, 0]}, "contacts.1.object.point.0", "finite"),
    "point without normal": ({"contacts.1.object.normal": ...}, "contacts.1.object", "needs a normal"),
    "limits of an unknown joint": (
        {"joint_limits": {"index_abducton": [0, 1]}},
        "joint_limits.index_abducton",
        "did you mean 'index_abduction'?",
    ),
    "limits of a coupled joint": (
        {"joint_limits": {"index_dip": [0, 1]}},
        "joint_limits.index_dip",
        "independent",
    ),
    "limits reversed": ({"joint_limits.index_abduction": [0.1, -0.1]}, "index_abduction", "above the upper"),
    "limits outside the hand's": (
        {"joint_limits.index_abduction": [-0.3, 0.1]},
        "index_abduction",
        "inside the hand's own limits",
    ),
    "limits in degrees": ({"joint_limits.index_abduction": [-5, 5]}, "index_abduction", "own limits"),
    "limits NaN": ({"joint_limits.index_abduction": [NAN, 0.1]}, "index_abduction.0", "finite"),
    "limits one number": ({"joint_limits.index_abduction": 0.1}, "index_abduction", "tuple"),
    "limits as text": ({"joint_limits.index_abduction": ["low", "high"]}, "index_abduction.0", "number"),
    "limits a list": ({"joint_limits": [0, 1]}, "joint_limits", "dictionary"),
}


@pytest.mark.parametrize(("changes", "field", "words"), BAD.values(), ids=BAD.keys())
def test_bad_tasks_are_refused(tmp_path, changes, field, words):
    path = write(tmp_path, changes)
    with pytest.raises(InputError, match=words) as caught:
        load_task(path)
    assert str(caught.value).startswith(str(tmp_path))
    assert field in caught.value.field
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600


@pytest.mark.parametrize("name", ["upholdng", "", "teapot/upholding", "scalpel/", "../upholding", "a\nb"])
def test_unknown_tasks(name):
    with pytest.raises(InputError, match="unknown task"):
        load_task(name)


def test_a_fault_in_the_object_file_names_that_file(tmp_path):
    (tmp_path / "ball.yaml").write_text("{name: ball, sphere: {radius: 0.03}, mass: -1, friction: 1}")
    with pytest.raises(InputError, match="mass") as caught:
        load_task(write(tmp_path, {"object": "ball.yaml"}))
    assert caught.value.source == str(tmp_path / "ball.yaml")


def test_normals_have_the_room_that_the_contact_or_the_task_says(tmp_path):
    def room(changes):
        return np.degrees([c.align_within_rad for c in load_task(write(tmp_path, changes)).contacts])

    pad = {"link": "thumb_distal", **POINT, "off_surface": True}
    face = {**POINT, "off_surface": True}
    flat = {"contacts": [{"hand": pad, "object": face}, {"hand": "index/tip", "object": "index_grip"}]}
    assert room(flat) == pytest.approx([0.01, 0.0])
    assert room({**flat, "align_within_deg": 3}) == pytest.approx([3.0, 0.0])
    assert room({**flat, "align_within_deg": 3, "contacts.0.align_within_deg": 2}) == pytest.approx(
        [2.0, 0.0]
    )
    assert room({**flat, "align_within_deg": 3, "contacts.0.align_within_deg": 0}) == pytest.approx(
        [0.0, 0.0]
    )


@pytest.mark.parametrize("value", [-1, 46, 1e-9, NAN, "wide", True])
@pytest.mark.parametrize("field", ["align_within_deg", "contacts.0.align_within_deg"])
def test_room_that_is_no_angle_is_refused(tmp_path, field, value):
    with pytest.raises(InputError) as caught:
        load_task(write(tmp_path, {field: value}))
    assert caught.value.field == field
