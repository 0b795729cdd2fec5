"""A hand alone as a folder of MJCF files: model, scene, postures and a page about them."""

from .export import export_hand

__all__ = ["export_hand"]
