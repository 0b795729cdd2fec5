"""Distances of points from a mesh, known beforehand."""

import numpy as np
import pytest
import trimesh
from holdfast.geometry.solids import SurfaceDistance


@pytest.mark.parametrize("off_m", [0.0, 1e-12, -1e-12, 1e-6, 2e-3, -2e-3])
def test_nearest_points_of_points_on_off_and_in_a_cube(off_m: float) -> None:
    surface = SurfaceDistance(trimesh.creation.box((0.04, 0.04, 0.04)))
    point = np.array([[0.003, -0.004, 0.02 + off_m]])
    assert surface.nearest(point) == pytest.approx(np.array([[0.003, -0.004, 0.02]]), abs=1e-9)
    assert surface.of(point) == pytest.approx([abs(off_m)], abs=1e-9)
