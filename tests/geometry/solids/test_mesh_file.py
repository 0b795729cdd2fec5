import numpy as np
import pytest
import trimesh
from holdfast.errors import InputError
from holdfast.geometry.solids.mesh_file import read_mesh
from holdfast.geometry.solids.rebuild import grouped, winding_number
from holdfast.objects import load_object
from holdfast.pipeline.cli.main import main

L_VOLUME = (0.06 * 0.02 + 0.02 * 0.04) * 0.02
FORMATS = ["obj", "stl", "ply", "glb", "off"]


def read(path):
    return read_mesh(path, "thing.yaml", "mesh")[0]


def repairs(path):
    return read_mesh(path, "thing.yaml", "mesh")[1]


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
    flat = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 1]], process=False)

    def content(mesh, kind):
        data = mesh.export(file_type=kind)
        return data.encode() if isinstance(data, str) else data

    yield "a.step", b"ISO-10303-21;", "export it as"
    yield "a", b"", "export it as"
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
        data = content(box, kind)
        # Text cut off in the list of triangles is a mesh with a hole, which is closed and called a guess.
        for share in (0.1, 0.5) if kind in ("obj", "off") else (0.1, 0.5, 0.9):
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
        with pytest.raises(InputError, match=r"no such file|not a regular file"):
            read(tmp_path / name)


BALL = trimesh.creation.icosphere(subdivisions=4, radius=0.05)
FINE_BALL = trimesh.creation.icosphere(subdivisions=5, radius=0.05)


@pytest.mark.parametrize("extension", FORMATS)
def test_a_sound_mesh_is_left_alone(tmp_path, extension):
    BALL.export(tmp_path / f"ball.{extension}")
    assert repairs(tmp_path / f"ball.{extension}") == ()


@pytest.mark.parametrize(("extension", "count"), [("obj", 3), ("stl", 1), ("ply", 1)])
def test_small_holes_are_closed(tmp_path, extension, count):
    """Around a vertex of an icosphere five or six triangles are left out."""
    mesh = FINE_BALL.copy()
    corners = np.argmax(mesh.vertices @ np.eye(3)[:, :count], axis=0)
    mesh.update_faces(~np.isin(mesh.faces, corners).any(axis=1))
    mesh.export(tmp_path / f"ball.{extension}")
    whole = read(tmp_path / f"ball.{extension}")
    assert whole.is_watertight
    assert whole.volume == pytest.approx(FINE_BALL.volume, rel=1e-3)
    assert repairs(tmp_path / f"ball.{extension}")[-1].startswith(f"closed {count} hole")


def test_a_large_hole_is_closed_and_called_a_guess(tmp_path):
    mesh = BALL.copy()
    mesh.update_faces(mesh.triangles_center[:, 2] < 0.03)
    mesh.export(tmp_path / "bowl.stl")
    depth = 0.05 - 0.03
    cap = np.pi * depth**2 * (3 * 0.05 - depth) / 3
    assert read(tmp_path / "bowl.stl").volume == pytest.approx(BALL.volume - cap, rel=0.02)
    assert "a guess" in repairs(tmp_path / "bowl.stl")[-1]


def test_corners_that_nearly_meet_are_joined(tmp_path):
    """Every triangle has its own corners, off by up to 0.2 um."""
    noise = np.random.default_rng(0).uniform(-1e-7, 1e-7, (len(BALL.faces), 3, 3))
    soup = trimesh.Trimesh(**trimesh.triangles.to_kwargs(BALL.triangles + noise), process=False)
    soup.export(tmp_path / "ball.ply")
    mesh = read(tmp_path / "ball.ply")
    assert mesh.is_watertight
    assert len(mesh.vertices) == len(BALL.vertices)
    assert mesh.volume == pytest.approx(BALL.volume, rel=1e-4)
    assert "nearly met" in " ".join(repairs(tmp_path / "ball.ply"))


