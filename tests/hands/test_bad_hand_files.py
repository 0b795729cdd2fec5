"""Every malformed hand file is refused in one line that names the file, the field and the remedy."""

import copy

import pytest
import yaml
from holdfast.errors import InputError
from holdfast.hands import load_hand

SERVO = {"effort": 3.0, "stiffness": 20.0, "damping": 0.5, "armature": 0.002}
GOOD = {
    "name": "pincer",
    "palm": "palm",
    "actuators": {"servo": dict(SERVO)},
    "links": [
        {
            "name": "palm",
            "mass": 0.2,
            "shapes": [{"box": {"centre": [0, 0, 0], "half_extents": [0.05, 0.05, 0.02]}}],
        },
        {
            "name": "finger",
            "mass": 0.1,
            "shapes": [
                {"capsule": {"start": [0, 0, 0], "end": [0.05, 0, 0], "radius": 0.01}},
                {
                    "hull": {
                        "points": [[0, 0, 0], [0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]],
                        "regions": ["finger/pad"],
                    }
                },
            ],
        },
        {"name": "tip", "mass": 0.05, "shapes": [{"sphere": {"centre": [0, 0, 0], "radius": 0.01}}]},
    ],
    "joints": [
        {
            "type": "universal",
            "parent": "palm",
            "child": "finger",
            "position": [0, 0, 0.02],
            "axes": [
                {"name": "spread", "direction": [0, 0, 1], "limits_deg": [-15, 15], "actuator": "servo"},
                {"name": "bend", "direction": [0, 1, 0], "limits_deg": [0, 90], "actuator": SERVO},
            ],
        },
        {
            "type": "revolute",
            "parent": "finger",
            "child": "tip",
            "position": [0.05, 0, 0],
            "axes": [
                {"name": "curl", "direction": [0, 1, 0], "limits": [0, 1.5], "coupled": {"to": "bend"}},
            ],
        },
    ],
    "regions": {
        "tip/front": {
            "link": "tip",
            "cap": {"centre": [0, 0, 0], "radius": 0.01, "axis": [1, 0, 0], "half_angle_deg": 60},
        },
        "finger/pad": {
            "link": "finger",
            "bezier": [[[0, 0, 0.01], [0, 0.01, 0.01]], [[0.02, 0, 0.01], [0.02, 0.01, 0.01]]],
        },
    },
}
NAN, INF = float("nan"), float("inf")
REMOVE = object()


class WrittenOut(yaml.SafeDumper):
    """Repeats what stands twice in a tree, as a person would."""

    def ignore_aliases(self, data):
        return True


def changed(path, value):
    """GOOD with the field at a dotted path replaced, added or removed."""
    data = copy.deepcopy(GOOD)
    *where, last = [int(part) if part.isdigit() else part for part in path.split(".")]
    target = data
    for part in where:
        target = target[part]
    if value is REMOVE:
        del target[last]
    else:
        target[last] = value
    return data


def link(name):
    return {"name": name, "mass": 0.1, "shapes": [{"sphere": {"centre": [0, 0, 0], "radius": 0.01}}]}


def fixed(parent, child):
    return {"type": "fixed", "parent": parent, "child": child, "position": [0, 0, 0]}


