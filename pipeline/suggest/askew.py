"""By how much two sites fail to face each other, at the points where they come nearest to it."""

import numpy as np

from ...base.numeric.arrays import Array
from ...geometry import Cap, Patch, Region
from .surface import Site

__all__ = ["askew_rad"]

# Grids of so many points a side, one after the other about the best pair of the one before and each a third
# as wide: of a bend of 40 degrees a tenth of a degree is left between the points of the last.
_GRIDS, _POINTS = 5, 7
_MIDDLE = np.array([0.5, 0.5])


def askew_rad(a: Site, b: Site, most_rad: float = np.pi) -> float:
    """The least angle between a normal of one site and the reverse of one of the other, in rad.

    Args:
        a: a site.
        b: the other.
        most_rad: where a first look shows that it is more than this, some angle that is, too, will do.
    """
    p, q, half_width = _MIDDLE, _MIDDLE, 0.5
    m, n = a.normals, b.normals
    caps = sum(site.region.half_angle_rad for site in (a, b) if isinstance(site.region, Cap))
    least = np.pi
    for k in range(_GRIDS):
        near_p, near_q = _around(p, half_width), _around(q, half_width)
        if k:
            m, n = _normals(a.region, near_p), _normals(b.region, near_q)
        i, j = np.unravel_index(int(np.argmin(m @ n.T)), (len(m), len(n)))
        p, q, half_width = near_p[i], near_q[j], half_width / 3.0
        least = min(least, float(np.arctan2(np.linalg.norm(np.cross(m[i], n[j])), -(m[i] @ n[j]))))
        if k == 0 and least - (a.bend_rad + b.bend_rad) / (_POINTS - 1) > most_rad + caps:
            break
    return max(0.0, least - caps)


def _around(middle: Array, half_width: float) -> Array:
    """Parameters (n, 2) in [0, 1] about a pair of them."""
    steps = np.linspace(-half_width, half_width, _POINTS)
    u, v = np.meshgrid(*(np.clip(x + steps, 0.0, 1.0) for x in middle), indexing="ij")
    return np.column_stack([u.ravel(), v.ravel()])


def _normals(region: Region, parameters: Array) -> Array:
    """Unit normals (n, 3) of a patch at parameters; of other regions that in the middle alone."""
    if isinstance(region, Patch):
        return region.patch.unit_normal(*parameters.T)
    return region.middle()[1][None]
