"""Convex shapes that make up links and objects, their meshes and their mass."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import manifold3d
import numpy as np
import trimesh

from ..base.numeric.arrays import Array, Indices
from .transforms import perpendicular, pose

__all__ = [
    "Box",
    "Capsule",
    "Hull",
    "MassProperties",
    "Shape",
    "Sphere",
    "combined_mass",
    "mass_properties",
    "shape_mesh",
]

# A triangle of less area has no side of its own; planes are alike to so many digits, offsets in so many m.
_LEAST_TWICE_AREA_M2 = 1e-14
_PLANE_DIGITS, _PLANE_SCALE_M = 7, 1e-2


@dataclass(frozen=True, eq=False)
class Sphere:
    """A ball; centre (3,) and radius in m, in the frame of its link."""

    centre: Array
    radius: float


@dataclass(frozen=True, eq=False)
class Capsule:
    """All points within `radius` of the segment from `start` to `end`, in m."""

    start: Array
    end: Array
    radius: float


@dataclass(frozen=True, eq=False)
class Box:
    """A box with pose `T_link_box` (4, 4) and half extents (3,) in m."""

    T_link_box: Array
    half_extents: Array


@dataclass(frozen=True, eq=False)
class Hull:
    """The convex hull of `vertices` (n, 3) in m; `faces` (m, 3) wind outwards."""

    vertices: Array
    faces: Indices

    @classmethod
    def from_points(cls, points: Array) -> "Hull":
        """Hull of a cloud of points (n, 3) that are not all in one plane."""
        points = np.ascontiguousarray(points, dtype=float)
        try:
            mesh = trimesh.convex.convex_hull(points)
        except ModuleNotFoundError:
            # Slivers have come out wound both ways; trimesh can't mend that without a library of graphs.
            whole = manifold3d.Manifold.hull_points(points).to_mesh64()
            return cls(np.array(whole.vert_properties[:, :3]), np.array(whole.tri_verts, dtype=np.int64))
        return cls(np.array(mesh.vertices), np.array(mesh.faces, dtype=np.int64))

    @cached_property
    def planes(self) -> tuple[Array, Array]:
        """Unit outward normals (k, 3) and offsets (k,) in m of its sides; a flat face is one of them."""
        corners = self.vertices[self.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        lengths = np.linalg.norm(normals, axis=1)
        solid = lengths > _LEAST_TWICE_AREA_M2
        normals = normals[solid] / lengths[solid, None]
        offsets = np.einsum("ij,ij->i", normals, corners[solid, 0])
        alike = np.round(np.column_stack([normals, offsets / _PLANE_SCALE_M]), _PLANE_DIGITS)
        _, kept = np.unique(alike, axis=0, return_index=True)
        return normals[kept], offsets[kept]

    @cached_property
    def bounds(self) -> Array:
        """Lowest and highest coordinates (2, 3) in m."""
        return np.array([self.vertices.min(axis=0), self.vertices.max(axis=0)])


Shape: TypeAlias = Sphere | Capsule | Box | Hull


def shape_mesh(shape: Shape) -> trimesh.Trimesh:
    """A closed triangle mesh of the shape, for drawing and mass properties (round shapes to 1 %)."""
    match shape:
        case Sphere():
            mesh = trimesh.creation.icosphere(subdivisions=3, radius=shape.radius)
            mesh.apply_translation(shape.centre)
        case Capsule():
            axis = shape.end - shape.start
            length = float(np.linalg.norm(axis))
            mesh = trimesh.creation.capsule(height=length, radius=shape.radius, count=[32, 32])
            frame = _rotation_from_z(axis / length)
            # Releases of trimesh differ in where the capsule starts, so it is centred first.
            mesh.apply_translation(-mesh.bounds.mean(axis=0))
            mesh.apply_transform(pose(frame, 0.5 * (shape.start + shape.end)))
        case Box():
            mesh = trimesh.creation.box(extents=2.0 * shape.half_extents, transform=shape.T_link_box)
        case Hull():
            mesh = trimesh.Trimesh(shape.vertices, shape.faces, process=False)
    return mesh


def _rotation_from_z(direction: Array) -> Array:
    """A rotation (3, 3) that takes +z to the unit vector `direction`."""
    return np.column_stack([*perpendicular(direction), direction])


@dataclass(frozen=True, eq=False)
class MassProperties:
    """Mass properties in the body's axes.

    Attributes:
        mass: in kg.
        centre: centre of mass (3,) in m.
        inertia: (3, 3) in kg m^2 about the centre of mass.
    """

    mass: float
    centre: Array
    inertia: Array

    def __post_init__(self) -> None:
        for name in ("centre", "inertia"):
            array = np.array(getattr(self, name), dtype=float)
            array.setflags(write=False)
            object.__setattr__(self, name, array)


def combined_mass(bodies: Iterable[MassProperties]) -> MassProperties:
    """Mass properties of rigidly joined bodies, all in the same axes (parallel-axis theorem)."""
    given = list(bodies)
    mass = float(sum(body.mass for body in given))
    centre = np.sum([body.mass * body.centre for body in given], axis=0) / mass
    inertia = np.zeros((3, 3))
    for body in given:
        d = body.centre - centre
        inertia += body.inertia + body.mass * (d @ d * np.eye(3) - np.outer(d, d))
    return MassProperties(mass, centre, inertia)


def mass_properties(shapes: tuple[Shape, ...] | list[Shape], mass: float) -> MassProperties:
    """Mass properties of a body of uniform density made of `shapes`; overlaps count twice."""
    meshes = [shape_mesh(shape) for shape in shapes]
    density = mass / sum(abs(mesh.volume) for mesh in meshes)
    whole = combined_mass(
        MassProperties(
            density * abs(mesh.volume), mesh.center_mass, density * mesh.moment_inertia / mesh.density
        )
        for mesh in meshes
    )
    return MassProperties(mass, whole.centre, whole.inertia)
