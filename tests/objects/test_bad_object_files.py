"""Every malformed object file is refused in one line that names the file, the field and the remedy."""

import copy

import numpy as np
import pytest
import trimesh
import yaml
from holdfast.errors import InputError
from holdfast.objects import load_object

NAN, INF = float("nan"), float("inf")
GOOD = {
    "name": "mug",
    "box": {"half_extents": [0.03, 0.03, 0.05]},
    "mass": 0.3,
    "centre": [0, 0, 0.01],
    "inertia": [[1e-4, 0, 0], [0, 1e-4, 0], [0, 0, 1.5e-4]],
    "friction": 0.6,
    "regions": {
        "rim": {"point": [0.03, 0, 0], "normal": [1, 0, 0]},
        "side": {"bezier": [[[0.03, 0, 0], [0.03, 0.01, 0]], [[0.03, 0, 0.01], [0.03, 0.01, 0.01]]]},
    },
}
WITHOUT_BOX = {key: value for key, value in GOOD.items() if key != "box"}
POINT = GOOD["regions"]["rim"]

# what is wrong: (changed fields, field that the message names, words of the remedy)
BAD = {
    "name climbing": ({"name": "../mug"}, "name", "letters, digits"),
    "name hidden": ({"name": ".mug"}, "name", "does not start with"),
    "name like an option": ({"name": "-rf"}, "name", "does not start with"),
    "name with space": ({"name": "my mug"}, "name", "letters, digits"),
    "name with null": ({"name": "a\0b"}, "name", "letters, digits"),
    "name a number": ({"name": 7}, "name", "string"),
    "unknown field": ({"fricton": 0.5}, "fricton", "did you mean 'friction'?"),
    "unknown field of a shape": ({"box": {"half_extent": [1, 1, 1]}}, "box.half_extent", "'half_extents'"),
    "unknown field of a region": ({"regions": {"a": {**POINT, "nromal": 1}}}, "regions.a.nromal", "'normal'"),
    "no shape": ({"box": ...}, "", "exactly one of mesh, box"),
    "two shapes": ({"sphere": {"radius": 0.1}}, "", "exactly one of mesh, box"),
    "unknown generator": ({"box": ..., "generator": "teapto"}, "generator", "'teapot'"),
    "no mass": ({"mass": ...}, "", "mass is required"),
    "mass zero": ({"mass": 0}, "mass", "greater than or equal"),
    "mass negative": ({"mass": -0.3}, "mass", "greater than or equal"),
    "mass NaN": ({"mass": NAN}, "mass", "finite"),
    "mass infinite": ({"mass": INF}, "mass", "finite"),
    "mass with unit": ({"mass": "0.3 kg"}, "mass", "number"),
    "mass true": ({"mass": True}, "mass", "number"),
    "no friction": ({"friction": ...}, "friction", "required"),
    "friction zero": ({"friction": 0}, "friction", "greater than 0"),
    "friction 100": ({"friction": 100}, "friction", "less than or equal to 10"),
    "half extents tiny": ({"box": {"half_extents": [1e-12, 1e-12, 1e-12]}}, "half_extents.0", "metres"),
    "half extents negative": ({"box": {"half_extents": [-0.1, 0.1, 0.1]}}, "half_extents.0", "metres"),
    "half extents NaN": ({"box": {"half_extents": [NAN, 0.1, 0.1]}}, "half_extents.0", "finite"),
    "half extents far too small": ({"box": {"half_extents": [1e-5, 1e-5, 1e-5]}}, "", "2e-05 m long"),
    "units of a box": ({"units": "mm"}, "", "units is for a mesh"),
    "scale of a box": ({"scale": 0.001}, "", "scale is for a mesh"),
    "unknown units": ({"box": ..., "mesh": "a.obj", "units": "inch"}, "units", "one of m, cm, mm, in, ft"),
    "scale zero": ({"box": ..., "mesh": "a.obj", "scale": 0}, "scale", "greater than or equal"),
    "scale as text": ({"box": ..., "mesh": "a.obj", "scale": "2"}, "scale", "number"),
    "half extents one number": ({"box": {"half_extents": 0.1}}, "half_extents", "tuple"),
    "box null": ({"box": None}, "", "exactly one"),
    "inertia without centre": ({"centre": ...}, "", "needs centre"),
    "inertia not symmetric": (
        {"inertia": [[1e-4, 1e-5, 0], [0, 1e-4, 0], [0, 0, 1e-4]]},
        "inertia",
        "symmetric",
    ),
    "inertia negative": ({"inertia": (-1e-4 * np.eye(3)).tolist()}, "inertia", "positive"),
    "inertia zero": ({"inertia": np.zeros((3, 3)).tolist()}, "inertia", "positive"),
    "inertia not of a body": ({"inertia": np.diag([1e-5, 1e-5, 1e-4]).tolist()}, "inertia", "sum"),
    "inertia in g mm^2": ({"inertia": (1e5 * np.eye(3)).tolist()}, "inertia", "mass and size"),
    "inertia of six numbers": ({"inertia": [1, 1, 1, 0, 0, 0]}, "inertia", "tuple|at most"),
    "centre outside": ({"centre": [10, 0, 0]}, "centre", "inside the object"),
    "centre huge": ({"centre": [1e300, 0, 0]}, "centre.0", "100 m"),
    "region far away": ({"regions": {"rim": {**POINT, "point": [30, 0, 0]}}}, "regions.rim", "metres"),
    "patch far away": (
        {"regions": {"side": {"bezier": [[[30, 0, 0], [30, 10, 0]], [[30, 0, 10], [30, 10, 10]]]}}},
        "regions.side",
        "metres",
    ),
    "control point of 1e12 m": (
        {"regions": {"side": {"bezier": [[[0, 0, 0], [0, 1e12, 0]], [[1, 0, 0], [1, 1, 0]]]}}},
        "regions.side.bezier.0.1.1",
        "100 m",
    ),
    "region with NaN": (
        {"regions": {"rim": {**POINT, "point": [NAN, 0, 0]}}},
        "regions.rim.point.0",
        "finite",
    ),
    "regions a list": ({"regions": [POINT]}, "regions", "dictionary"),
    "region null": ({"regions": {"rim": None}}, "regions.rim", "dictionary"),
    "region name climbing": ({"regions": {"../x": POINT}}, "regions", "join"),
    "region name ending in a slash": ({"regions": {"a/": POINT}}, "regions", "join"),
    "region name empty": ({"regions": {"": POINT}}, "regions", "join"),
    "region name with newline": ({"regions": {"a\nb": POINT}}, "regions", "join"),
    "source a number": ({"sources": {"mass": 3}}, "sources.mass", "string"),
    "description a list": ({"description": ["a"]}, "description", "string"),
    "description a book": ({"description": "a" * 10_000}, "description", "at most 2000"),
}


