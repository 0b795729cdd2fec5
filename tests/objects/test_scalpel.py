"""The built-in scalpel against the published facts, and by independent integration."""

import numpy as np
import pytest
import trimesh
from holdfast.geometry import Patch
from holdfast.objects import builtin_objects, load_object, load_task

SCALPEL = load_object("scalpel")
HANDLE, BLADE = SCALPEL.parts
PUBLISHED = ("index_grip", "thumb_grip", "middle_grip", "palm_rest")


def test_built_in_names_load_once():
    assert "scalpel" in builtin_objects()
    assert load_object("scalpel") is SCALPEL
    for name in builtin_objects():
        assert load_object(name).name == name


def test_dimensions_are_as_published():
    low, high = 1e3 * SCALPEL.mesh.bounds
    assert [low[1], high[1]] == pytest.approx([-122, 200])
    low, high = 1e3 * HANDLE.mesh.bounds
    assert [low[1], high[1]] == pytest.approx([-27, 200])
    radii = 1e3 * np.linalg.norm(HANDLE.mesh.vertices[:, [0, 2]], axis=1)
    assert 8.75 < radii.min() < radii.max() < 9.35
    low, high = 1e3 * BLADE.mesh.bounds
    assert [low[0], high[0]] == pytest.approx([-6.4, 9.6])
    assert high[2] - low[2] == pytest.approx(1.4)
    assert low[1] == pytest.approx(-122)
    assert high[1] == pytest.approx(-27, abs=1)


def distance_to_mesh(mesh, points):
    """Distance to the nearest triangle, by trimesh's own closest point on each."""
    triangles = mesh.triangles[mesh.area_faces > 0]
    out = []
    for p in points:
        nearest = trimesh.triangles.closest_point(triangles, np.tile(p, (len(triangles), 1)))
        out.append(np.linalg.norm(nearest - p, axis=1).min())
    return np.array(out)


@pytest.mark.parametrize("name", SCALPEL.regions)
def test_patches_lie_on_the_surface_and_look_outwards(name):
    region = SCALPEL.regions[name]
    points, normals = region.sample(40, np.random.default_rng(0))
    # The bar has flats, which carry the published patches; the others are on the circle around it.
    assert distance_to_mesh(SCALPEL.mesh, points).max() < (1e-6 if name in PUBLISHED else 6e-5)
    axis = points * [0, 1, 0]
    assert np.sum((points - axis) * normals, axis=1).min() > 0.008


def test_patches_are_the_published_ones(published_tasks):
    published = [
        np.array(contact["object_patch_mm"]["control_points"])
        for task in published_tasks
        if task["object"] == "scalpel"
        for contact in task["contacts"]
    ]
    for name in PUBLISHED:
        region = SCALPEL.regions[name]
        assert isinstance(region, Patch)
        net = 1e3 * region.patch.control_points
        assert any(net.shape == p.shape and np.allclose(net, p, atol=1e-9) for p in published)
    upholding = load_task("upholding")
    for contact, expected in zip(upholding.contacts, published[:2], strict=True):
        assert 1e3 * contact.object.region.patch.control_points == pytest.approx(expected, abs=1e-9)


def test_the_handle_is_round_in_free_form():
    """Points of the four surfaces lie on the circle to 3 um; together they go all the way round."""
    u, v = np.random.default_rng(0).uniform(size=(2, 200))
    angles = []
    for patch in SCALPEL.surfaces.values():
        across = patch.evaluate(u, v)[:, [0, 2]] - [0.000261, 0.000001]
        assert np.linalg.norm(across, axis=1) == pytest.approx(0.009055, abs=3e-6)
        angles.extend(np.arctan2(across[:, 1], across[:, 0]))
        normals = patch.unit_normal(u, v)[:, [0, 2]]
        assert np.sum(normals * across, axis=1) == pytest.approx(0.009055, abs=5e-5)
    assert np.diff(np.sort(angles)).max() < 0.1


def test_a_real_scalpel():
    obj = load_object("scalpel_real")
    assert np.ptp(obj.mesh.bounds[:, 1]) == pytest.approx(0.140)
    assert [part.name for part in obj.parts] == ["handle", "blade"]
    assert 0.015 < obj.inertia.mass < 0.035
    for part in obj.parts:
        assert part.mesh.is_watertight and part.mesh.volume > 0 and abs(part.inflation) < 1e-6
    for region in obj.regions.values():
        points, normals = region.sample(60, np.random.default_rng(0))
        assert distance_to_mesh(obj.mesh, points).max() < 2e-5
        assert np.all(np.sign(normals[:, 2]) == np.sign(points[:, 2]))


@pytest.mark.parametrize("part", SCALPEL.parts, ids=lambda part: part.name)
def test_parts_are_closed_and_covered_by_their_pieces(part):
    assert part.mesh.is_watertight
    assert part.mesh.is_winding_consistent
    assert part.mesh.volume > 0
    assert abs(part.inflation) < 1e-6
    inside = [np.max(plane_distances(piece, part.mesh.vertices), axis=1) < 1e-7 for piece in part.pieces]
    assert np.any(inside, axis=0).all()


def plane_distances(piece, points):
    mesh = trimesh.Trimesh(piece.vertices, piece.faces, process=False)
    sound = mesh.area_faces > 1e-14
    normals, corners = mesh.face_normals[sound], mesh.triangles[sound, 0]
    return points @ normals.T - np.sum(normals * corners, axis=1)


def test_mass_and_inertia_by_monte_carlo():
    """Counts random points inside each part: an integration that shares nothing with the code."""
    rng = np.random.default_rng(0)
    masses, firsts, seconds = [], [], []
    for part, density in ((HANDLE, 1050.0), (BLADE, 7800.0)):
        low, high = part.mesh.bounds
        points = rng.uniform(low, high, size=(100_000, 3))
        inside = points[np.max(plane_distances(part.pieces[0], points), axis=1) <= 0]
        mass = density * np.prod(high - low) * len(inside) / len(points)
        masses.append(mass)
        firsts.append(mass * inside.mean(axis=0))
        seconds.append(mass * np.einsum("ni,nj->ij", inside, inside) / len(inside))
    mass = sum(masses)
    centre = sum(firsts) / mass
    C = sum(seconds) - mass * np.outer(centre, centre)
    assert SCALPEL.inertia.mass == pytest.approx(mass, rel=0.01)
    assert SCALPEL.inertia.centre == pytest.approx(centre, abs=1e-3)
    expected = np.trace(C) * np.eye(3) - C
    assert SCALPEL.inertia.inertia == pytest.approx(expected, rel=0.02, abs=0.02 * expected[1, 1])


def test_numbers_have_sources():
    assert {"shape", "mass", "friction"} <= set(SCALPEL.sources)
