import numpy as np
import pytest
import trimesh
from holdfast.base.numeric.arrays import Array
from holdfast.geometry import Box, Capsule, Hull, Sphere, mass_properties, shape_mesh
from holdfast.geometry.transforms import pose, rotation_exp

R = rotation_exp(np.array([0.4, -1.1, 0.7]))
P = np.array([0.03, -0.02, 0.05])


def capsule_moments(mass, radius, length):
    """Axial and transverse moment of a solid capsule (cylinder and two half balls)."""
    cylinder, balls = np.pi * radius**2 * length, 4 / 3 * np.pi * radius**3
    mc, mb = mass * np.array([cylinder, balls]) / (cylinder + balls)
    axial = 0.5 * mc * radius**2 + 0.4 * mb * radius**2
    across = mc * (length**2 / 12 + radius**2 / 4)
    across += mb * (0.4 * radius**2 + length**2 / 4 + 3 / 8 * length * radius)
    return axial, across


def test_box():
    half = np.array([0.01, 0.02, 0.03])
    properties = mass_properties((Box(pose(R, P), half),), 0.5)
    sides = (2 * half) ** 2
    moments = 0.5 / 12 * (sides.sum() - sides)
    assert properties.mass == 0.5
    assert properties.centre == pytest.approx(P, abs=1e-12)
    assert properties.inertia == pytest.approx(R @ np.diag(moments) @ R.T, rel=1e-9)


def test_sphere():
    properties = mass_properties((Sphere(P, 0.02),), 0.3)
    assert properties.centre == pytest.approx(P, abs=1e-12)
    assert properties.inertia == pytest.approx(np.eye(3) * 0.4 * 0.3 * 0.02**2, rel=0.01, abs=1e-8)


def test_capsule():
    properties = mass_properties((Capsule(P, P + 0.06 * R[:, 2], 0.01),), 0.2)
    axial, across = capsule_moments(0.2, 0.01, 0.06)
    assert properties.centre == pytest.approx(P + 0.03 * R[:, 2], abs=1e-6)
    assert R.T @ properties.inertia @ R == pytest.approx(
        np.diag([across, across, axial]), rel=0.01, abs=1e-3 * axial
    )


@pytest.mark.parametrize(
    ("shape", "volume"),
    [
        (Sphere(P, 0.02), 4 / 3 * np.pi * 0.02**3),
        (Capsule(P, P + 0.06 * R[:, 2], 0.01), np.pi * 0.01**2 * 0.06 + 4 / 3 * np.pi * 0.01**3),
        (Box(pose(R, P), np.array([0.01, 0.02, 0.03])), 8 * 6e-6),
        (Hull.from_points(np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0.1, 0.1, 0.1]])), 1 / 6),
    ],
    ids=["sphere", "capsule", "box", "hull"],
)
def test_meshes_are_closed_outward_and_true_to_one_percent(shape, volume):
    mesh = shape_mesh(shape)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume == pytest.approx(volume, rel=0.01)


def test_vertices_of_round_shapes_lie_on_their_surface():
    capsule = Capsule(P, P + 0.06 * R[:, 2], 0.01)
    along = np.clip((shape_mesh(capsule).vertices - P) @ R[:, 2], 0, 0.06)
    distance = np.linalg.norm(shape_mesh(capsule).vertices - P - along[:, None] * R[:, 2], axis=1)
    assert distance == pytest.approx(np.full(len(distance), 0.01), rel=1e-6)


def test_parallel_axes():
    """Two balls apart: each counts with its share of the mass about the common centre."""
    d, r, m = 0.1, 0.01, 0.4
    pair = mass_properties((Sphere(np.array([-d, 0, 0]), r), Sphere(np.array([d, 0, 0]), r)), m)
    assert pair.centre == pytest.approx([0, 0, 0], abs=1e-12)
    own = mass_properties((Sphere(np.zeros(3), r),), m).inertia
    assert pair.inertia == pytest.approx(own + m * d**2 * np.diag([0, 1, 1]), rel=1e-9, abs=1e-15)


def test_halves_of_a_box_make_the_box():
    whole = mass_properties((Box(pose(R, P), np.array([0.02, 0.01, 0.03])),), 0.7)
    half = np.array([0.01, 0.01, 0.03])
    halves = mass_properties(
        tuple(Box(pose(R, P + s * 0.01 * R[:, 0]), half) for s in (-1, 1)),
        0.7,
    )
    assert halves.centre == pytest.approx(whole.centre, abs=1e-12)
    assert halves.inertia == pytest.approx(whole.inertia, rel=1e-9)


def test_mass_properties_are_frozen():
    properties = mass_properties((Sphere(P, 0.02),), 0.3)
    with pytest.raises(ValueError, match="read-only"):
        properties.inertia[0, 0] = 1.0


def test_a_hull_with_slivers_that_are_wound_both_ways_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(points: Array) -> trimesh.Trimesh:
        raise ModuleNotFoundError

    points = np.random.default_rng(3).normal(size=(40, 3))
    usual = Hull.from_points(points)
    monkeypatch.setattr(trimesh.convex, "convex_hull", refuse)
    hull = Hull.from_points(points)
    assert {tuple(row) for row in hull.vertices} == {tuple(row) for row in usual.vertices}
    normals, offsets = hull.planes
    assert np.all(points @ normals.T <= offsets + 1e-9)
