"""Lengths below the surface of bodies, against known answers and against signed distances."""

import numpy as np
import pytest
from holdfast.geometry import Box, Capsule, ConvexSurface, Hull, Shape, Sphere, length_below_surface

UP, FORTH = np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
BOX = Box(np.eye(4), np.array([0.01, 0.004, 0.003]))


def length(
    shapes: list[Shape], place: list[float], along: np.ndarray = FORTH, depth_m: float = 5e-4
) -> float:
    return length_below_surface(shapes, np.array(place), UP, along, depth_m)


def test_a_flat_ends_with_its_box_whatever_the_depth_and_the_gap() -> None:
    for depth_m, off_m in ((1e-4, 0.0), (1e-3, 0.0), (5e-4, 2e-5)):
        assert length([BOX], [0.002, 0.0, 0.003 + off_m], FORTH, depth_m) == pytest.approx(0.008)
        assert length([BOX], [0.002, 0.0, 0.003 + off_m], -FORTH, depth_m) == pytest.approx(0.012)


def test_round_shapes_end_where_they_fall_below() -> None:
    ball, rod = Sphere(np.zeros(3), 0.01), Capsule(-0.02 * FORTH, 0.02 * FORTH, 0.01)
    chord_m = np.sqrt(0.01**2 - 0.0095**2)
    assert length([ball], [0.0, 0.0, 0.01]) == pytest.approx(chord_m, rel=0.1)
    assert length([rod], [0.015, 0.0, 0.01]) == pytest.approx(0.005 + chord_m, rel=0.05)


def test_shapes_that_go_on_count_and_what_is_elsewhere_does_not() -> None:
    T = np.eye(4)
    T[0, 3] = 0.005
    assert length([BOX, Box(T, BOX.half_extents)], [0.002, 0.0, 0.003]) == pytest.approx(0.013)
    below = Box(np.eye(4), np.array([0.05, 0.05, 0.001]))
    assert length([BOX, below], [0.002, 0.0, 0.003]) == pytest.approx(0.008)
    assert length([BOX], [0.03, 0.0, 0.003]) == np.inf
    assert length([], [0.0, 0.0, 0.0]) == np.inf


def test_a_hull_ends_where_distances_change_sign() -> None:
    rng = np.random.default_rng(5)
    hull = Hull.from_points(rng.normal(size=(30, 3)) * 0.01)
    surface, (normals, _) = ConvexSurface([hull]), hull.planes
    for face, corners in enumerate(hull.vertices[hull.faces]):
        outwards = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        outwards /= np.linalg.norm(outwards)
        assert np.abs(normals - outwards).max(axis=1).min() < 1e-6, face
        along = (corners[1] - corners[0]) / np.linalg.norm(corners[1] - corners[0])
        place = corners.mean(axis=0)
        found_m = length_below_surface([hull], place, outwards, along, 1e-4)
        ends = place - 1e-4 * outwards + np.outer([found_m - 1e-6, found_m + 1e-6], along)
        inside, outside = surface.signed_distances(ends)
        assert inside < 0.0 < outside
