"""How far a contact region lies off the shapes of its link: where it does, touching there is not touching."""

import numpy as np

from ..arrays import Array
from ..geometry import Box, Capsule, Hull, Shape, Sphere
from .hand import Hand, HandRegion

__all__ = ["distance_off_surface"]

_SAMPLES = 100


def distance_off_surface(hand: Hand, region: HandRegion) -> float:
    """Largest distance in m of the region's points from its link's surface; inf for a link without shapes.

    Far outside a hull the distance counts as that from the farthest plane, which is a lower bound.
    """
    points, _ = region.region.sample(_SAMPLES, np.random.default_rng(0))
    shapes = hand.links[region.link].shapes
    if not shapes:
        return np.inf
    # Inside the union of convex shapes the deepest shape bounds the depth from below.
    return float(np.abs(np.min([_signed_distance(shape, points) for shape in shapes], axis=0)).max())


def _signed_distance(shape: Shape, p: Array) -> Array:
    """Distances (n,) of points (n, 3) from a shape, negative inside."""
    match shape:
        case Sphere():
            return np.linalg.norm(p - shape.centre, axis=1) - shape.radius
        case Capsule():
            axis = shape.end - shape.start
            along = np.clip((p - shape.start) @ axis / (axis @ axis), 0.0, 1.0)
            return np.linalg.norm(p - shape.start - along[:, None] * axis, axis=1) - shape.radius
        case Box():
            T = shape.T_link_box
            beyond = np.abs((p - T[:3, 3]) @ T[:3, :3]) - shape.half_extents
            outside = np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
            return outside + np.minimum(beyond.max(axis=1), 0.0)
        case Hull():
            corners = shape.vertices[shape.faces]
            normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            lengths = np.linalg.norm(normals, axis=1)
            normals = normals[lengths > 0.0] / lengths[lengths > 0.0, None]
            offsets = np.einsum("ij,ij->i", normals, corners[lengths > 0.0, 0])
            return (p @ normals.T - offsets).max(axis=1)
