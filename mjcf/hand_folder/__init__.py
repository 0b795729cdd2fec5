"""A hand alone as a folder of MJCF files: model, scene, postures and a page about them."""

from .export import export_hand
from .postures import open_posture

__all__ = ["export_hand", "open_posture"]
