"""Curvatures of regions: known surfaces, and normals that are followed along tangents."""

import numpy as np
import pytest
from holdfast.geometry import BezierPatch, Cap, Patch, PointRegion, region_curvature

UP = np.array([0.0, 0.0, 1.0])


def test_a_cap_curves_as_its_ball() -> None:
    cap = Cap(np.zeros(3), 0.02, UP, 1.0)
    t = np.array([0.6, 0.8, 0.0])
    assert t @ region_curvature(cap, np.zeros(2)) @ t == pytest.approx(50.0)


def test_a_point_counts_as_flat() -> None:
    assert not region_curvature(PointRegion(np.zeros(3), UP), np.zeros(2)).any()


def test_a_plane_has_none_and_a_parabola_that_of_its_vertex() -> None:
    flat = BezierPatch(np.array([[[x, y, 0.0] for y in (0, 1)] for x in (0, 1)]))
    assert region_curvature(Patch(flat), np.array([0.3, 0.8])) == pytest.approx(np.zeros((3, 3)))
    # z = -40 x^2 for x from -0.1 to 0.1, outward +z: it bends away from its normal by 80 / m.
    x, z = (-0.1, 0.0, 0.1), (-0.4, 0.4, -0.4)
    arch = BezierPatch(np.array([[[a, y, c] for y in (0.0, 1.0)] for a, c in zip(x, z, strict=True)]))
    K = region_curvature(Patch(arch), np.array([0.5, 0.5]))
    assert pytest.approx(np.diag([80.0, 0.0, 0.0]), abs=1e-9) == K


def test_curvature_is_how_the_normal_turns_along_a_tangent() -> None:
    rng = np.random.default_rng(5)
    grid = np.stack(np.meshgrid(np.linspace(0, 1, 4), np.linspace(0, 1, 3), indexing="ij"), axis=-1)
    for _ in range(5):
        heights = 0.3 * rng.normal(size=(4, 3, 1))
        patch = BezierPatch(np.concatenate([grid, heights], axis=2))
        u, v = rng.uniform(0.1, 0.9, 2)
        K = region_curvature(Patch(patch), np.array([u, v]))
        h = 1e-5
        for du, dv in ((1.0, 0.0), (0.0, 1.0), (0.6, -0.7)):
            ends = [(u + s * h * du, v + s * h * dv) for s in (1, -1)]
            way = patch.evaluate(*ends[0]) - patch.evaluate(*ends[1])
            turn = patch.unit_normal(*ends[0]) - patch.unit_normal(*ends[1])
            assert K @ way == pytest.approx(turn, rel=1e-4, abs=1e-9)
