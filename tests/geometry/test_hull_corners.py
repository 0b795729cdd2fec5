"""The furthest corner, found along edges, against a look at all corners."""

import numpy as np
import pytest
from holdfast.base.numeric.arrays import offsets
from holdfast.geometry import Hull, halton_points
from holdfast.geometry.hull_corners import Corners, any_corners, furthest, hull_edges

# Flat sides with many corners, on which many are as far, and a cloud.
ROUND = np.linspace(0.0, 2.0 * np.pi, 97)[:-1]
DISC = np.column_stack([0.05 * np.cos(ROUND), 0.05 * np.sin(ROUND), np.zeros(96)])
SHAPES = {
    "cylinder": np.concatenate([DISC, DISC + np.array([0.0, 0.0, 0.01])]),
    "cloud": np.random.default_rng(3).normal(scale=0.03, size=(400, 3)),
    "box": np.array([(x, y, z) for x in (0.0, 0.1) for y in (0.0, 0.2) for z in (0.0, 0.3)]),
}


@pytest.mark.parametrize("name", SHAPES)
def test_furthest_along_edges(name):
    hull = Hull.from_points(SHAPES[name])
    counts, neighbours = hull_edges(hull)
    assert len(neighbours) == 3 * len(hull.faces)  # each edge is one of two triangles and has two ends
    corners = Corners(hull.vertices, offsets(counts), neighbours)
    directions = np.concatenate([np.eye(3), -np.eye(3), 2.0 * halton_points(300, 3) - 1.0])
    at = 0
    for direction in directions:
        along = hull.vertices @ direction
        at = furthest(corners, tuple(direction), at)
        assert along[at] == pytest.approx(along.max(), abs=1e-14)
        assert along[furthest(any_corners(hull.vertices), tuple(direction), 0)] == along.max()


def test_what_is_not_convex_has_no_edges():
    hull = Hull.from_points(SHAPES["cloud"])
    dented = hull.vertices.copy()
    dented[7] *= 0.5
    assert not hull_edges(Hull(dented, hull.faces))[0].any()
    assert not hull_edges(Hull(hull.vertices, hull.faces[1:]))[0].any()
    inside = np.vstack([hull.vertices, np.zeros(3)])
    assert not hull_edges(Hull(inside, hull.faces))[0].any()
