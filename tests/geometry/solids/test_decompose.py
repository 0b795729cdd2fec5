import os

import numpy as np
import pytest
import trimesh
from holdfast.base.files.file_paths import cache_folder
from holdfast.geometry import Hull
from holdfast.geometry.solids.closeness import measure_closeness
from holdfast.geometry.solids.coacd_process import run_coacd
from holdfast.geometry.solids.decompose import convex_pieces
from holdfast.geometry.solids.hollows import cut_at_hollows

from ...objects.surface import distance_to_mesh


@pytest.fixture(autouse=True)
def empty_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("HOLDFAST_CACHE", str(tmp_path / "cache"))


def outside(piece, points):
    """How far (n,) points (n, 3) lie beyond a convex hull; negative inside."""
    hull = trimesh.Trimesh(piece.vertices, piece.faces, process=False)
    sound = hull.area_faces > 1e-12
    normals, corners = hull.face_normals[sound], hull.triangles[sound, 0]
    return np.max(points @ normals.T - np.sum(normals * corners, axis=1), axis=1)


def same(a, b):
    return len(a) == len(b) and all(
        np.array_equal(x.vertices, y.vertices) and np.array_equal(x.faces, y.faces)
        for x, y in zip(a, b, strict=True)
    )


def cached_file():
    (path,) = (cache_folder() / "pieces").glob("*.npz")
    return path


def test_a_convex_mesh_is_its_own_hull_and_needs_no_cache():
    box = trimesh.creation.box(extents=[0.02, 0.04, 0.06])
    (piece,) = convex_pieces(box).pieces
    assert np.ptp(piece.vertices, axis=0) == pytest.approx([0.02, 0.04, 0.06])
    assert not cache_folder().exists()


def test_an_l_is_cut_into_pieces_that_cover_it_and_leave_the_notch_free(l_mesh):
    pieces = convex_pieces(l_mesh).pieces
    assert len(pieces) >= 2
    rng = np.random.default_rng(0)
    points = np.vstack(
        [
            rng.uniform([0, 0, 0], [0.06, 0.02, 0.02], (500, 3)),
            rng.uniform([0, 0, 0], [0.02, 0.06, 0.02], (500, 3)),
        ]
    )
    assert np.min([outside(piece, points) for piece in pieces], axis=0).max() < 5e-4
    notch = np.array([[0.04, 0.04, 0.01], [0.025, 0.025, 0.01]])
    assert np.min([outside(piece, notch) for piece in pieces]) > 3e-3


def test_the_hole_of_a_ring_stays_open(ring):
    pieces = convex_pieces(ring).pieces
    assert len(pieces) >= 4
    assert np.min([outside(piece, np.zeros((1, 3))) for piece in pieces]) > 0.012
    on_ring = 0.025 * np.array([[np.cos(a), np.sin(a), 0] for a in np.linspace(0, 6, 50)])
    assert np.min([outside(piece, on_ring) for piece in pieces], axis=0).max() < 1e-3


def test_two_separate_boxes_are_not_taken_for_one_convex_body():
    box = trimesh.creation.box(extents=[0.02] * 3)
    other = box.copy()
    other.apply_translation([0.1, 0, 0])
    pieces = convex_pieces(trimesh.util.concatenate([box, other])).pieces
    assert len(pieces) == 2
    assert np.min([outside(piece, np.array([[0.05, 0, 0]])) for piece in pieces]) > 0.03


def test_a_cache_hit_gives_identical_pieces(l_mesh, monkeypatch):
    first = convex_pieces(l_mesh).pieces
    monkeypatch.setattr("holdfast.geometry.solids.decompose._decompose", None)  # a call would fail
    assert same(first, convex_pieces(l_mesh).pieces)


def test_the_same_seed_gives_the_same_pieces_without_cache(l_mesh):
    first = convex_pieces(l_mesh).pieces
    cached_file().unlink()
    assert same(first, convex_pieces(l_mesh).pieces)


