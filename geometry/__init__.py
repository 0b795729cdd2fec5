"""Geometry that hands and objects share: transforms, Bezier patches, contact regions, convex shapes."""

from .bezier import BezierPatch
from .region_file import RegionSpec, build_patch, build_region, check_regular
from .regions import Cap, Patch, PointRegion, Region
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

__all__ = [
    "BezierPatch",
    "Box",
    "Cap",
    "Capsule",
    "Hull",
    "MassProperties",
    "Patch",
    "PointRegion",
    "Region",
    "RegionSpec",
    "Shape",
    "Sphere",
    "build_patch",
    "build_region",
    "check_regular",
    "combined_mass",
    "mass_properties",
    "shape_mesh",
]