@pytest.mark.parametrize("other_way", [False, True], ids=["repeated", "two-sided"])
def test_a_surface_that_stands_twice_is_one(tmp_path, other_way):
    copy = BALL.copy()
    if other_way:
        copy.invert()
    trimesh.util.concatenate([BALL, copy]).export(tmp_path / "ball.stl")
    assert read(tmp_path / "ball.stl").volume == pytest.approx(BALL.volume, rel=1e-5)
    assert f"left out {len(BALL.faces)} triangles" in repairs(tmp_path / "ball.stl")[0]


def boxes(*offsets):
    """Boxes of 20 mm side by side."""
    return trimesh.util.concatenate([shifted(trimesh.creation.box(extents=[0.02] * 3), *o) for o in offsets])


def test_bodies_that_overlap_count_once(tmp_path):
    boxes((0, 0, 0), (0.01, 0.003, 0.002)).export(tmp_path / "two.obj")
    once = 2 * 0.02**3 - 0.01 * 0.017 * 0.018
    assert read(tmp_path / "two.obj").volume == pytest.approx(once, rel=1e-6)
    assert repairs(tmp_path / "two.obj")[-1].startswith("united 2 bodies that overlap: 3.06 cm^3")


@pytest.mark.parametrize(
    "offset",
    [(0.02, 0, 0), (0.02, 0.02, 0), (0.02, 0.02, 0.02), (0.02, 0.01, 0)],
    ids=["face", "edge", "corner", "part"],
)
def test_bodies_that_touch_are_a_solid(tmp_path, offset):
    boxes((0, 0, 0), offset).export(tmp_path / "two.stl")
    mesh = read(tmp_path / "two.stl")
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(2 * 0.02**3, rel=1e-5)


def test_one_of_two_boxes_at_an_edge_is_inside_out(tmp_path):
    pair = boxes((0, 0, 0), (0.02, 0.02, 0))
    pair.faces = np.vstack([pair.faces[:12], pair.faces[12:, ::-1]])
    pair.export(tmp_path / "two.stl")
    assert read(tmp_path / "two.stl").volume == pytest.approx(2 * 0.02**3, rel=1e-5)


def test_a_body_in_a_cavity_is_not_the_cavity(tmp_path):
    def box(side):
        return trimesh.creation.box(extents=[side] * 3)

    hollow = box(0.03)
    hollow.invert()
    trimesh.util.concatenate([box(0.04), hollow, shifted(box(0.01), 0, 0, 0.012)]).export(tmp_path / "a.stl")
    # The small box reaches from inside the cavity 2 mm into the wall.
    walls = 0.04**3 - 0.03**3
    in_cavity = 0.01**2 * (0.015 - 0.007)
    assert read(tmp_path / "a.stl").volume == pytest.approx(walls + in_cavity, rel=1e-5)


def test_faces_without_area_do_no_harm(tmp_path):
    """An edge of a box has a corner more on one side: a triangle without area closes the gap."""
    box = trimesh.creation.box(extents=[0.02] * 3)
    a, b, c = box.faces[0]
    middle = len(box.vertices)
    vertices = np.vstack([box.vertices, box.vertices[[a, b]].mean(axis=0)])
    faces = np.vstack([box.faces[1:], [[a, middle, c], [middle, b, c], [a, b, middle]]])
    trimesh.Trimesh(vertices, faces, process=False).export(tmp_path / "box.ply")
    assert read(tmp_path / "box.ply").volume == pytest.approx(0.02**3, rel=1e-6)


def test_a_wall_inside_goes(tmp_path):
    """Two boxes face to face with a single wall between them: three faces at each of its edges."""
    pair = boxes((0, 0, 0), (0.02, 0, 0))
    # The second box's own wall at x = 0.01 goes.
    pair.update_faces(
        (np.arange(24) < 12)
        | (np.ptp(pair.triangles[:, :, 0], axis=1) > 0)
        | (pair.triangles_center[:, 0] > 0.02)
    )
    pair.merge_vertices()
    pair.export(tmp_path / "two.ply")
    assert read(tmp_path / "two.ply").volume == pytest.approx(2 * 0.02**3, rel=1e-5)
    assert repairs(tmp_path / "two.ply") == ("left out 2 triangles of walls inside",)


