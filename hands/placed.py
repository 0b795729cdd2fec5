"""Shapes and regions carried from one frame to another that moves with it."""

from dataclasses import replace

from ..base.numeric.arrays import Array
from ..geometry import (
    BezierPatch,
    Box,
    Cap,
    Capsule,
    Hull,
    Patch,
    PointRegion,
    Region,
    Shape,
    Sphere,
    transform_points,
)

__all__ = ["placed_region", "placed_shape"]


def placed_shape(shape: Shape, T: Array) -> Shape:
    """The shape in the frame that `T` (4, 4) leads to."""
    match shape:
        case Sphere():
            return Sphere(transform_points(T, shape.centre), shape.radius)
        case Capsule():
            return Capsule(transform_points(T, shape.start), transform_points(T, shape.end), shape.radius)
        case Box():
            return Box(T @ shape.T_link_box, shape.half_extents)
        case Hull():
            return Hull(transform_points(T, shape.vertices), shape.faces)


def placed_region(region: Region, T: Array) -> Region:
    """The region in the frame that `T` (4, 4) leads to."""
    R = T[:3, :3]
    match region:
        case Cap():
            return replace(region, centre=transform_points(T, region.centre), axis=R @ region.axis)
        case Patch():
            return replace(region, patch=BezierPatch(transform_points(T, region.patch.control_points)))
        case PointRegion():
            return replace(region, point=transform_points(T, region.point), normal=R @ region.normal)
