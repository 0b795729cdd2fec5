"""Seeded families of objects: every seed is another box, mug, plate, ... with regions, mass and contacts."""

from .library import FAMILIES, FAMILY_PREFIX, check_family, family_grasps, family_object, is_family

__all__ = ["FAMILIES", "FAMILY_PREFIX", "check_family", "family_grasps", "family_object", "is_family"]
