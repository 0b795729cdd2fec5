"""Distances and directions from a mesh, against trimesh over all faces and against closed forms."""

import numpy as np
import pytest
import trimesh
from holdfast.geometry.solids import MeshSurface


def brute_force(mesh, points):
    found = []
    for point in points:
        nearest = trimesh.triangles.closest_point(mesh.triangles, np.tile(point, (len(mesh.faces), 1)))
        found.append(np.linalg.norm(nearest - point, axis=1).min())
    return np.array(found)


@pytest.mark.parametrize("spread", [1e-4, 3e-3, 0.1])
def test_distances_near_and_far_agree_with_all_faces(spread):
    mesh = trimesh.creation.torus(0.05, 0.02, 48, 24)
    points = (
        np.asarray(mesh.triangles_center[::37])
        + np.random.default_rng(2).normal(size=(63, 3))[: len(mesh.triangles_center[::37])] * spread
    )
    distance, _ = MeshSurface(mesh).compare(points, np.zeros_like(points))
    assert distance == pytest.approx(brute_force(mesh, points), abs=1e-12)


def test_directions_on_both_sides_of_a_sphere():
    mesh = trimesh.creation.icosphere(subdivisions=4, radius=0.04)
    directions = np.random.default_rng(2).normal(size=(50, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    surface = MeshSurface(mesh)
    for radius in (0.03, 0.04, 0.05):
        distance, angle = surface.compare(radius * directions, directions)
        assert distance == pytest.approx(abs(radius - 0.04), abs=1e-4)
        assert np.all(angle < 0.1)
        assert np.all(surface.compare(radius * directions, -directions)[1] > np.pi - 0.1)


def test_at_an_edge_the_face_that_agrees_best_counts():
    mesh = trimesh.creation.box((0.02, 0.02, 0.02))
    edge = np.array([[0.01, 0.01, 0.002]] * 3)
    normals = np.array([[1.0, 0, 0], [0, 1.0, 0], [0, 0, 1.0]])
    distance, angle = MeshSurface(mesh).compare(edge, normals)
    assert distance == pytest.approx(0.0, abs=1e-15)
    assert angle == pytest.approx([0.0, 0.0, 0.5 * np.pi], abs=1e-6)
