"""Shapes as MuJoCo has them: it finds the volumes, masses and middles that we do."""

import mujoco
import numpy as np
import pytest
from holdfast.geometry import (
    Box,
    Capsule,
    Hull,
    Shape,
    Sphere,
    mass_properties,
    mujoco_geom,
    mujoco_pose,
    pose,
)
from holdfast.geometry.transforms import rotation_exp, rotation_from_quaternion

R = rotation_exp(np.array([0.4, -1.1, 0.7]))
P = np.array([0.03, -0.02, 0.05])
SHAPES = [
    Sphere(P, 0.012),
    Capsule(P, P + np.array([0.01, 0.03, -0.02]), 0.008),
    Box(pose(R, P), np.array([0.01, 0.02, 0.03])),
    Box(np.eye(4), np.array([0.01, 0.02, 0.03])),
]


@pytest.mark.parametrize("shape", SHAPES, ids=["sphere", "capsule", "box", "plain box"])
def test_mujoco_finds_the_same_mass_properties(shape: Shape) -> None:
    kind, numbers = mujoco_geom(shape)
    attributes = " ".join(
        f'{name}="{" ".join(map(repr, values.tolist()))}"' for name, values in numbers.items()
    )
    geom = f'<geom type="{kind}" mass="0.7" {attributes}/>'
    text = f"<mujoco><worldbody><body><freejoint/>{geom}</body></worldbody></mujoco>"
    body = mujoco.MjModel.from_xml_string(text).body(1)
    ours = mass_properties((shape,), 0.7)
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, body.iquat)
    turn = turn.reshape(3, 3)
    assert body.ipos == pytest.approx(ours.centre, abs=1e-12)
    # Ours are those of a mesh inside what is round.
    tolerance = (1e-9 if isinstance(shape, Box) else 0.01) * np.abs(ours.inertia).max()
    assert turn @ np.diag(body.inertia) @ turn.T == pytest.approx(ours.inertia, abs=tolerance)


def test_a_hull_stands_in_a_mesh() -> None:
    corners = np.array(np.meshgrid([0, 1], [0, 1], [0, 1]), dtype=float).reshape(3, -1).T
    assert mujoco_geom(Hull.from_points(corners)) == ("mesh", {})


def test_poses_leave_out_what_is_the_identity() -> None:
    assert mujoco_pose(np.eye(4)) == {}
    assert list(mujoco_pose(pose(np.eye(3), P))) == ["pos"]
    numbers = mujoco_pose(pose(R, P))
    assert rotation_from_quaternion(numbers["quat"]) == pytest.approx(R)
