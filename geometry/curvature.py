"""How contact regions curve: what makes a patch of contact small or wide."""

import numpy as np

from ..base.numeric.arrays import Array
from .bezier import BezierPatch
from .regions import Cap, Patch, Region

__all__ = ["region_curvature"]


def region_curvature(region: Region, uv: Array) -> Array:
    """The curvature (3, 3) in 1/m of a region in the frame of its body.

    For a unit tangent t, t @ K @ t is the curvature of the surface along t, positive where it bends away from
    its outward normal, as that of a ball does. A point says nothing of what is around it and counts as flat.

    Args:
        region: the region.
        uv: parameters (2,) of a patch; of no meaning for others.
    """
    match region:
        case Cap():
            return np.eye(3) / region.radius
        case Patch():
            return _of_patch(region.patch, float(uv[0]), float(uv[1]))
        case _:
            return np.zeros((3, 3))


def _of_patch(patch: BezierPatch, u: float, v: float) -> Array:
    tangents = np.stack([patch.du.evaluate(u, v), patch.dv.evaluate(u, v)])
    n = patch.unit_normal(u, v)
    uu, uv, vv = (_second(patch, i, j, u, v) @ n for i, j in ((0, 0), (0, 1), (1, 1)))
    # The second fundamental form, brought into space by the dual basis of the tangents.
    dual = np.linalg.pinv(tangents)
    K: Array = -dual @ np.array([[uu, uv], [uv, vv]]) @ dual.T
    return K


def _second(patch: BezierPatch, i: int, j: int, u: float, v: float) -> Array:
    """The derivative (3,) of a patch by two of its parameters; zero where its degree is too low."""
    for axis in (i, j):
        if patch.degree[axis] == 0:
            return np.zeros(3)
        patch = (patch.du, patch.dv)[axis]
    return patch.evaluate(u, v)
