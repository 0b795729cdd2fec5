"""What numbers mean in each reading, against scipy's rotations."""

from pathlib import Path

import numpy as np
import pytest
from holdfast.pipeline.formats import (
    Grasp,
    GraspFile,
    Posture,
    Question,
    WrittenObject,
    WrittenPose,
    hand_in_object,
    object_factor,
    to_matrix,
)
from scipy.spatial.transform import Rotation

POSITION = np.array([0.1, -0.2, 0.3])


def turned(seed: int) -> Rotation:
    return Rotation.random(rng=np.random.default_rng(seed))


def placed(R: Rotation, position=POSITION) -> np.ndarray:
    T = np.eye(4)
    T[:3, :3], T[:3, 3] = R.as_matrix(), position
    return T


@pytest.mark.parametrize("seed", range(5))
def test_every_way_to_write_a_pose_gives_the_same_matrix(seed):
    R = turned(seed)
    xyzw = R.as_quat()
    euler = R.as_euler("xyz")  # lower case: about fixed axes
    mm = {"length": "mm"}
    for pose, reading in [
        (WrittenPose(matrix=placed(R)), {}),
        (WrittenPose(position=POSITION, rotation=R.as_matrix()), {}),
        (WrittenPose(position=POSITION, quaternion=3 * np.roll(xyzw, 1)), {}),
        (WrittenPose(position=POSITION, quaternion=xyzw), {"quaternion": "xyzw"}),
        (WrittenPose(position=POSITION, euler=euler), {}),
        (WrittenPose(position=POSITION, euler=np.rad2deg(euler)), {"angle": "deg"}),
        (WrittenPose(position=1e3 * POSITION, quaternion=np.roll(xyzw, 1)), mm),
        (WrittenPose(matrix=placed(R, 1e3 * POSITION)), mm),
    ]:
        np.testing.assert_allclose(to_matrix(pose, reading), placed(R), atol=1e-14)


def test_poses_in_a_third_frame_and_of_the_object_in_the_hand_come_to_the_same():
    world_object, object_hand = placed(turned(1)), placed(turned(2), POSITION[::-1])
    pose = WrittenPose(matrix=world_object @ object_hand)
    in_world = Grasp("0", Posture(pose), object_pose=WrittenPose(matrix=world_object))
    np.testing.assert_allclose(hand_in_object(in_world, {}), object_hand, atol=1e-14)
    reversed_one = Grasp("0", Posture(WrittenPose(matrix=np.linalg.inv(object_hand))))
    np.testing.assert_allclose(
        hand_in_object(reversed_one, {"direction": "object_in_hand"}), object_hand, atol=1e-14
    )


def test_a_pregrasp_without_a_pose_stands_where_the_grasp_does():
    pose = WrittenPose(matrix=placed(turned(3)))
    grasp = Grasp("0", Posture(pose), pregrasp=Posture())
    np.testing.assert_array_equal(hand_in_object(grasp, {}, grasp.pregrasp), pose.matrix)


def test_scale_multiplies_or_divides():
    grasp = Grasp("0", Posture(), object=WrittenObject(scale=(12.5,)))
    np.testing.assert_allclose(object_factor(grasp, {}), [12.5] * 3)
    np.testing.assert_allclose(object_factor(grasp, {"scale": "divided"}), [0.08] * 3)
    np.testing.assert_allclose(object_factor(Grasp("0", Posture()), {}), [1.0] * 3)


def test_answers_prefer_what_is_given_then_what_is_settled_then_what_is_usual():
    file = GraspFile(
        Path("f"),
        "bare",
        "",
        (),
        (Question.of("length", "m"), Question.of("scale"), Question.of("frame", "base")),
        {"quaternion": "xyzw"},
    )
    assert file.answers(length="mm") == {"length": "mm", "frame": "base", "quaternion": "xyzw"}
    assert file.question("scale").usual is None
    assert Question.of("length", "mm").answers == ("mm", "m")