class WrittenOut(yaml.SafeDumper):
    """Repeats what stands twice in a tree, as a person would."""

    def ignore_aliases(self, data):
        return True


def write(folder, changes):
    data = copy.deepcopy(GOOD)
    for key, value in changes.items():
        data.pop(key, None)
        if value is not ...:
            data[key] = value
    path = folder / "mug.yaml"
    path.write_text(yaml.dump(data, Dumper=WrittenOut))
    return path


def check_refused(path, field, words):
    with pytest.raises(InputError, match=words) as caught:
        load_object(path)
    assert str(caught.value).startswith(f"{path}: ")
    assert field in caught.value.field
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600


def test_the_good_file_is_accepted(tmp_path):
    assert load_object(write(tmp_path, {})).name == "mug"


@pytest.mark.parametrize(("changes", "field", "words"), BAD.values(), ids=BAD.keys())
def test_bad_objects_are_refused(tmp_path, changes, field, words):
    check_refused(write(tmp_path, changes), field, words)


@pytest.mark.parametrize(
    ("mesh", "words"),
    [
        ("missing.obj", "no such file or directory"),
        ("../outside.obj", "below the folder"),
        ("/etc/hostname", "below the folder"),
        ("link.obj", "below the folder"),
        ("folder.obj", "is not a regular file"),
        ("", "is no mesh that is read"),
        ("notes.txt", "is no mesh that is read"),
        ("nul\0l.obj", "not the path"),
        (5, "string"),
        (["a.obj"], "string"),
    ],
)
def test_meshes_that_may_not_or_cannot_be_read(tmp_path, mesh, words):
    folder = tmp_path / "inside"
    (folder / "folder.obj").mkdir(parents=True)
    trimesh.creation.box(extents=[0.1] * 3).export(tmp_path / "outside.obj")
    (folder / "link.obj").symlink_to("../outside.obj")
    (folder / "notes.txt").write_text("hello")
    check_refused(write(folder, {"box": ..., "mesh": mesh}), "mesh", words)


@pytest.mark.parametrize("name", ["scalpl", "", "../scalpel", "scalpel/", "a\nb"])
def test_unknown_objects(name):
    with pytest.raises(InputError, match="unknown object"):
        load_object(name)


def test_what_is_like_no_object_is_told_of_paths():
    with pytest.raises(InputError, match=r"unknown object 'cup'; known: .* or of a mesh"):
        load_object("cup")
