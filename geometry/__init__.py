"""Geometry that hands and objects share: transforms, Bezier patches, contact regions, convex shapes."""

from .bezier import BezierPatch
from .region_file import RegionSpec, build_region
from .regions import Cap, Patch, PointRegion, Region
from .shapes import Box, Capsule, Hull, MassProperties, Shape, Sphere, mass_properties, shape_mesh

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
    "build_region",
    "mass_properties",
    "shape_mesh",
]
