"""The compiled measure against the exact one and against Qhull."""

import numpy as np
import pytest
from holdfast.geometry.hull_corners import any_corners
from holdfast.geometry.transforms import rotation_exp
from holdfast.retraction.distance import measure
from holdfast.retraction.nearest import measure_quickly, nearest_points
from holdfast.retraction.pairs import collision_model
from scipy.optimize import nnls


def closest_distance(a, b):
    """Distance of two hulls of points as a least-squares problem with weights that sum to one."""
    big = 1e5
    rows = np.hstack([a.T, -b.T])
    sums = np.zeros((2, len(a) + len(b)))
    sums[0, : len(a)] = sums[1, len(a) :] = big
    weights, _ = nnls(np.vstack([rows, sums]), np.array([0.0, 0.0, 0.0, big, big]), maxiter=3000)
    return np.linalg.norm(rows @ weights)


def test_hulls_that_are_apart():
    rng = np.random.default_rng(0)
    w_a, w_b = np.zeros(3), np.zeros(3)
    for _ in range(60):
        a, b = (rng.normal(size=(rng.integers(1, 30), 3)) for _ in range(2))
        b = b + rng.normal(scale=6.0, size=3)
        distance = nearest_points(any_corners(a), any_corners(b), w_a, w_b)
        if distance > 0.0:
            assert distance == pytest.approx(closest_distance(a, b), abs=1e-6)
            n = (w_b - w_a) / distance
            # No plane across the normal lets either hull through: the points are the nearest.
            assert (b @ n).min() - (a @ n).max() == pytest.approx(distance, abs=1e-9)
            assert np.linalg.norm(w_b - w_a) == pytest.approx(distance, abs=1e-12)


@pytest.mark.parametrize("gap", [1e-6, 1e-3, 1.0])
def test_parallel_faces_and_edges(gap):
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    R = rotation_exp(np.array([0.3, 0.2, -0.7]))
    w_a, w_b = np.zeros(3), np.zeros(3)
    for offset in (
        [2.0 + gap, 0.3, 0.4],
        [2.0 + gap, 2.0, 0.0],
        [2.0 + gap, 2.0, 2.0],
        [2.0 + gap, 0.0, 0.0],
    ):
        distance = nearest_points(any_corners(corners @ R.T), any_corners((corners + offset) @ R.T), w_a, w_b)
        assert distance == pytest.approx(gap, rel=1e-6, abs=1e-12)


def test_overlap_is_told():
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    w_a, w_b = np.zeros(3), np.zeros(3)
    for offset in ([0.0, 0.0, 0.0], [1.9, 0.0, 0.0], [0.5, 0.4, -0.9], [2.0, 0.0, 0.0]):
        assert nearest_points(any_corners(corners), any_corners(corners + offset), w_a, w_b) == 0.0


def test_same_gaps_as_by_fcl(task, configurations):
    model = collision_model(task)
    for configuration in configurations[:8]:
        placed = model.place(configuration.state)
        ours, theirs = measure_quickly(placed, model.piece_pairs), measure(placed, model.piece_pairs)
        np.testing.assert_allclose(ours.distance_m, theirs.distance_m, atol=1e-7)
        # Points and normals fit the distance, whichever of several nearest ones they are.
        apart = ours.p_b - ours.p_a
        np.testing.assert_allclose(apart, ours.distance_m[:, None] * ours.normals, atol=1e-7)
        np.testing.assert_allclose(np.linalg.norm(ours.normals, axis=1), 1.0, atol=1e-9)