def test_an_open_sheet_is_refused_with_its_place(tmp_path):
    """Two triangles that meet in one corner alone bound nothing that could be filled."""
    corners = 0.01 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [-1, 0, 0], [0, -1, 0]])
    trimesh.Trimesh(corners, [[0, 1, 2], [0, 3, 4]], process=False).export(tmp_path / "sheet.ply")
    with pytest.raises(InputError, match=r"not closed: 6 open edges .* one at \("):
        read(tmp_path / "sheet.ply")


def test_huge_coordinates_are_refused(tmp_path):
    (BALL.copy().apply_scale(1e9)).export(tmp_path / "ball.ply")
    with pytest.raises(InputError, match="coordinates beyond 100000 m"):
        read(tmp_path / "ball.ply")


def test_fins_on_a_ball_are_left_out(tmp_path):
    """Three triangles meet at some edges, so that only what they wind around says what is solid."""
    fin = np.array([[0.05, 0, 0], [0, 0.05, 0], [0.1, 0.1, 0]])
    a, b = BALL.triangles[0][:2]
    triangles = np.vstack([BALL.triangles, [[a, b, 2 * a]], fin[None]])
    trimesh.Trimesh(**trimesh.triangles.to_kwargs(triangles), process=False).export(tmp_path / "fin.stl")
    mesh, (said,) = read_mesh(tmp_path / "fin.stl", "thing.yaml", "mesh")
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(BALL.volume, rel=0.05)
    assert np.abs(np.linalg.norm(mesh.vertices, axis=1) - np.linalg.norm(a)).max() < 0.1 * np.linalg.norm(a)
    assert "rebuilt the surface" in said and "open edges" in said


def test_winding_tells_inside_from_outside():
    groups = grouped(np.array(BALL.triangles))
    assert len(groups.radii) > 20
    radius = np.linalg.norm(BALL.vertices[0])
    for point in radius * np.random.default_rng(0).normal(size=(200, 3)):
        distance = np.linalg.norm(point)
        if distance < 0.9 * radius:
            assert winding_number(groups, point) == pytest.approx(1.0, abs=0.02)
        elif distance > 1.01 * radius:
            assert winding_number(groups, point) == pytest.approx(0.0, abs=0.02)


def test_few_triangles_wind_exactly():
    groups = grouped(np.array(trimesh.creation.box((0.02, 0.02, 0.02)).triangles))
    for point, expected in (([0.003, -0.004, 0.009], 1.0), ([0.003, -0.004, 0.011], 0.0)):
        assert winding_number(groups, np.array(point)) == pytest.approx(expected, abs=1e-9)


def test_a_cube_with_torn_faces_keeps_its_size(tmp_path):
    """Each face has corners of its own and lies up to 0.3 mm off: no edge meets any other."""
    cube = trimesh.creation.box((0.04, 0.04, 0.04)).subdivide().subdivide()
    rng = np.random.default_rng(0)
    corners = cube.triangles + rng.uniform(-3e-4, 3e-4, size=(len(cube.faces), 1, 3))
    trimesh.Trimesh(**trimesh.triangles.to_kwargs(corners), process=False).export(tmp_path / "torn.stl")
    mesh, (*_, said) = read_mesh(tmp_path / "torn.stl", "thing.yaml", "mesh")
    assert mesh.is_watertight
    assert mesh.volume == pytest.approx(0.04**3, rel=0.05)
    assert mesh.extents == pytest.approx([0.04] * 3, abs=1.5e-3)
    assert "moved by up to" in said


