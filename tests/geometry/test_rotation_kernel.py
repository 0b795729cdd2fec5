"""Rotations in compiled loops against numpy."""

import numpy as np
import pytest
from holdfast.geometry.rotation_kernel import make_rotation, turn_by
from holdfast.geometry.transforms import rotation_exp


@pytest.mark.parametrize("size", [0.0, 1e-9, 1e-5, 0.3, 3.0, 20.0])
def test_turning(size: float) -> None:
    rng = np.random.default_rng(0)
    turned, w = rotation_exp(rng.normal(size=3)), size * rng.normal(size=3)
    expected = rotation_exp(w) @ turned
    turn_by(turned, w)
    assert turned == pytest.approx(expected, abs=1e-14)


def test_the_nearest_rotation_is_the_polar_factor() -> None:
    rng = np.random.default_rng(1)
    for _ in range(100):
        c, d = rng.uniform(-1, 1, (2, 3))
        U, _, Vt = np.linalg.svd(np.column_stack([c, d, np.cross(c, d)]))
        turned = np.column_stack([c, d, np.full(3, np.nan)])
        make_rotation(turned)
        assert turned == pytest.approx(U @ Vt, abs=1e-11)
        assert turned.T @ turned == pytest.approx(np.eye(3), abs=1e-14)


@pytest.mark.parametrize(
    ("c", "d"),
    [((0, 0, 0), (0, 0, 0)), ((1, 0, 0), (2, 0, 0)), ((0, 0, 0), (0, 1, 0)), ((1, 2, 3), (-1, -2, -3))],
)
def test_columns_without_a_plane_still_make_a_rotation(c: tuple[float, ...], d: tuple[float, ...]) -> None:
    turned = np.column_stack([c, d, c]).astype(float)
    make_rotation(turned)
    assert turned.T @ turned == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(turned) == pytest.approx(1.0)


def test_columns_that_are_nearly_parallel_make_a_rotation() -> None:
    rng = np.random.default_rng(2)
    for size in (1e-6, 1e-8, 1e-12):
        c = rng.normal(size=3)
        turned = np.column_stack([c, 0.7 * c + size * rng.normal(size=3), c])
        make_rotation(turned)
        assert turned.T @ turned == pytest.approx(np.eye(3), abs=1e-13)
        assert np.linalg.det(turned) == pytest.approx(1.0)
