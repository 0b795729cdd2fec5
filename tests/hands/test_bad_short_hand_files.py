"""Malformed files of hands that are built or imported: one line with the file, the field and the remedy."""

import copy

import pytest
import yaml
from holdfast.errors import InputError
from holdfast.hands import load_hand
from holdfast.pipeline.cli.main import main

SERVO = {"effort": 3.0, "stiffness": 20.0, "damping": 0.5, "armature": 0.002}
BOX = [{"box": {"centre": [0, 0, 0.05], "half_extents": [0.01, 0.04, 0.05]}}]
CAP = {"centre": [0, 0, 0], "radius": 0.01, "axis": [1, 0, 0], "half_angle_deg": 60}
BUILT = {
    "name": "pair",
    "palm": {"mass": 0.3, "shapes": BOX},
    "density": 1500,
    "actuator": SERVO,
    "fingers": {
        "index": {
            "structure": "RU(RR)",
            "position": [0, 0.02, 0.1],
            "lengths": [0.03, 0.04, 0.03, 0.025],
            "radius": 0.009,
            "joints": [
                {"joint": 1, "axes": [[1, 0, 0]], "limits_deg": [[0, 30]]},
                {"joint": 2, "mount": {"position": [0.02, 0, 0.02]}},
            ],
        },
        "little": {
            "structure": "RUR",
            "base": "index",
            "position": [0, 0.03, 0],
            "lengths": [0.04, 0.025],
            "radius": 0.009,
        },
    },
    "regions": {"palm/front": {"link": "palm", "cap": CAP}},
}
MODEL = """
<mujoco><compiler angle="radian"/><worldbody><body name="palm"><geom size="0.03"/>
  <body name="one" pos="0 0 0.05"><joint name="a" axis="1 0 0" range="0 1"/><geom size="0.01"/>
    <body name="two" pos="0 0 0.04"><joint name="b" axis="1 0 0" range="0 1"/><geom size="0.01"/></body>
  </body></body><body name="other"/></worldbody></mujoco>
"""
IMPORTED = {
    "name": "taken",
    "import": "hand.xml",
    "palm": "palm",
    "actuator": SERVO,
    "actuators": {"a": SERVO},
    "coupled": {"b": {"to": "a", "ratio": "2/3"}},
    "limits": {"a": [0, 1.2]},
    "link_names": {"two": "tip"},
    "joint_names": {},
    "regions": {"one/tip": {"link": "tip", "cap": CAP}},
}
REMOVE = object()


class WrittenOut(yaml.SafeDumper):
    """Repeats what stands twice in a tree, as a person would."""

    def ignore_aliases(self, data):
        return True


def write(folder, good, changes):
    data = copy.deepcopy(good)
    for path, value in changes.items():
        *where, last = [int(part) if part.isdigit() else part for part in path.split(".")]
        target = data
        for part in where:
            target = target[part]
        if value is REMOVE:
            del target[last]
        else:
            target[last] = value
    (folder / "hand.xml").write_text(MODEL)
    path = folder / "hand.yaml"
    path.write_text(yaml.dump(data, Dumper=WrittenOut))
    return path


