"""The nearest points of triangles, of whatever size."""

import numpy as np
import pytest
from holdfast.geometry import closest_on_triangles


@pytest.mark.parametrize("size_m", [1.0, 1e-3, 1e-6])
def test_nothing_of_a_triangle_is_nearer(size_m):
    rng = np.random.default_rng(0)
    triangles, points = size_m * rng.normal(size=(200, 3, 3)), size_m * rng.normal(size=(200, 3))
    triangles[::4, 2] = triangles[::4, 1] + 1e-4 * (triangles[::4, 2] - triangles[::4, 1])  # slivers
    nearest = closest_on_triangles(triangles, points)
    length = np.linalg.norm(nearest - points, axis=1)
    weights = rng.dirichlet(np.ones(3), 2000)
    others = np.einsum("wi,nij->nwj", weights, triangles)
    assert np.all(np.linalg.norm(others - points[:, None], axis=2).min(axis=1) >= length - 1e-9 * size_m)
    # And it is one of its points: with the corners it spans no volume and no more area than they do.
    rays = triangles - nearest[:, None]
    areas = [np.linalg.norm(np.cross(rays[:, i], rays[:, i - 1]), axis=1) for i in range(3)]
    whole = np.linalg.norm(
        np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1
    )
    np.testing.assert_allclose(sum(areas), whole, rtol=1e-6, atol=1e-9 * size_m**2)


def test_a_point_of_a_small_triangle_is_its_own_nearest():
    triangle = 1e-4 * np.array([[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 300.0, 0.0]]])
    inside = triangle[0].mean(axis=0)
    np.testing.assert_allclose(closest_on_triangles(triangle, inside[None])[0], inside, atol=1e-12)
    np.testing.assert_allclose(
        closest_on_triangles(triangle, inside[None] + [0, 0, 0.01])[0], inside, atol=1e-12
    )


def test_a_triangle_that_is_a_point_has_one():
    point = np.array([0.1, 0.2, 0.3])
    np.testing.assert_allclose(closest_on_triangles(np.tile(point, (1, 3, 1)), np.zeros((1, 3)))[0], point)
