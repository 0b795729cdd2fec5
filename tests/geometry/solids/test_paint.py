"""Colours of meshes: kept from corners, materials and textures; what is wrong with them costs a warning."""

import warnings
from pathlib import Path

import numpy as np
import pytest
import trimesh
from holdfast.errors import InputWarning
from holdfast.geometry.solids import Paint, read_paint
from holdfast.objects import load_object, paint_files
from PIL import Image

RED, BLUE = (200, 30, 30), (30, 60, 200)


def textured_box(folder: Path, *, material: str = "Kd 0 0 0\nmap_Kd skins/half.png\n") -> Path:
    """A box of 40 x 60 x 20 mm whose upper half along y is red and whose lower half is blue, as OBJ."""
    picture = np.zeros((64, 64, 3), np.uint8)
    picture[:32], picture[32:] = RED, BLUE
    (folder / "skins").mkdir()
    Image.fromarray(picture).save(folder / "skins" / "half.png")
    box = trimesh.creation.box(extents=(0.04, 0.06, 0.02))
    lines = ["mtllib box.mtl"]
    lines += [f"v {x:g} {y:g} {z:g}" for x, y, z in box.vertices]
    lines += [f"vt {x / 0.04 + 0.5:g} {y / 0.06 + 0.5:g}" for x, y, _ in box.vertices]
    lines += ["usemtl skin", *("f " + " ".join(f"{i + 1}/{i + 1}" for i in face) for face in box.faces)]
    (folder / "box.obj").write_text("\n".join(lines) + "\n")
    (folder / "box.mtl").write_text(f"newmtl skin\n{material}")
    return folder / "box.obj"


def paint_of(path: Path) -> Paint:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        paint = read_paint(path, "object.yaml", "mesh")
    assert paint is not None
    return paint


@pytest.mark.parametrize("kind", ["obj", "glb"])
def test_a_texture_is_where_the_file_has_it(kind: str, tmp_path: Path) -> None:
    # Beside a texture the dull colours that MTL files often state don't count; those of GLB files do.
    path = textured_box(
        tmp_path, material=f"Kd {'0 0 0' if kind == 'obj' else '1 1 1'}\nmap_Kd skins/half.png\n"
    )
    if kind == "glb":
        trimesh.load_scene(path).export(tmp_path / "box.glb")
        path = tmp_path / "box.glb"
    paint = paint_of(path)
    assert np.ptp(paint.vertices, axis=0) == pytest.approx([0.04, 0.06, 0.02])
    y = paint.vertices[:, 1]
    np.testing.assert_array_equal(paint.rgb[y > 0.002], np.tile(RED, (int(np.sum(y > 0.002)), 1)))
    np.testing.assert_array_equal(paint.rgb[y < -0.002], np.tile(BLUE, (int(np.sum(y < -0.002)), 1)))
    # Fine enough for the border, and still the same surface.
    assert 1000 < len(paint.faces) <= 16_000
    area = trimesh.Trimesh(paint.vertices, paint.faces, process=False).area
    assert area == pytest.approx(2 * (0.04 * 0.06 + 0.04 * 0.02 + 0.06 * 0.02))


def test_colours_of_corners_of_faces_and_of_materials_are_kept(tmp_path: Path) -> None:
    box = trimesh.creation.box(extents=(0.04, 0.06, 0.02))
    box.visual.vertex_colors = np.array([[30 * i, 0, 0, 255] for i in range(8)], np.uint8)
    box.export(tmp_path / "corners.ply")
    np.testing.assert_array_equal(paint_of(tmp_path / "corners.ply").rgb[:, 0], np.arange(8) * 30)
    plain = trimesh.creation.box(extents=(0.04, 0.06, 0.02))
    plain.visual.face_colors = [10, 200, 10, 255]
    plain.export(tmp_path / "faces.ply")
    assert np.unique(paint_of(tmp_path / "faces.ply").rgb, axis=0).tolist() == [[10, 200, 10]]
    dyed = paint_of(textured_box(tmp_path, material="Kd 0.1 0.8 0.2\n"))
    assert np.unique(dyed.rgb, axis=0).tolist() == [[26, 204, 51]]
    plain.visual = trimesh.visual.ColorVisuals()
    plain.export(tmp_path / "plain.ply")
    assert read_paint(tmp_path / "plain.ply", "object.yaml", "mesh") is None


