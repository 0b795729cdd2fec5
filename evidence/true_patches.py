"""Bezier patches in balls: points, normals and curvature over all parameters near some."""

import numpy as np

from ..base.numeric.arrays import Array
from ..solver.interval import Balls

__all__ = ["patch_curvature", "point_and_normal"]


def point_and_normal(control_points: Array, params: Balls) -> tuple[Balls, Balls]:
    """Point (3,) in m and unit normal (3,) of a patch with control points (m + 1, n + 1, 3).

    Args:
        control_points: in m.
        params: (2,) u and v.
    """
    net = Balls.exact(control_points)
    u, v = params[0], params[1]
    along_u, along_v = (_evaluate(slopes, u, v) for slopes in _slopes(net))
    return _evaluate(net, u, v), along_u.cross(along_v).unit()


def patch_curvature(control_points: Array, params: Balls) -> Balls:
    """The curvature (3, 3) in 1/m of a patch, as `geometry.region_curvature` has it."""
    u, v = params[0], params[1]
    by_u, by_v = _slopes(Balls.exact(control_points))
    along_u, along_v = _evaluate(by_u, u, v), _evaluate(by_v, u, v)
    across = along_u.cross(along_v)
    normal = across.unit()
    uu, uv = ((_evaluate(slopes, u, v) * normal).sum() for slopes in _slopes(by_u))
    vv = (_evaluate(_slopes(by_v)[1], u, v) * normal).sum()
    # The dual basis of the tangents: crosswise with the normal, over the area that they span.
    area = (across * normal).sum()
    dual = Balls.stack([along_v.cross(normal) / area, normal.cross(along_u) / area])
    second = Balls.stack([Balls.stack([uu, uv]), Balls.stack([uv, vv])])
    return -(dual.T @ second @ dual)


def _slopes(net: Balls) -> tuple[Balls, Balls]:
    """Control points of the derivatives along both axes; of what is constant along one, zero."""
    return _along_first(net), _exchanged(_along_first(_exchanged(net)))


def _exchanged(net: Balls) -> Balls:
    return Balls(np.swapaxes(net.mid, 0, 1), np.swapaxes(net.rad, 0, 1))


def _along_first(net: Balls) -> Balls:
    degree = net.shape[0] - 1
    return (net[1:] - net[:-1]) * float(degree) if degree else net * 0.0


def _evaluate(net: Balls, u: Balls, v: Balls) -> Balls:
    """De Casteljau's rule along both axes."""
    for t in (u, v):
        while net.shape[0] > 1:
            net = net[:-1] * (1.0 - t) + net[1:] * t
        net = net[0]
    return net
