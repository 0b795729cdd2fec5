"""Files that readers of meshes don't take as they are, and meshes that are too many triangles."""

import re

import numpy as np
import pytest
import trimesh
from holdfast.errors import InputError
from holdfast.geometry.solids import closed_mesh, mesh_file, rebuild
from holdfast.geometry.solids.mesh_file import read_mesh

from ...objects.surface import distance_to_mesh


def read(path):
    return read_mesh(path, "thing.yaml", "mesh")[0]


def comma_text(kind):
    """A box of 20 mm as text with decimal commas."""
    if kind == "stl":
        text = trimesh.creation.box(extents=[0.02] * 3).export(file_type="stl_ascii")
    else:
        text = trimesh.creation.box(extents=[0.02] * 3).export(
            file_type=kind, **({"encoding": "ascii"} if kind == "ply" else {})
        )
    text = text if isinstance(text, str) else text.decode()
    head, end, body = text.rpartition("end_header\n")
    return head + end + re.sub(r"(?<=\d)\.(?=\d)", ",", body)


@pytest.mark.parametrize("kind", ["obj", "stl", "ply", "off"])
def test_decimal_commas_are_read(tmp_path, kind):
    text = comma_text(kind)
    assert "0,01" in text or "1,0" in text
    (tmp_path / f"a.{kind}").write_text(text)
    assert read(tmp_path / f"a.{kind}").volume == pytest.approx(0.02**3)


def test_decimal_commas_of_a_collada_file_are_read(tmp_path):
    pytest.importorskip("collada")
    text = trimesh.creation.box(extents=[0.5] * 3).export(file_type="dae").decode()
    text = re.sub(r"(?<=\d)\.(?=\d+[ <])", ",", text).replace("<asset>", '<asset><unit meter="0,01"/>')
    assert "0,25" in text
    (tmp_path / "a.dae").write_text(text)
    assert read(tmp_path / "a.dae").extents == pytest.approx([0.005] * 3)


STRIPS = [0, 1, 2, 3, -1, 4, 6, 5, 7, -1, 0, 2, 4, 6, -1, 1, 5, 3, 7, -1, 0, 4, 1, 5, -1, 2, 3, 6, 7]


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
def test_strips_of_triangles_of_a_ply_are_read(tmp_path, order):
    """A box whose corner k lies at its bits, with one strip for each side."""
    head = (
        f"ply\nformat {order} 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
        "element tristrips 1\nproperty list int int vertex_indices\nend_header\n"
    )
    corners = 0.02 * np.array([[(k >> 2) & 1, (k >> 1) & 1, k & 1] for k in range(8)])
    rows = [len(STRIPS), *STRIPS]
    if order == "ascii":
        body = "".join(f"{x} {y} {z}\n" for x, y, z in corners) + " ".join(map(str, rows)) + "\n"
        data = (head + body).encode()
    else:
        sign = "<" if "little" in order else ">"
        data = head.encode() + corners.astype(f"{sign}f4").tobytes() + np.array(rows, f"{sign}i4").tobytes()
    (tmp_path / "a.ply").write_bytes(data)
    mesh, repairs = read_mesh(tmp_path / "a.ply", "thing.yaml", "mesh")
    assert len(mesh.faces) == 12 and not repairs
    assert mesh.volume == pytest.approx(0.02**3)


def test_a_glb_file_of_the_first_version_is_told(tmp_path):
    (tmp_path / "a.glb").write_bytes(b"glTF" + np.array([1, 20, 0, 0], "<u4").tobytes())
    with pytest.raises(InputError, match=r"glTF 1\.0, which is no longer read: export it as glTF 2\.0"):
        read(tmp_path / "a.glb")


