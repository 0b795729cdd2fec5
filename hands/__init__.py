"""Hands: links, joints, couplings, shapes and contact regions, with their kinematics."""

from .hand import Actuator, Axis, Coupling, Hand, HandRegion, Link
from .kinematics import forward_kinematics, point_jacobian
from .library import builtin_hands, load_hand

__all__ = [
    "Actuator",
    "Axis",
    "Coupling",
    "Hand",
    "HandRegion",
    "Link",
    "builtin_hands",
    "forward_kinematics",
    "load_hand",
    "point_jacobian",
]
