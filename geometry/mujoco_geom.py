"""Convex shapes as MuJoCo has them, by the names of MJCF: for models that are written or built in memory."""

import numpy as np

from ..base.numeric.arrays import Array
from .shapes import Box, Capsule, Hull, Shape, Sphere
from .transforms import quaternion_from_rotation

__all__ = ["mujoco_geom", "mujoco_pose"]


def mujoco_geom(shape: Shape) -> tuple[str, dict[str, Array]]:
    """Type of the geom that is the shape, and its numbers; a hull's vertices stand in a mesh."""
    match shape:
        case Sphere():
            return "sphere", {"pos": shape.centre, "size": np.array([shape.radius])}
        case Capsule():
            return "capsule", {
                "fromto": np.concatenate([shape.start, shape.end]),
                "size": np.array([shape.radius]),
            }
        case Box():
            return "box", {"size": shape.half_extents, **mujoco_pose(shape.T_link_box)}
        case Hull():
            return "mesh", {}


def mujoco_pose(T: Array) -> dict[str, Array]:
    """`pos` (3,) and `quat` (4,), real part first, of a pose (4, 4); without those of the identity."""
    numbers = {}
    if np.any(T[:3, 3]):
        numbers["pos"] = T[:3, 3]
    if not np.array_equal(T[:3, :3], np.eye(3)):
        numbers["quat"] = quaternion_from_rotation(T[:3, :3])
    return numbers