INDEX = "fingers.index"
# what is wrong: (path changed, value, field that the message names, words of the remedy)
BAD_BUILT = {
    "structure of other letters": (
        f"{INDEX}.structure",
        "PRR",
        INDEX,
        "no finger structure: that is made of R and U",
    ),
    "structure with one in parentheses": (
        f"{INDEX}.structure",
        "U(R)R",
        INDEX,
        "two or more that turn together",
    ),
    "structure a number": (f"{INDEX}.structure", 5, f"{INDEX}.structure", "string"),
    "structure missing": (f"{INDEX}.structure", REMOVE, f"{INDEX}.structure", "required"),
    "too few lengths": (f"{INDEX}.lengths", [0.03, 0.04], INDEX, "2 entries, not 4, one per joint"),
    "length negative": (f"{INDEX}.lengths.1", -0.04, f"{INDEX}.lengths.1", "greater than or equal to 0"),
    "length in millimetres": (f"{INDEX}.lengths.1", 40, f"{INDEX}.lengths.1", "less than or equal to 1"),
    "no room for the fingertip": (f"{INDEX}.lengths.3", 0.017, INDEX, "at least twice the radius, 0.018 m"),
    "radius zero": (f"{INDEX}.radius", 0, f"{INDEX}.radius", "metres"),
    "misspelt field": (f"{INDEX}.lenghts", [], f"{INDEX}.lenghts", "did you mean 'lengths'?"),
    "misspelt field of a joint": (f"{INDEX}.joints.0.axis", [], "joints.0.axis", "did you mean 'axes'?"),
    "joint beyond the structure": (
        f"{INDEX}.joints.0.joint",
        5,
        INDEX,
        "joint 5, but the finger's own are 1 to 4",
    ),
    "joint twice": (f"{INDEX}.joints.0.joint", 2, INDEX, "same joint twice"),
    "axes of another joint": (
        f"{INDEX}.joints.0.axes",
        [[1, 0, 0], [0, 1, 0]],
        INDEX,
        "axes of joint 1 has 2 entries",
    ),
    "limits of another joint": (
        f"{INDEX}.joints.0.limits_deg",
        [],
        INDEX,
        "limits_deg of joint 1 has 0 entries",
    ),
    "limits reversed": (f"{INDEX}.joints.0.limits_deg", [[30, 0]], INDEX, "lower limit above its upper"),
    "limits beyond a turn": (f"{INDEX}.joints.0.limits_deg", [[0, 400]], "limits_deg.0.1", "360"),
    "first joint with a mount": (
        f"{INDEX}.joints.0.mount",
        {"position": [0, 0, 0]},
        INDEX,
        "it has no mount",
    ),
    "mount askew": (f"{INDEX}.joints.1.mount.x_axis", [2, 0, 0], "x_axis", "unit vector"),
    "zero axis": (f"{INDEX}.joints.0.axes", [[0, 0, 0]], "direction", "zero vector"),
    "base unknown": ("fingers.little.base", "indxe", "fingers.little.base", "did you mean 'index'?"),
    "base of another kind": (
        "fingers.little.structure",
        "UUR",
        "fingers.little.base",
        "starts with R: so must",
    ),
    "turning with the base": (
        "fingers.little.structure",
        "(RUR)",
        "fingers.little",
        "with the joint of the base",
    ),
    "nothing beyond the base": (
        "fingers.little.structure",
        "R",
        "fingers.little",
        "at least one joint of its own",
    ),
    "no fingers": ("fingers", {}, "fingers", "at least 1"),
    "finger name with slash": ("fingers.a/b", BUILT["fingers"]["index"], "fingers.a/b", "letters, digits"),
    "density of a gas": ("density", 1.2, "density", "greater than or equal to 10"),
    "palm without shapes": ("palm.shapes", [], "palm.shapes", "at least 1"),
    "region that is built": (
        "regions.index/tip",
        {"link": "palm", "cap": CAP},
        "regions.index/tip",
        "another name",
    ),
    "region on an unknown link": (
        "regions.palm/front.link",
        "index_5",
        "regions.palm/front.link",
        "did you mean",
    ),
}
BAD_IMPORTED = {
    "no such model": ("import", "hnad.xml", "", "no such file"),
    "a model outside": ("import", "../hand.xml", "import", "below the folder of this file"),
    "an absolute model": ("import", "/etc/hostname", "import", "below the folder of this file"),
    "a folder for a model": ("import", ".", "", "is not a regular file"),
    "the hand file itself": ("import", "hand.yaml", "", "not valid XML"),
    "an empty name": ("import", "", "import", "at least 1 character"),
    "palm unknown": ("palm", "plam", "palm", "did you mean 'palm'?"),
    "palm to be chosen": ("palm", REMOVE, "palm", "is required: several bodies"),
    "palm that carries nothing": ("palm", "other", "link_names.two", "unknown body 'two'"),
    "palm frame askew": ("palm_frame", {"x_axis": [1, 1, 0]}, "palm_frame.x_axis", "unit vector"),
    "actuator of an unknown joint": ("actuators.aa", SERVO, "actuators.aa", "unknown joint 'aa'"),
    "limits of an unknown joint": ("limits.c", [0, 1], "limits.c", "unknown joint 'c'; known: a, b"),
    "limits reversed": ("limits.a", [1, 0], "limits.a", "above the upper limit"),
    "limits in degrees": ("limits.a", [0, 90], "limits.a", "must lie in [-6.283, 6.283] rad"),
    "coupled to an unknown joint": ("coupled.b.to", "c", "joints.b.coupled.to", "unknown joint 'c'"),
    "coupled to itself": ("coupled.b.to", "b", "joints.b.coupled.to", "circle"),
    "ratio by words": ("coupled.b.ratio", "two thirds", "coupled.b.ratio", "valid number"),
    "ratio over zero": ("coupled.b.ratio", "2/0", "coupled.b.ratio", "valid number"),
    "two offsets": ("coupled.b", {"to": "a", "offset": 0.1, "offset_deg": 5}, "coupled.b", "not both"),
    "new name twice": ("link_names.one", "tip", "link_names.one", "stands twice"),
    "new name with a blank": ("link_names.one", "a b", "link_names.one", "letters, digits"),
    "new name of nothing": ("joint_names.c", "d", "joint_names.c", "unknown joint 'c'"),
    "region on an unknown link": (
        "regions.one/tip.link",
        "two",
        "regions.one/tip.link",
        "known: palm, one, tip",
    ),
    "links as well": ("links", [], "import", "exactly one of links"),
    "misspelt field": ("actuater", SERVO, "actuater", "did you mean 'actuator'?"),
}
BAD = {
    **{f"built: {what}": (BUILT, {path: value}, *rest) for what, (path, value, *rest) in BAD_BUILT.items()},
    **{
        f"imported: {what}": (IMPORTED, {path: value}, *rest)
        for what, (path, value, *rest) in BAD_IMPORTED.items()
    },
    "imported: misspelt import": (
        IMPORTED,
        {"imprt": "hand.xml", "import": REMOVE},
        "imprt",
        "did you mean 'import'?",
    ),
    "none of the three kinds": (
        IMPORTED,
        {"import": REMOVE},
        "links",
        "exactly one of links .*, fingers .*, import",
    ),
}