@pytest.mark.parametrize("extent", [1.0, 1e-3])
def test_edges_that_run_along_several_others_are_closed(extent):
    """A box whose top is four squares: its sides have no corner where these meet."""
    side = np.array([0.0, 1.0, 2.0])
    top = [(x, y, 1.0) for x in side for y in side]
    cells = [(3 * i + j) for i in (0, 1) for j in (0, 1)]
    quads = [(k, k + 3, k + 4, k + 1) for k in cells]
    bottom = [(x, y, 0.0) for x, y in ((0, 0), (2, 0), (2, 2), (0, 2))]
    below = [9, 10, 11, 12]
    above = [0, 6, 8, 2]
    quads += [(below[k], below[(k + 1) % 4], above[(k + 1) % 4], above[k]) for k in range(4)]
    quads.append((12, 11, 10, 9))
    faces = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    torn = trimesh.Trimesh(extent * 0.05 * np.array(top + bottom), faces, process=False)
    assert not torn.is_watertight
    mesh, repairs = closed_mesh(torn, "torn", "thing.yaml", "mesh")
    assert repairs == ("split 4 triangles at corners that lay on their edges",)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(4.0 * (0.05 * extent) ** 3)


def test_other_commas_are_told(tmp_path):
    (tmp_path / "a.obj").write_text("v 1,2,3\nv 1,0,0\nv 0,0,0\nf 1 2 3\n")
    with pytest.raises(InputError, match="'v 1,2,3' has commas"):
        read(tmp_path / "a.obj")


def test_faces_of_a_text_ply_may_have_more_than_their_corners(tmp_path):
    box = trimesh.creation.box(extents=[0.02] * 3)
    rows = [f"7 3 {a} {b} {c} " + ("0" if k % 2 else "2 0.5 1") for k, (a, b, c) in enumerate(box.faces)]
    head = (
        f"ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
        f"element face {len(rows)}\nproperty uchar flags\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n"
    )
    corners = [f"{x} {y} {z}" for x, y, z in box.vertices]
    (tmp_path / "a.ply").write_text(head + "\n".join(corners + rows) + "\n")
    assert read(tmp_path / "a.ply").volume == pytest.approx(0.02**3)


def test_corners_without_coordinates_that_no_triangle_has_go(tmp_path):
    text = trimesh.creation.box(extents=[0.02] * 3).export(file_type="obj")
    (tmp_path / "a.obj").write_text(f"{text}\nv nan nan nan\n")
    assert read(tmp_path / "a.obj").volume == pytest.approx(0.02**3)
    (tmp_path / "b.obj").write_text(f"{text}\nv nan nan nan\nf 9 1 2\n")
    with pytest.raises(InputError, match=r"1 corner .* in 1 of its 13 triangles"):
        read(tmp_path / "b.obj")


def test_very_many_triangles_become_fewer(monkeypatch):
    ball = trimesh.creation.icosphere(4, 0.03)
    monkeypatch.setattr(mesh_file, "_MANY_FACES", len(ball.faces) - 1)
    monkeypatch.setattr(mesh_file, "_NEAR", 2e-3)
    lighter, (said,) = closed_mesh(ball.copy(), "it", "s", "f")
    near_m = 2e-3 * ball.scale
    assert said.startswith(
        f"made {len(lighter.faces)} triangles of {len(ball.faces)}, at most {1e3 * near_m:.2g} mm"
    )
    assert len(lighter.faces) < 0.5 * len(ball.faces)
    assert distance_to_mesh(lighter, ball.vertices).max() < 1.01 * near_m
    monkeypatch.setattr(mesh_file, "MAX_FACES", len(ball.faces) - 1)
    with pytest.raises(InputError, match="decimate it first"):
        closed_mesh(ball, "it", "s", "f")


def test_a_torn_surface_of_very_many_triangles_is_rebuilt(monkeypatch):
    """What is said of it: how far it has moved, and across what was missing."""
    ball = trimesh.creation.icosphere(4, 0.03)
    ball.update_faces((np.arange(len(ball.faces)) % 97 != 0) & (ball.triangles_center[:, 2] > -0.024))
    ball.remove_unreferenced_vertices()
    monkeypatch.setattr(rebuild, "_MOST_TRIANGLES", len(ball.faces) // 3)
    made = rebuild.rebuild(ball)
    assert made.mesh.is_watertight
    assert distance_to_mesh(made.mesh, ball.vertices).max() <= 1.01 * made.moved_m < 1.5e-3
    assert 5e-3 < made.missing_m < 0.018
