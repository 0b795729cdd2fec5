"""Places on a surface over which a convex piece of the object lies, so that nothing can touch them."""

import numpy as np

from ...objects import ObjectModel
from .surface import Site

__all__ = ["is_covered"]

# As deep as the bodies of a contact may be in each other (see `RetractionSettings.contact_depth_m`).
_DEPTH_M = 1e-4


def is_covered(obj: ObjectModel, site: Site) -> bool:
    """Whether the middle of a site is deeper inside of a piece than a contact may be."""
    for piece in obj.pieces:
        corners = piece.vertices[piece.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        areas = np.linalg.norm(normals, axis=1)
        sound = areas > 0.0
        heights = np.sum((site.point - corners[sound, 0]) * normals[sound], axis=1) / areas[sound]
        if heights.max() < -_DEPTH_M:
            return True
    return False
