import numpy as np
import pytest
from holdfast.geometry.transforms import (
    axis_rotation,
    invert,
    perpendicular,
    pose,
    quaternion_from_rotation,
    rotation_angle,
    rotation_exp,
    rotation_from_quaternion,
    skew,
)
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

quick = settings(max_examples=60, deadline=None, derandomize=True)
components = st.floats(-1, 1, allow_subnormal=False)
units = (
    st.tuples(components, components, components)
    .filter(lambda v: np.linalg.norm(v) > 1e-3)
    .map(lambda v: np.array(v) / np.linalg.norm(v))
)
angles = st.one_of(
    st.floats(-np.pi, np.pi, allow_subnormal=False), st.sampled_from([np.pi, -np.pi, np.pi - 1e-9, 1e-9, 0.0])
)


def is_rotation(R):
    return np.allclose(R @ R.T, np.eye(3), atol=1e-12) and np.linalg.det(R) > 0


@quick
@given(units, angles)
def test_rotations_agree_with_scipy(axis, angle):
    expected = Rotation.from_rotvec(angle * axis).as_matrix()
    assert axis_rotation(axis, angle) == pytest.approx(expected, abs=1e-12)
    assert rotation_exp(angle * axis) == pytest.approx(expected, abs=1e-12)


@quick
@given(units, angles)
def test_quaternions_go_round_trip(axis, angle):
    R = axis_rotation(axis, angle)
    q = quaternion_from_rotation(R)
    assert np.linalg.norm(q) == pytest.approx(1.0, abs=1e-14)
    assert q[0] >= 0
    assert rotation_from_quaternion(q) == pytest.approx(R, abs=1e-12)


@quick
@given(st.lists(components, min_size=4, max_size=4).filter(lambda q: np.linalg.norm(q) > 1e-3))
def test_a_quaternion_its_opposite_and_its_multiples_are_one_rotation(q):
    q = np.array(q)
    R = rotation_from_quaternion(q)
    assert is_rotation(R)
    for other in (-q, 5.0 * q):
        assert rotation_from_quaternion(other) == pytest.approx(R, abs=1e-12)
        assert rotation_angle(R.T @ rotation_from_quaternion(other)) < 1e-12


@pytest.mark.parametrize("angle", [0.0, 1e-12, 1e-7, 0.5, np.pi / 2, np.pi - 1e-7, np.pi - 1e-12, np.pi])
def test_angle_is_exact_at_both_ends(angle):
    rng = np.random.default_rng(0)
    for axis in rng.normal(size=(10, 3)):
        axis /= np.linalg.norm(axis)
        assert rotation_angle(axis_rotation(axis, angle)) == pytest.approx(angle, abs=1e-14)


@quick
@given(units)
def test_perpendicular_completes_a_right_handed_frame(v):
    e1, e2 = perpendicular(v)
    assert is_rotation(np.array([e1, e2, v]))


def test_skew_is_the_cross_product():
    a, b = np.random.default_rng(1).normal(size=(2, 3))
    assert skew(a) @ b == pytest.approx(np.cross(a, b))


def test_exponential_of_a_tiny_vector_keeps_its_first_order():
    w = np.array([1e-13, -2e-13, 3e-13])
    assert rotation_exp(w) - np.eye(3) == pytest.approx(skew(w), abs=1e-16)


def test_inverse_of_a_pose():
    rng = np.random.default_rng(2)
    T = pose(rotation_exp(rng.normal(size=3)), rng.normal(size=3))
    assert invert(T) @ T == pytest.approx(np.eye(4), abs=1e-14)
