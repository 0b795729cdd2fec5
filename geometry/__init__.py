"""Geometry that hands and objects share: transforms, Bezier patches, contact regions, convex shapes."""

from .bernstein import bernstein, bernstein_jets, de_casteljau
from .bezier import BezierPatch
from .closest_points import closest_on_triangles
from .convex_surface import ConvexSurface
from .curvature import region_curvature
from .flat import flat_normal, region_normal
from .friction_cone import cone_edges, even_directions
from .halton import halton_points
from .hull_corners import Corners, any_corners, furthest, hull_edges
from .mujoco_geom import mujoco_geom, mujoco_pose
from .placement import MOST_OFF_M, Placement, Surface, place_region
from .region_file import RegionSpec, build_patch, build_region, check_regular, region_fields
from .regions import Cap, Patch, PointRegion, Region
from .rotation_kernel import make_rotation, turn_by
from .shape_edges import length_below_surface
from .shapes import (
    Box,
    Capsule,
    Hull,
    MassProperties,
    Shape,
    Sphere,
    combined_mass,
    mass_properties,
    shape_mesh,
)
from .transforms import (
    axis_rotation,
    invert,
    perpendicular,
    pose,
    quaternion_from_rotation,
    rotation_angle,
    rotation_exp,
    rotation_from_quaternion,
    rotation_from_unit_quaternion,
    skew,
    transform_points,
)

__all__ = [
    "MOST_OFF_M",
    "BezierPatch",
    "Box",
    "Cap",
    "Capsule",
    "ConvexSurface",
    "Corners",
    "Hull",
    "MassProperties",
    "Patch",
    "Placement",
    "PointRegion",
    "Region",
    "RegionSpec",
    "Shape",
    "Sphere",
    "Surface",
    "any_corners",
    "axis_rotation",
    "bernstein",
    "bernstein_jets",
    "build_patch",
    "build_region",
    "check_regular",
    "closest_on_triangles",
    "combined_mass",
    "cone_edges",
    "de_casteljau",
    "even_directions",
    "flat_normal",
    "furthest",
    "halton_points",
    "hull_edges",
    "invert",
    "length_below_surface",
    "make_rotation",
    "mass_properties",
    "mujoco_geom",
    "mujoco_pose",
    "perpendicular",
    "place_region",
    "pose",
    "quaternion_from_rotation",
    "region_curvature",
    "region_fields",
    "region_normal",
    "rotation_angle",
    "rotation_exp",
    "rotation_from_quaternion",
    "rotation_from_unit_quaternion",
    "shape_mesh",
    "skew",
    "transform_points",
    "turn_by",
]
