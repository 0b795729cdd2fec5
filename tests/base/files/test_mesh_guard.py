"""What stands for more than it takes is refused before a reader builds it."""

import copy
import json
import struct

import pytest
from holdfast.base.files.mesh_guard import check_mesh

PRIMITIVES = [{"attributes": {"POSITION": 0}, "indices": 1}]
GOOD = {
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": PRIMITIVES}],
    "accessors": [{"bufferView": 0, "count": 40}, {"bufferView": 1, "count": 120}],
}


def glb(content):
    text = json.dumps(content).encode()
    return struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text), len(text), b"JSON") + text


def check(**changes):
    check_mesh(glb({**copy.deepcopy(GOOD), **changes}), "glb", largest=1000)


def test_a_mesh_placed_a_few_times_is_let_through():
    check(nodes=[{"mesh": 0}] * 20)


@pytest.mark.parametrize(
    ("says", "changes"),
    [
        ("more than 1000 triangles", {"nodes": [{"mesh": 0}] * 30}),
        ("more than 1000 triangles", {"meshes": [*GOOD["meshes"], {"primitives": PRIMITIVES * 30}]}),
        ("too many numbers", {"accessors": [{"bufferView": 0, "count": 10**12}] * 2}),
        ("without a buffer", {"accessors": [{"count": 40}, {"count": 120}]}),
        ("hangs on two", {"nodes": [{"children": [1, 1]}, {"mesh": 0}]}),
        ("circle", {"nodes": [{"children": [1]}, {"children": [0]}]}),
        ("not a whole number", {"accessors": [{"bufferView": 0, "count": -1}] * 2}),
        ("not what glTF allows", {"meshes": [{}]}),
        ("not what glTF allows", {"nodes": 3}),
    ],
)  # fmt: skip
def test_what_grows_too_large_is_refused(says, changes):
    with pytest.raises(ValueError, match=says):
        check(**changes)


@pytest.mark.parametrize("face", ["f 0 1 2", "f 1/1 2/2 0/3", "  f 3 2 1 00", "f 1 2 0//1\r"])
def test_the_index_0_of_obj_is_refused(face):
    with pytest.raises(ValueError, match="index 0"):
        check_mesh(f"v 0 0 0\n{face}\n".encode(), "obj", largest=10)


def test_other_zeros_are_none_of_its_business():
    check_mesh(b"v 0 0 0\nvn 0 0 1\nf 1/0 2 3\nf 10 20 30\nf -1 -2 -3\n# f 0\n", "obj", largest=10)
