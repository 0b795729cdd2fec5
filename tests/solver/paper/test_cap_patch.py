"""The normals of a cap as a polynomial patch: the whole cap, from parameters in the unit square."""

import numpy as np
import pytest
from holdfast.geometry import Cap
from holdfast.solver.paper.cap_patch import CapPatch

HALF_ANGLES_DEG = (11.25, 60.0, 90.0, 120.0, 180.0)


@pytest.fixture(params=HALF_ANGLES_DEG)
def cap(request: pytest.FixtureRequest) -> Cap:
    axis = np.array([0.14, -0.3, 0.99])
    return Cap(
        np.array([0.02, 0.0, 0.001]), 0.013, axis / np.linalg.norm(axis), float(np.radians(request.param))
    )


def test_every_normal_of_the_cap_has_parameters(cap: Cap) -> None:
    patch = CapPatch(cap)
    _, normals = cap.sample(200, np.random.default_rng(1))
    for normal in normals:
        u, v = patch.params(normal)
        assert -1e-12 <= u <= 1.0 + 1e-12
        assert -1e-12 <= v <= 1.0 + 1e-12
        m = patch.normal.evaluate(u, v)
        assert m / np.linalg.norm(m) == pytest.approx(normal, abs=1e-11)


def test_the_axis_and_the_rim_have_parameters(cap: Cap) -> None:
    patch = CapPatch(cap)
    assert patch.params(cap.axis) == pytest.approx((0.5, 0.5))
    side = np.cross(cap.axis, [1.0, 0.0, 0.0])
    side /= np.linalg.norm(side)
    rim = np.cos(cap.half_angle_rad) * cap.axis + np.sin(cap.half_angle_rad) * side
    u, v = patch.params(rim)
    assert np.hypot(u - 0.5, v - 0.5) == pytest.approx(0.5, abs=1e-9)


def test_the_length_is_the_polynomial_of_the_docstring_and_never_vanishes(cap: Cap) -> None:
    patch = CapPatch(cap)
    u, v = np.random.default_rng(2).uniform(size=(2, 500))
    r2 = patch.reach**2 * ((2.0 * u - 1.0) ** 2 + (2.0 * v - 1.0) ** 2)
    lengths = np.linalg.norm(patch.normal.evaluate(u, v), axis=-1)
    assert lengths == pytest.approx((1.0 + r2) ** (2 if patch.doubled else 1), rel=1e-12)
    assert lengths.min() >= 1.0


def test_narrow_caps_are_of_degree_two() -> None:
    narrow, wide = (
        CapPatch(Cap(np.zeros(3), 0.01, np.array([0.0, 0.0, 1.0]), half)).normal.degree
        for half in (0.5 * np.pi, 0.6 * np.pi)
    )
    assert (narrow, wide) == ((2, 2), (4, 4))
