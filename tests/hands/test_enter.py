"""Rays into polyhedra: what they meet lies on the surface, and nothing of the body before it."""

import numpy as np
import pytest
from holdfast.geometry import Hull
from holdfast.hands.finding.enter import enter_planes
from scipy.spatial import ConvexHull


@pytest.fixture(scope="module")
def hull() -> Hull:
    return Hull.from_points(np.random.default_rng(3).normal(size=(60, 3)))


def test_rays_enter_where_the_body_begins(hull):
    rng = np.random.default_rng(4)
    # An oracle of its own: Qhull's facets.
    facets = ConvexHull(hull.vertices).equations
    origins = 5.0 * rng.normal(size=(400, 3))
    towards = rng.normal(size=(400, 3)) - origins
    directions = towards / np.linalg.norm(towards, axis=1, keepdims=True)
    depth, first = np.empty(400), np.empty(400, dtype=np.int64)
    A, b = hull.planes
    enter_planes(A, b, origins, directions, depth, first)
    steps = np.linspace(0.0, 30.0, 1500)
    for o, d, length, k in zip(origins, directions, depth, first, strict=True):
        outside = ((o + steps[:, None] * d) @ facets[:, :3].T + facets[:, 3]).max(axis=1)
        if outside[0] < 0.0:
            assert np.isinf(length)
        elif np.isinf(length):
            assert outside.min() > -0.05  # between two steps a ray may cut off a corner
        else:
            assert ((o + length * d) @ facets[:, :3].T + facets[:, 3]).max() == pytest.approx(0.0, abs=1e-9)
            assert outside[steps < length].min(initial=1.0) > 0.0
            assert A[k] @ (o + length * d) == pytest.approx(b[k]) and A[k] @ d < 0.0
    assert 50 < np.isfinite(depth).sum() < 390


def test_rays_along_a_face_meet_it_nowhere():
    cube = Hull.from_points(np.array(np.meshgrid([0.0, 1.0], [0.0, 1.0], [0.0, 1.0])).reshape(3, -1).T)
    A, b = cube.planes
    assert len(A) == 6  # two triangles of a side are one plane
    origins = np.array([[-1.0, 0.5, 0.5], [-1.0, 1.5, 0.5], [0.5, 0.5, 0.5], [2.0, 0.5, 0.5]])
    directions = np.tile([1.0, 0.0, 0.0], (4, 1))
    depth, first = np.empty(4), np.empty(4, dtype=np.int64)
    enter_planes(A, b, origins, directions, depth, first)
    assert depth.tolist() == [1.0, np.inf, np.inf, np.inf]
    assert A[first[0]] == pytest.approx([-1.0, 0.0, 0.0])
