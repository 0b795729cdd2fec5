"""Places on a surface over which a convex piece of the object lies, so that nothing can touch them."""

import numpy as np
from numpy.typing import NDArray

from ...base.numeric.arrays import Array
from ...objects import ObjectModel

__all__ = ["are_covered"]

# As deep as the bodies of a contact may be in each other (see `RetractionSettings.contact_depth_m`).
_DEPTH_M = 1e-4


def are_covered(obj: ObjectModel, points: Array) -> NDArray[np.bool_]:
    """Which points (n, 3) are deeper inside of a piece than a contact may be."""
    covered = np.zeros(len(points), dtype=bool)
    for piece in obj.pieces:
        corners = piece.vertices[piece.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        areas = np.linalg.norm(normals, axis=1)
        normals = normals[areas > 0.0] / areas[areas > 0.0, None]
        offsets = np.sum(normals * corners[areas > 0.0, 0], axis=1)
        low, high = piece.vertices.min(axis=0), piece.vertices.max(axis=0)
        near = np.flatnonzero(~covered & np.all((points >= low) & (points <= high), axis=1))
        covered[near] = (points[near] @ normals.T - offsets).max(axis=1, initial=-np.inf) < -_DEPTH_M
    return covered
