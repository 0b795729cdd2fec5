"""Whether a contact region is flat, and which way it then faces."""

import numpy as np

from ..base.numeric.arrays import Array
from .bezier import BezierPatch
from .regions import Patch, PointRegion, Region

__all__ = ["flat_normal", "region_normal"]

# Normals that agree to this share are taken as equal: decimals carry no more.
_NORMAL_ROUNDING = 1e-13


def flat_normal(patch: BezierPatch) -> Array | None:
    """The unit normal (3,) that a patch has everywhere, if it is flat."""
    normals = patch.normal.control_points
    mean: Array = normals.reshape(-1, 3).mean(axis=0)
    mean /= np.linalg.norm(mean)
    units = normals / np.linalg.norm(normals, axis=-1, keepdims=True)
    return mean if np.abs(units - mean).max() < _NORMAL_ROUNDING else None


def region_normal(region: Region) -> Array | None:
    """The one unit normal (3,) of a flat patch or of a point with its normal; None of a curved region."""
    match region:
        case PointRegion():
            return region.normal
        case Patch():
            return flat_normal(region.patch)
    return None