def test_repairs_are_said_where_the_object_is_shown(tmp_path, capsys):
    mesh = FINE_BALL.copy()
    mesh.update_faces(~(mesh.faces == 0).any(axis=1))
    mesh.export(tmp_path / "ball.obj")
    path = tmp_path / "ball.yaml"
    path.write_text("name: ball\nmesh: ball.obj\nmass: 0.2\nfriction: 0.5\n")
    assert load_object(path).sources["mesh"].startswith("repaired: closed 1 hole")
    assert main(["objects", str(path)]) == 0
    assert "repaired: closed 1 hole" in capsys.readouterr().out


def test_walls_that_stand_twice_and_a_fin_do_not_move_the_surface(tmp_path):
    """Two boxes that share a wall, which each has, and a loose triangle on an edge of one."""
    pair = boxes((0, 0, 0), (0.02, 0, 0))
    pair.merge_vertices()
    a, b = (int(np.argmin(np.linalg.norm(pair.vertices - p, axis=1))) for p in (LOW, HIGH))
    vertices = np.vstack([pair.vertices, [[0.0, 0.0, 0.0]]])
    faces = np.vstack([pair.faces, [[a, b, len(pair.vertices)]]])
    trimesh.Trimesh(vertices, faces, process=False).export(tmp_path / "two.ply")
    solid = read(tmp_path / "two.ply")
    assert solid.volume == pytest.approx(2 * 0.02**3, rel=1e-5)
    assert solid.bounds == pytest.approx(pair.bounds)
    said = repairs(tmp_path / "two.ply")
    assert said and not any("rebuilt" in words for words in said)


LOW, HIGH = (-0.01, -0.01, -0.01), (-0.01, 0.01, -0.01)


def test_a_tube_that_crosses_itself_counts_once(tmp_path):
    tube = figure_eight(radius=0.006)
    tube.export(tmp_path / "eight.ply")
    solid = read(tmp_path / "eight.ply")
    assert any("crosses itself" in words for words in repairs(tmp_path / "eight.ply"))
    points = np.random.default_rng(0).uniform(*(0.3 * tube.bounds), size=(2000, 3))
    before, after = (windings(mesh, points) for mesh in (tube, solid))
    assert before.max() == 2
    assert np.mean(after != np.minimum(before, 1)) < 0.005


def windings(mesh, points):
    groups = grouped(np.array(mesh.triangles))
    return np.array([abs(round(winding_number(groups, point))) for point in points])


def figure_eight(radius, rings=60, sides=12):
    """A closed tube around a figure of eight in a plane."""
    t = 2 * np.pi * np.arange(rings) / rings
    middle = np.column_stack([0.04 * np.sin(t), 0.03 * np.sin(2 * t), np.zeros(rings)])
    along = np.roll(middle, -1, axis=0) - np.roll(middle, 1, axis=0)
    up = np.array([0.0, 0.0, 1.0])
    side = np.cross(along / np.linalg.norm(along, axis=1)[:, None], up)
    a = 2 * np.pi * np.arange(sides) / sides
    circles = np.cos(a)[None, :, None] * side[:, None] + np.sin(a)[None, :, None] * up
    i, j = np.divmod(np.arange(rings * sides), sides)
    beside, after = (j + 1) % sides, (i + 1) % rings * sides
    p, q, u, v = i * sides + j, i * sides + beside, after + j, after + beside
    faces = np.vstack([np.column_stack([p, q, u]), np.column_stack([q, v, u])])
    return trimesh.Trimesh((middle[:, None] + radius * circles).reshape(-1, 3), faces, process=False)


@pytest.mark.parametrize("words", [["run"], ["suggest"], ["objects"]])
def test_formats_that_are_not_read_are_told_from_names(tmp_path, capsys, words):
    path = tmp_path / "cup.fbx"
    path.write_text("<COLLADA/>")
    assert main([*words, str(path)]) == 2
    said = capsys.readouterr().err
    assert "cup.fbx" in said and ".obj, .stl" in said and "known:" not in said
