"""How far an object has moved."""

import numpy as np
import pytest
from holdfast.geometry.transforms import axis_rotation, quaternion_from_rotation
from holdfast.mjcf.hold.motion import slip_and_rotation


def test_rotation_is_right_for_either_sign_of_a_quaternion() -> None:
    start = axis_rotation(np.array([1.0, 0.0, 0.0]), 2.0)
    axis = np.array([0.0, 0.6, 0.8])
    for angle in (0.0, 0.3, 3.1):
        turned = quaternion_from_rotation(axis_rotation(axis, angle) @ start)
        reference = np.array([0.1, 0.2, 0.3, *quaternion_from_rotation(start)])
        poses = np.array([[0.1, 0.2, 0.3, *(sign * turned)] for sign in (1.0, -1.0)])
        slip, rotation = slip_and_rotation(poses, reference, np.zeros((1, 3)))
        assert rotation == pytest.approx([angle, angle], abs=1e-7)
        assert slip == pytest.approx([0.0, 0.0], abs=1e-12)


def test_slip_is_that_of_the_farthest_point() -> None:
    """A quarter turn about z takes a point at x = 1 over a chord of sqrt 2, and one on the axis nowhere."""
    reference = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    turned = np.array([0.0, 0.0, 0.0, np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    lost = np.full(7, np.nan)
    slip, rotation = slip_and_rotation(
        np.array([turned, lost]), reference, np.array([[1.0, 0, 0], [0, 0, 5.0]])
    )
    assert slip[0] == pytest.approx(np.sqrt(2.0))
    assert rotation[0] == pytest.approx(np.pi / 2.0)
    assert np.isnan(slip[1]) and np.isnan(rotation[1])
