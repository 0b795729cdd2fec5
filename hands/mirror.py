"""The mirror image of a hand: the left hand of a right one."""

from dataclasses import replace

import numpy as np

from ..base.numeric.arrays import Array
from ..geometry import (
    BezierPatch,
    Box,
    Cap,
    Capsule,
    Hull,
    MassProperties,
    Patch,
    PointRegion,
    Region,
    Shape,
    Sphere,
)
from .hand import Axis, Hand, Link

__all__ = ["mirrored"]

# Reflection in the plane y = 0 of the palm, and of every link's own frame: only signs change.
_M = np.array([1.0, -1.0, 1.0])


def mirrored(hand: Hand) -> Hand:
    """The mirror image of a hand in the plane y = 0 of its palm.

    Each link's frame is mirrored in its own plane y = 0, so that the same joint vector places link i at
    M T_i M, with M = diag(1, -1, 1, 1). Joints, limits, couplings and servos keep their names and values.
    """
    regions = {
        name: replace(entry, region=_mirrored_region(entry.region)) for name, entry in hand.regions.items()
    }
    return replace(
        hand,
        name=_other_side(hand.name),
        links=tuple(_mirrored_link(link) for link in hand.links),
        regions=regions,
        frames={name: _mirrored_pose(T) for name, T in hand.frames.items()},
        description=f"mirror image of {hand.name}: {hand.description}".rstrip(": "),
    )


def _other_side(name: str) -> str:
    """The name with right for left; with `_mirrored` where it says neither."""
    for one, other in (("right", "left"), ("left", "right"), ("Right", "Left"), ("Left", "Right")):
        if one in name:
            return name.replace(one, other)
    return f"{name[:55]}_mirrored"


def _mirrored_link(link: Link) -> Link:
    inertia = link.inertia
    return replace(
        link,
        T_parent_link0=_mirrored_pose(link.T_parent_link0),
        axes=tuple(_mirrored_axis(axis) for axis in link.axes),
        shapes=tuple(_mirrored_shape(shape) for shape in link.shapes),
        inertia=MassProperties(inertia.mass, inertia.centre * _M, inertia.inertia * np.outer(_M, _M)),
    )


def _mirrored_pose(T: Array) -> Array:
    signs = np.append(_M, 1.0)
    return T * np.outer(signs, signs)


def _mirrored_axis(axis: Axis) -> Axis:
    # A turn by the same angle goes the other way round in a mirror; a slide does not.
    sign = -1.0 if axis.kind == "revolute" else 1.0
    return replace(axis, direction=sign * _M * axis.direction)


def _mirrored_shape(shape: Shape) -> Shape:
    match shape:
        case Sphere():
            return Sphere(shape.centre * _M, shape.radius)
        case Capsule():
            return Capsule(shape.start * _M, shape.end * _M, shape.radius)
        case Box():
            return Box(_mirrored_pose(shape.T_link_box), shape.half_extents)
        case Hull():
            return Hull(shape.vertices * _M, shape.faces[:, ::-1].copy())


def _mirrored_region(region: Region) -> Region:
    match region:
        case Cap():
            return replace(region, centre=region.centre * _M, axis=region.axis * _M)
        case Patch():
            # With u and v exchanged the normal p_u x p_v looks outwards again.
            return replace(region, patch=BezierPatch(region.patch.control_points.transpose(1, 0, 2) * _M))
        case PointRegion():
            return replace(region, point=region.point * _M, normal=region.normal * _M)
