"""The shape of a body as it stands in object files: a mesh, a primitive, or Bezier surfaces that close."""

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Annotated, ClassVar

import numpy as np
import trimesh
from pydantic import Field, model_validator

from ..base.files.fields import Extent, Name, Vector3
from ..base.files.file_model import FileModel
from ..base.files.file_paths import resolve_beside
from ..geometry import BezierPatch, Box, Capsule, Hull, Sphere, build_patch, shape_mesh, transform_points
from ..geometry.solids import Closeness, Paint, convex_pieces, join_patches, read_mesh, read_paint
from .pose_file import PoseSpec, build_pose
from .size import Scale, Unit, check_size, metres

__all__ = ["ClosedShape", "ShapeSpec", "build_shape"]


class BoxSpec(FileModel):
    """A box along the axes of its frame, centred at the origin."""

    half_extents: tuple[Extent, Extent, Extent]


class CylinderSpec(FileModel):
    """A cylinder along the body's z axis, centred at its origin."""

    radius: Extent
    length: Extent


class SphereSpec(FileModel):
    """A ball centred at the body's origin."""

    radius: Extent


class CapsuleSpec(FileModel):
    """A capsule along the body's z axis, centred at its origin; `length` is that of its straight part."""

    radius: Extent
    length: Extent


class ShapeSpec(FileModel):
    """A shape: at most one of the kinds of `KINDS`, of which the owner says how many there must be.

    Where it has a pose, it lies there in its object's frame.
    """

    KINDS: ClassVar[tuple[str, ...]] = ("mesh", "box", "cylinder", "sphere", "capsule", "patches")

    mesh: str | None = None
    scale: Scale | None = None
    units: Unit | None = None
    box: BoxSpec | None = None
    cylinder: CylinderSpec | None = None
    sphere: SphereSpec | None = None
    capsule: CapsuleSpec | None = None
    patches: Annotated[dict[Name, list[list[Vector3]]], Field(min_length=1, max_length=1000)] | None = None
    patch_gap: Extent | None = None
    pose: PoseSpec | None = None

    @model_validator(mode="after")
    def _gap_of_patches(self) -> "ShapeSpec":
        if self.patch_gap is not None and self.patches is None:
            raise ValueError("patch_gap is for a shape made of patches")
        return self

    @model_validator(mode="after")
    def _unit_of_a_mesh(self) -> "ShapeSpec":
        for name in ("scale", "units"):
            if getattr(self, name) is not None and self.mesh is None:
                raise ValueError(f"{name} is for a mesh; other lengths are in metres")
        return self


@dataclass(frozen=True, eq=False)
class ClosedShape:
    """A closed surface with the convex pieces that stand for it.

    Attributes:
        mesh: closed, outward-wound surface in m.
        pieces: convex hulls that together cover it.
        surfaces: the Bezier surfaces that it is made of, by name; none for other kinds.
        repairs: what was repaired of a mesh, in words.
        closeness: how far pieces and surface lie apart.
        note: why pieces are coarse, where they are.
        paint: the colours of a mesh that has any.
    """

    mesh: trimesh.Trimesh
    pieces: tuple[Hull, ...]
    surfaces: dict[str, BezierPatch] = field(default_factory=dict)
    repairs: tuple[str, ...] = ()
    closeness: Closeness | None = None
    note: str = ""
    paint: Paint | None = None


def build_shape(spec: ShapeSpec, path: Path, field: str) -> ClosedShape:
    """Builds the shape that a file describes.

    Args:
        spec: with exactly one kind of shape.
        path: the file, beside which a mesh lies.
        field: of the shape inside the file, empty for the whole.

    Raises:
        InputError: not a closed body, or one of a size that no hand holds.
    """
    prefix = f"{field}." if field else ""
    surfaces: dict[str, BezierPatch] = {}
    repairs: tuple[str, ...] = ()
    unit_m, paint = None, None
    if spec.mesh is not None:
        where = f"{prefix}mesh"
        unit_m = metres(spec.scale, spec.units)
        file = resolve_beside(path, spec.mesh, where)
        mesh, repairs = read_mesh(file, str(path), where, unit_m=unit_m)
        paint = read_paint(file, str(path), where, unit_m=unit_m)
    elif spec.patches is not None:
        where = f"{prefix}patches"
        for name, rows in spec.patches.items():
            surfaces[name] = build_patch(rows, str(path), f"{where}.{name}")
        mesh = join_patches(surfaces, spec.patch_gap, str(path), where)
    else:
        where = field
        mesh = _primitive(spec)
    if spec.pose is not None:
        T = build_pose(spec.pose, str(path), f"{prefix}pose")
        mesh = trimesh.Trimesh(transform_points(T, mesh.vertices), mesh.faces, process=False)
        surfaces = {
            name: BezierPatch(transform_points(T, patch.control_points)) for name, patch in surfaces.items()
        }
        paint = None if paint is None else replace(paint, vertices=transform_points(T, paint.vertices))
    check_size(mesh, str(path), where, unit_m=unit_m)
    made = convex_pieces(mesh)
    return ClosedShape(mesh, made.pieces, surfaces, repairs, made.closeness, made.note, paint)


def _primitive(spec: ShapeSpec) -> trimesh.Trimesh:
    if spec.box is not None:
        return shape_mesh(Box(np.eye(4), np.array(spec.box.half_extents)))
    if spec.cylinder is not None:
        return trimesh.creation.cylinder(spec.cylinder.radius, spec.cylinder.length, sections=48)
    if spec.sphere is not None:
        return shape_mesh(Sphere(np.zeros(3), spec.sphere.radius))
    assert spec.capsule is not None
    end = np.array([0.0, 0.0, 0.5 * spec.capsule.length])
    return shape_mesh(Capsule(-end, end, spec.capsule.radius))
