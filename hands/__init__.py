"""Hands: links, joints, couplings, shapes and contact regions, with their kinematics."""

from .hand import Actuator, Axis, Coupling, Hand, HandRegion, KinematicTree, Link
from .kinematics import forward_kinematics, jacobian_from_axes, joint_axes, place_links, point_jacobian
from .library import builtin_hands, load_hand
from .placed import placed_region
from .surface import distance_off_surface

__all__ = [
    "Actuator",
    "Axis",
    "Coupling",
    "Hand",
    "HandRegion",
    "KinematicTree",
    "Link",
    "builtin_hands",
    "distance_off_surface",
    "forward_kinematics",
    "jacobian_from_axes",
    "joint_axes",
    "load_hand",
    "place_links",
    "placed_region",
    "point_jacobian",
]
