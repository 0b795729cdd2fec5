"""Hand, object and stand as MuJoCo models (MJCF), and what a grasp is in them."""

from .burden import Burden
from .checks import check_configuration, checked_settings
from .compiled import compiled_model
from .document import new_model, section
from .grasp import grasp_mjcf, grasp_qpos, keyed_mjcf, trial_mjcf
from .hand import add_hand, hand_mjcf, shape_rgba
from .held_grasp import Grasp
from .object import OBJECT_BODY, STAND_BODY, add_object, add_object_classes
from .payload import payload
from .pressed_pads import PressedPads
from .scene import add_scene
from .squeeze import Squeeze
from .xml import element, numbers, to_text

__all__ = [
    "OBJECT_BODY",
    "STAND_BODY",
    "Burden",
    "Grasp",
    "PressedPads",
    "Squeeze",
    "add_hand",
    "add_object",
    "add_object_classes",
    "add_scene",
    "check_configuration",
    "checked_settings",
    "compiled_model",
    "element",
    "grasp_mjcf",
    "grasp_qpos",
    "hand_mjcf",
    "keyed_mjcf",
    "new_model",
    "numbers",
    "payload",
    "section",
    "shape_rgba",
    "to_text",
    "trial_mjcf",
]
