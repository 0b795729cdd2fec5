import numpy as np
import pytest
import trimesh
from holdfast.errors import InputError
from holdfast.objects.mesh_file import read_mesh

L_VOLUME = (0.06 * 0.02 + 0.02 * 0.04) * 0.02
FORMATS = ["obj", "stl", "ply", "glb", "off"]


def read(path):
    return read_mesh(path, "thing.yaml", "mesh")


@pytest.mark.parametrize("extension", FORMATS)
def test_formats(tmp_path, l_mesh, extension):
    path = tmp_path / f"l.{extension}"
    l_mesh.export(path)
    mesh = read(path)
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(L_VOLUME, rel=1e-5)
    assert mesh.bounds == pytest.approx(l_mesh.bounds, abs=1e-7)


def test_extension_in_capitals(tmp_path, l_mesh):
    l_mesh.export(tmp_path / "l.stl")
    (tmp_path / "l.stl").rename(tmp_path / "L.STL")
    assert read(tmp_path / "L.STL").volume == pytest.approx(L_VOLUME, rel=1e-5)


@pytest.mark.parametrize("extension", FORMATS)
def test_a_mesh_inside_out_is_turned(tmp_path, l_mesh, extension):
    l_mesh.invert()
    l_mesh.export(tmp_path / f"l.{extension}")
    assert read(tmp_path / f"l.{extension}").volume == pytest.approx(L_VOLUME, rel=1e-5)


def test_faces_that_disagree_are_turned(tmp_path, l_mesh):
    l_mesh.faces[::3] = l_mesh.faces[::3, ::-1]
    l_mesh.export(tmp_path / "l.ply")
    mesh = read(tmp_path / "l.ply")
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(L_VOLUME, rel=1e-5)


def shifted(mesh, *offset):
    mesh = mesh.copy()
    mesh.apply_translation(offset)
    return mesh


@pytest.mark.parametrize("extension", ["obj", "glb"])
def test_several_geometries_are_merged_in_place(tmp_path, extension):
    box = trimesh.creation.box(extents=[0.02] * 3)
    scene = trimesh.Scene()
    scene.add_geometry(box)
    scene.add_geometry(box, transform=trimesh.transformations.translation_matrix([0.1, 0, 0]))
    scene.export(tmp_path / f"two.{extension}")
    mesh = read(tmp_path / f"two.{extension}")
    assert mesh.volume == pytest.approx(2 * 0.02**3, rel=1e-5)
    assert mesh.bounds[:, 0] == pytest.approx([-0.01, 0.11], abs=1e-7)


def test_one_of_two_bodies_inside_out(tmp_path):
    box = trimesh.creation.box(extents=[0.02] * 3)
    other = shifted(box, 0.1, 0, 0)
    other.invert()
    trimesh.util.concatenate([box, other]).export(tmp_path / "two.stl")
    assert read(tmp_path / "two.stl").volume == pytest.approx(2 * 0.02**3, rel=1e-5)


@pytest.mark.parametrize("inside_out", [False, True])
def test_a_cavity_stays_one(tmp_path, inside_out):
    hollow = trimesh.creation.box(extents=[0.02] * 3)
    hollow.invert()
    mesh = trimesh.util.concatenate([trimesh.creation.box(extents=[0.04] * 3), hollow])
    if inside_out:
        mesh.invert()
    mesh.export(tmp_path / "hollow.stl")
    assert read(tmp_path / "hollow.stl").volume == pytest.approx(0.04**3 - 0.02**3, rel=1e-5)


def test_texture_seams_do_not_open_the_surface(tmp_path):
    """The same corner with different texture coordinates on each side of a seam."""
    box = trimesh.creation.box(extents=[0.02] * 3)
    lines = [f"v {x} {y} {z}" for x, y, z in box.vertices]
    lines += [f"vt {i / 36} 0" for i in range(36)]
    lines += [
        "f " + " ".join(f"{v + 1}/{3 * i + k + 1}" for k, v in enumerate(f)) for i, f in enumerate(box.faces)
    ]
    (tmp_path / "box.obj").write_text("\n".join(lines))
    assert read(tmp_path / "box.obj").volume == pytest.approx(0.02**3)


