"""Hands: links, joints, couplings, shapes and contact regions, with their kinematics."""

from .hand import Actuator, Axis, Coupling, Hand, HandRegion, Link
from .kinematics import forward_kinematics, point_jacobian
from .library import builtin_hands, load_hand
from .surface import distance_off_surface

__all__ = [
    "Actuator",
    "Axis",
    "Coupling",
    "Hand",
    "HandRegion",
    "Link",
    "builtin_hands",
    "distance_off_surface",
    "forward_kinematics",
    "load_hand",
    "point_jacobian",
]