AXIS = "joints.1.axes.0"
POINTS = "links.1.shapes.1.hull.points"
# what is wrong: (path changed, value, field that the message names, words of the remedy)
BAD = {
    "name with slash": ("name", "a/b", "name", "letters, digits"),
    "name with dots": ("name", "..", "name", "does not start with"),
    "name empty": ("name", "", "name", "letters, digits"),
    "name with newline": ("name", "a\nb", "name", "letters, digits"),
    "name with trailing newline": ("name", "a\n", "name", "letters, digits"),
    "name with escape": ("name", "a\x1b[31m", "name", "letters, digits"),
    "name with a letter of another script": ("name", "hаnd", "name", "letters, digits"),
    "name too long": ("name", "a" * 65, "name", "64"),
    "name a number": ("name", 5, "name", "string"),
    "unknown field": ("jonits", [], "jonits", "did you mean 'joints'?"),
    "unknown field of a link": ("links.0.maas", 1, "links.0.maas", "did you mean 'mass'?"),
    "unknown field of an axis": (f"{AXIS}.limit", [0, 1], f"{AXIS}.limit", "did you mean 'limits'?"),
    "no links": ("links", [], "links", "at least 1"),
    "links not a list": ("links", {"a": 1}, "links", "list"),
    "link null": ("links.0", None, "links.0", "dictionary"),
    "link without shapes": ("links.0.shapes", [], "links.0.shapes", "at least 1"),
    "duplicate link": ("links.1.name", "palm", "links.1.name", "already a link"),
    "link called world": ("links.2.name", "world", "links.2.name", "reserved"),
    "link name with slash": ("links.2.name", "a/b", "links.2.name", "letters, digits"),
    "mass zero": ("links.0.mass", 0, "links.0.mass", "greater than or equal"),
    "mass negative": ("links.0.mass", -1.0, "links.0.mass", "greater than or equal"),
    "mass tiny": ("links.0.mass", 1e-300, "links.0.mass", "greater than or equal"),
    "mass NaN": ("links.0.mass", NAN, "links.0.mass", "finite"),
    "mass infinite": ("links.0.mass", INF, "links.0.mass", "finite"),
    "mass as text": ("links.0.mass", "heavy", "links.0.mass", "number"),
    "mass true": ("links.0.mass", True, "links.0.mass", "number"),
    "mass a list": ("links.0.mass", [1], "links.0.mass", "number"),
    "mass of tonnes": ("links.0.mass", 1e6, "links.0.mass", "1000"),
    "two shapes at once": (
        "links.2.shapes.0.box",
        {"centre": [0, 0, 0], "half_extents": [1, 1, 1]},
        "links.2.shapes.0",
        "exactly one",
    ),
    "no shape": ("links.2.shapes.0", {}, "links.2.shapes.0", "exactly one"),
    "half extents tiny": ("links.0.shapes.0.box.half_extents", [1e-12, 1, 1], "half_extents.0", "metres"),
    "half extents of two": ("links.0.shapes.0.box.half_extents", [1, 1], "half_extents.2", "required"),
    "centre far away": ("links.0.shapes.0.box.centre", [1e12, 0, 0], "centre.0", "100 m"),
    "capsule of no length": (
        "links.1.shapes.0.capsule.end",
        [0, 0, 0],
        "links.finger.shapes.0.capsule",
        "differ",
    ),
    "radius negative": ("links.2.shapes.0.sphere.radius", -0.1, "radius", "metres"),
    "flat hull": (POINTS, [[0, 0, 0.01], [1, 0, 0.01], [0, 1, 0.01], [1, 1, 0.01]], "hull", "one plane"),
    "hull NaN": (f"{POINTS}.0", [NAN, 0, 0], f"{POINTS}.0.0", "finite"),
    "hull of an unknown region": (
        "links.1.shapes.1.hull.regions",
        ["finger/pat"],
        "hull.regions",
        "did you mean 'finger/pad'?",
    ),
    "hull of another link's region": (
        "links.1.shapes.1.hull.regions",
        ["tip/front"],
        "hull.regions",
        "known",
    ),
    "palm unknown": ("palm", "plam", "palm", "did you mean 'palm'?"),
    "parent unknown": ("joints.0.parent", "plam", "joints.0.parent", "did you mean 'palm'?"),
    "child unknown": ("joints.1.child", "tpi", "joints.1.child", "did you mean 'tip'?"),
    "child is the palm": ("joints.1.child", "palm", "joints.1.child", "already hangs"),
    "child twice": ("joints.1.child", "finger", "joints.1.child", "already hangs"),
    "loose link": ("links", [*GOOD["links"], link("extra")], "joints", "'extra' is not connected"),
    "cycle": ("joints.0.parent", "tip", "joints", "not connected to the palm"),
    "its own parent": ("joints.1.parent", "tip", "joints", "not connected to the palm"),
    "joint type unknown": ("joints.1.type", "ball", "joints.1.type", "'revolute'"),
    "too few axes": ("joints.0.type", "revolute", "joints.finger.axes", "has 1 axes, not 2"),
    "fixed with an axis": ("joints.1.type", "fixed", "joints.tip.axes", "has 0 axes"),
    "no moving joint": (
        "joints",
        [fixed("palm", "finger"), fixed("finger", "tip")],
        "joints",
        "at least one joint",
    ),
    "x axis too long": ("joints.1.x_axis", [2, 0, 0], "joints.tip.x_axis", "unit vector"),
    "y axis zero": ("joints.1.y_axis", [0, 0, 0], "joints.tip.y_axis", "unit vector"),
    "axes of the frame not perpendicular": (
        "joints.1.y_axis",
        [0.6, 0.8, 0],
        "joints.tip.y_axis",
        "perpendicular",
    ),
    "universal axes not perpendicular": (
        "joints.0.axes.1.direction",
        [0, 1, 1],
        "joints.finger.axes",
        "perpendicular",
    ),
    "zero axis": (f"{AXIS}.direction", [0, 0, 0], "joints.tip.axes.0.direction", "zero vector"),
    "axis infinite": (f"{AXIS}.direction", [0, -INF, 0], f"{AXIS}.direction.1", "finite"),
    "duplicate joint": (f"{AXIS}.name", "bend", "joints.tip.axes", "already a joint"),
    "joint name with slash": (f"{AXIS}.name", "a/b", f"{AXIS}.name", "letters, digits"),
    "limits reversed": (f"{AXIS}.limits", [1, 0], AXIS, "above the upper"),
    "limits twice": (f"{AXIS}.limits_deg", [0, 10], AXIS, "exactly one of limits"),
    "no limits": (f"{AXIS}.limits", REMOVE, AXIS, "exactly one of limits"),
    "limits NaN": (f"{AXIS}.limits", [NAN, 1], f"{AXIS}.limits.0", "finite"),
    "limits infinite": (f"{AXIS}.limits", [-INF, INF], f"{AXIS}.limits.0", "finite"),
    "limits in degrees": (f"{AXIS}.limits", [0, 90], "limits", "limits_deg"),
    "limits of three": (f"{AXIS}.limits", [0, 1, 2], f"{AXIS}.limits", "at most 2"),
    "offset beyond a turn": (f"{AXIS}.zero_offset_deg", 1e9, f"{AXIS}.zero_offset_deg", "360"),
    "actuator unknown": ("joints.0.axes.0.actuator", "sevro", "actuator", "did you mean 'servo'?"),
    "neither actuator nor coupled": (f"{AXIS}.coupled", REMOVE, AXIS, "actuator, or coupled"),
    "actuator and coupled": (f"{AXIS}.actuator", "servo", AXIS, "actuator, or coupled"),
    "effort zero": ("actuators.servo.effort", 0, "actuators.servo.effort", "greater than 0"),
    "effort of an actuator in place": (
        "joints.0.axes.1.actuator.effort",
        0,
        "joints.0.axes.1.actuator.effort",
        "greater than 0",
    ),
    "misspelt field of an actuator in place": (
        "joints.0.axes.1.actuator.efort",
        1,
        "joints.0.axes.1.actuator.efort",
        "did you mean 'effort'?",
    ),
    "armature negative": (
        "actuators.servo.armature",
        -1,
        "actuators.servo.armature",
        "greater than or equal",
    ),
    "coupled to an unknown joint": (f"{AXIS}.coupled.to", "bned", "curl.coupled.to", "did you mean 'bend'?"),
    "coupled to itself": (f"{AXIS}.coupled.to", "curl", "curl.coupled.to", "circle"),
    "ratio zero": (f"{AXIS}.coupled.ratio", 0, f"{AXIS}.coupled", "ratio"),
    "ratio huge": (f"{AXIS}.coupled.ratio", 1e9, f"{AXIS}.coupled.ratio", "100"),
    "coupling beyond the limits": (f"{AXIS}.limits", [3, 4], "joints", "exclude each other"),
    "region on an unknown link": (
        "regions.tip/front.link",
        "tpi",
        "regions.tip/front.link",
        "did you mean 'tip'?",
    ),
    "region without link": ("regions.tip/front.link", REMOVE, "regions.tip/front.link", "required"),
    "region without kind": ("regions.tip/front.cap", REMOVE, "regions.tip/front", "exactly one"),
    "region of two kinds": (
        "regions.finger/pad.cap",
        GOOD["regions"]["tip/front"]["cap"],
        "regions.finger/pad",
        "exactly one",
    ),
    "half angle 0": ("regions.tip/front.cap.half_angle_deg", 0, "half_angle_deg", "greater than 0"),
    "half angle 200": ("regions.tip/front.cap.half_angle_deg", 200, "half_angle_deg", "180"),
    "cap axis zero": ("regions.tip/front.cap.axis", [0, 0, 0], "cap.axis", "zero vector"),
    "net ragged": ("regions.finger/pad.bezier.0", [[0, 0, 0]], "regions.finger/pad.bezier", "2 x 2"),
    "region name climbing": ("regions.../../x", GOOD["regions"]["tip/front"], "regions", "joined|join"),
    "region name absolute": ("regions./x", GOOD["regions"]["tip/front"], "regions", "joined|join"),
}