@pytest.mark.parametrize("library", ["../secret.mtl", "/etc/hostname", "missing.mtl", "other.mtl"])
def test_materials_are_never_opened(tmp_path, library, monkeypatch):
    folder = tmp_path / "inside"
    folder.mkdir()
    for name in ("../secret.mtl", "other.mtl"):
        (folder / name).write_text("newmtl m\nmap_Kd ../texture.png\n")
    box = trimesh.creation.box(extents=[0.02] * 3)
    text = trimesh.exchange.obj.export_obj(box)
    (folder / "box.obj").write_text(f"mtllib {library}\nusemtl m\n{text}")
    opened = []
    plain_open = trimesh.resolvers.FilePathResolver.get
    monkeypatch.setattr(
        trimesh.resolvers.FilePathResolver,
        "get",
        lambda self, name: opened.append(name) or plain_open(self, name),
    )
    assert read(folder / "box.obj").volume == pytest.approx(0.02**3)
    assert opened == []


def garbled():
    """Files by name with their bytes, and words of the message."""
    box = trimesh.creation.box(extents=[0.02] * 3)
    with_nan = box.copy()
    with_nan.vertices[3, 1] = np.nan
    opened = box.copy()
    opened.update_faces(np.arange(len(opened.faces)) > 0)
    flat = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 1]], process=False)

    def content(mesh, kind):
        data = mesh.export(file_type=kind)
        return data.encode() if isinstance(data, str) else data

    yield "a.step", b"ISO-10303-21;", "must end in one of"
    yield "a", b"", "must end in one of"
    yield "empty.obj", b"", "box|triangles|read"
    yield "text.stl", b"hello world", "read|triangles"
    yield "points.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\n", "triangles|read"
    yield "wire.obj", b"v 0 0 0\nv 1 0 0\nl 1 2\n", "triangles|read"
    yield "index.obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "read|triangles"
    yield "words.obj", b"v a b c\nf 1 2 3\n", "read|triangles"
    yield "json.glb", b'{"asset": {"version": "2.0"}}', "read|triangles"
    yield "latin.ply", "ply\nformat ascii 1.0\ncomment \xe9\xff\n".encode("latin-1"), "read|triangles"
    yield (
        "huge.ply",
        (
            b"ply\nformat binary_little_endian 1.0\nelement vertex 999999999999\nproperty float x\n"
            b"property float y\nproperty float z\nelement face 99999999\n"
            b"property list uchar int vertex_indices\nend_header\n"
        ),
        "read|triangles",
    )
    yield "flat.stl", content(flat, "stl"), "closed|volume"
    for kind in FORMATS:
        yield f"nan.{kind}", content(with_nan, kind), "finite|read"
        yield f"open.{kind}", content(opened, kind), "not closed"
        data = content(box, kind)
        for share in (0.1, 0.5, 0.9):
            yield f"cut{share}.{kind}", data[: int(share * len(data))], "read|triangles|closed|volume|finite"


@pytest.mark.parametrize(
    ("name", "data", "words"), list(garbled()), ids=lambda value: value if isinstance(value, str) else ""
)
def test_garbled_files_are_refused(tmp_path, name, data, words):
    (tmp_path / name).write_bytes(data)
    with pytest.raises(InputError, match=words) as caught:
        read(tmp_path / name)
    assert caught.value.field == "mesh"
    assert name in str(caught.value)
    assert "\n" not in str(caught.value)


def test_random_damage_never_escapes(tmp_path, l_mesh):
    """Bytes changed at random give a mesh or an InputError, nothing else."""
    rng = np.random.default_rng(0)
    for kind in FORMATS:
        l_mesh.export(tmp_path / f"l.{kind}")
        data = np.frombuffer((tmp_path / f"l.{kind}").read_bytes(), dtype=np.uint8)
        for _ in range(25):
            damaged = data.copy()
            where = rng.integers(len(data), size=rng.integers(1, 6))
            damaged[where] = rng.integers(256, size=len(where))
            (tmp_path / f"l.{kind}").write_bytes(damaged.tobytes())
            try:
                mesh = read(tmp_path / f"l.{kind}")
            except InputError as error:
                assert "\n" not in str(error)
            else:
                assert mesh.is_watertight
                assert np.isfinite(mesh.vertices).all()


def test_missing_files_and_folders(tmp_path):
    (tmp_path / "folder.obj").mkdir()
    for name in ("nothing.obj", "folder.obj"):
        with pytest.raises(InputError, match="there is no file"):
            read(tmp_path / name)
