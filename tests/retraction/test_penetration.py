import numpy as np
import pytest
from holdfast.geometry.transforms import rotation_exp
from holdfast.retraction.penetration import penetrate
from scipy.spatial import ConvexHull

CORNERS = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
ANGLES = 2.0 * np.pi * np.arange(32) / 32
BAR = np.concatenate([np.column_stack([np.cos(ANGLES), np.sin(ANGLES), np.full(32, z)]) for z in (-5, 5)])


def signed_depth(a, b):
    """Least offset of the facets of the whole Minkowski difference, by Qhull, with the sign of a distance."""
    return ConvexHull((a[:, None] - b[None]).reshape(-1, 3)).equations[:, 3].max()


def check(a, b):
    found = penetrate(a, b)
    assert found is not None
    assert found.distance_m == pytest.approx(signed_depth(a, b), abs=1e-12)
    assert np.linalg.norm(found.normal) == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(found.p_b - found.p_a, found.distance_m * found.normal, atol=1e-12)
    # Moving b along the normal by the depth parts the two.
    assert (b @ found.normal).min() - (a @ found.normal).max() == pytest.approx(found.distance_m, abs=1e-12)


def test_depth_of_random_hulls():
    rng = np.random.default_rng(0)
    for _ in range(60):
        a, b = (rng.normal(size=(rng.integers(4, 40), 3)) * rng.uniform(0.002, 0.05, 3) for _ in range(2))
        check(a, b + 0.005 * rng.normal(size=3))


@pytest.mark.parametrize(
    "offset", [(0, 0, 0), (0.01, 0, 0), (0.01, 0.01, 0.01), (0.02, 0, 0.03), (0.001, 0, 0)]
)
@pytest.mark.parametrize("a", [0.02 * CORNERS, 0.01 * BAR, CORNERS * [0.01, 0.02, 0.03]])
def test_depth_of_aligned_shapes(a, offset):
    # Many facets in one plane, and the origin on edges of the polytope that grows.
    for b in (0.02 * CORNERS, 0.01 * BAR):
        check(a, b + offset)


@pytest.mark.parametrize("gap", [0.0, 1e-15, -1e-15, 1e-12, -1e-12, -1e-9, -1e-6])
def test_grazing_faces(gap):
    R = rotation_exp(np.array([0.3, -0.5, 0.9]))
    a = 0.02 * CORNERS @ R.T
    b = (0.01 * CORNERS + [0.03 + gap, 0.004, -0.003]) @ R.T
    found = penetrate(a, b)
    assert found is not None
    assert found.distance_m == pytest.approx(gap, abs=1e-15)
    np.testing.assert_allclose(found.normal, R[:, 0], atol=1e-9)


def test_point_in_a_box():
    found = penetrate(np.array([[0.015, 0.0, 0.0]]), 0.02 * CORNERS)
    assert found is not None
    assert found.distance_m == pytest.approx(-0.005, abs=1e-15)
    np.testing.assert_allclose(found.normal, [-1, 0, 0], atol=1e-12)


def test_flat_difference_is_told():
    segment = np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]])
    assert penetrate(segment, segment[:, [0, 2, 1]]) is None
