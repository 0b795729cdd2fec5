"""What the numbers of grasp files mean: found from hand and object, over all grasps of a layout."""

from .choose import AmbiguousReading, ChosenReading, choose_reading, option
from .fingers import finger_links
from .hand_frames import BASE, TCP
from .interpret import NO_SCALE, Interpreter
from .joint_orders import HAND_ORDER
from .near_object import NearObject
from .opposition import friction_to_oppose
from .pool import Pool, pooled
from .states import States

__all__ = [
    "BASE",
    "HAND_ORDER",
    "NO_SCALE",
    "TCP",
    "AmbiguousReading",
    "ChosenReading",
    "Interpreter",
    "NearObject",
    "Pool",
    "States",
    "choose_reading",
    "finger_links",
    "friction_to_oppose",
    "option",
    "pooled",
]