def test_another_threshold_is_another_entry(l_mesh):
    convex_pieces(l_mesh)
    convex_pieces(l_mesh, threshold=0.2)
    assert len(list((cache_folder() / "pieces").glob("*.npz"))) == 2


@pytest.mark.parametrize(
    "damage",
    [
        *("cut", "no count", "NaN"),
        *(
            pytest.param(d, marks=pytest.mark.slow)
            for d in ("empty", "garbage", "flipped", "bad index", "text")
        ),
    ],
)
def test_a_damaged_cache_file_is_computed_again(l_mesh, damage):
    first = convex_pieces(l_mesh).pieces
    path = cached_file()
    data = path.read_bytes()
    arrays = dict(np.load(path))
    match damage:
        case "empty":
            path.write_bytes(b"")
        case "cut":
            path.write_bytes(data[: len(data) // 2])
        case "garbage":
            path.write_bytes(b"\x00" * 500)
        case "flipped":
            path.write_bytes(data[:60] + bytes(255 - b for b in data[60:90]) + data[90:])
        case "no count":
            del arrays["count"]
            np.savez(path, **arrays)
        case "NaN":
            arrays["v0"][0, 0] = np.nan
            np.savez(path, **arrays)
        case "bad index":
            arrays["f0"][0, 0] = 10**6
            np.savez(path, **arrays)
        case "text":
            arrays["v0"] = np.array(["a"])
            np.savez(path, **arrays)
    assert same(first, convex_pieces(l_mesh).pieces)
    assert same(first, convex_pieces(l_mesh).pieces)  # and the file is whole again
    assert len(list(path.parent.iterdir())) == 1


def test_a_cache_that_cannot_be_written_does_not_matter(l_mesh, tmp_path, monkeypatch):
    (tmp_path / "file").write_text("not a folder")
    monkeypatch.setenv("HOLDFAST_CACHE", str(tmp_path / "file"))
    assert len(convex_pieces(l_mesh).pieces) >= 2


def test_cache_folder(monkeypatch, tmp_path):
    assert cache_folder() == tmp_path / "cache"
    monkeypatch.setenv("HOLDFAST_CACHE", "")
    assert cache_folder().name == "holdfast"
    assert os.path.isabs(cache_folder())


def torus():
    return trimesh.creation.torus(0.03, 0.01, major_sections=24, minor_sections=16)


@pytest.mark.parametrize(
    ("preprocess", "is_quick"),
    [("off", False), ("off", True), ("on", True), pytest.param("on", False, marks=pytest.mark.slow)],
)
def test_pieces_lie_on_the_surface_whether_preprocessed_or_not(l_mesh, monkeypatch, preprocess, is_quick):
    """An L can be cut without error; preprocessing alone would leave its pieces 0.3 mm outside."""
    monkeypatch.setattr("holdfast.geometry.solids.decompose._TRIES", ((preprocess, is_quick),))
    made = convex_pieces(l_mesh)
    assert made.note == ""
    for piece in made.pieces:
        low, high = piece.vertices.min(axis=0), piece.vertices.max(axis=0)
        assert np.all(low > l_mesh.bounds[0] - 1e-7) and np.all(high < l_mesh.bounds[1] + 1e-7)
        in_notch = piece.vertices[:, :2].min(axis=1) - 0.02
        assert in_notch.max() < 1e-7
    assert made.closeness.missing_m < 1e-4


@pytest.mark.parametrize(
    "make",
    [
        pytest.param(torus, marks=pytest.mark.slow),
        lambda: trimesh.creation.annulus(0.02, 0.03, 0.01, sections=24),
    ],
)
def test_nothing_sticks_out_by_more_than_stated(make):
    mesh = make()
    made = convex_pieces(mesh)
    rng = np.random.default_rng(3)
    stated = made.closeness
    inside = mesh.triangles_center
    above = np.min([outside(piece, inside) for piece in made.pieces], axis=0)
    assert above.max() <= stated.missing_m + 1e-5
    for piece in made.pieces:
        hull = trimesh.Trimesh(piece.vertices, piece.faces, process=False)
        points = trimesh.sample.sample_surface(hull, 100, seed=int(rng.integers(100)))[0]
        away = distance_to_mesh(mesh, points[~winds_around(mesh, points)])
        assert away.size == 0 or away.max() <= stated.outside_m + 2e-4


def winds_around(mesh, points):
    """Whether a closed surface surrounds the points, by the sum of solid angles."""
    a, b, c = np.moveaxis(mesh.triangles[None] - points[:, None, None], 2, 0)
    la, lb, lc = (np.linalg.norm(x, axis=-1) for x in (a, b, c))
    top = np.einsum("pti,pti->pt", a, np.cross(b, c))
    dot = [np.sum(x * y, axis=-1) for x, y in ((a, b), (b, c), (c, a))]
    angles = 2 * np.arctan2(top, la * lb * lc + dot[0] * lc + dot[1] * la + dot[2] * lb)
    return angles.sum(axis=1) > 2 * np.pi


def test_where_coacd_finds_nothing_a_body_is_halved_and_that_is_said(l_mesh, monkeypatch):
    monkeypatch.setattr("holdfast.geometry.solids.decompose.run_coacd", lambda *args, **kwargs: None)
    box = trimesh.creation.box(extents=[0.02] * 3)
    box.apply_translation([0.1, 0.1, 0])
    made = convex_pieces(trimesh.util.concatenate([l_mesh, box]))
    assert len(made.pieces) == 3  # the arms of the L, along a face of its notch, and the box
    assert "1 of its 2 bodies could not be cut" in made.note
    assert made.closeness.outside_m < 1e-6 and made.closeness.missing_m < 1e-6


def test_what_time_cut_short_is_kept_until_more_is_given(l_mesh, monkeypatch):
    short = convex_pieces(l_mesh, within_s=0.0)
    assert "could not be cut into convex pieces by CoACD in the 0 s" in short.note
    # The hull stands for the body, which misses nothing of it.
    assert short.within_s == 0.0 and short.closeness.missing_m < 1e-6
    kept = convex_pieces(l_mesh)  # a task file that names it, say
    assert kept.note == short.note and same(kept.pieces, short.pieces)
    longer = convex_pieces(l_mesh, within_s=60.0)
    assert longer.note == "" and longer.within_s is None
    monkeypatch.setattr("holdfast.geometry.solids.decompose._decompose", None)
    assert same(convex_pieces(l_mesh, within_s=0.0).pieces, longer.pieces)


def test_thorough_tries_leave_time_to_quick_ones(l_mesh, monkeypatch):
    limits = []

    def stand_in(mesh, **asked):
        limits.append((asked["is_quick"], asked["longest_s"]))
        return [l_mesh.vertices] if asked["is_quick"] else None

    monkeypatch.setattr("holdfast.geometry.solids.decompose.run_coacd", stand_in)
    convex_pieces(l_mesh, within_s=8.0)
    assert [is_quick for is_quick, _ in limits] == [False, True]
    assert limits[0][1] <= 4.0 < limits[1][1] <= 8.0


@pytest.mark.parametrize(("sections", "expected"), [(16, [False]), (48, [True])])
def test_bodies_of_many_triangles_are_cut_quickly_from_the_start(monkeypatch, sections, expected):
    ring = trimesh.creation.torus(0.03, 0.01, major_sections=sections, minor_sections=20)
    efforts = []

    def stand_in(mesh, **asked):
        efforts.append(asked["is_quick"])
        return [mesh.vertices]

    monkeypatch.setattr("holdfast.geometry.solids.decompose.run_coacd", stand_in)
    monkeypatch.setattr("holdfast.geometry.solids.decompose.cut_at_hollows", lambda pieces, *_, **__: pieces)
    assert convex_pieces(ring).note == ""
    assert efforts == expected


def test_a_hull_that_lies_near_is_not_called_halved(l_mesh, monkeypatch):
    monkeypatch.setattr("holdfast.geometry.solids.decompose.run_coacd", lambda *args, **kwargs: None)
    ball = trimesh.creation.icosphere(subdivisions=3, radius=0.02)
    ball.vertices[0] *= 0.99  # a dent of 0.2 mm
    made = convex_pieces(ball)
    assert len(made.pieces) == 1
    assert made.note.endswith("the convex hull stands for it")


def test_a_process_that_takes_too_long_or_crashes_is_none(l_mesh, monkeypatch):
    question = {"preprocess": "off", "threshold": 0.05, "seed": 0}
    assert run_coacd(l_mesh, **question, limit_s=1e-3) is None
    monkeypatch.setattr("sys.executable", "/bin/false")
    assert run_coacd(l_mesh, **question, limit_s=10.0) is None


def test_a_note_and_distances_are_kept_with_the_pieces(l_mesh, monkeypatch):
    monkeypatch.setattr("holdfast.geometry.solids.decompose.run_coacd", lambda *args, **kwargs: None)
    first = convex_pieces(l_mesh)
    monkeypatch.setattr("holdfast.geometry.solids.decompose._decompose", None)
    again = convex_pieces(l_mesh)
    assert (first.note, first.closeness) == (again.note, again.closeness) and first.note


def test_pieces_that_bridge_a_hollow_are_cut_there(l_mesh, monkeypatch):
    """A coarse piece fills the notch of an L."""
    corners = np.array(l_mesh.vertices)
    monkeypatch.setattr("holdfast.geometry.solids.decompose.run_coacd", lambda *args, **kwargs: [corners])
    made = convex_pieces(l_mesh)
    assert len(made.pieces) == 2 and made.note == ""
    assert made.closeness.outside_m < 1e-6 and made.closeness.missing_m < 1e-6


@pytest.mark.parametrize("wall", [0.003, 0.01])
def test_the_wall_of_a_tube_is_cut_until_its_pieces_follow_the_hollow(wall):
    """Its hull bridges the bore by the radius; the chord of a sector of 1/32 by a hundredth of it."""
    tube = trimesh.creation.annulus(0.03, 0.03 + wall, 0.04, sections=64)
    pieces = cut_at_hollows([Hull.from_points(tube.vertices)], tube)
    assert len(pieces) <= 64
    closeness = measure_closeness(tube, pieces)
    assert closeness.outside_m < 4e-4 and closeness.missing_m < 1e-5


def test_many_pieces_are_cut_further_where_they_stand_far_out(monkeypatch):
    """Above the number that is few only what is farther out than 0.5 mm, up to the number that is most."""
    tube = trimesh.creation.annulus(0.03, 0.033, 0.04, sections=64)
    hull = [Hull.from_points(tube.vertices)]
    monkeypatch.setattr("holdfast.geometry.solids.hollows._FEW_PIECES", 4)
    pieces = cut_at_hollows(hull, tube)
    assert 16 <= len(pieces) < 40
    assert 1.5e-4 < measure_closeness(tube, pieces).outside_m < 6e-4
    monkeypatch.setattr("holdfast.geometry.solids.hollows._MOST_PIECES", 8)
    assert len(cut_at_hollows(hull, tube)) == 8


def test_what_lies_near_the_surface_or_bounds_no_solid_is_cut_no_further():
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.02)
    (piece,) = cut_at_hollows([Hull.from_points(ball.vertices)], ball)
    assert len(piece.vertices) == len(ball.vertices)
    is_open = trimesh.Trimesh(ball.vertices, ball.faces[:-1], process=False)
    given = [Hull.from_points(ball.vertices)]
    assert cut_at_hollows(given, is_open) == given


def test_a_surface_of_many_triangles_is_made_simpler_for_the_cut_alone(l_mesh, monkeypatch):
    fine = l_mesh.subdivide().subdivide().subdivide().subdivide().subdivide()
    seen = []

    def cut(mesh, **_):
        seen.append(len(mesh.faces))
        return [np.array(l_mesh.vertices)]

    monkeypatch.setattr("holdfast.geometry.solids.decompose.run_coacd", cut)
    convex_pieces(fine)
    assert max(seen) < 4000 < len(fine.faces)