def write(folder, data):
    path = folder / "hand.yaml"
    path.write_text(yaml.dump(data, Dumper=WrittenOut))
    return path


def test_the_good_file_is_accepted(tmp_path):
    hand = load_hand(write(tmp_path, GOOD))
    assert hand.joint_names == ("spread", "bend", "curl")
    assert set(hand.regions) == {"tip/front", "finger/pad"}


@pytest.mark.parametrize(("path", "value", "field", "words"), BAD.values(), ids=BAD.keys())
def test_bad_hands_are_refused(tmp_path, path, value, field, words):
    if path.startswith(("regions../", "regions.../")):
        data = copy.deepcopy(GOOD)
        data["regions"][path.removeprefix("regions.")] = value
    else:
        data = changed(path, value)
    file = write(tmp_path, data)
    with pytest.raises(InputError, match=words) as caught:
        load_hand(file)
    assert str(caught.value).startswith(f"{file}: ")
    assert field in caught.value.field
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600


@pytest.mark.parametrize("name", ["sb", "SA", "", "../sa", "sa/", "hand.yaml.txt", "sa\n"])
def test_unknown_hands(name):
    with pytest.raises(InputError, match="unknown hand"):
        load_hand(name)


def test_limits_in_degrees_of_a_slide_are_refused(tmp_path):
    data = changed("joints.1.type", "prismatic")
    axis = data["joints"][1]["axes"][0]
    del axis["limits"]
    axis["limits_deg"] = [0, 10]
    with pytest.raises(InputError, match="prismatic joint has limits in m"):
        load_hand(write(tmp_path, data))