def test_the_good_files_are_accepted(tmp_path):
    built = load_hand(write(tmp_path, BUILT, {}))
    assert built.joint_names == (
        "index_1", "index_2_abduction", "index_2_flexion", "index_3", "index_4",
        "little_2_abduction", "little_2_flexion", "little_3",
    )  # fmt: skip
    assert built.independent_names == (
        "index_1", "index_2_abduction", "index_2_flexion", "index_3",
        "little_2_abduction", "little_2_flexion", "little_3",
    )  # fmt: skip
    assert built.links[built.link_index("little_2")].parent == built.link_index("index_1")
    taken = load_hand(write(tmp_path, IMPORTED, {}))
    assert [link.name for link in taken.links] == ["palm", "one", "tip"]
    assert taken.axes[1].coupling.ratio == 2.0 / 3.0
    assert taken.limits[0].tolist() == [0.0, 1.2]


@pytest.mark.parametrize(("good", "changes", "field", "words"), BAD.values(), ids=BAD.keys())
def test_bad_files_are_refused(tmp_path, good, changes, field, words):
    file = write(tmp_path, good, changes)
    words = words.replace("[-6.283, 6.283]", r"\[-6.283, 6.283\]")
    with pytest.raises(InputError, match=words) as caught:
        load_hand(file)
    assert str(caught.value).startswith(str(tmp_path))
    assert field in caught.value.field
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600


@pytest.mark.parametrize("case", ["built: too few lengths", "imported: palm unknown"])
def test_the_command_line_says_so_with_exit_code_2(tmp_path, case, capsys):
    good, changes, field, _ = BAD[case]
    assert main(["hands", str(write(tmp_path, good, changes))]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("holdfast: ") and field in line
