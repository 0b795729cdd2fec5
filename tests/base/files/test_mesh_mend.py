"""Mesh files as exporters write them: each is the same box, or block, as its plain form."""

import json
import struct
from io import BytesIO

import numpy as np
import pytest
import trimesh
from holdfast.base.files.mesh_guard import check_mesh
from holdfast.base.files.mesh_mend import mended_mesh

BOX = trimesh.creation.box((0.04, 0.05, 0.06))
CORNERS = [(x, y, z) for z in (0, 0.06) for y in (0, 0.05) for x in (0, 0.04)]
QUADS = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
# The outline of an L, from a corner that does not see all others.
OUTLINE = [(0.02, 0.02), (0.02, 0.06), (0, 0.06), (0, 0), (0.06, 0), (0.06, 0.02)]


def read(data: bytes, kind: str) -> trimesh.Trimesh:
    check_mesh(data, kind, largest=1000)
    scene = trimesh.load_scene(
        BytesIO(mended_mesh(data, kind)), file_type=kind, process=False, skip_materials=True
    )
    mesh = scene.to_mesh()
    mesh.merge_vertices()
    return mesh


def check(data: bytes, kind: str, *, extents=(0.04, 0.05, 0.06), volume=1.2e-4) -> None:
    mesh = read(data, kind)
    assert mesh.extents == pytest.approx(extents, rel=1e-4) and mesh.volume == pytest.approx(volume, rel=1e-3)


def plain(kind: str) -> bytes:
    made = BOX.export(file_type=kind)
    return made.encode() if isinstance(made, str) else made


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "obj", "ply", "off", "glb"])
def test_plain_files_stay_as_they_are(kind):
    data, suffix = plain(kind), kind.partition("_")[0]
    assert mended_mesh(data, suffix).strip() == data.strip()
    check(data, suffix)


def test_bytes_behind_a_binary_stl_and_a_head_that_reads_like_text():
    data = plain("stl")
    check(data + b"\0" * 37, "stl")
    check(b"solid exported".ljust(80) + data[80:] + b"\0" * 3, "stl")


def test_a_text_stl_without_its_last_line():
    text = plain("stl_ascii")
    check(text[: text.rindex(b"endsolid")], "stl")


def test_tabs_and_margins_in_an_obj():
    rows = [("v", *p) for p in CORNERS] + [("f", *(i + 1 for i in quad)) for quad in QUADS]
    check("".join("  " + "\t".join(map(str, row)) + "\r\n" for row in rows).encode(), "obj")


def test_comments_and_polygons_in_an_off():
    n = len(OUTLINE)
    sides = [(i, (i + 1) % n, (i + 1) % n + n, i + n) for i in range(n)]
    faces = [tuple(range(n)), tuple(range(2 * n - 1, n - 1, -1)), *(side[::-1] for side in sides)]
    points = [(*p, z) for z in (0, 0.03) for p in OUTLINE]
    text = f"OFF # an L\n# made by hand\n\n{2 * n} {len(faces)} 0\n\n"
    text += "".join(f"{x} {y} {z} # corner\n" for x, y, z in points)
    text += "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)
    mesh = read(text.encode(), "off")
    assert mesh.is_watertight and abs(mesh.volume) == pytest.approx(0.03 * 0.002)


@pytest.mark.parametrize("order", ["<", ">"])
def test_polygons_of_several_sizes_in_a_binary_ply(order):
    word = {"<": "little", ">": "big"}[order]
    head = (
        f"ply\nformat binary_{word}_endian 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
        "property float z\nelement face 7\nproperty uchar flags\nproperty list uchar int vertex_indices\n"
        "end_header\n"
    )
    faces = [QUADS[0][:3], (QUADS[0][0], *QUADS[0][2:]), *QUADS[1:]]
    body = b"".join(struct.pack(f"{order}fff", *p) for p in CORNERS)
    body += b"".join(struct.pack(f"{order}BB{len(face)}i", 9, len(face), *face) for face in faces)
    check(head.encode() + body, "ply")
    with pytest.raises(ValueError, match=r"."):
        mended_mesh(head.encode() + body[:-8], "ply")


def glb(points: np.ndarray, code: int, **extra) -> bytes:
    """The box, its corners as given, as a GLB file."""
    faces = BOX.faces.astype("<u2").tobytes()
    stride = points.dtype.itemsize * points.shape[1]
    binary = faces + points.tobytes()
    content = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(binary)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": len(faces)},
            {"buffer": 0, "byteOffset": len(faces), "byteLength": points.nbytes, "byteStride": stride},
        ],
        "accessors": [
            {"bufferView": 0, "componentType": 5123, "count": 36, "type": "SCALAR"},
            {"bufferView": 1, "componentType": code, "count": 8, "type": "VEC3", "normalized": True},
        ],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 1}, "indices": 0}]}],
        "nodes": [{"mesh": 0, "scale": [0.02, 0.025, 0.03]}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
        **extra,
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    chunks = (
        struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
    )
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


@pytest.mark.parametrize(("kind", "whole", "code"), [("<i2", 32767, 5122), ("i1", 127, 5120)])
def test_coordinates_as_shares_of_a_whole_number_in_a_glb(kind, whole, code):
    points = np.zeros((8, 4), kind)
    points[:, :3] = np.sign(BOX.vertices) * whole
    check(glb(points, code), "glb")


@pytest.mark.parametrize("name", ["KHR_draco_mesh_compression", "EXT_meshopt_compression"])
def test_compressed_files_are_refused_as_such(name):
    data = glb(np.zeros((8, 4), "<i2"), 5122, extensionsRequired=[name])
    with pytest.raises(ValueError, match=f"compressed by {name}: export it without compression"):
        check_mesh(data, "glb", largest=1000)
