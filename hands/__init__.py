"""Hands: links, joints, couplings, shapes and contact regions, with their kinematics."""

from .finger_joints import finger_joints
from .hand import Actuator, Axis, Coupling, Hand, HandRegion, KinematicTree, Link
from .kinematics import forward_kinematics, jacobian_from_axes, joint_axes, place_links, point_jacobian
from .library import HAND_SUFFIXES, builtin_hands, load_hand
from .mirror import mirrored
from .new_file import new_hand_file
from .pad import FLATTEST_PER_M, SHARPEST_PER_M, Pad
from .placed import placed_region
from .surface import hand_placement

__all__ = [
    "FLATTEST_PER_M",
    "HAND_SUFFIXES",
    "SHARPEST_PER_M",
    "Actuator",
    "Axis",
    "Coupling",
    "Hand",
    "HandRegion",
    "KinematicTree",
    "Link",
    "Pad",
    "builtin_hands",
    "finger_joints",
    "forward_kinematics",
    "hand_placement",
    "jacobian_from_axes",
    "joint_axes",
    "load_hand",
    "mirrored",
    "new_hand_file",
    "place_links",
    "placed_region",
    "point_jacobian",
]