@pytest.mark.parametrize(
    ("material", "said"),
    [
        ("map_Kd gone.png\n", "'gone.png': no such file"),
        ("map_Kd ../../secret.png\n", "lies outside"),
        ("map_Kd box.obj\n", None),
        ("map_Kd skins\n", "'skins': is not a regular file"),
    ],
)
def test_what_is_wrong_with_a_texture_costs_a_warning(
    material: str, said: str | None, tmp_path: Path
) -> None:
    path = textured_box(tmp_path, material=material)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        obj = load_object(path)
    assert obj.parts[0].mesh.is_watertight and obj.parts[0].paint is None
    messages = [str(one.message) for one in caught if issubclass(one.category, InputWarning)]
    assert [said in message for message in messages] == [True] if said else messages == []


def test_the_files_of_colours_are_found(tmp_path: Path) -> None:
    path = textured_box(tmp_path)
    assert sorted(paint_files(path)) == ["box.mtl", "skins/half.png"]


def test_an_object_has_the_paint_unless_its_file_says_a_colour(tmp_path: Path) -> None:
    textured_box(tmp_path)
    text = "name: box\nmesh: box.obj\nmass: 0.1\nfriction: 0.6\n"
    (tmp_path / "box.yaml").write_text(text)
    assert load_object(tmp_path / "box.yaml").parts[0].paint is not None
    (tmp_path / "box.yaml").write_text(text + "rgba: [1, 0, 0, 1]\n")
    assert load_object(tmp_path / "box.yaml").parts[0].paint is None


def test_patches_are_the_surface_in_few_colours(tmp_path: Path) -> None:
    paint = paint_of(textured_box(tmp_path))
    patches = paint.patches(4)
    assert 2 <= len(patches) <= 4
    assert sum(len(faces) for _, _, faces in patches) == len(paint.faces)
    for (red, _, blue), vertices, faces in patches:
        middle = vertices[faces].mean(axis=1)[:, 1]
        if red > 0.7:
            assert middle.min() > -1e-3
        if blue > 0.7:
            assert middle.max() < 1e-3
    # A corner of another colour is too little for a mesh of its own.
    rgb = np.tile(np.array(RED, np.uint8), (8, 1))
    box = trimesh.creation.box()
    speck = Paint(np.array(box.vertices), np.array(box.faces), rgb)
    rgb[box.faces[0]] = BLUE
    assert all(len(np.unique(faces)) >= 4 for _, _, faces in speck.patches(24))


@pytest.mark.parametrize("suffix", [".ply", ".obj"])
def test_a_file_without_colours_is_not_read_a_second_time(tmp_path, monkeypatch, suffix):
    """Of 82,000 triangles that would take 0.2 to 0.5 s."""
    plain, coloured = tmp_path / f"plain{suffix}", tmp_path / f"coloured{suffix}"
    box = trimesh.creation.box()
    box.export(plain)
    red = trimesh.creation.box()
    red.visual.vertex_colors = np.tile([200, 10, 10, 255], (8, 1))
    red.export(coloured)
    assert read_paint(coloured, "o.yaml", "mesh") is not None
    assert read_paint(plain, "o.yaml", "mesh") is None
    read = []
    monkeypatch.setattr(trimesh, "load_scene", lambda *a, **k: read.append(a))
    assert read_paint(plain, "o.yaml", "mesh") is None
    assert not read


def test_what_a_mesh_lacks_is_said_once_also_of_its_copy(tmp_path):
    data = "mtllib gone.mtl\nusemtl a\n" + trimesh.creation.box((0.02, 0.03, 0.041)).export(file_type="obj")
    for name in ("first", "copy"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "box.obj").write_text(data)
    with pytest.warns(InputWarning, match=r"without 'gone\.mtl': no such file"):
        read_paint(tmp_path / "first" / "box.obj", "run", "")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        read_paint(tmp_path / "copy" / "box.obj", "box.yaml", "mesh")
